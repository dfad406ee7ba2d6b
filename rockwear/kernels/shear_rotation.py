"""Shear springs of contacts that turn: what YADE's explicit rule is to start from, so that it ends where it should.

YADE carries the shear force of a contact into a step by s - s x a - (s - s x a) x t, with the turn a of the line of centres
and the twist t about it, and adds the slip of the points of contact, both with the normal of the end of the step while
velocities are those of its middle. The rule lengthens s by half the square of the angle, and a pair that turns as one
about a slanting axis slips by w_n w_t d dt^2 / 2 that never was (w_n, w_t: its angular_velocity along and across the normal, d: the
distance of the centres). Both pump energy into whatever spins fast.
"""
import numpy as np


def shear_to_start_from(shear, line, velocity, spins, radii, kt, dt):
    """The shear force from which YADE's rule arrives at that of a spring which turns with the contact.

    The spring's own rule is symmetric in time: half a turn, the slip in the middle of the step, half a turn.

        s' = R(R(s) - kt P (v - (r1' w1 + r2' w2) x n) dt),   r' = r - overlap / 2

    with R the turn over half the step, P the projection across the normal n, all but s and s' in the middle of the step.
    (Ours; YADE's rule: ScGeom::rotate and getIncidentVel, with avoidGranularRatcheting false.)

    shear (n, 3) N, of the last step; line (n, 3) m, from the first centre to the second, at the end of the step; velocity
    (n, 3) m/s, of the second centre to the first, and spins (2, n, 3) rad/s, in the middle of the step; radii (2, n) m; kt
    (n,) N/m; dt s.
    -> (n, 3) N.
    """
    angular_velocity = spins[0] + spins[1]
    middle = line - 0.5 * dt * velocity
    before, between, after = _unit(line - dt * velocity), _unit(middle), _unit(line)
    twist = 0.5 * dt * (between * angular_velocity).sum(axis=1)
    turned = _turned(shear, before, after, twist)
    slip = _turned(_slip(middle, between, velocity, spins, radii), between, after, 0.5 * twist)
    goal = turned + (dt * kt)[:, None] * (_slip(line, after, velocity, spins, radii) - slip)
    return _turned_back(_turned_back(goal, 0.5 * dt * _along(before, angular_velocity)), np.cross(before, after))


def turning_rates(line, velocity, spins):
    """(n,) rad/s at which contacts turn: their line of centres, and the mean angular_velocity about it. Arguments as above."""
    normal = _unit(line)
    across = velocity - _along(normal, velocity)
    return np.sqrt((across**2).sum(axis=1) / (line**2).sum(axis=1)
                   + 0.25 * (_along(normal, spins[0] + spins[1])**2).sum(axis=1))


def turned_by_yade(shear, orbit, twist):
    """(n, 3) YADE's rule, ScGeom::rotate: by the angles `orbit` and `twist` (n, 3)."""
    shear = shear - np.cross(shear, orbit)
    return shear - np.cross(shear, twist)


def _turned(vectors, before, after, angle):
    """Vectors across the normals `before`, carried along to the normals `after` and turned by `angle` (n,) about them."""
    across = vectors - (before + after) * ((vectors * after).sum(axis=1) / (1 + (before * after).sum(axis=1)))[:, None]
    return across * np.cos(angle)[:, None] + np.cross(after, across) * np.sin(angle)[:, None]


def _turned_back(shear, angle):
    """The inverse of s - s x angle."""
    return ((shear - np.cross(angle, shear) + angle * (angle * shear).sum(axis=1, keepdims=True))
            / (1 + (angle**2).sum(axis=1, keepdims=True)))


def _slip(line, normal, velocity, spins, radii):
    """(n, 3) m/s, velocity of the second surface along the first where they touch."""
    half = 0.5 * (radii.sum(axis=0) - np.linalg.norm(line, axis=1))
    arms = radii - half
    slip = velocity - np.cross(arms[0][:, None] * spins[0] + arms[1][:, None] * spins[1], normal)
    return slip - _along(normal, slip)


def _along(normal, vectors):
    return normal * (normal * vectors).sum(axis=1, keepdims=True)


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

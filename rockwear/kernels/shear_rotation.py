"""Shear force of rotating contacts: a correction of YADE's explicit rule.

YADE rotates the shear force s of a contact by s - s x a - (s - s x a) x t, with the rotation a of the line of centres
and the twist t about it, and adds the slip at the contact point, both with the normal at the end of the step and
velocities in its middle. The rule lengthens s by half the square of the angle. A pair in rigid rotation about an
oblique axis gets a spurious slip w_n w_t d dt^2 / 2 (w_n, w_t: angular velocity along and across the normal; d:
distance of the centres). Both add energy to particles that rotate fast.
"""
import numpy as np


def shear_to_start_from(shear, line, velocity, spins, radii, kt, dt):
    """Shear force (n, 3) N from which YADE's rule gives that of a spring which rotates with the contact. (Ours.)

    The rule of the spring is symmetric in time: half the rotation, the slip in mid-step, half the rotation.

        s' = R(R(s) - kt P (v - (r1' w1 + r2' w2) x n) dt),   r' = r - overlap / 2

    with the rotation R over half the step and the projection P across the normal n, all but s and s' in mid-step.
    YADE's rule is ScGeom::rotate and getIncidentVel with avoidGranularRatcheting false.

    shear: (n, 3) N, of the last step; line: (n, 3) m, from the first centre to the second, at the end of the step;
    velocity: (n, 3) m/s, of the second centre relative to the first, and spins: (2, n, 3) rad/s, angular velocities of
    both, in mid-step; radii: (2, n) m; kt: (n,) N/m; dt: s.
    """
    both = spins[0] + spins[1]
    middle = line - 0.5 * dt * velocity
    before, between, after = _unit(line - dt * velocity), _unit(middle), _unit(line)
    twist = 0.5 * dt * (between * both).sum(axis=1)
    turned = _turned(shear, before, after, twist)
    slip = _turned(_slip(middle, between, velocity, spins, radii), between, after, 0.5 * twist)
    goal = turned + (dt * kt)[:, None] * (_slip(line, after, velocity, spins, radii) - slip)
    return _turned_back(_turned_back(goal, 0.5 * dt * _along(before, both)), np.cross(before, after))


def turning_rates(line, velocity, spins):
    """(n,) rad/s, rotation of contacts: of the line of centres, and the mean twist about it. Arguments as above."""
    normal = _unit(line)
    across = velocity - _along(normal, velocity)
    return np.sqrt((across**2).sum(axis=1) / (line**2).sum(axis=1)
                   + 0.25 * (_along(normal, spins[0] + spins[1])**2).sum(axis=1))


def _turned(vectors, before, after, angle):
    """Vectors across the normals `before`, rotated to the normals `after` and by `angle` (n,) about these."""
    across = vectors - (before + after) * ((vectors * after).sum(axis=1) / (1 + (before * after).sum(axis=1)))[:, None]
    return across * np.cos(angle)[:, None] + np.cross(after, across) * np.sin(angle)[:, None]


def _turned_back(shear, angle):
    """The inverse of s - s x angle."""
    return ((shear - np.cross(angle, shear) + angle * (angle * shear).sum(axis=1, keepdims=True))
            / (1 + (angle**2).sum(axis=1, keepdims=True)))


def _slip(line, normal, velocity, spins, radii):
    """(n, 3) m/s, sliding velocity of the second surface on the first at the contact."""
    half = 0.5 * (radii.sum(axis=0) - np.linalg.norm(line, axis=1))
    arms = radii - half
    slip = velocity - np.cross(arms[0][:, None] * spins[0] + arms[1][:, None] * spins[1], normal)
    return slip - _along(normal, slip)


def _along(normal, vectors):
    return normal * (normal * vectors).sum(axis=1, keepdims=True)


def _unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

"""Rigid motions of a tool in the plane as functions of time: a straight cut, and a rotating and swinging cutter head.

A motion has pose(t) -> Pose and velocity(t) -> (2,) m/s of the origin of the body frame, t in s, and `angular_velocity`
in rad/s, positive counter-clockwise.
"""
import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Pose:
    """Position of a rigid body, x = offset + R(turn) X with X (m) in the body frame; offset: (2,) m; turn: rad."""

    offset: np.ndarray
    turn: float = 0.0

    @property
    def rotation(self):
        """(2, 2) rotation matrix R, counter-clockwise."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        return np.array([[c, -s], [s, c]])

    def of(self, points):
        """Positions (n, 2) m of points (n, 2) m given in the body frame."""
        return np.asarray(points, float) @ self.rotation.T + self.offset


class Straight:
    """Translation x(t) = start + v t. start: (2,) m; velocity v: (2,) m/s."""

    angular_velocity = 0.0

    def __init__(self, *, start, velocity):
        self.start, self.constant = np.asarray(start, float), np.asarray(velocity, float)

    def pose(self, t):
        """Pose at the time t (s)."""
        return Pose(self.start + self.constant * t)

    def velocity(self, t):
        """(2,) m/s of the origin of the body frame."""
        return self.constant


class SwingAndRotation:
    """A pick on a cutter head that rotates about a centre in straight motion [Rojek 2014, sec. 5.1, fig. 8].

        c(t) = c0 + u t,   turn(t) = a + w t,   x(t) = c(t) + R(turn) (X - C)

    A point at the distance R from the centre describes a trochoid (in [Rojek 2014]: a cycloid) at the circumferential
    velocity w R plus the swing velocity.

    centre: c0, (2,) m; swing: u, (2,) m/s; angular_velocity: w, rad/s, positive counter-clockwise; start: a, rad;
    pivot: C, the centre in the body frame of the pick, (2,) m.
    """

    def __init__(self, *, centre, swing, angular_velocity, pivot, start=0.0):
        self.centre, self.swing, self.pivot = (np.asarray(p, float) for p in (centre, swing, pivot))
        self.angular_velocity, self.start = angular_velocity, start

    def pose(self, t):
        """Pose at the time t (s)."""
        centre, turned = self.centre + self.swing * t, Pose(np.zeros(2), self.start + self.angular_velocity * t)
        return Pose(centre - turned.of([self.pivot])[0], turned.turn)

    def velocity(self, t):
        """(2,) m/s of the origin of the body frame at the time t (s)."""
        x, y = self.pose(t).offset - self.centre - self.swing * t
        return self.swing + self.angular_velocity * np.array([-y, x])


def rigid_parts(piece, *, positions, masses, inertias, velocities, spins):
    """((n, 2) m/s, (n,) rad/s): what the motion of discs in the plane has of the rigid motion of the piece each is of.

    The rigid motion of a piece has its momentum and its moment of momentum: the rest has neither, and the kinetic
    energy is the sum of both parts' own. piece: (n,) number of the piece, from 0 on; positions (n, 2) m; masses (n,)
    kg; inertias (n,) kg m2; velocities (n, 2) m/s; spins (n,) rad/s.
    """
    def summed(values):
        return np.bincount(piece, values)

    mass = summed(masses)
    arms, relative = (values - np.stack([summed(masses * column) / mass for column in values.T], axis=1)[piece]
                      for values in (positions, velocities))
    moment = summed(masses * (arms[:, 0] * relative[:, 1] - arms[:, 1] * relative[:, 0]) + inertias * spins)
    spin = (moment / summed(masses * (arms**2).sum(axis=1) + inertias))[piece]
    return velocities - relative + spin[:, None] * arms[:, ::-1] * (-1.0, 1.0), spin

"""Rigid motions of a tool in the plane, as exact functions of time: a straight cut, and a swinging cutter head.

A motion has pose(t) -> Pose; velocity(t) -> (2,) m/s of the origin of the body's own frame, t in s; and `angular_velocity`, rad/s.
"""
import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Pose:
    """Where a rigid body is: x = offset + R(turn) X, X (m) in the body's own frame; offset (2,) m, turn rad."""

    offset: np.ndarray
    turn: float = 0.0

    @property
    def rotation(self):
        """(2, 2) matrix R of the turn, counter-clockwise."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        return np.array([[c, -s], [s, c]])

    def of(self, points):
        """Places (n, 2) m of points of the body, given in its own frame."""
        return np.asarray(points, float) @ self.rotation.T + self.offset


class Straight:
    """x(t) = start + v t. start: (2,) m; velocity: (2,) m/s."""

    angular_velocity = 0.0

    def __init__(self, *, start, velocity):
        self.start, self.constant = np.asarray(start, float), np.asarray(velocity, float)

    def pose(self, t):
        return Pose(self.start + self.constant * t)

    def velocity(self, t):
        return self.constant


class SwingAndRotation:
    """A pick on a cutter head that turns about a centre, which swings along a straight line (P 5.1, fig. 8).

        c(t) = c0 + u t,   turn(t) = a + w t,   x(t) = c(t) + R(turn) (X - C)

    C is the centre as the pick sees it. A point at the distance R from the centre runs through a trochoid (P: a
    cycloid) at the circumferential velocity w R, to which the swing adds.

    centre: c0, (2,) m; swing: u, (2,) m/s; angular_velocity: w, rad/s, positive counter-clockwise; start: a, rad;
    pivot: C, (2,) m in the pick's own frame.
    """

    def __init__(self, *, centre, swing, angular_velocity, pivot, start=0.0):
        self.centre, self.swing, self.pivot = (np.asarray(p, float) for p in (centre, swing, pivot))
        self.angular_velocity, self.start = angular_velocity, start

    def pose(self, t):
        centre, turned = self.centre + self.swing * t, Pose(np.zeros(2), self.start + self.angular_velocity * t)
        return Pose(centre - turned.of([self.pivot])[0], turned.turn)

    def velocity(self, t):
        x, y = self.pose(t).offset - self.centre - self.swing * t
        return self.swing + self.angular_velocity * np.array([-y, x])

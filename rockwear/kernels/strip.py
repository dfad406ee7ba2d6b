"""A strip of the plane beside a way, straight or along an arc: maps from its coordinates to the plane.

Strip coordinates: x along the way, y to its left, m. The arc turns counter-clockwise, with its centre on the left:

    place = centre + rho (sin phi, -cos phi),   phi = start + x / R,   rho = R exp(-(y - level) / R)

With z = (x - centre) that is the exponential function, which is conformal: it turns and enlarges whatever is small
against R, by rho / R, and does not distort it. A packing whose radii are enlarged as much keeps its porosity, its
contacts and their overlaps over diameters up to terms of the order of a radius over R; heat flows through a network of
the same conductances, and moduli of bonded discs in the plane stay. Rock that repeats itself along x with a period does
so in the plane, by a translation or by a rotation about the centre.
"""
import math

import numpy as np

from rockwear.kernels.checks import positive, require


class StraightStrip:
    """The way along the x axis: strip coordinates are those of the plane."""

    def place(self, points):
        """Places (n, 2) m in the plane of points (n, 2) m of the strip."""
        return points

    def unroll(self, places):
        """Points (n, 2) m of the strip at places (n, 2) m of the plane."""
        return places

    def stretch(self, points):
        """(n,) length in the plane over length in the strip at points (n, 2) m."""
        return np.ones(len(points))

    def lengths(self, start, apart):
        """(m,) m in the plane between points (m, 2) m of the strip and those that are `apart` (m, 2) m from them."""
        return np.linalg.norm(apart, axis=1)

    def turned(self, vectors, points):
        """Directions (n, 2) in the plane of vectors (n, 2) in the strip at points (n, 2) m."""
        return vectors

    def frame(self, begin):
        """(2,) m, origin of pictures of the strip from x = `begin` (m) on."""
        return np.array([begin, 0.0])


class ArcStrip:
    """The way along an arc, counter-clockwise.

    centre: (2,) m; radius: R, m; level: m, the y at which lengths are those of the plane; start: rad, direction from
    the centre at x = 0, from straight down. Raises ParameterError.
    """

    def __init__(self, *, centre, radius, level=0.0, start=0.0):
        self.centre, self.radius = np.asarray(centre, float), positive("radius", radius, "m")
        self.level, self.start = level, start

    @classmethod
    def through(cls, points, *, level=0.0, x=0.0):
        """The arc nearest to a curve of points (k, 2) m, which runs at y = level (m) from x (m) on.

        The circle has the least sum of squares of |p - c|^2 - R^2 (Kasa 1976). Raises ParameterError for fewer than
        three points, or points on a line.
        """
        points = np.asarray(points, float)
        require(len(points) > 2, "points", len(points), "three or more")
        middle = points.mean(axis=0)
        near = points - middle
        found, _, rank, _ = np.linalg.lstsq(np.column_stack([2 * near, np.ones(len(near))]), (near**2).sum(axis=1),
                                            rcond=None)
        require(rank == 3, "points", len(points), "not on a straight line")
        radius, (east, north) = math.sqrt(found[2] + found[:2] @ found[:2]), near[0] - found[:2]
        return cls(centre=found[:2] + middle, radius=radius, level=level,
                   start=math.atan2(east, -north) - x / radius)

    def place(self, points):
        """Places (n, 2) m in the plane of points (n, 2) m of the strip."""
        angle = self._angle(points)
        return self.centre + (self.radius * self.stretch(points))[:, None] * np.column_stack(
            [np.sin(angle), -np.cos(angle)])

    def unroll(self, places):
        """Points (n, 2) m of the strip at places (n, 2) m of the plane, from a quarter of a turn before x = 0 on."""
        x, y = (np.asarray(places, float) - self.centre).T
        angle = np.mod(np.arctan2(x, -y) - self.start + 0.5 * math.pi, 2 * math.pi) - 0.5 * math.pi
        return np.column_stack([self.radius * angle, self.level - self.radius * np.log(np.hypot(x, y) / self.radius)])

    def stretch(self, points):
        """(n,) length in the plane over length in the strip at points (n, 2) m."""
        return np.exp((self.level - points[:, 1]) / self.radius)

    def lengths(self, start, apart):
        """(m,) m in the plane between points (m, 2) m of the strip and those that are `apart` (m, 2) m from them."""
        return np.linalg.norm(self.place(start + apart) - self.place(start), axis=1)

    def turned(self, vectors, points):
        """Directions (n, 2) in the plane of vectors (n, 2) in the strip at points (n, 2) m."""
        angle, (x, y) = self._angle(points), vectors.T
        return np.column_stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y])

    def frame(self, begin):
        """(2,) m, origin of pictures: they show the whole arc."""
        return np.zeros(2)

    def _angle(self, points):
        return self.start + points[:, 0] / self.radius

"""The Brazilian test of a triangular lattice, which is isotropic: stresses at its centre have an exact answer.

    yade -n -x brazilian.py [--name value ...]
"""
import math

import numpy as np

from calibration.laboratory.brazilian import GROUPS, BrazilianTest
from rockwear.model.rock import Arranged
from rockwear.run import main as run


class Lattice(BrazilianTest):
    """A disc of equal discs of radius_min."""

    def _specimen(self):
        v = self.v
        self.radius = 0.5 * v.diameter
        v.width = v.height = v.diameter
        self.centre = np.full(2, self.radius)
        n = math.ceil(self.radius / v.radius_min)
        row, column = np.mgrid[-n:n + 1, -n:n + 1].reshape(2, -1)
        places = v.radius_min * np.column_stack([2 * column + row % 2, math.sqrt(3) * row])
        places = places[np.linalg.norm(places, axis=1) <= self.radius]
        return Arranged(positions=places + self.centre, radius=v.radius_min, width=v.width, height=v.height,
                        density=v.rock_density)


run.main("lattice", GROUPS, Lattice)

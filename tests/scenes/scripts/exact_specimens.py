"""Specimens that have exact answers: a triangular lattice, and a chain of two discs."""
import math

import numpy as np

from rockwear.kernels.parameter import Group, Parameter, choice
from rockwear.model.rock import Arranged

ROWS, COLUMNS, RADIUS = 7, 36, 1e-3


def arranged(positions, section, density):
    """Discs whose force becomes a stress over `section`, m."""
    return Arranged(positions=positions, radius=RADIUS, width=np.ptp(positions[:, 0]) + 2 * RADIUS, height=section,
                    density=density)


def lattice(v):
    """Rows along x. Under uniaxial stress all of it strains alike, up to its free edges: a row carries kn D a strain,
    a gap between rows what is left of E sqrt(3)/2 D. With a gap less than rows, that is the section of N - 1 rows and
    of kn D/E for the last."""
    spacing, rise = 2 * RADIUS, math.sqrt(3) * RADIUS
    places = [(RADIUS + spacing * k + (row % 2) * RADIUS, RADIUS + rise * row)
              for row in range(ROWS) for k in range(COLUMNS)]
    modulus = 2 * math.sqrt(3) * v.kn * (v.kn + v.kt) / (3 * v.kn + v.kt)
    section = (ROWS - 1) * rise + v.kn * spacing / modulus
    return arranged(np.array(places), section, v.rock_density)


def chain(v):
    """Two discs in a row, both prescribed."""
    places = np.array([[RADIUS, RADIUS], [3 * RADIUS, RADIUS]])
    return arranged(places, 2 * RADIUS, v.rock_density)


class ExactSpecimen:
    """In place of the packing of a test, the specimen that the parameter `specimen` names."""

    def _specimen(self):
        return {"lattice": lattice, "chain": chain}[self.v.specimen](self.v)


SPECIMEN = Group("rock", (Parameter("specimen", "lattice", "", choice("lattice", "chain"), "what is tested"),))

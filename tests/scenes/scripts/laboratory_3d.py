"""The uniaxial test in space on a block that has exact answers: a face-centred cubic lattice of spheres.

    yade -n -x laboratory_3d.py [--name value ...]
"""
import math

import numpy as np

from calibration.laboratory.uniaxial import GROUPS_IN_SPACE, UniaxialTest
from rockwear.model.rock import Arranged
from rockwear.run import main as run

LAYERS, ROWS, RADIUS = 15, 6, 1e-3


def lattice(v):
    """Layers across x, each a chequered half of ROWS x ROWS places. Between two layers there are 2 ROWS (ROWS - 1)
    bonds, each of which carries what (D/2)^2 does in an endless lattice: that makes the section."""
    step = math.sqrt(2) * RADIUS
    places = np.array([(i, j, k) for i in range(LAYERS) for j in range(ROWS) for k in range(ROWS)
                       if (i + j + k) % 2 == 0], float)
    places -= (0, 0, 0.5 * (ROWS - 1))
    return Arranged(positions=step * places + (RADIUS, 0, 0), radius=RADIUS, width=step * (LAYERS - 1) + 2 * RADIUS,
                    height=step * (ROWS - 1), depth=step * ROWS, density=v.rock_density)


class Exact(UniaxialTest):
    """The test of the lattice."""

    def _specimen(self):
        return lattice(self.v)


run.main("exact", GROUPS_IN_SPACE, Exact)

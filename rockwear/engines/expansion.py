"""Thermal expansion of the rock's particles, and its effect on their bonds and contacts."""
import numpy as np
from yade import O

from rockwear.engines.base import Engine

RESOLUTION = 1e-12
"""Least relative change of a radius that is applied: 1e-7 K at 1e-5 1/K, at most 1e-5 of the strength of a bond."""


class Expansion(Engine):
    """Radii r = r0 (1 + alpha (theta - theta0)) [Rojek 2014, eq. 11], for bodies 0..n-1.

    Expansion acts on a bond like a displacement. Its length at rest, |x_j - x_i| at bonding, grows in proportion to
    r_i + r_j. (In [Rojek 2014, eq. 10] it grows by the growth of r_i + r_j and keeps the packing's gap g0: bonds with
    overlaps and bonds with gaps grow differently, and a packing under uniform heating has residual stresses. Here it
    has none; where discs touch the two are the same.) A broken bond keeps its length at rest, that is, the distance
    at which it presses again. Other contacts take the new radii. Masses are kept: the density falls. Bounding boxes
    follow at the next run of the collider; their margin, a twentieth of a radius, is a thousand times what the radii
    grow in the meantime.

    coefficient: alpha, 1/K; rock: the specimen, with its cold radii and positions; reference: theta0, K; temperature: a
    function that gives (n,) K; bonds: engines.bonds.Bonds; loose: a function that gives the contacts that are no bonds.
    `work` (J) is the work of the expansion against the forces in bonds and contacts.
    """

    name = "expansion"

    def __init__(self, *, coefficient, rock, reference, temperature, bonds, loose=tuple, period=1):
        super().__init__(period=period)
        self.coefficient, self.reference, self.temperature = coefficient, reference, temperature
        self.bonds, self.loose = bonds, loose
        self.cold, (i, j) = rock.radii, rock.pairs.T
        self.overlap = 1 - rock.bond_lengths / (self.cold[i] + self.cold[j])
        self.work = 0.0

    def connect(self):
        self.shapes = [O.bodies[i].shape for i in range(len(self.cold))]
        self.radii = np.array([shape.radius for shape in self.shapes])

    def act(self):
        radii = self.cold * (1 + self.coefficient * (self.temperature() - self.reference))
        changed = abs(radii - self.radii) > RESOLUTION * self.cold
        growth = np.where(changed, radii - self.radii, 0.0)
        if not changed.any():
            return
        self.radii = self.radii + growth
        for i in np.flatnonzero(changed).tolist():
            self.shapes[i].radius = float(self.radii[i])
        longer = growth[self.bonds.pairs].sum(axis=1)
        numbers = np.flatnonzero(longer)
        self.work += self.bonds.expand(numbers, longer[numbers], (longer * self.overlap)[numbers])
        for i in self.loose():
            grown = sum(growth[body] for body in (i.id1, i.id2) if body < len(growth))
            if grown and i.isReal:
                self.work += grown * (i.phys.normalForce.dot(i.geom.normal) + 0.5 * i.phys.kn * grown)

    def renew(self, numbers):
        """Particles `numbers` (k,) are about to be untouched rock, at the reference temperature."""
        self.radii[numbers] = self.cold[numbers]
        for n in numbers.tolist():
            self.shapes[n].radius = float(self.cold[n])

    def state(self):
        return {"work": self.work}

    def restore(self, state):
        self.work = float(state["work"])

"""Crushing of bonds in YADE's concrete model: one law for all of them, made each bond's own by its reference length."""
import math

import numpy as np
from yade import Law2_ScGeom_CpmPhys_Cpm

from rockwear.engines import access

STRAIN = 0.01
"""Elastic compressive strain at which YADE lets all bonds crush. The length over which a bond's strains count is chosen
so that this is its own crushing strength, and grows as that hardens."""
LONGER = {"length": "refLength", "E": "E", "G": "G"}
SHORTER = {"onset": "epsCrackOnset", "fracture": "epsFracture", "kappa": "kappaD"}
"""Numbers of a bond that grow, and strains that shrink, with that length: their names in YADE."""
GROUPS = {"longer": tuple(LONGER), "shorter": (*SHORTER, "strain", "slipped", "crushed")}
"""What is written at once."""


class Crushing:
    """What bonds are shorter for good: C++ shortens them at their crushing force, and a look hardens them.

    laws: (m,) of kernels.bond_laws.Cohesive; hardening: crushing_hardening of the rock; places: engines.memory.Places
    of the bonds. `strains` (m,): YADE's plastic strain epsNPl at the last look, <= 0.
    """

    def __init__(self, *, laws, hardening, places):
        self.force, self.kn = (np.array([getattr(law, name) for law in laws]) for name in ("Rc", "kn"))
        self.hardening, self.places = hardening, places
        self.possible, self.strains = bool((self.force < math.inf).any()), np.zeros(len(laws))

    def begin(self):
        """Let C++ crush the bonds of the scene that is in O now."""
        if self.possible:
            law = access.law_functor(Law2_ScGeom_CpmPhys_Cpm)
            law.epsSoft, law.relKnSoft = -STRAIN, 0.0

    def reference_length(self, n, own):
        """m over which the strains of bond n count; own: m, of a bond that does not crush."""
        return self.force[n] / (self.kn[n] * STRAIN) if self.force[n] < math.inf else own

    def harden(self, there, strains, lengths):
        """Take note of YADE's plastic strains (k,) of the bonds `there` (k,).

        lengths: (m,) m, reference lengths, brought up to date. -> bonds (l,) that are shorter now, work (l,) J.
        """
        shorter = np.flatnonzero(strains != self.strains[there])
        numbers, strains = there[shorter], strains[shorter]
        kn, length = self.kn[numbers], lengths[numbers]
        work = kn * STRAIN * length**2 * (self.strains[numbers] - strains)
        grown = (self.force[numbers] / (kn * length) - self.hardening * strains) / STRAIN
        self.places.write("longer", numbers, self.places.read("longer", numbers) * grown)
        self.places.write("shorter", numbers, self.places.read("shorter", numbers) / grown)
        # As a restart reads them.
        lengths[numbers], self.strains[numbers] = (self.places.read(name, numbers)[0] for name in ("length", "crushed"))
        return numbers, work

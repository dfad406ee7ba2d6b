"""Crushing of bonds in YADE's concrete model: one law for all of them, made each bond's own by its reference length."""
import math

from yade import Law2_ScGeom_CpmPhys_Cpm

from rockwear.engines import access
from rockwear.kernels.compiled import CRUSHING_STRAIN


def let_crush():
    """Let C++ crush the bonds of the scene that is in O now, all at the same elastic strain."""
    law = access.law_functor(Law2_ScGeom_CpmPhys_Cpm)
    law.epsSoft, law.relKnSoft = -CRUSHING_STRAIN, 0.0


def reference_length(law, own):
    """m over which the strains of a bond count, so that CRUSHING_STRAIN is its own crushing strength; it grows as that
    hardens (kernels.compiled.harden). law: kernels.bond_laws.Cohesive; own: m, of a bond that does not crush."""
    return law.Rc / (law.kn * CRUSHING_STRAIN) if law.Rc < math.inf else own

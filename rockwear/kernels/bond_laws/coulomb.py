"""Brittle bond with a Coulomb shear strength and a tension cut-off."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, ElasticDomain, LinearBondLaw
from rockwear.kernels.checks import positive
from rockwear.kernels.parameter import Parameter, plausible

stress = plausible(1e2, 1e11)
"""A rule: Pa."""

TENSION = Parameter("bond_tension", 7e6, "Pa", stress, "tensile strength of a bond over its area of crack",
                    "[Rojek 2014, 5.1]: that of the rock")
COHESION = Parameter("bond_cohesion", 20e6, "Pa", stress,
                     "shear strength of a bond without normal force, over its area of crack")


class Coulomb(LinearBondLaw):
    """Elastic brittle bond that breaks when Fn > Rn or |Ft| > Rt - mu Fn, with Fn positive in tension
    [Bahaaddini 2018, eqs 1-4]. Afterwards the faces keep the same mu.

    kn, kt  N/m, > 0      mu  friction within the bond and after breakage, >= 0
    bond_tension, bond_cohesion  Pa, > 0: Rn and Rt (N) of a bond that stands for 1 m2 of crack; `scaled` by the area of
    a bond gives its own, so that the rock's strength does not depend on the size of its particles. With a cohesion
    below mu times the tension, the cone ends in its apex: the bond breaks in tension at Rt / mu.
    Raises ParameterError.
    """

    name = "coulomb"
    by_area = True
    parameters = (KN, KT, TENSION, COHESION, MU)

    def __init__(self, *, kn, kt, bond_tension, bond_cohesion, mu):
        super().__init__(kn=kn, kt=kt, Rn=positive("bond_tension", bond_tension, "Pa"),
                         Rt=positive("bond_cohesion", bond_cohesion, "Pa"), H=math.inf, mu=mu)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        return ElasticDomain(self.kn, self.kt, self.Rn, self.Rt, -self.mu)

    def _bonded(self, bond, un, ut):
        Fn = self.kn * un
        Ft = self._shear(bond, Fn, ut)
        if Fn > self.Rn or math.hypot(*Ft) > self.Rt - self.mu * Fn:
            return None
        return Fn, Ft

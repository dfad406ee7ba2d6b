"""Elastic perfectly brittle bond."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, RN, RT, ElasticDomain, LinearBondLaw


class ElasticBrittle(LinearBondLaw):
    """Elastic perfectly brittle bond [Rojek 2003, eqs 4.1-4.6]: breaks at once when Fn > Rn or |Ft| > Rt.

    kn, kt  N/m, > 0      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    Raises ParameterError.
    """

    name = "brittle"
    parameters = (KN, KT, RN, RT, MU)

    def __init__(self, *, kn, kt, Rn, Rt, mu):
        super().__init__(kn=kn, kt=kt, Rn=Rn, Rt=Rt, H=math.inf, mu=mu)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        return ElasticDomain(self.kn, self.kt, self.Rn, self.Rt)

    def _bonded(self, bond, un, ut):
        Fn = self.kn * un
        Ft = self._shear(bond, Fn, ut)
        if Fn > self.Rn or math.hypot(*Ft) > self.Rt:
            return None
        return Fn, Ft

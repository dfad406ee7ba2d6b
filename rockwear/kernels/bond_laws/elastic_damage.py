"""Elastic damage with linear softening."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, RN, RT, SLOPE, ElasticDomain, LinearBondLaw
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Parameter, flag

_AT_ZERO = 1e-12
"""Limit force of an elastic domain that ends where a force changes its sign, as a fraction of the strength."""


class ElasticDamage(LinearBondLaw):
    """Elastic damage with linear softening [Rojek 2003, eqs 4.17-4.19].

    Fn = (1 - omega) kn un in tension, kn un in compression; Ft = (1 - omega) kt ut. One omega serves both directions:
    the largest value so far of omega(un; kn, Rn) and omega(|ut|; kt, Rt), where eqs 4.18-4.19 put the force on the line
    R - H (u - R/k). Since both grow with the distance from the origin, a path sampled at its corners gives the forces
    of the same path sampled finely. H -> inf is ElasticBrittle on every path.

    At omega = 1 the bond is broken (the text of [Rojek 2003, 4.4] says omega = 0). Under compression it breaks
    earlier, when damage by shear brings its force down to mu |Fn|, as in the elasto-plastic law: the sources leave this
    open, and otherwise a cracked bond would carry less shear than the same two faces unbonded. The contact starts from
    the force of the bond, not from the larger one of an undamaged spring.

    kn, kt, H  N/m, > 0 (H may be math.inf)      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    tension_only  only opening increases omega; shear alone then never breaks the bond
    Raises ParameterError.
    """

    name = "damage"
    parameters = (KN, KT, RN, RT, SLOPE, MU,
                  Parameter("tension_only", False, "", flag, "tension alone damages a bond, and shear never breaks it"))

    def __init__(self, *, kn, kt, Rn, Rt, H, mu, tension_only=False):
        super().__init__(kn=kn, kt=kt, Rn=Rn, Rt=Rt, H=H, mu=mu)
        require(tension_only in (True, False), "tension_only", tension_only, "True or False")
        self.tension_only = bool(tension_only)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """Limit forces at the current damage. The normal stiffness of a damaged bond is lower in tension than in
        compression, so that its domain ends where Fn changes its sign; in tension a slope does that: no shear at
        Fn = 0, both limits at once at the far end. With tension_only, the shear of a damaged bond has no limit: there
        is no domain."""
        left = 1.0 - bond.softening
        limit_n, limit_t = left * self._onset(bond, self.kn, self.Rn), left * self._onset(bond, self.kt, self.Rt)
        if bond.softening == 0.0:
            domain = ElasticDomain(self.kn, self.kt, limit_n, limit_t)
        elif self.tension_only:
            return None
        elif Fn <= 0.0:
            domain = ElasticDomain(self.kn, left * self.kt, _AT_ZERO * self.Rn, limit_t)
        else:
            domain = ElasticDomain(left * self.kn, left * self.kt, limit_n, _AT_ZERO * self.Rt, limit_t / limit_n)
        return domain if Fn < domain.Fn and Ft < domain.Ft + domain.slope * max(Fn, 0.0) else None

    def _onset(self, bond, k, R):
        """Force of an undamaged spring at which damage grows: eqs 4.18-4.19 solved for it."""
        return R / (1.0 - bond.softening / (1.0 + self.H / k))

    def _damage(self, force, k, R):
        """omega of eqs 4.18-4.19 where an undamaged spring would carry `force`."""
        return min((1.0 + self.H / k) * (1.0 - R / force), 1.0) if force > R else 0.0

    def _bonded(self, bond, un, ut):
        Fn = self.kn * un
        Ft = self._shear(bond, Fn, ut)
        omega = max(bond.softening, self._damage(Fn, self.kn, self.Rn))
        if not self.tension_only:
            norm = math.hypot(*Ft)
            omega = max(omega, self._damage(norm, self.kt, self.Rt))
            if omega > bond.softening and (1.0 - omega) * norm <= -self.mu * Fn:
                omega = 1.0
        if omega >= 1.0:
            # The force as it was before this step's damage is the contact's trial: exact on any proportional path.
            self._slip(bond, ut, Ft, 1.0 - bond.softening)
            return None
        bond.softening = omega
        if omega > 0.0:
            Ft = tuple([(1.0 - omega) * f for f in Ft])
            if Fn > 0.0:
                Fn *= 1.0 - omega
        return Fn, Ft

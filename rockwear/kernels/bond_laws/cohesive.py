"""Bond with a fracture energy: softening in tension, Coulomb slip in shear."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, LinearBondLaw
from rockwear.kernels.bond_laws.coulomb import COHESION, TENSION
from rockwear.kernels.checks import positive
from rockwear.kernels.parameter import Parameter, plausible

BRITTLEST = 1.001
"""Least opening at the end of softening, over that at the peak."""


class Cohesive(LinearBondLaw):
    """Tension softens linearly with a fracture energy, shear slips at Coulomb's limit.

    Tension is [Rojek 2003, eqs 4.17-4.19] driven by opening alone: with u0 = Rn/kn, uf = 2 G/Rn and the largest opening
    so far u, omega = (1 - u0/u)/(1 - u0/uf) and Fn = (1 - omega) kn un; compression is elastic. Shear is elastic up to
    |Ft| = (1 - omega) Rt - mu Fn (Fn positive in tension) [Bahaaddini 2018, eqs 2-4] and slips there; slip does not
    damage the bond. At u = uf the bond is broken, and Coulomb friction remains. The work to break it in tension is G.

    This is the published part of YADE's concrete model (Law2_ScGeom_CpmPhys_Cpm, damLaw 0), which carries it in C++.
    (Its equivStrainShearContrib lets shear drive the damage too, yet damages the limit of shear and not its stiffness:
    that is not [Rojek 2003]'s law, and it is left at 0.)

    kn, kt  N/m, > 0      mu  friction within the bond and after breakage, >= 0
    bond_tension, bond_cohesion  Pa, bond_fracture_energy  J/m2, all > 0: of a bond that stands for 1 m2 of crack, see
    Coulomb; a low cohesion does not cut the tension here. A bond's elastic energy Rn^2/(2 kn) is a lower bound of G.
    Raises ParameterError.
    """

    name = "cohesive"
    by_area = True
    yade_law = "Cpm"
    parameters = (KN, KT, TENSION, COHESION,
                  Parameter("bond_fracture_energy", 30.0, "J/m2", plausible(1e-4, 1e6),
                            "work to break a bond in tension, over its area"), MU)

    def __init__(self, *, kn, kt, bond_tension, bond_cohesion, bond_fracture_energy, mu):
        super().__init__(kn=kn, kt=kt, Rn=positive("bond_tension", bond_tension, "Pa"),
                         Rt=positive("bond_cohesion", bond_cohesion, "Pa"), H=math.inf, mu=mu)
        self.end = 2 * positive("bond_fracture_energy", bond_fracture_energy, "J/m2") / self.Rn

    @property
    def onset(self):
        """Opening (m) at the peak."""
        return self.Rn / self.kn

    @property
    def gone(self):
        """Opening (m) at which the bond is broken."""
        return max(self.end, BRITTLEST * self.onset)

    def fracture_energy(self):
        """(J to break the bond in pure tension, math.inf in pure shear, where it slips)."""
        return 0.5 * self.Rn * self.gone, math.inf

    def opening(self, softening):
        """Largest opening (m) so far of a bond of this omega > 0."""
        return self.onset / (1.0 - softening * (1.0 - self.onset / self.gone))

    def dissipated(self, softening):
        """Energy (J) that damage has dissipated at this omega."""
        u0, uf, u = self.onset, self.gone, self.opening(softening)
        # Under the curve up to u, less what unloading along the secant gives back.
        force = self.Rn * (uf - u) / (uf - u0)
        return 0.5 * (self.Rn * u0 + (self.Rn + force) * (u - u0) - force * u)

    def shear_limit(self, softening, Fn):
        """|Ft| (N) at which a bond of this omega slips under the normal force Fn (N)."""
        return max((1.0 - softening) * self.Rt - self.mu * Fn, 0.0)

    def _bonded(self, bond, un, ut):
        omega, u0 = bond.softening, self.onset
        if un > u0:
            omega = max(omega, (1.0 - u0 / un) / (1.0 - u0 / self.gone))
            if omega >= 1.0:
                return None
            bond.softening = omega
        Fn = self.kn * un * (1.0 - omega if un > 0.0 else 1.0)
        Ft = self._shear(bond, Fn, ut)
        norm, limit = math.hypot(*Ft), self.shear_limit(omega, Fn)
        if norm > limit:
            Ft = self._slip(bond, ut, Ft, limit / norm)
        return Fn, Ft

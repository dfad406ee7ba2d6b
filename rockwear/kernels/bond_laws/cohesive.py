"""Bond with fracture energies and crushing: softening in tension, in shear by Coulomb slip, plastic in compression."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, LinearBondLaw
from rockwear.kernels.bond_laws.coulomb import COHESION, TENSION
from rockwear.kernels.checks import finite, not_negative, positive, within
from rockwear.kernels.parameter import Parameter, number, plausible, zero_or

UNBREAKABLE = 1e30
"""Strength (N) of bonds that are not to break at all."""
BRITTLEST, CRUSHING = 1.001, 2.0
"""Least opening at the end of softening, over that at the peak; of bonds that may crush: past its end YADE's model
pulls a crushed bond the wrong way until the next look, up to onset/(gone - onset) times as strongly as an elastic one.
"""


class Cohesive(LinearBondLaw):
    """Tension softens linearly with a fracture energy, shear slips at Coulomb's limit, compression may crush.

    Tension is [Rojek 2003, eqs 4.17-4.19] driven by opening alone: with u0 = Rn/kn, uf = 2 G/Rn and the largest opening
    so far u, omega = (1 - u0/u)/(1 - u0/uf) and Fn = (1 - omega) kn un; compression is elastic up to Rc. Shear is
    elastic up to |Ft| = c Rt - mu Fn (Fn positive in tension) [Bahaaddini 2018, eqs 2-4] and slips there.

    With a crushing strength, compression flows at Fn = -(Rc - h kn up): un is then counted from where the force
    vanishes, un - up, and up falls. It stands for grains that break and pores that collapse (Zhang, Wong & Davis,
    1990), which lets rock give way under a tip without opening a crack beside it; the hardening h keeps particles from
    passing through one another. Pressed from all sides alike, rock whose bonds all crush carries pi/4 of bond_crushing
    in the plane, 2/3 in space. Bonds crush before and after they break; contacts between particles that have parted
    do not.

    Without a shear energy, slip does not damage, and c = 1 - omega: this is the published part of YADE's concrete model
    (Law2_ScGeom_CpmPhys_Cpm, damLaw 0), which carries it in C++. But 1 - omega is the part of the stiffness that is
    left: it falls to a tenth while most of the tensile strength is still there, and cohesion goes for little work.

    With a shear energy G2, c = (uf - u)/(uf - u0) = (1 - omega)/(1 - (1 - u0/uf) omega) is the part of the tensile
    strength that is left, which falls in a line from 1 to 0 as the bond opens, and slip by ds lowers it by ds/sf, sf =
    2 G2/Rt: without normal force, shear softens linearly with the displacement, and breaking a bond takes the work G2
    (slip weakening, as of J. R. Rice, 1980); under pressure, friction takes more beside it. At c = 0 the bond is
    broken, and Coulomb friction remains. The work to break it in tension is G. engines.cpm_bonds adds this to YADE's
    model. (Its equivStrainShearContrib lets shear drive the damage by strain: friction alone would then break a bond
    under pressure, and it is left at 0.)

    kn, kt  N/m, > 0      mu  friction within the bond and after breakage, >= 0
    bond_tension, bond_cohesion  Pa, bond_fracture_energy (G)  J/m2, all > 0: of a bond that stands for 1 m2 of crack,
    see Coulomb; a low cohesion does not cut the tension here. bond_shear_energy (G2)  J/m2; 0: slip does not damage.
    bond_crushing (Rc)  Pa; 0: nothing crushes. crushing_hardening (h)  slope over kn against what stays, 0 to 1.
    bond_tension_power, bond_cohesion_power  a rock of coarser discs of the same energies is more brittle, as G kn/(Rn^2
    r) falls with the radius r, and weaker: strengths that grow with so many powers of r keep those of the rock
    (calibration/results/rock_laws.md).
    Elastic energies Rn^2/(2 kn) and Rt^2/(2 kt) are lower bounds of G and G2, of bonds that crush twice the former.
    Raises ParameterError.
    """

    name = "cohesive"
    by_area = True
    yade_law = "Cpm"
    parameters = (KN, KT, TENSION, COHESION,
                  Parameter("bond_fracture_energy", 30.0, "J/m2", plausible(1e-4, 1e6),
                            "work to break a bond in tension, over its area"),
                  Parameter("bond_shear_energy", 0.0, "J/m2", zero_or(1e-2, 1e6),
                            "work to break a bond in shear without normal force, over its area; 0: slip does not "
                            "damage bonds"),
                  Parameter("bond_crushing", 0.0, "Pa", zero_or(1e4, 1e12),
                            "compression at which grains crush, over a bond's area; 0: never"),
                  Parameter("crushing_hardening", 0.05, "", zero_or(1e-4, 1),
                            "slope of the crushing strength over what a bond is shorter, over kn"),
                  Parameter("bond_tension_power", 0.0, "", number(-2, 2),
                            "power of the radius with which bond_tension grows where discs are coarser"),
                  Parameter("bond_cohesion_power", 0.0, "", number(-2, 2),
                            "power of the radius with which bond_cohesion grows where discs are coarser"), MU)

    def __init__(self, *, kn, kt, bond_tension, bond_cohesion, bond_fracture_energy, mu, bond_shear_energy=0.0,
                 bond_crushing=0.0, crushing_hardening=0.05, bond_tension_power=0.0, bond_cohesion_power=0.0):
        super().__init__(kn=kn, kt=kt, Rn=positive("bond_tension", bond_tension, "Pa"),
                         Rt=positive("bond_cohesion", bond_cohesion, "Pa"), H=math.inf, mu=mu)
        self.end = 2 * positive("bond_fracture_energy", bond_fracture_energy, "J/m2") / self.Rn
        energy = not_negative("bond_shear_energy", bond_shear_energy, "J/m2")
        self.end_of_slip = 2 * energy / self.Rt if energy else math.inf
        self.Rc = not_negative("bond_crushing", bond_crushing, "Pa") or math.inf
        self.hardening = within("crushing_hardening", crushing_hardening, 0, 1)
        self.powers = finite("bond_tension_power", bond_tension_power), finite("bond_cohesion_power",
                                                                               bond_cohesion_power)

    def scaled(self, factor):
        law = super().scaled(factor)
        law.Rc = self.Rc * factor
        return law

    def coarser(self, ratio):
        law = self.scaled(1.0)
        tension, cohesion = (ratio**power for power in self.powers)
        law.Rn, law.end = self.Rn * tension, self.end / tension
        law.Rt, law.end_of_slip = self.Rt * cohesion, self.end_of_slip / cohesion
        return law

    def unbreakable(self, *, kn, kt):
        """The law of a bond of this size within a grain: it crushes, and does not break. kn, kt: N/m."""
        law = self.scaled(1.0)
        law.kn, law.kt, law.Rn, law.Rt, law.end_of_slip = kn, kt, UNBREAKABLE, UNBREAKABLE, math.inf
        return law

    @property
    def onset(self):
        """Opening (m) at the peak."""
        return self.Rn / self.kn

    @property
    def gone(self):
        """Opening (m) at which the bond is broken."""
        return max(self.end, (BRITTLEST if self.Rc == math.inf else CRUSHING) * self.onset)

    @property
    def slip_end(self):
        """Slip (m) that takes all of the cohesion."""
        return max(self.end_of_slip, BRITTLEST * self.Rt / self.kt)

    def fracture_energy(self):
        """(J to break the bond in pure tension, J in pure shear: math.inf if it slips for ever)."""
        return 0.5 * self.Rn * self.gone, 0.5 * self.Rt * self.slip_end

    @property
    def coupling(self):
        """q in c = (1 - omega)/(1 - q omega): 1 - u0/uf, so that c is the part of the strength, or 0 for that of the
        stiffness."""
        return 0.0 if self.slip_end == math.inf else 1.0 - self.onset / self.gone

    def strength_left(self, softening):
        """Part c of the cohesion that is left to a bond of this omega."""
        return (1.0 - softening) / (1.0 - self.coupling * softening)

    def slipped(self, softening, slip):
        """omega, from `softening` on, after so much slip (m); 1 where none of the cohesion is left."""
        left = max(self.strength_left(softening) - slip / self.slip_end, 0.0)
        return (1.0 - left) / (1.0 - self.coupling * left)

    def shear_limit(self, softening, Fn):
        """|Ft| (N) at which a bond of this omega slips under the normal force Fn (N)."""
        return max(self.strength_left(softening) * self.Rt - self.mu * Fn, 0.0)

    def crushing_force(self, un_plastic):
        """N at which a bond that is shorter by -un_plastic (m) for good crushes on."""
        return self.Rc - self.hardening * self.kn * un_plastic

    def _normal(self, bond, un):
        if self.kn * (un - bond.un_plastic) < -self.crushing_force(bond.un_plastic):
            bond.un_plastic = (un + self.Rc / self.kn) / (1.0 + self.hardening)
        return super()._normal(bond, un)

    def _bonded(self, bond, un, ut):
        omega, u0, opening = bond.softening, self.onset, un - bond.un_plastic
        if opening > u0:
            omega = max(omega, (1.0 - u0 / opening) / (1.0 - u0 / self.gone))
            if omega >= 1.0:
                return None
            bond.softening = omega
        Fn = self._normal(bond, un) * (1.0 - omega if opening > 0.0 else 1.0)
        Ft = self._shear(bond, Fn, ut)
        norm, limit = math.hypot(*Ft), self.shear_limit(omega, Fn)
        if norm > limit:
            # The limit falls with the slip, but not below zero.
            slip = min((norm - limit) / (self.kt - self.Rt / self.slip_end), norm / self.kt)
            omega = self.slipped(omega, slip)
            if omega >= 1.0:
                return None
            bond.softening = omega
            Ft = self._slip(bond, ut, Ft, 1.0 - self.kt * slip / norm)
        return Fn, Ft

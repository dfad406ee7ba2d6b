"""Elasto-plastic bond with nonlinear hardening or softening: the Padova model."""
import math

from rockwear.kernels.bond_laws.base import _ORIGIN, KN, MU, RN, Bond, BondLaw
from rockwear.kernels.bond_laws.hardening import Hyperbolic, Parabolic
from rockwear.kernels.checks import finite, not_negative, positive, require
from rockwear.kernels.parameter import Parameter, above_zero, number

COMPRESSION = 100.0
"""Compression over tensile strength up to which `stiffest` bounds the shear stiffness."""


class HardeningBond(Bond):
    """State of a bond of NonlinearElastoPlastic.

    alpha_n, alpha_c, alpha_t  plastic displacement in tension, compression and shear, m; they never fall
    kt, ut_last                tangential stiffness (N/m) and displacement (m, tuple) at the last step
    """

    __slots__ = ("alpha_n", "alpha_c", "alpha_t", "kt", "ut_last")
    scalars = (*Bond.scalars, "alpha_n", "alpha_c", "alpha_t", "kt")
    vectors = ("ut_plastic", "ut_last")

    def __init__(self, kt):
        super().__init__()
        self.alpha_n = self.alpha_c = self.alpha_t = 0.0
        self.kt, self.ut_last = kt, _ORIGIN

    def turned(self, ut, increment):
        super().turned(ut, increment)
        self.ut_last = tuple([u - du for u, du in zip(ut, increment)])


class NonlinearElastoPlastic(BondLaw):
    """Elasto-plastic bond with nonlinear hardening or softening, the Padova model [Rojek 2003, eqs 4.7-4.15].

        tension      Fn   <= Rn + tension(alpha_n)
        compression -Fn   <= Rc + compression(alpha_c)
        shear        |Ft| <= eta (c - Fn) + shear(alpha_t)       (eqs 4.12, 4.14; compression strengthens)
        stiffness    kn,  kt = m cbrt(||Fn| - r|)                (eq. 4.13)

    Normal and shear flow are separate (eq. 4.15), the shear return is radial at the normal force of the step. r < 0
    makes kt rise with |Fn| throughout; with r > 0 it first falls, to zero at |Fn| = r.

    Read literally, Ft = kt(Fn) (ut - ut_plastic) creates energy: shear first, compress after, and unloading returns
    more than was put in. So a rising kt acts on the further displacement only (ut_plastic follows), while a falling kt
    acts on all of it; neither creates energy. The elastic force is exact on straight paths along which kt is monotone.
    Yielding is exact in tension, in compression, and in shear under constant Fn; where Fn and slip change together the
    error is of the order of the step.

    The bond breaks when its resistance in tension has fallen to zero, or when yielding has brought its resistance in
    shear down to mu |Fn|. Compression only hardens, and its plastic displacement remains in the contact.

    kn   N/m, > 0        m  N^(2/3)/m, > 0        r  N       Rn, Rc  N, > 0 (Rc may be math.inf)
    eta  >= 0            c  N, > 0                mu  friction after breakage, >= 0
    tension, compression  Parabolic               shear  Parabolic or Hyperbolic
    The sources give no numbers. The defaults are a bond of the strength and stiffness of [Rojek 2003, 4.6].
    Raises ParameterError.

    `parameters` offer linear softening, H(alpha) = b2 alpha, in tension and shear, and no yield in compression.
    """

    name = "padova"
    parameters = (
        KN, RN, MU,
        Parameter("padova_m", 2e8, "N^(2/3)/m", above_zero, "m of the tangential stiffness kt = m cbrt(||Fn| - r|), "
                  "9.3e9 N/m at Fn = 0", "ours: a bond of [Rojek 2003, 4.6]; eq. 4.13", size_power=(-1 / 3, 1 / 3)),
        Parameter("padova_r", -1e5, "N", number(), "r of the tangential stiffness; below 0: any normal force stiffens",
                  "ours: -Rn; [Rojek 2003, eq. 4.13]", size_power=(1, 2)),
        Parameter("padova_eta", 0.8, "", above_zero, "eta of the shear strength eta (c - Fn)",
                  "ours; [Rojek 2003, eq. 4.12]"),
        Parameter("padova_cohesion", 1.25e5, "N", above_zero, "c of the shear strength; eta c is its value at Fn = 0",
                  "ours: eta c = Rn, as in [Rojek 2003, 4.6]; eq. 4.12", size_power=(1, 2)),
        Parameter("padova_tension_b2", -5e9, "N/m", number(high=0.0), "slope of the tensile strength against plastic "
                  "opening; below 0: softening", "ours; [Rojek 2003, eq. 4.9]", size_power=(0, 1)),
        Parameter("padova_shear_b2", -5e9, "N/m", number(high=0.0), "slope of the shear strength against plastic slip; "
                  "below 0: softening", "ours; [Rojek 2003, eq. 4.9]", size_power=(0, 1)),
    )

    def __init__(self, *, kn=2e10, m=2e8, r=-1e5, eta=0.8, c=1.25e5, Rn=1e5, Rc=math.inf, tension=Parabolic(b2=-5e9),
                 compression=Parabolic(), shear=Parabolic(b2=-5e9), mu=0.8):
        super().__init__(kn=kn, mu=mu)
        self.m = positive("m", m, "N^(2/3)/m")
        self.r = finite("r", r, "N")
        self.eta = not_negative("eta", eta)
        self.c = positive("c", c, "N")
        self.Rn = positive("Rn", Rn, "N")
        self.Rc = math.inf if Rc == math.inf else positive("Rc", Rc, "N")
        for name, hardening, forms in (("tension", tension, Parabolic), ("compression", compression, Parabolic),
                                       ("shear", shear, (Parabolic, Hyperbolic))):
            require(isinstance(hardening, forms), name, type(hardening).__name__, "Parabolic, or Hyperbolic in shear")
        require(compression.b1 >= 0.0 and compression.b2 >= 0.0, "compression",
                f"b1 = {compression.b1:g} N/m^2, b2 = {compression.b2:g} N/m", "hardening (neither below 0)")
        for name, start in (("Rn + tension.b3", self.Rn + tension(0.0)), ("Rc + compression.b3",
                            self.Rc + compression(0.0)), ("eta c + shear.b3", self.eta * self.c + shear(0.0))):
            require(start > 0.0, name, start, "greater than 0", "N")
        self.tension, self.compression, self.shear = tension, compression, shear
        self.kt, self.Rt = self._stiffness(0.0), self.eta * self.c + shear(0.0)

    @classmethod
    def from_values(cls, values):
        return cls(kn=values["kn"], Rn=values["Rn"], mu=values["mu"], m=values["padova_m"], r=values["padova_r"],
                   eta=values["padova_eta"], c=values["padova_cohesion"],
                   tension=Parabolic(b2=values["padova_tension_b2"]), shear=Parabolic(b2=values["padova_shear_b2"]))

    def scaled(self, factor):
        return NonlinearElastoPlastic(
            kn=self.kn, m=self.m / factor ** (1.0 / 3.0), r=self.r * factor, eta=self.eta, c=self.c * factor,
            Rn=self.Rn * factor, Rc=self.Rc * factor, tension=self.tension.scaled(factor),
            compression=self.compression.scaled(factor), shear=self.shear.scaled(factor), mu=self.mu)

    def stiffest(self):
        """(kn, kt), N/m: kn, and the largest kt at normal forces up to F = COMPRESSION times Rn, or Rc if larger.

        With Rc = inf compression has no limit, and kt grows with its cube root: ten times F would give 2.2 times kt.
        """
        largest = max(COMPRESSION * self.Rn, self.Rc if self.Rc < math.inf else 0.0)
        return self.kn, max(self._stiffness(0.0), self._stiffness(largest))

    def initial_state(self):
        """State of a new bond, free of stress."""
        return HardeningBond(self.kt)

    def _stiffness(self, Fn):
        return self.m * abs(abs(Fn) - self.r) ** (1.0 / 3.0)

    def _shear(self, bond, Fn, ut):
        """As BondLaw._shear, at the normal force Fn; keeps kt in the bond."""
        before, kt = bond.kt, self._stiffness(Fn)
        if kt > before:
            # Mean of a cube root between its end values: the integral of kt over a step with Fn linear in ut.
            mean = 0.75 * (before + kt) * (before * before + kt * kt) / (before * before + before * kt + kt * kt)
            Ft = tuple([before * (last - p) + mean * (u - last)
                        for last, p, u in zip(bond.ut_last, bond.ut_plastic, ut)])
            bond.ut_plastic = tuple([u - f / kt for u, f in zip(ut, Ft)])
        else:
            Ft = tuple([kt * (u - p) for u, p in zip(ut, bond.ut_plastic)])
        bond.kt, bond.ut_last = kt, tuple(ut)
        return Ft

    def _bonded(self, bond, un, ut):
        Fn = self.kn * (un - bond.un_plastic)
        if Fn > self.Rn + self.tension(bond.alpha_n):
            step = self.tension.flow(Fn - self.Rn - self.tension(bond.alpha_n), self.kn, bond.alpha_n)
            if step is None or self.Rn + self.tension(bond.alpha_n + step) <= 0.0:
                return None
            bond.alpha_n += step
            bond.un_plastic += step
            Fn -= self.kn * step
        elif -Fn > self.Rc + self.compression(bond.alpha_c):
            step = self.compression.flow(-Fn - self.Rc - self.compression(bond.alpha_c), self.kn, bond.alpha_c)
            bond.alpha_c += step
            bond.un_plastic -= step
            Fn += self.kn * step

        Ft = self._shear(bond, Fn, ut)
        kt = bond.kt
        norm, threshold = math.hypot(*Ft), self.eta * (self.c - Fn) + self.shear(bond.alpha_t)
        if norm > max(threshold, 0.0):
            step = self.shear.flow(norm - threshold, kt, bond.alpha_t)
            if step is None or norm - kt * step <= self.mu * max(-Fn, 0.0):
                return None
            bond.alpha_t += step
            Ft = self._slip(bond, ut, Ft, 1.0 - kt * step / norm)
        return Fn, Ft

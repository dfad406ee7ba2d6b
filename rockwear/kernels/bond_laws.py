"""Force laws of one cohesive bond between two particles (M ch. 4).

M is the monograph M87, chapter 4; equation numbers are its own. Units are SI. Opening and tension are positive.

Every law is used contact by contact, with a small state that belongs to the bond::

    bond = law.initial_state()
    Fn, Ft = law.respond(bond, un, ut)      # at every step; changes `bond`

`un` is the total opening (float, m) since the bond was made and `ut` the total tangential displacement (1 to 3 floats,
m), which the caller accumulates and turns with the contact; the vectors named in `bond.vectors` must be turned with it.
`Ft` is a tuple as long as `ut` and points along the elastic part of `ut`. The arithmetic is on plain floats because the
engine calls it for some hundred contacts at every step, where numpy would spend its time on bookkeeping.

What all laws share: a initial_state bond is free of stress and answers Fn = kn un, Ft = kt ut. Once it is gone there remains
a unilateral contact with Coulomb friction (4.5-4.6), on the same reference as the bond: Fn = kn un for un < 0 and 0
otherwise; the tangential spring continues where the bond left it, slips radially at |Ft| = mu |Fn|, and forgets
everything when the contact opens. A bond goes only while it is yielding: compression alone never ends one, however
large mu |Fn| grows, because nothing in the bond has slipped.
"""
import math
from collections import namedtuple

import numpy as np

from rockwear.kernels.checks import finite, not_negative, positive, require

_ORIGIN = (0.0, 0.0, 0.0)
_HAIR = 1e-12
"""Width of a elastic_domain that is to trip as soon as a force changes its sign, as a fraction of the strength."""

_NARROW = 1e-3
"""Room in a elastic_domain, as a fraction of the strength, that is not worth having one."""

ElasticDomain = namedtuple("ElasticDomain", "kn kt Fn Ft slope", defaults=(0.0,))
"""Where a bond is linear elastic: as long as its normal force is at most Fn and its shear force at most
Ft + slope * (normal force), its forces are kn (un - un_plastic), kt (ut - ut_plastic) with constant kn, kt (N/m)."""


class Bond:
    """State of one bond; `BondLaw.initial_state` makes it, `BondLaw.respond` changes it.

    softening    0 in a initial_state bond, 1 in a broken one, never falls: the damage omega, or 1 - size of the yield surface
    un_plastic   opening at which the normal force is zero, m
    ut_plastic   tangential displacement at which the tangential force is zero, m (tuple)
    """

    __slots__ = ("softening", "un_plastic", "ut_plastic")
    scalars = ("softening", "un_plastic")
    vectors = ("ut_plastic",)

    def __init__(self):
        self.softening = 0.0
        self.un_plastic = 0.0
        self.ut_plastic = _ORIGIN  # cut to the length of ut by the first zip that meets it

    @property
    def broken(self):
        """True once only a frictional contact is left."""
        return self.softening >= 1.0

    def turned(self, ut, increment):
        """Count ut anew, from where Ft vanishes: for an engine that keeps the elastic part of ut and turns it.

        The next `respond` will get this ut, of which `increment` (3 floats, m, both) is new since the last one.
        """
        self.ut_plastic = _ORIGIN


class BondLaw:
    """What every law shares: the contact after breakage, the stored energy, the walk along a path.

    A law adds `_bonded(bond, un, ut)`, which returns (Fn, Ft), or None where the bond goes in this step;
    `_shear(bond, Fn, ut)`, the tangential force as long as nothing slips; `scaled(factor)`; `elastic_domain(bond, Fn, Ft)`
    if it has one; and the attributes kt (N/m), Rn and Rt (N): shear stiffness and strengths of a initial_state bond.
    """

    def __init__(self, *, kn, mu):
        self.kn = positive("kn", kn, "N/m")
        self.mu = not_negative("mu", mu)

    def initial_state(self):
        """State of a new bond, free of stress."""
        return Bond()

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """ElasticDomain around the forces of the last step: Fn (N), and Ft (N), the length of the tangential one.

        None where there is no room for one: Fn and Ft are at the limit of what is elastic, or nothing is linear.
        """
        return None

    def respond(self, bond, un, ut):
        """Forces of `bond` at the opening `un` (m) and the tangential displacement `ut` (sequence of 1 to 3 floats, m).

        Returns (Fn, Ft): N, and a tuple of N as long as `ut`. Changes `bond`. No checks: this is the inner loop.
        """
        if bond.softening < 1.0:
            forces = self._bonded(bond, un, ut)
            if forces is not None:
                return forces
            bond.softening = 1.0
            # The contact starts at the bond's first touch, or deeper where compression left a dent.
            bond.un_plastic = min(bond.un_plastic, 0.0)
        return self._contact(bond, un, ut)

    def stored_energy(self, bond, un, ut, Fn, Ft):
        """Elastic energy (J) that the forces (Fn, Ft) just returned by `respond` would give back on unloading.

        (Fn un_e + Ft . ut_e)/2 with the displacements counted from where each force vanishes. Work done on the bond
        minus this is what it dissipated.
        """
        shear = sum([f * (u - p) for f, u, p in zip(Ft, ut, bond.ut_plastic)])
        return 0.5 * (Fn * (un - bond.un_plastic) + shear)

    def drive(self, un, ut):
        """Lead a initial_state bond along a path.

        un, ut  total relative displacements, m; 1-D arrays of one length; opening is positive
        returns (Fn, Ft), N; arrays of the same length; tension is positive, Ft has the sign of the elastic ut
        raises  ParameterError for arrays of another shape or values that are not finite
        """
        un, ut = np.asarray(un, dtype=float), np.asarray(ut, dtype=float)
        require(un.ndim == 1, "un", f"array of shape {un.shape}", "one-dimensional", "m")
        require(ut.shape == un.shape, "ut", f"array of shape {ut.shape}", f"of the shape {un.shape} of un", "m")
        for name, path in (("un", un), ("ut", ut)):
            require(np.isfinite(path).all(), name, "array with nan or inf", "finite", "m")
        bond = self.initial_state()
        Fn, Ft = np.empty_like(un), np.empty_like(ut)
        for step, (opening, shift) in enumerate(zip(un.tolist(), ut.tolist())):
            Fn[step], (Ft[step],) = self.respond(bond, opening, (shift,))
        return Fn, Ft

    def _contact(self, bond, un, ut):
        """Unilateral contact with Coulomb friction (4.5-4.6); open is the case Fn = 0, where all shear is slip."""
        Fn = min(self.kn * (un - bond.un_plastic), 0.0)
        Ft = self._shear(bond, Fn, ut)
        norm, limit = math.hypot(*Ft), self.mu * abs(Fn)
        if norm > limit:
            Ft = self._slip(bond, ut, Ft, limit / norm)
        return Fn, Ft

    @staticmethod
    def _slip(bond, ut, Ft, kept):
        """Radial return: keep the fraction `kept` of the elastic tangential displacement, slip by the rest."""
        bond.ut_plastic = tuple([u - kept * (u - p) for u, p in zip(ut, bond.ut_plastic)])
        return tuple([kept * f for f in Ft])


class LinearBondLaw(BondLaw):
    """Laws with constant stiffness, a strength in each direction, and linear softening.

    kn, kt  stiffness, N/m      Rn, Rt  strength in tension and shear, N      mu  friction once the bond is gone
    H       slope of the fall after the peak against *total* displacement, N/m; math.inf is brittle. In tension the
            peak is at Rn/kn and the end at Rn/kn + Rn/H, in shear the same with Rt, kt (M fig. 4.11, 4.19).
    """

    def __init__(self, *, kn, kt, Rn, Rt, H, mu):
        super().__init__(kn=kn, mu=mu)
        self.kt = positive("kt", kt, "N/m")
        self.Rn = positive("Rn", Rn, "N")
        self.Rt = positive("Rt", Rt, "N")
        self.H = math.inf if H == math.inf else positive("H", H, "N/m")

    def scaled(self, factor):
        """The law of a bond `factor` times as strong: forces and displacements grow alike, every slope stays."""
        law = type(self).__new__(type(self))
        vars(law).update(vars(self), Rn=self.Rn * factor, Rt=self.Rt * factor)
        return law

    def fracture_energy(self):
        """Work (J) until the bond is gone in pure tension and in pure shear: R^2/(2k) + R^2/(2H), with its k and R."""
        return tuple(0.5 * R * R * (1.0 / k + 1.0 / self.H) for k, R in ((self.kn, self.Rn), (self.kt, self.Rt)))

    def _shear(self, bond, Fn, ut):
        """Elastic tangential force, if nothing slips in this step."""
        kt = self.kt
        return tuple([kt * (u - p) for u, p in zip(ut, bond.ut_plastic)])


class ElasticBrittle(LinearBondLaw):
    """Elastic perfectly brittle bond (M 4.1, eqs 4.1-4.6): gone at once when Fn > Rn or |Ft| > Rt.

    kn, kt  N/m, > 0      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    Raises ParameterError.
    """

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


class ElasticDamage(LinearBondLaw):
    """Elastic damage with linear softening (M 4.4, eqs 4.17-4.19).

    Fn = (1 - omega) kn un in tension, kn un in compression; Ft = (1 - omega) kt ut. One omega serves both directions:
    the largest value so far of omega(un; kn, Rn) and omega(|ut|; kt, Rt), where (4.18-4.19) put the force on the line
    R - H (u - R/k). Since both grow with the distance from the origin, a path sampled at its corners gives the forces
    of the same path sampled finely. H -> inf is ElasticBrittle on every path.

    At omega = 1 the bond is gone (the text of M 4.4 says omega = 0). Under compression it is gone earlier, when damage
    driven by shear brings its force down to mu |Fn|, as in the elasto-plastic law: the sources leave this open, and
    otherwise a cracked bond would carry less shear than the same two faces unbonded. The contact takes over the force
    that the bond had, not the larger one of an undamaged spring.

    kn, kt, H  N/m, > 0 (H may be math.inf)      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    tension_only  only opening drives omega; shear alone then never breaks the bond
    Raises ParameterError.
    """

    def __init__(self, *, kn, kt, Rn, Rt, H, mu, tension_only=False):
        super().__init__(kn=kn, kt=kt, Rn=Rn, Rt=Rt, H=H, mu=mu)
        require(tension_only in (True, False), "tension_only", tension_only, "True or False")
        self.tension_only = bool(tension_only)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """As far as damage does not grow. A damaged bond opens softer than it closes, so that its domain ends where Fn
        changes its sign; in tension a slope does that: no shear at Fn = 0, both limits at once at the far end. Where
        only tension damages, the shear of a damaged bond is without bounds, and without a domain."""
        left = 1.0 - bond.softening
        limit_n, limit_t = left * self._onset(bond, self.kn, self.Rn), left * self._onset(bond, self.kt, self.Rt)
        if bond.softening == 0.0:
            domain = ElasticDomain(self.kn, self.kt, limit_n, limit_t)
        elif self.tension_only:
            return None
        elif Fn <= 0.0:
            domain = ElasticDomain(self.kn, left * self.kt, _HAIR * self.Rn, limit_t)
        else:
            domain = ElasticDomain(left * self.kn, left * self.kt, limit_n, _HAIR * self.Rt, limit_t / limit_n)
        return domain if Fn < domain.Fn and Ft < domain.Ft + domain.slope * max(Fn, 0.0) else None

    def _onset(self, bond, k, R):
        """Force of an undamaged spring at which damage goes on: (4.18-4.19) solved for it."""
        return R / (1.0 - bond.softening / (1.0 + self.H / k))

    def _damage(self, force, k, R):
        """omega of (4.18-4.19) where an undamaged spring would carry `force`."""
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


class ElastoPlasticSoftening(LinearBondLaw):
    """Elasto-plastic bond with linear softening (M 4.3, eq 4.16).

    Fn = kn (un - un_plastic), Ft = kt (ut - ut_plastic): it unloads with the elastic stiffness. Yield, with the size q
    falling from 1 to 0:

        tension      (Fn/Rn)^2 + (|Ft|/Rt)^2 = q^2
        compression   |Ft| = q Rt, and Fn stays elastic

    Flow is radial in the plane (Fn/Rn, Ft/Rt): force and plastic displacement keep the direction of the trial force, so
    M's resultant reaches the strength while both components stay below. The size falls by

        dq = -hypot(dun_plastic/wn, |dut_plastic|/wt),      w = R/k + R/H,

    which in one direction is (4.16) with the plastic modulus H' = H k/(k + H), so that H is the slope against total
    displacement. The step is implicit and solved exactly: on
    a proportional path, and on any path in one direction, one long step gives the force of many short ones; elsewhere
    the error is of the order of the step.

    In tension the bond is gone at q = 0. Under compression it is gone when yielding has brought q Rt down to mu |Fn|.
    A bond drawn out by un_plastic > 0 loses that shift when it goes, since contact begins where the faces first met.
    H -> inf is ElasticBrittle in tension, in shear and in shear with compression; in shear with tension an ellipse
    takes the place of its rectangle.

    kn, kt, H  N/m, > 0 (H may be math.inf)      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    Raises ParameterError.
    """

    def __init__(self, *, kn, kt, Rn, Rt, H, mu):
        super().__init__(kn=kn, kt=kt, Rn=Rn, Rt=Rt, H=H, mu=mu)
        # (R/k)/w = H/(H + k), in the form that H = inf leaves finite.
        self._loss_n, self._loss_t = 1.0 / (1.0 + self.kn / self.H), 1.0 / (1.0 + self.kt / self.H)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """Of the rectangles in the ellipse the one whose corner is as many N from Fn as from Ft; under compression too
        strong for that, all of the shear strength and next to no tension."""
        size, u, v = 1.0 - bond.softening, self.Rn, self.Rt
        corner = _NARROW * size * u
        # ((Fn + m)/u)^2 + ((Ft + m)/v)^2 = size^2, times (u v)^2
        a, b = u * u + v * v, Fn * v * v + Ft * u * u
        root = a * (size * u * v) ** 2 - (u * v * (Fn - Ft)) ** 2
        if root > 0.0:
            corner = max(corner, Fn + (math.sqrt(root) - b) / a)
        limit_t = v * math.sqrt(max(size * size - (corner / u) ** 2, 0.0))
        domain = ElasticDomain(self.kn, self.kt, corner, limit_t)
        room = _NARROW * size
        return domain if Fn < corner - room * u and Ft < limit_t - room * v else None

    def _bonded(self, bond, un, ut):
        Fn = self.kn * (un - bond.un_plastic)
        Ft = self._shear(bond, Fn, ut)
        x, y = max(Fn, 0.0) / self.Rn, math.hypot(*Ft) / self.Rt
        trial, size = math.hypot(x, y), 1.0 - bond.softening
        if trial <= size:
            return Fn, Ft

        # Radial return to the new size q: the fall size - q is (trial - q) loss, so fall (1 - loss) = excess loss.
        cos, sin = x / trial, y / trial
        loss = math.hypot(cos * self._loss_n, sin * self._loss_t)
        rest = max(1.0 - loss, 0.0)  # 0 where H = inf: compare before dividing
        fall = (trial - size) * loss
        if size * rest - fall <= rest * self.mu * max(-Fn, 0.0) / self.Rt:
            return None
        size -= fall / rest
        bond.softening = 1.0 - size
        kept = size / trial
        if Fn > 0.0:
            bond.un_plastic = un - kept * (un - bond.un_plastic)
            Fn *= kept
        return Fn, self._slip(bond, ut, Ft, kept)


class Parabolic:
    """Change of a yield force with plastic displacement, H(alpha) = b1 alpha^2 + b2 alpha + b3 (4.9), N.

    b1  N/m^2      b2  N/m      b3  N.      Softening must not turn into hardening, so b1 > 0 needs b2 >= 0.
    Raises ParameterError.
    """

    def __init__(self, *, b1=0.0, b2=0.0, b3=0.0):
        self.b1, self.b2, self.b3 = finite("b1", b1, "N/m^2"), finite("b2", b2, "N/m"), finite("b3", b3, "N")
        require(self.b1 <= 0.0 or self.b2 >= 0.0, "b1", self.b1, "at most 0 where b2 < 0", "N/m^2")

    def __call__(self, alpha):
        return (self.b1 * alpha + self.b2) * alpha + self.b3

    def scaled(self, factor):
        """The same curve, `factor` times as large along both axes."""
        return Parabolic(b1=self.b1 / factor, b2=self.b2, b3=self.b3 * factor)

    def flow(self, excess, k, alpha):
        """Smallest plastic step g (m) that clears `excess` (N): excess - k g = H(alpha + g) - H(alpha).

        None where the yield force falls faster than the elastic force can: the bond snaps.
        """
        slope = k + self.b2 + 2.0 * self.b1 * alpha
        root = slope * slope + 4.0 * self.b1 * excess
        return 2.0 * excess / (slope + math.sqrt(root)) if slope > 0.0 and root >= 0.0 else None


class Hyperbolic:
    """Hardening of the shear yield force, H(alpha) = b1 alpha^d / (b2 + b3 alpha^d) (4.10), N; rises to b1/b3.

    b1  N, >= 0      b2  m^d, > 0      b3  >= 0      d  > 0
    Raises ParameterError.
    """

    def __init__(self, *, b1, b2, b3, d=1.0):
        self.b1, self.b2, self.b3 = not_negative("b1", b1, "N"), positive("b2", b2, "m^d"), not_negative("b3", b3)
        self.d = positive("d", d)

    def __call__(self, alpha):
        power = alpha ** self.d
        return self.b1 * power / (self.b2 + self.b3 * power)

    def scaled(self, factor):
        """The same curve, `factor` times as large along both axes."""
        return Hyperbolic(b1=self.b1 * factor, b2=self.b2 * factor ** self.d, b3=self.b3, d=self.d)

    def flow(self, excess, k, alpha):
        """Plastic step g (m) that clears `excess` (N): excess - k g = H(alpha + g) - H(alpha)."""
        start, low, high = self(alpha), 0.0, excess / k
        while low < (middle := 0.5 * (low + high)) < high:  # halve until no float is left between
            if excess - k * middle > self(alpha + middle) - start:
                low = middle
            else:
                high = middle
        return middle


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
    """Elasto-plastic bond with nonlinear hardening or softening, the Padova model (M 4.2, eqs 4.7-4.15).

        tension      Fn   <= Rn + tension(alpha_n)
        compression -Fn   <= Rc + compression(alpha_c)
        shear        |Ft| <= eta (c - Fn) + shear(alpha_t)       (4.12, 4.14; compression strengthens)
        stiffness    kn,  kt = m cbrt(||Fn| - r|)                (4.13)

    Normal and shear flow are separate (4.15), the shear return is radial at the normal force of the step. r < 0 makes
    kt rise with |Fn| throughout; with r > 0 it first falls, to zero at |Fn| = r.

    Read literally, Ft = kt(Fn) (ut - ut_plastic) gives energy away: shear first, compress after, and unloading returns
    more than was put in. So a rising kt acts on the further displacement only (ut_plastic follows), while a falling kt
    acts on all of it; neither creates energy. The elastic force is exact on straight paths along which kt is monotone.
    Yielding is exact in tension, in compression, and in shear under constant Fn; where Fn and slip change together the
    error is of the order of the step.

    The bond is gone when its resistance in tension has fallen to zero, or when yielding has brought its resistance in
    shear down to mu |Fn|. Compression only hardens, and its dent remains in the contact.

    kn   N/m, > 0        m  N^(2/3)/m, > 0        r  N       Rn, Rc  N, > 0 (Rc may be math.inf)
    eta  >= 0            c  N, > 0                mu  friction after breakage, >= 0
    tension, compression  Parabolic               shear  Parabolic or Hyperbolic
    The sources give no numbers. The defaults are a bond of the strength and stiffness of M 4.6.
    Raises ParameterError.
    """

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
            require(isinstance(hardening, forms), name, type(hardening).__name__, "a hardening function of M 4.2")
        require(compression.b1 >= 0.0 and compression.b2 >= 0.0, "compression",
                f"b1 = {compression.b1:g} N/m^2, b2 = {compression.b2:g} N/m", "hardening (neither below 0)")
        for name, start in (("Rn + tension.b3", self.Rn + tension(0.0)), ("Rc + compression.b3",
                            self.Rc + compression(0.0)), ("eta c + shear.b3", self.eta * self.c + shear(0.0))):
            require(start > 0.0, name, start, "greater than 0", "N")
        self.tension, self.compression, self.shear = tension, compression, shear
        self.kt, self.Rt = self._stiffness(0.0), self.eta * self.c + shear(0.0)

    def scaled(self, factor):
        """The law of a bond `factor` times as strong: forces and displacements grow alike, every slope stays."""
        return NonlinearElastoPlastic(
            kn=self.kn, m=self.m / factor ** (1.0 / 3.0), r=self.r * factor, eta=self.eta, c=self.c * factor,
            Rn=self.Rn * factor, Rc=self.Rc * factor, tension=self.tension.scaled(factor),
            compression=self.compression.scaled(factor), shear=self.shear.scaled(factor), mu=self.mu)

    def initial_state(self):
        """State of a new bond, free of stress."""
        return HardeningBond(self.kt)

    def _stiffness(self, Fn):
        return self.m * abs(abs(Fn) - self.r) ** (1.0 / 3.0)

    def _shear(self, bond, Fn, ut):
        """Elastic tangential force at the normal force Fn, if nothing slips in this step; leaves kt in the bond."""
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


def linear_law(name, *, kn, kt, Rn, Rt, H, mu):
    """The law that scenes know as "brittle", "damage" or "plastic"; H is not used by the first.

    kn, kt  N/m      Rn, Rt  N      H  N/m      Raises ParameterError.
    """
    strength = dict(kn=kn, kt=kt, Rn=Rn, Rt=Rt, mu=mu)
    require(name in LINEAR_LAWS, "bond_law", name, f"one of {', '.join(LINEAR_LAWS)}")
    return ElasticBrittle(**strength) if name == "brittle" else LINEAR_LAWS[name](H=H, **strength)


LINEAR_LAWS = {"brittle": ElasticBrittle, "damage": ElasticDamage, "plastic": ElastoPlasticSoftening}

"""What all bond laws share: the state of a bond, the contact after breakage, the registry of laws.

Units are SI. Opening and tension are positive. Every law is evaluated contact by contact, with a small state of the
bond::

    bond = law.initial_state()
    Fn, Ft = law.respond(bond, un, ut)      # at every step; changes `bond`

`un` is the total opening (float, m) since the bond was made and `ut` the total tangential displacement (1 to 3 floats,
m). The caller accumulates `ut` and rotates it with the contact, and rotates the vectors named in `bond.vectors` with
it. `Ft` is a tuple as long as `ut` and points along the elastic part of `ut`. The arithmetic is on plain floats because
the engine calls it for some hundred contacts at every step, where the overhead of numpy would dominate.

A new bond is free of stress and answers Fn = kn un, Ft = kt ut. After breakage there remains a unilateral contact with
Coulomb friction [Rojek 2003, eqs 4.5-4.6], with the reference of the bond: Fn = kn un for un < 0 and 0 otherwise;
the tangential spring continues with the bond's displacement, slips radially at |Ft| = mu |Fn|, and is reset when the
contact opens. A bond breaks only while it yields: compression alone never breaks one, however large mu |Fn| grows,
because nothing in the bond has slipped.
"""
import math
from abc import ABC, abstractmethod
from collections import namedtuple

import numpy as np

from rockwear.kernels.checks import not_negative, positive, require
from rockwear.kernels.parameter import Parameter, above_zero, stiffness, zero_or

BOND_LAWS = {}
"""{name: class} of all laws."""

KN = Parameter("kn", 20e9, "N/m", stiffness, "normal stiffness of bonds and rock contacts", "[Rojek 2003, 5.1]",
               size_power=(0, 1))
KT = Parameter("kt", 20e9, "N/m", stiffness, "tangential stiffness", "[Rojek 2003, 5.1]", size_power=(0, 1))
RN = Parameter("Rn", 0.1e6, "N", above_zero, "tensile strength of a bond", "[Rojek 2003, 5.1]",
               size_power=(1, 2))
RT = Parameter("Rt", 1e6, "N", above_zero, "shear strength of a bond", "[Rojek 2003, 5.1]", size_power=(1, 2))
SLOPE = Parameter("H", 1e10, "N/m", above_zero, "slope of softening, against total displacement", "[Rojek 2003, 4.6]",
                  size_power=(0, 1))
MU = Parameter("mu", 0.839, "", zero_or(1e-3, 100), "friction between rock particles after breakage",
               "[Rojek 2003, 5.1]")
"""KN to MU: parameters that several laws share."""

_ORIGIN = (0.0, 0.0, 0.0)

ElasticDomain = namedtuple("ElasticDomain", "kn kt Fn Ft slope", defaults=(0.0,))
"""Forces up to which a bond is linear elastic: as long as its normal force is at most Fn and its shear force at most
Ft + slope * (normal force), its forces are kn (un - un_plastic), kt (ut - ut_plastic) with constant kn, kt (N/m)."""


class Bond:
    """State of one bond; `BondLaw.initial_state` makes it, `BondLaw.respond` changes it.

    softening    0 in a new bond, 1 in a broken one, never falls: the damage omega, or 1 - size of the yield surface
    un_plastic   opening at which the normal force is zero, m
    ut_plastic   tangential displacement at which the tangential force is zero, m (tuple)
    """

    __slots__ = ("softening", "un_plastic", "ut_plastic")
    scalars = ("softening", "un_plastic")
    vectors = ("ut_plastic",)

    def __init__(self):
        self.softening = 0.0
        self.un_plastic = 0.0
        self.ut_plastic = _ORIGIN  # the first zip with ut cuts it to the length of ut

    @property
    def broken(self):
        """True once only a frictional contact is left."""
        return self.softening >= 1.0

    def turned(self, ut, increment):
        """Count ut anew, from where Ft vanishes: for an engine that keeps the elastic part of ut and rotates it.

        The next `respond` will get this ut, of which `increment` (3 floats, m, both) is new since the last one.
        """
        self.ut_plastic = _ORIGIN


class BondLaw(ABC):
    """Base of all laws: the contact after breakage, the stored energy, the response along a path.

    A law adds `name` and `parameters`; the abstract methods; `elastic_domain` if it has one; and the attributes kt
    (N/m), Rn and Rt (N): shear stiffness and strengths of a new bond. BOND_LAWS registers every subclass with a name.
    """

    name = None
    parameters = ()
    by_area = False
    """True if the strengths of the law are those of a bond that stands for 1 m2 of crack."""
    linear = False
    """True if the law is linear elastic up to its strength."""
    yade_law = "JCFpm"
    """YADE's law that carries the bonds: "JCFpm" within elastic domains, or "Cpm", its concrete model, all through."""

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        if "name" in vars(cls):
            BOND_LAWS[cls.name] = cls

    def __init__(self, *, kn, mu):
        self.kn = positive("kn", kn, "N/m")
        self.mu = not_negative("mu", mu)

    @classmethod
    def from_values(cls, values):
        """The law with the values of its `parameters`, from {name: value}. Raises ParameterError."""
        return cls(**{parameter.name: values[parameter.name] for parameter in cls.parameters})

    @abstractmethod
    def scaled(self, factor):
        """The law of a bond `factor` times as strong: forces and displacements grow alike, every slope stays."""

    def coarser(self, ratio):
        """The law of bonds over the same area between particles `ratio` times as large: the same, as long as the law
        has no other rule for them."""
        return self

    @abstractmethod
    def stiffest(self):
        """(kn, kt), N/m: upper bounds of the stiffness of a bond and of its contact, for the critical time step."""

    @abstractmethod
    def _bonded(self, bond, un, ut):
        """(Fn, Ft) of a bond that is not broken, or None where it breaks in this step. Changes `bond`."""

    @abstractmethod
    def _shear(self, bond, Fn, ut):
        """Elastic tangential force, if nothing slips in this step."""

    def initial_state(self):
        """State of a new bond, free of stress."""
        return Bond()

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """ElasticDomain around the forces of the last step: Fn (N), and Ft (N), the length of the tangential one.

        None where there is none: Fn and Ft are at the elastic limit, or nothing is linear.
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
            # The contact starts where the bond was made, or deeper where compression left plastic displacement.
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
        """Forces of a new bond along a path.

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
        """Unilateral contact with Coulomb friction [Rojek 2003, eqs 4.5-4.6]; open: Fn = 0, and all shear is slip."""
        Fn = min(self._normal(bond, un), 0.0)
        Ft = self._shear(bond, Fn, ut)
        norm, limit = math.hypot(*Ft), self.mu * abs(Fn)
        if norm > limit:
            Ft = self._slip(bond, ut, Ft, limit / norm)
        return Fn, Ft

    def _normal(self, bond, un):
        """Elastic normal force of a contact after breakage, negative in compression."""
        return self.kn * (un - bond.un_plastic)

    @staticmethod
    def _slip(bond, ut, Ft, kept):
        """Radial return: keep the fraction `kept` of the elastic tangential displacement, slip by the rest."""
        bond.ut_plastic = tuple([u - kept * (u - p) for u, p in zip(ut, bond.ut_plastic)])
        return tuple([kept * f for f in Ft])


class LinearBondLaw(BondLaw):
    """Laws with constant stiffness, a strength in each direction, and linear softening.

    kn, kt  stiffness, N/m      Rn, Rt  strength in tension and shear, N      mu  friction after breakage
    H       slope of the softening after the peak against *total* displacement, N/m; math.inf is brittle. In tension the
            peak is at Rn/kn and the end at Rn/kn + Rn/H, in shear the same with Rt, kt [Rojek 2003, figs 4.11, 4.19].
    """

    linear = True

    def __init__(self, *, kn, kt, Rn, Rt, H, mu):
        super().__init__(kn=kn, mu=mu)
        self.kt = positive("kt", kt, "N/m")
        self.Rn = positive("Rn", Rn, "N")
        self.Rt = positive("Rt", Rt, "N")
        self.H = math.inf if H == math.inf else positive("H", H, "N/m")

    def scaled(self, factor):
        law = type(self).__new__(type(self))
        vars(law).update(vars(self), Rn=self.Rn * factor, Rt=self.Rt * factor)
        return law

    def stronger(self, factor, *, kn, kt):
        """The law of a bond of these stiffnesses (N/m) with `factor` times the strengths: one within a grain that may
        break. Slopes of softening stay, or the displacements at its end where the law has those."""
        law = self.scaled(1.0)
        vars(law).update(kn=kn, kt=kt, Rn=factor * self.Rn, Rt=factor * self.Rt)
        return law

    def stiffest(self):
        """(kn, kt), N/m: the initial stiffness, which neither damage nor plastic flow raises."""
        return self.kn, self.kt

    def fracture_energy(self):
        """Work (J) to break the bond in pure tension and in pure shear: R^2/(2k) + R^2/(2H), with its k and R."""
        return tuple(0.5 * R * R * (1.0 / k + 1.0 / self.H) for k, R in ((self.kn, self.Rn), (self.kt, self.Rt)))

    def _shear(self, bond, Fn, ut):
        kt = self.kt
        return tuple([kt * (u - p) for u, p in zip(ut, bond.ut_plastic)])

"""What all wear laws share, and their registry."""
from abc import ABC, abstractmethod
from copy import copy

import numpy as np

from rockwear.kernels.checks import not_negative, positive, require
from rockwear.kernels.parameter import Parameter, number
from rockwear.kernels.wear_fitting import SILENT, fit_linear

WEAR_LAWS = {}
"""{name: class} of all laws."""

NORMAL, FRICTION = "normal", "friction"
"""The forces a law may ask for: compression, and friction."""
WORK = (FRICTION, 1.0)
"""The sum that is the friction work."""

STEEPEST = 20
"""Largest exponent of a law: forces to higher powers overflow."""

WEAR_COEFFICIENT = Parameter("wear_coefficient", 0.01128, "", number(0, 1e3), "Archard's k",
                             "mean of [Rojek 2003, 6.14-6.15]")
"""A parameter that several laws share."""


class WearLaw(ABC):
    """Base of all laws. A subclass with a name is registered in WEAR_LAWS.

    needs: ((force, exponent), ...), the sums of F^exponent s over the sliding contacts that `volume` takes
    wears: whether anything wears under this law
    """

    name = None
    parameters = ()

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        if "name" in vars(cls):
            WEAR_LAWS[cls.name] = cls

    @classmethod
    @abstractmethod
    def from_values(cls, values, mu):
        """The law with the values of its `parameters`, from {name: value}; mu: the tool's friction.

        Raises ParameterError."""

    @property
    @abstractmethod
    def needs(self):
        """((force, exponent), ...)."""

    @property
    @abstractmethod
    def wears(self):
        """Whether anything wears under this law."""

    @abstractmethod
    def volume(self, slid, hardness, area):
        """Worn volume, m3. slid: {(force, exponent): (n,) N^exponent m}; hardness: Pa; area: m2, 2 r b of each."""

    @abstractmethod
    def rate(self, pressure, hardness):
        """dw/ds (-) of a flat surface under a pressure (Pa) that slides with Coulomb's friction."""

    @abstractmethod
    def scaled(self, factor):
        """The same law with `factor` times its k, for accelerated wear."""

    @abstractmethod
    def depths(self, test):
        """(modes, m) depth (m) in each of the m laboratory tests that each mode would give with k = 1."""

    @abstractmethod
    def error_of(self, test):
        """(m,) relative standard error of the k of each test: p / H stands to the power n in it."""

    @abstractmethod
    def _with(self, k):
        """The same law with these k, one a mode."""

    @np.errstate(**SILENT)
    def fit(self, test):
        """The k of all modes, none negative, by least squares over a LaboratoryTest. -> (law, Fit).

        Raises ParameterError where the tests cannot tell the modes apart: too few of them, or all at one p / H; and
        where they are out of the range of numbers.
        """
        found = fit_linear(self.depths(test), test, self.error_of(test))
        return self._with(found.k), found


class SingleMode(WearLaw):
    """One mode: dw/ds = k (share p / H)^n, with p the pressure, or p_T / mu where `force` is FRICTION.

    k: -, >= 0; mu: Coulomb's coefficient; share: of the friction that is of this mode; exponent: n.
    Raises ParameterError.
    """

    force = NORMAL

    def __init__(self, *, k, mu=1.0, share=1.0, exponent=1.0):
        super().__init__()
        self.k = not_negative("k", k)
        self.mu, self.share = positive("mu", mu), positive("share", share)
        self.exponent = positive("exponent", exponent)
        require(self.exponent <= STEEPEST, "exponent", self.exponent,
                f"at most {STEEPEST}: higher powers of a force overflow")

    @property
    def needs(self):
        return ((self.force, self.exponent),)

    @property
    def wears(self):
        return self.k > 0

    def volume(self, slid, hardness, area):
        n, factor = self.exponent, self.share / self.mu
        return self.k * area * slid[self.force, n] * (factor / (area * np.asarray(hardness, float)))**n

    def rate(self, pressure, hardness):
        return self.k * (self.share * pressure / hardness)**self.exponent

    def scaled(self, factor):
        return self._with([self.k * factor])

    def load(self, test):
        """((m,) p / H of laboratory tests, p_T / mu for p in the friction forms, its relative standard error)."""
        pressure, error = (test.pressure, test.pressure_error) if self.force == NORMAL else (
            test.friction_stress / self.mu, test.friction_error)
        return pressure / test.hardness, np.hypot(error, test.hardness_error)

    def depth_per_k(self, test):
        """(m,) depth (m) that k = 1 gives in laboratory tests: s (p / H)^n, with the load for p / H."""
        return test.distance * (self.share * self.load(test)[0])**self.exponent

    def depths(self, test):
        return [self.depth_per_k(test)]

    def error_of(self, test):
        return np.hypot(test.rate_error, self.exponent * self.load(test)[1])

    def _with(self, k):
        law = copy(self)
        law.k = not_negative("k", float(k[0]))
        return law

"""Wear laws (M 6.3-6.4): what sliding wears off a surface, and the coefficient that a laboratory test gives each.

A law says how fast a surface loses depth while it slides,

    PressureArchard        dw/ds = k p_n / H                                 (M 6.1, 6.7, P 61)
    DissipationArchard     dw/ds = (k / mu) p_T / H                          (M 6.3, 6.9)
    PowerLaw               dw/ds = (p_T / (tau H))^n,  tau = mu k^(-1/n)     (M 6.5, one mode)
    SumOfModes             the sum of such laws over wear modes              (M 6.4, 6.5)

with p_n the pressure, p_T the friction stress, mu Coulomb's coefficient, H the hardness and k dimensionless. The
reference stress tau H of the power law is written through k, so that under Coulomb friction it reads k (p_n / H)^n and
is Archard's for n = 1. A mode takes a share of the friction stress, D_i = share_i D, which the friction model gives
(adhesion and ploughing, say); its k is the one the surface would have if all friction were of that mode.

Particles: a contact with the force F that slides by s on a particle of the area A = 2 r b wears

    V = k A s (F / (A H))^n

so a law needs no more of all that happened than sum F^n s by particle, over the contacts that slid: `needs` names these
sums. Where every sliding contact is at Coulomb's limit, F_T = mu F_n, the forms agree to round-off (in a cut, where
work takes the force of the middle of a step, by the first order of the step: 0.3 % at the default). They differ in a
contact that its dashpot pulls: YADE takes mu |F_n| for its limit, and the friction there counts as dissipation but no
pressure does. Contacts that stick slide nowhere and wear in no form. With n different from 1 the area counts: worn
volume then depends on the size of the particles, whose contacts carry the real, uneven pressure.
"""
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from rockwear.kernels.checks import ParameterError, finite, not_negative, positive, require

NORMAL, FRICTION = "normal", "friction"
"""The forces a law may ask for: compression, and friction."""
WORK = (FRICTION, 1.0)
"""The sum that is the friction work."""

STEEPEST = 20
"""Exponent of a power law."""


class WearLaw:
    """One mode. k: -; needs: ((force, exponent),), the sums of F^exponent s that `volume` takes."""

    force, exponent, mu, share = NORMAL, 1.0, 1.0, 1.0

    def __init__(self, *, k):
        self.k = not_negative("k", k)

    @property
    def needs(self):
        return ((self.force, self.exponent),)

    @property
    def wears(self):
        """Whether anything wears under this law."""
        return self.k > 0

    def volume(self, slid, hardness, area):
        """Worn volume, m3. slid: {(force, exponent): (n,) N^exponent m}; hardness: Pa; area: m2, 2 r b of each."""
        n, factor = self.exponent, self.share / self.mu
        return self.k * area * slid[self.force, n] * (factor / (area * np.asarray(hardness, float)))**n

    def depth_per_k(self, test):
        """(m,) depth (m) that k = 1 gives in laboratory tests: s (p / H)^n, p_T / mu for p in the friction forms."""
        pressure = test.pressure if self.force == NORMAL else test.friction_stress / self.mu
        return test.distance * (self.share * pressure / test.hardness)**self.exponent

    def error_of(self, test):
        """(m,) relative standard error of the k of each test: p / H stands to the power n in it."""
        load = test.pressure_error if self.force == NORMAL else test.friction_error
        return np.hypot(test.rate_error, self.exponent * np.hypot(load, test.hardness_error))

    def rate(self, pressure, hardness):
        """dw/ds (-) of a flat surface under a pressure (Pa) that slides with Coulomb's friction."""
        return self.k * (self.share * pressure / hardness)**self.exponent

    def scaled(self, factor):
        """The same law with `factor` times its k: wear accelerated."""
        return self._with(self.k * factor)

    def fit(self, test):
        """The k under which this law gives the depths of `test`, a LaboratoryTest. -> (law, Fit)."""
        found = fit_linear([self.depth_per_k(test)], test, self.error_of(test))
        return self._with(float(found.k[0])), found


class PressureArchard(WearLaw):
    """dw/ds = k p_n / H (M 6.7)."""

    def _with(self, k):
        return PressureArchard(k=k)


class DissipationArchard(WearLaw):
    """dw/ds = (k / mu) p_T / H (M 6.9). mu: Coulomb's coefficient; share: of the friction that is of this mode."""

    force = FRICTION

    def __init__(self, *, k, mu, share=1.0):
        super().__init__(k=k)
        self.mu, self.share = positive("mu", mu), positive("share", share)

    def _with(self, k):
        return DissipationArchard(k=k, mu=self.mu, share=self.share)


class PowerLaw(DissipationArchard):
    """dw/ds = (p_T / (tau H))^n with tau = mu k^(-1/n) (M 6.5). exponent: n."""

    def __init__(self, *, k, mu, exponent, share=1.0):
        super().__init__(k=k, mu=mu, share=share)
        self.exponent = positive("exponent", exponent)
        require(self.exponent <= STEEPEST, "exponent", self.exponent, f"at most {STEEPEST}: forces to that power leave all bounds")

    @property
    def reference(self):
        """tau, M's reference stress of this mode over the hardness, -; infinite for k = 0."""
        return np.inf if self.k == 0 else self.mu * self.k**(-1 / self.exponent)

    def _with(self, k):
        return PowerLaw(k=k, mu=self.mu, exponent=self.exponent, share=self.share)

    def fit_exponent(self, test):
        """The same law with k and n both fitted, from tests at different p / H. -> (law, Fit, (n, its uncertainty)).

        A straight line through log(w / s) over log(p / H), weighted by the errors where all are known. Raises ParameterError for fewer than three
        tests, or equal p / H.
        """
        require(len(test.depth) > 2, "tests", len(test.depth), "at least 3 to fit an exponent as well")
        x = np.log(self.share * test.friction_stress / (self.mu * test.hardness))
        require(np.ptp(x) > 1e-9, "pressure", float(test.pressure[0]), "different over hardness in some tests, to "
                "fit an exponent", "Pa")
        law, rate = self, np.log(test.depth / test.distance)
        for _ in range(2):  # what errors of p / H weigh depends on the exponent
            error = law.error_of(test)
            known = np.all(error > 0)
            weight = 1 / error if known else np.ones(len(x))
            matrix = np.column_stack([x, np.ones(len(x))]) * weight[:, None]
            solution = np.linalg.lstsq(matrix, rate * weight, rcond=None)[0]
            law = PowerLaw(k=float(np.exp(solution[1])), mu=self.mu, exponent=float(solution[0]), share=self.share)
        rest = rate * weight - matrix @ solution
        scatter = (rest @ rest) / (len(x) - 2)
        spread = np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)) * (max(scatter, 1.0) if known else scatter))
        model = law.k * law.depth_per_k(test)
        return law, Fit(k=np.array([law.k]), uncertainty=np.array([law.k * spread[1]]), depth=model,
                        misfit=misfit(model, test, error, 2)), (law.exponent, float(spread[0]))


class SumOfModes:
    """The sum of several modes (M 6.4): laws, each with its own k, share and exponent."""

    def __init__(self, modes):
        self.modes = list(modes)
        require(len(self.modes) > 0, "modes", len(self.modes), "at least one")
        shares = sum(mode.share for mode in self.modes)
        require(abs(shares - 1) < 1e-9, "modes", shares, "given shares of the friction that add up to 1")

    @property
    def needs(self):
        return tuple(dict.fromkeys(need for mode in self.modes for need in mode.needs))

    @property
    def wears(self):
        """Whether anything wears in any mode."""
        return any(mode.wears for mode in self.modes)

    def volume(self, slid, hardness, area):
        """Worn volume, m3, as WearLaw.volume."""
        return sum(mode.volume(slid, hardness, area) for mode in self.modes)

    def rate(self, pressure, hardness):
        """dw/ds (-), as WearLaw.rate."""
        return sum(mode.rate(pressure, hardness) for mode in self.modes)

    def scaled(self, factor):
        """The same modes with `factor` times their k."""
        return SumOfModes([mode.scaled(factor) for mode in self.modes])

    def error_of(self, test):
        """(m,) as WearLaw.error_of; of modes that answer p / H differently the steepest counts."""
        return np.max([mode.error_of(test) for mode in self.modes], axis=0)

    def depths(self, test):
        """(modes, m) depth (m) in each test that each mode would give with k = 1."""
        return [mode.depth_per_k(test) for mode in self.modes]

    def fit(self, test):
        """The k of all modes, none negative, by least squares. -> (law, Fit).

        Raises ParameterError where the tests cannot tell the modes apart: too few of them, or all at one p / H.
        """
        found = fit_linear(self.depths(test), test, self.error_of(test))
        return SumOfModes([mode._with(float(k)) for mode, k in zip(self.modes, found.k)]), found


LAWS = ("dissipation", "pressure", "power", "modes")


def wear_law(name, *, k, mu, exponent=1.0, modes=""):
    """The law called `name` in LAWS. modes: "k/exponent/share, ..." of each mode; k counts for the others.

    Raises ParameterError for a name that is none of these, modes that cannot be read, or modes or an exponent that are not
    this law's.
    """
    require(name in LAWS, "wear_law", name, f"one of {', '.join(LAWS)}")
    require(name == "power" or exponent == 1, "wear_exponent", exponent, f"1 under the law {name}: it is of the power law")
    require(name == "modes" or not modes, "wear_modes", modes, f"left out under the law {name}")
    if name == "pressure":
        return PressureArchard(k=k)
    if name == "power":
        return PowerLaw(k=k, mu=mu, exponent=exponent)
    if name == "modes":
        return SumOfModes(_mode(word, mu) for word in modes.split(","))
    return DissipationArchard(k=k, mu=mu)


def _mode(word, mu):
    parts = word.split("/")
    if len(parts) != 3:
        raise ParameterError("wear_modes", word.strip(), "k/exponent/share of each mode, with commas between modes")
    k, exponent, share = (finite("wear_modes", part) for part in parts)
    return PowerLaw(k=k, mu=mu, exponent=exponent, share=share)


# ---- from the laboratory

@dataclass
class LaboratoryTest:
    """Tests of blocks pressed and slid (M 6.6), one a row, all (m,) arrays.

    pressure, friction_stress, hardness: Pa; distance, depth: m. Relative standard errors, -, 0 where not known: rate_error
    of depth over distance, pressure_error, friction_error, hardness_error. Raises ParameterError unless the quantities are
    positive and the errors not negative.
    """

    pressure: np.ndarray
    friction_stress: np.ndarray
    distance: np.ndarray
    depth: np.ndarray
    hardness: np.ndarray
    rate_error: np.ndarray
    pressure_error: np.ndarray
    friction_error: np.ndarray
    hardness_error: np.ndarray

    def __post_init__(self):
        units = {"pressure": "Pa", "friction_stress": "Pa", "distance": "m", "depth": "m", "hardness": "Pa"}
        for name, unit in units.items():
            setattr(self, name, np.array([positive(name, value, unit) for value in np.atleast_1d(getattr(self, name))]))
        for name in ("rate_error", "pressure_error", "friction_error", "hardness_error"):
            setattr(self, name, np.array([not_negative(name, value) for value in np.atleast_1d(getattr(self, name))]))


@dataclass
class Fit:
    """k: (modes,) -; uncertainty: (modes,) one standard error, nan where nothing is known; depth: (m,) m, as fitted;
    misfit: chi2 over degrees of freedom, nan without any: well above 1, tests scatter more than their errors say."""

    k: np.ndarray
    uncertainty: np.ndarray
    depth: np.ndarray
    misfit: float


def misfit(model, test, error, parameters):
    """chi2 of the depths, with these relative errors, over the degrees of freedom; nan without errors or freedom."""
    freedom = len(model) - parameters
    if freedom < 1 or not np.all(error > 0):
        return np.nan
    return float(np.sum(((test.depth - model) / (error * test.depth))**2) / freedom)


def fit_linear(columns, test, error):
    """Least squares for depth = sum k_i column_i, k_i >= 0, weighted by the (m,) relative errors where all are known. -> Fit.

    Uncertainty: of one test, its error; of several, the larger of what their errors and what their scatter say. Without
    errors, tests count by their relative deviation, and only the scatter is known.
    """
    columns = np.column_stack(columns)
    count, unknown = columns.shape
    known = bool(np.all(error > 0))
    weight = 1 / (test.depth * (error if known else 1.0))
    matrix, right = columns * weight[:, None], test.depth * weight
    scale = np.linalg.norm(matrix, axis=0)
    require(count >= unknown and np.linalg.cond(matrix / scale) < 1e8, "tests", count,
            f"at least {unknown}, at different pressure over hardness, to tell modes of different exponents apart")
    k = nnls(matrix / scale, right)[0] / scale
    chi2 = float(np.sum((right - matrix @ k)**2))
    freedom = count - unknown
    variance = np.diag(np.linalg.inv((matrix / scale).T @ (matrix / scale))) / scale**2
    scatter = chi2 / freedom if freedom else (0.0 if known else np.nan)
    uncertainty = np.sqrt(variance * (max(scatter, 1.0) if known else scatter))
    return Fit(k=k, uncertainty=uncertainty, depth=columns @ k, misfit=misfit(columns @ k, test, error, unknown))

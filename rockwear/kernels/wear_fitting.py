"""Wear coefficients from laboratory tests, by least squares."""
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls
from scipy.special import stdtrit

from rockwear.kernels.checks import not_negative, positive, require

ROUND_OFF = 1e-9
"""Relative deviation of tests that is none."""
ROUNDS = 4
"""Fits one after the other, each with errors as parts of the depths of the one before."""
SILENT = dict(over="ignore", divide="ignore", invalid="ignore")
"""Of numpy where what is not finite is refused afterwards."""


@dataclass
class LaboratoryTest:
    """Tests of blocks pressed and slid [Rojek 2003, 6.6], one a row, all (m,) arrays.

    pressure, friction_stress, hardness: Pa; distance, depth: m. Relative standard errors, -, 0 where not known:
    rate_error of depth over distance, pressure_error, friction_error, hardness_error. Raises ParameterError unless the
    quantities are positive and the errors not negative.
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
    return float(np.sum(((test.depth - model) / (error * model))**2) / freedom)


def _factor(chi2, freedom, known):
    """Factor on the variances of a fit with this sum of squares: at least 1 where errors are known, else what the tests
    scatter; nan where they do not. Few tests do not know their scatter well: standard errors by it are larger by
    Student's t, so that k is within two of them in 95 % of the cases."""
    scatter = chi2 / freedom if freedom else 0.0
    if known:
        return max(scatter, 1.0)
    return scatter * (stdtrit(freedom, 0.975) / stdtrit(np.inf, 0.975))**2 if scatter > ROUND_OFF**2 else np.nan


def _check_range(test, *arrays):
    """Raise ParameterError where what is computed of the tests is not finite."""
    require(all(np.isfinite(array).all() for array in arrays), "tests", len(test.depth), "in the range of numbers: "
            "the law's power of pressure over hardness, or depth over distance, comes out as 0 or infinite")


@np.errstate(**SILENT)
def fit_linear(columns, test, error):
    """Least squares for depth = sum k_i column_i, k_i >= 0, weighted by the (m,) relative errors, if known. -> Fit.

    Errors are parts of the fitted depths: as parts of the measured ones they would let tests count most that happened
    to wear least, and k would come out too low. Of one mode with equal errors k is the mean of the tests. Uncertainty:
    of one test, its error; of several, the larger of what their errors and what their scatter say. Without errors,
    tests count by their relative deviation, and only the scatter is known.
    """
    columns = np.column_stack(columns)
    count, unknown = columns.shape
    known = bool(np.all(error > 0))
    depth = test.depth
    for _ in range(ROUNDS):
        weight = 1 / (depth * (error if known else 1.0))
        matrix, right = columns * weight[:, None], test.depth * weight
        scale = np.linalg.norm(matrix, axis=0)
        _check_range(test, right, scale, 1 / scale)
        require(count >= unknown and np.linalg.cond(matrix / scale) < 1e8, "tests", count,
                f"at least {unknown}, at different pressure over hardness, to tell modes of different exponents apart")
        k = nnls(matrix / scale, right)[0] / scale
        depth = columns @ k
    chi2 = float(np.sum((right - matrix @ k)**2))
    variance = np.diag(np.linalg.inv((matrix / scale).T @ (matrix / scale))) / scale**2
    uncertainty = np.sqrt(variance * _factor(chi2, count - unknown, known))
    return Fit(k=k, uncertainty=uncertainty, depth=columns @ k, misfit=misfit(columns @ k, test, error, unknown))


@np.errstate(**SILENT)
def fit_line(power_law, start, test, load):
    """k and n of dw/ds = k (load)^n: a straight line through log(w / s) over log(load), weighted by known errors.

    power_law(k, exponent) -> law; start: the law to begin with; load: (m,) p / H of the tests. -> (law, Fit, (n, its
    standard error)). Raises ParameterError for fewer than three tests, or equal loads.
    """
    require(len(test.depth) > 2, "tests", len(test.depth), "at least 3 to fit an exponent as well")
    x, rate = np.log(load), np.log(test.depth / test.distance)
    _check_range(test, x, rate)
    require(np.ptp(x) > 1e-9, "pressure", float(test.pressure[0]), "different over hardness in some tests, to "
            "fit an exponent", "Pa")
    law = start
    for _ in range(2):  # the weight of errors of p / H depends on the exponent
        error = law.error_of(test)
        known = np.all(error > 0)
        weight = 1 / error if known else np.ones(len(x))
        matrix = np.column_stack([x, np.ones(len(x))]) * weight[:, None]
        solution = np.linalg.lstsq(matrix, rate * weight, rcond=None)[0]
        require(solution[0] > 0, "fitted exponent", float(solution[0]),
                "greater than 0: these tests wear less the higher their pressure over hardness is")
        law = power_law(k=float(np.exp(solution[1])), exponent=float(solution[0]))
    rest = rate * weight - matrix @ solution
    spread = np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)) * _factor(rest @ rest, len(x) - 2, known))
    model = law.k * law.depth_per_k(test)
    return law, Fit(k=np.array([law.k]), uncertainty=np.array([law.k * spread[1]]), depth=model,
                    misfit=misfit(model, test, error, 2)), (law.exponent, float(spread[0]))

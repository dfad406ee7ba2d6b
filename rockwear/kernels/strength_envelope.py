"""Strength envelopes of intact rock: Mohr-Coulomb and Hoek-Brown, fitted to principal stresses at failure."""
import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from rockwear.kernels.checks import ParameterError, require

LEVEL = 0.95
"""Confidence of the intervals."""


class Estimate(NamedTuple):
    """A fitted parameter: value, and half the width of its confidence interval (nan without spare points)."""

    value: float
    half_width: float


class MohrCoulomb(NamedTuple):
    """sigma1 = 2 c cos(phi) / (1 - sin(phi)) + sigma3 (1 + sin(phi)) / (1 - sin(phi)); c in Pa, phi in degrees.

    residual: Pa, standard deviation of the points from the line.
    """

    cohesion: Estimate
    friction_angle: Estimate
    residual: float

    def sigma1(self, sigma3):
        """Pa at failure."""
        sine = math.sin(math.radians(self.friction_angle.value))
        slope = (1 + sine) / (1 - sine)
        return 2 * self.cohesion.value * math.sqrt(slope) + slope * np.asarray(sigma3, float)


class HoekBrown(NamedTuple):
    """sigma1 = sigma3 + sqrt(m_i sigma_ci sigma3 + sigma_ci^2), the criterion of intact rock (s = 1, a = 0.5) [Hoek and
    Brown 1980]; sigma_ci in Pa.

    residual: Pa, standard deviation of the points from the curve.
    """

    m_i: Estimate
    sigma_ci: Estimate
    residual: float

    def sigma1(self, sigma3):
        """Pa at failure; nan below the tensile strength."""
        return _hoek_brown(self.m_i.value, self.sigma_ci.value, np.asarray(sigma3, float))

    @property
    def tensile_strength(self):
        """Pa: -sigma3 where sigma1 = 0, the end of the curve that is a stress of direct tension."""
        return _tension(self.m_i.value, self.sigma_ci.value)


def _hoek_brown(m, strength, sigma3):
    with np.errstate(invalid="ignore"):
        return sigma3 + np.sqrt(m * strength * sigma3 + strength**2)


def _tension(m, strength):
    return 0.5 * strength * (math.sqrt(m**2 + 4) - m)


def mohr_coulomb(sigma3, sigma1):
    """MohrCoulomb by linear regression of sigma1 on sigma3.

    sigma3, sigma1: (n,) Pa, compression positive, at failure. Intervals: Student's t with n - 2 degrees of freedom, the
    covariance of the line carried over to c and phi by their derivatives. Raises ParameterError.
    """
    sigma3, sigma1 = _checked(sigma3, sigma1)
    matrix = np.column_stack([np.ones_like(sigma3), sigma3])
    strength, slope = np.linalg.lstsq(matrix, sigma1, rcond=None)[0]
    require(slope > 0, "sigma1", float(sigma1[np.argmax(sigma3)]), "rising with sigma3", "Pa")
    covariance, residual, factor = _spread(matrix, sigma1 - matrix @ (strength, slope))
    root = math.sqrt(slope)
    cohesion = np.array([0.5 / root, -0.25 * strength / slope**1.5])
    angle = np.array([0.0, math.degrees(1 / (root * (1 + slope)))])
    halves = [factor * math.sqrt(gradient @ covariance @ gradient) for gradient in (cohesion, angle)]
    return MohrCoulomb(Estimate(float(0.5 * strength / root), halves[0]),
                       Estimate(2 * math.degrees(math.atan(root)) - 90, halves[1]), residual)


def hoek_brown(sigma3, sigma1, tensile_strength=None):
    """HoekBrown by least squares of sigma1.

    sigma3, sigma1: (n,) Pa, compression positive, at failure; tensile_strength: Pa of direct tension or several, which
    count as further points, compared with that of the curve. Intervals: as of mohr_coulomb, from the covariance at
    the solution. Raises ParameterError.
    """
    sigma3, sigma1 = _checked(sigma3, sigma1)
    tension = np.atleast_1d(np.asarray([] if tensile_strength is None else tensile_strength, float))
    scale = float(sigma1.max())
    x, y, pulled = sigma3 / scale, sigma1 / scale, tension / scale
    # (sigma1 - sigma3)^2 is linear in sigma3: where to begin.
    slope, square = np.polyfit(x, (y - x)**2, 1)
    require(slope > 0, "sigma1", float(sigma1[np.argmax(sigma3)]), "rising faster than sigma3", "Pa")
    strength = math.sqrt(square) if square > 0 else 0.1 * float(y.min())

    def misfit(p):
        return np.concatenate([_hoek_brown(*p, x) - y, _tension(*p) - pulled])

    require(bool(np.isfinite(misfit((slope / strength, strength))).all()), "sigma3", float(sigma3.min()),
            "above the tension at which the curve of the other points begins", "Pa")
    found = least_squares(misfit, (slope / strength, strength), bounds=((1e-6, 1e-9), np.inf), x_scale="jac",
                          xtol=1e-14, ftol=1e-14, gtol=1e-14)
    if not found.success or found.active_mask.any():
        raise ParameterError("sigma1", float(sigma1.min()), "at stresses that Hoek-Brown can follow: sigma_ci and m_i "
                             "above 0", "Pa")
    covariance, residual, factor = _spread(found.jac, found.fun)
    m, strength = found.x.tolist()
    halves = [factor * math.sqrt(covariance[i, i]) for i in range(2)]
    return HoekBrown(Estimate(m, halves[0]), Estimate(scale * strength, scale * halves[1]), scale * residual)


def _checked(sigma3, sigma1):
    sigma3, sigma1 = np.asarray(sigma3, float), np.asarray(sigma1, float)
    require(sigma3.shape == sigma1.shape and sigma3.ndim == 1, "sigma1", len(sigma1), f"as many as sigma3, "
            f"{len(sigma3)}")
    for name, values in (("sigma3", sigma3), ("sigma1", sigma1)):
        require(bool(np.isfinite(values).all()), name, float(values[~np.isfinite(values)][:1].sum()), "finite", "Pa")
    require(len(np.unique(sigma3)) > 1, "sigma3", len(np.unique(sigma3)), "at least two different stresses")
    return sigma3, sigma1


def _spread(matrix, residuals):
    """Covariance of two parameters, standard deviation of the points, and Student's factor; nan without spare
    points."""
    free = len(residuals) - 2
    variance = float(residuals @ residuals) / free if free else math.nan
    factor = float(student.ppf(0.5 * (1 + LEVEL), free)) if free else math.nan
    return variance * np.linalg.inv(matrix.T @ matrix), math.sqrt(variance), factor

"""Mohr-Coulomb and Hoek-Brown envelopes: parameters that generated the points, and what the intervals are worth."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.strength_envelope import hoek_brown, mohr_coulomb

SIGMA3 = np.array([0, 1, 2, 5, 10, 20]) * 1e6


def test_mohr_coulomb_finds_cohesion_and_friction():
    cohesion, angle = 4.9e6, math.radians(50.6)
    slope = math.tan(math.pi / 4 + angle / 2)**2
    fit = mohr_coulomb(SIGMA3, 2 * cohesion * math.sqrt(slope) + slope * SIGMA3)
    assert fit.cohesion.value == pytest.approx(cohesion, rel=1e-9)
    assert fit.friction_angle.value == pytest.approx(50.6, rel=1e-9)
    assert fit.cohesion.half_width < 1 and fit.residual < 1
    # On Mohr's plane at failure the shear stress is c + sigma tan(phi).
    sigma1, sigma3 = float(fit.sigma1(3e6)), 3e6
    shear = 0.5 * (sigma1 - sigma3) * math.cos(angle)
    normal = 0.5 * (sigma1 + sigma3) - 0.5 * (sigma1 - sigma3) * math.sin(angle)
    assert shear == pytest.approx(cohesion + normal * math.tan(angle), rel=1e-9)


@pytest.mark.parametrize("with_tension", [False, True])
def test_hoek_brown_finds_its_parameters(with_tension):
    m, strength = 30.0, 27.4e6
    tension = 0.5 * strength * (math.sqrt(m**2 + 4) - m)
    points = SIGMA3 + np.sqrt(m * strength * SIGMA3 + strength**2)
    fit = hoek_brown(SIGMA3, points, tension if with_tension else None)
    assert fit.m_i.value == pytest.approx(m, rel=1e-6) and fit.sigma_ci.value == pytest.approx(strength, rel=1e-6)
    assert fit.tensile_strength == pytest.approx(tension, rel=1e-6)
    # The curve ends in direct tension: sigma1 = 0.
    assert float(fit.sigma1(-fit.tensile_strength)) == pytest.approx(0, abs=1e-3 * strength)


def test_tension_counts_as_a_point():
    points = SIGMA3 + np.sqrt(10 * 30e6 * SIGMA3 + 30e6**2)
    free, held = hoek_brown(SIGMA3, points), hoek_brown(SIGMA3, points, [1e6] * 5)
    assert held.tensile_strength < free.tensile_strength - 0.1e6


@pytest.mark.parametrize("fit, exact, names", [
    (mohr_coulomb, lambda s: 20e6 + 4 * s, {"cohesion": 5e6, "friction_angle": 36.86989764584402}),
    (hoek_brown, lambda s: s + np.sqrt(12 * 40e6 * s + 40e6**2), {"m_i": 12, "sigma_ci": 40e6})])
def test_nineteen_of_twenty_intervals_hold_the_parameter(fit, exact, names):
    rng = np.random.default_rng(1)
    fits = [fit(SIGMA3, exact(SIGMA3) + 1e6 * rng.standard_normal(len(SIGMA3))) for _ in range(400)]
    for name, value in names.items():
        held = np.mean([abs(getattr(one, name).value - value) < getattr(one, name).half_width for one in fits])
        assert 0.92 < held < 0.98, name
    assert np.mean([one.residual**2 for one in fits]) == pytest.approx(1e12, rel=0.1)


def test_two_points_give_no_interval():
    fit = mohr_coulomb([0, 10e6], [20e6, 60e6])
    assert fit.cohesion.value == pytest.approx(5e6) and math.isnan(fit.cohesion.half_width)


@pytest.mark.parametrize("fit", [mohr_coulomb, hoek_brown])
@pytest.mark.parametrize("sigma3, sigma1, words", [
    ([1e6, 1e6], [5e6, 6e6], "sigma3 = 1: must be at least two different stresses"),
    ([0, 1e6], [5e6], "sigma1 = 1: must be as many as sigma3, 2"),
    ([0, 1e6], [5e6, math.nan], "sigma1 = nan Pa: must be finite"),
    ([0, 1e6], [5e6, 4e6], "sigma1 = 4e+06 Pa: must be rising")])
def test_points_without_an_envelope_are_refused(fit, sigma3, sigma1, words):
    with pytest.raises(ParameterError) as error:
        fit(sigma3, sigma1)
    assert words in str(error.value)

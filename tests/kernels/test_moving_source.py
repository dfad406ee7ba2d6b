"""A strip of heat that lies still or moves, against integrals of line sources and against limits."""
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import exp1, k0

from rockwear.kernels.analytic import half_space_under_flux
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.moving_source import FAST, common_share, moving_strip, still_strip

STEEL = dict(conductivity=60.0, density=7830.0, specific_heat=450.0)
A = 60.0 / (7830 * 450)
STRIP = dict(half_length=4e-4, flux=1.6e7)


@pytest.mark.parametrize("t", (1e-5, 1e-3, 0.1, 10.0))
def test_a_still_strip_is_the_sum_of_its_lines(t):
    """A line of heat P (W/m) on the surface of a half-space: T = P/(2 pi lambda) E1(r^2/(4 a t))."""
    lines, _ = quad(lambda x: exp1(x**2 / (4 * A * t)), 0, 4e-4, limit=200)
    assert still_strip(t, **STRIP, **STEEL) == pytest.approx(2 * 1.6e7 / (2 * math.pi * 60) * lines, rel=1e-7)


def test_a_still_strip_begins_as_a_wide_flux():
    early = half_space_under_flux(0.0, 1e-6, flux=1.6e7, **STEEL)
    assert still_strip(1e-6, **STRIP, **STEEL) == pytest.approx(float(early), rel=1e-9)


@pytest.mark.parametrize("velocity", (1e-3, 0.04, 1.0, 50.0))
def test_a_moving_strip_is_the_hottest_sum_of_its_lines(velocity):
    """A line that moves: T = P/(pi lambda) e^(-v x/(2 a)) K0(v |x|/(2 a)), x ahead of it."""
    rate = velocity / (2 * A)

    def rise(place):
        def line(x):
            return math.exp(-rate * x) * k0(rate * abs(x)) if rate * abs(x) < 600 else (
                math.sqrt(math.pi / (2 * rate * abs(x))) if x < 0 else 0.0)
        ends = place - 4e-4, place + 4e-4
        whole, _ = quad(line, *ends, points=[x for x in (0.0, *np.sign(ends) * 1e-3 / rate) if ends[0] < x < ends[1]],
                        limit=400)
        return 1.6e7 / (math.pi * 60) * whole

    hottest = max(rise(place) for place in np.linspace(-4e-4, 0, 201)[1:-1])
    found = moving_strip(velocity, **STRIP, **STEEL)
    assert hottest <= found * (1 + 1e-6) and found == pytest.approx(hottest, rel=2e-3)


def test_a_fast_strip_heats_a_half_space_while_it_passes():
    passing = half_space_under_flux(0.0, 8e-4 / 100, flux=1.6e7, **STEEL)
    assert moving_strip(100.0, **STRIP, **STEEL) == pytest.approx(float(passing), rel=1e-3)


@pytest.mark.parametrize("peclet", (0.9 * FAST, 1.1 * FAST, 1e20))
def test_however_fast_a_strip_is_its_rise_is_known(peclet):
    velocity = peclet * A / STRIP["half_length"]
    passing = half_space_under_flux(0.0, 2 * STRIP["half_length"] / velocity, flux=1.6e7, **STEEL)
    assert moving_strip(velocity, **STRIP, **STEEL) == pytest.approx(float(passing), rel=1e-5)


def test_the_common_share_makes_both_as_hot():
    share = common_share(285.0, 54.0)
    assert share * 285 == pytest.approx((1 - share) * 54)


@pytest.mark.parametrize("call", (lambda: still_strip(0.0, **STRIP, **STEEL),
                                  lambda: moving_strip(-1, **STRIP, **STEEL),
                                  lambda: still_strip(1.0, half_length=0, flux=1, **STEEL),
                                  lambda: common_share(0.0, 1.0)))
def test_what_is_out_of_range_is_refused(call):
    with pytest.raises(ParameterError):
        call()

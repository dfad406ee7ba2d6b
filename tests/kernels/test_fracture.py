"""Fracture mechanics: the compact tension specimen's formulas, and tests that a sharp crack would give."""
import math

import numpy as np
import pytest

from rockwear.kernels import brazilian, fracture
from rockwear.kernels.checks import ParameterError


@pytest.mark.parametrize("alpha, factor", [(0.45, 8.34), (0.5, 9.66), (0.55, 11.36)])
def test_the_tabulated_factors(alpha, factor):
    """The table of ASTM E399."""
    assert fracture.intensity_factor(alpha) == pytest.approx(factor, abs=0.005)


def test_the_factor_of_a_deep_crack_is_that_of_a_bent_ligament():
    """M = P (W + a)/2 on a ligament c: K = 3.975 M / c^(3/2) (Tada's handbook), beside the tension of P itself."""
    alpha = 0.95
    bent = 3.975 * 0.5 * (1 + alpha) / (1 - alpha)**1.5
    assert fracture.intensity_factor(alpha) == pytest.approx(bent, rel=0.03)


def test_the_compliance_grows_as_the_energy_asks():
    """P^2/2 dC/da = K^2/E': the slope of the compliance is twice the square of the factor."""
    alpha = np.linspace(0.4, 0.9, 26)
    slope = (fracture.compliance(alpha + 1e-5) - fracture.compliance(alpha - 1e-5)) / 2e-5
    assert slope == pytest.approx(2 * fracture.intensity_factor(alpha)**2, rel=0.015)


def test_the_equivalent_crack_inverts_the_compliance():
    alpha = np.linspace(0.2, 0.94, 50)
    assert fracture.equivalent_crack(fracture.compliance(alpha)) == pytest.approx(alpha, abs=1e-6)


def sharp_crack(*, modulus, energy, width, notch, last=0.8):
    """(force, opening) of a specimen loaded to its toughness and then opened with K = K_IC: exact but for the formulas'
    own 1.5 %."""
    alpha = np.concatenate([np.full(200, notch), np.linspace(notch, last, 2000)])
    force = math.sqrt(modulus * energy * width) / fracture.intensity_factor(alpha)
    force[:200] *= np.linspace(0, 1, 200)
    return force, force * fracture.compliance(alpha) / modulus


@pytest.mark.parametrize("width, notch", [(0.04, 0.4), (0.1, 0.6)])
def test_a_sharp_crack_gives_back_its_toughness(width, notch):
    modulus, energy = 13e9, 30.0
    force, opening = sharp_crack(modulus=modulus, energy=energy, width=width, notch=notch)
    found = fracture.resistance_curve(force=force, opening=opening, width=width, notch=notch)
    exact = fracture.toughness(modulus, energy)
    assert exact == pytest.approx(624.5e3, rel=1e-4)
    assert found["modulus"] == pytest.approx(modulus, rel=1e-6)
    assert found["peak_intensity"] == pytest.approx(exact, rel=1e-6)
    assert found["intensity"][-1] == pytest.approx(exact, rel=1e-3)
    assert found["crack"][-1] == pytest.approx(0.8, abs=1e-4)
    assert found["energy"] == pytest.approx(energy, rel=0.01)


def test_a_test_too_short_says_nan():
    found = fracture.resistance_curve(force=[0.0, 1.0], opening=[0.0, 1e-6], width=0.04, notch=0.4)
    assert math.isnan(found["energy"]) and math.isnan(found["modulus"])
    assert math.isnan(fracture.toughness(found["modulus"], found["energy"]))


def test_a_crack_that_never_grows_has_no_energy():
    found = fracture.resistance_curve(force=np.arange(50.0), opening=1e-9 * np.arange(50.0), width=0.04, notch=0.4)
    assert math.isfinite(found["modulus"]) and math.isnan(found["energy"])


def test_a_crack_that_runs_at_once_has_its_energy():
    """From before the onset to past the end of what counts, between two rows."""
    force, opening = sharp_crack(modulus=13e9, energy=30.0, width=0.1, notch=0.4, last=0.85)
    rows = np.append(np.arange(210), len(force) - 1)
    found = fracture.resistance_curve(force=force[rows], opening=opening[rows], width=0.1, notch=0.4)
    assert found["crack"][-2] < 0.41 and found["crack"][-1] > 0.8
    # Between two rows the force is taken to fall along a line, and it falls below.
    assert 30.0 < found["energy"] < 60.0


def test_a_crack_that_ends_before_the_onset_has_no_energy():
    force, opening = sharp_crack(modulus=13e9, energy=30.0, width=0.1, notch=0.4, last=0.43)
    found = fracture.resistance_curve(force=force, opening=opening, width=0.1, notch=0.4)
    assert found["crack"][-1] == pytest.approx(0.43, abs=1e-4) and math.isnan(found["energy"])


@pytest.mark.parametrize("values, name", [({"width": 0.0}, "width"), ({"notch": 0.1}, "notch"),
                                          ({"notch": 0.9}, "notch"), ({"force": [], "opening": []}, "force")])
def test_bad_specimens_are_refused(values, name):
    with pytest.raises(ParameterError) as caught:
        fracture.resistance_curve(**{**dict(force=[0, 1], opening=[0, 1], width=0.04, notch=0.4), **values})
    assert caught.value.name == name


def test_the_law_of_size_gives_back_what_it_was_made_of():
    W = np.array([0.04, 0.08, 0.16])
    assert fracture.size_effect(W, 9e5 / np.sqrt(1 + 0.03 / W)) == pytest.approx((9e5, 0.03))
    # Strength alone: K grows as the root of the size.
    assert all(map(math.isnan, fracture.size_effect(W, 1e6 * W**0.51)))
    with pytest.raises(ParameterError, match="sizes"):
        fracture.size_effect([0.04, 0.04], [1e6, 1e6])


def test_stresses_of_a_pressed_disc():
    assert brazilian.tensile_strength(1e6, 0.05) == pytest.approx(0.6366 * 1e6 / 0.05, rel=1e-4)
    assert brazilian.centre_stresses(1.0, 1.0) == pytest.approx((2 / math.pi, -6 / math.pi))


@pytest.mark.parametrize("half_angle", [0.05, 0.2, 0.5])
def test_an_even_pressure_on_an_arc_gives_the_integral_of_point_loads(half_angle):
    """A pair of point loads dP at the angle t: 2/(pi D) (1, -3) along its own axes, turned by t."""
    t = np.linspace(-half_angle, half_angle, 20001)
    weight = np.full(t.shape, 1 / len(t))
    across = np.sum(weight * 2 / math.pi * (np.cos(t)**2 - 3 * np.sin(t)**2))
    along = np.sum(weight * 2 / math.pi * (np.sin(t)**2 - 3 * np.cos(t)**2))
    assert brazilian.centre_stresses(1.0, 1.0, half_angle) == pytest.approx((across, along), rel=1e-3)


def point_loads(x, y):
    """(across, along) the loading at (x, y) over the radius, of a disc of D = 1 under P = 1 along x: two half-planes
    under point forces, and the even tension 2/pi that frees the rim (Timoshenko and Goodier)."""
    across, along = np.full(x.shape, 2 / math.pi), np.full(x.shape, 2 / math.pi)
    for pole in (-1, 1):
        along_it, r4 = 1 + pole * x, ((1 + pole * x)**2 + y**2)**2
        # Distances are radii, half a diameter.
        across -= 2 / math.pi * along_it * y**2 / r4 / 0.5
        along -= 2 / math.pi * along_it**3 / r4 / 0.5
    return across, along


@pytest.mark.parametrize("gauge", [0.0, 0.25, 0.5])
def test_the_mean_over_a_gauge_is_that_of_the_whole_field(gauge):
    points = gauge * np.sqrt((np.arange(200) + 0.5) / 200)
    angle = np.arange(400) * 2 * math.pi / 400
    x, y = np.outer(points, np.cos(angle)), np.outer(points, np.sin(angle))
    expected = [field.mean() for field in point_loads(x, y)]
    assert brazilian.centre_stresses(1.0, 1.0, gauge=gauge) == pytest.approx(expected, rel=1e-4)

"""The envelope of a cut: the numbers it was given, and where it says nothing."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cutting_envelope import GROOVE_FORCES, RECALLED, RELATIONS, TARGET, Range, expected, exponent


def ranges(basis, ucs=50e6, depth=5e-3, rake=-5, **changed):
    """{observable: Range} of one basis; the rock's tensile strength a twelfth of its UCS unless given."""
    values = {"tensile_strength": ucs / 12, **changed}
    found = expected(compressive_strength=ucs, depth=depth, rake=math.radians(rake), **values)
    return {one.observable: one for one in found if one.basis == basis}


@pytest.mark.parametrize("ucs, low, high", [(30e6, 40e3, 87e3), (50e6, 66e3, 144e3), (75e6, 98e3, 215e3),
                                            (40e6, 53e3, 115.5e3)])
def test_groove(ucs, low, high):
    found = ranges(RECALLED, ucs)
    assert found["mean_cutting_force"][1:4] == pytest.approx((low, high, "N/m"))
    assert found["peak_over_mean"][1:3] == (2, 3)


def test_groove_forces_are_multiples_of_the_regression():
    for ucs, limits in GROOVE_FORCES.items():
        force = (0.25 * ucs + 0.11e6) * 5e-3
        np.testing.assert_allclose(np.round(1e-3 * force * np.array([1.04, 2.28])), 1e-3 * np.array(limits))


@pytest.mark.parametrize("rake, low, high", [(-5, 112e3, 449e3), (0, 97e3, 386e3), (15, 62e3, 249e3)])
def test_peaks_are_half_to_twice_evans(rake, low, high):
    found = ranges(RECALLED, 48e6, 10e-3, rake, tensile_strength=4e6)
    assert found.keys() == {"mean_peak_cutting_force"}
    assert np.round(1e-3 * np.array(found["mean_peak_cutting_force"][1:3])).tolist() == [1e-3 * low, 1e-3 * high]


@pytest.mark.parametrize("depth, known", [(0.9e-3, False), (1e-3, True), (20e-3, True), (21e-3, False)])
def test_chips_are_made_at_1_to_20_mm(depth, known):
    assert ("mean_peak_cutting_force" in ranges(RECALLED, depth=depth)) == known


@pytest.mark.parametrize("depth, rake", [(0.25e-3, -15), (0.5e-3, -20), (1e-3, -17)])
def test_scratch(depth, rake):
    """32 to 59 kN/m per mm of depth."""
    found = ranges(RECALLED, 49e6, depth, rake)
    assert found["specific_energy"][1:4] == (32e6, 59e6, "J/m3")
    assert found["thrust_over_cutting"][1:3] == (0.55, 0.85)


@pytest.mark.parametrize("changed", [{"ucs": 29e6}, {"ucs": 76e6}, {"depth": 4e-3}, {"rake": 0}, {"wear_flat": 1e-3}])
def test_beyond_its_case_a_range_is_not_given(changed):
    found = ranges(RECALLED, **changed)
    assert "mean_cutting_force" not in found and "specific_energy" not in found
    assert ("mean_peak_cutting_force" in found) == ("wear_flat" not in changed)


@pytest.mark.parametrize("changed", [{"ucs": 60e6}, {"depth": 2e-3}, {"rake": -5}, {"wear_flat": 1e-3}])
def test_no_scratch_of_another_rock_depth_rake_or_tool(changed):
    values = {"ucs": 49e6, "depth": 0.5e-3, "rake": -15, **changed}
    assert "specific_energy" not in ranges(RECALLED, **values)


def test_targets():
    found = ranges(TARGET)
    assert found["specific_energy"][1:3] == pytest.approx((5e6, 20e6))
    assert found["overbreak"][1:4] == (0, 5e-3, "m") and found["peak_over_mean"][1:3] == (2, 4)
    assert "specific_energy" not in ranges(TARGET, depth=10e-3)


@pytest.mark.parametrize("value, error, verdict", [
    (66e3, 0, "inside"), (144e3, 0, "inside"), (60e3, 2e3, "below"), (60e3, 3e3, "below, within the error"),
    (150e3, 2e3, "above"), (150e3, 4e3, "above, within the error"), (150e3, math.nan, "above"),
    (math.nan, 0, "not known")])
def test_verdicts(value, error, verdict):
    assert ranges(RECALLED)["mean_cutting_force"].verdict(value, error) == verdict


def test_relations_between_cuts():
    limits = {one.observable: one[1:3] for one in RELATIONS}
    assert limits == {"scratch_force_exponent": (0.9, 1.1), "chip_force_exponent": (0.5, 1.0),
                      "force_over_rake": (-math.inf, 0), "flat_thrust": (0.5, 1.0),
                      "flat_cutting_over_thrust": (0.5, 0.85), "wet_force": (0.95, 1.2),
                      "wet_specific_energy": (1.0, 1.35)}
    assert all(isinstance(one, Range) and one.basis in ("recalled", "seen, widened") for one in RELATIONS)


def test_exponent_of_a_power_and_its_error():
    depth = np.array([1.0, 2.0, 4.0]) * 1e-3
    found = exponent(depth, 3e6 * depth**0.7, 0.1 * 3e6 * depth**0.7)
    # Three points one log 2 apart: the sum of squares about the middle is 2 log(2)^2.
    assert found == pytest.approx((0.7, 0.1 / math.sqrt(2) / math.log(2)))
    bent = exponent(depth, np.array([1.0, 4.0, 4.0]), np.array([1e-3, 4e-3, 4e-3]))
    # Residuals of log 2 times (-1, 2, -1) / 3: variance 2/3 log(2)^2, one degree of freedom.
    assert bent == pytest.approx((1.0, math.sqrt(1 / 3)))


@pytest.mark.parametrize("depth, force, name", [([1.0, 1.0], [1.0, 2.0], "depth"), ([1.0, 2.0], [1.0, 0.0], "force")])
def test_no_exponent(depth, force, name):
    with pytest.raises(ParameterError, match=f"^{name} ="):
        exponent(depth, force, [0.1, 0.1])


@pytest.mark.parametrize("changed, name", [({"depth": 0.0}, "depth"), ({"wear_flat": -1.0}, "wear_flat"),
                                           ({"tensile_strength": 0.0}, "tensile_strength")])
def test_what_is_no_cut_is_refused(changed, name):
    with pytest.raises(ParameterError, match=f"^{name} ="):
        ranges(RECALLED, **changed)


def test_a_sign_is_told_where_twice_the_error_leaves_it():
    falls = next(one for one in RELATIONS if one.observable == "force_over_rake")
    assert [falls.verdict(-10.0, error) for error in (4.0, 6.0)] == ["inside", "not told"]

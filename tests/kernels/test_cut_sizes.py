"""Sizes of a cut by its depth and the discs in it."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cut_sizes import cut_sizes
from rockwear.kernels.polygon import tooth


@pytest.mark.parametrize("depth", [1e-3, 5e-3, 0.02])
@pytest.mark.parametrize("discs", [4, 16, 64])
def test_as_many_discs_as_asked_for_are_in_the_depth_of_cut(depth, discs):
    found = cut_sizes(depth, discs, velocity=4.0)
    assert depth / (found["radius_min"] + found["radius_max"]) == pytest.approx(discs)
    # Craters of eight discs end 2.1 depths below the surface.
    assert 1 <= found["grading_factor"] <= 8 and 2.1 * depth < found["fine_depth"] < 0.5 * found["window_height"]
    # A slab of the window, of which it has sixteen, is as long as its largest disc.
    assert found["grading_factor"] * found["radius_max"] <= max(
        (found["window_behind"] + found["window_ahead"]) / 32, found["radius_max"])


def test_all_lengths_grow_with_the_depth():
    small, large = (cut_sizes(depth, 16, velocity=4.0) for depth in (5e-3, 10e-3))
    for name in small:
        assert large[name] == pytest.approx(small[name] * (1 if name == "grading_factor" else 2)), name


def test_a_row_is_as_far_from_the_next_at_any_speed_and_a_blunt_tooth_is_wider():
    slow, fast = (cut_sizes(5e-3, 8, velocity=velocity) for velocity in (0.5, 8.0))
    assert 0.5 * slow["record_period"] == pytest.approx(8.0 * fast["record_period"]) == pytest.approx(5e-5)
    blunt = cut_sizes(5e-3, 8, velocity=8.0, blunt=2e-3)
    assert blunt == pytest.approx({**fast, "tooth_width": fast["tooth_width"] + 2e-3})


def test_a_long_flat_has_rock_under_it_and_a_rake_far_below_0_its_tooth():
    plain = cut_sizes(5e-3, 8, velocity=8.0)
    long = cut_sizes(5e-3, 8, velocity=8.0, blunt=0.02)
    assert long == pytest.approx({**plain, "tooth_width": plain["tooth_width"] + 0.02, "window_behind": 0.025})
    assert cut_sizes(5e-3, 8, velocity=8.0, rake=math.radians(-20)) == plain == cut_sizes(5e-3, 8, velocity=8.0, rake=1)
    for rake in (math.radians(-40), math.radians(-60)):
        found = cut_sizes(5e-3, 8, velocity=8.0, rake=rake, blunt=2e-3)
        outline = tooth(height=found["tooth_height"], width=found["tooth_width"], rake=rake,
                        clearance=math.radians(5), tip_radius=5e-4)
        assert np.ptp(outline[:, 0]) == pytest.approx(found["tooth_width"])


@pytest.mark.parametrize("depth, discs, velocity, blunt", [
    (0.0, 16, 4.0, 0.0), (5e-3, 0, 4.0, 0.0), (5e-3, -1, 4.0, 0.0), (5e-3, 8, 0.0, 0.0), (5e-3, 8, 4.0, -1e-3)])
def test_sizes_of_nothing_are_refused(depth, discs, velocity, blunt):
    with pytest.raises(ParameterError):
        cut_sizes(depth, discs, velocity=velocity, blunt=blunt)

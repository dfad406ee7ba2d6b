"""Sizes of a cut by its depth and the discs in it."""
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cut_sizes import cut_sizes


@pytest.mark.parametrize("depth", [1e-3, 5e-3, 0.02])
@pytest.mark.parametrize("discs", [4, 16, 64])
def test_as_many_discs_as_asked_for_are_in_the_depth_of_cut(depth, discs):
    found = cut_sizes(depth, discs, velocity=4.0)
    assert depth / (found["radius_min"] + found["radius_max"]) == pytest.approx(discs)
    assert 1 <= found["grading_factor"] <= 8 and found["fine_depth"] > depth
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


@pytest.mark.parametrize("depth, discs, velocity, blunt", [
    (0.0, 16, 4.0, 0.0), (5e-3, 0, 4.0, 0.0), (5e-3, -1, 4.0, 0.0), (5e-3, 8, 0.0, 0.0), (5e-3, 8, 4.0, -1e-3)])
def test_sizes_of_nothing_are_refused(depth, discs, velocity, blunt):
    with pytest.raises(ParameterError):
        cut_sizes(depth, discs, velocity=velocity, blunt=blunt)

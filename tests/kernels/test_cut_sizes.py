"""Sizes of a cut by its depth and the discs in it."""
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cut_sizes import cut_sizes


@pytest.mark.parametrize("depth", [1e-3, 5e-3, 0.02])
@pytest.mark.parametrize("discs", [4, 16, 64])
def test_as_many_discs_as_asked_for_are_in_the_depth_of_cut(depth, discs):
    found = cut_sizes(depth, discs)
    assert depth / (found["radius_min"] + found["radius_max"]) == pytest.approx(discs)
    assert 1 <= found["grading_factor"] <= 8 and found["fine_depth"] > depth
    # A slab of the window, of which it has sixteen, is as long as its largest disc.
    assert found["grading_factor"] * found["radius_max"] <= max(
        (found["window_behind"] + found["window_ahead"]) / 32, found["radius_max"])


def test_all_lengths_grow_with_the_depth():
    small, large = cut_sizes(5e-3, 16), cut_sizes(10e-3, 16)
    for name in small:
        assert large[name] == pytest.approx(small[name] * (1 if name == "grading_factor" else 2)), name


@pytest.mark.parametrize("depth, discs", [(0.0, 16), (5e-3, 0), (5e-3, -1)])
def test_sizes_of_nothing_are_refused(depth, discs):
    with pytest.raises(ParameterError):
        cut_sizes(depth, discs)

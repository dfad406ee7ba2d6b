"""Profiles of grooves that can be drawn by hand."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.groove import craters, exceeded, groove_profile, groove_results


def test_top_of_one_disc_in_bins_beside_it():
    """A disc of radius 5 about (5.5, 2), bins of 1: 5 in its own bin, sqrt(25 - dx^2) from the nearest edge."""
    profile = groove_profile([[5.5, 2.0]], [5.0], [True], np.arange(-1.0, 12.0))
    exact = [2 + math.sqrt(25 - dx**2) for dx in (4.5, 3.5, 2.5, 1.5, 0.5, 0.0, 0.5, 1.5, 2.5, 3.5, 4.5)]
    np.testing.assert_allclose(profile, [math.nan, *exact, math.nan][:12])


def test_the_highest_disc_of_the_mass_counts():
    positions, radii = [[0.5, 0.0], [0.6, 1.0], [0.4, 7.0], [9.0, 9.0]], [0.3, 0.2, 0.3, 0.2]
    profile = groove_profile(positions, radii, [True, True, False, True], [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(profile, [1.2, math.nan, math.nan])
    assert np.isnan(groove_profile(np.empty((0, 2)), [], [], [0.0, 1.0])).all()


def test_small_and_large_discs_reach_their_own_bins():
    profile = groove_profile([[1.5, 0.0], [1.5, 5.0]], [1.4, 0.1], [True, True], np.arange(4.0))
    np.testing.assert_allclose(profile, [math.sqrt(1.4**2 - 0.25), 5.1, math.sqrt(1.4**2 - 0.25)])


def test_a_disc_is_seen_from_bins_that_are_wider_or_uneven():
    profile = groove_profile([[2.0, 0.0], [3.0, -1.0]], [1.5, 0.5], [True, True], [0.0, 1.0, 2.5, 3.2, 9.0])
    np.testing.assert_allclose(profile, [math.sqrt(1.25), 1.5, math.sqrt(2), math.sqrt(0.81)])


def saw(teeth=40, bins=50):
    """(x, height): each stretch of 10 mm falls evenly from the path to 2 mm below it."""
    return (np.arange(teeth * bins) + 0.5) * 10e-3 / bins, -2e-3 * (np.tile(np.arange(bins), teeth) + 0.5) / bins


def test_overbreak_of_a_saw():
    x, height = saw()
    found = {name: value for name, (value, unit) in groove_results(x=x, height=height, chip=10e-3).items()}
    assert found["overbreak"] == pytest.approx(0.9 * 2e-3, abs=2e-3 / 50)
    assert found["mean_overbreak"] == pytest.approx(1e-3)
    assert found["crater_depth"] == pytest.approx(0.99 * 2e-3) == found["largest_overbreak"]
    assert found["crater_depth_standard_error"] == pytest.approx(0, abs=1e-12)
    assert found["standing_rock"] == found["standing_rock_standard_error"] == 0


def test_what_stands_above_is_apart_from_what_lies_below():
    x, height = saw()
    found = {name: value for name, (value, _) in groove_results(x=x, height=height + 1e-3, chip=10e-3).items()}
    assert found["mean_overbreak"] == pytest.approx(0.25e-3) == found["standing_rock"]
    assert found["overbreak"] == pytest.approx(0.8e-3, abs=2e-3 / 50)
    gaps = np.where(height < -1e-3, math.nan, height)
    empty = {name: value for name, (value, _) in groove_results(x=x, height=gaps, chip=10e-3).items()}
    assert empty["mean_overbreak"] == pytest.approx(0.5e-3) and empty["largest_overbreak"] < 1e-3


def test_errors_are_the_scatter_between_grooves():
    """Craters of random depth: the error of one groove is the scatter of many."""
    x = (np.arange(4000) + 0.5) * 2e-4
    found = []
    for seed in range(60):
        deep = 2e-3 * np.random.default_rng(seed).random(80)
        values = groove_results(x=x, height=-np.repeat(deep, 50), chip=10e-3)
        found.append([values[name][0] for part in ("overbreak", "mean_overbreak", "crater_depth")
                      for name in (part, f"{part}_standard_error")])
    value, error = np.std(found, axis=0)[::2], np.mean(found, axis=0)[1::2]
    np.testing.assert_allclose(error, value, rtol=0.25)


def test_exceeded_is_a_quantile():
    depth = np.random.default_rng(1).permutation(np.arange(10001.0))
    assert exceeded(depth, 0.1).value == pytest.approx(9000)
    # The share of independent bins has the error sqrt(0.1 0.9 / n).
    assert exceeded(depth, 0.1).standard_error == pytest.approx(1e4 * math.sqrt(0.09 / 1e4), rel=0.3)
    assert math.isnan(exceeded(np.zeros(0), 0.1).value) and math.isnan(exceeded(np.arange(5.0), 0.1).standard_error)


def test_craters_are_the_deepest_of_whole_stretches():
    x = np.arange(10.0)
    assert craters(x, x, 4.0).tolist() == [3.0, 7.0] and craters(x, x, 20.0).tolist() == []


@pytest.mark.parametrize("chips", [1, 2, 7])
def test_a_groove_of_whole_chips_has_as_many_craters(chips):
    """x are the middles of its bins: the groove is one bin longer than they are apart."""
    x = 1e-4 * (0.5 + np.arange(5 * chips))
    assert craters(x, x, 5e-4) == pytest.approx(x[4::5], rel=1e-12) and len(craters(x[:-1], x[:-1], 5e-4)) == chips - 1
    assert craters(x[:1], x[:1], 5e-4).tolist() == []


@pytest.mark.parametrize("count", [0, 1, 5])
def test_a_short_groove_has_no_errors(count):
    found = groove_results(x=np.arange(count) * 1e-3, height=np.full(count, -1e-3), chip=1e-2)
    assert math.isnan(found["overbreak_standard_error"][0])
    assert found["overbreak"][0] == pytest.approx(1e-3 if count else math.nan, nan_ok=True)


def test_without_chips_there_are_no_craters():
    x, height = saw()
    found = groove_results(x=x, height=height, chip=math.nan)
    assert math.isnan(found["crater_depth"][0]) and found["mean_overbreak"][0] == pytest.approx(1e-3)


def test_a_chip_without_length_is_refused():
    with pytest.raises(ParameterError, match="^chip = 0 m"):
        groove_results(x=[0.0], height=[0.0], chip=0.0)

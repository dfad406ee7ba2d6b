"""The rules of [Rocky] for accelerated wear, on records whose statistics are known."""
import numpy as np
import pytest

from rockwear.kernels.wear_statistics import (
    MIN_BLOCKS, PLACE, PLACES, difference, distribution_error, events_per_particle, middles, place_length, places,
    trusted_wear_acceleration)


def record(generator, spans, burst=1, places=8):
    """Wear of contacts that fall on one place each, by known odds, and stay there for `burst` spans."""
    odds = np.arange(1, places + 1) / np.sum(np.arange(1, places + 1))
    hit = np.repeat(generator.choice(places, size=spans // burst, p=odds), burst)
    return np.eye(places)[hit], odds


@pytest.mark.parametrize("burst", [1, 4])
def test_error_is_that_of_many_runs(burst):
    generator = np.random.default_rng(1)
    found, true = [], []
    for _ in range(200):
        increments, odds = record(generator, 2048, burst)
        found.append(distribution_error(increments))
        true.append(np.abs(increments.mean(axis=0) - odds).sum())
    assert np.mean(found) == pytest.approx(np.mean(true), rel=0.15)


def test_error_falls_with_the_root_of_time():
    generator = np.random.default_rng(2)
    spans = [256, 1024, 4096]
    errors = [np.mean([distribution_error(record(generator, n)[0]) for _ in range(60)]) for n in spans]
    assert np.polyfit(np.log(spans), np.log(errors), 1)[0] == pytest.approx(-0.5, abs=0.06)


def test_a_steady_distribution_has_no_error_whatever_its_intensity():
    increments = np.outer([1, 5, 0, 2, 8, 1, 1, 3, 0, 9], [3.0, 1.0, 0.5])
    assert distribution_error(increments) < 1e-15


def test_too_short_or_no_wear_says_nothing():
    assert np.isnan(distribution_error(np.ones((MIN_BLOCKS - 1, 3))))
    assert np.isnan(distribution_error(np.zeros((20, 3))))
    assert np.isnan(events_per_particle(events=np.zeros(3), worn=np.zeros(3), limit=np.ones(3)))


@pytest.mark.parametrize("side", [0.05, 4e-4])
def test_a_tool_has_places_enough_whatever_its_size(side):
    square = side * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    length = place_length(square)
    assert length == (PLACE if side == 0.05 else pytest.approx(4 * side / PLACES))
    along = np.linspace(0, 1, 401)[1:-1] * side
    found = places(square, np.column_stack([along, np.zeros(399)]))
    assert len(set(found.tolist())) == pytest.approx(side / length, abs=1)
    # A point lies within half a place of the middle of its own; the lower side is the front or behind the tip.
    arc = middles(square, found.max() + 1)[found]
    assert abs(abs(arc) - along).max() < 0.6 * length or abs(abs(arc) - along[::-1]).max() < 0.6 * length


def test_events_count_by_worn_volume():
    found = events_per_particle(events=np.array([30, 2, 7]), worn=np.array([3.0, 1e-3, 0.0]), limit=np.full(3, 0.5))
    assert found == pytest.approx(5.0)


def test_trust_follows_both_rules():
    common = dict(wear_acceleration=1000.0, tolerance=0.1)
    assert trusted_wear_acceleration(error=0.2, events=1e9, **common) == pytest.approx(250)
    assert trusted_wear_acceleration(error=1e-9, events=5.0, **common) == pytest.approx(500)
    # A record too short for the first rule is still judged by the second.
    assert trusted_wear_acceleration(error=np.nan, events=5.0, **common) == pytest.approx(500)
    assert np.isnan(trusted_wear_acceleration(error=np.nan, events=np.nan, **common))


def test_difference_of_distributions():
    assert difference([1, 2, 1], [10, 20, 10]) == pytest.approx(0)
    assert difference([1, 0], [0, 4]) == pytest.approx(2)

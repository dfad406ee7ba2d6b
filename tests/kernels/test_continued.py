"""How a displacement goes on: exact fields, loose points, none."""
import numpy as np
import pytest

from rockwear.kernels.continued import continued

POINTS, WANTED = (np.random.default_rng(1).uniform(low, high, (60, 2)) for low, high in ((-0.3, 0.0), (0.0, 0.1)))


def field(points):
    """A field that the fit can follow exactly, m."""
    x, y = points.T
    return 1e-6 * np.column_stack([3 - 2 * x + 5 * y, 1 + 4 * x - y])


def pressed(points):
    """What the displacement of rock is made of, m, whose surface y = 1 a line load presses 0.8 of its height behind the
    points' end: logarithm of the distance, and angle."""
    x, y = (points + [0.8, -1.0]).T
    return 1e-6 * np.column_stack([np.log(np.hypot(x, y)), np.arctan2(x, -y)])


def test_a_linear_field_goes_on_exactly():
    found = continued(POINTS, field(POINTS), WANTED, tolerance=1e-9, least=30)
    assert found == pytest.approx(field(WANTED), abs=1e-18)


@pytest.mark.parametrize("seed", range(5))
def test_rock_under_load_goes_on(seed):
    chance = np.random.default_rng(seed)
    rock, ahead = (np.column_stack([chance.uniform(*ends, count), chance.uniform(0, 1, count)])
                   for ends, count in (((-0.12, 0), 100), ((0, 0.06), 50)))
    missed = continued(rock, pressed(rock), ahead, tolerance=1e-6, least=50) - pressed(ahead)
    # A parabola over the height with a slope along x misses 0.8 to 1.3 %.
    assert np.sqrt(np.mean(missed**2)) < 0.008 * np.ptp(pressed(ahead), axis=0).max()


def test_loose_points_do_not_tell():
    displaced = field(POINTS)
    displaced[::12] += 2e-5
    assert continued(POINTS, displaced, WANTED, tolerance=8e-6, least=30) == pytest.approx(field(WANTED), abs=1e-17)


def test_too_few_points_tell_nothing():
    assert continued(POINTS, field(POINTS), WANTED, tolerance=1e-9, least=61) is None
    displaced = field(POINTS) + np.where(np.arange(60) % 2, 1e-3, -1e-3)[:, None]
    assert continued(POINTS, displaced, WANTED, tolerance=1e-9, least=30) is None


def test_points_on_a_line_and_points_of_which_most_are_loose_tell_nothing():
    line = np.column_stack([np.linspace(-0.3, 0.0, 60), np.linspace(0.0, 1.0, 60)])
    assert continued(line, field(line), WANTED, tolerance=1e-9, least=30) is None
    displaced = field(POINTS)
    displaced[:25] += np.random.default_rng(2).normal(size=(25, 2))
    assert continued(POINTS, displaced, WANTED, tolerance=1e-2, least=60) is None


def test_many_points_take_as_long_as_some_and_tell_as_much():
    chance = np.random.default_rng(3)
    rock, ahead = (np.column_stack([chance.uniform(*ends, count), chance.uniform(0, 1, count)])
                   for ends, count in (((-0.12, 0), 6000), ((0, 0.06), 50)))
    missed = continued(rock, pressed(rock), ahead, tolerance=1e-6, least=50) - pressed(ahead)
    assert np.sqrt(np.mean(missed**2)) < 0.008 * np.ptp(pressed(ahead), axis=0).max()

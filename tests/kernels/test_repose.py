"""Surface and flanks of a heap whose slope is known, and the relation of the literature."""
import math

import numpy as np
import pytest

from rockwear.kernels import repose
from rockwear.kernels.checks import ParameterError

R, HALF, DEPTH = 1e-3, 0.03, 8e-3


def wedge(left, right, *, hole=()):
    """Positions of grains whose tops lie on a wedge, side by side, with these slopes; hole: numbers left out."""
    x, z = np.meshgrid(np.arange(-HALF, HALF + R / 2, R / 2), np.arange(-DEPTH / 2, DEPTH / 2 + R / 2, R / 2))
    y = 0.025 - np.where(x < 0, left, right) * abs(x)
    places = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    return np.delete(places, hole, axis=0)


def measured(places, **options):
    x, heights = repose.surface(places, np.full(len(places), R),
                                **{"half_length": HALF, "half_depth": DEPTH / 2, "cell": 2 * R, **options})
    return x, heights, repose.flanks(x, heights, HALF)


def test_slopes_of_a_wedge_come_back_side_by_side():
    x, heights, found = measured(wedge(0.4, 0.6))
    assert heights.shape == (30, 4) and x == pytest.approx(HALF * ((2 * np.arange(30) + 1) / 30 - 1))
    assert found[found[:, 0] == -1, 1] == pytest.approx(0.4, rel=5e-3) and len(found) == 8
    assert found[found[:, 0] == 1, 1] == pytest.approx(0.6, rel=5e-3)
    # Grains side by side on a slope m are R sqrt(1 + m^2) below their envelope.
    assert found[found[:, 0] == 1, 2] == pytest.approx(0.025 + R * math.sqrt(1.36), rel=5e-3)


def test_the_error_is_that_of_the_sides_where_they_differ():
    mean, error = repose.angle(measured(wedge(0.4, 0.6))[2])
    low, high = math.atan(0.4), math.atan(0.6)
    assert mean == pytest.approx(0.5 * (low + high), rel=5e-3) and error == pytest.approx(0.5 * (high - low), rel=0.02)
    assert repose.angle(measured(wedge(0.5, 0.5))[2])[1] < 0.01


def test_a_hole_of_one_grain_does_not_reach_the_ground():
    places = wedge(0.5, 0.5)
    middle = np.argsort(np.linalg.norm(places - [0.015, 0.0175, 0.0], axis=1))[:9]
    assert repose.angle(measured(np.delete(places, middle, axis=0))[2])[0] == pytest.approx(math.atan(0.5), rel=0.02)


def test_the_top_of_one_sphere():
    _, heights, found = measured(np.array([[R, 2 * R, R]]), half_length=2 * R, half_depth=2 * R)
    # Mean height of a hemisphere's points that are sampled: 12 of the 16 lie under the sphere.
    points = (np.arange(4) - 1.5) / 2
    under = 1 - points[:, None]**2 - points**2
    expected = R * (2 + np.sqrt(under[under > 0]).mean())
    assert heights[1, 1] == pytest.approx(expected) and np.isnan(np.delete(heights.ravel(), 3)).all()
    assert len(found) == 0 and all(map(math.isnan, repose.angle(found)))


def test_grains_below_the_plate_are_no_heap():
    assert np.isnan(measured(wedge(0.4, 0.4) - [0, 0.1, 0])[1]).all()


def test_the_relation_of_zhou_and_others():
    values = dict(friction=0.5, wall_friction=0.5, rolling=5e-5, wall_rolling=5e-5, diameter=5e-3)
    expected = 68.61 * 0.5**0.49 * 0.05**0.18 * 5**-0.2
    assert math.degrees(repose.zhou(**values)) == pytest.approx(expected)
    assert repose.zhou(**{**values, "rolling": 0.0}) == 0.0
    for name, value in (("friction", -0.1), ("diameter", 0.0)):
        with pytest.raises(ParameterError, match=name):
            repose.zhou(**{**values, name: value})

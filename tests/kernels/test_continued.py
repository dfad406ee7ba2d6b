"""How a displacement goes on: exact fields, loose points, none."""
import numpy as np
import pytest

from rockwear.kernels.continued import continued

POINTS, WANTED = (np.random.default_rng(1).uniform(low, high, (60, 2)) for low, high in ((-0.3, 0.0), (0.0, 0.1)))


def field(points):
    """A field that the fit can follow, m."""
    x, y = points.T
    return 1e-6 * np.column_stack([3 - 2 * x + 5 * y**2, 1 + 4 * x * y - y])


def test_a_field_of_its_kind_goes_on_exactly():
    found = continued(POINTS, field(POINTS), WANTED, tolerance=1e-9, least=30)
    assert found == pytest.approx(field(WANTED), abs=1e-18)


def test_loose_points_do_not_tell():
    displaced = field(POINTS)
    displaced[::12] += 2e-5
    assert continued(POINTS, displaced, WANTED, tolerance=8e-6, least=30) == pytest.approx(field(WANTED), abs=1e-17)


def test_too_few_points_tell_nothing():
    assert continued(POINTS, field(POINTS), WANTED, tolerance=1e-9, least=61) is None
    displaced = field(POINTS) + np.where(np.arange(60) % 2, 1e-3, -1e-3)[:, None]
    assert continued(POINTS, displaced, WANTED, tolerance=1e-9, least=30) is None

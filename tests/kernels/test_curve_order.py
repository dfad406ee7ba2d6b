"""The order of points along Morton's curve."""
import numpy as np
import pytest

from rockwear.kernels.curve_order import curve_order


def test_four_by_four_cells_are_passed_in_a_z_of_zs():
    cells = np.array([(x, y) for y in range(4) for x in range(4)])
    along = cells[curve_order(cells)]
    assert along[:8].tolist() == [[0, 0], [1, 0], [0, 1], [1, 1], [2, 0], [3, 0], [2, 1], [3, 1]]
    assert along[8:].tolist() == (along[:8] + [0, 2]).tolist()


def test_eight_cells_in_space_and_points_of_one_cell_keep_their_order():
    cells = np.array([(x, y, z) for x in (1, 0) for y in (1, 0) for z in (1, 0)] + [(0, 0, 0)])
    assert curve_order(cells).tolist() == [7, 8, 3, 5, 1, 6, 2, 4, 0]


@pytest.mark.parametrize("dimensions, most", [(2, 0.05), (3, 0.12)])
def test_neighbours_on_the_curve_are_near_in_space(dimensions, most):
    points = np.random.default_rng(1).random((4096, dimensions))
    order = curve_order(points)
    assert sorted(order) == list(range(4096))
    steps = np.linalg.norm(np.diff(points[order], axis=0), axis=1)
    # Scattered points are 0.52 and 0.66 apart; 4096 points in even cells 1/64 and 1/16.
    assert steps.mean() < most

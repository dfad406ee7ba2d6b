"""A field that moves inwards with the surface that accelerated wear removes; points outside of a boundary."""
import numpy as np
import pytest

from rockwear.kernels.boundary import prism, segments
from rockwear.kernels.packing import contacts
from rockwear.kernels.polygon import inside
from rockwear.kernels.surface_recession import neighbours, outside, receded


def chain(count):
    return neighbours(np.column_stack([np.arange(count - 1), np.arange(1, count)]), count)


def lattice(columns, rows, *, triangular):
    """Discs of unit diameter, rows from the top; positions and what touches."""
    x = np.array([(i + 0.5 * triangular * (j % 2), -j * (np.sqrt(0.75) if triangular else 1.0))
                  for j in range(rows) for i in range(columns)])
    return x, neighbours(contacts(x, np.full(len(x), 0.5), 1e-6), len(x))


@pytest.mark.parametrize("capacity", [1.0, 7.3])
def test_on_a_chain_the_field_moves_by_one_particle(capacity):
    field = 300 + 50 * np.exp(-np.arange(20) / 3)
    found = receded(temperature=field, capacity=np.full(20, capacity), adjacent=chain(20), leaving=[0], share=1.0)
    assert found[1:] == pytest.approx(field[:-1], rel=1e-12)
    # Which leaves with the heat of the last one.
    assert found[0] == pytest.approx(field[-1], rel=1e-12)


def test_several_leave_one_after_another():
    field = 300 + 50 * np.exp(-np.arange(20) / 3)
    found = receded(temperature=field, capacity=np.ones(20), adjacent=chain(20), leaving=[0, 1, 2], share=1.0)
    assert found[3:] == pytest.approx(field[:-3], rel=1e-12)


@pytest.mark.parametrize("leaving", [[0, 1, 2], [2, 1, 0], [1, 0, 2]])
def test_of_several_that_leave_at_once_none_takes_heat_along(leaving):
    """A particle whose neighbours have left before it transfers its heat to the nearest that are left."""
    field = np.array([400.0, 350.0, 380.0] + 17 * [300.0])
    found = receded(temperature=field, capacity=np.ones(20), adjacent=chain(20), leaving=leaving, share=1.0)
    assert found[3:].sum() == pytest.approx(17 * 300 + 100 + 50 + 80, rel=1e-12)
    assert found[:3] == pytest.approx(3 * [300], rel=1e-12)


def test_wear_that_is_not_accelerated_takes_its_heat():
    field = 300 + 50 * np.exp(-np.arange(20) / 3)
    found = receded(temperature=field, capacity=np.ones(20), adjacent=chain(20), leaving=[0], share=0.0)
    assert np.array_equal(found, field)


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_of_an_accelerated_recession_the_real_part_is_left_out(share):
    field = 300 + 50 * np.exp(-np.arange(40) / 3)
    found = receded(temperature=field, capacity=np.ones(40), adjacent=chain(40), leaving=[0], share=share)
    assert found[1:] == pytest.approx(share * field[:-1] + (1 - share) * field[1:], rel=1e-12)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_heat_stays_and_nothing_gets_hotter_than_what_was_there(seed):
    chance = np.random.default_rng(seed)
    x, adjacent = lattice(12, 9, triangular=True)
    field, capacity = chance.uniform(280, 900, len(x)), chance.uniform(0.1, 10, len(x))
    leaving = chance.permutation(24)[:15]
    capacity[chance.integers(24, len(x), 10)] = 0.0
    present = capacity > 0
    leaving = [k for k in leaving if present[k]]
    found = receded(temperature=field, capacity=capacity, adjacent=adjacent, leaving=leaving, share=0.999)
    assert capacity @ found == pytest.approx(capacity @ field, rel=1e-14)
    assert found[present].max() <= field[present].max() * (1 + 1e-14)
    assert found[present].min() >= field[present].min() * (1 - 1e-14)
    assert np.array_equal(found[~present], field[~present])


def test_a_warm_body_wears_warm():
    x, adjacent = lattice(12, 9, triangular=True)
    field = np.full(len(x), 500.0)
    assert np.array_equal(receded(temperature=field, capacity=np.ones(len(x)), adjacent=adjacent, leaving=range(24),
                                  share=1.0), field)


@pytest.mark.parametrize("triangular", [False, True])
@pytest.mark.parametrize("depth", [1.0, 3.0])
def test_a_flat_face_that_loses_four_rows_keeps_its_heat_and_its_temperature(triangular, depth):
    """Less than 1 % of the heat in the layer that is left is lost; without the kernel it would be 70 to 98 %."""
    x, adjacent = lattice(30, 30, triangular=triangular)
    field = np.exp(x[:, 1] / depth)
    order = np.concatenate([30 * row + np.random.default_rng(row).permutation(30) for row in range(4)])
    found = receded(temperature=field, capacity=np.ones(len(x)), adjacent=adjacent, leaving=order, share=1.0)
    assert found[120:].sum() == pytest.approx(field.sum(), rel=0.01) and field[120:].sum() < 0.32 * field.sum()
    assert found[120:150] == pytest.approx(1.0, rel=1e-9)
    rows = found[120:].reshape(-1, 30).mean(axis=1)
    assert np.all(np.diff(rows) <= 1e-12)


def test_the_last_one_takes_its_heat():
    found = receded(temperature=np.array([500.0, 300.0]), capacity=np.array([1.0, 0.0]), adjacent=chain(2), leaving=[0],
                    share=1.0)
    assert np.array_equal(found, [500.0, 300.0])


NOTCHED = 1e-2 * np.array([[0, 0], [5, 0], [5, 4], [3, 4], [3, 1], [2, 1], [2, 4], [0, 4]])


def test_points_outside_of_a_notched_polygon():
    points = np.random.default_rng(0).uniform(-0.01, 0.06, (2000, 2))
    found = outside(points, *segments(NOTCHED))
    assert np.array_equal(found, ~inside(points, NOTCHED)) and 0.3 < found.mean() < 0.9


def test_points_outside_of_a_notched_prism():
    points = np.random.default_rng(0).uniform([-0.01, -0.01, -0.02], [0.06, 0.05, 0.02], (2000, 3))
    found = outside(points, *prism(NOTCHED, 0.02, 0.01))
    assert np.array_equal(found, ~(inside(points[:, :2], NOTCHED) & (abs(points[:, 2]) < 0.01)))


def test_no_points_are_outside_of_nothing():
    assert outside(np.empty((0, 2)), *segments(NOTCHED)).tolist() == []

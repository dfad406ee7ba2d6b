"""The membrane: which discs it touches, and what its pressure adds up to."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.membrane import pressure_forces, upper_chain


def rows(count, columns, radius=1e-3):
    """(n, 2) m, rows of touching discs, each on the gaps of the one below."""
    return np.array([(2 * radius * (k + 0.5 * (row % 2)), math.sqrt(3) * radius * row)
                     for row in range(count) for k in range(columns)])


def test_the_membrane_touches_the_upper_row_alone():
    places = rows(4, 10)
    chain = upper_chain(places, np.full(40, 1e-3), ball=1e-3)
    # The lowest disc at the left and the row below's at the right lie beside the upper row.
    assert [i for i in chain.tolist() if i >= 30] == list(range(30, 40))
    assert set(chain.tolist()) <= {*range(30, 40), 20}


@pytest.mark.parametrize("ball, inside", [(0.5e-3, True), (4e-3, False)])
def test_a_large_ball_bridges_a_gap(ball, inside):
    """A disc at the bottom of a gap as wide as 1.5 discs."""
    x = np.array([0, 2, 4, 7.5, 9.5, 11.5, 5.75]) * 1e-3
    places = np.column_stack([x, [0, 0, 0, 0, 0, 0, -2.5e-3]])
    assert (6 in upper_chain(places, np.full(7, 1e-3), ball=ball)) == inside


def test_it_runs_in_the_order_of_x_whatever_the_order_of_the_discs():
    rng = np.random.default_rng(2)
    places, radii = rng.uniform(0, 0.03, (400, 2)), rng.uniform(1e-3, 1.5e-3, 400)
    chain = upper_chain(places, radii, ball=1.5e-3)
    assert (np.diff(places[chain, 0]) >= 0).all()
    shuffled = rng.permutation(400)
    assert shuffled[upper_chain(places[shuffled], radii[shuffled], ball=1.5e-3)].tolist() == chain.tolist()
    # No disc lies above the chain by more than the ball can bridge.
    under = np.interp(places[:, 0], places[chain, 0], places[chain, 1])
    assert (places[:, 1] - under).max() < 1.5e-3 * 1.5


def test_a_level_chain_carries_pressure_times_length():
    chain = np.array([(1e-3, 0.02), (3e-3, 0.02), (5e-3, 0.02)])
    forces = pressure_forces(chain, 1e6, begin=0.0, end=6e-3)
    assert forces == pytest.approx(np.array([(0, -2e3), (0, -2e3), (0, -2e3)]), abs=1e-9)


def test_a_pressure_on_any_chain_has_the_resultant_of_its_ends():
    rng = np.random.default_rng(3)
    chain = np.column_stack([np.sort(rng.uniform(0, 1, 20)), rng.uniform(0, 0.3, 20)])
    total = pressure_forces(chain, 2e6, begin=-0.1, end=1.2).sum(axis=0)
    assert total == pytest.approx([2e6 * (chain[-1, 1] - chain[0, 1]), -2e6 * 1.3], rel=1e-12)


def test_a_ball_without_size_is_refused():
    with pytest.raises(ParameterError, match="ball = 0 m: must be greater than 0"):
        upper_chain(np.zeros((2, 2)), np.ones(2), ball=0)

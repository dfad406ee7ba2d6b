"""Grains: a partition of an assembly into Voronoi cells of a mean edge."""
import math

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.grains import CELL, grains

SPACING = 1e-3


def disturbed(n, dimensions, seed=0):
    """A square or cubic lattice of n per side, its points moved by up to a third of the spacing."""
    axes = [np.arange(n) * SPACING] * dimensions
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, dimensions)
    return points + np.random.default_rng(seed).uniform(-0.3, 0.3, points.shape) * SPACING


POINTS = disturbed(60, 2)
VOLUME = (60 * SPACING)**2


@pytest.mark.parametrize("points, volume, edge, cell", [
    (POINTS, VOLUME, 4e-3, 1.5 * math.sqrt(3)), (disturbed(22, 3), (22e-3)**3, 2e-3, 8 * math.sqrt(2))])
def test_grains_have_the_mean_size_of_cells_of_that_edge(points, volume, edge, cell):
    label = grains(points, volume=volume, edge=edge, seed=1)
    count = label.max() + 1
    assert label.shape == (len(points),) and np.array_equal(np.unique(label), np.arange(count))
    assert volume / count == pytest.approx(cell * edge**points.shape[1], rel=0.5 / count + 1e-9)
    assert CELL[points.shape[1]] == pytest.approx(cell)
    sizes = np.bincount(label)
    # Seeds at random give a scatter of 0.53 in the plane; those that have evened out much less.
    assert sizes.std() / sizes.mean() < 0.3


def test_the_edges_between_grains_are_as_long_as_those_of_hexagons():
    """In space of straight boundaries: total length of boundary is 3 edges a grain, counted by lines that cross it."""
    edge = 4e-3
    label = grains(POINTS, volume=VOLUME, edge=edge, seed=2).reshape(60, 60)
    across = np.sum(label[:, 1:] != label[:, :-1]) + np.sum(label[1:] != label[:-1])
    # Horizontal and vertical lines cross a boundary of random direction 4/pi times for each of its spacings.
    length = across * SPACING * math.pi / 4
    assert length / (label.max() + 1) == pytest.approx(3 * edge, rel=0.12)


def test_every_grain_is_in_one_piece():
    label = grains(POINTS, volume=VOLUME, edge=4e-3, seed=3)
    triangles = Delaunay(POINTS).simplices
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
    inner = pairs[label[pairs[:, 0]] == label[pairs[:, 1]]]
    pieces = connected_components(coo_matrix((np.ones(len(inner)), inner.T), shape=(3600, 3600)), directed=False)[0]
    assert pieces == label.max() + 1


def test_the_seed_decides():
    first, again, other = (grains(POINTS, volume=VOLUME, edge=3e-3, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(first, again) and not np.array_equal(first, other)


def test_a_grain_of_one_particle_each():
    edge = math.sqrt(VOLUME / len(POINTS) / CELL[2])
    label = grains(POINTS, volume=VOLUME, edge=edge * (1 + 1e-9), seed=1)
    assert np.array_equal(np.sort(label), np.arange(len(POINTS)))


@pytest.mark.parametrize("edge, rule", [(-1e-3, "greater than 0"), (math.nan, "finite"), (0.3, "at most 0.0215"),
                                        (0.5e-3, "at least 0.00062"), (1e-300, "at least 0.00062"),
                                        (1e300, "at most 0.0215")])
def test_refusals(edge, rule):
    with pytest.raises(ParameterError, match=f"^grain_edge = .*{rule}"):
        grains(POINTS, volume=VOLUME, edge=edge, seed=1)

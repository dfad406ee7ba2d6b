"""Grains that do not touch, and walls without gaps."""
import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from rockwear.kernels.checks import ParameterError
from rockwear.model.granular import DrainedBox, TubeBox, poured

FILL = dict(low=(-0.02, -0.01), high=(0.03, 0.01), count=500, radius_min=1e-3, radius_max=2e-3, density=2000.0)


def area(triangles):
    return 0.5 * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]),
                                axis=1).sum()


def rims(triangles):
    """Edges that belong to one triangle only, as pairs of rounded corners."""
    edges = {}
    for corners in np.round(triangles, 9).tolist():
        for a, b in zip(corners, corners[1:] + corners[:1]):
            edge = frozenset([tuple(a), tuple(b)])
            edges[edge] = edges.get(edge, 0) + 1
    return [edge for edge, count in edges.items() if count == 1]


@pytest.mark.parametrize("seed", range(3))
def test_poured_grains_touch_neither_each_other_nor_the_walls(seed):
    grains = poured(seed=seed, **FILL)
    distance, other = cKDTree(grains.positions).query(grains.positions, 2)
    assert (distance[:, 1] > grains.radii + grains.radii[other[:, 1]]).all() and grains.count == 500
    x, y, z = grains.positions.T
    for low, high, place in ((-0.02, 0.03, x), (-0.01, 0.01, z)):
        assert (place - grains.radii >= low - 1e-12).all() and (place + grains.radii <= high + 1e-12).all()
    assert (y - grains.radii > 0).all()


def test_masses_are_those_of_spheres():
    grains = poured(seed=1, **FILL)
    assert grains.masses == pytest.approx(2000 * 4 / 3 * math.pi * grains.radii**3)
    assert grains.inertias == pytest.approx(0.4 * grains.masses * grains.radii**2)


def test_a_slot_of_one_grain_and_none():
    one = poured(seed=1, **{**FILL, "low": (-0.02, -2.1e-3), "high": (0.02, 2.1e-3)})
    assert (abs(one.positions[:, 2]) <= 0.1e-3 + 1e-12).all()
    with pytest.raises(ParameterError, match="radius_max = 0.002 m: must be at most 0.0019"):
        poured(seed=1, **{**FILL, "low": (-0.02, -1.9e-3), "high": (0.02, 1.9e-3)})


def test_walls_of_the_box_that_is_drained():
    box = DrainedBox(half_length=0.07, opening=0.03, depth=0.02, height=0.2)
    assert area(box.gates) == pytest.approx(2 * 0.03 * 0.02)
    assert area(box.walls) == pytest.approx(0.14 * 0.02 + 2 * 0.23 * 0.02 + 2 * 0.2 * 0.23)


def test_a_rough_plate_is_covered_with_grains():
    places = DrainedBox(half_length=0.07, opening=0.03, depth=0.02, height=0.2).rough_plate(5e-3)
    assert len(places) == 28 * 4 and (abs(places) <= [0.0675 + 1e-12, 0, 0.0075 + 1e-12]).all()
    assert cKDTree(places).query(places, 2)[0][:, 1] == pytest.approx(5e-3)


def test_the_tube_is_open_to_the_box_and_closed_elsewhere():
    box = TubeBox(width=0.044, depth=0.032, height=0.1, diameter=0.02, length=0.08, axis=0.014)
    hole = 16 * 0.01**2 * math.tan(math.pi / 16)
    side = 0.032 * 0.1
    expected = 0.044 * 0.032 + side + 2 * 0.044 * 0.1 + (side - hole) + 32 * 0.01 * math.tan(math.pi / 16) * 0.08 + hole
    assert area(box.walls) == pytest.approx(expected)
    # The only rim that is left is that of the open top; the sides of the box have their own diagonals.
    assert all(corner[1] == pytest.approx(0.1) for edge in rims(box.walls) for corner in edge)
    assert box.tube_volume == pytest.approx(math.pi * 0.01**2 * 0.08)
    # The polygon lies around the circle.
    middles = 0.5 * (box.ring + np.roll(box.ring, 1, axis=0)) - [0, 0.014, 0]
    assert np.linalg.norm(middles, axis=1) == pytest.approx(0.01)

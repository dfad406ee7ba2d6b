"""Fragments of made-up rock, whose sizes can be done by hand."""
import math

import numpy as np
import pytest

from rockwear.kernels.fragments import LEAST_PARTICLES, chip_length, fragments, free_fragments, size_distribution

R = 1e-3
AREA = math.pi * R**2


def bar(columns, rows, at=(0.0, 0.0), turn=0.0):
    """Discs of a bar of touching discs, turned about its first: positions and the pairs of neighbours."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    points = 2 * R * np.column_stack([x.ravel(), y.ravel()])
    gaps = np.linalg.norm(points[:, None] - points, axis=2)
    turned = points @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    return turned + at, np.argwhere(np.triu(gaps < 2.01 * R, 1))


def rock():
    """A mass of 6 x 3 discs, of which the lowest are anchored; a turned bar of 5 x 2; one disc."""
    parts = [bar(6, 3), bar(5, 2, at=(0.02, 0.01), turn=0.7), bar(1, 1, at=(0.05, 0.0))]
    first = np.cumsum([0] + [len(points) for points, _ in parts])
    positions = np.vstack([points for points, _ in parts])
    pairs = np.vstack([pairs + start for (_, pairs), start in zip(parts, first)])
    anchored = np.zeros(len(positions), bool)
    anchored[:6] = True
    return dict(positions=positions, pairs=pairs, intact=np.ones(len(pairs), bool), anchored=anchored,
                areas=np.full(len(positions), AREA))


def test_sizes_of_a_turned_bar_and_of_one_disc():
    found = fragments(**rock())
    assert found.label.tolist() == [-1] * 18 + [0] * 10 + [1]
    assert found.particles.tolist() == [10, 1]
    np.testing.assert_allclose(found.area, [10 * AREA, AREA])
    np.testing.assert_allclose(found.length, [10 * R, 2 * R])
    np.testing.assert_allclose(found.thickness, [4 * R, 2 * R])
    middle = np.array([0.02, 0.01]) + [4 * R * math.cos(0.7) - R * math.sin(0.7),
                                       4 * R * math.sin(0.7) + R * math.cos(0.7)]
    np.testing.assert_allclose(found.centre, [middle, [0.05, 0.0]])


@pytest.mark.parametrize("pairs, held, gone", [
    ([], [], [0, 1]), ([[0, 1], [18, 19]], [], [0, 1]), ([[5, 20]], [], [1]), ([[28, 20]], [], []),
    ([], [27], [1]), ([[28, 3]], [], [0]), ([], [2], [0, 1])])
def test_pieces_are_free_that_neither_rock_nor_another_piece_nor_anything_else_touches(pairs, held, gone):
    label = fragments(**rock()).label
    found = free_fragments(label, pairs, np.array(held, int))
    assert found.tolist() == [piece in gone for piece in label.tolist()]


def test_a_broken_row_frees_what_stands_on_it():
    values = rock()
    upper = values["pairs"].max(axis=1) >= 6
    values["intact"] = ~(upper & (values["pairs"].min(axis=1) < 6))
    found = fragments(**values)
    assert found.particles.tolist() == [12, 10, 1]
    np.testing.assert_allclose((found.length[0], found.thickness[0]), (12 * R, 4 * R))


def test_extents_use_the_size_of_each_disc_and_moments_their_areas():
    """Two discs of radii 1 and 3 mm side by side: 8 mm long, 6 mm thick; the centre is nearer to the larger."""
    radii = np.array([1e-3, 3e-3])
    found = fragments(pairs=[[0, 1]], intact=[True], positions=[[0, 0], [0, 4e-3]], areas=math.pi * radii**2,
                      anchored=[False, False])
    assert (found.length[0], found.thickness[0]) == pytest.approx((8e-3, 6e-3))
    np.testing.assert_allclose(found.centre, [[0, 3.6e-3]], atol=1e-15)


def test_the_longer_extent_is_the_length_wherever_most_of_the_area_is():
    """Five discs in a row of 10 mm, and a splinter that stands 20 mm off."""
    x, radii = np.array([-4e-3, -2e-3, 0, 2e-3, 4e-3, 0]), np.array([R] * 5 + [0.1 * R])
    found = fragments(pairs=[[0, k] for k in range(1, 6)], intact=[True] * 5, areas=math.pi * radii**2,
                      positions=np.column_stack([x, [0] * 5 + [20e-3]]), anchored=[False] * 6)
    assert (found.length[0], found.thickness[0]) == pytest.approx((21.1e-3, 10e-3))


def test_nothing_loose_and_nothing_at_all():
    whole = rock()
    whole["anchored"][:] = True
    empty = fragments(pairs=np.empty((0, 2), int), intact=[], positions=np.empty((0, 2)), areas=[], anchored=[])
    for found in (fragments(**whole), empty):
        assert len(found.length) == len(found.area) == len(found.particles) == len(found.centre) == 0
        assert np.all(found.label == -1)


def test_chip_length_is_weighted_with_areas_and_leaves_dust_out():
    found = chip_length(particles=[10, LEAST_PARTICLES, LEAST_PARTICLES - 1], area=[3.0, 1.0, 50.0],
                        length=[1.0, 5.0, 0.1])
    assert found == pytest.approx((2.0, math.sqrt(2 * 18) / 4))
    assert math.isnan(chip_length(particles=[1], area=[1.0], length=[1.0]).value)


def test_size_distribution():
    lengths, share = size_distribution(area=[1.0, 2.0, 5.0], length=[3e-3, 1e-3, 2e-3])
    assert lengths.tolist() == [1e-3, 2e-3, 3e-3] and share.tolist() == [0.25, 0.875, 1.0]
    assert len(size_distribution(area=[], length=[])[0]) == 0

"""Volume balance of a body of particles under both removal rules, its surface, and detached pieces."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.erosion import Erosion

R = 0.5e-3


def block(nx, ny, rule="volume"):
    """A block of nx by ny discs on a square lattice, open at the left (x = 0), fixed at the right."""
    index = np.arange(nx * ny).reshape(nx, ny)
    pairs = np.concatenate([np.column_stack([index[:-1].ravel(), index[1:].ravel()]),
                            np.column_stack([index[:, :-1].ravel(), index[:, 1:].ravel()])])
    return Erosion(radii=np.full(nx * ny, R), volumes=np.full(nx * ny, 4 * R * R), pairs=pairs, surface=index[0],
                   fixed=index[-1], rule=rule)


def rub(body, total, visits):
    """Wear `total` m3 off the surface, evenly, in equal visits."""
    for _ in range(visits):
        volume = np.zeros(len(body.volumes))
        surface = sorted(body.surface)
        volume[surface] = total / visits / len(surface)
        body.wear(volume)


@pytest.mark.parametrize("visits", [7, 100, 1000])
def test_conserving_rule_removes_archards_volume_exactly(visits):
    """k F s / H = 30.5 cells off a block whose cells hold 4 r^2: 30 whole particles and half a one stored."""
    body = block(20, 6)
    rub(body, 30.5 * 4 * R * R, visits)
    balance = body.volume_balance()
    assert abs(balance["unexplained"]) < 1e-12 * balance["archard"]
    assert balance["removed"] + balance["stored"] == pytest.approx(30.5 * 4 * R * R, rel=1e-12)
    # Even wear takes whole columns; within a column the last particles may still be standing.
    assert balance["removed"] == pytest.approx(30 * 4 * R * R, abs=1e-12)


def test_depth_rule_equals_archard_only_on_the_square_lattice():
    """The depth 2 r over 2 r b is the cell 4 r^2 of a square lattice, but 4/pi of the disc itself."""
    lattice = block(20, 6, "depth")
    rub(lattice, 12 * 4 * R * R, 1200)
    assert lattice.volume_balance()["unexplained"] == pytest.approx(0, abs=1e-3 * 12 * 4 * R * R)
    discs = Erosion(radii=[R] * 3, volumes=[math.pi * R * R] * 3, pairs=[(0, 1), (1, 2)], surface=[0], fixed=[2],
                    rule="depth")
    discs.wear(np.array([4 * R * R, 0, 0]))
    balance = discs.volume_balance()
    assert balance["removed"] / balance["archard"] == pytest.approx(math.pi / 4)
    assert balance["unexplained"] == pytest.approx((math.pi - 4) * R * R)


def test_excess_goes_to_what_is_uncovered_and_on_through_the_body():
    body = block(5, 1)
    removed, uncovered = body.wear(np.array([2.25 * 4 * R * R, 0, 0, 0, 0]))
    assert removed == [0, 1] and uncovered == [2] and body.surface == {2}
    assert body.stored[2] == pytest.approx(0.25 * 4 * R * R)


def test_excess_crosses_a_gap_to_the_nearest_and_no_further():
    body = block(6, 1)
    body.surface = {0, 2, 5}
    body.wear(np.array([4 * R * R, 0, 0, 0, 0, 0]))
    body.surface.discard(1)
    body.alive[1] = False
    body.alive[3] = False
    before = body.stored.copy()
    body.wear(np.array([0, 0, 1.5 * 4 * R * R, 0, 0, 0]))
    assert body.stored[4] - before[4] == pytest.approx(0.5 * 4 * R * R) and body.stored[5] == before[5]


@pytest.mark.parametrize("gone", [[], [1, 3, 5], [1, 2, 3], [1, 2, 3, 4, 5], [1, 2, 3, 4, 5, 6]])
def test_a_particle_with_part_of_its_neighbours_gone_hands_on_to_the_living_only(gone):
    """The middle one of seven hexagonal discs; beyond each neighbour there is one more."""
    spokes = [(0, i) for i in range(1, 7)] + [(i, i % 6 + 1) for i in range(1, 7)] + [(i, i + 6) for i in range(1, 7)]
    cell = 4 * R * R
    body = Erosion(radii=np.full(13, R), volumes=np.full(13, cell), pairs=spokes, surface=[0], fixed=range(7, 13))
    body.drop(gone)
    volume = np.zeros(13)
    volume[0] = 1.6 * cell
    removed, uncovered = body.wear(volume)
    left = [i for i in range(1, 7) if i not in gone]
    heirs = left or list(range(7, 13))
    assert removed == [0] and uncovered == left
    assert body.stored[heirs] == pytest.approx(0.6 * cell / len(heirs), rel=1e-12)
    assert body.stored.sum() == pytest.approx(0.6 * cell, rel=1e-12)
    assert abs(body.volume_balance()["unexplained"]) < 1e-12 * cell


def test_very_large_wear_in_one_visit_eats_through_to_its_volume():
    """1000 visits' wear at once: as many whole particles go, and the last is worn in part."""
    body = block(40, 5)
    volume = np.zeros(200)
    volume[2] = 100.25 * 4 * R * R
    removed, uncovered = body.wear(volume)
    balance = body.volume_balance()
    assert 90 < len(removed) == (~body.alive).sum() <= 100 and set(uncovered) <= set(np.flatnonzero(body.alive))
    assert abs(balance["unexplained"]) < 1e-12 * balance["archard"] and np.all(body.stored[body.alive] < 4 * R * R)


def test_depth_rule_passes_nothing_on():
    body = block(5, 1, "depth")
    removed, _ = body.wear(np.array([2.25 * 4 * R * R, 0, 0, 0, 0]))
    assert removed == [0] and body.stored.sum() == 0


def test_what_hangs_free_is_found_and_dropped_with_its_volume():
    body = block(4, 1)
    body.surface = {1}
    body.wear(np.array([0, 4 * R * R, 0, 0]))
    assert body.detached().tolist() == [0]
    body.drop([0])
    balance = body.volume_balance()
    assert not body.alive[0] and balance["dropped_pieces"] == pytest.approx(4 * R * R)
    assert abs(balance["unexplained"]) < 1e-12 * 4 * R * R
    assert body.mass_fraction_lost == pytest.approx(0.5)


def test_a_body_worn_away_keeps_its_volume_balance():
    body = block(2, 1)
    body.wear(np.array([10 * 4 * R * R, 0]))
    assert not body.alive.any() and not body.surface
    balance = body.volume_balance()
    assert balance["unassigned"] == pytest.approx(8 * 4 * R * R)
    assert abs(balance["unexplained"]) < 1e-12 * balance["archard"]


@pytest.mark.parametrize("particles_a_visit, visits", [(0.25, 40), (2.5, 8), (8, 3)])
def test_order_of_particles_does_not_matter(particles_a_visit, visits):
    rng = np.random.default_rng(3)
    body, order = block(6, 4), rng.permutation(24)
    place = np.argsort(order)
    shuffled = Erosion(radii=body.radii, volumes=body.volumes, pairs=place[body.pairs],
                       surface=place[sorted(body.surface)], fixed=place[np.flatnonzero(body.fixed)])
    for _ in range(visits):
        wear = rng.uniform(0, particles_a_visit * 4 * R * R, 24)
        volume = np.where(np.isin(np.arange(24), list(body.surface)), wear, 0)
        body.wear(volume)
        shuffled.wear(volume[order])
    assert np.array_equal(body.alive[order], shuffled.alive) and not body.alive.all()
    assert body.stored[order] == pytest.approx(shuffled.stored, abs=1e-18)


def test_a_restored_body_continues_equally():
    body, other = block(6, 4), block(6, 4)
    rub(body, 5 * 4 * R * R, 50)
    other.restore(body.state())
    rub(body, 5 * 4 * R * R, 50), rub(other, 5 * 4 * R * R, 50)
    assert np.array_equal(body.stored, other.stored) and body.surface == other.surface


@pytest.mark.parametrize("change, name", [({"rule": "magic"}, "removal"), ({"pairs": [(0, 9)]}, "pairs"),
                                          ({"surface": [-1]}, "surface"), ({"volumes": [0, 1]}, "volumes")])
def test_bad_input(change, name):
    good = dict(radii=[R, R], volumes=[1e-6, 1e-6], pairs=[(0, 1)], surface=[0])
    with pytest.raises(ParameterError, match=f"^{name} = "):
        Erosion(**{**good, **change})

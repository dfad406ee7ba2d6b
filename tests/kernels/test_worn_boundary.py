"""Wear of boundaries: each update takes exactly the demanded volume, without a fold."""
import math

import numpy as np
import pytest

from rockwear.kernels.boundary import altitudes, area_vectors, check_boundary, crossings, prism, refine, segments
from rockwear.kernels.worn_boundary import LEAST_STRIDE, STRIDE, Folded, WornAway, WornBoundary
from tests.kernels.shapes import BLADE, SQUARE, TOOTH, cube, exact_volume, ring, sphere


def sizes(boundary):
    return np.linalg.norm(area_vectors(boundary.vertices, boundary.facets), axis=1)


def sharpest(boundary):
    """Smallest cosine between the normals of neighbouring facets."""
    normals = area_vectors(boundary.vertices, boundary.facets)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    a, b = boundary.joined.T
    return float(np.einsum("ij,ij->i", normals[a], normals[b]).min())


@pytest.mark.parametrize("make", [cube, lambda: refine(*segments(TOOTH), 2e-3), sphere])
@pytest.mark.parametrize("part", [1e-6, 1e-4, 1e-2])
def test_every_update_takes_exactly_the_demanded_volume(make, part):
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets)
    chance = np.random.default_rng(3)
    due, moved = 0.0, 0
    for _ in range(3):
        demanded = sizes(boundary) * chance.random(len(boundary.facets))
        demanded *= part * boundary.first_volume / demanded.sum()
        due += demanded.sum()
        before = exact_volume(boundary.vertices, boundary.facets)
        if boundary.wear(demanded):
            taken = before - exact_volume(boundary.vertices, boundary.facets)
            assert abs(float(taken) / due - 1) < 1e-9
            due, moved = 0.0, moved + 1
        assert boundary.pending.sum() == pytest.approx(due, rel=1e-12, abs=1e-9 * demanded.sum())
    # The least part is too little to be done to the last digit: it waits.
    assert (moved > 0) == (part > 1e-6 or len(vertices[0]) == 2)


@pytest.mark.parametrize("make", [cube, lambda: refine(*segments(TOOTH), 2e-3), sphere])
def test_one_step_takes_its_volume_whole(make):
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets)
    demanded = sizes(boundary) * np.random.default_rng(3).random(len(facets))
    boundary.pending = demanded * 1e-3 * boundary.first_volume / demanded.sum()
    due = boundary.pending.sum()
    motion, weights, reach = boundary._motion()
    assert reach.max() < STRIDE
    boundary._held_up = np.zeros(len(vertices), bool)
    assert boundary._step(motion, weights, reach)
    taken = exact_volume(vertices, facets) - exact_volume(boundary.vertices, facets)
    assert float(taken) == pytest.approx(due, rel=1e-9)


def test_a_ring_worn_evenly_stays_regular():
    vertices, facets = ring(20)
    boundary = WornBoundary(vertices=vertices, facets=facets)
    for _ in range(20):
        boundary.wear(sizes(boundary) * 1e-4)
    radius = np.linalg.norm(boundary.vertices, axis=1)
    left = 1 - boundary.archard_volume / boundary.first_volume
    assert radius == pytest.approx(np.full(20, 0.01 * left**0.5), rel=1e-12)


def test_a_sphere_worn_evenly_stays_one_to_second_order():
    """Depth q everywhere leaves the radius r - q, but for the second order of the mesh's spacing."""
    errors = []
    for fineness in (3, 4):
        vertices, facets = sphere(fineness)
        boundary = WornBoundary(vertices=vertices, facets=facets)
        for _ in range(40):
            boundary.wear(sizes(boundary) * 5e-5)
        radius = np.linalg.norm(boundary.vertices, axis=1)
        errors.append(np.ptp(radius) / radius.mean())
        assert radius.mean() == pytest.approx(0.01 * (boundary.volume / boundary.first_volume)**(1 / 3), rel=2e-3)
    assert errors[1] < 6e-3 and errors[0] / errors[1] > 2.5


def test_a_cube_worn_evenly_stays_a_cube():
    vertices, facets = cube(2e-3)
    boundary = WornBoundary(vertices=vertices, facets=facets)
    for _ in range(50):
        boundary.wear(sizes(boundary) * 1.6e-2 * boundary.first_volume / sizes(boundary).sum())
    # Facets are a third of the side by now, and the position of its edges known to a part of that.
    side = 0.2**(1 / 3) * 0.01
    assert np.ptp(boundary.vertices, axis=0) == pytest.approx([side] * 3, rel=1e-2)
    inner = np.abs(boundary.vertices - [0.005, 0.005, 0.0]).max(axis=1)
    assert np.median(inner) == pytest.approx(side / 2, rel=5e-3)
    assert inner.max() < 1.02 * side / 2 and inner.min() > 0.9 * side / 2


def test_a_worn_face_recedes_and_leaves_its_neighbours_plane():
    for vertices, facets in (cube(), refine(*segments(SQUARE), 1e-3)):
        boundary = WornBoundary(vertices=vertices, facets=facets)
        for _ in range(50):
            upward = np.maximum(area_vectors(boundary.vertices, boundary.facets)[:, 1], 0)
            boundary.wear(upward * 0.005 * boundary.first_volume / upward.sum())
        top = boundary.vertices[vertices[:, 1] > 0.00999, 1]
        # Corners that crowd are rounded by a facet or so.
        assert np.median(top) == pytest.approx(0.0075, rel=5e-3) and np.ptp(top) < 3e-4
        assert np.ptp(boundary.vertices[:, 0]) == pytest.approx(0.01, rel=2e-2)


def battered(boundary, centre, reach, part, chance):
    """Uneven wear of the facets near the tip whose normals look forwards or downwards."""
    areas = area_vectors(boundary.vertices, boundary.facets)
    away = boundary.vertices[boundary.facets].mean(axis=1)[:, :2] - centre
    demanded = np.maximum(areas[:, 0], 0) + np.maximum(-areas[:, 1], 0)
    demanded *= np.exp(-(away**2).sum(axis=1) / (2 * reach**2)) * chance.random(len(areas))**2
    return demanded * part * boundary.first_volume / demanded.sum()


def fixed(vertices, facets):
    top, back = vertices[:, 1] > vertices[:, 1].max() - 1e-9, vertices[:, 0] < vertices[:, 0].min() + 1e-9
    return top[facets].all(axis=1) | back[facets].all(axis=1)


def worn_down_to(left, boundary, reach, part=1e-3):
    """Uneven wear down to this part of the volume: each update is exact, folds nothing, keeps what is fixed."""
    first, chance = boundary.vertices, np.random.default_rng(5)
    sharp = sharpest(boundary)
    while boundary.volume > left * boundary.first_volume:
        demanded = battered(boundary, [0, 0], reach, part, chance)
        before, broken = boundary.volume, boundary.broken_off
        boundary.wear(demanded)
        lost = before - boundary.volume - (boundary.broken_off - broken)
        assert lost == pytest.approx(demanded[~boundary.fixed].sum(), rel=1e-9)
        assert sharpest(boundary) > min(-0.9, sharp)
    check_boundary(boundary.vertices, boundary.facets)
    there = boundary.vertices[boundary.facets[boundary.fixed]]
    top, back = (abs(there[..., 1] - first[:, 1].max()) < 1e-15), (abs(there[..., 0] - first[:, 0].min()) < 1e-15)
    assert (top.all(axis=1) | back.all(axis=1)).all() and top.any() and back.any()
    assert abs(boundary.volume_balance()["unexplained"]) < 1e-12 * boundary.first_volume


@pytest.mark.parametrize("segment, reach", [
    (1e-3, 5e-3), (2e-3, 10e-3), (1.5e-3, 15e-3), (2e-3, 20e-3), (1.5e-3, 25e-3)])
def test_heavy_uneven_wear_folds_nothing_in_the_plane(segment, reach):
    vertices, facets = refine(*segments(TOOTH), segment)
    worn_down_to(0.52, WornBoundary(vertices=vertices, facets=facets, fixed=fixed(vertices, facets)), reach)


@pytest.mark.parametrize("size, width, reach, left, part", [
    (6e-3, 0.02, 0.02, 0.7, 1e-3), (3e-3, 0.01, 0.02, 0.9, 1e-3), (8e-3, 0.016, 0.01, 0.75, 2e-3)])
def test_heavy_uneven_wear_folds_nothing_in_space(size, width, reach, left, part):
    """Without the check of folds before a step the last of these folds."""
    vertices, facets = prism(TOOTH, width, size)
    worn_down_to(left, WornBoundary(vertices=vertices, facets=facets, fixed=fixed(vertices, facets)), reach, part)


@pytest.mark.parametrize("make, updates", [(lambda: refine(*segments(TOOTH), 0.5e-3), 500),
                                           (lambda: refine(*segments(TOOTH), 1e-3), 500),
                                           (lambda: refine(*segments(TOOTH), 2e-3), 500),
                                           (lambda: prism(TOOTH, 0.008, 4e-3), 100)])
def test_a_clearance_face_worn_evenly_stays_a_face_that_meets_the_back(make, updates):
    """Exact: a layer of 10 mm is gone along the clearance face, and all else is left."""
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets, fixed=fixed(vertices, facets))
    outward = np.array([-math.sin(math.radians(3)), -math.cos(math.radians(3)), 0.0][:boundary.dimension])

    def face():
        areas = area_vectors(boundary.vertices, boundary.facets) @ outward
        return np.where(~boundary.fixed & (areas > 0.8 * sizes(boundary)), areas, 0.0)

    for _ in range(updates):
        before, demanded = boundary.volume + boundary.broken_off, 0.01 / updates * face()
        boundary.wear(demanded)
        assert before - boundary.volume - boundary.broken_off == pytest.approx(demanded.sum(), rel=1e-9)
    corners = boundary.vertices[boundary.facets[face() > 0]].reshape(-1, boundary.dimension)
    gone = (vertices @ outward).max() - corners @ outward
    assert gone[corners[:, 0] < -15e-3] == pytest.approx(0.01, abs=5e-6)
    # The back keeps its line (plane) and ends where the face meets it.
    back = boundary.vertices[boundary.facets[boundary.fixed]].reshape(-1, boundary.dimension)
    back = back[back[:, 0] < -0.0449]
    assert back[:, 0] == pytest.approx(-0.045, abs=1e-15)
    corner = vertices[vertices[:, 0] < -0.0449, 1].min() + 0.01 / math.cos(math.radians(3))
    assert back[:, 1].min() == pytest.approx(corner, abs=5e-5)
    assert boundary.broken_off < 1e-3 * boundary.removed


@pytest.mark.parametrize("make", [lambda: refine(*segments(BLADE), 1e-3), lambda: prism(BLADE, 0.01, 2e-3)])
def test_a_blade_worn_through_from_both_sides_ends_before_its_faces_cross(make):
    vertices, facets = make()
    top = (vertices[facets, 1] > BLADE[:, 1].max() - 1e-9).all(axis=1)
    boundary = WornBoundary(vertices=vertices, facets=facets, fixed=top)
    away = vertices[facets].mean(axis=1) - [0, 0.01, 0][:vertices.shape[1]]
    sides = abs(area_vectors(vertices, facets)[:, 0]) * np.exp(-((away / 3e-3)**2)[:, 1:].sum(axis=1))
    with pytest.raises(Folded, match="worn through"):
        for _ in range(400):
            boundary.wear(sides[boundary.place] * 2e-3 * boundary.first_volume / sides.sum())
    assert boundary.volume > 0.5 * boundary.first_volume
    assert len(crossings(boundary.vertices, boundary.facets)) == 0
    assert abs(boundary.volume_balance()["unexplained"]) < 1e-12 * boundary.first_volume


@pytest.mark.parametrize("make", [lambda: refine(*segments(SQUARE), 1e-3), cube])
def test_a_vertex_of_worn_and_fixed_facets_slides_along_the_fixed_ones(make):
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets, fixed=(vertices[facets, 0] < 1e-9).all(axis=1))
    count = int(boundary.fixed.sum())
    for _ in range(40):
        upward = np.maximum(area_vectors(boundary.vertices, boundary.facets)[:, 1], 0)
        boundary.wear(upward * 1e-4 * ~boundary.fixed + 1e-12 * boundary.fixed)
    assert 20e-12 * count < boundary.on_fixed < 40.1e-12 * count
    assert boundary.removed == pytest.approx(0.4 * boundary.first_volume, rel=1e-2)
    balance = boundary.volume_balance()
    assert balance["removed"] + balance["waiting"] + balance["on_fixed_facets"] == pytest.approx(
        balance["archard"], rel=1e-9)
    wall = boundary.vertices[boundary.facets[boundary.fixed]].reshape(-1, boundary.dimension)
    assert wall[:, 0] == pytest.approx(0.0, abs=1e-15) and wall[:, 1].max() == pytest.approx(0.006, abs=1e-5)
    # Facets are spread again over the worn and the fixed faces.
    assert boundary.fixed.sum() < count and (altitudes(boundary.vertices, boundary.facets) > 0.2 * boundary.size).all()


@pytest.mark.parametrize("make", [lambda: refine(*segments(BLADE), 1e-3), lambda: prism(BLADE, 0.006, 2e-3)])
@pytest.mark.parametrize("reach", [2e-3, 4e-3])
def test_a_feather_edge_breaks_off_and_is_no_wear(make, reach):
    """The sides are worn, most near the end, which is not: the blade becomes a wedge, then a feather edge."""
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets)
    while boundary.volume > 0.7 * boundary.first_volume:
        height = boundary.vertices[boundary.facets].mean(axis=1)[:, 1]
        sides = abs(area_vectors(boundary.vertices, boundary.facets)[:, 0]) * np.exp(-height / reach)
        boundary.wear(3e-3 * boundary.first_volume * sides / sides.sum())
        assert sharpest(boundary) > -0.9
    check_boundary(boundary.vertices, boundary.facets)
    balance = boundary.volume_balance()
    assert 0 < balance["broken_off"] < 0.1 * balance["removed"]
    assert balance["removed"] + balance["waiting"] == pytest.approx(balance["archard"], rel=1e-9)
    assert abs(balance["unexplained"]) < 1e-12 * boundary.first_volume
    # The end has receded by about the length over which the sides are worn.
    assert 0.3 * reach < boundary.vertices[:, 1].min() < 3 * reach


def test_what_waits_is_less_than_the_least_stride_of_a_layer_of_facets():
    vertices, facets = refine(*segments(TOOTH), 1e-3)
    boundary = WornBoundary(vertices=vertices, facets=facets, fixed=fixed(vertices, facets))
    chance, moved = np.random.default_rng(5), 0
    for _ in range(300):
        moved += boundary.wear(battered(boundary, [0, 0], 0.01, 1e-8, chance))
        worn = ~boundary.fixed
        layer = sizes(boundary)[worn].sum() * altitudes(boundary.vertices, boundary.facets)[worn].max()
        assert boundary.pending.sum() < LEAST_STRIDE * layer
    assert 2 < moved < 150


@pytest.mark.parametrize("seed", range(8))
def test_a_little_wear_of_single_large_facets_leaves_no_round_off_that_cannot_move(seed):
    """Round-off assigned to a facet of the shank, which cannot move, ended 10 of 40 such tools as folded."""
    chance = np.random.default_rng(22 + seed)
    vertices, facets = prism(TOOTH, 0.05, 0.02)
    vertices = vertices + np.array([0.3, 0.1, 0.2]) * chance.uniform(-1, 1)
    boundary = WornBoundary(vertices=vertices, facets=facets, fixed=fixed(vertices, facets))
    for _ in range(20):
        demanded, one = np.zeros(len(facets)), chance.choice(np.flatnonzero(~boundary.fixed))
        layer = sizes(boundary)[one] * altitudes(boundary.vertices, boundary.facets)[one]
        demanded[one] = layer * 10**chance.uniform(-4, -3)
        boundary.wear(demanded)
        assert not boundary.pending[boundary.fixed].any()
    # What is less than the least stride waits.
    assert boundary.removed > 0.95 * boundary.archard_volume


def test_little_wear_waits_until_it_can_be_done_to_the_last_digit():
    vertices, facets = refine(*segments(SQUARE), 1e-3)
    boundary = WornBoundary(vertices=vertices, facets=facets)
    demanded = np.full(len(facets), 1e-18)
    assert not boundary.wear(demanded)
    assert boundary.removed == 0 and boundary.pending.sum() == pytest.approx(demanded.sum(), rel=1e-12)
    assert boundary.wear(np.full(len(facets), 1e-9))
    assert boundary.removed == pytest.approx(boundary.archard_volume, rel=1e-9)


@pytest.mark.parametrize("make", [lambda: cube(2.5e-3), lambda: refine(*segments(TOOTH), 4e-3)])
def test_a_tool_worn_away_is_reported_and_keeps_its_balance(make):
    vertices, facets = make()
    boundary = WornBoundary(vertices=vertices, facets=facets)
    with pytest.raises(WornAway, match="% of the volume"):
        for _ in range(1000):
            boundary.wear(sizes(boundary) * 0.02 * boundary.first_volume / sizes(boundary).sum())
    assert boundary.volume < 0.2 * boundary.first_volume
    assert abs(boundary.volume_balance()["unexplained"]) < 1e-12 * boundary.first_volume
    assert np.isfinite(boundary.vertices).all()


def test_one_demand_of_more_than_the_body_ends_at_once():
    vertices, facets = cube()
    boundary = WornBoundary(vertices=vertices, facets=facets)
    with pytest.raises(WornAway):
        boundary.wear(np.full(len(facets), 1.0))
    assert np.array_equal(boundary.vertices, check_boundary(vertices, facets)[0])


def test_numbering_changes_nothing():
    vertices, facets = refine(*segments(TOOTH), 2e-3)
    order = np.random.default_rng(1).permutation(len(vertices))
    place = np.argsort(order)
    turned = np.random.default_rng(2).permutation(len(facets))
    one = WornBoundary(vertices=vertices, facets=facets)
    other = WornBoundary(vertices=vertices[order], facets=place[facets][turned])
    demanded = sizes(one) * np.random.default_rng(3).random(len(facets)) * 1e-5
    for _ in range(5):
        one.wear(demanded)
        other.wear(demanded[turned])
    assert other.vertices[place] == pytest.approx(one.vertices, abs=1e-12)


def test_a_restored_boundary_goes_on_to_the_last_bit():
    vertices, facets = cube()
    one, other = (WornBoundary(vertices=vertices, facets=facets) for _ in range(2))
    demanded = sizes(one) * np.random.default_rng(3).random(len(facets)) * 1e-4
    for _ in range(3):
        one.wear(demanded)
    other.restore(one.state())
    one.wear(demanded), other.wear(demanded)
    assert np.array_equal(one.vertices, other.vertices) and one.removed == other.removed

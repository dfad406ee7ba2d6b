"""The free surface of particles against outlines of known length and area."""
import numpy as np
import pytest
from scipy.spatial import cKDTree

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.packing import pack
from rockwear.kernels.free_surface import free_surface

pi = np.pi


def packed(shape, volume, dimension, fill, seed=0):
    """Particles of radii 1 to 1.5 mm thrown into a container and pushed apart: (positions, radii)."""
    rng = np.random.default_rng(seed)
    radii = rng.uniform(1e-3, 1.5e-3, 100000)
    cover = np.cumsum(pi * radii**2 if dimension == 2 else 4 / 3 * pi * radii**3)
    radii = radii[:np.searchsorted(cover, fill * volume)]
    throw, press = shape
    positions = throw(rng, radii.size)
    for _ in range(300):
        i, j = cKDTree(positions).query_pairs(3e-3, output_type="ndarray").T
        apart = positions[j] - positions[i]
        distance = np.linalg.norm(apart, axis=1)
        push = (0.4 * np.maximum(radii[i] + radii[j] - distance, 0) / distance)[:, None] * apart
        np.add.at(positions, j, push)
        np.add.at(positions, i, -push)
        positions = press(positions, radii)
    return positions, radii


def in_box(*size):
    return (lambda rng, n: rng.uniform(0, 1, (n, len(size))) * size,
            lambda positions, radii: np.clip(positions, radii[:, None], np.array(size) - radii[:, None]))


def in_circle(radius):
    def throw(rng, n):
        angle, reach = rng.uniform(0, 2 * pi, n), radius * np.sqrt(rng.uniform(0, 1, n))
        return np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])

    def press(positions, radii):
        reach = np.linalg.norm(positions, axis=1)
        return positions * np.minimum(1, (radius - radii) / np.maximum(reach, 1e-12))[:, None]
    return throw, press


def grid(*counts):
    return 2.0 * np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, len(counts))


def triangles(nx, ny):
    column, row = np.meshgrid(np.arange(nx), np.arange(ny))
    return np.column_stack([(2.0 * column + row % 2).ravel(), (row * np.sqrt(3)).ravel()])


def unit(positions, **more):
    return free_surface(positions=positions, radii=np.ones(len(positions)), **more)


# ---- few particles

@pytest.mark.parametrize("dimension, whole", [(2, 2 * pi), (3, 4 * pi)])
def test_lone_particles_are_free_all_round(dimension, whole):
    along = np.eye(dimension)[0]
    assert unit([0 * along]) == pytest.approx([whole])
    assert unit([0 * along, 50 * along, 120 * along]) == pytest.approx([whole] * 3)
    assert free_surface(positions=[0 * along], radii=[3.0]) == pytest.approx([whole * 3 ** (dimension - 1)])


def test_pairs_and_chains_wear_a_belt():
    assert unit([[0, 0], [2, 0]]) == pytest.approx([pi + 2] * 2)
    assert unit([[0, 0, 0], [2, 0, 0]]) == pytest.approx([4 * pi] * 2)
    for along in ([1.0, 0.0], [0.6, 0.8], [0.5, 0.5, np.sqrt(0.5)]):
        got = unit(2 * np.arange(7)[:, None] * np.array(along))
        links = (4, 4 * pi)[len(along) - 2]
        ends = (pi, 2 * pi)[len(along) - 2]
        assert got == pytest.approx([ends + links / 2] + 5 * [links] + [ends + links / 2])


def test_belt_of_unequal_discs():
    big, small, gap = 3.0, 1.0, 4.0
    lean = np.arcsin((big - small) / gap)
    got = free_surface(positions=[[0, 0], [gap, 0]], radii=[big, small])
    tangent = np.sqrt(gap**2 - (big - small)**2)
    assert got == pytest.approx([big * (pi + 2 * lean) + tangent, small * (pi - 2 * lean) + tangent])


def test_three_in_a_triangle():
    flat = np.array([[0, 0], [2, 0], [1, np.sqrt(3)]])
    assert unit(flat).sum() == pytest.approx(6 + 2 * pi)
    assert unit(np.column_stack([flat, np.zeros(3)])).sum() == pytest.approx(2 * np.sqrt(3) + 6 * pi + 4 * pi)


def test_no_particle_has_more_than_its_whole_surface():
    assert unit([[0, 0], [4.3, 0]]) == pytest.approx([2 * pi] * 2)


# ---- lattices: exact

def test_square_lattice_is_a_rounded_rectangle():
    got = unit(grid(20, 10))
    assert got.sum() == pytest.approx(2 * (38 + 18) + 2 * pi)
    inside = np.all((grid(20, 10) > 0) & (grid(20, 10) < [38, 18]), axis=1)
    assert np.all(got[inside] == 0) and np.all(got[~inside] > 0)
    assert got[1:9] == pytest.approx(2.0) and got[0] == pytest.approx(2 + pi / 2)


def test_cubic_lattice_is_a_rounded_box():
    got = unit(grid(6, 5, 4))
    assert got.sum() == pytest.approx(2 * (10 * 8 + 8 * 6 + 6 * 10) + 2 * pi * (10 + 8 + 6) + 4 * pi)
    assert (got == 0).sum() == 4 * 3 * 2


def test_sheet_has_two_sides():
    assert unit(np.pad(grid(6, 6), ((0, 0), (0, 1)))).sum() == pytest.approx(2 * 100 + 40 * pi + 4 * pi)


def test_ring_of_discs_has_its_outer_circle():
    count = 60
    angle = 2 * pi * np.arange(count) / count
    centre_circle = 1 / np.sin(pi / count)
    ring = centre_circle * np.column_stack([np.cos(angle), np.sin(angle)])
    filled = np.vstack([ring] + [ring * share for share in np.arange(0.1, 1, 0.1)[::-1]] + [np.zeros((1, 2))])
    got = unit(filled)
    assert got.sum() == pytest.approx(2 * pi * (centre_circle + 1), rel=2e-3)
    assert np.ptp(got[:count]) < 1e-9 and np.all(got[count:] == 0)
    assert unit(ring).sum() == pytest.approx(2 * pi * (centre_circle + 1), rel=2e-3)  # a closed one has no inside
    assert unit(ring[2:]).sum() == pytest.approx(4 * 57 + 2 * pi, rel=1e-3)  # an open one has both sides and two ends


# ---- random packings

@pytest.mark.parametrize("seed", range(3))
def test_random_rectangle_has_its_perimeter(seed):
    positions, radii = packed(in_box(0.06, 0.04), 0.0024, 2, 0.88, seed)
    got = free_surface(positions=positions, radii=radii)
    assert got.sum() == pytest.approx(0.2, rel=0.02)
    assert got.sum() == pytest.approx(0.2 - (8 - 2 * pi) * 1.25e-3, rel=0.015)  # with its corners round
    margin = np.minimum(positions, np.array([0.06, 0.04]) - positions).min(axis=1)
    assert np.all(got[margin > 4e-3] == 0)


@pytest.mark.parametrize("seed", range(3))
def test_random_disc_has_its_circumference(seed):
    positions, radii = packed(in_circle(0.03), pi * 0.03**2, 2, 0.88, seed)
    assert free_surface(positions=positions, radii=radii).sum() == pytest.approx(2 * pi * 0.03, rel=0.02)


def test_random_box_has_its_area():
    size = np.array([0.03, 0.025, 0.02])
    positions, radii = packed(in_box(*size), size.prod(), 3, 0.60)
    r = radii.mean()
    a, b, c = size - 2 * r
    rounded = 2 * (a * b + b * c + c * a) + 2 * pi * r * (a + b + c) + 4 * pi * r**2
    assert free_surface(positions=positions, radii=radii).sum() == pytest.approx(rounded, rel=0.02)


# ---- cracks, holes, chips, contact

def test_crack_counts_from_about_a_diameter_on():
    halves = grid(20, 20)
    whole = unit(halves).sum()
    upper = halves[:, 1] > 19
    for opening, added in ((0.3, 0.6), (1.5, 3.0), (2.8, 2 * 38 - 4 + 2 * pi)):
        assert unit(halves + opening * np.outer(upper, [0, 1])).sum() == pytest.approx(whole + added)


def test_pores_of_a_box_in_space_are_no_surface():
    """A particle missing inside of a box uncovers nothing, nor does a cavity of any size; a wide shaft does."""
    box = grid(9, 8, 7)
    closed, inside = unit(box), np.all((box > 0) & (box < [16, 14, 12]), axis=1)
    middle = np.array([8, 6, 6])
    pore = (box == middle).all(axis=1)
    cavity = (abs(box - middle) < 3).all(axis=1)
    for gone in (pore, cavity):
        exposed = unit(box[~gone])
        assert exposed.sum() == pytest.approx(closed.sum()) and np.all(exposed[inside[~gone]] == 0)
    shaft = (abs(box - middle)[:, :2] < 3).all(axis=1) & (box[:, 2] > 3)
    exposed = unit(box[~shaft])
    wall = (abs(box - middle)[:, 0] == 4) & (box[:, 1] == 6) & (box[:, 2] > 5)
    assert np.all(exposed[wall[~shaft]] > 2) and exposed.sum() > closed.sum() + 150


def test_notch_is_free_to_its_tip():
    plate = grid(21, 20)
    cut = (abs(plate[:, 0] - 20) < 3) & (plate[:, 1] > 10)
    got = unit(plate[~cut])
    beside = (abs(abs(plate[~cut][:, 0] - 20) - 4) < 0.1) & (plate[~cut][:, 1] > 12) & (plate[~cut][:, 1] < 37)
    assert beside.sum() > 20 and got[beside] == pytest.approx(2.0)


def test_a_hole_is_free_once_a_way_leads_to_it():
    plate = triangles(24, 26)
    centre = plate[12 * 24 + 12]
    reach = np.linalg.norm(plate - centre, axis=1)
    whole = unit(plate).sum()
    assert unit(plate[reach > 6.5]).sum() == pytest.approx(whole)  # enclosed: nothing flows there
    way = (abs(plate[:, 1] - centre[1]) < 3) & (plate[:, 0] > centre[0])
    left = (reach > 6.5) & ~way
    got = unit(plate[left])
    assert got.sum() > whole + 2 * pi * 6.5 and (got[reach[left] < 7.6] > 0).all()


def test_a_hollow_ball_is_free_outside_only():
    ball = grid(11, 11, 11) - 10.0
    distance = np.linalg.norm(ball, axis=1)
    solid, hollow = ball[distance < 9.5], ball[(distance < 9.5) & (distance > 5)]
    assert unit(hollow).sum() == pytest.approx(unit(solid).sum())
    drilled = hollow[(abs(hollow[:, :2]) > 2.5).any(axis=1) | (hollow[:, 2] < 0)]
    assert unit(drilled).sum() > unit(hollow).sum() + 4 * pi * 3**2


@pytest.mark.parametrize("seed", range(3))
def test_pores_of_loose_packings_are_no_surface(seed):
    packing = pack(box=(0.05, 0.04), radius_min=1e-3, radius_max=1.5e-3, porosity=0.17, seed=seed)
    positions, radii = packing.positions, packing.radii
    exposed = free_surface(positions=positions, radii=radii)
    margin = np.minimum(positions, np.array([0.05, 0.04]) - positions).min(axis=1)
    assert np.all(exposed[margin > 4e-3] == 0)
    assert exposed.sum() == pytest.approx(0.18 - (8 - 2 * pi) * 1.25e-3, rel=0.03)


def test_chips_have_surfaces_of_their_own():
    slab, chip, lone = grid(20, 5), triangles(4, 3) + [60.0, 0.0], np.array([[0.0, 40.0]])
    together = unit(np.vstack([slab, chip, lone]))
    assert together == pytest.approx(np.concatenate([unit(slab), unit(chip), [2 * pi]]))


def test_surface_does_not_depend_on_place_size_and_turn():
    positions, radii = packed(in_box(0.03, 0.02), 0.0006, 2, 0.88)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    got = free_surface(positions=positions, radii=radii)
    moved = free_surface(positions=1000 * positions @ turn.T + [3.0, -70.0], radii=1000 * radii)
    assert moved == pytest.approx(1000 * got, abs=1e-8)


def test_particle_in_contact_is_not_free():
    free, touching = unit(grid(5, 5)), grid(5, 5)[:, 1] == 8
    got = unit(grid(5, 5), in_contact=touching)
    assert np.all(got[touching] == 0) and np.array_equal(got[~touching], free[~touching])


@pytest.mark.parametrize("wrong", [
    dict(positions=np.zeros((2, 4))), dict(positions=np.zeros((0, 2)), radii=[]), dict(positions=[[0.0, np.nan]] * 2),
    dict(radii=[1.0]), dict(radii=[1.0, 0.0]), dict(radii=[1.0, np.nan]), dict(alpha=1.0), dict(alpha=np.nan),
    dict(in_contact=[True]), dict(in_contact=[0, 1])])
def test_wrong_input_is_refused(wrong):
    with pytest.raises(ParameterError):
        free_surface(**{**dict(positions=[[0.0, 0.0], [2.0, 0.0]], radii=[1.0, 1.0]), **wrong})

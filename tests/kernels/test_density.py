"""Density map against overlaps integrated numerically, sums over lattices, and free surfaces."""
import math
import time

import numpy as np
import pytest
from scipy.integrate import quad

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.density import control_volume_density, disc_overlap, sphere_overlap

R = 1e-3
FULL = {"triangular": math.pi / (2 * math.sqrt(3)), "square": math.pi / 4, "fcc": math.pi / math.sqrt(18),
        "cubic": math.pi / 6}
"""Solid fractions of lattices of touching particles."""
VECTORS = {"triangular": [[2, 0], [1, math.sqrt(3)]], "square": [[2, 0], [0, 2]],
           "fcc": (math.sqrt(2) * np.array([[0, 1, 1], [1, 0, 1], [1, 1, 0]])).tolist(), "cubic": 2 * np.eye(3)}


def lattice(kind, reach):
    """Touching particles (n, d) m within `reach` radii of the origin, the one there first."""
    vectors = np.array(VECTORS[kind], float)
    steps = np.arange(-2 * int(reach), 2 * int(reach) + 1)
    points = np.stack(np.meshgrid(*[steps] * len(vectors)), -1).reshape(-1, len(vectors)) @ vectors
    away = np.linalg.norm(points, axis=1)
    order = np.argsort(away, kind="stable")
    return R * points[order[away[order] <= reach + 1e-9]]


def fraction(positions, ratio, radii=None):
    """Solid fractions."""
    radii = np.full(len(positions), R) if radii is None else radii
    return control_volume_density(positions=positions, radii=radii, densities=1.0, ratio=ratio)


def section(x, r):
    return math.sqrt(max(r**2 - x**2, 0.0))


CASES = [(0.5, 1.0, 3.0), (2.0, 1.0, 3.0), (2.2, 1.0, 3.0), (3.5, 1.0, 3.0), (1.0, 1.0, 1.0), (2.9, 2.0, 1.2),
         (4.0, 1.0, 3.0), (5.0, 1.0, 3.0), (0.0, 1.0, 1.0)]


@pytest.mark.parametrize("d, r, big", CASES)
def test_overlap_of_two_discs_and_two_spheres_as_integrated(d, r, big):
    """Over the distance x from the larger one's centre: the narrower of both sections."""
    plane = (d**2 + big**2 - r**2) / (2 * d) if d else None  # where the two sections are equal
    kinks = sorted(x for x in {-big, big, d - r, d + r, plane} if x is not None and d - r < x < d + r)
    ends = [max(d - r, -big), *[x for x in kinks if max(d - r, -big) < x < min(d + r, big)], min(d + r, big)]
    for overlap, area in ((disc_overlap, lambda w: 2 * w), (sphere_overlap, lambda w: math.pi * w**2)):
        exact = sum(quad(lambda x: area(min(section(x, big), section(x - d, r))), a, b, epsabs=1e-12)[0]
                    for a, b in zip(ends, ends[1:]) if b > a)
        assert float(overlap(d, r, big)) == pytest.approx(exact, abs=1e-7)
        assert float(overlap(d, big, r)) == pytest.approx(float(overlap(d, r, big)), rel=1e-12, abs=1e-15)


def test_two_bodies():
    """Of the neighbour at a diameter's distance half lies in a control volume that reaches to its centre - of a disc:
    the lens of two circles of radii 1 and 2 at distance 2."""
    half = math.acos(0.25)
    lens = half - math.sin(half) * math.cos(half) + 4 * (math.acos(7 / 8) - math.sqrt(15) / 8 * 7 / 8)
    for dimension, shared, whole in ((2, lens / math.pi, 4), (3, 0.375 + 1 / 32, 8)):
        pair = np.zeros((2, dimension))
        pair[1, 0] = 2 * R
        np.testing.assert_allclose(fraction(pair, 2), (1 + shared) / whole, rtol=1e-12)
        np.testing.assert_allclose(fraction(pair, 1), 1.0, rtol=1e-12)
        np.testing.assert_allclose(fraction(pair, 3), 2 / 3**dimension, rtol=1e-12)
        weights = control_volume_density(positions=pair, radii=np.full(2, R), densities=np.array([2500.0, 7830.0]),
                                         ratio=2)
        np.testing.assert_allclose(weights, [(2500 + 7830 * shared) / whole, (7830 + 2500 * shared) / whole])


@pytest.mark.parametrize("kind, inside, cut", [
    ("triangular", 7, [(6, 2 * math.sqrt(3))]), ("square", 5, [(4, 2 * math.sqrt(2))]),
    ("fcc", 13, [(6, 2 * math.sqrt(2)), (24, 2 * math.sqrt(3))]),
    ("cubic", 7, [(12, 2 * math.sqrt(2)), (8, 2 * math.sqrt(3))])])
def test_lattices_by_hand(kind, inside, cut):
    """With three radii the nearest neighbours are inside; the boundary cuts the next ones."""
    points = lattice(kind, 5)
    dimension = points.shape[1]
    overlap, own = (disc_overlap, math.pi) if dimension == 2 else (sphere_overlap, 4 / 3 * math.pi)
    exact = (inside + sum(count * float(overlap(d, 1, 3)) / own for count, d in cut)) / 3**dimension
    assert fraction(points, 3)[0] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("kind, ratios", [("triangular", (6, 12, 18)), ("square", (6, 12, 18)), ("fcc", (4, 6, 9)),
                                          ("cubic", (4, 6, 9))])
def test_large_control_volumes_show_the_solid_fraction(kind, ratios):
    points = lattice(kind, ratios[-1] + 1)
    off = [abs(control_volume_density(positions=points, radii=np.full(len(points), R), densities=1.0,
                                      ratio=ratio)[0] / FULL[kind] - 1) for ratio in ratios]
    # The waves of lattice points in a growing sphere, of the order of f^-(d + 1)/2 for its overlaps.
    dimension = points.shape[1]
    assert all(error < 0.75 * ratio**(-(dimension + 1) / 2) for ratio, error in zip(ratios, off))


@pytest.mark.parametrize("kind, layer", [("triangular", math.sqrt(3)), ("square", 2.0), ("cubic", 2.0)])
def test_at_a_free_surface_half_is_empty(kind, layer):
    """Half a lattice, a row or layer through the origin its last one: phi/2 and half a layer h more, by 2h/(pi f) in
    the plane and 3h/(4 f) in space."""
    ratios = np.array([4, 8, 16]) if kind != "cubic" else np.array([3, 5, 9])
    whole = lattice(kind, ratios[-1] + 2)
    half = whole[whole[:, -1] < 1e-6 * R]
    found = np.array([fraction(half, ratio)[0] / FULL[kind] for ratio in ratios.tolist()])
    more = (2 / math.pi if len(half.T) == 2 else 0.75) * 0.5 * layer / ratios
    assert np.all(abs(found - 0.5 - more) < 0.4 * ratios**-1.5)
    # Without the half layer more the error falls with the size of the control volume.
    assert np.polyfit(np.log(ratios), np.log(found - 0.5), 1)[0] == pytest.approx(-1, abs=0.15)


def test_the_result_knows_no_units_no_order_and_no_direction():
    rng = np.random.default_rng(3)
    positions, radii = rng.random((400, 2)) * 0.05, rng.uniform(0.5e-3, 2e-3, 400)
    first = fraction(positions, 2.5, radii)
    np.testing.assert_allclose(fraction(1e3 * positions, 2.5, 1e3 * radii), first, rtol=1e-9)
    order = rng.permutation(400)
    np.testing.assert_allclose(fraction(positions[order], 2.5, radii[order]), first[order], rtol=1e-12)
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]])
    np.testing.assert_allclose(fraction(positions @ turn + 7.0, 2.5, radii), first, rtol=1e-9)
    weighed = control_volume_density(positions=positions, radii=radii, densities=2500.0, ratio=2.5)
    np.testing.assert_allclose(weighed, 2500 * first, rtol=1e-12)


def test_ten_thousand_particles_take_well_under_a_second():
    rng = np.random.default_rng(1)
    for dimension, side in ((2, 0.2), (3, 0.04)):
        begin = time.process_time()
        fraction(rng.random((10_000, dimension)) * side, 3)
        assert time.process_time() - begin < 1.0


@pytest.mark.parametrize("changes, words", [
    (dict(ratio=0.5), "ratio = 0.5: must be between 1 and 20"), (dict(ratio=math.nan), "ratio = nan"),
    (dict(radii=[1.0]), "radii = (1,) shape"), (dict(radii=[1.0, 0.0]), "radii = 0 m: must be greater than 0"),
    (dict(positions=[[0.0, math.nan], [1, 1]]), "positions = not all finite m"),
    (dict(positions=[0.0, 1.0]), "positions = (2,) shape")])
def test_bad_input(changes, words):
    with pytest.raises(ParameterError) as error:
        control_volume_density(**{**dict(positions=np.eye(2), radii=np.ones(2), densities=1.0, ratio=3), **changes})
    assert str(error.value).startswith(words)


def test_nothing_has_no_density():
    assert fraction(np.empty((0, 3)), 3).shape == (0,)

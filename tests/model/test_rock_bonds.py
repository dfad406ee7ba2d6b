"""Bonds of a rock: the crack area of each, scatter of strength, grains, overlaps."""
import math

import numpy as np
import pytest

from rockwear.kernels.bond_laws import Cohesive, Coulomb, ElasticBrittle, NonlinearElastoPlastic
from rockwear.kernels.checks import ParameterError
from rockwear.model.rock import UNBREAKABLE, Arranged, Block, CutOut, RockAssembly, Specimen

AREA = dict(kn=2e10, kt=1e10, bond_tension=7e6, bond_cohesion=20e6, mu=0.8)
COULOMB, COHESIVE = Coulomb(**AREA), Cohesive(bond_fracture_energy=30.0, **AREA)
SPECIMEN = dict(width=0.07, height=0.06, radius_min=1e-3, radius_max=1.5e-3, porosity=0.12, bonding_gap=1e-4,
                density=2500, seed=1)
D = 2e-3


def lattice(columns, rows):
    """Discs in equilateral triangles, in a box of their own cells."""
    places = np.array([(D * (k + 0.5 * (row % 2)), 0.5 * math.sqrt(3) * D * row)
                       for row in range(rows) for k in range(columns)])
    return Arranged(positions=places, radius=D / 2, width=columns * D, height=rows * 0.5 * math.sqrt(3) * D, density=1)


def crossings(points, pairs, inside, lines, seed=1):
    """Bonds over the area of planes, or the length of lines, that cut a ball (centre, radius) at random."""
    rng, (centre, reach), found = np.random.default_rng(seed), inside, 0
    first, second = points[pairs[:, 0]] - centre, points[pairs[:, 1]] - centre
    area = 0.0
    for _ in range(lines):
        normal = rng.normal(size=points.shape[1])
        normal /= np.linalg.norm(normal)
        level = reach * rng.uniform(-1, 1)
        a, b = first @ normal - level, second @ normal - level
        cut = a * b < 0
        share = (a[cut] / (a[cut] - b[cut]))[:, None]
        place = first[cut] + share * (second[cut] - first[cut])
        within = reach**2 - level**2
        found += np.sum(np.sum(place**2, axis=1) < reach**2)
        area += 2 * math.sqrt(within) if len(normal) == 2 else math.pi * within
    return found / area


def test_area_of_bonds_of_a_triangular_lattice():
    # Three bonds a disc inside; the border, which has fewer, counts for nothing.
    assert lattice(40, 40).bond_areas == pytest.approx(math.pi / (4 * math.sqrt(3)) * D, rel=1e-9)


def test_a_lattice_without_an_inside_has_the_area_of_all_its_bonds():
    rock = lattice(6, 5)
    np.testing.assert_allclose(rock.bond_areas, 0.5 * math.pi * rock.width * rock.height / (len(rock.pairs) * D))


def test_area_of_bonds_of_a_cubic_lattice():
    places = D * (np.stack(np.meshgrid(*[np.arange(12)] * 3), axis=-1).reshape(-1, 3) + (0.5, 0.5, -5.5))
    distance = np.abs(places[:, None] - places[None]).sum(axis=2)
    pairs = np.argwhere(np.triu(np.isclose(distance, D)))
    rock = RockAssembly(positions=places, radii=np.full(len(places), D / 2), width=12 * D, height=12 * D, depth=12 * D,
                        density=1, pairs=pairs)
    # A plane in a random direction meets 3 / (2 d2) bonds.
    assert rock.bond_areas == pytest.approx(2 / 3 * D**2, rel=1e-9)


def test_lines_through_a_packing_cross_as_many_bonds():
    """In the mean of four packings; each alone is within 2 %."""
    found = []
    for seed in range(4):
        rock = Specimen(**{**SPECIMEN, "seed": seed})
        found.append(crossings(rock.positions, rock.pairs, ((0.035, 0.03), 0.025), 3000) * rock.bond_areas.mean())
        assert np.ptp(rock.bond_areas) == 0
    assert np.mean(found) == pytest.approx(1, rel=0.015)


def test_planes_through_a_block_cross_as_many_bonds():
    block = Block(width=0.15, height=0.15, depth=0.15, radius=8e-3, porosity=0.4, seed=1, bonding_gap=8e-4,
                  density=2500)
    found = crossings(block.positions, block.pairs, ((0.075, 0.075, 0.0), 0.045), 1000)
    assert found * block.bond_areas.mean() == pytest.approx(1, rel=0.03)


@pytest.mark.parametrize("change", [{"width": 0.05, "height": 0.025}, {"width": 0.1, "height": 0.05},
                                    {"height": 0.1, "grading_factor": 3, "fine_depth": 0.03}], ids=str)
def test_area_does_not_depend_on_the_specimen(change):
    """In the mean of twelve packings of 250 to 1000 discs, which scatter by 2 %."""
    areas = [Specimen(**{**SPECIMEN, **change, "seed": seed}).crack_area for seed in range(1, 13)]
    assert np.mean(areas) == pytest.approx(1.433e-3, rel=0.015)


def test_area_does_not_depend_on_a_notch_nor_on_what_is_cut_out():
    rock, notched = Specimen(**SPECIMEN), Specimen(**SPECIMEN)
    notched.cut((0.035, -0.01), (0.035, 0.04))
    assert len(notched.pairs) < len(rock.pairs) and notched.crack_area == pytest.approx(rock.crack_area, rel=0.015)
    part = CutOut(rock, polygon=[(0.0, 0.0), (0.02, 0.0), (0.0, 0.02)], bonding_gap=1e-4)
    assert np.all(part.bond_areas == rock.crack_area)


def test_halved_discs_have_bonds_of_half_the_area_and_graded_ones_of_their_own():
    coarse = Specimen(**SPECIMEN)
    fine = Specimen(**{**SPECIMEN, "width": 0.035, "height": 0.03, "radius_min": 0.5e-3, "radius_max": 0.75e-3,
                       "bonding_gap": 0.5e-4})
    assert fine.bond_areas.mean() == pytest.approx(0.5 * coarse.bond_areas.mean(), rel=0.01)
    graded = Specimen(**{**SPECIMEN, "height": 0.1}, grading_factor=3, fine_depth=0.03)
    assert graded.bond_areas == pytest.approx(graded.crack_area * graded.strength_factor)
    y = graded.positions[graded.pairs].mean(axis=1)[:, 1]
    assert np.all(graded.bond_areas[y > 0.075] == graded.crack_area)
    assert graded.bond_areas[y < 0.03].min() > 2 * graded.crack_area


@pytest.mark.parametrize("law", [COULOMB, COHESIVE], ids=["coulomb", "cohesive"])
def test_strengths_are_those_of_the_area(law):
    rock = Specimen(**SPECIMEN)
    rock.bond(law)
    assert [found.Rn for found in rock.laws] == pytest.approx((7e6 * rock.bond_areas).tolist())
    assert {(found.kn, found.kt) for found in rock.laws} == {(2e10, 1e10)}
    if law is COHESIVE:
        assert rock.laws[0].fracture_energy()[0] == pytest.approx(30.0 * rock.bond_areas[0])


def test_laws_by_bond_are_as_strong_as_the_rock_is_graded():
    rock = Specimen(**SPECIMEN, grading_factor=3, fine_depth=0.03)
    rock.bond(ElasticBrittle(kn=1.0, kt=1.0, Rn=5.0, Rt=7.0, mu=0.5))
    assert [law.Rn for law in rock.laws] == pytest.approx((5.0 * rock.strength_factor).tolist())


def test_strengths_of_graded_rock_follow_the_discs_where_the_law_says_so():
    rock = Specimen(**{**SPECIMEN, "height": 0.1}, grading_factor=3, fine_depth=0.03)
    rock.bond(Cohesive(kn=2e10, kt=1e10, bond_tension=7e6, bond_cohesion=20e6, bond_fracture_energy=60.0, mu=0.5,
                       bond_cohesion_power=0.5))
    assert rock.strength_factor.max() > 2
    assert [law.Rn for law in rock.laws] == pytest.approx((7e6 * rock.bond_areas).tolist())
    assert [law.Rt for law in rock.laws] == pytest.approx(
        (20e6 * rock.strength_factor**0.5 * rock.bond_areas).tolist())


@pytest.mark.parametrize("modulus", [1.5, 4.0, 20.0])
def test_scatter_has_its_mean_and_its_modulus(modulus):
    rock = lattice(60, 60)
    rock.bond(COULOMB, weibull_modulus=modulus, seed=3)
    ratio = np.array([law.Rn for law in rock.laws]) / (7e6 * rock.bond_areas)
    assert np.allclose([law.Rt / law.Rn for law in rock.laws], 20 / 7)
    assert ratio.mean() == pytest.approx(1, rel=0.02) and ratio.min() >= 0.0499 and ratio.max() <= 5
    # A straight line in Weibull's diagram, with the modulus as its slope.
    order, chance = np.sort(ratio), (np.arange(len(ratio)) + 0.5) / len(ratio)
    kept = (chance > 0.05) & (chance < 0.95)
    slope = np.polyfit(np.log(order[kept]), np.log(-np.log(1 - chance[kept])), 1)[0]
    assert slope == pytest.approx(modulus, rel=0.04)
    strengths = [law.Rn for law in rock.laws]
    rock.bond(COULOMB, weibull_modulus=modulus, seed=3)
    assert strengths == [law.Rn for law in rock.laws]
    rock.bond(COULOMB, weibull_modulus=modulus, seed=4)
    assert strengths != [law.Rn for law in rock.laws]


@pytest.mark.parametrize("modulus", [0.5, 0.7, 1.0])
def test_strengths_that_scatter_far_keep_their_mean(modulus):
    """A sixth of the mean lies above the largest at a modulus of 0.5."""
    rock, means = lattice(60, 60), []
    for seed in range(12):
        rock.bond(COULOMB, weibull_modulus=modulus, seed=seed)
        means.append(np.mean([law.Rn for law in rock.laws] / (7e6 * rock.bond_areas)))
    assert np.mean(means) == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("factor", [1, 2.5, 5])
def test_grains_of_graded_rock_have_their_size_where_it_is_fine_and_as_many_discs_elsewhere(factor):
    rock = Specimen(width=0.06, height=0.05, radius_min=2.5e-4, radius_max=3.75e-4, porosity=0.12, seed=1,
                    bonding_gap=2.5e-5, density=2500, grading_factor=factor, fine_depth=0.012)
    rock.bond(COULOMB, grain_edge=8e-4, seed=1)
    area, discs = np.bincount(rock.grains, rock.masses / rock.density), np.bincount(rock.grains)
    fine, coarse = (np.unique(rock.grains[rows]) for rows in (rock.scale == 1, rock.scale == rock.scale.max()))
    assert area[fine].mean() == pytest.approx(1.5 * math.sqrt(3) * 8e-4**2, rel=0.1)
    assert discs[fine].mean() == pytest.approx(discs.mean(), rel=0.1) == pytest.approx(discs[coarse].mean(), rel=0.15)


@pytest.mark.parametrize("law", [COULOMB, COHESIVE], ids=["coulomb", "cohesive"])
def test_bonds_within_a_grain_do_not_break_and_have_their_own_stiffness(law):
    rock = Specimen(**SPECIMEN)
    rock.bond(law, grain_edge=4e-3, within_grains=(5e10, 3e10), seed=2)
    inside = np.equal(*rock.grains[rock.pairs].T)
    assert 0.3 < inside.mean() < 0.9
    for within, found in zip(inside, rock.laws):
        assert (found.kn, found.kt, found.mu) == ((5e10, 3e10, 0.8) if within else (2e10, 1e10, 0.8))
        assert (found.Rn >= UNBREAKABLE) == within
    kn, kt = rock.stiffness()
    assert np.array_equal(kn, np.where(inside, 5e10, 2e10)) and np.array_equal(kt, np.where(inside, 3e10, 1e10))
    rock.bond(law, grain_edge=4e-3, seed=2)
    assert set(rock.stiffness()[0]) == {2e10}


@pytest.mark.parametrize("law", [COULOMB, COHESIVE], ids=["coulomb", "cohesive"])
def test_bonds_within_a_grain_may_be_so_many_times_as_strong(law):
    """A third bond breaks at this multiple of the others' force, and a cohesive one takes as much more energy."""
    rock, plain = Specimen(**SPECIMEN), Specimen(**SPECIMEN)
    plain.bond(law)
    rock.bond(law, grain_edge=4e-3, grain_strength=12.0, within_grains=(5e10, 3e10), seed=2)
    inside = np.equal(*rock.grains[rock.pairs].T)
    for within, found, one in zip(inside, rock.laws, plain.laws):
        factor = 12.0 if within else 1.0
        assert (found.Rn, found.Rt) == pytest.approx((factor * one.Rn, factor * one.Rt))
        assert (found.kn, found.kt) == ((5e10, 3e10) if within else (one.kn, one.kt))
        if law is COHESIVE:
            # Or where its elastic energy at the peak is more: such a bond is brittle.
            least = 0.5 * found.Rn**2 / found.kn
            assert found.fracture_energy()[0] == pytest.approx(max(factor * one.fracture_energy()[0], least), rel=2e-3)
    strongest = next(one for one, within in zip(rock.laws, inside) if within)
    peak = strongest.drive(np.linspace(0, 2 * strongest.Rn / strongest.kn, 2001), np.zeros(2001))[0].max()
    assert peak == pytest.approx(strongest.Rn, rel=2e-3)


def test_grains_are_refused_with_a_law_that_is_linear_nowhere():
    with pytest.raises(ParameterError, match="^grain_edge = 0.004 m: must be 0 with the law padova"):
        Specimen(**SPECIMEN).bond(NonlinearElastoPlastic(), grain_edge=4e-3)


def test_overlaps_are_cleared_for_yades_concrete_model_alone():
    rock, plain = Specimen(**SPECIMEN), Specimen(**SPECIMEN)
    plain.bond(COULOMB)
    rock.bond(COHESIVE)

    def overlap(one):
        i, j = one.pairs.T
        return one.radii[i] + one.radii[j] - np.linalg.norm(one.positions[i] - one.positions[j], axis=1)
    assert overlap(plain).max() > 1e-5 and overlap(rock).max() < 1e-15
    assert np.array_equal(rock.masses, plain.masses) and np.array_equal(rock.bond_areas, plain.bond_areas)
    assert 0.93 < rock.radii.mean() / plain.radii.mean() < 1

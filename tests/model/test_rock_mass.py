"""The rock mass: periodic without a seam, its window of constant size."""
import numpy as np
import pytest

from rockwear.kernels import packing
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.conduction import HeatNetwork
from rockwear.kernels.grains import grains
from rockwear.kernels.polygon import reach
from rockwear.kernels.strip import ArcStrip
from rockwear.kernels.voronoi import periodic_cells
from rockwear.model.rock_mass import FEW, FITS, SLABS, RockMass

SIZE = dict(width=0.06, height=0.03, radius_min=0.8e-3, radius_max=1.2e-3, porosity=0.12, bonding_gap=1e-4,
            density=2300.0)


@pytest.fixture(scope="module")
def rock():
    return RockMass(seed=3, **SIZE)


def fresh():
    return RockMass(seed=3, **SIZE)


def bent(seed=3, radius=0.1, **given):
    """The same along an arc: its lower edge is 1.4 times as long as its upper one."""
    return RockMass(seed=seed, strip=ArcStrip(centre=(0.05, 0.2), radius=radius, level=0.015), **{**SIZE, **given})


def bonds_by_places(mass):
    """Pairs that stand within the bonding gap of each other in the window as it is now."""
    found = packing.contacts(mass.places, mass.radii, SIZE["bonding_gap"] * (1 + 1e-9))
    return {tuple(pair) for pair in found.tolist()}


def test_a_bond_is_there_exactly_where_its_particles_stand_next_to_each_other():
    mass = fresh()
    for _ in range(2 * SLABS + 3):
        assert {tuple(pair) for pair in mass.pairs[mass.bonded].tolist()} == bonds_by_places(mass)
        mass.advance()


def test_the_window_holds_each_particle_once_and_moves_by_slabs():
    mass = fresh()
    for k in range(1, 2 * SLABS):
        moved = mass.advance()
        x = mass.places[:, 0]
        assert mass.begin == pytest.approx(k * mass.slab_length)
        assert x.min() >= mass.begin - 1e-12 and x.max() <= mass.end + 1e-12
        assert x[moved].min() >= mass.end - mass.slab_length - 1e-12


@pytest.mark.parametrize("make", [fresh, bent])
def test_rock_goes_on_below_the_window_and_beyond_its_ends(make):
    """There it has no surface that air or water would cool: particles that touch the bottom or an end, no others."""
    mass = make()
    for _ in range(3):
        mass.advance()
    along, height = mass.strip.unroll(mass.places).T
    reach = 1.05 * mass.radii / mass.stretch
    near = (height < reach) | (along - mass.begin < reach) | (mass.end - along < reach)
    assert np.array_equal(mass.goes_on(), near) and 0.05 < near.mean() < 0.3


def test_the_packing_is_as_dense_at_the_seam_as_anywhere(rock):
    """Bonds that cross a vertical line, over many lines: no place stands out."""
    i, j = rock.pairs.T
    apart = packing.separation(rock.positions, i, j, rock.period)[:, 0]
    at = rock.positions[i, 0]
    lines = (np.arange(24) + 0.5) * rock.width / 24
    low, high = np.minimum(at, at + apart), np.maximum(at, at + apart)
    crossed = [sum(np.sum((low + k * rock.width < x) & (high + k * rock.width > x)) for k in (-1, 0, 1))
               for x in np.append(lines, 0.0)]
    spread = np.std(crossed[:-1])
    assert abs(crossed[-1] - np.mean(crossed[:-1])) < 3 * spread


def test_what_is_absent_stands_aside_unbonded_until_it_comes_in():
    mass = fresh()
    gone = mass.positions[:, 1] > 0.02
    mass.leave_out(gone)
    assert not mass.bonded[gone[mass.pairs].any(axis=1)].any()
    assert mass.places[gone, 1].max() < -mass.height
    assert len(packing.contacts(mass.places[gone], mass.radii[gone])) == 0
    for _ in range(SLABS):
        mass.advance()
    assert not mass.absent.any()
    assert {tuple(pair) for pair in mass.pairs[mass.bonded].tolist()} == bonds_by_places(mass)


def test_untouched_rock_fits_without_a_gap():
    mass = fresh()
    moved = mass.advance()
    displacement, made, longer, in_the_way = mass.fit(moved, mass.places, mass.bonded)
    assert abs(longer[made]).max() < 1e-15
    assert not len(in_the_way) and abs(displacement).max() < 1e-15
    assert (made == (mass.bonded & np.isin(mass.pairs, moved).any(axis=1))).all()


def test_rock_enters_as_the_displacement_of_the_rock_that_is_there_goes_on():
    mass = fresh()
    moved = mass.advance()
    x, y = mass.places.T
    pressed = 1e-6 * np.column_stack([3 - 90 * x - 60 * y, 1 + 20 * x - 40 * y])
    displacement, made, longer, in_the_way = mass.fit(moved, mass.places + pressed, mass.bonded)
    assert displacement == pytest.approx(pressed[moved], abs=1e-13) and not len(in_the_way)
    assert made.sum() == (mass.bonded & np.isin(mass.pairs, moved).any(axis=1)).sum()
    i, j = mass.pairs[made].T
    apart = np.linalg.norm((mass.places + pressed)[i] - (mass.places + pressed)[j], axis=1)
    assert mass.bond_lengths[made] + longer[made] == pytest.approx(apart, abs=1e-12)


def test_rock_that_gives_much_is_followed_and_loose_particles_are_not():
    mass = fresh()
    moved = mass.advance()
    pressed = mass.height * np.column_stack([2e-3 * (1 - mass.places[:, 1] / mass.height), np.full(mass.count, 1e-3)])
    loose = np.random.default_rng(1).choice(np.setdiff1d(np.arange(mass.count), moved), mass.count // 12, replace=False)
    loose = loose[~mass.anchored[loose]]
    off = np.zeros((mass.count, 2))
    off[loose, 0] = 1e-3 * mass.height * (-1.0)**np.arange(len(loose))
    displacement, made, _, in_the_way = mass.fit(moved, mass.places + pressed + off, mass.bonded)
    assert displacement == pytest.approx(pressed[moved], abs=1e-12)
    new, free = np.isin(mass.pairs, moved).any(axis=1), np.isin(mass.pairs, loose).any(axis=1)
    assert (made == (mass.bonded & new & ~free)).all() and set(in_the_way) <= set(loose)


def test_misfit_tells_how_far_rock_that_entered_would_be_off():
    mass = fresh()
    before, moved = mass.state(), np.array([3e-6, -1e-6])
    assert mass.misfit(mass.places + moved, mass.bonded) < 1e-9
    for size in (0.5e-6, 2e-6):
        shaken = np.random.default_rng(2).normal(size=(mass.count, 2)) * size
        off = FITS * mass.height * mass.misfit(mass.places + moved + shaken, mass.bonded)
        assert 0.3 * size < off < 1.5 * size
    # The same as before, but for none of the slab's.
    assert all(np.array_equal(before[name], value) for name, value in mass.state().items())


def test_what_a_blow_moves_at_the_end_of_the_window_would_be_left_out():
    """Particles of a fifth of the last slab are off: what half of the bonds do does not tell it."""
    mass = fresh()
    x, y = mass.places.T
    layer = (x > mass.end - mass.slab_length) & (abs(y - 0.5 * mass.height) < 0.1 * mass.height)
    shaken = 6e-4 * mass.height * np.random.default_rng(1).choice([-1, 1], mass.count)
    displaced = np.column_stack([shaken * layer, np.zeros(mass.count)])
    left_out = FEW * mass.misfit(mass.places + displaced, mass.bonded)
    intact, moved = mass.bonded, mass.advance()
    i, j = np.isin(mass.pairs, moved).T
    seam = mass.bonded & (i ^ j)
    _, made, _, _ = mass.fit(moved, mass.places + displaced, intact)
    assert left_out == pytest.approx(np.mean(~made[seam])) and 0.1 < left_out < 0.3


def test_rock_behind_a_crack_between_the_last_slabs_does_not_tell():
    mass = fresh()
    apart = 5e-4 * mass.height * (mass.places[:, 0] > mass.end - mass.slab_length)
    displaced = np.column_stack([apart, 0.5 * apart])
    assert mass.misfit(mass.places + displaced, mass.bonded) < 1e-9
    moved = mass.advance()
    displacement, made, _, in_the_way = mass.fit(moved, mass.places + displaced, mass.bonded)
    assert displacement == pytest.approx(np.broadcast_to(5e-4 * mass.height * np.array([1.0, 0.5]), (len(moved), 2)))
    assert (made == (mass.bonded & np.isin(mass.pairs, moved).any(axis=1))).all() and not len(in_the_way)


def test_a_chip_that_lies_where_rock_enters_is_put_aside():
    mass = fresh()
    places = mass.places.copy()
    chip = int(np.argmax(places[:, 1] - 10 * abs(places[:, 0] - 0.03)))
    places[chip] = mass.end + 0.5 * mass.slab_length, 0.015
    _, made, _, in_the_way = mass.fit(mass.advance(), places, mass.bonded & (mass.pairs != chip).all(axis=1))
    assert in_the_way.tolist() == [chip] and mass.absent[chip]
    assert not (made | mass.bonded)[(mass.pairs == chip).any(axis=1)].any()


def test_rock_is_not_bonded_across_an_open_crack():
    mass = fresh()
    places = mass.places.copy()
    end = (places[:, 0] > mass.end - 2e-3) & ~mass.anchored
    places[end] -= [8e-5, 0.0]
    whole = mass.bonded & (end[mass.pairs[:, 0]] == end[mass.pairs[:, 1]])
    moved = mass.advance()
    _, made, _, in_the_way = mass.fit(moved, places, whole)
    across = np.isin(mass.pairs, moved).sum(axis=1) == 1
    across &= end[mass.pairs].any(axis=1)
    assert (mass.bonded & across).sum() > 10 and not made[across].any()


def test_grains_have_no_seam(rock):
    """Shifting the rock by half its period shifts the statistics of the grains: as many grains end at the seam."""
    numbers = grains(rock.positions, volume=rock.volume, edge=3e-3, seed=1, period=rock.period)
    i, j = rock.pairs.T
    across = rock.crossing != 0
    between = numbers[i] != numbers[j]
    walled = grains(rock.positions, volume=rock.volume, edge=3e-3, seed=1)
    assert between[across].mean() < 0.75 < (walled[i] != walled[j])[across].mean()


def test_periodic_cells_fill_the_period_and_conduct_a_linear_temperature_exactly(rock):
    cells = periodic_cells(rock.positions, period=rock.width, height=rock.height)
    assert cells.volumes.sum() == pytest.approx(rock.width * rock.height, rel=1e-9)
    assert len(np.unique(cells.edges, axis=0)) == len(cells.edges)
    y = rock.positions[:, 1]
    flow = cells.conductance(2.0) * (y[cells.edges[:, 1]] - y[cells.edges[:, 0]])
    balance = (np.bincount(cells.edges[:, 0], flow, rock.count) - np.bincount(cells.edges[:, 1], flow, rock.count))
    inside = np.isin(np.arange(rock.count), np.concatenate([cells.walls[2][0], cells.walls[3][0]]), invert=True)
    assert abs(balance[inside]).max() < 1e-9 * abs(flow).max()


def test_heat_flows_across_the_seam(rock):
    edges, conductance = rock.paths("voronoi", 2.0)
    capacity = np.full(rock.count, 1.0)
    network = HeatNetwork(capacity=capacity, edges=edges, conductance=conductance,
                          temperature=np.where(rock.positions[:, 0] < 2e-3, 400.0, 300.0))
    network.advance(5.0)
    far = rock.positions[:, 0] > rock.width - 2e-3
    assert network.temperature[far].mean() > 302.0


def test_every_bond_shows_between_neighbours_in_one_of_the_layouts(rock):
    lengths = rock.bond_lengths
    seen = np.zeros(len(rock.pairs), bool)
    for positions, shown in rock.layouts():
        i, j = rock.pairs[shown].T
        assert np.linalg.norm(positions[i] - positions[j], axis=1) == pytest.approx(lengths[shown], rel=1e-12)
        seen |= shown
    assert seen.all() and not rock.layouts()[0][1].all()


def test_reach_is_the_foremost_point_of_a_polygon_at_a_height():
    triangle = np.array([[0.0, 0.0], [2.0, 1.0], [0.0, 2.0]])
    assert reach(triangle, np.array([0.0, 0.5, 1.0, 1.5, 3.0])).tolist() == [0.0, 1.0, 2.0, 1.0, -np.inf]


@pytest.mark.parametrize("name, value", [("width", 0.0), ("bonding_gap", 1.0), ("grading_factor", 0.5)])
def test_bad_windows_are_refused(name, value):
    with pytest.raises(ParameterError) as refused:
        RockMass(seed=1, **{**SIZE, name: value})
    assert refused.value.name == name


def found_in_the_plane(mass):
    """Porosity of the window, neighbours of a particle, mean gap over a diameter of the bonds; of the packing as it
    lies in the plane."""
    inner, outer = (mass.strip.radius * mass.strip.stretch(np.array([[0.0, y]]))[0] for y in (mass.height, 0.0))
    area = 0.5 * mass.width / mass.strip.radius * (outer**2 - inner**2)
    (i, j), lengths = mass.pairs[mass.bonded].T, np.linalg.norm
    gap = lengths(mass.places[i] - mass.places[j], axis=1) / (mass.radii[i] + mass.radii[j]) - 1
    near = packing.contacts(mass.places, mass.radii, 0.0)
    return 1 - np.pi * np.sum(mass.radii**2) / area, 2 * len(near) / mass.count, gap.mean()


def test_a_packing_along_an_arc_is_the_straight_one_in_all_that_counts():
    """Discs of R / 100 on an arc as strongly bent as here; a dredge's are of R / 600."""
    pairs = [(RockMass(seed=seed, **SIZE), bent(seed)) for seed in range(3, 8)]
    straight = np.array([(mass.porosity, 2 * len(packing.contacts(mass.places, mass.radii, 0.0)) / mass.count,
                          (mass.bond_lengths / mass.radii[mass.pairs].sum(axis=1) - 1)[mass.bonded].mean())
                         for mass, _ in pairs])
    arc = np.array([found_in_the_plane(mass) for _, mass in pairs])
    porosity, coordination, gap = (arc - straight).T
    # A contact more in a packing is 0.004 in the mean number of neighbours.
    assert abs(porosity).max() < 2e-3 and abs(coordination).mean() < 0.02 and abs(gap).max() < 5e-5
    assert np.ptp(straight[:, 1]) > 0.02 and np.ptp(straight[:, 2]) > 1e-4


def test_along_an_arc_bonds_and_modulus_are_the_same_wherever_the_window_is():
    mass, rock = bent(), fresh()
    assert (mass.pairs == rock.pairs).all() and mass.crack_area == pytest.approx(rock.crack_area, rel=5e-3)
    law = ElasticBrittle(kn=1e10, kt=5e9, Rn=1e4, Rt=1e4, mu=0.5)
    mass.bond(law), rock.bond(law)
    assert mass.moduli() == pytest.approx(rock.moduli(), rel=1e-12)
    assert mass.cells.volumes.sum() == pytest.approx(mass.volume, rel=0.01)
    for k in range(1, 2 * SLABS):
        mass.advance()
        i, j = mass.pairs[mass.bonded].T
        assert np.linalg.norm(mass.places[i] - mass.places[j], axis=1) == pytest.approx(
            mass.bond_lengths[mass.bonded], rel=1e-12)
        x = mass.strip.unroll(mass.places)[:, 0]
        assert x.min() >= k * mass.slab_length - 1e-12 and x.max() <= mass.end + 1e-12


def test_what_is_above_the_surface_is_absent_as_it_begins_and_as_it_enters():
    surface = np.array([0.0, 0.03, 0.1]), np.array([0.01, 0.01, 0.03])
    mass = bent(surface=surface)
    for _ in range(SLABS + 3):
        points = mass.positions + mass.laps[:, None] * mass.period
        assert (mass.absent == (points[:, 1] > np.interp(points[:, 0], *surface))).all() and mass.absent.any()
        mass.advance()
    assert mass.top(0.065) == pytest.approx(0.02) and fresh().top(0.065) == SIZE["height"]


def test_rock_enters_an_arc_displaced_by_what_is_there_at_its_depth():
    mass = bent()
    moved = mass.advance()
    shift = np.column_stack([2e-6 * (1 + 20 * mass.positions[:, 1]), np.full(mass.count, -1e-6)])
    displacement, made, _, in_the_way = mass.fit(moved, mass.places + shift, mass.bonded)
    assert displacement == pytest.approx(shift[moved]) and not len(in_the_way)
    assert made.sum() == (mass.bonded & np.isin(mass.pairs, moved).any(axis=1)).sum()

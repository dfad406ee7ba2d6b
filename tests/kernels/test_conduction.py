"""Heat conduction against exact solutions, lattices and its own balance."""
import numpy as np
import pytest
from scipy.spatial import cKDTree

from rockwear.kernels import analytic
from rockwear.kernels import voronoi as voronoi
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.packing import pack
from rockwear.kernels.conduction import (
    PATHS, STEFAN_BOLTZMANN, HeatNetwork, bar_conductance, calibrated_conductance, effective_conductivity, effusivity,
    effusivity_share, hot_and_mean, paths)
from tests.kernels import exact_heat


def chain(n, conductance=1.0, capacity=1.0, temperature=300.0):
    edges = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    return HeatNetwork(capacity=np.full(n, capacity), edges=edges, conductance=conductance, temperature=temperature)


def rod(cells, temperature):
    """Rod of length 1 and diffusivity 1 between cold ends, `cells` contacts long."""
    length = 1 / cells
    network = chain(cells + 1, 1 / length, length, temperature)
    network.fix([0, cells], 0.0)
    return network


def tangle(n=60, seed=0):
    """A random network, capacities and conductances spread over four decades, with everything that brings heat."""
    rng = np.random.default_rng(seed)
    edges = rng.integers(0, n, (4 * n, 2))
    edges = edges[edges[:, 0] != edges[:, 1]]
    network = HeatNetwork(capacity=10 ** rng.uniform(0, 4, n), edges=edges,
                          conductance=10 ** rng.uniform(0, 4, len(edges)), temperature=rng.uniform(280, 400, n))
    network.fix([1, 2], [1500.0, 300.0])
    network.source([1, 5, 7], [10.0, 20.0, 1e4])
    network.convect(range(10, 20), 3.0, 283.0)
    network.radiate(range(15, 30), 0.5, 1500.0)
    return network


def touching(positions, diameter):
    return cKDTree(positions).query_pairs(1.001 * diameter, output_type="ndarray")


def triangles(nx, ny, diameter):
    column, row = np.meshgrid(np.arange(nx), np.arange(ny))
    return diameter * np.column_stack([(column + 0.5 * (row % 2)).ravel(), (row * np.sqrt(0.75)).ravel()])


def grid(*counts, diameter):
    return diameter * np.stack(np.meshgrid(*map(np.arange, counts)), -1).reshape(-1, len(counts)).astype(float)


def dislodged(seed=3):
    """Triangles with a fifth of the contacts gone."""
    positions = triangles(30, 34, 0.002)
    edges = touching(positions, 0.002)
    loose = np.random.default_rng(seed).random(len(edges)) < 0.2
    return positions, edges[~loose]


# ---- exact solutions

def test_two_particles_meet_as_the_exponential():
    network = HeatNetwork(capacity=[2.0, 6.0], edges=[[0, 1]], conductance=3.0, temperature=[400.0, 300.0])
    network.advance(0.5, step=1e-4)
    exact = exact_heat.two_nodes(0.5, capacities=[2.0, 6.0], conductance=3.0, temperatures=[400.0, 300.0])
    assert network.temperature == pytest.approx(exact, abs=0.01)
    network.advance(100.0)
    assert network.temperature == pytest.approx([325.0, 325.0])


def test_contacts_given_twice_conduct_twice():
    once = HeatNetwork(capacity=[1.0, 2.0], edges=[[0, 1]], conductance=4.0, temperature=[400.0, 300.0])
    twice = HeatNetwork(capacity=[1.0, 2.0], edges=[[0, 1], [1, 0]], conductance=[1.0, 3.0], temperature=[400.0, 300.0])
    once.advance(0.1), twice.advance(0.1)
    assert twice.temperature == pytest.approx(once.temperature)


def test_one_euler_step_is_that_of_the_paper():
    network = chain(3, conductance=2.0, capacity=4.0, temperature=[300.0, 310.0, 330.0])
    network.source(0, 8.0)
    network.convect(2, 0.5, 280.0)
    network.advance(0.1, step=0.1)
    gains = np.array([8 + 20, -20 + 40, -40 - 25])
    assert network.temperature == pytest.approx([300, 310, 330] + 0.1 * gains / 4)


@pytest.mark.parametrize("n, coldest, hot", [(1000, 1.0, 994.5), (50, 1.0, 49.0), (1000, 20.0, 989.5)])
def test_the_hottest_part_is_a_hundredth_of_the_mass_or_the_heaviest_node(n, coldest, hot):
    """Nodes of 0 ... n - 1 K in any order and of the same mass, but for the coldest; a hotter one before does not
    count."""
    order = np.random.default_rng(1).permutation(n)
    edges = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    network = HeatNetwork(capacity=np.where(np.r_[1, order] == 0, coldest, 1.0), edges=edges, conductance=1.0,
                          temperature=np.r_[1e4, order])
    found, mean = hot_and_mean(network, 1)
    assert found == pytest.approx(hot)
    assert mean == pytest.approx(n * (n - 1) / 2 / (n - 1 + coldest))


def test_chain_decays_at_its_own_rate_and_at_that_of_the_rod():
    cells, time = 20, 0.05
    network = rod(cells, np.sin(np.pi * np.arange(cells + 1) / cells))
    network.advance(time, step=time / 20000)
    measured = -np.log(network.temperature[cells // 2]) / time
    assert measured == pytest.approx(exact_heat.chain_decay_rate(cells=cells, conductance=cells, capacity=1 / cells),
                                     rel=2e-5)
    assert measured == pytest.approx(analytic.rod_decay_rate(length=1.0, diffusivity=1.0), rel=2.2e-3)


def test_second_order_in_space():
    errors = []
    sizes = np.array([8, 16, 32])
    for cells in sizes:
        network = rod(cells, np.sin(np.pi * np.arange(cells + 1) / cells))
        network.advance(0.1, step=1e-5)
        errors.append(abs(network.temperature[cells // 2] * np.exp(0.1 * np.pi**2) - 1))
    assert -np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(2.0, abs=0.05)
    assert errors[-1] < 1e-3


def test_first_order_in_time():
    cells, time, counts = 10, 0.1, np.array([50, 100, 200, 400])
    rate = exact_heat.chain_decay_rate(cells=cells, conductance=cells, capacity=1 / cells)
    errors = []
    for count in counts:
        network = rod(cells, np.sin(np.pi * np.arange(cells + 1) / cells))
        assert network.advance(time, step=time / count) == count
        errors.append(abs(network.temperature[cells // 2] * np.exp(rate * time) - 1))
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.03)
    assert errors[-1] < 2e-3


def slab(cells, thickness, conductivity, density, specific_heat):
    """One row of particles across 1 m^2 of a slab, a particle on each face."""
    length = thickness / cells
    network = chain(cells + 1, conductivity / length, density * specific_heat * length, 0.0)
    return network, np.linspace(0, thickness, cells + 1)


def test_benchmark_slab_heated_inside():  # [Rojek 2003, 7.6.1]
    material = dict(conductivity=16.0, density=1.0, specific_heat=1.0)
    network, x = slab(40, 8.0, **material)
    network.fix([0, 40], 0.0)
    network.source(range(1, 40), 2000.0 * 0.2)
    before = 0.0
    for time in (0.08, 0.24):
        network.advance(time - before)
        before = time
        exact = analytic.heated_slab(x, time, thickness=8.0, power=2000.0, **material)
        assert abs(network.temperature - exact).max() < 2e-3 * exact.max()
    steady = analytic.heated_slab(x, np.inf, thickness=8.0, power=2000.0, **material)
    assert network.steady_state() == pytest.approx(steady, abs=1e-6)


def test_benchmark_half_space_under_flux():  # [Rojek 2003, 7.6.2]
    material = dict(conductivity=1.0, density=1.0, specific_heat=1.0)
    network, x = slab(300, 10.0, **material)
    x = x + x[1] / 2  # here the particles at the ends are whole, their centres half a spacing inside
    network.source(0, 1.0)
    network.advance(1.0)
    exact = analytic.half_space_under_flux(x, 1.0, flux=1.0, **material)
    assert abs(network.temperature - exact).max() < 1e-3


def test_benchmark_slab_with_jumping_faces():  # [Rojek 2003, 7.6.3]
    material = dict(conductivity=6.0, density=3.0, specific_heat=2.0)
    network, x = slab(60, 1.0, **material)
    network.fix([0, 60], 100.0)
    before = 0.0
    for time in (0.02, 0.075):
        network.advance(time - before)
        before = time
        exact = analytic.slab_with_jumping_faces(x, time, thickness=1.0, jump=100.0, **material)
        assert abs(network.temperature - exact).max() < 0.1


def test_the_two_series_of_the_jumping_slab_agree():
    x, material = np.linspace(0, 1, 21), dict(thickness=1.0, conductivity=1.0, density=1.0, specific_heat=1.0, jump=1.0)
    early = analytic.slab_with_jumping_faces(x, 0.05 * (1 - 1e-12), **material)
    assert early == pytest.approx(analytic.slab_with_jumping_faces(x, 0.05, **material), abs=1e-11)
    assert analytic.slab_with_jumping_faces(x, 1e-6, **material)[[0, 1, -1]] == pytest.approx([1.0, 0.0, 1.0])
    assert analytic.slab_with_jumping_faces(x, 10.0, **material) == pytest.approx(np.ones(21))


def test_face_of_the_half_space_warms_with_the_root_of_time():
    material = dict(flux=3.0, conductivity=5.0, density=2500.0, specific_heat=1970.0)
    face = analytic.half_space_under_flux(0.0, 4.0, **material)
    assert face == pytest.approx(2 * 3.0 * np.sqrt(4.0 / (np.pi * 5.0 * 2500.0 * 1970.0)))
    # heat taken up = flux times time
    x = np.linspace(0, 0.1, 20001)
    rise = analytic.half_space_under_flux(x, 4.0, **material)
    assert (rise[1:] + rise[:-1]).sum() / 2 * x[1] * 2500.0 * 1970.0 == pytest.approx(12.0, rel=1e-4)


# ---- steady states

def test_steady_profile_is_linear():
    network = chain(11)
    network.fix([0, 10], [300.0, 400.0])
    assert network.steady_state() == pytest.approx(np.linspace(300, 400, 11), abs=1e-9)


def test_long_transient_ends_in_the_steady_state():
    network = chain(12, conductance=3.0)
    network.fix(0, 350.0)
    network.source(4, 20.0)
    network.convect([9, 10], 2.0, 283.0)
    network.radiate(11, 0.05, 600.0)
    network.advance(500.0)
    assert network.temperature == pytest.approx(network.steady_state(), abs=1e-6)


def test_insulated_network_evens_out_and_keeps_its_heat():
    network = HeatNetwork(capacity=[1.0, 3.0, 5.0, 7.0], edges=[[0, 1], [2, 3]], conductance=[1.0, 2.0],
                          temperature=[300.0, 400.0, 500.0, 620.0])
    assert network.steady_state() == pytest.approx([375.0, 375.0, 570.0, 570.0])
    network.source([0, 1], [2.0, -2.0])
    assert network.steady_state() == pytest.approx([375.0 + 1.5, 375.0 - 0.5, 570.0, 570.0])
    network.source(1, 0.0)
    with pytest.raises(ParameterError, match="source"):
        network.steady_state()


STEEL_ON_ROCK = {"tool": (60.0, 7830.0, 450.0), "rock": (5.0, 2500.0, 1970.0)}
"""Conductivity, density, specific heat."""


def rubbed(cells, share, conductance, seconds):
    """Faces of two bars that rub on each other, their nodes at the faces and on beyond the reach of the heat."""
    lengths, capacities, edges, conductances, first = [], [], [], [], [0, cells + 1]
    for start, (conductivity, density, specific_heat) in zip(first, STEEL_ON_ROCK.values()):
        size = 6 * np.sqrt(conductivity / density / specific_heat * seconds) / cells
        lengths.append(size)
        capacities.append(density * specific_heat * size * np.where(np.arange(cells + 1) % cells, 1.0, 0.5))
        edges.append(start + np.column_stack([np.arange(cells), np.arange(1, cells + 1)]))
        conductances.append(np.full(cells, conductivity / size))
    network = HeatNetwork(capacity=np.concatenate(capacities), edges=np.vstack([*edges, [first]]),
                          conductance=np.concatenate([*conductances, [conductance]]), temperature=0.0)
    network.source(first, 1e6 * np.array([share, 1 - share]))
    network.advance(seconds)
    return network.temperature[first]


@pytest.mark.parametrize("conductance", [0.0, 1500.0, 3e5])
@pytest.mark.parametrize("sharing", ["equal", "effusivity"])
def test_two_bodies_that_rub_on_each_other(sharing, conductance):
    effusivities = [effusivity(*values) for values in STEEL_ON_ROCK.values()]
    share = 0.5 if sharing == "equal" else effusivity_share(*effusivities)
    exact = analytic.sliding_half_spaces(0.5, flux=1e6, share=share, effusivities=effusivities,
                                         conductance=conductance)
    if sharing == "effusivity":
        assert exact[0] == pytest.approx(exact[1], rel=1e-12)
    errors = [abs(rubbed(cells, share, conductance, 0.5) / exact - 1).max() for cells in (20, 40, 80)]
    assert np.polyfit(np.log([20, 40, 80]), np.log(errors), 1)[0] == pytest.approx(-2, abs=0.25)
    assert errors[-1] < 2e-3


def test_sharing_does_not_matter_where_bodies_touch_perfectly():
    common = dict(flux=1e6, effusivities=(14540.0, 4962.0))
    time = np.array([0.0, 1e-3, 1.0])
    best = 2e6 * np.sqrt(time / np.pi) / (14540.0 + 4962.0)
    for share in (0.0, 0.5, 1.0):
        found = analytic.sliding_half_spaces(time, share=share, conductance=1e12, **common)
        np.testing.assert_allclose(found, np.column_stack([best, best]), rtol=1e-6)
    # Without any exchange each is a half-space under its own flux.
    apart = analytic.sliding_half_spaces(0.3, share=0.5, conductance=0.0, **common)
    for rise, (conductivity, density, specific_heat) in zip(apart, [(14540.0, 14540.0, 1.0), (4962.0, 4962.0, 1.0)]):
        assert rise == pytest.approx(float(analytic.half_space_under_flux(
            0.0, 0.3, flux=0.5e6, conductivity=conductivity, density=density, specific_heat=specific_heat)))


def test_radiating_particle_settles_where_it_gives_off_what_it_gets():
    network = HeatNetwork(capacity=[1.0], edges=[], conductance=1.0, temperature=300.0)
    network.source(0, 1000.0)
    network.radiate(0, 0.1, 300.0)
    assert network.steady_state() == pytest.approx([(300.0**4 + 1000.0 / 0.1 / 5.670374419e-8) ** 0.25])


# ---- the balances

def test_heat_balance_closes_to_round_off():
    network = tangle()
    before = network.heat_content - sum(network.balance.values())
    for _ in range(10):
        network.advance(50 * network.stable_step())
        network.add_heat(np.linspace(0, 5, 60))
    carried = network.remove([1, 30, 31])  # a fixed node among them
    network.advance(50 * network.stable_step())
    network.rewire(edges=[[3, 4], [4, 5], [5, 2]], conductance=7.0)
    network.fix(4, 900.0)
    network.advance(20.0)
    balance = network.balance
    assert balance["removed"] == -carried and all(abs(value) > 1 for value in balance.values())
    scale = max(map(abs, balance.values()))
    assert network.heat_content - before == pytest.approx(sum(balance.values()), abs=1e-11 * scale + 1e-12 * before)


def test_each_entry_of_the_balance_alone():
    network = HeatNetwork(capacity=[2.0], edges=[], conductance=1.0, temperature=300.0)
    network.source(0, 5.0)
    network.advance(4.0)
    network.add_heat([7.0])
    assert network.balance["generated"] == pytest.approx(27.0) and network.temperature == pytest.approx([313.5])
    network = HeatNetwork(capacity=[2.0], edges=[], conductance=1.0, temperature=300.0)
    network.convect(0, 3.0, 280.0)
    network.advance(1e3)
    assert network.balance["convected"] == pytest.approx(-40.0)
    network = chain(2, capacity=2.0, temperature=300.0)
    network.fix(0, 310.0)
    network.advance(1e3)
    assert network.balance["into_fixed"] == pytest.approx(40.0)
    assert network.remove(1) == pytest.approx(620.0) and network.heat_content == pytest.approx(620.0)


def test_fixed_nodes_stay_and_hand_on_what_they_get():
    network = chain(5)
    network.fix([0, 4], [500.0, 300.0])
    network.source(0, 1e6)
    network.add_heat([1e6, 0, 0, 0, 0])
    network.advance(1000.0)
    assert network.temperature == pytest.approx([500, 450, 400, 350, 300])
    assert network.balance["into_fixed"] + network.balance["generated"] == pytest.approx(network.heat_content - 1500)


def test_removed_particle_is_gone():
    network = chain(3, temperature=[300.0, 400.0, 500.0])
    network.source(1, 5.0)
    network.remove(1)
    network.advance(10.0)
    assert network.temperature[[0, 2]] == pytest.approx([300.0, 500.0])
    assert network.present.tolist() == [True, False, True] and network.heat_content == pytest.approx(800.0)
    for act in (lambda: network.remove(1), lambda: network.fix(1, 300.0), lambda: network.source(1, 1.0),
                lambda: network.rewire(edges=[[0, 1]], conductance=1.0), lambda: network.add_heat([0.0, 1.0, 0.0])):
        with pytest.raises(ParameterError):
            act()


def test_source_and_convection_replace_what_was_set():
    network = chain(2)
    network.source([0, 1], [5.0, 6.0])
    network.source(0, 0.0)
    network.convect([0, 1], 9.0, 0.0)
    network.convect([0, 1], 0.0, 0.0)
    network.advance(2.0)
    assert network.balance["generated"] == pytest.approx(12.0) and network.balance["convected"] == 0.0


def test_temperatures_handed_out_do_not_move():
    network = chain(2, temperature=[300.0, 400.0])
    before = network.temperature
    network.advance(1.0)
    assert before.tolist() == [300.0, 400.0]
    with pytest.raises(ValueError):
        before[0] = 0.0


def test_restored_network_goes_on_bit_for_bit():
    network = tangle(n=150)
    network.advance(30 * network.stable_step())
    network.remove([3, 40])
    state, duration = network.state(), 33 * network.stable_step()
    assert all(isinstance(value, np.ndarray) for value in state.values())
    steps, at_save = network.advance(duration), state["temperature"].copy()
    other = chain(150)
    other.restore(state)
    assert other.advance(duration) == steps
    assert np.array_equal(other.temperature, network.temperature) and other.balance == network.balance
    assert np.array_equal(state["temperature"], at_save)
    with pytest.raises(ParameterError):
        chain(3).restore(state)
    with pytest.raises(ParameterError):
        other.restore({"temperature": state["temperature"]})


# ---- stability

def growth(network, share):
    """How much noise has grown after 3000 raw Euler steps of `share` of the stable step, sources left out."""
    rate = -np.diag(network._response) @ (network._conduction.toarray() + np.diag(network._convection))
    values = np.random.default_rng(0).standard_normal(len(rate)) * (network._response > 0)
    for _ in range(3000):
        values = values + share * network.stable_step() * (rate @ values)
    return abs(values).max()


@pytest.mark.parametrize("n", [40, 160])  # dense and Lanczos
def test_stable_step_is_sharp(n):
    network = tangle(n)
    network.radiate(range(15, 30), 0.0, 300.0)
    network.convect(5, 25000.0, 283.0)
    assert growth(network, 0.99) < 100
    assert growth(network, 1.01) > 1e10


def test_stable_step_of_a_chain_is_exact():
    network = chain(9, conductance=3.0, capacity=2.0)
    largest = exact_heat.chain_decay_rate(cells=9, conductance=3.0, capacity=2.0, mode=8)
    assert network.stable_step() == pytest.approx(2 / largest)
    network.fix([0, 8], 300.0)
    largest = exact_heat.chain_decay_rate(cells=8, conductance=3.0, capacity=2.0, mode=7)
    assert network.stable_step() == pytest.approx(2 / largest)


def test_stable_step_counts_convection_and_radiation():
    network = HeatNetwork(capacity=[4.0], edges=[], conductance=1.0, temperature=1500.0)
    assert network.stable_step() == np.inf and network.advance(1e6) == 1
    network.convect(0, 2.0, 283.0)
    assert network.stable_step() == pytest.approx(4.0)
    network.radiate(0, 0.01, 300.0)
    assert network.stable_step() == pytest.approx(8 / (2 + 4 * 5.670374419e-8 * 0.01 * 1500.0**3))
    network.fix(0, 1500.0)
    assert network.stable_step() == np.inf


def test_too_long_a_step_is_refused():
    network = chain(2)
    assert network.advance(10.0, step=1.0) == 10
    with pytest.raises(ParameterError, match="stable step"):
        network.advance(10.0, step=1.01)
    assert network.advance(10.0) == 20  # half the stable step


def test_no_temperature_leaves_the_range_of_the_start():
    network = HeatNetwork(capacity=np.tile([1e-4, 1.0], 50), edges=[[i, i + 1] for i in range(99)],
                          conductance=np.tile([1.0, 1e4, 10.0], 33),
                          temperature=np.tile([300.0, 1500.0, 700.0, 300.0], 25))
    network.convect(range(100), 25000 * 0.003, 300.0)
    for _ in range(50):
        network.advance(3 * network.stable_step())
        assert 300 - 1e-9 <= network.temperature.min() and network.temperature.max() <= 1500 + 1e-9


def test_radiation_at_1500_K_stays_bounded_and_cools():
    network = chain(5, capacity=20.0, temperature=1500.0)
    network.radiate(range(5), 0.5, 300.0)
    peaks = []
    for _ in range(40):
        network.advance(5.0)
        peaks.append(network.temperature.max())
    assert np.all(np.diff(peaks) <= 0) and 300 < peaks[3] < 310 and peaks[-1] == pytest.approx(300.0)


@pytest.mark.parametrize("surroundings", [0.0, 293.0])
def test_a_radiating_body_cools_exactly_in_the_limit_of_short_steps(surroundings):
    """From 1500 to 700 K; without surroundings T = T0 (1 + 3 sigma eA T0^3 t / C)^(-1/3)."""
    body = dict(capacity=20.0, area_times_emissivity=0.5)
    seconds = float(exact_heat.radiative_cooling_time(700.0, first=1500.0, surroundings=surroundings, **body))
    if not surroundings:
        growth_of_t = 1 + 3 * STEFAN_BOLTZMANN * 0.5 * 1500.0**3 * seconds / 20.0
        assert 1500.0 * growth_of_t**(-1 / 3) == pytest.approx(700.0, rel=1e-12)
    errors = []
    for steps in (25, 50, 100, 200, 0):
        network = HeatNetwork(capacity=[20.0], edges=[], conductance=1.0, temperature=1500.0)
        network.radiate(0, 0.5, surroundings)
        assert network.advance(seconds, **({"step": seconds / steps} if steps else {})) == steps or not steps
        errors.append(abs(network.temperature[0] - 700.0))
    assert np.polyfit(np.log([25, 50, 100, 200]), np.log(errors[:4]), 1)[0] == pytest.approx(-1, abs=0.06)
    # Of the 800 K that it has cooled by; by itself the network takes twelve steps.
    assert errors[3] < 0.0025 * 800 and errors[4] < 0.045 * 800


def test_radiation_stiffens_within_one_visit():
    network = HeatNetwork(capacity=[1.0], edges=[], conductance=1.0, temperature=10.0)
    network.source(0, 5e4)
    network.radiate(0, 0.1, 10.0)
    network.advance(100.0)
    assert network.temperature == pytest.approx(network.steady_state())


# ---- conductivity

@pytest.mark.parametrize("size", [(12, 12), (25, 20)])
def test_triangular_lattice_conducts_root_three(size):
    positions = triangles(*size, 0.002)
    got = effective_conductivity(positions=positions, edges=touching(positions, 0.002), conductance=5.0)
    assert got == pytest.approx([5 * np.sqrt(3)] * 2, rel=1e-9)


def test_square_lattice_conducts_h():
    positions = grid(12, 9, diameter=0.003)
    got = effective_conductivity(positions=positions, edges=touching(positions, 0.003), conductance=5.0)
    assert got == pytest.approx([5.0, 5.0], rel=1e-9)


def test_cubic_lattice_conducts_h_over_d():
    positions = grid(7, 8, 9, diameter=0.002)
    got = effective_conductivity(positions=positions, edges=touching(positions, 0.002), conductance=5.0)
    assert got == pytest.approx([2500.0] * 3, rel=1e-9)


def test_bars_between_equal_spheres_conduct_as_the_material_on_cubes():
    positions, radius = grid(6, 6, 6, diameter=0.004), 0.002
    for model, part in (("bar", 1.0), ("half_bar", 0.5)):
        edges, conductance = paths(model, 5.0, pairs=touching(positions, 0.004), cells=None, fitted=None,
                                   thickness=2 * radius)
        got = effective_conductivity(positions=positions, edges=edges, conductance=conductance)
        assert got == pytest.approx([5.0 * part] * 3, rel=1e-9)


def test_a_random_packing_of_spheres_is_calibrated():
    positions = pack(box=(0.04, 0.04, 0.04), radius_min=2e-3, radius_max=3e-3, porosity=0.4, seed=1).positions
    edges = cKDTree(positions).query_pairs(5e-3, output_type="ndarray")
    scaled = calibrated_conductance(positions=positions, edges=edges, conductance=1.0, conductivity=60.0)
    assert effective_conductivity(positions=positions, edges=edges, conductance=scaled).mean() == pytest.approx(60.0)


def test_directions_are_told_apart():
    positions = grid(10, 10, diameter=1.0)
    edges = touching(positions, 1.0)
    along = positions[edges[:, 0], 1] == positions[edges[:, 1], 1]
    got = effective_conductivity(positions=positions, edges=edges, conductance=np.where(along, 2.0, 7.0))
    assert got == pytest.approx([2.0, 7.0], rel=1e-9)


def test_damaged_lattice_conducts_as_the_effective_medium():
    """Kirkpatrick 1973: triangles with a share p of their contacts left conduct (p - 1/3)/(2/3) of the whole."""
    ratios = [effective_conductivity(positions=positions, edges=edges, conductance=1.0) / np.sqrt(3)
              for positions, edges in map(dislodged, range(8))]
    assert np.mean(ratios) == pytest.approx(0.7, abs=0.02)


def test_calibrated_packing_has_the_wanted_conductivity():
    positions, edges = dislodged()
    uneven = np.random.default_rng(1).uniform(1, 3, len(edges))
    scaled = calibrated_conductance(positions=positions, edges=edges, conductance=uneven, conductivity=60.0)
    assert np.ptp(scaled / uneven) < 1e-9
    assert effective_conductivity(positions=positions, edges=edges, conductance=scaled).mean() == pytest.approx(60.0)
    with pytest.raises(ParameterError):
        calibrated_conductance(positions=positions, edges=[], conductance=1.0, conductivity=60.0)


def test_numbers_of_the_sources():
    assert bar_conductance(5.0, 1.0) == 5.0 and bar_conductance(60.0, 1.0) == 60.0  # [Rojek 2014, 5.2]
    rock, steel = effusivity(5.0, 2500.0, 1970.0), effusivity(60.0, 7830.0, 450.0)
    assert rock == pytest.approx(4962.36, abs=0.01) and steel == pytest.approx(14539.94, abs=0.01)
    assert effusivity_share(rock, steel) + effusivity_share(steel, rock) == pytest.approx(1.0)
    assert effusivity_share(steel, rock) / effusivity_share(rock, steel) == pytest.approx(steel / rock)
    assert effusivity_share(rock, rock) == 0.5


def test_paths_of_the_four_models():
    pairs = touching(grid(4, 4, diameter=1.0), 1.0)
    of_grid = voronoi.cells(grid(4, 4, diameter=1.0) + 0.5, box=(4, 4))
    found = {model: paths(model, 8.0, pairs=pairs, cells=lambda: of_grid, fitted=lambda: 7.0) for model in PATHS}
    assert all(np.array_equal(np.unique(edges, axis=0), np.unique(pairs, axis=0)) for edges, _ in found.values())
    each = {"voronoi": 8.0, "fitted": 7.0, "bar": 8.0, "half_bar": 4.0}
    assert all(values == pytest.approx([each[model]] * 24) for model, (_, values) in found.items())
    with pytest.raises(ParameterError, match="model"):
        paths("bars", 8.0, pairs=pairs, cells=None, fitted=None)


# ---- what is refused

@pytest.mark.parametrize("wrong", [
    dict(capacity=[0.0, 1.0]), dict(capacity=[-1.0, 1.0]), dict(capacity=[np.nan, 1.0]), dict(capacity=[]),
    dict(edges=[[0, 0]]), dict(edges=[[0, 2]]), dict(edges=[[-1, 0]]), dict(edges=[[0.0, 1.0]]), dict(edges=[0, 1]),
    dict(conductance=-1.0), dict(conductance=[1.0, 2.0]), dict(conductance=np.inf),
    dict(temperature=np.nan), dict(temperature=[1.0, 2.0, 3.0]), dict(temperature="hot")])
def test_wrong_networks_are_refused(wrong):
    with pytest.raises(ParameterError) as caught:
        HeatNetwork(**{**dict(capacity=[1.0, 1.0], edges=[[0, 1]], conductance=1.0, temperature=300.0), **wrong})
    assert next(iter(wrong)) in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("act", [
    lambda it: it.fix(3, 300.0), lambda it: it.fix(-1, 300.0), lambda it: it.fix([0, 0], 300.0),
    lambda it: it.fix([0.5], 300.0), lambda it: it.fix([True], 300.0), lambda it: it.fix(0, np.nan),
    lambda it: it.source([0, 1], [1.0, 2.0, 3.0]), lambda it: it.convect(0, -1.0, 283.0),
    lambda it: it.radiate(0, 1.0, -1.0), lambda it: it.radiate(0, -1.0, 300.0), lambda it: it.add_heat([1.0]),
    lambda it: it.advance(-1.0), lambda it: it.advance(1.0, step=0.0), lambda it: it.advance(np.nan)])
def test_wrong_acts_are_refused_and_change_nothing(act):
    network = chain(3)
    before = network.state()
    with pytest.raises(ParameterError):
        act(network)
    assert all(np.array_equal(value, before[name]) for name, value in network.state().items())


def test_lone_particles():
    network = HeatNetwork(capacity=[3.0, 4.0, 5.0], edges=[[0, 1]], conductance=0.0, temperature=[300.0, 400.0, 500.0])
    assert network.stable_step() == np.inf
    network.advance(1e9)
    assert network.temperature.tolist() == network.steady_state().tolist() == [300.0, 400.0, 500.0]


# ---- hard cases: stable, bounded, balances closed

def one_contact(network_of):
    """Two particles, capacities 1e4 apart."""
    return network_of(capacity=[1e-2, 1e2], edges=[[0, 1]], conductance=50.0, temperature=[1500.0, 280.0])


def stiff_chain(network_of):
    """Conductances and capacities 1e4 apart, in turns."""
    return network_of(capacity=np.tile([1e-3, 10.0, 1.0], 20), edges=[[i, i + 1] for i in range(59)],
                      conductance=np.resize([1.0, 1e4, 10.0, 1e2], 59),
                      temperature=np.resize([280.0, 1500.0, 700.0], 60))


def in_water(network_of):
    """A hot chain in water at 25,000 W/m2K, one particle all by itself."""
    network = network_of(capacity=np.full(6, 5.0), edges=[[0, 1], [1, 2], [2, 3], [3, 4]], conductance=60.0,
                         temperature=1200.0)
    network.convect(range(6), 25000 * 4e-3, 283.0)
    return network


def glowing(network_of):
    """Radiation from 1500 K into a room at 280 K, some particles a hundred times lighter."""
    network = network_of(capacity=np.resize([5.0, 0.05], 8), edges=[[i, i + 1] for i in range(7)], conductance=2.0,
                         temperature=1500.0)
    network.radiate(range(8), 0.02, 280.0)
    return network


@pytest.mark.parametrize("case", [one_contact, stiff_chain, in_water, glowing])
@pytest.mark.parametrize("steps", [0.3, 7.0, 1000.0])
def test_hard_cases_stay_bounded_and_close_their_balance(case, steps):
    network = case(HeatNetwork)
    content = network.heat_content
    duration = steps * network.stable_step()
    for visit in range(5):
        network.advance(duration)
        assert 280 - 1e-9 <= network.temperature.min() <= network.temperature.max() <= 1500 + 1e-9
        if visit == 1:  # the hottest particle goes, with its heat
            hottest = int(np.argmax(np.where(network.present, network.temperature, 0.0)))
            carried = network.capacity[hottest] * network.temperature[hottest]
            assert network.remove(hottest) == pytest.approx(carried)
        if visit == 2:  # the surface doubles at once
            state = network.state()
            there = network.present
            network.convect(there, 2 * state["convection"][there] + 1e-3, 283.0)
            network.radiate(there, 2 * state["radiation"][there], 280.0)
    balance = network.balance
    assert network.heat_content - content == pytest.approx(sum(balance.values()), abs=1e-12 * content)


def test_what_nothing_holds_together_keeps_its_temperature():
    network = HeatNetwork(capacity=[1e-4, 1.0, 1e4], edges=[], conductance=1.0, temperature=[1500.0, 300.0, 280.0])
    network.advance(1e6)
    assert network.temperature.tolist() == [1500.0, 300.0, 280.0]


def test_a_step_above_the_stable_one_is_refused_after_the_surface_doubled():
    network = in_water(HeatNetwork)
    step = network.stable_step()
    network.advance(10 * step, step=step)
    network.convect(range(6), 2 * 25000 * 4e-3, 283.0)
    with pytest.raises(ParameterError, match="stable step"):
        network.advance(10 * step, step=step)
    assert network.advance(10 * step) > 20  # left to itself it divides more finely


def test_several_visits_and_one_visit_of_many_steps_agree():
    whole, parts = tangle(seed=4), tangle(seed=4)
    duration = 400 * whole.stable_step()
    whole.advance(duration)
    for _ in range(1000):  # each below one step, as a heat engine visited often
        parts.advance(duration / 1000)
    assert parts.temperature == pytest.approx(whole.temperature, rel=2e-3)

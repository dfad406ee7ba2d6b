"""New combinations of parts: heat in space and with facets, a Padova rock in a cut, tension-only damage, H(theta).

Each closes its balances, and shows what only this combination can show.
"""
import signal

import numpy as np
import pytest

from rockwear.kernels.archard import MET91
from rockwear.kernels.conduction import STEFAN_BOLTZMANN
from rockwear.model.facet_tool import FacetTool
from rockwear.model.materials import Material
from rockwear.model.particle_tool import LayeredTool, Tool
from rockwear.model.thermal_body import FacetBody, ParticleBody
from rockwear.report.folder import read_history
from tests.running import (
    BLOCK, BLOCK_OF_TRIANGLES, ROOT, SMALL, arguments, assert_as_if_never_stopped, assert_density_is_shown,
    assert_refused, interrupt_script, last_snapshot, packing, refusals, run_script, value, vtk_field)

DENSITY = 7830.0
LIGHT = 10.0
"""Specific heat (J/kg K) for which a short run heats the tool by as much as makes a difference to its hardness."""
HOT = dict(tool_temperature=650, rock_temperature=650, ambient_temperature=650)
IN_SPACE = {**{name: v for name, v in BLOCK.items() if name not in ("Rn", "Rt")}, "cut_time": 0.04,
            "heat_period": 1e-4, "surface_period": 0.02, "report": "false"}
"""The block of cutting_3d_thermal.py in miniature; bonds, wear and heat are the script's own."""
OF_SEGMENTS = {**{name: v for name, v in SMALL.items() if name != "cycles"}, "start_up": 8e-4, "cycle_time": 2e-4,
               "wear_acceleration": 60000, "seed": packing(3, 10), "wear_period": 50, "report": "false",
               "control_radius": 3, "emissivity": 0.9}
"""The cut of segments_thermal.py in miniature, its wear as much faster as it is shorter."""


def script(name):
    return ROOT / f"yade_scripts/{name}.py"


def run(name, out, *flags, **values):
    """Run one of the scripts to a good end."""
    done = run_script(script(name), *arguments(values), "--out", str(out), *flags, out=out)
    assert done.code == 0, done.stderr
    return done


def assert_balances_close(done):
    """Energy within 2 % of the tool's work; heat, mass and the friction that wears to round-off."""
    balances = done.summary["balances"]
    energy, friction, mass, heat = (balances.get(name) for name in ("energy", "friction", "mass", "heat"))
    assert energy["tool_work"] > 1 and abs(energy["residual"]) < 0.02 * energy["tool_work"]
    assert friction["worn_by"] == pytest.approx(friction["tool"], rel=1e-9) and friction["tool"] > 0.1
    assert abs(mass["unexplained"]) < 1e-12 * mass["initial"]
    if heat:
        # Of the heat that rock and tool hold above 0 K, some 1e6 J, all sums are differences.
        assert abs(heat["residual"]) < 1e-13 * 1e6 and heat["generated"] > 1


def wear_per_hardness(done, mu):
    """k A W / mu (J), worn volume times hardness where this is constant, from the friction work W that wears."""
    values = done.summary["parameters"]
    k = values["wear_coefficient"] * values["wear_acceleration"]
    return k / mu * done.summary["balances"]["friction"]["worn_by"]


def integral(first, last):
    """(n,) K/Pa: of 1 / H over temperature, from first to last."""
    kelvin = np.linspace(first, max(np.max(last), first + 1), 20001)
    mean = 0.5 * (1 / MET91(kelvin[1:]) + 1 / MET91(kelvin[:-1])) * np.diff(kelvin)
    return np.interp(last, kelvin, np.concatenate([[0.0], np.cumsum(mean)]))


def assert_wear_follows_own_heat(done, body, volume, *, mu):
    """Each node loses V = k A C / (mu chi s) times the integral of dT / H(T): without conduction T = T0 + chi s W / C.

    The temperature of a heat step counts for the wear until the next one. body: model.thermal_body.ThermalBody; volume:
    (n,) m3 that wore at its nodes.
    """
    values, temperature = done.summary["parameters"], last_snapshot(done.out)["temperature"][-body.count:]
    capacity = body.capacities(Material(density=DENSITY, specific_heat=values["tool_specific_heat"], conductivity=60.0),
                               "voronoi")
    heated = temperature > 650
    assert heated.sum() > 5 and temperature.max() > 700
    assert np.array_equal(heated, volume > 0)
    scale = values["wear_coefficient"] * values["wear_acceleration"] * capacity / (mu * 0.85 * 0.5)
    exact = scale * integral(650.0, temperature)
    assert volume.sum() == pytest.approx(exact.sum(), rel=5e-3)
    assert volume == pytest.approx(exact, rel=0.02, abs=1e-3 * exact.max())
    # What the heating of the run itself does is far more than what is missed.
    assert exact.sum() > 1.03 * (scale * (temperature - 650.0)).sum() / MET91(650.0)


# ---- heat in space with a tool of particles


@pytest.fixture(scope="module")
def in_space(tmp_path_factory):
    return run("cutting_3d_thermal", tmp_path_factory.mktemp("space") / "run", **IN_SPACE)


@pytest.fixture(scope="module")
def in_space_hot(tmp_path_factory):
    """The same cut with a hot tool, whose heat stays where it arises."""
    return run("cutting_3d_thermal", tmp_path_factory.mktemp("hot") / "run", **IN_SPACE, **HOT, conduction="false",
               tool_specific_heat=0.6 * LIGHT, heat_sharing="equal")


def test_a_tool_of_particles_in_space_heats_up(in_space):
    assert_balances_close(in_space)
    shot, model = last_snapshot(in_space.out), np.load(in_space.out / "model.npz")
    rock, tool = np.split(shot["temperature"], [len(model["rock_radii"])])
    assert 293.15 < rock.max() < tool.max() <= value(in_space, "tool_temperature_max")
    # Hot where it rubs, in its lowest part, and cold at the shank.
    hot = tool > 0.5 * (293.15 + tool.max())
    assert model["tool_positions"][hot, 1].max() < BLOCK["depth_of_cut"] and tool[model["tool_fixed"]].max() < 293.2


def test_wear_in_space_follows_the_hardness_at_each_particles_own_temperature(in_space_hot):
    assert_balances_close(in_space_hot)
    model, shot = np.load(in_space_hot.out / "model.npz"), last_snapshot(in_space_hot.out)
    tool = LayeredTool(vertices=model["outline"], radius=BLOCK["tool_radius"], breadth=BLOCK["breadth"], seed=1,
                       removal="none", density=DENSITY)
    assert np.array_equal(tool.positions, model["tool_positions"])
    volume = shot["worn_depth"] * (2 * tool.radii)**2
    assert_wear_follows_own_heat(in_space_hot, ParticleBody(tool), volume, mu=0.1)


def test_heat_does_not_change_the_cut_in_space_but_a_hot_tool_wears_more(in_space, in_space_hot):
    """Nothing is removed: the same forces do the same friction work, and volumes are as 1 / H."""
    friction, hot = (done.summary["balances"]["friction"]["worn_by"] for done in (in_space, in_space_hot))
    assert hot == friction
    ratio = value(in_space_hot, "worn_volume") / value(in_space, "worn_volume")
    warmest = [MET91(value(done, "tool_temperature_max")) for done in (in_space, in_space_hot)]
    assert warmest[0] / MET91(650) < ratio < MET91(293.15) / warmest[1]


def test_heat_in_space_stopped_and_resumed_equals_never_stopped(in_space, tmp_path):
    values = {**IN_SPACE, "checkpoint_interval": 0.01}
    # In the cut, whose steps are one chunk: the checkpoint is that of the end of the lowering.
    stopped = interrupt_script(script("cutting_3d_thermal"), tmp_path / "cut", signal.SIGKILL, 2, **values)
    assert stopped.code == -signal.SIGKILL
    resumed = run("cutting_3d_thermal", tmp_path / "cut", "--resume", **values)
    assert_as_if_never_stopped(resumed, in_space, "cracks.csv")
    assert np.array_equal(*(last_snapshot(out)["temperature"] for out in (in_space.out, tmp_path / "cut")))


# ---- heat with a tool of segments


@pytest.fixture(scope="module")
def of_segments(tmp_path_factory):
    """Heat is on by default; the surface recedes over thermal nodes."""
    return run("segments_thermal", tmp_path_factory.mktemp("segments") / "run", "--vtk", **OF_SEGMENTS)


@pytest.fixture(scope="module")
def of_segments_hot(tmp_path_factory):
    return run("segments_thermal", tmp_path_factory.mktemp("hot") / "run",
               **{**OF_SEGMENTS, "wear_period": 10, "start_up": 1.6e-3}, **HOT, reshape="false", conduction="false",
               tool_specific_heat=3 * LIGHT, heat_sharing="equal", heat_period=2e-6)


def facet_body(done):
    """The thermal body of the tool of segments of a run, when new."""
    outline = np.load(done.out / "model.npz")["outline"]
    tool = FacetTool.of_outline(outline, segment=1e-3, density=DENSITY)
    return tool, FacetBody(tool, fill=Tool(vertices=outline, radius_min=0.435e-3, radius_max=0.565e-3,
                                           seed=OF_SEGMENTS["seed"], removal="none", density=DENSITY))


def test_a_tool_of_segments_heats_up_and_wears(of_segments):
    assert_balances_close(of_segments)
    assert value(of_segments, "tool_temperature_max") > 293.3
    # Nodes that the surface has passed take heat along.
    assert value(of_segments, "mass_lost") > 0 and of_segments.summary["balances"]["heat"]["removed"] < 0
    exact = wear_per_hardness(of_segments, 0.3)
    coldest, warmest = (exact / MET91(kelvin) for kelvin in (293.15, value(of_segments, "tool_temperature_max")))
    assert coldest < value(of_segments, "worn_volume") < warmest


def test_rubbed_segments_are_the_hot_ones_and_wear_by_their_own_temperature(of_segments_hot):
    assert_balances_close(of_segments_hot)
    shot, (tool, body) = last_snapshot(of_segments_hot.out), facet_body(of_segments_hot)
    assert np.array_equal(tool.first, shot["tool_vertices"])
    volume = np.bincount(body.node_of, shot["worn_volume"], body.count)
    assert_wear_follows_own_heat(of_segments_hot, body, volume, mu=0.3)


def test_vtk_shows_temperatures_of_facets_at_their_vertices(of_segments):
    file = sorted((of_segments.out / "vtk").glob("tool.*.vtp"))[-1]
    assert np.array_equal(vtk_field(file, "connectivity").reshape(-1, 2), last_snapshot(of_segments.out)["tool_facets"])
    assert np.array_equal(vtk_field(file, "offsets"), 2 * (1 + np.arange(value(of_segments, "facets"))))
    shown = vtk_field(file, "temperature")
    nodes = last_snapshot(of_segments.out)["temperature"]
    assert len(shown) == len(last_snapshot(of_segments.out)["tool_vertices"])
    assert shown.min() == pytest.approx(293.15, abs=0.01) and 293.2 < shown.max() <= nodes.max() + 1e-6


def test_a_surface_that_is_little_warmer_radiates_as_by_a_coefficient(of_segments):
    """e sigma (T^4 - T_air^4) lies between 4 e sigma T^3 (T - T_air) at both temperatures; convection has 30 W/m2K."""
    heat, warmest = of_segments.summary["balances"]["heat"], value(of_segments, "tool_temperature_max")
    ratio = heat["radiated"] / heat["convected"]
    assert heat["convected"] < 0
    assert 4 * 0.9 * STEFAN_BOLTZMANN * 293.15**3 / 30 < ratio < 4 * 0.9 * STEFAN_BOLTZMANN * warmest**3 / 30


def test_the_density_map_of_a_cut(of_segments, in_space):
    assert_density_is_shown(of_segments.out, 3, 2500.0)
    assert "density" not in last_snapshot(in_space.out)


def test_a_hot_tool_of_segments_wears_more_per_work(of_segments, of_segments_hot):
    cold, hot = (value(done, "worn_volume") / wear_per_hardness(done, 0.3) for done in (of_segments, of_segments_hot))
    assert 1 / MET91(650) < hot and hot / cold > 0.99 * MET91(293.15) / MET91(650)


def test_heat_of_segments_stopped_and_resumed_equals_never_stopped(of_segments, tmp_path):
    values = {**OF_SEGMENTS, "checkpoint_interval": 0.01}
    stopped = interrupt_script(script("segments_thermal"), tmp_path / "cut", signal.SIGTERM, 2, **values)
    assert stopped.code == 128 + signal.SIGTERM
    resumed = run("segments_thermal", tmp_path / "cut", "--resume", **values)
    assert_as_if_never_stopped(resumed, of_segments, "cracks.csv", "wear_profile.csv")
    for name in ("temperature", "tool_vertices"):
        assert np.array_equal(*(last_snapshot(out)[name] for out in (of_segments.out, tmp_path / "cut")))


# ---- heat with a tool of triangles


def test_a_tool_of_triangles_heats_up_and_wears_by_its_hardness(tmp_path):
    values = {**IN_SPACE, **BLOCK_OF_TRIANGLES, "heat": "true", "hardness": 0, "wear_coefficient": 0.01,
              "wear_acceleration": 300, "reshape": "true"}
    values.pop("tool_radius")
    done = run("cutting_3d_triangles", tmp_path / "run", **values)
    assert_balances_close(done)
    assert value(done, "tool_temperature_max") > 300 and value(done, "mass_lost") > 0
    exact = wear_per_hardness(done, 0.1)
    coldest, warmest = (exact / MET91(kelvin) for kelvin in (293.15, value(done, "tool_temperature_max")))
    assert coldest < value(done, "worn_volume") < warmest


# ---- bond laws


def cracks(done):
    """{column: (n,)} of the cracks of a run."""
    return {name: np.array(column) for name, column in read_history(done.out / "cracks.csv")[0].items()}


CRUSHED = dict(width=0.03, height=0.02, tooth_height=0.018, tooth_width=0.012, depth_of_cut=0.006, tool_kn=20e9,
               tool_kt=20e9, start_up=4e-4, cycles=0, heat="false", report="false")


def test_a_padova_rock_is_cut(tmp_path):
    """Python gives the forces of all bonds at every step; bonds flow before they break, and some break in shear, by
    eta (c - Fn): a brittle one, with Rt = 1e6 N, never does here."""
    done = run("padova_cut", tmp_path / "run", **{**SMALL, **CRUSHED, "start_up": 3.5e-4})
    assert_balances_close(done)
    assert value(done, "tensile_cracks") > 10 and value(done, "shear_cracks") > 1
    assert done.summary["balances"]["energy"]["bond_breaking"] > 1.01 * cracks(done)["energy"].sum()
    current, = done.out.glob("checkpoint/*/state.npz")
    with np.load(current) as state:
        there = state["scene/engines/bonds/status"] != 2
        assert len(state["scene/engines/bonds/softening_bonds"]) == there.sum() > 50


def test_under_tension_only_shear_alone_breaks_no_bond(tmp_path):
    """Bonds are weak in shear. One that only opening damages dissipates at least Rn^2 / 2 (1 / kn + 1 / H)."""
    weak = {**SMALL, **CRUSHED, "bond_law": "damage", "H": 2e10, "Rt": 2e4, "time_step_fraction": 0.4}
    either, opening = (run("tooth_cycles", tmp_path / word, **weak, tension_only=word) for word in ("false", "true"))
    least = 0.5 * 1e5**2 * (1 / 20e9 + 1 / 2e10)
    for done in (either, opening):
        assert_balances_close(done)
    assert len(cracks(opening)["energy"]) > 5 and cracks(opening)["energy"].min() > 0.99 * least
    assert value(either, "shear_cracks") > 10 and np.median(cracks(either)["energy"]) < 0.5 * least


# ---- hardness over temperature without heat


def test_segments_without_heat_wear_by_the_hardness_at_their_temperature(tmp_path):
    values = {**OF_SEGMENTS, "start_up": 4e-4, "cycles": 0, "heat": "false", "reshape": "false"}
    values.pop("emissivity")
    cold, hot = (run("segments_thermal", tmp_path / str(kelvin), **values, tool_temperature=kelvin)
                 for kelvin in (300, 800))
    assert_balances_close(hot)
    friction = [done.summary["balances"]["friction"]["worn_by"] for done in (cold, hot)]
    assert friction[0] == friction[1] > 1
    assert value(hot, "worn_volume") / value(cold, "worn_volume") == pytest.approx(MET91(300) / MET91(800), rel=1e-12)


# ---- what makes no sense


def test_combinations_that_make_no_sense_are_refused_in_a_line(tmp_path):
    done = run_script(script("tooth_cycles"), *arguments({**SMALL, "tool": "segments", "removal": "depth"}), "--out",
                      str(tmp_path / "out"))
    assert_refused(done.code, done.stderr, "removal = depth: must be left out with tool = segments")


@pytest.mark.parametrize("name, usual, cases", [
    ("tooth_cycles", SMALL, [
        (dict(tool="segments", heat="false", thermal_radius=1e-3),
         "thermal_radius = 0.001 m: must be left out with heat = false"),
        (dict(tool="segments", tool_radius_min=1e-3),
         "tool_radius_min = 0.001 m: must be left out with tool = segments"),
        (dict(segment=1e-3), "segment = 0.001 m: must be left out with tool = particles"),
        (dict(bond_law="padova", kt=2e10), "kt = 2e+10 N/m: must be left out with bond_law = padova"),
        (dict(tension_only="true"), "tension_only = true: must be left out with bond_law = brittle"),
        (dict(heat="false", conduction="false"), "conduction = false: must be left out with heat = false")]),
    ("cutting_3d_wear", BLOCK, [
        (dict(heat="true", hardness=0, bond_conductance="bar"),
         "bond_conductance = bar: must be voronoi for a tool in space"),
        (dict(rock_conductivity=1), "rock_conductivity = 1 W/mK: must be left out with heat = false")]),
    ("granular_3d", {}, [(dict(heat="true"), "heat = true: must be a known parameter")])])
def test_parameters_of_parts_that_are_not_there_are_refused(tmp_path, name, usual, cases):
    words = [arguments({**usual, **values, "out": tmp_path / "out"}) for values, _ in cases]
    found = refusals(script(name), tmp_path, words)
    for (code, said), (_, expected) in zip(found, cases, strict=True):
        assert_refused(code, said, expected)
    assert not (tmp_path / "out").exists()

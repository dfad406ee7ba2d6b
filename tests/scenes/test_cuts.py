"""Cuts of [Rojek 2003, ch. 8-10] in miniature, wear and heat as their scripts have them: exact relations."""
import numpy as np
import pytest

from rockwear.model.materials import Material
from rockwear.model.particle_tool import Tool
from rockwear.model.thermal_body import ParticleBody
from rockwear.report.folder import read_history
from tests.running import ROOT, SMALL, arguments, last_snapshot, run_script, value

TINY = {**{name: v for name, v in SMALL.items() if name not in ("cycles", "cycle_time")}, "report": "false"}
DISCS = 2 * 0.5e-3
"""Diameter (m) of the particles of both tools."""


def cut(name, out, **values):
    """Run one of the scripts to a good end."""
    done = run_script(ROOT / f"yade_scripts/{name}.py", *arguments({**TINY, **values}), "--out", str(out), out=out)
    assert done.code == 0, done.stderr
    assert value(done, "tensile_cracks") > 50
    energy, friction = (done.summary["balances"][balance] for balance in ("energy", "friction"))
    assert energy["tool_work"] > 100 and abs(energy["residual"]) < 0.01 * energy["tool_work"]
    assert friction["worn_by"] == pytest.approx(friction["tool"], rel=1e-9)
    return done


def test_equal_particles_go_once_they_are_worn_by_their_diameter(tmp_path):
    """Wear twenty times the script's, so that 4 mm of cut are enough, and looked at in every other step."""
    done = cut("cutting_particles", tmp_path / "run", velocity=2, start_up=2e-3, snapshot_period=1e-3,
               wear_coefficient=20 * 0.839 * 5e-9, wear_period=2)
    mass, worked = (done.summary["balances"][name] for name in ("mass", "friction"))
    assert value(done, "worn_volume") == pytest.approx(20 * 5e-9 * worked["worn_by"], rel=1e-9, abs=0)
    assert mass["archard"] == pytest.approx(7830 * value(done, "worn_volume"), rel=1e-9)
    gone, depth = ~last_snapshot(done.out)["alive"], last_snapshot(done.out)["worn_depth"]
    model = np.load(done.out / "model.npz")
    assert gone.sum() == value(done, "particles_removed") > 0 and value(done, "dropped_volume") == 0
    assert value(done, "mass_lost") == pytest.approx(gone.mean(), rel=1e-9)
    # They are of the tip, and took their diameter times its width along, and what came in the last two steps.
    assert model["tool_positions"][gone, 1].max() < 4 * DISCS and depth[~gone].max() < DISCS
    volume = value(done, "worn_volume") - model["tool_radii"][0] * 2 * depth.sum()
    assert 1 <= volume / (gone.sum() * (2 * model["tool_radii"][0])**2) < 1.2


@pytest.fixture(scope="module")
def heated(tmp_path_factory):
    """{conduction: run} of 6.4 mm of the cut with heat."""
    folder = tmp_path_factory.mktemp("heated")
    return {word: cut("cutting_thermal", folder / word, start_up=0.16, snapshot_period=0.05, conduction=word)
            for word in ("true", "false")}


def test_conduction_changes_temperatures_alone(heated):
    """Nothing is removed and the hardness is constant: the same cut, step by step."""
    assert len({tuple(run.summary["balances"]["friction"].values()) for run in heated.values()}) == 1
    spread, kept = heated.values()
    # The hottest disc of the rock can be warmed by the tool that it touches; conduction warms more of them.
    assert min(value(run, "rock_temperature_max") for run in heated.values()) > 293.2
    rocks = [last_snapshot(run.out)["temperature"][:-value(run, "tool_particles")] > 293.1500001
             for run in (spread, kept)]
    assert rocks[0][rocks[1]].all() and rocks[0].sum() > 1.2 * rocks[1].sum()
    assert 0.05 < value(spread, "tool_temperature_max") - 293.15 < 0.8 * (value(kept, "tool_temperature_max") - 293.15)
    tools = [last_snapshot(run.out)["temperature"][-value(run, "tool_particles"):] > 293.1501 for run in (spread, kept)]
    # It reaches particles that rub nowhere.
    assert tools[0][tools[1]].all() and tools[0].sum() > 2 * tools[1].sum()


def test_each_row_counts_the_cracks_up_to_its_time(heated):
    rows, cracks = (read_history(heated["true"].out / name)[0] for name in ("history.csv", "cracks.csv"))
    for mode, name in ((1, "tensile_cracks"), (2, "shear_cracks")):
        times = np.array(cracks["time"])[np.array(cracks["mode"]) == mode]
        # The step that follows a row begins at its time.
        assert np.array_equal(rows[name], (times < np.array(rows["time"])[:, None]).sum(axis=1))
    assert len(set(rows["tensile_cracks"])) > 10


@pytest.mark.parametrize("conduction", ["true", "false"])
def test_heat_is_the_friction_work_and_wear_too(heated, conduction):
    run = heated[conduction]
    heat, friction = (run.summary["balances"][name] for name in ("heat", "friction"))
    fraction = run.summary["parameters"]["heat_fraction"]
    assert heat["generated"] == pytest.approx(fraction * (friction["tool"] + friction["rock"]), rel=1e-9)
    assert heat["stored"] == pytest.approx(heat["generated"] + heat["convected"], rel=1e-9)
    assert heat["convected"] < 0 if conduction == "true" else heat["convected"] == 0
    assert value(run, "worn_volume") == pytest.approx(1e-10 * friction["worn_by"] / 100, rel=1e-9, abs=0)
    assert value(run, "mass_lost") == 0


def test_without_conduction_the_tool_keeps_half_of_what_it_rubs(heated):
    """The source shares friction heat equally between tool and rock."""
    run = heated["false"]
    values, model = run.summary["parameters"], np.load(run.out / "model.npz")
    tool = Tool(vertices=model["outline"], radius_min=DISCS / 2, radius_max=DISCS / 2, seed=1, removal="none",
                density=7830.0)
    assert np.array_equal(tool.positions, model["tool_positions"])
    steel = Material(density=7830.0, specific_heat=values["tool_specific_heat"], conductivity=60.0)
    rise = last_snapshot(run.out)["temperature"][-len(tool.positions):] - 293.15
    stored = ParticleBody(tool).capacities(steel, "voronoi") @ rise
    rubbed = run.summary["balances"]["friction"]["tool"]
    assert stored == pytest.approx(0.5 * values["heat_fraction"] * rubbed, rel=1e-9)


@pytest.mark.parametrize("tool", ["particles", "segments"])
def test_a_tool_that_does_not_come_to_the_rock_says_so(tmp_path, tool):
    done = run_script(ROOT / "yade_scripts/tooth_cycles.py", *arguments({**SMALL, "tool": tool, "start_up": 1e-5,
                      "cycles": 0, "report": "false"}), "--out", str(tmp_path / "run"), out=tmp_path / "run")
    assert done.code == 0, done.stderr
    assert value(done, "mean_cutting_force") == 0 and any("did not meet" in line for line in done.summary["warnings"])

"""A tool of facets in YADE: one contact at a time, exact friction and wear, the new shape felt, resumed runs."""
import math
import signal

import numpy as np
import pytest

from rockwear.kernels.boundary import distance
from rockwear.kernels.wear_statistics import places
from rockwear.report.folder import RunFolder, read_history
from rockwear.report.views import history

from tests.running import (
    ROOT, SMALL, arguments, assert_refused, checks_of, interrupt_script, last_snapshot, refusals, run_script, value)

SEGMENTS = ROOT / "yade_scripts/cutting_segments.py"
SHORT = {**SMALL, "velocity": 4.0, "start_up": 8e-4, "cycles": 1, "cycle_time": 2e-4, "reshape": "true", "hardness": 0,
         "wear_coefficient": 0.01128, "wear_acceleration": 3e4, "wear_period": 50}


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """Particles pressed against facets: all checks, made in one process of YADE."""
    return checks_of("facet_contact", tmp_path_factory.mktemp("pressed"))


def cut(out, *flags, **values):
    return run_script(SEGMENTS, *arguments({**SHORT, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def worn(tmp_path_factory):
    return cut(tmp_path_factory.mktemp("segments") / "out", checkpoint_interval=0.3)


@pytest.mark.parametrize("kind, ripple, error", [("single", 1e-12, 1e-11), ("chain", 5e-3, 1e-6)])
def test_a_particle_passes_over_segments_as_over_one_face(pressed, kind, ripple, error):
    found = pressed[kind]
    assert found["facets"] == (4 if kind == "single" else 160)
    assert found["ripple"] < ripple
    assert found["work"] == pytest.approx(found["friction"], rel=error)
    assert found["own"] == pytest.approx(found["whole"], rel=1e-10)


def test_left_to_themselves_contacts_double_at_the_ends_of_segments(pressed):
    """What the engine is for: without it the force rises by a quarter at every end."""
    found = pressed["chain left to YADE"]
    assert found["ripple"] > 0.2
    assert abs(found["yade"] / found["friction"] - 1) > 3e-4


def test_a_shallow_inner_edge_is_one_face(pressed):
    """Its two faces are both touched within a strip of 17 um, 44 steps: counted twice the force would double there."""
    found = pressed["valley"]
    assert found["facets"] == 5 and found["ripple"] < 0.1
    # 1 mm uphill and 5 mm downhill; the angle of friction is that between the force and the normal of the face.
    friction, slope = math.atan(0.3), math.radians(2.5)
    assert found["work"] == pytest.approx(2e4 * (1e-3 * math.tan(friction - slope) + 5e-3 * math.tan(friction + slope)),
                                          rel=2e-3)


def test_a_soft_contact_is_not_thrown_out_of_a_notch(tmp_path):
    """With the force of the deeper face alone some crossings of the edge throw it out with many times what its
    spring holds."""
    found = checks_of("notch", tmp_path)
    assert found["crossings"] > 500 and found["samples"] >= 1000
    assert found["gained"] < 0.2 * found["in_the_spring"] and found["aside"] < 0.3e-3


def test_worn_triangles_lose_archards_volume_and_the_next_contact_feels_it(pressed):
    found = pressed["triangles"]
    assert found["archard"] == pytest.approx(found["by_work"], rel=1e-12)
    assert found["removed"] + found["waiting"] == pytest.approx(found["archard"], rel=1e-9)
    assert found["shape"] == pytest.approx(found["removed"], rel=1e-9)
    assert found["at_rest"] < 1e-9
    # Spheres lie deeper than the new face, and YADE's overlap is that with the kernel's worn boundary.
    assert found["seen"] == pytest.approx(found["overlaps"], rel=1e-9)
    for height, overlap in zip(found["heights"], found["overlaps"]):
        assert height - overlap > 5e-6


def test_the_segments_cut_and_wear_and_balances_close(worn):
    assert worn.code == 0, worn.stderr
    assert value(worn, "tensile_cracks") > 20
    balances = worn.summary["balances"]
    assert abs(balances["energy"]["residual"]) < 0.02 * balances["energy"]["tool_work"]
    assert balances["friction"]["worn_by"] == pytest.approx(balances["friction"]["tool"], rel=1e-9)
    assert abs(balances["mass"]["unexplained"]) < 1e-12 * balances["mass"]["initial"]
    assert balances["mass"]["removed"] > 0.9 * balances["mass"]["archard"]
    exact = 0.01128 * 3e4 / 0.839 * balances["friction"]["worn_by"] / (515 * 9.80665e6 - 20 / 200 * 6 * 9.80665e6)
    assert value(worn, "worn_volume") == pytest.approx(exact, rel=1e-12, abs=0)
    assert worn.summary["results"]["worn_volume"]["unit"] == "m3/m"
    assert read_history(worn.out / "history.csv")[1]["worn_volume"] == "m3/m"
    assert (worn.out / "report.html").stat().st_size > 0
    # At 30,000 times the face recedes faster than rock slides on it, and the run says so.
    assert value(worn, "recession_per_slip") > 1
    said = [float(line.split("se wear_acceleration = ")[1].split(" at most instead of 30000")[0])
            for line in worn.summary["warnings"] if "se wear_acceleration = " in line]
    assert said == pytest.approx([value(worn, "trusted_wear_acceleration")] * 2, rel=0.05)
    assert not any("e+" in line for line in worn.summary["warnings"])


def test_the_trusted_acceleration_is_one_at_which_the_face_recedes_slowly(tmp_path):
    """Layers as deep as long facets go in so many events that the two rules alone allow more."""
    run = cut(tmp_path / "out", segment=0.02, report="false")
    assert run.code == 0, run.stderr
    slow = 3e4 * 0.1 / value(run, "recession_per_slip")
    assert 3e4 * value(run, "contact_events_per_particle") / 10 > slow
    assert 3e4 * (0.1 / value(run, "wear_distribution_error"))**2 > slow
    assert value(run, "trusted_wear_acceleration") == pytest.approx(slow, rel=1e-9)


def test_the_depth_of_wear_is_the_way_from_the_new_outline_to_the_worn_one(worn):
    model, shot = np.load(worn.out / "model.npz"), last_snapshot(worn.out)
    depth = distance(model["tool_vertices"], shot["tool_vertices"], shot["tool_facets"])
    assert 0 < value(worn, "maximum_wear_depth") == pytest.approx(depth.max(), rel=1e-12)
    assert "deepest_wear" not in worn.summary["results"]


def test_the_history_shows_working_hours(worn):
    run = RunFolder(worn.out)
    figure = history.figure(run)
    figure.draw_without_rendering()
    panel = figure.axes[-1]
    upper, = panel.child_axes
    assert upper.get_xlabel() == "working time × acceleration / h"
    # The receding front gets the time to come to the rock, and that is no work.
    assert upper.get_xlim() == pytest.approx((0.0, run.column("working_time")[-1] * 3e4 / 3600), rel=1e-6)
    left = [shot for shot in map(dict, map(np.load, sorted((worn.out / "snapshots").glob("*.npz"))))
            if shot["stage"] == 0][-1]
    new, gone = (vertices[vertices[:, 1] < SMALL["depth_of_cut"], 0].max()
                 for vertices in (run.model["tool_vertices"], left["tool_vertices"]))
    way, step = (new - gone) / 4.0, value(worn, "time_step")
    free = run.parameter("approach") / 4.0
    assert value(worn, "working_time") == pytest.approx(1e-3 - free, abs=4 * step)
    assert way >= 0 and value(worn, "simulated_time") == pytest.approx(1e-3 + way, abs=4 * step)


def test_segments_are_judged_by_the_rules_of_acceleration(worn):
    """The rules of [Rocky], from the record along the outline; a layer as deep as its facet is gone within one
    contact here."""
    with open(worn.out / "wear_profile.csv", encoding="utf-8") as file:
        assert "place_0 [m3/m]" in file.readline()
    columns, _ = read_history(worn.out / "wear_profile.csv")
    by_place = np.sum(list(columns.values()), axis=1)
    assert by_place.sum() == pytest.approx(value(worn, "worn_volume"), rel=1e-9, abs=0)
    model = np.load(worn.out / "model.npz")
    middle = model["tool_vertices"][model["tool_facets"]].mean(axis=1)
    worn_volume = last_snapshot(worn.out)["worn_volume"]
    assert by_place == pytest.approx(np.bincount(places(model["outline"], middle), worn_volume, len(by_place)),
                                     rel=1e-9, abs=1e-9 * by_place.sum())
    assert 0 < value(worn, "trusted_wear_acceleration") < 0.1 * 3e4
    assert any("a layer as deep as its facet goes in" in line for line in worn.summary["warnings"])
    assert (worn.out / "figures/trust.png").exists()


def test_a_half_of_the_work_wears_half(worn, tmp_path):
    run = cut(tmp_path / "out", work_fraction=0.5, reshape="false", cycles=0, report="false")
    friction = run.summary["balances"]["friction"]["worn_by"]
    whole = value(worn, "worn_volume") / worn.summary["balances"]["friction"]["worn_by"]
    assert value(run, "worn_volume") == pytest.approx(0.5 * whole * friction, rel=1e-12, abs=0)
    assert value(run, "mass_lost") == 0
    balance = run.summary["balances"]["mass"]
    worn_mass = pytest.approx(7830 * value(run, "worn_volume"), rel=1e-12, abs=0)
    assert balance["archard"] == balance["shape_kept"] == worn_mass
    assert balance["removed"] == balance["unexplained"] == 0
    model, shot = np.load(run.out / "model.npz"), last_snapshot(run.out)
    length = np.linalg.norm(np.diff(model["tool_vertices"][model["tool_facets"]], axis=1)[:, 0], axis=1)
    deepest = (shot["worn_volume"] / length).max()
    assert value(run, "maximum_wear_depth") == pytest.approx(deepest, rel=1e-12, abs=0) and length.max() <= 1e-3


def test_a_tool_that_the_shank_cannot_hold_is_said(worn, tmp_path):
    """Its top and its back lean: all of its faces wear."""
    file = tmp_path / "tooth.csv"
    file.write_text("0,0\n0.004,0.03\n-0.02,0.026\n-0.016,0.005\n", encoding="utf-8")
    given = {name: v for name, v in SHORT.items() if name not in ("tooth_height", "tooth_width", "rake", "clearance")}
    out = tmp_path / "out"
    run = run_script(SEGMENTS, *arguments({**given, "outline": file, "start_up": 1e-4, "cycles": 0, "report": "false",
                                           "out": out}), out=out)
    assert run.code == 0, run.stderr
    assert not np.load(run.out / "model.npz")["tool_fixed"].any()
    said, unsaid = ([line for line in one.summary["warnings"] if "holds no facet" in line] for one in (run, worn))
    assert len(said) == 1 and not unsaid
    # Of particles one is held in any case. They do not fill the corner that cuts.
    del given["reshape"]
    file.write_text("0,0\n0.001,0.03\n-0.012,0.026\n-0.003,0.005\n", encoding="utf-8")
    discs = run_script(SEGMENTS, *arguments({**given, "tool": "particles", "outline": file, "start_up": 1e-4,
                                             "cycles": 0, "report": "false", "out": tmp_path / "discs"}),
                       out=tmp_path / "discs")
    assert discs.code == 0, discs.stderr
    held, low = (np.load(discs.out / "model.npz")[name] for name in ("tool_fixed", "tool_positions"))
    low = (low[:, 1] - np.load(discs.out / "model.npz")["tool_radii"]).min()
    assert 1 <= held.sum() < 5 and low > 0.05 * SHORT["depth_of_cut"]
    assert any(f"the shank holds {held.sum()} of the tool's {len(held)} particles" in line
               for line in discs.summary["warnings"])
    assert any(f"ends {low:.2g} m above the tip" in line for line in discs.summary["warnings"])


def test_stopped_and_resumed_equals_never_stopped(worn, tmp_path):
    out = tmp_path / "out"
    for number, after in ((signal.SIGKILL, 2), (signal.SIGTERM, 4)):
        stopped = interrupt_script(SEGMENTS, out, number, after, **{**SHORT, "checkpoint_interval": 0.01})
        assert stopped.code in (-signal.SIGKILL, 128 + signal.SIGTERM)
    resumed = cut(out, "--resume", checkpoint_interval=0.01, report="false")
    assert resumed.code == 0, resumed.stderr
    assert resumed.summary["results"] == worn.summary["results"]
    assert resumed.summary["balances"] == worn.summary["balances"]
    assert np.array_equal(*(last_snapshot(run.out)["tool_vertices"] for run in (worn, resumed)))


@pytest.mark.parametrize("kind", ["chain", "triangles"])
def test_a_particle_inside_the_tool_is_found(pressed, kind):
    """YADE's facets have two sides, the tool has one."""
    found = pressed[kind]
    assert found["outside"] is None and found["inside"].startswith("(")


def test_wear_too_fast_for_the_shape_ends_with_what_to_change(tmp_path):
    # The first that is too fast: it has worn before.
    runs = ((value, cut(tmp_path / f"{value:g}", wear_acceleration=value, cycles=0, report="false"))
            for value in (1e5, 3e5, 1e6, 3e6))
    wear_acceleration, run = next((value, run) for value, run in runs if run.code)
    assert run.code == 1
    said = next(line for line in run.stderr.splitlines() if line.startswith("error:"))
    assert "would recede by" in said and f"lower wear_acceleration = {wear_acceleration:g}" in said
    assert "Traceback" not in run.stderr
    assert "worn" not in run.summary["ended"].replace("its wear", "")
    mass = run.summary["balances"]["mass"]
    assert abs(mass["unexplained"]) < 1e-12 * mass["initial"]
    assert mass["archard"] == pytest.approx(7830 * value(run, "worn_volume"), rel=1e-9, abs=0)


def test_a_tool_that_meets_nothing_has_a_force_of_zero_without_a_sign(tmp_path):
    run = cut(tmp_path / "out", start_up=1e-5, cycles=0, record_period=1e-6, report="false")
    assert run.code == 0, run.stderr
    assert math.copysign(1, value(run, "peak_cutting_force")) == 1 and value(run, "peak_cutting_force") == 0


REFUSED = [
    ({"heat": "true", "thermal_radius": 0}, "thermal_radius = 0 m: must be greater than 0"),
    ({"sampling_period": 2}, "sampling_period = 2 steps: must be 1"),
    ({"segment": 0}, "segment = 0 m: must be greater than 0"),
    ({"segment": 1e-9}, "segment = 1e-09 m: must be at least 5.04e-06: the tool would have more than 20000 facets"),
    ({"work_fraction": 2}, "work_fraction = 2: must be at most 1")]


def test_bad_values_are_refused(tmp_path):
    cases = [arguments({**SHORT, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    found = refusals(SEGMENTS, tmp_path, cases)
    for (code, said), (_, words) in zip(found, REFUSED, strict=True):
        assert_refused(code, said, words)
    assert not (tmp_path / "out").exists()
    run = cut(tmp_path / "out", sampling_period=2)
    assert_refused(run.code, run.stderr, REFUSED[1][1])
    assert not (tmp_path / "out").exists()

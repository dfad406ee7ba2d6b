"""The main scene in miniature: it runs, its balances close, and it resumes to the last bit."""
import json
import os
import shutil
import signal
import subprocess
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.running import (
    ROOT, SMALL, arguments, assert_as_if_never_stopped, assert_refused, history, interrupt, refusals, run_script,
    tooth_cycles, value, vtk_field)

TINY = dict(start_up=2e-4, cycles=0, report="false")
TOOTH = "tooth_height", "tooth_width", "rake", "clearance"
"""Parameters of the miniature that an outline replaces."""


@pytest.fixture(scope="module")
def cut(tmp_path_factory):
    """One run of the miniature, to its end."""
    return tooth_cycles(tmp_path_factory.mktemp("cut") / "out", "--vtk", checkpoint_interval=0.3)


@pytest.fixture(scope="module")
def same_tool(tmp_path_factory):
    """Three cycles with a tool that keeps its shape; a period below a step gives each cycle's start a snapshot."""
    return tooth_cycles(tmp_path_factory.mktemp("same") / "out", heat="false", removal="none", snapshot_period=1e-9,
                        **{**TINY, "start_up": 3e-4, "cycles": 3, "cycle_time": 8e-4})


def test_it_ends_well_and_leaves_the_whole_folder(cut):
    assert cut.code == 0, cut.stderr
    assert cut.summary["ended"] == "finished"
    for name in ("summary.json", "history.csv", "report.html", "model.npz", "checkpoint/current.json"):
        assert (cut.out / name).stat().st_size > 0
    assert len(list((cut.out / "snapshots").glob("*.npz"))) >= 4
    assert set(SMALL) <= set(cut.summary["parameters"])
    assert cut.summary["peak_memory"]["value"] > 1e7


def test_the_rock_breaks_and_the_tool_heats_and_wears(cut):
    assert value(cut, "tensile_cracks") > 20
    assert value(cut, "mean_cutting_force") > 1e4
    assert value(cut, "tool_temperature_max") > 293.2
    assert value(cut, "worn_volume") > 0


def test_the_mean_force_is_the_work_over_the_way_however_few_rows_the_record_has(cut, tmp_path):
    """A record without a row in a stage gets one at its end."""
    few = tooth_cycles(tmp_path / "few", record_period=1.0, report="false")
    assert few.code == 0, few.stderr
    assert history(few.out)["stage [-]"].tolist() == [0, 1]
    for run in (cut, few):
        way = 4.0 * value(run, "working_time")
        assert value(run, "mean_cutting_force") == pytest.approx(
            run.summary["balances"]["energy"]["tool_work"] / way, rel=1e-9)
    assert value(few, "mean_thrust_force") == pytest.approx(value(cut, "mean_thrust_force"), rel=1e-9)
    assert value(few, "tool_temperature_max") == pytest.approx(value(cut, "tool_temperature_max"), abs=0.5)


@pytest.mark.parametrize("approach, worked", [(0.02, 0.0), (6e-3, 1e-4)])
def test_a_free_way_that_the_start_up_does_not_cover_is_no_cut_in_the_cycles(approach, worked, tmp_path):
    """4.8 mm of start-up, a cycle of 1.6 mm."""
    run = tooth_cycles(tmp_path / "out", approach=approach, report="false")
    assert run.code == 0, run.stderr
    assert value(run, "working_time") == pytest.approx(worked, abs=3 * value(run, "time_step"))
    assert (run.summary["balances"]["energy"]["tool_work"] > 0) == (worked > 0)


def test_energy_balance(cut):
    balance = cut.summary["balances"]["energy"]
    assert balance["tool_work"] > 100
    # Fewer than 10^4 steps and a handful of impacts: what YADE's friction by steps misses is larger than in a real run,
    # whose target is 1 %.
    assert abs(balance["residual"]) < 0.02 * balance["tool_work"]


def test_energy_that_the_balance_misses_is_said_and_without_heat_there_is_no_heat_engine(cut, tmp_path):
    """Forces sampled every 1000 steps only, more than a collision's length."""
    run = tooth_cycles(tmp_path / "out", heat="false", cycles=0, report="false", sampling_period=1000)
    assert run.code == 0, run.stderr
    energy = run.summary["balances"]["energy"]
    assert abs(energy["residual"]) > 0.05 * energy["tool_work"]
    assert "the energy balance misses" in run.summary["warnings"][0] and "the energy balance misses" in run.stderr
    assert not any("energy balance" in line for line in cut.summary["warnings"])
    assert "heat" not in run.summary["wall_time"]["by_engine"] and "heat" not in run.summary["balances"]
    assert "heat" in cut.summary["wall_time"]["by_engine"] and "heat" in cut.summary["balances"]


def test_heat_balance_closes_to_round_off(cut):
    balance = cut.summary["balances"]["heat"]
    assert balance["generated"] > 10
    content = 1e7  # J of heat held above 0 K, of which the stored heat is the difference
    assert abs(balance["residual"]) < 1e-12 * content
    friction = cut.summary["balances"]["friction"]
    assert balance["generated"] == pytest.approx(0.85 * (friction["tool"] + friction["rock"]), rel=1e-9)


def test_all_friction_at_the_tool_wears_it(cut):
    balance = cut.summary["balances"]["friction"]
    assert balance["tool"] > 1 and balance["rock"] > 1
    assert balance["worn_by"] == pytest.approx(balance["tool"], rel=1e-9)


def test_mass_balance_closes_to_round_off(cut):
    balance = cut.summary["balances"]["mass"]
    assert balance["archard"] > 0
    assert abs(balance["unexplained"]) < 1e-12 * balance["initial"]


@pytest.mark.parametrize("law, options, low, high", [
    ("dissipation", dict(wear_period=1), 1, 1),
    ("modes", dict(wear_modes="0.02/1/0.3, 0.007542857142857143/1/0.7"), 1, 1),
    # Friction of a contact that its dashpot pulls is work, but no pressure.
    ("pressure", {}, 0.97, 1 - 1e-6)])
def test_a_constant_hardness_gives_archards_volume(tmp_path, law, options, low, high):
    """V = k F s / H with F s = W / mu, from the run's own friction work."""
    run = tooth_cycles(tmp_path / "out", hardness_temperature=473.15, wear_acceleration=100, wear_law=law, **options,
                       **{**TINY, "start_up": 6e-4})
    hardness = 509 * 9.80665e6
    exact = 0.01128 * 100 / 0.3 * run.summary["balances"]["friction"]["worn_by"] / hardness
    assert low * (1 - 1e-12) <= value(run, "worn_volume") / exact <= high * (1 + 1e-12)


def test_killed_and_stopped_and_resumed_equals_never_stopped(cut, tmp_path):
    out = tmp_path / "out"
    options = dict(checkpoint_interval=0.01, report="false")
    killed = interrupt(out, signal.SIGKILL, 2, **options)
    assert killed.code == -signal.SIGKILL and not (out / "summary.json").exists()
    stopped = interrupt(out, signal.SIGTERM, 3, **options)
    assert stopped.code == 128 + signal.SIGTERM and "--resume" in stopped.stdout
    stopped = interrupt(out, signal.SIGINT, 5, **options)
    assert stopped.code == 128 + signal.SIGINT
    assert_as_if_never_stopped(tooth_cycles(out, "--resume", **options), cut)


@pytest.mark.parametrize("law", ["damage", "plastic"])
def test_a_cut_with_softening_bonds_closes_its_balance(tmp_path, law):
    run = tooth_cycles(tmp_path / "out", bond_law=law, heat="false", report="false", start_up=8e-4, cycle_time=3e-4)
    assert run.code == 0, run.stderr
    balance, cracks = run.summary["balances"]["energy"], run.summary["results"]
    assert cracks["tensile_cracks"]["value"] + cracks["shear_cracks"]["value"] > 20 and balance["bond_breaking"] > 0
    assert abs(balance["residual"]) < 0.02 * balance["tool_work"]


def test_truncated_and_foreign_checkpoints_are_refused(tmp_path):
    whole, cut_short, unreadable = (tmp_path / name for name in ("whole", "cut_short", "unreadable"))
    assert tooth_cycles(whole, **TINY).code == 0
    for copy in (cut_short, unreadable):
        shutil.copytree(whole, copy)
    scene = next((cut_short / "checkpoint").glob("*/scene.yade.gz"))
    scene.write_bytes(scene.read_bytes()[:1000])
    (unreadable / "checkpoint/current.json").write_text("{", encoding="utf-8")
    cases = {"Rn is 100000.0 there and 200000.0 here": (whole, {"Rn": 2e5}),
             "scene.yade.gz is missing or damaged": (cut_short, {}), "checkpoint": (unreadable, {})}
    said = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [
        [*arguments({**SMALL, **TINY, **values, "out": out}), "--resume"] for out, values in cases.values()])
    for words, case in zip(cases, said):
        assert_refused(*case, words)


def test_a_tool_worn_away_ends_cleanly(tmp_path):
    fast = dict(TINY, wear_acceleration=1e9, heat_period=1e-5, start_up=1e-3)
    run = tooth_cycles(tmp_path / "out", **{**fast, "report": "true"})
    assert run.code == 0, run.stderr
    assert "worn away" in run.summary["ended"] and "worn away" in run.stdout
    assert value(run, "mass_lost") > 0.9 and (run.out / "checkpoint/current.json").exists()
    # It was worn too fast to tell where, and says so.
    assert value(run, "trusted_wear_acceleration") < 1e-3 * 1e9
    assert "cannot be told from a run as short as this" in run.stderr
    assert "How far the acceleration can be trusted" in (run.out / "report.html").read_text(encoding="utf-8")
    mass = run.summary["balances"]["mass"]
    assert abs(mass["unexplained"]) < 1e-12 * mass["initial"] * 1e6
    # Nothing is left to go on with.
    again = tooth_cycles(run.out, "--resume", **fast)
    assert again.code == 0 and again.summary["ended"] == run.summary["ended"], again.stderr
    assert again.summary["results"] == run.summary["results"]


def test_a_simulation_that_blows_up_ends_in_one_line(tmp_path):
    out = tmp_path / "out"
    run = run_script(ROOT / "tests/scenes/scripts/blow_up.py", *arguments({**SMALL, **TINY, "start_up": 1e-3}), "--out",
                     str(out), out=out)
    assert run.code == 1
    assert "blew up" in run.stderr and "Traceback" not in run.stderr
    assert (out / "checkpoint/current.json").exists()


def test_both_removal_rules_report_what_they_differ_by(tmp_path):
    runs = {rule: tooth_cycles(tmp_path / rule, removal=rule, wear_acceleration=3e5, **{**TINY, "start_up": 8e-4})
            for rule in ("volume", "depth")}
    for run in runs.values():
        assert value(run, "particles_removed") > 3
    unexplained = {rule: run.summary["balances"]["mass"]["unexplained"] / run.summary["balances"]["mass"]["archard"]
                   for rule, run in runs.items()}
    assert abs(unexplained["volume"]) < 1e-12
    assert unexplained["depth"] < -0.1
    assert "removal = depth has lost" in runs["depth"].stderr and "has lost" not in runs["volume"].stderr


def test_a_table_of_yade_batch_gives_a_folder_a_row(tmp_path):
    table = tmp_path / "table.txt"
    values = {**SMALL, **TINY, "heat": "false", "out": tmp_path / "sweep"}
    rows = [("weak", 0.1e6, 1), ("strong", 0.2e6, 1), ("strong", 0.3e6, 2)]
    lines = [["description", "Rn", "seed", *values], *([*row, *values.values()] for row in rows)]
    table.write_text("".join(" ".join(map(str, line)) + "\n" for line in lines), encoding="utf-8")
    done = subprocess.run(["yade-batch", "-j2", "--job-threads=1", f"--log={tmp_path}/@.log", str(table),
                           str(ROOT / "yade_scripts/tooth_cycles.py")],
                          cwd=tmp_path, capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL, timeout=180)
    found = {path.parent.name: json.loads(path.read_text(encoding="utf-8"))
             for path in (tmp_path / "sweep").glob("*/summary.json")}
    assert {name: summary["parameters"]["Rn"] for name, summary in found.items()} == {
        "weak": 0.1e6, "strong_line_3": 0.2e6, "strong_line_4": 0.3e6}, done.stdout + done.stderr
    # Another seed is another rock.
    bonds = {name: summary["results"]["rock_bonds"]["value"] for name, summary in found.items()}
    assert bonds["weak"] == bonds["strong_line_3"] != bonds["strong_line_4"]


def test_a_table_without_its_last_line_break_is_refused(tmp_path):
    """YADE would read 0.15 as 0.1."""
    table = tmp_path / "table.txt"
    table.write_text("out porosity\nhere 0.15", encoding="utf-8")
    script, environment = ROOT / "yade_scripts/tooth_cycles.py", {**os.environ, "YADE_BATCH": f"{table}:2"}
    run = run_script(script, cwd=tmp_path, env=environment)
    assert (run.code, run.stderr.splitlines()[-1]) == (2, f"error: table = {table}: must be closed by a line break")


def test_every_cycle_starts_on_the_rock_that_the_start_up_left(same_tool):
    run = same_tool
    shots = [np.load(file) for file in sorted((run.out / "snapshots").glob("*.npz"))]
    stages = [int(shot["stage"]) for shot in shots]
    left = shots[max(i for i, stage in enumerate(stages) if stage == 0)]
    starts = [shots[stages.index(n)] for n in (1, 2, 3)]
    ends = [shots[max(i for i, stage in enumerate(stages) if stage == n)] for n in (1, 2, 3)]
    assert (ends[0]["status"] != 0).sum() > (left["status"] != 0).sum() > 0
    for shot in starts:
        assert np.array_equal(shot["status"], left["status"])
        assert np.array_equal(shot["rock_positions"], left["rock_positions"])


def test_the_end_of_a_cycle_is_no_force_of_the_next_one(tmp_path):
    """Its last impulse, after its last record, came into the first record of the next one, where the tool is in the
    air."""
    run = tooth_cycles(tmp_path / "out", heat="false", removal="none", **{
        **TINY, "start_up": 2e-5, "cycles": 3, "cycle_time": 3e-4, "record_period": 5e-5})
    found = history(run.out)
    first = [np.flatnonzero(found["stage [-]"] == n)[0] for n in (2, 3)]
    assert (found["cutting_force [N/m]"][first] == 0.0).all() and found["cutting_force [N/m]"].max() > 0


def test_a_worn_tool_gets_the_time_to_come_to_the_rock(tmp_path):
    """Else a tooth whose tip has gone back by more than a cycle's way would meet no rock any more."""
    seconds = 6e-4
    values = dict(heat="false", wear_acceleration=1.5e6, snapshot_period=1, start_up=seconds, cycles=3,
                  cycle_time=seconds, record_period=1e-6, report="false")
    run = tooth_cycles(tmp_path / "whole", **values)
    model = np.load(run.out / "model.npz")
    shots = [np.load(file) for file in sorted((run.out / "snapshots").glob("*.npz"))]
    ends = [shot for shot, later in zip(shots, shots[1:]) if later["stage"] != shot["stage"]]
    low = model["tool_positions"][:, 1] - model["tool_radii"] < SMALL["depth_of_cut"]
    fronts = model["tool_positions"][:, 0] + model["tool_radii"]
    behind = fronts[low].max() - np.array([fronts[low & end["alive"]].max() for end in ends])
    assert behind[2] >= behind[0] > 1e-3
    times = np.array([float(end["time"]) for end in ends])
    assert np.diff(times) == pytest.approx(seconds + behind[:-1] / 4.0, abs=2 * value(run, "time_step"))
    # The way to the rock is no work: not in the time that wear stands for, nor in the rock that is cut.
    working = 4 * seconds - run.summary["parameters"]["approach"] / 4.0
    assert value(run, "working_time") == pytest.approx(working, abs=4 * value(run, "time_step"))
    tool_work = run.summary["balances"]["energy"]["tool_work"]
    assert value(run, "specific_energy") == pytest.approx(tool_work / (SMALL["depth_of_cut"] * 4.0 * working), rel=1e-3)
    assert value(run, "mean_cutting_force") == pytest.approx(tool_work / (4.0 * working), rel=2e-3)
    record = history(run.out)
    resting = np.diff(record["working_time [s]"], prepend=0) == 0
    coming = [np.ptp(record["time [s]"][(record["stage [-]"] == n) & resting]) for n in range(1, len(ends))]
    assert coming == pytest.approx(behind[:-1] / 4.0, abs=6e-5)
    stopped = interrupt(tmp_path / "out", signal.SIGTERM, 4, checkpoint_interval=0.01, **values)
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(tooth_cycles(tmp_path / "out", "--resume", checkpoint_interval=0.01, **values), run)


@pytest.mark.parametrize("celsius, lines", [(599.999, 1), (400, 0)])
def test_wear_beyond_the_hardness_table_is_said_in_the_summary(tmp_path, celsius, lines):
    run = tooth_cycles(tmp_path / "out", tool_temperature=celsius + 273.15, **{**TINY, "start_up": 6e-4})
    assert run.code == 0, run.stderr
    assert sum("leaves the hardness table" in line for line in run.summary["warnings"]) == lines
    assert run.stderr.count("leaves the hardness table") == lines


def test_a_tool_that_does_not_reach_the_rock_any_more_says_so(tmp_path):
    spike = tmp_path / "spike.csv"
    spike.write_text("x,y\n-0.002,0\n0,0\n0,0.03\n-0.02,0.03\n-0.02,0.009\n-0.002,0.009\n", encoding="utf-8")
    run = tooth_cycles(tmp_path / "out", heat="false", wear_acceleration=1e6, depth_of_cut=0.005, cycles=8,
                       outline=spike, report="false", without=TOOTH)
    assert run.code == 0, run.stderr
    assert run.summary["ended"].startswith("nothing of the tool reaches the rock") and value(run, "mass_lost") < 0.9
    assert abs(run.summary["balances"]["energy"]["residual"]) < 0.02 * run.summary["balances"]["energy"]["tool_work"]
    assert sum("it cuts no more" in line for line in run.summary["warnings"]) == 1


def test_every_crack_is_logged_with_place_mode_and_energy(cut):
    lines = (cut.out / "cracks.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("time [s],x [m],y [m],z [m],normal_x [-]") and "energy [J]" in lines[0]
    table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert len(table) == value(cut, "tensile_cracks") + value(cut, "shear_cracks")
    assert table[:, 8].sum() == pytest.approx(cut.summary["balances"]["energy"]["bond_breaking"], rel=1e-6)
    assert np.all(np.diff(table[:, 0]) >= 0) and set(table[:, 7]) <= {1, 2}
    assert np.linalg.norm(table[:, 4:7], axis=1) == pytest.approx(1, abs=1e-9)
    # Rn = 1e5 N and kn = 2e10 N/m: a bond broken in pure tension frees 0.25 J, one that also shears more.
    assert np.median(table[table[:, 7] == 1, 8]) > 0.2


def test_vtk_on_request(cut):
    file = sorted((cut.out / "vtk").glob("tool.*.vtp"))[-1]
    count = value(cut, "tool_particles") - value(cut, "particles_removed")
    assert len(vtk_field(file, "points")) == 3 * count and len(vtk_field(file, "temperature")) == count
    entries = ElementTree.parse(cut.out / "vtk/tool.pvd").iter("DataSet")
    shown = {float(entry.get("timestep")): cut.out / "vtk" / entry.get("file") for entry in entries}
    assert sorted(shown) == list(shown) and shown[max(shown)] == file and all(path.exists() for path in shown.values())
    assert max(shown) == pytest.approx(value(cut, "simulated_time"), rel=1e-12) and len(shown) > 2


def test_history_has_units_and_rises_in_time(cut):
    columns = history(cut.out)
    assert all("[" in name for name in columns)
    assert np.all(np.diff(columns["time [s]"]) > 0)
    assert np.all(np.diff(columns["mass_lost [-]"]) >= 0)


def test_the_tip_counts_wherever_the_outline_lies(tmp_path):
    # Binary fractions, so that the shift leaves no trace in the last digit.
    corners = np.array([[0, 0], [4, 0], [4, 5], [0, 5]]) / 256
    works = []
    for shift in ((0.0, 0.0), (-2**20, 0.125)):
        file = tmp_path / f"{shift}.csv"
        np.savetxt(file, corners + shift, delimiter=",")
        run = tooth_cycles(tmp_path / str(shift), outline=file, without=TOOTH, **{**TINY, "start_up": 6e-4})
        works.append(run.summary["balances"]["energy"]["tool_work"])
    assert works[0] > 0 and works[1] == works[0]


def test_wear_is_noted_without_any_change_of_shape(same_tool):
    balance = same_tool.summary["balances"]["mass"]
    assert value(same_tool, "particles_removed") == 0 and balance["archard"] > 0
    assert balance["stored"] == pytest.approx(balance["archard"], rel=1e-12)
    # No particle goes, so none goes in too few events.
    assert "contact events" not in same_tool.stderr and "use wear_acceleration" not in same_tool.stderr


def test_cycles_that_repeat_each_other_sample_no_more_than_one(same_tool, tmp_path):
    """Nothing goes, so each cycle does to the same tool in the same rock what the first did."""
    runs = [tooth_cycles(tmp_path / "out", heat="false", removal="none",
                         **{**TINY, "start_up": 3e-4, "cycles": 1, "cycle_time": 8e-4}), same_tool]
    profiles = [np.loadtxt(run.out / "wear_profile.csv", delimiter=",", skiprows=1) for run in runs]
    assert len(profiles[0]) == len(profiles[1])
    for run, profile in zip(runs, profiles):
        assert profile.sum() == pytest.approx(value(run, "worn_volume"), rel=1e-9)
    first, third = (profile.sum(axis=1) for profile in profiles)
    times = third[first > 0] / first[first > 0]
    cycle = int(np.argmax(times > 2))
    # Until trajectories part, which begin in one rock but in another order of its contacts.
    assert 0 < cycle and times[:cycle] == pytest.approx(1, rel=1e-3) and times[cycle] == pytest.approx(3, rel=0.02)


def test_accelerated_wear_says_how_far_to_trust_it(cut):
    """The run's own statistics, put together from what it left in its folder."""
    lines = (cut.out / "wear_profile.csv").read_text(encoding="utf-8").splitlines()
    increments = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert increments.sum() == pytest.approx(value(cut, "worn_volume"), rel=1e-9)
    assert value(cut, "wear_distribution_error") > 0.05
    assert value(cut, "trusted_wear_acceleration") < 7000
    assert len(cut.summary["warnings"]) == 1 and "use wear_acceleration = " in cut.stderr


def test_strong_damping_is_visited_often_enough(tmp_path):
    """At most a fifth of the velocity in a visit, whatever the period."""
    run = tooth_cycles(tmp_path / "out", background_damping=3e4, start_up=3e-4, cycles=0, heat="false", report="false")
    assert run.code == 0, run.stderr
    visits = run.summary["wall_time"]["by_engine"]["background_damping"]["visits"]
    assert 1.0 <= 0.2 * visits / (3e4 * value(run, "simulated_time")) < 1.5

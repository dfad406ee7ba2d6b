"""The dredge pick in miniature: cuts and cooling in turn, balances that close, and a resume out of the water."""
import json
import signal
import time

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, finish, history, refusals, run_script, start, value)

SCRIPT = ROOT / "yade_scripts/dredge_pick.py"
TINY = dict(window="false", cut_time=0.016, cycles=2, tool_radius_min=2e-3, tool_radius_max=2e-3, record_period=5e-4,
            cooling_period=0.02, snapshot_period=0.25, wear_acceleration=4e5)


def dredge(out, *flags, **values):
    return run_script(SCRIPT, *arguments({**TINY, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def turns(tmp_path_factory):
    """One run of the miniature, to its end."""
    return dredge(tmp_path_factory.mktemp("turns") / "out", checkpoint_interval=0.2)


def stages(run):
    """{stage: {name: column} of its rows}."""
    columns = history(run.out)
    stage = columns["stage [-]"]
    return {int(k): {name.split(" [")[0]: column[stage == k] for name, column in columns.items()}
            for k in np.unique(stage)}


def test_two_turns_of_cutting_and_cooling(turns):
    assert turns.code == 0, turns.stderr
    assert value(turns, "simulated_time") == pytest.approx(1e-3 / (0.7 * 1.6204) + 2 * 2 * np.pi / 1.6204, rel=1e-3)
    rows = stages(turns)
    assert {1, 2, 3, 4} <= set(rows)
    for cut in (1, 3):
        assert rows[cut]["tool_friction"][-1] > rows[cut]["tool_friction"][0]
    assert rows[3]["mass_lost"][-1] > 0
    names = {file.name for file in (turns.out / "figures").iterdir()}
    assert {"failure.png", "heating.png", "cooling.png", "turns.png", "wear.png", "shape.png", "mass_loss.png"} <= names


def test_in_the_water_only_heat_happens(turns):
    rows = stages(turns)
    for water in (2, 4):
        for name in ("tool_work", "tool_friction", "worn_volume", "tensile_cracks", "kinetic_energy"):
            assert np.ptp(rows[water][name]) == 0
        assert len(rows[water]["time"]) == round((2 * np.pi / 1.6204 - 0.016) / 0.02)
        assert np.all(np.diff(rows[water]["tool_temperature_max"]) < 0)
        assert np.all(np.diff(rows[water]["water_heat"]) > 0)
    steps = 2 * 0.016 / (5 * value(turns, "time_step"))
    assert turns.summary["wall_time"]["by_engine"]["bonds"]["visits"] == pytest.approx(steps, rel=0.06)


def test_balances_close_with_the_heat_of_the_water(turns):
    balances = turns.summary["balances"]
    heat = balances["heat"]
    assert -heat["convected"] > 10 and heat["generated"] > 10
    assert abs(heat["residual"]) < 1e-12 * 1e8  # of the heat held above 0 K
    assert -heat["convected"] == pytest.approx(history(turns.out)["water_heat [J/m]"][-1], rel=1e-9)
    assert abs(balances["mass"]["unexplained"]) < 1e-12 * balances["mass"]["initial"]
    assert balances["energy"]["tool_work"] > 100
    assert abs(balances["energy"]["residual"]) < 0.03 * balances["energy"]["tool_work"]


def test_heat_of_the_pick_is_its_share_of_friction_and_little_goes_with_worn_particles(turns):
    columns = history(turns.out)
    share = np.sqrt(60 * 7830 * 450)
    share /= share + np.sqrt(5 * 2500 * 1970)
    made, lost = (columns[f"pick_{name} [J/m]"] for name in ("friction_heat", "heat_worn_away"))
    assert made[-1] == pytest.approx(0.85 * share * columns["tool_friction [J/m]"][-1], rel=1e-6)
    assert 0 < lost[-1] < 0.02 * made[-1]


def test_each_cut_is_into_fresh_rock(turns):
    rows = stages(turns)
    broken = {cut: rows[cut]["tensile_cracks"] + rows[cut]["shear_cracks"] for cut in (1, 2, 3)}
    assert broken[3][0] < 0.5 * broken[1][-1] and broken[2][0] == broken[2][-1] >= broken[1][-1]
    logged = len((turns.out / "cracks.csv").read_text(encoding="utf-8").splitlines()) - 1
    assert logged == value(turns, "tensile_cracks") + value(turns, "shear_cracks")


def test_repeated_turns_rise_and_level_off(turns):
    table = np.array([[float(cell) for cell in line.split(",")]
                      for line in (turns.out / "turns.csv").read_text(encoding="utf-8").splitlines()[1:]])
    peak, absorbed, released = table[:, 1], table[:, 4], table[:, 5]
    rise = np.diff(peak)
    assert np.all(rise > 0) and rise[-1] < 0.02 * rise[0]
    # The heating of the two cuts, without the approach, in which nothing heats the pick.
    assert absorbed == pytest.approx(history(turns.out)["pick_friction_heat [J/m]"][-1] / 2, rel=1e-3)
    assert released[0] < 0.95 * absorbed[0] and released[-1] == pytest.approx(absorbed[-1], rel=0.03)


def test_killed_in_the_water_and_resumed_equals_never_stopped(turns, tmp_path):
    out = tmp_path / "out"
    process = start(SCRIPT, [*arguments({**TINY, "checkpoint_interval": 0.001}), "--out", str(out)])
    deadline = time.time() + 120
    while time.time() < deadline and process.poll() is None and checkpoint_stage(out) != 2:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    assert finish(process, out).code == -signal.SIGKILL and checkpoint_stage(out) == 2
    resumed = dredge(out, "--resume", checkpoint_interval=0.2, report="false")
    assert_as_if_never_stopped(resumed, turns, "turns.csv")


def checkpoint_stage(out):
    """Stage of the present checkpoint, once some of it has passed; -1 without one."""
    try:
        current = json.loads((out / "checkpoint/current.json").read_text(encoding="utf-8"))["set"]
        with np.load(out / "checkpoint" / str(current) / "state.npz") as state:
            return int(state["scene/stage"]) if state["scene/programme/cooled"] > 0 else -1
    except (OSError, ValueError, KeyError):
        return -1


def test_segments_in_a_window_meet_the_same_rock_in_each_turn(tmp_path):
    """Each cut after the first begins in a loaded scene, where YADE looks again for what makes each contact."""
    given = dict(window="true", window_ahead=0.2, feed=0.04, tool="segments", segment=0.01, reshape="false",
                 heat="false", cut_time=0.012, cycles=2, cooling_period=1, seed=1, report="false")
    run = run_script(SCRIPT, *arguments(given), "--out", str(tmp_path / "out"), out=tmp_path / "out")
    assert run.code == 0, run.stderr
    rows = stages(run)
    assert rows[1]["tool_work"][-1] > 0
    for name in ("cutting_force", "thrust_force", "kinetic_energy"):
        assert np.array_equal(rows[1][name], rows[3][name])


def test_the_free_surface_goes_on_to_the_end_of_a_long_run_out(tmp_path):
    """To 157 degrees from the lowest point: the path before it is looked for past 180 degrees."""
    given = dict(window="false", cut_time=0.1, run_out=1.5, scale_factor=6, tool="segments", segment=0.01,
                 reshape="false", heat="false", out=tmp_path / "out")
    assert refusals(SCRIPT, tmp_path, [arguments(given)]) == [(0, "")]
    with np.load(tmp_path / "out/model.npz") as model:
        chords = np.linalg.norm(np.diff(model["free_surface"], axis=0), axis=1)
    # The tip's speed varies with the angle between its rotation and the swing.
    assert len(chords) > 50 and np.ptp(chords) < 0.5 * chords.mean()


IN_WINDOW = dict(window="true")
REFUSED = [
    (dict(cut_time=4), "cut_time = 4"), (dict(feed=0.01), "feed = 0.01"), (dict(backing=0.01), "backing = 0.01"),
    (dict(entry_angle=140, cut_time=0.6), "cut_time = 0.6"),
    (dict(backing=60), "backing = 60 m: must be at most cutter_radius = 0.7"),
    (dict(cutter_radius=0.05), "cutter_radius = 0.05 m: must be more than feed = 0.06"),
    (dict(angular_velocity=1e-6), "angular_velocity = 1e-06 rad/s: must be more than 0.286, so that"),
    (dict(cut_time=1e-3), "cut_time = 0.001 s: must be so long that the cut, 0.00113 m, is longer than a rock"),
    (dict(IN_WINDOW, window_behind=3), "window_behind + window_ahead = 3.14 m: must be at most 1.4, an arc of 2 rad"),
    (dict(tooth_height=0.05, clearance=1), "tooth_height = 0.0499988"),
    (dict(IN_WINDOW, window_ahead=0.1), "window_ahead = 0.1"),
    (dict(IN_WINDOW, window_behind=0.05), "window_behind = 0.05"),
    (dict(IN_WINDOW, window_ahead=0.12, window_behind=0.07), "window_ahead = 0.12"),
    (dict(run_out=1.9), "run_out = 1.9 m: must be less than 1.75, so that the rock, whose cut ends at 26.5 degrees"),
    (dict(window_behind=0.1), "window_behind = 0.1 m: must be left out with window"),
    (dict(IN_WINDOW, run_out=0.05), "run_out = 0.05 m: must be left out with window")]


def test_bad_input_is_refused_in_one_line(tmp_path):
    cases = [arguments({**TINY, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)
    full = [["--full=true", "--window_behind", "0.1"], ["--full", "false", "--run_out", "0.1"]]
    for words, (code, said) in zip(("window_behind = 0.1 m: must be left out with window = false",
                                    "run_out = 0.1 m: must be left out with window = true"),
                                   refusals(SCRIPT, tmp_path, full), strict=True):
        assert_refused(code, said, words)
    run = dredge(tmp_path / "out", feed=0.01)
    assert_refused(run.code, run.stderr, "feed = 0.01")
    assert not (tmp_path / "out").exists()

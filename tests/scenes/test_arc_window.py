"""The window along the path of a dredge pick: closed balances, bit-equal restarts, and the rock that it leaves out."""
import json
import signal
import time

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, checks_of, finish, history, run_script, start, value)

SCRIPT = ROOT / "yade_scripts/dredge_pick.py"
TINY = dict(cut_time=0.03, time_scale=7, cycles=2, scale_factor=3.75, window_behind=0.06, window_ahead=0.12,
            tool_radius_min=2e-3, tool_radius_max=2e-3, tooth_height=0.07, tooth_width=0.05, wear_acceleration=4e5,
            rock_expansion=1e-4, record_period=5e-4, cooling_period=0.2, snapshot_period=0.5, report="false")


def dredge(out, *flags, **values):
    return run_script(SCRIPT, *arguments({**TINY, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def never(tmp_path_factory):
    run = dredge(tmp_path_factory.mktemp("never") / "out", checkpoint_interval=1e3)
    assert run.code == 0, run.stderr
    return run


def test_balances_close_while_the_window_moves_and_begins_anew_with_each_turn(never):
    assert value(never, "window_passed") >= 0.18 / 16
    balances, columns = never.summary["balances"], history(never.out)
    energy, stage = balances["energy"], columns["stage [-]"]
    assert abs(energy["residual"]) < 0.02 * energy["tool_work"]
    assert energy["boundary_dashpots"] > 0 and energy["thermal_expansion"] != 0
    assert abs(balances["heat"]["residual"]) < 1e-12 * 1e8  # of the heat held above 0 K
    assert abs(balances["mass"]["unexplained"]) < 1e-12 * balances["mass"]["initial"]
    cracks = columns["tensile_cracks [-]"] + columns["shear_cracks [-]"]
    assert 0 <= cracks[stage == 3][0] < 0.5 * cracks[stage == 1][-1]
    logged = len((never.out / "cracks.csv").read_text(encoding="utf-8").splitlines()) - 1
    assert logged > cracks[stage == 3][-1]
    assert logged == value(never, "tensile_cracks") + value(never, "shear_cracks")


def test_killed_in_the_second_turn_and_resumed_equals_never_stopped(never, tmp_path):
    out = tmp_path / "out"
    process = start(SCRIPT, [*arguments({**TINY, "checkpoint_interval": 0.001}), "--out", str(out)])
    deadline = time.time() + 120
    while time.time() < deadline and process.poll() is None and not moved_in_second_turn(out):
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    assert finish(process, out).code == -signal.SIGKILL and moved_in_second_turn(out)
    resumed = dredge(out, "--resume", checkpoint_interval=1e3)
    assert_as_if_never_stopped(resumed, never, "turns.csv", "cracks.csv")


def moved_in_second_turn(out):
    """Whether the present checkpoint is of the second cut, with a window that has moved on in it."""
    try:
        current = json.loads((out / "checkpoint/current.json").read_text(encoding="utf-8"))["set"]
        with np.load(out / "checkpoint" / str(current) / "state.npz") as state:
            return int(state["scene/stage"]) == 3 and int(state["scene/programme/window/rock/passed"]) > 0
    except (OSError, ValueError, KeyError):
        return False


@pytest.fixture(scope="module")
def short_and_long(tmp_path_factory):
    found = checks_of("arc_window", tmp_path_factory.mktemp("arc"))
    return {**{name: np.array(found[name]).T for name in ("short", "long", "outwards")}, "padova": found["padova"]}


def test_all_strengths_of_a_bond_grow_with_the_discs(short_and_long):
    """Of the Padova law Rn alone did, and shear was weak beside tension."""
    small, large = (np.array(short_and_long["padova"][factor]) for factor in "24")
    assert large / small == pytest.approx([2.0, 2.0, 0.5], rel=1e-12)


def test_bottom_and_ends_are_held_along_the_arc(short_and_long):
    """Normals point away from the centre or along the arc."""
    outwards = abs(short_and_long["outwards"])
    bottom = outwards > 0.5
    assert bottom.sum() > 10 and outwards[bottom] == pytest.approx(1.0, abs=1e-12)
    assert (~bottom).sum() > 3 and abs(outwards[~bottom]).max() < 1e-12


def test_a_longer_window_is_not_felt_until_waves_come_back_from_its_end(short_and_long):
    """The same rock, a window of three times the length ahead: equal to the last digits while waves are on their way to
    its end and back, and close while the first bonds break."""
    found = short_and_long
    (distance, work, friction), (same, work_long, friction_long) = found["short"], found["long"]
    assert distance == pytest.approx(same, abs=1e-12)
    assert work[:4] == pytest.approx(work_long[:4], rel=1e-9) and work[0] > 1
    assert friction[:4] == pytest.approx(friction_long[:4], rel=1e-9) and friction[3] > 1
    assert work == pytest.approx(work_long, rel=0.05) and abs(work / work_long - 1).max() > 1e-3
    # Of a pick that hardly slides the friction itself is known less well.
    assert abs(friction - friction_long).max() < 2e-3 * work[-1]

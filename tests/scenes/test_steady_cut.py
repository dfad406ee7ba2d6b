"""The steady cut: a window that moves along, with closed balances, bit-equal restarts and rock at rest left at rest."""
import math
import signal

import numpy as np
import pytest

from rockwear.kernels.archard import MET91
from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_density_is_shown, assert_refused, checks_of, history,
    interrupt_script, last_snapshot, refusals, run_script, value)

SCRIPT = ROOT / "yade_scripts/steady_cut.py"
SMALL = dict(rock="", discs_per_depth=0, window_behind=0.016, window_ahead=0.048, window_height=0.026,
             radius_min=0.8e-3, radius_max=1.2e-3, tool_radius_min=4e-4, tool_radius_max=5e-4, tooth_height=0.015,
             tooth_width=0.01, velocity=5.0, tool_kn=2e10, tool_kt=2e10, contact_damping=0.2, ramp_length=2e-3,
             cut_length=0.02, time_step_fraction=0.8, report="false")
"""A steady cut in miniature."""
LAWS = {"brittle": dict(seed=7),
        "softening": dict(bond_law="cohesive", kt=8e9, rotation="blocked", mu=0.3, weibull_modulus=4, heat="true",
                          control_radius=2.5, free_chips="leave", seed=5),
        "crushing": dict(bond_law="cohesive", kt=8e9, grain_edge=2.4e-3, bond_crushing=6e7, bond_tension=3e6,
                         bond_cohesion=8.5e6, bond_shear_energy=500.0)}


def small(values):
    """The parameters of SMALL with these values, without those of particles for a tool of segments."""
    given = {**SMALL, **values}
    if given.get("tool") == "segments":
        given = {name: value for name, value in given.items() if not name.startswith("tool_radius")}
    return given


def steady_cut(out, *flags, **values):
    return run_script(SCRIPT, *arguments(small(values)), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module", params=LAWS)
def never(request, tmp_path_factory):
    run = steady_cut(tmp_path_factory.mktemp("never"), **LAWS[request.param])
    assert run.code == 0, run.stderr
    run.options = LAWS[request.param]
    return run


def way_of(run, chunk=2000):
    """m of a cut of SMALL whose speed rises in steps of so many time steps, each that of the ramp in its middle."""
    step, velocity, ramp = value(run, "time_step"), SMALL["velocity"], SMALL["ramp_length"]
    count = round((SMALL["cut_length"] + ramp) / velocity / step)
    begins = np.arange(0, count, chunk)
    rising = (begins + 0.5 * chunk) * step / (2 * ramp / velocity)
    return velocity * step * float(np.minimum(chunk, count - begins) @ np.clip(rising, 0.05, 1.0))


def test_the_window_moves_and_the_balance_closes(never):
    energy = never.summary["balances"]["energy"]
    assert value(never, "tensile_cracks") > 0
    assert abs(energy["residual"]) < 0.02 * energy["tool_work"]
    assert (energy["rock_crushing"] > 0.05 * energy["tool_work"]) == ("bond_crushing" in never.options)
    # The last row of the record is at the end.
    assert history(never.out)["distance [m]"][-1] == pytest.approx(way_of(never), rel=1e-9)
    assert value(never, "window_passed") >= 4 * (SMALL["window_behind"] + SMALL["window_ahead"]) / 16
    if "control_radius" in never.options:
        # Absent particles have no density, reduced radii no less mass.
        assert_density_is_shown(never.out, never.options["control_radius"], 2500.0)


def test_wear_and_tip_are_shown_beside_what_is_expected_by_hand(never):
    record, given = history(never.out), never.summary["parameters"]
    way, thrust = record["distance [m]"], record["thrust_force [N/m]"]
    assert value(never, "worn_volume_by_hand") == pytest.approx(
        given["wear_coefficient"] * given["wear_acceleration"] * np.sum(thrust[1:] * np.diff(way))
        / MET91(given["tool_temperature"]), rel=1e-6)
    if not given["heat"]:
        assert not {name for name in never.summary["results"] if name.startswith("tool_temperature")}
        return
    hottest = record["tool_temperature_max [K]"]
    assert value(never, "tool_temperature_end") == pytest.approx(hottest[way >= 0.9 * way[-1]].mean())
    # By hand both shares of the heat, of which the common one is the lower, warm the tip.
    assert given["tool_temperature"] < value(never, "tool_temperature_by_blok") < value(
        never, "tool_temperature_by_hand")


def test_chips_that_nothing_touches_leave_where_they_are_to(never):
    gone = np.isnan(last_snapshot(never.out)["rock_positions"][:, 0]).sum()
    leave = "free_chips" in never.options
    assert (gone > 50) == (value(never, "chip_particles_cleared") > 50) == leave
    # Each is a chip.
    chips = np.loadtxt(never.out / "chips.csv", delimiter=",", skiprows=1, ndmin=2)
    assert chips[:, 1].sum() > (50 if leave else 10)


def test_memory_stays_flat_as_the_cut_goes_on(never):
    """What leaks does so all the time: of the last two quarters of the cut, five thousand steps each in which the
    window moves on and bonds break, one takes at most 0.15 MB. (Room that is first needed there is taken once.)"""
    memory = never.summary["memory"]
    begin, middle, end = (np.interp(part * memory["time"][-1], memory["time"], memory["resident"])
                          for part in (0.5, 0.75, 1.0))
    assert 1e8 < middle <= never.summary["peak_memory"]["value"]
    assert min(middle - begin, end - middle) < 1.5e5, (begin, middle, end)


def test_contact_times_do_not_pile_up_where_nothing_conducts_heat(never):
    state, = never.out.glob("checkpoint/*/state.npz")
    assert len(np.load(state)["scene/engines/tool_contact/touching"]) == 0


def test_a_cut_goes_on_as_if_it_was_never_stopped(never, tmp_path):
    options = {**SMALL, **never.options, "checkpoint_interval": 0.01}
    out, tables = tmp_path / "again", ("cracks.csv", "groove.csv", "chips.csv")
    killed = interrupt_script(SCRIPT, out, signal.SIGKILL, 7, **options)
    assert killed.code == -signal.SIGKILL, killed.stderr
    # All cracks up to the last checkpoint, the groove and the chips of then.
    cracks, groove, chips = ((out / name).read_text(encoding="utf-8") for name in tables)
    assert (never.out / "cracks.csv").read_text(encoding="utf-8").startswith(cracks)
    assert cracks.count("\n") > 1 and groove.count("\n") > 1 and chips.startswith("distance [m],")
    for name in tables:
        (out / name).write_text("later than the checkpoint", encoding="utf-8")
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 8, **options)
    assert stopped.code == 128 + signal.SIGTERM, stopped.stderr
    resumed = steady_cut(out, "--resume", **never.options, checkpoint_interval=0.01)
    assert_as_if_never_stopped(resumed, never, *tables)


def test_a_cut_by_segments_goes_on_as_if_it_was_never_stopped(tmp_path):
    """In a loaded scene YADE looks again for what makes each contact, those of the boundary among them."""
    options = dict(tool="segments", segment=1e-3, ramp_length=1e-3, cut_length=0.004, seed=3)
    never = steady_cut(tmp_path / "never", **options)
    assert never.code == 0 and value(never, "tensile_cracks") > 0, never.stderr
    stopped = interrupt_script(SCRIPT, tmp_path / "out", signal.SIGTERM, 2,
                               **small({**options, "checkpoint_interval": 0.01}))
    assert stopped.code == 128 + signal.SIGTERM, stopped.stderr
    assert_as_if_never_stopped(steady_cut(tmp_path / "out", "--resume", **options), never, "cracks.csv")


def test_segments_go_as_far_and_the_process_takes_as_long_as_it_is_slower(tmp_path):
    run = steady_cut(tmp_path / "out", tool="segments", segment=1e-3, cut_length=0.01, velocity=2.5, time_scale=2.0,
                     work_fraction=0.5)
    assert run.code == 0, run.stderr
    rows = history(run.out)
    assert rows["distance [m]"][-1] == pytest.approx(0.01, abs=2e-4)
    # By hand, too, a part of the work wears a tool of facets.
    assert value(run, "worn_volume_by_hand") == pytest.approx(
        0.5 * 0.01128 * np.sum(rows["thrust_force [N/m]"][1:] * np.diff(rows["distance [m]"])) / MET91(293.15),
        rel=1e-6)
    assert value(run, "simulated_time") == pytest.approx((0.01 + SMALL["ramp_length"]) / 2.5, rel=1e-3)
    assert abs(run.summary["balances"]["energy"]["residual"]) < 0.02 * run.summary["balances"]["energy"]["tool_work"]


def test_a_cut_ends_once_its_mean_force_is_known(tmp_path):
    """Thin and fast, so that twenty depths are soon cut."""
    fast = dict(depth_of_cut=2.5e-3, velocity=20.0, cut_length=0.2, accuracy=0.5, seed=1)
    run = steady_cut(tmp_path / "out", **fast)
    assert run.code == 0, run.stderr
    assert value(run, "long_enough") and run.summary["ended"] == "finished"
    known = value(run, "mean_cutting_force_standard_error") / value(run, "mean_cutting_force")
    assert 0 < known <= 0.5 and 20 * 2.5e-3 < history(run.out)["distance [m]"][-1] < 0.19
    assert abs(run.summary["balances"]["energy"]["residual"]) < 0.03 * run.summary["balances"]["energy"]["tool_work"]
    again = steady_cut(tmp_path / "short", **{**fast, "cut_length": 0.01})
    assert "the mean cutting force is of a record too short to rely on its error, and was to be known to 50 %" in (
        again.stderr)
    assert again.summary["results"]["mean_cutting_force_standard_error"]["value"] is None


def test_a_fast_tool_does_not_leave_its_window(tmp_path):
    """In 2000 steps it goes 67 mm, beyond the 48 ahead of it. And before the first row no force is known."""
    run = steady_cut(tmp_path / "out", velocity=200.0, cut_length=0.1, accuracy=0.1, record_period=1.0)
    assert run.code == 0 and value(run, "window_passed") > 0.08, run.stderr


def test_sizes_follow_the_depth_of_cut_and_the_rock_follows_its_discs(tmp_path):
    given = dict(rock="interlocked_sandstone", depth_of_cut=4e-3, discs_per_depth=4, tooth_width=0.01, cut_length=0.012,
                 velocity=8.0, report="false", time_step_fraction=0.45)
    run = run_script(SCRIPT, *arguments(given), "--out", str(tmp_path / "out"), out=tmp_path / "out")
    assert run.code == 0, run.stderr
    values = run.summary["parameters"]
    assert values["radius_min"] == pytest.approx(4e-4) and values["window_height"] == pytest.approx(0.024)
    # The rock was measured with discs of 0.25 mm and grains of 0.8 mm.
    assert values["grain_edge"] == pytest.approx(8e-4 * 4e-4 / 2.5e-4) and values["tooth_width"] == 0.01
    assert value(run, "window_passed") > 0
    energy = run.summary["balances"]["energy"]
    assert abs(energy["residual"]) < 0.01 * energy["tool_work"]


@pytest.mark.parametrize("law", ["brittle", "cohesive", "arc"])
def test_rock_at_rest_stays_at_rest_while_the_window_moves_on(law, tmp_path):
    """Two periods of the window over rock that nothing touches: no stress, no crack, as many bonds as at first. And
    none where it moved on under a load that is gone."""
    found = checks_of("window_at_rest", tmp_path, law)
    assert found["kinetic"] < 1e-18 and found["elastic"] < 1e-18
    assert found["cracks"] == 0 and abs(found["late"]) < 1e-15
    assert found["bonds"] == found["whole"] and found["bonds"][-1] == found["interactions"]
    assert found["left"] < 1e-12
    # Held particles do not turn, absent ones do not move, and all others do.
    held, absent, others = found["freedom"]
    assert held == ["zXYZ"] and absent in ([], ["xyzXYZ"]) and others == ["zXY"]
    # What lies where rock enters is taken out, whether the boundary held it or not.
    assert found["in_the_way"] == [2, *[[True, "xyzXYZ", False, 0]] * 2]
    # It is damped as all rock once it has come in again.
    assert found["damped"] == pytest.approx([0.5, 0.5], rel=1e-3)


NO_ROOM = [
    (dict(depth_of_cut=0.0131), "depth_of_cut = 0.0131 m"), (dict(window_ahead=0.01), "window_ahead = 0.01 m"),
    (dict(window_behind=0.005), "window_behind = 0.005 m"), (dict(ramp_length=0.02), "cut_length = 0.02 m"),
    (dict(radius_max=2.1e-3), "radius_max = 0.0021 m"), (dict(tooth_height=0.004), "tooth_height = 0.004 m"),
    (dict(discs_per_depth=2), "discs_per_depth = 2: must be 0 or between 4 and 64"),
    (dict(rake=-20, wear_flat=8e-3), "tooth_width = 0.01 m"),
    (dict(rake=-60, wear_flat=1e-3, flat_angle=40), "flat_angle = 40 deg: must be less than 90 degrees plus the rake"),
    (dict(wear_flat=0.012, tooth_width=0.05), "window_behind = 0.016 m: must be at least"),
    (dict(wear_flat=6e-3, tooth_width=0.03, flat_angle=40), "wear_flat = 0.006 m: must be such that its edge is"),
    (dict(flat_angle=10), "flat_angle = 10 deg: must be")]


@pytest.fixture(scope="module")
def refused(tmp_path_factory):
    """What the script said to each of NO_ROOM."""
    folder = tmp_path_factory.mktemp("refused")
    return refusals(SCRIPT, folder, [arguments({**SMALL, **values, "out": folder / "out"}) for values, _ in NO_ROOM])


@pytest.mark.parametrize("case", range(len(NO_ROOM)), ids=[words for _, words in NO_ROOM])
def test_a_cut_that_has_no_room_is_refused(refused, case):
    assert_refused(*refused[case], NO_ROOM[case][1])


@pytest.mark.parametrize("values, said", [
    # Rock without cohesion flows about the tool; rock that nothing breaks gives way as its springs do.
    (dict(bond_law="cohesive", kt=8e9, bond_tension=1e3, bond_cohesion=1e3, bond_fracture_energy=0.01), "means are of"),
    (dict(Rn=1e12, Rt=1e12), "no bond broke: the tool was pressed into the rock, and cut nothing"),
    (dict(rake=-20, wear_flat=3e-3, flat_angle=5, tooth_width=0.02), "means are of")])
def test_rock_too_weak_or_too_strong_and_a_worn_tool_end_well(values, said, tmp_path):
    run = steady_cut(tmp_path / "out", cut_length=0.006, **values)
    assert run.code == 0 and run.summary["ended"] == "finished", run.stderr
    assert said in run.stderr and "Traceback" not in run.stderr
    assert math.isfinite(value(run, "peak_cutting_force")) and not value(run, "long_enough")

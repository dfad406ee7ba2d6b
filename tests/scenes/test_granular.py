"""Loose grains: one grain's exact motions, a heap that is drained out of a box, sand in a tube that vibrates."""
import math
import signal

import numpy as np
import pytest

from rockwear.kernels import repose
from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, checks_of, history, interrupt_script, last_snapshot,
    refusals, run_script, value)

HEAP, TUBE = ROOT / "yade_scripts/angle_of_repose.py", ROOT / "yade_scripts/vibrated_tube.py"
BOX = dict(particles=300, fill_ratio=0.75, opening=5, thickness=2, friction=0.4, wall_friction=0.2,
           rolling_resistance=0.02, radius_min=2.4e-3, radius_max=2.6e-3, settling=0.08, draining=0.6,
           time_step_fraction=0.4, snapshot_period=0.2)
FLASK = dict(particles=250, radius_min=2.4e-3, radius_max=2.6e-3, tube_diameter=0.014, tube_axis=9e-3, depth=0.018,
             width=0.026, tube_length=0.03, settling=0.1, vibrating=0.05, rolling_resistance=0, snapshot_period=0.05)
SHAKEN = {**FLASK, "rolling_resistance": 0.02, "amplitude": 3e-4, "vibrating": 0.4, "checkpoint_interval": 0.01,
          "report": "false"}


def run(script, out, *flags, **values):
    return run_script(script, *arguments(values), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def grain(tmp_path_factory):
    return checks_of("single_grain", tmp_path_factory.mktemp("grain"))


@pytest.fixture(scope="module")
def heap(tmp_path_factory):
    return run(HEAP, tmp_path_factory.mktemp("heap") / "out", **BOX)


def test_a_grain_rebounds_to_the_square_of_its_restitution(grain):
    for restitution, height in grain["rebound"].items():
        assert height == pytest.approx(float(restitution)**2, rel=0.04)


def test_a_grain_rolls_and_slides_on_a_slope_as_it_must(grain):
    g, time, flat = 9.81, 0.2, math.atan(0.2)
    way, rolled = 0.5 * g * time**2, grain["rolled"]
    assert rolled["free"] == pytest.approx(5 / 7 * way * math.sin(flat), rel=5e-3)
    # On a wall YADE's law takes 1.5 times the resistance: 0.1 holds to a slope of 0.15, 0.15 to one of 0.225.
    held_back = 5 / 7 * way * (math.sin(flat) - 1.5 * 0.1 * math.cos(flat))
    assert rolled["rolling"] == pytest.approx(held_back, rel=0.1) and rolled["held"] < 1e-4
    steep = math.atan(2.0)
    assert rolled["sliding"] == pytest.approx(way * (math.sin(steep) - 0.3 * math.cos(steep)), rel=5e-3)


def test_a_vibrating_floor_throws_a_grain_up_from_one_g_on(grain):
    assert grain["lifted"]["0.8"] < 0 < 5e-5 < grain["lifted"]["1.5"]


def test_a_fall_seen_from_a_vibrating_box(grain):
    place, work, kinetic, time = grain["fall"]
    omega = 2 * math.pi * 40
    expected = 1e-3 * (omega * time - math.sin(omega * time)) - 0.5 * 9.81 * time**2
    assert place == pytest.approx(expected, abs=3e-5) and work == pytest.approx(kinetic, rel=0.03)


def test_a_drained_box_leaves_a_heap(heap):
    assert heap.code == 0, heap.stderr
    assert 15 < value(heap, "angle_of_repose") < 50 and 0 < value(heap, "angle_of_repose_standard_error") < 10
    assert value(heap, "kinetic_over_fall_energy") < 1e-3 and 20 < value(heap, "grains_left") < 200
    shot = last_snapshot(heap.out)
    assert math.degrees(repose.angle(shot["flanks"])[0]) == pytest.approx(value(heap, "angle_of_repose"))
    places = shot["grain_positions"][np.isfinite(shot["grain_positions"][:, 0])]
    assert len(places) == value(heap, "grains_left") and (abs(places[:, 0]) < value(heap, "plate_half_length")).all()
    drained = history(heap.out)["mass_drained [kg]"]
    assert drained[-1] + value(heap, "mass_on_plate") == pytest.approx(value(heap, "mass"), rel=1e-9)
    balance = heap.summary["balances"]["energy"]
    assert abs(balance["rolling"]) < 0.1 * balance["gravity_work"] and balance["carried_out"] > 0
    assert "The heap" in (heap.out / "report.html").read_text(encoding="utf-8")


def test_a_box_that_nothing_has_left_has_no_angle_of_repose(tmp_path):
    done = run(HEAP, tmp_path / "out", **{**BOX, "settling": 0.03, "draining": 1e-4, "report": "false"})
    assert done.code == 0 and value(done, "grains_left") == BOX["particles"], done.stderr
    assert math.isnan(value(done, "angle_of_repose")) and value(done, "flanks") == 0
    assert any(line.startswith("no grain has fallen past the plate") for line in done.summary["warnings"])


def test_a_heap_stopped_and_resumed_equals_never_stopped(heap, tmp_path):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01, report="false")
    stopped = interrupt_script(HEAP, out, signal.SIGTERM, 3, **BOX, **options)
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(run(HEAP, out, "--resume", **BOX, **options), heap)


def test_energy_is_kept_where_nothing_can_take_it(tmp_path):
    """Without friction and dashpots; gravity and the inertial force of the vibration are all that does work."""
    done = run(TUBE, tmp_path / "out", **FLASK, friction=0, wall_friction=0, restitution=1, amplitude=3e-4,
               time_step_fraction=0.15)
    assert done.code == 0, done.stderr
    balance = done.summary["balances"]["energy"]
    assert balance["friction"] == balance["contact_damping"] == balance["carried_out"] == 0
    assert abs(balance["residual"]) < 0.01 * balance["gravity_work"]
    mass = history(done.out)["tube_mass [kg]"]
    assert mass[-1] == pytest.approx(value(done, "tube_mass"), rel=0.2) and mass[-1] > 2 * mass[7] > 0
    assert value(done, "peak_acceleration") == pytest.approx(3e-4 * (100 * math.pi)**2 / 9.81)
    assert "The tube" in (done.out / "report.html").read_text(encoding="utf-8")


def test_a_vibrating_tube_stopped_and_resumed_equals_never_stopped(tmp_path):
    never, out = run(TUBE, tmp_path / "never", **SHAKEN), tmp_path / "out"
    stopped = interrupt_script(TUBE, out, signal.SIGKILL, 3, **SHAKEN)
    assert stopped.code == -signal.SIGKILL
    with np.load(next(out.glob("checkpoint/*/state.npz"))) as state:
        # The vibration's phase goes on, too: the checkpoint is in the middle of it.
        assert state["scene/stage"] == 1 and state["scene/engines/recorder/rows"] > 15
    assert_as_if_never_stopped(run(TUBE, out, "--resume", **SHAKEN), never)
    assert np.array_equal(*(last_snapshot(folder)["grain_positions"] for folder in (never.out, out)))
    assert value(never, "tube_mass") > value(never, "tube_mass_by_gravity") > 0


def test_without_amplitude_gravity_acts_alone(tmp_path):
    done = run(TUBE, tmp_path / "out", **FLASK, amplitude=0, frequency=1e5, report="false")
    assert done.code == 0 and value(done, "peak_acceleration") == 0, done.stderr
    assert "vibration" not in done.summary["wall_time"]["by_engine"]
    places = last_snapshot(done.out)["grain_positions"]
    fall = done.summary["results"]["mass"]["value"] * 9.81 * places[:, 1].std()
    assert 0 < done.summary["balances"]["energy"]["gravity_work"] < 5 * fall
    assert 0 <= value(done, "tube_mass") - value(done, "tube_mass_by_gravity") < 0.1 * value(done, "mass")


HEAP_REFUSED = [
    ({"radius_max": 1e300}, "radius_max = 1e+300 m: must be between 1e-09 and 1e+06"),
    ({"friction": -0.1}, "friction = -0.1: must be at least 0"),
    ({"rolling_resistance": -1}, "rolling_resistance = -1: must be at least 0"),
    ({"particles": 60}, "particles = 60: must be more, for a plate of at least 8 diameters"),
    ({"radius_max": 2e-3}, "radius_max = 0.002 m: must be at least radius_min = 0.00225"),
    ({"restitution": 0}, "restitution = 0: must be at least 0.05"),
    ({"gravity": 1e5}, "gravity = 100000 m/s2: must be between 0.001 and 10000"),
    ({"particles": "3e9"}, "particles = 3e9: must be a whole number of at most 1000000")]
TUBE_REFUSED = [
    ({"tube_diameter": 3.9e-3}, "tube_diameter = 0.0039 m: must be more than the largest grain, 0.004"),
    ({"tube_diameter": 0.04}, "tube_diameter = 0.04 m: must be less than"),
    ({"tube_axis": 5e-3}, "tube_axis = 0.005 m: must be more than"),
    ({"particles": 300}, "particles = 300: must be more, for a fill that covers the tube"),
    ({"amplitude": -1e-4}, "amplitude = -0.0001 m: must be 0 or between 1e-09 and 1e+06"),
    ({"amplitude": 0.1}, "amplitude = 0.1 m: must be so small that the box is slower than 10 m/s"),
    ({"amplitude": 1e-4, "frequency": 12610.5}, "frequency = 12610.5 Hz: must be at most 63"),
    ({"width": 3e-3}, "radius_max = 0.002 m: must be at most 0.0015, for a sphere to fit")]


@pytest.mark.parametrize("script, refused", [(HEAP, HEAP_REFUSED), (TUBE, TUBE_REFUSED)])
def test_bad_input_ends_in_one_line(tmp_path, script, refused):
    cases = [arguments({**values, "out": tmp_path / "out"}) for values, _ in refused]
    for (code, said), (_, words) in zip(refusals(script, tmp_path, cases), refused, strict=True):
        assert_refused(code, said, words)

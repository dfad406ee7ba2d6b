"""Scenes about temperature: the process slower than its mechanics, no conduction, and a ripper at several speeds."""
import signal

import numpy as np
import pytest

from tests.running import (
    ROOT, SMALL, arguments, assert_as_if_never_stopped, assert_refused, history, interrupt_script, refusals, run_script,
    tooth_cycles, value)

RIPPER = ROOT / "yade_scripts/ripper_temperature.py"
PASSES = {**{name: value for name, value in SMALL.items() if name != "cycles"}, "approach": 1e-4, "start_up": 1e-4,
          "cycle_time": 5e-4, "record_period": 5e-7, "long_time": 1.0, "tool_radius_max": 0.52e-3,
          "wear_acceleration": 1e5, "emissivity": 0.4}


def ripper(out, *flags, **values):
    return run_script(RIPPER, *arguments({**PASSES, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def passes(tmp_path_factory):
    return ripper(tmp_path_factory.mktemp("ripper") / "out")


@pytest.fixture(scope="module")
def cuts(tmp_path_factory):
    """The same cut at 4 m/s, and as a process at 0.04 m/s; each with and without conduction."""
    folder, found = tmp_path_factory.mktemp("cuts"), {}
    times = dict(start_up=SMALL["start_up"], heat_period=1e-4, surface_period=5e-4, record_period=2e-5,
                 snapshot_period=SMALL["snapshot_period"])
    for slow in (1, 100):
        for conduction in ("true", "false"):
            found[slow, conduction] = tooth_cycles(
                folder / f"{slow}{conduction}", velocity=4 / slow, time_scale=slow, conduction=conduction, cycles=0,
                wear_acceleration=0, report="false", **{name: time * slow for name, time in times.items()})
            assert found[slow, conduction].code == 0, found[slow, conduction].stderr
    return found


def test_the_mechanics_of_a_slow_process_are_those_of_the_fast_one(cuts):
    for name in ("tensile_cracks", "time_step"):
        assert len({value(run, name) for run in cuts.values()}) == 1
    assert len({run.summary["balances"]["energy"]["tool_work"] for run in cuts.values()}) == 1
    # Means are over the time of the process, whose rounding differs.
    first, *others = (value(run, "mean_cutting_force") for run in cuts.values())
    assert others == pytest.approx([first] * 3, rel=1e-12)
    assert value(cuts[100, "true"], "simulated_time") == pytest.approx(100 * value(cuts[1, "true"], "simulated_time"))


def test_heat_flows_in_the_time_of_the_process(cuts):
    assert value(cuts[1, "false"], "tool_temperature_max") == value(cuts[100, "false"], "tool_temperature_max")
    rise = {slow: value(cuts[slow, "true"], "tool_temperature_max") - 293.15 for slow in (1, 100)}
    assert 0 < rise[100] < 0.9 * rise[1]
    convected = {slow: cuts[slow, "true"].summary["balances"]["heat"]["convected"] for slow in (1, 100)}
    assert convected[100] < 5 * convected[1] < 0


def test_without_conduction_heat_stays_where_it_arose(cuts):
    run = cuts[1, "false"]
    balance = run.summary["balances"]["heat"]
    assert balance["convected"] == 0 and balance["stored"] == pytest.approx(balance["generated"], rel=1e-9)
    assert value(run, "tool_temperature_max") > value(cuts[1, "true"], "tool_temperature_max")


def test_the_ripper_leaves_its_page(passes):
    assert passes.code == 0, passes.stderr
    for name in ("tip_over_time.png", "fields.png", "near_the_tip.png", "temperature.png"):
        assert (passes.out / "figures" / name).stat().st_size > 1e4


def test_all_passes_take_the_same_heat_a_metre(passes):
    a_metre = [value(passes, f"friction_heat_of_the_tool_{u}") / float(u) for u in ("4", "0.4", "0.04")]
    assert a_metre[0] > 10 and a_metre == pytest.approx([a_metre[0]] * 3, rel=1e-4)


def test_slower_means_cooler_and_a_fixed_shank_too(passes):
    for kind in ("fixed_shank", "insulated_shank"):
        rises = [value(passes, f"hottest_{kind}_{u}") - 293.15 for u in ("4", "0.4", "0.04")]
        assert rises[0] > 2 * rises[1] > 4 * rises[2] > 0
    for u in ("4", "0.4", "0.04"):
        assert 293.15 < value(passes, f"hottest_fixed_shank_{u}") < value(passes, f"hottest_insulated_shank_{u}")


def test_each_field_starts_its_own_wear_with_a_whole_tool(passes):
    columns = history(passes.out)
    stage, worn, hottest = (columns[name] for name in ("stage [-]", "worn_volume [m3/m]", "tool_temperature_max [K]"))
    assert worn[stage <= 3].max() < 1e-20 and worn[stage == 4].max() > 1e-9
    assert worn[stage == 5].min() < worn[stage == 4].max()
    profile = np.loadtxt(passes.out / "wear_profile.csv", delimiter=",", skiprows=1)
    last = value(passes, "worn_volume_from_insulated_shank")
    assert profile.min() >= 0 and profile.sum() == pytest.approx(last, rel=0.2)
    for k, shank in ((4, "fixed"), (5, "insulated")):
        assert hottest[stage == k][0] == pytest.approx(value(passes, f"hottest_{shank}_shank_0.4"), abs=1.0)
        assert value(passes, f"worn_volume_from_{shank}_shank") == pytest.approx(worn[stage == k].max(), rel=0.2)
    heat = passes.summary["balances"]["heat"]
    assert abs(heat["residual"]) < 1e-8 * heat["generated"] and heat["radiated"] < 0


def test_a_stopped_ripper_resumes_to_the_last_bit(passes, tmp_path):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01, report="false")
    for after in (4, 12):
        assert interrupt_script(RIPPER, out, signal.SIGTERM, after, **PASSES, **options).code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(ripper(out, "--resume", **options), passes, "tool_fields.csv", "warming.csv")


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [({"velocities": "4,fast"}, "velocities = fast"),
             ({"velocities": "4,0"}, "velocities = 0 m/s: must be greater than 0"),
             ({"velocities": "4,0.4,4.0"}, "velocities = 4,0.4,4 m/s: must be each given once"),
             ({"velocities": "0.4000001,0.4"}, "velocities = 0.4000001,0.4 m/s: must be each given once, different in"),
             ({"conduction": "false"}, "conduction = false: must be true"),
             ({"convection": 0, "emissivity": 0, "contact_conductance": 0}, "convection = 0 W/m2K: must be greater "
              "than 0 where emissivity and contact_conductance are 0"),
             ({"wear_velocity": 0.5}, "wear_velocity = 0.5 m/s: must be one of velocities = 4,0.4,0.04"),
             *(({name: value}, f"{name} = {value}: must be a known parameter") for name, value in (
                 ("cycles", 3), ("heat", "false"), ("shank", "fixed"), ("time_scale", 2), ("tool", "segments"),
                 ("segment", 1e-3), ("thermal_radius", 5e-4)))]
    said = refusals(RIPPER, tmp_path, [arguments({**PASSES, **values, "out": tmp_path / "out"}) for values, _ in cases])
    for (_, words), case in zip(cases, said):
        assert_refused(*case, words)
    assert not (tmp_path / "out").exists()

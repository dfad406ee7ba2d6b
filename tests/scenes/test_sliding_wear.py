"""The laboratory wear test returns the k it was given, under constant and falling hardness."""
import signal

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, history, interrupt_script, refusals, run_script, value)

SCRIPT = ROOT / "yade_scripts/sliding_wear.py"


def lab(out, *flags, **values):
    return run_script(SCRIPT, *arguments(values), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def worn(tmp_path_factory):
    return lab(tmp_path_factory.mktemp("lab") / "out")


def test_it_returns_its_k_within_a_tenth_of_a_per_cent(worn):
    """w H / (p s) of the first row of [Rojek 2003, table 6.2]: what was put in comes out, from the known force
    alone."""
    assert worn.code == 0, worn.stderr
    hardness = (500 - 9 * 156 / 200) * 9.80665e6
    k = value(worn, "worn_depth") * hardness / (885 / 26e-6 * 100)
    assert k == pytest.approx(0.0023, rel=1e-3) and k == pytest.approx(value(worn, "k_returned"), rel=1e-9)
    assert k != 0.0023  # contacts that close slip elastically at first


def test_the_load_is_carried_at_every_moment_and_friction_is_mu_of_it(worn):
    load = 885 / 26e-6 * 26e-6**0.5
    columns = history(worn.out)
    assert columns["normal_force [N/m]"] == pytest.approx(load, rel=1e-9)
    assert columns["friction_force [N/m]"] == pytest.approx(0.3 * load, rel=1e-9)
    balance = worn.summary["balances"]["friction"]
    assert balance["drag_work"] == pytest.approx(0.3 * load * 0.1, rel=1e-9)
    assert balance["worn_by"] == pytest.approx(balance["tool"], rel=1e-9)


def test_the_block_follows_its_wear_down(worn):
    assert value(worn, "particles_removed") > 30
    assert abs(worn.summary["balances"]["mass"]["unexplained"]) < 1e-12 * worn.summary["balances"]["mass"]["archard"]
    # Whole particles: the lowest that is left may stand a diameter below the mean depth.
    assert 0 < value(worn, "worn_depth") - value(worn, "descent") < 2 * 0.26e-3
    assert (worn.out / "report.html").stat().st_size > 1e4


@pytest.mark.parametrize("values", [
    dict(temperature_rise=430),
    dict(temperature_rise=700, hardness_table="MET91", wear_coefficient=0.0113, force=622, area=68e-6,
         temperature=401.15)])
def test_a_temperature_that_rises_gives_the_integral(tmp_path, values):
    run = lab(tmp_path / "out", report="false", wear_acceleration=3000, **values)
    assert run.code == 0, run.stderr
    assert abs(value(run, "k_deviation")) < 5e-3
    start, rise = values.get("temperature", 429.15) - 273.15, values["temperature_rise"]
    table = {"MET91": [515, 509, 498, 457, 375, 247]}.get(values.get("hardness_table"), [500, 491, 480, 439, 362, 241])
    fine = start + rise * (np.arange(200000) + 0.5) / 200000
    integral = np.mean(1 / np.interp(fine, [0, 200, 300, 400, 500, 600], table)) / 9.80665e6
    pressure, k = values.get("force", 885) / values.get("area", 26e-6), values.get("wear_coefficient", 0.0023)
    assert value(run, "worn_depth") == pytest.approx(k * pressure * 100 * integral, rel=5e-3)
    beyond = start + rise > 600
    assert len(run.summary["warnings"]) == run.stderr.count("leaves the hardness table") == beyond


@pytest.mark.parametrize("law, options", [
    ("power", dict(wear_exponent=2, wear_coefficient=0.3)), ("modes", dict(wear_modes="0.002/1/0.4, 0.5/2/0.6"))])
def test_other_laws_return_theirs_where_the_pressure_is_the_nominal_one(tmp_path, law, options):
    run = lab(tmp_path / "out", report="false", packing="lattice", wear_law=law, wear_acceleration=3000, **options)
    assert run.code == 0, run.stderr
    assert abs(value(run, "k_deviation")) < 1e-3 and value(run, "particles_removed") >= 20


def test_more_wear_on_less_way_is_the_same_wear_until_contacts_are_too_short(tmp_path):
    """The two rules of [Rocky]: what is off falls with the wear acceleration."""
    off = [value(lab(tmp_path / str(factor), report="false", wear_acceleration=factor, slip_step=1e-6), "k_deviation")
           for factor in (5000, 50000)]
    assert -0.03 < off[1] < 5 * off[0] < 0 and off[0] > -2e-3


@pytest.mark.parametrize("values, words", [
    (dict(tool_kt=1e6), "a greater tool_kt or a smaller wear_acceleration brings it nearer"),
    (dict(wear_law="power", wear_exponent=2), "wear follows the force of each contact and not the mean")])
def test_why_a_k_is_off_is_told(tmp_path, values, words):
    run = lab(tmp_path / "out", report="false", distance=1, wear_acceleration=10, **values)
    assert run.code == 0 and abs(value(run, "k_deviation")) > 0.1, run.stderr
    line, = (line for line in run.summary["warnings"] if "k returned" in line)
    assert words in line


def test_a_block_worn_away_ends_in_one_line(tmp_path):
    run = lab(tmp_path / "out", report="false", distance=400, wear_acceleration=10000)
    assert run.code == 0 and "the block is worn away after" in run.summary["ended"], run.stderr
    assert value(run, "mass_lost") == pytest.approx(1)
    assert abs(run.summary["balances"]["mass"]["unexplained"]) < 1e-12 * run.summary["balances"]["mass"]["archard"]
    assert (tmp_path / "out/checkpoint/current.json").exists()


def test_stopped_and_resumed_equals_never_stopped(worn, tmp_path):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01, report="false")
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 3, **options)
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(lab(out, "--resume", **options), worn)


REFUSED = [
    ({"wear_acceleration": 0}, "wear_acceleration = 0: must be greater than 0"),
    ({"temperature": 20}, "temperature = 20 K: must be inside the hardness table"),
    ({"force": 1e9}, "force = 1e+09 N: must be less than hardness times area"),
    ({"slip_step": 0.1}, "slip_step = 0.1 m: must be below a hundredth of the simulated distance")]


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [arguments({**values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)
    run = lab(tmp_path / "out", **REFUSED[2][0])
    assert_refused(run.code, run.stderr, REFUSED[2][1])
    assert not (tmp_path / "out").exists()

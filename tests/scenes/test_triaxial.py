"""Confined compression: exact moduli of a lattice, constant pressure, sand, resuming, bad input."""
import math
import signal

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, history, interrupt_script, refusals, run_script, value)

SCRIPT = ROOT / "yade_scripts/triaxial.py"
EXACT = ROOT / "tests/scenes/scripts/laboratory_confined.py"
SMALL = dict(width=0.04, height=0.03, radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=0.1e6, report="false")
"""Some 200 discs of the sandstone of [Rojek 2014]."""


def confined(out, *flags, script=SCRIPT, **values):
    return run_script(script, *arguments({**SMALL, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    return confined(tmp_path_factory.mktemp("broken") / "out", report="true", confinement=20e6)


@pytest.mark.parametrize("kt", [20e9, 4e9])
def test_a_confined_lattice_has_its_exact_moduli(tmp_path, kt):
    kn, confinement = 20e9, 5e6
    run = confined(tmp_path / "out", script=EXACT, kt=kt, Rn=1e12, Rt=1e12, strain_max=4e-4, record_strain=2e-6,
                   speed=0.01, gauge=0.3, confinement=confinement)
    assert run.code == 0, run.stderr
    modulus, ratio = 2 * math.sqrt(3) * kn * (kn + kt) / (3 * kn + kt), (kn - kt) / (3 * kn + kt)
    assert value(run, "youngs_modulus") == pytest.approx(modulus, rel=2e-3)
    assert value(run, "poissons_ratio") == pytest.approx(ratio, abs=2e-3)
    assert value(run, "confinement_held") == pytest.approx(confinement, rel=2e-3)
    assert value(run, "confinement_scatter") < 2e-3 * confinement
    # The stress path: up to the pressure on all sides, strained alike, then along sigma3 = constant.
    columns = history(run.out)
    last = (columns["stage [-]"] == 0).nonzero()[0][-1]
    assert columns["stress [Pa]"][last] == pytest.approx(confinement, rel=0.01)
    # The last row counts in the section, and strains less under lateral pressure: its missing force is the others'.
    diameter, section = 2e-3, 6 * math.sqrt(3) * 1e-3 + kn * 2e-3 / modulus
    axial = confinement * (1 + kn * diameter * ratio / (modulus * section))
    strains = (axial - ratio * confinement) / modulus, (confinement - ratio * axial) / modulus
    for name, exact in zip(("axial_strain [-]", "lateral_strain [-]"), strains):
        assert columns[name][last] == pytest.approx(exact, rel=0.01), name
    assert value(run, "peak_stress") == pytest.approx(
        confinement + modulus * value(run, "peak_strain"), rel=0.01)
    assert not value(run, "failed") and value(run, "tensile_cracks") == value(run, "shear_cracks") == 0


def test_the_pressure_stays_the_same_past_the_peak(broken):
    assert broken.code == 0, broken.stderr
    assert value(broken, "failed") and not broken.summary["warnings"]
    # The whole axial stress, as the strength.
    said = float(broken.summary["ended"].removeprefix("failed at ").removesuffix(" MPa"))
    assert said == pytest.approx(1e-6 * value(broken, "peak_stress"), rel=1e-3)
    assert value(broken, "confinement_held") == pytest.approx(20e6, rel=0.015)
    columns = history(broken.out)
    past = columns["axial_strain [-]"] > value(broken, "peak_strain")
    off = abs(columns["lateral_stress [Pa]"][past] / 20e6 - 1)
    # The specimen's own inertia counts, and these 200 discs burst in the end.
    assert "The stress across is" in (broken.out / "report.html").read_text(encoding="utf-8")
    assert past.sum() > 20 and np.median(off) < 0.04 and off.mean() < 0.1


def test_the_energy_balance_holds_the_work_of_the_pressure(broken):
    balance = broken.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.02 * balance["platen_work"]
    assert abs(balance["against_membrane"]) > 5 * abs(balance["residual"])
    assert balance["against_pressed_ends"] < 0 < balance["against_membrane"]


def test_confinement_makes_the_rock_stronger_and_no_stiffer(broken, tmp_path):
    free = confined(tmp_path / "out", confinement=0)
    assert value(broken, "peak_stress") > value(free, "peak_stress") + 1.5 * 20e6
    assert value(broken, "youngs_modulus") == pytest.approx(value(free, "youngs_modulus"), rel=0.02)
    assert value(broken, "residual_stress") > 20e6


def test_a_confinement_above_the_strength_is_held(broken, tmp_path):
    """100 MPa, more than the rock bears unconfined (some 80 MPa): it still carries by friction, and more than before.
    """
    pressed = confined(tmp_path / "out", confinement=100e6, strain_max=0.01, record_strain=5e-5)
    assert pressed.code == 0, pressed.stderr
    deviatoric, before = (value(run, "peak_stress") - pressure for run, pressure in ((pressed, 100e6), (broken, 20e6)))
    assert deviatoric > before + 0.3 * 80e6
    assert value(pressed, "confinement_held") == pytest.approx(100e6, rel=0.01)
    assert value(pressed, "youngs_modulus") == pytest.approx(value(broken, "youngs_modulus"), rel=0.03)
    balance = pressed.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.02 * balance["platen_work"]


def test_a_confinement_that_is_not_held_is_told(tmp_path):
    """The discs at the sides are looked for once only, and are pushed inwards as if they were there still."""
    lost = confined(tmp_path / "out", confinement=20e6, membrane_interval=10**6, strain_max=0.03)
    assert abs(value(lost, "confinement_held") / 20e6 - 1) > 0.5
    assert any("held a confinement of" in line for line in lost.summary["warnings"])


def test_without_confinement_it_is_the_uniaxial_test(tmp_path):
    free = confined(tmp_path / "free", confinement=0)
    uniaxial = run_script(ROOT / "yade_scripts/uniaxial.py", *arguments({**SMALL, "speed": 0.1}), "--out",
                          str(tmp_path / "uniaxial"), out=tmp_path / "uniaxial")
    for name in ("peak_stress", "peak_strain", "youngs_modulus", "poissons_ratio", "tensile_cracks", "shear_cracks"):
        assert value(free, name) == pytest.approx(value(uniaxial, name), rel=1e-3), name


def test_sand_has_a_friction_angle(tmp_path):
    """Bonds of almost no strength break while the pressure rises; the specimen then carries by friction alone. It
    dilates: at 0.1 m/s the servo lags by 1 to 3 % of the pressure, at half of that by half."""
    sand = confined(tmp_path / "out", confinement=5e6, Rn=1.0, Rt=1.0, mu=0.5, strain_max=0.03, speed=0.05)
    assert sand.code == 0, sand.stderr
    ratio = value(sand, "peak_stress") / 5e6
    assert 18 < math.degrees(math.asin((ratio - 1) / (ratio + 1))) < 45
    assert value(sand, "confinement_held") == pytest.approx(5e6, rel=0.02)


def test_a_specimen_that_never_fails_ends_and_says_so(tmp_path):
    strong = confined(tmp_path / "out", confinement=20e6, Rn=1e9, Rt=1e9, strain_max=2e-3)
    assert strong.code == 0 and strong.summary["ended"] == "finished" and not value(strong, "failed")
    assert value(strong, "peak_stress") == pytest.approx(value(strong, "residual_stress"), rel=0.05)


@pytest.mark.parametrize("after, stage, values", [(2, 0, dict(speed=0.02, strain_max=1e-3)), (4, 1, {})])
def test_stopped_and_resumed_equals_never_stopped(tmp_path, after, stage, values):
    """While the pressure rises, and while the platens approach."""
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01, confinement=20e6, **values)
    never = confined(tmp_path / "never", **options)
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, after, **{**SMALL, **options})
    assert stopped.code == 128 + signal.SIGTERM
    assert history(out)["stage [-]"][-1] == stage
    assert_as_if_never_stopped(confined(out, "--resume", **options), never, "cracks.csv")


REFUSED = [
    ({"confinement": -1e6}, "confinement = -1e+06 Pa: must be 0 or between 1000 and 1e+09"),
    ({"confinement": 10}, "confinement = 10 Pa: must be 0 or between 1000 and 1e+09"),
    ({"confinement": 10e12}, "confinement = 1e+13 Pa: must be 0 or between 1000 and 1e+09"),
    ({"confinement": 5e8}, "confinement = 5e+08 Pa: must be at most 0.02 kn = 4e+08"),
    ({"confinement": "10 MPa"}, "confinement = 10 MPa Pa: must be a number"),
    ({"membrane_interval": 0}, "membrane_interval = 0 steps: must be a whole number of at least 1"),
    ({"confinment": 1}, "did you mean confinement")]


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [arguments({**SMALL, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)

"""Brazilian test and fracture toughness: exact stresses, balances, failure, resuming, bad input."""
import math
import signal

import numpy as np
import pytest

from rockwear.kernels import brazilian, fracture
from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, history, interrupt_script, packing, refusals,
    run_script, value)

DISC, NOTCHED = ROOT / "yade_scripts/brazilian.py", ROOT / "yade_scripts/toughness.py"
BLOCK = ROOT / "yade_scripts/toughness_3d.py"
LATTICE = ROOT / "tests/scenes/scripts/brazilian.py"
ROCK = dict(radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=0.1e6)
SMALL = {DISC: dict(ROCK, diameter=0.03, drop=0.3, report="false"),
         NOTCHED: dict(ROCK, size=0.025, speed=0.05, report="false"),
         BLOCK: dict(radius=1.5e-3, kn=55e6, kt=14e6, size=0.03, speed=0.05, seed=packing(5, 2), report="false")}
"""Some 130 and 180 discs, 610 spheres. Of seven packings of these the work at the notch is 0.83 to 1.03 of what is
dissipated: at the pins of packing 5 the least gives way. On Debian 13 packing 2 is one that a crack runs through."""


def run(script, out, *flags, **values):
    return run_script(script, *arguments({**SMALL[script], **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    return run(DISC, tmp_path_factory.mktemp("pressed") / "out", report="true")


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    return run(NOTCHED, tmp_path_factory.mktemp("opened") / "out", report="true")


@pytest.fixture(scope="module")
def opened_block(tmp_path_factory):
    return run(BLOCK, tmp_path_factory.mktemp("block") / "out", report="true")


def test_stresses_at_the_centre_of_a_lattice_are_exact(tmp_path):
    """Its rim is rough by a radius of 25: the disc is 2 % smaller than its circle."""
    out, angle, gauge = tmp_path / "out", 20.0, 0.25
    done = run_script(LATTICE, *arguments(dict(
        kt=4e9, Rn=1e12, Rt=1e12, radius_min=1e-3, speed=0.01, strain_max=2e-4, record_strain=4e-6, report="false",
        loading_angle=angle, gauge=gauge)), "--out", str(out), out=out)
    assert done.code == 0, done.stderr
    columns = {name.split(" [")[0]: column[20:] for name, column in history(out).items()}
    across, along = brazilian.centre_stresses(columns["force"], 0.05, math.radians(angle / 2), gauge)
    assert np.mean(columns["centre_tension"] / across) == pytest.approx(1.02, abs=0.03)
    assert np.mean(columns["centre_compression"] / -along) == pytest.approx(1.02, abs=0.03)
    assert not value(done, "failed") and not value(done, "split")
    assert any("did not split from jaw to jaw" in line for line in done.summary["warnings"])


def test_a_disc_fails_across_its_load(pressed):
    assert pressed.code == 0, pressed.stderr
    assert value(pressed, "failed")
    strength = value(pressed, "tensile_strength")
    assert 10e6 < strength < 30e6
    assert strength == pytest.approx(2 * value(pressed, "peak_force") / (math.pi * 0.03), rel=1e-9)
    assert 0 < value(pressed, "first_cracks_radius") < 1
    assert value(pressed, "tensile_cracks") > value(pressed, "shear_cracks")
    assert value(pressed, "split") != any("did not split" in line for line in pressed.summary["warnings"])


def test_a_notch_drives_a_crack_to_the_back(opened):
    assert opened.code == 0, opened.stderr
    assert value(opened, "failed") and value(opened, "shear_cracks") <= 2 < value(opened, "tensile_cracks")
    assert value(opened, "crack_length") > 0.6 * 0.025
    assert value(opened, "youngs_modulus") == pytest.approx(17e9, rel=0.15)
    toughness, peak = value(opened, "fracture_toughness"), value(opened, "peak_toughness")
    assert 1e6 < toughness < 8e6 and 0.5 < peak / toughness < 1.5
    assert toughness == pytest.approx(math.sqrt(value(opened, "youngs_modulus") * value(opened, "fracture_energy")))
    assert peak == pytest.approx(
        value(opened, "peak_force") * fracture.intensity_factor(0.4) / math.sqrt(0.025), rel=1e-9)


def test_a_notch_drives_a_crack_through_a_block(opened_block):
    """Bonds take 30 J/m2 of its crack, which winds; forces and works are per metre of thickness."""
    assert opened_block.code == 0, opened_block.stderr
    assert value(opened_block, "failed")
    assert value(opened_block, "tensile_cracks") > 5 * value(opened_block, "shear_cracks")
    assert value(opened_block, "crack_length") > 0.7 * 0.03
    assert 1.0 < value(opened_block, "fracture_energy") / 30 < 4.0
    broken = opened_block.summary["balances"]["energy"]["bond_breaking"] / 0.01
    assert 1.0 < broken / (30 * (value(opened_block, "crack_length") - 0.4 * 0.03)) < 4.0


@pytest.mark.parametrize("name", ["pressed", "opened", "opened_block"])
def test_the_energy_balance_closes(request, name):
    done = request.getfixturevalue(name)
    balance = done.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.03 * balance["platen_work"] and balance["bond_breaking"] > 0
    assert (done.out / "figures/load_displacement.png").exists() and (done.out / "figures/failure.png").exists()
    assert not (done.out / "figures/stress_strain.png").exists()


@pytest.mark.parametrize("name, thickness", [("opened", 1.0), ("opened_block", 0.01)])
def test_the_work_at_the_notch_is_what_the_specimen_dissipates(request, name, thickness):
    """Force over opening misses what gives way at the pins, and that is elastic."""
    done = request.getfixturevalue(name)
    columns = {name.split(" [")[0]: column for name, column in history(done.out).items()}
    found = fracture.resistance_curve(force=columns["force"], opening=columns["opening"],
                                      width=done.summary["parameters"]["size"], notch=0.4)
    balance = done.summary["balances"]["energy"]
    spent = balance["bond_breaking"] + balance["rock_friction"] + balance["numerical_damping"] + balance["kinetic"]
    assert found["dissipated"][-1] == pytest.approx(spent / thickness, rel=0.1)


def test_softening_bonds_make_the_rock_tougher(opened, tmp_path):
    softer = run(NOTCHED, tmp_path / "out", bond_law="damage", H=2e9, drop=1e-3)
    # It ends with the crack, not with the last bridge.
    assert value(softer, "failed") and fracture.END * 0.025 < value(softer, "crack_length") < 0.97 * 0.025
    assert value(softer, "fracture_energy") > 1.5 * value(opened, "fracture_energy")


@pytest.mark.parametrize("script, name", [(DISC, "pressed"), (NOTCHED, "opened"), (BLOCK, "opened_block")])
def test_stopped_and_resumed_equals_never_stopped(request, tmp_path, script, name):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01)
    stopped = interrupt_script(script, out, signal.SIGTERM, 2, **{**SMALL[script], **options})
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(run(script, out, "--resume", **options), request.getfixturevalue(name), "cracks.csv")


REFUSED = {
    DISC: [({"diameter": 0}, "diameter = 0 m: must be greater than 0"),
           ({"loading_angle": 90}, "loading_angle = 90 deg: must be at most 60"),
           ({"loading_angle": 1.0}, "loading_angle = 1 deg: must be wide enough to hold a disc on each side"),
           ({"grip": 0.01}, "grip = 0.01 m: must be less than a quarter of the diameter 0.03"),
           ({"width": 0.1}, "width")],
    NOTCHED: [({"notch": 0.1}, "notch = 0.1: must be at least 0.2"),
              ({"notch": 0.9}, "notch = 0.9: must be at most 0.8"),
              ({"size": -1}, "size = -1 m: must be greater than 0"),
              ({"size": 0.01}, "size = 0.01 m: must be at least 0.024"),
              ({"platens": "rough"}, "platens")],
    BLOCK: [({"size": 0.02}, "size = 0.02 m: must be at least 0.024"),
            ({"depth": 0}, "depth = 0 m: must be greater than 0"),
            ({"radius_max": 1e-3}, "radius_max")]}


@pytest.mark.parametrize("script", REFUSED)
def test_bad_input_ends_in_one_line(tmp_path, script):
    cases = [arguments({**SMALL[script], **values, "out": tmp_path / "out"}) for values, _ in REFUSED[script]]
    for (code, said), (_, words) in zip(refusals(script, tmp_path, cases), REFUSED[script], strict=True):
        assert_refused(code, said, words)

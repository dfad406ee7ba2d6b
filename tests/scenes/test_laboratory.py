"""The virtual laboratory: exact moduli of a lattice, failure of a small specimen, resuming, bad input."""
import json
import math
import resource
import signal

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, finish, history, interrupt_script, refusals,
    run_script, start, value)

SCRIPT = ROOT / "yade_scripts/uniaxial.py"
EXACT = ROOT / "tests/scenes/scripts/laboratory.py"
SMALL = dict(width=0.04, height=0.03, radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=0.1e6, report="false")
"""Some 300 discs of the sandstone of [Rojek 2014]."""
CHAIN = dict(script=EXACT, specimen="chain", grip=1.5e-3, gauge=1, strain_max=0.05)


def laboratory(out, *flags, script=SCRIPT, **values):
    return run_script(script, *arguments({**SMALL, **values}), "--out", str(out), *flags, out=out)


@pytest.fixture(scope="module")
def compressed(tmp_path_factory):
    return laboratory(tmp_path_factory.mktemp("compressed") / "out", report="true", speed=0.05)


@pytest.fixture(scope="module")
def pulled(tmp_path_factory):
    return laboratory(tmp_path_factory.mktemp("pulled") / "out", test="tension")


@pytest.mark.parametrize("test", ["compression", "tension"])
@pytest.mark.parametrize("kt", [20e9, 4e9])
def test_a_triangular_lattice_has_its_exact_moduli(tmp_path, test, kt):
    kn = 20e9
    run = laboratory(tmp_path / "out", script=EXACT, test=test, kt=kt, Rn=1e12, Rt=1e12, strain_max=1e-4,
                     record_strain=5e-7, speed=0.005, gauge=0.3)
    assert run.code == 0, run.stderr
    assert value(run, "youngs_modulus") == pytest.approx(2 * math.sqrt(3) * kn * (kn + kt) / (3 * kn + kt), rel=1e-3)
    assert value(run, "poissons_ratio") == pytest.approx((kn - kt) / (3 * kn + kt), abs=1e-3)
    assert not value(run, "failed") and value(run, "tensile_cracks") == value(run, "shear_cracks") == 0
    assert "the stress has not fallen to 0.5 of its peak" in run.stderr


def test_compression_alone_never_breaks_a_bond_in_tension(tmp_path):
    run = laboratory(tmp_path / "out", **CHAIN, record_strain=1e-4)
    assert run.code == 0, run.stderr
    assert value(run, "tensile_cracks") == value(run, "shear_cracks") == 0
    # The bond of one diameter is shortened by the travel of both platens.
    assert value(run, "peak_stress") == pytest.approx(20e9 * 0.05 * 4e-3 / 2e-3, rel=5e-3)


def test_rock_that_grows_coarser_across_the_specimen_stays_the_same_rock(tmp_path):
    rock = dict(radius_min=5e-4, radius_max=7e-4, width=0.03, height=0.03, fine_depth=0.008, bond_law="cohesive",
                kt=8e9, bond_tension_power=0.12, bond_cohesion_power=0.12, report="false")
    uniform, graded = (run_script(SCRIPT, *arguments({**rock, "grading_factor": factor}), "--out",
                                  str(tmp_path / str(factor)), out=tmp_path / str(factor)) for factor in (1, 2.5))
    assert uniform.code == graded.code == 0, graded.stderr
    assert value(graded, "rock_particles") < 0.5 * value(uniform, "rock_particles")
    assert value(graded, "youngs_modulus") == pytest.approx(value(uniform, "youngs_modulus"), rel=0.08)
    assert value(graded, "peak_stress") == pytest.approx(value(uniform, "peak_stress"), rel=0.15)


@pytest.mark.parametrize("strain, names", [(0.9e-3, "strengths and moduli"), (1.5e-3, "youngs_modulus")])
def test_what_a_coarse_record_does_not_tell_is_said(tmp_path, strain, names):
    run = laboratory(tmp_path / "out", **{**CHAIN, "strain_max": strain}, record_strain=1e-3)
    assert run.code == 0 and f"not known: {names}" in run.stderr


def test_a_pulled_chain_breaks_at_its_strength(tmp_path):
    run = laboratory(tmp_path / "out", **CHAIN, test="tension", speed=0.01)
    assert value(run, "failed") and (value(run, "tensile_cracks"), value(run, "shear_cracks")) == (1, 0)
    assert value(run, "peak_stress") == pytest.approx(0.1e6 / 2e-3, rel=0.02)


def test_compression_breaks_the_specimen(compressed):
    assert compressed.code == 0, compressed.stderr
    assert value(compressed, "failed") and compressed.summary["ended"].startswith("failed at")
    assert compressed.summary["warnings"] == []
    assert value(compressed, "peak_stress") > 10e6
    assert 10e9 < value(compressed, "youngs_modulus") < 25e9 and 0 < value(compressed, "poissons_ratio") < 0.4
    assert value(compressed, "tensile_cracks") + value(compressed, "shear_cracks") > 10


def test_the_end_leaves_figures_and_balances(compressed):
    balance = compressed.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.03 * balance["platen_work"] and balance["bond_breaking"] > 0
    assert (compressed.out / "report.html").stat().st_size > 1e4
    columns = history(compressed.out)
    stress = columns["stress [Pa]"]
    assert stress[-1] < 0.5 * stress.max() == pytest.approx(0.5 * value(compressed, "peak_stress"), rel=1e-9)
    loading = columns["platen_strain [-]"] < 0.5 * value(compressed, "peak_strain")
    assert abs(columns["unbalanced_stress [Pa]"][loading]).max() < 0.02 * stress.max()


def test_the_rock_is_weaker_in_tension_and_as_stiff(compressed, pulled):
    assert value(pulled, "failed")
    assert value(pulled, "tensile_strength") == value(pulled, "peak_stress")
    assert "tensile_strength" not in compressed.summary["results"]
    assert 1e6 < value(pulled, "peak_stress") < 0.5 * value(compressed, "peak_stress")
    assert value(pulled, "youngs_modulus") == pytest.approx(value(compressed, "youngs_modulus"), rel=0.03)


def test_discs_that_cannot_turn_make_the_rock_stiffer(compressed, tmp_path):
    fixed = laboratory(tmp_path / "out", rotation="blocked", strain_max=1e-3)
    assert fixed.code == 0, fixed.stderr
    assert value(fixed, "youngs_modulus") > 1.02 * value(compressed, "youngs_modulus")
    energy = fixed.summary["balances"]["energy"]
    assert abs(energy["residual"]) < 0.01 * energy["platen_work"]


@pytest.mark.parametrize("law, softer", [("damage", 2e9), ("plastic", 2e9)])
def test_softening_bonds_make_the_rock_stronger(tmp_path, law, softer):
    steep, gentle = (laboratory(tmp_path / f"{H:g}", test="tension", bond_law=law, H=H) for H in (1e12, softer))
    assert value(gentle, "peak_stress") > 1.05 * value(steep, "peak_stress")


def test_a_rock_without_shear_strength_has_no_tensile_strength(pulled, tmp_path):
    """Shear strength of 1 N per metre, a hundred thousandth of that in tension: bonds across the load part."""
    loose = laboratory(tmp_path / "out", test="tension", Rt=1.0, rock_sampling_period=1)
    assert loose.code == 0 and value(loose, "failed"), loose.stderr
    assert 0 < value(loose, "peak_stress") < 1e-3 * value(pulled, "peak_stress")
    assert value(loose, "tensile_cracks") == 0 and value(loose, "shear_cracks") > 100
    # Platens do hardly any work: the specimen moves as it will from the beginning, and that energy goes.
    balance = loose.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.03 * max(abs(balance["kinetic"]), balance["platen_work"])


def test_one_law_from_a_steep_to_a_flat_softening(pulled, tmp_path):
    """Damage: with H to infinity the brittle rock, to the last digit; with H to 0 one that yields and never fails."""
    steep = laboratory(tmp_path / "steep", test="tension", bond_law="damage", H=1e16)
    for name in ("peak_stress", "peak_strain", "youngs_modulus", "poissons_ratio", "tensile_cracks", "shear_cracks"):
        assert value(steep, name) == pytest.approx(value(pulled, name), rel=1e-9), name
    flat = laboratory(tmp_path / "flat", test="tension", bond_law="damage", H=1e4, strain_max=4e-3, speed=0.1,
                      record_strain=2e-5)
    assert flat.summary["ended"] == "finished" and not value(flat, "failed")
    assert value(flat, "tensile_cracks") == value(flat, "shear_cracks") == 0
    assert value(flat, "youngs_modulus") == pytest.approx(value(pulled, "youngs_modulus"), rel=0.02)
    columns = history(flat.out)
    stress, strain = columns["stress [Pa]"], columns["platen_strain [-]"]
    # At its end it yields: stress stays the same, above the brittle strength.
    late = stress[strain > 0.8 * strain[-1]]
    assert late.min() > 0.95 * late.max() > 0.95 * 1.3 * value(pulled, "peak_stress")


def test_grains_of_a_disc_each_change_nothing(pulled, tmp_path):
    count = len(np.load(pulled.out / "model.npz")["rock_positions"])
    edge = math.sqrt(SMALL["width"] * SMALL["height"] / count / (1.5 * math.sqrt(3)))
    fine = laboratory(tmp_path / "out", test="tension", grain_edge=repr(edge * (1 + 1e-9)))
    assert fine.code == 0, fine.stderr
    assert len(set(np.load(fine.out / "model.npz")["grains"])) == count
    for name in ("peak_stress", "youngs_modulus", "poissons_ratio", "tensile_cracks", "shear_cracks"):
        assert value(fine, name) == pytest.approx(value(pulled, name), rel=1e-9), name


def test_stopped_and_resumed_equals_never_stopped(compressed, tmp_path):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.01, speed=0.05)
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 2, **{**SMALL, **options})
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(laboratory(out, "--resume", **options), compressed)


def test_a_full_disk_ends_the_run_in_one_line_and_leaves_it_resumable(tmp_path):
    """A limit on the size of a file stands for the disk: history.csv reaches it first."""
    out = tmp_path / "out"
    words = [*arguments({**SMALL, "test": "tension", "record_strain": 1e-6}), "--out", str(out)]
    limit = 100_000
    full = finish(start(SCRIPT, words, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))))
    lines = [line for line in full.stderr.splitlines() if "rror" in line]
    assert full.code == 1 and len(lines) == 1 and "File too large: " in lines[0] and "history.csv'" in lines[0]
    assert "Traceback" not in full.stderr and "the last checkpoint is kept" in lines[0]
    resumed = run_script(SCRIPT, *words, "--resume", out=out)
    assert resumed.code == 0, resumed.stderr
    assert (out / "history.csv").stat().st_size > limit
    period = np.diff(history(out)["time [s]"])
    assert period == pytest.approx(period[0], rel=1e-4)


@pytest.mark.parametrize("law", ["damage", "plastic"])
def test_softening_bonds_stopped_past_their_peak_and_resumed_equal_never_stopped(tmp_path, law):
    """Ten thousand steps, of which the last three thousand lie past the peak of the specimen, too."""
    options = dict(bond_law=law, H=1e9, speed=0.05, strain_max=0.01, drop=0)
    never = laboratory(tmp_path / "never", **options)
    assert never.code == 0, never.stderr
    out = tmp_path / "out"
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 4, **{**SMALL, **options, "checkpoint_interval": 0.01})
    assert stopped.code == 128 + signal.SIGTERM
    current = json.loads((out / "checkpoint/current.json").read_text(encoding="utf-8"))
    with np.load(out / "checkpoint" / str(current["set"]) / "state.npz") as state:
        softened = [len(state[f"scene/engines/bonds/{group}"]) for group in ("softening_bonds", "returned")]
        assert sum(softened) > 3
    resumed = laboratory(out, "--resume", **options)
    assert_as_if_never_stopped(resumed, never, "cracks.csv")


REFUSED = [
    ({"speed": 0}, "speed = 0 m/s: must be greater than 0"),
    ({"test": "shear"}, "test = shear: must be one of compression, tension"),
    ({"rotation": "held"}, "rotation = held: must be one of free, blocked"),
    ({"kn": -1}, "kn = -1 N/m: must be greater than 0"),
    ({"grip": 0.03}, "grip = 0.03 m: must be less than half the width 0.04"),
    ({"grip": 1e-5}, "grip = 1e-05 m: must be deep enough to hold a particle at each end"),
    ({"gauge": 2}, "gauge = 2: must be at most 1"),
    ({"time_step": 1e-3}, "time_step = 0.001 s: must be at most the stable step"),
    ({"radius_max": 5e-4}, "radius_max = 0.0005 m: must be at least radius_min"),
    ({"sped": 1}, "did you mean speed")]


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [arguments({**SMALL, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)
    run = laboratory(tmp_path / "out", **REFUSED[4][0])
    assert_refused(run.code, run.stderr, REFUSED[4][1])
    assert not (tmp_path / "out").exists()

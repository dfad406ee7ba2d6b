"""The laboratory in space: exact moduli and strength of a lattice, a block of spheres, resuming, bad input."""
import math
import signal

import numpy as np
import pytest

from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_density_is_shown, assert_refused, interrupt_script, refusals,
    run_script, value)

SCRIPT = ROOT / "yade_scripts/uniaxial_3d.py"
EXACT = ROOT / "tests/scenes/scripts/laboratory_3d.py"
SMALL = dict(radius=2.4e-3, speed=0.05, gauge=0.9, report="false")
"""Some 350 spheres, five across: the walls order them, and the block is stiffer along its length than finer ones."""
KN, DIAMETER = 50e6, 2e-3


def laboratory(out, *flags, script=SCRIPT, **values):
    return run_script(script, *arguments({**SMALL, **values}), "--out", str(out), *flags, out=out)


def exact(out, **values):
    run = laboratory(out, script=EXACT, **{"bond_law": "brittle", "kn": KN, "kt": KN, "Rt": 1e9, "speed": 0.02,
                                           **values})
    assert run.code == 0, run.stderr
    return run


@pytest.fixture(scope="module")
def compressed(tmp_path_factory):
    return laboratory(tmp_path_factory.mktemp("compressed") / "out", report="true", vtk="true", control_radius=2)


@pytest.mark.parametrize("kt, tolerance", [(KN, 0.005), (KN / 5, 0.04)])
def test_a_lattice_has_its_exact_moduli(tmp_path, kt, tolerance):
    """Strain energy of its twelve bonds a sphere: sqrt(2) (kn (1 - nu) + kt (1 + nu)) / D. Without lateral strain all
    of it strains alike; else its edges disturb it."""
    run = exact(tmp_path / "out", kt=kt, Rn=1e9, strain_max=1e-4, record_strain=2e-6,
                platens="rough" if kt == KN else "smooth")
    nu = (KN - kt) / (3 * KN + kt)
    modulus = math.sqrt(2) * (KN * (1 - nu) + kt * (1 + nu)) / DIAMETER
    assert value(run, "youngs_modulus") == pytest.approx(modulus, rel=tolerance)
    assert value(run, "poissons_ratio") == pytest.approx(nu, abs=tolerance)
    assert not value(run, "failed") and value(run, "tensile_cracks") == 0


def test_a_lattice_has_its_exact_strength(tmp_path):
    """With kn = kt a bond at 45 degrees is opened by half of the axial strain: Fn = kn D strain / 2."""
    run = exact(tmp_path / "out", Rn=50, speed=0.1, test="tension", platens="rough")
    assert value(run, "failed") and value(run, "shear_cracks") == 0
    assert value(run, "tensile_strength") == pytest.approx(4 * math.sqrt(2) * 50 / DIAMETER**2, rel=0.03)


def test_a_block_is_less_stiff_than_its_voigt_bound(compressed):
    """The bound is the strain energy of its own bonds, those of the middle, in the best uniform strain."""
    assert compressed.code == 0, compressed.stderr
    kn, kt = (compressed.summary["parameters"][name] for name in ("kn", "kt"))
    with np.load(compressed.out / "model.npz") as model:
        i, j = model["rock_positions"][model["bonds"].T]
        width, volume = model["block"][0], model["block"].prod()
    middle = abs(0.5 * (i + j)[:, 0] - 0.5 * width) < 0.3 * width
    bonds = (j - i)[middle]
    normals = bonds / np.linalg.norm(bonds, axis=1)[:, None]

    def stiffness(nu):
        strain = normals * [1, -nu, -nu]
        opening = (strain * normals).sum(axis=1)**2
        return ((bonds**2).sum(axis=1) * (kn * opening + kt * ((strain**2).sum(axis=1) - opening))).sum()

    bound = min(stiffness(nu) for nu in np.linspace(0, 0.5, 51)) / (0.6 * volume)
    assert 0.7 * bound < value(compressed, "youngs_modulus") < bound
    assert 0.1 < value(compressed, "poissons_ratio") < 0.35


def test_a_block_fails_and_leaves_its_balance_and_page(compressed):
    assert value(compressed, "failed") and compressed.summary["ended"].startswith("failed at")
    balance = compressed.summary["balances"]["energy"]
    assert balance["unit"] == "J" and abs(balance["residual"]) < 0.02 * balance["platen_work"]
    page = (compressed.out / "report.html").read_text(encoding="utf-8")
    assert "Stress and strain" in page and "slab behind its middle" in page
    assert (compressed.out / "figures/failure.png").stat().st_size > 1e4
    assert any("displacement_z" in file.read_text(encoding="utf-8") for file in (compressed.out / "vtk").iterdir())
    assert_density_is_shown(compressed.out, 2, 2500.0)
    assert (compressed.out / "figures/density.png").stat().st_size > 1e4


def test_a_block_is_weaker_in_tension_and_as_stiff(compressed, tmp_path):
    pulled = laboratory(tmp_path / "out", test="tension")
    assert value(pulled, "failed") and value(pulled, "tensile_strength") == value(pulled, "peak_stress")
    assert 1e6 < value(pulled, "peak_stress") < 0.4 * value(compressed, "peak_stress")
    assert value(pulled, "youngs_modulus") == pytest.approx(value(compressed, "youngs_modulus"), rel=0.1)
    balance = pulled.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.02 * balance["platen_work"]


def test_stopped_and_resumed_equals_never_stopped(tmp_path):
    options = dict(grain_edge=3e-3, grain_strength=2, test="tension", speed=0.01, checkpoint_interval=0.01)
    never = laboratory(tmp_path / "never", **options)
    assert never.code == 0, never.stderr
    out = tmp_path / "out"
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 1, **{**SMALL, **options})
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(laboratory(out, "--resume", **options), never, "cracks.csv")


REFUSED = [
    ({"radius": 0.03}, "radius = 0.03 m: must be at most"), ({"scale_factor": 2}, "scale_factor"),
    ({"depth": -1}, "depth = -1 m: must be"),
    ({"gauge": 0.05}, "gauge = 0.05: must be wide enough to hold 4 particles"),
    ({"grip": 0.03}, "grip = 0.03 m: must be less than half the width 0.05"),
    ({"grip": 1e-5}, "grip = 1e-05 m: must be deep enough to hold a particle at each end"),
    ({"grain_edge": 1.0}, "grain_edge = 1 m: must be at most"),
    ({"grain_strength": 0.5}, "grain_strength = 0.5: must be 0 or between 1 and 1000"),
    ({"time_step": 1e-3}, "time_step = 0.001 s: must be at most the stable step")]


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [arguments({**SMALL, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)
    assert not (tmp_path / "out").exists()

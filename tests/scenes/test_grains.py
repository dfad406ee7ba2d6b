"""Compression and tension of rock with grains: no bond within a grain breaks, and grains make rock of the same bonds
stronger in compression over tension [Bahaaddini 2018, sec. 1]."""
import pytest

from rockwear.report.folder import RunFolder
from tests.running import ROOT, arguments, history, last_snapshot, run_script, value

SPECIMEN = dict(width=0.05, height=0.025, radius_min=1e-3, radius_max=1.5e-3, bond_law="coulomb", kn=4e9, kt=1.6e9,
                mu=0.6, bond_tension=4e6, bond_cohesion=20e6, speed=0.2, rock_sampling_period=10, report="false",
                snapshot_period=1)


def loaded(folder, test, edge, **of_grains):
    out = folder / f"{test}{edge}-{len(of_grains)}"
    done = run_script(ROOT / "yade_scripts/uniaxial.py", "--out", str(out), *arguments(
        {**SPECIMEN, "test": test, "grain_edge": edge, **of_grains,
         "record_strain": 1e-5 if test == "tension" else 1e-4}), out=out)
    assert done.code == 0, done.stderr
    return done


@pytest.fixture(scope="module")
def tests_done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("grains")
    return {(test, edge): loaded(folder, test, edge) for test in ("compression", "tension") for edge in (0, 3e-3)}


def test_no_bond_within_a_grain_ever_breaks(tests_done):
    out = tests_done["compression", 3e-3].out
    model, status = RunFolder(out).model, last_snapshot(out)["status"]
    grain = model["grains"][model["bonds"]]
    within = grain[:, 0] == grain[:, 1]
    assert 0.3 < within.mean() < 0.9
    assert (status[within] == 0).all() and (status[~within] != 0).sum() > 10


def test_grains_make_rock_stronger_in_compression_over_tension(tests_done):
    def ratio(edge):
        return value(tests_done["compression", edge], "peak_stress") / value(tests_done["tension", edge], "peak_stress")

    assert all(value(run, "failed") for run in tests_done.values())
    assert ratio(3e-3) > 1.2 * ratio(0) > 5


def test_grains_as_strong_as_their_boundaries_are_none(tests_done, tmp_path):
    """To the last bit."""
    none, done = tests_done["compression", 0], loaded(tmp_path, "compression", 3e-3, grain_strength=1)
    assert value(done, "peak_stress") == value(none, "peak_stress")
    columns, expected = history(done.out), history(none.out)
    assert all((columns[name] == expected[name]).all() for name in expected if "stress" in name or "crack" in name)


def test_grains_that_break_make_a_rock_between_the_two(tests_done, tmp_path):
    done = loaded(tmp_path, "compression", 3e-3, grain_strength=2)
    weak, strong = (value(tests_done["compression", edge], "peak_stress") for edge in (0, 3e-3))
    assert 1.05 * weak < value(done, "peak_stress") < 0.95 * strong
    model, status = RunFolder(done.out).model, last_snapshot(done.out)["status"]
    grain = model["grains"][model["bonds"]]
    assert (status[grain[:, 0] == grain[:, 1]] != 0).sum() > 5
    balance = done.summary["balances"]["energy"]
    assert abs(balance["residual"]) < 0.03 * balance["platen_work"]

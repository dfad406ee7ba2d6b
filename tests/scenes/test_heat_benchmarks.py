"""The heat benchmarks of [Rojek 2003, 7.6] in YADE: errors and orders, the sources' models, resuming, bad input."""
import signal

import numpy as np
import pytest

from rockwear.kernels.conduction import PATHS
from tests.running import (
    ROOT, arguments, assert_as_if_never_stopped, assert_refused, interrupt_script, refusals, run_script, value)

SCRIPT = ROOT / "yade_scripts/heat_benchmarks.py"
SMALL = dict(across=32, refinements=2, report="false")


def benchmarks(out, *flags, **values):
    return run_script(SCRIPT, *arguments({**SMALL, **values}), "--out", str(out), *flags, out=out)


def errors(run):
    """(stages, 8) of errors.csv: benchmark, packing, across, discs, instant, steps, largest and rms error."""
    return np.loadtxt(run.out / "errors.csv", delimiter=",", skiprows=1)


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    return benchmarks(tmp_path_factory.mktemp("everything") / "out", report="true")


@pytest.mark.parametrize("packing", ["random", "square", "triangular"])
def test_temperatures_are_the_exact_ones_and_converge(everything, packing):
    assert everything.code == 0, everything.stderr
    orders = sorted(value(everything, f"{name}_{packing}_order_in_space") for name in ("slab_source", "half_space",
                                                                                       "jump"))
    # Two random packings, of 69 and 286 discs, differ by more than their size: on Debian 13 one of the three is 1.17.
    assert orders[1 if packing == "random" else 0] > 1.7 and orders[0] > 1.0
    # At 32 diameters across; the default's 80 have a sixth of it. The first instants see a front of few diameters.
    table = errors(everything)
    last = table[(table[:, 1] == ["random", "square", "triangular"].index(packing)) & (table[:, 2] == 32)]
    last = np.array([last[last[:, 0] == k][-1] for k in range(3)])
    assert (last[:, 6] < [0.005, 0.009, 0.002]).all() and (last[:, 7] < [0.004, 0.004, 0.001]).all()


def test_the_balance_closes_and_only_heat_is_there(everything):
    balance = everything.summary["balances"]["heat"]
    assert abs(balance["residual"]) < 1e-12 * balance["generated"] and balance["generated"] > 1e3
    assert set(everything.summary["wall_time"]["by_engine"]) == {"heat", "recorder"}
    assert (everything.out / "report.html").stat().st_size > 1e5


def test_bars_between_centres_miss_the_packing(tmp_path):
    rms = {}
    for model in PATHS:
        run = benchmarks(tmp_path / model, bond_conductance=model, packing="random", benchmark="jump", refinements=1)
        assert run.code == 0, run.stderr
        rms[model] = errors(run)[-1, 7]
    assert rms["voronoi"] < 0.001 and 0.005 < rms["fitted"] < 0.04 and min(rms["bar"], rms["half_bar"]) > 0.03


def test_stopped_and_resumed_equals_never_stopped(everything, tmp_path):
    out, options = tmp_path / "out", dict(checkpoint_interval=0.001)
    stopped = interrupt_script(SCRIPT, out, signal.SIGTERM, 30, **{**SMALL, **options})
    assert stopped.code == 128 + signal.SIGTERM
    resumed = benchmarks(out, "--resume", **options)
    assert_as_if_never_stopped(resumed, everything, "errors.csv")
    # A run that has finished makes nothing anew.
    pictures = sorted((out / "snapshots").iterdir())
    assert_as_if_never_stopped(benchmarks(out, "--resume", **options), everything, "errors.csv")
    assert sorted((out / "snapshots").iterdir()) == pictures


REFUSED = [
    ({"step_fraction": 1.2}, "step_fraction = 1.2: must be at most 1, the stable step"),
    ({"refinements": 4}, "refinements = 4: must be such that across = 32"),
    ({"benchmark": "rod"}, "benchmark = rod: must be one of all, slab_source, half_space, jump"),
    ({"porosity": 0.5}, "porosity = 0.5")]


def test_bad_input_ends_in_one_line(tmp_path):
    cases = [arguments({**SMALL, **values, "out": tmp_path / "out"}) for values, _ in REFUSED]
    for (code, said), (_, words) in zip(refusals(SCRIPT, tmp_path, cases), REFUSED, strict=True):
        assert_refused(code, said, words)
    run = benchmarks(tmp_path / "out", **REFUSED[1][0])
    assert_refused(run.code, run.stderr, REFUSED[1][1])
    assert not (tmp_path / "out").exists()

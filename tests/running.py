"""Scenes are run as a user runs them: YADE in a process of its own, judged by exit code, words and numbers."""
import base64
import json
import math
import os
import subprocess
import time
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np

from rockwear.kernels.density import control_volume_density

ROOT = Path(__file__).resolve().parents[1]
SMALL = dict(width=0.06, height=0.04, radius_min=1.5e-3, radius_max=2.2e-3, tooth_height=0.03, tooth_width=0.02,
             rake=10, clearance=10, tip_radius=2e-3, depth_of_cut=0.01, start_up=0.0012, cycles=1, cycle_time=4e-4,
             snapshot_period=4e-4)
"""A test tooth in miniature: every mechanism of the real one in a few seconds."""
BLOCK = dict(width=0.28, height=0.1, depth=0.16, scale_factor=1, radius=0.012, tool_radius=3e-3, breadth=0.04,
             tooth_height=0.06, tooth_width=0.04, depth_of_cut=0.026, lowering_velocity=0.5, velocity=0.5,
             cut_time=0.09, snapshot_period=0.03, Rn=500, Rt=5000)
"""A cut as of [Rojek 2003, 13.3] through 340 spheres. Bonds are fifty times as strong as there, so that balances are
seen to close on some joules."""
BLOCK_OF_TRIANGLES = {**{name: v for name, v in BLOCK.items() if name != "tool_radius"}, "facet": 0.02, "tool_kn": 1e7,
                      "tool_kt": 1e7}
"""The same by a tooth of triangles. Contacts are ten times as stiff as there: overlaps of 12 % of a radius at a sharp
edge cost the energy balance 4 %."""


def packing(debian_12, debian_13):
    """The seed of a packing that tells: one seed gives other packings with the numpy and scipy of another Debian."""
    return debian_12 if np.lib.NumpyVersion(np.__version__) < "2.0.0" else debian_13


def arguments(values):
    """Command line words of a dict of parameters."""
    return [word for name, value in values.items() for word in (f"--{name}", str(value))]


def start(script, words=(), threads=1, **options):
    """Start a YADE script, its output captured. It may import from its own folder, as under Python."""
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{Path(script).parent}"}
    return subprocess.Popen(["yade", "-n", "-x", f"-j{threads}", str(script), *words], stdout=subprocess.PIPE,
                            stdin=subprocess.DEVNULL, encoding="utf-8",
                            **{"env": environment, "stderr": subprocess.PIPE, **options})


def finish(process, out=None):
    """Wait for it. -> exit code, what it said, and the summary if there is one."""
    stdout, stderr = process.communicate(timeout=300)
    file = out / "summary.json" if out else None
    summary = json.loads(file.read_text(encoding="utf-8")) if file and file.exists() else None
    return SimpleNamespace(code=process.returncode, stdout=stdout, stderr=stderr, summary=summary, out=out)


def run_script(script, *words, out=None, **options):
    """Run a YADE script to its end."""
    return finish(start(script, words, **options), out)


def checks_of(name, folder, *words):
    """What tests/scenes/scripts/NAME.py, a script that makes all its checks in one process, wrote as JSON."""
    file = folder / "checks.json"
    done = run_script(ROOT / f"tests/scenes/scripts/{name}.py", *words, str(file))
    assert done.code == 0, done.stderr
    return json.loads(file.read_text(encoding="utf-8"))


def refusals(script, folder, cases):
    """[(exit code, what it said)] of a script started with each list of words of `cases`, in one process of YADE."""
    file = folder / "cases.json"
    file.write_text(json.dumps([[str(word) for word in words] for words in cases]), encoding="utf-8")
    return [tuple(pair) for pair in checks_of("refusals", folder, str(script), str(file))]


def assert_refused(code, said, words):
    """Refused with exit code 2 and one line that has these words in it, and no traceback."""
    lines = [line for line in said.splitlines() if line.startswith("error: ") or "Traceback" in line]
    assert code == 2 and len(lines) == 1 and lines[0].startswith("error: ") and words in lines[0], said


def value(run, name):
    """A result of a run."""
    found = run.summary["results"][name]["value"]
    return math.nan if found is None else found


def last_snapshot(out):
    """{name: array} of the last snapshot of the run in `out`."""
    with np.load(sorted((out / "snapshots").glob("*.npz"))[-1]) as arrays:
        return dict(arrays)


def vtk_field(file, name):
    """(n,) a field of numbers of a VTK file of ours."""
    array, = (found for found in ElementTree.parse(file).iter("DataArray") if found.get("Name") == name)
    data = base64.b64decode(array.text)
    assert int.from_bytes(data[:8], "little") == len(data) - 8
    return np.frombuffer(data[8:], array.get("type").lower())


def assert_density_is_shown(out, ratio, bulk):
    """The density of the last snapshot is that of its particles, of masses as their radii were at first; ParaView has
    it too. bulk: kg/m3 of the rock, which it has inside."""
    shot, radii = last_snapshot(out), np.load(out / "model.npz")["rock_radii"]
    there = np.isfinite(shot["rock_positions"]).all(axis=1)
    fraction = control_volume_density(positions=shot["rock_positions"][there], radii=radii[there], densities=1.0,
                                      ratio=ratio)
    density = shot["density"]
    assert np.array_equal(np.isfinite(density), there) and there.sum() > 100
    assert 0.7 * bulk < np.median(density[there]) < 1.1 * bulk and density[there].min() < 0.7 * bulk
    assert np.corrcoef(density[there], fraction)[0, 1] > 0.98
    files = sorted((out / "vtk").glob("rock.*.vtp"))
    if files:
        np.testing.assert_allclose(vtk_field(files[-1], "density"), density[there], rtol=1e-8)


def assert_as_if_never_stopped(resumed, never, *tables):
    """A resumed run ended with the results, balances and tables, to the last bit, of one that was never stopped."""
    assert resumed.code == 0, resumed.stderr
    assert resumed.summary["results"] == never.summary["results"]
    assert resumed.summary["balances"] == never.summary["balances"]
    for name in ("history.csv", *tables):
        assert (resumed.out / name).read_bytes() == (never.out / name).read_bytes()


def tooth_cycles(out, *flags, without=(), **values):
    """Run the miniature test tooth with some values of one's own, and without some of the miniature's."""
    script = ROOT / "yade_scripts/tooth_cycles.py"
    given = {name: value for name, value in {**SMALL, **values}.items() if name not in without}
    return run_script(script, *arguments(given), "--out", str(out), *flags, out=out)


tooth_cycles.__test__ = False


def interrupt(out, number, after, **values):
    """Start the miniature test tooth, and send it a signal once it has written `after` checkpoints. -> as finish."""
    return interrupt_script(ROOT / "yade_scripts/tooth_cycles.py", out, number, after, **{**SMALL, **values})


def interrupt_script(script, out, number, after, **values):
    """Start a script, from its checkpoint if there is one, and send it a signal as `interrupt` does."""
    process = start(script, [*arguments(values), "--out", str(out),
                             *(["--resume"] if (out / "checkpoint").exists() else [])])
    deadline = time.time() + 120
    while time.time() < deadline and process.poll() is None and _progress(out) < after:
        time.sleep(0.02)
    process.send_signal(number)
    return finish(process, out)


def _progress(out):
    try:
        return json.loads((out / "checkpoint/current.json").read_text(encoding="utf-8"))["set"]
    except (OSError, ValueError):
        return 0


def history(out):
    """{name: column} of a run's history.csv."""
    lines = (out / "history.csv").read_text(encoding="utf-8").splitlines()
    table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    return {name: table[:, i] for i, name in enumerate(lines[0].split(","))}

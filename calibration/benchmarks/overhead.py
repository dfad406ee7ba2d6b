"""Time per step of the steady cut with the Python engines or without them, from the same instant of the same cut.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/overhead.py --out DIR [--engines dead] [--name value ...]

A process of its own for either: both cut for BEGIN of way with the engines, and differ from there on alone. Nothing is
saved and loaded, which makes steps slower each time. What the window costs when it moves on is not in it. Writes
DIR/overhead.json. calibration/benchmarks/steady_cost.py runs it, in turns.
"""
import json
import os
import sys
import time
from pathlib import Path

from yade import O, PyRunner

from calibration.benchmarks.make_run import BEGIN, CUT
from rockwear.engines import base
from rockwear.kernels.parameter import Parameter, choice
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import steady_cut

STEPS, FIRST = 3000, 200
"""Steps that are timed; those in between, right after the switch."""
ENGINES = Parameter("engines", "alive", "", choice("alive", "dead"), "Python engines from BEGIN on")


def main():
    """Measure and write."""
    servers.close()
    values = parameters.read([*steady_cut.groups(**CUT), COMMON, ENGINES], sys.argv[1:])
    folder = Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    scene = steady_cut.make(values)
    scene.build()
    while scene.programme.distance < BEGIN:
        scene.run_chunk()
    for engine in O.engines:
        engine.dead = isinstance(engine, PyRunner) and values["engines"] == "dead"
    base.run(FIRST)
    begin = time.process_time()
    base.run(STEPS)
    (folder / "overhead.json").write_text(json.dumps({
        "seconds_a_step": (time.process_time() - begin) / STEPS, "cracks": len(scene.bonds.cracks)}, indent=1),
        encoding="utf-8")
    os._exit(0)


main()

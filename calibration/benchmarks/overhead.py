"""Time per step of the test tooth with the Python engines or without them, from the same instant of the same cut.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/overhead.py --out DIR [--engines dead] [--name value ...]

A process of its own for either: both cut up to WARM_UP with the engines, and differ from there on alone. Nothing is
saved and loaded, which makes steps slower each time. Writes DIR/overhead.json. make bench runs it, in turns.
"""
import json
import os
import sys
import time
from pathlib import Path

from yade import O, PyRunner

from rockwear.engines import base
from rockwear.kernels.parameter import Parameter, choice
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

STEPS, WARM_UP, FIRST = 3000, 0.0015, 200
"""Steps that are timed; s before; steps in between, right after the switch."""
ENGINES = Parameter("engines", "alive", "", choice("alive", "dead"), "Python engines after the warm-up")


def main():
    """Measure and write."""
    servers.close()
    values = parameters.read([*cutting.groups(), COMMON, ENGINES], sys.argv[1:])
    folder = Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    scene = cutting.make(values)
    scene.build()
    while scene.time < WARM_UP:
        scene.run_chunk()
    for engine in O.engines:
        engine.dead = isinstance(engine, PyRunner) and values["engines"] == "dead"
    base.run(FIRST)
    begin = time.process_time()
    base.run(STEPS)
    (folder / "overhead.json").write_text(json.dumps({
        "seconds_a_step": (time.process_time() - begin) / STEPS, "bonds": len(scene.rock.pairs),
        "cracks": len(scene.bonds.cracks), "surface": len(scene.tool.model.erosion.surface)}, indent=1),
        encoding="utf-8")
    os._exit(0)


main()

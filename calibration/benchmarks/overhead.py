"""Cost of the Python engines on top of YADE's own step: the same interval of the cut with and without them, in turns.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/overhead.py --out DIR [--name value ...]

Both run five times from one saved state ("dead" is YADE's term for an engine that is switched off). Writes the medians
into DIR/overhead.json. make bench runs it.
"""
import json
import os
import sys
import time
from pathlib import Path
from statistics import median

from yade import O, PyRunner

from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

TURNS, STEPS, WARM_UP = 5, 3000, 0.0015


def main():
    """Measure and write."""
    servers.close()
    values = parameters.read([*cutting.groups(), COMMON], sys.argv[1:])
    folder = Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    scene = cutting.make(values)
    scene.build()
    while scene.time < WARM_UP:
        scene.run_chunk()
    state = scene.state()
    scene.save(folder, folder)
    seconds = {"alive": [], "dead": []}
    for _ in range(TURNS):
        for kind in seconds:
            scene.restore(state, folder, folder)
            for engine in O.engines:
                engine.dead = isinstance(engine, PyRunner) and kind == "dead"
            O.run(200, True)
            begin = time.perf_counter()
            O.run(STEPS, True)
            seconds[kind].append((time.perf_counter() - begin) / STEPS)
    medians = {kind: median(times) for kind, times in seconds.items()}
    (folder / "overhead.json").write_text(json.dumps({
        "seconds_a_step": seconds, "median": medians, "overhead": medians["alive"] / medians["dead"] - 1,
        "bonds": len(scene.rock.pairs), "cracks": len(scene.bonds.cracks),
        "surface": len(scene.tool.model.erosion.surface)}, indent=1), encoding="utf-8")
    os._exit(0)


main()

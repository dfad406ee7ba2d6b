"""Cost of the Python engines on top of YADE's own step: the same interval of the cut with and without them, in turns.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/overhead.py --out DIR [--name value ...]

Both run five times from one saved state, see calibration/benchmarks/alive_and_dead.py. Writes the medians into
DIR/overhead.json. make bench runs it.
"""
import json
import os
import sys
from pathlib import Path

from calibration.benchmarks.alive_and_dead import alive_and_dead
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

STEPS, WARM_UP = 3000, 0.0015


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
    found = alive_and_dead(scene, folder, STEPS)
    (folder / "overhead.json").write_text(json.dumps({
        **found,
        "bonds": len(scene.rock.pairs), "cracks": len(scene.bonds.cracks),
        "surface": len(scene.tool.model.erosion.surface)}, indent=1), encoding="utf-8")
    os._exit(0)


main()

"""Time per step of one fine cut.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/fine_cut.py --out DIR [--name value ...]

The parameters are those of yade_scripts/tooth_cycles.py, with other defaults; it cuts for `start_up`. Writes
DIR/fine_cut.json. calibration/benchmarks/cut_cost.py runs it.
"""
import json
import os
import sys
import time
from pathlib import Path

from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

FINE = dict(width=0.044, height=0.022, radius_min=0.25e-3, radius_max=0.375e-3, bonding_gap=2.5e-5, kt=8e9,
            tooth_height=0.016, tooth_width=0.012, rake=10.0, clearance=10.0, tip_radius=1e-3, tool_radius_min=0.18e-3,
            tool_radius_max=0.24e-3, depth_of_cut=0.004, approach=2e-4, start_up=1.5e-4, cycles=0, heat=False)
"""Rock of 2747 discs."""


def main():
    """Cut, and write seconds per step, of wall and of processor time, and how the rock fared."""
    servers.close()
    values = parameters.read([*cutting.groups(**FINE), COMMON], sys.argv[1:])
    scene = cutting.make(values)
    scene.build()
    begin, begin_cpu = time.perf_counter(), time.process_time()
    while not scene.stage_done:
        scene.run_chunk()
    balance = scene.output.energy_balance()
    folder = Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fine_cut.json").write_text(json.dumps({
        "wall": (time.perf_counter() - begin) / scene.step, "cpu": (time.process_time() - begin_cpu) / scene.step,
        "steps": scene.step, "discs": scene.rock.count, "bonds": len(scene.rock.pairs),
        "softened": float((scene.bonds.softening() > 0).mean()), "cracks": len(scene.bonds.cracks),
        "residual": balance["residual"] / balance["tool_work"]}, indent=1), encoding="utf-8")
    os._exit(0)


main()

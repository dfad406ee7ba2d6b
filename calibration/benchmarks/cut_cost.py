"""Cost of softening bonds in a fine cut: brittle and softening rock in turns, their time per step over the brittle one.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/cut_cost.py --out DIR [--turns 5] [--name value ...]

The parameters are those of yade_scripts/tooth_cycles.py, with the defaults of a fine cut. Every case cuts for
`start_up` from the same packing; a case is compared with the brittle run of the same turn, and medians over the turns
are reported, of wall and of processor time. Writes DIR/cut_cost.json, with the balance of each case. make bench runs
it.
"""
import json
import os
import sys
import time
from pathlib import Path
from statistics import median

from rockwear.kernels.parameter import Parameter, integer
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

FINE = dict(width=0.044, height=0.022, radius_min=0.25e-3, radius_max=0.375e-3, bonding_gap=2.5e-5, kt=8e9,
            tooth_height=0.016, tooth_width=0.012, rake=10.0, clearance=10.0, tip_radius=1e-3, tool_radius_min=0.18e-3,
            tool_radius_max=0.24e-3, depth_of_cut=0.004, approach=2e-4, start_up=3e-4, cycles=0, heat=False)
"""2670 discs, 6580 bonds."""
CASES = {"coulomb": {"bond_law": "coulomb"},
         **{f"cohesive, {G} J/m2": {"bond_law": "cohesive", "bond_fracture_energy": float(G)} for G in (30, 80)}}
"""The first is the brittle one."""
TURNS = Parameter("turns", 5, "", integer(1), "runs of each case")


def cut(values):
    """One cut. -> {wall, cpu: s per step, bonds: s per step within the engine of the bonds, and how the rock fared}."""
    scene = cutting.make(values)
    scene.build()
    begin, begin_cpu, first = time.perf_counter(), time.process_time(), scene.step
    while not scene.stage_done:
        scene.run_chunk()
    steps = scene.step - first
    found = {"wall": (time.perf_counter() - begin) / steps, "cpu": (time.process_time() - begin_cpu) / steps,
             "bonds": scene.bonds.wall_time / steps, "steps": steps, "cracks": len(scene.bonds.cracks),
             "softened": float((scene.bonds.softening() > 0).mean())}
    balance = scene.output.energy_balance()
    return {**found, "residual": balance["residual"] / balance["tool_work"]}


def rows(runs):
    """One row for each case of runs [{case: what `cut` gives}], one for each turn."""
    found, brittle = [], next(iter(CASES))
    for case in CASES:
        turns = [turn[case] for turn in runs]
        found.append({"case": case, **{name: turns[0][name] for name in ("steps", "cracks", "softened", "residual")},
                      **{f"ms_a_step_{clock}": 1e3 * median(turn[clock] for turn in turns)
                         for clock in ("wall", "cpu", "bonds")},
                      **{f"ratio_{clock}": median(turn[case][clock] / turn[brittle][clock] for turn in runs)
                         for clock in ("wall", "cpu")}})
    return found


def main():
    """Measure, print and write."""
    servers.close()
    values = parameters.read([*cutting.groups(**FINE), COMMON, TURNS], sys.argv[1:])
    folder = Path(values["out"] or "out/cut_cost")
    folder.mkdir(parents=True, exist_ok=True)
    runs = []
    for _ in range(values["turns"]):
        runs.append({case: cut({**values, **own}) for case, own in CASES.items()})
        text = json.dumps({"turns": len(runs), "rows": rows(runs), "runs": runs}, indent=1)
        (folder / "cut_cost.json").write_text(text, encoding="utf-8")
    for row in rows(runs):
        print(f"{row['case']:20}{row['ms_a_step_cpu']:8.3f} ms a step, {row['ratio_cpu']:.3f} (wall "
              f"{row['ratio_wall']:.3f}) of brittle, bonds {row['ms_a_step_bonds']:.3f}, residual "
              f"{100 * row['residual']:.1f} %")
    sys.stdout.flush()
    os._exit(0)


main()

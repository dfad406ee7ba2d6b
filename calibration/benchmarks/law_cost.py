"""Cost of softening bonds: the uniaxial test with each bond law, in turns, its time per step over that of brittle ones.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/law_cost.py --out DIR [--turns 5] [--name value ...]

The parameters are those of yade_scripts/uniaxial.py. All laws run from the first load to failure, one after the other,
`turns` times; a law is compared with the brittle run of the same turn, and medians over the turns are reported.
Processor time is listed beside wall time, because other processes disturb it less. Writes one row for each law into
DIR/law_cost.json, with the ratio along the test beside the share of bonds past their peak. make bench runs it.
"""
import json
import os
import sys
import time
from pathlib import Path
from statistics import median

from calibration.laboratory.uniaxial import GROUPS, UniaxialTest
from rockwear.engines.base import RunEnded
from rockwear.kernels.parameter import Parameter, integer
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON

LAWS = "brittle", "damage", "plastic"
"""Laws with an elastic domain. Without one (padova) Python computes every bond in every step, thirty times as long."""
TURNS = Parameter("turns", 5, "", integer(1), "runs of each law")


def intervals(values):
    """One run to failure. -> a dict for each interval between reproducible states, all of one length."""
    scene = UniaxialTest(values)
    scene.build()
    rows, failed = [], False
    while not (failed or scene.stage_done):
        before, begin, begin_cpu = scene.step, time.perf_counter(), time.process_time()
        try:
            scene.run_chunk()
        except RunEnded:
            failed = True
        wall, cpu = time.perf_counter() - begin, time.process_time() - begin_cpu
        softening = scene.bonds.softening()
        rows.append({"steps": scene.step - before, "wall": wall, "cpu": cpu, "stress": scene.stress,
                     "past_peak": float((softening > 0).mean()), "broken": float((softening == 1).mean()),
                     "softening_bonds": len(scene.bonds.softening_bonds)})
    return rows


def a_step(rows, clock):
    """Seconds per step, mean over a run; clock: "wall" or "cpu"."""
    return sum(row[clock] for row in rows) / sum(row["steps"] for row in rows)


def table(runs, H):
    """One row for each law: share of bonds past their peak (mean and at the end), ms per step, ratio to brittle.

    runs: [{law: intervals}], one for each turn. curve: stress (Pa), share past the peak and ratio (cpu) of each.
    """
    found = []
    for law in runs[0]:
        turns = [turn[law] for turn in runs]
        row = {"bond_law": law, "H": None if law == "brittle" else H}
        for clock in ("wall", "cpu"):
            row[f"ms_a_step_{clock}"] = 1e3 * median(a_step(rows, clock) for rows in turns)
            row[f"ratio_{clock}"] = median(a_step(turn[law], clock) / a_step(turn["brittle"], clock) for turn in runs)
        # The runs of a law are equal bit for bit, so that their intervals correspond.
        whole = [a_step(turn["brittle"], "cpu") for turn in runs]
        row["curve"] = [{"stress": of_turns[0]["stress"], "past_peak": of_turns[0]["past_peak"],
                         "ratio": median(a_step([one], "cpu") / mean for one, mean in zip(of_turns, whole))}
                        for of_turns in zip(*turns)]
        past = [point["past_peak"] for point in row["curve"]]
        row.update(past_peak_mean=sum(past) / len(past), past_peak_end=past[-1])
        found.append(row)
    return found


def main():
    """Measure, print and write."""
    servers.close()
    values = parameters.read([*GROUPS, COMMON, TURNS], sys.argv[1:])
    folder = Path(values["out"] or "out/law_cost")
    folder.mkdir(parents=True, exist_ok=True)
    runs = [{law: intervals({**values, "bond_law": law}) for law in LAWS} for _ in range(values["turns"])]
    rows = table(runs, values["H"])
    text = json.dumps({"turns": values["turns"], "rows": rows}, indent=1)
    (folder / "law_cost.json").write_text(text, encoding="utf-8")
    print("law           H, N/m   past peak, mean   at the end   ms per step   ratio: wall     cpu   cpu, slowest part")
    for row in rows:
        H = f"{row['H']:.3g}" if row["H"] else "-"
        worst = max(point["ratio"] for point in row["curve"])
        print(f"{row['bond_law']:10}{H:>10}{row['past_peak_mean']:18.3f}{row['past_peak_end']:13.3f}"
              f"{row['ms_a_step_wall']:12.3f}{row['ratio_wall']:14.2f}{row['ratio_cpu']:8.2f}{worst:21.2f}")
    sys.stdout.flush()
    os._exit(0)


main()

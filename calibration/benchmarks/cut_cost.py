"""Cost of softening bonds in a fine cut: brittle and softening rock in turns, their time per step over the brittle one.

    python3 -m calibration.benchmarks.cut_cost DIR        (part of make bench)

Every cut (calibration/benchmarks/fine_cut.py) runs in a process of its own, one at a time, from the same packing. A
case is compared with the brittle cut of the same turn, and the median over the turns is reported. Processor time is
listed beside wall time, because other processes disturb it less.
"""
import json
from statistics import median

from calibration import generated
from calibration.benchmarks import one_curve
from calibration.campaigns.runs import run_script

TURNS = 5
BRITTLE = "brittle (coulomb)"
CASES = {BRITTLE: ["--bond_law", "coulomb"],
         **{f"cohesive, {G} J/m2": ["--bond_law", "cohesive", "--bond_fracture_energy", str(G)] for G in (30, 80)}}


def cut(folder, words):
    """One cut. -> what calibration/benchmarks/fine_cut.py writes."""
    run_script("calibration/benchmarks/fine_cut.py", folder, words)
    return json.loads((folder / "fine_cut.json").read_text(encoding="utf-8"))


def table(turns):
    """Lines of Markdown of [{case: what `cut` gives}], one dict for each turn."""
    def over(case, clock):
        return median(turn[case][clock] / turn[BRITTLE][clock] for turn in turns)

    first = turns[0]
    return ["## Softening bonds in a fine cut", "",
            f"{first[BRITTLE]['discs']} discs, {first[BRITTLE]['bonds']} bonds, {first[BRITTLE]['steps']} steps; the "
            f"cases in turns, {len(turns)} times, medians of the ratio to the brittle cut of the same turn.", "",
            *generated.table(
                ["bonds", "softened or broken", "cracks", "energy residual", "ms per step, processor",
                 "over brittle: processor", "wall"],
                [[case, f"{first[case]['softened']:.2f}", str(first[case]["cracks"]),
                  f"{100 * first[case]['residual']:.1f} %", f"{1e3 * median(t[case]['cpu'] for t in turns):.2f}",
                  f"{over(case, 'cpu'):.2f}", f"{over(case, 'wall'):.2f}"] for case in CASES])]


def curve(folder):
    """Run all and write cut_cost.json into `folder`. -> the lines of the table."""
    turns = []
    for turn in range(TURNS):
        turns.append({case: cut(folder / f"cut_cost/{turn}-{n}", words)
                      for n, (case, words) in enumerate(CASES.items())})
        (folder / "cut_cost.json").write_text(json.dumps(turns, indent=1), encoding="utf-8")
    return table(turns)


if __name__ == "__main__":
    one_curve.main(curve)

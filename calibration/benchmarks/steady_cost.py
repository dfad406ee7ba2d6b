"""Cost and errors of the Python engines in a steady cut.

    python3 -m calibration.benchmarks.steady_cost DIR        (part of make bench)

Runs calibration/benchmarks/steady_engines.py. Writes steady_cost.md and steady_engines.json into DIR.
"""
import json
from statistics import quantiles

from calibration import generated
from calibration.benchmarks import one_curve
from calibration.campaigns.runs import RunFailed, run_script

ERRORS = {"wear": "wear", "tip temperature": "tip temperature", "tool_friction": "friction work at the tool",
          "rock_friction": "friction work in the rock", "slip in bonds": "work of slip in bonds",
          "bond_breaking": "energy that bonds dissipate"}
"""{what the runs count: words}."""
WORK = "tool_friction", "rock_friction", "slip in bonds", "bond_breaking"
"""Those that are J."""


def table(found):
    """Lines of Markdown of what calibration/benchmarks/steady_engines.py writes."""
    exact, sampled, turns = found["exact"], found["found"], found["seconds_a_step"]
    errors = [[words, f"{100 * (sampled[name] / exact[name] - 1):+.2f} %",
               f"{100 * (sampled[name] - exact[name]) / exact['tool_work']:+.2f} %" if name in WORK else "–"]
              for name, words in ERRORS.items()]
    low, _, high = quantiles((100 * (alive / dead - 1) for alive, dead in zip(turns["alive"], turns["dead"])), n=4)
    spent = sum(found["seconds"].values())
    shares = sorted(((seconds / spent, name) for name, seconds in found["seconds"].items()), reverse=True)
    largest = ", ".join(f"{name.replace('_', ' ')} {100 * share:.0f} %" for share, name in shares if share > 0.01)
    return ["## Engines in a steady cut", "",
            f"The cut of make run, {found['discs']} discs, {found['bonds']} bonds: all Python engines cost "
            f"{100 * found['overhead']:.1f} % of YADE's own step of {1e3 * found['median']['dead']:.2f} ms (processor "
            f"time; {found['steps']} steps with and without them in turns, {len(turns['dead'])} times, median of the "
            f"ratios; half of them lie between {low:.1f} and {high:.1f} %). Of their time: {largest}.", "",
            f"Over the next {found['sampled']} steps, the defaults against sampling in every step, on the same motion:",
            "", *generated.table(["sum", "difference", "over the tool's work"], errors),
            f"The distribution of wear differs by {100 * found['distribution']:.2f} %. The residual of energy is "
            f"{100 * sampled['residual'] / sampled['tool_work']:+.2f} % of the tool's work with the defaults and "
            f"{100 * exact['residual'] / exact['tool_work']:+.2f} % with every step sampled.", ""]


def curve(folder):
    """Run it. -> the lines of the table."""
    folder.mkdir(parents=True, exist_ok=True)
    run_script("calibration/benchmarks/steady_engines.py", folder)
    found = json.loads((folder / "steady_engines.json").read_text(encoding="utf-8"))
    if found["found"]["kinetic energy"] != found["exact"]["kinetic energy"]:
        raise RunFailed("the two runs that differ in sampling alone have come to another motion")
    return table(found)


if __name__ == "__main__":
    one_curve.main(curve)

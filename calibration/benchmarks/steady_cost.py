"""Cost and errors of the Python engines in a steady cut.

    python3 -m calibration.benchmarks.steady_cost DIR        (part of make bench)

Runs calibration/benchmarks/steady_engines.py. Writes steady_cost.md and steady_engines.json into DIR.
"""
import json

import numpy as np

from calibration import generated
from calibration.benchmarks import one_curve
from calibration.campaigns.runs import RunFailed, run_script

ERRORS = {"wear": "wear", "tip temperature": "tip temperature", "tool_friction": "friction work at the tool",
          "rock_friction": "friction work in the rock"}
"""{what the runs count: words}."""
WORK = "tool_friction", "rock_friction"
"""Those that are J."""


def in_turns(found):
    """Words on YADE's own step with the engines and without them."""
    parts = [100 * (alive / dead - 1) for alive, dead in zip(*found.values())]
    low, middle, high = np.percentile(parts, [25, 50, 75])
    return (f"In {len(parts)} turns of some steps with the engines and without them YADE's own step takes "
            f"{middle:.1f} % longer with them (half of the turns {low:.1f} to {high:.1f}), as they use its cache.")


def table(found):
    """Lines of Markdown of what calibration/benchmarks/steady_engines.py writes."""
    exact, sampled = found["exact"], found["found"]
    errors = [[words, f"{100 * (sampled[name] / exact[name] - 1):+.2f} %",
               f"{100 * (sampled[name] - exact[name]) / exact['tool_work']:+.2f} %" if name in WORK else "–"]
              for name, words in ERRORS.items()]
    spent = sum(found["seconds"].values())
    shares = sorted(((seconds / spent, name) for name, seconds in found["seconds"].items()), reverse=True)
    largest = ", ".join(f"{name.replace('_', ' ')} {100 * share:.0f} %" for share, name in shares if share > 0.01)
    return ["## Engines in a steady cut", "",
            f"The cut of make run, {found['discs']} discs, {found['bonds']} bonds: all Python costs "
            f"{100 * found['overhead']:.1f} % of YADE's own step of {1e3 * found['step']:.2f} ms, over "
            f"{found['steps']} steps. Of its time: {largest}.", "", in_turns(found["turns"]), "",
            f"Over the next {found['sampled']} steps, the defaults against sampling in every step, on the same motion:",
            "", *generated.table(["sum", "difference", "over the tool's work"], errors),
            f"The distribution of wear differs by {100 * found['distribution']:.2f} %. The residual of energy is "
            f"{100 * sampled['residual'] / sampled['tool_work']:+.2f} % of the tool's work with the defaults and "
            f"{100 * exact['residual'] / exact['tool_work']:+.2f} % with every step sampled.", "",
            f"The critical step of the bonds that are intact after {found['steps']} steps is "
            f"{found['critical_steps']['intact']:.3f} of that of untouched rock, that of a disc under the tool "
            f"{found['critical_steps']['under the tool']:.3f}.", ""]


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

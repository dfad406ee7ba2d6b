"""Speed against error: cost and error of each numerical parameter, and the choice of its default.

    python3 -m calibration.benchmarks DIR        (make bench)

The steady cut of `make run` tells what the Python engines cost and what their samples miss (steady_cost.py). Heat and
time step are those of yade_scripts/tooth_cycles.py, each against its finest setting on otherwise the same run, two runs
at a time. Heat does not act back on the motion while no particle is removed (wear_acceleration 100 here), so its runs
follow one trajectory. Another time step changes which bond breaks first, and so the whole trajectory: its error is
measured on rock that cannot break. (What it moves in a steady cut campaigns.steady_cut says, over packings.) Writes
bench.md (tables), bench.json, figures and provenance.json into DIR.
"""
import json
import sys
import time

import matplotlib
import numpy as np

from calibration import command, generated
from calibration.benchmarks import cut_cost
from calibration.benchmarks import heat as heat_study
from calibration.benchmarks import loading_speed, scale, steady_cost
from calibration.campaigns.runs import RunFailed, Runs, run_script
from rockwear.report import plots

SAME_PATH = {"wear_acceleration": 100, "start_up": 0.002, "cycles": 0, "snapshot_period": 1}
UNBREAKABLE = {**SAME_PATH, "start_up": 2e-4, "Rn": 1e12, "Rt": 1e12, "approach": 1e-4}
HEAT, DEFAULT_HEAT = [2e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3], 1e-4
FRACTION, DEFAULT_FRACTION = [0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95], 0.8


def run_all(folder, jobs):
    """{name: summary, with the worn depth by tool particle} of runs of the test tooth {name: values}, two at a time.

    Finished runs in the folder are kept. Raises RunFailed.
    """
    with Runs(folder, keep=True) as runs:
        waiting = {name: runs.start(name, "yade_scripts/tooth_cycles.py", report="false", **values)
                   for name, values in jobs.items()}
        found = {name: future.result() for name, future in waiting.items()}
    return {name: {**run.summary, "worn_depth": run.snapshot(-1)["worn_depth"]} for name, run in found.items()}


def value(summary, name):
    """A result of a run."""
    return summary["results"][name]["value"]


def warming(summary):
    """Rise of the hottest tool particle, K."""
    return value(summary, "tool_temperature_max") - summary["parameters"]["tool_temperature"]


def rows_against_finest(runs, parameter):
    """[{parameter, loop_seconds, errors}] of runs from the finest setting, the reference, to the coarsest."""
    reference = next(iter(runs.values()))
    rows = []
    for summary in runs.values():
        depth, exact = summary["worn_depth"], reference["worn_depth"]
        rows.append({
            parameter: summary["parameters"][parameter], "loop_seconds": summary["wall_time"]["loop"],
            "wear": abs(value(summary, "worn_volume") / value(reference, "worn_volume") - 1),
            "distribution": float(np.abs(depth - exact).sum() / exact.sum()),
            "tip temperature": abs(warming(summary) / warming(reference) - 1) if warming(reference) > 0 else 0.0,
            "energy balance": energy_residual(summary)})
    return rows


def energy_residual(summary):
    """Residual of the energy balance over the tool's work."""
    balance = summary["balances"]["energy"]
    return abs(balance["residual"] / balance["tool_work"])


def draw(axes, rows, parameter, default, names, unit):
    """Errors over the parameter, the time of the run on the other axis, the default marked."""
    x = [row[parameter] for row in rows]
    for name in names:
        axes.loglog(x, np.maximum([row[name] for row in rows], 1e-6), "o-", label=name)
    axes.axhline(0.01, color="0.6", lw=0.8, ls="--")
    axes.axvline(default, color="k", lw=0.8, ls=":")
    axes.text(default, axes.get_ylim()[0], " default", rotation=90, va="bottom", fontsize=8)
    axes.set_xlabel(f"{parameter.replace('_', ' ')} [{unit}]")
    axes.set_ylabel("error, relative")
    other = axes.twinx()
    other.plot(x, [row["loop_seconds"] for row in rows], "s--", color="tab:red", ms=4)
    other.set_ylabel("wall time of the run, s", color="tab:red")
    other.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc="best")


def tables(result):
    """All tables, as lines of Markdown."""
    lines = ["Test tooth of [Rojek 2003, 9.2]; errors against the first row of each table.", ""]
    for rows in result.values():
        lines += generated.table([key.replace("_", " ") for key in rows[0]],
                                 [[f"{number:.3g}" for number in row.values()] for row in rows])
    return lines


def law_costs(folder):
    """Lines on the cost of softening bonds, from calibration/benchmarks/law_cost.py."""
    place = folder / "law_cost"
    run_script("calibration/benchmarks/law_cost.py", place, ["--turns", "3", "--speed", "0.2"])
    found = json.loads((place / "law_cost.json").read_text(encoding="utf-8"))
    return ["## Bond laws", "",
            f"Uniaxial compression to failure, the laws in turns, {found['turns']} times, medians.", "",
            *generated.table(
                ["bond law", "H, N/m", "share of bonds past the peak: mean", "at the end", "ms per step",
                 "over brittle: wall", "processor"],
                [[row["bond_law"], f"{row['H']:g}" if row["H"] else "–", f"{row['past_peak_mean']:.3f}",
                  f"{row['past_peak_end']:.3f}", f"{row['ms_a_step_wall']:.2f}", f"{row['ratio_wall']:.2f}",
                  f"{row['ratio_cpu']:.2f}"] for row in found["rows"]])]


def drawn(result):
    """The figure: errors and cost of heat and time step."""
    figure, axes = plots.canvas(11, 4.2, 1, 2)
    draw(axes[0], result["heat"], "heat_period", DEFAULT_HEAT, ["wear", "tip temperature"], "s")
    draw(axes[1], result["step"], "time_step_fraction", DEFAULT_FRACTION,
         ["specific energy", "wear", "tip temperature", "energy balance"], "of the critical step")
    figure.suptitle("Test tooth: error against cost")
    return figure


def jobs():
    """{name: values} of all runs of the test tooth."""
    return {**{f"heat-{p:g}": {**SAME_PATH, "heat_period": p} for p in HEAT},
            **{f"step-{f:g}": {**UNBREAKABLE, "time_step_fraction": f} for f in FRACTION}}


def evaluate(runs):
    """{table: its rows} of all runs."""
    def group(prefix):
        return {name: summary for name, summary in runs.items() if name.startswith(prefix)}

    step = rows_against_finest(group("step-"), "time_step_fraction")
    exact = value(runs["step-0.1"], "specific_energy")
    for row, summary in zip(step, group("step-").values()):
        row["specific energy"] = abs(value(summary, "specific_energy") / exact - 1)
    return {"heat": rows_against_finest(group("heat-"), "heat_period"), "step": step}


def errors_against_cost(folder):
    """Run the test tooth, draw speed_against_error.png, write bench.json. -> lines of Markdown."""
    result = evaluate(run_all(folder / "runs", jobs()))
    with matplotlib.rc_context(plots.STYLE):
        drawn(result).savefig(folder / "speed_against_error.png")
    (folder / "bench.json").write_text(json.dumps(result, indent=1), encoding="utf-8")
    generated.record(folder / "speed_against_error.png", folder / "bench.json")
    return tables(result)


PARTS = {"error against cost": errors_against_cost, "bond laws": law_costs, "steady cut": steady_cost.curve,
         "fine cut": cut_cost.curve, "loading speed": loading_speed.curve, "heat": heat_study.curve,
         "scale": scale.curve}


def main(folder):
    """All curves, the figures and the numbers, and how long each part took."""
    folder.mkdir(parents=True, exist_ok=True)
    lines, minutes = [], {}
    for name, part in PARTS.items():
        begin = time.monotonic()
        lines += part(folder)
        minutes[name] = (time.monotonic() - begin) / 60
    said = ", ".join(f"{name} {spent:.1f}" for name, spent in minutes.items())
    lines += ["", f"Wall minutes: {said}; {sum(minutes.values()):.1f} in all. Runs that the folder had took none."]
    print(generated.write_page(folder / "bench.md", lines))


if __name__ == "__main__":
    try:
        main(command.folder(__spec__.name, "out/bench"))
    except RunFailed as error:
        sys.exit(f"bench: {error}")

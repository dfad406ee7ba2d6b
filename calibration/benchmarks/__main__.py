"""Speed against error of the main scene: cost and error of each numerical parameter, and the choice of its default.

    python3 -m calibration.benchmarks DIR        (make bench)

Parameters of yade_scripts/tooth_cycles.py, each against its finest setting on otherwise the same run, two runs at a
time; the cost of all Python engines together comes from calibration/benchmarks/overhead.py, with and without them in
turns. Sampling and heat do not act back on the motion while no particle is removed (wear_acceleration 100 here), so
their runs follow one trajectory and differ by the parameter alone. Another time step changes which bond breaks first,
and so the whole trajectory: its error is measured on rock that cannot break, beside the scatter of the breaking rock
over seeds. Writes bench.md (tables), bench.json, figures and provenance.json into DIR.
"""
import json
import sys
import time
from statistics import mean, median, stdev

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
BREAKING = {**SAME_PATH, "start_up": 0.004, "wear_acceleration": 7000, "heat": "false"}
SAMPLING, DEFAULT_SAMPLING = [1, 2, 5, 10, 20, 50, 100], 1
ROCK_SAMPLING = [1, 2, 4, 8, 16]
HEAT, DEFAULT_HEAT = [2e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3], 1e-4
FRACTION, DEFAULT_FRACTION = [0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95], 0.8
SEEDS = [1, 2, 3, 4]
TURNS = 5
"""With and without the Python engines."""
VARIANTS = {"default": {}, "time step 0.3": {"time_step_fraction": 0.3}, "rock graded threefold": {"grading_factor": 3}}


def run_all(folder, jobs):
    """{name: summary, with the worn depth by tool particle} of runs of the main scene {name: values}, two at a time.

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


def cost(summary):
    """Wall time of all Python in the loop over that of YADE's own engines."""
    wall = summary["wall_time"]
    return (wall["loop"] - wall["yade"]) / wall["yade"]


def rows_against_finest(runs, parameter):
    """[{parameter, cost, errors}] of runs from the finest setting, the reference, to the coarsest."""
    reference = next(iter(runs.values()))
    rows = []
    for summary in runs.values():
        depth, exact = summary["worn_depth"], reference["worn_depth"]
        rows.append({
            parameter: summary["parameters"][parameter], "cost": cost(summary),
            "loop_seconds": summary["wall_time"]["loop"],
            "wear": abs(value(summary, "worn_volume") / value(reference, "worn_volume") - 1),
            "distribution": float(np.abs(depth - exact).sum() / exact.sum()),
            "tip temperature": abs(warming(summary) / warming(reference) - 1) if warming(reference) > 0 else 0.0,
            "energy balance": energy_residual(summary)})
    return rows


def over_seeds(summaries):
    """Mean and scatter of the breaking cut over packings."""
    forces = [value(s, "mean_cutting_force") for s in summaries]
    return {"mean_cutting_force": mean(forces), "scatter": stdev(forces),
            "loop_seconds": mean(s["wall_time"]["loop"] for s in summaries),
            "energy_residual": max(map(energy_residual, summaries))}


def energy_residual(summary):
    """Residual of the energy balance over the tool's work."""
    balance = summary["balances"]["energy"]
    return abs(balance["residual"] / balance["tool_work"])


def draw(axes, rows, parameter, default, names, unit, right="cost", right_label="Python engines / YADE"):
    """Errors over the parameter, the cost on the other axis, the default marked."""
    x = [row[parameter] for row in rows]
    for name in names:
        axes.loglog(x, np.maximum([row[name] for row in rows], 1e-6), "o-", label=name)
    axes.axhline(0.01, color="0.6", lw=0.8, ls="--")
    axes.axvline(default, color="k", lw=0.8, ls=":")
    axes.text(default, axes.get_ylim()[0], " default", rotation=90, va="bottom", fontsize=8)
    axes.set_xlabel(f"{parameter.replace('_', ' ')} [{unit}]")
    axes.set_ylabel("error, relative")
    other = axes.twinx()
    other.plot(x, [row[right] for row in rows], "s--", color="tab:red", ms=4)
    other.set_ylabel(right_label, color="tab:red")
    other.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc="best")


def in_words(overhead):
    """What all Python engines cost."""
    low, middle, high = (100 * part for part in overhead["overhead"])
    return (f"All Python engines at the defaults: {middle:.1f} % ({low:.1f} to {high:.1f}) of YADE's own step of "
            f"{1e3 * median(overhead['seconds_a_step']['dead']):.2f} ms")


def tables(result):
    """All tables, as lines of Markdown."""
    lines = ["Test tooth of [Rojek 2003, 9.2]; errors against the first row of each table.", ""]
    for name in ("sampling", "rock sampling", "heat", "step"):
        rows = result[name]
        lines += generated.table([key.replace("_", " ") for key in rows[0]],
                                 [[f"{number:.3g}" for number in row.values()] for row in rows])
    lines += [in_words(result["overhead"]) + f": with and without them in {TURNS} turns, a process for each, from the "
              "same instant of the same cut; medians, and the range of the ratio of a turn.", "",
              f"Breaking rock over packings {', '.join(map(str, SEEDS))}, 4 ms:", "", *generated.table(
                  ["variant", "mean cutting force, kN/m", "scatter, kN/m", "wall time, s", "largest energy residual"],
                  [[name, f"{1e-3 * v['mean_cutting_force']:.0f}", f"{1e-3 * v['scatter']:.0f}",
                    f"{v['loop_seconds']:.0f}", f"{100 * v['energy_residual']:.1f} %"]
                   for name, v in result["seeds"].items()])]
    return lines


def measure(script, folder):
    """Run a YADE script of calibration/benchmarks. -> the JSON file that it writes into `folder`."""
    run_script(f"calibration/benchmarks/{script}.py", folder)
    return json.loads((folder / f"{script}.json").read_text(encoding="utf-8"))


def engine_cost(folder):
    """{"seconds_a_step": {"alive" and "dead" engines: [s]}, "overhead": [least, median, largest of the turns]}."""
    found = {"alive": [], "dead": []}
    for turn in range(TURNS):
        for engines, seconds in found.items():
            place = folder / f"overhead/{turn}-{engines}"
            run_script("calibration/benchmarks/overhead.py", place, ["--engines", engines])
            seconds.append(json.loads((place / "overhead.json").read_text(encoding="utf-8"))["seconds_a_step"])
    parts = [alive / dead - 1 for alive, dead in zip(*found.values())]
    return {"seconds_a_step": found, "overhead": [min(parts), median(parts), max(parts)]}


def law_costs(folder):
    """Lines on the cost of softening bonds, from calibration/benchmarks/law_cost.py."""
    found = measure("law_cost", folder / "law_cost")
    return ["## Bond laws", "",
            f"Uniaxial compression to failure, the laws in turns, {found['turns']} times, medians.", "",
            *generated.table(
                ["bond law", "H, N/m", "share of bonds past the peak: mean", "at the end", "ms per step",
                 "over brittle: wall", "processor"],
                [[row["bond_law"], f"{row['H']:g}" if row["H"] else "–", f"{row['past_peak_mean']:.3f}",
                  f"{row['past_peak_end']:.3f}", f"{row['ms_a_step_wall']:.2f}", f"{row['ratio_wall']:.2f}",
                  f"{row['ratio_cpu']:.2f}"] for row in found["rows"]])]


def drawn(result):
    """The figure: errors and cost of sampling, heat and time step."""
    figure, axes = plots.canvas(15, 4.2, 1, 3)
    draw(axes[0], result["sampling"], "sampling_period", DEFAULT_SAMPLING,
         ["wear", "distribution", "tip temperature", "energy balance"], "steps")
    draw(axes[1], result["heat"], "heat_period", DEFAULT_HEAT, ["wear", "tip temperature"], "s")
    draw(axes[2], result["step"], "time_step_fraction", DEFAULT_FRACTION,
         ["specific energy", "wear", "tip temperature", "energy balance"], "of the critical step", "loop_seconds",
         "wall time of the run, s")
    figure.suptitle(f"Test tooth: error against cost. {in_words(result['overhead'])}")
    return figure


def jobs():
    """{name: values} of all runs of the main scene."""
    variants = {f"seed-{seed}-{name}": {**BREAKING, "seed": seed, **values}
                for name, values in VARIANTS.items() for seed in SEEDS}
    return {**{f"sampling-{n}": {**SAME_PATH, "sampling_period": n} for n in SAMPLING},
            **{f"rock-{n}": {**SAME_PATH, "rock_sampling_period": n} for n in ROCK_SAMPLING},
            **{f"heat-{p:g}": {**SAME_PATH, "heat_period": p} for p in HEAT},
            **{f"step-{f:g}": {**UNBREAKABLE, "time_step_fraction": f} for f in FRACTION}, **variants}


def evaluate(runs, overhead):
    """{table: its rows} of all runs, with the overhead of the Python engines."""
    def group(prefix):
        return {name: summary for name, summary in runs.items() if name.startswith(prefix)}

    step = rows_against_finest(group("step-"), "time_step_fraction")
    exact = value(runs["step-0.1"], "specific_energy")
    for row, summary in zip(step, group("step-").values()):
        row["specific energy"] = abs(value(summary, "specific_energy") / exact - 1)
    return {"sampling": rows_against_finest(group("sampling-"), "sampling_period"),
            "rock sampling": rows_against_finest(group("rock-"), "rock_sampling_period"),
            "heat": rows_against_finest(group("heat-"), "heat_period"), "step": step, "overhead": overhead,
            "seeds": {name: over_seeds([runs[f"seed-{seed}-{name}"] for seed in SEEDS]) for name in VARIANTS}}


def errors_against_cost(folder):
    """Run the main scene, draw speed_against_error.png, write bench.json. -> lines of Markdown."""
    result = evaluate(run_all(folder / "runs", jobs()), engine_cost(folder))
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

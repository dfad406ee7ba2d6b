"""Speed against error of the main scene: what each knob costs, what it is off by, and where the defaults come from.

    python3 -m calibration.benchmarks DIR        (make bench)

Knobs of yade_scripts/tooth_cycles.py, each against its finest setting on otherwise the same run, two at a time; the
cost of all our engines together comes from calibration/benchmarks/overhead.py. Sampling and heat do not act back on the motion
while no particle is removed (acceleration 100 here), so their runs follow one trajectory and differ by the knob alone.
A change of the time step changes which bond breaks first, and then everything: its error is shown on rock that cannot
break, beside the scatter of the breaking rock over seeds.
"""
import json
import subprocess
import sys
from pathlib import Path
from statistics import mean, stdev

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from calibration.benchmarks import heat as heat_study
from calibration.benchmarks import loading_speed
from calibration.campaigns.runs import ROOT, RunFailed, Runs

SAME_PATH = {"wear_acceleration": 100, "start_up": 0.002, "cycles": 0, "snapshot_period": 1}
UNBREAKABLE = {**SAME_PATH, "start_up": 2e-4, "Rn": 1e12, "Rt": 1e12, "approach": 1e-4}
BREAKING = {**SAME_PATH, "start_up": 0.004, "wear_acceleration": 7000, "heat": "false"}
SAMPLING, DEFAULT_SAMPLING = [1, 2, 5, 10, 20, 50, 100], 1
ROCK_SAMPLING = [1, 2, 4, 8, 16]
HEAT, DEFAULT_HEAT = [2e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3], 1e-4
FRACTION, DEFAULT_FRACTION = [0.1, 0.2, 0.4, 0.6, 0.8, 0.9], 0.8
SEEDS = [1, 2, 3, 4]


def run_all(folder, jobs):
    """{name: summary, with the worn depth by tool particle} of runs of the main scene {name: values}, two at a time.

    Runs that the folder has already are kept; the whole bench ends where one run does not end well.
    """
    try:
        with Runs(folder, keep=True) as runs:
            waiting = {name: runs.start(name, "yade_scripts/tooth_cycles.py", report="false", **values)
                       for name, values in jobs.items()}
            found = {name: future.result() for name, future in waiting.items()}
    except RunFailed as error:
        sys.exit(f"bench: {error}")
    return {name: {**run.summary, "worn_depth": run.snapshot(-1)["worn_depth"]} for name, run in found.items()}


def value(summary, name):
    """A result of a run."""
    return summary["results"][name]["value"]


def warming(summary):
    """Rise of the hottest tool particle, K."""
    return value(summary, "tool_temperature_max") - summary["parameters"]["tool_temperature"]


def cost(summary):
    """Wall time of our engines over that of YADE."""
    wall = summary["wall_time"]
    return wall["python_engines"] / wall["yade"]


def rows_against_finest(runs, knob):
    """[{knob, cost, errors}] of runs in rising order of scale_factor, the first being the reference."""
    reference = next(iter(runs.values()))
    rows = []
    for summary in runs.values():
        depth, exact = summary["worn_depth"], reference["worn_depth"]
        rows.append({
            knob: summary["parameters"][knob], "cost": cost(summary), "loop_seconds": summary["wall_time"]["loop"],
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
    """What the energy balance misses, as a part of the tool's work."""
    balance = summary["balances"]["energy"]
    return abs(balance["residual"] / balance["tool_work"])


def draw(axes, rows, knob, default, names, unit, right="cost", right_label="our engines / YADE"):
    """Errors over the knob, the cost on the other axis, the default marked."""
    x = [row[knob] for row in rows]
    for name in names:
        axes.loglog(x, np.maximum([row[name] for row in rows], 1e-6), "o-", label=name)
    axes.axhline(0.01, color="0.6", lw=0.8, ls="--")
    axes.axvline(default, color="k", lw=0.8, ls=":")
    axes.text(default, axes.get_ylim()[0], " default", rotation=90, va="bottom", fontsize=8)
    axes.set_xlabel(f"{knob.replace('_', ' ')} [{unit}]")
    axes.set_ylabel("error, relative")
    other = axes.twinx()
    other.plot(x, [row[right] for row in rows], "s--", color="tab:red", ms=4)
    other.set_ylabel(right_label, color="tab:red")
    other.set_ylim(bottom=0)
    axes.legend(fontsize=8, loc="best")


def markdown(result):
    """The numbers as bench.md."""
    lines = ["# Speed against error", "", "Test tooth at M's resolution; each error against the first row of its table.",
             "Runs go two at a time, so that their wall times are rough; the cost of our engines in the line below the",
             "tables is measured in turns.", "", "![curves](speed_against_error.png)", ""]
    for name in ("sampling", "rock sampling", "heat", "step"):
        rows = result[name]
        lines += [f"| {' | '.join(key.replace('_', ' ') for key in rows[0])} |", "|---" * len(rows[0]) + "|",
                  *(f"| {' | '.join(f'{number:.3g}' for number in row.values())} |" for row in rows), ""]
    lines += [f"All our engines at the defaults: {100 * result['overhead']['overhead']:.1f} % of YADE's own step of "
              f"{1e3 * result['overhead']['median']['dead']:.3f} ms (alive and dead in turns, {len(result['overhead']['seconds_a_step']['dead'])} times, medians).", "",
              f"Breaking rock over packings {', '.join(map(str, SEEDS))}, 4 ms:", "",
              "| variant | mean cutting force, kN/m | scatter, kN/m | wall time, s | largest energy residual |",
              "|---|---|---|---|---|",
              *(f"| {name} | {1e-3 * v['mean_cutting_force']:.0f} | {1e-3 * v['scatter']:.0f} | {v['loop_seconds']:.0f} | "
                f"{100 * v['energy_residual']:.1f} % |" for name, v in result["seeds"].items()), ""]
    return "\n".join(lines)


def measure(script, folder):
    """Run a measurement that is a YADE script of calibration/."""
    subprocess.run(["yade", "-n", "-x", "-j1", str(ROOT / "calibration/benchmarks" / script), "--out", str(folder)], check=True,
                   capture_output=True, stdin=subprocess.DEVNULL)


def law_costs(folder):
    """Lines on what softening bonds cost, from calibration/benchmarks/law_cost.py."""
    measure("law_cost.py", folder / "law_cost")
    found = json.loads((folder / "law_cost/law_cost.json").read_text(encoding="utf-8"))
    return ["", "## Bond laws", "", f"Uniaxial compression to failure, the laws in turns, {found['turns']} times, medians.", "",
            "| law | H, N/m | share of bonds past the peak: mean | at the end | ms a step | over brittle: wall | processor |",
            "|---|---|---|---|---|---|---|",
            *(f"| {row['law']} | {row['H'] or '–'} | {row['past_peak_mean']:.3f} | {row['past_peak_end']:.3f} | "
              f"{row['ms_a_step_wall']:.2f} | {row['ratio_wall']:.2f} | {row['ratio_cpu']:.2f} |" for row in found["rows"]), ""]


def main(folder):
    """All curves, the figure and the numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    jobs = {f"sampling-{n}": {**SAME_PATH, "sampling_period": n} for n in SAMPLING}
    jobs.update({f"rock-{n}": {**SAME_PATH, "rock_sampling_period": n} for n in ROCK_SAMPLING})
    jobs.update({f"heat-{p:g}": {**SAME_PATH, "heat_period": p} for p in HEAT})
    jobs.update({f"step-{f:g}": {**UNBREAKABLE, "time_step_fraction": f} for f in FRACTION})
    variants = {"default": {}, "time step 0.3": {"time_step_fraction": 0.3}, "rock graded threefold": {"grading_factor": 3}}
    jobs.update({f"seed-{s}-{name}": {**BREAKING, "seed": s, **values} for name, values in variants.items() for s in SEEDS})
    runs = run_all(folder / "runs", jobs)

    def group(prefix):
        return {name: summary for name, summary in runs.items() if name.startswith(prefix)}

    sampling = rows_against_finest(group("sampling-"), "sampling_period")
    heat = rows_against_finest(group("heat-"), "heat_period")
    step = rows_against_finest(group("step-"), "time_step_fraction")
    exact = value(runs["step-0.1"], "specific_energy")
    for row, summary in zip(step, group("step-").values()):
        row["specific energy"] = abs(value(summary, "specific_energy") / exact - 1)
    seeds = {name: [runs[f"seed-{s}-{name}"] for s in SEEDS] for name in variants}
    measure("overhead.py", folder)
    overhead = json.loads((folder / "overhead.json").read_text(encoding="utf-8"))

    figure, axes = plt.subplots(1, 3, figsize=(15, 4.2), constrained_layout=True)
    draw(axes[0], sampling, "sampling_period", DEFAULT_SAMPLING,
         ["wear", "distribution", "tip temperature", "energy balance"], "steps")
    draw(axes[1], heat, "heat_period", DEFAULT_HEAT, ["wear", "tip temperature"], "s")
    draw(axes[2], step, "time_step_fraction", DEFAULT_FRACTION,
         ["specific energy", "wear", "tip temperature", "energy balance"], "of the critical step", "loop_seconds", "wall time of the run, s")
    figure.suptitle(f"Test tooth: error against cost. All our engines at the defaults: {100 * overhead['overhead']:.1f} % "
                    f"of YADE's step of {1e3 * overhead['median']['dead']:.2f} ms")
    figure.savefig(folder / "speed_against_error.png", dpi=110)
    result = {"sampling": sampling, "rock sampling": rows_against_finest(group("rock-"), "rock_sampling_period"),
              "heat": heat, "step": step, "overhead": overhead,
              "seeds": {name: over_seeds(found) for name, found in seeds.items()}}
    (folder / "bench.json").write_text(json.dumps(result, indent=1), encoding="utf-8")
    text = "\n".join([markdown(result), *law_costs(folder), *loading_speed.curve(folder), *heat_study.curve(folder)])
    (folder / "bench.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/bench"))

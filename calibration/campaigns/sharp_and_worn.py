"""Sharp and worn: what a tool's wear does to its cut.

    python3 -m calibration.campaigns.sharp_and_worn DIR [--read] [--jobs N | --scheduler ADDRESS]

A tool wears in a steady cut, fast. Its outlines at equal steps of the area that it has lost become tools, which cut
fresh packings of the same rock as deep as the new one does, and hardly wear. Finished runs are kept; --read starts
none. Writes into DIR the outlines, sharp_and_worn.csv and .md, a figure and provenance.json: forces, peaks, chips and
friction over the area lost, beside the peak by Evans' theory.
"""
import csv
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns import steady_cut_cases as cases, steady_cut_numbers as numbers
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from rockwear.kernels import cutting_theory, steady_record
from rockwear.kernels.checks import ParameterError, require
from rockwear.model import rock_file
from rockwear.report import plots
from rockwear.report.bodies import tool_loops
from rockwear.scenes.parameters import OF_ROCK

SHAPES = 3
"""Number of outlines, the new one included."""
SEEDS = 1, 2, 3, 5, 6, 7
"""Packings that every tool cuts; in the fourth it wears."""
CUT = {**cases.CUT, **cases.ROCKS[cases.EIGHT], "cut_length": cases.CUT["cut_length"], "report": "false"}
RAKE = CUT.pop("rake")
WORN = {**CUT, "rake": RAKE, "seed": 4, "heat": "true", "wear_acceleration": 3000, "snapshot_period": 1e-4}
"""The cut in which the tool wears."""
QUANTITIES = {"force": "mean Fc, kN/m", "pressed": "mean Fn, kN/m", "peak": "mean peak Fc, kN/m",
              "friction": "friction work, kN/m", "chip": "chip length / depth", "overbreak": "overbreak / depth"}
"""{quantity of campaigns.steady_cut: heading}."""


def stages(run):
    """Snapshots of the new tool and at equal steps of the area that it has lost. -> [(m2, snapshot)]."""
    volumes = run.model["tool_volumes"]
    lost = np.array([volumes[~run.snapshot(k)["alive"]].sum() for k in range(len(run.times))])
    chosen = [int(np.argmin(abs(lost - share * lost[-1]))) for share in np.linspace(0, 1, SHAPES)]
    return [(float(lost[k]), run.snapshot(k)) for k in chosen]


def outline(run, shot):
    """(k, 2) m: outline of the tool, its lowest point at y = 0."""
    polygon = max(tool_loops(run, shot), key=len)
    return polygon - [0.0, polygon[:, 1].min()]


def effective_rake(polygon, depth):
    """Angle (rad) from the vertical of the line from the tip to the front at the rock's surface; negative: blunt."""
    following = np.roll(polygon, -1, axis=0)
    through = (polygon[:, 1] < depth) != (following[:, 1] < depth)
    (x, y), (x_next, y_next) = polygon[through].T, following[through].T
    front = np.max(x + (depth - y) / (y_next - y) * (x_next - x))
    return math.atan2(polygon[np.argmin(polygon[:, 1]), 0] - front, depth)


def evans(rake, depth):
    """kN/m, peak cutting force of a sharp tool by Evans' theory; nan beyond its range."""
    rock = rock_file.read(rock_file.find(CUT["rock"]), OF_ROCK).parts["plane"]
    tension = rock.measured["tensile_strength"]["mean"]
    try:
        return 1e-3 * cutting_theory.evans(tensile_strength=tension, depth=depth, rake=rake)
    except ValueError:
        return math.nan


def figure(tools):
    """Outlines, and four quantities against the area lost."""
    drawn, panels = plots.canvas(12, 7.2, 2, 3)
    colours = matplotlib.colormaps["plasma"](np.linspace(0, 0.85, len(tools)))
    for tool, colour in zip(tools, colours):
        closed = np.vstack([tool["outline"], tool["outline"][:1]])
        panels[0].plot(*plots.MM * closed.T, color=colour, label=f"{1e6 * tool['lost']:.1f} mm² lost")
    tip = tools[0]["outline"][np.argmin(tools[0]["outline"][:, 1]), 0]
    depth = CUT["depth_of_cut"]
    plots.frame(panels[0], plots.MM * np.array([tip - 1.5 * depth, tip + 0.7 * depth, -0.2 * depth, 2.0 * depth]),
                "outlines")
    panels[0].legend(fontsize=8)
    for axes, (name, heading) in zip(panels[1:], QUANTITIES.items()):
        lost = 1e6 * np.array([tool["lost"] for tool in tools])
        for k, tool in enumerate(tools):
            each = [one[name].value for one in tool["each"].values()]
            axes.plot([lost[k]] * len(each), each, "o", color="#c8a15a", markersize=4,
                      label="one packing" if not k else None)
        values, errors = np.array([tool[name] for tool in tools]).T
        axes.errorbar(lost, values, errors, color="#444444", capsize=3, label="mean, its standard error")
        if name == "peak":
            axes.plot(lost, [tool["evans"] for tool in tools], "s:", markersize=4, color="#2c6e91", label="Evans")
            axes.legend(fontsize=8)
        axes.set(title=heading, xlabel="area lost / mm²", ylim=(0, None))
    return drawn


def differences(tools):
    """Rows of a table: how much more each worn tool has than the new one in the same packings, which scatters less."""
    new, rows = tools[0]["each"], []
    for tool in tools[1:]:
        more = {name: [one[name].value - new[seed][name].value for seed, one in tool["each"].items() if seed in new]
                for name in QUANTITIES}
        rows.append([f"{1e6 * tool['lost']:.2f} mm²", *(
            numbers.shown(steady_record.sample_mean(values)) for values in more.values())])
    return rows


def write(folder, tools):
    """The figure, and the tables as sharp_and_worn.md and .csv. -> the text of the first."""
    with matplotlib.rc_context(plots.STYLE):
        figure(tools).savefig(folder / "sharp_and_worn.png")
    rows = [[f"{1e6 * tool['lost']:.2f} mm²", f"{math.degrees(tool['rake']):.0f}°", len(tool["each"]),
             *(numbers.shown(tool[name]) for name in QUANTITIES), f"{tool['evans']:.0f} kN/m"] for tool in tools]
    with open(folder / "sharp_and_worn.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["lost [m2]", "packing", *QUANTITIES], *(
            [tool["lost"], seed, *(one[name].value for name in QUANTITIES)]
            for tool in tools for seed, one in tool["each"].items())])
    generated.record(folder / "sharp_and_worn.png", folder / "sharp_and_worn.csv")
    return generated.write_page(folder / "sharp_and_worn.md", [
        "Mean ± standard error of the packings, from three depths of cut on. The effective rake is that of "
        "the line from the lowest point to the front at the rock's surface; Evans takes it, and the rock's strength in "
        "tension, for the peak of a sharp tool.", "",
        *generated.table(["area lost", "effective rake", "packings", *QUANTITIES.values(), "Evans"], rows),
        "More than the new tool in the same packing:", "",
        *generated.table(["area lost", *QUANTITIES.values()], differences(tools))])


def shapes(folder):
    """[{lost, outline, path, rake, evans}] of the worn tool's stages; writes the outlines. Raises ParameterError (DIR)
    where the run in which it wears has not finished."""
    run, depth, found = existing({"worn": folder / "worn"}).get("worn"), CUT["depth_of_cut"], []
    require(run and run.summary["exit_code"] == 0, "DIR", str(folder), 'a folder with the finished run "worn"')
    (folder / "outlines").mkdir(exist_ok=True)
    for number, (lost, shot) in enumerate(stages(run)):
        polygon, path = outline(run, shot), folder / "outlines" / f"tool_{number}.csv"
        np.savetxt(path, polygon, delimiter=",", header="x [m],y [m]", comments="")
        rake = effective_rake(polygon, depth)
        found.append({"lost": lost, "outline": polygon, "path": path, "rake": rake, "evans": evans(rake, depth)})
    return found


def start(folder, **where):
    """Run what is missing; where: options of Runs. -> 1 where a run failed, else 0."""
    with Runs(folder, keep=True, **where) as runs:
        if wait_for({"worn": runs.start("worn", cases.SCRIPT, **WORN)}, lambda name, run: name):
            return 1
        jobs = {(number, seed): runs.start(f"tool_{number}-{seed}", cases.SCRIPT,
                                           **{**CUT, "seed": seed},
                                           **{"outline": tool["path"]} if number else {"rake": RAKE})
                for seed in SEEDS for number, tool in enumerate(shapes(folder))}
        return wait_for(jobs, lambda key, run: run.path.name)


def main(folder, read=False, **where):
    """Run what is missing unless they are only read, and write all of what is there. -> exit code: 2 where they are
    read and that of the tool that wears has not finished, reported in one line."""
    folder.mkdir(parents=True, exist_ok=True)
    failed, tools = 0 if read else start(folder, **where), []
    try:
        worn = shapes(folder) if not failed else []
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    for number, tool in enumerate(worn):
        places = {seed: folder / f"tool_{number}-{seed}" for seed in SEEDS}
        each = {seed: numbers.of_run(run) for seed, run in existing(places).items()}
        if each:
            tools.append({**tool, "each": each, **{
                name: numbers.over_packings([one[name] for one in each.values()]) for name in QUANTITIES}})
    if tools:
        print(write(folder, tools))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name)
    sys.exit(main(place, "--read" in words, **where))

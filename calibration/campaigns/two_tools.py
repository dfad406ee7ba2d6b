"""The same cut with a tool of particles and with one of segments: worn volume, and its distribution along the tool.

    python3 -m calibration.campaigns.two_tools FIGURE.png FOLDER [FOLDER ...]

Reads run folders of yade_scripts/tooth_cycles.py with --tool particles and --tool segments, several seeds each, draws
the figure and writes a table of the same name (.md) beside it. calibration/results/facet_tools.md states the result.
"""
import sys

import matplotlib
import numpy as np

from calibration import command, generated
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.polygon import contour, nearest_arc
from rockwear.kernels.wear_statistics import PLACE
from rockwear.report import plots, shapes
from rockwear.report.folder import RunFolder

KEPT = 20.0
"""Place of runs with a constant tool shape on the axis of wear_acceleration."""
COLOURS = {"particles": "#2c6e91", "segments": "#cc1414"}
EDGES = np.arange(-6e-3, 24e-3, PLACE)
"""m; of the places along the new outline, from the tip up the front."""


def description(run):
    """(tool, wear_acceleration), the second 0 where the tool keeps its shape."""
    tool, values = run.parameters["tool"], run.parameters
    moves = values["reshape"] if tool == "segments" else values["removal"] != "none"
    return tool, values["wear_acceleration"] if moves else 0.0


def share_of_friction(run):
    """Friction on the tool over its work."""
    energy = run.summary["balances"]["energy"]
    return energy["tool_friction"] / energy["tool_work"]


def worn_once(run):
    """m2 worn, over wear_acceleration."""
    return run.result("worn_volume") / run.parameters["wear_acceleration"]


def profile(run):
    """Depth (m) worn off the places along the new outline."""
    model, shot = run.model, run.snapshot(-1)
    if description(run)[0] == "segments":
        outline = model["tool_vertices"][shapes.loop(model["tool_facets"])]
        middle = model["tool_vertices"][model["tool_facets"]].mean(axis=1)
        worn = shot["worn_volume"]
    else:
        outline, middle = model["outline"], model["tool_positions"]
        stored = shot["worn_depth"] * 2 * model["tool_radii"]
        worn = np.where(shot["alive"], stored, model["tool_volumes"])
    arc = nearest_arc(middle, *contour(outline, 1e-4))
    return np.histogram(arc, EDGES, weights=worn)[0] / PLACE


def grouped(runs):
    """{(tool, acceleration): its runs}."""
    groups = {}
    for run in runs:
        groups.setdefault(description(run), []).append(run)
    return dict(sorted(groups.items()))


def scatter(values):
    """(mean, standard error) of the finite values; nan where there are too few."""
    return generated.mean_and_error(np.asarray(values)[np.isfinite(values)])


def figure(groups):
    """Friction against wear_acceleration, and the distribution of wear on tools that keep their shape."""
    drawn, (left, right) = plots.canvas(11, 4, 1, 2)
    for (tool, factor), runs in groups.items():
        shares = 100 * np.array([share_of_friction(run) for run in runs])
        at = KEPT if factor == 0 else factor * (1.15 if tool == "segments" else 1 / 1.15)
        left.plot(np.full(len(runs), at), shares, ".", color=COLOURS[tool], alpha=0.4)
        left.errorbar(at, *scatter(shares), color=COLOURS[tool], marker="s", capsize=4,
                      label=tool if factor == 0 else None)
        if factor == 0:
            depth = np.mean([profile(run) for run in runs], axis=0)
            right.step(plots.MM * (EDGES[1:] + EDGES[:-1]) / 2, 100 * depth / (plots.MM * PLACE * depth.sum()),
                       where="mid", color=COLOURS[tool], label=f"{tool}, {len(runs)} seeds")
    left.set(xscale="log", xlabel="wear acceleration; leftmost: constant shape", ylim=(0, None),
             ylabel="friction on the tool / % of its work", title="each seed, mean and its standard error")
    right.set(xlabel="arc length from the tip, up the front / mm", ylabel="share of the wear / % per mm",
              title="distribution of wear, constant shape")
    for axes in (left, right):
        axes.legend()
    return drawn


def read(folder):
    """The run in a folder. Raises OSError, or ParameterError where it is of another scene."""
    run = RunFolder(folder)
    require({"tool", "reshape", "removal"} <= set(run.parameters) and "outline" in run.model, "FOLDER", str(folder),
            "the folder of a run of tooth_cycles.py")
    return run


def main(path, folders):
    """Draw the figure at `path`, and write and print a table with a row for each group."""
    groups = grouped(map(read, folders))
    rows = []
    for (tool, factor), runs in groups.items():
        share, its_error = scatter([100 * share_of_friction(run) for run in runs])
        worn, error = scatter([1e12 * worn_once(run) for run in runs])
        rows.append([tool, f"{factor:g}" if factor else "constant shape", f"{share:.3g} ± {its_error:.2g}",
                     f"{worn:.3g} ± {error:.2g}", len(runs)])
    with matplotlib.rc_context(plots.STYLE):
        figure(groups).savefig(path, dpi=80)
    generated.record(path)
    print(generated.write_page(path.with_suffix(".md"), generated.table(
        ["tool", "wear acceleration", "friction on the tool, % of its work", "worn volume over wear acceleration, µm²",
         "seeds"], rows), folders))


if __name__ == "__main__":
    matplotlib.use("Agg")
    command.help_if_asked()
    (file, *runs), _ = command.split(sys.argv[1:], __spec__.name, "FIGURE.png FOLDER [FOLDER ...]", least=2, most=None)
    try:
        main(file, runs)
    except (OSError, ParameterError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)

"""The same cut with a tool of particles and with one of segments: worn volume, and where along the tool it falls.

    python3 -m calibration.campaigns.two_tools FIGURE.png FOLDER [FOLDER ...]

reads run folders of yade_scripts/tooth_cycles.py with --tool particles and --tool segments, some seeds each, and draws
the figure (calibration/results/two_tools.png is one). M 9.2's tooth, 3 ms, grading_factor 3, no heat, five seeds, friction on the tool over its work:

    particles  shape kept (--removal none)   9.3 +- 1.2 %      segments  shape kept (--reshape false)  10.5 +- 2.0 %
               7000 times                    7.5 +- 1.2 %                70 times                      10.4 +- 2.3 %
                                                                         700 times                      7.6 +- 1.7 %
                                                                         7000 times                     3.9 +- 0.5 %

So the two tools are one while they keep their shape (make validate looks again, over three seeds). A face of segments
recedes with every update, away from what presses on it, and at 7000 times by several times the way that rock slides on it
(result recession_per_slip): the contact is relieved and the wear is no longer proportional to the acceleration. Particles
keep their place until they are worn away.
"""
import sys

import matplotlib
import numpy as np

from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.polygon import contour, nearest_arc
from rockwear.kernels.wear_statistics import PLACE
from rockwear.report import plots, shapes
from rockwear.report.folder import RunFolder

KEPT = 20.0
"""Where runs whose tool keeps its shape stand on the axis of acceleration."""
COLOURS = {"particles": "#2c6e91", "segments": "#cc1414"}
EDGES = np.arange(-6e-3, 24e-3, PLACE)
"""m; of the places along the new outline, from the tip up the front."""


def description(run):
    """(tool, acceleration), the second 0 where the tool keeps its shape."""
    tool, values = run.parameters["tool"], run.parameters
    moves = values["reshape"] if tool == "segments" else values["removal"] != "none"
    return tool, values["wear_acceleration"] if moves else 0.0


def share_of_friction(run):
    """Friction on the tool over its work."""
    energy = run.summary["balances"]["energy"]
    return energy["tool_friction"] / energy["tool_work"]


def worn_once(run):
    """m2 worn, were it not accelerated."""
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
    """(mean, standard error) over packings, of what is finite."""
    values = np.asarray(values)[np.isfinite(values)]
    return np.mean(values), np.std(values, ddof=1) / len(values)**0.5


def figure(groups):
    """Friction against acceleration, and where the wear falls on tools that keep their shape."""
    drawn, (left, right) = plots.canvas(11, 4, 1, 2)
    for (tool, factor), runs in groups.items():
        shares = 100 * np.array([share_of_friction(run) for run in runs])
        at = KEPT if factor == 0 else factor * (1.15 if tool == "segments" else 1 / 1.15)
        left.plot(np.full(len(runs), at), shares, ".", color=COLOURS[tool], alpha=0.4)
        left.errorbar(at, *scatter(shares), color=COLOURS[tool], marker="s", capsize=4, label=tool if factor == 0 else None)
        if factor == 0:
            depth = np.mean([profile(run) for run in runs], axis=0)
            right.step(plots.MM * (EDGES[1:] + EDGES[:-1]) / 2, 100 * depth / (plots.MM * PLACE * depth.sum()), where="mid",
                       color=COLOURS[tool], label=f"{tool}, {len(runs)} seeds")
    left.set(xscale="log", xlabel="acceleration; leftmost: the shape is kept", ylim=(0, None),
             ylabel="friction on the tool / % of its work", title="each seed, mean and its standard error")
    right.set(xlabel="arc length from the tip, up the front / mm", ylabel="share of the wear / % per mm",
              title="where wear falls, the shape kept")
    for axes in (left, right):
        axes.legend()
    return drawn


def read(folder):
    """The run in a folder. Raises OSError, or ParameterError where it is none of these."""
    run = RunFolder(folder)
    require({"tool", "reshape", "removal"} <= set(run.parameters) and "outline" in run.model, "FOLDER", str(folder),
            "the folder of a run of tooth_cycles.py")
    return run


def main(path, folders):
    """Draw the figure at `path` and print a line a group."""
    groups = grouped(map(read, folders))
    for (tool, factor), runs in groups.items():
        share, its_error = scatter([100 * share_of_friction(run) for run in runs])
        worn, error = scatter([1e12 * worn_once(run) for run in runs])
        print(f"{tool}, {f'{factor:g} times' if factor else 'shape kept'}: friction {share:.3g} +- {its_error:.2g} % of the "
              f"tool's work, worn at 1 times {worn:.3g} +- {error:.2g} um2, {len(runs)} seeds")
    with matplotlib.rc_context(plots.STYLE):
        figure(groups).savefig(path, dpi=80)


if __name__ == "__main__":
    matplotlib.use("Agg")
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        main(sys.argv[1], sys.argv[2:])
    except (OSError, ParameterError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)

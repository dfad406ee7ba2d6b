"""The same cut with a tool of particles and with one of segments: worn volume, and where along the tool it falls.

    python3 -m calibration.two_tools FOLDER [FOLDER ...]

reads run folders of yade_scripts/test_tooth.py with --tool particles and --tool segments, some seeds each, and draws
calibration/results/two_tools.png. M 9.2's tooth, 3 ms, coarsening 3, no heat, five seeds, friction on the tool over its work:

    particles  shape kept (--removal none)   9.3 +- 1.2 %      segments  shape kept (--reshape false)  10.5 +- 2.0 %
               7000 times                    7.5 +- 1.2 %                70 times                      10.4 +- 2.3 %
                                                                         700 times                      7.6 +- 1.7 %
                                                                         7000 times                     3.9 +- 0.5 %

So the two tools are one while they keep their shape. A face of segments recedes with every update, away from what presses
on it, and at 7000 times by several times the way that rock slides on it (result recession_per_slip): the contact is relieved
and the wear is no longer proportional to the acceleration. Particles keep their place until they are worn away.
"""
import json
import sys
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")

from matplotlib import pyplot  # noqa: E402

from rockwear.kernels.outline import contour  # noqa: E402
from rockwear.kernels.wear_statistics import PLACE  # noqa: E402
from rockwear.report import plots, shapes  # noqa: E402

KEPT = 20.0
"""Where runs whose tool keeps its shape stand on the axis of acceleration."""
COLOURS = {"particles": "#2c6e91", "segments": "#cc1414"}


def profile(folder, tool):
    """Depth (m) worn off the places, PLACE long, along the new outline; arc length (m) of their middles."""
    model = np.load(folder / "model.npz")
    shot = np.load(sorted((folder / "snapshots").glob("*.npz"))[-1])
    if tool == "segments":
        outline = model["tool_vertices"][shapes.loop(model["tool_facets"])]
        middle = model["tool_vertices"][model["tool_facets"]].mean(axis=1)
        worn = shot["worn_volume"]
    else:
        outline, middle = model["outline"], model["tool_positions"]
        stored = shot["worn_depth"] * 2 * model["tool_radii"]
        worn = np.where(shot["alive"], stored, model["tool_volumes"])
    points, arc = contour(outline, 1e-4)
    nearest = np.array([np.linalg.norm(points - place, axis=1).argmin() for place in middle])
    edges = np.arange(-6e-3, 24e-3, PLACE)
    return 0.5 * (edges[1:] + edges[:-1]), np.histogram(arc[nearest], edges, weights=worn)[0] / PLACE


def main(folders):
    runs = {}
    for folder in map(Path, folders):
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        values, energy = summary["parameters"], summary["audits"]["energy"]
        tool = values["tool"]
        moves = values["reshape"] if tool == "segments" else values["removal"] != "none"
        row = summary["results"]["worn_volume"]["value"] / values["acceleration"], energy["tool_friction"] / energy["tool_work"]
        runs.setdefault((tool, values["acceleration"] if moves else 0.0), []).append((*row, *profile(folder, tool)))
    with matplotlib.rc_context(plots.STYLE):
        figure, (left, right) = plots.canvas(11, 4, 1, 2)
        for (tool, factor), found in sorted(runs.items()):
            volumes, shares = np.array([row[:2] for row in found]).T
            count, at = len(found), KEPT if factor == 0 else factor * (1.15 if tool == "segments" else 1 / 1.15)
            left.plot(np.full(count, at), 100 * shares, ".", color=COLOURS[tool], alpha=0.4)
            left.errorbar(at, 100 * shares.mean(), 100 * shares.std(ddof=1) / count**0.5, color=COLOURS[tool], marker="s", capsize=4)
            print(f"{tool}, {f'{factor:g} times' if factor else 'shape kept'}: friction {100 * shares.mean():.3g} +- "
                  f"{100 * shares.std(ddof=1) / count**0.5:.2g} % of the tool's work, worn at 1 times "
                  f"{1e12 * volumes.mean():.3g} +- {1e12 * volumes.std(ddof=1) / count**0.5:.2g} um2, {count} seeds")
            if factor == 0:
                depth = np.array([row[3] for row in found]).mean(axis=0)
                depth *= 100 / (1e3 * PLACE) / depth.sum()
                right.step(1e3 * found[0][2], depth, where="mid", color=COLOURS[tool], label=f"{tool}, {count} seeds")
        left.set(xscale="log", xlabel="acceleration; leftmost: the shape is kept", ylim=(0, None),
                 ylabel="friction on the tool / % of its work", title="each seed, mean and its standard error")
        right.set(xlabel="arc length from the tip, up the front / mm", ylabel="share of the wear / % per mm",
                  title="where wear falls, the shape kept")
        right.legend()
        figure.savefig(Path(__file__).parent / "results" / "two_tools.png", dpi=80)
        pyplot.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])

"""The same cut with a tool of particles and with one of segments: worn volume, and where along the tool it falls.

    python3 -m calibration.two_tools FOLDER [FOLDER ...]

reads run folders of yade_scripts/test_tooth.py with --tool particles and --tool segments, some seeds each, and draws
calibration/results/two_tools.png.
"""
import json
import sys
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")

from matplotlib import pyplot  # noqa: E402

from rockwear.kernels.outline import contour  # noqa: E402
from rockwear.report import plots, shapes  # noqa: E402

PLACE = 2e-3
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
    runs = {"particles": [], "segments": []}
    for folder in map(Path, folders):
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        tool = summary["parameters"]["tool"]
        runs[tool].append((summary["results"]["worn_volume"]["value"], *profile(folder, tool)))
    with matplotlib.rc_context(plots.STYLE):
        figure, (left, right) = plots.canvas(11, 4, 1, 2)
        for place, (tool, found) in enumerate(runs.items()):
            volumes = 1e6 * np.array([row[0] for row in found])
            left.plot(np.full(len(volumes), place), volumes, "o", color=COLOURS[tool], alpha=0.6)
            left.errorbar(place + 0.15, volumes.mean(), volumes.std(ddof=1), color=COLOURS[tool], marker="s", capsize=4)
            depth = 1e3 * np.array([row[2] for row in found])
            right.step(1e3 * found[0][1], depth.mean(axis=0), where="mid", color=COLOURS[tool], label=f"{tool}, {len(found)} seeds")
            print(f"{tool}: {volumes.mean():.3g} +- {volumes.std(ddof=1):.2g} mm2, seeds {np.round(volumes, 2)}")
        left.set(xticks=[0, 1], xticklabels=list(runs), xlim=(-0.5, 1.6), ylim=(0, None), ylabel="worn volume / mm³ per mm",
                 title="each seed, mean and scatter")
        right.set(xlabel="arc length from the tip, up the front / mm", ylabel="mean worn depth / mm", title="where wear falls")
        right.legend()
        figure.savefig(Path(__file__).parent / "results" / "two_tools.png", dpi=80)
        pyplot.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])

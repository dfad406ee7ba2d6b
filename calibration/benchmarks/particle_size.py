"""Accuracy of the worn shape: size of the tool's particles or segments, removal rule, wear in a visit.

    python3 -m calibration.benchmarks.particle_size DIR

A tooth of particles and one of segments wear in the two ways of worn_outlines.py, whose exact outlines are known. The
wear in a visit varies too; in a run it follows from wear_period, wear_acceleration and the work of the cut. Sizes are
mean diameters. Writes particle_size.md (tables), particle_size.png and provenance.json into DIR.
"""
import math

import matplotlib
import numpy as np

from calibration import command, generated
from calibration.benchmarks.worn_outlines import (
    OUTLINE, PATTERN_WORN, WORN, Pattern, exact, flat, flat_of_segments, particles, patterned, patterned_segments, rub,
    unexplained)
from calibration.campaigns.runs import Runs
from rockwear.kernels.polygon import tooth
from rockwear.report import plots

SIZES = 0.3e-3, 0.5e-3, 0.8e-3
SEEDS = 1, 2, 3
CUT = dict(width=0.06, height=0.04, radius_min=1.5e-3, radius_max=2.2e-3, tooth_height=0.03, tooth_width=0.02, rake=10,
           clearance=10, tip_radius=2e-3, depth_of_cut=0.01, start_up=0.008, cycles=0, heat="false",
           wear_acceleration=1, tool_radius_min=0.22e-3, tool_radius_max=0.28e-3, report="false")
PORTIONS = 1 / 64, 1 / 8, 1 / 2, 2
"""Wear in a visit over the volume of a particle."""


def rate(errors):
    """Exponent of the errors over SIZES."""
    return float(np.polyfit(np.log(SIZES), np.log(errors), 1)[0])


def mean_square(rows):
    """[root mean square over the packings] in the order of SIZES."""
    return [float(np.sqrt(np.mean([row.off**2 for row in rows[size]]))) for size in SIZES]


def size_table(ways, off, segments):
    """Errors over the size, as lines of Markdown."""
    rows = []
    for k, size in enumerate(SIZES):
        worst = max(abs(row.unexplained) for found in ways.values() for row in found[size])
        rows.append([f"{1e3 * size:g}", *(f"{1e3 * off[name][k]:.3f}" for name in ways), f"{worst:.0e}",
                     *(f"{1e3 * found[k].off:.3f}" for found in segments.values()),
                     f"{max(abs(found[k].unexplained) for found in segments.values()):.0e}"])
    rates = " and ".join(f"{rate(off[name]):.2f} ({name})" for name in ways)
    return [f"Tooth of 30 x 20 mm, {len(SEEDS)} packings for each size. Flat: {1e6 * WORN:g} mm² rubbed off on a "
            f"plane. Pattern: {1e6 * PATTERN_WORN:g} mm² worn by the friction work of a cut. Error: rms distance "
            "between the worn face and the exact one. Residual: of the volume balance, over Archard's volume, at most.",
            "", *generated.table(["mean diameter or length, mm", "particles, flat: error, mm", "pattern: error, mm",
                                  "residual", "segments, flat: error, mm", "pattern: error, mm", "residual"], rows),
            f"The error of particles is proportional to the size to the power {rates}, that of segments to the power "
            f"{rate([row.off for row in segments['flat']]):.2f} (flat).", ""]


def visit_table(polygon, pattern):
    """Errors over the wear in a visit, as lines of Markdown."""
    size, rows = SIZES[1], []
    for portion in PORTIONS:
        conserving = [patterned(pattern, polygon, size, seed, portion=portion) for seed in SEEDS]
        rubbed = particles(polygon, size, SEEDS[0], "depth")
        rub(rubbed, WORN, portion)
        lost = unexplained(rubbed), patterned(pattern, polygon, size, SEEDS[0], "depth", portion).unexplained
        rows.append([f"{portion:.3g}", f"{1e3 * math.sqrt(np.mean([row.off**2 for row in conserving])):.3f}",
                     *(f"{100 * part:+.1f} %" for part in lost)])
    return [f"Wear in a visit, {1e3 * size:g} mm: error of the outline with removal = volume; removed minus Archard's "
            "volume, over Archard's, with removal = depth.", "", *generated.table(
                ["wear in a visit, of a particle", "removal = volume, pattern: error, mm", "removal = depth, flat",
                 "pattern"], rows)]


def main(folder):
    """Wear both teeth in both ways; write tables and figure."""
    folder.mkdir(parents=True, exist_ok=True)
    polygon = tooth(**OUTLINE)
    with Runs(folder, at_once=1, keep=True) as runs:
        pattern = Pattern(runs.start("cut", "yade_scripts/tooth_cycles.py", **CUT).result())
    ways = {"flat": {size: [flat(polygon, size, seed) for seed in SEEDS] for size in SIZES},
            "pattern": {size: [patterned(pattern, polygon, size, seed) for seed in SEEDS] for size in SIZES}}
    segments = {"flat": [flat_of_segments(polygon, size) for size in SIZES],
                "pattern": [patterned_segments(pattern, polygon, size) for size in SIZES]}
    off = {name: mean_square(rows) for name, rows in ways.items()}
    with matplotlib.rc_context(plots.STYLE):
        draw(polygon, pattern, ways, off, segments).savefig(folder / "particle_size.png")
    generated.record(folder / "particle_size.png")
    print(generated.write_page(folder / "particle_size.md",
                               [*size_table(ways, off, segments), *visit_table(polygon, pattern)]))


def closed(outline):
    """x and y (mm) of a polygon, closed."""
    return 1e3 * np.vstack([outline, outline[:1]]).T


def draw(polygon, pattern, ways, off, segments):
    """Outlines worn in both ways over the exact ones, and their errors over the size."""
    figure, (left, middle, right) = plots.canvas(14, 4.8, 1, 3, width_ratios=(1, 1, 0.8))
    worn_face = pattern.points + pattern.depth(PATTERN_WORN)[:, None] * pattern.inward
    targets = {"flat": exact(polygon, WORN)[0], "pattern": worn_face}
    titles = {"flat": f"rubbed on a plane, {1e6 * WORN:g} mm²",
              "pattern": f"worn as by a cut, {1e6 * PATTERN_WORN:g} mm²"}
    for axes, (name, rows) in zip((left, middle), ways.items()):
        axes.fill(*closed(polygon), facecolor="#eef0f1", edgecolor="0.6", linewidth=1, linestyle="--")
        axes.plot(*closed(targets[name]), color="black", linewidth=1.6, label="exact")
        for size, colour in zip(SIZES, ("#2c6e91", "#c8a15a", "#b5341d")):
            axes.plot(*closed(rows[size][0].outline), color=colour, linewidth=1.2, label=f"{1e3 * size:g} mm")
        axes.plot(*closed(segments[name][1].outline), color="#6a3d9a", linewidth=1.2, linestyle="--",
                  label=f"segments, {1e3 * SIZES[1]:g} mm")
        axes.set(title=titles[name], aspect="equal", xlabel="mm", xlim=(-13, 1), ylim=(-0.5, 10.5))
        axes.legend(loc="upper left")
    sizes = 1e3 * np.array(SIZES)
    for (name, errors), marker in zip(off.items(), "os"):
        right.loglog(sizes, 1e3 * np.array(errors), marker + "-", color="black" if name == "flat" else "#7d868c",
                     label=f"{name}, power {rate(errors):.2f}")
        for size in SIZES:
            right.loglog([1e3 * size] * len(SEEDS), [1e3 * row.off for row in ways[name][size]], ".", color="0.6")
    for (name, rows), style in zip(segments.items(), ("^--", "v:")):
        errors = [row.off for row in rows]
        right.loglog(sizes, 1e3 * np.array(errors), style, color="#6a3d9a",
                     label=f"{name}, segments, power {rate(errors):.2f}")
    right.set(xlabel="mean diameter or length / mm", ylabel="error of the worn face / mm", title="convergence")
    right.set_ylim(8e-4, 0.4)
    right.set_xticks(sizes, [f"{s:g}" for s in sizes])
    right.set_yticks([0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3], ["0.005", "0.01", "0.02", "0.05", "0.1", "0.2", "0.3"])
    right.minorticks_off()
    right.legend(loc="lower right")
    return figure


if __name__ == "__main__":
    main(command.folder(__spec__.name, "out/particle_size"))

"""A groove in space: what a tool's sides add to the cut of a slice.

    python3 -m calibration.campaigns.groove DIR [BREADTH ...] [--read] [--jobs N | --scheduler ADDRESS]

Tools of the breadths BREADTHS (mm) cut `crushing_sandstone` in space, the same depth in the same packings of rock. The
mean force grows as that of a slice times the breadth, and what is left at no breadth is cut at the tool's two sides. N
runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Writes into DIR groove.md,
groove.png and provenance.json.
"""
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, wait_for
from calibration.campaigns.steady_cut_numbers import over_packings, scaled, shown
from rockwear.kernels import steady_record
from rockwear.kernels.fragments import pieces
from rockwear.report import palette, plots
from rockwear.report.folder import RunFolder

SCRIPT = "yade_scripts/cutting_3d_triangles.py"
BREADTHS = {"6.5": 6.5e-3, "13": 13e-3, "26": 26e-3}
"""{mm: m}. A laboratory's chisel is 13 mm wide."""
SEEDS = 1, 2, 3
BESIDE = 0.01
"""m of rock at either side of the tool, two depths of cut, up to spheres that are fixed."""
DRAWN = "13"
BEGIN = 1
"""Depths of cut that do not count: the tool begins at a free face."""
CUT = dict(rock="crushing_sandstone", scale_factor=1.0, radius=6e-4, width=0.045, height=0.015, gravity=0.0,
           tooth_height=0.012, tooth_width=0.008, rake=-5.0, clearance=5.0, tip_radius=5e-4, facet=2e-3,
           tool_kn=1.5e7, tool_kt=6e6, tool_mu=0.3, contact_damping=0.2, velocity=8.0, lowering_velocity=8.0,
           depth_of_cut=5e-3, start=0.0, approach=1e-3, cut_time=3.75e-3, background_damping=500.0,
           snapshot_period=5e-4, record_period=5e-6, report="false")
"""Four spheres in the depth of cut, six depths of way; else as in campaigns.steady_cut."""
QUANTITIES = {"mean force, kN": "force", "over depth and breadth, MJ/m³": "energy", "peak / mean": "peaks",
              "thrust / cutting": "thrust", "friction, kN": "friction", "groove over tool": "section",
              "overbreak / depth": "overbreak"}
"""{heading: quantity of of_run}."""


def plan(breadths):
    """{(breadth, seed): (folder, parameters)}, one packing of all breadths first."""
    return {(name, seed): (f"{name}-{seed}", dict(CUT, breadth=breadth, seed=seed,
                                                  depth=float(f"{breadth + 2 * BESIDE:.6g}")))
            for seed in SEEDS for name, breadth in BREADTHS.items() if name in breadths}


def of_run(run):
    """{quantity: Measured} of one cut, from BEGIN depths of cut on. Forces in kN; energy, that of the mean force over
    depth and breadth, in MJ/m3; section: of the groove over that of the tool in the rock; overbreak: mean depth of the
    rock that came off below the path, over the depth of cut."""
    depth, breadth = run.parameter("depth_of_cut"), run.parameter("breadth")
    cut = run.column("stage") == run.column("stage").max()
    time, cutting, thrust, friction = (run.column(name)[cut] for name in (
        "time", "cutting_force", "thrust_force", "tool_friction"))
    distance = run.parameter("velocity") * (time - time[0])
    begin = BEGIN * depth
    total, pressed = (steady_record.integral(distance, force) for force in (cutting, thrust))
    mean = steady_record.mean(distance, total, begin)
    peaks = steady_record.peaks(distance, cutting, depth=depth, begin=begin).mean()
    above, below = broken(run, begin, float(distance[-1]) - depth)
    energy = run.balances["energy"]
    return {"force": scaled(mean, 1e-3), "energy": scaled(mean, 1e-6 / (depth * breadth)),
            "peaks": steady_record.quotient(peaks, mean),
            "thrust": steady_record.ratio(distance, pressed, total, begin),
            "friction": scaled(steady_record.mean(distance, friction, begin), 1e-3),
            "section": steady_record.Measured((above + below) / (depth * breadth), math.nan),
            "overbreak": steady_record.Measured(below / (depth * breadth), math.nan),
            "missed": steady_record.Measured(energy["residual"] / energy["tool_work"], math.nan)}


def broken(run, begin, end):
    """(above, below) the tool's path: m2 of rock in a section across the cut that has come off between `begin` and
    `end` m of way."""
    first, height = run.snapshot(0)["rock_positions"], run.parameter("height") - run.parameter("depth_of_cut")
    here = off(run) & (first[:, 0] > begin) & (first[:, 0] < end)
    volume = run.parameter("width") * run.parameter("height") * run.parameter("depth") / len(first)
    over = first[:, 1] > height
    return tuple(np.count_nonzero(here & part) * volume / (end - begin) for part in (over, ~over))


def off(run):
    """(n,) bool: spheres that no bonds hold to the fixed ones any more."""
    piece = pieces(len(run.model["rock_radii"]), run.model["bonds"], run.snapshot(-1)["status"] == 0)
    return ~np.isin(piece, piece[run.model["rock_fixed"]])


def measured(folder):
    """{breadth: {seed: {quantity: Measured}}} of the runs that exist."""
    found = {}
    for (name, seed), (place, _) in plan(BREADTHS).items():
        if (folder / place / "summary.json").exists():
            found.setdefault(name, {})[seed] = of_run(RunFolder(folder / place))
    return found


def sides(found):
    """(slice, kN/m; sides, kN), each Measured: the line of the mean force over the breadth, in each of the packings
    that have all breadths; unknown without one."""
    seeds = sorted(set.intersection(*(set(of) for of in found.values()))) if len(found) == len(BREADTHS) else []
    if not seeds:
        return steady_record.UNKNOWN, steady_record.UNKNOWN
    lines = [np.polyfit([BREADTHS[name] for name in found], [of[seed]["force"].value for of in found.values()], 1)
             for seed in seeds]
    return tuple(map(steady_record.sample_mean, np.transpose(lines)))


def rows(found):
    """Rows of the table, a breadth each."""
    for name, of in found.items():
        cells = (shown(over_packings([one[quantity] for one in of.values()])) for quantity in QUANTITIES.values())
        yield [name, len(of), *cells, f"{100 * max(abs(one['missed'].value) for one in of.values()):.2g} %"]


def figure(found, line, run):
    """The mean force over the breadth, and a section across the groove of a run (None: without)."""
    drawn, panels = plots.canvas(11, 4, 1, 2 if run else 1)
    for name, of in found.items():
        panels[0].plot([1e3 * BREADTHS[name]] * len(of), [one["force"].value for one in of.values()], "o",
                       color=palette.POINTS)
    if math.isfinite(line[0].value):
        breadth = np.array([0.0, 1.05 * max(BREADTHS.values())])
        panels[0].plot(1e3 * breadth, line[0].value * breadth + line[1].value, color=palette.CUTTING,
                       label=f"{shown(line[1])} kN at the sides, and a slice of {shown(line[0])} kN/m")
        panels[0].plot(1e3 * breadth, line[0].value * breadth, "--", color=palette.GUIDE, label="the slice alone")
        panels[0].legend()
    panels[0].set(xlabel="breadth of the tool / mm", ylabel="mean cutting force / kN", xlim=(0, None), ylim=(0, None))
    if run:
        section(panels[1], run)
    return drawn


def section(axes, run):
    """Rock across the cut where the tool has passed: what came off, and the tool's own section."""
    first, loose = run.snapshot(0)["rock_positions"], off(run)
    radius, (width, height, depth) = run.parameter("radius"), run.model["block"]
    breadth, cut = run.parameter("breadth"), run.parameter("depth_of_cut")
    here = np.abs(first[:, 0] - 2.5 * cut) < radius
    for these, colour in ((here & ~loose, palette.ROCK), (here & loose, palette.REMOVED)):
        plots.discs(axes, first[these][:, [2, 1]], np.full(np.count_nonzero(these), radius), facecolors=colour,
                    edgecolors=palette.ROCK_EDGE, linewidths=0.3)
    corners = np.array([(-1, 0), (-1, -1), (1, -1), (1, 0)]) * (0.5 * breadth, cut) + (0, height)
    axes.plot(*(1e3 * corners).T, color=palette.PATH, label="the tool's section")
    plots.frame(axes, (-500 * depth, 500 * depth, 0, 1.2e3 * height), "across the groove: red has come off")
    axes.legend(loc="upper right")


def write(folder):
    """Table and figure of the runs that exist. -> the table, in Markdown."""
    found = measured(folder)
    line = sides(found)
    lines = ["Mean ± standard error: of the packings where there are three, else of the cuts' own records, from "
             f"{BEGIN} depth of cut on. Groove over tool: section of the rock that came off over depth times breadth. "
             "Energy missed: residual of the balance over the tool's work, of the worst packing.", ""]
    lines += generated.table(["breadth, mm", "packings", *QUANTITIES, "energy missed"], rows(found))
    if math.isfinite(line[0].value):
        lines += [f"The mean force is {shown(line[1])} kN at the sides and {shown(line[0])} kN per metre of breadth "
                  "(mean of the lines of each packing)."]
    if found:
        drawn = next((RunFolder(folder / f"{DRAWN}-{seed}") for seed in found.get(DRAWN, {})), None)
        with matplotlib.rc_context(plots.STYLE):
            figure(found, line, drawn).savefig(folder / "groove.png")
        generated.record(folder / "groove.png")
    return generated.write_page(folder / "groove.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(place, SCRIPT, **values)
                    for key, (place, values) in plan(words or BREADTHS).items()}
            failed = wait_for(jobs, lambda key, run: "{} mm, packing {}".format(*key))
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, BREADTHS)
    sys.exit(main(place, words, **where))

"""A steady cut over the distance: forces and their means, the groove left behind, chips by size, cracks by depth."""
import math

import numpy as np
from matplotlib.ticker import LogLocator, NullLocator

from rockwear.kernels.fragments import LEAST_PARTICLES, size_distribution
from rockwear.kernels.steady_record import CELL, ENOUGH_CHIPS, LONG_ENOUGH, RESOLUTION, blocks, integral, peaks
from rockwear.report import palette
from rockwear.report.page import Section, beside, number, percent, quantity, shown_unit, table, with_error
from rockwear.report.plots import MM, canvas, legend, save

BLOCK = 5 * CELL
"""Length, in depths of cut, of the means that show whether the force drifts, as near as it divides the record."""
LEVEL = 0.1
"""Height, in depths of cut, of a bar of cracks."""
STRIP, MOST_STRIPS = 25, 4
"""Least length, in depths of cut, of a strip of the groove, and how many strips are drawn at most."""
TALLEST = 5
"""Inches, of a strip."""
ROWS = {"mean_cutting_force": "mean cutting force", "mean_peak_cutting_force": "mean peak of a chip",
        "peak_over_mean": "mean peak over mean", "mean_thrust_force": "mean thrust force",
        "thrust_over_cutting": "thrust over cutting force", "specific_energy": "specific energy",
        "friction_work_per_metre": "friction work per metre of cut", "overbreak": "overbreak",
        "chip_length": "chip length"}
BY_HAND = (("worn off; k N s/H, the thrust sliding all the way", "worn_volume", "worn_volume_by_hand"),
           ("tip at the end; a strip of heat, the tool's share", "tool_temperature_end", "tool_temperature_by_hand"),
           ("the same; tool and rock as hot (Blok)", "tool_temperature_end", "tool_temperature_by_blok"))
"""(label, result of the run, result by hand)."""
LENGTHS = "overbreak", "chip_length"


def is_steady_cut(run):
    """True for a run that was cut steadily and measured so."""
    return {"distance", "cutting_force", "thrust_force"} <= run.columns.keys() and (
        "mean_peak_cutting_force" in run.summary.get("results", {}))


def depth_of(run):
    """Depth of cut, m."""
    return run.parameter("depth_of_cut")


# ---- numbers

def steady_cut(run):
    """Section of the steady cut."""
    if not is_steady_cut(run):
        return None
    return Section("Steady cut", verdict(run), [
        beside(measured(run), by_hand(run)), save(run, "steady_forces", force_figure(run)),
        save(run, "groove", groove_figure(run)),
        save(run, "chips_and_cracks", chip_and_crack_figure(run))])


def verdict(run):
    """What the means stand for, and whether the record is long enough."""
    length, count = run.result("steady_length"), run.result("peaks")
    seen = (f"Means with their standard errors, over the {quantity(length, 'm')} that follow a transient of "
            f"{quantity(run.result('transient'), 'm')}: {number(length / depth_of(run))} depths of cut and "
            f"{number(count)} chips.")
    if run.result("long_enough") is True:
        return seen
    return (f"{seen} That is too short to rely on: at least {LONG_ENOUGH} depths and {ENOUGH_CHIPS} chips of a record "
            "that has become steady are needed.")


def measured(run):
    """Table of the means with their standard errors; lengths also in depths of cut."""
    rows = [(label, shown(run, name), shown(run, name, 1 / depth_of(run)) if name in LENGTHS else "")
            for name, label in ROWS.items() if math.isfinite(run.result(name))]
    return table(rows, ("", "mean ± standard error", "in depths of cut"))


def shown(run, name, part=None):
    """A mean with its error in its unit, or times `part` without one."""
    value, error = run.result(name), run.result(f"{name}_standard_error")
    return with_error(value, error, run.unit(name)) if part is None else with_error(part * value, part * error, "-")


def by_hand(run):
    """Table of wear and temperature by hand beside the run's; empty where neither is known."""
    rows = [(label, *(quantity(run.result(name), run.unit(name)) for name in pair)) for label, *pair in BY_HAND
            if math.isfinite(run.result(pair[-1]))]
    return table(rows, ("", "run", "by hand"), "Expected by hand") if rows else ""


# ---- forces

def force_figure(run):
    """Cutting and thrust force over the distance."""
    distance, begin, depth = run.column("distance"), run.result("transient"), depth_of(run)
    length = np.ptp(distance) if len(distance) else 0.0
    if not length > RESOLUTION * depth:
        return None
    figure, panels = canvas(12, 6.4, 2, sharex=True, height_ratios=(3, 2))
    unit, factor, _ = shown_unit("m", distance[-1])
    for axes, name, colour in zip(panels, ("cutting_force", "thrust_force"), (palette.CUTTING, palette.THRUST)):
        force = 1e-3 * np.nan_to_num(run.column(name), posinf=0.0, neginf=0.0)
        total = integral(distance, force)
        fine, coarse = max(1, round(length / (RESOLUTION * depth))), max(1, round(length / (BLOCK * depth)))
        record = blocks(distance, total, fine)
        draw_mean(run, axes, name, factor * begin, factor * distance[-1])
        axes.plot(factor * middles(distance, fine), record, color=colour, linewidth=0.5, alpha=0.6)
        axes.stairs(blocks(distance, total, coarse), factor * np.linspace(distance[0], distance[-1], coarse + 1),
                    color=colour, linewidth=2, baseline=None,
                    label=f"means over {number(length / (coarse * depth))} depths of cut")
        if name == "cutting_force" and run.result("peaks"):
            found = peaks(distance, force, depth=depth, begin=begin)
            axes.plot(factor * found.distance, found.force, "v", color=palette.LARGEST, markersize=4,
                      label=f"peak of a chip, mean\n{shown(run, 'mean_peak_cutting_force')}")
        axes.axvspan(factor * distance[0], factor * begin, color=palette.STAGE, zorder=-5, linewidth=0,
                     label="transient, left out" if begin > distance[0] else None)
        axes.set(ylabel=f"{name.replace('_', ' ')} / kN/m", ylim=(min(0.0, 1.05 * record.min()), None))
        legend(axes)
    panels[-1].set(xlabel=f"distance cut / {unit}", xlim=(factor * distance[0], factor * distance[-1]))
    return figure


def draw_mean(run, axes, name, begin, end):
    """The mean with a band of twice its standard error on either side, from `begin` on."""
    value, error = (1e-3 * run.result(f"mean_{name}{part}") for part in ("", "_standard_error"))
    band = "band: twice the error" if math.isfinite(error) else "its error is not known"
    axes.plot([begin, end], [value, value], color=palette.MEAN, linewidth=1.5, zorder=3,
              label=f"mean {shown(run, f'mean_{name}')};\n{band}")
    if math.isfinite(error):
        axes.fill_between([begin, end], value - 2 * error, value + 2 * error, color=palette.MEAN, alpha=0.15,
                          linewidth=0)


def middles(distance, count):
    """(count,) m, middles of equal parts of the record."""
    return distance[0] + (np.arange(count) + 0.5) / count * np.ptp(distance)


# ---- groove

def groove_figure(run):
    """The groove to scale, in strips: rock that is left, and what was broken out below the path; None for one that is
    shorter than the cut is deep."""
    x, height = (MM * column for column in run.table("groove.csv", "x", "height"))
    depth = MM * depth_of(run)
    if np.count_nonzero(np.isfinite(height)) < 2 or not (length := x[-1] - x[0]) > depth:
        return None
    strips = int(np.clip(length // (STRIP * depth), 1, MOST_STRIPS))
    bottom = min(np.nanmin(height), 0.0) - 0.6 * depth
    top = max(np.nanmax(height), depth) + 0.4 * depth
    tall = min(TALLEST, 11 * (top - bottom) / (length / strips))
    figure, panels = canvas(12, 0.7 + strips * (0.25 + tall), strips)
    for k, axes in enumerate(panels):
        draw_groove(axes, x, height, depth, bottom)
        axes.set(xlim=(x[0] + k * length / strips, x[0] + (k + 1) * length / strips), ylim=(bottom, top))
        axes.axvspan(x[0], MM * run.result("transient"), color=palette.STAGE, alpha=0.5, linewidth=0)
    panels[-1].set_xlabel("mm")
    overbreak = run.result("overbreak")
    words = (f", after the transient (pale) more than {quantity(overbreak, 'm')} on 10 % of the length"
             if math.isfinite(overbreak) else "")
    panels[0].set_title(f"The groove left behind, to scale. Red: broken out below the tool's path{words}", loc="left")
    return figure


def draw_groove(axes, x, height, depth, bottom):
    """Rock below the profile, rock broken out below the path, and both levels, mm, to scale."""
    axes.fill_between(x, height, depth, color=palette.TOOL_NEW, linewidth=0)
    axes.fill_between(x, np.minimum(height, 0), 0, color=palette.REMOVED_EDGE, linewidth=0)
    axes.fill_between(x, bottom, height, color=palette.ROCK, linewidth=0)
    axes.plot(x, height, color=palette.ROCK_EDGE, linewidth=0.8)
    axes.axhline(0, color=palette.PATH, linewidth=0.8)
    axes.axhline(depth, color=palette.GUIDE, linewidth=0.8, linestyle="--")
    axes.set_aspect("equal")
    axes.set_yticks([0, depth], ["path", "surface"])


# ---- chips and cracks

def chip_and_crack_figure(run):
    """Chips by size and cracks by depth, what there is of both."""
    drawers = [draw for draw, file in ((draw_chips, "chips.csv"), (draw_cracks, "cracks.csv"))
               if len(run.table(file, "y")[0])]
    if not drawers:
        return None
    figure, panels = canvas(6 * len(drawers), 4.2, 1, len(drawers))
    for draw, axes in zip(drawers, panels):
        draw(run, axes)
    return figure


def draw_chips(run, axes):
    """Share of the broken rock in chips up to a length, in depths of cut."""
    particles, area, length = run.table("chips.csv", "particles", "area", "length")
    lengths, share = size_distribution(area=area, length=length)
    axes.plot(lengths / depth_of(run), 100 * share, color=palette.THRUST, drawstyle="steps-post")
    mean = run.result("chip_length") / depth_of(run)
    dust = percent(area[particles < LEAST_PARTICLES].sum(), area.sum())
    axes.set(xscale="log", xlabel="length of the chip / depth of cut", ylabel="area in chips up to this length / %",
             ylim=(0, 102), title=f"{len(area)} chips; {dust} of their area in pieces\n"
             f"of fewer than {LEAST_PARTICLES} particles")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    if math.isfinite(mean):
        axes.axvline(mean, color=palette.MEAN, linewidth=1.5,
                     label=f"mean by area\n{shown(run, 'chip_length', 1 / depth_of(run))} depths")
        axes.legend(loc="upper left")


def draw_cracks(run, axes):
    """Cracks per metre of cut by their height, tension and shear one beside the other."""
    y, mode = run.table("cracks.csv", "y", "mode")
    y = y / depth_of(run)
    y, mode = y[np.isfinite(y)], mode[np.isfinite(y)]
    length = np.ptp(run.column("distance"))
    edges = LEVEL * np.arange(math.floor(y.min(initial=0.0) / LEVEL), math.ceil(y.max(initial=1.0) / LEVEL) + 1)
    counts = [np.histogram(y[mode == kind], edges)[0] / length for kind in (1, 2)]
    middle, left = (edges[1:] + edges[:-1]) / 2, np.zeros(len(edges) - 1)
    for count, words, colour in zip(counts, ("tension", "shear"), (palette.TENSILE, palette.SHEAR)):
        axes.barh(middle, count, height=0.9 * LEVEL, left=left, color=colour, label=words)
        left = left + count
    for level, words, colour, style in ((0, "path", palette.PATH, "-"), (1, "surface", palette.GUIDE, "--")):
        axes.axhline(level, color=colour, linewidth=0.8, linestyle=style)
        axes.text(1.01, level, words, va="center", transform=axes.get_yaxis_transform(), color=palette.REMARK)
    axes.set(xlabel=f"cracks per metre of cut in {LEVEL:g} depths", ylabel="height above the path / depth of cut",
             title=f"{len(y)} cracks, {percent(np.count_nonzero(y < 0), len(y))} below the tool's path")
    axes.legend(loc="upper right")

"""Shape of a tool in the plane as it wears: outlines over the new one, and worn depth along it."""
import numpy as np

from rockwear.kernels.polygon import contour
from rockwear.report import palette
from rockwear.report.bodies import gap, has_facets, has_particles, in_plane, keeps_shape, tool_loops
from rockwear.report.instants import turns, worn
from rockwear.report.page import Section
from rockwear.report.plane import draw_new_outline, worn_limits
from rockwear.report.plots import MM, canvas, closed, frame, save

SPACING = 1e-4
"""Distance (m) between the places of the contour where worn depth is measured."""


def outlines(run):
    """Section of the tool's shape."""
    if not in_plane(run) or keeps_shape(run) or not run.has("outline"):
        return None
    source = ", as in [Rojek 2014, fig. 17]" if turns(run) else ""
    points = " Each point is a vertex." if has_facets(run) else ""
    return Section(f"Shape of the tool{source}", "Dashed: the new tool. Worn depth is the distance from the new "
                   f"contour to what is left; arc length counts from the tip, positive up the front.{points}",
                   [save(run, "shape", figure(run))])


def figure(run):
    """The whole tool, where it is worn, and worn depth along the contour, at several stages."""
    shown = worn(run, 8)
    if not shown:
        return None
    shots = {label: run.snapshot(k) for label, k in shown.items()}
    colours = palette.sequence(len(shots))
    drawn, (whole, near, profile) = canvas(13, 5.2, 1, 3, width_ratios=(0.7, 1, 1.2))
    for axes in (whole, near):
        axes.fill(*MM * run.model["outline"].T, facecolor=palette.TOOL_NEW)
        draw_new_outline(run, axes, linestyle="--", linewidth=1)
        for shot, colour in zip(shots.values(), colours):
            for loop in tool_loops(run, shot):
                style = ".-" if has_facets(run) and axes is near else "-"
                axes.plot(*MM * closed(loop).T, style, color=colour, linewidth=1.4, markersize=3)
    (left, low), (right, top) = MM * run.model["outline"].min(axis=0), MM * run.model["outline"].max(axis=0)
    frame(whole, (left - 2, right + 2, low - 2, top + 2), "outline")
    frame(near, worn_limits(run, list(shots.values())[-1]), "where it is worn")
    draw_depths(run, profile, shots, colours)
    return drawn


def draw_depths(run, axes, shots, colours):
    """Worn depth along the new contour; shots: {label: snapshot}."""
    points, arc = contour(run.model["outline"], SPACING)
    # Particles do not fill the outline to its line.
    rough = gap(run, points)
    deepest = np.zeros(len(arc))
    for (label, shot), colour in zip(shots.items(), colours):
        depth = np.maximum(gap(run, points, shot) - rough, 0)
        axes.plot(MM * arc, MM * depth, color=colour, linewidth=1.4, label=label)
        deepest = np.fmax(deepest, depth)
    there = np.append(MM * arc[deepest > 0.02 * deepest.max()], [-5, 5])
    least = 0.1 if has_particles(run) else 1e-3
    axes.set(xlim=(there.min() - 2, there.max() + 2), ylim=(0, max(least, 1.1 * MM * deepest.max())),
             xlabel="arc length from the tip / mm", ylabel="mm", title="worn depth along the new contour")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, fontsize=8)

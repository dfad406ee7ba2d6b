"""Set-up of a cut in the plane: rock, what of it is fixed, the tool with its surface, motion, dimensions."""
import math

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockwear.report import palette
from rockwear.report.bodies import has_particles, in_plane, place, pose, tip, tool_loops
from rockwear.report.instants import turns
from rockwear.report.page import Section, number, quantity
from rockwear.report.plane import cut_limits
from rockwear.report.plots import MM, canvas, discs, frame, save


def set_up(run):
    """Section of the set-up."""
    if not in_plane(run):
        return None
    text = "Grey discs are held. The tool moves to the right; only its dark surface takes part in contact."
    if turns(run):
        text += (" Dashed: the path of the tip, an arc that the swing stretches to a cycloid. The free surface is the "
                 "path of the pick before.")
    return Section("Set-up", text, [save(run, "set_up", figure(run))])


def figure(run):
    """Rock and tool before the first step."""
    shot, model = run.snapshot(0), run.model
    limits = cut_limits(run) if turns(run) else everything(run, shot)
    drawn, (axes,) = canvas(10, 10 * (limits[3] - limits[2]) / (limits[1] - limits[0]) + 0.4)
    discs(axes, shot["rock_positions"], model["rock_radii"], linewidths=0.3, edgecolors=palette.ROCK_EDGE,
          facecolors=np.where(model["rock_fixed"][:, None], to_rgba(palette.FIXED), to_rgba(palette.ROCK)))
    draw_tool(run, axes, shot)
    marks = draw_turns(run, axes, shot, limits) if turns(run) else draw_straight_cut(run, axes, limits)
    frame(axes, limits)
    patches = [Patch(color=colour, label=label) for colour, label in (
        (palette.ROCK, "rock"), (palette.FIXED, "held"), (palette.TOOL_INSIDE, "tool"),
        (palette.TOOL_SURFACE, "its surface"))]
    axes.legend(handles=patches + marks, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return drawn


def everything(run, shot):
    """Limits in mm that hold rock, tool and the dimensions around them."""
    rock, outline = MM * shot["rock_positions"], MM * place(shot, run.model["outline"])
    rock = rock[np.isfinite(rock).all(axis=1)]
    low, high = (side(np.vstack([rock, outline]), axis=0) for side in (np.min, np.max))
    return low[0] - 6, high[0] + 14, low[1] - 14, high[1] + 8


def draw_tool(run, axes, shot):
    """The tool, its surface dark."""
    if not has_particles(run):
        for loop in tool_loops(run, shot):
            axes.fill(*MM * place(shot, loop).T, facecolor=palette.TOOL_INSIDE, edgecolor=palette.TOOL_SURFACE,
                      linewidth=2)
        return
    alive = np.flatnonzero(shot["alive"])
    surface = np.isin(alive, shot["surface"])
    discs(axes, place(shot, run.model["tool_positions"][alive]), run.model["tool_radii"][alive],
          facecolors=np.where(surface[:, None], to_rgba(palette.TOOL_SURFACE), to_rgba(palette.TOOL_INSIDE)))


def draw_straight_cut(run, axes, limits):
    """Depth of cut, the rock's dimensions, and the velocity."""
    width, height = MM * run.model["box"]
    depth = MM * run.parameter("depth_of_cut")
    if math.isfinite(depth):
        axes.axhline(height - depth, color=palette.PATH, linewidth=0.8, linestyle="--")
        arrow(axes, (0.9 * width, height - depth), (0.9 * width, height), f"depth of cut {depth:.3g} mm", shift=(-6, 0),
              ha="right", va="center", bbox={"color": palette.LABEL_BACK, "alpha": 0.85, "pad": 1})
    arrow(axes, (0, -5), (width, -5), f"{width:.4g} mm", shift=(0, -4), ha="center", va="top")
    arrow(axes, (width + 5, 0), (width + 5, height), f"{height:.4g} mm", shift=(5, 0), ha="left", va="center",
          rotation=90)
    top = limits[3] - 5
    arrow(axes, (0.08 * width, top), (0.35 * width, top), quantity(run.parameter("velocity"), "m/s"), "-|>", (0, -5),
          ha="center", va="top")
    return []


def draw_turns(run, axes, shot, limits):
    """Paths of the tip and of the pick before, the velocity on the path and that of the swing. -> marks for the
    legend."""
    model = run.model
    axes.plot(*MM * model["own_path"].T, color=palette.PATH, linestyle="--", linewidth=1.2)
    axes.plot(*MM * model["free_surface"].T, color=palette.PATH_BEFORE, linewidth=1.2)
    speed = run.parameter("angular_velocity") * run.parameter("cutter_radius")
    ahead = pose(shot).rotation @ (1.0, 0.0)
    begin = MM * pose(shot).of(tip(run)[None])[0] - (0, 22)
    arrow(axes, begin, begin + 50 * ahead, f"{number(speed)} m/s", "-|>", (6, -6), ha="left", va="top")
    left, top = limits[0] + 15, limits[3] - 10
    arrow(axes, (left, top), (left + 50, top), f"swing {quantity(run.parameter('swing'), 'm/s')}", "-|>", ha="center")
    return [Line2D([], [], color=palette.PATH, linestyle="--", label="path of the tip"),
            Line2D([], [], color=palette.PATH_BEFORE, label="path of the pick before")]


def arrow(axes, begin, end, text, style="<->", shift=(0, 5), **words):
    """A dimension, or a motion, between two points in mm, its text `shift` points from the middle."""
    axes.annotate("", end, begin, arrowprops={"arrowstyle": style, "shrinkA": 0, "shrinkB": 0})
    middle = (begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2
    axes.annotate(text, middle, shift, textcoords="offset points", **words)

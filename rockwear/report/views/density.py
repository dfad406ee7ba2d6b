"""Density map: how loose the rock is around each particle, in the plane and in space."""
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize

from rockwear.report import palette
from rockwear.report.bodies import has_tool, place, tool_loops
from rockwear.report.instants import course, course_in_space, moment
from rockwear.report.page import Section, number
from rockwear.report.plane import cut_limits
from rockwear.report.plots import MM, discs, frame, grid, save
from rockwear.report.solid import (
    READABLE, SIDE, paint, panels_without_axes, sphere_polygons, tool_polygons, whole_frame)

LOOSEST = 0.6
"""Density, over that of the whole rock, from which on colours differ."""


def density(run):
    """Section of the density map."""
    if not run.has("density", "rock_positions", "rock_radii"):
        return None
    control = number(run.parameter("control_radius"))
    figure = in_plane_figure(run) if "box" in run.model else in_space_figure(run)
    return Section("Density of the rock", (
        f"Mean density around each particle, within {control} of its radii, over that of the whole rock "
        "[Rojek 2003, eq. 7.9]. Cracks and chips are loose. At free surfaces, walls and the tool a part of the control "
        "volume holds no rock: with 3 radii the outermost particles show about 0.7."), [save(run, "density", figure)])


def relative(run, shot):
    """(n,) density over that of the whole rock."""
    return shot["density"] / run.parameter("rock_density")


def instants(run):
    """{label: snapshot}: of a cut its course, of a specimen begin and end."""
    if has_tool(run):
        return course(run) if "box" in run.model else course_in_space(run, 3)
    return {moment(run, k).split(", ")[-1]: k for k in sorted({0, len(run.times) - 1})}


def in_plane_figure(run):
    """The rock at several instants, with the tool."""
    shown = instants(run)
    if not shown:
        return None
    width, height = MM * run.model["box"]
    limits = cut_limits(run) if has_tool(run) else (-0.08 * width, 1.08 * width, -0.08 * width, height + 0.08 * width)
    figure, panels = grid(len(shown), 12, (limits[3] - limits[2]) / (limits[1] - limits[0]))
    for axes, (label, k) in zip(panels, shown.items()):
        shot = run.snapshot(k)
        painted = discs(axes, shot["rock_positions"], run.model["rock_radii"], array=relative(run, shot), linewidths=0,
                        norm=Normalize(LOOSEST, 1), cmap=palette.DENSITY)
        if has_tool(run):
            axes.add_collection(PolyCollection([MM * place(shot, loop) for loop in tool_loops(run, shot)],
                                               facecolors=palette.TOOL, edgecolors=palette.TOOL_SURFACE, zorder=4))
        frame(axes, limits, label)
    figure.colorbar(painted, ax=panels, label="density over that of the rock", shrink=0.8, extend="both")
    return figure


def in_space_figure(run):
    """Rock and tool cut open at the middle plane, at several instants."""
    shown = instants(run)
    norm = Normalize(LOOSEST, 1)
    figure, panels = panels_without_axes(12, 4, 1, max(len(shown), 2))
    for axes, (label, k) in zip(panels, shown.items()):
        shot = run.snapshot(k)
        places, radii = shot["rock_positions"], run.model["rock_radii"]
        slab = abs(places[:, 2] + radii) < 2 * radii
        rock = sphere_polygons(places[slab], radii[slab], palette.DENSITY(norm(relative(run, shot)[slab])), SIDE)
        if has_tool(run):
            tool = tool_polygons(run, shot, SIDE, cut_open=True)
            paint(axes, rock, tool, darkest=READABLE, frame=whole_frame(run, SIDE))
        else:
            paint(axes, rock, darkest=READABLE)
        axes.set_title(label)
    figure.colorbar(ScalarMappable(norm, palette.DENSITY), ax=panels, label="density over that of the rock", shrink=0.8,
                    extend="both")
    return figure

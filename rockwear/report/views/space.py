"""The cut in space: rock and tool in perspective, and from the side with the nearer half taken away."""
import numpy as np

from rockwear.report.bodies import has_tool, in_space, is_loose, rock_colours, words_on_rock
from rockwear.report.instants import course_in_space
from rockwear.report.page import Section, number
from rockwear.report.plots import MM, save
from rockwear.report.solid import ABOVE, SIDE, paint, panels_without_axes, sphere_polygons, tool_polygons, whole_frame


def perspective(run):
    """Section of the cut from above and in front."""
    if not shows(run):
        return None
    hidden = " The box's two nearer sides are not shown." if is_loose(run) else ""
    return Section("The cut in perspective", words_on_rock(run) + hidden, [save(run, "perspective", from_above(run))])


def side(run):
    """Section of the cut, open in its middle."""
    if not shows(run):
        return None
    return Section("The cut from the side", "The slab that the tool runs through, its nearer half taken away. "
                   + words_on_rock(run), [save(run, "side", cut_open(run))])


def shows(run):
    """True for a cut in space."""
    return has_tool(run) and in_space(run)


def from_above(run):
    """Rock and tool from above and in front."""
    figure, panels = panels_without_axes(11, 7.6, 2, 2)
    shown, radii = in_sight(run), run.model["rock_radii"]
    for axes, (label, k) in zip(panels, course_in_space(run).items()):
        shot = run.snapshot(k)
        paint(axes, sphere_polygons(shot["rock_positions"][shown], radii[shown], rock_colours(run, shot)[shown], ABOVE),
              tool_polygons(run, shot, ABOVE), edge=0.2, frame=whole_frame(run, ABOVE))
        axes.set_title(f"{label}, tip at {number(MM * shot['tool_offset'][0])} mm")
    return figure


def cut_open(run):
    """The slab that the tool runs through."""
    figure, panels = panels_without_axes(11, 6.8, 2, 2)
    radii = run.model["rock_radii"]
    for axes, (label, k) in zip(panels, course_in_space(run).items()):
        shot = run.snapshot(k)
        slab = slab_of(shot, radii)
        paint(axes, sphere_polygons(shot["rock_positions"][slab], radii[slab], rock_colours(run, shot)[slab], SIDE),
              tool_polygons(run, shot, SIDE, cut_open=True), frame=whole_frame(run, SIDE))
        axes.set_title(label)
    return figure


def slab_of(shot, radii):
    """(n,) bool: spheres of the rock at and just behind the middle plane."""
    z = shot["rock_positions"][:, 2]
    return (z < 0.5 * radii) & (z > -3 * radii)


def in_sight(run):
    """(n,) bool, rock to show from above: all but the two sides of a box that hide the loose fill."""
    radii, fixed = run.model["rock_radii"], run.model["rock_fixed"]
    width, _, depth = run.model["block"]
    x, _, z = run.snapshot(0)["rock_positions"].T
    hides = (z > 0.5 * depth - 2.5 * radii) | (x > width - 2.5 * radii)
    return ~fixed | ~hides if is_loose(run) else np.ones(len(radii), bool)

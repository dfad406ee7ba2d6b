"""Pictures of a cut in the plane: rock, cracks and tool in axes of mm."""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from rockwear.report import palette, shapes
from rockwear.report.bodies import gap, has_facets, place, rock_colours, rock_temperature, tip, tool_heat, tool_loops
from rockwear.report.instants import turns
from rockwear.report.plots import MM, closed, discs

TIP_WINDOW = 0.035
"""Half the width (m) of a picture of a pick's tip."""


class CutPicture:
    """Rock, cracks and tool in one axes; `show` another snapshot with the same artists."""

    def __init__(self, run, axes, shot, **style):
        self.run = run
        self.rock = discs(axes, shot["rock_positions"], run.model["rock_radii"], **style)
        self.cracks = LineCollection([], colors=palette.CRACK, linewidths=1.1, capstyle="round", zorder=3)
        self.tool = PolyCollection([], facecolors=palette.TOOL, edgecolors=palette.TOOL_SURFACE, linewidths=1, zorder=4)
        axes.add_collection(self.cracks)
        axes.add_collection(self.tool)
        self.show(shot)

    def show(self, shot):
        """Show this snapshot."""
        self.rock.set_offsets(MM * shot["rock_positions"])
        self.rock.set_facecolors(rock_colours(self.run, shot))
        broken = self.run.model["bonds"][shot["status"] != 0]
        self.cracks.set_segments(MM * shapes.cracks(shot["rock_positions"], self.run.model["rock_radii"], broken))
        self.tool.set_verts([MM * place(shot, loop) for loop in tool_loops(self.run, shot)])


def cut_limits(run):
    """Limits in mm that hold the rock as deep as it is broken, and the tool's tip on its way."""
    width, height = MM * run.model["box"]
    if turns(run):
        return -0.25 * width, 1.05 * width, -0.03 * height, height + 0.5 * MM * np.ptp(run.model["outline"][:, 1])
    depth = MM * run.parameter("depth_of_cut", 0.1 * run.model["box"][1])
    lowest = height - 2 * depth
    for k in run.stage_ends().values():
        shot = run.snapshot(k)
        broken = np.zeros(len(run.model["rock_radii"]), bool)
        broken[run.model["bonds"][shot["status"] != 0].ravel()] = True
        heights = MM * shot["rock_positions"][broken, 1]
        lowest = min(lowest, *heights[np.isfinite(heights)].tolist(), height)
    return -0.12 * width, 1.03 * width, max(lowest - 0.5 * depth, -0.02 * height), height + 2 * depth


def tip_limits(run):
    """Limits in mm, in the tool's own frame, of a picture of the tip."""
    x, y = MM * tip(run)
    width = MM * min(TIP_WINDOW, 0.5 * np.ptp(run.model["outline"], axis=0).max())
    below = min(4, 0.25 * width)
    return x - 1.2 * width, x + 0.8 * width, y - below, y + 2 * width - below


def worn_limits(run, shot):
    """Limits in mm, in the tool's own frame, around most of what is removed or clearly worn; around the tip if nothing
    is."""
    lowest, worn = MM * tip(run), MM * worn_places(run, shot)
    if len(worn):
        away = np.linalg.norm(worn - lowest, axis=1)
        worn = worn[away <= np.percentile(away, 85)]
    # Of small tools less is shown.
    around, margin = np.minimum([3.0, 2.0], np.array([0.15, 0.1]) * MM * np.ptp(run.model["outline"][:, 1]))
    points = np.vstack([worn, lowest - around, lowest + around])
    (left, bottom), (right, top) = points.min(axis=0) - margin, points.max(axis=0) + margin
    aside = max(0.0, 0.8 * (top - bottom) - (right - left)) / 2
    return left - aside, right + aside, bottom, top


def worn_places(run, shot):
    """(n, 2) m in the tool's own frame: where particles are gone or clearly worn, or where facets were."""
    model = run.model
    if has_facets(run):
        depth = gap(run, model["tool_vertices"], shot)
        return model["tool_vertices"][depth > 0.05 * depth.max()]
    return model["tool_positions"][~shot["alive"] | (shot["worn_depth"] > 0.5 * model["tool_radii"].max())]


def draw_new_outline(run, axes, **style):
    """The outline of the new tool, in its own frame."""
    axes.plot(*MM * closed(run.model["outline"]).T, **{"color": palette.OUTLINE, "linewidth": 0.8, **style})


def paint_temperature(axes, run, shot, cold, norm):
    """Rock and tool by their rise above `cold`, and the outline of the new tool."""
    edge = {"edgecolors": palette.HEAT_EDGE, "linewidths": 0.2, "norm": norm, "cmap": palette.TEMPERATURE}
    painted = discs(axes, shot["rock_positions"], run.model["rock_radii"],
                    array=np.maximum(rock_temperature(run, shot) - cold, norm.vmin), **edge)
    positions, radii, kelvin = tool_heat(run, shot)
    discs(axes, place(shot, positions), radii, array=np.maximum(kelvin - cold, norm.vmin), **edge)
    axes.plot(*MM * closed(place(shot, run.model["outline"])).T, color=palette.OUTLINE, linewidth=0.6, alpha=0.5)
    return painted

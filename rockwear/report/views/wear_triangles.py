"""Wear of a tool of triangles in space: worn depth on the tool, and its section in the middle plane."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from rockwear.kernels.boundary import distance
from rockwear.report import palette, shapes
from rockwear.report.bodies import facet_depth, has_facets, in_space, keeps_shape
from rockwear.report.instants import moment, spread
from rockwear.report.page import Section
from rockwear.report.plots import MM, frame, save


def wear_triangles(run):
    """Section of the worn depth on the tool."""
    if not has_facets(run) or not in_space(run) or not run.result("maximum_wear_depth") > 0:
        return None
    words = ("How far each triangle would have gone back, volume over area: the shape is kept." if keeps_shape(run) else
             "How far the surface has gone back: the way from each triangle, as it is, to the nearest point of the new "
             "surface. Below: the section in the middle plane as it was and as it became.")
    return Section("Wear of the tool", words, [save(run, "worn_triangles", figure(run))])


def figure(run):
    """The tool at the end, coloured by its worn depth, and what has become of its outline."""
    shot = run.snapshot(-1)
    facets, depth = shot["tool_facets"], MM * facet_depth(run, shot)
    norm = Normalize(0, depth.max())
    rows = 1 if keeps_shape(run) else 2
    drawn = Figure(figsize=(12, 4.6 * rows), layout="constrained")
    seen = [drawn.add_subplot(rows, 2, k, projection="3d") for k in (1, 2)]
    for axes, (elevation, title) in zip(seen, ((15, "from in front"), (-35, "from in front and below"))):
        draw_solid(axes, shot["tool_vertices"], facets, palette.WEAR(norm(depth))[:, :3])
        axes.view_init(elevation, -40)
        axes.set_title(title)
    drawn.colorbar(ScalarMappable(norm, palette.WEAR), ax=seen, label="worn depth / mm", shrink=0.7)
    if rows == 2:
        draw_sections(run, [drawn.add_subplot(2, 2, k) for k in (3, 4)])
    return drawn


def draw_solid(axes, vertices, facets, colours):
    """Triangles in a perspective view, shaded by their slope; y is drawn upwards."""
    corners = MM * vertices[:, [0, 2, 1]] * (1, -1, 1)
    normal = np.cross(*np.diff(corners[facets], axis=1).transpose(1, 0, 2))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    light = 0.92 + 0.08 * normal @ (0.64, -0.48, 0.6)
    axes.add_collection3d(Poly3DCollection(corners[facets], facecolors=colours * light[:, None],
                                           edgecolors=palette.FACET_EDGE, linewidths=0.4))
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low)
    axes.axis("off")


def draw_sections(run, panels):
    """The tool's section in its middle plane, new and at instants of the run: whole, and where it wears."""
    first, facets = run.model["tool_vertices"], run.model["tool_facets"]
    # Beside the plane that many vertices lie in.
    middle = 1e-6 * np.ptp(first[:, 2])
    numbers = spread(range(len(run.times)), 5)[1:]
    for axes in panels:
        new = MM * shapes.section(first, facets, middle)
        axes.add_collection(LineCollection(new, color=palette.OUTLINE, linestyle="--", linewidth=1, zorder=5,
                                           label="new"))
        for k, colour in zip(numbers, palette.sequence(len(numbers))):
            shot = run.snapshot(k)
            lines = MM * shapes.section(shot["tool_vertices"], shot["tool_facets"], middle)
            axes.add_collection(LineCollection(lines, color=colour, linewidth=1.6, label=moment(run, k)))
    last = run.snapshot(-1)
    depth = distance(first, last["tool_vertices"], last["tool_facets"])
    near = MM * first[depth > 0.1 * depth.max()]
    for axes, points, title in zip(panels, (MM * first, near), ("section in the middle plane", "where it is worn")):
        (left, low), (right, high) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        frame(axes, (left - 3, right + 3, low - 3, high + 3), title)
    panels[1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))

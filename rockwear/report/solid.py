"""Pictures of rock and tool in space, drawn as polygons seen from one direction, the farthest first."""
import math

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from rockwear.report import palette
from rockwear.report.bodies import has_particles, place
from rockwear.report.plots import MM, canvas

CORNERS = 14
"""Of the polygon that stands for a sphere."""
SIDE, FRONT, ABOVE, BELOW = (0.0, 0.0), (50.0, 12.0), (32.0, 28.0), (55.0, -25.0)
"""Where one looks from: azimuth from the side to the front and elevation, degrees."""
READABLE = 0.92
"""Brightness of the farthest piece of a picture whose colours are to be read from a scale."""


def panels_without_axes(*size):
    """A canvas whose panels are empty until something is painted: a short run has fewer instants than panels."""
    figure, panels = canvas(*size)
    for axes in panels:
        axes.axis("off")
    return figure, panels


def axes_of_view(view):
    """(3, 3): the directions to the right, upwards and towards the eye, as rows, of a view in degrees."""
    a, e = np.radians(view)
    return np.array([[math.cos(a), 0, -math.sin(a)],
                     [-math.sin(a) * math.sin(e), math.cos(e), -math.cos(a) * math.sin(e)],
                     [math.sin(a) * math.cos(e), math.sin(e), math.cos(a) * math.cos(e)]])


def sphere_polygons(positions, radii, colours, view):
    """(nearness (n,), polygons, colours (n, 3)) of spheres; colours: one of all, or (n, 3) or (n, 4)."""
    turned = positions @ axes_of_view(view).T
    angle = np.linspace(0, 2 * math.pi, CORNERS, endpoint=False)
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    polygons = turned[:, None, :2] + radii[:, None, None] * rim
    colours = np.tile(to_rgb(colours), (len(radii), 1)) if isinstance(colours, str) else np.asarray(colours)[:, :3]
    return turned[:, 2], list(polygons), colours


def facet_polygons(vertices, facets, view):
    """The same of the tool's triangles that face the eye, shaded by their slope."""
    turned = vertices @ axes_of_view(view).T
    corners = turned[facets]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    seen = normal[:, 2] > 0
    light = 0.55 + 0.45 * np.clip(normal[seen] @ (0.3, 0.6, 0.74), 0, 1)
    return corners[seen, :, 2].mean(axis=1), list(corners[seen, :, :2]), light[:, None] * np.array(to_rgb(palette.TOOL))


def tool_polygons(run, shot, view, *, cut_open=False):
    """Polygons of the tool where it is: its triangles, or the particles of its surface and where it is mounted; of a
    tool cut open at its middle plane, the particles behind that."""
    if not has_particles(run):
        return facet_polygons(place(shot, shot["tool_vertices"]), shot["tool_facets"], view)
    shown = np.zeros(len(run.model["tool_radii"]), bool)
    shown[shot["surface"]] = True
    shown |= run.model["tool_fixed"] & shot["alive"]
    if cut_open:
        shown = shot["alive"] & behind_middle(run.model["tool_positions"], run.model["tool_radii"])
    places = place(shot, run.model["tool_positions"])
    return sphere_polygons(places[shown], run.model["tool_radii"][shown], palette.TOOL, view)


def behind_middle(positions, radii, thick=2.5):
    """(n,) bool: the spheres just behind the middle plane, in a slab of so many radii."""
    return (positions[:, 2] < 0) & (positions[:, 2] > -thick * radii)


def paint(axes, *parts, edge=0.35, frame=None, darkest=0.72):
    """Polygons, the farthest first and darker, in axes of mm; frame: (n, 2) m, what must be seen, all if None; darkest:
    brightness of the farthest, near 1 where colours are to be read from a scale."""
    depth = np.concatenate([part[0] for part in parts])
    polygons = [polygon for part in parts for polygon in part[1]]
    colours = np.vstack([part[2] for part in parts])
    order = np.argsort(depth, kind="stable")
    nearness = (depth - depth.min(initial=np.inf)) / max(depth.max(initial=-np.inf) - depth.min(initial=np.inf), 1e-12)
    colours = (colours * (darkest + (1 - darkest) * nearness)[:, None])[order]
    axes.add_collection(PolyCollection([MM * polygons[k] for k in order], facecolors=colours, edgecolors=0.6 * colours,
                                       linewidths=edge))
    points = MM * (np.concatenate([p[:: max(1, len(p) // 4)] for p in polygons]) if frame is None else frame)
    low, high = points.min(axis=0), points.max(axis=0)
    axes.set(xlim=(low[0] - 5, high[0] + 5), ylim=(low[1] - 5, high[1] + 5), aspect="equal")
    axes.axis("off")


def whole_frame(run, view):
    """(n, 2) m: corners of the block and the tool at the first and the last instant, as seen."""
    width, height, depth = run.model["block"]
    corners = [np.array([x, y, z]) for x in (0, width) for y in (0, height) for z in (-depth / 2, depth / 2)]
    tool = run.model["tool_positions"] if has_particles(run) else run.model["tool_vertices"]
    places = [place(run.snapshot(k), tool) for k in (0, -1)]
    return np.vstack([*corners, *places]) @ axes_of_view(view).T[:, :2]

"""Wear of a tool of segments in the plane: worn volume along its outline, and where on the tool."""
import numpy as np

from rockwear.kernels.boundary import area_vectors
from rockwear.kernels.polygon import contour, nearest_arc
from rockwear.report import palette, shapes
from rockwear.report.bodies import has_facets, in_plane, keeps_shape
from rockwear.report.instants import worn
from rockwear.report.page import Section
from rockwear.report.plots import MM, canvas, frame, save


def wear_segments(run):
    """Section of the wear along the tool."""
    if not has_facets(run) or not in_plane(run) or not run.has("worn_volume"):
        return None
    kept = " The tool keeps its shape." if keeps_shape(run) else ""
    return Section("Wear along the tool", "Volume worn off each segment so far, over its length when new, along the "
                   "new outline: zero at the tip, positive up the front; a tall single segment is one contact "
                   f"that slid under load. Right: the same, at the end, as a band on the tool.{kept}",
                   [save(run, "wear", figure(run))])


def along(run):
    """Middles (m, 2) m of the segments, their lengths (m,) m, outward normals, and arc length (m,) m from the tip."""
    vertices, facets = run.model["tool_vertices"], run.model["tool_facets"]
    middle, normal = vertices[facets].mean(axis=1), area_vectors(vertices, facets)
    length = np.linalg.norm(normal, axis=1)
    arc = nearest_arc(middle, *contour(vertices[shapes.loop(facets)], 1e-4))
    return middle, length, normal / length[:, None], arc


def figure(run):
    """Depth worn off along the outline at several stages, and on the tool."""
    middle, length, normal, arc = along(run)
    free = ~run.model.get("tool_fixed", np.zeros(len(arc), bool))
    drawn, (profile, band) = canvas(12, 5.4, 1, 2)
    depth = draw_profile(run, profile, arc, length, free)
    new = run.model["tool_vertices"][shapes.loop(run.model["tool_facets"])]
    band.fill(*MM * new.T, facecolor=palette.TOOL_UNWORN, edgecolor=palette.OUTLINE, linewidth=0.8)
    if depth.max() > 0:
        scale = 0.25 * np.ptp(new[:, 1]) / depth.max()
        for k in np.flatnonzero(free & (depth > 0)):
            end = middle[k] + normal[k] * depth[k] * scale
            band.plot(*MM * np.array([middle[k], end]).T, color=palette.WORN, linewidth=1.6)
    low, high = MM * new.min(axis=0), MM * new.max(axis=0)
    frame(band, (low[0] - 4, high[0] + 22, low[1] - 18, high[1] + 3), "where wear falls")
    return drawn


def draw_profile(run, axes, arc, length, free):
    """Worn volume over the new length (µm) at several stages, over arc length. -> (m,) µm at the last of them."""
    order = np.argsort(arc)
    order = order[free[order]]
    shown = worn(run, 8)
    for (label, k), colour in zip(shown.items(), palette.sequence(len(shown))):
        depth = 1e6 * run.snapshot(k)["worn_volume"] / length
        axes.step(MM * arc[order], depth[order], where="mid", color=colour, linewidth=1.4, label=label)
    there = MM * arc[order][depth[order] > 0.01 * depth.max()]
    left, right = (there.min(), there.max()) if len(there) else (-5, 5)
    axes.set(xlim=(left - 3, right + 3), ylim=(0, None), xlabel="arc length from the tip / mm",
             ylabel="worn volume over the new length / µm")
    axes.axvline(0, color=palette.GUIDE, linewidth=0.8, linestyle=":")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, fontsize=8)
    return depth

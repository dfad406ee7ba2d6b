"""Figures of a cut with a tool of segments: the cut, where wear falls along the tool, its outlines, and the history."""
import numpy as np
from matplotlib import colormaps

from rockwear.kernels.boundary import distance
from rockwear.kernels.polygon import contour, nearest_arc
from rockwear.report import shapes
from rockwear.report.cutting import (
    CRACK, cut, draw_cracks, draw_energy, draw_forces, moving_picture, summary_line, trusted, worn_stages)
from rockwear.report.page import Section, machine_tiles, percent, quantity, tiles
from rockwear.report.plots import MM, MS, balances, canvas, frame, mark_stages, save, working_hours


def shows(run):
    """True for a run with rock, segments and at least one snapshot."""
    return bool({"tool_facets", "rock_radii", "bonds"} <= run.model.keys() and len(run.times))


def sections(run):
    """The sections of the page, in order."""
    def drawn(figure):
        return save(run, figure.__name__, figure(run))

    return [
        Section("Key results", summary_line(run), [key_results(run)]),
        Section("Failure", "Red: broken bonds, drawn across the bond where its discs are still near each other. Blue: "
                "chips, which no chain of bonds joins to the support. The darker a disc, the more of its bonds are gone.",
                [drawn(cut), moving_picture(run)]),
        Section("Wear along the tool", "Volume worn off each segment so far, over its length when new, along the new outline: "
                "zero at the lowest point, positive up the front; a tall single segment is one contact that slid under "
                "load. Right: the same, at the end, as a band on the tool.", [drawn(wear)]),
        *trusted(run),
        *([Section("Shape of the tool", "Dashed: the new tool. Each point is a vertex.", [drawn(shape)])]
          if run.parameter("reshape", False) else []),
        Section("History", "Thin lines are the record, thick ones a running mean.", [drawn(history)]),
        balances(run)]


def key_results(run):
    """The numbers an engineer looks for first."""
    def tile(label, name, unit, remark=""):
        return label, quantity(run.result(name), unit), remark

    energy = run.summary.get("balances", {}).get("energy", {})
    return tiles([
        tile("mean cutting force", "mean_cutting_force", "N/m"), tile("peak cutting force", "peak_cutting_force", "N/m"),
        tile("mean thrust force", "mean_thrust_force", "N/m"), tile("specific energy", "specific_energy", "J/m3"),
        *([tile("worn volume", "worn_volume", "m3/m", "by the wear law"),
           tile("maximum wear depth", "maximum_wear_depth", "m", "of the surface, from the new to the worn one"),
           ("mass lost", percent(run.result("mass_lost"), 1.0), ""),
           ("recession over slip", quantity(run.result("recession_per_slip"), "-"), "wear is relieved where it is not small")]
          if run.parameter("reshape", False) else
          [tile("worn volume", "worn_volume", "m3/m", "by the wear law; the shape is kept"),
           tile("maximum wear depth", "maximum_wear_depth", "m", "that a segment would go back")]),
        ("cracks", f"{run.result('tensile_cracks')} + {run.result('shear_cracks')}", "tensile + shear, at the end"),
        ("energy residual", percent(energy.get("residual", np.nan), energy.get("tool_work", 0.0)), "of the tool's work"),
        *machine_tiles(run)])


def along(run):
    """Middles (m, 2) m of the segments, their lengths (m,) m, outward normals, and arc length (m,) m from the tip."""
    vertices, facets = run.model["tool_vertices"], run.model["tool_facets"]
    begin, end = vertices[facets[:, 0]], vertices[facets[:, 1]]
    way = end - begin
    length = np.linalg.norm(way, axis=1)
    middle = 0.5 * (begin + end)
    arc = nearest_arc(middle, *contour(vertices[shapes.loop(facets)], 1e-4))
    return middle, length, np.column_stack([way[:, 1], -way[:, 0]]) / length[:, None], arc


def wear(run):
    """Depth worn off along the outline at several stages, and on the tool."""
    middle, length, normal, arc = along(run)
    free = ~run.model["tool_fixed"]
    order = np.argsort(arc)
    order = order[free[order]]
    shown = worn_stages(run, 8)
    figure, (profile, axes) = canvas(12, 5.4, 1, 2)
    for (label, k), colour in zip(shown.items(), colormaps["plasma"](np.linspace(0, 0.85, len(shown)))):
        worn_volume = run.snapshot(k)["worn_volume"]
        depth = 1e6 * worn_volume / length
        profile.step(MM * arc[order], depth[order], where="mid", color=colour, linewidth=1.4,
                     label=label)
    worn = MM * arc[order][depth[order] > 0.01 * depth.max()]
    left, right = (worn.min(), worn.max()) if len(worn) else (-5, 5)
    profile.set(xlim=(left - 3, right + 3), xlabel="arc length from the tip / mm", ylabel="worn volume over the new length / µm")
    profile.axvline(0, color="#999999", linewidth=0.8, linestyle=":")
    profile.legend(loc="upper left")
    model = run.model["tool_vertices"][shapes.loop(run.model["tool_facets"])]
    axes.fill(*MM * model.T, facecolor="#dfe3e6", edgecolor="black", linewidth=0.8)
    if depth.max() > 0:
        scale = 0.25 * np.ptp(model[:, 1]) / depth.max()
        for k in np.flatnonzero(free & (depth > 0)):
            tip = middle[k] + normal[k] * depth[k] * scale
            axes.plot(*MM * np.array([middle[k], tip]).T, color=CRACK, linewidth=1.6)
    low, high = MM * model.min(axis=0), MM * model.max(axis=0)
    frame(axes, (low[0] - 4, high[0] + 22, low[1] - 18, high[1] + 3), "where wear falls")
    return figure


def closed(vertices, facets):
    """(m + 1, 2) m, the outline that segments make, its first corner again at its end."""
    loop = shapes.loop(facets)
    return vertices[np.append(loop, loop[0])]


def shape(run):
    """Outlines at the end of each stage: the whole tool, and where it is worn."""
    facets, first = run.model["tool_facets"], run.model["tool_vertices"]
    shown = worn_stages(run, 8)
    figure, panels = canvas(12, 6, 1, 2)
    last = run.snapshot(-1)
    moved = distance(first, last["tool_vertices"], last["tool_facets"])
    near = MM * first[moved > 0.02 * moved.max()] if moved.any() else MM * first[[first[:, 1].argmin()]]
    for axes in panels:
        axes.plot(*MM * closed(first, facets).T, color="black", linewidth=1, linestyle="--")
        for (label, k), colour in zip(shown.items(), colormaps["plasma"](np.linspace(0, 0.85, len(shown)))):
            shot = run.snapshot(k)
            axes.plot(*MM * closed(shot["tool_vertices"], shot["tool_facets"]).T, ".-", color=colour, linewidth=1.2, markersize=3,
                      label=label)
    (left, low), (right, top) = MM * first.min(axis=0), MM * first.max(axis=0)
    frame(panels[0], (left - 2, right + 2, low - 2, top + 2), "outline")
    frame(panels[1], (near[:, 0].min() - 2, near[:, 0].max() + 2, near[:, 1].min() - 2, near[:, 1].max() + 2), "worn part")
    panels[1].legend(loc="upper left")
    return figure


def history(run):
    """Forces, energy, cracks and wear over time."""
    time = MS * run.column("time")
    if not len(time):
        return None
    figure, panels = canvas(12, 9.6, 4, sharex=True)
    for draw, axes in zip((draw_forces, draw_energy, draw_cracks), panels):
        draw(run, axes, time)
    panels[3].plot(time, run.column("worn_volume"), color=CRACK, label="worn by the wear law")
    panels[3].set_ylabel("m³/m")
    panels[3].legend(loc="upper left")
    working_hours(run, panels[3], time)
    for axes in panels:
        mark_stages(run, axes, named=axes is panels[0])
    panels[-1].set(xlabel="time / ms", xlim=(0, time.max() or 1))
    return figure

"""Wear of a tool of particles in space: worn depth over the surface and over the height, and the particles removed."""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from rockwear.report import palette, published
from rockwear.report.bodies import has_particles, in_space
from rockwear.report.instants import moment, spread
from rockwear.report.page import Section
from rockwear.report.plots import MM, canvas, legend, save
from rockwear.report.solid import BELOW, FRONT, READABLE, SIDE, paint, panels_without_axes, sphere_polygons


def wear_spheres(run):
    """Section of the worn depth on the tool."""
    if not shows(run):
        return None
    return Section("Wear of the tool", "Depth worn off each particle that is left: volume over the square that it "
                   "shows.", [save(run, "wear", depth_figure(run)), save(run, "wear_over_height", height_figure(run))])


def stages_of_wear(run):
    """Section of the tool's shape as it loses particles."""
    if not shows(run) or run.snapshot(-1)["alive"].all():
        return None
    return Section("Shape of the tool at stages, and the particles removed", "Red: removed particles, where they were.",
                   [save(run, "stages_of_wear", stages_figure(run))])


def shows(run):
    """True for a tool of particles in space that wore."""
    return has_particles(run) and in_space(run) and bool(run.result("worn_volume") > 0)


def paint_surface(axes, run, shot, norm, view):
    """The tool's surface in the colour of its worn depth."""
    surface = shot["surface"]
    colours = palette.WEAR(norm(MM * shot["worn_depth"][surface]))
    paint(axes, sphere_polygons(run.model["tool_positions"][surface], run.model["tool_radii"][surface], colours, view),
          edge=0.15, darkest=READABLE)


def depth_figure(run):
    """Worn depth at the end, from three sides."""
    shot = run.snapshot(-1)
    norm = Normalize(0, max(MM * float(shot["worn_depth"].max()), 1e-12))
    figure, panels = panels_without_axes(11, 4.6, 1, 3)
    views = {"from the side": SIDE, "from in front": FRONT, "from in front and below": BELOW}
    for axes, (title, view) in zip(panels, views.items()):
        paint_surface(axes, run, shot, norm, view)
        axes.set_title(title)
    figure.colorbar(ScalarMappable(norm, palette.WEAR), ax=panels, label="worn depth / mm", shrink=0.7)
    return figure


def height_figure(run):
    """Largest and mean worn depth of the surface particles, over the height above the tip."""
    shot, places, radius = run.snapshot(-1), run.model["tool_positions"], float(run.model["tool_radii"][0])
    surface = shot["surface"]
    row = np.floor(places[surface, 1] / (2 * radius)).astype(int)
    depth = MM * shot["worn_depth"][surface]
    rows = np.array([k for k in np.unique(row) if depth[row == k].any()])
    if not len(rows):
        return None
    height = MM * 2 * radius * (rows + 0.5)
    figure, (axes,) = canvas(9, 3.4)
    axes.plot(height, [depth[row == k].max() for k in rows], "o-", color=palette.LARGEST, markersize=4, label="largest")
    axes.plot(height, [depth[row == k].mean() for k in rows], "o-", color=palette.MEAN, markersize=4, label="mean")
    if run.parameter("removal", "") == "none":
        axes.axhline(MM * published.value("m-13.3-depth"), color=palette.PUBLISHED, linestyle="--", linewidth=1,
                     label="largest of\n[Rojek 2003, 13.3]")
    axes.set(xlabel="height above the tip / mm", ylabel="worn depth / mm", yscale="log", ylim=(1e-3, None),
             xlim=(0, None))
    legend(axes)
    return figure


def stages_figure(run):
    """What is left of the tool at stages of the cut, coloured by its wear, and what was removed."""
    radii, places = run.model["tool_radii"], run.model["tool_positions"]
    norm = Normalize(0, MM * 2 * float(radii[0]))
    figure, panels = panels_without_axes(11, 7.2, 2, 4)
    for above, below, k in zip(panels[:4], panels[4:], spread(range(len(run.times)), 4)):
        shot = run.snapshot(k)
        paint_surface(above, run, shot, norm, FRONT)
        above.set_title(moment(run, k))
        gone, surface = ~shot["alive"], shot["surface"]
        parts = [sphere_polygons(places[surface], radii[surface], palette.TOOL_INSIDE, FRONT)]
        if gone.any():
            # Drawn nearer than they were, so that none is hidden by the tool.
            nearness, polygons, colours = sphere_polygons(places[gone], radii[gone], palette.CRACK, FRONT)
            parts.append((nearness + np.ptp(places[:, 0]), polygons, colours))
        paint(below, *parts, edge=0.15)
        below.set_title(f"{int(gone.sum())} removed")
    figure.colorbar(ScalarMappable(norm, palette.WEAR), ax=panels, label="worn depth of what is left / mm", shrink=0.5)
    return figure

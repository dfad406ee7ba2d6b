"""Figures of a cut in space: rock and tooth from the side and in perspective, forces, wear on the tooth, its shape."""
import math

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from rockwear.kernels.boundary import area_vectors, distance
from rockwear.report import shapes
from rockwear.report.cutting import CRACK, DAMAGE, LOOSE, PALE, STEEL, SUPPORT, trusted
from rockwear.report.page import Section, machine_tiles, number, percent, quantity, tiles
from rockwear.report.plots import MM, balances, canvas, frame as limits, running_mean, save, spread

CORNERS = 14
"""Of the polygon that stands for a sphere."""
SIDE, ABOVE, BELOW = (0.0, 0.0), (32.0, 28.0), (55.0, -25.0)
"""Where one looks from: azimuth from the side to the front and elevation, degrees."""
WEAR = LinearSegmentedColormap.from_list("wear", ["#d9dde0", "#fdd873", "#f58a3c", "#c8252c", "#54093a"])
M_DEPTH = 0.14e-3
"""m, maximum wear depth of M 13.3 (model II)."""
WORN_DEPTH = {
    "particles": "Depth worn off each particle that is left: volume over the square that it shows.",
    "triangles": "How far the surface has gone back: the way from each triangle, as it is, to the nearest point of the new "
                 "surface. Below: the section in the middle plane as it was and as it became.",
    "kept triangles": "How far each triangle would have gone back, volume over area: the shape is kept."}
"""What the colour of wear means."""


def shows(run):
    """True for a run in a block of spheres with at least one snapshot."""
    return "block" in run.model and len(run.times) > 0


def sections(run):
    """The sections of the page, in order."""
    def drawn(figure):
        return save(run, figure.__name__, figure(run))

    rock = ("Colour: how far each sphere has moved; grey ones are held, those at the near sides not shown." if loose(run) else
            "Blue: pieces that no chain of bonds joins to the support. The darker a sphere, the more of its bonds are "
            "gone. Grey: held.")
    return [
        Section("Key results", summary_line(run), [key_results(run)]),
        Section("The cut in perspective", rock, [drawn(perspective)]),
        Section("The cut from the side", f"The slab that the tooth runs through, its nearer half taken away. {rock}", [drawn(side)]),
        Section("Forces, work and wear over time", "Thin lines are the record, thick ones a running mean.", [drawn(forces)]),
        Section("Wear of the tooth", WORN_DEPTH[made_of(run)],
                [drawn(wear), drawn(wear_over_height), drawn(worn_triangles)]),
        Section("Shape of the tooth at stages, and the particles removed", "Red: removed particles, where they were.",
                [drawn(stages_of_wear)]),
        *trusted(run),
        balances(run)]


def loose(run):
    """True where nothing was ever bonded."""
    return len(run.model["bonds"]) == 0


def has_particles(run):
    """True for a tooth of particles."""
    return "tool_positions" in run.model


def made_of(run):
    """What the tooth is made of and wears as."""
    return "particles" if has_particles(run) else "triangles" if run.parameter("reshape", False) else "kept triangles"


# ---- numbers

def summary_line(run):
    """The run in a line."""
    def value(name, unit):
        return quantity(run.parameter(name, math.nan), unit)

    return (f"{value('velocity', 'm/s')}, depth of cut {value('depth_of_cut', 'm')}, "
            f"{quantity(run.result('simulated_time'), 's')} simulated, radii {number(run.result('scale_factor'))} times those "
            "of the source.")


def key_results(run):
    """The numbers an engineer looks for first."""
    energy = run.summary.get("balances", {}).get("energy", {})
    step, critical = run.result("time_step"), run.result("critical_time_step")
    wears = run.result("worn_volume") > 0
    if has_particles(run):
        tool = f"{run.result('tool_particles')} particles"
        depth_remark, mass_remark = f"M 13.3: {quantity(M_DEPTH, 'm')}", f"{run.result('particles_removed')} particles removed"
    else:
        tool = f"{run.result('facets')} triangles"
        depth_remark, mass_remark = "of the surface", f"{quantity(run.result('worn_volume'), 'm3')} by the wear law"
    return tiles([
        *[(label, quantity(run.result(name), "N"), "while it cuts") for label, name in (
            ("mean cutting force", "mean_cutting_force"), ("peak cutting force", "peak_cutting_force"),
            ("mean thrust force", "mean_thrust_force"))],
        *([("maximum wear depth", quantity(run.result("maximum_wear_depth"), "m"), depth_remark),
           ("mass lost", percent(run.result("mass_lost"), 1.0), mass_remark)] if wears else []),
        *([] if loose(run) else [("cracks", f"{run.result('tensile_cracks')} + {run.result('shear_cracks')}", "tensile + shear")]),
        ("spheres of rock", number(run.result("rock_particles")), f"tooth: {tool}"),
        ("time step", f"{number(1e6 * step)} µs", f"{percent(step, critical)} of the critical"),
        ("energy residual", percent(energy.get("residual", math.nan), energy.get("tool_work", 0.0)), "of the tool's work"),
        *machine_tiles(run)])


# ---- drawing in space

def axes_of_view(view):
    """(3, 3): the directions to the right, upwards and towards the eye, as rows, of a view in degrees."""
    a, e = np.radians(view)
    return np.array([[math.cos(a), 0, -math.sin(a)], [-math.sin(a) * math.sin(e), math.cos(e), -math.cos(a) * math.sin(e)],
                     [math.sin(a) * math.cos(e), math.sin(e), math.cos(a) * math.cos(e)]])


def sphere_polygons(positions, radii, colours, view):
    """[(nearness, polygon, colour)] of spheres."""
    turned = positions @ axes_of_view(view).T
    angle = np.linspace(0, 2 * math.pi, CORNERS, endpoint=False)
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    polygons = turned[:, None, :2] + radii[:, None, None] * rim
    return turned[:, 2], list(polygons), np.asarray(colours)[:, :3]


def facet_polygons(vertices, facets, view, colour=STEEL):
    """The same of triangles that face the eye, shaded by their slope."""
    turned = vertices @ axes_of_view(view).T
    corners = turned[facets]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    seen = normal[:, 2] > 0
    light = 0.55 + 0.45 * np.clip(normal[seen] @ (0.3, 0.6, 0.74), 0, 1)
    return corners[seen, :, 2].mean(axis=1), list(corners[seen, :, :2]), light[:, None] * np.array(to_rgb(colour))


def paint(axes, *parts, edge=0.35, frame=None):
    """Polygons, the farthest first and darker, in axes of mm; frame: (n, 2) m, what must be seen, all if None."""
    depth = np.concatenate([part[0] for part in parts])
    polygons = [polygon for part in parts for polygon in part[1]]
    colours = np.vstack([part[2] for part in parts])
    order = np.argsort(depth, kind="stable")
    shade = 0.72 + 0.28 * (depth - depth.min()) / max(np.ptp(depth), 1e-12)
    colours = (colours * shade[:, None])[order]
    axes.add_collection(PolyCollection([MM * polygons[k] for k in order], facecolors=colours, edgecolors=0.6 * colours,
                                       linewidths=edge))
    points = MM * (np.concatenate([p[:: max(1, len(p) // 4)] for p in polygons]) if frame is None else frame)
    low, high = points.min(axis=0), points.max(axis=0)
    axes.set(xlim=(low[0] - 5, high[0] + 5), ylim=(low[1] - 5, high[1] + 5), aspect="equal")
    axes.axis("off")


def rock_colours(run, shot):
    """(n, 3) of the rock's spheres."""
    model, fixed = run.model, run.model["rock_fixed"]
    if loose(run):
        moved = np.linalg.norm(shot["rock_positions"] - run.snapshot(settled(run))["rock_positions"], axis=1)
        colours = colormaps["YlOrBr"](np.clip(moved / (4 * model["rock_radii"]), 0.08, 0.9))[:, :3]
    else:
        bonds, gone = model["bonds"], shot["status"] != 0
        count = len(fixed)
        every = np.bincount(bonds.ravel(), minlength=count)
        broken = np.bincount(bonds[gone].ravel(), minlength=count) / np.maximum(every, 1)
        colours = DAMAGE(broken)[:, :3]
        chip = shapes.chips(count, bonds, ~gone, fixed)
        colours[chip] = LOOSE(broken[chip])[:, :3]
    colours[fixed] = to_rgb(SUPPORT)
    return colours


def settled(run):
    """Number of the snapshot at which the fill has come to rest."""
    return run.stage_ends()[0]


def tooth_parts(run, shot, view, nearer=np.inf):
    """Polygons of the tooth where it is, its particles or triangles no nearer to the eye than z = `nearer`."""
    place = np.array([*shot["tool_offset"], 0.0])
    if not has_particles(run):
        return facet_polygons(shot["tool_vertices"] + place, shot["tool_facets"], view)
    shown = np.zeros(len(run.model["tool_radii"]), bool)
    shown[shot["surface"]] = True
    shown |= run.model["tool_fixed"] & shot["alive"]
    if np.isfinite(nearer):
        shown = shot["alive"] & (run.model["tool_positions"][:, 2] < nearer)
        shown &= run.model["tool_positions"][:, 2] > nearer - 2.5 * run.model["tool_radii"]
    colour = np.tile(to_rgb(STEEL), (shown.sum(), 1))
    return sphere_polygons(run.model["tool_positions"][shown] + place, run.model["tool_radii"][shown], colour, view)


def frame(run, view):
    """(n, 2) m: corners of the block and the tooth at the first and the last instant, as seen."""
    width, height, depth = run.model["block"]
    corners = [np.array([x, y, z]) for x in (0, width) for y in (0, height) for z in (-depth / 2, depth / 2)]
    tooth = run.model["tool_positions"] if has_particles(run) else run.model["tool_vertices"]
    places = [tooth + (*run.snapshot(k)["tool_offset"], 0.0) for k in (0, -1)]
    return np.vstack([*corners, *places]) @ axes_of_view(view).T[:, :2]


def instants(run, most=4):
    """Numbers of snapshots to show: the first of the cut, then evenly up to the last."""
    last = int(run.stages[-1])
    ends = run.stage_ends()
    cut = max((s for s in ends if s < last), default=0)
    cutting = [k for k in range(len(run.times)) if run.times[k] >= run.times[ends.get(cut - 1, 0)]]
    return spread(cutting, most)


def views(*size):
    """A canvas whose panels are empty until something is painted: a short run has fewer instants than panels."""
    figure, panels = canvas(*size)
    for axes in panels:
        axes.axis("off")
    return figure, panels


def in_sight(run):
    """(n,) bool, rock to show from above: all but the two sides of a box that hide the loose fill."""
    radii, fixed = run.model["rock_radii"], run.model["rock_fixed"]
    width, _, depth = run.model["block"]
    x, _, z = run.snapshot(0)["rock_positions"].T
    return ~(loose(run) & fixed & ((z > 0.5 * depth - 2.5 * radii) | (x > width - 2.5 * radii)))


def perspective(run):
    """Rock and tooth from above and in front."""
    figure, panels = views(11, 7.6, 2, 2)
    shown = in_sight(run)
    for axes, k in zip(panels, instants(run)):
        shot = run.snapshot(k)
        paint(axes, sphere_polygons(shot["rock_positions"][shown], run.model["rock_radii"][shown],
                                    rock_colours(run, shot)[shown], ABOVE),
              tooth_parts(run, shot, ABOVE), edge=0.2, frame=frame(run, ABOVE))
        axes.set_title(f"t = {number(run.times[k])} s, tip at {number(MM * shot['tool_offset'][0])} mm")
    return figure


def side(run):
    """The slab that the tooth runs through, cut open at its middle."""
    figure, panels = views(11, 6.8, 2, 2)
    radius = run.model["rock_radii"]
    for axes, k in zip(panels, instants(run)):
        shot = run.snapshot(k)
        z = shot["rock_positions"][:, 2]
        slab = (z < 0.5 * radius) & (z > -3 * radius)
        paint(axes, sphere_polygons(shot["rock_positions"][slab], radius[slab], rock_colours(run, shot)[slab], SIDE),
              tooth_parts(run, shot, SIDE, nearer=0.0), frame=frame(run, SIDE))
        axes.set_title(f"t = {number(run.times[k])} s")
    return figure


# ---- curves

def forces(run):
    """Forces on the tooth, work and what became of it, cracks and worn volume."""
    time = run.column("time")
    if not len(time):
        return None
    names = [("cutting_force", "cutting", "black"), ("thrust_force", "thrust", "#3b7fb0"),
             ("side_force", "sideways", "#8a8a8a")]
    figure, (upper, lower) = canvas(10, 5.6, 2, 1, sharex=True)
    window = max(1, len(time) // 60)
    scale, unit = (1e3, "kN") if max(np.abs(run.column(name)).max() for name, *_ in names) > 1e3 else (1.0, "N")
    for name, label, colour in names:
        upper.plot(time, run.column(name) / scale, color=colour, linewidth=0.5, alpha=0.5)
        upper.plot(time, running_mean(run.column(name), window) / scale, color=colour, linewidth=1.6, label=label)
    upper.set_ylabel(f"force on the tooth / {unit}")
    upper.legend(loc="upper left")
    for name, label, colour in (("tool_work", "work of the tooth", "black"), ("tool_friction", "friction on it", "#c8a15a"),
                                ("bond_breaking", "bonds broken", CRACK)):
        if run.column(name).any():
            lower.plot(time, run.column(name), color=colour, label=label)
    lower.set(ylabel="J", xlabel="time / s")
    lower.legend(loc="upper left")
    if run.column("worn_volume").any():
        other = lower.twinx()
        other.plot(time, 1e6 * run.column("worn_volume"), color="#54093a", linestyle=":")
        other.set_ylabel("worn volume / cm³ (dotted)")
    name_stages(run, upper)
    return figure


def name_stages(run, axes):
    """A line where each stage ends, and its name."""
    time, stage = run.column("time"), run.column("stage")
    for k, name in enumerate(run.model["stage_names"].tolist()):
        rows = time[stage == k]
        if len(rows):
            axes.axvline(rows.max(), color="#c9b48a", linewidth=0.8)
            axes.text(rows.mean(), 1.01, name, ha="center", va="bottom", transform=axes.get_xaxis_transform())


# ---- wear

def worn(run):
    """True where the tooth wore."""
    return has_particles(run) and bool(run.result("worn_volume") > 0)


def wear_scale(run):
    """Normalisation of the colour of worn depth, mm."""
    depth = MM * run.snapshot(-1)["worn_depth"]
    return Normalize(0, max(float(depth.max()), 1e-12))


def worn_tooth(axes, run, shot, norm, view):
    """The tooth's surface in the colour of its worn depth."""
    surface = shot["surface"]
    colours = WEAR(norm(MM * shot["worn_depth"][surface]))
    part = sphere_polygons(run.model["tool_positions"][surface], run.model["tool_radii"][surface], colours, view)
    paint(axes, part, edge=0.15)


def wear(run):
    """Profile of wear on the tooth at the end, from in front and from below."""
    if not worn(run):
        return None
    shot, norm = run.snapshot(-1), wear_scale(run)
    figure, panels = canvas(11, 4.6, 1, 3)
    for axes, view, title in zip(panels, (SIDE, (50.0, 12.0), BELOW), ("from the side", "from in front", "from in front and below")):
        worn_tooth(axes, run, shot, norm, view)
        axes.set_title(title)
    figure.colorbar(ScalarMappable(norm, WEAR), ax=panels, label="worn depth / mm", shrink=0.7)
    return figure


def facet_depth(run, shot):
    """(m,) m worn off the triangles: how far their corners lie below the first surface, in the mean; of a shape that is
    kept, the volume over the area."""
    first, facets = run.model["tool_vertices"], run.model["tool_facets"]
    if made_of(run) == "triangles":
        return distance(shot["tool_vertices"], first, facets)[shot["tool_facets"]].mean(axis=1)
    return shot["worn_volume"] / np.linalg.norm(area_vectors(first, facets), axis=1)


def worn_triangles(run):
    """The tooth of triangles at the end, coloured by its worn depth, and what has become of its outline."""
    if has_particles(run) or not run.result("maximum_wear_depth") > 0:
        return None
    shot = run.snapshot(-1)
    facets, depth = shot["tool_facets"], MM * facet_depth(run, shot)
    norm = Normalize(0, depth.max())
    rows = 2 if made_of(run) == "triangles" else 1
    figure = Figure(figsize=(12, 4.6 * rows), layout="constrained")
    seen = [figure.add_subplot(rows, 2, k, projection="3d") for k in (1, 2)]
    for axes, (elevation, title) in zip(seen, ((15, "from in front"), (-35, "from in front and below"))):
        solid(axes, shot["tool_vertices"], facets, WEAR(norm(depth))[:, :3])
        axes.view_init(elevation, -40)
        axes.set_title(title)
    figure.colorbar(ScalarMappable(norm, WEAR), ax=seen, label="worn depth / mm", shrink=0.7)
    if rows == 2:
        sections_of_tool(run, [figure.add_subplot(2, 2, k) for k in (3, 4)])
    return figure


def solid(axes, vertices, facets, colours):
    """Triangles in a perspective view, shaded by their slope; y is drawn upwards."""
    corners = MM * vertices[:, [0, 2, 1]] * (1, -1, 1)
    normal = np.cross(*np.diff(corners[facets], axis=1).transpose(1, 0, 2))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    light = 0.92 + 0.08 * normal @ (0.64, -0.48, 0.6)
    axes.add_collection3d(Poly3DCollection(corners[facets], facecolors=colours * light[:, None], edgecolors="#00000030",
                                            linewidths=0.4))
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low)
    axes.axis("off")


def sections_of_tool(run, panels):
    """The tooth's section in its middle plane, new and at instants of the cut: whole, and where it wears."""
    first, facets = run.model["tool_vertices"], run.model["tool_facets"]
    # Beside the plane that many vertices lie in.
    middle = 1e-6 * np.ptp(first[:, 2])
    numbers = spread(range(len(run.times)), 5)
    for axes in panels:
        axes.add_collection(LineCollection(MM * shapes.section(first, facets, middle), color="black", linestyle="--",
                                           linewidth=1, zorder=5, label="new"))
        for k, colour in zip(numbers[1:], colormaps["plasma"](np.linspace(0.1, 0.85, len(numbers) - 1))):
            shot = run.snapshot(k)
            lines = MM * shapes.section(shot["tool_vertices"], shot["tool_facets"], middle)
            axes.add_collection(LineCollection(lines, color=colour, linewidth=1.6, label=f"t = {number(run.times[k])} s"))
    last = run.snapshot(-1)
    depth = distance(first, last["tool_vertices"], last["tool_facets"])
    near = MM * first[depth > 0.1 * depth.max()]
    for axes, points, title in zip(panels, (MM * first, near), ("section in the middle plane", "where it is worn")):
        (left, low), (right, high) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        limits(axes, (left - 3, right + 3, low - 3, high + 3), title)
    panels[1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))


def wear_over_height(run):
    """Largest and mean worn depth of the particles that were surface, over the height above the tip."""
    if not worn(run):
        return None
    shot, places, radii = run.snapshot(-1), run.model["tool_positions"], run.model["tool_radii"]
    surface, radius = shot["surface"], float(radii[0])
    row = np.floor((places[surface, 1]) / (2 * radius)).astype(int)
    depth = MM * shot["worn_depth"][surface]
    rows = np.unique(row)
    height = MM * 2 * radius * (rows + 0.5)
    figure, (axes,) = canvas(7, 3.4)
    axes.plot(height, [depth[row == k].max() for k in rows], color=CRACK, label="largest")
    axes.plot(height, [depth[row == k].mean() for k in rows], color="black", label="mean")
    if run.parameter("removal", "") == "none":
        axes.axhline(MM * M_DEPTH, color="#3b7fb0", linestyle="--", linewidth=1, label="largest of M 13.3")
    axes.set(xlabel="height above the tip / mm", ylabel="worn depth / mm", yscale="log", ylim=(1e-3, None))
    axes.legend()
    return figure


def stages_of_wear(run):
    """What is left of the tooth at stages of the cut, coloured by its wear, and what is gone."""
    if not worn(run) or run.snapshot(-1)["alive"].all():
        return None
    numbers = spread(range(len(run.times)), 4)
    radii, places = run.model["tool_radii"], run.model["tool_positions"]
    norm = Normalize(0, MM * 2 * float(radii[0]))
    figure, panels = views(11, 7.2, 2, 4)
    for axes, below, k in zip(panels[:4], panels[4:], numbers):
        shot = run.snapshot(k)
        worn_tooth(axes, run, shot, norm, (50.0, 12.0))
        axes.set_title(f"t = {number(run.times[k])} s")
        gone, surface = ~shot["alive"], shot["surface"]
        parts = [sphere_polygons(places[surface], radii[surface], np.tile(to_rgb(PALE), (len(surface), 1)), (50.0, 12.0))]
        if gone.any():
            # Drawn nearer than they were, so that none is hidden by the tooth.
            nearness, polygons, colours = sphere_polygons(places[gone], radii[gone], np.tile(to_rgb(CRACK), (gone.sum(), 1)),
                                                          (50.0, 12.0))
            parts.append((nearness + 1.0 * np.ptp(places[:, 0]), polygons, colours))
        paint(below, *parts, edge=0.15)
        below.set_title(f"{int(gone.sum())} removed")
    figure.colorbar(ScalarMappable(norm, WEAR), ax=panels, label="worn depth of what is left / mm", shrink=0.5)
    return figure

"""Figures of a cutting run: set-up, cut, temperature, wear, outlines, forces, and a moving picture of it all."""
import math

import numpy as np
from matplotlib import colormaps
from matplotlib.animation import PillowWriter
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize, to_rgba
from matplotlib.patches import Patch

from rockwear.kernels import wear_statistics
from rockwear.kernels.polygon import contour
from rockwear.kernels.rigid_motion import Pose
from rockwear.report import shapes
from rockwear.report.folder import read_history
from rockwear.report.page import Section, image, machine_tiles, number, percent, quantity, table, tiles, words
from rockwear.report.plots import (
    MM, MS, balances, canvas, discs, frame, mark_stages, running_mean, save, spread, stage_name, working_hours)

ROCK, EDGE, SUPPORT, CRACK = "#e2d4b4", "#8d7d58", "#9a9a92", "#cc1414"
STEEL, SKIN, PALE = "#7d868c", "#2f3a40", "#c3c9cd"
DAMAGE = LinearSegmentedColormap.from_list("damage", [ROCK, "#8f5a24"])
LOOSE = LinearSegmentedColormap.from_list("loose", ["#c9dfee", "#3b7fb0"])
WARMTH = LinearSegmentedColormap.from_list("warmth", ["#e9e9e4", "#fdd873", "#f58a3c", "#c8252c", "#54093a"])
SPACING = 1e-4
"""Distance (m) between the places of the contour where worn depth is measured."""


def shows(run):
    """True for a run with rock, a tool and at least one snapshot."""
    return bool({"tool_positions", "rock_radii", "bonds"} <= run.model.keys() and len(run.times))


def sections(run):
    """The sections of the page, in order."""
    def drawn(figure):
        return save(run, figure.__name__, figure(run))

    return [
        Section("Key results", summary_line(run), [key_results(run), stage_table(run)]),
        Section("Set-up", "Grey discs are held. The tooth moves right; only its dark surface takes part in contact.",
                [drawn(set_up)]),
        Section("The cut", "Red: broken bonds, drawn across the bond where its discs are still near each other. "
                "Blue: chips, which no chain of bonds joins to the support. "
                "The darker a disc, the more of its bonds are gone.",
                [drawn(cut), moving_picture(run)]),
        Section("Forces, energy, cracks, wear and temperature over time",
                "Thin lines are the record, thick ones a running mean. Each cycle begins on the rock that the start-up "
                "left. The upper axis of the wear is the time that the accelerated wear stands for.", [drawn(history)]),
        Section("Temperature", "Rise above the coldest start, on a logarithmic scale.", [drawn(temperature)]),
        Section("Wear of the tooth", "Depth worn off each surface particle that is left, and the particles that are gone, so "
                "far.",
                [drawn(wear)]),
        *trusted(run),
        Section("Shape of the tooth", "Dashed: the new tooth. Worn depth is the distance from the new contour to what "
                "is left; arc length counts from the lowest point, positive up the front.", [drawn(shape)]),
        balances(run)]


# ---- numbers

def summary_line(run):
    """The run in a line."""
    def value(name, unit):
        return quantity(run.parameter(name, math.nan), unit)

    return (f"{value('velocity', 'm/s')}, depth of cut {value('depth_of_cut', 'm')}, "
            f"{quantity(run.result('simulated_time'), 's')} simulated, "
            f"wear accelerated {value('acceleration', '-')} times.")


def key_results(run):
    """The numbers an engineer looks for first."""
    def tile(label, name, unit, remark=""):
        return label, quantity(run.result(name), unit), remark

    step, critical = run.result("time_step"), run.result("critical_time_step")
    energy = run.summary.get("balances", {}).get("energy", {})
    tiles_shown = [
        tile("mean cutting force", "mean_cutting_force", "N/m"),
        tile("peak cutting force", "peak_cutting_force", "N/m"),
        tile("mean thrust force", "mean_thrust_force", "N/m"), tile("specific energy", "specific_energy", "J/m3"),
        ("mass lost", percent(run.result("mass_lost"), 1.0), f"{run.result('particles_removed')} particles removed"),
        tile("worn volume", "worn_volume", "m3/m", "by Archard's law"),
        *[tile(f"hottest {body}", f"{body}_temperature_max", "K") for body in ("tool", "rock")
          if math.isfinite(run.result(f"{body}_temperature_max"))],
        ("cracks", f"{run.result('tensile_cracks')} + {run.result('shear_cracks')}", "tensile + shear, at the end"),
        ("particles", f"{run.result('rock_particles')} + {run.result('tool_particles')}", "rock + tool"),
        ("time step", f"{number(1e9 * step)} ns", f"{percent(step, critical)} of the critical"),
        ("energy residual", percent(energy.get("residual", math.nan), energy.get("tool_work", 0.0)),
         "of the tool's work"),
        *machine_tiles(run)]
    return tiles(tiles_shown)


def stage_table(run):
    """Forces, wear and temperature stage by stage."""
    stage = run.column("stage")

    def mean_at_work(name, k):
        # Not over the time in which a worn tool comes to the rock.
        return run.over_stage(name, np.mean, k) * run.over_stage("time", np.ptp, k) / run.over_stage("working_time", np.ptp, k)

    rows = [(stage_name(k), quantity(mean_at_work("cutting_force", k), "N/m"),
             quantity(run.over_stage("cutting_force", np.max, k), "N/m"), quantity(mean_at_work("thrust_force", k), "N/m"),
             percent(run.over_stage("mass_lost", np.max, k), 1.0),
             quantity(run.over_stage("tool_temperature_max", np.max, k), "K"))
            for k in np.unique(stage[np.isfinite(stage)]).astype(int)]
    header = ("", "mean cutting force", "peak", "mean thrust force", "mass lost so far", "hottest tool")
    return table(rows, header) if rows else ""


# ---- pieces of pictures

def pose(shot):
    """Where the tool is now."""
    return Pose(shot["tool_offset"], float(shot.get("tool_turn", 0.0)))


def moved_tool(run, shot):
    """(positions of the living tool particles where the tool is now, their numbers)."""
    alive = np.flatnonzero(shot["alive"])
    return pose(shot).of(run.model["tool_positions"][alive]), alive


def tool_outlines(run, shot):
    """Polygons (m, in the tool's own frame) of what is left of the tool, worn depth taken off."""
    if "tool_facets" in run.model:
        return [shot["tool_vertices"][shapes.loop(shot["tool_facets"])]]
    model, alive = run.model, shot["alive"]
    return shapes.outlines(model["tool_positions"][alive], model["tool_radii"][alive], shot["worn_depth"][alive])


def rock_colours(run, shot):
    """(n, 4) colour of each rock disc: sound, damaged, loose, held."""
    bonds, fixed = run.model["bonds"], run.model["rock_fixed"]
    count = len(run.model["rock_radii"])
    broken = np.bincount(bonds[shot["status"] != 0].ravel(), minlength=count)
    share = broken / np.maximum(np.bincount(bonds.ravel(), minlength=count), 1)
    loose = shapes.chips(count, bonds, shot["status"] == 0, fixed)
    colours = np.where(loose[:, None], LOOSE(share), DAMAGE(share))
    colours[fixed] = to_rgba(SUPPORT)
    return colours


def crack_lines(run, shot):
    """(m, 2, 2) segments in mm."""
    pairs = run.model["bonds"][shot["status"] != 0]
    return MM * shapes.cracks(shot["rock_positions"], run.model["rock_radii"], pairs)


class CutPicture:
    """Rock, cracks and tool in one axes; `show` another snapshot with the same artists."""

    def __init__(self, run, axes, shot, **style):
        self.run = run
        self.rock = discs(axes, shot["rock_positions"], run.model["rock_radii"], **style)
        self.cracks = LineCollection([], colors=CRACK, linewidths=1.1, capstyle="round", zorder=3)
        self.tool = PolyCollection([], facecolors=STEEL, edgecolors=SKIN, linewidths=1, zorder=4)
        axes.add_collection(self.cracks)
        axes.add_collection(self.tool)
        self.show(shot)

    def show(self, shot):
        """Show this snapshot."""
        self.rock.set_offsets(MM * shot["rock_positions"])
        self.rock.set_facecolors(rock_colours(self.run, shot))
        self.cracks.set_segments(crack_lines(self.run, shot))
        self.tool.set_verts([MM * pose(shot).of(loop) for loop in tool_outlines(self.run, shot)])


def cut_view(run):
    """Limits in mm that hold the tool's tip on its way and all broken discs that are still about in the rock."""
    width, height = MM * run.model["box"]
    depth = MM * run.parameter("depth_of_cut", 0.1 * run.model["box"][1])
    lowest = height - 2 * depth
    for k in run.stage_ends().values():
        shot = run.snapshot(k)
        heights = MM * shot["rock_positions"][shot["broken_bonds"] > 0, 1]
        lowest = min(lowest, *heights[np.isfinite(heights)].tolist(), height)
    return -0.12 * width, 1.03 * width, max(lowest - 0.5 * depth, -0.02 * height), height + 2 * depth


def moment(run, k):
    """What a snapshot shows, in words."""
    return f"{stage_name(stage_of(run, k))}, {MS * run.times[k]:.2f} ms"


def stage_of(run, k):
    """Stage of a snapshot; the one taken after the run belongs to the last recorded stage."""
    recorded = run.column("stage")
    last = np.nanmax(recorded) if len(recorded) and np.isfinite(recorded).any() else run.stages[k]
    return int(min(run.stages[k], last))


def instants(run):
    """Up to six snapshots: the course of the first stage, and of the last."""
    stages = np.array([stage_of(run, k) for k in range(len(run.times))])
    first, last = np.flatnonzero(stages == stages[0]), np.flatnonzero(stages == stages[-1])
    if stages[0] == stages[-1]:
        return spread(first, 7)[-6:]
    return spread(first, 4)[-3:] + spread(last, 4)[-3:]


# ---- figures

def arrow(axes, begin, end, text, style="<->", shift=(0, 5), **place):
    """A dimension, or a motion, between two points in mm, its text `shift` points from the middle."""
    axes.annotate("", end, begin, arrowprops={"arrowstyle": style, "shrinkA": 0, "shrinkB": 0})
    middle = (begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2
    axes.annotate(text, middle, shift, textcoords="offset points", **place)


def set_up(run):
    """Rock, support, tooth with its surface, motion, dimensions."""
    shot = run.snapshot(0)
    model, (width, height) = run.model, MM * run.model["box"]
    positions, alive = moved_tool(run, shot)
    figure, (axes,) = canvas(9, 6.2)
    discs(axes, shot["rock_positions"], model["rock_radii"], linewidths=0.3, edgecolors=EDGE,
          facecolors=np.where(model["rock_fixed"][:, None], to_rgba(SUPPORT), to_rgba(ROCK)))
    surface = np.isin(alive, shot["surface"])
    discs(axes, positions, model["tool_radii"][alive],
          facecolors=np.where(surface[:, None], to_rgba(SKIN), to_rgba(PALE)))
    outline = MM * pose(shot).of(model["outline"])
    left, top = min(0, outline[:, 0].min()), max(height, outline[:, 1].max())
    depth = MM * run.parameter("depth_of_cut", math.nan)
    if math.isfinite(depth):
        axes.axhline(height - depth, color=CRACK, linewidth=0.8, linestyle="--")
        arrow(axes, (0.9 * width, height - depth), (0.9 * width, height), f"depth of cut {depth:.3g} mm", shift=(-6, 0),
              ha="right", va="center", bbox={"color": "white", "alpha": 0.85, "pad": 1})
    arrow(axes, (0, -5), (width, -5), f"{width:.4g} mm", shift=(0, -4), ha="center", va="top")
    arrow(axes, (width + 5, 0), (width + 5, height), f"{height:.4g} mm", shift=(5, 0), ha="left", va="center")
    speed = quantity(run.parameter("velocity", math.nan), "m/s")
    arrow(axes, (0.08 * width, top - 8), (0.35 * width, top - 8), speed, "-|>", ha="center")
    frame(axes, (left - 6, width + 26, -14, top + 5))
    axes.legend(handles=[Patch(color=ROCK, label="bonded rock"), Patch(color=SUPPORT, label="held"),
                         Patch(color=PALE, label="tool"), Patch(color=SKIN, label="its surface")], loc="lower left")
    return figure


def cut(run):
    """The cut at several instants."""
    shown = instants(run)
    limits = cut_view(run)
    columns = min(3, len(shown)) if len(shown) != 4 else 2
    rows = math.ceil(len(shown) / columns)
    width = 12 / columns
    tall = width * (limits[3] - limits[2]) / (limits[1] - limits[0]) + 0.6
    figure, panels = canvas(12, rows * tall, rows, columns)
    for axes, k in zip(panels, shown):
        CutPicture(run, axes, run.snapshot(k), linewidths=0.2, edgecolors=EDGE)
        frame(axes, limits, moment(run, k))
    for axes in panels[len(shown):]:
        axes.set_visible(False)
    return figure


def moving_picture(run, title=moment, limits=None, shown=None):
    """The cut as an animated GIF of at most 40 frames, of some or all snapshots. -> html"""
    shown = spread(range(len(run.times)) if shown is None else shown, 40)
    if len(shown) < 2:
        return ""
    limits = limits or cut_view(run)
    figure, (axes,) = canvas(7.2, 0.7 + 6.4 * (limits[3] - limits[2]) / (limits[1] - limits[0]))
    picture = CutPicture(run, axes, run.snapshot(shown[0]), linewidths=0, antialiaseds=False)
    path = run.path / "figures" / "cut.gif"
    writer = PillowWriter(fps=6)
    with writer.saving(figure, path, dpi=80):
        for k in shown:
            picture.show(run.snapshot(k))
            frame(axes, limits, title(run, k))
            writer.grab_frame()
    return image(path)


def temperature(run):
    """Temperature at the end of the first stage and of the run: the whole, and the tip."""
    ends = run.stage_ends()
    shown = sorted({next(iter(ends.values())), len(run.times) - 1})
    first = run.snapshot(0)["temperature"]
    if not len(first):
        return None
    cold = np.nanmin(first)
    shots = [run.snapshot(k) for k in shown]
    highest = max(1e-3, *(np.nanmax(shot["temperature"][present(run, shot)]) - cold for shot in shots))
    norm = LogNorm(1e-3 * highest, highest)
    width, height = MM * run.model["box"]
    figure, panels = canvas(12, 5.2 * len(shown), len(shown), 2)
    for whole, near, k, shot in zip(panels[::2], panels[1::2], shown, shots):
        for axes in (whole, near):
            painted = paint_temperature(axes, run, shot, cold, norm)
        outline = MM * pose(shot).of(run.model["outline"])
        x, y = outline[np.argmin(outline[:, 1])]
        frame(whole, (-0.25 * width, 1.03 * width, 0, max(outline[:, 1].max(), height) + 3), moment(run, k))
        frame(near, (x - 15, x + 15, y - 8, y + 22), f"at the tip: {hottest(run, shot)}")
    figure.colorbar(painted, ax=panels, label=f"rise above {quantity(cold, 'K')} / K", shrink=0.7, extend="min")
    return figure


def hottest(run, shot):
    """Highest temperatures now, in words."""
    count = len(run.model["rock_radii"])
    bodies = {"rock": shot["temperature"][:count], "tool": shot["temperature"][count:][shot["alive"]]}
    return ", ".join(f"{name} up to {quantity(np.nanmax(values), 'K')}"
                     for name, values in bodies.items() if len(values))


def present(run, shot):
    """Mask over temperatures: rock, and the tool particles that live."""
    return np.concatenate([np.ones(len(run.model["rock_radii"]), bool), shot["alive"]])


def paint_temperature(axes, run, shot, cold, norm):
    """Rock and tool discs by their rise above `cold`."""
    positions, alive = moved_tool(run, shot)
    rise = np.maximum(shot["temperature"] - cold, norm.vmin)
    count = len(run.model["rock_radii"])
    radii = run.model["rock_radii"]
    edge = {"edgecolors": "#b5b5ac", "linewidths": 0.2}
    discs(axes, shot["rock_positions"], radii, array=rise[:count], norm=norm, cmap=WARMTH, **edge)
    return discs(axes, positions, run.model["tool_radii"][alive], array=rise[count:][alive], norm=norm, cmap=WARMTH,
                 **edge)


def wear_limits(run, shot, margin=2.0):
    """Limits in mm, in the tool's own frame, around most of what is gone or clearly worn; around the tip if nothing is."""
    model, depth = run.model, shot["worn_depth"]
    worn = MM * model["tool_positions"][~shot["alive"] | (depth > 0.5 * model["tool_radii"].max())]
    tip = MM * model["outline"][np.argmin(model["outline"][:, 1])]
    if len(worn):
        away = np.linalg.norm(worn - tip, axis=1)
        worn = worn[away <= np.percentile(away, 85)]
    points = np.vstack([worn, tip - 3, tip + 3])
    (left, bottom), (right, top) = points.min(axis=0) - margin, points.max(axis=0) + margin
    aside = max(0.0, 0.8 * (top - bottom) - (right - left)) / 2
    return left - aside, right + aside, bottom, top


def worn_stages(run, most):
    """{label: snapshot} to show wear at: the ends of the stages, or of equal spans of a single one."""
    ends = {stage_of(run, k): k for k in run.stage_ends().values()}
    if len(ends) > 1:
        return {f"after {stage_name(stage)}": k for stage, k in spread(ends.items(), most)}
    return {f"after {MS * run.times[k]:.3g} ms": k for k in spread(range(len(run.times)), most + 1)[-most:]}


def wear(run):
    """Worn depth of each particle, and the particles that are gone, at the end of four stages."""
    shown, model = {label: run.snapshot(k) for label, k in worn_stages(run, 4).items()}, run.model
    limits = wear_limits(run, list(shown.values())[-1])
    norm = Normalize(0, MM * max(1e-6, *(shot["worn_depth"][shot["alive"]].max(initial=0) for shot in shown.values())))
    columns = min(2, len(shown))
    figure, panels = canvas(12, 5.4 * -(-len(shown) // columns), -(-len(shown) // columns), columns)
    for axes in panels[len(shown):]:
        axes.set_axis_off()
    for (label, shot), axes in zip(shown.items(), panels):
        alive, gone, worn = shot["alive"], ~shot["alive"], shot["alive"] & (shot["worn_depth"] > 0)
        sound = alive & ~worn
        discs(axes, model["tool_positions"][sound], model["tool_radii"][sound], facecolors="#dfe3e6", edgecolors="white")
        discs(axes, model["tool_positions"][gone], model["tool_radii"][gone], facecolors="#f9dcdc", edgecolors="#e08a8a",
              linewidths=0.6)
        painted = discs(axes, model["tool_positions"][worn], model["tool_radii"][worn], array=MM * shot["worn_depth"][worn],
                        cmap="YlOrRd", norm=norm, edgecolors="#777777", linewidths=0.4)
        axes.plot(*MM * np.vstack([model["outline"], model["outline"][:1]]).T, color="black", linewidth=0.8)
        frame(axes, limits, f"{label}: {int(gone.sum())} particles gone (pale red), {int(worn.sum())} being worn")
    figure.colorbar(painted, ax=panels, label="worn depth of the particle / mm", shrink=0.7)
    return figure


def shape(run):
    """Outlines at the end of each stage over the new one, and worn depth along the contour."""
    return worn_outlines(run, worn_stages(run, 8))


def worn_outlines(run, shown):
    """Outline of the tool over the new one, and worn depth along the contour; shown: {label: snapshot}."""
    model = run.model
    points, arc = contour(model["outline"], SPACING)
    rough = shapes.distance_to(points, shapes.outlines(model["tool_positions"], model["tool_radii"]), SPACING)
    deepest = np.zeros(len(arc))
    figure, (axes, profile) = canvas(12, 5.6, 1, 2)
    axes.fill(*MM * model["outline"].T, facecolor="#eef0f1", edgecolor="black", linewidth=1, linestyle="--", )
    for (label, k), colour in zip(shown.items(), colormaps["plasma"](np.linspace(0, 0.85, len(shown)))):
        shot = run.snapshot(k)
        loops = tool_outlines(run, shot)
        for loop in loops:
            axes.plot(*MM * np.vstack([loop, loop[:1]]).T, color=colour, linewidth=1.4)
        depth = np.maximum(shapes.distance_to(points, loops, SPACING) - rough, 0)
        profile.plot(MM * arc, MM * depth, color=colour, linewidth=1.4, label=label)
        deepest = np.fmax(deepest, depth)
    worn = np.append(MM * arc[deepest > 0.02 * deepest.max()], [-5, 5])
    profile.set(xlim=(worn.min() - 2, worn.max() + 2), ylim=(0, max(0.1, 1.1 * MM * deepest.max())),
                xlabel="arc length from the tip / mm", ylabel="mm", title="worn depth along the new contour")
    frame(axes, wear_limits(run, shot), "outline")
    profile.legend(loc="upper left")
    return figure


def trusted(run):
    """The section on how far the acceleration can be trusted, in a list; empty where nothing has judged it."""
    if not math.isfinite(run.result("contact_events_per_particle")):
        return []
    return [Section("How far the acceleration can be trusted", trust_line(run), [" ", save(run, "trust", trust(run))])]


def trust_line(run):
    """What R's rules say of this run."""
    piece = "a layer as deep as its facet" if "tool_facets" in run.model else "a particle"
    error = run.result("wear_distribution_error")
    known = f"is known to {percent(error, 1.0)}" if math.isfinite(error) else "cannot be told: the run is too short"
    return (f"Wear is accelerated {quantity(run.parameter('acceleration', 0.0), '-')} times. Sampled in "
            f"{quantity(run.result('simulated_time'), 's')}, its distribution along the tool {known}, and {piece} goes in "
            f"{number(run.result('contact_events_per_particle'))} contact events. For an error of "
            f"{percent(run.parameter('wear_tolerance', math.nan), 1.0)} and {wear_statistics.ENOUGH_EVENTS} events, "
            f"accelerate at most {number(run.result('trusted_wear_acceleration'))} times, and run as much longer.")


def trust(run):
    """Wear along the outline with its own error, and error and events against the factor of acceleration."""
    columns = read_history(run.path / "wear_profile.csv")[0]
    increments = np.column_stack(list(columns.values())) if columns else []
    deviation = wear_statistics.distribution_deviation(increments) if len(increments) else None
    factor, error = run.parameter("wear_acceleration", 0.0), run.result("wear_distribution_error")
    if deviation is None or not factor:
        return None
    worn = increments.sum(axis=0)
    place = wear_statistics.middles(run.model["outline"], len(worn))
    figure, (along, against) = canvas(12, 4.2, 1, 2)
    along.bar(MM * place, 100 * worn / worn.sum(), 0.9 * MM * wear_statistics.PLACE, color="#c8a15a",
              yerr=100 * deviation / worn.sum(), ecolor="#444444")
    shown = MM * place[worn > 1e-3 * worn.max()]
    along.set(xlabel="arc length from the tip along the new outline / mm", ylabel="% of the worn volume",
              xlim=(shown.min() - 4, shown.max() + 4), title="where the tool wears, and how well that is known")
    factors = factor * np.geomspace(1e-3, 10, 60)
    against.loglog(factors, 100 * error * np.sqrt(factors / factor), color="#2c6e91", label="error of the distribution / %")
    against.loglog(factors, run.result("contact_events_per_particle") * factor / factors, color="#b5651d",
                   label="contact events till a piece is gone")
    against.axhline(100 * run.parameter("wear_tolerance", math.nan), color="#2c6e91", linestyle=":")
    against.axhline(wear_statistics.ENOUGH_EVENTS, color="#b5651d", linestyle=":")
    trusted = run.result("trusted_wear_acceleration")
    against.axvspan(factors[0], trusted, color="#e4efe0", zorder=-5, label="both of R's rules kept")
    against.axvline(factor, color="black", linewidth=1, label="this run")
    against.set(xlabel="acceleration of wear, at the same worn volume", xlim=factors[[0, -1]])
    against.legend(loc="upper center", fontsize=8)
    return figure


def history(run):
    """Forces, energy, cracks, wear and temperature over time."""
    time = MS * run.column("time")
    if not len(time):
        return None
    hot = [draw_hottest] if "tool_temperature_max" in run.columns else []
    drawers = [draw_forces, draw_energy, draw_cracks, draw_wear, *hot]
    figure, panels = canvas(12, 2.4 * len(drawers), len(drawers), sharex=True)
    for draw, axes in zip(drawers, panels):
        draw(run, axes, time)
    for axes in panels:
        mark_stages(run, axes, named=axes is panels[0])
    panels[-1].set(xlabel="time / ms", xlim=(0, time.max() if np.isfinite(time.max()) and time.max() > 0 else 1))
    return figure


def draw_forces(run, axes, time):
    """Cutting and thrust force; the axis holds the running means, peaks may leave it."""
    window = max(1, len(time) // 40)
    low, high, peak = 0.0, 0.0, 0.0
    for name, colour in (("cutting_force", "#b5651d"), ("thrust_force", "#2c6e91")):
        force = 1e-3 * np.nan_to_num(run.column(name), posinf=0.0, neginf=0.0)
        smooth = running_mean(force, window)
        axes.plot(time, force, color=colour, linewidth=0.6, alpha=0.4)
        axes.plot(time, smooth, color=colour, linewidth=2, label=words(name))
        low, high, peak = min(low, smooth.min()), max(high, smooth.max()), max(peak, force.max())
    top = min(3 * high, 1.05 * peak) or 1.0
    axes.set(ylabel="kN/m", ylim=(1.2 * low - 0.02 * top, top))
    axes.legend(loc="upper left")


def draw_energy(run, axes, time):
    """The tool's work, and what is in motion."""
    for name, colour in (("tool_work", "#444444"), ("kinetic_energy", "#b5651d"), ("tool_friction", "#2c6e91"),
                         ("bond_breaking", CRACK)):
        if name in run.columns:
            axes.plot(time, run.column(name), color=colour, label=words(name))
    axes.set_ylabel("J/m")
    axes.legend(loc="upper left")


def draw_cracks(run, axes, time):
    """Broken bonds of the rock as it is now; each cycle begins again at the start-up's."""
    for name, colour in (("tensile_cracks", CRACK), ("shear_cracks", "#2c6e91")):
        axes.plot(time, run.column(name), color=colour, label=words(name))
    axes.set_ylabel("broken bonds")
    axes.legend(loc="upper left")


def draw_wear(run, axes, time):
    """Mass lost, and Archard's volume as a share of the tool."""
    whole = run.model["tool_volumes"].sum()
    axes.plot(time, 100 * run.column("mass_lost"), color="#444444", drawstyle="steps-post", label="particles gone")
    axes.plot(time, 100 * run.column("worn_volume") / whole, color=CRACK, label="worn by Archard's law")
    axes.set(ylabel="% of the tool")
    axes.legend(loc="upper left")
    working_hours(run, axes, time)


def draw_hottest(run, axes, time):
    """Highest temperatures of tool and rock."""
    for body, colour in (("tool", CRACK), ("rock", "#b5651d")):
        axes.plot(time, run.column(f"{body}_temperature_max") - 273.15, color=colour, label=f"hottest {body}")
    axes.set_ylabel("°C")
    axes.legend(loc="upper left")

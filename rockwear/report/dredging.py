"""Figures of a dredge pick, those of P 12-18: failure, temperature and its course, wear, shape, mass loss."""
import math

import numpy as np
from matplotlib.colors import LogNorm, Normalize, to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rockwear.report.cutting import (
    CRACK, EDGE, PALE, ROCK, SKIN, SUPPORT, WARMTH, CutPicture, arrow, balances, moved_tool, moving_picture, pose,
    worn_outlines)
from rockwear.report.page import Section, machine_tiles, number, percent, quantity, table, tiles
from rockwear.report.plots import MM, canvas, discs, frame, running_mean, save

CUT_TIMES = 0.01, 0.2, 0.4, 0.65
"""Instants of the first cut that P shows, s."""
COOLING_TIMES = 0.03, 0.13, 0.83, 1.35
"""Instants of the first cooling that P shows, s after the cut (0.68, 0.78, 1.48 and 2.00 s)."""
WINDOW = 0.035
"""Half the width (m) of the pictures of the tip."""


def shows(run):
    """True for a run with a pick on its path."""
    return "own_path" in run.model and len(run.times) > 0


def sections(run):
    """The sections of the page, in order."""
    def drawn(name, figure):
        return save(run, name, figure)

    first = snapshots(run, 1, CUT_TIMES)
    hot = len(run.snapshot(0)["temperature"]) > 0
    return [
        Section("Key results", summary_line(run), [key_results(run), cut_table(run)]),
        Section("Set-up", "Grey discs are held. Dashed: the path of the tip, an arc that the swing stretches to a "
                "cycloid. The free surface is the path of the pick before.", [drawn("set_up", set_up(run))]),
        Section("Failure of the rock (P fig. 12)", "The first cut. Red: broken bonds. Blue: chips, which no chain of "
                "bonds joins to the support. The darker a disc, the more of its bonds are gone.",
                [drawn("failure", failure(run, first)),
                 moving_picture(run, instant, limits(run), np.flatnonzero(run.stages % 2 == 1))]),
        Section("Forces", "Along and across the direction in which the pick looks; thin lines are the record, thick ones "
                "a running mean. Only the cuts are shown, end to end.", [drawn("forces", forces(run))]),
        *([Section("Temperature during the first cut (P fig. 13)", "The tip of the pick, in its own frame. Heat arises "
                   "in the contact and falls off steeply behind it. Line: the new pick.",
                   [drawn("heating", tip(run, first, paint_heat(run), "of cutting"))]),
           Section("Temperature while the pick cools in water after the first cut (P fig. 14)", "Water takes heat from "
                   "the surface, and conduction spreads it through the body.",
                   [drawn("cooling", tip(run, snapshots(run, 2, COOLING_TIMES), paint_heat(run, 2), "after the cut"))]),
           Section("Temperature over the turns (P fig. 15)", turns_words(run), [drawn("turns", turns(run))])] if hot else []),
        Section("Accumulated wear during the first cut (P fig. 16)", "Depth worn off each particle of the surface; pale "
                "red: particles that are gone.", [drawn("wear", tip(run, first, paint_wear(run), "of cutting"))]),
        Section("Shape of the pick (P fig. 17)", "Dashed: the new pick. Arc length counts from the lowest point, "
                "positive up the rake face.", [drawn("shape", worn_outlines(run, after_cuts(run)))]),
        Section("Loss of mass (P fig. 18)", "Particles gone, and Archard's volume, which they follow.",
                [drawn("mass_loss", mass_loss(run))]),
        balances(run)]


# ---- numbers

def summary_line(run):
    """The run in a line."""
    def value(name, unit):
        return quantity(run.parameter(name, math.nan), unit)

    speed = run.parameter("angular_velocity", math.nan) * run.parameter("cutter_radius", math.nan)
    return (f"{number(speed)} m/s around the axis, swing {value('swing', 'm/s')}, {run.parameter('cycles', 0)} turns, "
            f"mechanics {value('time_scale', '-')} times as fast, wear accelerated {value('acceleration', '-')} times, "
            f"rock discs {value('scale_factor', '-')} times as coarse as P's.")


def key_results(run):
    """The numbers an engineer looks for first."""
    energy = run.summary.get("balances", {}).get("energy", {})
    water = run.column("water_heat")
    to_water = f"{number(1e-3 * water[-1])} kJ/m" if len(water) and np.isfinite(water[-1]) else "none"
    shown = [
        ("mean cutting force", quantity(run.result("mean_cutting_force"), "N/m"), "while cutting"),
        ("peak cutting force", quantity(run.result("peak_cutting_force"), "N/m"), ""),
        ("specific energy", quantity(run.result("specific_energy"), "J/m3"), ""),
        ("mass lost", percent(run.result("mass_lost"), 1.0), f"{run.result('particles_removed')} particles removed"),
        ("hottest particle", quantity(run.result("tool_temperature_max"), "K"), "of the pick"),
        ("heat to the water", to_water, "from pick and rock"),
        ("levels off after", levelling(run), "of the same cut again and again"),
        ("particles", f"{run.result('rock_particles')} + {run.result('tool_particles')}", "rock + tool"),
        ("time step", f"{number(1e9 * run.result('time_step'))} ns", "of the mechanics"),
        ("energy residual", percent(energy.get("residual", math.nan), energy.get("tool_work", 0.0)),
         "of the tool's work"),
        *machine_tiles(run)]
    return tiles(shown)


def levelling(run):
    """Turns until the peak is within 5 % of its final rise."""
    turn, peak = run.table("turns.csv", "turn", "peak")
    if len(peak) < 2:
        return "not known"
    rise = peak - run.parameter("tool_temperature", 0.0)
    return f"{int(turn[np.argmax(rise >= 0.95 * rise[-1])])} turns"


def turns_words(run):
    """What the temperature over the turns shows, why measured peaks may not rise, and what worn particles took."""
    made, lost = (run.column(name)[-1:] for name in ("pick_friction_heat", "pick_heat_worn_away"))
    words = ("Shaded: cutting. Below, the mean friction heat of these cuts is repeated from the cold on the pick as it is "
             "worn now, without further wear: peaks rise until the water takes a turn's heat in the same turn. Crosses "
             "are the peaks above. Cuts break the rock each in its own way, and their heat differs: rings are the "
             "same peaks for equal heat, the rise of each cut scaled to the mean heat of all.")
    if len(made) and made[0] > 0 and lost[0] > 0:
        words += (f" Wear is accelerated {quantity(run.parameter('acceleration', math.nan), '-')} times. Worn particles took "
                  f"{100 * lost[0] / made[0]:.2g} % of the pick's friction heat with them; what else they held stayed with "
                  "those under them, so that the field recedes with the surface, as it does under real wear.")
    return words


def per_cut(run, name):
    """{turn: growth of a column during its cut}."""
    ends = {n: run.over_stage(name, lambda values: values[-1], 2 * n - 1) for n in range(1, run.parameter("cycles", 0) + 1)}
    return {n: ends[n] - (ends[n - 1] if n > 1 else 0.0) for n in ends if np.isfinite(ends[n])}


def measured_peaks(run):
    """Turns, peaks of the hottest part (K), and the same for the mean heat of all cuts: arrays (n,) each."""
    heat = per_cut(run, "pick_friction_heat")
    done = [n for n in heat if heat[n] > 0]
    peak = np.array([run.over_stage("tool_temperature_hot", np.max, 2 * n - 1) for n in done])
    cold = np.array([run.over_stage("tool_temperature_hot", lambda values: values[-1], 2 * n - 2) if n > 1
                     else run.parameter("tool_temperature", math.nan) for n in done])
    share = np.array([heat[n] for n in done])
    return np.array(done), peak, cold + (peak - cold) * share.mean() / share if done else peak


def cut_table(run):
    """Force, temperature, heat and wear cut by cut."""
    stage = run.column("stage")
    made, lost = per_cut(run, "pick_friction_heat"), per_cut(run, "pick_heat_worn_away")
    cold = run.parameter("tool_temperature", math.nan)
    rows = [(f"turn {n}", quantity(run.over_stage("cutting_force", np.mean, 2 * n - 1), "N/m"),
             quantity(run.over_stage("tool_temperature_max", np.max, 2 * n - 1), "K"),
             f"{number(run.over_stage('tool_temperature_hot', np.max, 2 * n - 1) - cold)} K",
             quantity(run.over_stage("tool_temperature_max", np.min, 2 * n), "K"),
             quantity(made.get(n, math.nan), "J/m"), quantity(lost.get(n, math.nan), "J/m"),
             percent(run.over_stage("mass_lost", np.max, 2 * n - 1), 1.0))
            for n in range(1, run.parameter("cycles", 0) + 1) if (stage == 2 * n - 1).any()]
    return table(rows, ("", "mean cutting force", "hottest particle", "rise of the pick's hottest 1 %",
                        "hottest after cooling", "friction heat into the pick", "heat gone with worn particles", "mass lost so far"))


# ---- pieces of pictures

def snapshots(run, stage, seconds):
    """{seconds into the stage: snapshot nearest to it}, each snapshot once."""
    found = np.flatnonzero(run.stages == stage)
    if not len(found):
        return {}
    begin = run.times[run.stages < stage].max(initial=0.0)
    nearest = [int(found[np.argmin(abs(run.times[found] - begin - s))]) for s in seconds]
    return {float(run.times[k] - begin): k for k in dict.fromkeys(nearest)}


def after_cuts(run):
    """{label: snapshot} at the end of each cut."""
    return {f"after cut {(stage + 1) // 2}": k for stage, k in run.stage_ends().items() if stage % 2}


def limits(run):
    """Limits in mm that hold the rock and the way of the pick."""
    width, height = MM * run.model["box"]
    high = MM * np.ptp(run.model["outline"][:, 1])
    return -0.25 * width, 1.05 * width, -0.03 * height, height + 0.5 * high


def panels_of(count, width, tall):
    """A row of panels, or two where there are four."""
    columns = 2 if count == 4 else max(1, count)
    rows = math.ceil(count / columns) or 1
    return canvas(width, rows * (width / columns * tall + 0.4), rows, columns)


def instant(run, k):
    """What a snapshot of a cut shows, in words."""
    return f"cut {(run.stages[k] + 1) // 2}, {run.times[k]:.2f} s"


def set_up(run):
    """Rock, support, pick with its surface, and the path of its tip."""
    shot, model = run.snapshot(0), run.model
    positions, alive = moved_tool(run, shot)
    left, right, bottom, top = limits(run)
    figure, (axes,) = canvas(10, 10 * (top - bottom) / (right - left) + 0.3)
    discs(axes, shot["rock_positions"], model["rock_radii"], linewidths=0.2, edgecolors=EDGE,
          facecolors=np.where(model["rock_fixed"][:, None], to_rgba(SUPPORT), to_rgba(ROCK)))
    surface = np.isin(alive, shot["surface"])
    discs(axes, positions, model["tool_radii"][alive],
          facecolors=np.where(surface[:, None], to_rgba(SKIN), to_rgba(PALE)))
    axes.plot(*MM * model["own_path"].T, color=CRACK, linestyle="--", linewidth=1.2)
    axes.plot(*MM * model["free_surface"].T, color="#2c6e91", linewidth=1.2)
    tip_now = MM * pose(shot).of(model["outline"])[np.argmin(model["outline"][:, 1])]
    speed = run.parameter("angular_velocity", math.nan) * run.parameter("cutter_radius", math.nan)
    ahead = pose(shot).rotation @ (1.0, 0.0)
    below = tip_now - (0, 14)
    arrow(axes, below, below + 70 * ahead, f"{number(speed)} m/s", "-|>", (0, -6), ha="left", va="top")
    swing = quantity(run.parameter("swing", math.nan), "m/s")
    arrow(axes, (left + 15, top - 15), (left + 75, top - 15), f"swing {swing}", "-|>", ha="center")
    frame(axes, (left, right, bottom, top))
    axes.legend(handles=[Patch(color=ROCK, label="bonded rock"), Patch(color=SUPPORT, label="held"),
                         Patch(color=PALE, label="pick"), Patch(color=SKIN, label="its surface"),
                         Line2D([], [], color=CRACK, linestyle="--", label="path of the tip"),
                         Line2D([], [], color="#2c6e91", label="path of the pick before")], loc="lower right")
    return figure


def failure(run, shown):
    """The cut at several instants."""
    left, right, bottom, top = limits(run)
    figure, panels = panels_of(len(shown), 12, (top - bottom) / (right - left))
    for axes, (seconds, k) in zip(panels, shown.items()):
        CutPicture(run, axes, run.snapshot(k), linewidths=0.2, edgecolors=EDGE)
        frame(axes, (left, right, bottom, top), f"{seconds:.2f} s of cutting")
    return figure if shown else None


def tip(run, shown, paint, words):
    """The tip in the tool's own frame at several instants; paint(axes, shot) -> what a colour bar is drawn of."""
    if not shown:
        return None
    figure, panels = canvas(12, 3.9, 1, len(shown))
    x, y = MM * run.model["outline"][np.argmin(run.model["outline"][:, 1])]
    painted = None
    for axes, (seconds, k) in zip(panels, shown.items()):
        painted = paint(axes, run.snapshot(k)) or painted
        axes.plot(*MM * np.vstack([run.model["outline"], run.model["outline"][:1]]).T, color="black", linewidth=0.8)
        width = MM * WINDOW
        frame(axes, (x - 1.2 * width, x + 0.8 * width, y - 4, y + 2 * width - 4), f"{seconds:.2f} s {words}")
    if painted:
        figure.colorbar(painted, ax=panels, label=painted.get_label(), shrink=0.8)
    return figure


def paint_heat(run, stage=1):
    """A painter of the tool's temperatures, one scale for all of a stage."""
    count = len(run.model["rock_radii"])
    shots = [run.snapshot(k) for k in np.flatnonzero(run.stages == stage)]
    values = [shot["temperature"][count:][shot["alive"]] - 273.15 for shot in shots] or [np.zeros(1)]
    low, high = min(v.min() for v in values), max(v.max() for v in values)
    norm = LogNorm(max(1e-3 * (high - low), 1e-6), max(high - low, 2e-6))

    def paint(axes, shot):
        alive = shot["alive"]
        rise = np.maximum(shot["temperature"][count:][alive] - 273.15 - low, norm.vmin)
        return discs(axes, run.model["tool_positions"][alive], run.model["tool_radii"][alive], array=rise, norm=norm,
                     cmap=WARMTH, linewidths=0, label=f"rise above {low:.1f} °C / K")
    return paint


def paint_wear(run):
    """A painter of the worn depth of the tool's particles."""
    places, radii = run.model["tool_positions"], run.model["tool_radii"]
    norm = Normalize(0, 2 * MM * radii.max())

    def paint(axes, shot):
        alive = shot["alive"]
        worn, sound = alive & (shot["worn_depth"] > 0), alive & ~(shot["worn_depth"] > 0)
        discs(axes, places[sound], radii[sound], facecolors="#dfe3e6", edgecolors="white")
        discs(axes, places[~alive], radii[~alive], facecolors="#f9dcdc", edgecolors="#e08a8a")
        return discs(axes, places[worn], radii[worn], array=MM * shot["worn_depth"][worn], norm=norm, cmap="YlOrRd",
                     edgecolors="#777777", linewidths=0.4, label="worn depth / mm")
    return paint


def shade_cuts(run, axes):
    """Shade the cuts of a figure over time in s."""
    time, stage = run.column("time"), run.column("stage")
    for k in np.unique(stage[stage % 2 == 1]):
        axes.axvspan(time[stage == k].min(), time[stage == k].max(), color="#f3e3c4", zorder=-5, linewidth=0)


# ---- figures over time

def forces(run):
    """Cutting and thrust force over the time of cutting."""
    cutting = run.column("stage") % 2 == 1
    if not cutting.any():
        return None
    step = np.diff(run.column("time"), prepend=0.0)[cutting]
    time = np.cumsum(np.minimum(step, np.median(step)))
    figure, (axes,) = canvas(12, 3.2)
    window = max(1, len(time) // 60)
    top = 0.0
    for name, colour in (("cutting_force", "#b5651d"), ("thrust_force", "#2c6e91")):
        force = 1e-3 * run.column(name)[cutting]
        smooth = running_mean(force, window)
        axes.plot(time, force, color=colour, linewidth=0.5, alpha=0.35)
        axes.plot(time, smooth, color=colour, linewidth=2, label=name.replace("_", " "))
        top = max(top, smooth.max())
    stage = run.column("stage")[cutting]
    for k in np.flatnonzero(np.diff(stage)):
        axes.axvline(time[k], color="#999999", linewidth=0.8)
    axes.axhline(0, color="#999999", linewidth=0.6)
    axes.set(xlabel="time of cutting / s", ylabel="kN/m", ylim=(-0.8 * top, 2.5 * top), xlim=(0, time[-1]))
    axes.legend(loc="upper left", ncols=2)
    return figure


def turns(run):
    """Temperatures of the pick over the turns, and of the same heating repeated."""
    time = run.column("time")
    turn, peak, cooled, mean = run.table("turns.csv", "turn", "peak", "cooled", "mean")
    figure, (axes, *below) = canvas(12, 4 + 3 * bool(len(turn)), 1 + bool(len(turn)), 1)
    shade_cuts(run, axes)
    for name, label, colour, wide in (("tool_temperature_max", "hottest particle", CRACK, 0.8),
                                      ("tool_temperature_hot", "hottest 1 % of the pick", "#b5651d", 1.8),
                                      ("tool_temperature_mean", "mean of the pick", "#444444", 1.8)):
        axes.plot(time, run.column(name) - 273.15, color=colour, linewidth=wide, label=label)
    axes.set(xlabel="time / s", ylabel="°C", xlim=(0, time.max()))
    axes.legend(loc="upper right")
    for axes in below:
        done, found, equal = measured_peaks(run)
        axes.plot(turn, peak - 273.15, "o-", color="#b5651d", markersize=4, label="hottest 1 % at the end of the cut")
        axes.plot(done, found - 273.15, "x", color=CRACK, markersize=8, label="measured peaks")
        axes.plot(done, equal - 273.15, "o", color=CRACK, markersize=8, fillstyle="none", label="the same for equal heat")
        axes.plot(turn, cooled - 273.15, "s-", color="#2c6e91", markersize=4, label="hottest 1 % after cooling")
        axes.plot(turn, mean - 273.15, "-", color="#444444", label="mean of the pick after cooling")
        axes.set(xlabel="turn, each with the mean heating of the cuts above", ylabel="°C", xlim=(0, turn.max() + 1))
        axes.legend(loc="center right", bbox_to_anchor=(1.0, 0.62))
    return figure


def mass_loss(run):
    """Mass lost over time."""
    time, whole = run.column("time"), run.model["tool_volumes"].sum()
    figure, (axes,) = canvas(12, 3.4)
    shade_cuts(run, axes)
    axes.plot(time, 100 * run.column("mass_lost"), color="#444444", linewidth=2, label="particles gone")
    axes.plot(time, 100 * run.column("worn_volume") / whole, color=CRACK, linewidth=1.2, label="worn by Archard's law")
    axes.set(xlabel="time / s", ylabel="% of the pick", xlim=(0, time.max()), ylim=(0, None))
    axes.legend(loc="upper left")
    return figure

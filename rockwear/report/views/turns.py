"""Turns of a pick that cuts and cools: temperatures turn by turn, and its loss of mass."""
import math

import numpy as np

from rockwear.report import palette
from rockwear.report.bodies import has_heat, has_tool
from rockwear.report.curves import draw_wear
from rockwear.report.instants import turns as in_turns
from rockwear.report.page import Section, number, percent, quantity, table
from rockwear.report.plots import KELVIN, canvas, legend, save


def turns(run):
    """Section of the temperature over the turns."""
    if not in_turns(run) or not has_heat(run):
        return None
    return Section("Temperature over the turns, as in [Rojek 2014, fig. 15]", in_words(run),
                   [save(run, "turns", figure(run))])


def mass_loss(run):
    """Section of the mass lost over the turns."""
    if not in_turns(run) or not has_tool(run) or "worn_volume" not in run.columns:
        return None
    return Section("Loss of mass, as in [Rojek 2014, fig. 18]", "Mass lost with particles, and the volume of the wear "
                   "law, which they follow. Shaded: cutting.", [save(run, "mass_loss", mass_figure(run))])


def in_words(run):
    """What the temperature over the turns shows, why measured peaks may not rise, and what worn particles took."""
    made, lost = (run.column(name)[-1:] for name in ("pick_friction_heat", "pick_heat_worn_away"))
    text = ("Shaded: cutting. Below, the mean friction heat of these cuts is repeated from the cold on the pick as it "
            "is worn now, without further wear: peaks rise until the water takes a turn's heat in the same turn. "
            "Crosses are the peaks above. Cuts break the rock each in its own way, and their heat differs: rings are "
            "the same peaks for equal heat, the rise of each cut scaled to the mean heat of all.")
    if len(made) and made[0] > 0 and lost[0] > 0:
        text += (f" Wear is accelerated {quantity(run.parameter('wear_acceleration'), '-')} times. Worn particles took "
                 f"{100 * lost[0] / made[0]:.2g} % of the pick's friction heat with them; what else they stored stayed "
                 "with those under them, so that the field recedes with the surface, as it does under real wear.")
    return text


# ---- numbers

def per_cut(run, name):
    """{turn: growth of a column during its cut}."""
    ends = {n: run.over_stage(name, lambda values: values[-1], 2 * n - 1)
            for n in range(1, run.parameter("cycles", 0) + 1)}
    return {n: ends[n] - (ends[n - 1] if n > 1 else 0.0) for n in ends if np.isfinite(ends[n])}


def measured_peaks(run):
    """Turns, peaks of the hottest part (K), and the same for the mean heat of all cuts: arrays (n,) each."""
    heat = per_cut(run, "pick_friction_heat")
    done = [n for n in heat if heat[n] > 0]
    peak = np.array([run.over_stage("tool_temperature_hot", np.max, 2 * n - 1) for n in done])
    cold = np.array([run.over_stage("tool_temperature_hot", lambda values: values[-1], 2 * n - 2) if n > 1
                     else run.parameter("tool_temperature") for n in done])
    share = np.array([heat[n] for n in done])
    return np.array(done), peak, cold + (peak - cold) * share.mean() / share if done else peak


def turn_by_turn(run):
    """Section of force, temperature, heat and wear by turn."""
    if not in_turns(run):
        return None
    stage = run.column("stage")
    made, lost = per_cut(run, "pick_friction_heat"), per_cut(run, "pick_heat_worn_away")
    cold = run.parameter("tool_temperature")
    rows = [(f"turn {n}", quantity(run.mean_over("cutting_force", stage == 2 * n - 1), "N/m"),
             quantity(run.over_stage("tool_temperature_max", np.max, 2 * n - 1), "K"),
             f"{number(run.over_stage('tool_temperature_hot', np.max, 2 * n - 1) - cold)} K",
             quantity(run.over_stage("tool_temperature_max", np.min, 2 * n), "K"),
             quantity(made.get(n, math.nan), "J/m"), quantity(lost.get(n, math.nan), "J/m"),
             percent(run.over_stage("mass_lost", np.max, 2 * n - 1), 1.0))
            for n in range(1, run.parameter("cycles", 0) + 1) if (stage == 2 * n - 1).any()]
    header = ("", "mean cutting force", "hottest of the tool", "rise of the pick's hottest 1 %",
              "hottest after cooling", "friction heat into the pick", "heat gone with worn particles",
              "mass lost so far")
    return Section("Turn by turn", "", [table(rows, header)]) if rows else None


# ---- figures

def shade_cuts(run, axes):
    """Shade the cuts of a figure over time in s."""
    time, stage = run.column("time"), run.column("stage")
    for k in np.unique(stage[stage % 2 == 1]):
        axes.axvspan(time[stage == k].min(), time[stage == k].max(), color=palette.CUTTING_TIME, zorder=-5, linewidth=0)


def figure(run):
    """Temperatures of the pick over the turns, and of the same heating repeated."""
    time = run.column("time")
    if not len(time):
        return None
    turn, peak, cooled, mean = run.table("turns.csv", "turn", "peak", "cooled", "mean")
    drawn, (axes, *below) = canvas(12, 4 + 3 * bool(len(turn)), 1 + bool(len(turn)), 1)
    shade_cuts(run, axes)
    for name, label, colour, wide in (("tool_temperature_max", "hottest of the tool", palette.TOOL_HEAT, 0.8),
                                      ("tool_temperature_hot", "hottest 1 %", palette.HOTTEST_PART, 1.8),
                                      ("tool_temperature_mean", "mean", palette.MEAN_HEAT, 1.8)):
        axes.plot(time, run.column(name) - KELVIN, color=colour, linewidth=wide, label=label)
    axes.set(xlabel="time / s", ylabel="°C", xlim=(0, time.max()))
    legend(axes)
    for repeated in below:
        done, found, equal = measured_peaks(run)
        repeated.plot(turn, peak - KELVIN, "o-", color=palette.HOTTEST_PART, markersize=4,
                      label="hottest 1 %, end of the cut")
        repeated.plot(done, found - KELVIN, "x", color=palette.TOOL_HEAT, markersize=8, label="measured peaks")
        repeated.plot(done, equal - KELVIN, "o", color=palette.TOOL_HEAT, markersize=8, fillstyle="none",
                      label="the same for equal heat")
        repeated.plot(turn, cooled - KELVIN, "s-", color=palette.COOLED, markersize=4,
                      label="hottest 1 %, after cooling")
        repeated.plot(turn, mean - KELVIN, "-", color=palette.MEAN_HEAT, label="mean, after cooling")
        repeated.set(xlabel="turn, each with the mean heating of the cuts above", ylabel="°C",
                     xlim=(0, turn.max() + 1))
        legend(repeated)
    return drawn


def mass_figure(run):
    """Mass lost over time."""
    time = run.column("time")
    if not len(time):
        return None
    drawn, (axes,) = canvas(12, 3.4)
    shade_cuts(run, axes)
    draw_wear(run, axes, time)
    axes.set(xlabel="time / s", xlim=(0, time.max()), ylim=(0, None))
    return drawn

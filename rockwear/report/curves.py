"""Curves of a run's recorded columns: forces, wear, and any others by their unit."""
import numpy as np

from rockwear.report import palette
from rockwear.report.bodies import tool_volume
from rockwear.report.page import shown_unit, words
from rockwear.report.plots import legend, running_mean, working_hours

FORCES = {"cutting_force": palette.CUTTING, "thrust_force": palette.THRUST, "side_force": palette.SIDEWAYS}
ENERGIES = {"tool_work": palette.WORK, "kinetic_energy": palette.MOTION, "tool_friction": palette.FRICTION,
            "bond_breaking": palette.BREAKING, "rock_crushing": palette.CRUSHING}
CRACKS = {"tensile_cracks": palette.TENSILE, "shear_cracks": palette.SHEAR}
TEMPERATURES = {"tool_temperature_max": palette.TOOL_HEAT, "rock_temperature_max": palette.ROCK_HEAT}
LABELS = {"tool_temperature_max": "hottest of the tool", "rock_temperature_max": "hottest of the rock"}
WEAR = "mass_lost", "worn_volume"
APART = 100.0
"""Columns of one unit whose largest values differ by such a factor get panels of their own."""


def draw_forces(run, axes, time, rows=slice(None)):
    """Components of the force on the tool; the axis holds the running means, peaks may leave it."""
    names = [name for name in FORCES if name in run.columns]
    found = {name: np.nan_to_num(run.column(name)[rows], posinf=0.0, neginf=0.0) for name in names}
    largest = max(abs(force).max(initial=0.0) for force in found.values())
    unit, factor, _ = shown_unit(run.units["cutting_force"], largest)
    window = max(1, len(time) // 40)
    low, high, peak = 0.0, 0.0, 0.0
    for name, force in found.items():
        force = factor * force
        smooth = running_mean(force, window)
        axes.plot(time, force, color=FORCES[name], linewidth=0.6, alpha=0.4)
        axes.plot(time, smooth, color=FORCES[name], linewidth=2, label=words(name))
        low, high, peak = min(low, smooth.min()), max(high, smooth.max()), max(peak, force.max())
    top = min(3 * high, 1.05 * peak) or 1.0
    axes.set(ylabel=unit, ylim=(1.2 * low - 0.02 * top, 1.05 * top))
    legend(axes)


def draw_wear(run, axes, time):
    """Mass lost, and the volume that the wear law asks for, as a share of the tool."""
    if np.isfinite(run.column("mass_lost")).any():
        axes.plot(time, 100 * run.column("mass_lost"), color=palette.MASS_LOST, drawstyle="steps-post",
                  label="mass lost")
    volume = tool_volume(run)
    axes.plot(time, 100 * run.column("worn_volume") / volume, color=palette.WORN, label="worn by the wear law")
    axes.set_ylabel("% of the tool")
    legend(axes)
    working_hours(run, axes)


def draw_columns(run, axes, time, names, label=""):
    """Columns of one unit; names: {column: colour}; label: of the axis where the unit says too little."""
    shown, factor, added = shown_unit(run.units[next(iter(names))], max(largest_value(run, name) for name in names))
    for name, colour in names.items():
        axes.plot(time, factor * run.column(name) + added, color=colour, label=LABELS.get(name, words(name)))
    axes.set_ylabel(label or shown)
    legend(axes)


def by_unit(run, names):
    """[{column: colour}] of columns of one unit and of like size."""
    groups = []
    for name in sorted(names, key=lambda name: largest_value(run, name), reverse=True):
        group = next((group for group in groups if alike(run, group[0], name)), None)
        if group is None:
            groups.append(group := [])
        group.append(name)
    order = {name: k for k, name in enumerate(run.columns)}
    groups = sorted((sorted(group, key=order.get) for group in groups), key=lambda group: order[group[0]])
    return [dict(zip(group, palette.OTHER_LINES * len(group))) for group in groups]


def alike(run, first, second):
    """True for columns of one unit, the second at most APART times smaller, or nothing at all."""
    if run.units[first] != run.units[second]:
        return False
    small, large = largest_value(run, second), largest_value(run, first)
    return run.units[first] == "K" or small == 0 or large <= APART * small


def largest_value(run, name):
    """Largest size of a column's finite values."""
    values = abs(run.column(name))
    return values[np.isfinite(values)].max(initial=0.0)

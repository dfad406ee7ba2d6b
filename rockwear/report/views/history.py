"""What was recorded over time: forces, energy, cracks, wear, temperature, and whatever else a run records."""
from rockwear.report.curves import (
    CRACKS, ENERGIES, FORCES, TEMPERATURES, WEAR, by_unit, draw_columns, draw_forces, draw_wear)
from rockwear.report.instants import turns
from rockwear.report.page import Section
from rockwear.report.plots import canvas, save, time_axis, times


def history(run):
    """Section of the history. Not of a tool that cools most of the time, its cuts would be lines; not of benchmarks,
    which are many short runs."""
    if turns(run) or run.has("heat_cases"):
        return None
    text = "Every recorded quantity over time, stage by stage."
    if "cutting_force" in run.columns:
        text += " Thin lines of the forces are the record, thick ones a running mean."
    if run.parameter("wear_acceleration", 0.0) not in (0.0, 1.0) and "working_time" in run.columns:
        text += " The upper axis of the wear is the working time that the accelerated wear stands for."
    return Section("History", text, [save(run, "history", figure(run))])


def figure(run):
    """A panel a quantity."""
    time, _ = times(run)
    drawers = panels_of(run)
    if not len(time) or not drawers:
        return None
    drawn, panels = canvas(12, 0.6 + 2.2 * len(drawers), len(drawers), sharex=True)
    for draw, axes in zip(drawers, panels):
        draw(run, axes, time)
    time_axis(run, panels)
    return drawn


def panels_of(run):
    """[draw(run, axes, time)], a panel each."""
    def columns(names, label=""):
        return lambda run, axes, time: draw_columns(run, axes, time, names, label)

    def recorded(names):
        return {name: colour for name, colour in names.items() if name in run.columns}

    known = {"time", "stage", "working_time", *FORCES, *ENERGIES, *CRACKS, *TEMPERATURES, *WEAR}
    energies, cracks, temperatures = map(recorded, (ENERGIES, CRACKS, TEMPERATURES))
    bonded = len(run.model.get("bonds", (None,)))
    others = by_unit(run, [name for name in run.columns if name not in known])
    return [*([draw_forces] if "cutting_force" in run.columns else []), *([columns(energies)] if energies else []),
            *([columns(cracks, "broken bonds")] if cracks and bonded else []),
            *([draw_wear] if "worn_volume" in run.columns else []), *([columns(temperatures)] if temperatures else []),
            *map(columns, others)]

"""One tool at several speeds: its tip's temperature over time, its fields, transient and quasi-stationary."""
import numpy as np

from rockwear.report import palette
from rockwear.report.bodies import has_heat, place, tip
from rockwear.report.folder import read_history
from rockwear.report.instants import stage_name
from rockwear.report.page import Section, number, quantity, table
from rockwear.report.plane import paint_temperature
from rockwear.report.plots import KELVIN, MM, canvas, discs, frame, legend, rise_scale, save

KINDS = {"pass": "after the pass", "fixed": "quasi-stationary, shank at its temperature",
         "insulated": "quasi-stationary, shank insulated"}
SOFTEST = 600 + KELVIN
"""K, where the table of steel's hardness ends."""


def speed_tables(run):
    """Section of the temperatures and the wear at each speed."""
    if not shows(run):
        return None
    names = speeds(run)
    stages = ", ".join(f"{stage_name(run, k)} at {u} m/s" for k, u in enumerate(names, 1))
    return Section("Temperature at several speeds", "A pass at each speed, all of the same way through the rock, then "
                   f"the mean load of the pass on the tool alone. The mechanics run at "
                   f"{quantity(run.parameter('velocity', 0), 'm/s')}, heat in the time of the process. Below, "
                   f"{stages}; stages after these wear the tool, from either field.",
                   [speed_table(run, names), wear_table(run)])


def tip_over_time(run):
    """Section of the hottest particle over time."""
    if not shows(run):
        return None
    return Section("Tip over time", "Hottest particle of the tool. Thick: the pass as simulated. Thin: the tool alone "
                   "under the mean load from there on. Dotted: where it ends. Steel softens from some 300 °C on and "
                   "has no hardness in the table above 600 °C: lines up there say that the tool would not hold, not "
                   "how hot it gets.",
                   [save(run, "tip_over_time", tip_figure(run))])


def fields(run):
    """Section of the tool's temperature field at each speed."""
    if not shows(run):
        return None
    return Section("Tool at each speed", "After the pass, and what the mean load ends in; each picture has its own "
                   "scale.", [save(run, "fields", field_figure(run))])


def near_the_tip(run):
    """Section of rock and tool after the pass of each speed."""
    if not shows(run):
        return None
    return Section("Rock and tool after the passes", "Near the tip, rise above the first temperature.",
                   [save(run, "near_the_tip", near_figure(run))])


def shows(run):
    """True for a run with fields of the tool at several speeds."""
    return has_heat(run) and (run.path / "tool_fields.csv").exists()


def speeds(run):
    """Speeds of the process as they are written in names."""
    return [f"{float(word):g}" for word in run.parameter("velocities", "").split(",")
            if np.isfinite(run.result(f"hottest_after_the_pass_{float(word):g}"))]


def speed_table(run, names):
    """Heat and temperatures at each speed."""
    kinds = "after_the_pass", "fixed_shank", "insulated_shank"
    rows = [(f"{u} m/s", f"{number(1e-3 * run.result(f'friction_heat_of_the_tool_{u}'))} kW/m",
             f"{number(run.result(f'conductance_to_the_rock_{u}'))} W/mK",
             *(quantity(run.result(f"hottest_{kind}_{u}"), "K") for kind in kinds))
            for u in names]
    return table(rows, ("", "friction heat into the tool", "conductance to the rock",
                        *(f"hottest {kind}" for kind in KINDS.values())))


def wear_table(run):
    """Wear of the last passes, from either field."""
    rows = [(f"from the field of the {shank} shank", quantity(run.result(f"worn_volume_from_{shank}_shank"), "m3/m"),
             f"{number(100 * run.result(f'mass_lost_from_{shank}_shank'))} %") for shank in ("fixed", "insulated")
            if np.isfinite(run.result(f"worn_volume_from_{shank}_shank"))]
    header = f"wear at {run.parameter('wear_velocity', 0)} m/s", "by the wear law", "mass lost"
    return table(rows, header) if rows else ""


def tip_figure(run):
    """Rise of the hottest particle over the time of the process, both axes logarithmic."""
    columns, _ = read_history(run.path / "warming.csv")
    start = run.parameter("tool_temperature", 293.15)
    stage, time, hottest = (run.column(name) for name in ("stage", "time", "tool_temperature_max"))
    figure, (axes,) = canvas(12, 5.5)
    for k, (u, colour) in enumerate(zip(speeds(run), palette.SPEEDS), 1):
        here = stage == k
        if here.any():
            passed = (time[here] - time[stage < k].max()) * run.parameter("velocity", 1.0) / float(u)
            axes.plot(passed, hottest[here] - start, color=colour, linewidth=3, label=f"{u} m/s")
        for shank, style in (("insulated", "-"), ("fixed", "--")):
            axes.plot(columns[f"time_{shank}_{u}"], columns[f"{shank}_{u}"] - start, color=colour, linestyle=style,
                      linewidth=1)
            axes.axhline(run.result(f"hottest_{shank}_shank_{u}") - start, color=colour, linestyle=":", linewidth=1,
                         xmin=0.93 if shank == "insulated" else 0.9)
    axes.plot([], [], color=palette.OUTLINE, linewidth=1, label="mean load, shank insulated")
    axes.plot([], [], color=palette.OUTLINE, linestyle="--", linewidth=1, label="mean load, shank at its temperature")
    axes.axhline(SOFTEST - start, color=palette.GUIDE, linewidth=0.8)
    axes.text(0.01, SOFTEST - start, "end of the hardness table", transform=axes.get_yaxis_transform(), va="bottom",
              color=palette.REMARK)
    axes.set(xscale="log", yscale="log", xlabel="time of the process / s", ylabel="rise of the hottest particle / K")
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, 1e-6 * high), 2 * high)
    legend(axes)
    return figure


def field_figure(run):
    """The tool at each speed: after the pass, and quasi-stationary with either shank."""
    columns, _ = read_history(run.path / "tool_fields.csv")
    places, radii, names = np.column_stack([columns["x"], columns["y"]]), columns["radius"], speeds(run)
    outline = MM * run.model["outline"]
    size = np.ptp(outline, axis=0)
    limits = (outline[:, 0].min() - 2, outline[:, 0].max() + 2, outline[:, 1].min() - 2, outline[:, 1].max() + 2)
    figure, panels = canvas(12, len(KINDS) * (4 * size[1] / size[0] * 0.75 + 0.4), len(KINDS), len(names))
    for axes, (kind, u) in zip(panels, [(kind, u) for kind in KINDS for u in names]):
        celsius = columns[f"{kind}_{u}"] - KELVIN
        painted = discs(axes, places, radii, array=celsius, cmap=palette.TEMPERATURE, linewidths=0)
        frame(axes, limits, f"{u} m/s, {KINDS[kind]}\nhottest {number(celsius.max())} °C")
        axes.title.set_fontsize(9)
        axes.tick_params(labelsize=7)
        figure.colorbar(painted, ax=axes, shrink=0.7, format="%.4g").ax.tick_params(labelsize=7)
    return figure


def near_figure(run):
    """Rock and tool at the end of the pass of each speed."""
    ends, names = run.stage_ends(), speeds(run)
    shots = [(u, run.snapshot(ends[k])) for k, u in enumerate(names, 1) if k in ends]
    if not shots:
        return None
    cold = min(float(np.nanmin(shot["temperature"])) for _, shot in shots)
    norm = rise_scale(max(float(np.nanmax(shot["temperature"])) for _, shot in shots) - cold)
    figure, panels = canvas(12, 4.4, 1, len(shots))
    for axes, (u, shot) in zip(panels, shots):
        painted = paint_temperature(axes, run, shot, cold, norm)
        x, y = MM * place(shot, tip(run)[None])[0]
        frame(axes, (x - 10, x + 20, y - 10, y + 20), f"{u} m/s")
    figure.colorbar(painted, ax=panels, label="rise / K", shrink=0.8)
    return figure

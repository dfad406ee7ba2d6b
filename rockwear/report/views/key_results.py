"""The numbers an engineer looks for first, whatever of them a run has."""
import math

import numpy as np

from rockwear.report import published
from rockwear.report.bodies import has_particles, in_space, keeps_shape
from rockwear.report.folder import work_entry
from rockwear.report.instants import cutting, turns
from rockwear.report.page import Section, duration, number, percent, quantity, tiles, with_error, words


def key_results(run):
    """Section of the numbers."""
    makers = (force_tiles, wear_tiles, heat_tiles, strength_tiles, sliding_tiles, granular_tiles, error_tiles,
              model_tiles, cost_tiles)
    shown = [tile for make in makers for tile in make(run) if tile]
    return Section("Key results", summary_line(run), [tiles(shown)])


def tile(value, label, text, remark=""):
    """(label, text, remark); None where the value that the text shows is not known."""
    return (label, text, remark) if math.isfinite(value) else None


def result(run, label, name, remark=""):
    """The tile of a result in its own unit, with its standard error if it has one."""
    value, error, unit = run.result(name), run.result(f"{name}_standard_error"), run.unit(name)
    return tile(value, label, with_error(value, error, unit), remark)


# ---- the run in a line

def summary_line(run):
    """What was done."""
    phrases = [
        parameter(run, "test", "", "{} test"), parameter(run, "bond_law", "", "{} bonds"),
        parameter(run, "speed", "m/s", "each platen at {}"),
        speed(run), parameter(run, "swing", "m/s", "swing {}"),
        parameter(run, "depth_of_cut", "m", "depth of cut {}"),
        parameter(run, "distance", "m", "{} of the laboratory test"),
        found(run, "simulated_distance", "m", "simulated as {}"), found(run, "simulated_time", "s", "{} simulated"),
        parameter(run, "cycles", "-", "{} turn" + "s" * (run.parameter("cycles") != 1)) if turns(run) else "",
        parameter(run, "time_scale", "-", "mechanics {} times as fast as heat", (1,)),
        parameter(run, "wear_acceleration", "-", "wear accelerated {} times", (0, 1)),
        parameter(run, "grading_factor", "-", "rock graded up to {} times as coarse", (1,)),
        parameter(run, "scale_factor", "-", "rock radii {} times those of the source", (1,))]
    line = ", ".join(filter(None, phrases))
    return f"{line[:1].upper()}{line[1:]}." if line else ""


def parameter(run, name, unit, text, unless=()):
    """A phrase with a parameter, empty where the run does not have it or it has one of the values `unless`."""
    value = run.parameters.get(name)
    return "" if value is None or value in unless else text.format(quantity(value, unit))


def found(run, name, unit, text):
    """A phrase with a result, empty where the run does not have it."""
    return text.format(quantity(run.result(name), unit)) if math.isfinite(run.result(name)) else ""


def speed(run):
    """How fast the tool moves."""
    around = run.parameter("angular_velocity") * run.parameter("cutter_radius")
    return f"{number(around)} m/s around the axis" if math.isfinite(around) else parameter(run, "velocity", "m/s", "{}")


# ---- tiles

def force_tiles(run):
    """Forces, energy and cracks."""
    at_work = cutting(run)
    remark = "while it cuts" if len(at_work) and not at_work.all() else ""
    return [result(run, "mean cutting force", "mean_cutting_force", remark),
            result(run, "peak cutting force", "peak_cutting_force", remark),
            result(run, "mean peak of a chip", "mean_peak_cutting_force"),
            result(run, "mean thrust force", "mean_thrust_force", remark),
            result(run, "specific energy", "specific_energy"),
            result(run, "overbreak", "overbreak", "below the path, exceeded on 10 % of the length"),
            result(run, "chip length", "chip_length", "mean by area"), crack_tile(run)]


def crack_tile(run):
    """Cracks of both kinds, at the end and, where it is known, at the peak."""
    if not len(run.model.get("bonds", (None,))):
        return None
    cracks, at_peak = ({kind: run.result(f"{kind}_cracks{when}") for kind in ("tensile", "shear")
                        if math.isfinite(run.result(f"{kind}_cracks{when}"))} for when in ("", "_at_peak"))
    remark = f", {' + '.join(map(number, at_peak.values()))} at the peak" if at_peak else ", in all rock that was cut"
    return ("cracks", " + ".join(map(number, cracks.values())), " + ".join(cracks) + remark) if cracks else None


def wear_tiles(run):
    """Wear of the tool; none where nothing could wear."""
    coefficient = "wear_modes" if run.parameters.get("wear_law") == "modes" else "wear_coefficient"
    no_wear = 0 in (run.parameters.get("wear_acceleration"), run.parameters.get(coefficient))
    if no_wear or math.isfinite(run.result("k_given")):
        return []
    removed, kept = run.result("particles_removed"), keeps_shape(run)
    depth_remark = "that a facet would go back" if kept else "from the new surface to the worn one"
    if has_particles(run) and in_space(run):
        depth_remark = f"[Rojek 2003, 13.3]: {quantity(published.value('m-13.3-depth'), 'm')}"
    return [tile(run.result("mass_lost"), "mass lost", percent(run.result("mass_lost"), 1.0),
                 f"{number(removed)} particles removed" if math.isfinite(removed) else ""),
            result(run, "worn volume", "worn_volume", "by the wear law" + ("; the shape is kept" if kept else "")),
            result(run, "maximum wear depth", "maximum_wear_depth", depth_remark),
            result(run, "recession over slip", "recession_per_slip", "wear is relieved where it is not small")]


def heat_tiles(run):
    """Temperatures and heat."""
    water = float(run.column("water_heat")[-1]) if run.rows else math.nan
    return [result(run, "hottest tool", "tool_temperature_max"), result(run, "hottest rock", "rock_temperature_max"),
            tile(water, "heat to the water", f"{number(1e-3 * water)} kJ/m", "from pick and rock"),
            tile(water, "levels off after", levelling(run), "of the same cut again and again")]


def levelling(run):
    """Turns until the peak is within 5 % of its final rise above the new tool's temperature, or of its fall below."""
    turn, peak = run.table("turns.csv", "turn", "peak")
    if len(peak) < 2:
        return "not known"
    change = abs(peak - run.parameter("tool_temperature", 0.0))
    before = np.flatnonzero(abs(change - change[-1]) > 0.05 * change[-1])
    count = int(turn[before[-1] + 1 if len(before) else 0])
    return f"{count} turn" + "s" * (count != 1)


def strength_tiles(run):
    """Strength and stiffness of a specimen."""
    modulus = run.result("youngs_modulus")
    return [result(run, "strength" if run.result("failed") else "peak stress, not failed", "peak_stress",
                   f"at a strain of {percent(run.result('peak_strain'), 1)}"),
            tile(modulus, "Young's modulus", f"{number(modulus / 1e9)} GPa", "between 10 and 25 % of the peak"),
            result(run, "Poisson's ratio", "poissons_ratio")]


def sliding_tiles(run):
    """What a laboratory wear test gives back."""
    given, returned, deviation = (run.result(name) for name in ("k_given", "k_returned", "k_deviation"))
    if not math.isfinite(given):
        return []
    return [tile(given, "k given", number(given)),
            tile(returned, "k returned", number(returned), "what the law needs for this depth"),
            tile(deviation, "k off by", percent(deviation, 1.0), "of what was given"),
            result(run, "worn depth", "worn_depth", f"by the law {quantity(run.result('expected_depth'), 'm')}"),
            result(run, "descent of the block", "descent", "in whole particles"), result(run, "pressure", "pressure"),
            result(run, "temperature", "temperature_end", "at the end"),
            ("particles removed", f"{run.result('particles_removed')} of {run.result('tool_particles')}", "")]


def granular_tiles(run):
    """Heap and tube of loose grains."""
    filled, gravity = run.result("tube_fill"), run.result("tube_fill_by_gravity")
    known = run.result("angle_zhou_2002")
    remark = f"Zhou and others (2002): {number(known)} deg" if math.isfinite(known) else ""
    return [result(run, "angle of repose", "angle_of_repose", remark), result(run, "heap height", "heap_height"),
            result(run, "sand in the tube", "tube_mass"),
            tile(filled, "of the tube", percent(filled, 1.0), f"by gravity alone {percent(gravity, 1.0)}"),
            result(run, "inflow", "inflow_rate", "mean while it vibrates"),
            result(run, "peak acceleration", "peak_acceleration")]


def error_tiles(run):
    """Largest errors of the heat benchmarks, by packing."""
    def worst(packing, kind):
        return max((run.result(name) for name in run.summary.get("results", {})
                    if name.endswith(f"_{packing}_{kind}_error")), default=math.nan)

    return [tile(worst(packing, "largest"), f"largest error, {packing}", percent(worst(packing, "largest"), 1.0),
                 f"root mean square {percent(worst(packing, 'rms'), 1.0)}")
            for packing in ("random", "square", "triangular")]


def model_tiles(run):
    """Size of the model, time step, and what the energy balance misses."""
    pieces = {"rock": "rock_particles", "tool": "tool_particles", "facets of the tool": "facets"}
    count = {label: run.result(name) for label, name in pieces.items() if math.isfinite(run.result(name))}
    step, critical, energy = (run.result("time_step"), run.result("critical_time_step"),
                              run.balances.get("energy", {}))
    work = work_entry(energy)
    missed = percent(energy.get("residual", math.nan), energy.get(work, 0.0))
    return [tile(run.result("rock_particles"), "particles", " + ".join(map(number, count.values())), " + ".join(count)),
            tile(step, "time step", f"{number(1e9 * step)} ns" if step < 1e-6 else f"{number(1e6 * step)} µs",
                 f"{percent(step, critical)} of the critical" if math.isfinite(critical) else ""),
            ("energy residual", missed, f"of the {words(work)}") if work else None]


def cost_tiles(run):
    """What the run cost."""
    wall = run.summary.get("wall_time", {})
    total, loop, python = (wall.get(name, math.nan) for name in ("total", "loop", "python_engines"))
    memory = run.summary.get("peak_memory", {}).get("value", math.nan)
    engines = f"Python engines {percent(python, loop)} of the loop" if math.isfinite(python) else ""
    return [tile(total, "wall time", duration(total), engines),
            tile(memory, "peak memory", quantity(memory, "bytes"))]

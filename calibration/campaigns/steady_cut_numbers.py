"""What the runs of campaigns.steady_cut are measured by: a cut, the packings of a case, two cases beside each other."""
import json
import math

import numpy as np

from calibration.campaigns.steady_cut_cases import (
    BASE, CUT, CUTS, MORE_SEEDS, PULLED, changed_from, rock_of, slug)
from calibration.campaigns.runs import existing
from rockwear.kernels import steady_record
from rockwear.kernels.fragments import chip_length
from rockwear.kernels.groove import groove_results
from rockwear.kernels.steady_record import Measured

BEGIN = 3
"""Depths of cut that do not count: the tool has passed the slope at which it begins, which is 2.7 long."""
LOAD = 0.1
"""Part of the mean peak above which the tool is under load."""
IN_TENSION = 1
"""Mode of a crack (cracks.csv) on which more work was spent in tension than in slip."""
WARM = 12
"""Depths of cut up to which the tool warms in every cut, however long."""
COLUMNS = {"specific energy / UCS": "energy", "mean Fc, kN/m": "force", "peak / mean": "peaks",
           "of packings abreast": "abreast",
           "overbreak / depth": "overbreak", "chip length / depth": "chip", "mean Fn, kN/m": "pressed",
           "thrust / cutting": "thrust",
           "friction work, kN/m": "friction", "tool warmer by, K": "temperature",
           "way under load": "loaded", "work in bonds": "bonds",
           "in tension": "tension", "in crushing": "crushing"}
"""{heading: quantity}."""


def runs_of(folder, *words):
    """{seed: RunFolder} of the packings that exist."""
    places = {seed: folder / slug(*words, seed) for seed in MORE_SEEDS}
    return existing(places)


def strengths(folder, rock, test="compression"):
    """(k,) Pa, of the packings that exist."""
    name = {"compression": "peak_stress", "tension": "tensile_strength"}[test]
    return np.array([run.result(name) for run in runs_of(folder / "lab", rock, test).values()])


def tensions(folder, case):
    """(k,) Pa, tensile strengths of the rock of a case; of the base where its bonds are the base's."""
    rock = rock_of(case)
    return strengths(folder, rock if rock in PULLED else BASE, "tension")


def of_forces(distance, cutting, thrust, friction, *, depth, begin):
    """({quantity: Measured}, steady_record.Peaks) of what steady_record.steady_results takes, from `begin` (m) on;
    forces and friction in thousands of their units."""
    total, pressed = (steady_record.integral(distance, force) for force in (cutting, thrust))
    mean = steady_record.mean(distance, total, begin)
    peaks = steady_record.peaks(distance, cutting, depth=depth, begin=begin)
    return {"force": scaled(mean, 1e-3), "peak": scaled(peaks.mean(), 1e-3),
            "peaks": steady_record.quotient(peaks.mean(), mean),
            "thrust": steady_record.ratio(distance, pressed, total, begin),
            "pressed": scaled(steady_record.mean(distance, pressed, begin), 1e-3),
            "friction": scaled(steady_record.mean(distance, friction, begin), 1e-3)}, peaks


def of_run(run):
    """{quantity: Measured} of one cut, from BEGIN depths of cut on."""
    depth = run.parameter("depth_of_cut")
    begin = BEGIN * depth
    distance, cutting, thrust, friction = (run.column(name) for name in (
        "distance", "cutting_force", "thrust_force", "tool_friction"))
    found, peaks = of_forces(distance, cutting, thrust, friction, depth=depth, begin=begin)
    spacing = np.ptp(peaks.distance) / (len(peaks.force) - 1) if len(peaks.force) > 1 else math.nan
    x, height = run.table("groove.csv", "x", "height")
    groove = groove_results(x=x[x > begin], height=height[x > begin], chip=float(spacing))
    way, particles, area, length = run.table("chips.csv", "distance", "particles", "area", "length")
    late = way > begin
    chip = chip_length(particles=particles[late], area=area[late], length=length[late])
    overbreak = Measured(groove["overbreak"][0], groove["overbreak_standard_error"][0])
    energy, (work, mode) = run.balances["energy"], run.table("cracks.csv", "energy", "mode")
    return {**found, "energy": scaled(found["force"], 1e3 / depth), "overbreak": scaled(overbreak, 1 / depth),
            "chip": scaled(chip, 1 / depth), "temperature": Measured(warmth(run, begin, WARM * depth), math.nan),
            "loaded": under_load(distance, cutting, peaks.mean().value, begin),
            "bonds": Measured(energy["bond_breaking"] / energy["tool_work"], math.nan),
            "tension": Measured(float(work[mode == IN_TENSION].sum()) / energy["tool_work"], math.nan),
            "crushing": Measured(energy["rock_crushing"] / energy["tool_work"], math.nan)}


def warmth(run, begin, end):
    """K by which the tool's hottest place is warmer than the tool was, in the mean of this part of the way (m); nan
    without heat."""
    distance = run.column("distance")
    there = (distance > begin) & (distance <= end)
    warmer = run.column("tool_temperature_max")[there] - run.parameter("tool_temperature")
    return float(warmer.mean()) if there.any() else math.nan


def abreast(runs):
    """Measured mean peak over mean of the mean force of these runs, from BEGIN depths of cut on: of a tool so many
    chips wide, each of which breaks on its own."""
    depth = runs[0].parameter("depth_of_cut")
    records = [[run.column(name) for name in ("distance", "cutting_force")] for run in runs]
    way = np.linspace(0.0, min(distance[-1] for distance, _ in records), max(len(record[0]) for record in records))
    total = np.mean([np.interp(way, distance, steady_record.integral(distance, force))
                     for distance, force in records], axis=0)
    peaks = steady_record.peaks(way, np.diff(total, prepend=0.0) / way[1], depth=depth, begin=BEGIN * depth)
    return steady_record.quotient(peaks.mean(), steady_record.mean(way, total, BEGIN * depth))


def under_load(distance, cutting, peak, begin):
    """Measured part of the way on which the cutting force is above LOAD of the mean peak; unknown without peaks."""
    if math.isnan(peak):
        return steady_record.UNKNOWN
    return steady_record.mean(distance, steady_record.integral(distance, cutting > LOAD * peak), begin)


def scaled(measured, factor):
    """A Measured in another unit."""
    return Measured(measured.value * factor, measured.standard_error * factor)


def over_packings(values):
    """Measured mean of [Measured], one a packing: its error from the scatter of three or more, else from their own."""
    known = [one for one in values if math.isfinite(one.value)]
    if not known:
        return steady_record.UNKNOWN
    if len(known) > 2:
        return steady_record.sample_mean([one.value for one in known])
    return Measured(float(np.mean([one.value for one in known])),
                    math.sqrt(sum(one.standard_error**2 for one in known)) / len(known))


def of_case(folder, case):
    """{quantity: Measured}, with {seed: {quantity: Measured}} as "each", the number of packings and minutes per metre;
    None without a run."""
    of_seed = runs_of(folder / "cut", case)
    if not of_seed:
        return None
    runs, each = list(of_seed.values()), {seed: of_run(run) for seed, run in of_seed.items()}
    found = {name: over_packings([one[name] for one in each.values()]) for name in each[min(each)]}
    found["abreast"] = abreast(runs) if len(runs) > 1 else steady_record.UNKNOWN
    ucs = strengths(folder, rock_of(case))
    found["ucs"] = steady_record.sample_mean(1e-6 * ucs)
    found["tensile_strength"] = steady_record.sample_mean(1e-6 * tensions(folder, case))
    found["specific_energy"] = scaled(found["energy"], 1e-6)
    found["energy"] = scaled(found["energy"], 1e-6 / found["ucs"].value)
    way = [run.parameter("cut_length") + run.parameter("ramp_length") for run in runs]
    minutes = [run.summary["wall_time"]["total"] / 60 for run in runs]
    missed = [run.balances["energy"]["residual"] / run.balances["energy"]["tool_work"] for run in runs]
    return {**found, "each": each, "packings": len(runs), "version": runs[0].summary["versions"]["rockwear"],
            "cost": sum(minutes) / sum(way),
            "missed": max(map(abs, missed)),
            "way": sum(run.parameter("cut_length") / run.parameter("depth_of_cut") - BEGIN for run in runs)}


def keep(found, path):
    """Write {case: row of of_case}, so that cases can stand in a table without their runs: `kept` reads them."""
    lines = ",\n".join(f"{json.dumps(case)}: {json.dumps(row)}" for case, row in found.items())
    path.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


def kept(path):
    """{case: row of of_case} of a file that `keep` wrote."""
    found = json.loads(path.read_text(encoding="utf-8"))
    for row in found.values():
        row["each"] = {int(seed): _measured(one) for seed, one in row["each"].items()}
    return {case: _measured(row) for case, row in found.items()}


def _measured(row):
    return {name: Measured(*value) if isinstance(value, list) else value for name, value in row.items()}


def shown(measured):
    """Value ± standard error."""
    if not math.isfinite(measured.value):
        return "–"
    error = measured.standard_error
    return f"{measured.value:.3g}" + (f" ± {error:.2g}" if math.isfinite(error) else "")


def force_over(found, case, what):
    """Measured slope of the mean force over one parameter, of a case and those that differ from it in that alone: the
    mean of the slopes in each of the packings that all have; unknown with fewer than three."""
    rows = {CUTS.get(name, {}).get(what, CUT[what]): row.get("each", {}) for name, row in found.items()
            if case in found and (name == case or (changed_from(name) == case and what in CUTS.get(name, {})))}
    seeds = set.intersection(*map(set, rows.values())) if len(rows) > 1 else ()
    if len(seeds) < 3:
        return steady_record.UNKNOWN
    return steady_record.sample_mean([float(np.polyfit(list(rows), [each[seed]["force"].value for each in
                                                                    rows.values()], 1)[0]) for seed in sorted(seeds)])


def difference(row, other, what):
    """Measured difference of a quantity of two cases: where they have three packings in common, the mean of what it is
    in each, else that of two independent ones."""
    seeds = sorted(row.get("each", {}).keys() & other.get("each", {}).keys())
    if len(seeds) > 2:
        return steady_record.sample_mean([row["each"][seed][what].value - other["each"][seed][what].value
                                          for seed in seeds])
    one, other = row[what], other[what]
    return Measured(one.value - other.value, math.hypot(one.standard_error, other.standard_error))

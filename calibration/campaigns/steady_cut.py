"""What makes a steady cut what it is: causes one at a time, from a rock whose chips come off as a rock's do.

    python3 -m calibration.campaigns.steady_cut DIR [CASE ...] [--read] [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Each rock is also crushed in
the laboratory, and the base pulled, in the same packings. Writes into DIR steady_cut.md (tables), steady_cut.csv,
figures of the base, of the finest discs and over their number (steady_cut*.png), and provenance.json.
"""
import csv
import math
import sys

import matplotlib
import numpy as np
from scipy import stats

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, wait_for
from rockwear.kernels import cutting_theory, steady_record
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cut_sizes import cut_sizes
from rockwear.kernels.cutting_envelope import (
    ENERGY_TARGET, OVERBREAK_TARGET, PEAKS_TARGET, RELATIONS, SCRATCH_DEPTHS, SCRATCH_ENERGY, SCRATCH_STRENGTH,
    SCRATCH_THRUST, expected, exponent)
from rockwear.kernels.fragments import chip_length
from rockwear.kernels.groove import groove_results
from rockwear.kernels.steady_record import Measured
from rockwear.report import plane, plots
from rockwear.report.folder import RunFolder
from rockwear.report.views import cut, steady

SCRIPT, UNIAXIAL = "yade_scripts/steady_cut.py", "yade_scripts/uniaxial.py"
BASE, EIGHT, FINEST = "base", "eight discs", "32 discs"
SEEDS, MORE_SEEDS = (1, 2, 3), (1, 2, 3, 4, 5, 6)
"""Packings of each case, and of those at FLATS_DEPTH."""
BEGIN = 3
"""Depths of cut that do not count: the tool has passed the slope at which it begins, which is 2.7 long."""
LOAD = 0.1
"""Part of the mean peak above which the tool is under load."""
IN_TENSION = 1
"""Mode of a crack (cracks.csv) on which more work was spent in tension than in slip."""

ROCK = dict(rock="crushing_sandstone")
CUT = dict(depth_of_cut=5e-3, discs_per_depth=16, rake=-5.0, velocity=8.0, snapshot_period=5e-4, cut_length=0.06)
SHORT = 0.03
"""m of way with small discs."""
SLOWER = dict(velocity=4.0, snapshot_period=1e-3)
"""Half as fast, with as many pictures over the way."""
FLATS_DEPTH = 1.25e-3
"""m, at which the groove is left near the tool's path: a flat rubs there, as on scratches."""
DEPTHS = 0.3125e-3, FLATS_DEPTH, 0.02
"""m of other cuts, half as fast, all lengths of which follow their depth: 16 and 4 times less, and 4 times more."""
BOX = dict(width=0.02, height=0.01)
"""Of the laboratory, m; loaded along its length; as much larger or smaller as the discs are."""
SPEEDS = {"compression": 0.04, "tension": 0.02}
"""Of each platen, m/s."""


def at_depth(depth):
    """Parameters of a cut that is as CUT, but for its size. depth: m."""
    size = depth / CUT["depth_of_cut"]
    return dict(depth_of_cut=depth, tip_radius=5e-4 * size, cut_length=CUT["cut_length"] * size,
                velocity=SLOWER["velocity"], snapshot_period=SLOWER["snapshot_period"] * size)


def strengths_times(factor):
    """Bonds of ROCK with strengths so many times theirs, and the same lengths K^2 / strength^2."""
    return dict(bond_tension=3e6 * factor, bond_cohesion=8.5e6 * factor, bond_crushing=480e6 * factor,
                bond_fracture_energy=90.0 * factor**2, bond_shear_energy=1000.0 * factor**2)


def depth_case(depth):
    """Name of the case at this depth of cut (m)."""
    return f"{EIGHT}, depth {1e3 * depth:.2g} mm"


ROCKS = {
    BASE: ROCK,
    EIGHT: dict(ROCK, discs_per_depth=8),
    FINEST: dict(ROCK, discs_per_depth=32),
    **{depth_case(depth): dict(ROCK, discs_per_depth=8, **at_depth(depth)) for depth in DEPTHS},
    **{f"{EIGHT}, {name}": dict(ROCK, discs_per_depth=8, **change) for name, change in {
        "strengths halved": strengths_times(0.5),
        "strengths times 1.4": strengths_times(1.4),
        "bentheim": dict(rock="bentheim"),
        "medium_sandstone": dict(rock="medium_sandstone"),
        "p_sandstone": dict(rock="p_sandstone"),
        "no crushing": dict(bond_crushing=0.0),
        "crushing 150 MPa": dict(bond_crushing=150e6),
        "no grains": dict(grain_edge=0.0),
        "Weibull modulus 2": dict(weibull_modulus=2.0),
        "fracture energy 30": dict(bond_fracture_energy=30.0),
        "fracture energy 5": dict(bond_fracture_energy=5.0)}.items()}}
"""Rocks that are cut as the base is, at other depths of cut too: finer discs make another rock."""
HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA, NO_GRAINS = (f"{EIGHT}, {name}" for name in (
    "strengths halved", "strengths times 1.4", "bentheim", "medium_sandstone", "p_sandstone", "no grains"))
PULLED = BASE, HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA
"""Rocks that are pulled in the laboratory, too; the others have the bonds of the base."""
CHANGES = {
    "velocity 4 m/s": SLOWER,
    "velocity 2 m/s": dict(velocity=2.0, snapshot_period=2e-3),
    "4 m/s, window 1.5 times as long": dict(SLOWER, window_behind=0.018, window_ahead=0.06),
    "4 m/s, window 1.5 times as high": dict(SLOWER, window_height=0.03),
    "window 5 depths ahead": dict(window_ahead=0.025),
    "boundary fixed": dict(boundary="fixed"),
    "ends free": dict(boundary="free"),
    "rake -15°": dict(rake=-15.0),
    "rake 15°": dict(rake=15.0),
    "clearance 20°": dict(clearance=20.0),
    "tip 0.2 mm": dict(tip_radius=2e-4),
    "wear flat 1 mm": dict(wear_flat=1e-3),
    "wear flat 2 mm": dict(wear_flat=2e-3),
    "tool friction 0.6": dict(tool_mu=0.6),
    "damping 5000 1/s": dict(background_damping=5e3),
    "damping 30000 1/s": dict(background_damping=3e4),
    "grains not damped": dict(grain_quality=0.0),
    "stiffer tool contact, step 0.8": dict(tool_kn=1e10, tool_kt=1e10, contact_damping=0.2, time_step_fraction=0.8),
}
"""How else the rock of eight discs is cut: a twentieth of the cost of sixteen."""
CUTS = {**{f"{EIGHT}, {name}": change for name, change in CHANGES.items()},
        **{f"{depth_case(FLATS_DEPTH)}, {name}": CHANGES[name] for name in ("wear flat 1 mm", "wear flat 2 mm")},
        **{name: CHANGES[name] for name in ("wear flat 2 mm", "velocity 4 m/s")}}
"""How else the rock that a case begins with is cut, or that of the base."""
DRAWN = {BASE: "steady_cut", FINEST: "steady_cut_finest"}
"""{case: name of its figures}."""
SETTINGS = BASE, FINEST, EIGHT, *(f"{EIGHT}, {name}" for name in (
    "velocity 4 m/s", "velocity 2 m/s", "4 m/s, window 1.5 times as long", "4 m/s, window 1.5 times as high",
    "window 5 depths ahead", "boundary fixed", "stiffer tool contact, step 0.8"))
"""Cases that cut the same rock with the same tool: they differ in what they cost."""
CHANGED = {"mean Fc, kN/m": "force", "mean Fn, kN/m": "pressed", "peak / mean": "peaks",
           "overbreak / depth": "overbreak", "way under load": "loaded", "friction work, kN/m": "friction"}
"""{heading: quantity} of which it is said how a cause changes them."""
CHANCE = 0.05
"""How often chance alone may make a change that counts as told."""
TOOL_FRICTION = 0.3
"""Of steel on rock, the default of the cut."""
NISHIMATSU = 11.3, -0.18
"""His exponent of the stress on the shear plane, and its change per degree of rake (Nishimatsu 1972, recalled)."""
ACCURACY = 0.1
"""Of the mean force, for which the length of a cut is given."""
MOVED = 0.15
"""Part of specific energy and friction work by which a setting may move them."""
JUDGED = BASE, EIGHT, FINEST, HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA, *map(depth_case, DEPTHS)
OF_THE_CUT = {"discs_per_depth", *at_depth(1.0)}
"""Parameters of a rock of ROCKS that the laboratory does not take."""
AT_DEPTHS = *map(depth_case, DEPTHS[:2]), f"{EIGHT}, velocity 4 m/s", depth_case(DEPTHS[2])
"""Cases that differ in size alone, by their depth of cut."""
CASES = [BASE, *[name for name in ROCKS if name != BASE], *CUTS]

COLUMNS = {"specific energy / UCS": "energy", "mean Fc, kN/m": "force", "peak / mean": "peaks",
           "of packings abreast": "abreast",
           "overbreak / depth": "overbreak", "chip length / depth": "chip", "mean Fn, kN/m": "pressed",
           "thrust / cutting": "thrust",
           "friction work, kN/m": "friction", "way under load": "loaded", "work in bonds": "bonds",
           "in tension": "tension", "in crushing": "crushing"}
"""{heading: quantity}."""


def slug(*words):
    """Name of a folder."""
    return "-".join("".join(c if c.isalnum() or c in "-." else "_" for c in str(word)) for word in words)


def rock_of(case):
    """The rock that a case cuts."""
    return max((rock for rock in ROCKS if f"{case}, ".startswith(f"{rock}, ")), key=len, default=BASE)


def seeds_of(case):
    """Packings that are cut."""
    return MORE_SEEDS if depth_of(case) == FLATS_DEPTH else SEEDS


def cut_of(case, seed):
    """Parameters of a cut."""
    length = dict(cut_length=SHORT) if case == FINEST else {}
    return {**CUT, **length, **ROCKS[rock_of(case)], **CUTS.get(case, {}), "seed": seed, "report": "false"}


def test_of(rock, test, seed):
    """Parameters of a laboratory test: discs as in the cut, and a specimen that is as much larger as they are."""
    sizes, base = (cut_sizes(case["depth_of_cut"], case["discs_per_depth"], velocity=CUT["velocity"])
                   for case in ({**CUT, **ROCKS[rock]}, CUT))
    factor = sizes["radius_min"] / base["radius_min"]
    return {**{name: factor * length for name, length in BOX.items()},
            **{name: sizes[name] for name in ("radius_min", "radius_max")},
            **{name: value for name, value in ROCKS[rock].items() if name not in OF_THE_CUT},
            "test": test, "speed": SPEEDS[test], "seed": seed, "snapshot_period": 1, "report": "false"}


def plan(cases):
    """{folder: (script, parameters)}, the base and one packing of each case first."""
    found = {}
    for case, seed in sorted(((case, seed) for case in cases for seed in seeds_of(case)),
                             key=lambda job: (job[0] != BASE, job[1], CASES.index(job[0]))):
        rock = rock_of(case)
        found[f"cut/{slug(case, seed)}"] = SCRIPT, cut_of(case, seed)
        for test in SPEEDS if rock in PULLED else ["compression"]:
            found[f"lab/{slug(rock, test, seed)}"] = UNIAXIAL, test_of(rock, test, seed)
    return found


def runs_of(folder, *words):
    """{seed: RunFolder} of the packings that exist."""
    places = {seed: folder / slug(*words, seed) for seed in MORE_SEEDS}
    return {seed: RunFolder(place) for seed, place in places.items() if (place / "summary.json").exists()}


def strengths(folder, rock, test="compression"):
    """(k,) Pa, of the packings that exist."""
    name = {"compression": "peak_stress", "tension": "tensile_strength"}[test]
    return np.array([run.result(name) for run in runs_of(folder / "lab", rock, test).values()])


def of_run(run):
    """{quantity: Measured} of one cut, from BEGIN depths of cut on."""
    depth = run.parameter("depth_of_cut")
    begin = BEGIN * depth
    distance, cutting, thrust, friction = (run.column(name) for name in (
        "distance", "cutting_force", "thrust_force", "tool_friction"))
    total, pressed = (steady_record.integral(distance, force) for force in (cutting, thrust))
    mean = steady_record.mean(distance, total, begin)
    peaks = steady_record.peaks(distance, cutting, depth=depth, begin=begin)
    spacing = np.ptp(peaks.distance) / (len(peaks.force) - 1) if len(peaks.force) > 1 else math.nan
    x, height = run.table("groove.csv", "x", "height")
    groove = groove_results(x=x[x > begin], height=height[x > begin], chip=float(spacing))
    way, particles, area, length = run.table("chips.csv", "distance", "particles", "area", "length")
    late = way > begin
    chip = chip_length(particles=particles[late], area=area[late], length=length[late])
    overbreak = Measured(groove["overbreak"][0], groove["overbreak_standard_error"][0])
    energy, (work, mode) = run.balances["energy"], run.table("cracks.csv", "energy", "mode")
    return {"force": scaled(mean, 1e-3), "energy": scaled(mean, 1 / depth), "peak": scaled(peaks.mean(), 1e-3),
            "peaks": steady_record.quotient(peaks.mean(), mean), "overbreak": scaled(overbreak, 1 / depth),
            "chip": scaled(chip, 1 / depth), "thrust": steady_record.ratio(distance, pressed, total, begin),
            "pressed": scaled(steady_record.mean(distance, pressed, begin), 1e-3),
            "friction": scaled(steady_record.mean(distance, friction, begin), 1e-3),
            "loaded": under_load(distance, cutting, peaks.mean().value, begin),
            "bonds": Measured(energy["bond_breaking"] / energy["tool_work"], math.nan),
            "tension": Measured(float(work[mode == IN_TENSION].sum()) / energy["tool_work"], math.nan),
            "crushing": Measured(energy["rock_crushing"] / energy["tool_work"], math.nan)}


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
    found["specific_energy"] = scaled(found["energy"], 1e-6)
    found["energy"] = scaled(found["energy"], 1e-6 / found["ucs"].value)
    way = [run.parameter("cut_length") + run.parameter("ramp_length") for run in runs]
    minutes = [run.summary["wall_time"]["total"] / 60 for run in runs]
    missed = [run.balances["energy"]["residual"] / run.balances["energy"]["tool_work"] for run in runs]
    return {**found, "each": each, "packings": len(runs), "cost": sum(minutes) / sum(way),
            "missed": max(map(abs, missed)),
            "way": sum(run.parameter("cut_length") / run.parameter("depth_of_cut") - BEGIN for run in runs)}


def shown(measured):
    """Value ± standard error."""
    if not math.isfinite(measured.value):
        return "–"
    error = measured.standard_error
    return f"{measured.value:.3g}" + (f" ± {error:.2g}" if math.isfinite(error) else "")


def causes(found):
    """Lines: a row a case."""
    return generated.table(
        ["", "packings", "depths cut", "UCS, MPa", *COLUMNS, "energy missed, %", "minutes per metre"],
        [[case, row["packings"], f"{row['way']:.0f}", shown(row["ucs"]),
          *(shown(row[name]) for name in COLUMNS.values()), f"{100 * row['missed']:.1f}", f"{row['cost']:.0f}"]
         for case, row in found.items()])


def envelope(folder, found):
    """Rows of a table: cuts of JUDGED against what is expected of a rock of their strengths."""
    rows = []
    for case in JUDGED:
        rock = rock_of(case)
        row, tension = found.get(case), strengths(folder, rock if rock in PULLED else BASE, "tension")
        if not row or not len(tension) or not math.isfinite(row["ucs"].value):
            continue
        depth = depth_of(case)
        ours = {"mean_cutting_force": (row["force"], 1e-3, "kN/m"), "peak_over_mean": (row["peaks"], 1, ""),
                "mean_peak_cutting_force": (row["peak"], 1e-3, "kN/m"),
                "overbreak": (row["overbreak"], 1 / depth, "depths"),
                "specific_energy": (row["specific_energy"], 1e-6, "MJ/m³")}
        for one in expected(compressive_strength=1e6 * row["ucs"].value, tensile_strength=tension.mean(), depth=depth,
                            rake=math.radians(CUT["rake"])):
            measured, factor, unit = ours[one.observable]
            found_here = {case: measured}
            if one.observable == "peak_over_mean" and math.isfinite(row["abreast"].value):
                found_here[f"{case}, packings abreast"] = row["abreast"]
            rows += [[name, one.observable.replace("_", " "), f"{one.low * factor:.3g} to {one.high * factor:.3g} "
                      f"{unit}", one.basis, shown(value),
                      one.verdict(value.value / factor, value.standard_error / factor)]
                     for name, value in found_here.items()]
    return rows


def relations(found):
    """Rows of a table: what several cuts tell together, against RELATIONS."""
    ours, rows = {}, []
    forces = {depth_of(case): found[case]["force"] for case in AT_DEPTHS
              if case in found and math.isfinite(found[case]["force"].standard_error)}
    for name, part in {"scratch_force_exponent": lambda depth: depth < 2e-3,
                       "chip_force_exponent": lambda depth: depth > 1e-3}.items():
        if sum(map(part, forces)) > 1:
            depths = {depth: force for depth, force in forces.items() if part(depth)}
            ours[name, EIGHT] = exponent(list(depths), *np.array(list(depths.values())).T)
    for rock in (BASE, EIGHT):
        rakes = forces_over(found, rock, "rake")
        if len(rakes) > 1:
            ours["force_over_rake", rock] = slope(np.radians(list(rakes)), *1e3 * np.array(list(rakes.values())).T)
    for name, change in CUTS.items():
        known = found.get(rock_of(name))
        if known and name in found and "wear_flat" in change:
            more = {what: difference(found[name], known, what) for what in ("force", "pressed")}
            ours["flat_thrust", name] = scaled(more["pressed"], 1e-3 / (known["ucs"].value * change["wear_flat"]))
            part = more["force"].value / more["pressed"].value
            ours["flat_cutting_over_thrust", name] = Measured(part, math.hypot(
                more["force"].standard_error, part * more["pressed"].standard_error) / abs(more["pressed"].value))
    for one in RELATIONS:
        for (observable, case), measured in ours.items():
            if one.observable == observable:
                rows.append([case, one.case, f"{one.low:g} to {one.high:g} {one.unit}", one.basis, shown(measured),
                             one.verdict(*measured)])
    return rows


def depth_of(case):
    """m."""
    return {**CUT, **ROCKS[rock_of(case)]}["depth_of_cut"]


def forces_over(found, rock, what):
    """{value: Measured mean force} of the cuts of a rock that differ in one parameter; without the rock's own, none."""
    return {CUTS.get(name, {}).get(what, CUT[what]): row["force"] for name, row in found.items()
            if rock in found and rock_of(name) == rock and (name == rock or what in CUTS[name])
            and math.isfinite(row["force"].standard_error)}


def difference(row, other, what):
    """Measured difference of a quantity of two cases: where they have three packings in common, the mean of what it is
    in each, else that of two independent ones."""
    seeds = sorted(row.get("each", {}).keys() & other.get("each", {}).keys())
    if len(seeds) > 2:
        return steady_record.sample_mean([row["each"][seed][what].value - other["each"][seed][what].value
                                          for seed in seeds])
    one, other = row[what], other[what]
    return Measured(one.value - other.value, math.hypot(one.standard_error, other.standard_error))


def changed_from(case):
    """The case that this one differs from in one cause; None for those of other discs or depths."""
    if case in CUTS:
        slower = f"{rock_of(case)}, velocity 4 m/s"
        return slower if case.startswith(f"{rock_of(case)}, 4 m/s, ") else rock_of(case)
    return EIGHT if case.startswith(f"{EIGHT}, ") and depth_of(case) == depth_of(EIGHT) else None


def changes(found):
    """Rows of a table: how much a cause changes the cut in the same packings, and what of it is told from chance."""
    rows = []
    for case, row in found.items():
        known = found.get(changed_from(case))
        if known:
            by = {words: (difference(row, known, what), known[what].value) for words, what in CHANGED.items()}
            common = len(row["each"].keys() & known["each"].keys())
            least = stats.t.ppf(1 - 0.5 * CHANCE, common - 1) if common > 2 else math.inf
            told = [words for words, (change, _) in by.items() if abs(change.value) > least * change.standard_error]
            rows.append([case, common,
                         *(f"{shown(change)} ({100 * change.value / value:+.0f} %)" for change, value in by.values()),
                         ", ".join(told) or "–"])
    return rows


def lengths_needed(found):
    """Rows of a table: how well one cut knows the mean force, by packings and by its record, and how many depths of cut
    it takes to know it to ACCURACY; the larger error counts, for that of three packings is itself not known well."""
    rows = []
    for case in (*SETTINGS, NO_GRAINS):
        row = found.get(case)
        if row and len(row["each"]) > 2:
            forces = np.array([one["force"] for one in row["each"].values()])
            errors = np.array([forces[:, 0].std(ddof=1), np.sqrt(np.mean(forces[:, 1]**2))]) / forces[:, 0].mean()
            depths = row["way"] / len(forces)
            rows.append([case, f"{depths:.0f}", *(f"{100 * error:.0f} %" for error in errors),
                         f"{depths * (errors.max() / ACCURACY)**2:.0f}"])
    return rows


def theories(folder, found):
    """Rows of a table: peaks beside those of Evans and Nishimatsu, and thrust over cutting force beside the latter."""
    rows, friction = [], math.atan(TOOL_FRICTION)
    for case, row in found.items():
        rock = rock_of(case)
        tension = strengths(folder, rock if rock in PULLED else BASE, "tension")
        other_theory = case not in CUTS or "rake" in CUTS[case]
        if not (other_theory and len(tension) and math.isfinite(row["ucs"].value)):
            continue
        rake, depth = math.radians({**CUT, **CUTS.get(case, {})}["rake"]), depth_of(case)
        cohesion, angle = cutting_theory.mohr_coulomb(compressive_strength=1e6 * row["ucs"].value,
                                                      tensile_strength=tension.mean())
        evans = cutting_theory.evans(tensile_strength=tension.mean(), depth=depth, rake=rake)
        try:
            cutting, thrust = cutting_theory.nishimatsu(
                shear_strength=cohesion, internal_friction=angle, depth=depth, rake=rake, friction_angle=friction,
                distribution=NISHIMATSU[0] + NISHIMATSU[1] * math.degrees(rake))
        except ParameterError:
            # Friction in the rock and on so blunt a tool leaves no plane to slide on.
            cutting, thrust = math.nan, math.nan
        rows.append([case, shown(row["peak"]), f"{1e-3 * evans:.0f}",
                     shown(Measured(1e-3 * cutting, math.nan)), shown(row["thrust"]),
                     shown(Measured(thrust / cutting, math.nan))])
    return rows


def slope(x, values, errors):
    """Measured slope of values (k,) over x (k,), weighted with their standard errors."""
    weight = errors**-2.0
    x = x - np.average(x, weights=weight)
    spread = np.sum(weight * x**2)
    return Measured(float(np.sum(weight * x * values) / spread), float(spread**-0.5))


def resolution(found):
    """Figure: what the number of discs in the depth of cut changes, and what it costs."""
    discs = {case: {**CUT, **ROCKS[case]}["discs_per_depth"] for case in (EIGHT, BASE, FINEST) if case in found}
    drawn, panels = plots.canvas(13, 3.4, 1, 4)
    targets = {"energy": ENERGY_TARGET, "peaks": PEAKS_TARGET, "overbreak": OVERBREAK_TARGET, "thrust": None}
    for axes, (name, target) in zip(panels, targets.items()):
        values, errors = np.array([found[case][name] for case in discs]).T
        if target:
            axes.axhspan(*target, color="#dfe8d8", label="aimed at")
            axes.legend(fontsize=8)
        axes.errorbar(list(discs.values()), values, np.nan_to_num(errors), fmt="o-", color="#444444", capsize=3)
        axes.set(xscale="log", ylim=(0, None), title=next(words for words, of in COLUMNS.items() if of == name))
        axes.set_xticks(list(discs.values()), [f"{count} discs\n{found[case]['cost']:.0f} min/m"
                                               for case, count in discs.items()])
        axes.minorticks_off()
    return drawn


def over_depth(found):
    """Figure: cuts of one rock that differ in size alone, over their depth of cut."""
    cases = [case for case in AT_DEPTHS if case in found]
    drawn, panels = plots.canvas(13, 3.6, 1, 4)
    bands = {"energy": (SCRATCH_ENERGY[0] / SCRATCH_STRENGTH, SCRATCH_ENERGY[1] / SCRATCH_STRENGTH),
             "peaks": PEAKS_TARGET, "overbreak": OVERBREAK_TARGET, "thrust": SCRATCH_THRUST}
    for axes, (name, band) in zip(panels, bands.items()):
        scratch = name in ("energy", "thrust")
        axes.fill_between([min(SCRATCH_DEPTHS) * 1e3, 1e3 * max(SCRATCH_DEPTHS)] if scratch else [0.2, 30.0], *band,
                          color="#dfe8d8", label="scratches, recalled" if scratch else "aimed at")
        if name == "energy":
            axes.plot([5.0, 5.0], ENERGY_TARGET, color="#8aa37b", linewidth=6, alpha=0.5, label="aimed at")
        values, errors = np.array([found[case][name] for case in cases]).T
        axes.errorbar([1e3 * depth_of(case) for case in cases], values, np.nan_to_num(errors), fmt="o-",
                      color="#444444", capsize=3)
        axes.set(xscale="log", ylim=(0, None), xlim=(0.2, 30), xlabel="depth of cut, mm",
                 title=next(words for words, of in COLUMNS.items() if of == name))
        axes.set_xticks([0.3, 1, 5, 20], ["0.3", "1", "5", "20"])
        axes.minorticks_off()
        axes.legend(fontsize=8)
    return drawn


def price(found):
    """Figure: what a setting moves in specific energy and in friction at the tool, as wear goes, over what it costs."""
    drawn, panels = plots.canvas(12, 4.4, 1, 2)
    for axes, (name, title) in zip(panels, {"force": "specific energy", "friction": "friction at the tool"}.items()):
        axes.axhspan(1 - MOVED, 1 + MOVED, color="#dfe8d8")
        for number, case in enumerate(case for case in SETTINGS if case in found):
            value, error = scaled(found[case][name], 1 / found[EIGHT][name].value)
            axes.errorbar(found[case]["cost"], value, np.nan_to_num(error), fmt="o", color=f"C{number}", capsize=3,
                          label=case.removeprefix(f"{EIGHT}, ").replace(BASE, "sixteen discs"))
        axes.set(xscale="log", ylim=(0, None), xlabel="minutes per metre", title=f"{title} over that of {EIGHT}")
        axes.set_xticks([10, 20, 50, 100, 200, 500], [10, 20, 50, 100, 200, 500])
        axes.minorticks_off()
    panels[0].legend(fontsize=8)
    return drawn


def write(folder):
    """Tables and figures of all runs that exist. -> the tables, in Markdown."""
    found = {case: row for case in CASES if (row := of_case(folder, case))}
    files = [folder / "steady_cut.csv"]
    lines = ["## Causes, one at a time", "", f"Mean ± standard error: of the packings where there are three, else of "
             f"the cuts' own records, from {BEGIN} depths of cut on. Way under load: part of the way with a cutting "
             f"force above {LOAD:g} of the mean peak. Of packings abreast: peak over mean of the mean force of all "
             "packings, as of a tool so many chips wide. Work in bonds: part of the tool's work that bonds take "
             "in slip and damage, those alone that broke in tension, and in crushing. Energy missed: residual of the "
             "balance over the tool's work, of the worst packing. Minutes on a shared core.", "", *causes(found)]
    if changed := changes(found):
        lines += ["", "## What each changes in the same packings", "", "Mean ± standard error of the differences in "
                  "the same packing; told: so many standard errors that chance makes as large a change once in "
                  f"{1 / CHANCE:g} cases (Student's t).", "",
                  *generated.table(["", "packings in common", *CHANGED, "told"], changed)]
    if needed := lengths_needed(found):
        lines += ["", "## How long a cut has to be", "", "How far the mean force of one cut is off, by the scatter of "
                  f"packings and by its own record, and how many depths of cut tell it to {100 * ACCURACY:g} %.", "",
                  *generated.table(["", "depths of one cut", "packings", "record", "depths needed"], needed)]
    if judged := envelope(folder, found):
        lines += ["", "## Against the envelope", "",
                  *generated.table(["cut", "", "range", "basis", "ours", "verdict"], [*judged, *relations(found)])]
    if compared := theories(folder, found):
        lines += ["", "## Theories", "", "Both are known to be unreliable in absolute value. Strengths are those of "
                  "the rock's laboratory; Nishimatsu's with the exponent recalled of his own tests.", "",
                  *generated.table(["", "mean peak Fc, kN/m", "Evans", "Nishimatsu", "thrust / cutting", "Nishimatsu"],
                                   compared)]
    for case, name in DRAWN.items():
        if case in found:
            run = next(iter(runs_of(folder / "cut", case).values()))
            with matplotlib.rc_context(plots.STYLE):
                for end, figure in (("", cut.figure(run, plane.cut_limits(run))),
                                    ("_forces", steady.force_figure(run))):
                    files.append(folder / f"{name}{end}.png")
                    figure.savefig(files[-1])
    if {BASE, EIGHT} <= set(found):
        with matplotlib.rc_context(plots.STYLE):
            files.append(folder / "steady_cut_resolution.png")
            resolution(found).savefig(files[-1])
            files.append(folder / "steady_cut_price.png")
            price(found).savefig(files[-1])
    if sum(case in found for case in AT_DEPTHS) > 2:
        with matplotlib.rc_context(plots.STYLE):
            files.append(folder / "steady_cut_depths.png")
            over_depth(found).savefig(files[-1])
    with open(files[0], "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["case", "quantity", "mean", "standard error"],
                                    *([case, name, *value] for case, row in found.items()
                                      for name, value in row.items() if isinstance(value, Measured))])
    generated.record(*files)
    return generated.write_page(folder / "steady_cut.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {name: runs.start(name, script, **values)
                    for name, (script, values) in plan(words or CASES).items()}
            failed = wait_for(jobs, lambda name, run: name)
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, CASES)
    sys.exit(main(place, words, **where))

"""Tables of campaigns.steady_cut. found: {case: row of steady_cut_numbers.of_case}."""
import math

import numpy as np

from calibration import generated
from calibration.campaigns.steady_cut_cases import (
    AT_DEPTHS, BASE, BENTHEIM, CUT, CUTS, DEPTHS, EIGHT, EIGHT_SHARP, FINEST, HALVED, MEDIUM, NO_GRAINS,
    PADOVA, ROCKS, SETTINGS, STRONGER, changed_from, cut_of, depth_case, depth_of, rock_of)
from calibration.campaigns.steady_cut_numbers import COLUMNS, difference, force_over, scaled, shown
from rockwear.kernels import cutting_theory
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cutting_envelope import RELATIONS, expected, exponent
from rockwear.kernels.steady_record import Measured

CHANGED = {"mean Fc, kN/m": "force", "mean Fn, kN/m": "pressed", "peak / mean": "peaks",
           "overbreak / depth": "overbreak", "way under load": "loaded", "friction work, kN/m": "friction"}
"""{heading: quantity} of which it is said how a cause changes them."""
TOOL_FRICTION = 0.3
"""Of steel on rock, the default of the cut."""
NISHIMATSU = 11.3, -0.18
"""His exponent of the stress on the shear plane, and its change per degree of rake (Nishimatsu 1972, recalled)."""
ACCURACY = 0.1
"""Of the mean force, for which the length of a cut is given."""
ERRORS_OF = {"specific_energy": "force", "wear": "friction", "temperature": "temperature"}
"""{quantity that an accuracy may be asked of: quantity of a row}; wear goes as friction at the tool."""
OPTIONS, NO_OPTIONS = ("discs_per_depth", "velocity", "time_step_fraction"), ("rock", "cut_length", "snapshot_period")
"""Parameters that every setting gives, and those of a cut that are none of it."""
JUDGED = BASE, EIGHT, FINEST, HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA, *map(depth_case, DEPTHS)


def causes(found):
    """Lines: a row a case."""
    return generated.table(
        ["", "packings", "depths cut", "UCS, MPa", *COLUMNS, "energy missed, %", "minutes per metre"],
        [[case, row["packings"], f"{row['way']:.0f}", shown(row["ucs"]),
          *(shown(row[name]) for name in COLUMNS.values()), f"{100 * row['missed']:.1f}", f"{row['cost']:.0f}"]
         for case, row in found.items()])


def envelope(found):
    """Rows of a table: cuts of JUDGED against what is expected of a rock of their strengths."""
    rows = []
    for case in JUDGED:
        row = found.get(case)
        if not row or not _tested(row):
            continue
        depth = depth_of(case)
        ours = {"mean_cutting_force": (row["force"], 1e-3, "kN/m"), "peak_over_mean": (row["peaks"], 1, ""),
                "mean_peak_cutting_force": (row["peak"], 1e-3, "kN/m"),
                "overbreak": (row["overbreak"], 1 / depth, "depths"),
                "specific_energy": (row["specific_energy"], 1e-6, "MJ/m³")}
        for one in expected(compressive_strength=1e6 * row["ucs"].value,
                            tensile_strength=1e6 * row["tensile_strength"].value, depth=depth,
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


def _tested(row):
    return all(math.isfinite(row[name].value) for name in ("ucs", "tensile_strength"))


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
    for case in (BASE, EIGHT, EIGHT_SHARP):
        per_degree = force_over(found, case, "rake")
        if math.isfinite(per_degree.value):
            ours["force_over_rake", case] = scaled(per_degree, 1e3 * math.degrees(1.0))
    for name, change in CUTS.items():
        known = found.get(changed_from(name))
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


def changes(found):
    """Rows of a table: how much a cause changes the cut in the same packings, and what of it is significant."""
    rows = []
    for case, row in found.items():
        known = found.get(changed_from(case))
        if known:
            by = {words: (difference(row, known, what), known[what].value) for words, what in CHANGED.items()}
            common = len(row["each"].keys() & known["each"].keys())
            significant = [words for words, what in CHANGED.items() if told_apart(row, known, what)]
            rows.append([case, common,
                         *(f"{shown(change)} ({100 * change.value / value:+.0f} %)" for change, value in by.values()),
                         ", ".join(significant) or "–"])
    return rows


def told_apart(row, known, what):
    """Whether two cases differ significantly in a quantity, by the packings that they have in common."""
    change = difference(row, known, what)
    return generated.significant(change.value, change.standard_error, len(row["each"].keys() & known["each"].keys()))


def lengths_needed(found):
    """Rows of a table: how well one cut knows the mean force, by packings and by its record, and how many depths of cut
    and minutes it takes to know it to ACCURACY; the larger error counts, for that of three packings is itself not known
    well."""
    rows = []
    for case in (*SETTINGS, NO_GRAINS):
        row = found.get(case)
        if row and len(row["each"]) > 2:
            depths, errors = scatter(row)
            needed = depths * (errors.max() / ACCURACY)**2
            rows.append([case, f"{depths:.0f}", *(f"{100 * error:.0f} %" for error in errors), f"{needed:.0f}",
                         f"{needed * depth_of(case) * row['cost']:.0f}"])
    return rows


def scatter(row):
    """(depths of one cut, (2,) relative errors of its mean force, by packings and by its record)."""
    forces = np.array([one["force"] for one in row["each"].values()])
    errors = np.array([forces[:, 0].std(ddof=1), np.sqrt(np.mean(forces[:, 1]**2))]) / forces[:, 0].mean()
    return row["way"] / len(forces), errors


def settings(found):
    """What calibration.settings chooses from: [{setting, options, lengths (over the depth of cut), minutes_per_depth,
    depths_for_tenth, errors {quantity: part by which the base differs}}] of SETTINGS with three packings.

    A setting that is not told apart from the case it was changed from in a quantity has the larger error of both: what
    chance makes smaller is no reason to choose it.
    """
    rows = []
    for case in SETTINGS:
        row = found.get(case)
        if row and BASE in found and len(row["each"]) > 2:
            depths, errors = scatter(row)
            changed = {**ROCKS[rock_of(case)], **CUTS.get(case, {})}
            options = {name: changed.get(name, CUT.get(name)) for name in (*OPTIONS, *changed)
                       if name not in NO_OPTIONS}
            lengths = {name: options.pop(name) / depth_of(case) for name in tuple(options)
                       if name.startswith("window_")}
            rows.append({"setting": case, "options": options, "lengths": lengths,
                         "minutes_per_depth": row["cost"] * depth_of(case),
                         "depths_for_tenth": depths * (errors.max() / 0.1)**2,
                         "errors": {name: _error(row, found.get(changed_from(case)), found[BASE], what)
                                    for name, what in ERRORS_OF.items()}})
    return rows


def _error(row, known, base, what):
    """Part by which a quantity of a setting, changed from the case `known`, is off that of the base; None where that is
    not known."""
    off = _off(row, base, what)
    if not known or off is None:
        return off
    return off if told_apart(row, known, what) else max(off, _off(known, base, what) or 0.0)


def _off(row, base, what):
    """Part by which a quantity is off that of the base, with the error of that; None where it is not known."""
    if row is base:
        return 0.0
    change = difference(row, base, what)
    off = math.hypot(change.value, change.standard_error) / base[what].value
    return off if math.isfinite(off) else None


def theories(found):
    """Rows of a table: peaks beside those of Evans and Nishimatsu, and thrust over cutting force beside the latter."""
    rows, friction = [], math.atan(TOOL_FRICTION)
    for case, row in found.items():
        other_theory = case not in CUTS or "rake" in CUTS[case]
        if not (other_theory and _tested(row)):
            continue
        tension = 1e6 * row["tensile_strength"].value
        rake, depth = math.radians(cut_of(case, seed=1)["rake"]), depth_of(case)
        cohesion, angle = cutting_theory.mohr_coulomb(compressive_strength=1e6 * row["ucs"].value,
                                                      tensile_strength=tension)
        evans = cutting_theory.evans(tensile_strength=tension, depth=depth, rake=rake)
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

"""What a fitted rock is to be: laboratory values from the command line and a table, checked against each other."""
import csv
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError, finite, require, within
from rockwear.kernels.packing import POROSITY_LIMITS
from rockwear.kernels.parameter import Group, Parameter, choice, file, integer, number, plausible, text
from rockwear.model.rock_file import PROPERTIES, RADIUS, RockPresets, check_properties
from rockwear.scenes.parameters import OF_ROCK

NEEDED = "youngs_modulus", "poissons_ratio", "ucs", "tensile_strength"
"""Values without which there is no fit."""
POISSON = -0.2, 0.36
"""Poisson's ratios that bonds with springs along and across them can give."""
LAWS = "brittle", "coulomb", "cohesive"
"""Bond laws that can be fitted, as far as they exist."""
RATIO = 1.5, 50.0
"""UCS over tensile strength, of rocks 5 to 30 or so: beyond, a value has slipped."""
RISE = 1.0, 35.0
"""Rise of sigma1 over that of sigma3 from ucs to the highest point that is fitted, friction angles of 0 to 71 degrees:
with less, or more, no frictional material."""
LARGEST_ZONE = 1.0
"""m, (fracture toughness over tensile strength)^2: of rocks 0.01 to 0.05, beyond a metre one value has slipped."""
TOUGH, RADIUS_OF_TOUGH = 0.15, 1.25e-3
"""sqrt(m), K_IC over tensile strength of brittle bonds between discs of this mean radius, m; it goes with the root of
the radius, softening and grains add to it (calibration/results/rocks.md)."""
FAR = 0.5
"""Part of the toughness of brittle bonds below which a target is refused: no bonds come near it."""
WIDEST = 5.0
"""radius_max over radius_min."""
STAGES = "small", "full", "check"
"""Of a fit, in this order."""
GIVEN = "porosity", "weibull_modulus"
"""Parameters of the rock that are given and not fitted, beside its grains."""
KEPT = "rotation", "bond_shear_energy", "bond_crushing", "crushing_hardening"
"""Parameters of the rock that the fit begins with, which stay as they are there; the crushing strength where no ductile
points are fitted."""
UNITS = {"kpa": 1e3, "mpa": 1e6, "gpa": 1e9}
"""Pa, of the units that the header of a table may name."""
GRAINS = (5.0, 0.0), (11.0, 1.8), (math.inf, 2.2)
"""(largest UCS over tensile strength, grain_edge over the mean radius that can give it). Without grains and with the
cohesive law the ratio is 6 to 7 for any shear strength; at an edge of 1.8 radii it is 6.2, 8.1 and 13.0 for shear over
tensile strengths of 1.5, 3 and 7 (525 discs, three packings)."""
CONFINEMENTS = 0.1, 0.3
"""Confinements over UCS at which a friction angle is fitted."""
HIGHEST = 1.5
"""Confinement over UCS above which a rock is ductile: grains crush there (cohesive bonds alone can)."""
MOST_POINTS, MOST_DUCTILE = 3, 2
"""Confined tests of one packing up to there and beyond, each dear."""
FIRST_POINT = 0.2
"""Largest difference of a table's unconfined strength from UCS, over UCS."""


def wanted(name):
    """A rule: a property in its range, or nothing."""
    unit, low, high = PROPERTIES[name]

    def rule(given, value, _):
        if value == "":
            return None
        found = finite(given, value, unit)
        require(low <= found <= high, given, found, f"between {low:g} and {high:g}", unit)
        return found
    return rule


def _target(name, meaning):
    return Parameter(name, "", PROPERTIES[name][0], wanted(name), meaning, "yours")


TARGETS = Group("targets", (
    _target("youngs_modulus", "Young's modulus"), _target("poissons_ratio", "Poisson's ratio"),
    _target("ucs", "uniaxial compressive strength"), _target("tensile_strength", "strength in direct tension"),
    _target("fracture_toughness", "K_IC; not needed"),
    _target("friction_angle", "of Mohr-Coulomb at low confinement; not needed"),
    Parameter("triaxial", "", "", file, "CSV table of strengths (commas, semicolons or tabs), columns sigma3 and "
              "sigma1 in Pa, or sigma3_MPa and sigma1_MPa; not needed, and in place of friction_angle", "yours")))
ROCK = Group("rock", (
    Parameter("name", "fitted_rock", "", text, "of the rock"),
    Parameter("source", "laboratory values given to calibration.fit", "", text, "where the targets are from"),
    Parameter("radius_min", 1e-3, "m", plausible(*RADIUS), "smallest radius of the particles", "[Rojek 2003, 5.1]"),
    Parameter("radius_max", 1.5e-3, "m", plausible(*RADIUS), "largest radius of the particles", "[Rojek 2003, 5.1]"),
    Parameter("bond_law", LAWS[-1] if LAWS[-1] in BOND_LAWS else LAWS[0], "",
              choice(*(law for law in LAWS if law in BOND_LAWS)), "force law of the bonds"),
    *(OF_ROCK[name] for name in GIVEN),
    Parameter("grain_edge", -1.0, "m", number(-1), "mean edge of grains; 0: none; -1: chosen by ucs over "
              "tensile_strength, which grains raise")))
SEARCH = Group("search", (
    Parameter("start", "", "", file, "rock, a name of the library or a file, whose bonds and grains the search begins "
              "with; not needed"),
    Parameter("first_stage", "small", "", choice(*STAGES), "small: search on small specimens, then on full ones, then "
              "check; later ones begin near the end, which start must give"),
    Parameter("jobs", 2, "", integer(1), "tests at a time")))
OUTPUT = Group("output", (Parameter("out", "", "", text, "folder of rock.json, fit.md and all runs"),))
GROUPS = [TARGETS, ROCK, SEARCH, OUTPUT]


@dataclass(frozen=True)
class Targets:
    """Properties of the rock in SI. fracture_toughness: None where it is not given; points: ((sigma3, sigma1), ...) at
    sigma3 > 0, ductile: those above HIGHEST ucs; friction_angle, deg, None where it is not given; left_out: words on
    points that are not fitted."""

    youngs_modulus: float
    poissons_ratio: float
    ucs: float
    tensile_strength: float
    fracture_toughness: float | None = None
    friction_angle: float | None = None
    points: tuple = ()
    ductile: tuple = ()
    left_out: str = ""

    def confined(self):
        """All points, ((sigma3, sigma1), ...)."""
        return self.points + self.ductile

    def as_properties(self):
        """{property: value} of a rock file."""
        names = *NEEDED, "fracture_toughness", "friction_angle"
        found = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        if self.points and self.friction_angle is None:
            found["triaxial"] = [list(point) for point in self.confined()]
        return found


def targets_of(values):
    """Targets of {name: value} of GROUPS. Raises ParameterError for what is missing, contradictory or out of reach."""
    for name in NEEDED:
        require(values[name] is not None, name, "nothing", f"given: {', '.join(NEEDED)} are needed")
    found = {name: values[name] for name in (*NEEDED, "fracture_toughness", "friction_angle")
             if values[name] is not None}
    try:
        check_properties(found)
    except ParameterError as error:
        raise ParameterError(error.name.partition(".")[2], error.value, error.rule, error.unit) from None
    low, high = POISSON
    require(low <= found["poissons_ratio"] <= high, "poissons_ratio", found["poissons_ratio"],
            f"between {low:g} and {high:g}, all that bonds with springs along and across them can give")
    _check_strengths(found)
    require(values["bond_law"] == "cohesive" or values["fracture_toughness"] is None, "fracture_toughness",
            values["fracture_toughness"], f"left out with bond_law = {values['bond_law']}: toughness follows the radii")
    require(not values["triaxial"] or values["friction_angle"] is None, "friction_angle", values["friction_angle"],
            "left out with triaxial", "deg")
    require(values["radius_max"] >= values["radius_min"], "radius_max", values["radius_max"],
            f"at least radius_min = {values['radius_min']:g}", "m")
    require(values["radius_max"] <= WIDEST * values["radius_min"], "radius_max", values["radius_max"],
            f"at most {WIDEST:g} times radius_min = {values['radius_min']:g}", "m")
    least = FAR * least_toughness(found["tensile_strength"], radius=(values["radius_min"] + values["radius_max"]) / 2)
    require(found.get("fracture_toughness", least) >= least, "fracture_toughness", values["fracture_toughness"],
            f"at least {least:.3g}, half of what the most brittle bonds have at these radii", "Pa sqrt(m)")
    within("porosity", values["porosity"], *POROSITY_LIMITS[2])
    if values["triaxial"]:
        return Targets(**found, **_chosen(read_table(values["triaxial"]), values["triaxial"], ucs=found["ucs"],
                                          crushes=values["bond_law"] == "cohesive"))
    if values["friction_angle"] is not None:
        sine = math.sin(math.radians(values["friction_angle"]))
        slope = (1 + sine) / (1 - sine)
        require(slope <= RISE[1], "friction_angle", values["friction_angle"], "at most 71, as of rocks",
                "deg")
        return Targets(**found, points=tuple((part * found["ucs"], (1 + slope * part) * found["ucs"])
                                             for part in CONFINEMENTS))
    return Targets(**found)


def least_toughness(tensile_strength, *, radius):
    """Pa sqrt(m), K_IC of brittle bonds between discs of this mean radius, m, at this tensile strength of a rock, Pa.
    """
    return TOUGH * tensile_strength * math.sqrt(radius / RADIUS_OF_TOUGH)


def doubts(targets, radius):
    """Words on what is not likely to be reached with discs of this mean radius, m; "" where nothing is."""
    least = least_toughness(targets.tensile_strength, radius=radius)
    if targets.fracture_toughness is None or targets.fracture_toughness >= least:
        return ""
    good = radius * (targets.fracture_toughness / least)**2
    return (f"note: at these radii bonds give a fracture_toughness of at least some {least:.2g} Pa sqrt(m), with "
            f"grains more; a mean radius below {1e3 * good:.2g} mm can give {targets.fracture_toughness:g}")


def _check_strengths(found):
    low, high = RATIO
    ratio = found["ucs"] / found["tensile_strength"]
    require(low <= ratio <= high, "tensile_strength", found["tensile_strength"],
            f"ucs = {found['ucs']:g} divided by {low:g} to {high:g}, as of rocks", "Pa")
    toughness = found.get("fracture_toughness", 0.0)
    require(toughness**2 <= LARGEST_ZONE * found["tensile_strength"]**2, "fracture_toughness", toughness,
            f"at most {math.sqrt(LARGEST_ZONE):g} sqrt(m) times tensile_strength = {found['tensile_strength']:g}",
            "Pa sqrt(m)")


def read_table(path):
    """{sigma3: mean sigma1}, Pa, of a CSV file with the columns sigma3 and sigma1, in Pa, or in kPa, MPa or GPa if the
    header says so, between commas, semicolons or tabs.

    Further columns are allowed. Raises ParameterError (triaxial).
    """
    try:
        with open(path, newline="", encoding="utf-8-sig") as file_of_table:
            lines = file_of_table.read().splitlines()
        between = max(",;\t", key=next(filter(str.strip, lines), "").count)
        rows = [(line, row) for line, row in enumerate(csv.reader(lines, delimiter=between, skipinitialspace=True), 1)
                if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ParameterError("triaxial", str(path), f"a readable CSV file ({error})") from None
    heads = [head.strip().lower() for head in rows[0][1]] if rows else []
    places, factors = {}, {}
    for name in ("sigma3", "sigma1"):
        fitting = [k for k, head in enumerate(heads) if re.match(rf"{name}(?![0-9])", head)]
        require(len(fitting) == 1, "triaxial", str(path), f"a table with one column {name}")
        places[name] = fitting[0]
        factors[name] = next((factor for unit, factor in UNITS.items() if unit in heads[fitting[0]]), 1.0)
    found = {}
    for line, row in rows[1:]:
        pair = [_cell(path, line, row, places[name], factors[name]) for name in ("sigma3", "sigma1")]
        found.setdefault(pair[0], []).append(pair[1])
    require(found, "triaxial", str(path), "a table with at least one row")
    return {least: float(np.mean(found[least])) for least in sorted(found)}


def _cell(path, line, row, place, factor):
    try:
        value = factor * finite("triaxial", row[place])
        require(0 <= value <= PROPERTIES["triaxial"][2] and (value == 0 or value >= 1e3), "triaxial", value, "a stress")
    except (IndexError, ParameterError):
        raise ParameterError("triaxial", str(Path(path)), f"a table of stresses in Pa, unlike line {line}: "
                             f"{','.join(row)[:60]} (a column in MPa says so in its header)") from None
    return value


def _chosen(table, path, *, ucs, crushes):
    """{"points", "ductile": points to fit, "left_out": words on the others} of a table. crushes: whether bonds can."""
    unconfined = table.get(0.0, ucs)
    require(abs(unconfined / ucs - 1) <= FIRST_POINT, "triaxial", f"{path}, sigma1 = {unconfined:g} Pa at sigma3 = 0",
            f"within {100 * FIRST_POINT:g} % of ucs = {ucs:g}")
    strengths = [ucs, *(table[least] for least in table if least)]
    require(len(strengths) > 1 and all(a < b for a, b in zip(strengths, strengths[1:])), "triaxial", str(path),
            "a table in which sigma1 rises with sigma3 from ucs on")
    low = [least for least in table if 0 < least <= HIGHEST * ucs]
    require(low, "triaxial", str(path), f"a table with a point at a confinement of at most {HIGHEST:g} ucs")
    least, most = RISE
    rise = (table[low[-1]] - ucs) / low[-1]
    require(least <= rise <= most, "triaxial", f"{path}, sigma1 = {table[low[-1]]:g} Pa at sigma3 = {low[-1]:g} Pa",
            f"above ucs = {ucs:g} by {least:g} to {most:g} sigma3, as of what has friction")
    kept = _spread(low, MOST_POINTS)
    ductile = _spread([least for least in table if least > HIGHEST * ucs], MOST_DUCTILE) if crushes else []
    others = [f"{1e-6 * least:g}" for least in table if least and least not in kept + ductile]
    return {"points": tuple((least, table[least]) for least in kept),
            "ductile": tuple((least, table[least]) for least in ductile),
            "left_out": f"Points of the table at {', '.join(others)} MPa are not fitted." if others else ""}


def _spread(values, most):
    """At most `most` of sorted values, the first and the last among them."""
    return sorted({values[round(k)] for k in np.linspace(0, len(values) - 1, most)}) if values else []


def start_of(values):
    """{parameter: value at the radii of the fit} of the rock that the search begins with, {} without one. Raises
    ParameterError."""
    require(values["start"] or values["first_stage"] == STAGES[0], "first_stage", values["first_stage"],
            f"{STAGES[0]} without start, a rock that is near")
    if not values["start"]:
        return {}
    radii = {name: values[name] for name in ("radius_min", "radius_max")}
    try:
        found = RockPresets(OF_ROCK).defaults(values["start"], {**dict.fromkeys(OF_ROCK), **radii})
    except ParameterError as error:
        raise ParameterError("start", error.value, error.rule) from None
    require(found["bond_law"] == values["bond_law"], "start", values["start"], f"a rock with the bond law "
            f"{values['bond_law']}; it has {found['bond_law']}")
    return found


def given_of(values, targets, start=None):
    """{parameter of a scene: value} of what is not fitted. values: of GROUPS; start: {parameter: value} of a rock,
    which counts where the command line leaves a default."""
    start = start or {}
    edge = values["grain_edge"]
    if edge < 0 and start:
        edge = start.get("grain_edge", 0.0)
    elif edge < 0:
        ratio = targets.ucs / targets.tensile_strength
        edge = (values["radius_min"] + values["radius_max"]) / 2 * next(part for most, part in GRAINS if ratio <= most)
    found = {name: start.get(name, values[name]) if values[name] == OF_ROCK[name].default else values[name]
             for name in GIVEN}
    return {**found, "grain_edge": float(f"{edge:.4g}"), **{
        name: start[name] for name in KEPT if start.get(name) and not (name == "bond_crushing" and targets.ductile)}}

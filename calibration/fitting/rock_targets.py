"""What a fitted rock is to be: laboratory values from the command line and a table, checked against each other."""
import math
from dataclasses import dataclass

import numpy as np

from calibration.fitting.relations import elastic_guess
from calibration.laboratory import strength_table
from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError, finite, require, within
from rockwear.kernels.membrane import STIFF
from rockwear.kernels.packing import POROSITY_LIMITS
from rockwear.kernels.parameter import Group, Parameter, choice, file, integer, number, plausible, text, words
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
DENSITIES = 300.0, 10e3
"""kg/m3, of rocks."""
KEPT = ("rotation", "bond_shear_energy", "bond_crushing", "crushing_hardening", "bond_tension_power",
        "bond_cohesion_power")
"""Parameters of the rock that the fit begins with, which stay as they are there; the crushing strength where no ductile
points are fitted."""
GRAINS = (5.0, 0.0), (11.0, 1.8), (math.inf, 2.2)
"""(largest UCS over tensile strength, grain_edge over the mean radius that can give it). Without grains and with the
cohesive law the ratio is 4.1 to 6.8 for shear over tensile strengths of 0.5 to 10 (relations.json); at an edge of 1.8
radii it is 6.2, 8.1 and 13.0 for 1.5, 3 and 7 (525 discs, three packings)."""
FRICTION_FITTED = 1.2
"""Ratio of such strengths to what a rock reaches whose confined strengths ask for little friction in its bonds: 10.9 to
9.3 at a friction of 0.12, shear over tension of 4.4 and an edge of 1.8 radii (ten packings)."""
LEAST_EDGE, MOST_EDGE = 1.4, 12.0
"""Mean radii, edges of grains: each has a disc of its own, and the smallest specimens of a fit hold five."""
CONFINEMENTS = 0.1, 0.3
"""Confinements over UCS at which a friction angle is fitted."""
HIGHEST = 1.5
"""Confinement over UCS above which a rock is ductile: grains crush there (cohesive bonds alone can)."""
MOST_POINTS, MOST_DUCTILE = 5, 2
"""Confined tests of one packing up to there and beyond, each dear."""
FIRST_POINT = 0.2
"""Largest difference of a table's unconfined strength from UCS, over UCS."""
SCATTER = 0.25
"""Largest part by which a strength may lie below one at less confinement: single specimens of a rock scatter by 10 to
15 %, the difference of two by up to twice that."""
OVERLAP = 0.9
"""Part of the largest confinement of the laboratory that a fit uses, at the first guess of kn: that may fall."""


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


def edge_or_choice(name, value, unit):
    """A rule: an edge (m), 0 for none, or -1 for one that the fit chooses."""
    edge = number(-1)(name, value, unit)
    require(edge == -1 or edge >= 0, name, edge, "-1, 0 or greater than 0", unit)
    return edge


TARGETS = Group("targets", (
    _target("youngs_modulus", "Young's modulus"), _target("poissons_ratio", "Poisson's ratio"),
    _target("ucs", "uniaxial compressive strength"), _target("tensile_strength", "strength in direct tension"),
    _target("fracture_toughness", "K_IC; not needed"),
    _target("friction_angle", "of Mohr-Coulomb at low confinement; not needed"),
    Parameter("triaxial", "", "", file, "CSV table of strengths (commas, semicolons or tabs), columns sigma3 and "
              "sigma1 in Pa, or sigma3_MPa and sigma1_MPa (kPa, GPa); not needed, and in place of friction_angle",
              "yours")))
ROCK = Group("rock", (
    Parameter("name", "fitted_rock", "", words, "of the rock"),
    Parameter("source", "laboratory values given to calibration.fit", "", words, "where the targets are from"),
    Parameter("radius_min", 1e-3, "m", plausible(*RADIUS), "smallest radius of the particles", "[Rojek 2003, 5.1]"),
    Parameter("radius_max", 1.5e-3, "m", plausible(*RADIUS), "largest radius of the particles", "[Rojek 2003, 5.1]"),
    Parameter("bond_law", LAWS[-1] if LAWS[-1] in BOND_LAWS else LAWS[0], "",
              choice(*(law for law in LAWS if law in BOND_LAWS)), "force law of the bonds"),
    *(OF_ROCK[name] for name in GIVEN),
    Parameter("density", OF_ROCK["rock_density"].default, "kg/m3", number(*DENSITIES), "bulk density, that of the rock "
              "in every scene", OF_ROCK["rock_density"].source),
    Parameter("grain_edge", -1.0, "m", edge_or_choice, "mean edge of grains; 0: none; -1: chosen by ucs over "
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
    points that are pooled or not fitted."""

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
    radius, edge = (values["radius_min"] + values["radius_max"]) / 2, values["grain_edge"]
    require(edge <= 0 or edge >= LEAST_EDGE * radius, "grain_edge", edge,
            f"at least {LEAST_EDGE * radius:.3g}, so that each grain has a disc; 0 for none", "m")
    require(edge <= MOST_EDGE * radius, "grain_edge", edge,
            f"at most {MOST_EDGE * radius:.3g}: the smallest specimens of a fit hold five grains then", "m")
    least = FAR * least_toughness(found["tensile_strength"], radius=radius)
    require(found.get("fracture_toughness", least) >= least, "fracture_toughness", values["fracture_toughness"],
            f"at least {least:.3g}, half of what the most brittle bonds have at these radii", "Pa sqrt(m)")
    within("porosity", values["porosity"], *POROSITY_LIMITS[2])
    if values["triaxial"]:
        chosen = _chosen(strength_table.read(values["triaxial"], "triaxial"), values["triaxial"], ucs=found["ucs"],
                         crushes=values["bond_law"] == "cohesive")
        return _checked(Targets(**found, **chosen), "triaxial", values["triaxial"])
    if values["friction_angle"] is not None:
        sine = math.sin(math.radians(values["friction_angle"]))
        slope = (1 + sine) / (1 - sine)
        require(slope <= RISE[1], "friction_angle", values["friction_angle"], "at most 71, as of rocks",
                "deg")
        points = tuple((part * found["ucs"], (1 + slope * part) * found["ucs"]) for part in CONFINEMENTS)
        return _checked(Targets(**found, points=points), "friction_angle", f"{values['friction_angle']:g} deg")
    return Targets(**found)


def _checked(targets, name, given):
    """The targets, with no confinement at which discs overlap too far. name, given: the parameter that asks for it."""
    kn, _ = elastic_guess(youngs_modulus=targets.youngs_modulus, poissons_ratio=targets.poissons_ratio)
    most = OVERLAP * STIFF * kn
    for least, _ in targets.confined():
        require(least <= most, name, f"{given}, tested at sigma3 = {least:g} Pa", f"without points above {most:.3g} "
                f"Pa, {most / targets.youngs_modulus:.2g} of youngs_modulus: discs overlap too far there")
    return targets


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


def _chosen(rows, path, *, ucs, crushes):
    """{"points", "ductile": points to fit, "left_out": words on the others} of the rows [(sigma3, sigma1)] of a table.
    crushes: whether bonds can.

    Repeats at one confinement count as their mean. Neighbours whose strengths do not rise are scatter: they are pooled,
    as in isotonic regression, and so are the closest neighbours where there are more than MOST_POINTS.
    """
    table = {least: _mean([row for row in rows if row[0] == least])[1] for least, _ in sorted(rows)}
    unconfined = table.get(0.0, ucs)
    require(abs(unconfined / ucs - 1) <= FIRST_POINT, "triaxial", f"{path}, sigma1 = {unconfined:g} Pa at sigma3 = 0",
            f"within {100 * FIRST_POINT:g} % of ucs = {ucs:g}")
    require(any(table), "triaxial", str(path), "a table with a confined strength")
    _check_order({least: largest for least, largest in table.items() if least}, path, ucs)
    groups = _rising([[row for row in rows if row[0] == least] for least in table if least], ucs)
    low = [group for group in groups if _mean(group)[0] <= HIGHEST * ucs]
    require(low, "triaxial", str(path), f"a table with a point at a confinement of at most {HIGHEST:g} ucs")
    least, most = RISE
    confinement, strength = _mean(low[-1])
    require(least <= (strength - ucs) / confinement <= most, "triaxial",
            f"{path}, sigma1 = {strength:g} Pa at sigma3 = {confinement:g} Pa",
            f"above ucs = {ucs:g} by {least:g} to {most:g} sigma3, as of what has friction")
    high = groups[len(low):]
    low = _fewer(low, MOST_POINTS)
    ductile = _spread(high, MOST_DUCTILE) if crushes else []
    return {"points": tuple(map(_mean, low)), "ductile": tuple(map(_mean, ductile)),
            "left_out": " ".join([*filter(None, map(_pooled, low + ductile)),
                                  *_unused([group for group in high if group not in ductile])])}


def _mean(group):
    """(sigma3, sigma1) of rows, in six digits."""
    return tuple(float(f"{value:.6g}") for value in np.mean(group, axis=0))


def _check_order(table, path, ucs):
    """Raise ParameterError for strengths that scatter alone does not explain."""
    highest, where = ucs, "ucs"
    for least, largest in table.items():
        row = f"{path}, sigma1 = {largest:g} Pa at sigma3 = {least:g} Pa"
        require(largest > least, "triaxial", row, "more than sigma3")
        require(largest >= (1 - SCATTER) * highest, "triaxial", row,
                f"no more than {100 * SCATTER:g} % below {where} = {highest:g}: less is no scatter")
        if largest > highest:
            highest, where = largest, f"sigma1 at {least:g} Pa"


def _rising(groups, ucs):
    """Groups of rows whose mean strengths rise, from above ucs on where there is more than one."""
    found = []
    for group in groups:
        found.append(group)
        while len(found) > 1 and _mean(found[-1])[1] <= _mean(found[-2])[1]:
            found[-2:] = [found[-2] + found[-1]]
    while len(found) > 1 and _mean(found[0])[1] <= ucs:
        found[:2] = [found[0] + found[1]]
    return found


def _fewer(groups, most):
    """At most `most` groups of rows: the nearest neighbours in sigma3 become one."""
    while len(groups) > most:
        places = [_mean(group)[0] for group in groups]
        k = int(np.argmin(np.diff(places)))
        groups = [*groups[:k], groups[k] + groups[k + 1], *groups[k + 2:]]
    return groups


def _pooled(group):
    """Words on a group of several confinements."""
    places = _places(group)
    return f"Points at {', '.join(places)} MPa count as one at {1e-6 * _mean(group)[0]:.3g} MPa, their mean." \
        if len(places) > 1 else ""


def _unused(groups):
    """[words] on groups that are not fitted."""
    places = [place for group in groups for place in _places(group)]
    return [f"Points of the table at {', '.join(places)} MPa are not fitted."] if places else []


def _places(group):
    """Confinements of rows, MPa, as words."""
    return [f"{1e-6 * least:g}" for least in sorted({least for least, _ in group})]


def _spread(values, most):
    """At most `most` of a sorted list, the first and the last among them."""
    return [values[k] for k in sorted({round(k) for k in np.linspace(0, len(values) - 1, most)})] if values else []


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
        ratio = targets.ucs / targets.tensile_strength * (FRICTION_FITTED if targets.confined() else 1.0)
        edge = (values["radius_min"] + values["radius_max"]) / 2 * next(part for most, part in GRAINS if ratio <= most)
    given = {**{name: values[name] for name in GIVEN}, "rock_density": values["density"]}
    found = {name: start.get(name, value) if value == OF_ROCK[name].default else value for name, value in given.items()}
    return {**found, "grain_edge": float(f"{edge:.4g}"), **{
        name: start[name] for name in KEPT if start.get(name) and not (name == "bond_crushing" and targets.ductile)}}

"""Parameter groups that scenes take as a whole; each scene has defaults of its own."""
from dataclasses import replace

from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.conduction import PATHS
from rockwear.kernels.density import LEAST_RATIO, MOST_RATIO
from rockwear.kernels.erosion import REMOVAL
from rockwear.kernels.parameter import (
    Above, Fixed, Group, Parameter, above_zero, choice, density, duration, file, flag, integer, law_parameters, length,
    length_or_zero, number, plausible, speed, stiffness, text, zero_or)
from rockwear.kernels.wear_laws import WEAR_LAWS
from rockwear.model.materials import SANDSTONE, STEEL
from rockwear.model.rock_file import RockPresets

MOST_CYCLES = 10**5
HARDNESS_TABLES = "MET71", "MET91"
BY_TABLE = {"hardness": (0.0,)}
OF_PARTICLES, OF_FACETS = {"tool": ("particles",)}, {"tool": ("segments", "triangles")}
OF_GRAINS = {"grain_edge": Above(0)}
PARAMETRIC = {"outline": ("",), "stl": ("",)}

# ---- rock

SPECIMEN = Group("rock", (
    Parameter("width", 0.109, "m", length, "width of the specimen", "[Rojek 2003, 5.1]"),
    Parameter("height", 0.109, "m", length, "height of the specimen", "[Rojek 2003, 5.1]"),
    Parameter("radius_min", 1e-3, "m", length, "smallest radius of rock particles", "[Rojek 2003, 5.1]"),
    Parameter("radius_max", 1.5e-3, "m", length, "largest radius of rock particles", "[Rojek 2003, 5.1]"),
    Parameter("porosity", 0.12, "", number(0), "1 - sum of particle areas over the box's area", "[Rojek 2014, 5.2]"),
    Parameter("seed", 1, "", integer(0), "of the packings of rock and tool"),
    Parameter("grading_factor", 1.0, "", number(1, 8), "factor by which radii grow below fine_depth; 1: uniform rock"),
    Parameter("fine_depth", 0.035, "m", length, "depth that keeps the fine particles"),
    Parameter("rock_density", SANDSTONE.density, "kg/m3", density, "bulk density of the rock", "[Rojek 2003, 7.4]")))

BLOCK = Group("rock", (
    Parameter("width", 0.62, "m", length, "length of the block, along the cut"),
    Parameter("height", 0.22, "m", length, "height of the block"),
    Parameter("depth", 0.41, "m", length, "depth of the block, across the cut"),
    Parameter("radius", 9e-3, "m", length, "radius of all rock spheres, before scale_factor", "[Rojek 2003, 13.1]"),
    Parameter("porosity", 0.36, "", number(0), "1 - sum of particle volumes over the block's volume"),
    Parameter("seed", 1, "", integer(0), "of the packings of rock and tool"),
    Parameter("scale_factor", 1.5, "", number(1, 8),
              "factor on the radii of rock and tool; stiffnesses grow with it and "
              "strengths with its square, so that the rock keeps modulus and strength"),
    Parameter("full", False, "", flag, "the source's sizes: scale_factor is 1 by default",
              presets=Fixed(scale_factor=1.0)),
    Parameter("rock_density", SANDSTONE.density, "kg/m3", density, "bulk density of the rock", "[Rojek 2003, 7.4]"),
    Parameter("gravity", 9.81, "m/s2", number(0), "downwards", "[Rojek 2003, 13.1]")))

BOND_PARAMETERS = (
    Parameter("bond_law", "brittle", "", choice(*BOND_LAWS), "force law of a bond", "[Rojek 2003, ch. 4]"),
    *law_parameters(BOND_LAWS, "bond_law"),
    Parameter("bonding_gap", 1e-4, "m", zero_or(1e-8, 1), "largest gap that is bonded",
              "[Rojek 2014, eq. 6]; the value is ours", size_power=(1, 1)),
    Parameter("weibull_modulus", 0.0, "", zero_or(0.5, 1000),
              "of the scatter of bond strengths about their mean; 0: none"),
    Parameter("rotation", "free", "", choice("free", "blocked"), "of the rock's particles; blocked: none ever turns, "
              "they interlock as grains do in the crudest way"),
    Parameter("grain_edge", 0.0, "m", length_or_zero, "mean edge of grains, Voronoi cells of particles; 0: no grains",
              "[Bahaaddini 2018, sec. 2]", size_power=(1, 1)),
    Parameter("grain_strength", 0.0, "", zero_or(1, 1e3), "strengths of bonds within a grain over those between "
              "grains; 0: grains do not break", "0: [Bahaaddini 2018, sec. 2]", OF_GRAINS),
    Parameter("grain_kn", 0.0, "N/m", number(0), "normal stiffness of bonds within a grain; 0: kn", "ours", OF_GRAINS,
              size_power=(0, 1)),
    Parameter("grain_kt", 0.0, "N/m", number(0), "tangential stiffness of bonds within a grain; 0: kt", "ours",
              OF_GRAINS, size_power=(0, 1)))
OF_ROCK = {p.name: p for p in (*BOND_PARAMETERS, *SPECIMEN.only("porosity", "rock_density"))}
"""What the file of a rock may give."""


def rock_parameter(**options):
    """The parameter that names the file of a rock. options: of RockPresets."""
    return Parameter("rock", "", "", text, "a rock of the library, or the file of your own: it gives the values that "
                     "follow their defaults, converted to the radii of the scene",
                     "ours", presets=RockPresets(OF_ROCK, **options))


BONDS = Group("bonds", (rock_parameter(), *BOND_PARAMETERS))

LOOSE = Group("bonds", (rock_parameter(only=("kn", "kt", "mu", "rock_density")), *(
    p for p in law_parameters({"brittle": BOND_LAWS["brittle"]}, "bond_law") if p.name in ("kn", "kt", "mu"))))
"""Contacts of rock that was never bonded."""

# ---- tool

OUTLINE = (
    Parameter("tooth_height", 0.07, "m", length, "height of the tooth", "ours: the sources show it in figures only",
              PARAMETRIC),
    Parameter("tooth_width", 0.045, "m", length, "width of the tooth at its top", "ours", PARAMETRIC),
    Parameter("rake", 0.0, "deg", number(-80, 80), "rake angle, from the vertical", "ours", PARAMETRIC),
    Parameter("clearance", 3.0, "deg", number(0, 80), "clearance angle, from the horizontal", "ours", PARAMETRIC),
    Parameter("tip_radius", 4e-3, "m", length, "rounding of the tip, which lies so far behind the tool's origin; an "
              "outline of your own is not rounded", "ours"),
    Parameter("wear_flat", 0.0, "m", length_or_zero, "length of a worn flat behind the tip", "ours", PARAMETRIC),
    Parameter("flat_angle", 0.0, "deg", number(0, 45), "by which the flat leans into the rock; its heel is then "
              "the lowest point, from which arc lengths count; 0: along the motion",
              "calibration/results/steady_cut.md", {**PARAMETRIC, "wear_flat": Above(0)}),
    Parameter("outline", "", "", file, "CSV file of x, y in m: a tooth of your own in place of the above. A "
              "level top and an upright back are held by the shank"))
SHAPE = (
    Parameter("work_fraction", 1.0, "", number(0, 1), "part of the friction work that wears a tool of facets",
              "[Rojek 2003, eq. 6.9]; [Rocky, eq. 2-53]: 0.5", OF_FACETS),
    Parameter("reshape", True, "", flag,
              "move the vertices of a tool of facets; false: note where it wears and keep the shape",
              "ours", OF_FACETS))

PLANE_TOOL = Group("tool", (
    Parameter("tool", "particles", "", choice("particles", "segments"), "what the tool is made of",
              "[Rojek 2003, 8.2, 8.1]"),
    *OUTLINE,
    Parameter("tool_radius_min", 0.4e-3, "m", length, "smallest radius of tool particles", "[Rojek 2003, 9.2]",
              OF_PARTICLES),
    Parameter("tool_radius_max", 0.52e-3, "m", length, "largest radius of tool particles", "[Rojek 2003, 9.2]",
              OF_PARTICLES),
    Parameter("thermal_radius", 0.5e-3, "m", length,
              "mean radius of the particles that fill a tool of facets for its heat",
              "ours", {**OF_FACETS, "heat": (True,)}),
    Parameter("segment", 1e-3, "m", length, "longest segment of the tool's outline", "ours", OF_FACETS),
    *SHAPE,
    Parameter("tool_density", STEEL.density, "kg/m3", density, "density of the tool", "[Rojek 2003, 7.4]")))

SPACE_TOOL = Group("tool", (
    Parameter("tool", "particles", "", choice("particles", "triangles"), "what the tool is made of",
              "[Rojek 2003, 13.3, 13.2]"),
    *OUTLINE,
    Parameter("breadth", 0.057, "m", length, "breadth of the tooth, across the cut", "ours", {"stl": ("",)}),
    Parameter("tool_radius", 1.5e-3, "m", length, "radius of the tool's spheres, before scale_factor",
              "[Rojek 2003, 13.3]",
              OF_PARTICLES),
    Parameter("stl", "", "", file,
              "STL file in m: a tool of your own in place of outline, breadth and tooth_*. It moves in +x, "
              "y is up, z across, the lowest point is the tip; top and back are fixed", "ours", {**OF_FACETS,
                                                                                                 "outline": ("",)}),
    Parameter("thermal_radius", 2e-3, "m", length,
              "mean radius of the particles that fill a tool of facets for its heat",
              "ours", {**OF_FACETS, "heat": (True,)}),
    Parameter("facet", 0.02, "m", length,
              "size of the tool's triangles, halves of such squares; edges of an STL file longer "
              "than 1.5 times that are cut in halves", "ours", OF_FACETS),
    *SHAPE,
    Parameter("tool_density", STEEL.density, "kg/m3", density, "density of the tool",
              "[Rojek 2003, 7.4]"))).with_defaults(
        tooth_height=0.14, tooth_width=0.0758, rake=30.0, clearance=20.0, reshape=False)

CONTACT = Group("contact of tool and rock", (
    Parameter("tool_kn", 90e9, "N/m", stiffness, "normal stiffness", "[Rojek 2003, 9.2]", size_power=(0, 1)),
    Parameter("tool_kt", 90e9, "N/m", stiffness, "tangential stiffness", "as tool_kn: no source gives one",
              size_power=(0, 1)),
    Parameter("tool_mu", 0.3, "", plausible(1e-3, 100), "friction", "[Rojek 2003, 9.2]"),
    Parameter("contact_damping", 0.9, "", number(0, 1), "dashpot, as a fraction of the critical one",
              "[Rojek 2003, 9.2]")))

# ---- motion

CUT_MOTION = (
    Parameter("velocity", 4.0, "m/s", speed, "cutting velocity", "[Rojek 2003, 9.2]"),
    Parameter("time_scale", 1.0, "", plausible(1e-4, 1e5),
              "mechanical over physical rate: the mechanics run so many times as fast as the "
              "process; heat flows, and all times count, in the process's own seconds, damping alone in those of the "
              "mechanics", "[Rojek 2003, 12.1], there 5"),
    Parameter("depth_of_cut", 0.008, "m", length, "depth of cut"),
    Parameter("approach", 0.5e-3, "m", length_or_zero, "free way before the tool meets the rock"))
DAMPING = Parameter("background_damping", 500.0, "1/s", number(0), "global viscous damping, rate of decay",
                    "ours: [Rojek 2003, 3.3] gives no number")
OTHER_DAMPING = (
    Parameter("non_viscous_damping", 0.0, "", number(0, 0.9), "of the rock, a fraction of each force against the "
              "velocity (Cundall's)", "[Rojek 2003, eqs 3.33-3.34]; [Rojek 2014, 3.1.3]"),
    Parameter("bond_damping", 0.0, "", number(0, 1), "dashpots of bonds and rock contacts, normal and tangential, as a "
              "fraction of the critical ones; in the plane", "[Rojek 2014, eqs 18-22]"),
    Parameter("grain_quality", 30.0, "", number(0), "quality factor of vibrations within grains, in the plane, if "
              "damping_period is short against their decay; 0: they do not decay",
              "ours; sandstones have some 20 to 100, recalled", OF_GRAINS))
CYCLES = Group("motion", (
    *CUT_MOTION,
    Parameter("start_up", 0.005, "s", duration, "time of the start-up cut", "[Rojek 2003, 9.1]"),
    Parameter("cycles", 3, "", integer(0, MOST_CYCLES),
              "cycles after the start-up, each on the rock that the start-up left"),
    Parameter("cycle_time", 0.007, "s", duration, "time of a cycle, beside what a worn tool needs to reach the rock"),
    DAMPING, *OTHER_DAMPING))
LOWERING = Group("motion", (
    Parameter("velocity", 0.04, "m/s", speed, "cutting velocity", "[Rojek 2003, 13.1]"),
    Parameter("lowering_velocity", 0.08, "m/s", speed, "of the tooth on its way down"),
    Parameter("depth_of_cut", 0.03, "m", length, "depth of cut"),
    Parameter("approach", 2e-3, "m", length_or_zero, "free way before the tool meets the rock"),
    Parameter("start", 0.0, "m", length_or_zero, "place of the tip when it is lowered, from the left end"),
    Parameter("cut_time", 1.0, "s", duration, "time of the horizontal cut", "[Rojek 2003, 13.3]"),
    Parameter("background_damping", 20.0, "1/s", number(0), "global viscous damping, rate of decay"),
    OTHER_DAMPING[0]))

# ---- wear

WEAR = Group("wear", (
    Parameter("hardness_table", "MET91", "", choice(*HARDNESS_TABLES), "hardness of the tool over temperature",
              "[Rojek 2003, 9.2, table 6.1]", BY_TABLE),
    Parameter("hardness_temperature", -1.0, "K", number(-1),
              "constant hardness, the table's at this temperature; -1: at the "
              "tool's own", "[Rojek 2003, 9.2] took 293", BY_TABLE),
    Parameter("hardness", 0.0, "Pa", number(0), "constant hardness itself; 0: the table's",
              "[Rojek 2003, ch. 8] took 1"),
    Parameter("wear_law", "dissipation", "", choice(*WEAR_LAWS),
              "friction work, pressure, a power of either, or several modes",
              "[Rojek 2003, eqs. 6.1-6.5]"),
    *law_parameters(WEAR_LAWS, "wear_law"),
    Parameter("wear_acceleration", 7000.0, "", number(0, 1e10), "factor on the wear coefficient", "[Rojek 2003, 9.2]"),
    Parameter("removal", "volume", "", choice(*REMOVAL),
              "criterion: Archard's volume conserved, the depth of [Rojek 2003, 6.5], "
              "or none: the shape stays", "ours", OF_PARTICLES),
    Parameter("wear_tolerance", 0.1, "", above_zero,
              "error of the wear distribution up to which a wear acceleration is trusted",
              "[Rocky]; the value is ours"),
    Parameter("tool_temperature", 293.15, "K", number(0), "of the tool at first", "[Rojek 2003, 9.2]")))

# ---- heat

BOND_CONDUCTANCE = Parameter(
    "bond_conductance", PATHS[0], "",
    choice(*PATHS, renamed={"cells": "voronoi", "packing": "fitted", "P": "bar", "M": "half_bar"}),
    "between particles: by the faces of their Voronoi cells; one value fitted to the packing; a bar between two "
    "centres, or half of it", "ours; ours; [Rojek 2014, eqs. 64-65]; [Rojek 2003, eq. 11.1]")
HEAT = Group("heat", (
    Parameter("heat", True, "", flag, "heat, or a hardness at the tool's first temperature"),
    Parameter("rock_specific_heat", SANDSTONE.specific_heat, "J/kgK", above_zero, "specific heat of the rock",
              "[Rojek 2003, 7.4]"),
    Parameter("rock_conductivity", SANDSTONE.conductivity, "W/mK", above_zero, "conductivity of the rock",
              "[Rojek 2003, 11.1]"),
    Parameter("rock_expansion", 0.0, "1/K", number(0), "linear thermal expansion of the rock; 0: none",
              "[Rojek 2014, 5.2]: 1e-5"),
    Parameter("tool_specific_heat", STEEL.specific_heat, "J/kgK", above_zero, "specific heat of the tool",
              "[Rojek 2003, 7.4]"),
    Parameter("tool_conductivity", STEEL.conductivity, "W/mK", above_zero, "conductivity of the tool",
              "[Rojek 2003, 7.4]"),
    Parameter("heat_fraction", 0.85, "", number(0, 1), "chi, the part of friction work that becomes heat",
              "[Rojek 2014, 5.2]"),
    Parameter("heat_sharing", "effusivity", "", choice("effusivity", "equal"), "of friction heat between tool and rock",
              "[Rojek 2014, eqs. 39-41]; [Rojek 2003, 4.5] shares equally"),
    Parameter("conduction", True, "", flag, "false: all heat stays with the particles that it arose at",
              "[Rojek 2003, 10.1]"),
    BOND_CONDUCTANCE,
    Parameter("shank", "insulated", "", choice("insulated", "fixed"), "the tool's particles held by the shank",
              "[Rojek 2003, 11.3]"),
    Parameter("shank_temperature", 293.15, "K", number(0), "of a fixed shank", "[Rojek 2003, 11.3]",
              {"shank": ("fixed",)}),
    Parameter("contact_conductance", 1500.0, "W/m2K", number(0), "between tool and rock", "[Rojek 2014, 5.2]"),
    Parameter("convection", 30.0, "W/m2K", number(0), "at the free surface, natural air", "[Rojek 2003, 7.5]"),
    Parameter("emissivity", 0.0, "", number(0, 1), "of the free surface of rock and tool, which radiates beside "
              "convection; 0: no radiation", "[Rojek 2003, 7.5] counts radiation within convection; its 60 W/m2K at "
              "1000 C are an emissivity of 0.4"),
    Parameter("ambient_temperature", 293.15, "K", number(0), "of the air, and of what is around that radiates back",
              "[Rojek 2003, 9.2]"),
    Parameter("rock_temperature", 293.15, "K", number(0), "of the rock at first", "[Rojek 2003, 9.2]")),
             {"heat": (True,)})

# ---- accuracy

TIME_STEP = (
    Parameter("time_step_fraction", 0.8, "", number(1e-4, 1), "time step over the critical one", "make bench",
              {"time_step": (0.0,)}),
    Parameter("time_step", 0.0, "s", zero_or(1e-15, 1), "time step itself; 0: by time_step_fraction"))
ACCURACY = Group("accuracy", (
    *TIME_STEP,
    Parameter("sampling_period", 1, "steps", integer(1), "between samples of the tool's contacts", "make bench"),
    Parameter("rock_sampling_period", 4, "steps", integer(1), "between samples of sliding rock contacts", "make bench"),
    Parameter("wear_period", 100, "steps", integer(1), "between updates of wear and removal",
              "calibration/results/particle_size.md"),
    Parameter("heat_period", 1e-4, "s", duration, "between heat steps, each divided as stability asks", "make bench",
              {"heat": (True,)}),
    Parameter("surface_period", 5e-4, "s", duration, "between searches for free surface and open cracks", "ours",
              {"heat": (True,)}),
    Parameter("damping_period", 500, "steps", integer(1), "between visits of the background damping, at most"),
    Parameter("record_period", 2e-5, "s", duration, "between rows of history.csv")))

# ---- output

DENSITY_MAP = Group("output", (
    Parameter("control_radius", 0.0, "", zero_or(LEAST_RATIO, MOST_RATIO),
              "of the density map: radius of the control volume around a particle, over the particle's own, 3 say; 0: "
              "no density map", "[Rojek 2003, eq. 7.9]"),))
"""What a snapshot shows of rock when asked to."""


def given(groups, **values):
    """The groups without what a scene gives itself, {name: value}, and without what is not used with these values."""
    def used(one):
        return all(values[name] in allowed for name, allowed in (one.when or {}).items() if name in values)
    return [replace(group, when=None if set(group.when or ()) <= set(values) else group.when,
                    parameters=tuple(p for p in group.parameters if p.name not in values and used(p)))
            for group in groups if used(group)]


def with_defaults(groups, **defaults):
    """The groups with other defaults. Raises KeyError for a name that is in none of them."""
    unknown = set(defaults) - {p.name for group in groups for p in group.parameters}
    if unknown:
        raise KeyError(f"no such parameter: {', '.join(sorted(unknown))}")
    return [group.with_defaults(**{p.name: defaults[p.name] for p in group.parameters if p.name in defaults})
            for group in groups]

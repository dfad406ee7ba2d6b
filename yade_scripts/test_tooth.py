"""M 9.2, thermo-mechanical: a test tooth cuts bonded sandstone, heats up, wears and changes its shape over many cycles.

    yade -n -x yade_scripts/test_tooth.py [--name value ...] [--out DIR] [--resume]
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from rockwear import run  # noqa: E402
from rockwear.parameters import Parameter, above_zero, choice, flag, integer, number, text  # noqa: E402
from rockwear.scene import Cutting  # noqa: E402

PARAMETERS = [
    # rock
    Parameter("width", 0.109, "m", above_zero, "width of the specimen", "M 5.1"),
    Parameter("height", 0.109, "m", above_zero, "height of the specimen", "M 5.1"),
    Parameter("radius_min", 1e-3, "m", above_zero, "smallest radius of rock particles", "M 5.1"),
    Parameter("radius_max", 1.5e-3, "m", above_zero, "largest radius of rock particles", "M 5.1"),
    Parameter("porosity", 0.12, "", number(0), "1 - sum of particle areas over the box's area", "P 5.2"),
    Parameter("seed", 1, "", integer(0), "of the packings of rock and tool"),
    Parameter("coarsening", 1.0, "", number(1, 8), "factor by which radii grow below fine_depth; 1: uniform rock"),
    Parameter("fine_depth", 0.035, "m", above_zero, "depth that keeps the fine particles"),
    Parameter("bonding_gap", 1e-4, "m", number(0), "largest gap that is bonded", "P 6; the value is ours"),
    Parameter("kn", 20e9, "N/m", above_zero, "normal stiffness of bonds and rock contacts", "M 5.1"),
    Parameter("kt", 20e9, "N/m", above_zero, "tangential stiffness", "M 5.1"),
    Parameter("Rn", 0.1e6, "N", above_zero, "tensile strength of a bond", "M 5.1"),
    Parameter("Rt", 1e6, "N", above_zero, "shear strength of a bond", "M 5.1"),
    Parameter("mu", 0.839, "", number(0), "friction between rock particles after breakage", "M 5.1"),
    Parameter("rock_density", 2500.0, "kg/m3", above_zero, "bulk density of the rock", "M 7.4"),
    Parameter("rock_specific_heat", 1970.0, "J/kgK", above_zero, "specific heat of the rock", "M 7.4"),
    Parameter("rock_conductivity", 5.0, "W/mK", above_zero, "conductivity of the rock", "M 11.1"),
    # tool
    Parameter("tooth_height", 0.07, "m", above_zero, "height of the tooth", "ours: M shows it in a figure only"),
    Parameter("tooth_width", 0.045, "m", above_zero, "width of the tooth at its top", "ours"),
    Parameter("rake", 10.0, "deg", number(-80, 80), "rake angle, from the vertical", "ours"),
    Parameter("clearance", 10.0, "deg", number(0, 80), "clearance angle, from the horizontal", "ours"),
    Parameter("tip_radius", 2e-3, "m", above_zero, "rounding of the tip", "ours"),
    Parameter("outline", "", "", text, "CSV file of x, y in m: a tooth of your own in place of the five above"),
    Parameter("tool_radius_min", 0.4e-3, "m", above_zero, "smallest radius of tool particles", "M 9.2"),
    Parameter("tool_radius_max", 0.52e-3, "m", above_zero, "largest radius of tool particles", "M 9.2"),
    Parameter("tool_kn", 90e9, "N/m", above_zero, "normal stiffness of the tool-rock contact", "M 9.2"),
    Parameter("tool_kt", 90e9, "N/m", above_zero, "tangential stiffness of the tool-rock contact", "as kn: M gives none"),
    Parameter("tool_mu", 0.3, "", above_zero, "friction between tool and rock", "M 9.2"),
    Parameter("contact_damping", 0.9, "", number(0, 1), "dashpot, as a fraction of the critical", "M 9.2"),
    Parameter("tool_density", 7830.0, "kg/m3", above_zero, "density of the steel", "M 7.4"),
    Parameter("tool_specific_heat", 450.0, "J/kgK", above_zero, "specific heat of the steel", "M 7.4"),
    Parameter("tool_conductivity", 60.0, "W/mK", above_zero, "conductivity of the steel", "M 7.4"),
    # motion
    Parameter("velocity", 4.0, "m/s", above_zero, "cutting velocity", "M 9.2"),
    Parameter("depth_of_cut", 0.01, "m", above_zero, "depth of cut", "ours"),
    Parameter("approach", 0.5e-3, "m", number(0), "free way before the tool meets the rock", "ours"),
    Parameter("start_up", 0.005, "s", above_zero, "time of the start-up cut", "M 9.1"),
    Parameter("cycles", 3, "", integer(0), "cycles after the start-up, each on the rock that the start-up left"),
    Parameter("cycle_time", 0.005, "s", above_zero, "time of a cycle", "ours"),
    Parameter("background_damping", 500.0, "1/s", number(0), "global viscous damping, rate of decay", "ours: M gives none"),
    # wear
    Parameter("steel", "MET91", "", choice("MET71", "MET91"), "hardness table", "M 9.2, table 6.1"),
    Parameter("hardness_temperature", -1.0, "K", number(-1), "constant hardness at this temperature; -1: the tool's own",
              "M 9.2 took 293"),
    Parameter("wear_coefficient", 0.01128, "", number(0), "Archard's k", "mean of M 6.14-6.15"),
    Parameter("acceleration", 7000.0, "", number(0), "factor on k", "M 9.2"),
    Parameter("removal", "volume", "", choice("volume", "depth"), "criterion: Archard's volume conserved, or the depth of M 6.5"),
    # heat
    Parameter("heat", True, "", flag, "heat, or a hardness at the tool's first temperature"),
    Parameter("heat_fraction", 0.85, "", number(0, 1), "chi, the part of friction work that becomes heat", "P 5.2"),
    Parameter("contact_conductance", 1500.0, "W/m2K", number(0), "between tool and rock", "P 5.2"),
    Parameter("convection", 30.0, "W/m2K", number(0), "at the free surface, natural air", "M 7.5"),
    Parameter("ambient_temperature", 293.15, "K", number(0), "of the air", "M 9.2"),
    Parameter("rock_temperature", 293.15, "K", number(0), "of the rock at first", "M 9.2"),
    Parameter("tool_temperature", 293.15, "K", number(0), "of the tool at first", "M 9.2"),
    # accuracy against speed: defaults from make bench
    Parameter("time_step_fraction", 0.8, "", number(1e-4, 1), "time step over the critical one", "make bench"),
    Parameter("time_step", 0.0, "s", number(0), "time step itself; 0: by time_step_fraction"),
    Parameter("sampling_period", 1, "steps", integer(1), "between samples of the tool's contacts", "make bench"),
    Parameter("rock_sampling_period", 5, "steps", integer(1), "between samples of sliding rock contacts", "make bench"),
    Parameter("wear_period", 100, "steps", integer(1), "between updates of wear and removal", "make bench"),
    Parameter("heat_period", 1e-4, "s", above_zero, "between heat steps, each divided as stability asks", "make bench"),
    Parameter("surface_period", 5e-4, "s", above_zero, "between searches for free surface and open cracks", "make bench"),
    Parameter("damping_period", 500, "steps", integer(1), "between visits of the background damping", "make bench"),
    Parameter("record_period", 2e-5, "s", above_zero, "between rows of history.csv"),
]

run.main("test_tooth", PARAMETERS, Cutting)

"""The cut: a rigid tooth of particles through bonded rock, with heat, wear and many cycles (M ch. 9-11, P 5)."""
import math
import shutil
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from yade import FrictMat, O, utils

from rockwear.scenes import yade_scene
from rockwear.scenes.scene import Scene
from rockwear.scenes.tool_bodies import ToolBodies
from rockwear.run import vtk
from rockwear.engines.bonds import Bonds, Crack
from rockwear.engines.separation import Separation
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.expansion import Expansion
from rockwear.engines.heat import Heat
from rockwear.engines.damping import BackgroundDamping
from rockwear.engines.path_follower import PathFollower
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.base import RunEnded
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.recorder import Recorder
from rockwear.engines.tool_contact import ToolContact
from rockwear.engines.wear import Wear
from rockwear.engines.wear_profile import WearProfile
from rockwear.kernels.archard import BRINELL, KELVIN, MET71, MET91, Hardness
from rockwear.kernels.bond_laws import LINEAR_LAWS, linear_law
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.conduction import (
    PATHS, HeatNetwork, calibrated_conductance, effusivity, effusivity_share, paths)
from rockwear.kernels.erosion import REMOVAL
from rockwear.kernels.polygon import read_outline, tip, tooth
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.stability import critical_time_step
from rockwear.kernels.wear_laws import LAWS, wear_law
from rockwear.kernels.wear_statistics import distribution_error, events_per_particle, places, trusted_wear_acceleration
from rockwear.model.materials import Material
from rockwear.kernels.parameter import Parameter, above_zero, choice, file, flag, integer, number, text
from rockwear.model.rock import Specimen
from rockwear.model.particle_tool import Tool
from rockwear.model.thermal_body import ParticleBody

HARDNESS = {"MET71": MET71, "MET91": MET91}
MOST_HEAT_STEPS = 1000
"""Into which the time between two visits may have to be divided."""
GUIDE_PERIOD = 100
"""Steps N between the corners of a curved path, which chords leave by (v dt N)^2 / 8R: 23 nm at P's pick (5.7 m/s, 0.7 m)."""
PROFILE_PERIOD = 10
"""Visits of the wear between rows of its profile."""
ENERGY_MISSED = 0.05
"""Part of its largest entry that the energy book may miss without a warning."""

LOST = 0.1
"""Part of Archard's volume that a rule of removal may lose without a warning."""

PARAMETERS = [
    # rock
    Parameter("width", 0.109, "m", above_zero, "width of the specimen", "M 5.1"),
    Parameter("height", 0.109, "m", above_zero, "height of the specimen", "M 5.1"),
    Parameter("radius_min", 1e-3, "m", above_zero, "smallest radius of rock particles", "M 5.1"),
    Parameter("radius_max", 1.5e-3, "m", above_zero, "largest radius of rock particles", "M 5.1"),
    Parameter("porosity", 0.12, "", number(0), "1 - sum of particle areas over the box's area", "P 5.2"),
    Parameter("seed", 1, "", integer(0), "of the packings of rock and tool"),
    Parameter("grading_factor", 1.0, "", number(1, 8), "factor by which radii grow below fine_depth; 1: uniform rock"),
    Parameter("fine_depth", 0.035, "m", above_zero, "depth that keeps the fine particles"),
    Parameter("bonding_gap", 1e-4, "m", number(0), "largest gap that is bonded", "P 6; the value is ours"),
    Parameter("kn", 20e9, "N/m", above_zero, "normal stiffness of bonds and rock contacts", "M 5.1"),
    Parameter("kt", 20e9, "N/m", above_zero, "tangential stiffness", "M 5.1"),
    Parameter("Rn", 0.1e6, "N", above_zero, "tensile strength of a bond", "M 5.1"),
    Parameter("Rt", 1e6, "N", above_zero, "shear strength of a bond", "M 5.1"),
    Parameter("bond_law", "brittle", "", choice(*LINEAR_LAWS), "of the bonds; the others soften from the strength on", "M 4"),
    Parameter("H", 1e10, "N/m", above_zero, "slope of softening, against total displacement", "M 4.6"),
    Parameter("mu", 0.839, "", number(0), "friction between rock particles after breakage", "M 5.1"),
    Parameter("rock_density", 2500.0, "kg/m3", above_zero, "bulk density of the rock", "M 7.4"),
    Parameter("rock_specific_heat", 1970.0, "J/kgK", above_zero, "specific heat of the rock", "M 7.4"),
    Parameter("rock_conductivity", 5.0, "W/mK", above_zero, "conductivity of the rock", "M 11.1"),
    Parameter("rock_expansion", 0.0, "1/K", number(0), "linear thermal expansion of the rock; 0: none", "P 5.2 has 1e-5"),
    # tool
    Parameter("tooth_height", 0.07, "m", above_zero, "height of the tooth", "ours: M shows it in a figure only"),
    Parameter("tooth_width", 0.045, "m", above_zero, "width of the tooth at its top", "ours"),
    Parameter("rake", 0.0, "deg", number(-80, 80), "rake angle, from the vertical", "ours"),
    Parameter("clearance", 3.0, "deg", number(0, 80), "clearance angle, from the horizontal", "ours"),
    Parameter("tip_radius", 4e-3, "m", above_zero, "rounding of the tip", "ours"),
    Parameter("outline", "", "", file, "CSV file of x, y in m: a tooth of your own in place of the five above"),
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
    Parameter("time_scale", 1.0, "", above_zero, "the mechanics run so many times as fast as the process; heat flows, and "
              "all times count, in the process's own seconds", "M 12.1, there 5"),
    Parameter("depth_of_cut", 0.008, "m", above_zero, "depth of cut", "ours"),
    Parameter("approach", 0.5e-3, "m", number(0), "free way before the tool meets the rock", "ours"),
    Parameter("start_up", 0.005, "s", above_zero, "time of the start-up cut", "M 9.1"),
    Parameter("cycles", 3, "", integer(0), "cycles after the start-up, each on the rock that the start-up left"),
    Parameter("cycle_time", 0.007, "s", above_zero, "time of a cycle, beside what a worn tool needs to reach the rock", "ours"),
    Parameter("background_damping", 500.0, "1/s", number(0), "global viscous damping, rate of decay", "ours: M gives none"),
    # wear
    Parameter("hardness_table", "MET91", "", choice("MET71", "MET91"), "hardness table", "M 9.2, table 6.1"),
    Parameter("hardness_temperature", -1.0, "K", number(-1), "constant hardness at this temperature; -1: the tool's own",
              "M 9.2 took 293"),
    Parameter("hardness", 0.0, "Pa", number(0), "constant hardness itself; 0: the steel's", "M 8 took 1"),
    Parameter("wear_coefficient", 0.01128, "", number(0), "Archard's k", "mean of M 6.14-6.15"),
    Parameter("wear_law", "dissipation", "", choice(*LAWS), "friction work, pressure, power of either, or several modes",
              "M 6.3, 6.1, 6.5, 6.4"),
    Parameter("wear_exponent", 1.0, "", above_zero, "n of the power law, k (p / H)^n", "M 6.5; the value is ours"),
    Parameter("wear_modes", "", "", text, "k/exponent/share of the friction for each mode, with commas", "M 6.4-6.5"),
    Parameter("wear_acceleration", 7000.0, "", number(0), "factor on k", "M 9.2"),
    Parameter("removal", "volume", "", choice(*REMOVAL), "criterion: Archard's volume conserved, the depth of M 6.5, "
              "or none: the shape stays"),
    Parameter("wear_tolerance", 0.1, "", above_zero, "error of the wear distribution up to which an acceleration is trusted",
              "R; the value is ours"),
    # heat
    Parameter("heat", True, "", flag, "heat, or a hardness at the tool's first temperature"),
    Parameter("heat_fraction", 0.85, "", number(0, 1), "chi, the part of friction work that becomes heat", "P 5.2"),
    Parameter("heat_sharing", "effusivity", "", choice("effusivity", "equal"), "of friction heat between tool and rock",
              "P 39-41; M 4.5 shares equally"),
    Parameter("conduction", True, "", flag, "false: all heat stays with the particles that it arose at", "M 10.1"),
    Parameter("bond_conductance", "voronoi", "", choice(*PATHS), "between particles: by the faces of their Voronoi cells; "
              "one value fitted to the packing; or a bar between two centres, or half of it", "ours; ours; P 64-65; M 11.1"),
    Parameter("shank", "insulated", "", choice("insulated", "fixed"), "the tool's particles held by the shank", "M 11.3"),
    Parameter("shank_temperature", 293.15, "K", number(0), "of a fixed root", "M 11.3"),
    Parameter("contact_conductance", 1500.0, "W/m2K", number(0), "between tool and rock", "P 5.2"),
    Parameter("convection", 30.0, "W/m2K", number(0), "at the free surface, natural air", "M 7.5"),
    Parameter("ambient_temperature", 293.15, "K", number(0), "of the air", "M 9.2"),
    Parameter("rock_temperature", 293.15, "K", number(0), "of the rock at first", "M 9.2"),
    Parameter("tool_temperature", 293.15, "K", number(0), "of the tool at first", "M 9.2"),
    # accuracy against speed
    Parameter("time_step_fraction", 0.8, "", number(1e-4, 1), "time step over the critical one", "make bench"),
    Parameter("time_step", 0.0, "s", number(0), "time step itself; 0: by time_step_fraction"),
    Parameter("sampling_period", 1, "steps", integer(1), "between samples of the tool's contacts", "make bench"),
    Parameter("rock_sampling_period", 4, "steps", integer(1), "between samples of sliding rock contacts", "make bench"),
    Parameter("wear_period", 100, "steps", integer(1), "between updates of wear and removal", "calibration/benchmarks/particle_size.py"),
    Parameter("heat_period", 1e-4, "s", above_zero, "between heat steps, each divided as stability asks", "make bench"),
    Parameter("surface_period", 5e-4, "s", above_zero, "between searches for free surface and open cracks"),
    Parameter("damping_period", 500, "steps", integer(1), "between visits of the background damping"),
    Parameter("record_period", 2e-5, "s", above_zero, "between rows of history.csv"),
]


def parameters(**defaults):
    """PARAMETERS with other defaults, for a scene of its own."""
    unknown = set(defaults) - {parameter.name for parameter in PARAMETERS}
    if unknown:
        raise KeyError(f"no such parameter: {', '.join(sorted(unknown))}")
    return [replace(p, default=defaults[p.name]) if p.name in defaults else p for p in PARAMETERS]


class Cutting(Scene):
    """A rigid tooth of particles cuts bonded rock: start-up, then cycles with the worn tooth put back (M 9.1).

    values: {name: value} of all PARAMETERS. The constructor does all that can fail on a
    parameter, without YADE's scene; `build` fills the scene.
    """

    looking = {*Scene.looking, "tool_contact"}
    loose_rock, put_loop = FrictMat, staticmethod(yade_scene.put_loop)
    ratcheting_free = True
    piece, volume_unit = "a particle", "m3/m"
    """What of the tool wears away in one, and the unit of its volume."""

    def __init__(self, values):
        self.values = values
        v = self.v = SimpleNamespace(**values)
        self.time_scale = v.time_scale
        require(v.radius_max >= v.radius_min, "radius_max", v.radius_max, f"at least radius_min = {v.radius_min:g}", "m")
        require(v.tool_radius_max >= v.tool_radius_min, "tool_radius_max", v.tool_radius_max,
                f"at least tool_radius_min = {v.tool_radius_min:g}", "m")
        require(v.tool_radius_max <= v.radius_min, "tool_radius_max", v.tool_radius_max,
                f"at most the rock's radius_min = {v.radius_min:g}: a smooth tool needs finer particles (M 6.5)", "m")
        self._check_cut(v)
        self.hardness = self._hardness(v)
        self.wear_law = wear_law(v.wear_law, k=v.wear_coefficient, mu=v.tool_mu, exponent=v.wear_exponent,
                                 modes=v.wear_modes).scaled(v.wear_acceleration)
        self.rock_material = Material(density=v.rock_density, specific_heat=v.rock_specific_heat,
                                      conductivity=v.rock_conductivity)
        self.tool_material = Material(density=v.tool_density, specific_heat=v.tool_specific_heat,
                                      conductivity=v.tool_conductivity)
        self.outline = self._outline(v)
        self._check_size(v, self.outline)
        self.law = self._law(v)
        self.rock = self._specimen(v)
        self.tool = self._make_tool(self.outline)
        self.motion = self._motion(v)
        self.foremost_when_new = self._foremost()
        self._choose_time_step(v)
        self._plan(self._stages(v))
        self.balance = {"kinetic": 0.0, "elastic": 0.0, "contact_elastic": 0.0}
        self.cracks_of_past_cycles = []

    def _outline(self, v):
        if v.outline:
            # Its tip is where the tooth of the parameters has its own, wherever the file has its origin.
            vertices = read_outline(v.outline)
            return vertices - tip(vertices) - [v.tip_radius, 0.0]
        vertices = self._tooth(v)
        # The chords of a round tip may end above its lowest point, from which the depth of cut counts.
        return vertices - [0.0, vertices[:, 1].min()]

    def _tooth(self, v):
        try:
            return tooth(height=v.tooth_height, width=v.tooth_width, rake=math.radians(v.rake),
                         clearance=math.radians(v.clearance), tip_radius=v.tip_radius)
        except ParameterError as error:
            # The kernel's words for them, and its radians, are not those of the scene.
            if error.unit == "rad":
                raise ParameterError(error.name, getattr(v, error.name), error.rule, "deg") from None
            name = {"height": "tooth_height", "width": "tooth_width"}.get(error.name, error.name)
            raise ParameterError(name, error.value, error.rule, error.unit) from None

    def _law(self, v):
        return linear_law(v.bond_law, kn=v.kn, kt=v.kt, Rn=v.Rn, Rt=v.Rt, H=v.H, mu=v.mu)

    def _make_tool(self, vertices):
        v = self.v
        return Tool(vertices=vertices, radius_min=v.tool_radius_min, radius_max=v.tool_radius_max, seed=v.seed,
                    removal=v.removal, material=self.tool_material)

    # ---- parameters

    def _check_cut(self, v):
        require(2 * v.radius_max < v.depth_of_cut < v.height, "depth_of_cut", v.depth_of_cut,
                f"more than a rock particle, {2 * v.radius_max:g}, and less than the specimen's height {v.height:g}", "m")
        travel = (v.start_up + (v.cycle_time if v.cycles else 0.0)) * v.velocity
        require(travel <= v.width, "cycle_time", v.cycle_time,
                f"so short that the tool's travel, {travel:g} m at {v.velocity:g} m/s with the start-up, stays within the "
                f"specimen's width {v.width:g} m", "s")

    def _check_size(self, v, vertices):
        width, height = np.ptp(vertices, axis=0)
        require(width <= v.width, "tooth_width", float(width), f"at most the specimen's width {v.width:g}", "m")
        require(height <= v.height, "tooth_height", float(height), f"at most the specimen's height {v.height:g}", "m")
        require(height > v.depth_of_cut, "tooth_height", float(height), f"more than depth_of_cut = {v.depth_of_cut:g}", "m")

    def _hardness(self, v):
        table = HARDNESS[v.hardness_table]
        low, high = table.limits
        for name in ("tool_temperature", "rock_temperature", "ambient_temperature", "shank_temperature"):
            value = getattr(v, name)
            require(low <= value <= high, name, value, f"inside the hardness table of {v.hardness_table}, {low:g} to {high:g}", "K")
        if v.hardness > 0:
            return Hardness.constant(v.hardness)
        if v.hardness_temperature >= 0:
            require(low <= v.hardness_temperature <= high, "hardness_temperature", v.hardness_temperature,
                    f"inside the hardness table of {v.hardness_table}, {low:g} to {high:g}, or -1 for the tool's own", "K")
            return Hardness.constant(table(v.hardness_temperature))
        return Hardness(table.kelvin - KELVIN, table.pascal / BRINELL)

    def _specimen(self, v):
        rock = Specimen(width=v.width, height=v.height, radius_min=v.radius_min, radius_max=v.radius_max,
                        porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap, grading_factor=v.grading_factor,
                        fine_depth=v.fine_depth, density=v.rock_density)
        # The specimen stands for a part of a rock mass: its sides are held where no chip can reach them.
        rock.fix("bottom")
        rock.fix("left", "right", below=v.height - 3 * v.depth_of_cut)
        return rock

    def _stages(self, v):
        return {"start-up": v.start_up, **{f"cycle {n + 1}": v.cycle_time for n in range(v.cycles)}}

    def _motion(self, v):
        x = -v.approach - self.tool.foremost(below=v.depth_of_cut + 2 * v.radius_max)
        return Straight(start=(x, v.height - v.depth_of_cut), velocity=(v.velocity * v.time_scale, 0.0))

    def _plan(self, stages):
        super()._plan(stages)
        self.approach_steps = np.zeros(len(self.stages), int)
        """Steps of each stage in which a worn tool comes to where the new one stood."""

    def _path_time(self):
        """Seconds along the tool's path; the rock put back before a cycle puts back this clock too."""
        return (O.iter - self.path_start) * self.time_step

    def _choose_time_step(self, v):
        rock = self.rock
        common = dict(positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                      bonds=rock.pairs, kn=v.kn, kt=v.kt, fixed=np.flatnonzero(rock.fixed))
        self.bonded_step = critical_time_step(**common)
        # Any free disc may be the one that the tool presses, from any side, with two of its particles at once.
        free = np.flatnonzero(~rock.fixed)
        dashpots = 4 * v.contact_damping * np.sqrt(v.tool_kn * rock.masses[free])
        sides = [np.tile([math.cos(angle), math.sin(angle)], (len(free), 1)) for angle in (0, math.pi / 4, math.pi / 2)]
        exact = min(critical_time_step(**common, ground=(free, side, 2 * v.tool_kn, 2 * v.tool_kt, dashpots))
                    for side in sides)
        # M's estimate (3.37) for the lightest disc is shorter where contacts are damped, and the energy book asks for it.
        highest = math.hypot(2 / self.bonded_step, math.sqrt(2 * v.tool_kn / float(rock.masses[free].min())))
        xi = v.contact_damping
        self.contact_step = min(exact, 2 / highest * (math.sqrt(1 + xi * xi) - xi))
        self._take_time_step(v)

    def _take_time_step(self, v):
        self.critical_step = min(self.bonded_step, self.contact_step)
        if v.time_step > 0:
            require(v.time_step <= self.critical_step, "time_step", v.time_step,
                    f"at most the stable step {self.critical_step:.3e} of this scene", "s")
            self.time_step = v.time_step
        else:
            self.time_step = v.time_step_fraction * self.critical_step

    # ---- YADE

    def build(self):
        """Fill YADE's scene: bodies, bonds, engines; the tool in front of the rock."""
        O.reset()
        v, rock = self.v, self.rock
        yade_scene.put_rock_materials(mu=v.mu, loose=self.loose_rock)
        yade_scene.put_tool_material(mu=v.tool_mu, contact_damping=v.contact_damping)
        yade_scene.put_rock(rock)
        self.put_loop(kn=v.kn, kt=v.kt, mu=v.mu, tool=(v.tool_kn, v.tool_kt, v.tool_mu),
                      ratcheting_free=self.ratcheting_free)
        self._make_engines()
        yade_scene.make_bonds(rock, self.bonds)
        self._put_tool()
        self._insert_engines()
        self.path_start = O.iter
        if self.heat:
            self.heat.begin()
            longest = MOST_HEAT_STEPS * self.heat.network.stable_step()
            require(v.heat_period <= longest, "heat_period", v.heat_period,
                    f"at most {MOST_HEAT_STEPS} stable heat steps, {longest:.3g} s with these conductivities and capacities", "s")
        self.base = self._stored_energy()
        self.canonical()

    def _make_engines(self):
        v, rock = self.v, self.rock
        self.bonds = Bonds(pairs=rock.pairs, law=self.law, strength_factor=rock.strength_factor, clock=lambda: self.time)
        motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed)
        self._make_tool_engines(motion)
        self.profile = self._profile()
        guide = PathFollower(bodies=self.bodies, clock=self._path_time, period=GUIDE_PERIOD) if self.motion.angular_velocity else None
        self.heat = self._heat() if v.heat else None
        self.expansion = self._expansion() if v.heat and v.rock_expansion else None
        self.damping = BackgroundDamping(rate=v.background_damping, bodies=range(rock.count)) if v.background_damping else None
        self.recorder = Recorder([self._log, self.wear.log, self.bonds.log] + ([self.heat.log] if self.heat else []))
        kick = 0.5 * float(rock.masses.max()) * float(np.sum(self.motion.velocity(0.0)**2))
        self.watch = EnergyGuard(work=lambda: self.contact.work_done, floor=50 * kick)
        self._register(self.bonds, self.contact, self.rock_friction, Separation(self.bonds), guide, self.wear,
                     self.profile, self.heat, self.expansion, self.damping, self.recorder, self.watch)

    def _make_tool_engines(self, motion):
        """Bodies and engines of the tool, and the friction of the rock, whose account may be one with the tool's."""
        v, tool = self.v, self.tool
        self.bodies = ToolBodies(tool, self.motion)
        self.rock_friction = RockFriction(bonds=self.bonds, motion=motion)
        self.contact = ToolContact(tool=self.bodies, motion=motion, needs=self.wear_law.needs,
                                   sampling_period=v.sampling_period)
        self.wear = Wear(contact=self.contact, erosion=tool.erosion, tool=self.bodies, law=self.wear_law,
                         hardness=self.hardness, temperature=self._tool_temperature, on_removal=self._on_removal)

    def _profile(self):
        """The engine that R's rules are judged by, None where nothing is to wear."""
        if not self.wear_law.wears:
            return None
        return WearProfile(wear=self.wear, place=places(self.outline, self.tool.positions[:, :2]))

    def _heat(self):
        v, rock, tool = self.v, self.rock, self.tool
        capacity = np.concatenate([self._capacity(rock, v.rock_specific_heat),
                                   self._capacity(tool, v.tool_specific_heat)])
        temperature = np.repeat([v.rock_temperature, v.tool_temperature], [rock.count, tool.count])
        network = HeatNetwork(capacity=capacity, temperature=temperature, edges=np.empty((0, 2), int), conductance=0.0)
        e_tool, e_rock = (effusivity(m.conductivity, m.density, m.specific_heat)
                          for m in (self.tool_material, self.rock_material))
        return Heat(network=network, bonds=self.bonds, rock_friction=self.rock_friction, tool_contact=self.contact,
                    rock=rock, body=ParticleBody(tool), heat_fraction=v.heat_fraction,
                    tool_share=effusivity_share(e_tool, e_rock) if v.heat_sharing == "effusivity" else 0.5,
                    contact_conductance=v.contact_conductance, convection=v.convection, ambient=v.ambient_temperature,
                    rock_paths=paths(v.bond_conductance, v.rock_conductivity, pairs=rock.pairs,
                                     cells=lambda: rock.cells, fitted=self._fitted_to_rock),
                    tool_paths=paths(v.bond_conductance, v.tool_conductivity, pairs=tool.pairs,
                                     cells=lambda: tool.cells, fitted=lambda: tool.conductance),
                    conduction=v.conduction, shank_temperature=v.shank_temperature if v.shank == "fixed" else None,
                    surface_period=v.surface_period, wear_acceleration=v.wear_acceleration, time_scale=lambda: self.time_scale)

    def _expansion(self):
        return Expansion(coefficient=self.v.rock_expansion, rock=self.rock, reference=self.v.rock_temperature,
                         temperature=lambda: self.heat.network.temperature[:self.rock.count], bonds=self.bonds,
                         loose=lambda: [*self.rock_friction.contacts, *(entry[0] for entry in self.contact.possible)])

    def _fitted_to_rock(self):
        return calibrated_conductance(positions=self.rock.positions, edges=self.rock.pairs, conductance=1.0,
                                      conductivity=self.v.rock_conductivity)[0]

    def _capacity(self, body, specific_heat):
        """(n,) J/K: of the cells where heat passes their faces, else of the particles' own masses as in the sources."""
        masses = body.density * body.cells.volumes if self.v.bond_conductance == "voronoi" else body.masses
        return masses * specific_heat

    def _periods(self):
        """{engine: steps between visits}."""
        v = self.v
        heat = max(1, self._steps(v.heat_period))
        return {"bonds": 1, "tool_contact": 1, "rock_friction": v.rock_sampling_period,
                "wear": v.wear_period, "wear_profile": PROFILE_PERIOD * v.wear_period, "heat": heat, "expansion": heat,
                "separation": 200, "path_follower": GUIDE_PERIOD, "background_damping": v.damping_period, "energy_guard": 200,
                "recorder": max(1, self._steps(v.record_period))}

    def _connect(self):
        super()._connect()
        self.bodies.connect()

    def _tool_temperature(self):
        return self.heat.temperature_of_pieces() if self.heat else np.full(self.tool.count, self.v.tool_temperature)

    def _on_removal(self, worn, loose):
        if self.heat:
            self.heat.remove(worn, loose)
        if not self.bodies.body_of:
            # A simulation that blows up may wear the tool away before its watch comes by.
            self.watch.act()
            raise RunEnded(f"the tool is worn away at t = {self.time:g} s", True)

    # ---- stages

    def canonical(self):
        super().canonical()
        self.contact.find_contacts()

    def end_stage(self, folder):
        """Close the stage's balances; before each further cycle put back the rock as the start-up left it."""
        for engine in (self.wear, self.profile, self.damping, self.heat):
            if engine:
                engine.act()
        stored = self._stored_energy()
        for name, value in stored.items():
            self.balance[name] += value - self.base[name]
        super().end_stage(folder)
        self._begin_stage(folder)
        self.base = self._stored_energy()
        if not self.finished and not math.isfinite(self._foremost()):
            raise RunEnded(f"nothing of the tool reaches the rock any more at t = {self.time:g} s", True)

    def _begin_stage(self, folder):
        if self.stage == 1:
            self.canonical()
            O.save(str(folder / "start_up.yade.gz"))
            self.start = {"bonds": self.bonds.state(), "bodies": self.bodies.state()}
            if self.heat:
                self.start["rock_temperature"] = self.heat.network.temperature[:self.rock.count].copy()
        elif not self.finished:
            self._put_back(folder)
        if not self.finished:
            self._add_approach()
            if self.profile:
                self.profile.begin_cycle(self._mark_of_shape())

    def _mark_of_shape(self):
        """A number that differs where the tool's shape does."""
        return float(np.count_nonzero(self.tool.erosion.alive))

    def _foremost(self):
        """x (m) in the tool's frame of the foremost of what is left of it below the rock's surface, -inf for nothing."""
        return self.tool.foremost(below=self.v.depth_of_cut)

    def _add_approach(self):
        """Lengthen the cycle by the way that a worn tool is behind a new one, so that each goes through the same rock."""
        behind = self.foremost_when_new - self._foremost()
        if 0.0 < behind < math.inf:
            name, steps = self.stages[self.stage]
            self.approach_steps[self.stage] = self._steps(behind / self.v.velocity)
            self.stages[self.stage] = name, steps + int(self.approach_steps[self.stage])

    @property
    def working_time(self):
        """Simulated seconds without those in which a worn tool came to where the new one stood."""
        prescribed = self.approach_steps[:self.stage].sum()
        if not self.finished:
            prescribed += min(self.step, self.approach_steps[self.stage])
        return self.time - float(prescribed) * self.time_step * self.time_scale

    def _put_back(self, folder):
        """The rock of the start-up's end, and in it the tool as it is worn now (M 9.1)."""
        released = self.bonds.energy_released
        self.cracks_of_past_cycles += self.bonds.cracks[len(self.start["bonds"]["cracks"]):]
        O.load(str(folder / "start_up.yade.gz"))
        self.bonds.restore(self.start["bonds"])
        self.bonds.energy_released = released
        self.bodies.restore(self.start["bodies"])
        self._connect()
        self.first_iteration = O.iter
        self._put_tool_back()
        if self.heat:
            self.heat.replace_rock(self.start["rock_temperature"])
            self.heat.find_surfaces()
        self.canonical()

    def _put_tool(self):
        self.bodies.add(sorted(self.tool.erosion.surface))

    def _put_tool_back(self):
        """Bring the tool of the start-up's end to its present shape."""
        erosion = self.tool.erosion
        self.bodies.erase([i for i in self.bodies.body_of if not erosion.alive[i]])
        self.bodies.add([i for i in sorted(erosion.surface) if i not in self.bodies.body_of])

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "balance": self.balance, "base": self.base, "bodies": self.bodies.state(),
                "path_start": self.path_start, "stage_steps": np.array([steps for _, steps in self.stages]), "approach_steps": self.approach_steps,
                "cracks": np.array(self.cracks_of_past_cycles, float).reshape(-1, len(Crack._fields)),
                "start": getattr(self, "start", {})}

    def save(self, directory, folder):
        super().save(directory, folder)
        if self.stage > 0:
            shutil.copy(folder / "start_up.yade.gz", directory)

    def restore(self, state, directory, folder):
        if (directory / "start_up.yade.gz").exists():
            shutil.copy(directory / "start_up.yade.gz", folder)
        super().restore(state, directory, folder)
        self.path_start = int(state["path_start"])
        self.stages = [(name, int(steps)) for (name, _), steps in zip(self.stages, state["stage_steps"])]
        self.approach_steps = state["approach_steps"].copy()
        self.balance = {name: float(value) for name, value in state["balance"].items()}
        self.base = {name: float(value) for name, value in state["base"].items()}
        self.start = state["start"] if "start" in state else {}
        self.cracks_of_past_cycles = [Crack(*row) for row in state["cracks"].tolist()]

    def _restore_engines(self, state):
        self.bodies.restore(state["bodies"])
        super()._restore_engines(state)

    # ---- balances

    def _stored_energy(self):
        stored = super()._stored_energy()
        stored["contact_elastic"] += self.contact.elastic_energy()
        return stored

    def energy_balance(self):
        """J per metre of thickness: the tool's work, where it went, and what the account misses."""
        now = self._stored_energy()
        balance = {"tool_work": self.contact.work_done}
        balance.update({name: self.balance[name] + now[name] - self.base[name] for name in now})
        balance["tool_friction"] = self.contact.friction
        balance["rock_friction"] = self.rock_friction.total
        balance["contact_dashpots"] = self.contact.dashpot_dissipated
        balance["bond_breaking"] = self.bonds.energy_released
        balance["background_damping"] = self.damping.dissipated if self.damping else 0.0
        balance["removed_contacts"] = self.wear.contact_energy_removed - self.contact.reshaping_energy
        if self.expansion:
            balance["thermal_expansion"] = -self.expansion.work
        balance["residual"] = balance["tool_work"] - math.fsum(list(balance.values())[1:])
        return balance

    def mass_balance(self):
        """kg per metre of thickness: the volume book of what is worn times the tool's density."""
        balance = self._volume_balance()
        return {"initial": self.tool.area * self.tool.density, **{k: v * self.tool.density for k, v in balance.items()}}

    def _volume_balance(self):
        return self.tool.erosion.volume_balance()

    def _log(self):
        elapsed = self.recorder.elapsed()
        # Along and across the direction in which the tool looks.
        self.bodies.connect()
        impulse = self.contact.take_impulse()[:2] @ self.bodies.pose.rotation
        force = impulse / elapsed if elapsed else impulse
        return {"time": (self.time, "s"), "stage": (self.stage, "-"), "working_time": (self.working_time, "s"),
                "cutting_force": (-force[0], "N/m"), "thrust_force": (force[1], "N/m"),
                "tool_work": (self.contact.work_done, "J/m"),
                "kinetic_energy": (utils.kineticEnergy(), "J/m"), "tool_friction": (self.contact.friction, "J/m"),
                "bond_breaking": (self.bonds.energy_released, "J/m")}

    # ---- what a run's folder shows

    def model(self):
        """Arrays that stay the same all through a run."""
        rock, tool = self.rock, self.tool
        return {"rock_radii": rock.radii, "rock_fixed": rock.fixed, "bonds": rock.pairs, "tool_radii": tool.radii,
                "tool_positions": tool.positions, "tool_volumes": tool.volumes, "outline": self.outline,
                "box": np.array([rock.width, rock.height])}

    def snapshot(self):
        """Arrays that show the scene now."""
        erosion = self.tool.erosion
        temperature = self.heat.network.temperature if self.heat else np.empty(0)
        return {**self._rock_and_pose(), "temperature": temperature, "alive": erosion.alive,
                "worn_depth": erosion.stored / (2 * self.tool.radii), "surface": np.array(sorted(erosion.surface), int)}

    def _rock_and_pose(self):
        """What a snapshot shows whatever the tool is made of."""
        rock = self.rock
        self.bodies.connect()
        return {"time": self.time, "stage": self.stage, "rock_positions": rock.current_positions(),
                "broken_bonds": np.bincount(rock.pairs[self.bonds.status != 0].ravel(), minlength=rock.count),
                "status": self.bonds.status, "tool_offset": self.bodies.pose.offset, "tool_turn": self.bodies.pose.turn}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtk and tool.NNNN.vtk: diameter, broken bonds, temperature, worn depth."""
        shot, rock, tool = self.snapshot(), self.rock, self.tool
        alive = shot["alive"]
        fields = {"diameter": 2 * rock.radii, "broken_bonds": shot["broken_bonds"]}
        worn = {"diameter": 2 * tool.radii[alive], "worn_depth": shot["worn_depth"][alive]}
        if self.heat:
            fields["temperature"] = shot["temperature"][:rock.count]
            worn["temperature"] = shot["temperature"][rock.count:][alive]
        vtk.write(folder / f"rock.{number:04d}.vtk", shot["rock_positions"], fields)
        vtk.write(folder / f"tool.{number:04d}.vtk", self.bodies.pose.of(tool.positions[alive]), worn)

    def cracks(self):
        return self.cracks_of_past_cycles + self.bonds.cracks

    def progress(self):
        """A few words on how it stands."""
        words = [f"{self.bonds.log()['tensile_cracks'][0] + self.bonds.log()['shear_cracks'][0]} cracks",
                 self._worn_words()]
        if self.heat:
            words.append(f"hottest {self.heat.log()['tool_temperature_max'][0] - KELVIN:.0f} C")
        return ", ".join(words)

    def _cut_area(self):
        """Area (m2) of the rock that the tool has gone through."""
        return self.v.depth_of_cut * self.v.velocity * self.working_time

    def _worn_words(self):
        return f"{100 * self.tool.erosion.mass_fraction_lost:.2f} % of the tool worn"

    def _worn_results(self):
        erosion = self.tool.erosion
        return {"mass_lost": (erosion.mass_fraction_lost, "-"), "worn_volume": (erosion.archard_volume, self.volume_unit),
                "particles_removed": (int(np.sum(~erosion.alive)), "-"),
                "dropped_volume": (erosion.lost_with_pieces, self.volume_unit), "tool_particles": (self.tool.count, "-")}

    def results(self):
        """{name: (value, unit)} of the run."""
        columns = self.recorder.columns()
        cutting, thrust = (columns.get(f"{name}_force", np.zeros(1)) for name in ("cutting", "thrust"))
        area, working_time = self._cut_area(), self.working_time
        # On its way to the rock a worn tool meets no force, and that way is no cut.
        at_work = self.time / working_time if working_time else 1.0
        found = {"simulated_time": (self.time, "s"), "working_time": (working_time, "s"), "time_step": (self.time_step, "s"),
                 "critical_time_step": (self.critical_step, "s"), "bonded_critical_time_step": (self.bonded_step, "s"),
                 "mean_cutting_force": (at_work * float(cutting.mean()), "N/m"), "peak_cutting_force": (float(cutting.max()), "N/m"),
                 "mean_thrust_force": (at_work * float(thrust.mean()), "N/m"),
                 "specific_energy": (self.contact.work_done / area if area else 0.0, "J/m3"),
                 **self._worn_results(),
                 **self.bonds.log(), **{f"rock_{k}": value for k, value in self.rock.report().items()}}
        if self.profile:
            found.update(self._trust())
        if self.heat:
            for name in ("tool_temperature_max", "rock_temperature_max"):
                found[name] = (float(np.nanmax(columns[name])) if name in columns else math.nan, "K")
        return found

    def _trust(self):
        """R's two rules for accelerated wear, judged from this run's own record."""
        v, wear = self.v, self.wear
        error = distribution_error(self.profile.increments)
        events = events_per_particle(events=wear.events, worn=wear.worn, limit=wear.limit)
        trusted = trusted_wear_acceleration(wear_acceleration=v.wear_acceleration, error=error, events=events, tolerance=v.wear_tolerance)
        return {"wear_distribution_error": (error, "-"), "contact_events_per_particle": (events, "-"),
                "trusted_wear_acceleration": (trusted, "-")}

    def warnings(self):
        return [*self._missed_energy(), *(self._worn_warnings() if self.profile else [])]

    def _missed_energy(self):
        balance = self.energy_balance()
        part = balance["residual"] / max(abs(value) for value in balance.values()) if balance["residual"] else 0.0
        return [] if abs(part) <= ENERGY_MISSED else [
            f"the energy book misses {100 * part:.2g} % of its largest entry: forces and wear are no better known than that; "
            "a smaller sampling_period or time_step_fraction may tell why"]

    def _worn_warnings(self):
        short = [] if math.isfinite(self._foremost()) else [
            f"nothing of the tool is left below the rock's surface, of its lowest {self.v.depth_of_cut:g} m: it cuts no more"]
        return [*short, *self.wear.warnings(), *self._lost_wear(), *self._distrust()]

    def _lost_wear(self):
        balance = self._volume_balance()
        lost = -balance["unexplained"] / balance["archard"] if balance["archard"] > 0 else 0.0
        return [] if lost <= LOST else [
            f"removal = {self.v.removal} has lost {100 * lost:.2g} % of Archard's volume: removal = volume conserves it, and less "
            "is lost at a lower wear_acceleration or a shorter wear_period"]

    def _distrust(self):
        v, found = self.v, {name: value for name, (value, _) in self._trust().items()}
        error, events, trusted = (found[name] for name in ("wear_distribution_error", "contact_events_per_particle",
                                                           "trusted_wear_acceleration"))
        if math.isnan(events) or (math.isfinite(error) and trusted >= v.wear_acceleration):
            return []
        known = f"is known to {100 * error:.2g} % only" if math.isfinite(error) else "cannot be told from a run as short as this"
        advice = "run longer" if trusted >= v.wear_acceleration else (
            f"accelerate it at most {trusted:.2g} times instead of {v.wear_acceleration:g}, and run that much longer")
        return [f"where the tool wears {known}, and {self.piece} goes in {events:.2g} contact events: to trust the distribution "
                f"of wear to {100 * v.wear_tolerance:g} %, {advice}"]

    def tables(self):
        if not self.profile:
            return super().tables()
        header = [f"place_{n} [{self.volume_unit}]" for n in range(self.profile.places)]
        return {**super().tables(), "wear_profile.csv": (header, self.profile.increments)}

    def friction_balance(self):
        """J per metre of thickness: friction at the tool, what of it has worn it, and friction between rock particles."""
        return {"tool": self.contact.friction, "worn_by": self.wear.work_used + float(self.contact.wearing_work.sum()),
                "rock": self.rock_friction.total}

    def balances(self):
        """Energy, friction, mass and heat balances."""
        balances = {"energy": (self.energy_balance(), "J/m"), "friction": (self.friction_balance(), "J/m"),
                 "mass": (self.mass_balance(), "kg/m")}
        if self.heat:
            balances["heat"] = (self.heat.balance(), "J/m")
        return balances


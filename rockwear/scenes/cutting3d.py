"""The cut in space (M 13): a tooth lowered into loose or bonded spheres, then drawn through them."""
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from scipy.spatial import ConvexHull
from yade import NewtonIntegrator, Vector3

from rockwear.engines import access
from rockwear.scenes.scene import Scene
from rockwear.scenes.tool_bodies import SphereBodies
from rockwear.run import vtk
from rockwear.scenes import cutting
from rockwear.scenes.cutting import Cutting
from rockwear.engines.bonds import Bonds
from rockwear.engines.separation import Separation
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.rock_friction import YadeFriction
from rockwear.engines.damping import BackgroundDamping
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.recorder import Recorder
from rockwear.engines.shear_rotation import ShearRotation
from rockwear.engines.tool_contact import ToolContact
from rockwear.engines.wear import Wear
from rockwear.scenes.facet_cutting import FacetCutting, check_sampling
from rockwear.model.facet_tool import MOST_FACETS, FacetTool, check_size, read_stl, write_stl
from rockwear.kernels.archard import KELVIN, Hardness
from rockwear.kernels.bond_laws import linear_law
from rockwear.kernels.boundary import area_vectors, prism, refine
from rockwear.kernels.checks import require
from rockwear.kernels.polygon import area, perimeter, tip
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.stability import critical_time_step
from rockwear.kernels.wear_laws import wear_law
from rockwear.kernels.parameter import Parameter, above_zero, file, flag, number
from rockwear.model.rock import Block
from rockwear.model.particle_tool import LayeredTool

GRAVITY = 9.81
"""m/s2"""
CLOSE = 0.05
"""Particles whose gap is below this part of a radius count as touching in the time step."""
TOUCHING = 4
"""Tool particles that are taken to press one rock particle at once, in the time step."""

SHARED = """porosity seed kn kt Rn Rt bond_law H mu tool_kn tool_kt tool_mu contact_damping tool_density outline rake clearance
    tip_radius tooth_height tooth_width velocity depth_of_cut approach background_damping wear_coefficient
    wear_law wear_exponent wear_modes wear_acceleration removal time_step_fraction time_step sampling_period rock_sampling_period
    wear_period wear_tolerance damping_period record_period rock_density width height""".split()
"""Parameters that are those of the cut in the plane."""

OURS = dict(
    width=0.62, height=0.22, porosity=0.36, kn=1e6, kt=1e6, Rn=500.0, Rt=5000.0, mu=0.5, tool_kn=1e6, tool_kt=1e6,
    tool_mu=0.1, contact_damping=0.0, tooth_height=0.14, tooth_width=0.0758, rake=30.0, clearance=20.0, tip_radius=4e-3,
    velocity=0.04, depth_of_cut=0.03, approach=2e-3, background_damping=20.0, wear_coefficient=0.0,
    wear_acceleration=1.0, removal="none", damping_period=100, rock_sampling_period=8, wear_period=10, record_period=2e-3)
"""Their defaults in space: numbers of M 13.2, and sizes of ours where M shows them in a figure."""

PARAMETERS = [p for p in cutting.parameters(**OURS) if p.name in SHARED] + [
    Parameter("depth", 0.41, "m", above_zero, "depth of the specimen, across the cut", "ours"),
    Parameter("radius", 9e-3, "m", above_zero, "radius of all rock spheres, before scale_factor", "M 13.1"),
    Parameter("bonding_gap", 1e-4, "m", number(0), "largest gap that is bonded", "ours"),
    Parameter("breadth", 0.057, "m", above_zero, "breadth of the tooth, across the cut", "ours"),
    Parameter("gravity", GRAVITY, "m/s2", number(0), "downwards", "M 13.1"),
    Parameter("start", 0.0, "m", number(0), "place of the tip when it is lowered, from the left end", "ours"),
    Parameter("lowering_velocity", 0.08, "m/s", above_zero, "of the tooth on its way down", "ours: M gives none"),
    Parameter("hardness", 1.0, "Pa", above_zero, "of the tool, constant; 1: wear_coefficient is k / H", "M 8 took 1; steel has 5e9"),
    Parameter("cut_time", 1.0, "s", above_zero, "time of the horizontal cut", "M 13.3"),
    Parameter("scale_factor", 1.5, "", number(1, 8), "factor on the radii of rock and tool; stiffnesses grow with it and "
              "strengths with its square, so that the rock keeps modulus and strength"),
    Parameter("full", False, "", flag, "the source's sizes: scale_factor counts as 1"),
    Parameter("snapshot_period", 0.05, "s", above_zero, "simulated time between the pictures of the report"),
]
OF_PARTICLES = [Parameter("tool_radius", 1.5e-3, "m", above_zero, "radius of the tool's spheres, before scale_factor",
                          "M 13.3")]
OF_TRIANGLES = [Parameter("stl", "", "", file, "STL file in m: a tool of your own in place of outline, breadth and tooth_*. It "
                          "moves in +x, y is up, z across, the lowest point is the tip; top and back are held"),
                Parameter("facet", 0.02, "m", above_zero, "size of the tool's triangles, halves of such squares; edges "
                          "of an STL file longer than 1.5 times that are cut in halves", "ours"),
                Parameter("work_fraction", 1.0, "", number(0, 1), "part of the friction work that wears the tool",
                          "M 6.9"),
                Parameter("reshape", False, "", flag, "move the vertices with the wear")]
LOOSE = [Parameter("settling", 0.4, "s", above_zero, "time for the fill to settle under gravity", "ours"),
         Parameter("settling_damping", 50.0, "1/s", number(0), "background damping while it settles", "ours"),
         Parameter("freeboard", 0.06, "m", number(0), "how far the box's sides stand above the fill", "ours")]


OF_BONDS = {"bond_law", "H", "Rn", "Rt", "bonding_gap"}


def parameters(*further, without=(), **defaults):
    """PARAMETERS and further ones, with other defaults, and without some."""
    found = [p for p in (*PARAMETERS, *further) if p.name not in without]
    unknown = set(defaults) - {p.name for p in found}
    if unknown:
        raise KeyError(f"no such parameter: {', '.join(sorted(unknown))}")
    return [replace(p, default=defaults.get(p.name, p.default)) for p in found]


class Cutting3D(Cutting):
    """A tooth lowered into a block of spheres and drawn through it, in space and without heat.

    x is along the cut, y up, z across. The block stands for a part of a rock mass at whose edge the cut begins: its
    faces are held but for the top, and the upper part of the left one.
    What the tooth is made of is left to others.
    """

    volume_unit = "m3"
    ratcheting_free = False
    """M's bonds are so soft that spheres overlap by a tenth of their size: springs sheared by full radii would then gain
    energy, whatever the step (tests/scenes/test_hard_cases.py)."""

    def __init__(self, values):
        self.values = values
        v = self.v = self._scaled(values)
        require(v.velocity * v.cut_time < v.width - v.start, "cut_time", v.cut_time,
                f"so short that the tool's way, {v.velocity * v.cut_time:g} m, stays within the block: it starts at "
                f"{v.start:g} of {v.width:g} m", "s")
        require(2 * v.radius < v.depth_of_cut < v.height, "depth_of_cut", v.depth_of_cut,
                f"more than a rock particle, {2 * v.radius:g}, and less than the block's height {v.height:g}", "m")
        self.law = self._law(v)
        self.hardness = Hardness.constant(v.hardness)
        self.wear_law = wear_law(v.wear_law, k=v.wear_coefficient, mu=v.tool_mu, exponent=v.wear_exponent,
                                 modes=v.wear_modes).scaled(v.wear_acceleration)
        self.gravity = Vector3(0, -v.gravity, 0) if v.gravity else None
        self.outline, self.tool = self._shape()
        self._check_start(v)
        self.rock = self._make_rock()
        self.ways = self._ways()
        start = v.start + v.tip_radius, v.height + v.approach
        self.motion = Straight(start=start, velocity=self.ways[0][2])
        self._choose_time_step(v)
        self._plan({name: seconds for name, seconds, _ in self.ways})
        self.balance = {"kinetic": 0.0, "elastic": 0.0, "contact_elastic": 0.0, "potential": 0.0}
        self.cracks_of_past_cycles = []
        self.heat = self.expansion = None

    def _scaled(self, values):
        """The parameters with scale_factor applied."""
        v = SimpleNamespace(**values)
        c = v.scale_factor = 1.0 if v.full else v.scale_factor
        powers = {**dict.fromkeys(("radius", "tool_radius", "bonding_gap", "kn", "kt", "tool_kn", "tool_kt", "H"), 1),
                  "Rn": 2, "Rt": 2}
        for name, power in powers.items():
            if name in values:
                setattr(v, name, c**power * values[name])
        v.tool_temperature = KELVIN + 20  # for a hardness that is constant
        return v

    def _make_rock(self):
        v = self.v
        rock = Block(width=v.width, height=v.height, depth=v.depth, radius=v.radius, porosity=v.porosity, seed=v.seed,
                     bonding_gap=v.bonding_gap, density=v.rock_density)
        # The tooth is lowered at the left end, where the block is free so that a chip can break out.
        rock.fix("bottom", "right", "front", "back")
        rock.fix("left", below=v.height - 2 * v.depth_of_cut)
        return rock

    def _shape(self):
        """(outline (k, 2) m from the side, the tool)."""
        v = self.v
        require(v.breadth < v.depth, "breadth", v.breadth, f"less than the block's depth {v.depth:g}", "m")
        outline = self._outline(v)
        height = float(np.ptp(outline[:, 1]))
        require(height > v.depth_of_cut, "tooth_height", height, f"more than depth_of_cut = {v.depth_of_cut:g}", "m")
        return outline, self._make_tool(outline)

    def _check_start(self, v):
        """The tooth may be lowered beside the block: nothing to check."""

    def _ways(self):
        """[(stage, s, velocity (2,) m/s of the tool)]."""
        v = self.v
        return [("lowering", (v.approach + v.depth_of_cut) / v.lowering_velocity, (0.0, -v.lowering_velocity)),
                ("cutting", v.cut_time, (v.velocity, 0.0))]

    def _choose_time_step(self, v):
        rock = self.rock
        free = np.flatnonzero(~rock.fixed)
        common = dict(positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                      bonds=rock.near(CLOSE * v.radius), kn=v.kn, kt=v.kt, fixed=np.flatnonzero(rock.fixed),
                      ratcheting_free=self.ratcheting_free)
        self.bonded_step = critical_time_step(**common)
        # Any free sphere may be the one that the tool presses.
        dashpots = 2 * TOUCHING * v.contact_damping * np.sqrt(v.tool_kn * rock.masses[free])
        self.contact_step = min(
            critical_time_step(**common, ground=(free, np.tile(side, (len(free), 1)), TOUCHING * v.tool_kn,
                                                 TOUCHING * v.tool_kt, dashpots)) for side in np.eye(3)[:2])
        self._take_time_step(v)

    # ---- YADE

    def build(self):
        super().build()
        if self.gravity:
            access.yade_engine(NewtonIntegrator).gravity = self.gravity

    def _make_engines(self):
        v, rock = self.v, self.rock
        self.bonds = Bonds(pairs=rock.pairs, law=self.law, strength_factor=rock.strength_factor, clock=lambda: self.time)
        motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed,
                           gravity=self.gravity)
        self._make_tool_engines(motion)
        self.profile = self._profile()
        self.damping = BackgroundDamping(rate=self._damping_rate(), bodies=range(rock.count))
        self.recorder = Recorder([self._log, self.wear.log, self.bonds.log])
        pull = float(rock.masses.sum()) * v.gravity * v.radius
        self.watch = EnergyGuard(work=lambda: self.contact.work_done,
                           floor=25 * float(rock.masses.max()) * max(v.velocity, v.lowering_velocity)**2 + pull)
        turning = ShearRotation(bonds=self.bonds, radii=rock.radii) if len(rock.pairs) else None
        self._register(turning, self.bonds, self.contact, self.rock_friction, Separation(self.bonds), self.wear, self.profile, self.damping,
                     self.recorder, self.watch)

    def _damping_rate(self):
        return self.v.background_damping

    def _periods(self):
        v = self.v
        return {"shear_rotation": 1, "bonds": 1, "tool_contact": 1, "rock_friction": v.rock_sampling_period,
                "wear": v.wear_period, "wear_profile": cutting.PROFILE_PERIOD * v.wear_period, "separation": 200,
                "background_damping": v.damping_period, "energy_guard": 200, "recorder": max(1, self._steps(v.record_period))}

    # ---- stages

    def _begin_stage(self, folder):
        self.damping.rate = self._damping_rate()
        if not self.finished:
            self.bodies.go_on(self.ways[self.stage][2])

    def _restore_engines(self, state):
        super()._restore_engines(state)
        self.damping.rate = self._damping_rate()

    def save(self, directory, folder):
        Scene.save(self, directory, folder)

    # ---- balances

    def _stored_energy(self):
        height = self.rock.current_positions()[:, 1]
        return {**super()._stored_energy(), "potential": float(self.rock.masses @ height) * self.v.gravity}

    def _log(self):
        elapsed = self.recorder.elapsed()
        force = self.contact.take_impulse() / elapsed if elapsed else np.zeros(3)
        return {"time": (self.time, "s"), "stage": (self.stage, "-"), "cutting_force": (-force[0], "N"),
                "thrust_force": (force[1], "N"), "side_force": (force[2], "N"), "tool_work": (self.contact.work_done, "J"),
                "tool_friction": (self.contact.friction, "J"), "bond_breaking": (self.bonds.energy_released, "J")}

    def balances(self):
        return {"energy": (self.energy_balance(), "J"), "friction": (self.friction_balance(), "J"),
                "mass": (self.mass_balance(), "kg")}

    # ---- what a run's folder shows

    def model(self):
        rock = self.rock
        return {"rock_radii": rock.radii, "rock_fixed": rock.fixed, "bonds": rock.pairs,
                "block": np.array([rock.width, rock.height, rock.depth]), "outline": self.outline,
                "stage_names": np.array([name for name, _ in self.stages]), **self._tool_model()}

    def snapshot(self):
        self.bodies.connect()
        return {"time": self.time, "stage": self.stage, "rock_positions": self.rock.current_positions(),
                "status": self.bonds.status, "tool_offset": self.bodies.pose.offset, **self._tool_snapshot()}

    def results(self):
        columns = self.recorder.columns()
        cut = columns["stage"] == len(self.ways) - 1 if columns else np.zeros(0, bool)
        found = {"simulated_time": (self.time, "s"), "time_step": (self.time_step, "s"),
                 "critical_time_step": (self.critical_step, "s"), "scale_factor": (self.v.scale_factor, "-"),
                 **self._worn_results(), **self.bonds.log(),
                 **{f"rock_{k}": value for k, value in self.rock.report().items()}}
        if cut.any():
            for name in ("cutting_force", "thrust_force"):
                found[f"mean_{name}"] = float(columns[name][cut].mean()), "N"
            found["peak_cutting_force"] = float(columns["cutting_force"][cut].max()), "N"
        if self.profile:
            found.update(self._trust())
        return found

    def write_vtk(self, folder, number):
        """rock.NNNN.vtk: diameter, broken bonds; tool.NNNN.vtk: what it is made of, worn depth."""
        rock, shot = self.rock, self.snapshot()
        broken = np.bincount(rock.pairs[shot["status"] != 0].ravel(), minlength=rock.count)
        vtk.write(folder / f"rock.{number:04d}.vtk", shot["rock_positions"],
                  {"diameter": 2 * rock.radii, "broken_bonds": broken})
        places, fields = self._tool_points(shot)
        vtk.write(folder / f"tool.{number:04d}.vtk", places + (*shot["tool_offset"], 0.0), fields)


class ParticleCutting3D(Cutting3D):
    """A tooth of spheres in bonded rock (M 13.3-13.4).

    Of M's tool, part triangles and part particles, all is particles here: only the surface takes part in contact, and what
    lies under it costs nothing.
    """

    def _make_tool(self, vertices):
        v = self.v
        require(v.tool_radius < v.radius, "tool_radius", v.tool_radius, f"less than that of the rock, {v.radius:g}", "m")
        return LayeredTool(vertices=vertices, radius=v.tool_radius, breadth=v.breadth, seed=v.seed, removal=v.removal,
                           density=v.tool_density)

    def _make_tool_engines(self, motion):
        self.bodies = SphereBodies(self.tool, self.motion)
        self.rock_friction = RockFriction(bonds=self.bonds, motion=motion)
        self.contact = ToolContact(tool=self.bodies, motion=motion, needs=self.wear_law.needs,
                                   sampling_period=self.v.sampling_period)
        self.wear = Wear(contact=self.contact, erosion=self.tool.erosion, tool=self.bodies, law=self.wear_law,
                         hardness=self.hardness, temperature=self._tool_temperature, on_removal=self._on_removal,
                         volume_unit=self.volume_unit)

    def _tool_model(self):
        tool = self.tool
        return {"tool_positions": tool.positions, "tool_radii": tool.radii, "tool_fixed": tool.fixed}

    def _tool_snapshot(self):
        erosion = self.tool.erosion
        return {"alive": erosion.alive, "worn_depth": erosion.stored / erosion.areas,
                "surface": np.array(sorted(erosion.surface), int)}

    def _tool_points(self, shot):
        alive = shot["alive"]
        return self.tool.positions[alive], {"diameter": 2 * self.tool.radii[alive], "worn_depth": shot["worn_depth"][alive]}

    def _worn_results(self):
        erosion = self.tool.erosion
        return {**super()._worn_results(), "maximum_wear_depth": (float((erosion.worn / erosion.areas).max()), "m")}


class TriangleCutting3D(Cutting3D, FacetCutting):
    """A tooth of triangles in bonded rock (M 13.2). It wears only where a wear coefficient is given."""

    def __init__(self, values):
        check_sampling(values)
        super().__init__(values)

    def _shape(self):
        v = self.v
        if not v.stl:
            return super()._shape()
        require(not v.outline, "stl", v.stl, f"without outline = {v.outline}: a tool has one shape")
        vertices, facets = read_stl(v.stl)
        size = np.ptp(vertices, axis=0)
        require(size[0] < v.width and size[2] < v.depth, "stl", f"{v.stl}, {size[0]:g} x {size[1]:g} x {size[2]:g}",
                f"shorter and narrower than the block, {v.width:g} x {v.height:g} x {v.depth:g}", "m")
        require(size[1] > v.depth_of_cut, "stl", f"{v.stl} of a height of {size[1]:g}",
                f"higher than depth_of_cut = {v.depth_of_cut:g}", "m")
        # Its tip goes where the tooth of the parameters has its own, wherever the file has its origin.
        self._check_facet(float(np.linalg.norm(area_vectors(vertices, facets), axis=1).sum()))
        (x, y), z = tip(vertices), vertices[:, 2]
        vertices, facets = refine(vertices - [x + v.tip_radius, y, 0.5 * (z.min() + z.max())], facets, 1.5 * v.facet)
        seen = vertices[:, :2]
        return seen[ConvexHull(seen).vertices], FacetTool(vertices=vertices, facets=facets, density=v.tool_density)

    def _make_tool(self, vertices):
        v = self.v
        self._check_facet(2 * area(vertices) + perimeter(vertices) * v.breadth)
        corners, facets = prism(vertices, v.breadth, v.facet)
        return FacetTool(vertices=corners, facets=facets, density=v.tool_density)

    def _check_facet(self, surface):
        """Of triangles that are halves of squares; surface: m2."""
        check_size("facet", self.v.facet, math.sqrt(2 * surface / MOST_FACETS))

    def write_shape(self, folder):
        if self.wear_law.wears and self.v.reshape:
            write_stl(folder / "tool.stl", self.tool.boundary.vertices, self.tool.boundary.facets)

    def _tool_model(self):
        return {"tool_vertices": self.tool.first, "tool_facets": self.tool.first_facets}

    def _tool_snapshot(self):
        return {"tool_vertices": self.tool.boundary.vertices, "tool_facets": self.tool.boundary.facets,
                "worn_volume": self.wear.worn}

    def _tool_points(self, shot):
        return shot["tool_vertices"], {"worn_depth": self.tool.depth_below}


class LooseCutting3D(TriangleCutting3D):
    """A tooth of triangles in loose spheres (M 13.1), which settle under gravity first, in a box of held ones."""

    def _make_rock(self):
        v = self.v
        rock = Block(width=v.width, height=v.height + v.freeboard, depth=v.depth, radius=v.radius, porosity=v.porosity,
                     seed=v.seed, bonding_gap=0.0, density=v.rock_density, bonded=False)
        # So many are held that none of the others can slip through.
        rock.fix("bottom", "left", "right", "front", "back", within=2)
        rock.leave_out((rock.positions[:, 1] > v.height - v.radius) & ~rock.fixed)
        return rock

    def _check_start(self, v):
        behind = -float(self.tool.first[:, 0].min()) - v.tip_radius
        room = behind + 3 * v.radius
        require(v.start > room, "start", v.start, f"more than {room:g}, for the tooth to clear the box behind it", "m")

    def _law(self, v):
        # For the friction alone: there are no bonds.
        return linear_law("brittle", kn=v.kn, kt=v.kt, Rn=v.kn, Rt=v.kt, H=v.kn, mu=v.mu)

    def _ways(self):
        return [("settling", self.v.settling, (0.0, 0.0)), *super()._ways()]

    def _make_tool_engines(self, motion):
        super()._make_tool_engines(motion)
        self.rock_friction = YadeFriction(contact=self.contact, bonds=self.bonds, motion=motion)

    def _damping_rate(self):
        return self.v.background_damping if self.stage else self.v.settling_damping

    def _periods(self):
        return {**super()._periods(), "rock_friction": None}

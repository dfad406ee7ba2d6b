"""The laboratory wear test (M 6.6, fig. 6.3): a block of tool steel under a known load slides on flat rock."""
import math
from types import SimpleNamespace

import numpy as np
from scipy.integrate import quad
from yade import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider,
                  InteractionLoop, Ip2_FrictMat_FrictViscoMat_FrictViscoPhys,
                  Law2_ScGeom_FrictViscoPhys_CundallStrackVisco, NewtonIntegrator, O, utils)

from rockwear.scenes import yade_scene
from rockwear.scenes.scene import Scene
from rockwear.scenes.tool_bodies import ToolBodies
from rockwear.run import vtk
from rockwear.scenes import cutting
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.dead_load import DeadLoad
from rockwear.engines.base import RunEnded
from rockwear.engines.recorder import Recorder
from rockwear.engines.tool_contact import ToolContact
from rockwear.engines.wear import Wear
from rockwear.kernels.archard import BRINELL, KELVIN, Hardness
from rockwear.kernels.checks import require
from rockwear.kernels.erosion import Erosion
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.wear_laws import wear_law
from rockwear.model.materials import STEEL
from rockwear.kernels.parameter import Parameter, above_zero, choice, integer, number
from rockwear.model.particle_tool import Tool

SHARED = ("seed tool_radius_min tool_radius_max tool_kn tool_kt tool_mu hardness_table wear_coefficient wear_law wear_exponent "
          "wear_modes wear_acceleration removal").split()
"""Parameters that are those of the cut."""

PARAMETERS = [p for p in cutting.parameters(hardness_table="MET71", wear_coefficient=0.0023, tool_radius_min=0.2e-3,
                                            tool_radius_max=0.26e-3, wear_acceleration=1000.0) if p.name in SHARED] + [
    Parameter("force", 885.0, "N", above_zero, "normal force on the block", "M table 6.2"),
    Parameter("area", 26e-6, "m2", above_zero, "contact surface of the block", "M table 6.2"),
    Parameter("distance", 100.0, "m", above_zero, "sliding distance in the laboratory", "M table 6.2"),
    Parameter("velocity", 0.117, "m/s", above_zero, "sliding velocity", "M table 6.2"),
    Parameter("temperature", 429.15, "K", number(0), "of the block at first", "M table 6.2: 156 deg C"),
    Parameter("temperature_rise", 0.0, "K", number(0), "of the block over the whole distance, linear in it"),
    Parameter("block_width", 0.0, "m", number(0), "of the block along the sliding; 0: side of a square of `area`"),
    Parameter("block_height", 6e-3, "m", above_zero, "of the block"),
    Parameter("packing", "random", "", choice("random", "lattice"), "of the block's particles"),
    Parameter("slip_step", 2e-6, "m", above_zero, "sliding in a time step", "ours, see SlidingWear"),
    Parameter("wear_period", 10, "steps", integer(1), "between updates of wear and removal"),
    Parameter("record_distance", 0.5, "m", above_zero, "laboratory distance between rows of history.csv"),
]


class Block(Tool):
    """A rectangle of tool particles, held along its top."""

    def _fixed(self):
        return self.positions[:, 1] > self.vertices[:, 1].max() - 1.5 * self.radii


class Lattice(Block):
    """A rectangle of equal discs in a square lattice: every disc of a row carries the same load."""

    def __init__(self, *, vertices, radius, removal, material):
        width, height = np.ptp(vertices, axis=0)
        columns = max(2, round(width / (2 * radius)))
        radius = width / (2 * columns)
        rows = max(2, round(height / (2 * radius)))
        index = np.arange(rows * columns).reshape(rows, columns)
        y, x = (radius * (2 * place.ravel() + 1) for place in np.indices(index.shape))
        self.vertices = np.array([(0, 0), (width, 0), (width, 2 * radius * rows), (0, 2 * radius * rows)])
        self.positions, self.radii, self.count = np.column_stack([x, y]), np.full(len(x), radius), len(x)
        self.area, self.material = 4 * radius**2 * len(x), material
        self.volumes = 4 * self.radii**2
        self.fixed = self._fixed()
        pairs = np.concatenate([np.column_stack([index[:-1].ravel(), index[1:].ravel()]),
                                np.column_stack([index[:, :-1].ravel(), index[:, 1:].ravel()])])
        self.erosion = Erosion(radii=self.radii, volumes=self.volumes, pairs=pairs, surface=index[0],
                               fixed=np.flatnonzero(self.fixed), rule=removal)


class SlidingWear(Scene):
    """A block of particles led over flat rock under a known load. values: {name: value} of all PARAMETERS.

    The plane of the simulation is a slice through the block: all forces and volumes count per metre of thickness,
    pressure and depth are those of the laboratory. The 100 m of M take 855 s; here the wear coefficient is scaled up by
    `acceleration` and the distance down by the same factor (R's first rule).

    The block carries the load exactly, see engines.press. What its k is off by is what the contacts dissipate less than
    mu F s: each that has just closed slips elastically by mu F / kt before it is at Coulomb's limit, and the more
    wear comes on a metre, the more contacts do (R's second rule). M's first test, 42 particles removed:

        acceleration          500     1000     2000     7000    50000
        k returned, off by  -0.027   -0.055   -0.11     -0.38     -2.5  %

    at the default slip_step, of which half a step is lost with each such contact, too. With a power of the pressure or
    modes, the k returned is that of the block as it is: in a random packing a few particles carry all the load, and only
    a lattice has the nominal pressure.
    """

    looking = {"tool_contact"}

    def __init__(self, values):
        self.values = values
        v = self.v = SimpleNamespace(**values)
        require(v.tool_radius_max >= v.tool_radius_min, "tool_radius_max", v.tool_radius_max,
                f"at least tool_radius_min = {v.tool_radius_min:g}", "m")
        table = cutting.HARDNESS[v.hardness_table]
        low, high = table.limits
        require(low <= v.temperature <= high, "temperature", v.temperature,
                f"inside the hardness table of {v.hardness_table}, {low:g} to {high:g}", "K")
        self.hardness = Hardness(table.kelvin - KELVIN, table.pascal / BRINELL)
        self.law = wear_law(v.wear_law, k=v.wear_coefficient, mu=v.tool_mu, exponent=v.wear_exponent,
                            modes=v.wear_modes)
        require(v.wear_acceleration > 0, "wear_acceleration", v.wear_acceleration, "greater than 0 for a block that is to wear")
        width = v.block_width or math.sqrt(v.area)
        self.pressure, self.load = v.force / v.area, v.force / v.area * width
        hardest = float(self.hardness(v.temperature))
        require(self.pressure < hardest, "force", v.force, f"less than hardness times area, {hardest * v.area:.4g}, where steel "
                "would flow", "N")
        outline = np.array([(0, 0), (width, 0), (width, v.block_height), (0, v.block_height)])
        if v.packing == "lattice":
            self.tool = Lattice(vertices=outline, radius=v.tool_radius_max, removal=v.removal, material=STEEL)
        else:
            self.tool = Block(vertices=outline, radius_min=v.tool_radius_min, radius_max=v.tool_radius_max, seed=v.seed,
                              removal=v.removal, material=STEEL)
        self.width = width
        require(v.slip_step < 0.01 * v.distance / v.wear_acceleration, "slip_step", v.slip_step,
                f"below a hundredth of the simulated distance, {v.distance / v.wear_acceleration:g}", "m")
        self.time_step = v.slip_step / v.velocity
        self.rock = SimpleNamespace(pairs=())
        self._plan({"sliding": v.distance / v.wear_acceleration / v.velocity})

    # ---- YADE

    def build(self):
        """Fill YADE's scene: the flat, the block on it under its load, engines."""
        O.reset()
        v = self.v
        yade_scene.put_rock_materials(mu=v.tool_mu)
        yade_scene.put_tool_material(mu=v.tool_mu, contact_damping=0.0)
        O.bodies.append(utils.wall(0.0, axis=1, sense=0, material="loose rock", mask=yade_scene.ROCK_MASK))
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], avoidSelfInteractionMask=2),
            InteractionLoop([Ig2_Wall_Sphere_ScGeom(noRatch=False)], [Ip2_FrictMat_FrictViscoMat_FrictViscoPhys(
                kn=yade_scene.exactly(v.tool_kn), kRatio=yade_scene.exactly(v.tool_kt / v.tool_kn),
                frictAngle=yade_scene.exactly(math.atan(v.tool_mu)))],
                [Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True)]),
            NewtonIntegrator(damping=0.0)]
        self._make_engines()
        self.bodies.add(sorted(self.tool.erosion.surface))
        self.press.act()
        self.press.descent = 0.0
        self._insert_engines()
        self.canonical()

    def _make_engines(self):
        v, tool = self.v, self.tool
        self.bodies = ToolBodies(tool, Straight(start=(0.0, 0.0), velocity=(v.velocity, 0.0)))
        flat = VelocityIncrement(masses=np.ones(1), inertias=np.ones(1), radii=np.ones(1), fixed=[True])
        law = self.law.scaled(v.wear_acceleration)
        self.contact = ToolContact(tool=self.bodies, motion=flat, needs=law.needs)
        self.wear = Wear(contact=self.contact, erosion=tool.erosion, tool=self.bodies, law=law, hardness=self.hardness,
                         temperature=lambda: np.full(tool.count, self.temperature(self.slid)),
                         on_removal=self._on_removal)
        self.press = DeadLoad(bodies=self.bodies, load=self.load, kn=v.tool_kn)
        self.recorder = Recorder([self._log])
        self._register(self.contact, self.wear, self.recorder, self.press)

    def _periods(self):
        v = self.v
        return {"tool_contact": 1, "wear": v.wear_period, "dead_load": None,
                "recorder": max(1, round(v.record_distance / v.wear_acceleration / v.slip_step))}

    def _connect(self):
        super()._connect()
        self.bodies.connect()

    def _on_removal(self, worn, loose):
        if not self.bodies.body_of:
            raise RunEnded(f"the block is worn away after {self.slid:g} m", True)
        self.press.act()

    def canonical(self):
        self._fresh_bounds()
        self.contact.find_contacts()

    def end_stage(self, folder):
        self.wear.act()
        super().end_stage(folder)

    def _restore_engines(self, state):
        self.bodies.restore(state["bodies"])
        super()._restore_engines(state)

    def state(self):
        return {**super().state(), "bodies": self.bodies.state()}

    # ---- what is measured

    @property
    def slid(self):
        """Distance (m) in the laboratory that the simulated sliding stands for."""
        return self.time * self.v.velocity * self.v.wear_acceleration

    def temperature(self, distance):
        """K of the block after a distance (m) in the laboratory."""
        return self.v.temperature + self.v.temperature_rise * distance / self.v.distance

    def expected_depth(self, distance):
        """Integral of the law's dw/ds under the known pressure over a distance (m), k p / H(theta(s)) for one, m."""
        rise, rows = self.v.temperature_rise, self.hardness.kelvin
        bends = [] if rise == 0 else [(row - self.v.temperature) / rise * self.v.distance for row in rows]
        inside = [s for s in bends if 0 < s < distance] or None
        return quad(lambda s: self.law.rate(self.pressure, self.hardness.nearest(self.temperature(s))), 0, distance,
                    points=inside, epsrel=1e-10)[0]

    @property
    def depth(self):
        """Worn depth (m), worn volume over the block's surface."""
        return self.tool.erosion.archard_volume / self.width

    def _log(self):
        impulse, elapsed = self.contact.take_impulse(), self.recorder.elapsed()
        force = impulse / elapsed if elapsed else impulse
        return {"time": (self.time, "s"), "stage": (self.stage, "-"), "distance": (self.slid, "m"),
                "worn_depth": (self.depth, "m"), "descent": (self.press.descent, "m"),
                "expected_depth": (self.expected_depth(self.slid), "m"),
                "temperature": (self.temperature(self.slid), "K"), "normal_force": (force[1], "N/m"),
                "friction_force": (-force[0], "N/m")}

    def results(self):
        """{name: (value, unit)} of the run; k_returned is what the laboratory would find from force, way and depth."""
        v, erosion = self.v, self.tool.erosion
        expected = self.expected_depth(self.slid)
        ratio = self.depth / expected if expected else math.nan
        given = {} if v.wear_law == "modes" else {"k_given": (v.wear_coefficient, "-"),
                                                  "k_returned": (v.wear_coefficient * ratio, "-")}
        return {**given, "k_deviation": (ratio - 1, "-"), "expected_depth": (expected, "m"),
                "worn_depth": (self.depth, "m"), "descent": (self.press.descent, "m"),
                "distance": (self.slid, "m"), "simulated_distance": (self.slid / v.wear_acceleration, "m"),
                "simulated_time": (self.time, "s"), "pressure": (self.pressure, "Pa"), "block_width": (self.width, "m"),
                "temperature_end": (self.temperature(self.slid), "K"), "mass_lost": (erosion.mass_fraction_lost, "-"),
                "particles_removed": (int(np.sum(~erosion.alive)), "-"), "tool_particles": (self.tool.count, "-")}

    def warnings(self):
        return self.wear.warnings()

    def balances(self):
        """Friction: mu F s of the known load, and what became of it; mass: Archard's volume, and where it is."""
        contact, erosion = self.contact, self.tool.erosion
        expected = self.v.tool_mu * self.load * self.slid / self.v.wear_acceleration
        friction = {"mu_load_distance": expected, "drag_work": contact.work_done, "tool": contact.friction,
                    "worn_by": self.wear.work_used + float(contact.wearing_work.sum()),
                    "not_dissipated": expected - contact.friction}
        mass = {name: value * STEEL.density for name, value in erosion.volume_balance().items()}
        return {"friction": (friction, "J/m"), "mass": ({"initial": self.tool.area * STEEL.density, **mass}, "kg/m")}

    # ---- what a run's folder shows

    def model(self):
        """Arrays that stay the same all through a run."""
        tool = self.tool
        return {"block_positions": tool.positions, "block_radii": tool.radii, "outline": tool.vertices}

    def snapshot(self):
        """Arrays that show the scene now."""
        self.bodies.connect()
        erosion = self.tool.erosion
        return {"time": self.time, "stage": self.stage, "offset": self.bodies.pose.offset, "alive": erosion.alive,
                "worn_depth": erosion.stored / (2 * self.tool.radii)}

    def write_vtk(self, folder, number):
        """tool.NNNN.vtk: diameter, worn depth."""
        shot, alive = self.snapshot(), self.tool.erosion.alive
        vtk.write(folder / f"tool.{number:04d}.vtk", self.tool.positions[alive] + shot["offset"],
                  {"diameter": 2 * self.tool.radii[alive], "worn_depth": shot["worn_depth"][alive]})

    def tables(self):
        return {}

    def progress(self):
        """A few words on how it stands."""
        return f"{self.slid:.1f} m stand for, {1e3 * self.depth:.3f} mm worn"

"""Loose spheres under gravity between walls [Rojek 2003, ch. 14]: what the heap and the vibrated tube have in
common."""
import math
from types import SimpleNamespace

import numpy as np
from yade import (
    Bo1_Facet_Aabb, Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Facet_Sphere_ScGeom, Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_MindlinPhys, Law2_ScGeom_MindlinPhys_Mindlin,
    MatchMaker, NewtonIntegrator, O, Vector3, utils)

from rockwear.engines import access
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.grain_contacts import GrainContacts
from rockwear.engines.recorder import Recorder
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, density, duration, integer, length, number, plausible
from rockwear.run import vtk
from rockwear.scenes.balances import with_residual
from rockwear.scenes.output import Output
from rockwear.scenes.scene import Scene
from rockwear.scenes.yade_scene import exactly

ROLLING_STIFFNESS = 0.01
"""Of a contact, over Young's modulus times the cube of the smallest radius: the moment is at its limit after some
thousandths of a radian, and the time step does not feel it."""
AT_REST = 1e-3
"""Kinetic energy of a sphere at rest in the mean, over that of a fall by its diameter."""

ENERGY_MISSED = 0.15
"""Part of the work of gravity that the balance may miss without a warning: YADE's law counts as friction work all
displacement of a contact that slides, with what goes into its spring and comes back from there."""
GRAIN_MASK, WALL_MASK = 1, 3
"""Bodies meet where masks share a bit; bit 2 is avoided between what is fixed."""

GRAINS = Group("grains", (
    Parameter("radius_min", 2.25e-3, "m", length, "smallest radius"),
    Parameter("radius_max", 2.75e-3, "m", length, "largest radius"),
    Parameter("particles", 2000, "", integer(10, 1_000_000), "spheres"),
    Parameter("seed", 1, "", integer(0), "of radii and first places"),
    Parameter("density", 2500.0, "kg/m3", density, "of the grains themselves, glass or quartz"),
    Parameter("young", 2.5e6, "Pa", plausible(1e4, 1e12), "Young's modulus in Hertz's law, far below that of quartz: "
              "grains that overlap by two hundredths of a radius flow as stiff ones do, and the step is a hundredfold"),
    Parameter("poisson", 0.25, "", number(0, 0.49), "Poisson's ratio of the grains"),
    Parameter("friction", 0.5, "", number(0, 10), "between grains"),
    Parameter("wall_friction", 0.5, "", number(0, 10), "of grains on walls"),
    Parameter("rolling_resistance", 0.1, "", number(0, 2), "largest moment of a contact over normal force and mean "
              "radius; on a wall, by YADE's law, 1.5 times as much; 0: grains roll freely"),
    Parameter("restitution", 0.7, "", number(0.05, 1), "of a collision, normal and tangential, by dashpots"),
    Parameter("gravity", 9.81, "m/s2", plausible(1e-3, 1e4), "downwards")))
ACCURACY = Group("accuracy", (
    Parameter("time_step_fraction", 0.3, "", number(1e-4, 0.8), "time step over the time of a Rayleigh wave around the "
              "smallest grain, the usual measure for Hertz's law"),
    Parameter("record_period", 0.01, "s", duration, "between rows of history.csv")))
SETTLING = Parameter("settling", 0.25, "s", duration, "time for the grains to fall into the box and come to rest")


def check_radii(v):
    """Raise ParameterError for radii in the wrong order."""
    require(v.radius_max >= v.radius_min, "radius_max", v.radius_max, f"at least radius_min = {v.radius_min:g}", "m")


def rayleigh_time(*, radius, density, young, poisson):
    """Time (s) of a Rayleigh wave around half a sphere, pi r sqrt(rho / G) / (0.1631 nu + 0.8766)."""
    shear = young / (2 * (1 + poisson))
    return math.pi * radius * math.sqrt(density / shear) / (0.1631 * poisson + 0.8766)


class Granular(Scene):
    """Grains that settle in a box, and what is done to them then.

    values: {name: value} of GRAINS and ACCURACY at least; grains: model.granular.Grains; walls: (k, 3, 3) m, triangles;
    gates: those that go when the grains have settled; fixed: (k, 3) m, grains of the mean radius that never move;
    stages: {name: s}, settling the first.
    """

    def __init__(self, values, *, grains, walls, stages, gates=np.empty((0, 3, 3)), fixed=np.empty((0, 3))):
        super().__init__()
        v = self.v = SimpleNamespace(**values)
        self.grains, self.walls, self.gates, self.fixed = grains, walls, gates, fixed
        self.rayleigh = rayleigh_time(radius=v.radius_min, density=v.density, young=v.young, poisson=v.poisson)
        self.time_step = v.time_step_fraction * self.rayleigh
        self.rock = SimpleNamespace(pairs=())
        self._plan(stages)
        self.gate_ids = range(len(walls), len(walls) + len(gates))
        first = len(walls) + len(gates) + len(fixed)
        self.ids = range(first, first + grains.count)
        self.energy_scale = float(grains.masses.sum()) * v.gravity * 2 * float(grains.radii.mean())
        """J: of all grains in a fall by a diameter."""

    # ---- YADE

    def build(self):
        """Fill YADE's scene: walls, grains, loop, engines."""
        O.reset()
        O.trackEnergy = True
        v = self.v
        for label, friction in (("grain", v.friction), ("wall", v.wall_friction)):
            O.materials.append(FrictMat(young=v.young, poisson=v.poisson, frictionAngle=math.atan(friction),
                                        density=v.density, label=label))
        for corners in np.concatenate([self.walls, self.gates]).tolist():
            O.bodies.append(utils.facet(corners, fixed=True, material="wall", mask=WALL_MASK))
        for place in self.fixed.tolist():
            O.bodies.append(utils.sphere(place, 0.5 * (v.radius_min + v.radius_max), material="grain", fixed=True,
                                         mask=WALL_MASK))
        for place, radius in zip(self.grains.positions.tolist(), self.grains.radii.tolist()):
            O.bodies.append(utils.sphere(place, radius, material="grain", mask=GRAIN_MASK))
        self._put_loop()
        self._make_engines()
        self._insert_engines()
        self.canonical()

    def _put_loop(self):
        v = self.v
        grain, wall = O.materials["grain"].id, O.materials["wall"].id
        friction = MatchMaker(matches=((grain, grain, math.atan(v.friction)), (grain, wall, math.atan(v.wall_friction)),
                                       (wall, wall, 0.0)))
        rolls = v.rolling_resistance > 0
        stiffness = ROLLING_STIFFNESS * v.young * v.radius_min**3 if rolls else 0.0
        damped = {name: exactly(v.restitution) for name in ("en", "es")} if v.restitution < 1 else {}
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], verletDist=0.3 * v.radius_min,
                                  avoidSelfInteractionMask=2),
            InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
                            [Ip2_FrictMat_FrictMat_MindlinPhys(frictAngle=friction, eta=v.rolling_resistance,
                                                               krot=stiffness, ktwist=0.0, **damped)],
                            [Law2_ScGeom_MindlinPhys_Mindlin(calcEnergy=True, includeMoment=rolls)]),
            NewtonIntegrator(damping=0.0, gravity=Vector3(0, -v.gravity, 0))]

    def _make_engines(self):
        self.contacts = GrainContacts()
        guard = EnergyGuard(work=lambda: abs(self.gravity_work()), floor=10 * self.energy_scale, period=self.chunk)
        self.recorder = Recorder([self.output.log], period=max(1, self.steps_in(self.v.record_period)))
        self._register(self.contacts, *self.own_engines(), guard, self.recorder)

    def own_engines(self):
        """Engines of the scene itself, in the order of their visits."""
        return []

    def canonical(self):
        """The state that a saved and loaded scene has, by saving and loading it: YADE's contacts hold on to the law
        that they have met first, and with it to sums that no file keeps."""
        self._refresh_bounds()
        self.contacts.act()
        O.saveTmp(quiet=True)
        O.loadTmp(quiet=True)
        self._find_yade()

    def _connect(self):
        super()._connect()
        self._find_yade()

    def _find_yade(self):
        # Else bodies that are erased later would be unknown to a collider that is made afterwards.
        O.bodies.enableRedirection = False
        for engine in self.engines:
            engine.connect()

    def end_stage(self, folder):
        """On to the next stage; after settling the gates go."""
        super().end_stage(folder)
        if self.stage == 1:
            for gate in self.gate_ids:
                O.bodies.erase(gate)
            self.canonical()

    # ---- what is measured

    def left(self):
        """(m,) places among the grains of those that have not been erased."""
        return np.array([k for k, i in enumerate(self.ids) if O.bodies[i]], int)

    def positions(self):
        """((m, 3) m of the grains that are left, (m,) their places among all)."""
        left = self.left()
        ids = [self.ids[k] for k in left.tolist()]
        return access.states(ids)[:, :3], left

    def gravity_work(self):
        """J done by gravity, and by the inertial forces of a container that vibrates."""
        return -O.energy["gravWork"] if "gravWork" in O.energy.keys() else 0.0

    def stored_energy(self):
        return {"kinetic": utils.kineticEnergy(), "elastic": self.contacts.elastic_energy()}


class GranularOutput(Output):
    """What the folders of granular scenes have in common."""

    carried_out = staticmethod(lambda: 0.0)
    """A function giving J that left with erased grains."""

    def log(self):
        """{name: (value, unit)} of the history."""
        scene = self.scene
        return {"time": (scene.time, "s"), "stage": (scene.stage, "-"),
                "kinetic_energy": (utils.kineticEnergy(), "J"), "gravity_work": (scene.gravity_work(), "J"),
                **scene.contacts.log()}

    def rest(self):
        """Kinetic energy over that of all grains in a fall by a diameter."""
        return utils.kineticEnergy() / self.scene.energy_scale

    def common_results(self):
        """{name: (value, unit)}."""
        scene = self.scene
        return {"simulated_time": (scene.time, "s"), "grains": (scene.grains.count, "-"),
                "mass": (float(scene.grains.masses.sum()), "kg"), "kinetic_energy_end": (utils.kineticEnergy(), "J"),
                "kinetic_over_fall_energy": (self.rest(), "-"), "time_step": (scene.time_step, "s"),
                "rayleigh_time": (scene.rayleigh, "s")}

    def balances(self):
        """Energy: what gravity (and vibration) did, and where it is. YADE does not count the work of rolling
        resistance: with it, `rolling` is what the other entries leave, and no residual can be told."""
        scene = self.scene
        balance = {"gravity_work": scene.gravity_work(), **scene.stored_energy(),
                   "friction": scene.contacts.friction_work, "contact_damping": scene.contacts.damping_work,
                   "carried_out": self.carried_out()}
        balance = with_residual(balance, "gravity_work")
        if scene.v.rolling_resistance > 0:
            balance["rolling"] = balance.pop("residual")
        return {"energy": (balance, "J")}

    def warnings(self):
        balance = self.balances()["energy"][0]
        work = balance["gravity_work"]
        # What rolling takes is no residual, but nothing can be taken from it.
        missed = balance.get("residual", min(0.0, balance.get("rolling", 0.0)))
        return [] if abs(missed) <= ENERGY_MISSED * abs(work) else [
            f"the energy balance misses {100 * missed / work:.2g} % of the work of gravity: a smaller "
            "time_step_fraction may tell why"]

    def model(self):
        """Arrays that stay the same all through a run."""
        return {"grain_radii": self.scene.grains.radii, "wall_triangles": self.scene.walls,
                "fixed_grains": self.scene.fixed,
                "stage_names": np.array([name for name, _ in self.scene.stages])}

    def snapshot(self):
        """Arrays that show the scene now; grains that were erased are nan."""
        places = np.full((self.scene.grains.count, 3), np.nan)
        now, left = self.scene.positions()
        places[left] = now
        return {"time": self.scene.time, "stage": self.scene.stage, "grain_positions": places}

    def write_vtk(self, folder, number):
        """grains.NNNN.vtp: diameter."""
        places, left = self.scene.positions()
        vtk.write(folder, "grains", number, self.scene.time, places, {"diameter": 2 * self.scene.grains.radii[left]})

"""Every engine in a small scene, saved and restarted between its visits; writes {check: findings} to FILE.

    yade -n -x contract.py FOLDER FILE        FOLDER is for checkpoints
"""
import importlib
import inspect
import json
import math
import numbers
import os
import pkgutil
import sys
from abc import abstractmethod
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from yade import FrictViscoMat, NewtonIntegrator, O, Subdomain

import rockwear.engines
from rockwear.engines import access, base
from rockwear.engines.absorbing_boundary import AbsorbingBoundary
from rockwear.engines.bond_dashpots import BondDashpots
from rockwear.engines.base import Engine
from rockwear.engines.conduction import Conduction
from rockwear.engines.confinement import Membrane, PressedEnds
from rockwear.engines.damping import BackgroundDamping, GrainDamping
from rockwear.engines.dead_load import DeadLoad
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.expansion import Expansion
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.facet_wear import FacetWear
from rockwear.engines.failure import Failure
from rockwear.engines.heat import Heat
from rockwear.engines.outflow import Outflow
from rockwear.engines.path_follower import PathFollower
from rockwear.engines.platens import Platens
from rockwear.engines.recorder import Recorder
from rockwear.engines.rest import Rest
from rockwear.engines.rock_friction import RockFriction, YadeFriction
from rockwear.engines.separation import Separation
from rockwear.engines.shear_rotation import ShearRotation
from rockwear.engines.tool_contact import ToolContact
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.vibration import Vibration
from rockwear.engines.wear import Wear
from rockwear.engines.wear_profile import WearProfile
from rockwear.kernels.archard import Hardness
from rockwear.kernels.bond_laws import (
    Cohesive, ElasticBrittle, ElasticDamage, ElastoPlasticSoftening, NonlinearElastoPlastic)
from rockwear.kernels.conduction import HeatNetwork
from rockwear.kernels.elastic_moduli import Moduli
from rockwear.kernels.erosion import Erosion
from rockwear.kernels.packing import contacts
from rockwear.kernels.rigid_motion import Straight, SwingAndRotation
from rockwear.kernels.voronoi import cells
from rockwear.kernels.wear_laws import DissipationArchard, PressureArchard
from rockwear.model.contact import ContactLaw
from rockwear.model.facet_tool import FacetTool
from rockwear.model.granular import TubeBox, poured
from rockwear.model.rock import Arranged
from rockwear.model.thermal_body import ParticleBody
from rockwear.run import checkpoint
from rockwear.scenes import granular, yade_scene
from rockwear.scenes.scene import Scene
from rockwear.scenes.tool_bodies import FacetBodies, ToolBodies

SAVED, AFTER = 132, 101
"""Steps to the checkpoint and from there; it comes at no multiple of the period of an engine that adds up."""
TRANSIENT = {"wall_time", "visits", "places", "body_list", "where", "counted"}
"""Attributes of engines that a restart resets or counts anew, or finds elsewhere in memory."""
RADIUS, KN, KT, RN, MU = 1e-3, 2e10, 1e10, 1e5, 0.5
STRENGTH = dict(kn=KN, kt=KT, mu=MU, Rn=RN, Rt=RN)
STEEL = Hardness([0, 200], [500, 400])
PLASTIC = ElastoPlasticSoftening(H=1e10, **STRENGTH)


def lattice(columns, rows, radius=RADIUS):
    """(n, 2) m, of discs that touch in equilateral triangles."""
    return np.array([(radius * (1 + 2 * column + row % 2), radius * (1 + math.sqrt(3) * row))
                     for row in range(rows) for column in range(columns)])


def discs(positions, radius=RADIUS):
    """A specimen of these discs, the touching ones bonded."""
    # In a box of their own area.
    side = math.sqrt(math.pi * len(positions)) * radius
    return Arranged(positions=positions, radius=radius, width=side, height=side, density=2500.0)


def block(columns=3, rows=5, radius=0.8 * RADIUS):
    """A tool of discs in a square lattice, its lower left corner at the origin and its top fixed."""
    index = np.arange(columns * rows).reshape(rows, columns)
    y, x = (radius * (2 * place.ravel() + 1) for place in np.indices(index.shape))
    positions, radii = np.column_stack([x, y]), np.full(len(x), radius)
    outline = 2 * radius * np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)])
    pairs = np.concatenate([np.column_stack([index[:-1].ravel(), index[1:].ravel()]),
                            np.column_stack([index[:, :-1].ravel(), index[:, 1:].ravel()])])
    surface = np.concatenate([index[0], index[1:, -1]])
    return SimpleNamespace(
        positions=positions, radii=radii, count=len(radii), volumes=4 * radii**2, pairs=pairs,
        cells=cells(positions, polygon=outline), fixed=y > y.max() - radius,
        erosion=Erosion(radii=radii, volumes=4 * radii**2, pairs=pairs, surface=surface, fixed=index[-1]))


class World(Scene):
    """A scene with a checkpoint after SAVED steps. `rock` is a specimen or the like; `law` that of its bonds."""

    rock, bodies, law, loop = None, None, PLASTIC, staticmethod(yade_scene.put_loop)
    tool_law, loose, options = None, FrictViscoMat, {}

    def __init__(self):
        self.stage, self.clock, self.skipped = 0, 0.0, 0

    def build(self):
        O.reset()
        yade_scene.put_rock_materials(mu=self.law.mu, loose=self.loose, yade_law=self.law.yade_law)
        yade_scene.put_tool_material(mu=0.3, contact_damping=0.5)
        yade_scene.put_rock(self.rock)
        self.loop(rock=self.law, tool=self.tool_law, **self.options)
        self._make_engines()
        yade_scene.make_bonds(self.rock, self.bonds)
        self._begin()
        self._insert()

    def _insert(self):
        self._insert_engines()
        self._start()
        self.canonical()

    def _begin(self):
        """What follows bonding."""

    def _start(self):
        """What follows once all engines are connected."""

    def event(self, last):
        """What happens halfway to the checkpoint, and, as the `last` event, just before it."""

    def _make_engines(self):
        rock = self.rock
        self.bonds = yade_scene.bonds_engine(rock, self.law, lambda: self.time)
        self.increment = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii,
                                           fixed=rock.fixed)
        self.rock_friction = RockFriction(bonds=self.bonds, motion=self.increment, period=3)
        self._register(*self._engines())

    @abstractmethod
    def _engines(self):
        """The scene's engines, in the order of their visits."""

    def _connect(self):
        super()._connect()
        if self.bodies:
            self.bodies.connect()

    def canonical(self):
        super().canonical()
        if self.bodies:
            self.contact.find_contacts()

    def advance(self, steps):
        base.run(steps)
        self.canonical()

    def state(self):
        return {**super().state(), **({"bodies": self.bodies.state()} if self.bodies else {})}

    def _restore_engines(self, state):
        if self.bodies:
            self.bodies.restore(state["bodies"])
        super()._restore_engines(state)


class ParticleCut(World):
    """A tool of discs that swings into bonded discs, which is worn and heated."""

    time_step, law = 1e-7, ElasticDamage(H=2e10, **STRENGTH)
    tool_law = ContactLaw(kn=2e10, kt=2e10, mu=0.1)

    def __init__(self):
        super().__init__()
        self.rock = discs(lattice(9, 6))
        self.rock.fixed[self.rock.positions[:, 0] > 17e-3] = True
        self.tool = block()
        self.motion = SwingAndRotation(centre=(-4.79e-3, 0.02), swing=(20.0, 0.0), angular_velocity=400.0,
                                       pivot=(0.0, 0.02))

    def _engines(self):
        rock, tool = self.rock, self.tool
        self.bodies = ToolBodies(tool, self.motion)
        law = PressureArchard(k=700)
        self.contact = ToolContact(tool=self.bodies, motion=self.increment, needs=law.needs, sampling_period=3)
        body = ParticleBody(tool)
        network = HeatNetwork(capacity=np.concatenate([rock.masses * 800, 7830 * tool.volumes * 500]),
                              temperature=np.repeat([300.0, 350.0], [rock.count, tool.count]),
                              edges=np.empty((0, 2), int), conductance=0.0)
        self.heat = Heat(network=network, bonds=self.bonds, rock_friction=self.rock_friction, tool_contact=self.contact,
                         rock=rock, body=body, heat_fraction=0.9, tool_share=0.6, contact_conductance=1e6,
                         convection=1e4, emissivity=0.9, ambient=280.0,
                         rock_paths=(rock.pairs, np.full(len(rock.pairs), 3.0)),
                         tool_paths=(tool.pairs, np.full(len(tool.pairs), 50.0)), surface_period=2e-6,
                         wear_acceleration=10.0, shank_temperature=320.0, period=32)
        expansion = Expansion(coefficient=1e-5, rock=rock, reference=290.0, bonds=self.bonds, period=32,
                              temperature=lambda: network.temperature[:rock.count],
                              loose=lambda: [*self.rock_friction.contacts,
                                             *(contact.interaction for contact in self.contact.possible)])
        wear = Wear(contact=self.contact, erosion=tool.erosion, tool=self.bodies, law=law, hardness=STEEL,
                    temperature=self.heat.temperature_of_pieces, on_removal=self.heat.remove, period=5)
        profile = WearProfile(wear=wear, place=np.arange(tool.count) // 3, period=10)
        recorder = Recorder([wear.log, self.bonds.log, self.heat.log], period=27)
        guard = EnergyGuard(work=lambda: self.contact.work_done, floor=1e6, period=11)
        self.profile = profile
        return [self.bonds, self.contact, self.rock_friction, Separation(self.bonds, period=9),
                PathFollower(bodies=self.bodies, clock=lambda: self.time, period=4),
                wear, profile, self.heat, expansion,
                BackgroundDamping(rate=1e4, bodies=range(rock.count), period=3), recorder, guard]

    def _begin(self):
        self.bodies.add(sorted(self.tool.erosion.surface))

    def _start(self):
        self.heat.begin()
        self.profile.begin_cycle(1.0)

    def event(self, last):
        if not last:
            self.profile.begin_cycle(2.0)
            self.heat.replace_rock(np.full(self.rock.count, 310.0))
            self.heat.renew_tool(np.full(self.tool.count, 340.0))


SLOPE = math.tan(math.radians(2.5))


class FacetCut(World):
    """A tool of facets with a notch slides over loose discs that are pressed against it."""

    time_step, loop = 1e-6, staticmethod(yade_scene.put_loop_with_facets)
    law = ElasticBrittle(**{**STRENGTH, "kn": 1e8, "kt": 1e8})
    tool_law = ContactLaw(kn=1e8, kt=1e8, mu=0.3)

    def __init__(self):
        super().__init__()
        radius, rise = 1.25 * RADIUS, 0.02 * SLOPE
        places = radius * np.array([(0, -1), (8, -1 - 8 * SLOPE), (7.1, -2.8 - 8 * SLOPE), (-5, -1.1 - 5 * SLOPE),
                                    (-9, -1.1 - 9 * SLOPE)])
        self.rock = discs(places + (0, rise), radius)
        self.rock.pairs = np.empty((0, 2), int)
        self.tool = FacetTool.of_outline(np.array([(-0.02, 0), (0, rise), (0.02, 0), (0.02, 0.01), (-0.02, 0.01)]),
                                         segment=1.7e-3, density=7830.0)

    def _engines(self):
        boundary = self.tool.boundary
        self.bodies = FacetBodies(self.tool, Straight(start=(-0.13e-3, 0.0), velocity=(1.0, 0.0)))
        self.contact = FacetContact(tool=self.bodies, motion=self.increment, neighbours=boundary.neighbours())
        self.rock_friction = YadeFriction(contact=self.contact, bonds=self.bonds, motion=self.increment, period=9)
        wear = FacetWear(contact=self.contact, boundary=boundary, tool=self.bodies, hardness=STEEL, period=5,
                         law=DissipationArchard(k=20.0, mu=0.3),
                         temperature=lambda: self._temperature() + np.arange(self.tool.count))
        return [self.bonds, self.contact, self.rock_friction, wear]

    def _temperature(self):
        return 300 + 100 * math.exp(-2e4 * self.time) * math.sin(1e5 * self.time)

    def _begin(self):
        access.yade_engine(NewtonIntegrator).gravity = (0, 1e6, 0)
        for body in (0, 1):
            O.bodies[body].state.blockedDOFs = "xzXYZ"
        for body in (3, 4):
            O.bodies[body].state.blockedDOFs = "xyzXYZ"
        self.bodies.add(range(self.tool.count))

    def event(self, last):
        """One of two discs comes into contact by what counts as a change of the tool's shape."""
        O.bodies[3 + last].state.pos += (0, 0.2 * RADIUS, 0)
        self.contact.shape_has_changed()


class Sliding(World):
    """A tool of discs slides under a dead load over a large disc, and is worn."""

    time_step, tool_law = 1e-7, ContactLaw(kn=2e10, kt=2e10, mu=0.3)

    def __init__(self):
        super().__init__()
        self.rock = discs(np.array([(0.0, -1.0)]), 1.0)
        self.rock.pairs, self.rock.fixed[:] = np.empty((0, 2), int), True
        self.tool = block()

    def _engines(self):
        self.bodies = ToolBodies(self.tool, Straight(start=(-2.4e-3, -5e-6), velocity=(20.0, 0.0)))
        self.contact = ToolContact(tool=self.bodies, motion=self.increment)
        wear = Wear(contact=self.contact, erosion=self.tool.erosion, tool=self.bodies, hardness=Hardness.constant(5e9),
                    law=DissipationArchard(k=550, mu=0.3), temperature=lambda: np.full(self.tool.count, 300.0),
                    on_removal=lambda worn, loose: None, period=5)
        return [self.bonds, self.contact, self.rock_friction, wear,
                DeadLoad(bodies=self.bodies, load=3e5, kn=2e10, period=15)]

    def _begin(self):
        self.bodies.add(sorted(self.tool.erosion.surface))


class Tension(World):
    """A specimen is torn apart."""

    time_step = 1e-7

    def __init__(self):
        super().__init__()
        self.rock = discs(lattice(8, 5))
        x = self.rock.positions[:, 0]
        self.left = np.flatnonzero(x < 3 * RADIUS).tolist()
        self.right = np.flatnonzero(x > x.max() - 2 * RADIUS).tolist()

    def _engines(self):
        platens = Platens(left=self.left, right=self.right, velocity=20.0, period=3)
        recorder = Recorder([lambda: {name: (value, "N") for name, value in zip(("pull", "off"), platens.take_mean())}],
                            period=27)
        failure = Failure(stress=lambda: recorder.columns()["pull"][-1], broken=lambda: False, drop=0.1, period=27)
        return [self.bonds, self.rock_friction, platens, recorder, failure]

    def _begin(self):
        for body, sign in [(i, -1) for i in self.left] + [(i, 1) for i in self.right]:
            O.bodies[body].state.blockedDOFs = "xyzXYZ"
            O.bodies[body].state.vel = (20.0 * sign, 0, 0)


class Confined(Tension):
    """The same specimen under pressure on its sides and, at first, on its ends."""

    pressing = 1e5

    def _engines(self):
        membrane = Membrane(rock=self.rock, ends=(self.left[0], self.right[0]), pressure=lambda: 1e6 + 1e12 * self.time,
                            interval=25)
        ends = PressedEnds(left=self.left, right=self.right, masses=self.rock.masses, force=lambda: self.pressing)
        return [self.bonds, membrane, ends, self.rock_friction]

    def _begin(self):
        for body in self.left + self.right:
            O.bodies[body].state.blockedDOFs = "xzXY"


class Absorbing(World):
    """A block falls on a boundary that absorbs, which holds other particles as time goes on; one is pulled far off."""

    time_step = 1e-7
    law = ElasticBrittle(**{**STRENGTH, "Rn": 1e9, "Rt": 1e9})

    def __init__(self):
        super().__init__()
        self.rock = discs(np.append(lattice(8, 5), [(0.05, 0.0)], axis=0))

    def _engines(self):
        self.boundary = AbsorbingBoundary(moduli=Moduli(2e10, 0.2, 2e10 / 2.4), density=2500.0, period=3,
                                          step=self.time_step, critical=1e-6)
        return [self.bonds, self.boundary, self.rock_friction]

    def _hold(self, numbers, normal, displacements=0.0):
        count = len(numbers)
        self.boundary.hold(numbers, [normal] * count, np.full(count, 2 * RADIUS), np.full(count, 8e-3), displacements)

    def _begin(self):
        for i in range(self.rock.count):
            O.bodies[i].state.vel = (1.0, -5.0, 0)
        self._hold([*range(8), self.rock.count - 1], (0, -1))
        pulled = O.bodies[self.rock.count - 1].state
        pulled.blockedDOFs, pulled.vel = "xyzXYZ", (0, 300.0, 0)

    def event(self, last):
        if last:
            self._hold([0, 8, 16], (-1, 0), [(1e-7, 0.0)] * 3)
        else:
            self._hold([7, 15, 23], (1, 0))
            self.boundary.release([1, 3, 5])


class NowhereLinear(Tension):
    """The same with a law whose bonds all have their force from Python."""

    law = NonlinearElastoPlastic()


class Softening(Tension):
    """The same with bonds that YADE's concrete model carries, dashpots, and damping of the two grains between its ends,
    its inner particles driven against one another: at the checkpoint some bonds soften, some slip, some are crushed."""

    law = Cohesive(kn=KN, kt=KT, mu=MU, bond_tension=RN, bond_cohesion=0.3 * RN, bond_fracture_energy=1.0,
                   bond_shear_energy=0.5, bond_crushing=0.05 * RN)

    def __init__(self):
        super().__init__()
        self.rock.laws = [self.law] * len(self.rock.pairs)
        self.rock.grains = np.searchsorted([3 * RADIUS, 8 * RADIUS, 14 * RADIUS], self.rock.positions[:, 0])

    def _begin(self):
        super()._begin()
        for i in set(range(self.rock.count)) - {*self.left, *self.right}:
            O.bodies[i].state.vel = (0, 30.0 * (-1)**i, 0)

    def event(self, last):
        # As a heat engine does.
        self.bonds.take_slip_work(self.rock.count)

    def _engines(self):
        bonds, *others = super()._engines()
        return [bonds, BondDashpots(rock=self.rock, bonds=bonds, ratio=0.05),
                GrainDamping(rock=self.rock, bonds=bonds, rate=1e4, period=5), *others]


class Spinning(World):
    """A chip of four bonded spheres spins in space."""

    time_step, options = 3e-5, {"ratcheting_free": False}
    law = ElasticBrittle(kn=1.5e6, kt=1.5e6, mu=0.8, Rn=1e6, Rt=1e6)

    def __init__(self):
        super().__init__()
        radius = 13.5e-3
        places = 0.95 * radius / math.sqrt(2) * np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
        masses = np.full(4, 2500 * 4 / 3 * math.pi * radius**3)
        pairs = contacts(places, np.full(4, radius), 0.0)
        self.rock = SimpleNamespace(count=4, positions=places, places=places,
                                    bonded=np.ones(len(pairs), bool), radii=np.full(4, radius), masses=masses,
                                    inertias=0.4 * masses * radius**2, fixed=np.zeros(4, bool), laws=None,
                                    side=np.zeros(4, int), pairs=pairs)

    def _engines(self):
        return [ShearRotation(bonds=self.bonds, radii=self.rock.radii), self.bonds, self.rock_friction]

    def _begin(self):
        spin = np.array([900.0, 1000.0, 1500.0])
        for i, place in enumerate(self.rock.positions):
            state = O.bodies[i].state
            state.vel, state.angVel = tuple(np.cross(spin, place)), tuple(spin + 10 * i)


class HeatAlone(World):
    """Heat in a network, and nothing in YADE."""

    time_step = 0.1

    def build(self):
        O.reset()
        O.engines = []
        self._make_engines()
        self._insert()

    def _make_engines(self):
        self._register(*self._engines())

    def _engines(self):
        network = HeatNetwork(capacity=np.array([1.0, 2.0, 3.0]), edges=np.array([(0, 1), (1, 2)]), conductance=0.01,
                              temperature=np.array([300.0, 400.0, 350.0]))
        network.convect([0], 0.002, 280.0)
        network.source([2], 0.5)
        return [Conduction(network=network, step=1.0, period=5)]

    def canonical(self):
        """Nothing of YADE's to prepare."""


class Pouring(granular.Granular):
    """Grains are thrown on the floor of a box that vibrates; some fall out on their way, which counts as rest."""

    def __init__(self):
        v = {p.name: p.default for group in (granular.GRAINS, granular.ACCURACY) for p in group.parameters}
        v.update(gravity=2000.0, particles=30)
        box = TubeBox(width=0.022, depth=0.022, height=0.2, diameter=0.012, length=0.02, axis=0.01)
        low, high = box.inside
        grains = poured(low=low, high=high, count=v["particles"], radius_min=v["radius_min"],
                        radius_max=v["radius_max"], density=v["density"], seed=1)
        self.output = SimpleNamespace(log=lambda: self.contacts.log())
        super().__init__(v, grains=grains, walls=box.walls, stages={"settling": 1.0})

    def own_engines(self):
        return [Vibration(amplitude=1e-3, frequency=400.0, direction=(0.6, 0.8, 0.0), gravity=2000.0, period=4,
                          clock=lambda: self.time),
                Outflow(bodies=self.ids, below=2.3e-3, period=7), Rest(limit=1e9, watching=lambda: True, period=31)]

    def advance(self, steps):
        base.run(steps)
        self.canonical()

    def event(self, last):
        """Nothing happens."""


WORLDS = (ParticleCut, FacetCut, Sliding, Tension, Confined, Absorbing, NowhereLinear, Softening, Spinning, HeatAlone,
          Pouring)


def concrete_engines():
    """Names of all engine classes of the package that are not abstract."""
    found = set()
    for module in pkgutil.iter_modules(rockwear.engines.__path__, "rockwear.engines."):
        for _, kind in inspect.getmembers(importlib.import_module(module.name), inspect.isclass):
            if issubclass(kind, Engine) and not inspect.isabstract(kind):
                found.add(kind.__name__)
    return sorted(found)


def flat(tree, prefix=""):
    """{path: value} of nested dicts."""
    found = {}
    for name, value in tree.items():
        found |= flat(value, f"{prefix}{name}/") if isinstance(value, dict) else {prefix + name: value}
    return found


def bits(tree):
    """{path: bytes} of nested dicts of numbers and arrays."""
    return {path: (np.asarray(value).shape, np.asarray(value).tobytes()) for path, value in flat(tree).items()}


def different(one, other):
    """Paths of {path: bytes} that differ."""
    return sorted(path for path in one.keys() | other.keys() if one.get(path) != other.get(path))


def plain(value):
    if isinstance(value, np.ndarray):
        return value.dtype != object
    return isinstance(value, (numbers.Number, str, np.bool_))


def of_engines(world):
    return {engine.name: engine.state() for engine in world.engines}


def numbers_of(thing):
    """{path: bytes} of all numbers that an object and its parts have, whether `state` gives them or not."""
    properties = [name for name, kind in inspect.getmembers(type(thing), lambda member: isinstance(member, property))]
    found = {}
    for name, value in {**vars(thing), **{name: getattr(thing, name) for name in properties}}.items():
        if name in TRANSIENT:
            continue
        if hasattr(value, "state") and hasattr(value, "restore") and not isinstance(value, Engine):
            found |= {f"{name}/{path}": numbers for path, numbers in numbers_of(value).items()}
        elif isinstance(value, dict):
            keys = sorted(value)
            found |= as_bits(f"{name}, keys", keys) | as_bits(f"{name}, values", [value[key] for key in keys])
        else:
            found |= as_bits(name, sorted(value) if isinstance(value, set) else value)
    return found


def as_bits(name, value):
    """{name: bytes} of what is numbers or strings, {} of all else."""
    try:
        value = np.asarray(value)
    except ValueError:
        return {}
    return {name: (value.shape, value.tobytes())} if value.dtype != object else {}


def all_numbers(world):
    return {f"{engine.name}/{path}": found for engine in world.engines for path, found in numbers_of(engine).items()}


def yade_now():
    """All bodies as YADE has them."""
    bodies = [body.id for body in O.bodies if body]
    return {"iteration": O.iter, "ids": np.array(bodies), "bodies": np.array(Subdomain().getStateValuesFromIds(bodies))}


def visits_due(engine, start):
    """Visits in SAVED steps from iteration `start`: between steps whenever YADE has counted a multiple of the period.

    A PyRunner comes in its first step if `start` is at least its period.
    """
    if engine.phase == base.BETWEEN:
        return (start + SAVED) // engine.period - start // engine.period
    return (start >= engine.period) + (SAVED - 1) // engine.period


def open_history(world, folder):
    """Give the recorder of a world its files, as a run does."""
    folder.mkdir(exist_ok=True)
    for engine in world.engines:
        if isinstance(engine, Recorder):
            assert engine.history.open(folder / "history.f8", folder / "history.csv")


def check(kind, folder):
    """{check: [what is wrong]} of a world; and what was covered."""
    world = kind()
    world.build()
    open_history(world, folder)
    first = of_engines(world)
    wrong = {"state": [], "log": [], "visits": [], "round trip": [], "restart": []}
    for last in (False, True):
        world.advance(SAVED // 2)
        world.event(last)
    world.canonical()
    states = of_engines(world)
    for engine in world.engines:
        wrong["state"] += [f"{engine.name}: {path} is a {type(value).__name__}"
                           for path, value in flat(states[engine.name]).items() if not plain(value)]
        wrong["log"] += [f"{engine.name}: {name}" for name, (value, unit) in engine.log().items()
                         if not (isinstance(value, numbers.Number) and isinstance(unit, str))]
        due = visits_due(engine, world.first_iteration) if engine.period else 0
        if engine.visits != due or (due and not engine.wall_time > 0):
            wrong["visits"].append(f"{engine.name}: {engine.visits} of {due}")
    checkpoint.save(folder, identity={}, state=world.state(),
                    write_scenes=lambda directory: world.save(directory, folder))
    visits = {engine.name: engine.visits for engine in world.engines}
    world.advance(AFTER)
    visits = {engine.name: engine.visits - visits[engine.name] for engine in world.engines}
    never = all_numbers(world) | bits(yade_now())

    again = kind()
    state, directory = checkpoint.load(folder, {})
    again.restore(state, directory, folder)
    open_history(again, folder)
    wrong["round trip"] = different(bits(of_engines(again)), bits(states))
    again.advance(AFTER)
    wrong["restart"] = different(all_numbers(again) | bits(yade_now()), never)
    wrong["visits"] += [f"{engine.name}: {engine.visits} after the restart, {visits[engine.name]} without"
                        for engine in again.engines if engine.visits != visits[engine.name]]
    changed = {name: {path.split("/")[0] for path in different(bits(state), bits(first[name]))}
               for name, state in states.items()}
    return wrong, world.engines, changed


def without_a_visit():
    """What Python says to an engine that has no `act`."""
    try:
        type("Idle", (Engine,), {"name": "idle"})()
    except TypeError as error:
        return str(error)
    return ""


*_, folder, file = sys.argv
classes, names, phases, findings, seen, keys = set(), set(), set(), {}, {}, {}
for kind in WORLDS:
    findings[kind.__name__], engines, changed = check(kind, Path(folder) / kind.__name__)
    for engine in engines:
        classes.add(type(engine).__name__)
        names.add(engine.name)
        phases.add(engine.phase)
        # A state that no scene changes is not tested.
        seen.setdefault(engine.name, set()).update(changed[engine.name])
        keys.setdefault(engine.name, set()).update(path.split("/")[0] for path in flat(engine.state()))
found = {"engines": concrete_engines(), "covered": sorted(classes), "names": sorted(names), "phases": sorted(phases),
         "without a visit": without_a_visit(), "findings": findings,
         "never changed": {name: sorted(keys[name] - seen[name]) for name in keys if keys[name] - seen[name]}}
Path(file).write_text(json.dumps(found, indent=1), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

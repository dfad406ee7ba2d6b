"""Heat and mechanics on each other, where exact answers exist; writes {check: {number: value}} to the file named last.

    yade -n -x coupling.py CHECK ... FILE
"""
import json
import math
import os
import sys
from types import SimpleNamespace

import numpy as np
from yade import Law2_ScGeom_FrictViscoPhys_CundallStrackVisco, O

from rockwear.engines import base
from rockwear.scenes import yade_scene
from rockwear.engines.access import law_functor
from rockwear.engines.bonds import ELASTIC_STEPS, Bonds
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.expansion import Expansion
from rockwear.engines.heat import Heat
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.tool_contact import ToolContact
from rockwear.kernels.bond_laws import ElasticBrittle, ElasticDamage, ElastoPlasticSoftening
from rockwear.kernels.conduction import HeatNetwork, effusivity, effusivity_share
from rockwear.kernels.packing import contacts
from rockwear.kernels.stability import critical_time_step
from rockwear.model.contact import ContactLaw
from rockwear.model.materials import SANDSTONE, STEEL
from rockwear.model.rock import Specimen
from rockwear.model.thermal_body import ParticleBody
from yade_loop import insert

KN, KT, MU, ALPHA, D = 20e9, 5e9, 0.5, 1e-5, 2e-3
E = 2 * math.sqrt(3) * KN * (KN + KT) / (3 * KN + KT)
UNBREAKABLE = ElasticBrittle(kn=KN, kt=KT, Rn=1e12, Rt=1e12, mu=MU)
TOOL = ContactLaw(kn=90e9, kt=90e9, mu=0.3, damping=0.9)

NO_PATHS = np.empty((0, 2), int), np.empty(0)


def arranged(positions, radii=D / 2, pairs=None, fixed=()):
    """Discs at given places, those that touch bonded."""
    positions = np.asarray(positions, float)
    count, radii = len(positions), np.broadcast_to(radii, len(positions)).astype(float)
    is_fixed = np.zeros(count, bool)
    is_fixed[list(fixed)] = True
    masses = 2500 * np.pi * radii**2
    pairs = contacts(positions, radii, 1e-9) if pairs is None else np.reshape(pairs, (-1, 2)).astype(int)
    return SimpleNamespace(positions=positions, places=positions, radii=radii, count=count, fixed=is_fixed,
                           bonded=np.ones(len(pairs), bool), side=np.zeros(count, int),
                           masses=masses, inertias=0.5 * masses * radii**2, pairs=pairs,
                           bond_lengths=np.linalg.norm(np.diff(positions[pairs], axis=1)[:, 0], axis=1))


def body_of_discs(positions, radius):
    """Thermal body of so many discs of steel."""
    count = len(positions)
    erosion = SimpleNamespace(alive=np.ones(count, bool), areas=np.full(count, 2 * radius))
    return ParticleBody(SimpleNamespace(positions=positions, radii=np.full(count, radius), volumes=np.zeros(count),
                                        count=count, fixed=np.zeros(count, bool), erosion=erosion))


class Assembly:
    """Bonded discs in YADE whose temperatures (n,) K above the reference are set by hand."""

    def __init__(self, rock, law=UNBREAKABLE, damping=0.0):
        self.rock, self.temperature = rock, np.zeros(rock.count)
        O.reset()
        yade_scene.put_rock_materials(mu=MU)
        yade_scene.put_rock(rock)
        yade_scene.put_loop(rock=UNBREAKABLE, damping=damping)
        self.bonds = Bonds(pairs=rock.pairs, law=law, clock=lambda: O.time)
        yade_scene.make_bonds(rock, self.bonds)
        self.expansion = Expansion(coefficient=ALPHA, rock=rock, reference=0.0, temperature=lambda: self.temperature,
                                   bonds=self.bonds, period=None)
        insert(self.bonds, self.expansion)
        O.dt = 0.6 * critical_time_step(positions=rock.positions, radii=rock.radii, masses=rock.masses,
                                        inertias=rock.inertias, bonds=rock.pairs, kn=KN, kt=KT)

    def heat(self, temperature):
        self.temperature = np.broadcast_to(temperature, self.rock.count)
        self.expansion.act()

    def place(self, positions):
        for i, (x, y) in enumerate(positions.tolist()):
            O.bodies[i].state.pos = (x, y, 0)

    def move(self, along, steps):
        """Move all discs along x, those that are free only at first."""
        for i, shift in enumerate(along.tolist()):
            O.bodies[i].state.vel = (shift / (steps * O.dt), 0, 0)
        self.relax(steps)
        for body in O.bodies:
            body.state.vel = (0, 0, 0)

    def positions(self):
        return np.array([O.bodies[i].state.pos for i in range(self.rock.count)])[:, :2]

    def forces(self):
        """(m, 2) N that the second particle of each bond feels, and (m, 2) m from the first to the second."""
        return (np.array([(i.phys.normalForce + i.phys.shearForce) * (1 if i.id1 == a else -1)
                          for a, i in self._bonds()])[:, :2],
                np.array([O.bodies[i.id2 if i.id1 == a else i.id1].state.pos - O.bodies[a].state.pos
                          for a, i in self._bonds()])[:, :2])

    def _bonds(self):
        return [(a, O.interactions[a, b]) for a, b in self.rock.pairs.tolist()]

    def relax(self, steps):
        base.run(steps)


def packed(**size):
    """A random packing with gaps and overlaps."""
    return Specimen(height=0.03, radius_min=1e-3, radius_max=1.5e-3, porosity=0.12, bonding_gap=1e-4, density=2500,
                    **size)


def lattice(rows, columns):
    return [(D * (k + 0.5 * (row % 2)), 0.5 * math.sqrt(3) * D * row) for row in range(rows) for k in range(columns)]


def free():
    """A packing with gaps and overlaps, heated evenly: bonds feel nothing once it has its new size."""
    rock = packed(width=0.04, seed=1)
    a = Assembly(rock)
    a.heat(10.0)
    a.place(rock.positions * (1 + 10 * ALPHA))
    O.dt = 1e-12
    O.step()
    grown = abs(a.forces()[0]).max()
    a = Assembly(rock, damping=0.4)
    a.heat(10.0)
    a.relax(6000)
    i, j = rock.pairs.T
    lengths = [np.linalg.norm(x[j] - x[i], axis=1) for x in (rock.positions, a.positions())]
    strain = lengths[1] / lengths[0] - 1
    return {"force_of_strength": grown / 1e5, "force_relaxed": abs(a.forces()[0]).max() / (KN * ALPHA * 10 * D),
            "strain": [float(strain.min()), float(strain.max())], "expected": 10 * ALPHA,
            "mass": sum(O.bodies[i].state.mass for i in range(rock.count)), "cold_mass": float(rock.masses.sum())}


def grip(a, kelvin, shortened=0.0):
    """Force (N) with which the two ends of a specimen are fixed, when it is heated, or shortened by that strain."""
    x = a.rock.positions[:, 0]
    left, right = np.flatnonzero(x < x.min() + D), np.flatnonzero(x > x.max() - D)
    for i in (*left, *right):
        O.bodies[int(i)].state.blockedDOFs = "xzXYZ"
    a.heat(kelvin)
    if shortened:
        a.move(-shortened * x, steps=1000)
    a.relax(8000)
    right_of = x[a.rock.pairs] > 0.5 * (x.min() + x.max())
    return (a.forces()[0][:, 0] * (right_of[:, 1] * 1.0 - right_of[:, 0])).sum()


def constrained():
    """A lattice fixed at its ends, sides free: E alpha dtheta. Fixed everywhere: E alpha dtheta/(1 - nu)."""
    rows, kelvin = 7, 10.0
    rock = arranged(lattice(rows, 30))
    # The section over which the lattice's force is a stress: see scripts/laboratory.py.
    section = (rows - 1) * 0.5 * math.sqrt(3) * D + KN * D / E
    uniaxial = grip(Assembly(rock, damping=0.4), kelvin) / section
    rock = packed(width=0.05, seed=2)
    heated = grip(Assembly(rock, damping=0.4), kelvin)
    pressed = grip(Assembly(rock, damping=0.4), 0.0, shortened=kelvin * ALPHA)
    a = Assembly(arranged(lattice(7, 9), fixed=range(63)))
    for part in (0.25, 0.5, 1.0, 0.7, 2.0, 1.0):
        a.heat(part * kelvin)
        a.relax(1)
    force, branch = a.forces()
    middle = [k for k, pair in enumerate(a.rock.pairs) if 31 in pair]
    stress = -0.5 * np.einsum("ki,kj->ij", force[middle], branch[middle]) / (0.5 * math.sqrt(3) * D**2)
    return {"uniaxial": uniaxial, "E_alpha_dT": E * ALPHA * kelvin, "packing_heated": heated,
            "packing_pressed": pressed, "plane": (-stress).tolist(),
            "plane_expected": math.sqrt(3) * KN * ALPHA * kelvin, "work": a.expansion.work,
            "stored": a.bonds.elastic_energy()}


def followed():
    """Two overlapping discs fixed at an opening and heated, then cooled: each law's own force at the same opening."""
    found = {}
    common = dict(kn=KN, kt=KT, Rn=1e5, Rt=1e5, mu=MU)
    laws = {"brittle": ElasticBrittle(**common), "damage": ElasticDamage(H=1e10, **common),
            "plastic": ElastoPlasticSoftening(H=1e10, **common)}
    apart = 0.98 * D
    for name, law in laws.items():
        for opening in (0.0, 2e-6, 8e-6, 40e-6):
            a = Assembly(arranged([(0, 0), (apart, 0)], pairs=[(0, 1)], fixed=(0, 1)), law)
            path, forces = [0.0], [0.0]

            def visit(opened, kelvin):
                a.place(np.array([(0, 0), (apart + opened, 0)]))
                a.heat(kelvin)
                a.relax(1)
                path.append(opened - ALPHA * kelvin * apart)
                forces.append(-a.forces()[0][0, 0])

            for opened in np.linspace(0, opening, 10)[1:]:
                visit(opened, 0.0)
            # Long at 100 K a bond that no longer yields is YADE's again.
            for kelvin in (50, *[100] * (ELASTIC_STEPS + 1), 300, -100, 700, 2500, 300, -100, -500, 0):
                visit(opening, float(kelvin))
            exact = law.drive(np.array(path), np.zeros(len(path)))[0]
            found[f"{name} {opening:g}"] = {"deviation": float(abs(np.array(forces) - exact).max() / law.Rn),
                                            "broken": int(a.bonds.status[0]), "largest": float(max(map(abs, forces)))}
    return found


def heated_disc():
    """A hot disc inside a cold round plate (plane stress, radii a < b): mean stresses over rings."""
    reach, kelvin = 24.5, 10.0
    places = np.array([(x, y) for x, y in lattice(70, 70)])
    places -= places[np.argmin(np.linalg.norm(places - places.mean(axis=0), axis=1))]
    rock = arranged(places[np.linalg.norm(places, axis=1) < reach * D])
    r = np.linalg.norm(rock.positions, axis=1)
    cell, hot = 0.5 * math.sqrt(3) * D**2, r < 8.2 * D
    inner, outer = (math.sqrt(count * cell / math.pi) for count in (hot.sum(), rock.count))
    a = Assembly(rock, damping=0.4)
    a.heat(np.where(hot, kelvin, 0.0))
    a.relax(2000)
    force, branch = a.forces()
    share = -0.5 * np.einsum("ki,kj->kij", force, branch) / cell
    stress = np.zeros((rock.count, 2, 2))
    for side in (0, 1):
        np.add.at(stress, rock.pairs[:, side], share)
    radial = rock.positions / np.maximum(r, 1e-12)[:, None]
    rr = np.einsum("ni,nij,nj->n", radial, stress, radial)
    tt = np.trace(stress, axis1=1, axis2=2) - rr
    scale, rows = E * ALPHA * kelvin, []
    for low, high in ((0, 0.7), (1.3, 1.6), (1.6, 2.0), (2.0, 2.5)):
        ring = (r >= low * inner) & (r < high * inner)
        inside = high < 1
        exact_rr = 0.5 * (inner**2 / outer**2 - (1 if inside else (inner / r[ring])**2)).mean() if not inside else \
            0.5 * (inner**2 / outer**2 - 1)
        exact_tt = exact_rr if inside else 0.5 * (inner**2 / outer**2 + (inner / r[ring])**2).mean()
        rows.append([float(rr[ring].mean() / scale), exact_rr, float(tt[ring].mean() / scale), exact_tt])
    return {"rings": rows}


def two_spinning(period, duration=0.02):
    """Overlap of two fixed discs that rub on each other, after `duration`, and its exact exponential growth.

    Friction heats them, they expand, press more and heat more: d' = r alpha chi mu kn d v / C.
    """
    radius, start, chi, alpha, capacity = 1e-3, 1e-7, 0.85, 1e-4, 2.0
    rock = arranged([(0, 0), (2 * radius - start, 0)], radius, pairs=np.empty((0, 2)), fixed=(0, 1))
    O.reset()
    yade_scene.put_rock_materials(mu=MU)
    yade_scene.put_rock(rock)
    # A shear spring so stiff that it takes up nothing.
    yade_scene.put_loop(rock=ContactLaw(kn=KN, kt=1e5 * KN, mu=MU))
    for body in O.bodies:
        body.mat = O.materials["loose rock"]
    O.dt = 1e-6
    # Both turn the same way, so that their surfaces pass each other.
    for body in O.bodies:
        body.state.angVel = (0, 0, 20.0)
    speed, steps = 2 * 20.0 * radius, round(period / O.dt)
    bonds = Bonds(pairs=rock.pairs, law=UNBREAKABLE, clock=lambda: O.time, period=None)
    motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed)
    friction = RockFriction(bonds=bonds, motion=motion)
    network = HeatNetwork(capacity=np.full(2, capacity), temperature=300.0, edges=NO_PATHS[0], conductance=0.0)
    untouched = SimpleNamespace(take_heating=lambda: (np.empty(0), np.zeros(2), {}))
    heat = Heat(network=network, bonds=bonds, rock_friction=friction, tool_contact=untouched, rock=rock,
                body=body_of_discs(np.empty((0, 2)), radius), heat_fraction=chi, tool_share=0.5,
                contact_conductance=0.0, convection=0.0, ambient=300.0, rock_paths=NO_PATHS, tool_paths=NO_PATHS,
                surface_period=1.0, conduction=False, period=steps)
    expansion = Expansion(coefficient=alpha, rock=rock, reference=300.0, temperature=lambda: network.temperature,
                          bonds=bonds, loose=lambda: friction.contacts, period=steps)
    base.register([])
    base.run(10)
    insert(bonds, friction, heat, expansion)
    base.run(round(duration / O.dt))
    heat.act(), expansion.act()
    if base.failures:
        raise base.failures.pop()
    overlap = sum(expansion.radii) - 2 * radius + start
    rate = radius * alpha * chi * MU * KN * speed / capacity
    return overlap / start, math.exp(rate * duration)


def staggered():
    """Error of the coupled problem against the coupling step."""
    periods = [4e-4, 2e-4, 1e-4, 5e-5]
    runs = [two_spinning(period) for period in periods]
    return {"periods": periods, "grown": [run[0] for run in runs], "exact": runs[0][1]}


def sliding_block():
    """A block of steel discs on a turning stone, under a constant force, there and back and there again."""
    stone, radius, pressed, discs = 0.05, 0.5e-3, 4e-6, 5
    angular_velocity, steps = 2.0, 4000
    angle = math.pi / 2 + 2.2 * radius / (stone + radius) * (np.arange(discs) - (discs - 1) / 2)
    places = (stone + radius - pressed) * np.column_stack([np.cos(angle), np.sin(angle)])
    O.reset()
    yade_scene.put_rock_materials(mu=MU)
    yade_scene.put_tool_material(mu=0.3, contact_damping=0.9)
    rock = arranged([(0, 0)], stone, pairs=np.empty((0, 2)), fixed=(0,))
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=UNBREAKABLE, tool=TOOL)
    O.bodies[0].mat = O.materials["loose rock"]
    bodies = {}
    for index, place in enumerate(places.tolist()):
        body = yade_scene.finite_disc(place, radius, material="steel", mask=yade_scene.TOOL_MASK, mass=0.0, inertia=0.0)
        body.state.blockedDOFs = "xyzXYZ"
        bodies[index] = O.bodies.append(body)
    tool = SimpleNamespace(count=discs, body_of=bodies, ids=list(bodies.values()))
    bonds = Bonds(pairs=rock.pairs, law=UNBREAKABLE, clock=lambda: O.time, period=None)
    motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed)
    friction = RockFriction(bonds=bonds, motion=motion, period=4)
    contact = ToolContact(tool=tool, motion=motion)
    c_rock, c_tool = 5.0, 2.0
    network = HeatNetwork(capacity=np.array([c_rock] + discs * [c_tool]), temperature=300.0, edges=NO_PATHS[0],
                          conductance=0.0)
    e_rock, e_tool = (effusivity(m.conductivity, m.density, m.specific_heat) for m in (SANDSTONE, STEEL))
    share, chi = effusivity_share(e_tool, e_rock), 0.85
    heat = Heat(network=network, bonds=bonds, rock_friction=friction, tool_contact=contact, rock=rock,
                body=body_of_discs(places, radius), heat_fraction=chi, tool_share=share, contact_conductance=0.0,
                convection=0.0, ambient=300.0, rock_paths=NO_PATHS, tool_paths=NO_PATHS, surface_period=1.0,
                conduction=False, period=100)
    O.dt = 1e-8
    insert(bonds, contact, friction, heat)
    kn, kt, load = TOOL.kn, TOOL.kt, 0.0
    slip, turns = 0.0, []
    for sign in (1, -1, 1):
        O.bodies[0].state.angVel = (0, 0, sign * angular_velocity)
        base.run(steps)
        # Each turn first slackens the springs and draws them taut the other way: no heat in those.
        load = max(i.phys.normalForce.norm() for i in O.interactions if i.isReal)
        slip += ((steps * O.dt * angular_velocity * stone - (1 if not turns else 2) * 0.3 * load / kt)
                 * (1 - 0.5 * pressed / stone))  # the surfaces meet where they overlap
        turns.append(O.interactions.countReal())
    heat.act()
    if base.failures:
        raise base.failures.pop()
    exact = chi * 0.3 * kn * pressed * discs * slip
    rise = network.temperature - 300.0
    return {"force": load / (kn * pressed), "tool_heat": float(c_tool * rise[1:].sum()), "tool_exact": share * exact,
            "rock_heat": float(c_rock * rise[0]), "rock_exact": (1 - share) * exact, "slip": slip,
            "all_slip": 3 * steps * O.dt * angular_velocity * stone, "touching": turns,
            "spread": float(np.ptp(rise[1:]) / rise[1:].mean())}


def collisions():
    """A disc thrown askew against a disc of the tool: what it loses, and what the sums of ToolContact have of it."""
    radius, speed, found = 1.2e-3, 4.0, []
    for angle in (20, 45, 70):
        for fraction in (0.8, 0.08):
            O.reset()
            yade_scene.put_rock_materials(mu=MU)
            yade_scene.put_tool_material(mu=0.3, contact_damping=0.9)
            thrown = math.radians(angle)
            rock = arranged([(0, 0)], radius, pairs=np.empty((0, 2)))
            yade_scene.put_rock(rock)
            yade_scene.put_loop(rock=UNBREAKABLE, tool=TOOL)
            O.bodies[0].mat = O.materials["loose rock"]
            O.bodies[0].state.vel = (speed * math.cos(thrown), speed * math.sin(thrown), 0)
            body = yade_scene.finite_disc((1.5 * radius + 1e-6, 0.0), radius / 2, material="steel",
                                          mask=yade_scene.TOOL_MASK, mass=0.0, inertia=0.0)
            body.state.blockedDOFs = "xyzXYZ"
            bodies = {0: O.bodies.append(body)}
            tool = SimpleNamespace(count=1, body_of=bodies, ids=list(bodies.values()))
            motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed)
            contact = ToolContact(tool=tool, motion=motion)
            O.dt = fraction * 2 / math.sqrt(2 * TOOL.kn / rock.masses[0]) * (math.sqrt(1 + 0.81) - 0.9)
            insert(contact)
            state = O.bodies[0].state

            def kinetic():
                return 0.5 * (rock.masses[0] * state.vel.squaredNorm() + rock.inertias[0] * state.angVel.squaredNorm())

            before = kinetic()
            base.run(int(60 / fraction))
            law = law_functor(Law2_ScGeom_FrictViscoPhys_CundallStrackVisco)
            found.append({"angle": angle, "fraction": fraction, "lost": before - kinetic(),
                          "friction": contact.friction, "dashpot": contact.dashpot_dissipated,
                          "yade": law.plasticDissipation(), "parted": O.interactions.countReal() == 0})
    return found


CHECKS = {check.__name__: check for check in (free, constrained, followed, heated_disc, staggered, sliding_block,
                                              collisions)}
*wanted, file = sys.argv[1:]
with open(file, "w", encoding="utf-8") as stream:
    json.dump({name: CHECKS[name]() for name in wanted}, stream)
sys.stdout.flush()
os._exit(0)

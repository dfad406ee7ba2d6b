"""Hard cases of the bond laws in YADE; writes {check: {case: numbers}} to the file named last.

A lattice of discs is torn, sheared or crushed by its own velocity; discs of a breaking lattice are erased; a bond is
driven around its peak.
"""
import json
import math
import os
import sys
from types import SimpleNamespace
from unittest import mock

import numpy as np
from yade import O, utils

from rockwear.engines import base
from rockwear.scenes import yade_scene
from rockwear.engines.bonds import BROKEN, SEPARATED, INTACT, Bonds
from rockwear.engines.bonding_normals import BondingNormals
from rockwear.engines.separation import Separation
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.shear_rotation import ShearRotation
from rockwear.kernels.bond_laws import Cohesive, Coulomb, ElasticBrittle, ElasticDamage, ElastoPlasticSoftening
from rockwear.kernels.packing import contacts
from rockwear.model.contact import ContactLaw
from rockwear.scenes.two_disc import drive_pair
from yade_loop import insert

KN, KT, RN, RT, MU = 2e10, 1e10, 1e5, 6e4, 0.8
SPRING = dict(kn=KN, kt=KT, mu=MU)
LAWS = {"brittle": ElasticBrittle(Rn=RN, Rt=RT, **SPRING)}
for name, kind in (("damage", ElasticDamage), ("plastic", ElastoPlasticSoftening)):
    LAWS |= {name: kind(Rn=RN, Rt=RT, H=1e10, **SPRING),
             f"{name}, nearly vertical": kind(Rn=RN, Rt=RT, H=1e4 * KN, **SPRING),
             f"{name}, weak in shear": kind(Rn=RN, Rt=1e-3 * RN, H=1e10, **SPRING),
             f"{name}, weak in tension": kind(Rn=1e-3 * RN, Rt=RN, H=1e10, **SPRING)}
AREA = dict(bond_tension=RN, bond_cohesion=2 * RT, **SPRING)
LAWS["coulomb"] = Coulomb(**AREA)
SPUN = {"brittle": ElasticBrittle(kn=1.5e6, kt=1.5e6, mu=MU, Rn=1e6, Rt=1e6),
        "cohesive": Cohesive(kn=1.5e6, kt=1.5e6, mu=MU, bond_tension=1e6, bond_cohesion=1e6, bond_fracture_energy=1e6)}
SOFT = {"cohesive": Cohesive(bond_fracture_energy=0.75, **AREA),
        "cohesive, nearly vertical": Cohesive(bond_fracture_energy=0.26, **AREA),
        "cohesive, weak in shear": Cohesive(bond_fracture_energy=0.75, **{**AREA, "bond_cohesion": 1e-3 * RN})}
"""Laws that YADE's concrete model carries."""
RADIUS, ROWS, COLUMNS = 1e-3, 8, 9
TIME_STEP = 1e-7
RATE = 0.2
"""First step over the displacement of the peak: fast enough to break most of a lattice."""
TEAR, SHEAR, CRUSH = np.diag([1.0, 1.0]), np.array([[0.0, 1.0], [0.0, 0.0]]), np.diag([-1.0, 1.0])
SQUEEZE = np.array([[-1.2e5, -8e4], [4e4, 6e4]])


def lattice():
    """A triangular one, in the form that yade_scene.put_rock takes."""
    places = np.array([(2 * RADIUS * column + RADIUS * (row % 2), math.sqrt(3) * RADIUS * row)
                       for row in range(ROWS) for column in range(COLUMNS)])
    count = len(places)
    masses = np.full(count, 2500 * math.pi * RADIUS**2)
    return SimpleNamespace(count=count, positions=places, radii=np.full(count, RADIUS), masses=masses,
                           inertias=0.5 * masses * RADIUS**2, fixed=np.zeros(count, bool),
                           side=np.zeros(count, int),
                           pairs=contacts(places, np.full(count, RADIUS), 1e-6 * RADIUS))


def bonded(rock, law, looks=1, **loop):
    """`rock` alone in a new loop, all its pairs bonded. -> its engine of bonds, visited every `looks` steps."""
    rock.places, rock.bonded = rock.positions, np.ones(len(rock.pairs), bool)
    O.reset()
    yade_scene.put_rock_materials(mu=law.mu, yade_law=law.yade_law)
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=law, **loop)
    bonds = yade_scene.CARRIERS[law.yade_law](pairs=rock.pairs, law=law, clock=lambda: O.time, period=looks)
    yade_scene.make_bonds(rock, bonds)
    return bonds


def moving_lattice(law, gradient, *first, ratcheting_free=True, looks=1):
    """Bonded rock with a linear field of velocity (1/s), free at its edges; engines `first` are visited before all.
    -> its engine of bonds, and a function that gives the energy that only the balance holds (J)."""
    rock = lattice()
    bonds = bonded(rock, law, looks, ratcheting_free=ratcheting_free)
    increment = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed)
    friction = RockFriction(bonds=bonds, motion=increment)
    for i, (x, y) in enumerate((rock.positions - rock.positions.mean(axis=0)) @ np.transpose(gradient)):
        O.bodies[i].state.vel = (x, y, 0.0)
    O.dt = TIME_STEP
    insert(*first, bonds, friction, Separation(bonds, period=50))

    def energy():
        return (utils.kineticEnergy() + bonds.elastic_energy() + friction.elastic_energy() + bonds.energy_released
                + friction.total)
    return bonds, energy


def run(steps):
    base.run(steps)


def fastest():
    return max(body.state.vel.norm() for body in O.bodies if body)


def torn(law, gradient, rate, steps, finer=1, **looks):
    """A lattice whose motion breaks most bonds. rate: how often the displacement of the peak fits into the first step,
    where kn = kt and Rn = Rt; finer: in how many steps a step is divided."""
    # In shear a bond of YADE's concrete model slips, and does not break.
    peaks = [law.Rn / law.kn, *([] if law.yade_law == "Cpm" else [law.Rt / law.kt])]
    per_step = rate * min(peaks) / (2 * RADIUS)
    bonds, energy = moving_lattice(law, per_step / TIME_STEP * gradient, **looks)
    O.dt /= finer
    before, speed = energy(), fastest()
    kicks, most = [], 0
    for _ in range(10):
        broken = len(bonds.cracks)
        run(max(1, finer * steps // 10))
        most = max(most, len(bonds.cracks) - broken)
        kicks.append(fastest() / speed)
    return {"residual": (energy() - before) / before, "broken": len(bonds.cracks) / len(bonds.pairs),
            "at once": most, "kick": max(kicks), "least crack": min(crack.energy for crack in bonds.cracks),
            "finite": bool(np.isfinite([body.state.pos for body in O.bodies]).all()), "first": bonds.cracks[0].time}


def slipped(gradient, every_bond):
    """Work of slip in a lattice whose bonds are looked at now and then, over its energy at first, and its motion then:
    with every bond sampled or those that move alone."""
    peak = SOFT["cohesive"].Rn / SOFT["cohesive"].kn
    bonds, energy = moving_lattice(SOFT["cohesive"], RATE * peak / (2 * RADIUS * TIME_STEP) * gradient, looks=10)
    bonds.every_bond = every_bond
    O.dt /= 8
    before = energy()
    run(2400)
    return float(bonds.by_slip.sum()) / before, utils.kineticEnergy()


class Eraser(base.Engine):
    """Erases a disc at certain steps, from within the loop and before the bonds are visited."""

    name = "eraser"
    phase = base.FORCES

    def __init__(self, discs):
        super().__init__()
        self.discs = dict(discs)

    def act(self):
        for disc in self.discs.pop(O.iter - self.first, []):
            O.bodies.erase(disc)

    def connect(self):
        self.first = O.iter


def numbers(bonds, group):
    """Those of a group of bonds."""
    if isinstance(bonds, Bonds):
        return set(getattr(bonds, group))
    return set(np.flatnonzero((bonds.active == (group == "active")) & (bonds.status != SEPARATED)))


def erased(law):
    """Discs erased while their bonds soften, break, and slide; afterwards no energy is lost or found."""
    middle = ROWS // 2 * COLUMNS
    at = {step: [disc] for step, disc in zip(range(20, 20 * 12, 20), range(middle, middle + 11))}
    bonds, energy = moving_lattice(law, RATE * RN / KN / (2 * RADIUS * TIME_STEP) * (SHEAR + 0.2 * TEAR), Eraser(at))
    groups = ("active", "quiet") if law.yade_law == "Cpm" else ("elastic", "softening_bonds", "returned", "broken")
    seen = dict.fromkeys(groups, 0)
    for step in range(240):
        fixed = {name: numbers(bonds, name) for name in seen}
        discs = set(range(len(O.bodies))) - {body.id for body in O.bodies if body}
        run(1)
        new = {i for i in range(len(O.bodies)) if O.bodies[i] is None} - discs
        for name in seen:
            seen[name] += sum(bool(new & set(bonds.pairs[n])) for n in fixed[name])
    # By hand, between two steps.
    O.bodies.erase(0)
    bonds.erase_separated()
    gone = [i for i in range(len(O.bodies)) if O.bodies[i] is None]
    touching = np.isin(bonds.pairs, gone).any(axis=1)
    before = energy()
    run(500)
    return {"erased": len(gone), "seen": seen, "all gone": bool((bonds.status[touching] == SEPARATED).all()),
            "others alive": int((bonds.status[~touching] == INTACT).sum()), "cracks": len(bonds.cracks),
            "broken": int((bonds.status == BROKEN).sum()), "residual": (energy() - before) / before,
            "left over": sum(n in numbers(bonds, name) for n in np.flatnonzero(touching)
                             for name in groups)}


def cycled(law, seed=4, legs=60):
    """A bond driven to and fro around its peak: deviation from the law, and how often it returned to YADE's law."""
    rng = np.random.default_rng(seed)
    returns = [0]
    return_to_yade = Bonds._return_to_yade

    def counting(self, n, softening):
        returns[0] += 1
        return_to_yade(self, n, softening)

    corners = rng.uniform([-0.3, -1.5], [1.0, 1.5], (legs, 2)) * np.linspace(0.6, 1.6, legs)[:, None]
    corners = np.vstack([[0.0, 0.0], corners]) * [law.Rn / law.kn, law.Rt / law.kt]
    path = np.vstack([a + (b - a) * np.linspace(0, 1, 30, endpoint=False)[:, None]
                      for a, b in zip(corners, corners[1:])])
    with mock.patch.object(Bonds, "_return_to_yade", counting):
        response = drive_pair(law, *path.T, radii=(1e-3, 1.6e-3))
    Fn, Ft = law.drive(response.un, response.ut[:, 0])
    deviation = max(abs(Fn - response.Fn).max(), abs(Ft - response.Ft[:, 0]).max()) / max(law.Rn, law.Rt)
    return {"deviation": float(deviation), "returns": returns[0]}


def cycled_without_new_normals():
    """The same, the engine broken on purpose: after a return to YADE's law the shear force forgets what has slipped."""
    with mock.patch.object(BondingNormals, "set_elastic", lambda self, n, interaction: None):
        return cycled(LAWS["plastic"])["deviation"]


def rolled(law):
    """A chip of two discs, joined by one bond, that roll on each other like wheels and are then torn apart.
    -> energy of the crack over that of a bond at its strength."""
    radii = np.array([1.0, 1.3]) * RADIUS
    masses = 2500 * math.pi * radii**2
    rock = SimpleNamespace(count=2, positions=np.array([(0.0, 0.0), (radii.sum(), 0.0)]), radii=radii, masses=masses,
                           inertias=0.5 * masses * radii**2, fixed=np.zeros(2, bool), side=np.zeros(2, int),
                           pairs=np.array([(0, 1)]))
    bonds = bonded(rock, law)
    O.dt, speed = TIME_STEP, 2 * math.pi * 3 / (3000 * TIME_STEP)
    insert(bonds)
    for body, sign in ((0, 1), (1, -1)):
        O.bodies[body].state.angVel = (0, 0, sign * speed * radii[0] / radii[body])
    run(3000)
    O.dt /= 50
    O.bodies[1].state.vel = (20.0, 0.0, 0.0)
    run(2000)
    return [crack.energy / (0.5 * law.Rn**2 / law.kn) for crack in bonds.cracks]


def squeezed(ratcheting_free, finer=1):
    """Unbreakable bonds that are pressed and sheared by a quarter of a disc, and swing on without damping.
    -> (largest overlap over the diameter, energy gained over that put in)."""
    law = ElasticBrittle(Rn=1e12, Rt=1e12, **SPRING)
    _, energy = moving_lattice(law, SQUEEZE, ratcheting_free=ratcheting_free)
    O.dt = 0.1 * TIME_STEP / finer
    put_in, deepest = energy(), 0.0
    for _ in range(100):
        run(200 * finer)
        deepest = max(deepest, max(i.geom.penetrationDepth for i in O.interactions) / (2 * RADIUS))
    return deepest, energy() / put_in - 1


def soft(seed):
    """A lattice whose bonds stretch by a twentieth of a disc before they break, squeezed and sheared until most have.
    -> share of broken bonds, residual of the energy over that put in."""
    law = ElasticBrittle(Rn=1e6, Rt=1e7, **SPRING)
    bonds, energy = moving_lattice(law, SQUEEZE, ratcheting_free=False)
    chance = np.random.default_rng(seed)
    for body in O.bodies:
        body.state.vel += (*chance.normal(0, 20, 2), 0.0)
    O.dt = 0.3 * TIME_STEP
    before = energy()
    run(1500)
    return len(bonds.cracks) / len(bonds.pairs), (energy() - before) / before


def chip(places, radius, density):
    """Free spheres that overlap, in the form that yade_scene.put_rock takes."""
    count = len(places)
    masses = np.full(count, density * 4 / 3 * math.pi * radius**3)
    return SimpleNamespace(count=count, positions=places, radii=np.full(count, radius), masses=masses,
                           inertias=0.4 * masses * radius**2, fixed=np.zeros(count, bool), side=np.zeros(count, int),
                           pairs=contacts(places, np.full(count, radius), 0.0))


def spinning(corrected, law):
    """A chip of four spheres, pressed together and bonded so, that spins about a slanting axis and swings undamped, as
    soft and fast as in [Rojek 2003, ch. 13]. -> energy gained over that put in, after 20 ms; whether all bonds are
    there."""
    radius, angular_velocity, step = 13.5e-3, np.array([900.0, 1000.0, 1500.0]), 3e-5
    places = 0.95 * radius / math.sqrt(2) * np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    rock = chip(places, radius, density=2500)
    bonds = bonded(rock, law, ratcheting_free=False)
    chance = np.random.default_rng(1)
    for body, place in zip(O.bodies, places):
        body.state.vel = tuple(np.cross(angular_velocity, place) + chance.normal(0, 0.5, 3))
        body.state.angVel = tuple(angular_velocity + chance.normal(0, 20, 3))
    insert(*([ShearRotation(bonds=bonds, radii=rock.radii)] if corrected else []), bonds)
    O.dt = step

    def energy():
        return utils.kineticEnergy() + bonds.elastic_energy()
    put_in = energy()
    run(round(0.02 / step))
    return energy() / put_in - 1, bool((bonds.status == INTACT).all())


def in_flight(corrected, spin):
    """Two spheres of 0.9 mm, bonded, that spin (rad/s) and roll on each other in flight, in steps and with springs of a
    groove in sandstone. -> energy gained over that put in, after 1 ms."""
    radius = 9e-4
    places = radius * np.array([(-0.999, 0, 0), (0.999, 0, 0)])
    rock = chip(places, radius, density=2600)
    law = Cohesive(kn=1.85e7, kt=2.86e6, mu=MU, bond_tension=1e6, bond_cohesion=1e6, bond_fracture_energy=1e5)
    bonds = bonded(rock, law, looks=10, ratcheting_free=False)
    angular_velocity, chance = spin * np.array([0.5, 0.6, 0.62]), np.random.default_rng(1)
    for body, place in zip(O.bodies, places):
        body.state.vel = tuple(np.cross(angular_velocity, place))
        body.state.angVel = tuple(angular_velocity + chance.normal(0, 0.3 * spin, 3))
    insert(*([ShearRotation(bonds=bonds, radii=rock.radii)] if corrected else []), bonds)
    O.dt = 2.75e-7

    def energy():
        return utils.kineticEnergy() + bonds.elastic_energy() + bonds.energy_released
    put_in = energy()
    run(round(1e-3 / O.dt))
    return energy() / put_in - 1


def glancing(known):
    """A spinning disc glances off one that is held. known: whether samples of friction take that one for fixed all
    along. -> J of friction."""
    there = [0, COLUMNS]
    rock = SimpleNamespace(count=2, pairs=np.empty((0, 2), int), **{
        name: values[there] for name, values in vars(lattice()).items() if name not in ("count", "pairs")})
    rock.places = rock.positions
    O.reset()
    yade_scene.put_rock_materials(mu=MU)
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=ContactLaw(**SPRING))
    for body in O.bodies:
        body.mat = O.materials["loose rock"]
    bonds = Bonds(pairs=rock.pairs, law=LAWS["brittle"], clock=lambda: O.time, period=None)
    motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii,
                               fixed=np.array([known, False]))
    friction = RockFriction(bonds=bonds, motion=motion)
    O.bodies[0].state.blockedDOFs = "xyzXYZ"
    O.bodies[1].state.vel, O.bodies[1].state.angVel = (-2.0, -20.0, 0.0), (0.0, 0.0, 2e4)
    O.dt = 0.2 * TIME_STEP
    insert(friction)
    run(400)
    return friction.total


THREE = ["brittle", "damage", "plastic"]
checks = {
    "torn in one step": {name: torn(law, TEAR, 3e4, 10) for name, law in LAWS.items()},
    "torn in a few steps": {name: torn(law, TEAR, 1.0, 40) for name, law in LAWS.items()},
    "sheared": {name: torn(law, SHEAR, RATE, 300) for name, law in LAWS.items()},
    "crushed": {name: torn(law, CRUSH, RATE, 300) for name, law in LAWS.items()},
    "crushed in finer steps": {name: torn(LAWS[name], CRUSH, RATE, 100, finer=8) for name in THREE},
    "erased": {name: erased(law) for name, law in {**{name: LAWS[name] for name in THREE}, **SOFT}.items()},
    "carried in C++": {
        name: {"torn in one step": torn(law, TEAR, 3e4, 10), "torn in a few steps": torn(law, TEAR, 1.0, 40),
               "sheared": torn(law, SHEAR, RATE, 300), "crushed": torn(law, CRUSH, RATE, 300),
               "crushed in finer steps": torn(law, CRUSH, RATE, 100, finer=8)} for name, law in SOFT.items()},
    "looks ten steps apart": {name: torn(SOFT["cohesive"], gradient, RATE, 300, finer=8, looks=10)
                              for name, gradient in (("sheared", SHEAR), ("crushed", CRUSH), ("torn", TEAR))},
    "slipped": {name: [slipped(gradient, every_bond) for every_bond in (True, False)]
                for name, gradient in (("sheared", SHEAR), ("crushed", CRUSH))},
    "time step": TIME_STEP,
    "brittle limit": {law.name: torn(law, TEAR, 0.1, 400)
                      for law in (LAWS["coulomb"], Cohesive(bond_fracture_energy=1e-6, **AREA))},
    "cycled": {name: cycled(law) for name, law in LAWS.items()},
    "squeezed": {"by full radii": squeezed(True), "as contacts move": squeezed(False),
                 "as contacts move, half the step": squeezed(False, 2)},
    "spinning": {name: {"by YADE's rule": spinning(False, law), "corrected": spinning(True, law)}
                 for name, law in SPUN.items()},
    "in flight": [(in_flight(False, spin), in_flight(True, spin)) for spin in (2e4, 8e4)],
    "soft": [soft(seed) for seed in (1, 2)],
    "glancing": {"fixed": glancing(True), "held": glancing(False)},
    "rolled": {name: rolled(LAWS[name]) for name in THREE},
    "cycled without new normals": cycled_without_new_normals(),
}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file, indent=1)
sys.stdout.flush()
os._exit(0)

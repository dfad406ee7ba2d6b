"""Two particles in YADE against the bond laws themselves; writes {check: {case: number}} to the file named last."""
import json
import os
import sys
from unittest import mock

import numpy as np
from yade import O, Vector3, utils

from rockwear.engines import base
from rockwear.engines.bonding_normals import BondingNormals
from rockwear.engines.bonds import Bonds
from rockwear.engines.cpm_bonds import CpmBonds
from rockwear.engines.softening import SofteningBond
from rockwear.kernels.bond_laws import (
    Cohesive, Coulomb, ElasticBrittle, ElasticDamage, ElastoPlasticSoftening, NonlinearElastoPlastic, Parabolic)
from rockwear.scenes.yade_scene import CARRIERS
from rockwear.scenes.two_disc import drive_pair, programme

KN, KT, RN, RT, H, MU = 2e10, 1e10, 1e5, 6e4, 1e10, 0.839
COMMON = dict(kn=KN, kt=KT, Rn=RN, Rt=RT, mu=MU)
LAWS = {"brittle": ElasticBrittle(**COMMON), "damage": ElasticDamage(H=H, **COMMON),
        "damage by tension only": ElasticDamage(H=H, tension_only=True, **COMMON),
        "elasto-plastic": ElastoPlasticSoftening(H=H, **COMMON), "Padova": NonlinearElastoPlastic(),
        "Padova, denting": NonlinearElastoPlastic(Rc=1e5, compression=Parabolic(b2=3e9))}
AREA = dict(kn=KN, kt=KT, bond_tension=RN, bond_cohesion=2 * RT, mu=0.5)
LAWS |= {"Coulomb": Coulomb(**AREA), "cohesive": Cohesive(bond_fracture_energy=0.75, **AREA)}
SLIPPING, HALF_SLIPPED = (Cohesive(bond_fracture_energy=0.75, bond_shear_energy=G, **AREA) for G in (3.6, 36.0))
WIDE = Cohesive(bond_fracture_energy=75.0, bond_shear_energy=360.0, **AREA)
"""Opens by 1.2 radii before it is gone: bonds of fine discs do."""
LASTING = Cohesive(bond_fracture_energy=7.5, **AREA)
"""Carries tension long after it has no shear strength left, which comes back when it closes."""
CRUSHING = Cohesive(bond_fracture_energy=0.75, bond_crushing=1.5 * RN, crushing_hardening=0.0, **AREA)
HARDENING = Cohesive(bond_fracture_energy=0.75, bond_crushing=1.5 * RN, crushing_hardening=0.25, **AREA)
LAWS["crushing"] = CRUSHING
LINEAR = [*list(LAWS)[:4], "Coulomb"]
END_N, END_T = RN / KN + RN / H, RT / KT + RT / H


def follow(law, un, ut):
    """(n, 3) forces of the law itself along a path with two tangential components; (n,) whether the bond is broken."""
    bond, rows, broken = law.initial_state(), [], []
    for opening, shift in zip(un.tolist(), ut.tolist()):
        Fn, Ft = law.respond(bond, opening, tuple(shift))
        rows.append((Fn, *Ft))
        broken.append(bond.broken)
    return np.array(rows), np.array(broken)


def forces(response):
    return np.column_stack([response.Fn, response.Ft])


def deviation(law, response):
    """Largest difference between YADE's force and the law's at the same displacements, over the strength.

    A bond of YADE's concrete model is followed to its end: its particles then meet as any others do, by their radii.
    The step in which a crushed one breaks does not count, for the look that notices comes after it.
    """
    exact, broken = follow(law, response.un, response.ut)
    kept = np.ones(len(exact), bool)
    if law.yade_law == "Cpm":
        gone = np.flatnonzero(broken & (response.un > 0.0))
        kept[gone[0] + 1 if len(gone) else len(kept):] = False
        if law is CRUSHING:
            kept[np.flatnonzero(broken)[:1]] = False
    return float(abs(forces(response) - exact)[kept].max() / law.Rn)


def random_path(rng, legs=8, steps=40):
    """Straight legs between random points, of which some are far outside the strength; two tangential directions."""
    corners = rng.normal(size=(legs, 3)) * rng.choice([0.5, 2.0, 6.0], size=(legs, 1)) * RN / KN
    corners[:, 0] += rng.choice([-2.0, 0.0, 1.0]) * RN / KN
    corners = np.vstack([np.zeros(3), corners])
    path = np.vstack([start + (end - start) * np.linspace(0.0, 1.0, steps, endpoint=False)[:, None]
                      for start, end in zip(corners, corners[1:])])
    return path[:, 0], path[:, 1:]


def random_axes(rng):
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return axes


def set_free(bonds):
    """Drive the pair no longer."""
    O.engines = [*O.engines[:3], O.engines[-1]]
    base.register([bonds])
    base.insert([bonds])


def programmes(law):
    return {kind: deviation(law, drive_pair(law, un, ut))
            for kind, (un, ut) in programme(law, END_N, END_T, 203).items()}


def random_paths(law, plane, seeds=range(8)):
    """Worst deviation on random paths, in the plane or in space, between unequal particles, ids in both orders."""
    worst = 0.0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        un, ut = random_path(rng)
        if plane:
            ut[:, 1] = 0.0
        axes = None if plane else random_axes(rng)
        response = drive_pair(law, un, ut, radii=(1e-3, 1.7e-3), axes=axes, swapped=bool(seed % 2))
        worst = max(worst, deviation(law, response))
    return worst


def swapping(law):
    """Difference that the order of the ids makes."""
    un, ut = random_path(np.random.default_rng(1))
    a, b = (forces(drive_pair(law, un, ut, radii=(1e-3, 1.7e-3), swapped=swapped)) for swapped in (False, True))
    return float(abs(a - b).max() / law.Rn)


def turning(law, steps=1000):
    """Difference that a rigid rotation of the pair by a radian makes, away from jumps of the force.

    YADE takes the velocity of the middle of a step with the normal of its end, so that some of it is of its own making.
    """
    worst = 0.0
    for un, ut in [*programme(law, END_N, END_T, steps).values()][2:]:
        ut = np.column_stack([0.6 * ut, 0.8 * ut])
        still = forces(drive_pair(law, un, ut))
        for axis in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
            turned = forces(drive_pair(law, un, ut, spin=np.array(axis) / steps))
            difference = np.sort(abs(still - turned).max(axis=1))
            worst = max(worst, float(difference[-3]) / law.Rn)
    return worst


def looked_at_now_and_then(law, period, radian=0.1, steps=2000):
    """Error of the force of a slipping pair that rotates by a tenth of a radian, and of the energy: looks every
    `period` steps."""
    ut = np.linspace(0.0, 40e-6, steps)
    path = -ut / 20, np.column_stack([0.6 * ut, 0.8 * ut])
    turned = drive_pair(law, *path, spin=np.array((0.6, 0.0, 0.8)) * radian / steps, period=period)
    bonds, exact = turned.bonds, follow(law, turned.un, turned.ut)[0]
    work = np.sum(0.5 * (exact[1:] + exact[:-1]) * np.diff(np.column_stack([turned.un, turned.ut]), axis=0))
    error = float(abs(forces(turned) - exact).max() / law.Rn)
    return {"force": error, "energy": float((bonds.elastic_energy() + bonds.energy_released) / work - 1)}


def without_realigning(law):
    """The same where no look turns the slip of a bond: YADE's own error."""
    with mock.patch.object(CpmBonds, "act", lambda self: None):
        return looked_at_now_and_then(law, 1)["force"]


def closed_again(law, period, wide=0.3):
    """Error of the force of a bond that slides open with little or no shear strength, and closes while nobody looks.
    wide: its opening over that at which it is gone."""
    knots = [0, 800, 995, 997, 1205, 1207, 1300]
    un = np.interp(np.arange(knots[-1]), knots, np.array([0.0, wide, wide, -0.02, wide - 0.05, -0.02, 0.1]) * law.gone)
    ut = np.interp(np.arange(knots[-1]), [0, 800, 1300], np.array([0.0, 0.0, 0.4]) * law.gone)
    return deviation(law, drive_pair(law, un, np.column_stack([ut, 0.5 * ut]), period=period))


def coulomb_afterwards(law):
    """A broken bond under YADE alone: Python holds no bond, and the force is that of a Coulomb contact."""
    rng = np.random.default_rng(3)
    un, ut = random_path(rng)
    un, ut = np.concatenate([[0.0, 2 * END_N], un - 2e-6]), np.vstack([np.zeros((2, 2)), ut])
    response = drive_pair(law, un, ut, axes=random_axes(rng))
    Fn, Ft = np.minimum(law.kn * response.un, 0.0), np.zeros(2)
    worst, before = 0.0, response.ut[1]
    for k in range(2, len(un)):
        Ft = Ft + law.kt * (response.ut[k] - before)
        before, limit = response.ut[k], law.mu * abs(Fn[k])
        Ft = Ft * min(1.0, limit / (np.linalg.norm(Ft) or 1.0))
        worst = max(worst, abs(response.Fn[k] - Fn[k]), abs(response.Ft[k] - Ft).max())
    return {"deviation": float(worst / law.Rn), "softening_bonds": len(response.bonds.softening_bonds),
            "slides": int(np.sum(Fn < 0))}


def work_until_gone(law):
    """Energy released, and the work until a bond is gone, in tension and in shear."""
    exact = law.fracture_energy()
    if law.yade_law == "Cpm":
        response = drive_pair(law, *programme(law, END_N, END_T, 2003)["tension, unloading and reloading"], period=7)
        crack, = response.bonds.cracks
        return {"tension": crack.energy / exact[0] - 1, "mode": crack.mode,
                "missing": response.bonds.energy_released - crack.energy}
    found = []
    for kind in ("tension, unloading and reloading", "shear"):
        response = drive_pair(law, *programme(law, END_N, END_T, 2003)[kind])
        crack, = response.bonds.cracks
        found.append((crack.energy, crack.mode, response.bonds.energy_released - crack.energy))
    return {"tension": found[0][0] / exact[0] - 1, "shear": found[1][0] / exact[1] - 1,
            "modes": [found[0][1], found[1][1]], "missing": max(abs(rest) for *_, rest in found)}


def slip_by_particle(law):
    """What a slipping bond gives its two particles, over its work of slip; what is left for a second call (J)."""
    # It stands still in the end: YADE makes a step more than it is driven.
    ut = np.append(np.linspace(0.0, 40e-6, 400), 40e-6)
    response = drive_pair(law, 0.0 * ut, np.column_stack([ut, 0.0 * ut]))
    bonds = response.bonds
    halves, work = bonds.take_slip_work(2), bonds.energy_released
    return {"halves": (halves / work).tolist(), "work": work, "left": float(abs(bonds.take_slip_work(2)).max()),
            "exact": law.Rt * (response.ut[-1, 0] - law.Rt / law.kt)}


def damaged_by_slip(law, steps, period):
    """A pair under pressure that shears forth, back and forth, until slip has broken it.

    -> errors of the force, over the strength, and of the energy released; what is left of the pair.
    """
    corners = np.array([0.0, 0.6, 0.2, 1.4]) * law.slip_end
    way = np.concatenate([[0.0], np.cumsum(abs(np.diff(corners)))])
    ut, un = np.interp(np.linspace(0.0, way[-1], steps), way, corners), np.full(steps, -1e-6)
    un[0] = 0.0
    response = drive_pair(law, un, ut, period=period)
    bonds, (exact, _) = response.bonds, follow(law, response.un, response.ut)
    path = np.column_stack([response.un, response.ut])
    work = np.sum(0.5 * (exact[1:] + exact[:-1]) * np.diff(path, axis=0))
    crack, = bonds.cracks
    energy = bonds.elastic_energy() + bonds.energy_released
    return {"force": float(abs(forces(response) - exact).max() / law.Rn), "energy": float(energy / work - 1),
            "mode": crack.mode, "status": int(bonds.status[0]), "presses": bool(bonds.in_contact()[0])}


def damaged_both_ways(law, steps, period):
    """A pair that opens halfway to its end and shears there until slip has broken it.

    -> errors of the force, over the strength, and of the energy released; the work of slip, over the shear energy.
    """
    way = np.linspace(0.0, 2.5, steps)
    un, ut = np.clip(way, 0.0, 0.5) * law.gone, np.clip(way - 0.5, 0.0, None) * law.slip_end
    response = drive_pair(law, un, ut, period=period)
    bonds, (exact, _) = response.bonds, follow(law, response.un, response.ut)
    path = np.column_stack([response.un, response.ut])
    work = np.sum(0.5 * (exact[1:] + exact[:-1]) * np.diff(path, axis=0))
    energy = bonds.elastic_energy() + bonds.energy_released
    return {"force": float(np.mean(abs(forces(response) - exact)) / law.Rn), "energy": float(energy / work - 1),
            "by slip": float(bonds.by_slip[0] / law.fracture_energy()[1]), "status": int(bonds.status[0]),
            "presses": bool(bonds.in_contact()[0])}


def crushed(law, period, steps=4000):
    """A pair that is crushed, pulled apart until it breaks and crushed again while it shears, twice.

    -> errors of the force, over the strength, and of all energy but shear's; how much shorter it is than the law says.
    """
    corners = np.array([0.0, -20e-6, -20e-6 + 1.2 * law.gone, -30e-6, -5e-6, -40e-6])
    way = np.concatenate([[0.0], np.cumsum(abs(np.diff(corners)))])
    un = np.interp(np.linspace(0.0, way[-1], steps), way, corners)
    ut = np.where(np.linspace(0.0, way[-1], steps) > way[2], np.linspace(-10e-6, 20e-6, steps), 0.0)
    response = drive_pair(law, un, np.maximum(ut, 0.0), period=period)
    bonds, (exact, _) = response.bonds, follow(law, response.un, response.ut)
    path = np.column_stack([response.un, response.ut])
    work = np.sum(0.5 * (exact[1:] + exact[:-1]) * np.diff(path, axis=0))
    energy = bonds.elastic_energy() + bonds.energy_released
    return {"force": float(np.mean(abs(forces(response) - exact)) / law.Rn), "energy": float(energy / work - 1),
            "crushed": float(bonds.energy_crushed / _crushing_work(law, 40e-6) - 1),
            "status": int(bonds.status[0]), "cracks": len(bonds.cracks)}


def _crushing_work(law, shortened):
    """J of a pair that is nearer by so much (m), once all else has relaxed."""
    stays = (shortened - law.Rc / law.kn) / (1 + law.hardening)
    return stays * (law.Rc + 0.5 * law.hardening * law.kn * stays)


def slipping_wide_open(law, period, steps=4000, radius=1.25e-3):
    """A pair that opens by 0.6 of its radius and is rolled there until slip has broken it.

    -> energy that is in no balance, over the work done; what it would be if forces had worked over YADE's increments.
    """
    way = np.linspace(0.0, 2.0, steps)
    un, ut = np.clip(way, 0.0, 0.5) * law.gone, np.clip(way - 0.5, 0.0, None) * law.slip_end
    response = drive_pair(law, un, ut, radii=(radius, radius), period=period)
    bonds, force = response.bonds, forces(response)
    mean = 0.5 * (force[1:] + force[:-1])
    # The torque about the particle that is rolled has its arm from there to the middle of the gap.
    arm = 1.0 + 0.5 * response.un[1:, None] / radius
    opening, shear = (np.sum(part) for part in (mean[:, 0] * np.diff(response.un), mean[:, 1:] * np.diff(
        response.ut, axis=0) * arm))
    measured = np.sum(mean[:, 1:] * np.diff(response.ut, axis=0))
    work = opening + shear
    energy = bonds.elastic_energy() + bonds.energy_released
    return {"residual": float(1 - energy / work), "by increments": float((shear - measured) / work),
            "status": int(bonds.status[0])}


def flying_apart(law, period=1, later=0):
    """A free pair driven apart, turning and shearing: energy that is in no balance, over the energy released. later:
    steps by which the motion begins later between two looks."""
    bonds = drive_pair(law, np.zeros(2 + later), np.zeros(2 + later), period=period).bonds
    set_free(bonds)
    for body, (vel, spin) in zip(O.bodies, [((0.4, -0.2, 0.1), (30, -20, 80)), ((-0.3, 1.2, 0.2), (-40, 10, 60))]):
        body.state.blockedDOFs = ""
        body.state.mass, body.state.inertia = 5.0, (3e-6,) * 3
        body.state.vel, body.state.angVel = vel, spin
    O.dt = 1e-8
    before = utils.kineticEnergy()
    base.run(10000)
    return {"residual": abs(before - utils.kineticEnergy() - bonds.elastic_energy() - bonds.energy_released)
            / bonds.energy_released, "broken": len(bonds.cracks)}


def strength_factor(law, factor=1.7):
    """A bond of a scaled law answers a scaled path with scaled forces."""
    un, ut = random_path(np.random.default_rng(5))
    a, b = (follow(one, size * un, size * ut)[0] for one, size in ((law, 1.0), (law.scaled(factor), factor)))
    return float(abs(factor * a - b).max() / law.Rn)


def resuming(law):
    """Largest difference after a save and a restart half-way through softening; bit for bit is 0."""
    un, ut = random_path(np.random.default_rng(8), legs=3)
    un, ut = 0.2 * (un + np.linspace(0.0, 8e-6, len(un))), 0.2 * ut
    if law in (CRUSHING, HARDENING):
        # It is crushed and then pulled until it breaks, its particles still nearer than when it was made.
        un, ut = np.interp(np.arange(120), [0, 40, 119], [0.0, -40e-6, -15e-6]), np.linspace(0.0, 3e-6, 120)
    elif law.yade_law == "Cpm":
        un, ut = np.linspace(0.0, 9e-6, 80), np.linspace(0.0, 30e-6, 80)

    def half(resumed):
        response = drive_pair(law, un, ut)
        bonds = response.bonds
        bonds.erase_separated()
        state, softened = bonds.state(), float(bonds.softening()[0])
        set_free(bonds)
        away = -0.3 if law in (CRUSHING, HARDENING) else 0.05
        O.bodies[1].state.vel, O.bodies[1].state.angVel = Vector3(0.02, away, 0.0), Vector3(3.0, 5.0, -8.0)
        if resumed:
            O.save(path)
            O.reset()
            O.load(path)
            bonds = CARRIERS[law.yade_law](pairs=np.array([[0, 1]]), law=law, clock=lambda: O.time, period=1)
            bonds.restore(state)
            base.register([bonds])
            bonds.connect()
        rows = []
        for _ in range(150):
            base.run(1)
            rows.append([*O.forces.f(1), *O.forces.t(0), bonds.energy_released])
        return np.array(rows), softened

    path = sys.argv[-1] + ".yade.gz"
    (whole, softened), (resumed, _) = half(False), half(True)
    os.remove(path)
    return {"difference": float(abs(whole - resumed).max()), "largest": float(abs(whole).max()), "softened": softened}


def broken_on_purpose():
    """Deviation on paths of shear with tension when a part of the engine is taken away: no test may pass then."""
    def no_shear(self, n, geom, first, second):
        return Vector3.Zero

    def a_step_late(self):
        for n, softening in list(self.softening_bonds.items()):
            dissipated = softening.advance(softening.trial(), O.forces)
            if dissipated is not None:
                self._dissipate(n, softening, dissipated)
        yielded = [n for n, (_, phys) in self.elastic.items() if not phys.isCohesive]
        for n in [n for n in yielded if getattr(self, "seen", None) == n]:
            self._yield(n)
        self.seen = yielded[0] if yielded else None

    def no_friction(self):
        convert(self)
        self.phys.tanFrictionAngle = 0.0

    convert, law = SofteningBond.convert_to_friction, LAWS["damage"]
    patches = {"no force from Python": mock.patch.object(SofteningBond, "advance", lambda self, ut, forces: None),
               "shear forgotten": mock.patch.object(BondingNormals, "shear_displacement", no_shear),
               "a step late": mock.patch.object(Bonds, "act", a_step_late),
               "no friction": mock.patch.object(SofteningBond, "convert_to_friction", no_friction)}
    ut = np.linspace(0.0, 30e-6, 203)
    found = {}
    for name, patch in patches.items():
        with patch:
            found[name] = max(deviation(law, drive_pair(law, un, ut)) for un in (0.7 * ut, -ut / 10))
    return found


checks = {
    "programme": {name: programmes(law) for name, law in LAWS.items()},
    "plane": {name: random_paths(law, True) for name, law in LAWS.items()},
    "space": {name: random_paths(law, False) for name, law in LAWS.items()},
    "swapping": {name: swapping(law) for name, law in LAWS.items()},
    "shear_rotation": {name: turning(law) for name, law in LAWS.items()},
    "turning in half the steps": {name: turning(law, 500) for name, law in LAWS.items()},
    "slip by particle": slip_by_particle(LAWS["cohesive"]),
    "looks": {period: looked_at_now_and_then(LAWS["cohesive"], period) for period in (1, 10, 40)},
    "damaged by slip": {f"{steps} steps, {period}": damaged_by_slip(SLIPPING, steps, period)
                        for steps, period in ((1000, 1), (4000, 1), (4000, 10))},
    "damaged both ways": {f"{steps} steps, {period}": damaged_both_ways(SLIPPING, steps, period)
                          for steps, period in ((1000, 1), (4000, 1), (4000, 10))},
    "without realigning": without_realigning(LAWS["cohesive"]),
    "closed again": {period: closed_again(LASTING, period) for period in (1, 10)},
    "weak, closed again": {period: closed_again(WIDE, period, wide=0.95) for period in (1, 10)},
    "coulomb": {name: coulomb_afterwards(LAWS[name]) for name in LINEAR},
    "work": {name: work_until_gone(LAWS[name]) for name in ("damage", "elasto-plastic", "cohesive")},
    "flying": {name: flying_apart(LAWS[name]) for name in ("brittle", "damage", "elasto-plastic", "Coulomb",
                                                           "cohesive")},
    "flying, looked at every ten steps": [flying_apart(LAWS["cohesive"], 10, later) for later in range(10)],
    "flying, damaged by slip": [flying_apart(SLIPPING, 10, later) for later in range(10)],
    "wide open": {period: slipping_wide_open(WIDE, period) for period in (1, 10)},
    "crushed": {period: crushed(CRUSHING, period) for period in (1, 10)},
    "hardening": {f"{steps} steps, {period}": crushed(HARDENING, period, steps)
                  for steps, period in ((1000, 1), (4000, 1), (4000, 10))},
    "scaled": {name: strength_factor(law) for name, law in LAWS.items() if name not in ("cohesive", "crushing")},
    "resuming": {name: resuming(law) for name, law in {**LAWS, "damaged by slip": HALF_SLIPPED,
                                                       "hardening": HARDENING}.items()},
    "broken on purpose": broken_on_purpose(),
}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file, indent=1)

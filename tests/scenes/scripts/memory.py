"""YADE's vectors read and written in memory, against Python's; writes {check: what it found} to the file named last.

    yade -n -x memory.py FILE.json
"""
import json
import os
import sys
from unittest import mock

import numpy as np
from yade import (
    Body, Bo1_Sphere_Aabb, CpmPhys, ForceResetter, FrictPhys, FrictViscoPhys, Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider, Interaction, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator, O, ScGeom, State, Vector3, utils)

from places import all_contacts
from rockwear.engines import cpm_bonds, memory
from rockwear.kernels import compiled
from rockwear.kernels.bond_laws import Cohesive
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.compiled import CONTACT

COUNT = 7
VALUES = np.random.default_rng(1).normal(size=(3, COUNT)) * 10.0**np.arange(-9, 12, 3)
LAW = Cohesive(kn=2e10, kt=1e10, bond_tension=1e5, bond_cohesion=2e5, bond_fracture_energy=1.0, mu=0.5)
VECTORS = cpm_bonds._VECTORS


def contacts():
    """-> contacts of no bodies, their vectors zero, and the Places of what they hold."""
    found = [cpm_bonds._Contact(None, ScGeom(), CpmPhys()) for _ in range(COUNT)]
    for contact in found:
        for vector in VECTORS.values():
            write(vector(contact), (0.0, 0.0, 0.0))
    places = memory.Places(COUNT, vectors=VECTORS, groups=cpm_bonds._GROUPS, numbers=cpm_bonds._numbers())
    places.find(np.array([4, 5, 6]), found[4:])
    places.find(np.arange(4), found[:4])
    return found, places


def write(vector, values):
    for k, value in enumerate(values):
        vector[k] = value


def python(vector, found):
    return np.array([list(vector(contact)) for contact in found]).T


def read_and_written():
    """Names of the vectors of which memory does not read, or write, what Python gives."""
    wrong, numbers = [], np.array([5, 0, 3])
    for name, vector in VECTORS.items():
        found, places = contacts()
        for contact, value in zip(found, VALUES.T.tolist()):
            write(vector(contact), value)
        read = places.read(name, numbers)
        places.write(name, numbers, -VALUES[:, numbers])
        expected = VALUES.copy()
        expected[:, numbers] *= -1.0
        others = [python(other, found) for key, other in VECTORS.items() if key != name]
        if (read != VALUES[:, numbers]).any() or (python(vector, found) != expected).any() or np.any(others):
            wrong.append(name)
    return wrong


def behind():
    """{what: numbers from memory, numbers from Python} of omega, cohesion and epsNPl, and of those that are written."""
    found, places = contacts()
    for k, contact in enumerate(found):
        phys = contact.phys
        phys.isCohesive, phys.epsCrackOnset, phys.epsFracture, phys.undamagedCohesion = True, 1e-4, 1e-2, 10.0 + k
        phys.setDamage(0.1 + 0.1 * k)
    numbers = np.array([6, 1])

    def both(name, attribute):
        return places.read(name, numbers)[0].tolist(), [getattr(found[n].phys, attribute) for n in numbers]

    pairs = {"omega": both("omega", "omega"), "cohesion": both("cohesion", "undamagedCohesion")}
    places.write("cohesion", numbers, np.array([3.0, 4.0]))
    places.write("crushed", numbers, np.array([-0.3, -0.4]))
    return {**pairs, "written": ([3.0, 4.0], both("cohesion", "undamagedCohesion")[1]),
            "crushed": both("crushed", "epsNPl"), "crushed, written": ([-0.3, -0.4], both("crushed", "epsNPl")[1])}


def together():
    """Whether a group gives what its vectors and numbers give one by one."""
    found, places = contacts()
    for contact, value in zip(found, VALUES.T):
        for k, vector in enumerate(VECTORS.values()):
            write(vector(contact), (value * (k + 1)).tolist())
    numbers = np.array([2, 6, 0, 1])
    return [name for name, parts in cpm_bonds._GROUPS.items() if not np.array_equal(
        places.read(name, numbers), np.vstack([places.read(part, numbers) for part in parts]), equal_nan=True)]


def contacts_of_yade():
    """{what: from memory, from Python} of the contacts of a row of discs, every other one of which touches the next."""
    O.reset()
    O.bodies.append([utils.sphere((1.5 * k + (k % 2), 0, 0), 1.0) for k in range(9)])
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.5)]), InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        NewtonIntegrator()]
    O.step()
    words, layout, found = memory.WORDS, memory.contact_layout(), O.interactions.all()
    places = all_contacts()
    bodies = words[places + layout["bodies"]]
    pairs = np.column_stack([bodies & 0xffffffff, bodies >> 32]).tolist()
    pointers = {name: words[places + layout[name]] for name in ("phys", "geom")}
    touching = (pointers["phys"] != 0) & (pointers["geom"] != 0)
    phys, geom = (memory.pointed(found[touching]) for found in pointers.values())
    vectors = {name: memory.MEMORY[start + layout[name] + np.arange(3)[:, None]].T.tolist()
               for name, start in (("normal_force", phys), ("shear_force", phys), ("normal", geom))}
    there = [i.phys for i in found if i.isReal]
    return {"bodies": (pairs, [[i.id1, i.id2] for i in found]), "real": (touching.tolist(), [i.isReal for i in found]),
            "normal": (vectors["normal"], [list(i.geom.normal) for i in found if i.isReal]),
            "normal_force": (vectors["normal_force"], [list(p.normalForce) for p in there]),
            "shear_force": (vectors["shear_force"], [list(p.shearForce) for p in there]),
            "friction": (memory.MEMORY[phys + layout["friction"]].tolist(), [p.tangensOfFrictionAngle for p in there]),
            "class": (words[phys].tolist(), [memory.class_of(FrictPhys())] * len(there))}


def contact_of_the_tool():
    """{name: from memory, from Python} of all that is read of a contact with a dashpot."""
    contact = Interaction(id1=1, id2=2)
    contact.geom, contact.phys = ScGeom(), FrictViscoPhys(ks=2.5, cn=3.5, tangensOfFrictionAngle=4.5)
    parts = {"phys": {**memory._FORCES, **memory._CONSTANTS}, "geom": memory._GEOMETRY}
    vectors = [getattr(getattr(contact, part), attribute) for part, names in parts.items()
               for name, attribute in names.items() if name not in memory._CONSTANTS]
    for vector, values in zip(vectors, VALUES.T.tolist()):
        write(vector, values)
    layout, words = dict(zip(CONTACT, memory.kernel_layout().tolist())), memory.WORDS
    found = {}
    for part, names in parts.items():
        begin = memory.pointed(words[memory.place(contact) + layout[part]])
        for name, attribute in names.items():
            value = getattr(getattr(contact, part), attribute)
            count = 1 if name in memory._CONSTANTS else 3
            found[name] = (memory.MEMORY[begin + layout[name]:][:count].tolist(),
                           [value] if name in memory._CONSTANTS else list(value))
    return found


def velocities_at_contacts():
    """{what: from memory, from Python} of contacts of spheres that move and turn: velocities of the second body, less
    that of the first, at the point of contact; and which bodies are there."""
    contacts_of_yade()
    for body, velocity, spin in zip(O.bodies, VALUES.T.tolist(), -VALUES.T):
        body.state.vel, body.state.angVel = velocity, spin.tolist()
    real = [i for i in O.interactions if i.isReal]
    where = memory.MEMORY, memory.WORDS, memory.kernel_layout(), memory.list_of_bodies()
    nobody = *memory.lists_of_forces(), *np.zeros((3, 0)), np.zeros(3)
    both = [np.array(compiled.velocities(*where, nobody, 0.0, memory.place(i))) for i in real]
    python = [list(i.geom.incidentVel(i, False)) for i in real]
    O.bodies.erase(8)
    scale = np.abs(python).max(axis=1, keepdims=True)
    return {"relative": (np.round([second - first for first, second in both] / scale, 12).tolist(),
                         np.round(python / scale, 12).tolist()),
            "there": ([bool(compiled.is_there(where[1], where[3], k)) for k in range(9)], [k != 8 for k in range(9)])}


def velocities_before_the_step():
    """{what: from memory after a step, from Python before it} of contacts of spheres that forces and torques moved on,
    one of them blocked in part: velocities of both bodies at the point of contact of the step."""
    contacts_of_yade()
    masses, inertias, gravity = np.arange(1.0, 10.0), np.arange(2.0, 11.0), np.array([0.3, -9.81, 0.2])
    motion = np.random.default_rng(2).normal(size=(9, 2, 3)).tolist()
    for body, (velocity, spin), mass, inertia in zip(O.bodies, motion, masses.tolist(), inertias.tolist()):
        body.state.vel, body.state.angVel = velocity, spin
        body.state.mass, body.state.inertia = mass, (inertia,) * 3
        O.forces.setPermF(body.id, (3.0 * body.id, -2.0, 1.0))
        O.forces.setPermT(body.id, (0.5, -body.id, 2.0))
    O.bodies[3].state.blockedDOFs = "xzY"
    # Of a body beyond those of `motion`, here the last one, nothing is known but that it moves evenly.
    O.bodies[8].state.blockedDOFs = "xyzXYZ"
    O.engines[-1].gravity, O.engines[-1].damping, O.dt = gravity.tolist(), 0.0, 1e-4
    before = [[np.array(part) for part in (body.state.pos, body.state.vel, body.state.angVel)] for body in O.bodies]
    lists = memory.lists_of_forces()
    O.step()
    tables = *lists, 1.0 / masses[:8], 1.0 / inertias[:8], np.ones(8), gravity
    where = memory.MEMORY, memory.WORDS, memory.kernel_layout(), memory.list_of_bodies()
    real = [i for i in O.interactions if i.isReal]
    found = [np.array(compiled.velocities(*where, tables, O.dt, memory.place(i))) for i in real]
    python = [np.array([velocity + np.cross(spin, np.array(i.geom.contactPoint) - place)
                        for place, velocity, spin in (before[i.id1], before[i.id2])]) for i in real]
    return {"before": (np.round(found, 9).tolist(), np.round(python, 9).tolist()),
            "of blocked ones": (sum(bool({i.id1, i.id2} & {3, 8}) for i in real), 2)}


def motions():
    """{name: from memory, from Python} of bodies, and as Python has them after they were written."""
    O.reset()
    for (x, y, z), velocity, spin in zip(VALUES.T.tolist(), -VALUES.T, 2 * VALUES.T):
        body = O.bodies[O.bodies.append(utils.sphere((x, y, z), 1.0))]
        body.state.vel, body.state.angVel = velocity.tolist(), spin.tolist()
    bodies = [5, 0, 3]
    found, states = memory.Motions(bodies), [O.bodies[n].state for n in bodies]
    read = {name: found.read(name).T.tolist() for name in ("in_plane", "moving", "turning", "velocity", "spin")}
    pairs = {"in_plane": [list(s.pos)[:2] for s in states], "moving": [list(s.vel)[:2] for s in states],
             "turning": [[s.angVel[2]] for s in states], "velocity": [list(s.vel) for s in states],
             "spin": [list(s.angVel) for s in states]}
    found.write("moving", np.array([2, 1]), [[7.0, 8.0], [9.0, 10.0]])
    return {**{name: (read[name], python) for name, python in pairs.items()},
            "written": ([list(O.bodies[n].state.vel)[:2] for n in (3, 0)], [[7.0, 9.0], [8.0, 10.0]])}


def refused(**constants):
    """What making the engine of bonds says where memory is laid out in another way; None: it is made."""
    cpm_bonds._behind_slip.cache_clear(), cpm_bonds._behind_normal.cache_clear()
    try:
        with mock.patch.multiple(memory, **constants):
            cpm_bonds.CpmBonds(pairs=np.array([[0, 1]]), law=LAW, clock=lambda: 0.0)
    except ParameterError as error:
        return str(error)


def packed(times=100):
    """What is said where no gaps are left, and the objects that are tried lie one behind the other.

    A body's state, say, then lies behind it at the same distance in all bodies, with the count of its owners.
    """
    kept, said = [], []
    for find, kinds in ((memory._position, [State]), (memory.kernel_layout, [Body]),
                        (memory.contact_layout, [ScGeom, FrictViscoPhys, Interaction]),
                        (cpm_bonds._behind_slip, [CpmPhys]), (cpm_bonds._behind_normal, [ScGeom])):
        for _ in range(times):
            # They take what the last try gave back.
            kept.append([made() for made in kinds for _ in range(memory.TRIED)])
            try:
                find.__wrapped__()
            except ParameterError as error:
                said.append(str(error))
    return said


def checked(vector):
    """What the check says of one vector of a contact."""
    try:
        memory.check(cpm_bonds._Contact(None, ScGeom(), CpmPhys()), {"it": vector})
    except ParameterError as error:
        return str(error)


def left_as_it_was():
    """A vector after the check."""
    contact = cpm_bonds._Contact(None, ScGeom(), CpmPhys())
    write(contact.geom.normal, (0.6, 0.0, -0.8))
    memory.check(contact, VECTORS)
    return list(contact.geom.normal)


checks = {
    "wrong": read_and_written(), "wrong together": together(), "behind": behind(), "left": left_as_it_was(),
    "contacts": contacts_of_yade(), "contact of the tool": contact_of_the_tool(),
    "velocities": velocities_at_contacts(), "velocities before": velocities_before_the_step(), "motions": motions(),
    "as it is": refused(INSTANCE=memory.INSTANCE),
    "other layouts": [refused(INSTANCE=i, HOLDER=h) for i in (24, 32, 40, 48) for h in (0, 8, 16, 24)
                      if (i, h) != (40, 16)],
    "out of reach": refused(REACH=5), "packed": packed(),
    "by reference": checked(VECTORS["strain"]), "by value": checked(lambda contact: Vector3(contact.phys.epsT)),
}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)
os._exit(0)

"""YADE's vectors read and written in memory, against Python's; writes {check: what it found} to the file named last.

    yade -n -x memory.py FILE.json
"""
import json
import os
import sys
from unittest import mock

import numpy as np
from yade import CpmPhys, ScGeom, Vector3

from rockwear.engines import cpm_bonds, memory
from rockwear.kernels.bond_laws import Cohesive
from rockwear.kernels.checks import ParameterError

COUNT = 7
VALUES = np.random.default_rng(1).normal(size=(COUNT, 3)) * 10.0**np.arange(-9, 12, 3)[:, None]
LAW = Cohesive(kn=2e10, kt=1e10, bond_tension=1e5, bond_cohesion=2e5, bond_fracture_energy=1.0, mu=0.5)
VECTORS = cpm_bonds._VECTORS


def contacts():
    """-> contacts of no bodies, their vectors zero, and the Vectors of them."""
    found = [cpm_bonds._Contact(None, ScGeom(), CpmPhys()) for _ in range(COUNT)]
    for contact in found:
        for vector in VECTORS.values():
            write(vector(contact), (0.0, 0.0, 0.0))
    vectors = memory.Vectors(COUNT, VECTORS)
    for n, contact in enumerate(found):
        vectors.find(n, contact)
    return found, vectors


def write(vector, values):
    for k, value in enumerate(values):
        vector[k] = value


def python(vector, found):
    return np.array([list(vector(contact)) for contact in found])


def read_and_written():
    """Names of the vectors of which memory does not read, or write, what Python gives."""
    wrong, numbers = [], np.array([5, 0, 3])
    for name, vector in VECTORS.items():
        found, vectors = contacts()
        for contact, value in zip(found, VALUES.tolist()):
            write(vector(contact), value)
        read = vectors.read(name, numbers)
        vectors.write(name, numbers, -VALUES[numbers])
        expected = VALUES.copy()
        expected[numbers] *= -1.0
        others = [python(other, found) for key, other in VECTORS.items() if key != name]
        if (read != VALUES[numbers]).any() or (python(vector, found) != expected).any() or np.any(others):
            wrong.append(name)
    return wrong


def behind():
    """{what: numbers from memory, numbers from Python} of omega and the cohesion, and of a cohesion that is written."""
    found, vectors = contacts()
    omega_behind, cohesion_behind = cpm_bonds._behind_slip()
    for k, contact in enumerate(found):
        phys = contact.phys
        phys.isCohesive, phys.epsCrackOnset, phys.epsFracture, phys.undamagedCohesion = True, 1e-4, 1e-2, 10.0 + k
        phys.setDamage(0.1 + 0.1 * k)
    numbers = np.array([6, 1])

    def both(name, at):
        return vectors.number("slipped", at, numbers).tolist(), [getattr(found[n].phys, name) for n in numbers]

    pairs = {"omega": both("omega", omega_behind), "cohesion": both("undamagedCohesion", cohesion_behind)}
    vectors.set_number("slipped", cohesion_behind, numbers, np.array([3.0, 4.0]))
    return {**pairs, "written": ([3.0, 4.0], both("undamagedCohesion", cohesion_behind)[1])}


def refused(**constants):
    """What making the engine of bonds says where memory is laid out in another way; None: it is made."""
    cpm_bonds._behind_slip.cache_clear()
    try:
        with mock.patch.multiple(memory, **constants):
            cpm_bonds.CpmBonds(pairs=np.array([[0, 1]]), law=LAW, clock=lambda: 0.0)
    except ParameterError as error:
        return str(error)


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
    "wrong": read_and_written(), "behind": behind(), "left": left_as_it_was(),
    "as it is": refused(INSTANCE=memory.INSTANCE),
    "other layouts": [refused(INSTANCE=i, HOLDER=h) for i in (24, 32, 40, 48) for h in (0, 8, 16, 24)
                      if (i, h) != (40, 16)],
    "out of reach": refused(REACH=5),
    "by reference": checked(VECTORS["strain"]), "by value": checked(lambda contact: Vector3(contact.phys.epsT)),
}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)
os._exit(0)

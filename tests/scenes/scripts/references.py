"""What YADE keeps of sequences that it is given; writes {check: what it found} to the file named last.

    yade -n -x references.py FILE.json
"""
import json
import os
import sys
import weakref

from yade import (
    Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator, O, utils)

from rockwear.engines import access
from rockwear.scenes import yade_scene

COUNT, FIRST, CALLS = 600, 300, 200


def collider():
    return InsertionSortCollider([Bo1_Sphere_Aabb()])


def row_of_spheres():
    """Each touches the next."""
    O.reset()
    O.bodies.append([utils.sphere((0.99 * k, 0, 0), 0.5, material=FrictMat(young=1e5)) for k in range(COUNT)])
    access.put_engines([ForceResetter(), collider(), InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
        NewtonIntegrator()])
    O.dt = 1e-9
    O.step()


def replaced():
    """{"freed": how many of CALLS colliders that others replaced are gone, "loop": what the loop then holds,
    "contacts": how many contacts it finds}."""
    gone = []
    for _ in range(CALLS):
        old = access.yade_engine(InsertionSortCollider)
        gone.append(weakref.ref(old))
        with yade_scene.standing_still():
            O.step()
        access.put_engines([collider() if engine is old else engine for engine in O.engines])
        del old
        O.step()
    return {"freed": sum(one() is None for one in gone), "loop": [type(engine).__name__ for engine in O.engines],
            "contacts": O.interactions.countReal()}


class Number(int):
    """An integer that counts those of its kind that are gone."""

    gone = 0

    def __del__(self):
        Number.gone += 1


def freed(call, *values):
    """Share of new numbers with these values that are gone after `call` with them, CALLS times."""
    call(*map(Number, values))
    before = Number.gone
    for _ in range(CALLS):
        call(*map(Number, values))
    return (Number.gone - before) / (CALLS * len(values))


row_of_spheres()
checks = {
    "replaced": replaced(),
    "contact": freed(access.contact_of, FIRST, FIRST + 1),
    "states": freed(lambda *bodies: access.states(bodies), *range(COUNT)),
    "bodies": [access.contact_of(FIRST, FIRST + 1).id1, access.contact_of(FIRST, FIRST + 1).id2],
    "places": access.states([FIRST, 5])[:, 0].tolist(),
}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)
os._exit(0)

"""Where YADE's forces lie in memory, found in several states of a scene; writes {state: what it found} to the file
named last.

    yade -n -x [-jN] forces.py FILE.json
"""
import json
import os
import sys

import numpy as np
from yade import ForceResetter, NewtonIntegrator, O, utils

from rockwear.engines import memory
from rockwear.kernels import compiled

BODIES = range(5)


def scene():
    """Spheres apart from each other, no force on any."""
    O.reset()
    O.bodies.append([utils.sphere((3.0 * k, 0, 0), 1.0) for k in BODIES])
    O.engines = [ForceResetter(), NewtonIntegrator()]


def python():
    return [[list(given(body)) for body in BODIES] for given in (O.forces.f, O.forces.t)]


def found():
    """The word found anew, forces and torques in memory, in Python then and in Python before."""
    before = python()
    memory._word_of_forces.cache_clear()
    lists = memory.lists_of_forces()
    bodies = np.array(BODIES)
    in_memory = [compiled.exerted_on(memory.MEMORY, memory.WORDS, each, bodies).tolist() for each in lists]
    return {"word": memory._word_of_forces(), "memory": in_memory, "python": python(), "before": before}


def pushed(permanent):
    """All spheres but the first one are pushed and turned."""
    scene()
    for body in BODIES[1:]:
        O.forces.addF(body, (0.1 * body, -2.0, 0.3), permanent=permanent)
        O.forces.addT(body, (0.0, 0.7, -0.1 * body), permanent=permanent)
    return found()


def first_pushed():
    scene()
    O.forces.addF(0, (0.1, 0.2, 0.3))
    return found()


def still():
    scene()
    return found()


def stepped():
    pushed(True)
    O.dt = 1e-3
    O.step()
    return found()


with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump({"still": still(), "pushed": pushed(False), "pushed for good": pushed(True),
               "first body pushed": first_pushed(), "after a step": stepped()}, file)
os._exit(0)

"""YADE's own time in a loop with an engine and another runner of Python, and what a run raises where two engines fail
in one step; writes {"yade", "all", "python": s, "raised": words} to FILE.

    yade -n -x clock.py FILE
"""
import json
import os
import sys
import time

from yade import Bo1_Sphere_Aabb, ForceResetter, InsertionSortCollider, NewtonIntegrator, O, PyRunner, utils

from rockwear.engines import base

STEPS, SPENT = 200, 2e-4


class Busy(base.Engine):
    """Takes SPENT (s) each time."""

    name = "busy"

    def act(self):
        time.sleep(SPENT)


class Failing(base.Engine):
    """Fails with its name."""

    def __init__(self, name):
        super().__init__()
        self.name = name

    def act(self):
        raise base.RunEnded(self.name, True)


O.bodies.append([utils.sphere((3.0 * k, 0, 0), 1.0) for k in range(200)])
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]), NewtonIntegrator()]
busy = Busy()
base.register([busy])
base.insert([busy])
O.engines = [*O.engines, PyRunner(command=f"import time; time.sleep({SPENT})", iterPeriod=1)]
begin = time.perf_counter()
base.run(STEPS)
found = {"yade": base.yade_time, "all": time.perf_counter() - begin, "python": 2 * (STEPS - 1) * SPENT,
         "steps": O.iter}
base.register([Failing("first"), Failing("second")])
try:
    base.run(1)
except base.RunEnded as ended:
    found["raised"] = str(ended)
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(found, file)
os._exit(0)

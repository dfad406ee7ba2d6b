"""Settles the loose fill of granular_3d: its weight, and what the fixed spheres of the box carry.

    yade -n -x settled_fill.py [--name value ...] CHECKS.json
"""
import json
import os
import sys

from yade import O, utils

from rockwear.engines.access import rock_positions
from rockwear.run import parameters
from rockwear.scenes import cutting_3d

values = parameters.read(cutting_3d.loose_groups(tool="triangles"), sys.argv[1:-1])
scene = cutting_3d.make_loose(values)
scene.build()
rock = scene.rock
mean = 0.0
while scene.stage == 0 and not scene.stage_done:
    scene.run_chunk()
for _ in range(400):
    O.step()
    mean -= sum(O.forces.f(i)[1] for i in range(rock.count) if rock.fixed[i]) / 400
free = ~rock.fixed
fallen = float(rock.masses @ (rock.positions[:, 1] - rock_positions(rock)[:, 1])) * values["gravity"]
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump({"weight": float(rock.masses[free].sum()) * values["gravity"], "on_box": mean, "fallen": fallen,
               "kinetic": utils.kineticEnergy()}, file)
os._exit(0)

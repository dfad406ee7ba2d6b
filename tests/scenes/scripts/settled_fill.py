"""Settles the loose fill of granular_3d, and prints its weight and what the held spheres of the box carry."""
import json
import os
import sys

from yade import O, utils


from rockwear.run import parameters as reading
from rockwear.scenes.cutting3d import LOOSE, OF_BONDS, OF_TRIANGLES, LooseCutting3D, parameters

values = reading.read(parameters(*OF_TRIANGLES, *LOOSE, without=OF_BONDS, mu=0.1), sys.argv[1:])
scene = LooseCutting3D(values)
scene.build()
rock = scene.rock
mean = 0.0
while scene.stage == 0 and not scene.stage_done:
    scene.run_chunk()
for _ in range(400):
    O.step()
    mean -= sum(O.forces.f(i)[1] for i in range(rock.count) if rock.fixed[i]) / 400
free = ~rock.fixed
fallen = float(rock.masses @ (rock.positions[:, 1] - rock.current_positions()[:, 1])) * values["gravity"]
print("JSON" + json.dumps({"weight": float(rock.masses[free].sum()) * values["gravity"], "on_box": mean, "fallen": fallen,
                           "kinetic": utils.kineticEnergy()}), flush=True)
os._exit(0)

"""The window of a rock mass moves on over rock that the tool does not touch.

    yade -n -x window_at_rest.py LAW CHECKS.json      LAW: of bonds along a straight way; arc: the dredge's
"""
import json
import math
import os
import sys

import numpy as np
from yade import O, utils

from rockwear.engines.damping import BackgroundDamping
from rockwear.model.rock_mass import SLABS
from rockwear.run import parameters
from rockwear.scenes import dredging, steady_cut
from rockwear.scenes.parameters import with_defaults

PRESSED = 1e-4

law, file = sys.argv[1:]
if law == "arc":
    groups = with_defaults(
        dredging.groups(), window_behind=0.06, window_ahead=0.14, cut_time=0.2, background_damping=0.0,
        tool_radius_min=2e-3, tool_radius_max=2e-3, tooth_height=0.07, tooth_width=0.05, convection=0.0)
    scene = dredging.make(parameters.read(groups, []))
else:
    groups = steady_cut.groups(
        window_behind=0.014, window_ahead=0.026, window_height=0.02, radius_min=0.8e-3, radius_max=1.2e-3, heat=False,
        tool_radius_min=4e-4, tool_radius_max=5e-4, tooth_height=0.015, tooth_width=0.01, depth_of_cut=5e-3,
        bond_law=law, background_damping=0.0)
    scene = steady_cut.make(parameters.read(groups, []))
scene.programme.run = lambda: False
scene.build()
window, bonds, whole = scene.programme.window, [], []
for k in range(2 * SLABS):
    # Whole rock, from which the tool is far off.
    if k == SLABS:
        for body in scene.tool.bodies.ids:
            O.bodies[body].state.pos += (0.0, 0.1, 0.0)
    if scene.expansion:
        # In the first round rock leaves warm, and with it the stress of its expansion.
        leaving = np.isin(np.arange(len(scene.heat.network.capacity)), np.flatnonzero(scene.rock.slab == k))
        scene.heat.network.add_heat(np.where(leaving, 10 * scene.heat.network.capacity, 0.0))
        scene.expansion.act()
    window.advance()
    if k >= SLABS:
        for _ in range(20):
            O.step()
        scene.canonical()
        bonds.append(int((scene.bonds.status == 0).sum()))
        whole.append(int(scene.rock.bonded.sum()))
stored = scene.stored_energy()
among_rock = sum(i.isReal and max(i.id1, i.id2) < scene.rock.count for i in O.interactions)
moving, cracks = utils.kineticEnergy(), len(scene.bonds.cracks)
late = scene.programme.path_time() * scene.time_scale - scene.time


def place(strain):
    """Press the rock together along the cut, all of it alike."""
    for body, (x, y) in enumerate(scene.rock.places.tolist()):
        O.bodies[body].state.pos = ((1.0 - strain) * x, y, 0.0)


# Rock that comes in beside rock under load is without force when the load has fallen.
place(PRESSED)
for _ in range(3):
    window.advance()
place(0.0)
O.dt = 0.0
O.step()
left = max(i.phys.normalForce.norm() / i.phys.kn for i in O.interactions
           if i.isReal and max(i.id1, i.id2) < scene.rock.count)
held = np.isin(np.arange(scene.rock.count), scene.boundary.numbers)
blocked = np.array([O.bodies[n].state.blockedDOFs for n in range(scene.rock.count)])
freedom = [sorted(set(blocked[which].tolist()))
           for which in (held, scene.rock.absent, ~held & ~scene.rock.absent)]

# Particles that have parted lie where rock enters: one of them held by the boundary, one not.
rock = scene.rock
middle = rock.slab == (rock.passed + SLABS // 2) % SLABS
parted = [int(np.flatnonzero(middle & which)[0]) for which in (held, ~held)]
for k, body in enumerate(parted):
    x, y = rock.strip.place(np.array([[rock.end + 0.4 * rock.slab_length, (0.3 + 0.4 * k) * rock.height]]))[0]
    O.bodies[body].state.pos = (x, y, 0.0)
O.dt = 1e-12
O.step()
scene.canonical()
cleared = window.cleared
window.advance()
in_the_way = [window.cleared - cleared, *(
    [bool(rock.absent[n]), str(O.bodies[n].state.blockedDOFs), n in scene.boundary.numbers,
     len(O.interactions.withBody(n))] for n in parted)]

# Background damping that began while they were absent: it damps them once they are rock again.
damping = BackgroundDamping(rate=math.log(2.0) / O.dt, bodies=range(rock.count))
damping.connect()
while rock.absent[parted].any():
    window.advance()
for body in parted:
    O.bodies[body].state.vel = (1.0, 0.0, 0.0)
damping.elapsed()
O.step()
damping.act()
damped = [O.bodies[body].state.vel[0] for body in parted]
found = {"late": late, "kinetic": moving, "elastic": stored["elastic"], "cracks": cracks,
         "bonds": bonds, "whole": whole, "interactions": among_rock, "left": left / scene.rock.radii.mean(),
         "freedom": freedom, "in_the_way": in_the_way,
         "damped": damped}
with open(file, "w", encoding="utf-8") as out:
    json.dump(found, out)
os._exit(0)

"""What a removal does to the cut: overlaps that uncovered particles come into the world with, and a tooth sawn in two.

    yade -n -x removal.py --saw false|true [--name value ...]      writes one line of JSON
"""
import json
import math
import os
import sys

import numpy as np
from scipy.spatial import cKDTree
from yade import InsertionSortCollider, NewtonIntegrator, O, PyRunner

from rockwear.engines import access
from rockwear.kernels.parameter import Parameter, flag
from rockwear.kernels.wear_laws import WORK
from rockwear.run import parameters
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

BAND = 1.5e-3, 3e-3
"""Heights in the tool's own frame (m) between which the saw takes everything away: below all that the shank holds."""


class Saw:
    """In place of a wear law: wears the band away in one visit."""

    def volume(self, slid, hardness, area):
        y = tool.positions[:, 1]
        return np.where((y > BAND[0]) & (y < BAND[1]), tool.volumes, 0.0)


def place(index):
    return np.array(O.bodies[bodies.body_of[int(index)]].state.pos)[:2]


def overlaps(indices):
    """Overlaps (m) with rock of tool particles that are there now."""
    rock = access.rock_positions(scene.rock)
    tree = cKDTree(rock)
    for i in indices:
        here, reach = place(i), tool.radii[i]
        for j in tree.query_ball_point(here, reach + scene.rock.radii.max()):
            yield reach + scene.rock.radii[j] - np.linalg.norm(rock[j] - here)


def spy(add):
    def watched(indices):
        add(indices)
        found.extend(o for o in overlaps(indices) if o > 0)
        newcomers.update(bodies.body_of[int(i)] for i in indices)
    return watched


def watch_newcomers():
    """The force of each uncovered particle in the step in which it first meets rock, over the most that an approach
    from outside may bring: what a step's way loads the spring by, and the dashpot."""
    for body in sorted(newcomers):
        if not O.bodies[body]:
            newcomers.remove(body)
            continue
        force = O.forces.f(body).norm()
        if force > 0:
            newcomers.remove(body)
            most = 0.0
            for interaction in O.interactions.withBody(body):
                speed, phys = interaction.geom.incidentVel(interaction, False).norm(), interaction.phys
                most += (phys.kn * O.dt + phys.cn) * speed * math.hypot(1, phys.tangensOfFrictionAngle)
            pushes.append(force / most)


def unseen():
    """Bodies that the collider, once it has run again, does not know."""
    O.run(1, True)
    listed = access.yade_engine(InsertionSortCollider).dumpBounds()[0]
    return {body.id for body in O.bodies if body and body.bound} - {abs(number) for _, number in listed}


SAW = Parameter("saw", False, "", flag, "saw the tooth in two half-way")
values = parameters.read([*cutting.GROUPS, COMMON, SAW], sys.argv[1:])
scene, found, newcomers, pushes = cutting.make(values), [], set(), []
tool = scene.tool.model
scene.build()
bodies, contact, wear = scene.tool.bodies, scene.tool.contact, scene.tool.wear_engine
# Before the integrator, which changes the speeds that the forces come from.
before = next(k for k, engine in enumerate(O.engines) if isinstance(engine, NewtonIntegrator))
O.engines = O.engines[:before] + [PyRunner(command="watch_newcomers()", iterPeriod=1)] + O.engines[before:]
bodies.add = spy(bodies.add)
sawn = not values["saw"]
below, unlisted = [], set()
while not scene.stage_done:
    scene.run_chunk()
    unlisted |= unseen()
    if not sawn and scene.step > scene.stages[0][1] // 2:
        law, wear.law = wear.law, Saw()
        contact.slid[WORK][0] += 1e-9
        wear.act()
        wear.law, sawn = law, True
        low = np.flatnonzero(tool.positions[:, 1] < BAND[0])
        below = [int(np.sum(tool.erosion.alive[low])), sum(int(i) in bodies.body_of for i in low),
                 sum(one.piece in low for one in contact.possible)]
wear.act()
if scene.heat:
    scene.heat.act()
balances = {name: balance for name, (balance, _) in scene.output.balances().items()}
print("JSON" + json.dumps({"removed": int(np.sum(~tool.erosion.alive)), "overlaps": found, "pushes": pushes,
                           "below": below, "unlisted": sorted(unlisted), "balances": balances,
                           "limit": wear.limit.tolist(), "radii": tool.radii.tolist(),
                           "volumes": tool.volumes.tolist()},
                          default=lambda x: x.item()))
sys.stdout.flush()
os._exit(0)

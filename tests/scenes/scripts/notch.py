"""A disc without friction swings in a notch of a tool of segments: the energy that many crossings of its edge give it.

    yade -n -x notch.py        prints one line of JSON
"""
import json
import math

import numpy as np
from yade import FrictViscoMat, O, utils

from rockwear.engines import base
from rockwear.scenes import yade_scene
from rockwear.scenes.tool_bodies import FacetBodies
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.model.facet_tool import FacetTool
from rockwear.kernels.rigid_motion import Straight

SLOPE, RADIUS, KN, LOAD, MU = math.radians(5), 1.25e-3, 1e8, 1e4, 1e-9
MASS = 2500 * math.pi * RADIUS**2
rise = 0.02 * math.tan(SLOPE)
tool = FacetTool.of_outline(np.array([[-0.02, 0], [0, rise], [0.02, 0], [0.02, 0.03], [-0.02, 0.03]]), segment=1.0, density=7830.0)

yade_scene.put_rock_materials(mu=0.8, loose=FrictViscoMat)
yade_scene.put_tool_material(mu=MU, contact_damping=0.0)
# As deep as the load presses it, and beside the middle, so that it swings to and fro over the edge.
aside = 0.2e-3
deep = RADIUS - LOAD / KN
body = utils.sphere((aside, rise - aside * math.tan(SLOPE) - deep / math.cos(SLOPE), 0), RADIUS, material="loose rock",
                    mask=yade_scene.ROCK_MASK)
body.state.mass, body.state.inertia = MASS, (MASS * RADIUS**2,) * 3
body.state.blockedDOFs = "zXYZ"
O.bodies.append(body)
O.forces.setPermF(0, (0, LOAD, 0))
yade_scene.put_loop_with_facets(kn=20e9, kt=20e9, mu=0.8, tool=(KN, KN, MU))
bodies = FacetBodies(tool, Straight(start=(0.0, 0.0), velocity=(0.0, 0.0)))
contact = FacetContact(tool=bodies, neighbours=tool.boundary.neighbours(),
                       motion=VelocityIncrement(masses=np.array([MASS]), inertias=np.ones(1), radii=np.array([RADIUS]), fixed=np.zeros(1, bool)))
bodies.add(range(tool.count))
O.dt = 0.4 * math.sqrt(MASS / KN)
base.register([contact])
O.engines = O.engines[:-1] + base.runners({"tool_contact": 1}) + O.engines[-1:]
contact.connect()


def energy():
    state = O.bodies[0].state
    return 0.5 * MASS * state.vel.squaredNorm() - LOAD * state.pos[1] + contact.elastic_energy()


O.run(2, True)
first, gained, places = energy(), [], []
for _ in range(1000):
    O.run(20, True)
    if base.failures:
        raise base.failures[0]
    gained.append(energy() - first)
    places.append(O.bodies[0].state.pos[0])
print(json.dumps({"gained": float(np.abs(gained).max()), "in_the_spring": 0.5 * LOAD**2 / KN, "aside": float(np.abs(places).max()),
                  "crossings": int(np.sum(np.diff(np.sign(places)) != 0)), "reshaping_energy": contact.reshaping_energy}))

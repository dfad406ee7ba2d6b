"""A disc without friction swings in a notch of a tool of segments: the energy that many crossings of its edge give it.

    yade -n -x notch.py CHECKS.json
"""
import json
import math
import os
import sys
from types import SimpleNamespace

import numpy as np
from yade import FrictViscoMat, O, utils

import yade_loop
from rockwear.engines import base
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.kernels.rigid_motion import Straight
from rockwear.model.facet_tool import FacetTool
from rockwear.scenes import yade_scene
from rockwear.scenes.tool_bodies import FacetBodies

SLOPE, RADIUS, KN, LOAD, MU = math.radians(5), 1.25e-3, 1e8, 1e4, 1e-9
MASS = 2500 * math.pi * RADIUS**2


class Swing(base.Engine):
    """Place and energy (J) of the disc, after the integrator."""

    name = "swing"

    def __init__(self, contact, **options):
        super().__init__(**options)
        self.contact, self.rows = contact, []

    def act(self):
        state = O.bodies[0].state
        self.rows.append((state.pos[0],
                          0.5 * MASS * state.vel.squaredNorm() - LOAD * state.pos[1] + self.contact.elastic_energy()))


rise = 0.02 * math.tan(SLOPE)
tool = FacetTool.of_outline(np.array([[-0.02, 0], [0, rise], [0.02, 0], [0.02, 0.03], [-0.02, 0.03]]), segment=1.0,
                            density=7830.0)
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
yade_scene.put_loop_with_facets(rock=SimpleNamespace(kn=20e9, kt=20e9, mu=0.8),
                                tool=SimpleNamespace(kn=KN, kt=KN, mu=MU))
bodies = FacetBodies(tool, Straight(start=(0.0, 0.0), velocity=(0.0, 0.0)))
contact = FacetContact(tool=bodies, neighbours=tool.boundary.neighbours(),
                       motion=VelocityIncrement(masses=np.array([MASS]), inertias=np.ones(1), radii=np.array([RADIUS]),
                                                fixed=np.zeros(1, bool)))
bodies.add(range(tool.count))
O.dt = 0.4 * math.sqrt(MASS / KN)
swing = Swing(contact, period=20)
yade_loop.insert(contact, swing)
O.run(2, True)
swing.act()
first = swing.rows.pop()[1]
# In one go: YADE looks at the end of a short run for as long as that takes.
base.run(20000)
places, energy = np.array(swing.rows[-1000:]).T
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump({"gained": float(np.abs(energy - first).max()), "in_the_spring": 0.5 * LOAD**2 / KN,
               "aside": float(np.abs(places).max()), "crossings": int(np.sum(np.diff(np.sign(places)) != 0)),
               "samples": len(swing.rows)}, file)
os._exit(0)

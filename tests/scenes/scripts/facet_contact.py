"""Particles pressed against a led tool of facets: YADE's forces and accounts against exact ones. Prints one line of JSON.

    yade -n -x facet_contact.py chain|single|valley|triangles [unwatched]
"""
import json
import math
import sys

import numpy as np
from yade import FrictViscoMat, O, PyRunner, utils

from rockwear.engines import base
from rockwear.scenes import yade_scene
from rockwear.scenes.tool_bodies import FacetBodies
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.facet_wear import FacetWear
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.model.facet_tool import FacetTool
from rockwear.kernels.archard import Hardness
from rockwear.kernels.boundary import nearest_on_triangle, prism
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.wear_laws import DissipationArchard

KIND, WATCHED = sys.argv[1], "unwatched" not in sys.argv
MU, FORCE, SPEED, K, HARDNESS = 0.3, 2e4, 4.0, 0.1, 5e9
in_space = KIND == "triangles"
RADIUS = 3e-3 if in_space else 1.25e-3
KN = 90e9 if KIND in ("chain", "single") else 1e8
box = np.array([[-0.02, 0], [0.02, 0], [0.02, 0.01], [-0.02, 0.01]])
if KIND == "valley":
    # An inner edge of 5 degrees, over which the particle comes with an overlap of a sixth of its radius.
    box = np.insert(box, 1, [0.0, 0.02 * math.tan(math.radians(2.5))], axis=0)
if in_space:
    vertices, facets = prism(0.5 * box, 8e-3, 1e-3)
    tool = FacetTool(vertices=vertices, facets=facets, density=7830.0)
else:
    # 1.03 mm: no end of a segment comes to lie just over a particle.
    tool = FacetTool.of_outline(box, segment=1.03e-3 if KIND == "chain" else 1.0, density=7830.0)
FORCE = 2e3 if in_space else FORCE

yade_scene.put_rock_materials(mu=0.8, loose=FrictViscoMat)
yade_scene.put_tool_material(mu=MU, contact_damping=0.9)
places = [(0.0, 0.0), (-6.5e-3, 0.3e-3)] if in_space else [(0.0, 0.0)]
start = {"triangles": -0.006, "valley": -0.005}.get(KIND, -0.0123)
surface = 0.75 * box[1, 1]
mass = 2500 * math.pi * RADIUS**2
for x, z in places:
    body = utils.sphere((x, surface - RADIUS, z), RADIUS, material="loose rock", mask=yade_scene.ROCK_MASK)
    body.state.mass, body.state.inertia = mass, (mass * RADIUS**2,) * 3
    body.state.blockedDOFs = "xzXYZ"
    O.forces.setPermF(O.bodies.append(body), (0, FORCE, 0))
yade_scene.put_loop_with_facets(kn=20e9, kt=20e9, mu=0.8, tool=(KN, KN, MU))
bodies = FacetBodies(tool, Straight(start=(start, 0.0), velocity=(SPEED, 0.0)))
count = len(places)
motion = VelocityIncrement(masses=np.full(count, mass), inertias=np.ones(count), radii=np.full(count, RADIUS),
                   fixed=np.zeros(count, bool))
contact = FacetContact(tool=bodies, motion=motion, neighbours=tool.boundary.neighbours())
wear = FacetWear(contact=contact, boundary=tool.boundary, tool=bodies, law=DissipationArchard(k=K if in_space else 0.0, mu=MU),
                 hardness=Hardness.constant(HARDNESS), temperature=lambda: np.full(tool.count, 293.0))
bodies.add(range(tool.count))
O.dt = 1e-6 if in_space else 1e-7
base.register([contact, wear])
found, forces = {}, []
if WATCHED:
    O.engines = O.engines[:-1] + base.runners({"tool_contact": 1}) + O.engines[-1:] + base.runners({"wear": 50})


def note():
    force = O.forces.f(0)
    forces.append(force[1])


# Before the integrator, after all that may change forces.
O.engines = O.engines[:-1] + [PyRunner(command="note()", iterPeriod=1)] + O.engines[-1:] if not WATCHED else (
    O.engines[:-3] + O.engines[-3:-2] + [PyRunner(command="note()", iterPeriod=1)] + O.engines[-2:])
contact.connect()


def run(steps):
    O.run(steps, True)
    if base.failures:
        raise base.failures[0]


run(500 if in_space else 10000)
begun, at = contact.work_done, len(forces)
account = contact.functor.plasticDissipation()
steps = 1500 if in_space else 15000
run(steps)
distance = SPEED * steps * O.dt
force = np.array(forces)[at:]
wear.act()
found.update(friction=MU * FORCE * distance * count, work=contact.work_done - begun,
             account=contact.functor.plasticDissipation() - account, own=contact.in_yade_balance,
             whole=contact.functor.plasticDissipation(), slid=contact.friction,
             ripple=float(np.abs(force - force[0]).max() / FORCE),
             archard=tool.boundary.archard_volume, by_work=K / MU * wear.work_used / HARDNESS,
             removed=tool.boundary.removed, waiting=float(tool.boundary.pending.sum()), facets=tool.count,
             shape=tool.boundary.first_volume - tool.boundary.volume)
bodies.connect()
moved = tool.boundary.vertices + np.append(bodies.pose.offset, [0.0] * (tool.boundary.dimension - 2))
if in_space:
    for body in O.bodies:
        if body.id >= count:
            body.state.vel = (0, 0, 0)
    run(3000)
    bodies.connect()
    moved = tool.boundary.vertices + np.append(bodies.pose.offset, 0.0)
    depths = []
    for number in range(count):
        place = np.array(O.bodies[number].state.pos)
        depths.append(RADIUS - min(float(np.linalg.norm(nearest_on_triangle(place, moved[facet]) - place))
                                   for facet in tool.boundary.facets))
    seen = [max(i.geom.penetrationDepth for i in O.interactions.withBody(number)) for number in range(count)]
    found.update(overlaps=depths, seen=seen, at_rest=max(abs(O.forces.f(number)[1]) for number in range(count)) / FORCE,
                 heights=[float(O.bodies[number].state.pos[1] + RADIUS) for number in range(count)])
found["outside"] = contact.contact_inside_tool()
wear.reshape = False
for number in range(count):
    # Half a radius inside the tool.
    O.bodies[number].state.pos += (0, 1.5 * RADIUS, 0)
run(1)
found["inside"] = contact.contact_inside_tool()
print(json.dumps(found))

"""Particles pressed against a moved tool of facets: YADE's forces and sums against exact ones.

    yade -n -x facet_contact.py CHECKS.json        writes {case: {quantity: number}}
"""
import json
import math
import os
import sys
from types import SimpleNamespace

import numpy as np
from yade import FrictViscoMat, O, utils

from rockwear.engines import base
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.facet_wear import FacetWear
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.kernels.archard import Hardness
from rockwear.kernels.boundary import nearest_on_triangle, prism
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.wear_laws import DissipationArchard
from rockwear.model.facet_tool import FacetTool
from rockwear.scenes import yade_scene
from rockwear.scenes.tool_bodies import FacetBodies

MU, SPEED, K, HARDNESS = 0.3, 4.0, 0.1, 5e9
ROCK = SimpleNamespace(kn=20e9, kt=20e9, mu=0.8)


class Force(base.Engine):
    """What presses the first particle down, before the integrator, after all that may change forces."""

    name = "force"
    phase = base.FORCES

    def __init__(self):
        super().__init__()
        self.rows = []

    def act(self):
        self.rows.append(O.forces.f(0)[1])


class Pressed:
    """Particles under a dead load on the underside of a tool that moves. kind: single, one facet; chain, short
    facets; valley; triangles. watched: False leaves the contacts to YADE."""

    def __init__(self, kind, watched=True):
        O.reset()
        self.in_space = kind == "triangles"
        self.force, self.radius = (2e3, 3e-3) if self.in_space else (2e4, 1.25e-3)
        box = np.array([[-0.02, 0], [0.02, 0], [0.02, 0.01], [-0.02, 0.01]])
        if kind == "valley":
            # An inner edge of 5 degrees, over which the particle comes with an overlap of a sixth of its radius.
            box = np.insert(box, 1, [0.0, 0.02 * math.tan(math.radians(2.5))], axis=0)
        if self.in_space:
            vertices, facets = prism(0.5 * box, 8e-3, 1e-3)
            self.tool = FacetTool(vertices=vertices, facets=facets, density=7830.0)
        else:
            # 1.03 mm: no end of a segment comes to lie just over a particle.
            self.tool = FacetTool.of_outline(box, segment=1.03e-3 if kind == "chain" else 1.0, density=7830.0)
        self.places = [(0.0, 0.0), (-6.5e-3, 0.3e-3)] if self.in_space else [(0.0, 0.0)]
        self.count = len(self.places)
        self.mass = 2500 * math.pi * self.radius**2
        start = {"triangles": -0.006, "valley": -0.005}.get(kind, -0.0123)
        self.put_bodies(surface=0.75 * box[1, 1], kn=90e9 if kind in ("chain", "single") else 1e8,
                        motion=Straight(start=(start, 0.0), velocity=(SPEED, 0.0)))
        self.put_engines(watched)

    def put_bodies(self, *, surface, kn, motion):
        yade_scene.put_rock_materials(mu=ROCK.mu, loose=FrictViscoMat)
        yade_scene.put_tool_material(mu=MU, contact_damping=0.9)
        for x, z in self.places:
            body = utils.sphere((x, surface - self.radius, z), self.radius, material="loose rock",
                                mask=yade_scene.ROCK_MASK)
            body.state.mass, body.state.inertia = self.mass, (self.mass * self.radius**2,) * 3
            body.state.blockedDOFs = "xzXYZ"
            O.forces.setPermF(O.bodies.append(body), (0, self.force, 0))
        yade_scene.put_loop_with_facets(rock=ROCK, tool=SimpleNamespace(kn=kn, kt=kn, mu=MU))
        self.bodies = FacetBodies(self.tool, motion)
        self.bodies.add(range(self.tool.count))

    def put_engines(self, watched):
        tool, ones = self.tool, np.ones(self.count)
        increment = VelocityIncrement(masses=self.mass * ones, inertias=ones, radii=self.radius * ones, fixed=ones < 0)
        self.contact = FacetContact(tool=self.bodies, motion=increment, neighbours=tool.boundary.neighbours())
        self.wear = FacetWear(contact=self.contact, boundary=tool.boundary, tool=self.bodies,
                              law=DissipationArchard(k=K if self.in_space else 0.0, mu=MU),
                              hardness=Hardness.constant(HARDNESS),
                              temperature=lambda: np.full(tool.count, 293.0), period=50)
        self.noted = Force()
        O.dt = 1e-6 if self.in_space else 1e-7
        engines = [self.contact, self.noted, self.wear] if watched else [self.noted]
        base.register(engines)
        base.insert(engines)
        self.contact.connect()

    def run(self, steps):
        base.run(steps)

    def slide(self):
        """What a way along the tool does."""
        contact, boundary = self.contact, self.tool.boundary
        self.run(500 if self.in_space else 10000)
        begun, at, before = contact.work_done, len(self.noted.rows), contact.functor.plasticDissipation()
        steps = 1500 if self.in_space else 15000
        self.run(steps)
        force = np.array(self.noted.rows)[at:]
        self.wear.act()
        return dict(
            friction=MU * self.force * SPEED * steps * O.dt * self.count, work=contact.work_done - begun,
            yade=contact.functor.plasticDissipation() - before, own=contact.in_yade_balance,
            whole=contact.functor.plasticDissipation(), ripple=float(np.abs(force - force[0]).max() / self.force),
            archard=boundary.archard_volume, by_work=K / MU * self.wear.work_used / HARDNESS, removed=boundary.removed,
            waiting=float(boundary.pending.sum()), facets=self.tool.count,
            shape=boundary.first_volume - boundary.volume)

    def stand(self):
        """Where particles come to rest on the worn tool, which stands still."""
        for body in O.bodies:
            if body.id >= self.count:
                body.state.vel = (0, 0, 0)
        self.run(3000)
        self.bodies.connect()
        boundary, places = self.tool.boundary, [np.array(O.bodies[number].state.pos) for number in range(self.count)]
        moved = boundary.vertices + np.append(self.bodies.pose.offset, 0.0)
        return dict(
            overlaps=[self.radius - min(float(np.linalg.norm(nearest_on_triangle(place, moved[facet]) - place))
                                        for facet in boundary.facets) for place in places],
            seen=[max(i.geom.penetrationDepth for i in O.interactions.withBody(number))
                  for number in range(self.count)],
            at_rest=max(abs(O.forces.f(number)[1]) for number in range(self.count)) / self.force,
            heights=[float(place[1] + self.radius) for place in places])

    def inside(self):
        """What is found of a particle on its side of the tool's surface, and of one half a radius inside."""
        outside = self.contact.contact_inside_tool()
        self.wear.reshape = False
        for number in range(self.count):
            O.bodies[number].state.pos += (0, 1.5 * self.radius, 0)
        self.run(1)
        return dict(outside=outside, inside=self.contact.contact_inside_tool())


def check(kind, watched=True):
    pressed = Pressed(kind, watched)
    return {**pressed.slide(), **(pressed.stand() if pressed.in_space else {}), **pressed.inside()}


checks = {kind: check(kind) for kind in ("single", "chain", "valley", "triangles")}
checks["chain left to YADE"] = check("chain", watched=False)
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)
os._exit(0)

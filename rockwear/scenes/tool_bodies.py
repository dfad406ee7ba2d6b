"""A tool's bodies in YADE: particles or facets on a prescribed motion."""
import math

import numpy as np
from yade import NewtonIntegrator, O, Quaternion, Vector3, utils

from rockwear.engines import access
from rockwear.kernels.boundary import nearest_on_triangle
from rockwear.kernels.rigid_motion import Pose
from rockwear.model.facet_tool import corners, incentres
from rockwear.scenes.yade_scene import TOOL_MASK, finite_disc, sphere


class ToolBodies:
    """The tool's surface particles in YADE, on a prescribed motion: only these take part in contact detection.

    They have no mass: the motion is prescribed, and no kinetic energy of the tool enters the balance.

    tool: a model.particle_tool.Tool; motion: of kernels.rigid_motion. `pose` is where the tool is, `velocities`
    {particle: (vx, vy)} and `angular_velocity` (rad/s) are how YADE moves it in this step.
    """

    def __init__(self, tool, motion):
        self.tool, self.motion = tool, motion
        self.count, self.positions = tool.count, tool.positions
        self.body_of = {}
        self.ids = []
        self.pose = motion.pose(0.0)
        self.velocities, self.angular_velocity = {}, motion.angular_velocity

    def connect(self):
        """Follow YADE: where the tool is now, and how it moves."""
        for index, body in self.body_of.items():
            self.velocities[index] = tuple(O.bodies[body].state.vel)[:2]
        if self.body_of:
            index, body = next(iter(self.body_of.items()))
            state = O.bodies[body].state
            turned = Pose(np.zeros(2), 2 * math.atan2(state.ori[2], state.ori[3]))
            self.pose = Pose(np.array(state.pos)[:2] - turned.of(self.positions[[index]])[0], turned.turn)

    def aim(self, time, period):
        """Move every particle along the chord from where it is to where the motion has it `period` s after `time`.

        Between two visits a particle is off its path by at most v w period^2 / 8, and no error ever builds up.
        """
        goal = self.motion.pose(time + period)
        places = goal.of(self.positions[list(self.body_of)]).tolist()
        for (index, body), (x, y) in zip(self.body_of.items(), places):
            state = O.bodies[body].state
            here = state.pos
            velocity = self.velocities[index] = (x - here[0]) / period, (y - here[1]) / period
            state.vel = (*velocity, 0.0)

    def add(self, indices):
        """Put particles `indices` of the tool into YADE, where the tool is now."""
        self.connect()
        places = self.pose.of(self.positions[np.asarray(indices, int)]).tolist()
        origin, velocity = self._moving_point()
        for index, (x, y) in zip(indices, places):
            body = self._body(int(index), x, y)
            state = body.state
            state.blockedDOFs, state.isDamped = access.FIXED, False
            self._set_off(int(index), state, x, y, origin, velocity)
            state.angVel = (0.0, 0.0, self.angular_velocity)
            state.ori = Quaternion((0, 0, 1), self.pose.turn)
            self.body_of[int(index)] = O.bodies.append(body)
        self.ids = list(self.body_of.values())

    def _body(self, index, x, y):
        return finite_disc((x, y), float(self.tool.radii[index]), material="steel", mask=TOOL_MASK, mass=0.0,
                           inertia=0.0)

    def _set_off(self, index, state, x, y, origin, velocity):
        """Move it as a point at (x, y) of a body does whose `origin` has this velocity."""
        self.velocities[index] = (velocity[0] - self.angular_velocity * (y - origin[1]),
                                  velocity[1] + self.angular_velocity * (x - origin[0]))
        state.vel = (*self.velocities[index], 0.0)

    def go_on(self, velocity):
        """Move straight on at another velocity (2,), m/s."""
        for index, body in self.body_of.items():
            self.velocities[index] = tuple(velocity)
            O.bodies[body].state.vel = (*velocity, 0.0)

    def _moving_point(self):
        """A point of the tool, m, and its velocity, m/s."""
        if not self.body_of:
            return self.pose.offset, self.motion.velocity(0.0)
        index = next(iter(self.body_of))
        return self.pose.of(self.positions[[index]])[0], self.velocities[index]

    def erase(self, indices):
        """Take particles out of YADE. -> strain energy (J) of the contacts that vanish with them."""
        self.connect()
        energy = 0.0
        for index in indices:
            body = self.body_of.pop(int(index), None)
            if body is None:
                continue
            del self.velocities[int(index)]
            energy += access.contact_energy(O.interactions.withBody(body))
            O.bodies.erase(body)
        self.ids = list(self.body_of.values())
        return energy

    def state(self):
        """Which body is which particle, and where the tool is."""
        return {"bodies": np.array(list(self.body_of.items()), int).reshape(-1, 2), "offset": self.pose.offset.copy(),
                "turn": self.pose.turn}

    def restore(self, state):
        """Take back what `state` gave; `connect` finds the rest in YADE."""
        self.body_of = {int(i): int(body) for i, body in state["bodies"]}
        self.ids = list(self.body_of.values())
        self.pose = Pose(state["offset"].copy(), float(state["turn"]))
        self.velocities = {}


class SphereBodies(ToolBodies):
    """The surface of a tool of spheres, moved in the plane of the cut. tool: a model.particle_tool.LayeredTool."""

    def __init__(self, tool, motion):
        super().__init__(tool, motion)
        self.positions = tool.positions[:, :2]

    def _body(self, index, x, y):
        place = x, y, float(self.tool.positions[index, 2])
        return sphere(place, float(self.tool.radii[index]), material="steel", mask=TOOL_MASK, mass=0.0, inertia=0.0)


class FacetBodies(ToolBodies):
    """A tool's facets in YADE, moved like particles; each is the triangle that facet_tool.corners gives.

    tool: a model.facet_tool.FacetTool. `positions` (m, 2) and `heights` (m,) m are the bodies' centres in the tool's
    frame as they are in YADE, `local` (m, 3, 3) m their corners about them; `reshape` brings all to the tool's
    present shape.
    """

    def __init__(self, tool, motion):
        super().__init__(tool, motion)
        self._measure()

    def _measure(self):
        triangles = corners(self.tool.boundary.vertices, self.tool.boundary.facets)
        centres = incentres(triangles)
        self.positions, self.heights, self.local = centres[:, :2], centres[:, 2], triangles - centres[:, None]

    def _body(self, index, x, y):
        body = utils.facet([(0, 0, 0), (1, 0, 0), (0, 1, 0)], material="steel", mask=TOOL_MASK)
        self._form(body, index, x, y)
        return body

    def _form(self, body, index, x, y):
        body.shape.setVertices(*[Vector3(corner) for corner in self.local[index].tolist()])
        body.state.pos = (x, y, float(self.heights[index]))

    def reshape(self):
        """Give YADE's facets the shape that the tool's boundary has now, where the tool is now."""
        self.connect()
        before = np.column_stack([self.positions, self.heights, self.local.reshape(self.count, 9)])
        origin, velocity = self._moving_point()
        self._measure()
        after = np.column_stack([self.positions, self.heights, self.local.reshape(self.count, 9)])
        changed = np.flatnonzero((before != after).any(axis=1)).tolist()
        for index, (x, y) in zip(changed, self.pose.of(self.positions[changed]).tolist()):
            body = O.bodies[self.body_of[index]]
            self._form(body, index, x, y)
            self._set_off(index, body.state, x, y, origin, velocity)
        # Facets may now reach where no contact was possible before: the collider is to run in the next step.
        access.yade_engine(NewtonIntegrator).maxVelocitySq = 0.0

    def outward(self, index):
        """(3,) normal of facet `index` in the tool's frame, of any length, as YADE has the facet."""
        first, second, third = self.local[index]
        normal = np.cross(second - first, third - first)
        # corners() puts a segment's base across the plane so that its triangle looks inwards.
        return -normal if self.tool.boundary.dimension == 2 else normal

    def meeting(self, interaction):
        """Overlap (m) of a facet and a sphere as they lie, and the direction (Vector3) from the facet to the sphere."""
        facet, sphere = O.bodies[interaction.id1], O.bodies[interaction.id2]
        if not hasattr(sphere.shape, "radius"):
            facet, sphere = sphere, facet
        state = facet.state
        place = state.ori.conjugate() * (sphere.state.pos - state.pos)
        nearest = nearest_on_triangle(np.array(place), np.array(facet.shape.vertices))
        way = place - Vector3(*nearest)
        return sphere.shape.radius - way.norm(), state.ori * way.normalized()

    def state(self):
        return {**super().state(), "positions": self.positions.copy(), "heights": self.heights.copy(),
                "local": self.local.copy()}

    def restore(self, state):
        super().restore(state)
        for name in ("positions", "heights", "local"):
            setattr(self, name, state[name].copy())

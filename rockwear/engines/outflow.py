"""Loose spheres that leave a scene."""
import numpy as np
from yade import O

from rockwear.engines import access
from rockwear.engines.base import Engine


class Outflow(Engine):
    """Erases spheres that fall below a height `below` (m), and counts what goes with them.

    bodies: ids. `erased`: how many are gone; `mass` (kg) and `kinetic` (J): that they took along.
    """

    name = "outflow"

    def __init__(self, *, bodies, below, period=1):
        super().__init__(period=period)
        self.bodies, self.below = bodies, below
        self.erased, self.mass, self.kinetic = 0, 0.0, 0.0

    def left(self):
        """Ids of the spheres that are there."""
        return [i for i in self.bodies if O.bodies[i]]

    def act(self):
        ids = self.left()
        heights = access.states(ids)[:, 1]
        for i in np.asarray(ids, int)[heights < self.below].tolist():
            state = O.bodies[i].state
            self.erased += 1
            self.mass += state.mass
            self.kinetic += 0.5 * (state.mass * state.vel.squaredNorm() + state.inertia[0] * state.angVel.squaredNorm())
            O.bodies.erase(i)

    def state(self):
        return {"erased": self.erased, "mass": self.mass, "kinetic": self.kinetic}

    def restore(self, state):
        self.erased, self.mass, self.kinetic = int(state["erased"]), float(state["mass"]), float(state["kinetic"])

    def log(self):
        return {"mass_drained": (self.mass, "kg")}

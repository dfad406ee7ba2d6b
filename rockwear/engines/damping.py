"""Background damping of the rock."""
import math

from yade import O, utils

from rockwear.engines.access import FIXED
from rockwear.engines.base import Engine


class BackgroundDamping(Engine):
    """F = -rate m v and T = -rate I omega on the rock, as its exact solution v(t) = v(0) exp(-rate t) between visits.

    rate: 1/s; bodies: ids. The operator split has an error of the order rate x period, and saves a force on each body
    in each step. The kinetic energy dissipated is exact: YADE's sum before the visit, times 1 - exp(-2 rate t).
    """

    name = "background_damping"

    def __init__(self, *, rate, bodies, period=1):
        super().__init__(period=period)
        self.rate, self.bodies = rate, bodies
        self.dissipated = 0.0

    def connect(self):
        self.states = [O.bodies[i].state for i in self.bodies]

    def act(self):
        factor = math.exp(-self.rate * self.elapsed())
        self.dissipated += utils.kineticEnergy() * (1 - factor * factor)
        for state in self.states:
            # What a window holds aside now may be rock later.
            if state.blockedDOFs != FIXED:
                state.vel = state.vel * factor
                state.angVel = state.angVel * factor

    def state(self):
        return {"dissipated": self.dissipated}

    def restore(self, state):
        self.dissipated = float(state["dissipated"])

"""A known load on a tool whose sliding is prescribed: the dead weight of a laboratory test."""
import numpy as np
from yade import O

from rockwear.engines.access import collide_next_step
from rockwear.engines.base import Engine


class DeadLoad(Engine):
    """Keeps a rigid tool without inertia at the height over the flat y = 0 at which its contacts carry the load.

    bodies: the tool's bodies; load: N; kn: N/m of each contact. The height at which sum kn (overlap)+ = load is found
    exactly, so that no force is lost while the tool wears. The tool settles at once in a visit, which is needed only
    after its shape has changed.
    """

    name = "dead_load"

    def __init__(self, *, bodies, load, kn, period=None):
        super().__init__(period=period)
        self.bodies, self.load, self.kn = bodies, load, kn
        self.descent = 0.0

    def act(self):
        bodies, tool = self.bodies, self.bodies.tool
        bodies.connect()
        indices = list(bodies.body_of)
        height = sinking_height(tool.positions[indices, 1] - tool.radii[indices], self.load / self.kn)
        fall = float(bodies.pose.offset[1] - height)
        if fall == 0:
            return
        for body in bodies.ids:
            state = O.bodies[body].state
            state.pos = state.pos - (0, fall, 0)
        self.descent += fall
        collide_next_step()

    def state(self):
        return {"descent": self.descent}

    def restore(self, state):
        self.descent = float(state["descent"])


def sinking_height(lowest, total):
    """Height (m) at which points `lowest` (n,) m are `total` (m) deep in all: sum (-lowest - height)+ = total."""
    rising = np.sort(lowest)
    depths = (total + np.cumsum(rising)) / np.arange(1, len(rising) + 1)
    return -float(depths[np.flatnonzero(depths > rising)[-1]])

"""The end of a motion that comes to rest."""
from yade import utils

from rockwear.engines.base import Engine, RunEnded


class Rest(Engine):
    """Ends the run when the kinetic energy of all bodies has been below `limit` (J) at `visits_at_rest` visits one
    after the other.

    watching: a function telling whether the run may end now.
    """

    name = "rest"
    visits_at_rest = 10

    def __init__(self, *, limit, watching, period=1):
        super().__init__(period=period)
        self.limit, self.watching, self.calm = limit, watching, 0

    def act(self):
        self.calm = self.calm + 1 if self.watching() and utils.kineticEnergy() < self.limit else 0
        if self.calm >= self.visits_at_rest:
            raise RunEnded("the heap is at rest", True)

    def state(self):
        return {"calm": self.calm}

    def restore(self, state):
        self.calm = int(state["calm"])

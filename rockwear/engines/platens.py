"""Loading of a specimen between its two ends."""
import math

from yade import O

from rockwear.engines.base import Engine


class Platens(Engine):
    """Two sets of bodies whose velocity along x is prescribed: `velocity` (m/s) on the right, its opposite on the left.

    left, right: ids. Pull is the force (N) that the platens exert outwards on the specimen, the mean of both ends;
    positive in tension.
    """

    name = "platens"

    def __init__(self, *, left, right, velocity, period=1):
        super().__init__(period=period)
        self.left, self.right, self.velocity = left, right, velocity
        self.work = self.impulse = self.unbalanced = self.time = 0.0

    def act(self):
        elapsed, force = self.elapsed(), O.forces.f
        left, right = (math.fsum(force(i)[0] for i in ids) for ids in (self.left, self.right))
        pull = 0.5 * (left - right)
        self.work += 2 * self.velocity * pull * elapsed
        self.impulse += pull * elapsed
        self.unbalanced += (left + right) * elapsed
        self.time += elapsed

    def take_mean(self):
        """(pull, difference of the two ends), N, each the mean since the last call."""
        means = (self.impulse / self.time, self.unbalanced / self.time) if self.time else (0.0, 0.0)
        self.impulse = self.unbalanced = self.time = 0.0
        return means

    def state(self):
        return {"work": self.work, "impulse": self.impulse, "unbalanced": self.unbalanced, "time": self.time}

    def restore(self, state):
        for name, value in state.items():
            setattr(self, name, float(value))

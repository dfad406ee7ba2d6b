"""The end of a strength test."""
from rockwear.engines.base import Engine, RunEnded


class Failure(Engine):
    """Ends the run when the stress has fallen to a part `drop` of its peak, by more than `noise`, and bonds are broken.

    stress: a function giving it (Pa); broken: a function telling whether any bond is broken; beside: Pa that the
    specimen bears beside it, which its strength has too; noise: Pa.
    """

    name = "failure"

    def __init__(self, *, stress, broken, drop, beside=0.0, noise=0.0, period=1):
        super().__init__(period=period)
        self.stress, self.broken, self.drop, self.beside, self.noise = stress, broken, drop, beside, noise
        self.peak = 0.0

    def act(self):
        stress = self.stress()
        self.peak = max(self.peak, stress)
        if self.has_fallen(stress) and self.broken():
            raise RunEnded(f"failed at {(self.peak + self.beside) / 1e6:.4g} MPa", True)

    def has_fallen(self, stress):
        """Whether this stress (Pa) is so far below the peak."""
        return stress < self.drop * self.peak and self.peak - stress > self.noise

    def state(self):
        return {"peak": self.peak}

    def restore(self, state):
        self.peak = float(state["peak"])

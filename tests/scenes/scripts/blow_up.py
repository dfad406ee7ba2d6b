"""The test tooth with a time step that its own check would never let pass."""

from rockwear.run import main as run
from rockwear.scenes import cutting


class Unstable(cutting.Cutting):
    def _choose_time_step(self, v):
        super()._choose_time_step(v)
        self.time_step = 3 * self.bonded_step


run.main("unstable", cutting.PARAMETERS, Unstable)

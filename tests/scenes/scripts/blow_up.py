"""The test tooth with a time step that its own check would never let pass."""
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
sys.path.insert(0, ROOT)

from rockwear import cutting, run  # noqa: E402


class Unstable(cutting.Cutting):
    def _choose_time_step(self, v):
        super()._choose_time_step(v)
        self.time_step = 3 * self.bonded_step


run.main("unstable", cutting.PARAMETERS, Unstable)

"""Accuracy against speed: the time step, and how often engines look."""
from dataclasses import dataclass

from rockwear.kernels.checks import require


@dataclass(frozen=True)
class Accuracy:
    """The knobs of a scene, each with its price in calibration/results/bench.md.

    time_step_fraction: of the critical step; time_step: s, itself, 0 for that fraction; rock_sampling_period,
    wear_period, damping_period: steps; heat_period, surface_period, record_period: s of the process.
    """

    time_step_fraction: float
    time_step: float
    rock_sampling_period: int
    wear_period: int
    damping_period: int
    heat_period: float
    surface_period: float
    record_period: float

    def step(self, critical):
        """The time step (s) of a scene with this critical one. Raises ParameterError for one above it."""
        if not self.time_step > 0:
            return self.time_step_fraction * critical
        require(self.time_step <= critical, "time_step", self.time_step,
                f"at most the stable step {critical:.3e} of this scene",
                "s")
        return self.time_step

"""Accuracy against speed: the time step, and how often engines look."""
from dataclasses import dataclass

from rockwear.kernels.checks import require


def chosen_step(v, critical):
    """The time step (s) that v.time_step (s) or, where it is 0, v.time_step_fraction gives a scene with this critical
    one (s). Raises ParameterError for one above it."""
    require(v.time_step <= critical, "time_step", v.time_step, f"at most the stable step {critical:.3e} of this scene",
            "s")
    return v.time_step or v.time_step_fraction * critical


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

"""A run of a scene that is nothing but its steps: of a spring k that carries a mass m for a time."""
import math
from types import SimpleNamespace

from rockwear.kernels.parameter import Group, Parameter, above_zero, duration
from rockwear.run.main import main

OSCILLATOR = Group("oscillator", (
    Parameter("k", 1e6, "N/m", above_zero, "stiffness"), Parameter("density", 1e3, "kg/m3", above_zero, "of 1 m3"),
    Parameter("width", 1.0, "m", above_zero, "not of the spring"), Parameter("time", 1.0, "s", duration, "of the run")))


def make_scene(values):
    time_step = math.sqrt(values["density"] / values["k"])
    return SimpleNamespace(time_step=time_step, stages=[("swing", values["time"] / time_step)])


main("steps", [OSCILLATOR], make_scene)

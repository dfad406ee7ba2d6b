"""A run of a scene that is nothing but its steps: of a spring k that carries a mass m for a time."""
import math
from types import SimpleNamespace

from rockwear.kernels.parameter import Fixed, Group, Parameter, above_zero, duration, flag, zero_or
from rockwear.run.main import main

OSCILLATOR = Group("oscillator", (
    Parameter("k", 1e6, "N/m", above_zero, "stiffness"), Parameter("density", 1e3, "kg/m3", above_zero, "of 1 m3"),
    Parameter("width", 1.0, "m", above_zero, "not of the spring"), Parameter("time", 1.0, "s", duration, "of the run"),
    Parameter("stiff", False, "", flag, "a stiff spring", presets=Fixed(k=1e15)),
    Parameter("time_step", 0.0, "s", zero_or(1e-15, 1), "given; 0: that of the spring")))


def make_scene(values):
    time_step = values["time_step"] or math.sqrt(values["density"] / values["k"])
    return SimpleNamespace(time_step=time_step, stages=[("swing", values["time"] / time_step)])


main("steps", [OSCILLATOR], make_scene)

"""Stresses of a disc pressed along a diameter, as in the Brazilian test. Forces are per metre of thickness."""
import math

import numpy as np

from rockwear.kernels.checks import positive


def tensile_strength(force, diameter):
    """2 P / (pi D), Pa: the tension at the centre at the peak force, (ISRM 1978), the suggested method's 0.636 P/(D t).

    force: N/m; diameter: m.
    """
    return 2 * force / (math.pi * positive("diameter", diameter, "m"))


def centre_stresses(force, diameter, half_angle=0.0, gauge=0.0):
    """(across, along) the loading at the centre, Pa, tension positive (Hondros 1959).

    The force comes as an even radial pressure over arcs of 2 half_angle (rad):
    2P/(pi D) (sin 2a / a - 1) and -2P/(pi D) (sin 2a / a + 1), which for a = 0 are 2P/(pi D) and -6P/(pi D).
    gauge: the mean over a circle of so many radii about the centre; both are smaller by its square times 2P/(pi D)
    there. That is exact for a = 0, as stress is biharmonic: its mean is that at the centre + r^2/8 of its Laplacian.
    """
    part = 2 * np.sinc(2 * half_angle / math.pi)
    stress = tensile_strength(force, diameter)
    return stress * (part - 1 - gauge**2), -stress * (part + 1 - gauge**2)

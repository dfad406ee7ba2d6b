"""What a steady cut of sandstone should look like: ranges to judge a simulated cut by.

They are an orientation and no validation: each range says on what it rests.
- recalled: from the literature, not read again;
- seen: in an abstract or a table, widened where so little was said;
- target: what this project asks of a cut.
Forces are per metre of width, angles in radians.
"""
import math
from typing import NamedTuple

import numpy as np

from rockwear.kernels import cutting_theory
from rockwear.kernels.checks import not_negative, positive, require
from rockwear.kernels.steady_record import Measured

RECALLED, SEEN, TARGET = "recalled", "seen, widened", "target"
NEAR_ANGLE, NEAR = math.radians(2.5), 0.1
"""How far (rad, relative) a cut may be from the rake, depth or strength that a range is for. (Ours.)"""
SCRATCH_STRENGTH, SCRATCH_DEPTHS, SCRATCH_RAKES = 49e6, (0.25e-3, 1e-3), (math.radians(-20), math.radians(-15))
SCRATCH_ENERGY, SCRATCH_THRUST = (32e6, 59e6), (0.55, 0.85)
"""Specific energy, J/m3, which is the mean cutting force over the depth, and thrust over cutting force of a scratch."""
GROOVE_DEPTH, GROOVE_RAKE = 5e-3, math.radians(-5)
GROOVE_FORCES = {30e6: (40e3, 87e3), 50e6: (66e3, 144e3), 75e6: (98e3, 215e3)}
"""Mean cutting force, N/m, by uniaxial compressive strength, Pa, for a sharp dry tool with a clearance of 5 degrees in
rock of a twelfth of that in tension. These are 1.04 to 2.28 times Roxborough's regression of the specific energy,
0.25 UCS + 0.11 MJ/m3 (recalled), and so linear in between."""
GROOVE_PEAKS = 2.0, 3.0
CHIP_DEPTHS, EVANS_FACTORS = (1e-3, 20e-3), (0.5, 2.0)
"""Depths at which a sharp tool makes chips, and peak cutting force over that of Evans."""
ENERGY_TARGET, PEAKS_TARGET, OVERBREAK_TARGET = (0.1, 0.4), (2.0, 4.0), (0.0, 1.0)
"""Specific energy over UCS at GROOVE_DEPTH, mean peak over mean, overbreak over depth."""


class Range(NamedTuple):
    """What an observable should be: its name among the results of a run, both limits, on what they rest, for what."""

    observable: str
    low: float
    high: float
    unit: str
    basis: str
    case: str

    def verdict(self, value, standard_error=0.0):
        """"inside", "below", "above" or "not known"; with ", within the error" if the limit is within twice that; "not
        told" of a side on which the value is by less."""
        if math.isnan(value):
            return "not known"
        if self.low <= value <= self.high:
            margin = min(value - self.low, self.high - value)
            half_line = math.isinf(self.high - self.low)
            return "not told" if half_line and margin < 2 * standard_error else "inside"
        missed = max(self.low - value, value - self.high)
        side = "below" if value < self.low else "above"
        return f"{side}, within the error" if missed <= 2 * standard_error else side


RELATIONS = (
    Range("scratch_force_exponent", 0.9, 1.1, "-", RECALLED, "mean cutting force over depth, scratch"),
    Range("chip_force_exponent", 0.5, 1.0, "-", RECALLED, "mean cutting force over depth, 1 to 20 mm, UCS 48 MPa"),
    Range("force_over_rake", -math.inf, 0.0, "N/m", RECALLED, "change of the mean cutting force per rad of rake"),
    Range("flat_thrust", 0.5, 1.0, "-", RECALLED, "thrust that a wear flat of 1 or 2 mm adds, over UCS times the flat"),
    Range("flat_cutting_over_thrust", 0.5, 0.85, "-", RECALLED, "cutting force that a wear flat adds, over the thrust"),
    Range("wet_force", 0.95, 1.2, "-", SEEN, "mean cutting force in wet rock, of its wet strengths, over that in dry"),
    Range("wet_specific_energy", 1.0, 1.35, "-", SEEN, "specific energy in wet rock over that in dry"))
"""Ranges of what several cuts tell together."""


def expected(*, compressive_strength, tensile_strength, depth, rake, wear_flat=0.0):
    """[Range] of every observable of one cut that something is known of; each limit in the unit of the result.

    compressive_strength UCS, tensile_strength: Pa; depth: of cut, m; rake: rad; wear_flat: m; only targets are known of
    a tool that has one. Raises ParameterError.
    """
    strength, depth = positive("compressive_strength", compressive_strength, "Pa"), positive("depth", depth, "m")
    blunt = not_negative("wear_flat", wear_flat, "m") > 0
    sharp = [] if blunt else [*_scratch(strength, depth, rake), *_groove(strength, depth, rake),
                              *_evans(tensile_strength, depth, rake)]
    return sharp + _targets(strength, depth)


def _near(value, low, high):
    """Whether a value is in a range, or nearly."""
    return (1 - NEAR) * low <= value <= (1 + NEAR) * high


def _scratch(strength, depth, rake):
    low, high = SCRATCH_RAKES
    if not (_near(strength, SCRATCH_STRENGTH, SCRATCH_STRENGTH) and _near(depth, *SCRATCH_DEPTHS)
            and low - NEAR_ANGLE <= rake <= high + NEAR_ANGLE):
        return []
    case = "scratch, UCS 49 MPa, rake -15 to -20°, no flat, 0.25 to 1 mm deep"
    return [Range("specific_energy", *SCRATCH_ENERGY, "J/m3", RECALLED, case),
            Range("thrust_over_cutting", *SCRATCH_THRUST, "-", RECALLED, case)]


def _groove(strength, depth, rake):
    strengths = list(GROOVE_FORCES)
    if not (strengths[0] <= strength <= strengths[-1] and _near(depth, GROOVE_DEPTH, GROOVE_DEPTH)
            and abs(rake - GROOVE_RAKE) <= NEAR_ANGLE):
        return []
    low, high = (float(np.interp(strength, strengths, limits)) for limits in zip(*GROOVE_FORCES.values()))
    case = "groove, UCS 30 to 75 MPa, rake -5°, sharp, dry, 5 mm deep"
    return [Range("mean_cutting_force", low, high, "N/m", RECALLED, case),
            Range("peak_over_mean", *GROOVE_PEAKS, "-", RECALLED, case)]


def _evans(tensile_strength, depth, rake):
    if not CHIP_DEPTHS[0] <= depth <= CHIP_DEPTHS[1]:
        return []
    peak = cutting_theory.evans(tensile_strength=tensile_strength, depth=depth, rake=rake)
    return [Range("mean_peak_cutting_force", *(factor * peak for factor in EVANS_FACTORS), "N/m", RECALLED,
                  "chip, 1 to 20 mm deep, sharp: half to twice Evans")]


def _targets(strength, depth):
    case = "steady cut"
    found = [Range("peak_over_mean", *PEAKS_TARGET, "-", TARGET, case),
             Range("overbreak", *(part * depth for part in OVERBREAK_TARGET), "m", TARGET, case)]
    if _near(depth, GROOVE_DEPTH, GROOVE_DEPTH):
        found.append(Range("specific_energy", *(part * strength for part in ENERGY_TARGET), "J/m3", TARGET,
                           "5 mm deep: 10 to 40 % of the UCS"))
    return found


def exponent(depth, force, standard_error):
    """Measured exponent n of force ~ depth^n, by least squares of log(force), weighted with (force / standard_error)^2.

    depth (k,) m, force, standard_error (k,) N/m. The error follows from those of the forces, or from their scatter
    about the power where that is larger. Raises ParameterError for fewer than two depths or a force that is not
    positive.
    """
    depth, force, standard_error = (np.asarray(x, float) for x in (depth, force, standard_error))
    require(len(np.unique(depth)) > 1, "depth", len(np.unique(depth)), "at least two different depths")
    for name, values, unit in (("force", force, "N/m"), ("standard_error", standard_error, "N/m")):
        require(bool(np.all(values > 0)), name, float(values.min()), "greater than 0", unit)
    weight, x, y = (force / standard_error)**2, np.log(depth), np.log(force)
    x, y = x - np.average(x, weights=weight), y - np.average(y, weights=weight)
    spread = np.sum(weight * x**2)
    slope = float(np.sum(weight * x * y) / spread)
    scatter = np.sum(weight * (y - slope * x)**2) / (len(x) - 2) if len(x) > 2 else 0.0
    return Measured(slope, math.sqrt(max(1.0, scatter) / spread))

"""Fracture mechanics of the compact tension specimen, and what a test of it tells about the toughness of a rock.

W, m, is the distance from the load line to the specimen's back, a the length of notch and crack from the load line,
alpha = a/W; forces are per metre of thickness.
"""
import math

import numpy as np

from rockwear.kernels.checks import positive, require

FACTOR = 0.886, 4.64, -13.32, 14.72, -5.6
COMPLIANCE = 2.163, 12.219, -20.065, -0.9925, 20.609, -9.9314
SHORTEST, LONGEST = 0.2, 0.95
"""alpha in which both formulas hold."""


def _polynomial(coefficients, x):
    return np.polynomial.polynomial.polyval(x, coefficients)


def intensity_factor(alpha):
    """f in K = P f(alpha) / sqrt(W), (Srawley 1976), the formula of ASTM E399 for the compact tension specimen; within
    0.5 % for alpha >= 0.2. alpha: number or array."""
    alpha = np.asarray(alpha, float)
    return (2 + alpha) / (1 - alpha)**1.5 * _polynomial(FACTOR, alpha)


def compliance(alpha):
    """E' u / P, u the opening at the load line (Saxena and Hudak 1978), the formula of ASTM E1820.

    Its slope must be 2 f(alpha)^2, as P^2/2 dC/da = K^2/E': it is within 1.5 % of that for alpha >= 0.4, 9 % too steep
    at 0.3 and 27 % at 0.2.
    """
    alpha = np.asarray(alpha, float)
    return ((1 + alpha) / (1 - alpha))**2 * _polynomial(COMPLIANCE, alpha)


_ALPHAS = np.linspace(SHORTEST, LONGEST, 4001)
_COMPLIANCES = compliance(_ALPHAS)


def equivalent_crack(dimensionless):
    """alpha of the sharp crack that makes a specimen so compliant: the inverse of `compliance`, within [SHORTEST,
    LONGEST]. dimensionless: E' u / P, number or array."""
    return np.interp(dimensionless, _COMPLIANCES, _ALPHAS)


ELASTIC_RANGE = 0.2, 0.5
"""Forces over the peak between which the stiffness of the specimen is taken."""
ONSET, END = 0.1, 0.85
"""The crack has left the notch at this part of the ligament; alpha up to which its energy counts."""


def resistance_curve(*, force, opening, width, notch):
    """What a compact tension test tells: {name: number or (n,) array}.

    force: (n,) N/m; opening: (n,) m, at the load line; width: W, m; notch: alpha of the notch. nan where the test is
    too short.
    - modulus, E' (Pa): from the first forces over openings, as the notch is known;
    - crack, (n,): alpha of the sharp crack as compliant as the specimen at that moment (it unloads to the origin);
    - intensity, (n,): K (Pa sqrt(m)) of that crack;
    - dissipated, (n,): J per m of thickness, the work less P u/2;
    - peak_intensity: K at the peak force for the notch as it was cut;
    - energy: dissipated per area of crack (J/m2), between the crack's ONSET and the end of the test or END.
    With a process zone of size c the peak's K is too low unless c << W; the energy includes all that a growing crack
    takes.
    """
    positive("width", width, "m")
    require(SHORTEST <= notch < END, "notch", notch, f"from {SHORTEST:g} to {END:g}")
    force, opening = np.asarray(force, float), np.asarray(opening, float)
    require(len(force) > 0, "force", "without rows", "a record of at least one", "N/m")
    peak = int(np.argmax(force))
    top = force[peak]
    above = int(np.argmax(force >= ELASTIC_RANGE[1] * top))
    rows = np.flatnonzero(force[:above + 1] >= ELASTIC_RANGE[0] * top)
    if len(rows) < 3:
        nothing = np.full(len(force), math.nan)
        return dict(modulus=math.nan, crack=nothing, intensity=nothing, dissipated=nothing,
                    peak_intensity=float(top * intensity_factor(notch) / math.sqrt(width)), energy=math.nan)
    # Through the origin: the waves that the first motion sends through the specimen then count for little.
    modulus = float(force[rows] @ opening[rows] / (opening[rows] @ opening[rows]) * compliance(notch))
    loaded = force > 0
    flexibility = np.divide(modulus * opening, force, out=np.full(len(force), np.inf), where=loaded)
    crack = np.where(np.arange(len(force)) < rows[0], notch, equivalent_crack(flexibility))
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(opening))])
    dissipated = work + 0.5 * force[0] * opening[0] - 0.5 * force * opening
    intensity = force * intensity_factor(crack) / math.sqrt(width)
    return dict(modulus=modulus, crack=crack, intensity=intensity, dissipated=dissipated,
                peak_intensity=float(top * intensity_factor(notch) / math.sqrt(width)),
                energy=_energy(crack[peak:], dissipated[peak:], width, notch))


def _energy(crack, dissipated, width, notch):
    # Between two moments: the last before the onset, or the peak, and the last of the test or the first past END. A
    # crack may run from one to the other at once.
    begun, past = crack >= notch + ONSET * (1 - notch), crack >= END
    if not begun.any():
        return math.nan
    begin = max(int(np.argmax(begun)) - 1, 0)
    end = int(np.argmax(past)) if past.any() else len(crack) - 1
    grown = (crack[end] - crack[begin]) * width
    return float((dissipated[end] - dissipated[begin]) / grown) if end > begin and grown > 0 else math.nan


def toughness(modulus, energy):
    """K_IC = sqrt(E' G_f) (Irwin), Pa sqrt(m). modulus: Pa; energy: J/m2."""
    return math.sqrt(modulus * energy) if modulus * energy >= 0 else math.nan


def size_effect(sizes, peaks):
    """What K at the peak force of similar specimens goes to as they grow, and how fast.

        1/K_peak^2 = (1 + W_0/W) / K^2

    (Bažant 1984, the law of size for blunt fracture), by least squares over 1/W. sizes: (n,) m, W; peaks: (n,)
    Pa sqrt(m). -> K (Pa sqrt(m)), W_0 (m), the size at which K_peak is K/sqrt(2); both nan where the peaks grow as
    strength alone makes them, so that there is no bound. Raises ParameterError for fewer than two sizes.
    """
    require(len(set(sizes)) > 1, "sizes", sizes, "at least two", "m")
    slope, inverse = np.polyfit(1.0 / np.asarray(sizes, float), np.asarray(peaks, float)**-2.0, 1)
    if inverse <= 0.0:
        return math.nan, math.nan
    return 1.0 / math.sqrt(inverse), float(slope / inverse)

"""Archard's wear law with a hardness that depends on temperature [Rojek 2003, ch. 6; Rojek 2014, ch. 4].

A surface under the pressure p that slides at the speed v is worn at the rate

    dw/dt = k p v / H(theta)                      [Rojek 2003, eq. 6.7; Rojek 2014, eq. 61]

or, with Coulomb friction p_t = mu p and the dissipation rate D = p_t v per area,

    dw/dt = (k / mu) D / H(theta)                 [Rojek 2003, eq. 6.9]

so that the friction work W wears the volume V = (k / mu) W / H, independent of the area over which it is distributed.
The laws by particle or facet, which the engines use, are in wear_laws.
"""
import warnings

import numpy as np

from rockwear.kernels.checks import ParameterError, not_negative, positive, require

KELVIN = 273.15
BRINELL = 9.80665e6
"""Pa per HB: Brinell numbers are in kgf/mm2. ([Rojek 2003] rounds to 10e6.)"""


class Hardness:
    """Brinell hardness as a function of temperature, piecewise linear in a table [Rojek 2003, eq. 6.6].

    celsius: (n,) increasing temperatures in deg C; brinell: (n,) positive HB in kgf/mm2.
    An instance called with kelvin (scalar or array) returns Pa. Outside the table the value of the nearest row is used,
    with one warning; nan gives nan. Raises ParameterError for an empty table, temperatures that do not increase or lie
    below 0 K, values that are not finite, hardness not above 0, and lengths that differ.
    """

    def __init__(self, celsius, brinell):
        self.kelvin = np.atleast_1d(np.asarray(celsius, float)) + KELVIN
        self.pascal = np.atleast_1d(np.asarray(brinell, float)) * BRINELL
        require(self.kelvin.ndim == 1 and self.kelvin.shape == self.pascal.shape, "brinell", np.shape(brinell),
                f"of the shape of celsius, {np.shape(celsius)}")
        require(self.kelvin.size > 0 and np.all(np.isfinite(self.kelvin)) and np.all(np.diff(self.kelvin) > 0)
                and self.kelvin[0] >= 0, "celsius", list(np.ravel(celsius)),
                f"one temperature or more, finite, increasing and at least {-KELVIN:g}", "deg C")
        require(np.all(np.isfinite(self.pascal)) and np.all(self.pascal > 0),
                "brinell", list(np.ravel(brinell)), "finite and greater than 0", "kgf/mm2")
        self._warned = False

    @classmethod
    def constant(cls, pascal):
        """A hardness (Pa) independent of temperature. Raises ParameterError unless it is greater than 0."""
        return cls([20.0], [positive("hardness", pascal, "Pa") / BRINELL])

    @property
    def limits(self):
        """The temperatures (K) of the first and the last row."""
        return float(self.kelvin[0]), float(self.kelvin[-1])

    def __call__(self, kelvin):
        kelvin = np.asarray(kelvin, float)
        if not self._warned and kelvin.size and self.leaves(np.min(kelvin), np.max(kelvin)):
            self._warned = True
            warnings.warn(f"temperature {np.min(kelvin):.1f} to {np.max(kelvin):.1f} K leaves the hardness table "
                          f"({self.kelvin[0]:.1f} to {self.kelvin[-1]:.1f} K): the nearest row holds", stacklevel=2)
        return self.nearest(kelvin)

    def nearest(self, kelvin):
        """Hardness (Pa) as by a call, without a warning: for callers that check `leaves` themselves."""
        found = np.where(np.isnan(kelvin), np.nan, np.interp(kelvin, self.kelvin, self.pascal))
        return float(found) if found.ndim == 0 else found

    def leaves(self, low, high):
        """Whether the range of temperatures (K) low..high exceeds the table; False for a constant hardness."""
        first, last = self.limits
        return first < last and (low < first or high > last)


MET71 = Hardness([0, 200, 300, 400, 500, 600], [500, 491, 480, 439, 362, 241])
"""Steel MET 71 [Rojek 2003, table 6.1]."""
MET91 = Hardness([0, 200, 300, 400, 500, 600], [515, 509, 498, 457, 375, 247])
"""Steel MET 91 [Rojek 2003, table 6.1]."""


def wear_rate(*, k, pressure, slip_velocity, hardness):
    """Rate of the worn depth (m/s), k p v / H [Rojek 2003, eq. 6.7; Rojek 2014, eq. 61].

    k: wear coefficient of Archard's law (-); pressure: Pa, scalar or array; slip_velocity: m/s, of any sign;
    hardness: Pa at the temperature of the surface. Raises ParameterError for k < 0, pressure < 0 or hardness <= 0.
    """
    not_negative("k", k)
    pressure, hardness = np.asarray(pressure, float), np.asarray(hardness, float)
    if not np.all(pressure >= 0):
        raise ParameterError("pressure", float(np.min(pressure)), "at least 0", "Pa")
    if not np.all(hardness > 0):
        raise ParameterError("hardness", float(np.min(hardness)), "greater than 0", "Pa")
    rate = k * pressure * np.abs(slip_velocity) / hardness
    return float(rate) if np.ndim(rate) == 0 else rate


def wear_coefficient(*, depth, pressure, distance, hardness):
    """Wear coefficient (-) of a laboratory test at constant p and H, k = w H / (p s) [Rojek 2003, eq. 6.11].

    depth: worn depth w, m; pressure: Pa; distance: sliding distance s, m; hardness: Pa.
    Raises ParameterError unless all are positive.
    """
    return (positive("depth", depth, "m") * positive("hardness", hardness, "Pa")
            / (positive("pressure", pressure, "Pa") * positive("distance", distance, "m")))

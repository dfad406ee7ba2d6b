"""Archard's wear law with a hardness that depends on temperature (M ch. 6, P ch. 4).

A surface under the pressure p that slides at the speed v loses depth at the rate

    dw/dt = k p v / H(theta)                                     (M 6.7, P 61)

or, with Coulomb friction p_t = mu p and the dissipation rate D = p_t v per area,

    dw/dt = (k / mu) D / H(theta)                                (M 6.9)

so that the friction work W wears the volume V = (k / mu) W / H, whatever the area it is spread over. The laws that
engines use, by particle, are in wear_laws.
"""
import warnings

import numpy as np

from rockwear.kernels.checks import ParameterError, not_negative, positive, require

KELVIN = 273.15
BRINELL = 9.80665e6
"""Pa per HB: Brinell numbers are kgf/mm2. (M rounds to 10e6.)"""


class Hardness:
    """Brinell hardness against temperature, piecewise linear between the rows of a table (M 6.6).

    celsius: (n,) rising temperatures in deg C; brinell: (n,) positive HB in kgf/mm2.
    Called with kelvin (scalar or array) it gives Pa. Outside the table the nearest row holds, with one warning.
    Raises ParameterError for a table that is not rising, not positive, not finite or not of equal lengths.
    """

    def __init__(self, celsius, brinell):
        self.kelvin = np.atleast_1d(np.asarray(celsius, float)) + KELVIN
        self.pascal = np.atleast_1d(np.asarray(brinell, float)) * BRINELL
        require(self.kelvin.ndim == 1 and self.kelvin.shape == self.pascal.shape, "brinell", np.shape(brinell),
                f"of the shape of celsius, {np.shape(celsius)}")
        require(np.all(np.isfinite(self.kelvin)) and np.all(np.diff(self.kelvin) > 0),
                "celsius", list(np.ravel(celsius)), "finite and rising", "deg C")
        require(np.all(np.isfinite(self.pascal)) and np.all(self.pascal > 0),
                "brinell", list(np.ravel(brinell)), "finite and greater than 0", "kgf/mm2")
        self._warned = False

    @classmethod
    def constant(cls, pascal):
        """A hardness (Pa) that does not depend on temperature."""
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
        """The same without a warning, for those who ask `leaves` themselves."""
        found = np.interp(kelvin, self.kelvin, self.pascal)
        return float(found) if found.ndim == 0 else found

    def leaves(self, low, high):
        """True where temperatures (K) from low to high leave the table; a constant hardness has no end."""
        first, last = self.limits
        return first < last and (low < first or high > last)


MET71 = Hardness([0, 200, 300, 400, 500, 600], [500, 491, 480, 439, 362, 241])
"""Steel MET 71 (M table 6.1)."""
MET91 = Hardness([0, 200, 300, 400, 500, 600], [515, 509, 498, 457, 375, 247])
"""Steel MET 91 (M table 6.1)."""


def wear_rate(*, k, pressure, slip_velocity, hardness):
    """Rate of the worn depth, k p v / H (M 6.7, P 61), m/s.

    k: Archard's coefficient (-); pressure: Pa, scalar or array; slip_velocity: m/s, its sign does not matter;
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
    """k of a laboratory test, w H / (p s) (M 6.11, integrated over the sliding distance s at constant p and H), -.

    depth: worn depth (m); pressure: Pa; distance: m; hardness: Pa. Raises ParameterError unless all are positive.
    """
    return (positive("depth", depth, "m") * positive("hardness", hardness, "Pa")
            / (positive("pressure", pressure, "Pa") * positive("distance", distance, "m")))

"""Trends of a parameter study: does a property rise, fall or stay over the range of a parameter?"""
import math
from typing import NamedTuple

import numpy as np

NOTICED, EXCLUDED = 0.1, 0.25
"""Change over the range of a parameter, over the mean, below which a property counts as unchanged, where the packings
exclude the larger one."""
CERTAIN = 2.0
"""Change over its standard error from which it is none of the packings' scatter."""


class Trend(NamedTuple):
    """exponent: of the power law y ~ x**exponent through all points; change: of y over the range of x by that law, a
    factor less 1; error: standard error of ln(1 + change), nan of two points."""

    exponent: float
    change: float
    error: float

    @property
    def word(self):
        """rises, falls, unchanged, or unclear: a change that is not CERTAIN, or not certain to be small."""
        if abs(self.change) <= NOTICED:
            most = abs(math.log1p(self.change)) + CERTAIN * self.error
            return "unchanged" if most <= math.log1p(EXCLUDED) else "unclear"
        if not abs(math.log1p(self.change)) > CERTAIN * self.error:
            return "unclear"
        return "rises" if self.change > 0 else "falls"


def trend(x, y):
    """Trend of y over x, (n,) both above 0: least squares of ln y on ln x."""
    x, y = np.log(np.asarray(x, float)), np.log(np.asarray(y, float))
    off = x - x.mean()
    spread = float(off @ off)
    exponent = float(off @ y) / spread
    residual = y - y.mean() - exponent * off
    free = len(x) - 2
    error = math.sqrt(float(residual @ residual) / free / spread) if free > 0 else math.nan
    span = float(x.max() - x.min())
    return Trend(exponent, math.expm1(exponent * span), error * span)


def verdict(stated, found):
    """How the word of a Trend compares with the stated one: agrees, disagrees or unclear."""
    if found == "unclear":
        return "unclear"
    return "agrees" if found == stated else "disagrees"

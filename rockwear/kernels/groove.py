"""The groove that a cut leaves behind: the top of the rock mass, and how far it lies below or above the tool's path."""
import math

import numpy as np

from rockwear.kernels.checks import positive, within
from rockwear.kernels.steady_record import UNKNOWN, Measured, integral, mean, sample_mean, with_error

EXCEEDED = 0.1
"""Part of the groove's length on which it is deeper than the overbreak."""
ROUND_OFF = 1e-9
"""Part of a chip by which a groove may be too short for it."""


def groove_profile(positions, radii, of_mass, x_edges):
    """(b,) m, height of the top of the rock mass in each bin between x_edges (b + 1,) m; nan in empty bins.

    positions (n, 2) m, radii (n,) m, of_mass (n,) bool: discs, and those that are rock mass. A disc reaches up to y + r
    in the bin of its centre and up to y + sqrt(r^2 - dx^2) in others, dx being the distance of the centre to the bin.
    """
    edges = np.asarray(x_edges, float)
    of_mass = np.asarray(of_mass, bool)
    (x, y), r = np.asarray(positions, float)[of_mass].T, np.asarray(radii, float)[of_mass]
    top = np.full(len(edges) - 1, -math.inf)
    first, last = np.searchsorted(edges, x - r, "right") - 1, np.searchsorted(edges, x + r, "left") - 1
    for step in range(int((last - first).max(initial=-1)) + 1):
        bins = first + step
        here = (bins >= 0) & (bins < len(top)) & (bins <= last)
        b = bins[here]
        beside = np.clip(x[here], edges[b], edges[b + 1]) - x[here]
        np.maximum.at(top, b, y[here] + np.sqrt(np.maximum(r[here]**2 - beside**2, 0)))
    return np.where(np.isfinite(top), top, math.nan)


def exceeded(depth, part):
    """Measured depth (m) that is exceeded on `part` of the length, of a profile depth (b,) m in equal bins.

    With the error s of the share of the length that lies deeper (steady_record.mean), the error is half of the
    difference of the depths that are exceeded on part - s and part + s (Woodruff 1952).
    """
    within("part", part, 0, 1)
    if not len(depth):
        return UNKNOWN
    value = float(np.quantile(depth, 1 - part))
    share = _mean(depth > value).standard_error
    if math.isnan(share):
        return Measured(value, math.nan)
    low, high = np.quantile(depth, np.clip([1 - part - share, 1 - part + share], 0, 1))
    return Measured(value, float(high - low) / 2)


def _mean(values):
    """Measured mean of values (b,) in equal bins."""
    along = np.arange(len(values) + 1)
    return mean(along, integral(along, np.append(0.0, values)))


def groove_results(*, x, height, chip):
    """{name: (value, unit)} of a groove; each but the largest with its `..._standard_error`.

    x (b,) m, the middles of equal bins, height (b,) m of the rock that is left above the tool's path (below: negative),
    nan in empty bins, which are left out; chip: m, length of cut a chip (peak_spacing); nan where
    it is not known: then there is no crater_depth.
    - overbreak (m): the depth below the path that is exceeded on EXCEEDED of the length. Rock beside the deepest places
      often lies at the path, so that a mean says little of the craters, and the largest depth grows with the length
      of the cut; this does neither;
    - mean_overbreak: mean depth below the path, 0 where rock stands above it; crater_depth: mean of the largest depths
      in stretches of one chip; largest_overbreak;
    - standing_rock: mean height above the path, 0 where it lies below.
    """
    chips_known = not math.isnan(chip) and positive("chip", chip, "m")
    x, height = np.asarray(x, float), np.asarray(height, float)
    there = np.isfinite(height)
    x, height = x[there], height[there]
    depth = np.maximum(-height, 0)
    deepest = sample_mean(craters(x, depth, chip)) if len(x) and chips_known else UNKNOWN
    found = {"overbreak": exceeded(depth, EXCEEDED), "mean_overbreak": _mean(depth), "crater_depth": deepest,
             "standing_rock": _mean(np.maximum(height, 0))}
    return {**{key: entry for name, one in found.items() for key, entry in with_error(name, one, "m").items()},
            "largest_overbreak": (float(depth.max()) if len(x) else math.nan, "m")}


def craters(x, depth, chip):
    """(k,) m, largest depth (b,) m in each whole stretch of one chip (m) along x (b,) m, the middles of bins."""
    if len(x) < 2:
        return np.zeros(0)
    stretch = np.floor((x - x[0]) / chip).astype(int)
    whole = int((x[-1] - x[0] + np.diff(x).min()) / chip + ROUND_OFF)
    return np.array([depth[stretch == k].max() for k in range(whole) if np.any(stretch == k)])

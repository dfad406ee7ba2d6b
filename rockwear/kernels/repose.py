"""The angle of repose of a heap of spheres between two walls: its surface, the slope of its flanks, known values."""
import math

import numpy as np

from rockwear.kernels.checks import require

FLANK = 0.15, 0.9
"""Parts of the way from the middle of the plate to its edge between which a flank is fitted: its crest is round, and
at the edge grains lie one by one."""
FEWEST = 4
"""Points of a flank below which it has no slope."""
FINE = 4
"""Sampling points along the side of a cell."""


def surface(positions, radii, *, half_length, half_depth, cell):
    """Height of the surface of a heap over a plate, in square cells.

    The surface is what one sees from above, max over the spheres of y + sqrt(r^2 - d^2), at FINE x FINE points of each
    cell, of which the mean is taken. positions: (n, 3) m, y upwards, the plate at y = 0, |x| <= half_length (m), |z| <=
    half_depth (m); radii: (n,) m; cell: m, about the side of a cell. -> (x (k,) m of the middles, heights (k, strips)
    m; nan where nothing lies).
    """
    columns, strips = (FINE * max(1, round(2 * half / cell)) for half in (half_length, half_depth))
    x, z = (half * ((2 * np.arange(count) + 1) / count - 1)
            for half, count in ((half_length, columns), (half_depth, strips)))
    seen = np.full((columns, strips), -math.inf)
    for (px, py, pz), r in zip(positions[positions[:, 1] > 0].tolist(), radii[positions[:, 1] > 0].tolist()):
        i, k = (slice(*np.searchsorted(points, (place - r, place + r))) for points, place in ((x, px), (z, pz)))
        under = r**2 - (x[i, None] - px)**2 - (z[k] - pz)**2
        height = np.where(under > 0, py + np.sqrt(np.maximum(under, 0.0)), -math.inf)
        seen[i, k] = np.maximum(seen[i, k], height)
    there = np.isfinite(seen)
    cells = columns // FINE, FINE, strips // FINE, FINE
    count = there.reshape(cells).sum(axis=(1, 3))
    total = np.where(there, seen, 0.0).reshape(cells).sum(axis=(1, 3))
    heights = np.divide(total, count, out=np.full(count.shape, math.nan), where=count > 0)
    return x.reshape(-1, FINE).mean(axis=1), heights


def flanks(x, heights, half_length):
    """Straight lines through the flanks of a heap, fitted by least squares strip by strip, between the parts FLANK of
    the plate's half length (m).

    x: (k,) m, 0 in the middle; heights: (k, strips) m. -> (m, 3): side (-1 or 1), slope down and outwards, and its
    intercept in the middle (m), of those flanks that have FEWEST points.
    """
    found = []
    for side in (-1, 1):
        out = side * x / half_length
        for strip in heights.T:
            taken = (out > FLANK[0]) & (out < FLANK[1]) & np.isfinite(strip)
            if np.count_nonzero(taken) >= FEWEST:
                falling, at_crest = np.polyfit(side * x[taken], strip[taken], 1)
                found.append((side, -falling, at_crest))
    return np.array(found).reshape(-1, 3)


def angle(found):
    """(mean angle, its standard error), rad, of the flanks (m, 3) that `flanks` has found; nan without any.

    The strips of one flank are not independent: the error is that of their mean as if they were, or half the
    difference between the two sides where that is larger.
    """
    if not len(found):
        return math.nan, math.nan
    angles = np.arctan(found[:, 1])
    sides = [float(angles[found[:, 0] == side].mean()) for side in (-1, 1) if (found[:, 0] == side).any()]
    errors = [float(angles.std(ddof=1)) / math.sqrt(len(angles))] if len(angles) > 1 else []
    errors += [0.5 * abs(sides[1] - sides[0])] if len(sides) == 2 else []
    return float(angles.mean()), max(errors, default=math.nan)


def zhou(*, friction, wall_friction, rolling, wall_rolling, diameter):
    """Angle of repose (rad) of coarse spheres between two walls four diameters apart, after Zhou, Xu, Yu and Zulli
    (2002): 68.61 deg mu^0.27 mu_w^0.22 mu_r^0.06 mu_rw^0.12 d^-0.2, mu_r, mu_rw and d in mm.

    A fit to simulations and measurements with d = 2 to 10 mm and mu_r up to 0.1 mm; quoted from memory, not read again.
    friction, wall_friction: sliding, sphere on sphere and on the walls; rolling, wall_rolling: m, the moment over the
    normal force; diameter: m. 0 without rolling resistance, where it does not hold.
    """
    for name, value in (("friction", friction), ("wall_friction", wall_friction), ("rolling", rolling),
                        ("wall_rolling", wall_rolling)):
        require(value >= 0, name, value, "at least 0")
    require(diameter > 0, "diameter", diameter, "greater than 0", "m")
    return math.radians(68.61 * friction**0.27 * wall_friction**0.22 * (1e3 * rolling)**0.06
                        * (1e3 * wall_rolling)**0.12 * (1e3 * diameter)**-0.2)

"""The angle of repose of a heap of spheres between two walls: its surface, the slope of its flanks, known values."""
import math

import numpy as np

from rockwear.kernels.checks import require

FLANK = 0.15, 0.85
"""Parts of the heap's height over its plate between which a flank is fitted: its crest is round, its foot one layer."""
FEWEST = 4
"""Points of a flank below which it has no slope."""


def surface(positions, radii, *, half_length, half_depth, cell):
    """The tops of the highest spheres over a plate, in square cells.

    positions: (n, 3) m, y upwards, the plate at y = 0, |x| <= half_length (m), |z| <= half_depth (m); radii: (n,) m;
    cell: m, about the side of a cell. -> (x (k,) m of the middles, heights (k, strips) m; nan where nothing lies).
    """
    columns, strips = max(1, round(2 * half_length / cell)), max(1, round(2 * half_depth / cell))
    x, y, z = positions.T
    i = np.floor((x + half_length) / (2 * half_length) * columns).astype(int)
    k = np.clip(np.floor((z + half_depth) / (2 * half_depth) * strips).astype(int), 0, strips - 1)
    over = (i >= 0) & (i < columns) & (y > 0)
    heights = np.full((columns, strips), -math.inf)
    np.maximum.at(heights, (i[over], k[over]), (y + radii)[over])
    heights[np.isinf(heights)] = math.nan
    return half_length * ((2 * np.arange(columns) + 1) / columns - 1), heights


def flanks(x, heights):
    """Straight lines through the flanks of a heap, fitted by least squares strip by strip, between the parts FLANK of
    its mean height at the crest.

    x: (k,) m, 0 at the crest; heights: (k, strips) m. -> (m, 3): side (-1 or 1), slope down and outwards, and its
    intercept at the crest (m), of those flanks that have FEWEST points.
    """
    if not np.isfinite(heights).any():
        return np.empty((0, 3))
    rows = [row for row in heights if np.isfinite(row).any()]
    crest = max(float(np.nanmean(row)) for row in rows)
    found = []
    for side in (-1, 1):
        for strip in heights.T:
            taken = (side * x > 0) & (strip > FLANK[0] * crest) & (strip < FLANK[1] * crest)
            if np.count_nonzero(taken) >= FEWEST:
                falling, at_crest = np.polyfit(side * x[taken], strip[taken], 1)
                found.append((side, -falling, at_crest))
    return np.array(found).reshape(-1, 3)


def angle(slopes):
    """(mean angle, its standard error), rad, of slopes (m,) fitted to the flanks; nan without any, the error with
    fewer than two."""
    angles = np.arctan(slopes)
    if not len(angles):
        return math.nan, math.nan
    error = float(angles.std(ddof=1)) / math.sqrt(len(angles)) if len(angles) > 1 else math.nan
    return float(angles.mean()), error


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

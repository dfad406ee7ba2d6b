"""Density map: the mean density around each particle, from exact overlaps of discs or spheres with a control volume.

[Rojek 2003, 7.5, eq. 7.9].
"""
import math

import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels.checks import require, within
from rockwear.kernels.packing import volumes

LEAST_RATIO, MOST_RATIO = 1.0, 20.0
"""Radius of a control volume over that of its particle: the particle itself; some hundred discs or thousands of
spheres, beyond which a specimen has no inside."""


def disc_overlap(distance, first, second):
    """Area (m2) that two discs share, arrays of one shape or scalars.

        A = r^2 (a - sin a cos a) + R^2 (b - sin b cos b),   cos a = (d^2 + r^2 - R^2)/(2 d r), b likewise

    a and b are half the angles under which the discs see their common chord. Without a chord it is 0 or the area of
    the smaller disc.

    distance: d, m, between the centres, at least 0; first, second: r and R, m, greater than 0
    """
    distance, first, second = np.broadcast_arrays(*(np.asarray(x, float) for x in (distance, first, second)))
    area = np.array(volumes(np.minimum(first, second), 2) * (distance <= abs(first - second)))
    chord = (distance > abs(first - second)) & (distance < first + second)
    d, r, R = distance[chord], first[chord], second[chord]
    for own, other in ((r, R), (R, r)):
        half = np.arccos(np.clip((d**2 + own**2 - other**2) / (2 * d * own), -1, 1))
        area[chord] += own**2 * (half - np.sin(half) * np.cos(half))
    return area


def sphere_overlap(distance, first, second):
    """Volume (m3) that two spheres share, two caps; arrays of one shape or scalars.

        V = pi (r + R - d)^2 (d^2 + 2 d (r + R) - 3 (r - R)^2)/(12 d)

    Without a common circle it is 0 or the volume of the smaller sphere. Parameters as of disc_overlap.
    """
    distance, first, second = np.broadcast_arrays(*(np.asarray(x, float) for x in (distance, first, second)))
    volume = np.array(volumes(np.minimum(first, second), 3) * (distance <= abs(first - second)))
    circle = (distance > abs(first - second)) & (distance < first + second)
    d, r, R = distance[circle], first[circle], second[circle]
    volume[circle] = math.pi * (r + R - d)**2 * (d**2 + 2 * d * (r + R) - 3 * (r - R)**2) / (12 * d)
    return volume


def control_volume_density(*, positions, radii, densities, ratio):
    """Mean density (n,) kg/m3 in a control volume around each particle [Rojek 2003, eq. 7.9].

        rho_i = sum_j rho_j V_ij / V_c,i

    V_ij is what particle j, i itself among them, has in common with the control volume of i: a disc or a sphere around
    its centre, V_c,i = pi (f r_i)^2 or 4/3 pi (f r_i)^3. The source shows its control volume in a figure only. Where
    particles overlap, what they have in common counts twice, as in the source. At a straight free surface half of the
    control volume is empty.

    positions: (n, 2) or (n, 3) m; radii: (n,) m, greater than 0; densities: of the particles' own material, without
    pores, a scalar or (n,) kg/m3: with 1 the result is the solid fraction; ratio: f, between 1 and 20. Raises
    ParameterError.
    """
    positions, radii = np.asarray(positions, float), np.asarray(radii, float)
    require(positions.ndim == 2 and positions.shape[1] in (2, 3), "positions", positions.shape, "(n, 2) or (n, 3)",
            "shape")
    n, dimension = positions.shape
    require(np.isfinite(positions).all(), "positions", "not all finite", "finite", "m")
    require(radii.shape == (n,), "radii", radii.shape, f"one number for each of {n} particles", "shape")
    require(np.isfinite(radii).all() and (radii > 0).all(), "radii", float(radii.min(initial=0.0)), "greater than 0",
            "m")
    ratio = within("ratio", ratio, LEAST_RATIO, MOST_RATIO)
    if not n:
        return np.zeros(0)
    control = ratio * radii
    near = cKDTree(positions).query_ball_point(positions, control + radii.max())
    other = np.concatenate([np.array(found, int) for found in near])
    own = np.repeat(np.arange(n), [len(found) for found in near])
    distance = np.linalg.norm(positions[own] - positions[other], axis=1)
    overlap = disc_overlap if dimension == 2 else sphere_overlap
    shared = overlap(distance, control[own], radii[other]) * np.broadcast_to(densities, (n,))[other]
    return np.bincount(own, shared, n) / volumes(control, dimension)

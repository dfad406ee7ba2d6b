"""Grains of a rock: Voronoi cells over an assembly of particles [Bahaaddini 2018, fig. 2]."""
import math

import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels.checks import positive, require
from rockwear.kernels.packing import separation, wrap

RELAXATIONS = 8
"""Moves of each seed to the centre of its grain: more make grains more equal [Bahaaddini 2018, sec. 2]."""
CELL = {2: 1.5 * math.sqrt(3), 3: 8 * math.sqrt(2)}
"""Area of a regular hexagon and volume of a regular truncated octahedron of edge 1."""


def grains(positions, *, volume, edge, seed, period=None):
    """Number of the grain of each particle, (n,) int from 0.

    Random seeds, one for so many cells of the given edge as fill the volume, take the particles nearest to them; the
    cells are the hexagons (plane) or truncated octahedra (space) to which Voronoi cells tend as seeds even out.

    positions  (n, 2) or (n, 3) m      volume  of the assembly, m2 or m3      edge  m, mean edge of a grain
    In graded rock grains are everywhere of as many particles: with a volume as if all were fine, edge is that there.
    period  (d,) m with which the assembly repeats itself, 0 in directions in which it does not
    Raises ParameterError for an edge at which a grain has no particle of its own, or the rock less than three grains.
    """
    positive("grain_edge", edge, "m")
    positions = np.asarray(positions, float)
    n, d = positions.shape
    smallest = (volume / n / CELL[d])**(1 / d)
    largest = (volume / 3 / CELL[d])**(1 / d)
    require(edge <= largest, "grain_edge", edge, f"at most {largest:.3g}: a rock of three grains", "m")
    require(edge >= smallest, "grain_edge", edge, f"at least {smallest:.3g}: a particle a grain; 0 for none", "m")
    count = round(volume / (CELL[d] * edge**d))
    rng = np.random.default_rng([seed, n])
    seeds = positions[rng.choice(n, count, replace=False)]
    for _ in range(RELAXATIONS):
        nearest = cKDTree(seeds, boxsize=period).query(positions)[1]
        members = np.bincount(nearest, minlength=count)
        # From the seed to the image that is nearest to it.
        offsets = separation(np.vstack([seeds, positions]), nearest, count + np.arange(n), period)
        moves = np.stack([np.bincount(nearest, x, count) for x in offsets.T], axis=1)
        seeds = wrap(seeds + moves / np.maximum(members, 1)[:, None], period)
    return np.unique(cKDTree(seeds, boxsize=period).query(positions)[1], return_inverse=True)[1]

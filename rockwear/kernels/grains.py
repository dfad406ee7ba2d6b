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


def grains(positions, *, volumes, edge, seed, period=None):
    """Number of the grain of each particle, (n,) int from 0.

    Random seeds, one for so many cells of the given edge as fill the volume, take the particles nearest to them; the
    cells are the hexagons (plane) or truncated octahedra (space) to which Voronoi cells tend as seeds even out. Where
    particles are larger than such a cell, each is a grain.

    positions  (n, 2) or (n, 3) m      volumes  (n,) m2 or m3 of the particles with their pores
    edge  m, mean edge of a grain      period  (d,) m with which the assembly repeats itself, 0 in directions in which
    it does not
    Raises ParameterError for an edge at which a grain has no particle of its own, or the rock less than three grains.
    """
    positive("grain_edge", edge, "m")
    positions = np.asarray(positions, float)
    volumes = np.broadcast_to(np.asarray(volumes, float), len(positions))
    n, d = positions.shape
    smallest, largest = ((volume / CELL[d])**(1 / d) for volume in (volumes.min(), volumes.sum() / 3))
    require(edge <= largest, "grain_edge", edge, f"at most {largest:.3g}: a rock of three grains", "m")
    require(edge >= smallest, "grain_edge", edge, f"at least {smallest:.3g}: a particle a grain; 0 for none", "m")
    shares = np.minimum(volumes / (CELL[d] * edge**d), 1.0)
    rng = np.random.default_rng([seed, n])
    seeds = positions[_drawn(rng, shares)]
    count = len(seeds)
    for _ in range(RELAXATIONS):
        nearest = cKDTree(seeds, boxsize=period).query(positions)[1]
        weights = np.bincount(nearest, volumes, minlength=count)
        # From the seed to the image that is nearest to it.
        offsets = separation(np.vstack([seeds, positions]), nearest, count + np.arange(n), period)
        moves = np.stack([np.bincount(nearest, volumes * x, count) for x in offsets.T], axis=1)
        seeds = wrap(seeds + moves / np.where(weights > 0, weights, 1.0)[:, None], period)
    return np.unique(cKDTree(seeds, boxsize=period).query(positions)[1], return_inverse=True)[1]


def _drawn(rng, shares):
    """Indices drawn without replacement, each in so many of all cases as its share (n,) of 0 to 1 says."""
    order = rng.permutation(len(shares))
    total = np.concatenate([[0.0], np.cumsum(shares[order])]) + rng.random()
    return order[np.floor(total[1:]) > np.floor(total[:-1])]

"""Fragments of broken rock: which particles are still bonded, and how large the pieces are."""
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from rockwear.kernels.steady_record import sample_mean

LEAST_PARTICLES = 4
"""Least number of particles of a chip: what is smaller is dust, whose shape says nothing."""


class Fragments(NamedTuple):
    """Pieces that are no part of the rock mass, in the order of their first particle.

    label (n,) int, the piece of each particle, -1 in the rock mass; particles (k,) int; area (k,) m2; length, thickness
    (k,) m, extents along the principal axis of the piece and across it, with the discs' own radii; centre (k, 2) m.
    """

    label: np.ndarray
    particles: np.ndarray
    area: np.ndarray
    length: np.ndarray
    thickness: np.ndarray
    centre: np.ndarray


def pieces(count, pairs, intact):
    """(count,) int, number of the piece that each particle belongs to by bonds `pairs` (m, 2), the intact ones."""
    i, j = np.asarray(pairs).reshape(-1, 2)[np.asarray(intact, bool)].T
    return connected_components(coo_matrix((np.ones(len(i)), (i, j)), shape=(count, count)), directed=False)[1]


def fragments(*, pairs, intact, positions, areas, anchored):
    """Fragments of a plane rock.

    pairs (m, 2) int, intact (m,) bool: bonds; positions (n, 2) m; areas (n,) m2 of the particles, each taken as a disc;
    anchored (n,) bool: particles of the rock mass. A piece that holds an anchored particle is rock mass.
    """
    positions, areas = np.asarray(positions, float).reshape(-1, 2), np.asarray(areas, float)
    piece = pieces(len(positions), pairs, intact)
    loose = ~np.isin(piece, piece[np.asarray(anchored, bool)])
    label = np.full(len(positions), -1)
    label[loose] = np.unique(piece[loose], return_inverse=True)[1]
    return Fragments(label, *_sizes(label[loose], positions[loose], areas[loose]))


def free_fragments(label, pairs, held):
    """(n,) bool: particles of fragments that nothing touches.

    label: (n,), see Fragments; pairs: (l, 2) particles that touch; held: (k,) particles that something else touches.
    """
    a, b = label[np.asarray(pairs, int).reshape(-1, 2)].T
    other = a != b
    return (label >= 0) & ~np.isin(label, np.concatenate([a[other], b[other], label[held]]))


def _sizes(label, positions, areas):
    """Particles, area, length, thickness and centre of the pieces of `label` (n,) from 0."""
    particles, area = np.bincount(label), np.bincount(label, areas)

    def mean(values):
        return np.bincount(label, areas * values) / area

    centre = np.column_stack([mean(x) for x in positions.T])
    x, y = (positions - centre[label]).T
    # The axis of the largest second moment; a disc's own moment is the same about any axis.
    angle = 0.5 * np.arctan2(2 * mean(x * y), mean(x * x) - mean(y * y))[label]
    cosine, sine, radius = np.cos(angle), np.sin(angle), np.sqrt(areas / np.pi)
    along, across = (_extent(label, distance, radius) for distance in (cosine * x + sine * y, cosine * y - sine * x))
    return particles, area, np.maximum(along, across), np.minimum(along, across), centre


def _extent(label, distance, radius):
    """(k,) m from the first to the last point of each piece."""
    order = np.argsort(label, kind="stable")
    starts = np.searchsorted(label[order], np.arange(label.max(initial=-1) + 1))
    if not len(starts):
        return np.empty(0)
    return (np.maximum.reduceat((distance + radius)[order], starts)
            - np.minimum.reduceat((distance - radius)[order], starts))


def chip_length(*, particles, area, length):
    """Measured mean length (m) of chips, weighted with their areas: where most of the broken rock is.

    particles, area, length (k,) of fragments; those of fewer than LEAST_PARTICLES particles do not count.
    """
    chip = np.asarray(particles) >= LEAST_PARTICLES
    return sample_mean(np.asarray(length, float)[chip], np.asarray(area, float)[chip])


def size_distribution(*, area, length):
    """(lengths (k,) m in order, share (k,) of the area in fragments up to this length)."""
    order = np.argsort(length, kind="stable")
    passing = np.cumsum(np.asarray(area, float)[order])
    return np.asarray(length, float)[order], passing / passing[-1] if len(passing) else passing

"""Shapes in a run's arrays: the outline of what is left of the tool, its wear along the contour, chips, cracks."""
import numpy as np
from scipy.spatial import Delaunay, QhullError

from rockwear.kernels.fragments import pieces
from rockwear.kernels.polygon import cross, nearest_on_edges

ALPHA = 2.2
"""Gaps whose rim fits on a circle of this many mean radii are closed, as in kernels.surface."""


def outlines(positions, radii, inset=None):
    """Closed polygons (k, 2) around a body of discs, counter-clockwise, through the outermost points of its rim.

    inset: (n,) m by which each disc has been worn from outside; the polygon stands that much further in.
    """
    reach = radii if inset is None else np.maximum(radii - np.nan_to_num(inset), -radii)
    return [positions[loop] + reach[loop, None] * _outward(positions[loop]) for loop in _rims(positions, radii)]


def _rims(positions, radii):
    """Lists of disc numbers around each part of the body, counter-clockwise; holes and single chains are left out."""
    if len(positions) < 3:
        return []
    try:
        triangles = Delaunay(positions).simplices
    except QhullError:  # all in a line
        return []
    a, b, c = positions[triangles].transpose(1, 0, 2)
    area = cross(b - a, c - a) / 2
    sides = np.linalg.norm(b - a, axis=1) * np.linalg.norm(c - b, axis=1) * np.linalg.norm(a - c, axis=1)
    with np.errstate(divide="ignore"):
        inside = sides / (4 * abs(area)) < ALPHA * radii[triangles].mean(axis=1)
    triangles = np.where(area[:, None] > 0, triangles, triangles[:, ::-1])[inside]
    edges = {(i, j) for t in triangles.tolist() for i, j in zip(t, t[1:] + t[:1])}
    following = {}
    for i, j in sorted(edges):
        if (j, i) not in edges:
            following.setdefault(i, []).append(j)
    loops = []
    while following:
        loop = _follow(following)
        x, y = positions[loop].T
        if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0:
            loops.append(loop)
    return loops


def _follow(following):
    """Take one closed loop of numbers out of {number: [next numbers]}."""
    start = here = next(iter(following))
    loop = []
    while True:
        loop.append(here)
        onward = following[here].pop()
        if not following[here]:
            del following[here]
        here = onward
        if here == start:
            return np.array(loop)


def _outward(loop):
    """Unit normals of a counter-clockwise polygon at its corners, those of the two sides between them."""
    along = np.roll(loop, -1, axis=0) - loop
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    normal = np.column_stack([along[:, 1], -along[:, 0]])
    normal = normal + np.roll(normal, 1, axis=0)
    return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)


def loop(facets):
    """(m,) numbers of the corners of the one polygon that segments (m, 2) make, in order."""
    following = dict(facets.tolist())
    corners = [int(facets[0, 0])]
    while following[corners[-1]] != corners[0]:
        corners.append(following[corners[-1]])
    return np.array(corners)


def section(vertices, facets, z):
    """(k, 2, 2) m: the segments, in x and y, in which the plane of this z cuts triangles (m, 3) of vertices (n, 3)."""
    corners = vertices[facets]
    above = corners[:, :, 2] > z
    cut = above.any(axis=1) & ~above.all(axis=1)
    corners, above = corners[cut], above[cut]
    # Of three corners one is alone on its side; the plane cuts its two edges.
    alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
    here, *others = (corners[np.arange(len(corners)), (alone + k) % 3] for k in range(3))
    ends = [here + (other - here) * ((z - here[:, 2]) / (other - here)[:, 2])[:, None] for other in others]
    return np.stack(ends, axis=1)[:, :, :2]


def distance_to(points, polygons):
    """(n,) m from each point to the nearest side of the polygons; nan without any."""
    if not polygons:
        return np.full(len(points), np.nan)
    edges = np.vstack([np.roll(polygon, -1, axis=0) - polygon for polygon in polygons])
    long = edges.any(axis=1)
    foot, _ = nearest_on_edges(points, np.vstack(polygons)[long], edges[long])
    return np.linalg.norm(points - foot, axis=1)


def chips(count, pairs, intact, fixed):
    """(n,) bool: discs that no chain of intact bonds joins to a fixed one (to the largest piece, if none is fixed)."""
    label = pieces(count, pairs, intact)
    whole = label[fixed] if np.any(fixed) else [np.argmax(np.bincount(label))]
    return ~np.isin(label, whole)


def cracks(positions, radii, pairs, near=1.3):
    """Segments (m, 2, 2), one a broken bond, across it and as long as its smaller disc: together they trace the crack.

    Only bonds whose discs are still within `near` sums of their radii.
    """
    i, j = pairs.T
    across = positions[j] - positions[i]
    distance = np.linalg.norm(across, axis=1)
    close = (distance > 0) & (distance < near * (radii[i] + radii[j]))
    i, j, across = i[close], j[close], across[close] / distance[close, None]
    middle = (positions[i] + positions[j]) / 2
    half = np.minimum(radii[i], radii[j])[:, None] * np.column_stack([-across[:, 1], across[:, 0]])
    return np.stack([middle - half, middle + half], axis=1)

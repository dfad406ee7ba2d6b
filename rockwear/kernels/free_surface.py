"""Free surface of an assembly of particles, found from positions and radii alone, in 2D and 3D.

Convection acts on the free surface; [Rojek 2003, 7.2] asks for a procedure that follows cracks, chips and wear.
"""
import math

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from rockwear.kernels.checks import positive, require

# Tighter than 2 particle radii, gaps between touching neighbours begin to let the medium into a random packing; each
# tenth above lets cracks open by a tenth of a radius more before they count.
ALPHA = 2.2

_FLAT = 1e-12  # squared volume of a simplex, against the product of its squared edges, below which it is flat


def free_surface(*, positions, radii, alpha=ALPHA, in_contact=None):
    """Free surface of each particle: (n,) length in m (2D, per metre of thickness m^2) or area in m^2 (3D).

    positions   (n, 2) or (n, 3) centres, m
    radii       (n,) m, greater than 0
    alpha       largest gap that counts as closed, in mean radii of the particles around it, greater than 1. A crack
                is free surface once its walls are 2 (alpha - 1) radii apart (1.2 diameters at 2.2). A hole or a pore
                is free surface once a channel as wide connects it with the outside: air or water reach no other.
    in_contact  (n,) bool, particles touching another body: they are on the contact interface and not on the free
                surface [Rojek 2003, 7.2], their share is 0

    The alpha complex of the centres (Edelsbrunner and Muecke 1994) is the body; the free surface is that of the body
    dilated by the radii, each simplex contributing to its own particles (Steiner's formula):

        2D   L_i = sum_edges l/2 + r_i phi_i
        3D   A_i = sum_faces A/3 + r_i sum_edges (l/2) phi_e + r_i^2 K_i

    with the turning angles phi, reflex ones negative, and the Gauss curvature K; in 2D the edges are the outer
    tangents of their two discs. So a ring of discs of outer radius R gives 2 pi R, a straight wall its length, a
    single particle 2 pi r or 4 pi r^2; a right-angled corner is round and (2 - pi/2) r shorter than a sharp one.
    Particles inside have 0; none has more than its whole circumference or area.

    The sum is L_bound of [Rojek 2014, eq. 44]. There eq. 43 distributes it by radius alone, xi*r_i; here each particle
    has what is exposed at its own place. Raises ParameterError.
    """
    positions, radii = np.asarray(positions, float), np.asarray(radii, float)
    require(positions.ndim == 2 and positions.shape[1] in (2, 3) and len(positions) > 0, "positions",
            positions.shape, "(n, 2) or (n, 3)", "shape")
    n, dimension = positions.shape
    require(np.isfinite(positions).all(), "positions", "not all finite", "finite", "m")
    require(radii.shape == (n,), "radii", radii.shape, f"one number for each of {n} particles", "shape")
    require(np.isfinite(radii).all() and (radii > 0).all(), "radii", float(radii.min()), "greater than 0", "m")
    require(positive("alpha", alpha) > 1, "alpha", alpha, "greater than 1, or touching particles stay apart")

    body = _alpha_complex(positions, radii, alpha)
    exposed = (_lengths if dimension == 2 else _areas)(positions, radii, body)
    *_, (facets, sides), (solids, _) = body
    inside = np.zeros(n, bool)
    inside[solids] = True
    inside[facets[sides > 0]] = False
    whole = 2 * math.pi * radii if dimension == 2 else 4 * math.pi * radii**2
    exposed = np.where(inside, 0.0, np.clip(exposed, 0.0, whole))
    if in_contact is not None:
        in_contact = np.asarray(in_contact)
        require(in_contact.shape == (n,) and in_contact.dtype == bool, "in_contact", in_contact.shape,
                f"a mask over {n} particles", "shape")
        exposed[in_contact] = 0.0
    return exposed


def _lengths(positions, radii, body):
    (edges, sides), (triangles, _) = body
    n, (i, j) = len(positions), edges.T
    length = np.linalg.norm(positions[j] - positions[i], axis=1)
    step = radii[i] - radii[j]
    lean = np.arcsin(np.clip(step / length, -1, 1))  # from the line of the centres to the tangent
    tangent = np.sqrt(np.maximum(length**2 - step**2, 0))
    turning = 2 * math.pi + _at(i, sides * (lean - math.pi / 2), n) - _at(j, sides * (lean + math.pi / 2), n)
    for own, first, second in ((0, 1, 2), (1, 0, 2), (2, 0, 1)):
        turning -= _at(triangles[:, own], _corner(positions, triangles, own, first, second), n)
    return _at(edges, sides * tangent / 2, n) + radii * turning


def _areas(positions, radii, body):
    (edges, _), (triangles, sides), (solids, _) = body
    n = len(positions)
    legs = positions[triangles[:, 1:]] - positions[triangles[:, :1]]
    area = np.linalg.norm(np.cross(legs[:, 0], legs[:, 1]), axis=1) / 2

    keys = _keys(edges, n)  # sorted, as _alpha_complex leaves them
    turning = np.full(len(edges), 2 * math.pi)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        turning -= _at(np.searchsorted(keys, _keys(triangles[:, [a, b]], n)), sides * math.pi / 2, len(edges))
    for a, b, c, d in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)):
        turning -= _at(np.searchsorted(keys, _keys(solids[:, [a, b]], n)), _dihedral(positions, solids, a, b, c, d),
                       len(edges))
    length = np.linalg.norm(positions[edges[:, 1]] - positions[edges[:, 0]], axis=1)

    # Gauss and Bonnet around a particle: what is free of it has the Euler number 2 - E + F - T.
    curvature = 2 * math.pi * (2.0 - _at(edges, 1, n) + _at(triangles, 1, n) - _at(solids, 1, n))
    for own, first, second in ((0, 1, 2), (1, 0, 2), (2, 0, 1)):
        curvature -= _at(triangles[:, own], sides * _corner(positions, triangles, own, first, second), n)
    return (_at(triangles, sides * area / 3, n) + radii * _at(edges, length * turning / 2, n)
            + radii**2 * curvature)


def _alpha_complex(positions, radii, alpha):
    """Edges, triangles (and tetrahedra) of the body: for each dimension from 1 on (simplices, free sides).

    A simplex belongs to the body if the smallest sphere through its corners is smaller than alpha mean radii and
    empty, or if it bounds one that does. The vertices of each are sorted, and so are the simplices; a facet has as
    many free sides as simplices of full dimension are missing beside it.
    """
    n, dimension = positions.shape
    # Ghost points far off surround the particles: the hull is no special case, and one particle, a chain or a layer
    # has a triangulation as well.
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    reach = np.ptp(positions, axis=0).max() + alpha * radii.max()
    corners = np.vstack([np.eye(dimension), -np.ones((1, dimension))])
    points = np.vstack([positions, middle + 10 * reach * corners])
    sizes = np.concatenate([radii, np.full(dimension + 1, np.nan)])  # no simplex with a ghost is small enough

    triangulation = Delaunay(points)
    simplices = np.sort(triangulation.simplices, axis=1)
    belongs = _circumsphere(points, simplices)[1] < alpha * sizes[simplices].mean(axis=1)
    belongs |= _enclosed(points, triangulation, belongs, n, alpha * sizes)
    body = [(simplices[belongs], np.zeros(belongs.sum(), int))]
    for size in range(dimension, 1, -1):
        columns = [np.delete(np.arange(size + 1), k) for k in range(size + 1)]
        faces = np.concatenate([simplices[:, kept] for kept in columns])
        opposite = simplices.T.ravel()
        bounds = np.tile(belongs, size + 1)
        _, first, which = np.unique(_keys(faces, len(points)), return_index=True, return_inverse=True)
        which = which.ravel()
        simplices = faces[first]
        centre, radius = _circumsphere(points, simplices)
        near = np.linalg.norm(points[opposite] - centre[which], axis=1) < radius[which] * (1 - 1e-9)
        occupied = np.bincount(which, near) > 0
        beside = np.bincount(which, bounds).astype(int)
        belongs = (beside > 0) | (~occupied & (radius < alpha * sizes[simplices].mean(axis=1)))
        body.insert(0, (simplices[belongs], 2 - beside[belongs]))
    return body


def _enclosed(points, triangulation, belongs, n, reach):
    """Simplices of pores that are connected with the outside by no channel wider than `reach` (one per particle)."""
    empty, beside = np.flatnonzero(~belongs), triangulation.neighbors
    own, across = (a.ravel() for a in np.broadcast_arrays(empty[:, None], beside[empty]))
    facets = np.concatenate([np.delete(triangulation.simplices[empty], k, axis=1)[:, None]
                             for k in range(beside.shape[1])], axis=1).reshape(len(own), -1)
    passable = (across >= 0) & ~belongs[across]
    own, across, facets = own[passable], across[passable], facets[passable]
    wide = ~(_circumsphere(points, facets)[1] < reach[facets].mean(axis=1))
    ways = csr_matrix((np.ones(wide.sum(), bool), (own[wide], across[wide])), shape=(len(belongs),) * 2)
    pore = connected_components(ways, directed=False)[1]
    outside = np.unique(pore[(triangulation.simplices >= n).any(axis=1)])
    return ~belongs & ~np.isin(pore, outside)


def _circumsphere(points, simplices):
    """Centre and radius of the smallest sphere through the corners of each simplex; inf where there is none."""
    legs = points[simplices[:, 1:]] - points[simplices[:, :1]]
    gram = legs @ legs.transpose(0, 2, 1)
    square = np.diagonal(gram, axis1=1, axis2=2)
    flat = np.linalg.det(gram) < _FLAT * square.prod(axis=1)
    weight = np.empty_like(square)
    weight[~flat] = np.linalg.solve(gram[~flat], square[~flat, :, None] / 2)[..., 0]
    # Lattices have flat simplices with all corners on one circle, which do belong to the body, and such with three
    # in a row, which have no sphere.
    inverse = np.linalg.pinv(gram[flat], rcond=1e-9, hermitian=True)
    weight[flat] = (inverse @ square[flat, :, None] / 2)[..., 0]
    miss = abs((gram @ weight[..., None])[..., 0] - square / 2).max(axis=1)
    offset = (weight[:, None, :] @ legs)[:, 0]
    radius = np.where(miss <= 1e-6 * square.max(axis=1), np.linalg.norm(offset, axis=1), np.inf)
    return points[simplices[:, 0]] + offset, radius


def _corner(positions, simplices, own, first, second):
    """Angle at corner `own` between the legs to `first` and `second`, rad."""
    one = positions[simplices[:, first]] - positions[simplices[:, own]]
    two = positions[simplices[:, second]] - positions[simplices[:, own]]
    return _angle(one, two)


def _dihedral(positions, solids, a, b, c, d):
    """Angle of tetrahedra at their edge a-b, between the faces to c and d, rad."""
    axis = positions[solids[:, b]] - positions[solids[:, a]]
    one, two = (np.cross(axis, positions[solids[:, k]] - positions[solids[:, a]]) for k in (c, d))
    return _angle(one, two)


def _angle(one, two):
    length_one, length_two = np.linalg.norm(one, axis=1), np.linalg.norm(two, axis=1)
    cosine = np.einsum("ij,ij->i", one, two) / (length_one * length_two)
    return np.arccos(np.clip(cosine, -1, 1))


def _at(nodes, values, n):
    """Sum of `values`, one a row of `nodes` (or one for all), gathered at every node of the row."""
    nodes = nodes[:, None] if nodes.ndim == 1 else nodes
    values = np.broadcast_to(np.reshape(values, (-1, 1)), nodes.shape)
    return np.bincount(nodes.ravel(), values.ravel(), n)


def _keys(simplices, n):
    """One integer for each row of vertex numbers below n, in the order of the rows."""
    return simplices.astype(np.int64) @ n ** np.arange(simplices.shape[1] - 1, -1, -1, dtype=np.int64)

"""The cells of particles: what part of a body each stands for, and the faces through which neighbours exchange heat.

A packing is a sample of the body that it fills, and its particles' Voronoi cells divide that body without gap and
overlap. Heat between the centres of neighbours passes the face between their cells:

    h_ij = lambda A_ij / d_ij

which is M eq. 7.3 with its "equivalent area" found instead of guessed. As every cell is closed, sum_j A_ij n_ij is 0
over its faces, and a linear temperature is exactly steady on any packing: the network conducts as the material does,
in every direction and at every place, with nothing to be fitted (a finite volume scheme, second order in the spacing).
"""
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import Voronoi, cKDTree

from rockwear.kernels import polygon as outline
from rockwear.kernels.checks import positive, require

REACH = 3  # largest distance between nearest neighbours: so deep do cells reach a wall
_POINT = 1e-9  # faces below this part of their neighbours' distance (to the power d-1) are corners: lattices have them


@dataclass(frozen=True)
class Cells:
    """Cells of n particles in d dimensions; areas are lengths and volumes areas in 2D, per metre of thickness.

    edges (m, 2)     neighbours i < j, sorted
    faces (m,)       area of the face between them, m^(d-1)
    distances (m,)   between their centres, m
    volumes (n,)     m^d; they add up to the container's
    walls            {side: (nodes (k,), areas (k,), distances (k,))}: the cells that touch a side of the container,
                     the area of their part of it and its distance from the centre, m. Sides are 0, 1, ... in the
                     order of outline.sides, or of the axes: low x, high x, low y, high y ... of a box
    """

    edges: np.ndarray
    faces: np.ndarray
    distances: np.ndarray
    volumes: np.ndarray
    walls: dict

    def conductance(self, conductivity):
        """(m,) W/K between neighbours, lambda A/d; conductivity in W/(m K), greater than 0, or ParameterError."""
        return positive("conductivity", conductivity, "W/(m K)") * self.faces / self.distances

    @property
    def at_walls(self):
        """(n,) bool: the cells that touch any side of the container."""
        return np.isin(np.arange(len(self.volumes)), np.concatenate([nodes for nodes, _, _ in self.walls.values()]))

    def wall_conductance(self, side, conductivity):
        """(nodes, (k,) W/K between their centres and a side of the container, lambda A/distance).

        A prescribed temperature of the side acts through it, HeatNetwork.convect(nodes, W/K, K); a prescribed flux is
        a source of flux times area.
        """
        nodes, areas, distances = self.walls[side]
        return nodes, positive("conductivity", conductivity, "W/(m K)") * areas / distances


def cells(positions, *, box=None, polygon=None):
    """Voronoi cells of particles within a container, as Cells.

    positions (n, d) m, inside the container: a box of sides (d,) m with one corner at the origin, in 2D or 3D; or a
    polygon (k, 2) m. Each particle near a side has a mirror image behind it: the face between the two lies in the
    side. (Behind a curved side, in its tangent; around a re-entrant corner two cells may overlap a little, or leave a
    little gap.) Raises ParameterError.
    """
    positions = np.asarray(positions, float)
    require((box is None) != (polygon is None), "box", box, "given, or else polygon, not both")
    require(positions.ndim == 2 and positions.shape[1] in (2, 3), "positions", positions.shape, "(n, 2) or (n, 3)",
            "shape")
    n, dimension = positions.shape
    require(n > 1, "positions", f"{n} particles", "two at least")
    reach = REACH * float(cKDTree(positions).query(positions, 2)[0][:, 1].max())
    images = _behind_box(positions, box) if polygon is None else _behind_polygon(positions, polygon)
    points, owner, side = [positions], [np.arange(n)], [np.full(n, -1)]
    for number, mirrored in enumerate(images):
        apart = np.linalg.norm(mirrored - positions, axis=1)
        near = np.flatnonzero((apart < 2 * reach) & (apart > 0))
        points.append(mirrored[near]), owner.append(near), side.append(np.full(len(near), number))
    points, owner, side = map(np.concatenate, (points, owner, side))
    # Far points close every cell, so that the last images are no special case either.
    middle, span = points.mean(axis=0), np.ptp(points, axis=0).max()
    far = middle + 10 * span * np.vstack([np.eye(dimension), -np.ones((1, dimension))])
    return _measure(points, owner, side, far, n)


def _measure(points, owner, side, far, n):
    diagram = Voronoi(np.vstack([points, far]))
    pairs = np.sort(diagram.ridge_points, axis=1)
    of_ours = np.flatnonzero((pairs[:, 0] < n) & (pairs[:, 1] < len(points)))
    area = _areas(diagram, of_ours)
    pairs = pairs[of_ours]
    distance = np.linalg.norm(points[pairs[:, 1]] - points[pairs[:, 0]], axis=1)
    real = area > _POINT * distance ** (points.shape[1] - 1)
    pairs, area, distance = pairs[real], area[real], distance[real]
    inner = pairs[:, 1] < n
    # A cell is made of pyramids from its centre to its faces, of height half the distance.
    pyramid = area * distance / (2 * points.shape[1])
    volumes = np.bincount(pairs[:, 0], pyramid, n) + np.bincount(pairs[inner, 1], pyramid[inner], n)
    order = np.lexsort((pairs[inner, 1], pairs[inner, 0]))
    walls = {}
    for number in np.unique(side[n:]):
        at = ~inner & (side[pairs[:, 1]] == number) & (owner[pairs[:, 1]] == pairs[:, 0])
        walls[int(number)] = pairs[at, 0], area[at], distance[at] / 2
    return Cells(edges=pairs[inner][order], faces=area[inner][order], distances=distance[inner][order], volumes=volumes,
                 walls=walls)


def _areas(diagram, ridges):
    corners = [diagram.ridge_vertices[ridge] for ridge in ridges]
    if diagram.points.shape[1] == 2:
        first, second = diagram.vertices[np.array(corners)].transpose(1, 0, 2)
        return np.linalg.norm(second - first, axis=1)
    # Fans of triangles: Qhull gives the corners of a face in order.
    count = np.array([len(c) for c in corners])
    flat = diagram.vertices[np.concatenate(corners)]
    start = np.cumsum(count) - count
    apex = np.repeat(flat[start], count, axis=0)
    following = np.arange(len(flat)) + 1
    following[start + count - 1] = start
    fans = np.cross(flat - apex, flat[following] - apex)
    return np.linalg.norm(np.add.reduceat(fans, start), axis=1) / 2


def _behind_box(positions, box):
    require(np.shape(box) == (positions.shape[1],), "box", box, f"{positions.shape[1]} sides", "m")
    sides = np.array([positive("box", length, "m") for length in box])
    inside = ((positions > 0) & (positions < sides)).all()
    require(inside, "positions", "not all inside", "inside the box", "m")
    for axis, length in enumerate(sides):
        for wall in (0.0, length):
            mirrored = positions.copy()
            mirrored[:, axis] = 2 * wall - mirrored[:, axis]
            yield mirrored


def _behind_polygon(positions, polygon):
    polygon = outline.check_polygon(polygon)
    require(outline.inside(positions, polygon).all(), "positions", "not all inside", "inside the polygon", "m")
    for start, edge in outline.sides(polygon):
        mirrored = 2 * outline.nearest_on_edges(positions, start, edge)[0] - positions
        # Around a re-entrant corner an image may fall into the other cutter_radius, where it has no wall to make.
        yield np.where(outline.inside(mirrored, polygon)[:, None], positions, mirrored)


def among(pairs, others, n):
    """(m,) bool: which pairs (m, 2) of n particles, the lower number first, are among the others (k, 2)."""
    return np.isin(np.asarray(pairs) @ [n, 1], np.asarray(others) @ [n, 1])


def conducting(edges, joined, facing, n):
    """Which neighbours exchange heat while some of the contacts are open: (m,) bool.

    edges (m, 2) neighbours of n particles; joined (m,) bool: bonded or touching, those do; facing (m,) bool: never
    bonded, they only face each other across a pore. These do while the pore is closed, that is while a third particle
    joins them by two pairs that do: a crack between them would have to part the third from one of the two. All others
    are cracks, and do not.
    """
    edges, conducts = np.asarray(edges), np.array(joined, bool)
    while True:
        i, j = edges[conducts].T
        ends = np.concatenate([i, j]), np.concatenate([j, i])
        link = csr_matrix((np.ones(2 * len(i), np.int32), ends), shape=(n, n))
        open_pairs = np.flatnonzero(facing & ~conducts)
        a, b = edges[open_pairs].T
        closed = np.asarray(link[a].multiply(link[b]).sum(axis=1)).ravel() > 0
        if not closed.any():
            return conducts
        conducts[open_pairs[closed]] = True

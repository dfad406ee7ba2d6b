"""Voronoi cells of particles: the part of a body that each represents, and the faces through which heat is conducted.

A packing is a sample of the body that it fills, and the Voronoi cells of its particles divide that body without gap and
overlap. Heat between the centres of neighbours passes the face between their cells:

    h_ij = lambda A_ij / d_ij

which is [Rojek 2003, eq. 7.3] with the face as "equivalent area". As every cell is closed, sum_j A_ij n_ij is 0 over
its faces, and a linear temperature is exactly stationary on any packing: the network conducts as the material does, in
every direction and at every place, without any fit (a finite volume scheme of second order in the spacing).
"""
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import Voronoi, cKDTree

from rockwear.kernels.checks import positive, require
from rockwear.kernels.polygon import check_polygon, inside, nearest_on_edges, sides

REACH = 3  # particles within so many largest distances of nearest neighbours of a wall get an image behind it
_POINT = 1e-9  # smaller faces, over their neighbours' distance to the power d-1, are corners: lattices have them


@dataclass(frozen=True)
class Cells:
    """Cells of n particles in d dimensions; areas are lengths and volumes areas in 2D, per metre of thickness.

    edges (m, 2)     neighbours i < j, sorted
    faces (m,)       area of the face between them, m^(d-1)
    distances (m,)   between their centres, m
    volumes (n,)     m^d; they add up to the container's
    walls            {side: (nodes (k,), areas (k,), distances (k,))}: the cells that touch a side of the container,
                     the area of their part of it and its distance from the centre, m. Sides are 0, 1, ... in the
                     order of polygon.sides, or of the axes: low x, high x, low y, high y ... of a box; of `layered`
                     cells, -2 and -1 are the low and the high end
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

    positions (n, d) m, of a packing that fills the container: a box of sides (d,) m with one corner at the origin, in
    2D or 3D; or a polygon (k, 2) m. Each particle near a side has a mirror image behind it: the face between the two
    lies in the side. (Around a re-entrant corner two cells may overlap a little, or leave a little gap.) Raises
    ParameterError.
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
    # Far points close every cell, those of the images too.
    middle, span = points.mean(axis=0), np.ptp(points, axis=0).max()
    far = middle + 10 * span * np.vstack([np.eye(dimension), -np.ones((1, dimension))])
    return _measure(points, owner, side, far, n)


def periodic_cells(positions, *, period, height):
    """Voronoi cells of particles in the plane that repeat themselves along x with `period` (m), between walls at y = 0
    and y = height (m), as Cells; an edge may join a particle with the image of its neighbour, and each pair is there
    once.

    positions (n, 2) m, 0 <= x < period. Raises ParameterError.
    """
    n = len(positions)
    reach = 2 * REACH * float(cKDTree(positions).query(positions, 2)[0][:, 1].max())
    before, after = (np.flatnonzero(near) for near in (positions[:, 0] > period - reach, positions[:, 0] < reach))
    shift = np.array([period, 0.0])
    spread = np.vstack([positions, positions[before] - shift, positions[after] + shift]) + [reach, 0.0]
    number = np.concatenate([np.arange(n), before, after])
    found = cells(spread + [1e-9 * period, 0.0], box=(period + 2 * reach + 2e-9 * period, height))
    own = found.edges < n
    # A face at the seam is found twice, from either side: that of the lower number of the two counts.
    kept = own.all(axis=1) | (own.any(axis=1) & (np.where(own[:, 0], found.edges[:, 0], found.edges[:, 1])
                                                 < number[np.where(own[:, 0], found.edges[:, 1], found.edges[:, 0])]))
    edges = np.sort(number[found.edges[kept]], axis=1)
    order = _sorted(edges)
    walls = {}
    for side in (2, 3):
        nodes, areas, away = found.walls[side]
        walls[side] = nodes[nodes < n], areas[nodes < n], away[nodes < n]
    return Cells(edges=edges[order], faces=found.faces[kept][order], distances=found.distances[kept][order],
                 volumes=found.volumes[:n], walls=walls)


def _measure(points, owner, side, far, n):
    diagram = Voronoi(np.vstack([points, far]))
    pairs = np.sort(diagram.ridge_points, axis=1)
    of_cells = np.flatnonzero((pairs[:, 0] < n) & (pairs[:, 1] < len(points)))
    area = _areas(diagram, of_cells)
    pairs = pairs[of_cells]
    distance = np.linalg.norm(points[pairs[:, 1]] - points[pairs[:, 0]], axis=1)
    real = area > _POINT * distance ** (points.shape[1] - 1)
    pairs, area, distance = pairs[real], area[real], distance[real]
    inner = pairs[:, 1] < n
    # A cell consists of pyramids from its centre to its faces, whose height is half the distance.
    pyramid = area * distance / (2 * points.shape[1])
    volumes = np.bincount(pairs[:, 0], pyramid, n) + np.bincount(pairs[inner, 1], pyramid[inner], n)
    order = _sorted(pairs[inner])
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


def _sorted(pairs):
    return np.lexsort((pairs[:, 1], pairs[:, 0]))


def _behind_box(positions, box):
    require(np.shape(box) == (positions.shape[1],), "box", box, f"{positions.shape[1]} sides", "m")
    lengths = np.array([positive("box", length, "m") for length in box])
    require(((positions > 0) & (positions < lengths)).all(), "positions", "not all inside", "inside the box", "m")
    for axis, length in enumerate(lengths):
        for wall in (0.0, length):
            mirrored = positions.copy()
            mirrored[:, axis] = 2 * wall - mirrored[:, axis]
            yield mirrored


def _behind_polygon(positions, polygon):
    polygon = check_polygon(polygon)
    require(inside(positions, polygon).all(), "positions", "not all inside", "inside the polygon", "m")
    for start, edge in sides(polygon):
        mirrored = 2 * nearest_on_edges(positions, start, edge)[0] - positions
        # Around a re-entrant corner an image may lie inside of the polygon, where it belongs to no wall.
        yield np.where(inside(mirrored, polygon)[:, None], positions, mirrored)


def layered(section, layers, thickness):
    """Cells of a plane section repeated in so many layers across, each `thickness` (m) deep: Cells in space, exactly.

    section: Cells of n particles in the plane. Particle k of layer l, counted from the low end, has the number l n + k;
    its centre is in the middle of the layer. Raises ParameterError for a number of layers below 1 or a thickness of 0.
    """
    require(layers >= 1, "layers", layers, "at least 1")
    thickness, n = positive("thickness", thickness, "m"), len(section.volumes)
    first = n * np.arange(layers)

    def repeat(values, times=layers):
        return np.tile(values, times)

    across = np.arange(n * (layers - 1))
    edges = np.vstack([(section.edges + first[:, None, None]).reshape(-1, 2), np.column_stack([across, across + n])])
    faces = np.concatenate([repeat(section.faces) * thickness, repeat(section.volumes, layers - 1)])
    distances = np.concatenate([repeat(section.distances), np.full(across.size, thickness)])
    walls = {side: ((nodes + first[:, None]).ravel(), repeat(areas) * thickness, repeat(away))
             for side, (nodes, areas, away) in section.walls.items()}
    for side, layer in ((-2, 0), (-1, layers - 1)):
        walls[side] = n * layer + np.arange(n), section.volumes, np.full(n, thickness / 2)
    order = _sorted(edges)
    return Cells(edges=edges[order], faces=faces[order], distances=distances[order], walls=walls,
                 volumes=repeat(section.volumes) * thickness)


def among(pairs, others, n):
    """(m,) bool: which pairs (m, 2) of n particles, the lower number first, are among the others (k, 2)."""
    return np.isin(np.asarray(pairs) @ [n, 1], np.asarray(others) @ [n, 1])


def conducting(edges, joined, facing, n):
    """Which neighbours exchange heat while some of the contacts are open: (m,) bool.

    edges (m, 2) neighbours of n particles; joined (m,) bool: bonded or touching, these conduct; facing (m,) bool: never
    bonded, they only face each other across a pore. These conduct while the pore is closed, that is, while a third
    particle is connected to both by conducting pairs: a crack between the two would have to separate it from one of
    them. All others are cracks and do not conduct.
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

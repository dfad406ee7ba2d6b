"""Closed boundaries of facets: segments in the plane, triangles in space; measures, checks, refinement.

A boundary is vertices (n, d) in m and facets (m, d) of vertex numbers, d = 2 or 3. The body is on the left of a
directed segment; the corners of a triangle are in counter-clockwise order seen from outside. In the plane areas are
lengths and volumes are areas, both per metre of thickness.
"""
import heapq
import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay, cKDTree

from rockwear.kernels.checks import positive, require
from rockwear.kernels.polygon import check_polygon, cross as cross_in_plane, inside, nearest_on_edges, signed_distance

PAIRS = 1_000_000
"""Most pairs of points and triangles processed together in `distance`: some 500 MB of temporaries if all are near."""

LEVEL = 1e-6
"""Part of a tool's size by which its top may fall off and its back lean."""


def cross(a, b):
    """(n, 3) vector products of the rows of a and b (n, 3); faster than np.cross, equal to the last bit."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    product = np.empty(a.shape)
    product[:, 0], product[:, 1], product[:, 2] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    return product


def area_vectors(vertices, facets):
    """(m, d) m2 (in the plane: m), outward normal of each facet times its area."""
    first = vertices[facets[:, 0]]
    along = vertices[facets[:, 1]] - first
    if vertices.shape[1] == 2:
        return np.column_stack([along[:, 1], -along[:, 0]])
    return 0.5 * cross(along, vertices[facets[:, 2]] - first)


def volume(vertices, facets, origin=None):
    """Enclosed volume (m3; in the plane m2), sum of det(corners) / d! over the facets; positive for outward normals.

    For an open set of facets it is the volume between them and `origin` (d,) m: use only differences between sets with
    the same rim.
    """
    corners = vertices[facets]
    corners = corners - (corners.mean(axis=(0, 1)) if origin is None else origin)
    return float(np.linalg.det(corners).sum()) / (2 if vertices.shape[1] == 2 else 6)


def altitudes(vertices, facets, areas=None):
    """(m,) m, smallest altitude of each triangle, or the length of each segment. areas: area_vectors, if known."""
    size = np.linalg.norm(area_vectors(vertices, facets) if areas is None else areas, axis=1)
    if vertices.shape[1] == 2:
        return size
    corners = vertices[facets]
    return 2 * size / np.linalg.norm(corners - vertices[facets[:, [2, 0, 1]]], axis=2).max(axis=1)


def ridges(facets):
    """(k, d - 1) oriented edges (in the plane: ends) of all facets; each is listed once for each facet.

    Edges (i, j) of triangles in the order of their corners; of a segment (i, j) its ends, -1 - i for the first and j
    for the second, so that _opposite reverses the orientation in both cases.
    """
    if facets.shape[1] == 2:
        return np.concatenate([-1 - facets[:, :1], facets[:, 1:]])
    return np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]])


def _opposite(rows):
    return -1 - rows if rows.shape[1] == 1 else rows[:, ::-1]


def check_boundary(vertices, facets, name="boundary"):
    """(vertices, facets) as float and int arrays, without unused vertices.

    Raises ParameterError (under `name`) unless the vertices are finite, no facet is degenerate, every edge (in the
    plane: end) of a facet belongs to exactly one other with the opposite orientation, the volume is positive, no two
    facets intersect, and the surface is connected.
    """
    vertices, facets = np.array(vertices, float), np.array(facets, int)
    d = vertices.shape[1] if vertices.ndim == 2 else 0
    require(d in (2, 3) and facets.ndim == 2 and facets.shape[1] == d, name,
            f"{vertices.shape} vertices and {facets.shape} facets", "(n, 2) and (m, 2), or (n, 3) and (m, 3)")
    require(len(facets) > d, name, f"{len(facets)} facets", f"at least {d + 1} facets")
    known = 0 <= facets.min() and facets.max() < len(vertices)
    require(known, name, f"vertex {facets.max()}", "made of known vertices")
    require(np.isfinite(vertices).all(), name, f"{len(vertices)} vertices", "finite", "m")
    used, facets = np.unique(facets, return_inverse=True)
    vertices, facets = vertices[used], facets.reshape(-1, d)
    longest = np.linalg.norm(np.ptp(vertices, axis=0))
    flat = np.flatnonzero(altitudes(vertices, facets) <= 1e-9 * longest) if longest > 0 else [0]
    require(len(flat) == 0, name, f"facet {flat[0] if len(flat) else ''}", "free of degenerate facets (no area)")
    rows = ridges(facets)
    distinct, count = np.unique(rows, axis=0, return_counts=True)
    senses = {tuple(row) for row in distinct.tolist()}
    single = [row for row in distinct.tolist() if tuple(_opposite(np.array([row]))[0].tolist()) not in senses]
    turned = int((count > 1).sum())
    require(turned == 0, name, f"{turned} edges twice in one sense",
            "of one orientation: some facets are flipped or doubled")
    require(not single, name, f"{len(single)} open edges", "closed: it has holes")
    require(volume(vertices, facets) > 0, name, f"{len(facets)} facets", "oriented with its normals outwards")
    through = len(crossings(vertices, facets))
    require(through == 0, name, f"{through} crossings", "free of facets that intersect")
    shared = facets.ravel(), np.roll(facets, 1, axis=1).ravel()
    pieces, _ = connected_components(coo_matrix((np.ones(facets.size), shared), 2 * [len(vertices)]), directed=False)
    require(pieces == 1, name, f"{pieces} separate surfaces", "one piece without a cavity")
    return vertices, facets


def crossings(vertices, facets, moved=None):
    """(k, 4) or (k, 5) vertices of intersections between facets without a common vertex: in the plane pairs of
    segments, in space an edge and the triangle that it pierces. moved: (n,) bool; in space only facets with one of
    these vertices are checked."""
    if vertices.shape[1] == 2:
        return _meeting(vertices, facets)
    edges = ridges(facets)
    edges = edges[edges[:, 0] < edges[:, 1]]  # each is listed in both orientations
    if moved is None:
        return _piercing(vertices, edges, facets)
    of_edge, of_facet = moved[edges].any(axis=1), moved[facets].any(axis=1)
    return np.concatenate([_piercing(vertices, edges[of_edge], facets),
                           _piercing(vertices, edges[~of_edge], facets[of_facet])])


def _meeting(vertices, facets):
    middle = vertices[facets].mean(axis=1)
    along = vertices[facets[:, 1]] - vertices[facets[:, 0]]
    # The middles of intersecting segments are at most the length of the longest apart.
    reach = float(np.linalg.norm(along, axis=1).max())
    i, j = cKDTree(middle).query_pairs(reach * (1 + 1e-9), output_type="ndarray").T
    apart = (facets[i][:, :, None] != facets[j][:, None, :]).all(axis=(1, 2))
    i, j = i[apart], j[apart]
    gap = vertices[facets[j, 0]] - vertices[facets[i, 0]]
    det = cross_in_plane(along[i], along[j])
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = cross_in_plane(gap, along[j]) / det, cross_in_plane(gap, along[i]) / det
        meet = (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return np.column_stack([facets[i], facets[j]])[meet]


def _piercing(vertices, edges, facets):
    if not len(edges) or not len(facets):
        return np.empty((0, 5), int)
    i, j = _near(vertices, edges, facets)
    start, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    corner, normal = vertices[facets[:, 0]], 2 * area_vectors(vertices, facets)
    # Coplanar facets are on neither side of each other, in spite of round-off.
    least = 1e-9 * np.linalg.norm(normal, axis=1)[j] * np.linalg.norm(end - start, axis=1)[i]
    corner, normal = corner.take(j, axis=0), normal.take(j, axis=0)
    above, below = (np.einsum("ni,ni->n", normal, ends.take(i, axis=0) - corner) for ends in (start, end))
    between = (above * below < 0) & (np.minimum(abs(above), abs(below)) > least)
    rows, least = np.column_stack([edges[i[between]], facets[j[between]]]), least[between]
    apart = (rows[:, :2, None] != rows[:, None, 2:]).all(axis=(1, 2))
    rows, least = rows[apart], least[apart]
    p, q, *corners = np.moveaxis(vertices[rows], 1, 0)
    around = np.array([np.einsum("ni,ni->n", cross(q - p, v - p), w - p)
                       for v, w in zip(corners, corners[1:] + corners[:1])])
    return rows[(around.min(axis=0) >= -least) | (around.max(axis=0) <= least)]


def _near(vertices, edges, facets):
    """Numbers (2, k) of edges and facets whose bounding spheres intersect; facets of an octave with the largest one."""
    def spheres(rows):
        middle = vertices[rows].mean(axis=1)
        return middle, np.linalg.norm(vertices[rows] - middle[:, None], axis=2).max(axis=1)

    def within(points, others, reach):
        """Numbers of the points near the bounding box of the others: most calls concern a few facets."""
        low, high = others.min(axis=0) - reach, others.max(axis=0) + reach
        return np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))

    (middle, half), (centre, radius) = spheres(edges), spheres(facets)
    octave, numbers = np.floor(np.log2(radius)), [np.empty((2, 0), int)]
    for one in np.unique(octave):
        mine = np.flatnonzero(octave == one)
        reach = (half + radius[mine].max()) * (1 + 1e-9)
        some = within(middle, centre[mine], reach.max())
        if len(some):
            longest = reach[some].max()
            mine = mine[within(centre[mine], middle[some], longest)]
            near = cKDTree(centre[mine]).sparse_distance_matrix(cKDTree(middle[some]), longest, output_type="ndarray")
            i, j = some[near["j"]], mine[near["i"]]
            numbers.append(np.array([i, j])[:, near["v"] <= reach[i]])
    return np.concatenate(numbers, axis=1)


def nearest_on_triangle(point, triangle):
    """Point (3,) m of a triangle (3, 3) m nearest to `point` (3,) m."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    foot = point - normal * (normal @ (point - a)) / (normal @ normal)
    sides = [(a, b), (b, c), (c, a)]
    if all(np.cross(q - p, foot - p) @ normal >= 0 for p, q in sides):
        return foot
    rim = [p + (q - p) * np.clip((point - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1) for p, q in sides]
    return min(rim, key=lambda place: np.sum((place - point)**2))


def distance(points, vertices, facets):
    """(n,) m, distance of points (n, d) m from the nearest point of any facet."""
    points, corners = np.asarray(points, float), np.asarray(vertices, float)[facets]
    if points.shape[1] == 2:
        foot, _ = nearest_on_edges(points, corners[:, 0], corners[:, 1] - corners[:, 0])
        return np.linalg.norm(points - foot, axis=1)
    middle = corners.mean(axis=1)
    reach = np.linalg.norm(corners - middle[:, None], axis=2).max()
    tree, some = cKDTree(middle), max(1, PAIRS // len(corners))
    # The distance of the nearest corner is an upper bound.
    within = cKDTree(corners.reshape(-1, 3)).query(points)[0] + reach * (1 + 1e-9)
    squared = np.full(len(points), np.inf)
    for low in range(0, len(points), some):
        near = tree.query_ball_point(points[low:low + some], within[low:low + some])
        i, j = np.repeat(np.arange(low, low + len(near)), [len(one) for one in near]), np.concatenate(near).astype(int)
        np.minimum.at(squared, i, _squared_distances(points[i], corners[j]))
    return np.sqrt(squared)


def _squared_distances(points, triangles):
    """(n,) m2 between points (n, 3) and triangles (n, 3, 3): from the plane where the foot is inside the triangle, else
    from the nearest side."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    normal = np.cross(sides[:, 0], sides[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    away = points[:, None] - triangles
    between = (np.einsum("nkd,nkd->nk", away, np.cross(normal[:, None], sides)) >= 0).all(axis=1)
    along = np.clip(np.einsum("nkd,nkd->nk", away, sides) / np.einsum("nkd,nkd->nk", sides, sides), 0, 1)
    to_side = np.sum((away - along[..., None] * sides)**2, axis=2).min(axis=1)
    return np.where(between, np.einsum("nd,nd->n", away[:, 0], normal)**2, to_side)


def foremost(vertices, facets, below):
    """Largest x (m) of what the facets have below the height y = `below` (m) and where they come up to it, -inf for
    nothing below it."""
    x, y = vertices[:, 0], vertices[:, 1]
    low = y < below
    # Of a closed boundary each edge is there in both senses, in one of which it rises.
    edges = np.stack([facets, np.roll(facets, -1, axis=1)]).reshape(2, -1)
    begin, end = edges[:, low[edges[0]] & ~low[edges[1]]]
    crossing = x[begin] + (below - y[begin]) / (y[end] - y[begin]) * (x[end] - x[begin])
    return float(np.concatenate([x[low], crossing]).max(initial=-np.inf))


def held_sides(vertices, facets):
    """(2, m) bool: facets that lie in the top, the largest y, and in the back, the smallest x, of a tool."""
    slack = LEVEL * np.ptp(vertices[:, :2], axis=0).max()
    top, back = vertices[:, 1] > vertices[:, 1].max() - slack, vertices[:, 0] < vertices[:, 0].min() + slack
    return np.stack([top[facets].all(axis=1), back[facets].all(axis=1)])


def segments(polygon):
    """(vertices, facets) of a polygon (k, 2) m, one segment for each side. Raises as check_polygon."""
    corners = check_polygon(polygon)
    number = np.arange(len(corners))
    return corners, np.column_stack([number, np.roll(number, -1)])


def prism(polygon, width, size):
    """(vertices, facets) of a polygon (k, 2) m in x and y extruded to `width` m along z about z = 0; triangles of about
    `size` m.

    Corners of the polygon less than half the size apart are merged, except sharp ones (40 degrees). Raises
    ParameterError for a width or size that is not positive, a size too coarse for the polygon, and as check_polygon.
    """
    rim = _in_order(*refine(*segments(_thinned(check_polygon(polygon), positive("size", size, "m"))), size))
    k, layers = len(rim), max(1, math.ceil(positive("width", width, "m") / size))
    flat, face = _fill(rim, size)
    heights = np.linspace(-0.5 * width, 0.5 * width, layers + 1)
    points, facets = [np.column_stack([rim, np.full(k, z)]) for z in heights], []
    i = np.arange(k)
    j = np.roll(i, -1)
    for low in range(0, layers * k, k):
        facets += [np.column_stack([i, j, j + k]) + low, np.column_stack([i, j + k, i + k]) + low]
    inner = flat[k:]
    for low, z, triangles in ((0, heights[0], face[:, ::-1]), (layers * k, heights[-1], face)):
        first = sum(map(len, points))
        points.append(np.column_stack([inner, np.full(len(inner), z)]))
        facets.append(np.where(triangles < k, triangles + low, triangles - k + first))
    return np.vstack(points), np.vstack(facets)


def _thinned(polygon, size):
    """The polygon without corners less than half of `size` from the last, except sharp ones."""
    along = np.roll(polygon, -1, axis=0) - polygon
    along /= np.linalg.norm(along, axis=1)[:, None]
    sharp = np.einsum("ij,ij->i", along, np.roll(along, 1, axis=0)) < math.cos(math.radians(40))
    first = int(np.argmax(sharp))
    kept = []
    for number in np.roll(np.arange(len(polygon)), -first):
        if not kept or sharp[number] or np.linalg.norm(polygon[number] - polygon[kept[-1]]) >= 0.5 * size:
            kept.append(number)
    return polygon[kept]


def _in_order(vertices, facets):
    """Corners (k, 2) of the polygon formed by the segments."""
    following, loop = dict(facets.tolist()), [0]
    while following[loop[-1]] != 0:
        loop.append(following[loop[-1]])
    return vertices[loop]


def _fill(rim, size):
    """Points (n, 2), `rim` and a grid of spacing `size` inside it, and their triangles (m, 3)."""
    low, high = rim.min(axis=0), rim.max(axis=0)
    x, y = np.meshgrid(np.arange(low[0], high[0], size), np.arange(low[1], high[1], size * math.sqrt(0.75)))
    x[1::2] += 0.5 * size
    grid = np.column_stack([x.ravel(), y.ravel()])
    grid = grid[signed_distance(grid, rim) < -0.6 * size]
    points = np.vstack([rim, grid])
    triangles = Delaunay(points).simplices
    corners = points[triangles]
    p, q = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    turn = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    triangles = np.where(turn[:, None] > 0, triangles, triangles[:, ::-1])[np.abs(turn) > 1e-9 * size * size]
    triangles = triangles[inside(points[triangles].mean(axis=1), rim)]
    sides = {(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1])}
    k = len(rim)
    require(all((i, (i + 1) % k) in sides for i in range(k)), "size", size, "finer: its triangles cut the polygon", "m")
    return points, triangles


def refine(vertices, facets, size):
    """(vertices, facets) with edges bisected, the longest first, until none is longer than `size`: m, or a function of
    a point (d,) -> m.

    Both facets at an edge are divided: the boundary stays closed and its shape the same.
    """
    wanted = size if callable(size) else lambda point: size
    points, facets = [np.asarray(p, float) for p in vertices], [tuple(f) for f in np.asarray(facets).tolist()]
    owners = {}
    for number, facet in enumerate(facets):
        for edge in _edges(facet):
            owners.setdefault(edge, set()).add(number)

    def excess(edge):
        i, j = edge
        return -float(np.linalg.norm(points[i] - points[j])) / wanted(0.5 * (points[i] + points[j]))

    queue = [(excess(edge), edge) for edge in owners]
    heapq.heapify(queue)
    while queue and queue[0][0] < -1 - 1e-9:
        _, edge = heapq.heappop(queue)
        i, j = edge
        middle = len(points)
        points.append(0.5 * (points[i] + points[j]))
        fresh = set()
        for number in sorted(owners.pop(edge)):
            old = facets[number]
            for side in _edges(old):
                owners.get(side, set()).discard(number)
            halves = [tuple(middle if v == away else v for v in old) for away in (j, i)]
            facets[number] = halves[0]
            facets.append(halves[1])
            for place in (number, len(facets) - 1):
                for side in _edges(facets[place]):
                    if side not in owners:
                        owners[side] = set()
                        fresh.add(side)
                    owners[side].add(place)
        for side in sorted(fresh):
            heapq.heappush(queue, (excess(side), side))
    return np.array(points), np.array(facets)


def _edges(facet):
    pairs = [facet] if len(facet) == 2 else [facet[:2], facet[1:], (facet[2], facet[0])]
    return [(min(pair), max(pair)) for pair in pairs]

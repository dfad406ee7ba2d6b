"""Remeshing of a closed boundary of facets whose shape changes. (Ours.)

The numbers of vertices and facets stay. A short edge is collapsed and its vertex inserted in the middle of the longest
edge; in space the longest side of a flat triangle is flipped instead. Both keep the volume. A feather edge breaks off.
"""
import numpy as np

from rockwear.kernels.boundary import altitudes, area_vectors, check_boundary, crossings, distance, ridges, volume
from rockwear.kernels.checks import ParameterError

CROWDED = 0.3
"""A facet is crowded if its smallest altitude is below this fraction of the initial one."""
OFF = 0.02
"""Largest distance of the new surface from its old vertices, over the size of a facet, unless facets are TIGHT."""
TIGHT = 0.1
"""Below this fraction of its initial altitude a facet may be removed at the cost of an edge finer than the facets."""
RELIEF = 0.95
"""Largest ratio of the sums of reciprocal fractions, over the changed facets, after and before an operation."""
WORTH = 1.3
"""Least ratio of the facets where a vertex is inserted to those from which it is removed."""
EDGE = 0.13
"""Two equal facets form an edge if their normals are more than 40 degrees apart: the sum of a n n^T then has a second
eigenvalue of more than tan^2(20 degrees) times the first."""
PLANE = 1e-8
"""Fixed facets are coplanar if the second eigenvalue is less than tan^2(1e-4) times the first."""
TURN = 0.5
"""Least cosine of the rotation of a facet in one operation: 60 degrees."""
SHARP = -0.9
"""An edge between facets whose normals have less than this cosine (154 degrees) is a feather edge and breaks off,
unless the initial boundary has sharper ones."""
BLUNT = 0.8
"""Fraction of the way to the middle between the adjacent vertices by which a feather edge breaks off."""
AGAIN = 0.9
"""A facet that could not be remeshed is tried again if smaller by this factor, or after a change beside it."""
OPERATIONS = 100
"""Most operations at one time."""
SHAPE = "vertices", "facets", "fixed", "size", "place", "pending", "refused"
CONNECTIONS = "joined", "around", "seam", "beside", "ways"


class Mesh:
    """A closed boundary of facets with a fixed part.

    vertices: (n, d) m; facets: (m, d), normals outwards; fixed: (m,) bool, facets whose plane (line) stays.

    `size` (m,) m is the initial smallest altitude of a facet, `place` (m,) the number of the initial facet on whose
    part of the surface it lies, `pending` (m,) m3 the volume still to be worn off it, `refused` (m,) its altitude over
    size at the last failed operation, `joined` (k, 2) adjacent facets, `around` (j, 2) adjacent vertices.
    Raises ParameterError as check_boundary, and if all facets are fixed.
    """

    def __init__(self, *, vertices, facets, fixed=None):
        self.vertices, self.facets = check_boundary(vertices, facets)
        self.dimension = self.vertices.shape[1]
        m = len(self.facets)
        self.fixed = np.zeros(m, bool) if fixed is None else np.array(fixed, bool)
        if self.fixed.shape != (m,) or self.fixed.all():
            raise ParameterError("fixed", f"{int(self.fixed.sum())} of {m} facets",
                                 "a flag for each facet that leaves at least one free")
        self.size = altitudes(self.vertices, self.facets)
        self.place, self.pending, self.refused = np.arange(m), np.zeros(m), np.full(m, np.inf)
        self._connect()
        self.sharp = min(SHARP, self.bends(area_vectors(self.vertices, self.facets)).min() - 0.01)

    def _connect(self):
        """Connectivity of the present facets."""
        d, facets = self.dimension, self.facets
        self.joined = joined(facets)
        n = len(self.vertices)
        codes = np.unique(np.concatenate([n * facets[:, a] + facets[:, b]
                                          for a in range(d) for b in range(d) if a != b]))
        self.around = np.column_stack([codes // n, codes % n])
        pairs = facets[self.joined]
        common = (pairs[:, :, :, None] == pairs[:, ::-1, None, :]).any(axis=3)
        self.seam, self.beside = pairs[:, 0][common[:, 0]].reshape(len(pairs), -1), pairs[~common].reshape(-1, 2)
        self.ways = self._ways_left()

    def _ways_left(self):
        """(n, d, d) projection of vertex motions on the directions in which the fixed facets keep their planes: the
        identity without fixed facets, their common plane or line, zero at their corners."""
        areas = area_vectors(self.vertices, self.facets) * self.fixed[:, None]
        size = np.maximum(np.linalg.norm(areas, axis=1), np.finfo(float).tiny)
        values, frames = np.linalg.eigh(self.normal_tensors(areas / size[:, None], size))
        return np.einsum("nij,nj,nkj->nik", frames, values <= PLANE * values[:, -1:], frames)

    def normal_tensors(self, normals, size):
        """(n, d, d) m2, sum of a n n^T over the facets at each vertex. normals n: (m, d); size a: (m,) areas."""
        d = self.dimension
        tensors = (size[:, None, None] * normals[:, :, None] * normals[:, None, :]).reshape(-1, d * d)
        return self.sum_at_vertices(np.repeat(tensors, d, axis=0)).reshape(-1, d, d)

    def sum_at_vertices(self, rows):
        """(n, k) sums over the corners of facets, given as rows (m d, k)."""
        return np.column_stack([np.bincount(self.facets.ravel(), column, len(self.vertices)) for column in rows.T])

    def neighbours(self):
        """[set of the facets that share a vertex with facet k] by k."""
        at = [set() for _ in self.vertices]
        for number, facet in enumerate(self.facets.tolist()):
            for vertex in facet:
                at[vertex].add(number)
        return [set().union(*(at[vertex] for vertex in facet)) - {number}
                for number, facet in enumerate(self.facets.tolist())]

    def bends(self, areas):
        """(k,) cosine between the normals of joined facets. areas: (m, d), normals of any length."""
        size = np.linalg.norm(areas, axis=1)
        one, other = self.joined.T
        scale = np.maximum(size[one] * size[other], np.finfo(float).tiny)
        return np.einsum("ni,ni->n", areas[one], areas[other]) / scale

    def slope(self, vertices, normals):
        """(k,) m, rise of the second of joined facets over the plane of the first: negative at a convex edge, positive
        in a notch. normals: (m, d), of length 1 (else the rise is multiplied by their length)."""
        rise = vertices[self.beside[:, 1]] - vertices[self.seam[:, 0]]
        return np.einsum("ni,ni->n", rise, normals[self.joined[:, 0]])

    def notches(self, vertices, normals):
        """(k,) bool, whether joined facets nearly close a notch. normals: (m, d), of any length."""
        return (self.bends(normals) < SHARP) & (self.slope(vertices, normals) > 0)

    # ---- operations

    def even_out(self):
        """Remesh crowded facets, the smallest first, until none is left or none can be. -> whether facets changed."""
        done = False
        for _ in range(OPERATIONS):
            part = altitudes(self.vertices, self.facets) / self.size
            waiting = np.where((part < CROWDED) & (part < AGAIN * self.refused), part, np.inf)
            worst = int(np.argmin(waiting))
            if waiting[worst] == np.inf:
                break
            if self._remesh(worst, part[worst]):
                done = True
            else:
                self.refused[worst] = part[worst]
        return done

    def blunt(self):
        """Break off feather edges: their vertices move towards those beside them. -> m3 lost."""
        lost = 0.0
        for _ in range(OPERATIONS):
            areas = area_vectors(self.vertices, self.facets)
            feather = (self.bends(areas) < self.sharp) & (self.slope(self.vertices, areas) < 0)
            feather &= self.ways[self.seam].any(axis=(1, 2, 3))
            if not feather.any():
                break
            seam, beside = self.seam[feather], self.beside[feather]
            count = np.bincount(seam.ravel(), minlength=len(self.vertices))[:, None]
            aim = np.zeros_like(self.vertices)
            np.add.at(aim, seam, self.vertices[beside].mean(axis=1)[:, None])
            way = BLUNT * np.einsum("nij,nj->ni", self.ways, aim / np.maximum(count, 1) - self.vertices) * (count > 0)
            # All at once, else one by one where possible.
            gone = [self._break_off(way)] if way.any() else []
            if gone == [0.0]:
                gone = [self._break_off(way * (np.arange(len(way)) == k)[:, None]) for k in np.flatnonzero(count)]
            if not any(gone):
                break
            lost += sum(gone)
        return lost

    def _break_off(self, way):
        """Move vertices by `way` (n, d) m unless facets would fold. -> m3 lost."""
        moved = way.any(axis=1)
        fresh = self.vertices + way
        areas = area_vectors(fresh, self.facets)
        notch = self.notches(fresh, areas)
        concerned = moved[self.seam].any(axis=1) | moved[self.beside].any(axis=1)
        if notch[concerned].any() or len(crossings(fresh, self.facets, moved)):
            return 0.0
        star, origin, old = moved[self.facets].any(axis=1), fresh.mean(axis=0), self.vertices
        before = volume(self.vertices, self.facets[star], origin)
        self.vertices = fresh
        lost = before - volume(self.vertices, self.facets[star], origin)
        if lost <= 0:
            self.vertices, lost = old, 0.0
        return lost

    def _remesh(self, facet, part):
        """Collapse the shortest side of a facet, or flip its longest. -> whether the mesh is sound, else unchanged."""
        corners = self.facets[facet]
        sides = self.vertices[np.roll(corners, -1)] - self.vertices[corners]
        length = np.linalg.norm(sides, axis=1)
        shortest, longest = int(np.argmin(length)), int(np.argmax(length))
        ends = corners[shortest], corners[(shortest + 1) % self.dimension]
        flat = self.dimension == 3 and part * self.size[facet] < 0.5 * length[shortest]
        ways = [lambda: self._flip(facet, longest)] if flat else []
        ways += [lambda keep=keep: self._collapse(keep, ends[0] + ends[1] - keep, part) for keep in self._ranked(ends)]
        before = {name: getattr(self, name).copy() for name in SHAPE}
        connections = {name: getattr(self, name) for name in CONNECTIONS}
        for way in ways:
            if way() and self._is_sound(before, part):
                return True
            for name, value in before.items():
                setattr(self, name, value.copy())
            for name, value in connections.items():
                setattr(self, name, value)
        return False

    def _ranked(self, ends):
        """Ends of an edge, the one to keep first: that with fewer degrees of freedom, then a corner, then an edge."""
        def rank(vertex):
            return np.trace(self.ways[vertex]).round(), *-self._sharpness(vertex).round(2)

        return sorted(ends, key=rank)

    def _collapse(self, keep, gone, part):
        """Collapse the edge from vertex `gone` to `keep`, and insert `gone` in the middle of the longest edge."""
        if not self._simple(keep, gone):
            return False
        has_keep, has_gone = ((self.facets == vertex).any(axis=1) for vertex in (keep, gone))
        between, star = np.flatnonzero(has_keep & has_gone), has_keep | has_gone
        origin = self.vertices[keep].copy()
        was = volume(self.vertices, self.facets[star], origin)
        left = np.flatnonzero(star & ~(has_keep & has_gone))
        taking = left[~self.fixed[left]] if not self.fixed[left].all() else np.flatnonzero(~self.fixed)
        self.pending[taking] += self.pending[between].sum() / len(taking)
        self.facets[has_gone] = np.where(self.facets[has_gone] == gone, keep, self.facets[has_gone])
        return self._restore_volume(keep, left, origin, was) and self._split_longest(gone, between, part)

    def _simple(self, keep, gone):
        """Whether the ends have no common neighbours but those of the facets at the edge, so that a surface remains."""
        j, k = self.around.T
        common = set(k[j == keep].tolist()).intersection(k[j == gone].tolist())
        return len(common) == (2 if self.dimension == 3 else 0)

    def _restore_volume(self, vertex, star, origin, was):
        """Move the vertex so that the facets `star` have the volume `was`. -> whether the displacement is small."""
        areas = area_vectors(self.vertices, self.facets[star])
        normal, area = areas.sum(axis=0) / self.dimension, np.linalg.norm(areas, axis=1).sum() / self.dimension
        way, missing = self.ways[vertex] @ normal, was - volume(self.vertices, self.facets[star], origin)
        if way @ normal <= (1e-3 * area)**2:
            return abs(missing) <= 1e-12 * area * self.size[star].mean()
        step = way * (missing / (way @ normal))
        self.vertices[vertex] += step
        return bool(np.linalg.norm(step) < 0.5 * self.size[star].mean())

    def _split_longest(self, vertex, spare, part):
        """Insert `vertex` in the middle of the edge that is longest over the size of its facets and not fixed, and use
        the facets `spare` there."""
        d, facets = self.dimension, self.facets
        start, end = (facets[:, :1], facets[:, 1:]) if d == 2 else (facets, np.roll(facets, -1, axis=1))
        length = np.linalg.norm(self.vertices[end] - self.vertices[start], axis=2)
        length = np.where(self.fixed[:, None], 0.0, length / self.size[:, None])
        length[spare] = 0.0
        row, side = np.unravel_index(np.argmax(length), length.shape)
        if length[row, side] < 2 * WORTH * part:
            return False
        i, j = start[row, side], end[row, side]
        holders = (facets == i).any(axis=1) & (facets == j).any(axis=1)
        holders[spare] = False
        self.vertices[vertex] = 0.5 * (self.vertices[i] + self.vertices[j])
        for old, new in zip(np.flatnonzero(holders), spare):
            corners = self.facets[old].copy()
            self.facets[old], self.facets[new] = (np.where(corners == end, vertex, corners) for end in (j, i))
            self.pending[old] *= 0.5
            for values in (self.pending, self.fixed, self.size, self.place):
                values[new] = values[old]
        return True

    def _flip(self, facet, side):
        """Flip the longest edge `side` of a flat triangle: it then connects the third corner, which is moved on it, and
        that of the triangle behind it."""
        a, b, c = np.roll(self.facets[facet], -side)
        holders = np.flatnonzero((self.facets == a).any(axis=1) & (self.facets == b).any(axis=1))
        behind = int(holders[holders != facet][0])
        e = self.facets[behind].sum() - a - b
        if self.fixed[behind] != self.fixed[facet] or ((self.around[:, 0] == c) & (self.around[:, 1] == e)).any():
            return False
        star = np.flatnonzero((self.facets == c).any(axis=1) | (np.arange(len(self.facets)) == behind))
        origin = self.vertices[c].copy()
        was, flat = volume(self.vertices, self.facets[star], origin), self._sharpness(c)[-1] < EDGE
        self.facets[facet], self.facets[behind] = (a, e, c), (e, b, c)
        if flat:
            along = self.vertices[b] - self.vertices[a]
            foot = self.vertices[a] + along * ((origin - self.vertices[a]) @ along / (along @ along))
            self.vertices[c] += self.ways[c] @ (foot - origin)
        star = np.flatnonzero((self.facets == c).any(axis=1))
        return self._restore_volume(c, star, origin, was)

    def _sharpness(self, vertex):
        """(d - 1,) eigenvalues of the normal tensor of a vertex over the largest, ascending: in space both are 0 in a
        plane, the first at an edge, none at a corner."""
        areas = area_vectors(self.vertices, self.facets[(self.facets == vertex).any(axis=1)])
        values = np.linalg.eigvalsh(np.einsum("ni,nj->ij", areas, areas / np.linalg.norm(areas, axis=1)[:, None]))
        return values[:-1] / values[-1]

    def _is_sound(self, before, part):
        """Whether the facets changed since `before` are less crowded, lie on the old surface, have rotated by less than
        TURN (fixed ones not at all), and neither close a notch nor intersect others."""
        vertices, facets = before["vertices"], before["facets"]
        other = (self.facets != facets).any(axis=1) | (self.vertices != vertices).any(axis=1)[facets].any(axis=1)
        high = altitudes(self.vertices, self.facets[other]) / self.size[other]
        were_high = altitudes(vertices, facets[other]) / before["size"][other]
        if not other.any() or not high.all() or (1 / high).sum() > RELIEF * (1 / were_high).sum():
            return False
        old = vertices[np.unique(facets[other])]
        off = OFF if part > TIGHT else 0.5
        if distance(old, self.vertices, self.facets[other]).max() > off * self.size[other].min():
            return False
        normals, were = (areas / np.linalg.norm(areas, axis=1)[:, None] for areas in (
            area_vectors(self.vertices, self.facets), area_vectors(vertices, facets)))
        if not self._rotated_little(other, normals[other], before, were):
            return False
        self._connect()
        if self.notches(self.vertices, normals)[other[self.joined].any(axis=1)].any():
            return False
        moved = np.zeros(len(self.vertices), bool)
        moved[self.facets[other]] = True
        if len(crossings(self.vertices, self.facets, moved)):
            return False
        self.refused[moved[self.facets].any(axis=1)] = np.inf
        return True

    def _rotated_little(self, other, normals, before, were):
        """Whether the normal of each facet `other` is near that of one of `before` which shared two of its corners (in
        the plane: one) and was fixed if it is."""
        near = np.zeros(len(self.vertices), bool)
        near[self.facets[other]] = True
        old = near[before["facets"]].any(axis=1)
        corners = before["facets"][old][:, None, :, None] == self.facets[other][None, :, None, :]
        shared = corners.any(axis=3).sum(axis=2)
        alike = (shared >= self.dimension - 1) & (before["fixed"][old][:, None] == self.fixed[other])
        least = np.where(self.fixed[other], 1 - 1e-10, TURN)
        return bool((alike & (were[old] @ normals.T > least)).any(axis=0).all())


def joined(facets):
    """(k, 2) facets that share an edge (in the plane: an end)."""
    d = facets.shape[1]
    owner = np.tile(np.arange(len(facets)), d)
    rows = np.sort(ridges(facets), axis=1) if d == 3 else np.abs(ridges(facets) + 0.5)
    return owner[np.lexsort(rows.T)].reshape(-1, 2)

"""Remeshing of a closed boundary of facets whose shape changes: facets that crowd are given to where they are missed.

The numbers of vertices and of facets stay. A vertex goes where an edge has become short, and is put in the middle of
the longest edge; in space the longest side of a flat triangle is turned instead. Neither changes the volume. A feather
edge breaks off.
"""
import numpy as np

from rockwear.kernels.boundary import altitudes, area_vectors, check_boundary, crossings, distance, ridges, volume
from rockwear.kernels.checks import ParameterError

CROWDED = 0.3
"""A facet crowds where its smallest altitude has fallen to this part of what it was at first."""
OFF = 0.02
"""The surface leaves none of its old vertices by more than this part of a facet's size, unless facets are TIGHT."""
TIGHT = 0.1
"""A facet so small a part of what it was may be relieved at the cost of an edge: that is finer than the facets."""
RELIEF = 0.95
"""An operation must bring the sum of the reciprocals of these parts, over the facets it changes, down to so much of it."""
WORTH = 1.3
"""A vertex goes elsewhere if facets there stay larger than those it leaves by this factor."""
EDGE = 0.13
"""Two equal facets make an edge where they meet at more than 40 degrees: they look across their mean normal with
tan^2(20 degrees) of the weight with which they look along it."""
PLANE = 1e-8
"""Protected facets are in one plane where they look across their mean normal with less than tan^2(1e-4) of the weight."""
TURN = 0.5
"""No facet turns by more than 60 degrees, cosine 0.5, at once."""
SHARP = -0.9
"""An edge between facets whose normals have less than this cosine, 154 degrees, breaks off, unless such were there at
first."""
BLUNT = 0.8
"""By this part of the way back to between the vertices beside it."""
AGAIN = 0.9
"""A facet that could not be relieved is tried again when it has become so much smaller, or one beside it another."""
OPERATIONS = 100
"""So many at one time; what still crowds waits for the next."""
SHAPE = "vertices", "facets", "fixed", "size", "place", "pending", "refused"
CONNECTIONS = "joined", "around", "seam", "beside", "ways"


class Mesh:
    """A closed boundary of facets, parts of which are fixed.

    vertices: (n, d) m; facets: (m, d), normals outwards; fixed: (m,) bool, facets whose plane (line) stays.

    `size` (m,) m is the smallest altitude that a facet had at first, `place` (m,) the number of the first facet on whose
    part of the surface it lies, `pending` (m,) m3 what is to be worn off it. `refused` (m,) is its altitude, as a part of
    its size, when it could not be relieved.
    Raises ParameterError for a boundary that is open, folded, or not oriented outwards, or fixed altogether.
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
        """What follows from which facets there are."""
        d, facets = self.dimension, self.facets
        self.joined = joined(facets)
        n = len(self.vertices)
        codes = np.unique(np.concatenate([n * facets[:, a] + facets[:, b] for a in range(d) for b in range(d) if a != b]))
        self.around = np.column_stack([codes // n, codes % n])
        pairs = facets[self.joined]
        common = (pairs[:, :, :, None] == pairs[:, ::-1, None, :]).any(axis=3)
        self.seam, self.beside = pairs[:, 0][common[:, 0]].reshape(len(pairs), -1), pairs[~common].reshape(-1, 2)
        self.ways = self._ways_left()

    def _ways_left(self):
        """(n, d, d) projection of each vertex's motion on what its fixed facets leave it: all for a vertex of none,
        their common plane or line for one on them, nothing for a corner of them."""
        areas = area_vectors(self.vertices, self.facets) * self.fixed[:, None]
        size = np.maximum(np.linalg.norm(areas, axis=1), np.finfo(float).tiny)
        values, frames = np.linalg.eigh(self.looks(areas / size[:, None], size))
        return np.einsum("nij,nj,nkj->nik", frames, values <= PLANE * values[:, -1:], frames)

    def looks(self, normals, size):
        """(n, d, d) sum of area n n^T over the facets at each vertex: where its facets look."""
        d = self.dimension
        looks = np.repeat((size[:, None, None] * normals[:, :, None] * normals[:, None, :]).reshape(-1, d * d), d, axis=0)
        return self.sum_at_vertices(looks).reshape(-1, d, d)

    def sum_at_vertices(self, rows):
        """(n, k) sums of rows (m d, k), one for each corner of each facet."""
        return np.column_stack([np.bincount(self.facets.ravel(), column, len(self.vertices)) for column in rows.T])

    def neighbours(self):
        """[{facets that have a vertex in common with facet k}] by k."""
        at = [set() for _ in self.vertices]
        for number, facet in enumerate(self.facets.tolist()):
            for vertex in facet:
                at[vertex].add(number)
        return [set().union(*(at[vertex] for vertex in facet)) - {number}
                for number, facet in enumerate(self.facets.tolist())]

    def bends(self, areas):
        """(k,) cosine between the normals of the joined facets, from normals (m, d) of any length."""
        size = np.linalg.norm(areas, axis=1)
        one, other = self.joined.T
        return np.einsum("ni,ni->n", areas[one], areas[other]) / np.maximum(size[one] * size[other], np.finfo(float).tiny)

    def slope(self, vertices, normals):
        """(k,) m by which the second of the joined facets rises over the first one's plane: below zero at an edge that
        stands out, above it in a notch. normals (m, d), or m times their length."""
        rise = vertices[self.beside[:, 1]] - vertices[self.seam[:, 0]]
        return np.einsum("ni,ni->n", rise, normals[self.joined[:, 0]])

    def notches(self, vertices, normals):
        """(k,) whether the joined facets, with these normals (m, d) of any length, all but close a notch."""
        return (self.bends(normals) < SHARP) & (self.slope(vertices, normals) > 0)

    # ---- operations

    def even_out(self):
        """Relieve facets that crowd, the worst first, until none does or none can be relieved. -> whether any was."""
        done = False
        for _ in range(OPERATIONS):
            part = altitudes(self.vertices, self.facets) / self.size
            waiting = np.where((part < CROWDED) & (part < AGAIN * self.refused), part, np.inf)
            worst = int(np.argmin(waiting))
            if waiting[worst] == np.inf:
                break
            if self._relieve(worst, part[worst]):
                done = True
            else:
                self.refused[worst] = part[worst]
        return done

    def blunt(self):
        """Let feather edges break off: their vertices go back to between those beside them. -> m3 that is lost."""
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
            # All of them at once, else as many as can be.
            gone = [self._break_off(way)] if way.any() else []
            if gone == [0.0]:
                gone = [self._break_off(way * (np.arange(len(way)) == k)[:, None]) for k in np.flatnonzero(count)]
            if not any(gone):
                break
            lost += sum(gone)
        return lost

    def _break_off(self, way):
        """Move vertices by `way` (n, d) m unless that would fold something. -> m3 that is lost."""
        moved = way.any(axis=1)
        fresh = self.vertices + way
        areas = area_vectors(fresh, self.facets)
        notch = self.notches(fresh, areas)
        if notch[moved[self.seam].any(axis=1) | moved[self.beside].any(axis=1)].any() or len(crossings(fresh, self.facets, moved)):
            return 0.0
        star, origin, old = moved[self.facets].any(axis=1), fresh.mean(axis=0), self.vertices
        before = volume(self.vertices, self.facets[star], origin)
        self.vertices = fresh
        lost = before - volume(self.vertices, self.facets[star], origin)
        if lost <= 0:
            self.vertices, lost = old, 0.0
        return lost

    def _relieve(self, facet, part):
        """Take away the facet's shortest side, or turn its longest. -> whether that is sound, else nothing has changed."""
        corners = self.facets[facet]
        sides = self.vertices[np.roll(corners, -1)] - self.vertices[corners]
        length = np.linalg.norm(sides, axis=1)
        shortest, longest = int(np.argmin(length)), int(np.argmax(length))
        ends = corners[shortest], corners[(shortest + 1) % self.dimension]
        flat = self.dimension == 3 and part * self.size[facet] < 0.5 * length[shortest]
        ways = [lambda: self._turn(facet, longest)] if flat else []
        ways += [lambda keep=keep: self._carry(keep, ends[0] + ends[1] - keep, part) for keep in self._ranked(ends)]
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
        """The ends of an edge, first the one that is to stay: that with the fewest ways, then a corner, then an edge."""
        return sorted(ends, key=lambda vertex: (np.trace(self.ways[vertex]).round(), *-self._sharpness(vertex).round(2)))

    def _carry(self, keep, gone, part):
        """Take vertex `gone` away to the vertex `keep` beside it, and put it into the longest edge."""
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
        """Whether the facets at the edge are all that its ends have in common, so that its loss leaves a surface."""
        j, k = self.around.T
        common = set(k[j == keep].tolist()).intersection(k[j == gone].tolist())
        return len(common) == (2 if self.dimension == 3 else 0)

    def _restore_volume(self, vertex, star, origin, was):
        """Move the vertex on its ways so that its star has the volume it `was`. -> whether that is no long way."""
        areas = area_vectors(self.vertices, self.facets[star])
        normal, area = areas.sum(axis=0) / self.dimension, np.linalg.norm(areas, axis=1).sum() / self.dimension
        way, missing = self.ways[vertex] @ normal, was - volume(self.vertices, self.facets[star], origin)
        if way @ normal <= (1e-3 * area)**2:
            return abs(missing) <= 1e-12 * area * self.size[star].mean()
        step = way * (missing / (way @ normal))
        self.vertices[vertex] += step
        return bool(np.linalg.norm(step) < 0.5 * self.size[star].mean())

    def _split_longest(self, vertex, spare, part):
        """Put `vertex` in the middle of the longest edge, for its facets' sizes, that is not all fixed, with the
        facets `spare` beside it."""
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

    def _turn(self, facet, side):
        """Let the edge `side` of a flat triangle run from its third corner, which is put on it, to that of the triangle
        behind it."""
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
        """(d - 1,) how much the facets there look across their mean normal, for what they look along it, the least first:
        in space none is zero at a corner, only the first at an edge."""
        areas = area_vectors(self.vertices, self.facets[(self.facets == vertex).any(axis=1)])
        values = np.linalg.eigvalsh(np.einsum("ni,nj->ij", areas, areas / np.linalg.norm(areas, axis=1)[:, None]))
        return values[:-1] / values[-1]

    def _is_sound(self, before, part):
        """Whether the facets that are another shape than `before` crowd less, lie where the surface was, have turned
        little, fixed ones not at all, and neither close a notch nor run through others."""
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
        if not self._turned_little(other, normals[other], before, were):
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

    def _turned_little(self, other, normals, before, were):
        """Whether each of the facets `other`, with these normals, looks as one of `before` did that shared two of its
        corners (in the plane: one) and was fixed or not as it is."""
        near = np.zeros(len(self.vertices), bool)
        near[self.facets[other]] = True
        old = near[before["facets"]].any(axis=1)
        shared = (before["facets"][old][:, None, :, None] == self.facets[other][None, :, None, :]).any(axis=3).sum(axis=2)
        alike = (shared >= self.dimension - 1) & (before["fixed"][old][:, None] == self.fixed[other])
        least = np.where(self.fixed[other], 1 - 1e-10, TURN)
        return bool((alike & (were[old] @ normals.T > least)).any(axis=0).all())


def joined(facets):
    """(k, 2) facets that share an edge (in the plane: an end)."""
    d = facets.shape[1]
    owner = np.tile(np.arange(len(facets)), d)
    rows = np.sort(ridges(facets), axis=1) if d == 3 else np.abs(ridges(facets) + 0.5)
    return owner[np.lexsort(rows.T)].reshape(-1, 2)

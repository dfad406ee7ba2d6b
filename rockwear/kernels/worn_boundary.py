"""Wear of a boundary of facets: the volume worn off each facet becomes an inward motion of its vertices (R 2.5).

The volume V of a closed boundary of facets with area vectors a_f is linear in any single vertex, dV/dx_j = N_j = sum of
a_f / d over the facets at j, and a polynomial of degree d in the length s of a common motion x + s u. So the motion
that takes away exactly a demanded volume is found to round-off.
"""
import numpy as np
from scipy.sparse import bsr_matrix, coo_matrix, identity, kron
from scipy.sparse.linalg import splu

from .boundary import altitudes, area_vectors, check_boundary, crossings, ridges, volume
from .checks import ParameterError, within

STRIDE = 0.2
"""Longest way of a vertex at once, as a part of the smallest altitude around it."""
LEAST_STRIDE = 1e-4
"""An update waits until some vertex has so far to go, as a part of the same altitude: below it the last digit of the
coordinates would spoil the volume."""
EDGE = 0.13
"""Two equal facets make an edge where they meet at more than 40 degrees: they look across their mean normal with
tan^2(20 degrees) of the weight with which they look along it."""
FLAT = 0.03
"""The same for the sliding of vertices, which must not round any edge: 20 degrees."""
DENT = 0.1, 0.2
"""Mean slope from a vertex up to its neighbours: from the first on it hands wear over to them, from the second on all
of it."""
CROWDED = 0.5
"""Vertices slide along the surface where a facet's altitude has fallen to this part of what it was at first."""
TIGHT = 0.25
"""From this part on they slide round edges as well: an edge that holds so many vertices is finer than the facets."""
FOLDED = 0.5
"""A facet may not turn by more than 60 degrees, cosine 0.5, at once, nor pass below SLIVER."""
SLIVER = 1e-3
"""Smallest altitude of a facet, as a part of what it was at first."""
ATTEMPTS = 8
"""So often a step is tried, with vertices held back wherever it would fold."""
LEAST_PART = 0.02
"""Least part of what is due that is done in one step, where strides allow it."""
STEPS = 200
"""So many steps of at most a STRIDE in one update; what is still not done waits for the next."""


PLANE = 1e-8
"""Protected facets are in one plane where they look across their mean normal with less than tan^2(1e-4) of the weight."""
ALONG = 0.03
"""A vertex on the rim of the protected part gives way only where the worn facets look along the protected ones with
more than cos^2(80 degrees) of their weight."""
THIN = -0.8, -0.88
"""Cosine between the normals of two facets, 37 and 28 degrees of wedge, between which the edge where they meet takes over
the wear of the vertices beside it."""
ASTRAY = 0.02
"""A vertex that would win less than this part of its way goes back along its mean normal instead."""
SHARP = -0.9
"""Two neighbouring facets do not come nearer to lying back to back than this cosine between their normals, 154 degrees,
unless they were made so."""


class WornAway(Exception):
    """Nothing is left that could be worn: str() is one line."""


class Folded(Exception):
    """Much is left, but the vertices can move no further without a fold: str() is one line."""


class WornBoundary:
    """A closed boundary whose facets are worn; its topology stays, its vertices move inwards.

    vertices: (n, d) m; facets: (m, d), normals outwards; protected: (n,) bool, vertices of the part that is held (a
    shank); gone: the part of the volume at which the body counts as worn away.

    A facet all of whose vertices are protected is protected: it is never worn and keeps its plane (its line). It gets
    shorter as the worn surface beside it retreats: a vertex of worn and protected facets slides along the protected
    ones, to the corner where they end, and the vertices behind it follow, each the same mean of its neighbours. A
    protected vertex of no protected facet, or of facets in more planes than leave a way, never moves.

    A vertex moves so that each facet around it recedes by its own depth, volume over area, as nearly as one motion
    can (least squares over the facets, weighted by area): an edge between a worn and a sound face slides down the
    sound one, which keeps its plane. The facet's volume is shared equally by those of its vertices that can go.
    Where vertices crowd, they slide along flat faces and straight edges, which changes no volume.

    Where a step would fold a facet, or make two run through each other where a part has become thin, the vertices in
    question stay behind, and the facets around take over their wear. A feather edge is blunted.

    An update that moves vertices takes all that is due, to round-off, in STEPS strides at most. Below LEAST_STRIDE nothing moves, and a later
    update makes up for it: what waits by then is less than LEAST_STRIDE times the area of the worn facets times the
    largest of their altitudes. `pending` holds it by facet; `kept` is what fell on protected facets.
    Raises ParameterError for a boundary that is open, folded, or not oriented outwards, or with no free vertex.
    """

    def __init__(self, *, vertices, facets, protected=None, gone=0.02):
        self.vertices, self.facets = check_boundary(vertices, facets)
        n, d = self.vertices.shape
        self.dimension = d
        self.protected = np.zeros(n, bool) if protected is None else np.array(protected, bool)
        if self.protected.shape != (n,) or self.protected.all():
            raise ParameterError("protected", f"{int(self.protected.sum())} of {n} vertices",
                                 "a flag for each vertex that leaves at least one free")
        self.bare = self.protected[self.facets].all(axis=1)
        self._ways = self._ways_left()
        self._followers = self._hangers()
        self.first_altitude = altitudes(self.vertices, self.facets)
        self.first_room = self._room()
        self.first_volume = volume(self.vertices, self.facets)
        self.least_volume = within("gone", gone, 0, 1) * self.first_volume
        self.pending = np.zeros(len(self.facets))
        self.archard_volume = self.removed = self.kept = 0.0
        self._classes = self._colour()
        self._around = self._rings()
        self._joined = self._neighbours()
        pairs = self.facets[self._joined]
        common = (pairs[:, :, :, None] == pairs[:, ::-1, None, :]).any(axis=3)
        self._seam = pairs[:, 0][common[:, 0]].reshape(len(pairs), -1)
        self._beside = pairs[~common].reshape(len(pairs), 2)

    def _ways_left(self):
        """(n, d, d) projection of each vertex's motion on what its protected facets leave it: all for a free vertex,
        their common plane or line for one on them, nothing for a corner or a protected vertex without such a facet."""
        areas = area_vectors(self.vertices, self.facets) * self.bare[:, None]
        size = np.maximum(np.linalg.norm(areas, axis=1), np.finfo(float).tiny)
        values, frames = np.linalg.eigh(self._looks(areas / size[:, None], size))
        left = (values <= PLANE * values[:, -1:]) & (values[:, -1:] > 0) | ~self.protected[:, None]
        return np.einsum("nij,nj,nkj->nik", frames, left, frames)

    def _hangers(self):
        """(solve, drive, (k,) numbers) for the protected vertices that no worn facet touches: each stays the same mean of
        its neighbours, so that they give way to the rim within their planes. None without any.

        The weights of the mean are Floater's mean value coordinates (2003), (tan(a/2) + tan(b/2)) / length with the
        angles a and b on either side of the edge: positive, so that no facet within a convex rim folds.
        """
        n, d = self.vertices.shape
        held = self.facets[self.bare]
        inner = np.zeros(n, bool)
        inner[held] = True
        inner[self.facets[~self.bare]] = False
        if not inner.any():
            return None
        j, k = np.concatenate([held[:, [a, b]] for a in range(d) for b in range(d) if a != b]).T
        weight = 1 / np.linalg.norm(self.vertices[k] - self.vertices[j], axis=1)
        if d == 3:
            third = np.tile(held.sum(axis=1), 6) - j - k
            along, beside = ((self.vertices[other] - self.vertices[j]) for other in (k, third))
            along, beside = (rows / np.linalg.norm(rows, axis=1)[:, None] for rows in (along, beside))
            # tan(a/2) of the angle between two unit vectors
            weight *= np.linalg.norm(along - beside, axis=1) / np.linalg.norm(along + beside, axis=1)
        spring = coo_matrix((weight, (j, k)), (n, n)).tocsr()
        spring = kron(coo_matrix((spring.sum(axis=1).A1, (np.arange(n),) * 2), (n, n)) - spring, np.eye(d)).tocsr()
        numbers = np.flatnonzero(inner)
        rows = (d * numbers[:, None] + np.arange(d)).ravel()
        ways = bsr_matrix((self._ways[numbers], np.arange(len(numbers)), np.arange(len(numbers) + 1))).tocsr()
        drive = ways @ spring[rows]
        matrix = drive[:, rows] @ ways + identity(len(rows)) - ways
        return splu(matrix.tocsc()).solve, drive, numbers

    def _followed(self, motion):
        """The motion (n, d) and that by which protected vertices follow the rim of what is worn."""
        if self._followers is None:
            return motion
        solve, drive, numbers = self._followers
        led = motion.copy()
        led[numbers] = 0.0
        motion = motion.copy()
        motion[numbers] -= solve(drive @ led.ravel()).reshape(-1, self.dimension)
        return motion

    def _neighbours(self):
        """(k, 2) facets that share an edge (in the plane: an end)."""
        owner = np.tile(np.arange(len(self.facets)), self.dimension)
        rows = np.sort(ridges(self.facets), axis=1) if self.dimension == 3 else np.abs(ridges(self.facets) + 0.5)
        order = np.lexsort(rows.T)
        return owner[order].reshape(-1, 2)

    def _rings(self):
        """Pairs (j, k) of vertices of a common facet, both ways."""
        pairs = [self.facets[:, [a, b]] for a in range(self.dimension) for b in range(self.dimension) if a != b]
        return np.unique(np.concatenate(pairs), axis=0)

    def _colour(self):
        """Sets of vertices that can move, no two of which share a facet."""
        colour = np.full(len(self.vertices), -1)
        rings = {}
        for j, k in self._rings().tolist():
            rings.setdefault(j, []).append(k)
        for j in np.flatnonzero(self._ways.any(axis=(1, 2))).tolist():
            taken = set(colour[rings[j]].tolist())
            colour[j] = next(c for c in range(len(taken) + 1) if c not in taken)
        return [np.flatnonzero(colour == c) for c in range(colour.max() + 1)]

    # ---- wear

    def wear(self, demanded):
        """Take the volumes `demanded` (m,) m3 off the facets. -> True if vertices have moved.

        Raises WornAway once less than the part `gone` would be left, or no motion takes more without folding and less
        than half is left; Folded if more is left.
        """
        demanded = np.asarray(demanded, float)
        self.archard_volume += float(demanded.sum())
        self.kept += float(demanded[self.bare].sum())
        self.pending += np.where(self.bare, 0.0, demanded)
        total = float(self.pending.sum())
        if total <= 0:
            return False
        left = self.volume
        if left - total <= self.least_volume:
            raise WornAway(f"{100 * (1 - left / self.first_volume):.3g} % of the volume is worn off, and "
                           f"{100 * total / self.first_volume:.3g} % more is due")
        motion, weights, reach = self._motion()
        if reach.max() < LEAST_STRIDE:
            return False
        stuck = hindrances = 0
        for _ in range(STEPS):
            self._held_up = np.zeros(len(self.vertices), bool)
            stuck = 0 if self._step(motion, weights, reach) else stuck + 1
            if stuck > 10:
                part = self.volume / self.first_volume
                raise (WornAway if part < 0.5 else Folded)(
                    f"its surface can recede no further without a fold, with {100 * part:.3g} % of the volume left: some "
                    "part is thinner than its facets; take facets of another size, or wear it less than that")
            if self._held_up.any():
                hindrances += 1
                self._spread(2**min(hindrances, 8))
            finished = abs(self.pending.sum()) <= 1e-12 * total
            # Last, so that the next demands, made for the facets as they lie then, find them there.
            self._slide()
            if finished:
                return True
            motion, weights, reach = self._motion()
        return True

    def _motion(self):
        """For all that is pending: motion (n, d) m, volume (n,) m3 by vertex, and its reach (n,) over the altitude."""
        areas, corners = area_vectors(self.vertices, self.facets), self.facets.ravel()
        n, d = self.vertices.shape
        self.share = self._shares(areas)
        share = self.share * self.pending[:, None]
        size = np.linalg.norm(areas, axis=1)
        normals = areas / size[:, None]
        gradient = self._sum(np.repeat(areas / d, d, axis=0), corners)
        own = np.bincount(corners, share.ravel(), n)
        values, frames = np.linalg.eigh(self._ways @ self._looks(normals, size) @ self._ways)
        due = self._sum((d * share[:, :, None] * normals[:, None, :]).reshape(-1, d), corners)
        along = np.einsum("nij,ni->nj", frames, due)
        seen = values > np.maximum(EDGE * values[:, -1:], 1e-12 * size.max())
        motion = -np.einsum("nij,nj->ni", frames, np.where(seen, along / np.where(seen, values, 1.0), 0.0))
        gain = -np.einsum("ni,ni->n", gradient, motion)
        straight = np.einsum("nij,nj->ni", self._ways, gradient)
        # A ring of facets too crooked for that recedes along its mean normal.
        sound = (gain > 0.25 * own) & (gain < 4 * own)
        motion = np.where(sound[:, None], motion, -straight)
        weights, motion = self._off_flanks(self._over_dents(own, gradient), motion, normals)
        # Across the surface nothing is won; what a vertex cannot take on any way stays pending.
        way, straight = _directions(motion), _directions(-straight)
        least = ASTRAY * np.linalg.norm(gradient, axis=1)
        way = np.where((-np.einsum("ni,ni->n", gradient, way) > least)[:, None], way, straight)
        gain = -np.einsum("ni,ni->n", gradient, way)
        weights = np.where(gain > least, weights, 0.0)
        motion = way * (weights / np.where(gain > least, gain, 1.0))[:, None]
        return motion, weights, np.linalg.norm(motion, axis=1) / self._room()

    def _shares(self, areas):
        """(m, d) of each facet's volume by its vertices: equal ones, but for vertices that what is protected holds."""
        d = self.dimension
        worn = self._sum(np.repeat(areas * ~self.bare[:, None], d, axis=0), self.facets.ravel())
        way = np.einsum("nij,nj->ni", self._ways, worn)
        self._gives = np.einsum("ni,ni->n", way, way) > ALONG * np.einsum("ni,ni->n", worn, worn)
        taking = self._gives[self.facets] & ~self.bare[:, None]
        return taking / np.maximum(taking.sum(axis=1), 1)[:, None]

    def _over_dents(self, weights, gradient):
        """The volumes by vertex, those of dents handed to the vertices around: what wears does not reach into a dent
        finer than the facets, it rides on the rim."""
        j, k = self._around.T
        n = len(self.vertices)
        apart = self.vertices[k] - self.vertices[j]
        outward = gradient / np.linalg.norm(gradient, axis=1)[:, None]
        slope = np.einsum("ni,ni->n", apart, outward[j]) / np.linalg.norm(apart, axis=1)
        depth = np.bincount(j, slope, n) / np.bincount(j, minlength=n)
        handed = np.clip((depth - DENT[0]) / (DENT[1] - DENT[0]), 0.0, 1.0)
        rim = (weights[k] > 0) & (handed[k] < handed[j])
        rims = np.bincount(j[rim], minlength=n)
        handed[rims == 0] = 0.0
        for _ in range(3):
            given = weights * handed
            weights = weights - given + np.bincount(k[rim], (given / np.maximum(rims, 1))[j[rim]], n)
        return weights

    def _off_flanks(self, weights, motion, normals):
        """(volumes by vertex, directions of motion) where feather edges are blunted: an edge thinner than THIN breaks off
        rather than wear on at its flanks. It takes over the volume of the vertices beside it and goes back along the
        bisector of its wedge, which opens it whatever its flanks look like."""
        one, other = normals[self._joined.T]
        bend = np.einsum("ni,ni->n", one, other)
        handed = np.clip((bend - THIN[0]) / (THIN[1] - THIN[0]), 0.0, 1.0)
        rise = np.einsum("ni,ni->n", self.vertices[self._beside[:, 1]] - self.vertices[self._seam[:, 0]], one)
        thin = (handed > 0) & (rise < 0) & self._gives[self._seam].all(axis=1)
        seam, beside = self._seam[thin], self._beside[thin]
        inward = np.zeros_like(motion)
        np.add.at(inward, seam, -(one + other)[thin, None])
        inward = np.einsum("nij,nj->ni", self._ways, inward)
        part = np.zeros(len(weights))
        np.maximum.at(part, beside, handed[thin, None])
        part[seam] = 0.0
        given = weights * part / np.maximum(np.bincount(beside.ravel(), minlength=len(weights)), 1)
        weights = weights * (1 - part)
        np.add.at(weights, seam, (given[beside].sum(axis=1) / seam.shape[1])[:, None])
        return weights, np.where(inward.any(axis=1)[:, None], inward, motion)

    def _looks(self, normals, size):
        """(n, d, d) sum of area n n^T over the facets at each vertex: where its facets look."""
        n, d = self.vertices.shape
        looks = np.repeat((size[:, None, None] * normals[:, :, None] * normals[:, None, :]).reshape(-1, d * d), d, axis=0)
        return self._sum(looks, self.facets.ravel()).reshape(n, d, d)

    def _sum(self, rows, corners):
        return np.column_stack([np.bincount(corners, column, len(self.vertices)) for column in rows.T])

    def _room(self):
        """(n,) m, the smallest altitude around each vertex."""
        room = np.full(len(self.vertices), np.inf)
        height = altitudes(self.vertices, self.facets)
        np.minimum.at(room, self.facets.ravel(), np.repeat(height, self.dimension))
        return room

    def _step(self, motion, weights, reach):
        """Do as much of the pending volume as a stride allows at each vertex, the lot of it exactly. -> whether it could
        be done without a fold."""
        # All vertices go on together, so that the shape between them stays, unless a few would hold up all others.
        together = max(STRIDE / max(reach.max(), STRIDE), LEAST_PART)
        part = np.minimum(together, STRIDE / np.maximum(reach, STRIDE))
        for attempt in range(ATTEMPTS):
            wanted = float(weights @ part)
            if wanted <= 0:
                return False
            moved = self._followed(motion * part[:, None])
            fresh = self.vertices + moved * self._length(moved, wanted)
            hindered = self._hindered(fresh, (moved != 0).any(axis=1), attempt < ATTEMPTS // 2)
            if not hindered.any():
                break
            # First a shorter way, then none.
            part = np.where(hindered, 0.5 * part if attempt < 2 else 0.0, part)
            self._held_up |= hindered & (part == 0)
        else:
            return False
        taken = -self._change(fresh - self.vertices)
        self.vertices = fresh
        total = float(self.pending.sum())
        undone = self.pending * (self.share * (1 - part[self.facets])).sum(axis=1)
        rest = float(undone.sum())
        self.pending = undone * ((total - wanted) / rest) if rest > 0 else undone
        self._book(taken, wanted)
        return True

    def _book(self, taken, wanted):
        """What the last digits of the coordinates took beside what was wanted is settled with the next motion."""
        self.removed += taken
        self.pending[np.argmax(self.pending)] += wanted - taken

    def _length(self, motion, wanted):
        """s for which the motion s u takes exactly `wanted` (m3), by Newton's rule on the polynomial."""
        terms = self._terms(motion)
        s = 1.0
        for _ in range(20):
            powers = s ** np.arange(1, len(terms) + 1)
            miss = terms @ powers + wanted
            slope = terms @ (np.arange(1, len(terms) + 1) * powers / s)
            s -= miss / slope
            if abs(miss) <= 1e-15 * wanted:
                break
        return s

    def _terms(self, motion):
        """Coefficients of s, s^2 (, s^3) in the change of volume along s times the motion; no difference of volumes,
        which would lose the digits of small motions."""
        x, u = self.vertices[self.facets] - self.vertices.mean(axis=0), motion[self.facets]
        if self.dimension == 2:
            cross = [p[:, 0, 0] * q[:, 1, 1] - p[:, 0, 1] * q[:, 1, 0] for p, q in ((x, u), (u, x), (u, u))]
            return 0.5 * np.array([(cross[0] + cross[1]).sum(), cross[2].sum()])

        def mixed(a, b, c):
            return np.einsum("ni,ni->", a[:, 0], np.cross(b[:, 1], c[:, 2])) / 6

        return np.array([mixed(u, x, x) + mixed(x, u, x) + mixed(x, x, u),
                         mixed(u, u, x) + mixed(u, x, u) + mixed(x, u, u), mixed(u, u, u)])

    def _change(self, motion):
        return float(self._terms(motion).sum())

    def _hindered(self, fresh, moved, flanks):
        """(n,) vertices of the facets that on the way to `fresh` turn far, collapse or run through each other; flanks:
        of those that come to lie back to back only the vertices beside their common edge."""
        through = crossings(fresh, self.facets, moved)
        facets, pairs = self._folded(fresh)
        hindered = np.zeros(len(fresh), bool)
        hindered[self.facets[facets]] = True
        hindered[self._beside[pairs] if flanks else self.facets[self._joined[pairs]]] = True
        hindered[through] = True
        return hindered

    def _folded(self, fresh):
        """(m,) facets that on the way to `fresh` turn far or collapse, and (k,) pairs of them that come too near to
        lying back to back."""
        before, after = area_vectors(self.vertices, self.facets), area_vectors(fresh, self.facets)
        cosine = np.einsum("ni,ni->n", before, after)
        cosine = cosine - FOLDED * np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
        folds, were = _bend(after, self._joined), _bend(before, self._joined)
        height, was = altitudes(fresh, self.facets), altitudes(self.vertices, self.facets)
        return ((cosine <= 0) | ((height < SLIVER * self.first_altitude) & (height < was)),
                (folds <= SHARP) & (folds < were))

    def _spread(self, times):
        """Hand on what facets that would fold could not do: half of it to the facets around, and so on, `times`."""
        giving = self._held_up[self.facets].any(axis=1) & ~self.bare
        corners, n = self.facets.ravel(), len(self.vertices)
        facets_at = np.maximum(np.bincount(corners, (~self.bare).repeat(self.dimension), n), 1)
        for _ in range(times):
            given = 0.5 * self.pending * giving
            at_vertex = np.bincount(corners, (self.share * given[:, None]).ravel(), n) / facets_at
            self.pending += np.where(self.bare, 0.0, at_vertex[self.facets].sum(axis=1)) - given

    # ---- the spacing of vertices

    def _slide(self):
        """Even out the spacing where vertices crowd, class by class: no two of a class share a facet, and each moves
        across its own N_j, so that the volume stays. Again and again where they all but meet, as no way is longer than
        a stride."""
        for _ in range(10):
            spacing = altitudes(self.vertices, self.facets) / self.first_altitude
            if spacing.min() < CROWDED:
                self._slide_once(spacing < CROWDED)
            if spacing.min() >= 0.5 * TIGHT:
                return

    def _slide_once(self, crowded):
        near = np.zeros(len(self.vertices), bool)
        near[self.facets[crowded]] = True
        near[self._around[near[self._around[:, 0]], 1]] = True
        for one_class in self._classes:
            mine = one_class[near[one_class]]
            if len(mine):
                self._slide_class(mine)

    def _slide_class(self, mine):
        n = len(self.vertices)
        areas = area_vectors(self.vertices, self.facets)
        size = np.linalg.norm(areas, axis=1)
        values, frames = np.linalg.eigh(self._looks(areas / size[:, None], size)[mine])
        j, k = self._around.T
        mean = self._sum(self.vertices[k], j)[mine] / np.bincount(j, minlength=n)[mine, None]
        ways = self._ways[mine]
        along = np.einsum("nij,nik,nk->nj", frames, ways, mean - self.vertices[mine])
        room = self._room()[mine]
        # Not round an edge of a protected face: its rim, a corner cut off, would leave no room for the facets behind it.
        tight = (room < TIGHT * self.first_room[mine]) & ~self.protected[mine]
        away = 0.5 * np.einsum("nij,nj->ni", frames, np.where((values < FLAT * values[:, -1:]) | tight[:, None], along, 0.0))
        away = np.einsum("nij,nj->ni", ways, away)
        gradient = self._sum(np.repeat(areas, self.dimension, axis=0), self.facets.ravel())[mine]
        across = np.einsum("nij,nj->ni", ways, gradient)
        square = np.einsum("ni,ni->n", across, across)
        tilted = square > PLANE * np.einsum("ni,ni->n", gradient, gradient)
        away -= np.where(tilted, np.einsum("ni,ni->n", away, across) / np.where(tilted, square, 1.0), 0.0)[:, None] * across
        length = np.linalg.norm(away, axis=1)
        away *= np.minimum(1.0, STRIDE * room / np.maximum(length, STRIDE * room))[:, None]
        motion = np.zeros_like(self.vertices)
        motion[mine] = away
        fresh = self.vertices + self._followed(motion)
        folded, back_to_back = self._folded(fresh)
        stay = np.zeros(n, bool)
        stay[self.facets[folded]] = stay[self.facets[self._joined[back_to_back]]] = True
        if stay.any():
            motion[stay] = 0.0
            fresh = self.vertices + self._followed(motion)
        if not any(folded.any() for folded in self._folded(fresh)):
            taken = -self._change(fresh - self.vertices)
            self.vertices = fresh
            self._book(taken, 0.0)

    # ---- books

    @property
    def volume(self):
        """m3 that the boundary encloses now."""
        return volume(self.vertices, self.facets)

    def volume_balance(self):
        """The volume book in m3: what Archard's law wore, what the motion of vertices has taken, what waits, what fell
        on protected facets; unexplained is what the volume enclosed now has lost beside that."""
        waiting = float(self.pending.sum())
        return {"archard": self.archard_volume, "removed": self.removed, "waiting": waiting,
                "on_protected_facets": self.kept,
                "unexplained": self.first_volume - self.volume + waiting + self.kept - self.archard_volume}

    def depth(self, first):
        """(n,) m by which the vertices have come from `first` (n, d), their places of the beginning; none for protected
        ones, which slide in their faces."""
        return np.where(self.protected, 0.0, np.linalg.norm(self.vertices - first, axis=1))

    def state(self):
        """What must survive a restart."""
        return {"vertices": self.vertices.copy(), "pending": self.pending.copy(), "kept": self.kept,
                "archard_volume": self.archard_volume, "removed": self.removed}

    def restore(self, state):
        """Take back what `state` gave."""
        self.vertices, self.pending = state["vertices"].copy(), state["pending"].copy()
        for name in ("kept", "archard_volume", "removed"):
            setattr(self, name, float(state[name]))


def _directions(vectors):
    """(n, d) of length 1, or 0 where the vectors are none."""
    size = np.linalg.norm(vectors, axis=1)
    return vectors / np.where(size > 0, size, 1.0)[:, None]


def _bend(areas, pairs):
    """Cosine between the normals of the pairs of facets."""
    normals = areas / np.linalg.norm(areas, axis=1)[:, None]
    return np.einsum("ni,ni->n", normals[pairs[:, 0]], normals[pairs[:, 1]])

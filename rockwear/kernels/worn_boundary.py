"""Wear of a boundary of facets: the volume worn off each facet becomes an inward motion of its vertices (R 2.5).

The volume V of a closed boundary of facets with area vectors a_f is linear in any single vertex, dV/dx_j = N_j = sum of
a_f / d over the facets at j, and a polynomial of degree d in the length s of a common motion x + s u. So the motion
that takes away exactly a demanded volume is found to round-off.
"""
import numpy as np

from .boundary import altitudes, area_vectors, check_boundary, crossings, ridges, volume
from .checks import ParameterError, within

STRIDE = 0.2
"""Longest way of a vertex at once, as a part of the smallest altitude around it."""
LEAST_STRIDE = 1e-4
"""Wear waits until some vertex has so far to go, as a part of the same altitude: below it the last digit of the
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
LEAST_PART = 0.02
"""Least part of what is due that is done in one step, where strides allow it."""
STEPS = 200
"""So many steps of at most a STRIDE in one update; what is still not done waits for the next."""


SHARP = -0.9
"""Two neighbouring facets do not come nearer to lying back to back than this cosine between their normals, 154 degrees,
unless they were made so."""


class WornAway(Exception):
    """Nothing is left that could be worn: str() is one line."""


class Folded(Exception):
    """Much is left, but the vertices can move no further without a fold: str() is one line."""


class WornBoundary:
    """A closed boundary whose facets are worn; its topology stays, its vertices move inwards.

    vertices: (n, d) m; facets: (m, d), normals outwards; protected: (n,) bool, vertices that never move (a shank);
    gone: the part of the volume that can be worn at which the body counts as worn away.

    A vertex moves so that each facet around it recedes by its own depth, volume over area, as nearly as one motion
    can (least squares over the facets, weighted by area): an edge between a worn and a sound face slides down the
    sound one, which keeps its plane. The facet's volume is shared equally by those of its vertices that are free.
    Where vertices crowd, they slide along flat faces and straight edges, which changes no volume.

    A step that would fold a facet, or make two run through each other where a part has become thin, is not taken.

    `pending` holds, by facet, what has not been done yet; `kept` what fell on facets that are protected altogether.
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
        free = ~self.protected[self.facets]
        self.free_count = free.sum(axis=1)
        self.share = np.where(free, 1 / np.maximum(self.free_count, 1)[:, None], 0.0)
        self.first_altitude = altitudes(self.vertices, self.facets)
        self.first_room = self._room()
        self.first_volume = volume(self.vertices, self.facets)
        self.least_volume = within("gone", gone, 0, 1) * self.first_volume
        self.pending = np.zeros(len(self.facets))
        self.archard_volume = self.removed = self.kept = 0.0
        self._classes = self._colour()
        self._around = self._rings()
        self._joined = self._neighbours()

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
        """Sets of free vertices no two of which share a facet."""
        colour = np.full(len(self.vertices), -1)
        rings = {}
        for j, k in self._rings().tolist():
            rings.setdefault(j, []).append(k)
        for j in np.flatnonzero(~self.protected).tolist():
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
        bare = self.free_count == 0
        self.kept += float(demanded[bare].sum())
        self.pending += np.where(bare, 0.0, demanded)
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
        stuck = 0
        for _ in range(STEPS):
            if self._step(motion, weights, reach):
                self._slide()
            else:
                stuck += 1
                if stuck > 10:
                    part = self.volume / self.first_volume
                    raise (WornAway if part < 0.5 else Folded)(
                        f"its surface can recede no further without a fold, with {100 * part:.3g} % of the volume left")
                self._spread()
            if self.pending.sum() <= 0:
                return True
            motion, weights, reach = self._motion()
            if reach.max() < LEAST_STRIDE:
                return True
        self._spread()
        return True

    def _motion(self):
        """For all that is pending: motion (n, d) m, volume (n,) m3 by vertex, and its reach (n,) over the altitude."""
        areas, corners = area_vectors(self.vertices, self.facets), self.facets.ravel()
        n, d = self.vertices.shape
        share = self.share * self.pending[:, None]
        size = np.linalg.norm(areas, axis=1)
        normals = areas / size[:, None]
        gradient = self._sum(np.repeat(areas / d, d, axis=0), corners)
        own = np.bincount(corners, share.ravel(), n)
        values, frames = np.linalg.eigh(self._looks(normals, size))
        due = self._sum((d * share[:, :, None] * normals[:, None, :]).reshape(-1, d), corners)
        along = np.einsum("nij,ni->nj", frames, due)
        seen = values > EDGE * values[:, -1:]
        motion = -np.einsum("nij,nj->ni", frames, np.where(seen, along / np.where(seen, values, 1.0), 0.0))
        gain = -np.einsum("ni,ni->n", gradient, motion)
        # A ring of facets too crooked for that recedes along its mean normal.
        sound = (gain > 0.25 * own) & (gain < 4 * own)
        weights = self._over_dents(own, gradient)
        motion = np.where(sound[:, None], motion * (weights / np.where(sound, gain, 1.0))[:, None],
                          -gradient * (weights / np.einsum("ni,ni->n", gradient, gradient))[:, None])
        return motion, weights, np.linalg.norm(motion, axis=1) / self._room()

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
        rim = ~self.protected[k] & (handed[k] < handed[j])
        rims = np.bincount(j[rim], minlength=n)
        handed[rims == 0] = 0.0
        for _ in range(3):
            given = weights * handed
            weights = weights - given + np.bincount(k[rim], (given / np.maximum(rims, 1))[j[rim]], n)
        return weights

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
        for attempt in range(4):
            wanted = float(weights @ part)
            moved = motion * part[:, None]
            fresh = self.vertices + moved * self._length(moved, wanted)
            if self._holds(fresh) and not crossings(fresh, self.facets, (moved != 0).any(axis=1)):
                break
            part = 0.5 * part
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

    def _holds(self, fresh):
        """Whether no facet turns far or collapses on the way to `fresh`."""
        before, after = area_vectors(self.vertices, self.facets), area_vectors(fresh, self.facets)
        cosine = np.einsum("ni,ni->n", before, after)
        cosine = cosine - FOLDED * np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
        folds, were = _bend(after, self._joined), _bend(before, self._joined)
        return bool(np.all(cosine > 0) and np.all((folds > SHARP) | (folds >= were))
                    and np.all(altitudes(fresh, self.facets) >= SLIVER * self.first_altitude))

    def _spread(self):
        """Hand half of what could not be done to the facets around."""
        at_vertex = np.bincount(self.facets.ravel(), (self.share * self.pending[:, None]).ravel(), len(self.vertices))
        facets_at = np.bincount(self.facets.ravel(), (self.free_count > 0).repeat(self.dimension), len(self.vertices))
        given = np.where(self.free_count > 0, (at_vertex / np.maximum(facets_at, 1))[self.facets].sum(axis=1), 0.0)
        self.pending = 0.5 * (self.pending + given)

    # ---- the spacing of vertices

    def _slide(self):
        """Even out the spacing where vertices crowd, class by class: no two of a class share a facet, and each moves
        across its own N_j, so that the volume stays."""
        crowded = altitudes(self.vertices, self.facets) < CROWDED * self.first_altitude
        if not crowded.any():
            return
        near = np.zeros(len(self.vertices), bool)
        near[self.facets[crowded]] = True
        near[self._around[near[self._around[:, 0]], 1]] = True
        near &= ~self.protected
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
        along = np.einsum("nij,ni->nj", frames, mean - self.vertices[mine])
        room = self._room()[mine]
        tight = room < TIGHT * self.first_room[mine]
        away = 0.5 * np.einsum("nij,nj->ni", frames, np.where((values < FLAT * values[:, -1:]) | tight[:, None], along, 0.0))
        gradient = self._sum(np.repeat(areas, self.dimension, axis=0), self.facets.ravel())[mine]
        gradient /= np.linalg.norm(gradient, axis=1)[:, None]
        away -= np.einsum("ni,ni->n", away, gradient)[:, None] * gradient
        length = np.linalg.norm(away, axis=1)
        away *= np.minimum(1.0, STRIDE * room / np.maximum(length, STRIDE * room))[:, None]
        fresh = self.vertices.copy()
        fresh[mine] += away
        if self._holds(fresh):
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
        on protected facets; unexplained is what the shape itself contradicts."""
        waiting = float(self.pending.sum())
        return {"archard": self.archard_volume, "removed": self.removed, "waiting": waiting,
                "on_protected_facets": self.kept,
                "unexplained": self.removed + waiting + self.kept - self.archard_volume,
                "shape": self.first_volume - self.volume - self.removed}

    def depth(self, first):
        """(n,) m by which the vertices have come from `first` (n, d), their places of the beginning."""
        return np.linalg.norm(self.vertices - first, axis=1)

    def state(self):
        """What must survive a restart."""
        return {"vertices": self.vertices.copy(), "pending": self.pending.copy(), "kept": self.kept,
                "archard_volume": self.archard_volume, "removed": self.removed}

    def restore(self, state):
        """Take back what `state` gave."""
        self.vertices, self.pending = state["vertices"].copy(), state["pending"].copy()
        for name in ("kept", "archard_volume", "removed"):
            setattr(self, name, float(state[name]))


def _bend(areas, pairs):
    """Cosine between the normals of the pairs of facets."""
    normals = areas / np.linalg.norm(areas, axis=1)[:, None]
    return np.einsum("ni,ni->n", normals[pairs[:, 0]], normals[pairs[:, 1]])

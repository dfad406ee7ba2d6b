"""Wear of a boundary of facets: vertices move inwards by the volume worn off their facets [Rocky, sec. 2.5].

The volume V of a closed boundary of facets with area vectors a_f is linear in each vertex, dV/dx_j = sum of a_f / d
over the facets at j, and a polynomial of degree d in the length s of a common motion x + s u. So the motion that
removes exactly a demanded volume is found to round-off.
"""
import numpy as np

from rockwear.kernels.boundary import altitudes, area_vectors, crossings, volume
from rockwear.kernels.checks import within
from rockwear.kernels.remeshing import EDGE, SHAPE, TURN, Mesh

STRIDE = 0.2
"""Longest displacement of a vertex in one step, over the smallest altitude of the facets at it."""
LEAST_STRIDE = 1e-4
"""Least displacement of an update, over the same altitude: below it round-off of the coordinates affects the volume."""
NO_STRIDE = 1e-9 * LEAST_STRIDE
"""Displacement, over the same altitude, that is round-off after the first step of an update."""
DENT = 0.1, 0.2
"""Mean slope from a vertex up to its neighbours: from the first value on it transfers wear to them, from the second
all of it."""
SLIVER = 1e-3
"""Smallest altitude of a facet over the initial one."""
ATTEMPTS = 8
"""Most trials of a step, with vertices held back where facets would fold."""
LEAST_PART = 0.02
"""Least part of the pending volume that is removed in one step, if STRIDE allows it."""
STEPS = 200
"""Most steps in one update; the rest stays pending."""
ALONG = 0.03
"""A vertex at the fixed part moves only if the worn area, projected on the directions left by the fixed facets, is more
than cos(80 degrees) of itself (squared here)."""
ASTRAY = 0.02
"""A vertex whose displacement has less than this component along its mean normal moves along that normal instead."""
BALANCE = "on_fixed", "archard_volume", "removed", "broken_off"
FAR = {2: 6, 3: 3}
"""Facets that intersect at least this many facets apart along the surface are two faces: the body is worn through.
Nearer ones are the flanks of one edge."""


class WornAway(Exception):
    """The body is worn away: str() is one line."""


class Folded(Exception):
    """The vertices can move no further without a fold, though much is left: str() is one line."""


class WornBoundary(Mesh):
    """A closed boundary whose facets are worn: its vertices move inwards. (Motion: ours.)

    vertices, facets, fixed: as for Mesh; the fixed part is the shank; gone: the part of the volume at which the body
    counts as worn away. Raises ParameterError as Mesh, and for a part out of [0, 1].

    A fixed facet is not worn and keeps its plane (its line). It becomes shorter as the worn surface beside it recedes:
    a vertex of worn and fixed facets slides along the fixed ones.

    The displacement of a vertex makes each facet at it recede by its own depth, volume over area, in the sense of least
    squares weighted by area: an edge between a worn and an unworn face slides along the unworn one, which keeps its
    plane. The volume of a facet is shared equally by those of its vertices that can move. Crowded facets are moved to
    where facets are missing, without change of the volume (kernels.remeshing).

    Where a step would fold a facet, or make two intersect near an edge, the vertices concerned are held back, and the
    facets around are worn in their place. A feather edge breaks off, which is not wear: `broken_off` m3.

    An update that moves vertices removes all pending volume, to round-off, in at most STEPS steps. Below LEAST_STRIDE
    nothing moves, and the volume stays pending: less than LEAST_STRIDE times the area of the worn facets times the
    largest of their altitudes. `pending` is the volume by facet; `on_fixed` that assigned to fixed facets; `remeshed`
    counts the updates in which facets changed.
    """

    def __init__(self, *, gone=0.02, **shape):
        super().__init__(**shape)
        self.first_volume = volume(self.vertices, self.facets)
        self.least_volume = within("gone", gone, 0, 1) * self.first_volume
        self.archard_volume = self.removed = self.on_fixed = self.broken_off = 0.0
        self.remeshed = 0

    # ---- wear

    def wear(self, demanded):
        """Wear the volumes `demanded` (m,) m3 off the facets. -> whether vertices have moved.

        Raises WornAway if less than the part `gone` would be left, or if no motion without a fold is left and less than
        half of the volume; Folded if more is left.
        """
        demanded = np.asarray(demanded, float)
        self.archard_volume += float(demanded.sum())
        self.on_fixed += float(demanded[self.fixed].sum())
        self.pending += np.where(self.fixed, 0.0, demanded)
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
                    f"its surface can recede no further without a fold, with {100 * part:.3g} % of the volume left: "
                    "some part is thinner than its facets; take facets of another size, or wear it less than that")
            if self._held_up.any():
                hindrances += 1
                self._spread(2**min(hindrances, 8))
            if self.pending.sum() <= 1e-11 * total:
                break
            self._mend()
            motion, weights, reach = self._motion()
            if reach.max() < NO_STRIDE:
                break
        # At the end, so that the next demands are for the present facets.
        self._mend()
        return True

    def _mend(self):
        self.remeshed += self.even_out()
        self.broken_off += self.blunt()

    def _motion(self):
        """Of all pending volume: displacement (n, d) m, volume (n,) m3 by vertex, and length (n,) over the altitude."""
        areas, corners = area_vectors(self.vertices, self.facets), self.facets.ravel()
        n, d = self.vertices.shape
        self.share = self._shares(areas)
        share = self.share * self.pending[:, None]
        size = np.linalg.norm(areas, axis=1)
        normals = areas / size[:, None]
        gradient = self.sum_at_vertices(np.repeat(areas / d, d, axis=0))
        own = np.bincount(corners, share.ravel(), n)
        values, frames = np.linalg.eigh(self.ways @ self.normal_tensors(normals, size) @ self.ways)
        due = self.sum_at_vertices((d * share[:, :, None] * normals[:, None, :]).reshape(-1, d))
        along = np.einsum("nij,ni->nj", frames, due)
        seen = values > np.maximum(EDGE * values[:, -1:], 1e-12 * size.max())
        motion = -np.einsum("nij,nj->ni", frames, np.where(seen, along / np.where(seen, values, 1.0), 0.0))
        gain = -np.einsum("ni,ni->n", gradient, motion)
        straight = np.einsum("nij,nj->ni", self.ways, gradient)
        # Where least squares fail for the facets at a vertex, it moves along their mean normal.
        sound = (gain > 0.25 * own) & (gain < 4 * own)
        motion = np.where(sound[:, None], motion, -straight)
        weights = self._over_dents(own, gradient)
        # A tangential displacement removes nothing; the volume of a vertex that cannot move stays pending.
        way, straight = _directions(motion), _directions(-straight)
        least = ASTRAY * np.linalg.norm(gradient, axis=1)
        way = np.where((-np.einsum("ni,ni->n", gradient, way) > least)[:, None], way, straight)
        gain = -np.einsum("ni,ni->n", gradient, way)
        weights = np.where(gain > least, weights, 0.0)
        motion = way * (weights / np.where(gain > least, gain, 1.0))[:, None]
        return motion, weights, np.linalg.norm(motion, axis=1) / self._room(areas)

    def _shares(self, areas):
        """(m, d) shares of the vertices in the volume of a facet: equal, except for vertices held by fixed facets."""
        d = self.dimension
        worn = self.sum_at_vertices(np.repeat(areas * ~self.fixed[:, None], d, axis=0))
        way = np.einsum("nij,nj->ni", self.ways, worn)
        gives = np.einsum("ni,ni->n", way, way) > ALONG * np.einsum("ni,ni->n", worn, worn)
        taking = gives[self.facets] & ~self.fixed[:, None]
        return taking / np.maximum(taking.sum(axis=1), 1)[:, None]

    def _over_dents(self, weights, gradient):
        """Volumes (n,) m3 by vertex, those of dents transferred to the vertices around: a counterbody touches the rim
        of a dent finer than the facets, not its bottom."""
        j, k = self.around.T
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

    def _room(self, areas):
        """(n,) m, the smallest altitude around each vertex."""
        room = np.full(len(self.vertices), np.inf)
        height = altitudes(self.vertices, self.facets, areas)
        np.minimum.at(room, self.facets.ravel(), np.repeat(height, self.dimension))
        return room

    def _step(self, motion, weights, reach):
        """Remove as much of the pending volume as STRIDE allows at each vertex, in sum exactly. -> whether a step
        without a fold was found."""
        # The same part for all vertices keeps the shape between them, unless a few would hold back all others.
        together = max(STRIDE / max(reach.max(), STRIDE), LEAST_PART)
        part = np.minimum(together, STRIDE / np.maximum(reach, STRIDE))
        for attempt in range(ATTEMPTS):
            wanted = float(weights @ part)
            if wanted <= 0:
                return False
            moved = motion * part[:, None]
            fresh = self.vertices + moved * self._length(moved, wanted)
            through = crossings(fresh, self.facets, (moved != 0).any(axis=1))
            hindered = self._folded(fresh)
            hindered[through] = True
            if not hindered.any():
                break
            if attempt >= 2:
                self._check_through(through)
            # First a shorter displacement, then none.
            part = np.where(hindered, 0.5 * part if attempt < 2 else 0.0, part)
            self._held_up |= hindered & (part == 0)
        else:
            return False
        taken = -self._change(fresh - self.vertices)
        self.vertices = fresh
        most = int(np.argmax(self.pending * self.share.sum(axis=1)))
        total = float(self.pending.sum())
        undone = self.pending * (self.share * (1 - part[self.facets])).sum(axis=1)
        if undone.sum() <= 1e-9 * total:
            # The rest is wear that dents have transferred: it stays with its facets.
            undone = self.pending
        self.pending = undone * ((total - wanted) / undone.sum())
        self.removed += taken
        # The difference by round-off of the coordinates is corrected by the next motion.
        self.pending[most] += wanted - taken
        return True

    def _length(self, motion, wanted):
        """s for which the motion s u removes exactly `wanted` (m3), by Newton's method on the polynomial."""
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
        """Coefficients of s, s^2 (, s^3) in the change of volume by s times the motion; no difference of volumes, which
        would lose digits for small motions."""
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

    def _check_through(self, through):
        """Raise Folded if any of `through`, vertices of intersecting facets, belong to two faces."""
        d = self.dimension
        j, k = self.around.T
        for row in through:
            near = np.zeros(len(self.vertices), bool)
            near[row[:-d]] = True
            for _ in range(FAR[d]):
                near[j[near[k]]] = True
            if not near[row[-d:]].any():
                place = ", ".join(f"{x:.4g}" for x in self.vertices[row].mean(axis=0))
                raise Folded(f"it is worn through at ({place}) m of its own frame, with "
                             f"{100 * self.volume / self.first_volume:.3g} % of the volume left")

    def _folded(self, fresh):
        """(n,) bool, vertices of the facets that in moving to `fresh` rotate by more than TURN, collapse, pass through
        their neighbour or nearly close a notch with it."""
        before, after = area_vectors(self.vertices, self.facets), area_vectors(fresh, self.facets)
        cosine = np.einsum("ni,ni->n", before, after)
        cosine = cosine - TURN * np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
        height, was = altitudes(fresh, self.facets, after), altitudes(self.vertices, self.facets, before)
        folded = np.zeros(len(fresh), bool)
        folded[self.facets[(cosine <= 0) | ((height < SLIVER * self.size) & (height < was))]] = True
        was_bent, bent = self.bends(before), self.bends(after)
        through = (bent < 0) & (self.slope(self.vertices, before) * self.slope(fresh, after) <= 0)
        folded[self.facets[self.joined[through | self.notches(fresh, after) & (bent < was_bent)]]] = True
        return folded

    def _spread(self, times):
        """Transfer pending volume of facets that would fold: half of it to the facets around, `times` times."""
        giving = self._held_up[self.facets].any(axis=1) & ~self.fixed
        corners, n = self.facets.ravel(), len(self.vertices)
        facets_at = np.maximum(np.bincount(corners, (~self.fixed).repeat(self.dimension), n), 1)
        for _ in range(times):
            given = 0.5 * self.pending * giving
            at_vertex = np.bincount(corners, (self.share * given[:, None]).ravel(), n) / facets_at
            self.pending += np.where(self.fixed, 0.0, at_vertex[self.facets].sum(axis=1)) - given

    # ---- balances

    @property
    def volume(self):
        """Enclosed volume, m3."""
        return volume(self.vertices, self.facets)

    def volume_balance(self):
        """Volume balance (m3): archard, demanded so far; removed by moving vertices; waiting, still pending; on fixed
        facets, not removed; broken off, not wear; unexplained, the rest of the lost volume."""
        waiting = float(self.pending.sum())
        return {"archard": self.archard_volume, "removed": self.removed, "waiting": waiting,
                "on_fixed_facets": self.on_fixed, "broken_off": self.broken_off,
                "unexplained": self.first_volume - self.volume - self.broken_off + waiting + self.on_fixed
                - self.archard_volume}

    def state(self):
        """What a checkpoint keeps."""
        return {**{name: getattr(self, name).copy() for name in SHAPE},
                **{name: getattr(self, name) for name in (*BALANCE, "remeshed")}}

    def restore(self, state):
        """Resume from what `state` returned."""
        for name in SHAPE:
            setattr(self, name, state[name].copy())
        for name in BALANCE:
            setattr(self, name, float(state[name]))
        self.remeshed = int(state["remeshed"])
        self._connect()


def _directions(vectors):
    """(n, d) unit vectors; zero vectors stay."""
    size = np.linalg.norm(vectors, axis=1)
    return vectors / np.where(size > 0, size, 1.0)[:, None]

"""The temperature field below a surface whose wear is accelerated: accelerated wear takes no more heat than real wear.

Wear that is accelerated A times removes A times the volume, and with it A times the heat that wear would take. What
leaves with 1 - 1/A of the worn volume is an artefact: in the same heating time the real surface stays where it is, and
so does the field below it. In the frame of the receding surface the field is therefore moved inwards with it.
"""
import numpy as np
from scipy.sparse import coo_array

SPENT = 1e-12
"""Part of a particle's heat below which no further layer is looked at."""
PAIRS = 1_000_000
"""Most pairs of points and facets at a time in `outside`."""


def neighbours(pairs, count):
    """The pairs (m, 2) of `count` particles as a sparse adjacency matrix."""
    both = np.concatenate([pairs, np.asarray(pairs)[:, ::-1]])
    return coo_array((np.ones(len(both)), both.T), shape=(count, count)).tocsr()


def receded(*, temperature, capacity, adjacent, leaving, share):
    """Temperatures (n,) K after the particles `leaving` have given `share` of their heat to those below them.

    One after another, in the order given. The neighbours of a leaving particle take its temperature, theirs goes to the
    layer behind them, and so on inwards: on a chain the field moves by one particle for `share` = 1. No layer becomes
    hotter than the one in front of it was (of several neighbours there, the coldest), and the heat given is at most
    what the leaving particle holds above the coldest one. Where neighbouring columns share the particles below, the
    first layers are served first: heat and surface temperature are kept, and the profile behind is steeper than it was,
    until conduction has evened it out. Where only gone particles are behind a layer, the next one is that of the
    nearest particles behind these.

    temperature (n,) K; capacity (n,) J/K, 0 for particles that are gone; adjacent: by `neighbours`. The sum of
    capacity * temperature is kept.
    """
    temperature, there = np.array(temperature, float), np.asarray(capacity) > 0
    for one in leaving:
        there[one] = False
        if there.any():
            given = _move_inwards(temperature, capacity, adjacent, one, there, share)
            temperature[one] -= given / capacity[one]
    return temperature


def _move_inwards(temperature, capacity, adjacent, one, there, share):
    """Raise `temperature` behind particle `one`, layer by layer. -> J transferred."""
    budget = left = share * capacity[one] * (temperature[one] - temperature[there].min())
    before, unseen, layer = temperature.copy(), there.copy(), np.array([one])
    while left > SPENT * abs(budget):
        rows = adjacent[layer]
        outer, inner = np.repeat(layer, np.diff(rows.indptr)), rows.indices
        outer, inner = outer[unseen[inner]], inner[unseen[inner]]
        if not len(inner):
            layer = _gone_before(unseen, adjacent, one)
            if not len(layer):
                break
            before[layer] = temperature[one]
            continue
        layer, place = np.unique(inner, return_inverse=True)
        limit = np.full(len(layer), np.inf)
        np.minimum.at(limit, place, before[outer])
        wanted = share * capacity[layer] * np.maximum(limit - before[layer], 0.0)
        part = min(1.0, left / wanted.sum()) if wanted.any() else 0.0
        temperature[layer] += part * wanted / capacity[layer]
        left -= part * wanted.sum()
        unseen[layer] = False
    return budget - left


def _gone_before(unseen, adjacent, one):
    """The gone particles, fewest pairs away from `one`, beside which `unseen` ones are; none if there are no such."""
    layer = seen = np.array([one])
    while len(layer) and not unseen[adjacent[layer].indices].any():
        layer = np.setdiff1d(adjacent[layer].indices, seen)
        seen = np.concatenate([seen, layer])
    return layer


def outside(points, vertices, facets):
    """(n,) bool: which of the points (n, d) lie outside of a closed boundary, whose winding number there is below 1/2.

    vertices (k, d) m, facets (m, d) as in kernels.boundary, d = 2 or 3. The winding number is the sum of the angles
    over 2 pi, or of the solid angles over 4 pi [van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125], at
    which a point sees the facets.
    """
    points, corners = np.asarray(points, float), np.asarray(vertices, float)[facets]
    some = max(1, PAIRS // len(corners))
    turns = [_turns(points[low:low + some], corners) for low in range(0, len(points), some)]
    return np.concatenate(turns) < 0.5 if turns else np.zeros(0, bool)


def _turns(points, corners):
    sight = corners[None] - points[:, None, None]
    if points.shape[1] == 2:
        (ax, ay), (bx, by) = np.moveaxis(sight, (2, 3), (0, 1))
        return np.arctan2(ax * by - ay * bx, ax * bx + ay * by).sum(axis=1) / (2 * np.pi)
    a, b, c = np.moveaxis(sight, 2, 0)
    la, lb, lc = (np.linalg.norm(leg, axis=2) for leg in (a, b, c))

    def dot(one, other):
        return np.einsum("nmd,nmd->nm", one, other)

    below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return np.arctan2(dot(a, np.cross(b, c)), below).sum(axis=1) / (2 * np.pi)

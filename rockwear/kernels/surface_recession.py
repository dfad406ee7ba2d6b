"""The temperature field of a surface that recedes faster than it should: wear that is accelerated takes no more heat.

A body worn A times too fast loses A times the volume, and with it A times the heat that wear would take. What leaves with
1 - 1/A of the worn volume is an artefact: over the same heating time the real surface stays where it is, and so does the
field below it. In the frame of the receding surface the field is therefore moved inwards with it.
"""
import numpy as np
from scipy.sparse import coo_array

SPENT = 1e-12
"""Part of a particle's heat that is not worth another layer."""


def neighbours(pairs, count):
    """The pairs (m, 2) of `count` particles as a sparse matrix, a row a particle."""
    both = np.concatenate([pairs, np.asarray(pairs)[:, ::-1]])
    return coo_array((np.ones(len(both)), both.T), shape=(count, count)).tocsr()


def receded(*, temperature, capacity, adjacent, leaving, share):
    """Temperatures (n,) K after the particles `leaving` have handed `share` of their heat to those under them.

    One after another, in the order given. The neighbours of one that leaves take its temperature, theirs go to the
    layer behind them, and so on inwards: on a chain the field moves by one particle for `share` = 1. No layer becomes
    hotter than what was before it (of several neighbours there, the coldest), and the heat handed over is at most what
    the leaving one holds above the coldest particle: where neighbouring columns share what is under them the first
    layers are served first, so that heat and the surface's temperature are kept, and the profile behind is steeper than
    the one that was, until conduction has evened it.

    temperature (n,) K; capacity (n,) J/K, 0 for particles that have gone before; adjacent: of `neighbours`. The sum of
    capacity * temperature stays.
    """
    temperature, there = np.array(temperature, float), np.asarray(capacity) > 0
    for one in leaving:
        there[one] = False
        if there.any():
            handed = _hand_inwards(temperature, capacity, adjacent, one, there, share)
            temperature[one] -= handed / capacity[one]
    return temperature


def _hand_inwards(temperature, capacity, adjacent, one, there, share):
    """Raise `temperature` behind particle `one`, layer by layer. -> J handed over."""
    budget = left = share * capacity[one] * (temperature[one] - temperature[there].min())
    before, unseen, layer = temperature.copy(), there.copy(), np.array([one])
    while left > SPENT * abs(budget):
        rows = adjacent[layer]
        outer, inner = np.repeat(layer, np.diff(rows.indptr)), rows.indices
        outer, inner = outer[unseen[inner]], inner[unseen[inner]]
        if not len(inner):
            break
        layer, place = np.unique(inner, return_inverse=True)
        limit = np.full(len(layer), np.inf)
        np.minimum.at(limit, place, before[outer])
        wanted = share * capacity[layer] * np.maximum(limit - before[layer], 0.0)
        part = min(1.0, left / wanted.sum()) if wanted.any() else 0.0
        temperature[layer] += part * wanted / capacity[layer]
        left -= part * wanted.sum()
        unseen[layer] = False
    return budget - left

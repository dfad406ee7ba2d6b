"""How far accelerated wear can be trusted: R's two rules, judged from one run's own record.

Wear that is accelerated f times in a run of T seconds stands for f T seconds of work. R asks two things of f: scaling f
up and T down by the same factor must leave the wear where it was, and T must stay long against single contact events.
Both are questions of statistics: how well T seconds sample where the tool wears, and over how many contacts a layer of
the tool goes.
"""
import numpy as np

from rockwear.kernels.polygon import contour, nearest_arc

MIN_BLOCKS = 8
"""Fewer blocks of a record tell nothing of its scatter."""
PLACE = 2e-3
"""Length (m) along a tool's outline that counts as one place where wear may happen."""
ENOUGH_EVENTS = 10
"""Contact events over which a particle should wear away, so that no single one shapes the tool."""


def places(outline, points):
    """(m,) number of the place, PLACE long, along an outline (k, 2) m that each of the points (m, 2) is nearest to."""
    along, arc = contour(outline, PLACE / 10)
    return np.floor((nearest_arc(points, along, arc) - arc[0]) / PLACE).astype(int)


def middles(outline, count):
    """(count,) m along an outline (k, 2) m, from its tip, to the middles of its places."""
    return contour(outline, PLACE / 10)[1][0] + (np.arange(count) + 0.5) * PLACE


def distribution_error(increments):
    """Expected relative error of a wear distribution that was sampled in one run, by batch means.

    increments: (t, b) worn volume (m3) of each of b places along the tool in each of t equal spans of time. With the
    record cut into n blocks of sums X_kb, totals w_b, W = sum w_b and the shares p_b = w_b / W, the variance of w_b at
    a given worn volume W is n / (n - 1) sum_k (X_kb - p_b X_k)^2 (ratio estimator), and the error is

        sum_b sqrt(2 / pi var_b) / W,

    the mean absolute deviation of a normal variable, summed over the places. Contacts come in bursts, so the blocks grow
    from one span until MIN_BLOCKS are left, and the largest error counts. -> float; it falls with 1 / sqrt(T); nan where
    there is no wear or no MIN_BLOCKS spans.
    """
    total = np.sum(increments, axis=0)
    deviation = distribution_deviation(increments)
    return float("nan") if deviation is None else float(np.sqrt(2 / np.pi) * np.sum(deviation) / total.sum())


def distribution_deviation(increments):
    """Standard error (b,) m3 of the wear at each place, given the worn volume; see distribution_error. None without one."""
    increments = np.asarray(increments, float)
    total = increments.sum(axis=0)
    if len(increments) < MIN_BLOCKS or not total.sum() > 0:
        return None
    found, span = [], 1
    while len(increments) // span >= MIN_BLOCKS:
        count = len(increments) // span
        blocks = increments[:count * span].reshape(count, span, -1).sum(axis=1)
        rest = blocks - np.outer(blocks.sum(axis=1), total / total.sum())
        found.append(np.sqrt(count / (count - 1) * np.sum(rest**2, axis=0) * len(increments) / (count * span)))
        span *= 2
    return max(found, key=np.sum)


def events_per_particle(*, events, worn, limit):
    """Contact events over which a particle wears away: the median over the worn volume of events * limit / worn.

    events: (m,) contact events in which each particle was worn; worn: (m,) m3 worn off it, whatever it had to give;
    limit: (m,) m3 at which it goes. -> float, nan without wear.
    """
    touched = np.flatnonzero((np.asarray(worn) > 0) & (np.asarray(events) > 0))
    if not len(touched):
        return float("nan")
    count = np.asarray(events)[touched] * np.asarray(limit)[touched] / np.asarray(worn)[touched]
    order = np.argsort(count)
    weight = np.cumsum(np.asarray(worn)[touched][order])
    return float(count[order][np.searchsorted(weight, 0.5 * weight[-1])])


def trusted_wear_acceleration(*, wear_acceleration, error, events, tolerance):
    """Largest factor at which the same worn volume would have kept both of R's rules.

    A factor f' wears the same volume in f / f' of the time: the error of the distribution becomes error sqrt(f' / f),
    and a particle goes in events f / f' contacts. -> f min((tolerance / error)^2, events / ENOUGH_EVENTS), of what is
    known of the two; nan where the record says nothing.
    """
    with np.errstate(divide="ignore"):
        return wear_acceleration * float(np.fmin((tolerance / np.float64(error)) ** 2, events / ENOUGH_EVENTS))


def difference(first, second):
    """Relative difference of two wear distributions (b,) m3 whatever their totals: sum |p - q| of their shares, 0 to 2."""
    first, second = np.asarray(first, float), np.asarray(second, float)
    return float(np.abs(first / first.sum() - second / second.sum()).sum())

"""Reliability of accelerated wear: the two rules of [Rocky], evaluated from the record of one run.

Wear accelerated f times in a run of T seconds represents f T seconds of cutting. [Rocky, sec. 2.5] has two rules for f:
the wear must not change if f is multiplied and T divided by the same factor, and T must be long against single contact
events. Both are statistical: how well T seconds sample the distribution of wear over the tool, and in how many contact
events a layer of the tool is worn off.
"""
import numpy as np

from rockwear.kernels.polygon import contour, nearest_arc, perimeter

MIN_BLOCKS = 8
"""Least number of blocks of a record from which its scatter is estimated."""
PLACE, PLACES = 2e-3, 20
"""Length (m) along the profile of a tool over which wear is summed; places that a small tool has at least."""
ENOUGH_EVENTS = 10
"""Least number of contact events in which a particle should be worn away: no single event determines the shape."""
RECESSION = 0.1
"""Recession over slip up to which a wear acceleration is trusted: friction was 10 % below that of a tool that keeps its
shape at 0.16, 32 % at 1.1, 73 % at 3.6 (calibration/campaigns/two_tools.py, seed 1)."""


def place_length(outline):
    """m, length of a place of a profile (k, 2) m: PLACE, or a part of the profile where it has few of these."""
    return min(PLACE, perimeter(outline) / PLACES)


def places(outline, points):
    """(m,) int, number of the place of a profile (k, 2) m nearest to each of the points (m, 2) m."""
    length = place_length(outline)
    along, arc = contour(outline, length / 10)
    return np.floor((nearest_arc(points, along, arc) - arc[0]) / length).astype(int)


def middles(outline, count):
    """(count,) m, arc length from the tip of a profile (k, 2) m to the middles of its places."""
    length = place_length(outline)
    return contour(outline, length / 10)[1][0] + (np.arange(count) + 0.5) * length


def distribution_error(increments):
    """Expected relative error (-) of a wear distribution sampled in one run, by batch means. (Ours.)

    increments: (t, b) m3, worn volume of each of b places along the tool in each of t equal intervals of time. For n
    blocks with the sums X_kb, totals w_b, W = sum w_b and shares p_b = w_b / W, the variance of w_b at a given W is
    n / (n - 1) sum_k (X_kb - p_b X_k)^2 (ratio estimator), and the error is

        sum_b sqrt(2 / pi var_b) / W,

    the mean absolute deviation of a normal variable, summed over the places. As contact events are correlated, blocks
    of 1, 2, 4, ... intervals are used while MIN_BLOCKS remain, and the largest error is returned. It decreases with
    1 / sqrt(T); nan without wear and with fewer than MIN_BLOCKS intervals.
    """
    total = np.sum(increments, axis=0)
    deviation = distribution_deviation(increments)
    return float("nan") if deviation is None else float(np.sqrt(2 / np.pi) * np.sum(deviation) / total.sum())


def distribution_deviation(increments):
    """Standard error (b,) m3 of the wear at each place at a given worn volume, or None; see distribution_error."""
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
    """Contact events (-) in which a particle is worn away: median, weighted by worn volume, of events * limit / worn.

    events: (m,) contact events in which each particle was worn; worn: (m,) m3 worn off it, which may exceed its own
    volume; limit: (m,) m3 at which it is removed. nan without wear.
    """
    touched = np.flatnonzero((np.asarray(worn) > 0) & (np.asarray(events) > 0))
    if not len(touched):
        return float("nan")
    count = np.asarray(events)[touched] * np.asarray(limit)[touched] / np.asarray(worn)[touched]
    order = np.argsort(count)
    weight = np.cumsum(np.asarray(worn)[touched][order])
    return float(count[order][np.searchsorted(weight, 0.5 * weight[-1])])


def trusted_wear_acceleration(*, wear_acceleration, error, events, tolerance):
    """Largest wear acceleration (-) at which the same worn volume would have satisfied both rules of [Rocky, sec. 2.5].

    A factor f' wears the same volume in the time f / f': the error of the distribution becomes error sqrt(f' / f), and
    a particle is worn away in events f / f' contacts: f' = f min((tolerance / error)^2, events / ENOUGH_EVENTS).
    wear_acceleration f; error: of distribution_error; events: of events_per_particle; tolerance: of the error. A nan of
    error or events is ignored; nan if both are.
    """
    with np.errstate(divide="ignore"):
        return wear_acceleration * float(np.fmin((tolerance / np.float64(error)) ** 2, events / ENOUGH_EVENTS))


def difference(first, second):
    """Difference (-, 0 to 2) of two wear distributions (b,) m3: sum |p - q| over their shares of the totals."""
    first, second = np.asarray(first, float), np.asarray(second, float)
    return float(np.abs(first / first.sum() - second / second.sum()).sum())

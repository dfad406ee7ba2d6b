"""Solving for unknowns of which every measurement is dear and noisy: a linear model that each measurement improves.

Observables y depend on unknowns x nearly linearly (both are logarithms, as a rule): y = a + J (x - c) about the centre
c. J is known beforehand with a standard deviation for each entry, 0 where a scaling law is exact; a is not known. The
mean of a and J given all measurements so far (Bayesian linear regression, each observable for itself) is the model that
the next x comes from. A measurement far from the centre counts less, by CURVATURE times its distance squared.
"""
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import lsq_linear

CURVATURE = 0.3
"""Error of the model, in units of y, at a distance of 1 in x."""
LONGEST = 0.7
"""Longest change of an unknown in a step: a factor of two."""
FREE = 1e6
"""Standard deviation of what is not known."""
SETTLED = 2e-3
"""Change of all unknowns below which another step cannot come nearer."""
GAIN = 0.25
"""Least expected approach of a step, over what the misfits may be at the end: where targets contradict each other, the
search ends at the best place and does not follow the noise."""


class Surrogate:
    """The linear model. jacobian: (m, n); deviation: (m, n), of each entry, 0: exact."""

    def __init__(self, jacobian, deviation):
        self.mean = np.asarray(jacobian, float)
        self.covariance = np.array([np.diag(np.maximum(row, 1e-6)**2) for row in np.asarray(deviation, float)])
        self.points = []

    def add(self, x, y, noise):
        """Take a measurement: x (n,), y (m,), noise (m,), the standard deviations of y. nan in y: not measured."""
        self.points.append((np.array(x, float), np.array(y, float), np.array(noise, float)))

    def about(self, centre):
        """(a (m,), J (m, n), covariance (m, 1 + n, 1 + n) of both) about a centre (n,)."""
        values, covariances = [], []
        for i, (mean, covariance) in enumerate(zip(self.mean, self.covariance)):
            precision = np.zeros((1 + len(mean),) * 2)
            precision[0, 0], precision[1:, 1:] = FREE**-2, np.linalg.inv(covariance)
            moment = precision @ [0.0, *mean]
            for x, y, noise in self.points:
                if np.isfinite(y[i]):
                    row = np.array([1.0, *(x - centre)])
                    weight = 1 / (noise[i]**2 + (CURVATURE * (row[1:] @ row[1:]))**2)
                    precision += weight * np.outer(row, row)
                    moment += weight * y[i] * row
            covariances.append(np.linalg.inv(precision))
            values.append(covariances[-1] @ moment)
        values = np.array(values)
        return values[:, 0], values[:, 1:], np.array(covariances)

    def next_stage(self, centre):
        """The model for other specimens: the slopes as they are known now, no measurement."""
        _, mean, covariance = self.about(centre)
        new = Surrogate(mean, np.ones_like(mean))
        new.covariance = covariance[:, 1:, 1:]
        return new

    def solve(self, problem, centre):
        """(n,): the unknowns at which the model about `centre` (n,) is nearest to the targets."""
        a, slopes, _ = self.about(centre)
        weight = 1 / problem.tolerance
        low, high = (np.clip(bound, centre - LONGEST, centre + LONGEST) - centre
                     for bound in (problem.low, problem.high))
        return centre + lsq_linear(weight[:, None] * slopes, weight * (problem.target - a),
                                   bounds=(low - 1e-9, high + 1e-9)).x

    def approach(self, problem, old, new):
        """By how many tolerances (root of the sum of squares) `new` (n,) is expected to be nearer than `old` (n,)."""
        a, slopes, _ = self.about(old)
        before, after = ((y - problem.target) / problem.tolerance for y in (a, a + slopes @ (new - old)))
        return float(np.linalg.norm(before) - np.linalg.norm(after))


@dataclass
class Problem:
    """What is sought. target, tolerance: (m,) of the observables; low, high: (n,) of the unknowns."""

    target: np.ndarray
    tolerance: np.ndarray
    low: np.ndarray
    high: np.ndarray


@dataclass
class Solution:
    """Steps [(x, y, noise)] of a solution, the nearest last; reached: whether every target was met."""

    steps: list = field(default_factory=list)
    reached: bool = False

    @property
    def x(self):
        """(n,): the unknowns found."""
        return self.steps[-1][0]


def solve(measure, surrogate, problem, *, start, most, enough=1.0):
    """Solution of at most `most` measurements. measure(x (n,)) -> (y (m,), noise (m,)).

    It ends where every target is met to `enough` times its tolerance, or where the model knows no better place.
    """
    solution, x = Solution(), np.array(start, float)
    for _ in range(most):
        y, noise = measure(x)
        surrogate.add(x, y, noise)
        solution.steps.append((x, y, noise))
        if misfit(y, problem) <= enough:
            solution.reached = True
            return solution
        new = surrogate.solve(problem, x)
        if np.max(abs(new - x)) < SETTLED or surrogate.approach(problem, x, new) < GAIN * enough:
            break
        x = new
    # Where not all targets can be met, the sum of squares keeps the others.
    solution.steps.sort(key=lambda step: -float(np.sum(_misfits(step[1], problem)**2)))
    return solution


def misfit(y, problem):
    """Largest distance of an observable from its target, in tolerances; inf where one is not known."""
    return float(np.max(_misfits(y, problem)))


def _misfits(y, problem):
    return np.nan_to_num(abs(y - problem.target) / problem.tolerance, nan=np.inf)


def uncertainty(surrogate, problem, centre, error):
    """(n,): standard deviations of the unknowns that come from those of the observables, error (m,)."""
    _, slopes, _ = surrogate.about(centre)
    weight = 1 / problem.tolerance
    inverse = np.linalg.pinv(weight[:, None] * slopes) * weight
    return np.sqrt(np.nansum((inverse * error)**2, axis=1))

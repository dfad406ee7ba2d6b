"""Fits the micro-parameters of a rock to laboratory values: search on small specimens, then on full ones, then a check
on packings that the fit has not seen. The entry is calibration/fit.py."""
import math
import os
import sys
import time
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from calibration.campaigns.runs import RunFailed, Runs, require_dask
from calibration.command import made
from calibration.fitting import rock_page
from calibration.fitting.rock_unknowns import AIM, Micro
from calibration.fitting.rock_targets import GROUPS, STAGES, doubts, given_of, start_of, targets_of
from calibration.fitting.rock_tests import Laboratory, Stage
from calibration.fitting.surrogate import Problem, Surrogate, solve, uncertainty
from rockwear.kernels.checks import ParameterError, require
from rockwear.run import parameters

SIDES = {"side": 87.2, "notched": 64.0, "confined": 43.6}
SMALL = Stage("small", side=43.6, notched=32.0, confined=43.6, seeds=(1, 2, 3, 4), dear=2)
FULL = tuple(Stage("full", **SIDES, seeds=tuple(range(first, first + 5)), dear=3) for first in (11, 16))
CHECK = Stage("check", **SIDES, seeds=tuple(range(21, 31)), dear=6)
"""Full specimens have 2,100 particles, as those of [Rojek 2003, 5.1]; small ones a quarter of them, and twice the
scatter: they give the slopes. Confined tests are made on small ones throughout: a full one takes eight times as long.
UCS scatters by 9 % between full specimens. The second full set has other packings than the first, and both count."""
SEARCH = {"small": ((SMALL,) * 7, 1.0), "full": (FULL, 0.4)}
"""{stage: (sets of tests at most, part of what is allowed that they may miss at the end)}. Small specimens differ from
full ones by as much as is allowed: to search on them for less is lost time."""
JOBS = 8
"""Tests at a time for each processor: more only take memory."""
CHECKS = 2
"""Checks in all. Where the first misses a target its packings join those of the fit, and others check the new rock."""
LEAST_NOISE, COMMON_SEEDS = 0.004, 0.5
"""Noise of a mean: at least, and over its standard error where all sets of a stage have the same packings, which change
alike."""


@dataclass
class Step:
    """One set of tests: the stage, the unknowns x (n,), {Observable: (packings,) values}; s since the fit
    began. Packings are in the order of the stage's seeds, nan where one was not measured."""

    stage: str
    x: np.ndarray
    values: dict
    seconds: float = 0.0


@dataclass
class Fit:
    """A fit and how it went. verdicts: {Observable: Verdict} of the last check; error: (n,), of log unknowns;
    specimens: words on those of the check."""

    x: np.ndarray
    error: np.ndarray
    steps: list = field(default_factory=list)
    verdicts: dict = field(default_factory=dict)
    not_failed: list = field(default_factory=list)
    failures: list = field(default_factory=list)
    specimens: str = ""


@dataclass(frozen=True)
class Verdict:
    """An observable on packings that the fit has not seen. mean, deviation: over `count` packings; off: how far the
    mean lies from the target, allowed: how far it may."""

    mean: float
    deviation: float
    count: int
    off: float
    allowed: float

    @property
    def error(self):
        """Standard error of the mean."""
        return self.deviation / math.sqrt(self.count)

    @property
    def told(self):
        """Whether the packings tell if the target is met: the standard error is no larger than what is allowed, or the
        mean is off by more than that and twice the error."""
        return self.error <= self.allowed or self.off > self.allowed + 2 * self.error

    @property
    def met(self):
        """Whether the target is met, as far as the packings tell."""
        return self.told and self.off <= self.allowed

    @property
    def missed(self):
        """Whether it is not."""
        return self.told and self.off > self.allowed


def fit(*, micro, measure, first_stage=STAGES[0], say=partial(print, flush=True)):
    """Fit of the unknowns of `micro`. measure(x, Stage) -> {Observable: (packings,) values}: the laboratory;
    first_stage: of STAGES."""
    found, began = Fit(micro.first, np.zeros(len(micro.first))), time.time()
    problem = Problem(target=np.array([float(o.scaled(o.target)) for o in micro.observables]),
                      tolerance=np.array([AIM * o.tolerance for o in micro.observables]),
                      low=micro.low, high=micro.high)

    def tested(x, stage):
        values = measure(x, stage)
        found.steps.append(Step(stage.name, np.array(x), values, time.time() - began))
        say(rock_page.progress(found.steps[-1]))
        return values

    def measured(sets, x):
        stage = next(sets)
        return statistics(tested(x, stage), COMMON_SEEDS if stage is SMALL else 1.0)

    model = Surrogate(*micro.slopes())
    for name in STAGES[STAGES.index(first_stage):-1]:
        sets, part = SEARCH[name]
        solution = solve(partial(measured, iter(sets)), model, problem, start=found.x, most=len(sets),
                         enough=part / AIM)
        found.x = model.solve(problem, solution.x)
        if name == SMALL.name:
            model = model.next_stage(found.x)
    for number in range(CHECKS):
        stage = replace(CHECK, name=f"check {number + 1}", seeds=tuple(seed + 10 * number for seed in CHECK.seeds))
        values = tested(found.x, stage)
        found.verdicts = {o: verdict(o, of_seeds) for o, of_seeds in values.items()}
        if number + 1 == CHECKS or all(one.met for one in found.verdicts.values()):
            break
        model.add(found.x, *statistics(values))
        found.x = model.solve(problem, found.x)
    errors = np.array([spread(o, values[o])[1] for o in micro.observables])
    found.error = uncertainty(model, problem, found.x, errors)
    return found


def statistics(values, part=1.0):
    """(means (m,), noise (m,)) of {Observable: (packings,)}, as the solver sees them. part: of the standard error that
    counts."""
    means, errors = np.array([spread(o, of_seeds) for o, of_seeds in values.items()]).T
    return means, np.hypot(LEAST_NOISE, part * errors)


def spread(observable, values):
    """(mean, standard error), scaled, of the values (packings,) of an observable; nan: not measured."""
    values = values[np.isfinite(values)]
    scaled = observable.scaled(values)
    return float(observable.scaled(values.mean())), float(scaled.std(ddof=1) / np.sqrt(len(scaled)))


def verdict(observable, values):
    """Verdict of the values (packings,) of an observable; nan: not measured."""
    mean = float(np.nanmean(values))
    allowed = observable.tolerance if observable.kind == "nu" else observable.allowed * observable.target
    return Verdict(mean=mean, deviation=float(np.nanstd(values, ddof=1)), count=int(np.isfinite(values).sum()),
                   off=abs(mean - observable.target), allowed=allowed)


def check_jobs(count):
    """Raise ParameterError for more tests at a time than this machine has any use for."""
    most = JOBS * os.cpu_count()
    require(count <= most, "jobs", count, f"at most {most}, {JOBS} for each processor here")


def main(words):
    """Command line. -> exit code: 0 where every target is met; 3 where some are missed; 4 where none is, but packings
    scatter too much to tell of some; 2: options that cannot be used; 1: a run failed."""
    if "--help" in words:
        parameters.describe(GROUPS, usage="python3 -m calibration.fit --youngs_modulus PA --poissons_ratio NU --ucs PA "
                            "--tensile_strength PA --out DIR [--name value ...]")
        return 0
    try:
        values = parameters.read(GROUPS, words)
        targets = targets_of(values)
        start = start_of(values)
        check_jobs(values["jobs"])
        require(values["out"], "out", "nothing", "given: the folder of the results")
        require_dask()
        folder = made(Path(values["out"]))
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    radii = values["radius_min"], values["radius_max"]
    if words_of_doubt := doubts(targets, sum(radii) / 2):
        print(words_of_doubt, flush=True)
    micro = Micro(law=values["bond_law"], targets=targets, radius=sum(radii) / 2,
                  given=given_of(values, targets, start), start=start)
    try:
        with Runs(folder / "runs", at_once=values["jobs"], keep=True) as runs:
            laboratory = Laboratory(runs=runs, targets=targets, radii=radii, micro=micro)
            found = fit(micro=micro, measure=laboratory.measure, first_stage=values["first_stage"])
            found.not_failed, found.failures = laboratory.not_failed[found.steps[-1].stage], laboratory.failures
            found.specimens = laboratory.specimens(CHECK)
        rock_page.write(folder, found, micro=micro, targets=targets, values=values)
    except (RunFailed, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print("\n".join(rock_page.answer(found, micro)))
    print(f"rock: {folder / 'rock.json'}; page: {folder / 'fit.md'}")
    return exit_code(found.verdicts.values())


def exit_code(verdicts):
    """Of the command, of all Verdicts."""
    if any(one.missed for one in verdicts):
        return 3
    return 0 if all(one.told for one in verdicts) else 4

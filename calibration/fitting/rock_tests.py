"""The laboratory of a rock fit: which script tests what, on which specimens, how fast; all runs kept."""
import hashlib
import json
from dataclasses import dataclass

import numpy as np

COMMON = {"report": "false", "snapshot_period": 1}
SPEED = {"compression": 6.8, "tension": 42.0}
"""Speed of a platen, m/s, over strength / E. They are those of [Rojek 2003]'s bonds at 0.05 m/s: a rock that fails at
less strain is loaded as much more slowly (calibration/results/uniaxial.md)."""
TOUGHNESS_SIZE = 64.0
"""Size of a toughness specimen over the mean radius."""
DEAR, DEAR_PACKINGS = ("triaxial", "toughness"), 3
"""Tests that take minutes, and the packings that they are made on at most."""


@dataclass(frozen=True)
class Stage:
    """A set of tests. side: of a specimen over the mean radius; hurry: factor on SPEED; seeds: of the packings."""

    name: str
    side: float
    hurry: float
    seeds: tuple


class Laboratory:
    """Runs the tests of a list of Observables. runs: campaigns.runs.Runs; radii: (smallest, largest), m."""

    def __init__(self, *, runs, targets, radii, micro):
        self.runs, self.targets, self.radii, self.micro = runs, targets, radii, micro
        self.not_failed = {}

    def measure(self, x, stage):
        """{Observable: (packings,) values} at the logarithms x of the unknowns. Raises RunFailed."""
        parameters = self.micro.parameters(x)
        tests = {(o.test, o.confinement) for o in self.micro.observables}
        # The longest first, so that both processes end together.
        order = sorted(tests, key=lambda test: ("triaxial", "compression", "toughness", "tension").index(test[0]))
        seeds = {test: stage.seeds[:DEAR_PACKINGS if test[0] in DEAR else None] for test in order}
        jobs = {(*test, seed): self._start(*test, seed, parameters, stage) for test in order for seed in seeds[test]}
        done = {key: job.result() for key, job in jobs.items()}
        self.not_failed[stage.name] = sorted(
            {f"{test} {1e-6 * confinement:g} MPa" if confinement else test
             for (test, confinement, _), run in done.items() if run.result("failed") == 0})
        return {o: np.array([done[o.test, o.confinement, seed].result(o.result)
                             for seed in seeds[o.test, o.confinement]]) for o in self.micro.observables}

    def _start(self, test, confinement, seed, parameters, stage):
        script, values = self._test(test, confinement, stage)
        values = {**values, **parameters, "radius_min": self.radii[0], "radius_max": self.radii[1], "seed": seed,
                  **COMMON}
        digest = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:12]
        return self.runs.start(f"{stage.name}/{test}-{seed}-{digest}", script, **values)

    def _test(self, test, confinement, stage):
        """(script, {parameter: value}) of a test but for the rock."""
        t, radius = self.targets, self.micro.radius
        side = _digits(stage.side * radius)
        box = {"width": side, "height": side}
        squeeze = _digits(stage.hurry * SPEED["compression"] * t.ucs / t.youngs_modulus)
        pull = _digits(stage.hurry * SPEED["tension"] * t.tensile_strength / t.youngs_modulus)
        if test == "toughness":
            return "yade_scripts/toughness.py", {"size": _digits(TOUGHNESS_SIZE * radius)}
        if test == "triaxial":
            return "yade_scripts/triaxial.py", {**box, "speed": squeeze, "confinement": confinement}
        return "yade_scripts/uniaxial.py", {"test": test, **box, "speed": squeeze if test == "compression" else pull}


def _digits(value):
    return float(f"{value:.4g}")

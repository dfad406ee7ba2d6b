"""The laboratory of a rock fit: which script tests what, on which specimens, how fast; all runs kept."""
import hashlib
import json
import math
from dataclasses import dataclass

import numpy as np

from calibration.campaigns.runs import RunFailed, ended_well
from calibration.laboratory.loading import loading, strength

COMMON = {"report": "false", "snapshot_period": 1, "rock_sampling_period": 50}
"""Looks at slipping contacts of rock enter the energy balance alone; at the default period they take a tenth of a test.
"""
DROP = 0.8
"""Part of the peak at which a test of strength ends. In 32 tests with grains, up to 15 MPa of confinement, none that
fell so far rose above its peak again; to 0.5 a compression takes a fifth longer, a confined one up to twice as long."""
LEAST = 2
"""Packings below which there is no mean."""


@dataclass(frozen=True)
class Stage:
    """A set of tests. side, notched, confined: of a specimen, of one for the toughness and of one for confined tests
    over the mean radius; seeds: of the packings; dear: of how many of these packings confined tests are made."""

    name: str
    side: float
    notched: float
    confined: float
    seeds: tuple
    dear: int


class Laboratory:
    """Runs the tests of a fit. runs: campaigns.runs.Runs; targets: Targets; radii: (smallest, largest), m; micro: Micro

    not_failed: {stage: tests in which some specimen did not fail}; failures: what runs that ended badly said.
    """

    def __init__(self, *, runs, targets, radii, micro):
        self.runs, self.targets, self.radii, self.micro = runs, targets, radii, micro
        self.not_failed, self.failures = {}, []

    def measure(self, x, stage):
        """{Observable: (packings,) values} at the logarithms x of the unknowns, in the order of the stage's seeds, nan
        where a packing could not be measured. Raises RunFailed."""
        parameters = self.micro.parameters(x)
        tests = {(o.test, o.confinement) for o in self.micro.observables}
        # The longest first, so that both processes end together.
        order = sorted(tests, key=lambda test: ("triaxial", "compression", "toughness", "tension").index(test[0]))
        seeds = {test: stage.seeds[:stage.dear if test[0] == "triaxial" else None] for test in order}
        jobs = {(*test, seed): self._start(*test, seed, parameters, stage) for test in order for seed in seeds[test]}
        done, failures = ended_well(jobs)
        self.failures += failures
        self.not_failed[stage.name] = sorted(
            {f"{test} {1e-6 * confinement:g} MPa" if confinement else test
             for (test, confinement, _), run in done.items() if run.result("failed") == 0})
        values = {o: np.array([run.result(o.result) if (run := done.get((o.test, o.confinement, seed))) else math.nan
                               for seed in seeds[o.test, o.confinement]]) for o in self.micro.observables}
        for o, of_packings in values.items():
            if np.isfinite(of_packings).sum() < LEAST:
                raise RunFailed(f"{o.name} could not be measured on {LEAST} packings of the stage {stage.name}: "
                                f"{'; '.join(self.failures) or 'too few rows before the peak'}")
        return values

    def specimens(self, stage):
        """Words on the specimens of a stage."""
        tests = {o.test for o in self.micro.observables}
        sides = [("compression", "compression and tension", stage.side),
                 ("toughness", "toughness (load line to back)", stage.notched),
                 ("triaxial", "confined compression", stage.confined)]
        return ", ".join(f"{1e3 * side * self.micro.radius:.3g} mm in {words}" for test, words, side in sides
                         if test in tests)

    def _start(self, test, confinement, seed, parameters, stage):
        script, values = self._test(test, confinement, stage)
        values = {**values, **parameters, "radius_min": self.radii[0], "radius_max": self.radii[1], "seed": seed,
                  **COMMON}
        digest = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:12]
        return self.runs.start(f"{stage.name}/{test}-{seed}-{digest}", script, **values)

    def _test(self, test, confinement, stage):
        """(script, {parameter: value}) of a test but for the rock."""
        t, radius = self.targets, self.micro.radius
        if test == "toughness":
            return "yade_scripts/toughness.py", {"size": _digits(stage.notched * radius)}
        side = _digits((stage.confined if test == "triaxial" else stage.side) * radius)
        looked_for = strength(test, {"ucs": t.ucs, "tensile_strength": t.tensile_strength, "triaxial": t.confined()},
                              confinement)
        common = {"width": side, "height": side, "drop": DROP, **loading(test, looked_for / t.youngs_modulus)}
        if test == "triaxial":
            return "yade_scripts/triaxial.py", {**common, "confinement": confinement}
        return "yade_scripts/uniaxial.py", {"test": test, **common}


def _digits(value):
    return float(f"{value:.4g}")

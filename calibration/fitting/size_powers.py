"""The powers of the radius that keep the strengths of a rock of cohesive bonds in coarser and finer discs.

    python3 -m calibration.fitting.size_powers --rock NAME|FILE --out DIR [--factor 2] [--packings 5] [--jobs 2]

The fracture energy of such bonds is a length of the rock's own: discs of other radii than those of its file make it
stronger or weaker. Specimens with discs `factor` times coarser and finer are crushed and pulled until
bond_tension_power and bond_cohesion_power leave UCS and tensile strength alike in both; then other packings are tested
at all three radii: over a large factor one power may not be enough. Writes DIR/rock.json, the rock with these powers,
and DIR/size_powers.md. What was interrupted goes on where it was when it is started again with the same words.
"""
import hashlib
import json
import math
import sys
from pathlib import Path

import numpy as np

from calibration import command, generated
from calibration.campaigns.runs import RunFailed, Runs, as_they_end, ended_well, require_dask
from calibration.fitting.rock_fit import LEAST_NOISE, SIDES, check_jobs
from calibration.fitting.rock_tests import COMMON, DROP, LEAST
from calibration.fitting.surrogate import Problem, Surrogate, solve
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import Group, Parameter, file, integer, number, text
from rockwear.model import rock_file
from rockwear.run import parameters
from rockwear.scenes.parameters import OF_ROCK

TESTS = {"compression": ("UCS", "peak_stress", 0.05), "tension": ("tensile strength", "tensile_strength", 0.10)}
"""{test: (words, result, part by which it may change)}."""
POWERS = "bond_tension_power", "bond_cohesion_power"
SLOPES, DEVIATIONS = ((-0.1, 0.55), (0.5, 0.4)), ((0.3, 0.3), (0.3, 0.3))
"""(2, 2): change of ln UCS and ln tensile strength over that of ln bond_tension and ln bond_cohesion, and how far other
rocks may be from that: crushing_sandstone with discs of four times and a quarter of its radii (one packing)."""
MOST_POWER = 1.5
"""Largest power that is looked for."""
SEARCHES = 4
"""Sets of tests at most, before the check."""
ENOUGH = 0.5
"""Part of what is allowed that the search may miss."""
PACKINGS = integer(2, 100)
"""A rule: packings of each set of tests."""
CHECKED = 20
"""Seeds of the check lie above this, and above those of the search."""
GROUPS = [Group("rock", (
    Parameter("rock", "", "", file, "rock, a name of the library or a file, of cohesive bonds in the plane", "yours"),
    Parameter("factor", 2.0, "", number(1.5, 10), "how many times coarser and finer the discs are to be"))),
    Group("search", (Parameter("packings", 5, "", PACKINGS, "packings of each set of tests"),
                     Parameter("jobs", 2, "", integer(1), "tests at a time"))),
    Group("output", (Parameter("out", "", "", text, "folder of rock.json, size_powers.md and all runs"),))]


class SizedLaboratory:
    """Compression and tension of a rock at several radii. runs: campaigns.runs.Runs; data: the rock file, as JSON has
    it; folder: of the rocks that are tested."""

    def __init__(self, *, runs, data, folder):
        self.runs, self.data, self.folder = runs, data, folder

    def measure(self, powers, ratios, seeds):
        """{(test, ratio): (packings,) Pa} of the rock with these powers (2,), in discs of `ratios` times the radii of
        its file, nan where a run failed. Raises RunFailed."""
        rock = json.dumps(with_powers(self.data, powers), indent=1) + "\n"
        name = hashlib.sha256(rock.encode()).hexdigest()[:12]
        path = self.folder / f"rock-{name}.json"
        path.write_text(rock, encoding="utf-8")
        jobs = {(test, ratio, seed): self._start(test, ratio, seed, name, path)
                for ratio in ratios for test in TESTS for seed in seeds}
        for _ in as_they_end(jobs.values()):
            pass
        runs, failures = ended_well(jobs)
        found = {(test, ratio): np.array([runs[test, ratio, seed].result(TESTS[test][1])
                                          if (test, ratio, seed) in runs else math.nan for seed in seeds])
                 for ratio in ratios for test in TESTS}
        for test in TESTS:
            if np.isfinite([found[test, ratio] for ratio in ratios]).all(axis=0).sum() < LEAST:
                raise RunFailed(f"fewer than {LEAST} packings end well in {test} at every radius: "
                                f"{'; '.join(failures)}")
        return found

    def _start(self, test, ratio, seed, name, path):
        radii = {of: ratio * value for of, value in self.data["plane"]["resolution"].items()}
        # The same packing at every ratio, only larger or smaller.
        side = ratio * float(f"{SIDES['side'] * rock_file.size(self.data['plane']['resolution']):.4g}")
        return self.runs.start(f"{name}/{test}-{ratio:g}-{seed}", "yade_scripts/uniaxial.py", test=test, width=side,
                               height=side, drop=DROP, rock=str(path), seed=seed, **radii, **COMMON)


def with_powers(data, powers):
    """The rock file `data`, as JSON has it, with these powers (2,)."""
    plane = data["plane"]
    given = dict(zip(POWERS, (float(f"{power:.3g}") for power in powers)))
    return {**data, "plane": {**plane, "parameters": {**plane["parameters"], **given}}}


def exponents(found, factor):
    """(mean (2,), standard error (2,)) of d ln strength / d ln radius, in the order of TESTS, between discs `factor`
    times coarser and finer of the same packings. found: of SizedLaboratory.measure."""
    of = np.array([np.log(found[test, factor] / found[test, 1 / factor]) for test in TESTS]) / (2 * math.log(factor))
    return np.array([generated.mean_and_error(of_packings[np.isfinite(of_packings)]) for of_packings in of]).T


def search(measure, *, factor, start):
    """surrogate.Solution: the powers (2,) with which the exponents vanish. measure: (2,) -> of `exponents`."""
    allowed = np.array([part for _, _, part in TESTS.values()]) / math.log(factor)
    problem = Problem(target=np.zeros(2), tolerance=allowed, low=np.full(2, -MOST_POWER), high=np.full(2, MOST_POWER))

    def noisy(powers):
        mean, error = measure(powers)
        return mean, np.hypot(LEAST_NOISE, error)

    return solve(noisy, Surrogate(SLOPES, DEVIATIONS), problem, start=start, most=SEARCHES, enough=ENOUGH)


def changes(found, factor):
    """[(words, ratio, mean strength, its standard error, change against the file's radii, its standard error, met)] of
    a check at three radii."""
    rows = []
    for test, (words, _, allowed) in TESTS.items():
        for ratio in (factor, 1.0, 1 / factor):
            values, here = found[test, ratio], found[test, 1.0]
            both = np.isfinite(values) & np.isfinite(here)
            change, error = generated.mean_and_error(values[both] / here[both] - 1.0)
            # What packings do not tell is not said to stay.
            kept = ratio == 1.0 or (abs(change) <= allowed and error <= allowed)
            rows.append((words, ratio, *generated.mean_and_error(values[both]), change, error, kept))
    return rows


def page(name, solution, rows, *, factor, packings):
    """Lines of size_powers.md. rows: of `changes`."""
    met = all(row[-1] for row in rows)
    names = ", ".join(f"{power} {value:.3g}" for power, value in zip(POWERS, solution.x))
    lines = [f"# {name} in coarser and finer discs", "",
             f"With {names} the strengths of the rock {'stay' if met else '**do not all stay**'} within what is "
             f"allowed ({', '.join(f'{words} {100 * part:g} %' for words, _, part in TESTS.values())}) in discs "
             f"{factor:g} times coarser and finer than those of its file ({packings} packings that the search has not "
             "seen).", ""]
    lines += generated.table(
        ["", "radius over that of the file", "mean ± standard error, MPa", "change", "stays"],
        [[words, f"{ratio:.3g}", f"{1e-6 * mean:.4g} ± {1e-6 * error:.2g}",
          "–" if ratio == 1.0 else f"{100 * change:+.1f} ± {100 * deviation:.1f} %", "yes" if kept else "**no**"]
         for words, ratio, mean, error, change, deviation, kept in rows])
    lines += ["## Search", "", "Change of the strengths from the finer discs to the coarser ones, mean ± standard "
              "error of the same packings, the nearest last:", ""]
    total = 2 * math.log(factor)
    lines += generated.table(
        [*POWERS, *(words for words, _, _ in TESTS.values())],
        [[*(f"{power:.3g}" for power in x),
          *(f"{100 * math.expm1(total * one):+.1f} ± {100 * total * error:.1f} %" for one, error in zip(y, noise))]
         for x, y, noise in solution.steps])
    return lines


def plane_rock(word):
    """(the rock file as JSON has it, its RockFile) of a rock with a part for the plane. Raises ParameterError."""
    require(word, "rock", "nothing", "given: a name of the library, or a file")
    path = rock_file.find(word)
    rock = rock_file.read(path, OF_ROCK)
    require("plane" in rock.parts, "rock", word, "a rock with a part for the plane")
    return json.loads(Path(path).read_text(encoding="utf-8-sig")), rock


def folders(values):
    """(folder of the results, folder of their runs), made, of a command with `jobs` and `out`. Raises
    ParameterError."""
    check_jobs(values["jobs"])
    require(values["out"], "out", "nothing", "given: the folder of the results")
    require_dask()
    folder = command.made(Path(values["out"]))
    return folder, command.made(folder / "runs")


def rock_of(values):
    """The rock file, as JSON has it. Raises ParameterError."""
    data, rock = plane_rock(values["rock"])
    law = rock.parts["plane"].parameters["bond_law"]
    require(law == "cohesive", "rock", f"{values['rock']}, bond_law = {law}", "a rock of cohesive bonds: others have "
            "no such powers")
    return data


def main(words):
    """-> exit code: 0 where the strengths stay; 3 where they do not; 2: options that cannot be used; 1: too few
    runs ended well."""
    command.help_if_asked()
    try:
        values = parameters.read(GROUPS, words)
        data = rock_of(values)
        folder, runs_at = folders(values)
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    factor, packings = values["factor"], values["packings"]
    ends, seeds = (factor, 1 / factor), range(1, 1 + packings)
    unseen = [max(CHECKED, packings) + seed for seed in seeds]
    start = [data["plane"]["parameters"].get(power, 0.0) for power in POWERS]
    try:
        with Runs(runs_at, at_once=values["jobs"], keep=True) as runs:
            laboratory = SizedLaboratory(runs=runs, data=data, folder=runs_at)
            solution = search(lambda powers: exponents(laboratory.measure(powers, ends, seeds), factor),
                              factor=factor, start=start)
            rows = changes(laboratory.measure(solution.x, (1.0, *ends), unseen), factor)
    except (RunFailed, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    (folder / "rock.json").write_text(json.dumps(with_powers(data, solution.x), indent=1) + "\n", encoding="utf-8")
    generated.record(folder / "rock.json")
    print(generated.write_page(folder / "size_powers.md",
                               page(data["name"], solution, rows, factor=factor, packings=packings)))
    print(f"rock: {folder / 'rock.json'}")
    return 0 if all(row[-1] for row in rows) else 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

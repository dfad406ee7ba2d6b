"""The part for space of a rock that has one for the plane: spheres with the same elasticity and strengths.

    python3 -m calibration.fitting.in_space --rock NAME|FILE --out DIR [--radius 6e-4] [--packings 3] [--jobs 2]

Blocks of some 1440 spheres are compressed and pulled until E, nu, UCS and tensile strength are the targets of the rock
file. Where it has a target for the toughness, notched blocks are torn, the bonds' fracture energy is changed until they
have it, and blocks are tested again. Then other packings are tested. Fitted are the stiffnesses of the bonds, their two
strengths and, of cohesive bonds, the fracture energy unless it is given; friction, crushing and the shear energy are
those of the plane. Where slip does not damage the bonds of the plane, UCS over tensile strength stays near six without
grains; --bond_shear_energy 1000 doubles it, and makes a tough rock. --grains 1.8 --grain_strength 15 makes it twelve at
the toughness of a sandstone; packings of grains differ by a tenth, and ask for --packings 5. Grains that do not break
lock before a tool (calibration/results/groove.md). nu is that of a pulled block: in a compressed one the first cracks
open along the load. Writes DIR/rock.json, the rock with both parts, and DIR/in_space.md. What was interrupted goes on
where it was when it is started again with the same words.
"""
import hashlib
import json
import math
import sys

import numpy as np

from calibration import command, generated
from calibration.campaigns.runs import RunFailed, Runs, as_they_end, ended_well
from calibration.fitting.rock_fit import COMMON_SEEDS, exit_code, statistics, verdict
from calibration.fitting.rock_page import allowed, measured, off, shown
from calibration.fitting.rock_tests import COMMON, DROP, LEAST
from calibration.fitting.rock_unknowns import Observable
from calibration.fitting.size_powers import PACKINGS, folders, plane_rock
from calibration.fitting.surrogate import Problem, Surrogate, solve
from calibration.laboratory.loading import loading, strength
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import Above, Group, Parameter, file, integer, plausible, text, zero_or
from rockwear.model.rock_file import RADIUS
from rockwear.run import parameters

SCRIPT, NOTCHED = "yade_scripts/uniaxial_3d.py", "yade_scripts/toughness_3d.py"
LAWS = "cohesive", "coulomb"
ENERGIES = "bond_shear_energy", "bond_fracture_energy"
SIDES, NOTCHED_SIDES = {"width": 100 / 3, "height": 50 / 3, "depth": 50 / 3}, {"size": 28, "depth": 11}
"""Over the radius, of a block, which is loaded along its width, and of a notched one."""
POROSITY, GAP = 0.35, 0.1
"""Of the packings; bonding_gap over the radius."""
EDGES = 0.9, 6.0
"""Least and largest edge of grains over the radius: a grain has a sphere of its own, and a notched block three grains.
"""
OF_PLANE = ("kn", "kt", "bond_tension", "bond_cohesion", "bond_tension_power", "bond_cohesion_power", "bonding_gap",
            "porosity", "grain_edge", "grain_kn", "grain_kt", "grain_strength")
"""Parameters that do not carry over."""
UNKNOWNS = "kn over E d", "kt over kn", "bond_tension over the tensile strength", "bond_cohesion over UCS"
"""Their logarithms are what is varied. d: diameter of the spheres."""
FIRST, WITH_GRAINS, SPAN = np.log([0.99, 0.27, 0.67, 0.52]), np.log([1.2, 0.155, 1.76, 0.83]), math.log(10)
"""crushing_sandstone has the first, medium_sandstone with grains the second; how far others are looked for, a factor of
ten."""
SLOPES = {"E": ((1, 0), (0.2, 0.1), (0, 0.05), (0, 0.05)), "nu": ((0, 0.02), (-0.12, 0.05), (0, 0.02), (0, 0.02)),
          "ucs": ((0, 0.2), (0, 0.2), (0.1, 0.3), (0.6, 0.3)), "tension": ((0, 0.2), (0, 0.2), (0.8, 0.3), (0.1, 0.2))}
"""{kind of observable: (slope over each unknown, standard deviation)}; a deviation of 0: exact."""
SEARCHES, ENOUGH = 7, 0.5
"""Sets of tests at most, before the check; part of what is allowed that they may miss."""
CHECKED, CHECKS, NOTCHES = 20, 5, 3
"""Seeds of the check lie above this, and above those of the search; its packings, and those whose toughness is
measured."""
TEARS, TOUGH, LARGEST = 4, 0.05, 8.0
"""Fracture energies at most that are tried; what the toughness may miss of its target, and by how much an energy
changes at once, at most."""
GROUPS = [
    Group("rock", (
        Parameter("rock", "", "", file, "rock with a part for the plane, a name of the library or a file", "yours"),
        Parameter("radius", 6e-4, "m", plausible(*RADIUS), "radius of the spheres"),
        Parameter("bond_shear_energy", 0.0, "J/m2", zero_or(1e-2, 1e6), "work to break a bond in shear without normal "
                  "force, over its area, for want of grains that interlock; 0: that of the plane; of cohesive bonds "
                  "alone"),
        Parameter("bond_fracture_energy", 0.0, "J/m2", zero_or(1e-4, 1e6), "work to break a bond in tension over its "
                  "area; 0: fitted to the toughness, or that of the plane without one; of cohesive bonds alone"),
        Parameter("grains", 0.0, "", zero_or(*EDGES), "mean edge of grains over the radius of the spheres; 0: none"),
        Parameter("grain_strength", 0.0, "", zero_or(1, 1e3), "of bonds within a grain over those between grains; 0: "
                  "grains do not break", when={"grains": Above(0)}))),
    Group("search", (Parameter("packings", 3, "", PACKINGS, "packings of each set of tests"),
                     Parameter("jobs", 2, "", integer(1), "tests at a time"))),
    Group("output", (Parameter("out", "", "", text, "folder of rock.json, in_space.md and all runs"),))]


def sized(sides, radius):
    """{side: m} of {side: its length over the radius}."""
    return {side: float(f"{length * radius:.4g}") for side, length in sides.items()}


def observables(targets):
    """[Observable] of the targets {property: value} of a rock."""
    return [Observable("youngs_modulus", "compression", "youngs_modulus", targets["youngs_modulus"], 0.05, "E", "Pa"),
            Observable("poissons_ratio", "tension", "poissons_ratio", targets["poissons_ratio"], 0.1, "nu", ""),
            Observable("ucs", "compression", "peak_stress", targets["ucs"], 0.05, "ucs", "Pa"),
            Observable("tensile_strength", "tension", "peak_stress", targets["tensile_strength"], 0.1, "tension", "Pa")]


class BlockLaboratory:
    """Compression and tension of blocks. runs: campaigns.runs.Runs; rock: rock_file.RockFile; radius: m; given:
    {parameter: value} in place of the plane's."""

    def __init__(self, *, runs, rock, radius, given):
        self.runs, self.rock, self.radius, self.given = runs, rock, radius, given
        self.observables = observables(rock.targets)
        free = "bond_fracture_energy" in rock.parts["plane"].parameters and "bond_fracture_energy" not in given
        self.tough_target = rock.targets.get("fracture_toughness") if free else None

    def parameters(self, x):
        """{parameter of a scene: value} of the logarithms (4,) of UNKNOWNS, in five digits."""
        stiffness, ratio, tension, cohesion = np.exp(x)
        of, plane = self.rock.targets, self.rock.parts["plane"].parameters
        kn = stiffness * of["youngs_modulus"] * 2 * self.radius
        found = {"kn": kn, "kt": ratio * kn, "bond_tension": tension * of["tensile_strength"],
                 "bond_cohesion": cohesion * of["ucs"], "bonding_gap": GAP * self.radius, "porosity": POROSITY}
        return {**{name: value for name, value in plane.items() if name not in OF_PLANE}, **self.given,
                **{name: float(f"{value:.5g}") for name, value in found.items()}}

    def measure(self, x, seeds):
        """{Observable: (packings,) values}, nan where a run failed. Raises RunFailed."""
        box = sized(SIDES, self.radius)
        strains = {test: strength(test, self.rock.targets) / self.rock.targets["youngs_modulus"]
                   for test in ("compression", "tension")}
        found = self._run(x, seeds, SCRIPT, {test: dict(test=test, drop=DROP, **box, **loading(test, strain))
                                             for test, strain in strains.items()})
        return {o: self._values(found, o.test, o.result, seeds) for o in self.observables}

    def toughness(self, x, seeds):
        """(packings,) Pa sqrt(m): fracture toughness, nan where it is not known. Raises RunFailed."""
        found = self._run(x, seeds, NOTCHED, {"toughness": sized(NOTCHED_SIDES, self.radius)})
        return self._values(found, "toughness", "fracture_toughness", seeds)

    def _run(self, x, seeds, script, tests):
        """{(test, seed): RunFolder} of {test: its parameters}, of the runs that end well."""
        given = self.parameters(x)
        digest = hashlib.sha256(json.dumps([given, self.radius], sort_keys=True).encode()).hexdigest()[:12]
        jobs = {(test, seed): self.runs.start(f"{digest}/{test}-{seed}", script, radius=self.radius, seed=seed,
                                              **values, **given, **COMMON)
                for seed in seeds for test, values in tests.items()}
        for _ in as_they_end(jobs.values()):
            pass
        found, failures = ended_well(jobs)
        for test in tests:
            if sum(key[0] == test for key in found) < LEAST:
                raise RunFailed(f"fewer than {LEAST} packings end well in {test}: {'; '.join(failures)}")
        return found

    @staticmethod
    def _values(found, test, result, seeds):
        return np.array([found[test, seed].result(result) if (test, seed) in found else math.nan for seed in seeds])


def search(measure, of, first):
    """surrogate.Solution: logarithms (4,) of UNKNOWNS at which the observables `of` are their targets. measure: (4,) ->
    {Observable: (packings,)}; first: (4,), where to begin."""
    problem = Problem(target=np.array([float(o.scaled(o.target)) for o in of]),
                      tolerance=np.array([o.tolerance for o in of]), low=first - SPAN, high=first + SPAN)
    slopes = np.array([SLOPES[o.kind] for o in of], float)
    return solve(lambda x: statistics(measure(x), COMMON_SEEDS), Surrogate(slopes[..., 0], slopes[..., 1]), problem,
                 start=first, most=SEARCHES, enough=ENOUGH)


def next_energy(tried, target):
    """J/m2: the fracture energy to try next. tried: [(energy, toughness)], the last one last; target: Pa sqrt(m).

    K^2 goes with the energy in a body without grains (Irwin); after two trials the power is theirs, within a half and
    four.
    """
    (energy, toughness), power = tried[-1], 2.0
    if len(tried) > 1:
        before, its = tried[-2]
        rise = math.log(toughness / its)
        power = min(max(math.log(energy / before) / rise, 0.5), 4.0) if rise else 4.0
    return energy * min(max((target / toughness)**power, 1 / LARGEST), LARGEST)


def fitted(laboratory, seeds, first):
    """Search and, where a toughness is aimed at and the fracture energy is free, change that and search again.

    laboratory: BlockLaboratory, whose `given` has the energy of the solution afterwards. -> (surrogate.Solution of the
    energy that came nearest, [(energy, mean toughness)] of those tried).
    """
    def searched(start):
        return search(lambda x: laboratory.measure(x, seeds), laboratory.observables, start)
    solution, tried, solutions = searched(first), [], []
    while laboratory.tough_target:
        energy = laboratory.parameters(solution.x)["bond_fracture_energy"]
        found = laboratory.toughness(solution.x, seeds)
        if np.isfinite(found).sum() < LEAST:
            break
        tried.append((energy, float(np.nanmean(found))))
        solutions.append(solution)
        if abs(tried[-1][1] / laboratory.tough_target - 1) <= TOUGH or len(tried) == TEARS:
            break
        laboratory.given["bond_fracture_energy"] = float(f"{next_energy(tried, laboratory.tough_target):.4g}")
        solution = searched(solution.x)
    if tried:
        nearest = min(range(len(tried)), key=lambda n: abs(math.log(tried[n][1] / laboratory.tough_target)))
        solution, laboratory.given["bond_fracture_energy"] = solutions[nearest], tried[nearest][0]
    return solution, tried


def with_space(data, given, *, radius, verdicts):
    """The rock file `data`, as JSON has it, with a part for space. given: {parameter: value}; verdicts: {Observable:
    Verdict}."""
    return {**data, "space": {"parameters": given, "resolution": {"radius": radius}, "measured": measured(verdicts)}}


def page(name, given, solution, tried, verdicts, *, radius):
    """Lines of in_space.md. tried: as `fitted` gives it."""
    missed = [o for o, one in verdicts.items() if not one.met]
    words = ", ".join(f"{o.name} is {shown(o, verdicts[o].mean)} ± {shown(o, verdicts[o].error)} instead of "
                      f"{shown(o, o.target)}{'' if verdicts[o].told else ', which these packings do not tell'}"
                      for o in missed)
    lines = [f"# {name} in space", "",
             f"Spheres of {1e3 * radius:g} mm in radius have {len(verdicts) - len(missed)} of the {len(verdicts)} "
             f"properties aimed at, on {CHECKS} packings that the search has not seen"
             f"{f'. **Not reached: {words}.**' if missed else '.'} Toughness, where the rock has a target for it, is "
             f"measured on {NOTCHES} of them{'.' if tried else ', and not fitted.'}", ""]
    lines += generated.table(
        ["", "test", "target", "mean ± standard deviation", "standard error", "difference", "allowed", "met"],
        [[o.name, o.test, shown(o, o.target), f"{shown(o, one.mean)} ± {shown(o, one.deviation)}", shown(o, one.error),
          off(o, [one.mean]), allowed(o), "yes" if one.met else "**no**" if one.told else "**not told**"]
         for o, one in verdicts.items()])
    lines += ["## Micro-parameters", "", *generated.table(["parameter", "value"], list(given.items()))]
    if tried:
        lines += ["## Toughness", "", "Packings of the search:", "", *generated.table(
            ["bond_fracture_energy, J/m²", "fracture_toughness"],
            [[f"{energy:.4g}", f"{1e-6 * toughness:.3g} MPa sqrt(m)"] for energy, toughness in tried])]
    lines += ["## Search", "", "Means of the same packings, the nearest last:", ""]
    return lines + generated.table(
        [*UNKNOWNS, *(o.name for o in verdicts if o.test != "toughness")],
        [[*(f"{value:.3g}" for value in np.exp(x)),
          *(shown(o, float(value if o.kind == "nu" else np.exp(value))) for o, value in zip(verdicts, y))]
         for x, y, _ in solution.steps])


def rock_of(values):
    """(the rock file as JSON has it, its RockFile). Raises ParameterError."""
    data, rock = plane_rock(values["rock"])
    law = rock.parts["plane"].parameters["bond_law"]
    require(law in LAWS, "rock", f"{values['rock']}, bond_law = {law}", f"a rock of {' or '.join(LAWS)} bonds")
    for name in ENERGIES:
        require(not values[name] or law == "cohesive", name, values[name], f"left out with bond_law = {law}", "J/m2")
    for name in ("youngs_modulus", "poissons_ratio", "ucs", "tensile_strength"):
        require(name in rock.targets, "rock", values["rock"], f"a rock with a target for {name}")
    return data, rock


def given_of(values):
    """{parameter: value} in place of the plane's."""
    edge = float(f"{values['grains'] * values['radius']:.4g}")
    return {**{name: values[name] for name in ENERGIES if values[name]},
            **({"grain_edge": edge, "grain_strength": values["grain_strength"]} if edge else {})}


def checked(laboratory, x, seeds):
    """{Observable: Verdict} on the packings `seeds`; the toughness last, where the rock has a target for it and at
    least two packings tell it."""
    found = laboratory.measure(x, seeds)
    target = laboratory.rock.targets.get("fracture_toughness")
    if target:
        toughness = laboratory.toughness(x, seeds[:NOTCHES])
        if np.isfinite(toughness).sum() >= LEAST:
            found[Observable("fracture_toughness", "toughness", "fracture_toughness", target, 0.1, "toughness",
                             "Pa sqrt(m)")] = toughness
    return {o: verdict(o, of) for o, of in found.items()}


def main(words):
    """-> exit code: 0 where every target is met; 3 where some are missed; 4 where packings scatter too much to tell; 2:
    options that cannot be used; 1: too few runs ended well."""
    command.help_if_asked()
    try:
        values = parameters.read(GROUPS, words)
        data, rock = rock_of(values)
        folder, runs_at = folders(values)
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    radius, seeds = values["radius"], range(1, 1 + values["packings"])
    unseen = [max(CHECKED, len(seeds)) + number for number in range(1, 1 + CHECKS)]
    try:
        with Runs(runs_at, at_once=values["jobs"], keep=True) as runs:
            laboratory = BlockLaboratory(runs=runs, rock=rock, radius=radius, given=given_of(values))
            solution, tried = fitted(laboratory, seeds, WITH_GRAINS if values["grains"] else FIRST)
            found = laboratory.parameters(solution.x)
            verdicts = checked(laboratory, solution.x, unseen)
    except (RunFailed, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    whole = with_space(data, found, radius=radius, verdicts=verdicts)
    (folder / "rock.json").write_text(json.dumps(whole, indent=1) + "\n", encoding="utf-8")
    generated.record(folder / "rock.json")
    print(generated.write_page(folder / "in_space.md",
                               page(data["name"], found, solution, tried, verdicts, radius=radius)))
    print(f"rock: {folder / 'rock.json'}")
    return exit_code(verdicts.values())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

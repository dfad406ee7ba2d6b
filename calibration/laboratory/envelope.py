"""The strength envelope of a rock: confined tests and direct tension, Mohr-Coulomb and Hoek-Brown, one figure.

    python3 -m calibration.laboratory.envelope DIR [--confinements 0,1e6,2e6,5e6,10e6] [--seeds 1,2,3]
                                               [--points FILE.csv] [--rock NAME|FILE] [--name value ...]

Runs yade_scripts/triaxial.py at each confinement (Pa) and yade_scripts/uniaxial.py in tension with each seed, two at a
time; finished runs are kept, so that an interrupted command resumes. Further names and values go to both scripts.
--points: peak stresses of a laboratory, a CSV file with columns sigma3... and sigma1... in Pa, or in kPa, MPa or GPa
where the header says so; those up to the largest confinement are fitted and drawn beside ours. Writes envelope.json,
envelope.md, envelope.png and provenance.json into DIR.
"""
import argparse
import json
import math
import sys
from pathlib import Path

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import RunFailed, Runs
from calibration.command import Parser, made
from calibration.laboratory import envelope_figure, strength_table
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import integer, listed, numbers
from rockwear.kernels.strength_envelope import Estimate, HoekBrown, MohrCoulomb, hoek_brown, mohr_coulomb
from rockwear.report import palette, plots

CONFINED, UNIAXIAL = "yade_scripts/triaxial.py", "yade_scripts/uniaxial.py"
CONFINEMENTS, SEEDS = "0,1e6,2e6,5e6,10e6", "1,2,3"
"""Pa, as [Bahaaddini 2018, fig. 10]."""
QUANTITIES = "peak_stress", "residual_stress", "youngs_modulus", "poissons_ratio", "failed"
ONLY_CONFINED = {"membrane_interval", "drop"}
"""Parameters that the test in tension does not take, or takes otherwise."""
MPA = 1e6


def measure(folder, *, confinements, seeds, at_once=2, **values):
    """The envelope that `fitted` gives, of tests in subfolders of `folder`; finished ones are kept.

    confinements: Pa; seeds: of the packings; values: {parameter: value} of all tests. Raises RunFailed, and
    ParameterError where the points have no envelope.
    """
    common = dict(report="false", snapshot_period=1, **values)
    pulled = {name: value for name, value in common.items() if name not in ONLY_CONFINED}
    with Runs(folder, at_once=at_once, keep=True) as runs:
        tension = [runs.start(f"tension-{seed}", UNIAXIAL, test="tension", seed=seed, **pulled) for seed in seeds]
        confined = {(confinement, seed): runs.start(f"{confinement:g}-{seed}", CONFINED, confinement=confinement,
                                                    seed=seed, **common)
                    for seed in seeds for confinement in confinements}
        points = [{"sigma3": confinement, "seed": seed, **{name: run.result().result(name) for name in QUANTITIES}}
                  for (confinement, seed), run in confined.items()]
        tension = [run.result().result("tensile_strength") for run in tension]
    return fitted(points, tension)


def fitted(points, tension=()):
    """{"points", "tensile_strengths", "mohr_coulomb", "hoek_brown"}: fits as {name: {"value", "half_width"}}.

    points: [{"sigma3": Pa, "peak_stress": Pa, ...}]; tension: Pa. Hoek-Brown counts the tests in tension as points;
    Mohr-Coulomb does not, because it ends in a cut-off. Raises ParameterError.
    """
    sigma3, sigma1 = ([point[name] for point in points] for name in ("sigma3", "peak_stress"))
    line = mohr_coulomb(sigma3, sigma1)
    found = {"points": points, "tensile_strengths": list(tension), "mohr_coulomb": _plain(line)}
    try:
        curve = hoek_brown(sigma3, sigma1, list(tension) or None)
        found["hoek_brown"] = {**_plain(curve), "tensile_strength": curve.tensile_strength}
    except ParameterError as error:
        # A sand, or points on a line: the line stands for itself.
        found["hoek_brown"] = {"refused": str(error)}
    return found


def _plain(fit):
    return {name: part._asdict() if hasattr(part, "_asdict") else part for name, part in fit._asdict().items()}


# ---- what is written


def _numbers(found):
    """The same, with None for what is not known: JSON has no nan."""
    if isinstance(found, dict):
        return {name: _numbers(one) for name, one in found.items()}
    if isinstance(found, (list, tuple)):
        return [_numbers(one) for one in found]
    return None if isinstance(found, float) and not math.isfinite(found) else found


def draw(ours, laboratory):
    """Figure of sigma1 over sigma3: tests, both fits, and the laboratory's."""
    shown = [envelope_figure.of_packings("simulated", palette.SIMULATED, ours["points"], ours["tensile_strengths"],
                                         fits_of(ours))]
    if laboratory:
        tests = tuple((point["sigma3"], point["peak_stress"]) for point in laboratory["points"])
        shown.append(envelope_figure.Strengths("laboratory", palette.PUBLISHED, tests=tests, fits=fits_of(laboratory)))
    return envelope_figure.figure(shown)


def fits_of(found):
    """(MohrCoulomb, HoekBrown) of what `fitted` gives, as far as they are there."""
    kinds = (MohrCoulomb, found["mohr_coulomb"]), (HoekBrown, found["hoek_brown"])
    return tuple(kind(*(Estimate(**part[name]) if isinstance(part[name], dict) else part[name]
                        for name in kind._fields)) for kind, part in kinds if "refused" not in part)


def page(ours, laboratory):
    """Lines of Markdown: the fits, then the tests."""
    fits = {"simulated": ours, **({"laboratory": laboratory} if laboratory else {})}
    lines = ["# Strength envelope", "", "± is half the 95 % confidence interval (Student's t).", ""]
    lines += generated.table(
        ["", "c, MPa", "φ, °", "m_i", "σci, MPa", "σt of the curve, MPa", "points"],
        [[what, *_pair(found["mohr_coulomb"], "cohesion", "friction_angle"), *_curve(found["hoek_brown"]),
          len(found["points"])] for what, found in fits.items()])
    for what, found in fits.items():
        if "refused" in found["hoek_brown"]:
            lines += [f"Hoek-Brown, {what}: {found['hoek_brown']['refused']}.", ""]
    tension = np.array(ours["tensile_strengths"])
    if len(tension):
        lines += [f"Direct tension: {tension.mean() / MPA:.3g} MPa in the mean of {len(tension)}, from "
                  f"{tension.min() / MPA:.3g} to {tension.max() / MPA:.3g}.", ""]
    lines += generated.table(
        ["σ3, MPa", "seed", "σ1 at the peak, MPa", "at the end", "E, GPa", "ν", "failed"],
        [[f"{p['sigma3'] / MPA:g}", p["seed"], f"{p['peak_stress'] / MPA:.4g}", f"{p['residual_stress'] / MPA:.4g}",
          f"{p['youngs_modulus'] / 1e9:.3g}", f"{p['poissons_ratio']:.3g}", "yes" if p["failed"] else "no"]
         for p in sorted(ours["points"], key=lambda point: (point["sigma3"], point["seed"]))])
    return [*lines, "![σ1 over σ3](envelope.png)"]


def _pair(fit, first, second):
    return [f"{fit[name]['value'] / scale:.3g}" + (
        f" ± {fit[name]['half_width'] / scale:.2g}" if math.isfinite(fit[name]["half_width"]) else "")
        for name, scale in ((first, MPA), (second, 1.0))]


def _curve(fit):
    if "refused" in fit:
        return ["-"] * 3
    return [*reversed(_pair(fit, "sigma_ci", "m_i")), f"{fit['tensile_strength'] / MPA:.3g}"]


def main(words):
    """Measure, fit, write. -> exit code."""
    parser = Parser(prog="python3 -m calibration.laboratory.envelope", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="DIR")
    for name, default in (("confinements", CONFINEMENTS), ("seeds", SEEDS), ("points", "")):
        parser.add_argument(f"--{name}", default=default)
    given, rest = parser.parse_known_args(words)
    try:
        confinements = listed(numbers(strength_table.CONFINEMENT)("confinements", given.confinements, "Pa"))
        seeds = [int(seed) for seed in listed(numbers(integer(0))("seeds", given.seeds, ""))]
        for name, found in (("confinements", confinements), ("seeds", seeds)):
            require(len(set(found)) == len(found), name, getattr(given, name), "each given once")
        require(len(confinements) > 1, "confinements", given.confinements, "at least two", "Pa")
        require(len(rest) % 2 == 0 and all(name.startswith("--") for name in rest[::2]), "arguments", " ".join(rest),
                "pairs of --name value")
        rows = strength_table.read(given.points, "points") if given.points else []
        laboratory = [{"sigma3": least, "peak_stress": largest} for least, largest in rows
                      if least <= max(confinements)]
        laboratory = fitted(laboratory) if laboratory else None
        ours = measure(made(given.folder, "DIR"), confinements=confinements, seeds=seeds,
                       **{name[2:]: value for name, value in zip(rest[::2], rest[1::2])})
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except RunFailed as error:
        print(f"error: {error}", file=sys.stderr)
        return 2 if error.code == 2 else 1
    written = given.folder / "envelope.json", given.folder / "envelope.png"
    written[0].write_text(json.dumps(_numbers({"simulated": ours, "laboratory": laboratory}), indent=1,
                                     allow_nan=False) + "\n", encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        draw(ours, laboratory).savefig(written[1])
    generated.record(*written)
    print(generated.write_page(given.folder / "envelope.md", page(ours, laboratory)))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""A rock's measured strengths over confinement beside those that its file asks for: a figure and a table.

    python3 -m calibration.fitting.rock_envelope NAME|FILE [--points FILE.csv] [--out DIR]

Runs nothing: what was measured is in the rock's file. --points: single tests of a laboratory, a CSV file with columns
sigma3... and sigma1... (Pa, or as their heads say), drawn in place of the targets. Writes NAME_envelope.png and
provenance.json into DIR (the present folder if not given). Its lower half has how far strengths are off the targets,
or, where these are a friction angle alone, off its line; shaded is what a fit allows. Fits go through strengths up to
1.5 times UCS, above which a rock is ductile.
"""
import argparse
import math
import sys
from pathlib import Path

import matplotlib
import numpy as np

from calibration import generated
from calibration.command import Parser, made
from calibration.fitting.rock_targets import HIGHEST
from calibration.laboratory import envelope_figure, strength_table
from calibration.laboratory.envelope_figure import Mean, Reference, Strengths
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.strength_envelope import Estimate, HoekBrown, MohrCoulomb
from rockwear.model import rock_file
from rockwear.report import palette, plots
from rockwear.run.parameters import file_name
from rockwear.scenes.parameters import OF_ROCK

MPA = 1e6
ALLOWED, ALLOWED_DUCTILE = 5.0, 10.0
"""% by which a fit may be off, up to HIGHEST times UCS and above."""


def measured(part, most):
    """Strengths of what was measured of a rock_file.Part; fits up to sigma3 = most, Pa."""
    found = {name: (entry["mean"], entry["standard_deviation"], entry["packings"])
             for name, entry in part.measured.items()}
    pairs, deviations, packings = found["triaxial"]
    means = [Mean(*pair, deviation, packings) for pair, deviation in zip(pairs, deviations)]
    if "ucs" in found:
        means.insert(0, Mean(0.0, *found["ucs"]))
    fits = envelope_figure.through([mean[:2] for mean in means if mean.sigma3 <= most])
    if "tensile_strength" in found:
        strength, _, packings = found["tensile_strength"]
        means.insert(0, Mean(-strength, 0.0, math.nan, packings))
    return Strengths("simulated", palette.SIMULATED, means=tuple(means), fits=fits, most=most)


def wanted(targets, most, tests=()):
    """(Strengths, Reference) of targets {property: value}; tests: ((sigma3, sigma1), ...) drawn in their place.

    Fits are the stated ones, or go through the targets up to sigma3 = most, Pa. Raises ParameterError (rock).
    """
    points = [pair for pair in [(0.0, targets.get("ucs", 0.0)), *sorted(targets.get("triaxial", []))] if pair[1]]
    fits = stated(targets) or envelope_figure.through([pair for pair in points if pair[0] <= most])
    tension = [(-targets["tensile_strength"], 0.0)] if "tensile_strength" in targets else []
    shown = Strengths("laboratory", palette.PUBLISHED, tests=(*tension, *(tests or points)), fits=fits, most=most)
    if "triaxial" in targets:
        allowed = (most, ALLOWED), (math.inf, ALLOWED_DUCTILE)
        return shown, Reference("target", lambda sigma3: np.interp(sigma3, *np.transpose(points)), allowed, False)
    require(fits and isinstance(fits[0], MohrCoulomb), "rock", ", ".join(targets) or "no targets",
            "a rock with targets of triaxial strengths or friction_angle")
    return shown, Reference("the laboratory's line", fits[0].sigma1, ((most, ALLOWED),))


def stated(targets):
    """(MohrCoulomb, HoekBrown) of targets {property: value}, as far as they have their numbers; without a cohesion the
    line begins at UCS."""
    found = []
    if "friction_angle" in targets and {"cohesion", "ucs"} & set(targets):
        angle = targets["friction_angle"]
        cohesion = targets.get("cohesion") or 0.5 * targets["ucs"] / math.tan(math.radians(45 + 0.5 * angle))
        found.append(MohrCoulomb(Estimate(cohesion, math.nan), Estimate(angle, math.nan), math.nan))
    if targets.keys() >= {"hoek_brown_m", "hoek_brown_sigma_ci"}:
        numbers = (Estimate(targets[name], math.nan) for name in ("hoek_brown_m", "hoek_brown_sigma_ci"))
        found.append(HoekBrown(*numbers, math.nan))
    return tuple(found)


def compared(rock, tests=()):
    """(Strengths of the laboratory, of the rock, Reference) of a RockFile. Raises ParameterError (rock)."""
    part = next((part for part in rock.parts.values() if "triaxial" in part.measured), None)
    require(part, "rock", rock.name, "a rock with measured triaxial strengths")
    ucs = rock.targets.get("ucs") or part.measured.get("ucs", {}).get("mean")
    most = HIGHEST * ucs if ucs else math.inf
    laboratory, reference = wanted(rock.targets, most, tests)
    return laboratory, measured(part, most), reference


def draw(laboratory, ours, reference):
    """Figure of what `compared` gives."""
    drawn = envelope_figure.figure([ours, laboratory], reference)
    if ours.most < max(mean.sigma3 for mean in ours.means):
        for axes in drawn.axes:
            axes.axvline(ours.most / MPA, color=palette.GUIDE, linestyle=":")
        upper = drawn.axes[0]
        upper.text(ours.most / MPA, 1.0, f" {HIGHEST:g} UCS: ductile beyond, no fit", fontsize=9, color=palette.REMARK,
                   transform=upper.get_xaxis_transform(), va="top")
    return drawn


def table(ours, reference):
    """Lines: measured strengths, and how far they are off the reference."""
    means = [mean for mean in ours.means if mean.sigma3 >= 0]
    return generated.table(
        ["σ3, MPa", f"{reference.words}, MPa", "simulated, MPa", "± standard deviation", "packings",
         "off ± standard error"],
        [[f"{mean.sigma3 / MPA:g}", f"{float(reference.sigma1(mean.sigma3)) / MPA:.1f}", f"{mean.sigma1 / MPA:.1f}",
          f"{mean.deviation / MPA:.1f}", mean.tests, f"{difference:+.1f} ± {error:.1f} %"]
         for mean, (_, difference, error) in zip(means, envelope_figure.off(means, reference.sigma1))])


def main(words):
    """-> exit code."""
    parser = Parser(prog="python3 -m calibration.fitting.rock_envelope", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rock", metavar="NAME|FILE")
    parser.add_argument("--points", metavar="FILE.csv")
    parser.add_argument("--out", type=Path, metavar="DIR", default=Path())
    given = parser.parse_args(words)
    try:
        rock = rock_file.read(rock_file.find(given.rock), OF_ROCK)
        tests = tuple(strength_table.read(given.points, "points")) if given.points else ()
        found = compared(rock, tests)
        written = made(given.out) / f"{file_name(rock.name)}_envelope.png"
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    try:
        with matplotlib.rc_context(plots.STYLE):
            draw(*found).savefig(written)
        generated.record(written)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print("\n".join(table(*found[1:])))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

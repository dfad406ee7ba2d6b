"""Fits the rocks of the library to their sources' numbers, and writes the table of measured against target.

    python3 -m calibration.campaigns.library DIR [NAME ...]     fits, one after another; DIR/NAME/rock.json, fit.md
    python3 -m calibration.campaigns.library DIR --read         the table alone, of the rocks in rockwear/rocks

An interrupted fit resumes. A rock that is good is put into the library by copying its file. Writes DIR/rocks.md.
"""
import sys

from calibration import command, generated
from calibration.fitting import rock_fit
from rockwear.kernels.checks import ParameterError
from rockwear.model import rock_file
from rockwear.scenes.parameters import OF_ROCK

ROCKS = {
    "p_sandstone": {"youngs_modulus": 18e9, "poissons_ratio": 0.18, "ucs": 60e6, "tensile_strength": 7e6,
                    "source": "[Rojek 2014, 5.1]"},
    "medium_sandstone": {"youngs_modulus": 13e9, "poissons_ratio": 0.25, "ucs": 50e6, "tensile_strength": 4.2e6,
                         "fracture_toughness": 0.6e6, "radius_min": 0.25e-3, "radius_max": 0.375e-3,
                         "start": "medium_sandstone", "first_stage": "check", "source": "a medium sandstone, ours"}}
"""{name: options of calibration.fit}."""


def words_of(name, folder):
    """Command line of a fit."""
    given = {**ROCKS[name], "name": name, "out": str(folder / name)}
    return [word for option, value in given.items() for word in (f"--{option}", str(value))]


def table():
    """Lines: what each rock of the library is to be and what the laboratory measured of that, and beside."""
    rows = []
    for name in rock_file.library():
        rock = rock_file.read(rock_file.find(name), OF_ROCK)
        for kind, part in rock.parts.items():
            rows += [row(name, kind, quantity, rock.targets.get(quantity), part.measured.get(quantity))
                     for quantity in (*part.measured, *(target for target in rock.targets
                                                        if target not in part.measured))]
    return generated.table(["rock", "in", "property", "target", "measured", "± standard deviation", "difference",
                            "packings", "unit"], rows)


def row(name, kind, quantity, target, found):
    """Cells of a property. found: its entry in the rock's file, None where it was not measured."""
    unit = rock_file.PROPERTIES[quantity][0]
    if found is None:
        return [name, kind, quantity, shown(target), "not measured", "–", "–", "–", unit]
    return [name, kind, quantity, shown(target), shown(found["mean"]), shown(found["standard_deviation"]),
            difference(target, found["mean"]), found["packings"], unit]


def shown(value):
    """A number, or pairs of them."""
    if value is None:
        return "–"
    return "; ".join(" at ".join(f"{one:.4g}" for one in reversed(pair)) if isinstance(pair, tuple) else f"{pair:.4g}"
                     for pair in (value if isinstance(value, list) else [value]))


def difference(target, mean):
    """Words on mean over target, of triaxial strengths at each confinement that has both."""
    if target is None:
        return "–"
    if isinstance(target, list):
        sought = dict(target)
        return "; ".join(difference(sought.get(least), largest) for least, largest in mean)
    return f"{100 * (mean / target - 1):+.1f} %"


def main(folder, words):
    """-> exit code: the largest of the fits."""
    codes = [0]
    if "--read" not in words:
        for name in words or ROCKS:
            print(f"{name}:", flush=True)
            codes.append(rock_fit.main(words_of(name, folder)))
    folder.mkdir(parents=True, exist_ok=True)
    try:
        print(generated.write_page(folder / "rocks.md", table()))
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        codes.append(2)
    return max(codes)


if __name__ == "__main__":
    command.help_if_asked()
    known = *ROCKS, "--read"
    (place,), given = command.split(sys.argv[1:], __spec__.name, f"DIR [{'] ['.join(known)}]", known=known)
    sys.exit(main(place, given))

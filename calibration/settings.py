"""Settings of a steady cut for an accuracy that is asked for, those that cost least, from what a campaign measured.

    python3 -m calibration.settings --accuracy 0.3 [--depth_of_cut 5e-3] [--of specific_energy,wear,temperature]

A setting (discs in the depth of cut, speed, window) is off by what `campaigns.steady_cut` found it to move, beside
sixteen discs at 8 m/s, at which all were cut, and one cut by its length: its error falls as one over the root of
that. Both together make the accuracy, a part of the mean. How far sixteen discs are off themselves is not known:
nothing finer was cut. Prints the command of the cut, which ends by itself when its mean force is known well enough
and was at two thirds of its way, and what it costs.
"""
import json
import math
import sys
from pathlib import Path

from calibration import command
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import Group, Parameter, number, text
from rockwear.kernels.steady_record import HELD, LONG_ENOUGH
from rockwear.run import parameters

MEASURED = Path(__file__).parent / "results" / "steady_settings.json"
"""What campaigns.steady_cut writes."""
QUANTITIES = "specific_energy", "wear", "temperature"
LONGEST = 2
"""Times as long as expected, at which a cut ends that does not know its mean force by then."""
TIP = 0.1
"""Radius of the tool's tip over the depth of cut, of the cuts that were measured."""
GROUP = Group("settings", (
    Parameter("accuracy", 0.3, "", number(0.01, 1), "part of the mean by which results may be off"),
    Parameter("depth_of_cut", 5e-3, "m", number(1e-4, 0.1), "of the cut"),
    Parameter("of", "specific_energy,wear", "", text, "what is to be so accurate beside the specific energy, out of "
              + ", ".join(QUANTITIES))))


def choose(rows, *, accuracy, quantities):
    """(row, depths of cut, error of the setting, error of the length) of the cheapest setting.

    rows: of steady_settings.json; quantities: names of its errors. Raises ParameterError where no setting is as
    accurate.
    """
    found, least = [], math.inf
    for row in rows:
        errors = [row["errors"][name] for name in quantities]
        if None not in errors:
            off = max(errors)
            least = min(least, off)
            if off < accuracy:
                of_length = math.sqrt(accuracy**2 - off**2)
                needed = max(LONG_ENOUGH, row["depths_for_tenth"] * (0.1 / of_length)**2)
                depths = math.ceil(needed / HELD)
                found.append((depths * row["minutes_per_depth"], depths, off, of_length, row))
    require(found, "accuracy", accuracy, f"above {least:.2g}, which the best setting that was measured reaches in "
            f"{', '.join(quantities)}")
    _, depths, off, of_length, row = min(found, key=lambda one: one[0])
    return row, depths, off, of_length


def shown(row, depths, off, of_length, *, depth, quantities):
    """Lines: the command, and what is to be expected of it. depth: m, of the cut; quantities: names out of QUANTITIES.
    """
    values = {"depth_of_cut": depth, "tip_radius": TIP * depth, **row["options"],
              **{name: part * depth for name, part in row["lengths"].items()},
              "accuracy": round(of_length, 3), "cut_length": LONGEST * depths * depth,
              **({"heat": "true"} if "temperature" in quantities else {})}
    words = " ".join(f"--{name} {value:.6g}" if isinstance(value, (int, float)) else f"--{name} {value}"
                     for name, value in values.items())
    return [f"yade -n -x -j1 yade_scripts/steady_cut.py {words}",
            f"{row['setting']}: off by {100 * off:.0f} % beside sixteen discs at the same speed, by "
            f"{100 * of_length:.0f} % for its length, some {depths} depths of cut; "
            f"{depths * row['minutes_per_depth']:.0f} minutes"]


def main(words):
    """-> exit code."""
    command.help_if_asked()
    try:
        v = parameters.read([GROUP], words)
        # A cut with another force is another cut, whatever else of it may agree.
        quantities = list(dict.fromkeys((QUANTITIES[0], *(name.strip() for name in v["of"].split(",")))))
        unknown = [name for name in quantities if name not in QUANTITIES]
        require(not unknown, "of", v["of"], f"names out of {', '.join(QUANTITIES)}, with commas")
        rows = json.loads(MEASURED.read_text(encoding="utf-8"))
        print("\n".join(shown(*choose(rows, accuracy=v["accuracy"], quantities=quantities), depth=v["depth_of_cut"],
                              quantities=quantities)))
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

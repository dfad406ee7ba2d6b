"""Admissible loading speed of a specimen: strength and E over the platens' speed, against the slowest.

    python3 -m calibration.benchmarks.loading_speed DIR        (part of make bench)

Two sets of bonds (campaigns.uniaxial.ROCKS), in compression and tension, over a decade and a half of speeds. The speed
matters, not the rate of strain: the error grows with the time that a wave takes through the specimen, which is
proportional to the specimen's size, while the rate of strain is inversely proportional to it. So 525 discs are enough.
"""
import json

import matplotlib
import numpy as np

from calibration import generated
from calibration.benchmarks import one_curve
from calibration.campaigns.runs import Runs
from calibration.campaigns.uniaxial import ROCKS, SCRIPT, SMALL, TESTS, folder_of
from rockwear.report import plots

SPEEDS = [0.4, 0.2, 0.1, 0.05, 0.025, 0.0125]
SEEDS = 1, 2
QUANTITIES = {"peak_stress": "strength", "youngs_modulus": "E"}
TOLERANCE = 0.02
DEFAULT = 0.05


def measure(folder, at_once=2):
    """{(rock, test, quantity): (seeds, speeds) values in Pa}; finished runs are kept."""
    with Runs(folder, at_once=at_once, keep=True) as runs:
        jobs = {(rock, test, seed, speed): runs.start(
                    folder_of(rock, test, f"{seed}-{speed:g}"), SCRIPT, test=test, seed=seed, speed=speed,
                    report="false", snapshot_period=1, **{**SMALL, **values})
                for seed in SEEDS for speed in SPEEDS for rock, values in ROCKS.items() for test in TESTS}
        found = {key: job.result() for key, job in jobs.items()}
    return {(rock, test, quantity): np.array(
                [[found[rock, test, seed, speed].result(quantity) for speed in SPEEDS] for seed in SEEDS])
            for rock in ROCKS for test in TESTS for quantity in QUANTITIES}


def deviations(measured):
    """Rows {rock, test, quantity, speed, deviation, low, high}: from the slowest, mean and range over the packings."""
    rows = []
    for (rock, test, quantity), values in measured.items():
        off = values / values[:, -1:] - 1
        for k, speed in enumerate(SPEEDS):
            rows.append({"rock": rock, "test": test, "quantity": QUANTITIES[quantity], "speed": speed,
                         "deviation": float(off[:, k].mean()), "low": float(off[:, k].min()),
                         "high": float(off[:, k].max())})
    return rows


def fastest(rows, tolerance=TOLERANCE):
    """The highest speed at which, and below which, every packing's deviation is within the tolerance."""
    good = SPEEDS[-1]
    for speed in reversed(SPEEDS):
        if any(max(-row["low"], row["high"]) > tolerance for row in rows if row["speed"] == speed):
            break
        good = speed
    return good


def draw(rows):
    """A panel a test: deviation of strength and E over the speed, both rocks."""
    figure, panels = plots.canvas(10, 4, 1, 2, sharey=True)
    for axes, test in zip(panels, TESTS):
        axes.axhspan(-100 * TOLERANCE, 100 * TOLERANCE, color="#e8f0e4", zorder=-5)
        axes.axvline(DEFAULT, color="0.3", linestyle=":", linewidth=1)
        for rock, colour in zip(ROCKS, ("#b5541c", "#2d6a9f")):
            for quantity, style in (("strength", "o-"), ("E", "s--")):
                chosen = [row for row in rows if (row["rock"], row["test"], row["quantity"]) == (rock, test, quantity)]
                mean, low, high = (100 * np.array([row[name] for row in chosen])
                                   for name in ("deviation", "low", "high"))
                axes.errorbar([row["speed"] for row in chosen], mean, [mean - low, high - mean], fmt=style,
                              color=colour, capsize=3, markersize=4, alpha=1 if quantity == "strength" else 0.5,
                              label=f"[{rock}], {quantity}")
        axes.set(xscale="log", xlabel="speed of each platen, m/s", title=test)
        axes.set_xticks(SPEEDS, [f"{speed:g}" for speed in SPEEDS])
        axes.minorticks_off()
        axes.text(DEFAULT, 0.98, " default", transform=axes.get_xaxis_transform(), va="top", fontsize=9)
    panels[0].set_ylabel(f"deviation from {SPEEDS[-1]:g} m/s, %")
    panels[0].legend(loc="upper left", fontsize=9)
    return figure


def table(rows):
    """The deviations, as lines of Markdown."""
    cells = {}
    for row in rows:
        cells.setdefault((row["rock"], row["test"], row["quantity"]), []).append(
            f"{100 * row['deviation']:+.1f} ({100 * row['low']:+.1f} … {100 * row['high']:+.1f})")
    return ["## Speed of loading", "",
            f"Deviation from {SPEEDS[-1]:g} m/s in %, mean and range of {len(SEEDS)} packings of 525 discs. The "
            f"fastest speed within {100 * TOLERANCE:g} % for every packing: {fastest(rows):g} m/s.", "",
            *generated.table(
                ["m/s", *(f"{speed:g}" for speed in SPEEDS)],
                [[f"bonds of [{rock}], {test}, {quantity}", *found]
                 for (rock, test, quantity), found in cells.items()])]


def curve(folder):
    """Run what is missing, draw loading_speed.png, write loading_speed.json. -> lines of Markdown."""
    rows = deviations(measure(folder / "runs"))
    files = folder / "loading_speed.json", folder / "loading_speed.png"
    files[0].write_text(json.dumps(rows, indent=1), encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        draw(rows).savefig(files[1])
    generated.record(*files)
    return table(rows)


if __name__ == "__main__":
    one_curve.main(curve)

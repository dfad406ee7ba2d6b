"""Whether a rock's toughness is its own or that of its specimen: similar specimens of several sizes, the same discs.

    python3 -m calibration.campaigns.toughness_size DIR [ROCK ...] [--read] [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Writes into DIR
toughness_size.md (a table a rock), toughness_size.png and provenance.json.
"""
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns import rock_laws
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from rockwear.kernels.fracture import size_effect
from rockwear.report import palette, plots

SEEDS = 1, 2, 3
COARSE, FINE = dict(radius_min=1e-3, radius_max=1.5e-3), dict(radius_min=2.5e-4, radius_max=3.75e-4)
ROCKS = {"cohesive": {**rock_laws.ROCK, **COARSE}, "grains, edge 3 mm": {**rock_laws.GRAINS, **COARSE},
         **{name: {"rock": name, **FINE} for name in ("medium_sandstone", "crushing_sandstone")}}
"""{rock: parameters}: two of campaigns.rock_laws, and two of the library at the radii of their files."""
OVER_RADIUS = 27, 53, 107
"""Sizes W of the specimens over the largest radius; the smallest is what a fit takes at least, and the largest has
some 7,000 discs."""
DRIVEN, PEAK = "K_IC, MPa√m", "K at the peak force, MPa√m"
QUANTITIES = {DRIVEN: ("fracture_toughness", 1e-6), "G_f, J/m²": ("fracture_energy", 1.0),
              PEAK: ("peak_toughness", 1e-6)}
"""{heading: (result, its unit)}."""


def sizes(rock):
    """(k,) m, W of the specimens of a rock."""
    return [float(f"{over * ROCKS[rock]['radius_max']:.3g}") for over in OVER_RADIUS]


def plan(rocks):
    """{(rock, W, seed): (folder, parameters)}, the small ones first."""
    return {(rock, size, seed): (rock_laws.folder_of(rock, f"{1e3 * size:g}mm", seed),
                                 dict(ROCKS[rock], size=size, seed=seed, report="false", snapshot_period=1))
            for number in range(len(OVER_RADIUS)) for seed in SEEDS for rock in rocks for size in [sizes(rock)[number]]}


def measured(folder, rocks):
    """{rock: {W: {heading: (packings,) values}}} of the runs that exist."""
    found = {}
    for (rock, size, _), run in existing({key: folder / name for key, (name, _) in plan(rocks).items()}).items():
        of = found.setdefault(rock, {}).setdefault(size, {})
        for heading, (result, unit) in QUANTITIES.items():
            of.setdefault(heading, []).append(unit * run.result(result))
    return {rock: dict(sorted(of.items())) for rock, of in found.items()}


def rows(of):
    """Rows of the table of a rock."""
    return [[f"{1e3 * size:g}", len(values[PEAK]), *map(generated.mean_cell, values.values())]
            for size, values in of.items()]


def without_end(of):
    """(K, MPa√m, W_0, mm) of `size_effect`; (nan, nan) of fewer than two sizes."""
    if len(of) < 2:
        return math.nan, math.nan
    K, W_0 = size_effect(list(of), [np.mean(values[PEAK]) for values in of.values()])
    return K, 1e3 * W_0


def figure(found):
    """K at the peak force and from the energy, over the size, a panel a rock."""
    drawn, panels = plots.canvas(3 * len(found) + 1, 4, 1, len(found))
    for axes, (rock, of) in zip(panels, found.items()):
        for heading, colour in zip((DRIVEN, PEAK), palette.OTHER_LINES):
            values = [sized[heading] for sized in of.values()]
            mean, deviation = [list(map(of_packings, values)) for of_packings in (np.mean, np.std)]
            axes.errorbar([1e3 * size for size in of], mean, deviation, fmt="o-", color=colour, capsize=3,
                          label="from the energy" if heading != PEAK else "at the peak force")
        axes.set(xscale="log", xlabel="W / mm", title=rock)
        axes.set_xticks([1e3 * size for size in of], [f"{1e3 * size:g}" for size in of])
        axes.minorticks_off()
        axes.set_ylim(bottom=0)
    panels[0].set_ylabel("K / MPa√m")
    panels[0].legend()
    return drawn


def write(folder, rocks):
    """Table and figure of the runs that exist. -> the table, in Markdown."""
    found = measured(folder, rocks)
    lines = ["Mean ± standard error over packings. K_IC is that of the energy which a driven crack takes. K at the "
             "peak force goes to that of a specimen without end as sqrt(W/(W + W_0)) (Bažant's law of size).", ""]
    for rock, of in found.items():
        K, W_0 = without_end(of)
        lines += [f"## {rock}", "", *generated.table(["W, mm", "packings", *QUANTITIES], rows(of))]
        lines += [f"Without end {K:.3g} MPa√m at the peak force, W_0 = {W_0:.3g} mm." if math.isfinite(K) else
                  "What K at the peak force goes to, these sizes do not tell.", ""]
    with matplotlib.rc_context(plots.STYLE):
        if found:
            figure(found).savefig(folder / "toughness_size.png")
            generated.record(folder / "toughness_size.png")
    return generated.write_page(folder / "toughness_size.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed, rocks = 0, [word for word in words if word in ROCKS] or list(ROCKS)
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(name, rock_laws.TOUGHNESS, **values)
                    for key, (name, values) in plan(rocks).items()}
            failed = wait_for(jobs, lambda key, run: "{}, W = {:g} m, packing {}".format(*key))
    print(write(folder, rocks))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, ROCKS)
    sys.exit(main(place, words, **where))

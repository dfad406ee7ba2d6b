"""What bond laws and rock properties do to a rock, and whether a rock stays the same as its discs become finer.

    python3 -m calibration.campaigns.rock_laws DIR [laws|resolution|softening|kept|powers|graded|relations ...] [--read]
        [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Writes into DIR rock_laws.md
(tables), rock_laws.csv, resolution.png, relations.json, relations.png and provenance.json.
"""
import csv
import json
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns import rock_relations
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from rockwear.report import palette, plots

UNIAXIAL, CONFINED, TOUGHNESS = (f"yade_scripts/{name}.py" for name in ("uniaxial", "triaxial", "toughness"))
CONFINED_AT = 10e6
"""Pa."""

ROCK = dict(kn=20e9, kt=8e9, mu=0.8, bond_law="cohesive", bond_tension=7e6, bond_cohesion=20e6,
            bond_fracture_energy=30.0)
"""A sandstone to begin with, of softening bonds; all discs of 1 to 1.5 mm."""
GRAINS = dict(ROCK, grain_edge=3e-3)
BOX, SMALL_BOX, LARGE_BOX = (dict(width=2 * height, height=height) for height in (0.04, 0.03, 0.06))
"""Loaded along their length; 650, 330 and 1,300 discs of 1 to 1.5 mm, the small one for the finest discs' sake: 5,600.
"""
SPEED, PULL = 0.04, 0.02
"""Of each platen, m/s."""
SIZE, SMALL_SIZE = 0.08, 0.04
"""Of the toughness specimen, m."""
SUDDEN = dict(speed=0.01, record_strain=1e-6)
"""How toughness specimens of brittle bonds are pulled (m/s): their cracks run so fast that the usual records miss them.
"""

LAWS = {
    "cohesive": ROCK,
    "fracture energy 10 J/m²": dict(ROCK, bond_fracture_energy=10.0),
    "fracture energy 100 J/m²": dict(ROCK, bond_fracture_energy=100.0),
    "cohesion doubled": dict(ROCK, bond_cohesion=40e6),
    "friction 0.4": dict(ROCK, mu=0.4),
    "Weibull modulus 4": dict(ROCK, weibull_modulus=4.0),
    "Weibull modulus 2": dict(ROCK, weibull_modulus=2.0),
    "bonding gap 0": dict(ROCK, bonding_gap=0.0),
    "bonding gap 0.3 mm": dict(ROCK, bonding_gap=3e-4),
    "no rotation": dict(ROCK, rotation="blocked"),
    "shear energy 300 J/m²": dict(ROCK, bond_shear_energy=300.0),
    "crushing at 75 MPa": dict(ROCK, bond_crushing=75e6),
    "Coulomb, brittle": {name: value for name, value in dict(ROCK, bond_law="coulomb").items()
                         if name != "bond_fracture_energy"},
    "grains, edge 2 mm": dict(ROCK, grain_edge=2e-3),
    "grains, edge 3 mm": GRAINS,
    "grains, edge 4 mm": dict(ROCK, grain_edge=4e-3),
    "grains 3 mm, friction 0.4": dict(GRAINS, mu=0.4),
    "grains 3 mm, Weibull modulus 3": dict(GRAINS, weibull_modulus=3.0),
    "grains 3 mm, shear energy 300 J/m²": dict(GRAINS, bond_shear_energy=300.0),
    "grains 3 mm, crushing at 150 MPa": dict(GRAINS, bond_crushing=150e6),
    "grains 3 mm, crushing at 300 MPa": dict(GRAINS, bond_crushing=300e6),
    "grains 3 mm that break at 2 times": dict(GRAINS, grain_strength=2.0),
    "grains 3 mm that break at 5 times": dict(GRAINS, grain_strength=5.0),
    "grains 3 mm, Coulomb, brittle": {name: value for name, value in dict(GRAINS, bond_law="coulomb").items()
                                      if name != "bond_fracture_energy"},
}
"""One change at a time."""

COARSEST = 1.5e-3
"""m, largest radius of the rocks but KEPT."""
FINENESS = {1.25: 1.0, 0.6: 0.48, 0.3: 0.24}
"""{mean radius, mm: factor on all lengths of the packing and of its grains}."""
POWER = 0.12
"""Of the radius, with which the strengths of bare discs grow so that UCS and tensile strength stay. By hand, from the
softening campaign: UCS then goes as radius^-0.05, tensile strength as radius^0.03."""


KEPT, KEPT_RADII = "crushing_sandstone", (0.25e-3, 0.375e-3)
"""A rock whose strengths follow the radius, and the radii (m) of its file."""
KEPT_BOX, KEPT_SIZE = dict(width=0.04, height=0.02), 0.02
"""Of its specimens at those radii; they are as much larger or smaller as the discs are, for it is the radius over the
length E G_f/strength^2 of the rock that counts."""

GRADINGS, GRADED_BOX, GRADED_SIZE = (1.0, 2.0, 3.0), dict(width=0.08, height=0.06), 0.04
"""Factors by which radii grow below a quarter of a specimen's height over as much again, on a side that is not loaded,
and ahead of the crack from the coarse discs to the fine ones."""


def at_size(values, factor, power=0.0):
    """Values of a rock whose packing is `factor` times as coarse. The fracture energy and stresses are the rock's, the
    strengths of its bonds but for that power of the factor."""
    lengths = {"radius_min": 1e-3, "radius_max": COARSEST, "bonding_gap": 1e-4,
               **{name: values[name] for name in ("bonding_gap", "grain_edge") if name in values}}
    strengths = {name: values[name] * factor**power for name in ("bond_tension", "bond_cohesion")}
    return {**values, **{name: float(f"{value:.6g}") for name, value in strengths.items()},
            **{name: float(f"{factor * length:.6g}") for name, length in lengths.items()}}


CASES = {
    "laws": (LAWS, (1, 2, 3), (0.0, CONFINED_AT)),
    "resolution": ({f"{kind}, r = {radius:g} mm": at_size(values, factor) for kind, values in
                    (("discs", ROCK), ("grains", GRAINS)) for radius, factor in FINENESS.items()},
                   (1, 2, 3, 4, 5), (0.0,)),
    "softening": ({f"{energy:g} J/m²": dict(ROCK, bond_fracture_energy=energy)
                   for energy in (30.0, 62.5, 125.0, 250.0)}, (1, 2, 3, 4, 5), (0.0,)),
    "kept": ({f"{KEPT}, r = {500 * factor * sum(KEPT_RADII):.3g} mm": dict(
        rock=KEPT, radius_min=factor * KEPT_RADII[0], radius_max=factor * KEPT_RADII[1]) for factor in (2.0, 1.0, 0.5)},
             (1, 2, 3, 4, 5), (0.0,)),
    "powers": ({f"strengths as radius^{POWER:g}, r = {radius:g} mm": at_size(ROCK, factor, POWER)
                for radius, factor in FINENESS.items()}, (1, 2, 3, 4, 5), (0.0,)),
    "graded": ({f"0.6 mm, graded by {grading:g}": dict(
        at_size(ROCK, FINENESS[0.6], POWER), grading_factor=grading, bond_tension_power=POWER,
        bond_cohesion_power=POWER) for grading in GRADINGS}, (1, 2, 3, 4, 5), (0.0,)),
    "relations": (rock_relations.cases(ROCK), rock_relations.SEEDS, (0.0,)),
}
"""{campaign: (cases, seeds, confinements)}."""
QUANTITIES = {"coordination": (1, ""), "E": (1e-9, "GPa"), "nu": (1, ""), "UCS": (1e-6, "MPa"),
              "tension": (1e-6, "MPa"), "ratio": (1, ""), "phi": (1, "°"), "m_i": (1, ""), "K": (1e-6, "MPa√m"),
              "G": (1, "J/m²")}
HEADS = {"coordination": "coordination", "E": "E, GPa", "nu": "ν", "UCS": "UCS, MPa", "tension": "σt, MPa",
         "ratio": "UCS/σt", "phi": "φ, °", "m_i": "m_i", "K": "K_IC, MPa√m", "G": "G_f, J/m²"}


def tests(campaign, values, seed):
    """{test: (script, parameters)} of one packing of a rock."""
    confinements, blocked = CASES[campaign][2], values.get("rotation")
    box, size = {"resolution": (SMALL_BOX, SMALL_SIZE), "softening": (LARGE_BOX, None),
                 "kept": (KEPT_BOX, KEPT_SIZE), "graded": (GRADED_BOX, GRADED_SIZE)}.get(campaign, (BOX, SIZE))
    coarsest = {"kept": KEPT_RADII[1], "powers": COARSEST}.get(campaign)
    if coarsest:
        # The same packings at all radii.
        factor = values["radius_max"] / coarsest
        box = {side: factor * length for side, length in box.items()}
        # K_IC depends on the size of its specimen: that of one rock is told by one size.
        size = SMALL_SIZE if campaign == "powers" else factor * size
    common = dict(values, seed=seed, report="false", snapshot_period=1)
    found = {f"confined {1e-6 * confinement:g}": (CONFINED, dict(common, **box, speed=SPEED, confinement=confinement))
             for confinement in confinements}
    found["tension"] = UNIAXIAL, dict(common, **box, speed=PULL, test="tension")
    if campaign in ("laws", "resolution", "kept", "powers", "graded") and not blocked:
        brittle = values.get("bond_law") == "coulomb"
        found["toughness"] = TOUGHNESS, dict(common, size=size, **(SUDDEN if brittle else {}))
    if campaign == "graded":
        for _, of in found.values():
            of["fine_depth"] = 0.25 * of.get("height", 1.25 * size)
    return found


def folder_of(case, test, seed):
    """Name of a run's folder."""
    return "".join(c if c.isalnum() or c in "-." else "_" for c in f"{case}-{test}-{seed}")


def start(runs, campaign):
    """Queue a campaign, seed by seed. -> {(case, test, seed): Future of its RunFolder}."""
    cases, seeds, _ = CASES[campaign]
    return {(case, test, seed): runs.start(f"{campaign}/{folder_of(case, test, seed)}", script, **values)
            for seed in seeds for case, rock in cases.items()
            for test, (script, values) in tests(campaign, rock, seed).items()}


def measured(folder, campaign):
    """{case: {quantity: (seeds,) values}} of the runs that exist."""
    cases, seeds, _ = CASES[campaign]
    found = {}
    for case, rock in cases.items():
        rows = [row for seed in seeds if (row := _of_packing(folder, campaign, case, rock, seed))]
        if rows:
            found[case] = {name: np.array([row.get(name, math.nan) for row in rows]) for name in QUANTITIES}
    return found


def _of_packing(folder, campaign, case, rock, seed):
    places = {test: folder / campaign / folder_of(case, test, seed) for test in tests(campaign, rock, seed)}
    runs = existing(places)
    unconfined, tension = runs.get("confined 0"), runs.get("tension")
    if unconfined is None or tension is None:
        return None
    row = {"coordination": unconfined.result("rock_coordination"), "E": unconfined.result("youngs_modulus"),
           "nu": unconfined.result("poissons_ratio"), "UCS": unconfined.result("peak_stress"),
           "tension": tension.result("tensile_strength")}
    row["ratio"] = row["UCS"] / row["tension"]
    if "toughness" in runs:
        row.update(K=runs["toughness"].result("fracture_toughness"), G=runs["toughness"].result("fracture_energy"))
    confined = runs.get(f"confined {1e-6 * CONFINED_AT:g}")
    if confined is not None:
        row.update(_envelope(row["UCS"], confined.result("peak_stress")))
    return row


def _envelope(ucs, confined):
    """phi (degrees) of the line and m_i of the Hoek-Brown curve through UCS and the strength at CONFINED_AT, Pa."""
    slope = (confined - ucs) / CONFINED_AT
    return {"phi": math.degrees(math.asin((slope - 1) / (slope + 1))),
            "m_i": ((confined - CONFINED_AT)**2 - ucs**2) / (ucs * CONFINED_AT)}


def cell(name, values):
    """Mean ± scatter of a quantity."""
    scale = QUANTITIES[name][0]
    values = values[np.isfinite(values)] * scale
    if not len(values):
        return "–"
    return f"{values.mean():.3g}" + (f" ± {values.std(ddof=1):.2g}" if len(values) > 1 else "")


def table(found):
    """Lines of Markdown: a row a case."""
    columns = [name for name in QUANTITIES if any(cell(name, values[name]) != "–" for values in found.values())]
    return generated.table(["", *(HEADS[name] for name in columns)],
                           [[case, *(cell(name, values[name]) for name in columns)] for case, values in found.items()])


def draw_resolution(found):
    """Properties over the mean radius, each over its mean at the finest."""
    figure, panels = plots.canvas(10, 4, 1, 2, sharey=True)
    for axes, kind in zip(panels, ("discs", "grains")):
        cases = {radius: found[f"{kind}, r = {radius:g} mm"] for radius in FINENESS
                 if f"{kind}, r = {radius:g} mm" in found}
        for name, colour in zip(("UCS", "tension", "K", "E"), palette.OTHER_LINES):
            known = {radius: values[name][np.isfinite(values[name])] for radius, values in cases.items()}
            known = {radius: values for radius, values in known.items() if len(values)}
            if known:
                finest = known[min(known)].mean()
                axes.errorbar(list(known), [values.mean() / finest for values in known.values()],
                              [values.std() / finest for values in known.values()], fmt="o-", color=colour, capsize=3,
                              label=HEADS[name].split(",")[0])
        axes.axhspan(0.95, 1.05, color="#e8f0e4", zorder=-5)
        axes.set(xscale="log", xlabel="mean radius of the discs, mm", title=kind)
        axes.set_xticks(list(FINENESS), [f"{radius:g}" for radius in FINENESS])
        axes.minorticks_off()
    panels[0].set_ylabel("over the mean of the finest discs")
    panels[0].legend()
    return figure


TITLES = {"laws": "What bond laws and rock properties do", "resolution": "The same rock of finer discs",
          "softening": "Fracture energy at the same discs",
          "kept": "A rock whose strengths follow the radius of its discs",
          "powers": "Bare discs whose strengths follow the radius",
          "graded": "Rock that grows coarser across the specimen",
          "relations": "Dimensionless relations"}


def write(folder):
    """Tables and figures of all runs that exist. -> the tables, in Markdown."""
    lines, files, rows = [], [folder / "rock_laws.csv"], []
    found = {campaign: measured(folder, campaign) for campaign in CASES}
    with matplotlib.rc_context(plots.STYLE):
        for campaign, cases in found.items():
            if not cases:
                continue
            counts = {len(values["UCS"]) for values in cases.values()}
            lines += [f"## {TITLES[campaign]}", "", f"Mean ± standard deviation of {min(counts)} to {max(counts)} "
                      f"packings. φ and m_i: from UCS and the strength at {1e-6 * CONFINED_AT:g} MPa.", "",
                      *table(cases)]
            rows += [[campaign, case, name, *values] for case, quantities in cases.items()
                     for name, values in quantities.items()]
        whole = {case: values for case, values in found["relations"].items() if len(values["UCS"]) > 1}
        if len(whole) == len(CASES["relations"][0]):
            lines += rock_relations.tables(ROCK, whole)
            data = rock_relations.numbers(ROCK, whole)
            files += [folder / "relations.json", folder / "relations.png"]
            files[-2].write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
            rock_relations.draw(data).savefig(files[-1])
        if found["resolution"]:
            files.append(folder / "resolution.png")
            draw_resolution(found["resolution"]).savefig(files[-1])
    with open(files[0], "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["campaign", "case", "quantity", "packings …"], *rows])
    generated.record(*files)
    return generated.write_page(folder / "rock_laws.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {(campaign, *key): job for campaign in words or list(CASES)
                    for key, job in start(runs, campaign).items()}
            failed = wait_for(jobs, lambda key, run: "{}: {}, {}, packing {}".format(*key))
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, CASES)
    sys.exit(main(place, words, **where))

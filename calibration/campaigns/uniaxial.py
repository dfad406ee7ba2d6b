"""Campaigns of the virtual laboratory: three bond laws, and the parameters that a sandstone's strength depends on.

    python3 -m calibration.campaigns.uniaxial DIR [CAMPAIGN ...] [--read] [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Writes into DIR uniaxial.csv
(strengths and moduli by case and packing), stress_strain.csv, uniaxial.md (tables), the figures and provenance.json.
"""
import math
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

from calibration import generated
from calibration.campaigns import uniaxial_figures as figures
from calibration.campaigns import uniaxial_tables as tables
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from calibration.campaigns.uniaxial_tables import TESTS
from rockwear.report import plots

SCRIPT = "yade_scripts/uniaxial.py"

SMALL = dict(width=0.0545, height=0.0545)
"""A quarter of the specimen of [Rojek 2003, 5.1], 525 discs: an eighth of the cost of a test."""

PLASTIC = dict(bond_law="plastic", Rn=0.04e6, Rt=0.16e6)
MAIN = {"brittle": {}, "damage 2e11": dict(bond_law="damage", H=2e11), "plastic 1e10": dict(PLASTIC, H=1e10)}
"""The three laws of [Rojek 2003, fig. 5.2]; brittle and damage bonds have its Rn = 0.1e6, Rt = 1e6."""
SOFTENING = {"damage 2e10": dict(bond_law="damage", H=2e10), "damage 5e9": dict(bond_law="damage", H=5e9),
             "damage 2e9": dict(bond_law="damage", H=2e9), "plastic 2e10": dict(PLASTIC, H=2e10),
             "plastic 5e9": dict(PLASTIC, H=5e9), "plastic 2e9": dict(PLASTIC, H=2e9)}
"""The other curves of [Rojek 2003, figs. 5.6 and 5.10]."""
LIKE = {"brittle": [*MAIN, *SOFTENING], "damage 2e11": [case for case in SOFTENING if "damage" in case],
        "plastic 1e10": [case for case in SOFTENING if "plastic" in case]}
"""{case: those whose cracks are looked for in the same places}: the other laws, and the other slopes of each law."""

SPEED = dict(speed=0.1)
"""Of loading: strengths up to 4 % too high (loading_speed.py), less than the scatter, at half the default's cost."""

SANDSTONE = dict(kn=20e9, kt=4e9, Rn=0.1e6, Rt=0.1e6, mu=0.8)
"""[Rojek 2014, 5.2]."""
ROCKS = {"Rojek 2003": {}, "Rojek 2014": SANDSTONE}
"""Two sets of bonds: strong in shear, and Rt = Rn with kt = kn/5."""
PUBLISHED = "Rojek 2014"
"""Case with the published parameters as they are."""
FACTORS = {
    PUBLISHED: {},
    "no rotation": dict(rotation="blocked"),
    "bonding gap 0": dict(bonding_gap=0), "bonding gap 0.05 mm": dict(bonding_gap=5e-5),
    "bonding gap 0.2 mm": dict(bonding_gap=2e-4),
    "porosity 0.06": dict(porosity=0.06), "porosity 0.16": dict(porosity=0.16),
    "friction 0": dict(mu=0), "friction 0.4": dict(mu=0.4),
    "rough platens": dict(platens="rough"),
    "Rt doubled": dict(Rt=0.2e6), "Rt fivefold": dict(Rt=0.5e6), "Rt tenfold": dict(Rt=1e6),
    "kt = kn": dict(kt=20e9),
    "nearly equal radii": dict(radius_min=1.2e-3, radius_max=1.3e-3),
    "radii doubled": dict(radius_min=2e-3, radius_max=3e-3, width=0.109, height=0.109),
    "100 x 50 mm": dict(width=0.1, height=0.05),
    "speed 0.025 m/s": dict(speed=0.025), "speed 0.4 m/s": dict(speed=0.4),
    "damping 0.1": dict(damping=0.1), "damping 0.7": dict(damping=0.7),
    "damage, H = 2e9": dict(bond_law="damage", H=2e9), "plastic, H = 1e10": dict(bond_law="plastic", H=1e10),
}
"""One change at a time to the set of [Rojek 2014]."""

COMBINED = {
    "no rotation, Rt doubled": dict(rotation="blocked", Rt=0.2e6),
    "no rotation, Rt tenfold": dict(rotation="blocked", Rt=1e6),
    "no rotation, Rt tenfold, gap 0.2 mm": dict(rotation="blocked", Rt=1e6, bonding_gap=2e-4),
    "no rotation, Rt tenfold, kt = 0.4 kn": dict(rotation="blocked", Rt=1e6, kt=8e9),
    "Rt tenfold, gap 0.2 mm": dict(Rt=1e6, bonding_gap=2e-4),
    "Rt tenfold, kt = 0.4 kn": dict(Rt=1e6, kt=8e9),
}
"""Several changes, towards the strengths of [Rojek 2014]."""

CLOSEST = {
    "discs free to turn": dict(kn=18.5e9, kt=8.4e9, Rn=0.04e6, Rt=0.4e6, mu=0.8, speed=0.04),
    "no rotation": dict(kn=17.7e9, kt=6.9e9, Rn=0.022e6, Rt=0.058e6, mu=0.8, rotation="blocked", speed=0.025,
                        strain_max=0.006),
}
"""Sets close to the rock of [Rojek 2014, 5.1]. A rock of less strength strains less until it fails, and is loaded more
slowly in proportion."""

CAMPAIGNS = {
    "laws": ({**MAIN, **SOFTENING}, SPEED, (1, 2, 3, 4, 5)),
    "small": ({**MAIN, **SOFTENING}, {**SMALL, **SPEED}, (1, 2, 3, 4, 5)),
    "sandstone": ({PUBLISHED: {}}, {**SANDSTONE, **SPEED}, (1, 2, 3, 4, 5)),
    "closest": (CLOSEST, {}, (1, 2, 3)),
    "closest_small": (CLOSEST, SMALL, (1, 2, 3)),
    "combined": (COMBINED, {**SANDSTONE, **SMALL, **SPEED}, (1, 2, 3)),
    "factors": (FACTORS, {**SANDSTONE, **SMALL, **SPEED}, (1, 2, 3)),
}
"""{campaign: (cases, what they have in common, seeds)}; each case in both tests."""
SIZES = {"laws": "", "small": "_small"}
"""{campaign of all laws: how the names of its figures end}."""
TITLES = {"laws": "all laws, 2100 discs", "small": "all laws, 525 discs",
          "sandstone": "sandstone of [Rojek 2014], 2100 discs", "closest": "sets close to this rock, 2100 discs",
          "closest_small": "sets close to this rock, 525 discs",
          "combined": "sandstone of [Rojek 2014], several changes, 525 discs",
          "factors": "sandstone of [Rojek 2014], one change at a time, 525 discs"}

MEASURED_ROCK = {"E, GPa": 18, "ν": 0.18, "UCS, MPa": 60, "σt, MPa": 7, "UCS/σt": 60 / 7}
"""The sandstone that [Rojek 2014, 5.1] reports."""


def folder_of(case, test, seed):
    """Name of a run's folder."""
    return "".join(c if c.isalnum() or c in "-." else "_" for c in f"{case}-{test}-{seed}")


def start(runs, campaign):
    """Queue a campaign, seed by seed. -> {(case, test, seed): Future of its RunFolder}."""
    cases, common, seeds = CAMPAIGNS[campaign]
    return {(case, test, seed): runs.start(f"{campaign}/{folder_of(case, test, seed)}", SCRIPT, test=test, seed=seed,
                                           report="false", snapshot_period=1, **{**common, **values})
            for seed in seeds for case, values in cases.items() for test in TESTS}


def found(folder, campaign):
    """{(case, test, seed): RunFolder} of a campaign's runs that exist."""
    cases, _, seeds = CAMPAIGNS[campaign]
    places = {(case, test, seed): folder / campaign / folder_of(case, test, seed)
              for case in cases for test in TESTS for seed in seeds}
    return existing(places)


def slope_cases():
    """{law: {H: case}}."""
    cases = {**MAIN, **SOFTENING}
    laws = {"damage": {math.inf: "brittle"}, "plastic": {}}
    for case, values in cases.items():
        if "H" in values:
            laws[values["bond_law"]][values["H"]] = case
    return laws


def mean_and_error(rows, case):
    """{quantity: (mean, standard error)} of a case, in the units of MEASURED_ROCK."""
    def of(test, name, scale):
        values = [scale * row[name] for row in rows if (row["case"], row["test"]) == (case, test)]
        mean, error = generated.mean_and_error(values)
        return mean, error if len(values) > 1 else 0.0

    strong, weak = of("compression", "peak_stress", 1e-6), of("tension", "peak_stress", 1e-6)
    ratio = strong[0] / weak[0]
    return {"E, GPa": of("tension", "youngs_modulus", 1e-9), "ν": of("tension", "poissons_ratio", 1),
            "UCS, MPa": strong, "σt, MPa": weak,
            "UCS/σt": (ratio, ratio * math.hypot(strong[1] / strong[0], weak[1] / weak[0]))}


def write(folder):
    """Tables and figures of all runs that exist. -> the tables, in Markdown."""
    runs = {campaign: found(folder, campaign) for campaign in CAMPAIGNS}
    rows = {campaign: [tables.row_of(campaign, *key, run) for key, run in done.items()]
            for campaign, done in runs.items()}
    tables.write_csv(folder / "uniaxial.csv", [row for part in rows.values() for row in part])
    lines = []
    for campaign in CAMPAIGNS:
        if rows[campaign]:
            lines += [f"### {TITLES[campaign]}", "", *tables.strengths(rows[campaign])]
    for campaign in SIZES:
        if rows[campaign]:
            maps = {(case, seed): tables.crack_map(run) for (case, test, seed), run in runs[campaign].items()
                    if test == "compression"}
            lines += [f"### {TITLES[campaign]}: against the brittle law", "",
                      *tables.against(rows[campaign], "brittle"), *tables.likeness(maps, LIKE)]
    written = [folder / "stress_strain.csv", folder / "uniaxial.csv"]
    write_curves(written[0], runs["laws"])
    with matplotlib.rc_context(plots.STYLE):
        for name, figure in drawn(runs, rows).items():
            written.append(folder / f"{name}.png")
            figure.savefig(written[-1])
    generated.record(*filter(Path.exists, written))
    return generated.write_page(folder / "uniaxial.md", lines)


def drawn(runs, rows):
    """{name: Figure}."""
    found = {}
    for campaign, suffix in SIZES.items():
        found |= of_laws(runs[campaign], suffix)
        if rows[campaign]:
            found[f"over_softening{suffix}"] = figures.over_softening(rows[campaign], slope_cases())
    if rows["factors"]:
        groups = {"factors": "", "combined": "", "closest_small": "close: ", "sandstone": "2100 discs: ",
                  "closest": "2100 discs, close: "}
        values = {f"{words}{case}": mean_and_error(rows[campaign], case) for campaign, words in groups.items()
                  for case in dict.fromkeys(row["case"] for row in rows[campaign])}
        found["sandstone_factors"] = figures.factors(values, MEASURED_ROCK)
    return found


def of_laws(runs, suffix):
    """Stress over strain and failure of the three laws, as far as the runs exist; failures of the first packing."""
    by_case = defaultdict(list)
    for (case, test, _), run in sorted(runs.items(), key=lambda item: item[0][2]):
        if test == "compression":
            by_case[case].append(run)
    if not set(MAIN) <= set(by_case):
        return {}
    slopes = {law: [case for _, case in sorted(cases.items(), reverse=True) if case in by_case]
              for law, cases in slope_cases().items()}
    groups = {"three laws (thin: other packings)": {case: by_case[case] for case in MAIN},
              **{f"{law}, softening slope H in N/m": {case: by_case[case][:1] for case in cases}
                 for law, cases in slopes.items()}}
    failed = {"laws": MAIN, "damage": slopes["damage"][1:], "plastic": slopes["plastic"]}
    return {f"stress_strain{suffix}": figures.stress_strain(groups),
            **{f"failure_{name}{suffix}": figures.failures({case: by_case[case][0] for case in cases})
               for name, cases in failed.items()}}


def write_curves(path, runs):
    """Thinned stress-strain curves of the first packing."""
    tables.write_csv(path, [
        {"case": case, "test": test, "platen_strain": strain, "axial_strain": axial, "lateral_strain": lateral,
         "stress_Pa": stress}
        for (case, test, seed), run in runs.items() if seed == 1
        for strain, axial, lateral, stress in zip(*(figures.thinned(run.column(name)).tolist() for name in (
            "platen_strain", "axial_strain", "lateral_strain", "stress")))])


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    campaigns = [word for word in words if word != "--read"] or list(CAMPAIGNS)
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {(campaign, *key): job for campaign in campaigns for key, job in start(runs, campaign).items()}
            failed = wait_for(jobs, lambda key, run: "{}: {}, {}, packing {}: {:.1f} MPa".format(
                *key, 1e-6 * run.result("peak_stress")))
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, CAMPAIGNS)
    sys.exit(main(place, words, **where))

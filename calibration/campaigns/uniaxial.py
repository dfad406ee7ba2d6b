"""Campaigns of the virtual laboratory: M's three laws, and what P's sandstone depends on.

    python3 -m calibration.campaigns.uniaxial DIR [CAMPAIGN ...] [--read]

Two runs at a time, a folder a run; runs that are finished stay as they are, so that a stopped campaign goes on. --read
starts none, and shows what is there. Leaves in DIR uniaxial.csv (strengths and moduli by case and packing),
stress_strain.csv, tables.md and the figures.
"""
import math
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib
import numpy as np

from calibration.campaigns import uniaxial_figures as figures
from calibration.campaigns.runs import RunFailed, Runs
from rockwear.report import plots
from rockwear.report.folder import RunFolder

SCRIPT = "yade_scripts/uniaxial.py"
TESTS = "compression", "tension"

SMALL = dict(width=0.0545, height=0.0545)
"""A quarter of M's specimen, 525 discs: an eighth of the cost of a test."""

PLASTIC = dict(law="plastic", Rn=0.04e6, Rt=0.16e6)
MAIN = {"brittle": {}, "damage 2e11": dict(law="damage", H=2e11), "plastic 1e10": dict(PLASTIC, H=1e10)}
"""M's three laws as in M fig. 5.2; brittle and damage bonds have M's Rn = 0.1e6, Rt = 1e6."""
SOFTENING = {"damage 2e10": dict(law="damage", H=2e10), "damage 5e9": dict(law="damage", H=5e9),
             "damage 2e9": dict(law="damage", H=2e9), "plastic 2e10": dict(PLASTIC, H=2e10),
             "plastic 5e9": dict(PLASTIC, H=5e9), "plastic 2e9": dict(PLASTIC, H=2e9)}
"""The other curves of M figs. 5.6 and 5.10."""

SPEED = dict(speed=0.1)
"""Of loading: up to 4 % too strong (see loading_speed), less than the scatter, at half the cost of the default."""

SANDSTONE = dict(kn=20e9, kt=4e9, Rn=0.1e6, Rt=0.1e6, mu=0.8)
"""P 5.2."""
FACTORS = {
    "P's numbers": {},
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
    "damage, H = 2e9": dict(law="damage", H=2e9), "plastic, H = 1e10": dict(law="plastic", H=1e10),
}
"""One change at a time to P's set."""

COMBINED = {
    "no rotation, Rt doubled": dict(rotation="blocked", Rt=0.2e6),
    "no rotation, Rt tenfold": dict(rotation="blocked", Rt=1e6),
    "no rotation, Rt tenfold, gap 0.2 mm": dict(rotation="blocked", Rt=1e6, bonding_gap=2e-4),
    "no rotation, Rt tenfold, kt = 0.4 kn": dict(rotation="blocked", Rt=1e6, kt=8e9),
    "Rt tenfold, gap 0.2 mm": dict(Rt=1e6, bonding_gap=2e-4),
    "Rt tenfold, kt = 0.4 kn": dict(Rt=1e6, kt=8e9),
}
"""Several changes, towards the strengths that P states."""

CLOSEST = {
    "discs free to turn": dict(kn=18.5e9, kt=8.4e9, Rn=0.04e6, Rt=0.4e6, mu=0.8, speed=0.04),
    "no rotation": dict(kn=17.7e9, kt=6.9e9, Rn=0.022e6, Rt=0.058e6, mu=0.8, rotation="blocked", speed=0.025,
                        strain_max=0.006),
}
"""Sets that come near all that P says of its rock. A rock of less strength strains less until it fails, and is loaded
as much more slowly."""

CAMPAIGNS = {
    "laws": (MAIN, SPEED, (1, 2, 3, 4, 5)),
    "softening": (SOFTENING, SPEED, (1,)),
    "small": ({**MAIN, **SOFTENING}, {**SMALL, **SPEED}, (1, 2, 3, 4, 5)),
    "sandstone": ({"P's numbers": {}}, {**SANDSTONE, **SPEED}, (1, 2, 3, 4, 5)),
    "closest": (CLOSEST, {}, (1, 2, 3)),
    "closest_small": (CLOSEST, SMALL, (1, 2, 3)),
    "combined": (COMBINED, {**SANDSTONE, **SMALL, **SPEED}, (1, 2, 3)),
    "factors": (FACTORS, {**SANDSTONE, **SMALL, **SPEED}, (1, 2, 3)),
}
"""{campaign: (cases, what they have in common, seeds)}; each case in both tests."""
TITLES = {"laws": "M's laws, 2100 discs", "softening": "other slopes, 2100 discs", "small": "all laws, 525 discs",
          "sandstone": "P's sandstone, 2100 discs", "closest": "sets near P's rock, 2100 discs",
          "closest_small": "sets near P's rock, 525 discs",
          "combined": "P's sandstone, several changes, 525 discs",
          "factors": "P's sandstone, one change at a time, 525 discs"}

P_ROCK = {"E, GPa": 18, "ν": 0.18, "UCS, MPa": 60, "σt, MPa": 7, "UCS/σt": 60 / 7}
"""What P 5.1 says of the rock."""


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
    """{(case, test, seed): RunFolder} of a campaign's runs that are there."""
    cases, _, seeds = CAMPAIGNS[campaign]
    places = {(case, test, seed): folder / campaign / folder_of(case, test, seed)
              for case in cases for test in TESTS for seed in seeds}
    return {key: RunFolder(place) for key, place in places.items() if (place / "summary.json").exists()}


# ---- tables

def statistics(rows, scale=1.0):
    """(mean, standard deviation, number) of values."""
    values = scale * np.array(rows)
    return values.mean(), values.std(ddof=1) if len(values) > 1 else math.nan, len(values)


def shown(values, scale=1.0, digits=1):
    """Mean ± standard deviation."""
    if not values:
        return "–"
    mean, deviation, count = statistics(values, scale)
    return f"{mean:.{digits}f}" + (f" ± {deviation:.{digits}f}" if count > 1 else "")


def table(header, rows):
    """Lines of Markdown."""
    return [f"| {' | '.join(header)} |", "|---" * len(header) + "|", *(f"| {' | '.join(row)} |" for row in rows), ""]


def strengths(rows):
    """One line a case: packings, UCS, tensile strength, their ratio, E, nu, cracks at the peak, localisation."""
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        compressed, pulled = ([row for row in rows if (row["case"], row["test"]) == (case, test)] for test in TESTS)
        pull = {row["seed"]: row["peak_stress"] for row in pulled}
        ratios = [row["peak_stress"] / pull[row["seed"]] for row in compressed if row["seed"] in pull]
        open_ended = sum(not row["failed"] for row in compressed)
        lines.append([case, str(len(compressed)),
                      shown([row["peak_stress"] for row in compressed], 1e-6) + (
                          f" ({open_ended} not failed)" if open_ended else ""),
                      shown([row["peak_stress"] for row in pulled], 1e-6), shown(ratios, 1, 2),
                      shown([row["youngs_modulus"] for row in pulled], 1e-9),
                      shown([row["poissons_ratio"] for row in pulled], 1, 3),
                      shown([row["peak_strain"] for row in compressed], 100, 2),
                      shown([row["tensile_cracks_at_peak"] + row["shear_cracks_at_peak"] for row in compressed], 1, 0),
                      shown([100 * row["localised"] for row in compressed], 1, 0)])
    return table(["case", "packings", "UCS, MPa", "tensile strength, MPa", "UCS/σt", "E, GPa", "ν", "strain at UCS, %",
                  "cracks at UCS", "% of cracks in the densest fifth"], lines)


def against(rows, reference):
    """Change of UCS from the reference case on the same packing, mean ± standard error, in %."""
    base = {row["seed"]: row["peak_stress"] for row in rows if row["case"] == reference and row["test"] == TESTS[0]}
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        change = [100 * (row["peak_stress"] / base[row["seed"]] - 1) for row in rows
                  if row["case"] == case and row["test"] == TESTS[0] and row["seed"] in base]
        if len(change) > 1 and case != reference:
            mean, deviation, count = statistics(change)
            lines.append([case, f"{mean:+.1f} ± {deviation / math.sqrt(count):.1f}"])
    return table(["case", f"UCS against {reference} on the same packing, % ± standard error"], lines)


def likeness(maps):
    """Mean correlation of the crack maps of two laws on the same packing, and of one law on different packings.

    maps: {(case, seed): crack map}, all of one size.
    """
    cases = list(dict.fromkeys(case for case, _ in maps))
    same, other = defaultdict(list), []
    for (case, seed), density in maps.items():
        if (cases[0], seed) in maps and case != cases[0]:
            same[case].append(figures.alike(density, maps[cases[0], seed]))
        other += [figures.alike(density, there) for (name, k), there in maps.items() if name == case and k > seed]
    lines = [[f"{case} and {cases[0]}, same packing", shown(values, 1, 2)] for case, values in same.items()]
    lines.append(["one law, different packings", shown(other, 1, 2)])
    return table(["cracks in the same places", "correlation"], lines)


# ---- the page

def slope_cases():
    """{law: {H: case}}."""
    cases = {**MAIN, **SOFTENING}
    laws = {"damage": {math.inf: "brittle"}, "plastic": {}}
    for case, values in cases.items():
        if "H" in values:
            laws[values["bond_law"]][values["H"]] = case
    return laws


def mean_and_error(rows, case):
    """{quantity: (mean, standard error)} of a case, in the units of P_ROCK."""
    def of(test, name, scale):
        values = [row[name] for row in rows if (row["case"], row["test"]) == (case, test)]
        mean, deviation, count = statistics(values, scale) if values else (math.nan, math.nan, 1)
        return mean, deviation / math.sqrt(count) if count > 1 else 0.0

    strong, weak = of("compression", "peak_stress", 1e-6), of("tension", "peak_stress", 1e-6)
    ratio = strong[0] / weak[0]
    return {"E, GPa": of("tension", "youngs_modulus", 1e-9), "ν": of("tension", "poissons_ratio", 1),
            "UCS, MPa": strong, "σt, MPa": weak,
            "UCS/σt": (ratio, ratio * math.hypot(strong[1] / strong[0], weak[1] / weak[0]))}


def write(folder):
    """Tables and figures of all runs that are there."""
    runs = {campaign: found(folder, campaign) for campaign in CAMPAIGNS}
    rows = {campaign: [figures.row_of(campaign, *key, run) for key, run in done.items()]
            for campaign, done in runs.items()}
    figures.write_csv(folder / "uniaxial.csv", [row for part in rows.values() for row in part])
    lines = []
    for campaign in CAMPAIGNS:
        if rows[campaign]:
            lines += [f"### {TITLES[campaign]}", "", *strengths(rows[campaign])]
    for campaign in ("laws", "small"):
        if rows[campaign]:
            maps = {(case, seed): figures.crack_map(run) for (case, test, seed), run in runs[campaign].items()
                    if test == "compression"}
            lines += [f"### {TITLES[campaign]}: against the brittle law", "", *against(rows[campaign], "brittle"),
                      *likeness(maps)]
    (folder / "tables.md").write_text("\n".join(lines), encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        for name, figure in drawn(runs, rows).items():
            figure.savefig(folder / f"{name}.png")
    write_curves(folder / "stress_strain.csv", {**runs["laws"], **runs["softening"]})


def drawn(runs, rows):
    """{name: Figure}."""
    found = {**of_laws({**runs["laws"], **runs["softening"]}, ""), **of_laws(runs["small"], "_small")}
    if rows["small"]:
        found["over_softening"] = figures.over_softening(rows["small"], slope_cases())
    if rows["factors"]:
        groups = {"factors": "", "combined": "", "closest_small": "near P: ", "sandstone": "2100 discs: ",
                  "closest": "2100 discs, near P: "}
        values = {f"{words}{case}": mean_and_error(rows[campaign], case) for campaign, words in groups.items()
                  for case in dict.fromkeys(row["case"] for row in rows[campaign])}
        found["sandstone_factors"] = figures.factors(values, P_ROCK)
    return found


def of_laws(runs, suffix):
    """Stress over strain and failure of M's cases, as far as they are there; the failures are the first packing's."""
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
    figures.write_csv(path, [
        {"case": case, "test": test, "platen_strain": strain, "axial_strain": axial, "lateral_strain": lateral,
         "stress_Pa": stress}
        for (case, test, seed), run in runs.items() if seed == 1
        for strain, axial, lateral, stress in zip(*(figures.thinned(run.column(name)).tolist() for name in (
            "platen_strain", "axial_strain", "lateral_strain", "stress")))])


def main(folder, words):
    """-> exit code: 1 where a run failed."""
    failed = 0
    campaigns = [word for word in words if word != "--read"] or list(CAMPAIGNS)
    if "--read" not in words:
        with Runs(folder, keep=True) as runs:
            jobs = {(campaign, *key): job for campaign in campaigns for key, job in start(runs, campaign).items()}
            for (campaign, case, test, seed), job in jobs.items():
                try:
                    strength = job.result().result("peak_stress")
                    print(f"{campaign}: {case}, {test}, packing {seed}: {1e-6 * strength:.1f} MPa", flush=True)
                except RunFailed as error:
                    print(error, file=sys.stderr, flush=True)
                    failed = 1
    write(folder)
    print((folder / "tables.md").read_text(encoding="utf-8"))
    return failed


if __name__ == "__main__":
    unknown = [word for word in sys.argv[2:] if word not in (*CAMPAIGNS, "--read")]
    if len(sys.argv) < 2 or unknown:
        sys.exit(f"usage: python3 -m calibration.campaigns.uniaxial DIR [{'] ['.join(CAMPAIGNS)}] [--read]")
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))

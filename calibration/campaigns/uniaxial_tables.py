"""Tables of laboratory campaigns: strengths by case and packing, changes against a reference, where rock failed."""
import csv
import math

import numpy as np
from scipy.ndimage import gaussian_filter

from calibration import generated

TESTS = "compression", "tension"
RESULTS = ["peak_stress", "peak_strain", "youngs_modulus", "poissons_ratio", "tensile_cracks", "shear_cracks",
           "tensile_cracks_at_peak", "shear_cracks_at_peak", "failed"]
CELL, SMOOTHING = 2.5e-3, 5e-3
"""m; cells of a map of cracks, and the standard deviation of the Gaussian that smooths it."""
DENSEST = 0.2
"""Part of the area that counts as localised."""


def row_of(campaign, case, test, seed, run):
    """{column: value} of a run in SI, with the relative residual of energy and the localisation of cracks."""
    balance = run.summary["balances"]["energy"]
    return {"campaign": campaign, "case": case, "test": test, "seed": seed,
            **{name: run.result(name) for name in RESULTS},
            "energy_missing": balance["residual"] / balance["platen_work"], "localised": localised(crack_map(run))}


def write_csv(path, rows):
    """Rows of dicts with the same keys; no file without rows."""
    if not rows:
        return
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def crack_map(run):
    """Broken bonds per m2 where they were bonded, smoothed: (rows, columns) of cells over the specimen."""
    model, shot = run.model, run.snapshot(-1)
    broken = model["bonds"][shot["status"] != 0]
    middle = model["rock_positions"][broken].mean(axis=1)
    edges = [np.linspace(0, side, max(2, round(side / CELL)) + 1) for side in model["box"]]
    counts, *_ = np.histogram2d(*middle.T, bins=edges)
    return gaussian_filter(counts, SMOOTHING / CELL, mode="constant") / CELL**2


def localised(density):
    """Part of all cracks that lies in the densest fifth of the area; 0.2 for uniformly spread cracks."""
    values = np.sort(density.ravel())[::-1]
    whole = values.sum()
    return float(values[:round(DENSEST * len(values))].sum() / whole) if whole else math.nan


def alike(first, second):
    """Correlation of two maps of cracks: 1 for cracks in the same places, 0 for independent ones."""
    return float(np.corrcoef(first.ravel(), second.ravel())[0, 1])


def shown(values, scale=1.0, digits=1):
    """Mean ± standard deviation."""
    if not values:
        return "–"
    values = scale * np.array(values)
    return f"{values.mean():.{digits}f}" + (f" ± {values.std(ddof=1):.{digits}f}" if len(values) > 1 else "")


def strengths(rows):
    """Table with one row a case: packings, strengths, their ratio, E, nu, cracks at the peak, localisation."""
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
    return generated.table(["case", "packings", "UCS, MPa", "tensile strength, MPa", "UCS/σt", "E, GPa", "ν",
                            "strain at UCS, %", "cracks at UCS", "% of cracks in the densest fifth"], lines)


def against(rows, reference):
    """Change of UCS from the reference case on the same packing, mean ± standard error, in %."""
    base = {row["seed"]: row["peak_stress"] for row in rows if row["case"] == reference and row["test"] == TESTS[0]}
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        change = [100 * (row["peak_stress"] / base[row["seed"]] - 1) for row in rows
                  if row["case"] == case and row["test"] == TESTS[0] and row["seed"] in base]
        if len(change) > 1 and case != reference:
            mean, error = generated.mean_and_error(change)
            lines.append([case, f"{mean:+.1f} ± {error:.1f}"])
    return generated.table(["case", f"UCS against {reference} on the same packing, % ± standard error"], lines)


def likeness(maps, like):
    """Mean correlation of the crack maps of two cases on the same packing, and of one case on different packings.

    maps: {(case, seed): crack map}, all of one size; like: {case: cases that are compared with it}.
    """
    lines = []
    for first, others in like.items():
        for case in others:
            values = [alike(density, maps[first, seed]) for (name, seed), density in maps.items()
                      if name == case != first and (first, seed) in maps]
            if values:
                lines.append([f"{case} and {first}, same packing", shown(values, 1, 2)])
    different = [alike(density, there) for (case, seed), density in maps.items()
                 for (name, k), there in maps.items() if name == case and k > seed]
    lines.append(["one case, different packings", shown(different, 1, 2)])
    return generated.table(["cracks in the same places", "correlation"], lines)

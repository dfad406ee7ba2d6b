"""Figures of a laboratory test: stress over strain, and the specimen as it failed, displacements and broken bonds."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, to_rgba

from rockwear.report import shapes
from rockwear.report.page import Section, machine_tiles, number, percent, quantity, tiles
from rockwear.report.plots import MM, balances, canvas, discs, frame, history, save

ROCK, GRIP, CRACK = "#e2d4b4", "#9a9a92", "#cc1414"
SOFTENED = LinearSegmentedColormap.from_list("softened", [ROCK, "#8f5a24"])
ARROWS = 900
"""Largest number of arrows in the displacement field."""


def shows(run):
    """True for a run with a specimen between platens and at least one snapshot."""
    return bool({"rock_prescribed", "rock_radii", "bonds"} <= run.model.keys() and len(run.times))


def sections(run):
    """The sections of the page, in order."""
    def drawn(figure):
        return save(run, figure.__name__, figure(run))

    return [
        Section("Key results", f"{run.parameter('test', '')} with {run.parameter('law', '')} bonds, each platen at "
                f"{number(run.parameter('speed', np.nan))} m/s.", [key_results(run)]),
        Section("Stress and strain", "Strain is measured in the middle of the specimen; dashed, from the platens' "
                "travel. Cracks count all broken bonds.", [drawn(stress_strain)]),
        Section("Failure", "Left: displacements since the start, less their mean, arrows enlarged, colour their size. "
                "Right: broken bonds in red, drawn across the bond; the darker a disc, the softer its bonds; "
                "grey discs are led by the platens.", [drawn(failure)]),
        Section("History", "Every recorded quantity over time.", [drawn(history)]),
        balances(run)]


def key_results(run):
    """The numbers to see first."""
    def tile(label, name, unit, remark=""):
        return label, quantity(run.result(name), unit), remark

    balance = run.summary.get("balances", {}).get("energy", {})
    failed = run.result("failed")
    return tiles([
        tile("strength" if failed else "peak stress, not failed", "peak_stress", "Pa",
             f"at a strain of {percent(run.result('peak_strain'), 1)}"),
        ("Young's modulus", f"{number(run.result('youngs_modulus') / 1e9)} GPa", "between 10 and 40 % of the peak"),
        tile("Poisson's ratio", "poissons_ratio", "-"),
        tile("tensile cracks", "tensile_cracks", "-", f"{number(run.result('tensile_cracks_at_peak'))} at the peak"),
        tile("shear cracks", "shear_cracks", "-", f"{number(run.result('shear_cracks_at_peak'))} at the peak"),
        ("energy not accounted for", percent(balance.get("residual", np.nan), balance.get("platen_work", 0.0)),
         "of the platens' work"),
        *machine_tiles(run)])


def stress_strain(run):
    """Stress and the number of cracks over strain."""
    stress = 1e-6 * run.column("stress")
    if not len(stress):
        return None
    figure, (axes,) = canvas(8, 4.5)
    travel = 100 * run.column("platen_strain")
    axes.plot(100 * run.column("axial_strain"), stress, color="black", label="in the middle")
    axes.plot(travel, stress, color="0.6", linestyle="--", linewidth=1, label="by the platens")
    axes.plot(100 * run.column("lateral_strain"), stress, color="#3b7fb0", linewidth=1, label="lateral")
    # Past the peak the lateral strain is the opening of cracks and may be any multiple of the axial one.
    axes.set(xlabel="strain / %", ylabel="stress / MPa", xlim=(-0.6 * travel.max(), 1.2 * travel.max()))
    axes.legend(loc="upper left")
    other = axes.twinx()
    other.plot(travel, run.column("tensile_cracks") + run.column("shear_cracks"), color=CRACK, linewidth=1)
    other.set_ylabel("cracks", color=CRACK)
    return figure


def failure(run):
    """The specimen at the end: displacement field, and broken bonds."""
    model, shot = run.model, run.snapshot(-1)
    radii, places, moved = model["rock_radii"], shot["rock_positions"], shot["displacement"]
    size = MM * model["box"]
    limits = (-0.03 * size[0], 1.03 * size[0], -0.03 * size[0], size[1] + 0.03 * size[0])
    figure, (left, right) = canvas(12, 1 + 5.5 * size[1] / size[0], 1, 2)
    moved = moved - moved.mean(axis=0)
    length = np.linalg.norm(moved, axis=1)
    show = np.random.default_rng(0).permutation(len(radii))[:ARROWS]
    largest = np.percentile(length, 95) or 1.0
    arrows = left.quiver(*(MM * places[show]).T, *moved[show].T, MM * length[show], cmap="viridis", angles="xy",
                         scale_units="xy", scale=largest / (0.06 * size[0]), width=0.003, clim=(0, MM * largest))
    figure.colorbar(arrows, ax=left, label="displacement / mm", shrink=0.8)
    frame(left, limits, "displacements")
    softness = np.bincount(model["bonds"].ravel(), np.repeat(shot["softening"], 2), len(radii))
    softness /= np.maximum(np.bincount(model["bonds"].ravel(), minlength=len(radii)), 1)
    colours = SOFTENED(np.clip(softness, 0, 1))
    colours[model["rock_prescribed"]] = to_rgba(GRIP)
    discs(right, places, radii, facecolors=colours)
    broken = model["bonds"][shot["status"] != 0]
    right.add_collection(LineCollection(MM * shapes.cracks(places, radii, broken), colors=CRACK, linewidths=1))
    frame(right, limits, f"{len(broken)} broken bonds")
    return figure

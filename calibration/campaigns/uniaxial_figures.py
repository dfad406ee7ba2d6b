"""Figures of laboratory campaigns: stress over strain, failure, strength over H and over other parameters.

runs: {label: RunFolder}.
"""
import math

import numpy as np
from matplotlib.collections import LineCollection

from rockwear.report import shapes
from rockwear.report.instants import spread
from rockwear.report.plots import MM, canvas, discs, frame

CRACK = "#cc1414"
CURVE_POINTS = 150


def thinned(values):
    """At most CURVE_POINTS of them, evenly spread."""
    return np.array(spread(values, CURVE_POINTS))


def stress_strain(panels):
    """panels: {title: {label: [RunFolder by seed]}}; the first seed bold, the others thin; strain by the platens."""
    figure, axes = canvas(4.6 * len(panels), 4.2, 1, len(panels))
    for axis, (title, cases) in zip(axes, panels.items()):
        for k, (label, runs) in enumerate(cases.items()):
            for run in runs[::-1]:
                first = run is runs[0]
                axis.plot(100 * run.column("platen_strain"), 1e-6 * run.column("stress"), color=f"C{k}",
                          linewidth=1.8 if first else 0.6, alpha=1 if first else 0.45, label=label if first else None)
        axis.set(title=title, xlabel="strain, %", ylim=(0, None), xlim=(0, None))
        axis.legend(fontsize=9)
    axes[0].set_ylabel("stress, MPa")
    return figure


def failures(runs):
    """A column for each case: displacements above, cracks below."""
    figure, axes = canvas(3.6 * len(runs), 7.4, 2, len(runs))
    for k, (label, run) in enumerate(runs.items()):
        displacements(axes[k], run, label)
        cracks(axes[len(runs) + k], run)
    return figure


def displacements(axes, run, title):
    """Size and direction of the displacements less their mean, by disc."""
    model, shot = run.model, run.snapshot(-1)
    moved = MM * (shot["displacement"] - shot["displacement"].mean(axis=0))
    length = np.linalg.norm(moved, axis=1)
    largest = np.percentile(length, 98)
    places = shot["rock_positions"]
    found = discs(axes, places, model["rock_radii"], array=np.minimum(length, largest), cmap="viridis", linewidths=0)
    show = np.random.default_rng(0).permutation(len(length))[:350]
    axes.quiver(*(MM * places[show]).T, *moved[show].T, color="white", angles="xy", scale_units="xy",
                scale=largest / (0.07 * MM * model["box"][0]), width=0.004, alpha=0.8)
    axes.figure.colorbar(found, ax=axes, shrink=0.6, label="displacement, mm")
    frame(axes, limits_of(run), title)


def cracks(axes, run):
    """Broken bonds in red, discs with softened bonds in brown."""
    model, shot = run.model, run.snapshot(-1)
    places, radii = shot["rock_positions"], model["rock_radii"]
    softness = np.bincount(model["bonds"].ravel(), np.repeat(shot["softening"], 2), len(radii))
    softness /= np.maximum(np.bincount(model["bonds"].ravel(), minlength=len(radii)), 1)
    discs(axes, places, radii, array=softness, cmap="YlOrBr", clim=(0, 1), linewidths=0)
    broken = model["bonds"][shot["status"] != 0]
    axes.add_collection(LineCollection(MM * shapes.cracks(places, radii, broken), colors=CRACK, linewidths=1.1))
    softened = int(np.sum((shot["softening"] > 0) & (shot["status"] == 0)))
    frame(axes, limits_of(run), f"{len(broken)} broken" + (f", {softened} softened" if softened else ""))


def limits_of(run):
    """A view of the specimen with a margin, mm."""
    width, height = MM * run.model["box"]
    margin = 0.04 * width
    return -margin, width + margin, -margin, height + margin


def over_softening(rows, cases):
    """Strength over H in both tests: packings as points, means as lines. cases: {law: {H: case}}; inf is brittle."""
    figure, panels = canvas(10, 4, 1, 2)
    for axes, test in zip(panels, ("compression", "tension")):
        for k, (law, names) in enumerate(cases.items()):
            slopes = sorted(names)
            groups = [[1e-6 * row["peak_stress"] for row in rows
                       if (row["case"], row["test"]) == (names[H], test)] or [math.nan] for H in slopes]
            finite = [H for H in slopes if math.isfinite(H)]
            places = [H if math.isfinite(H) else 5 * max(finite) for H in slopes]
            axes.plot(places, [np.mean(group) for group in groups], "o-", color=f"C{k}", label=law)
            for place, group in zip(places, groups):
                axes.plot([place] * len(group), group, ".", color=f"C{k}", alpha=0.4, markersize=5)
        axes.set(xscale="log", title=test, xlabel="softening slope H, N/m (rightmost: brittle)", ylim=(0, None))
    panels[0].set_ylabel("strength, MPa")
    panels[0].legend()
    return figure


def factors(rows, wanted):
    """One change at a time: a row for each case, a panel for each quantity.

    rows: {case: {quantity: (mean, error)}}, the first without a change; wanted: {quantity: value}.
    """
    figure, panels = canvas(13, 1 + 0.27 * len(rows), 1, len(wanted), sharey=True)
    for axes, (quantity, target) in zip(panels, wanted.items()):
        means, errors = np.array([found[quantity] for found in rows.values()]).T
        places = np.arange(len(rows))[::-1]
        axes.axvline(target, color="#2f7d32", linewidth=2, alpha=0.6)
        axes.axvline(means[0], color="0.5", linestyle=":", linewidth=1)
        axes.errorbar(means, places, xerr=errors, fmt="o", color="#8f3b1b", capsize=2, markersize=5)
        axes.set(title=quantity, ylim=(-0.7, len(rows) - 0.3), xlim=(0, 1.1 * max(np.nanmax(means + errors), target)))
        axes.set_yticks(places, list(rows))
        axes.grid(axis="y", color="0.9")
    figure.suptitle("green: the sandstone reported by [Rojek 2014]; dotted: its parameters unchanged", fontsize=10)
    return figure

"""What the heat is worth: conductances against packings, convergence, hard numbers on cost.

    python3 -m calibration.benchmarks.heat DIR

Writes DIR/heat.md with its figures. Kernels alone, no YADE: some minutes. Sections of `make validate` come from
here too (SECTIONS). Times of a heat step are processor
times, medians of five rounds.
"""
import sys
import time
from pathlib import Path
from statistics import median

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from calibration.validation.verdicts import Row, Section
from rockwear.kernels import analytic, packing
from rockwear.kernels.voronoi import cells
from rockwear.kernels.conduction import HeatNetwork, bar_conductance, calibrated_conductance, effective_conductivity
from rockwear.report import plots
from rockwear.model.cache import cached

SEEDS = 1, 2, 3, 4, 5
ROCKS = {"uniform 1-1.5 mm": dict(ratio=1.5, porosity=0.12), "uniform 1-1.2 mm": dict(ratio=1.2, porosity=0.12),
         "uniform 1-2.5 mm": dict(ratio=2.5, porosity=0.12), "denser, 0.06": dict(ratio=1.5, porosity=0.06),
         "looser, 0.16": dict(ratio=1.5, porosity=0.16), "graded 1 to 3": dict(ratio=1.5, porosity=0.12, graded=3.0)}
"""Packings in a square: radii, porosity, and by how much they grow from its top to its bottom."""
SIDE, SMALLEST = 0.08, 1e-3
MODELS = "M, bars r wide", "P, bars 2r wide", "fitted to the first packing", "fitted to each packing", "cells"
CONDUCTIVITY = 5.0


def rock(*, seed, ratio, porosity, graded=1.0, side=SIDE, smallest=SMALLEST):
    """(positions, radii) of a packing in a square, kept in the cache."""
    def make():
        field = None if graded == 1 else lambda points: 1 + (graded - 1) * (1 - points[:, 1] / side)
        found = packing.pack(box=(side, side), radius_min=smallest, radius_max=ratio * smallest, porosity=porosity,
                             seed=seed, radius_scale=field)
        return {"positions": found.positions, "radii": found.radii}

    found = cached(make, study="heat", seed=seed, ratio=ratio, porosity=porosity, graded=graded, side=side,
                   smallest=smallest)
    return found["positions"], found["radii"]


def scale_and_noise(*, positions, side, edges, conductance):
    """(conductivity in x and y, rms deviation of the temperatures from the linear field, of its range), steady."""
    conductivity = effective_conductivity(positions=positions, edges=edges, conductance=conductance)
    network = HeatNetwork(capacity=np.ones(len(positions)), edges=edges, conductance=conductance, temperature=0.0)
    linear = positions[:, 0] / side
    strips = (linear < 0.1) | (linear > 0.9)
    network.fix(strips, linear[strips])
    return conductivity, float(np.sqrt(np.mean((network.steady_state() - linear)[~strips] ** 2)))


def conductivities():
    """{packing: {model: (seeds, 3) conductivity in x and y over the wanted one, and noise}}."""
    found, reference = {}, None
    for name, kind in ROCKS.items():
        rows = {model: [] for model in MODELS}
        for seed in SEEDS:
            positions, radii = rock(seed=seed, **kind)
            contacts = packing.contacts(positions, radii, 0.1 * SMALLEST)
            common = dict(positions=positions, edges=contacts)
            own = calibrated_conductance(conductance=1.0, conductivity=CONDUCTIVITY, **common)[0]
            reference = own if reference is None else reference
            bar = bar_conductance(CONDUCTIVITY, 1.0)
            of_cells = cells(positions, box=(SIDE, SIDE))
            for model, edges, conductance in zip(MODELS, [contacts] * 4 + [of_cells.edges], [
                    bar / 2, bar, reference, own, of_cells.conductance(CONDUCTIVITY)]):
                conductivity, noise = scale_and_noise(positions=positions, side=SIDE, edges=edges,
                                                      conductance=conductance)
                rows[model].append((*conductivity / CONDUCTIVITY, noise))
        found[name] = {model: np.array(values) for model, values in rows.items()}
    return found


def slab(across, seed=1):
    """(cells, depths) of a random packing of so many mean diameters across a slab of 1, a quarter of it high."""
    radius = 1 / (2 * across)
    smallest = 2 * radius / 2.5

    def make():
        found = packing.pack(box=(1.0, 0.25), radius_min=smallest, radius_max=1.5 * smallest, porosity=0.12, seed=seed)
        return {"positions": found.positions}

    positions = cached(make, study="slab", across=across, seed=seed)["positions"]
    return cells(positions, box=(1.0, 0.25)), positions[:, 0]


MATERIAL = dict(conductivity=1.0, density=1.0, specific_heat=1.0)


def jump(found):
    """The network of M 7.6.3 over these cells, faces rising by 1."""
    network = HeatNetwork(capacity=found.volumes, edges=found.edges, conductance=found.conductance(1.0),
                          temperature=0.0)
    for side in (0, 1):
        network.convect(*found.wall_conductance(side, 1.0), 1.0)
    return network


def errors_in_space(sizes=(20, 40, 80, 160), instant=0.05):
    """[(across, rms error, largest error)] of M 7.6.3, means over three packings; heat step with the size squared."""
    rows = []
    for across in sizes:
        found = []
        for seed in SEEDS[:3]:
            of_cells, x = slab(across, seed)
            network = jump(of_cells)
            network.advance(instant)
            exact = analytic.slab_with_jumping_faces(x, instant, thickness=1.0, jump=1.0, **MATERIAL)
            gap = abs(network.temperature - exact)
            found.append((np.sqrt(np.mean(gap**2)), gap.max()))
        rows.append((across, *np.mean(found, axis=0).tolist()))
    return rows


def errors_in_time(fractions=(1.0, 0.5, 0.25, 0.125), across=40, instant=0.05):
    """[(heat step over the stable one, rms error against a step 64 times finer, against the exact solution)]."""
    found, x = slab(across)
    exact = analytic.slab_with_jumping_faces(x, instant, thickness=1.0, jump=1.0, **MATERIAL)
    stable = jump(found).stable_step()

    def solved(fraction):
        network = jump(found)
        network.advance(instant, step=fraction * stable)
        return network.temperature

    finest = solved(1 / 64)
    rows = []
    for fraction in fractions:
        temperature = solved(fraction)
        rows.append((fraction, *(float(np.sqrt(np.mean((temperature - to) ** 2))) for to in (finest, exact))))
    return rows


def heated_face(*, size, visit=None):
    """Temperature of a face under a flux, of the exact one: (at the first node, through its half cell to the face).

    size   node diameter over the depth sqrt(a t) that heat has reached
    visit  seconds between visits over t, each bringing the heat gathered since the last one at once; None: steady flux
    A row of cells stands for any packing: across the flux they are all alike.
    """
    count = int(np.ceil(8 / size)) + 1
    edges = np.column_stack([np.arange(count - 1), np.arange(1, count)])
    network = HeatNetwork(capacity=np.full(count, size), edges=edges, conductance=1 / size, temperature=0.0)
    if visit is None:
        network.source(0, 1.0)
        network.advance(1.0, step=min(1e-3, 0.5 * network.stable_step()))
    else:
        for _ in range(round(1 / visit)):
            network.add_heat(visit * (np.arange(count) == 0))
            network.advance(visit)
    exact = analytic.half_space_under_flux(0.0, 1.0, flux=1.0, **MATERIAL)
    return float(network.temperature[0] / exact), float((network.temperature[0] + size / 2) / exact)


SIZES = 4.0, 2.0, 1.0, 0.5, 0.25, 0.125
VISITS = 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005


def tip_errors():
    """([(size, errors at node and face)], {size: [(visit, error that the visits add at the node)]})."""
    by_size = [(size, *(found - 1 for found in heated_face(size=size))) for size in SIZES]
    by_visit = {size: [(visit, heated_face(size=size, visit=visit)[0] / heated_face(size=size)[0] - 1)
                       for visit in VISITS] for size in (2.0, 1.0, 0.5)}
    return by_size, by_visit


def order(rows, column=1):
    """Slope of log error over log of the first column, its size."""
    sizes, errors = np.array(rows, float)[:, [0, column]].T
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def cost(rock_discs=92_000, tool_discs=5_400):
    """Seconds of one heat step, of finding its stable step, and of a new wiring, at the size of P's dredging."""
    tile = packing.pack(box=(0.1, 0.1), radius_min=1e-3, radius_max=1.5e-3, porosity=0.12, seed=1, periodic=True)
    count = rock_discs + tool_discs
    repeats = int(np.ceil(np.sqrt(count / len(tile.radii))))
    shifts = 0.1 * np.indices((repeats, repeats)).reshape(2, -1).T
    positions = (tile.positions + shifts[:, None, :]).reshape(-1, 2)[:count]
    box = positions.max(axis=0) + 1e-3
    began = time.process_time()
    found = cells(positions + 1e-6, box=box)
    seconds = {"cells": time.process_time() - began}
    network = HeatNetwork(capacity=found.volumes, edges=found.edges, conductance=found.conductance(1.0),
                          temperature=np.random.default_rng(0).uniform(280, 400, count))
    network.convect(np.arange(0, count, 50), 1e-3, 293.0)
    began = time.process_time()
    step = network.stable_step()
    seconds["stable_step"] = time.process_time() - began
    rounds = []
    for _ in range(5):
        began = time.process_time()
        network.advance(40 * 0.5 * step, step=0.5 * step)
        rounds.append((time.process_time() - began) / 40)
    seconds["heat_step"] = median(rounds)
    began = time.process_time()
    network.rewire(edges=found.edges, conductance=found.conductance(1.0))
    seconds["rewire"] = time.process_time() - began
    return {"nodes": count, "contacts": len(found.edges), **seconds}


# ---- what is shown

def models_figure(found):
    """Conductivity of every packing under every model, and the noise of its temperatures."""
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    colours = dict(zip(MODELS, ["#9a9a92", "#c8a15a", "#b0522a", "#3b7fb0", "#222222"]))
    for row, (name, models) in enumerate(found.items()):
        for k, (model, values) in enumerate(models.items()):
            place = row + 0.14 * (k - 2)
            left.plot(100 * (values[:, :2].mean(axis=1) - 1), np.full(len(values), place), "o", color=colours[model],
                      markersize=4, label=model if row == 0 else None)
            right.plot(100 * values[:, 2], np.full(len(values), place), "o", color=colours[model], markersize=4)
    left.axvspan(-1, 1, color="0.9", zorder=-1)
    left.set_xscale("symlog", linthresh=1.0)
    left.set(xlabel="conductivity off by / %", yticks=range(len(found)), yticklabels=list(found))
    ticks = [-50, -10, -1, 0, 1, 10, 30]
    left.set_xticks(ticks, map(str, ticks))
    left.invert_yaxis()
    right.set(xlabel="rms deviation from the linear temperature / % of its range", xscale="log")
    figure.get_layout_engine().set(rect=(0, 0.08, 1, 0.92))
    figure.legend(*left.get_legend_handles_labels(), loc="lower center", ncols=5, fontsize=8)
    return figure


def convergence_figure(space, in_time):
    """Errors over the number of diameters across, and over the heat step."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    across, rms, largest = np.array(space).T
    left.loglog(1 / across, 100 * rms, "o-", label=f"rms, order {-order(space):.2f}")
    left.loglog(1 / across, 100 * largest, "o:", markerfacecolor="white",
                label=f"largest, order {-order(space, 2):.2f}")
    left.axhline(0.5, color="0.6", lw=0.8, ls="--")
    left.set_xticks(1 / across, [f"1/{n:g}" for n in across])
    left.minorticks_off()
    left.set(xlabel="mean diameter / thickness", ylabel="error / % of the jump")
    fraction, against_fine, against_exact = np.array(in_time).T
    right.loglog(fraction, 100 * against_fine, "o-", label=f"of the step alone, order {order(in_time[1:]):.2f}")
    right.loglog(fraction, 100 * against_exact, "s:", label="step and size, 40 across")
    right.axvline(0.5, color="k", lw=0.8, ls=":")
    right.text(0.5, right.get_ylim()[0], " default", rotation=90, va="bottom", ha="right", fontsize=8)
    right.set_xticks(fraction, [f"{f:g}" for f in fraction])
    right.minorticks_off()
    right.set(xlabel="heat step / stable step")
    for axes in (left, right):
        axes.legend(fontsize=8)
    return figure


def tip_figure(by_size, by_visit):
    """Error of the temperature of a heated face: by node size, and by the period between visits."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    size, node, face = np.array(by_size).T
    left.loglog(size, 100 * abs(node), "o-", label="temperature of the node")
    left.loglog(size, 100 * abs(face), "s-", label="carried on to the face through the half cell")
    left.set_xticks(size, [f"{s:g}" for s in size])
    left.minorticks_off()
    left.set(xlabel="node diameter / depth of the heat, sqrt(a t)", ylabel="error of the face's temperature / %")
    for size, rows in by_visit.items():
        visit, error = np.array(rows).T
        right.loglog(visit, 100 * abs(error), "o-", label=f"node diameter {size:g} sqrt(a t)")
    right.set_xticks(visit, [f"{v:g}" for v in visit])
    right.minorticks_off()
    right.set(xlabel="time between visits / time of heating", ylabel="error that visits add / %")
    for axes in (left, right):
        axes.legend(fontsize=8)
    return figure


def tip_lines(by_size, by_visit):
    """The same as lines of markdown."""
    return ["Temperature of a tip whose face takes up a flux, against the exact one. The heat of t seconds is",
            "sqrt(a t) deep (steel: 0.3 mm in 5 ms, 3 mm in 0.5 s):",
            "nodes larger than that show a mean over themselves, and no",
            "heat step makes up for it; half a cell's flux q d/(2 lambda) on top of the node does, from a node of",
            "sqrt(a t) down.", "",
            "![tip](heat_tip.png)", "",
            "| node diameter / sqrt(a t) | error of the node, % | carried on to the face, % |", "|---|---|---|",
            *(f"| {size:g} | {100 * node:+.1f} | {100 * face:+.1f} |" for size, node, face in by_size), "",
            "Visits that bring the heat gathered since the last one add:", "",
            "| time between visits / time of heating | "
            + " | ".join(f"diameter {size:g} sqrt(a t), %" for size in by_visit) + " |",
            "|---" * (1 + len(by_visit)) + "|",
            *(f"| {visit:g} | " + " | ".join(f"{100 * rows[k][1]:+.2f}" for rows in by_visit.values()) + " |"
              for k, visit in enumerate(VISITS)), ""]


def curve(folder):
    """For make bench: error of the tip's temperature against node size and visit period, as lines and a figure."""
    tip = tip_errors()
    with matplotlib.rc_context(plots.STYLE):
        tip_figure(*tip).savefig(folder / "heat_tip.png")
    return tip_lines(*tip)


def markdown(found, space, in_time, tip, seconds):
    """heat.md."""
    lines = ["# Heat: conductances, convergence, cost", "",
             f"Conductivity of random packings ({SIDE * 1e3:g} mm square, smallest radius {SMALLEST * 1e3:g} mm, seeds",
             f"{', '.join(map(str, SEEDS))}) over that of the material, off by so many per cent: mean of both",
             "directions (mean over seeds, and the seed that is off most);",
             "greatest difference of the two directions, seen",
             "through a window of some hundred particles; and how far steady temperatures are off a linear field,",
             "of its range.",
             "", "![models](heat_conductances.png)", "",
             "| packing | model | mean, % | worst seed, % | x against y, % | temperatures, % |",
             "|---|---|---|---|---|---|"]
    for name, models in found.items():
        for model, values in models.items():
            off = 100 * (values[:, :2].mean(axis=1) - 1)
            between = 100 * np.abs(values[:, 0] / values[:, 1] - 1).max()
            lines.append(f"| {name} | {model} | {off.mean():+.2f} | {off[np.abs(off).argmax()]:+.2f} | {between:.2f} | "
                         f"{100 * values[:, 2].mean():.2f} |")
    lines += ["", "One conductance for all contacts, even the best, leaves each particle where its few contacts put",
              "it; the faces of the cells put it on the line, and need no fit.", "",
              "M 7.6.3 (faces that jump) on random packings, t = 0.05 L²/a, against the exact solution:", "",
              "![convergence](heat_convergence.png)", "",
              "| diameters across | rms error, % of the jump | largest, % |", "|---|---|---|",
              *(f"| {n} | {100 * rms:.4f} | {100 * largest:.4f} |" for n, rms, largest in space),
              f"| order | {-order(space):.2f} | {-order(space, 2):.2f} |", "",
              "| heat step over the stable one | rms error of the step, % | of step and size (40 across), % |",
              "|---|---|---|",
              *(f"| {f:g} | {100 * fine:.4f} | {100 * exact:.4f} |" for f, fine, exact in in_time),
              f"| order up to 0.5 | {order(in_time[1:]):.2f} | |", "",
              *tip_lines(*tip),
              f"Cost at {seconds['nodes']:,} nodes and {seconds['contacts']:,} contacts (processor time, one core):",
              f"a heat step {1e3 * seconds['heat_step']:.1f} ms;",
              f"after a change of contacts {1e3 * seconds['rewire']:.0f} ms for the new matrix and "
              f"{1e3 * seconds['stable_step']:.0f} ms for its stable step;",
              f"cells, once a run, {seconds['cells']:.1f} s.",
              ""]
    return "\n".join(lines)


# ---- make validate

def benchmarks(runs):
    """Errors and orders of the three benchmarks of M 7.6 on three packings."""
    result, rows = runs["heat_benchmarks"].result, []
    for name in ("slab_source", "half_space", "jump"):
        for kind in ("random", "square", "triangular"):
            words = f"{name.replace('_', ' ')}, {kind}"
            rows += [Row(f"{words}: largest error, of the range", 0.0, result(f"{name}_{kind}_largest_error"), 0.005),
                     Row(f"{words}: order in space at least 1.7", 1, result(f"{name}_{kind}_order_in_space") > 1.7, 0)]
    return rows, {}


def conductances(runs):
    """Conductivity of packings that nothing was fitted to, and orders of convergence."""
    found, space, in_time = conductivities(), errors_in_space(), errors_in_time()
    rows = []
    for name, models in found.items():
        for model, allowed in (("cells", 1e-6), ("fitted to each packing", 1e-6)):
            worst = models[model][:, :2].mean(axis=1)
            rows.append(Row(f"{name}, {model}: conductivity over the material's", 1.0,
                            float(worst[np.abs(worst - 1).argmax()]), allowed))
    rows += [Row("order in space of M 7.6.3 on random packings", 2.0, -order(space), 0.3),
             Row("order in time", 1.0, order(in_time[1:]), 0.15)]
    return rows, {"conductances": models_figure(found), "heat_convergence": convergence_figure(space, in_time)}


SECTIONS = [
    Section("Heat benchmarks", "M 7.6 on three packings: the largest error of any disc at any of its instants.",
            benchmarks, {"heat_benchmarks": ("yade_scripts/heat_benchmarks.py", {})}),
    Section("Conductances", "What packings conduct by the faces of their cells, by a fit, and by bars.", conductances)]


def main(folder):
    """All studies, figures and heat.md."""
    folder.mkdir(parents=True, exist_ok=True)
    found, space, in_time, tip, seconds = conductivities(), errors_in_space(), errors_in_time(), tip_errors(), cost()
    with matplotlib.rc_context(plots.STYLE):
        models_figure(found).savefig(folder / "heat_conductances.png")
        convergence_figure(space, in_time).savefig(folder / "heat_convergence.png")
        tip_figure(*tip).savefig(folder / "heat_tip.png")
    text = markdown(found, space, in_time, tip, seconds)
    (folder / "heat.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/heat"))

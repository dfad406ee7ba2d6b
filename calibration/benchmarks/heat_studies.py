"""Studies of heat conduction in packings: conductivity, convergence, a heated face, processor time. Kernels only."""
import time
from statistics import median

import numpy as np

from rockwear.kernels import analytic, packing
from rockwear.kernels.conduction import HeatNetwork, bar_conductance, calibrated_conductance, effective_conductivity
from rockwear.kernels.voronoi import cells
from rockwear.model.cache import cached

SEEDS = 1, 2, 3, 4, 5
ROCKS = {"uniform 1-1.5 mm": dict(ratio=1.5, porosity=0.12), "uniform 1-1.2 mm": dict(ratio=1.2, porosity=0.12),
         "uniform 1-2.5 mm": dict(ratio=2.5, porosity=0.12), "denser, 0.06": dict(ratio=1.5, porosity=0.06),
         "looser, 0.16": dict(ratio=1.5, porosity=0.16), "graded 1 to 3": dict(ratio=1.5, porosity=0.12, graded=3.0)}
"""Packings in a square: ratio of radii, porosity, and growth of the radii from top to bottom."""
SIDE, SMALLEST = 0.08, 1e-3
MODELS = ("bars r wide [Rojek 2003]", "bars 2r wide [Rojek 2014]", "fitted to the first packing",
          "fitted to each packing", "Voronoi cells")
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
    """Steady state: (conductivity in x and y, rms deviation of temperatures from the linear field over its range)."""
    conductivity = effective_conductivity(positions=positions, edges=edges, conductance=conductance)
    network = HeatNetwork(capacity=np.ones(len(positions)), edges=edges, conductance=conductance, temperature=0.0)
    linear = positions[:, 0] / side
    strips = (linear < 0.1) | (linear > 0.9)
    network.fix(strips, linear[strips])
    return conductivity, float(np.sqrt(np.mean((network.steady_state() - linear)[~strips] ** 2)))


def conductivities():
    """{packing: {model: (seeds, 3) conductivity in x and y over the material's, and noise}}."""
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
    """(cells, depths) of a random packing of `across` mean diameters over a slab of thickness 1 and height 1/4."""
    radius = 1 / (2 * across)
    smallest = 2 * radius / 2.5

    def make():
        found = packing.pack(box=(1.0, 0.25), radius_min=smallest, radius_max=1.5 * smallest, porosity=0.12, seed=seed)
        return {"positions": found.positions}

    positions = cached(make, study="slab", across=across, seed=seed)["positions"]
    return cells(positions, box=(1.0, 0.25)), positions[:, 0]


MATERIAL = dict(conductivity=1.0, density=1.0, specific_heat=1.0)


def jump(found):
    """The network of [Rojek 2003, 7.6.3] over these cells, with a step of 1 at both faces."""
    network = HeatNetwork(capacity=found.volumes, edges=found.edges, conductance=found.conductance(1.0),
                          temperature=0.0)
    for side in (0, 1):
        network.convect(*found.wall_conductance(side, 1.0), 1.0)
    return network


def errors_in_space(sizes=(20, 40, 80, 160), instant=0.05):
    """[(across, rms error, largest error)] of [Rojek 2003, 7.6.3], means over three packings."""
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
    """Temperature of a face under a flux over the exact one: (at the first node, extrapolated through its half cell).

    size   node diameter over the depth sqrt(a t) that heat has reached
    visit  seconds between visits over t, each adding the heat collected since the last one at once; None: steady flux
    One row of cells represents any packing, since the problem is uniform across the flux.
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
    """([(size, errors at node and face)], {size: [(visit, additional error of the visits at the node)]})."""
    by_size = [(size, *(found - 1 for found in heated_face(size=size))) for size in SIZES]
    by_visit = {size: [(visit, heated_face(size=size, visit=visit)[0] / heated_face(size=size)[0] - 1)
                       for visit in VISITS] for size in (2.0, 1.0, 0.5)}
    return by_size, by_visit


def order(rows, column=1):
    """Slope of log error over log of the first column."""
    sizes, errors = np.array(rows, float)[:, [0, column]].T
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def cost(rock_discs=92_000, tool_discs=5_400):
    """Seconds of a heat step, of its stable step, and of new edges, at the size of the dredging in [Rojek 2014, 5]."""
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

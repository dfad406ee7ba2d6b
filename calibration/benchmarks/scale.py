"""What a step of YADE costs by the number of particles, their order in memory, the collider's stride, and threads.

    python3 -m calibration.benchmarks.scale DIR [--large]        (part of make bench, without --large)

Runs calibration/benchmarks/scale_block.py, one process at a time except for the jobs side by side, all cases of a turn
one after the other; blocks that DIR has are kept. --large: a million discs and a hundred thousand spheres too, in one
turn. Writes scale.md, scale.json and scale.png into DIR.
"""
import json
import math
import os
import subprocess
from statistics import median

import matplotlib

from calibration import generated
from calibration.benchmarks import one_curve
from calibration.campaigns.runs import ROOT, RunFailed, command, run_script
from rockwear.report import plots

SCRIPT = "calibration/benchmarks/scale_block.py"
ORDERS = "scattered", "packing", "curve"
ALL, CURVE = ORDERS, ORDERS[2:]
SIZES = {2: {1000: CURVE, 2000: ALL, 4000: CURVE, 8000: CURVE, 20_000: ALL, 92_000: ALL},
         3: {2000: ALL, 20_000: ALL}}
"""{dimensions: {particles: orders}}; spheres in a lattice are packed row by row."""
LARGE = {2: {1_000_000: CURVE}, 3: {97_336: CURVE}}
"""With --large: in one turn."""
FIRST, LAST = 2000, 92_000
"""Discs between which the growth is said in one number."""
VERLET = 0.1, 0.25, 0.5, 1.0
VERLET_SIZE = THREADS_SIZE = 20_000
THREADS = ("one job, -j1", 1, 1), ("one job, -j2", 1, 2), ("two jobs, -j1, together", 2, 1)
"""Words, jobs, threads of each."""
TURNS = 3
WORK = 8e6
"""Bonds times steps that are timed."""


def words(particles, dimensions=2, **options):
    """Words of the command line of a block."""
    steps = max(40, round(WORK / (3 * particles)))
    values = {"particles": particles, "dimensions": dimensions, "steps": steps, **options}
    return [word for name, value in values.items() for word in (f"--{name}", str(value))]


def block(folder, **options):
    """Run one block, unless the folder has it. -> what it writes."""
    if not (folder / "scale_block.json").exists():
        run_script(SCRIPT, folder, words(**options))
    return read(folder)


def read(folder):
    """What a block has written."""
    return json.loads((folder / "scale_block.json").read_text(encoding="utf-8"))


def together(folder, jobs, threads):
    """Steps per second of all of `jobs` blocks at once, each with so many threads; what the folders have is kept."""
    folders = [folder / f"{jobs}x{threads}-{n}" for n in range(jobs)]
    if not all((one / "scale_block.json").exists() for one in folders):
        started = [subprocess.Popen(command(SCRIPT, one, words(THREADS_SIZE), threads), stdin=subprocess.DEVNULL,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                    env={**os.environ, "PYTHONPATH": str(ROOT)}) for one in folders]
        if any([one.wait() for one in started]):
            raise RunFailed(f"{jobs} jobs of {threads} threads failed")
    return sum(1 / read(one)["wall"] for one in folders)


def name_of(dimensions, particles, order):
    """The name of a case."""
    return f"{dimensions}D-{particles}-{order}"


def blocks(sizes):
    """{name: options} of the blocks of such sizes."""
    return {name_of(d, n, order): dict(particles=n, dimensions=d, order=order)
            for d, of in sizes.items() for n, orders in of.items() for order in orders}


def verlet():
    """{name: options} of the blocks with other Verlet distances."""
    return {f"verlet-{v}": dict(particles=VERLET_SIZE, verlet=v) for v in VERLET}


def measure(folder, large):
    """({case: [what it wrote in each turn]}, {words: [steps per second in each turn]})."""
    found, rates = {}, {name: [] for name, *_ in THREADS}
    for turn in range(TURNS):
        place = folder / "scale" / str(turn)
        for name, options in {**blocks(SIZES), **verlet()}.items():
            found.setdefault(name, []).append(block(place / name, **options))
        for name, jobs, threads in THREADS:
            rates[name].append(together(place, jobs, threads))
    for name, options in blocks(LARGE if large else {}).items():
        found[name] = [block(folder / "scale/large" / name, **options)]
    return found, rates


def nanoseconds(runs):
    """(k,) ns of processor time per bond and step."""
    return [1e9 * run["cpu"] / run["bonds"] for run in runs]


def half_range(values):
    """Half of what lies between the least and the largest."""
    return 0.5 * (max(values) - min(values))


def cell(values, digits=0):
    """A table's cell: the median, with half of the range where there are several."""
    return f"{median(values):.{digits}f}" + (f" ± {half_range(values):.{digits}f}" if len(values) > 1 else "")


def of_order(found, dimensions, order):
    """[(particles, runs)] of the blocks of one order, by size."""
    cases = {**SIZES[dimensions], **LARGE[dimensions]}
    return [(n, found[name_of(dimensions, n, order)]) for n in sorted(cases)
            if name_of(dimensions, n, order) in found]


def growth(first, last):
    """(how many times as long a bond takes per step in the second of two blocks [runs], exponent of the time per step
    over the particles)."""
    (a, b), (n, m) = (median(nanoseconds(runs)) for runs in (first, last)), (runs[0] for runs in (first, last))
    return b / a, math.log(b * m["bonds"] / (a * n["bonds"])) / math.log(m["particles"] / n["particles"])


def over_all(found, order):
    """Words: growth in the plane from FIRST to LAST."""
    factor, exponent = growth(*(found[name_of(2, n, order)] for n in (FIRST, LAST)))
    return f"{factor:.2f} times as long per bond and step, exponent {exponent:.2f}"


def table(found, rates):
    """Lines of Markdown."""
    rows = []
    for d in SIZES:
        before = None
        for n, curve_runs in of_order(found, d, "curve"):
            times = {order: found.get(name_of(d, n, order)) for order in ORDERS}
            gain = (f"{median(nanoseconds(curve_runs)) / median(nanoseconds(times['packing'])):.2f}"
                    if times["packing"] else "–")
            off = abs(curve_runs[0]["energy"] / times["scattered"][0]["energy"] - 1) if times["scattered"] else None
            rows.append([d, curve_runs[0]["particles"], curve_runs[0]["bonds"],
                         *(cell(nanoseconds(runs)) if runs else "–" for runs in times.values()), gain,
                         f"{growth(before, curve_runs)[1]:.2f}" if before else "–",
                         cell([1e-3 * run["bytes"] for run in curve_runs], 1), "–" if off is None else f"{off:.0e}"])
            before = curve_runs
    return ["## Scale", "",
            f"Processor time of YADE by itself per bond and step: medians of {TURNS} turns ± half of the range; blocks "
            "without ± ran once. Particles scattered in memory, in the packing's own order, and along Morton's curve. "
            "Growth: exponent of the time per step over the particles, along the curve, from the size before.", "",
            *generated.table(["dimensions", "particles", "bonds", *(f"ns, {order}" for order in ORDERS),
                              "curve over packing", "growth", "kB per particle", "difference of kinetic energy"], rows),
            f"From {FIRST} to {LAST} discs: " + "; ".join(f"{order} {over_all(found, order)}" for order in ORDERS)
            + ".", "",
            f"Verlet distance of the collider, {VERLET_SIZE} discs moving at up to 10 m/s:", "",
            *generated.table(["over the least radius", "ns per bond and step"],
                             [[v, cell(nanoseconds(found[f"verlet-{v}"]))] for v in VERLET]),
            f"Steps per second of {THREADS_SIZE} discs by the clock, all jobs together:", "",
            *generated.table(["jobs and threads", "steps per second", "over the first"],
                             [[name, cell(of, 1), f"{median(of) / median(rates[THREADS[0][0]]):.2f}"]
                              for name, of in rates.items()])]


def drawn(found):
    """The figure: time per bond and step, and memory, over the particles."""
    figure, (left, right) = plots.canvas(11, 4.4, 1, 2)
    for d, mark in ((2, "o"), (3, "s")):
        place = "plane" if d == 2 else "space"
        for order, style in zip(ORDERS, (":", "--", "-")):
            particles, runs = zip(*of_order(found, d, order))
            times = list(map(nanoseconds, runs))
            left.errorbar(particles, list(map(median, times)), list(map(half_range, times)), fmt=mark + style, ms=4,
                          capsize=2, color=f"C{d - 2}", label=f"{place}, {order}")
        right.plot(particles, [median(run["bytes"] for run in turns) for turns in runs], mark + "-",
                   color=f"C{d - 2}", label=place)
    left.set_title(f"{FIRST} to {LAST} discs, along the curve:\n{over_all(found, 'curve')}", fontsize=9)
    left.set_ylabel("ns per bond and step")
    right.set_ylabel("bytes per particle")
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_xlabel("particles")
        axes.set_ylim(bottom=0)
        axes.legend(fontsize=8)
    return figure


def curve(folder, large=False):
    """Run all, write scale.json and scale.png into `folder`. -> the lines of the tables."""
    folder.mkdir(parents=True, exist_ok=True)
    found, rates = measure(folder, large)
    (folder / "scale.json").write_text(json.dumps({"blocks": found, "threads": rates}, indent=1), encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        drawn(found).savefig(folder / "scale.png")
    generated.record(folder / "scale.png", folder / "scale.json")
    return table(found, rates)


if __name__ == "__main__":
    one_curve.main(curve, "--large")

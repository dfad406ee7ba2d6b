"""What a step of YADE costs by the number of particles, their order in memory, the collider's stride, and threads.

    python3 -m calibration.benchmarks.scale DIR        (part of make bench)

Runs calibration/benchmarks/scale_block.py, one process at a time except for the jobs side by side, all cases of a turn
one after the other; blocks that DIR has are kept. Writes scale.md, scale.json and scale.png into DIR.
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
SIZES = {2: (2000, 20_000, 92_000), 3: (2000, 20_000)}
ORDERS = "scattered", "curve"
VERLET = 0.1, 0.25, 0.5, 1.0
VERLET_SIZE = THREADS_SIZE = 20_000
THREADS = ("one job, -j1:", 1, 1), ("one job, -j2:", 1, 2), ("two jobs, -j1, together:", 2, 1)
"""Words, jobs, threads of each."""
TURNS, LARGE = 3, 10_000
"""Turns, one from LARGE particles on."""
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
    """Steps per second of all of `jobs` blocks at once, each with so many threads."""
    folders = [folder / f"{jobs}x{threads}-{n}" for n in range(jobs)]
    started = [subprocess.Popen(command(SCRIPT, one, words(THREADS_SIZE), threads), stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                env={**os.environ, "PYTHONPATH": str(ROOT)}) for one in folders]
    if any([one.wait() for one in started]):
        raise RunFailed(f"{jobs} jobs of {threads} threads failed")
    return sum(1 / read(one)["wall"] for one in folders)


def cases():
    """{name: options} of all blocks."""
    sizes = {f"{d}D-{n}-{order}": dict(particles=n, dimensions=d, order=order)
             for d in SIZES for n in SIZES[d] for order in ORDERS}
    return {**sizes, **{f"verlet-{v}": dict(particles=VERLET_SIZE, verlet=v) for v in VERLET}}


def measure(folder):
    """{case: what it wrote, `ns` (median) per bond and step}."""
    found = {name: [] for name in cases()}
    for turn in range(TURNS):
        for name, options in cases().items():
            if not turn or options["particles"] < LARGE:
                found[name].append(block(folder / f"scale/{turn}-{name}", **options))
    return {name: {**runs[0], "ns": 1e9 * median(run["cpu"] / run["bonds"] for run in runs)}
            for name, runs in found.items()}


def exponents(rows):
    """Exponents of the time per step over the particles, between neighbouring sizes."""
    return [math.log(b["ns"] * b["bonds"] / (a["ns"] * a["bonds"])) / math.log(b["particles"] / a["particles"])
            for a, b in zip(rows, rows[1:])]


def table(found, threads):
    """Lines of Markdown."""
    rows = []
    for d, sizes in SIZES.items():
        by_order = {order: [found[f"{d}D-{n}-{order}"] for n in sizes] for order in ORDERS}
        growth = {order: ["–", *(f"{e:.2f}" for e in exponents(of))] for order, of in by_order.items()}
        for k, (scattered, curve) in enumerate(zip(*by_order.values())):
            rows.append([f"{d}", curve["particles"], curve["bonds"], f"{scattered['ns']:.0f}", f"{curve['ns']:.0f}",
                         f"{curve['ns'] / scattered['ns']:.2f}", growth["scattered"][k], growth["curve"][k],
                         f"{1e-3 * curve['bytes']:.1f}", f"{abs(curve['energy'] / scattered['energy'] - 1):.0e}"])
    return ["## Scale", "",
            "Processor time of YADE by itself per bond and step; particles scattered in memory and along Morton's "
            "curve. Growth: exponent of the time per step over the particles, from the size before.", "",
            *generated.table(["dimensions", "particles", "bonds", "ns, scattered", "ns, curve", "ratio",
                              "growth, scattered", "growth, curve", "kB per particle", "difference of kinetic energy"],
                             rows),
            f"Verlet distance of the collider, {VERLET_SIZE} discs moving at up to 10 m/s:", "",
            *generated.table(["over the least radius", "ns per bond and step"],
                             [[v, f"{found[f'verlet-{v}']['ns']:.0f}"] for v in VERLET]),
            f"Steps per second of {VERLET_SIZE} discs by the clock: " + ", ".join(
                f"{words} {rate:.1f}" for words, rate in threads.items()) + ".", ""]


def drawn(found):
    """The figure: time per bond and step, and memory, over the particles."""
    figure, (left, right) = plots.canvas(10, 4.2, 1, 2)
    for d, mark in ((2, "o"), (3, "s")):
        for order, style in (("scattered", "--"), ("curve", "-")):
            rows = [found[f"{d}D-{n}-{order}"] for n in SIZES[d]]
            left.semilogx([row["particles"] for row in rows], [row["ns"] for row in rows], mark + style,
                          color=f"C{d - 2}", label=f"{'plane' if d == 2 else 'space'}, {order}")
        right.semilogx([row["particles"] for row in rows], [1e-3 * row["bytes"] for row in rows], mark + "-",
                       color=f"C{d - 2}", label="plane" if d == 2 else "space")
    left.set_ylabel("ns per bond and step")
    right.set_ylabel("kB per particle")
    for axes in (left, right):
        axes.set_xlabel("particles")
        axes.set_ylim(bottom=0)
        axes.legend(fontsize=8)
    return figure


def curve(folder):
    """Run all, write scale.json and scale.png into `folder`. -> the lines of the tables."""
    folder.mkdir(parents=True, exist_ok=True)
    found = measure(folder)
    threads = {name: together(folder / "scale", jobs, n) for name, jobs, n in THREADS}
    (folder / "scale.json").write_text(json.dumps({"blocks": found, "threads": threads}, indent=1), encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        drawn(found).savefig(folder / "scale.png")
    generated.record(folder / "scale.png", folder / "scale.json")
    return table(found, threads)


if __name__ == "__main__":
    one_curve.main(curve)

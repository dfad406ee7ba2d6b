"""Does the worn shape depend on the size of the tool's particles? And what does the removal rule change?

    python3 -m calibration.particle_size DIR

Flat: a tooth rubs on a plane, and what touches it wears. Whatever the particles, the worn tooth must be the new one cut
off by the plane that takes away Archard's volume: an exact outline. Cut: the test tooth in miniature, real contacts,
stopped at one worn volume. Sizes are mean diameters. Leaves particle_size.png and particle_size.md in DIR.
"""
import math
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from calibration.runs import Runs
from rockwear.kernels.outline import area, tooth
from rockwear.materials import STEEL
from rockwear.report import plots, shapes
from rockwear.tool import Tool

SIZES = 0.3e-3, 0.5e-3, 0.8e-3
SPREAD = 0.12
"""Radii differ by this part of the mean either way, as M's 0.4 to 0.52 mm."""
SEEDS = 1, 2, 3
OUTLINE = dict(height=0.03, width=0.02, rake=math.radians(10), clearance=math.radians(10), tip_radius=2e-3)
DOWN = np.array([math.sin(math.radians(30)), -math.cos(math.radians(30))])
"""Towards the plane that the tooth rubs on: below and before it."""
WORN = 20e-6
"""Worn volume of the comparison, m3 per metre of thickness."""
GRID = 2e-5
CUT = dict(width=0.06, height=0.04, radius_min=1.5e-3, radius_max=2.2e-3, tooth_height=0.03, tooth_width=0.02, rake=10,
           clearance=10, tip_radius=2e-3, depth_of_cut=0.01, start_up=0.006, cycles=0, snapshot_period=5e-5, heat="false",
           acceleration=2e5, report="false")
CUT_WORN = 8e-6


def cut_off(polygon, height):
    """What of a polygon (k, 2) lies not further than `height` along DOWN."""
    kept = []
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
        over = a @ DOWN - height, b @ DOWN - height
        if over[0] <= 0:
            kept.append(a)
        if over[0] * over[1] < 0:
            kept.append(a + (b - a) * over[0] / (over[0] - over[1]))
    return np.array(kept)


def exact(polygon, volume):
    """(outline, height along DOWN) of the polygon without the area `volume` that lies furthest along DOWN."""
    heights = polygon @ DOWN
    height = brentq(lambda h: area(polygon) - area(cut_off(polygon, h)) - volume, heights.min() + 1e-6, heights.max())
    return cut_off(polygon, height), height


def particles(polygon, size, seed, removal):
    """The tooth filled with particles of a mean diameter."""
    return Tool(vertices=polygon, radius_min=(1 - SPREAD) * size / 2, radius_max=(1 + SPREAD) * size / 2, seed=seed,
                removal=removal, material=STEEL)


def rub(tool, volume, parts=8):
    """Wear `volume` (m3) off what reaches furthest along DOWN: a rigid tool's one bearing particle, a part at a time."""
    erosion, reach = tool.erosion, tool.positions @ DOWN + tool.radii
    portion = float(tool.volumes.mean()) / parts
    visits = math.ceil(volume / portion)
    for _ in range(visits):
        skin = np.fromiter(erosion.skin, int)
        worn = np.zeros(tool.count)
        worn[skin[np.argmax(reach[skin])]] = volume / visits
        erosion.wear(worn)
        erosion.drop(erosion.detached() if not erosion.alive[tool.mounted].all() else [])
    return tool


def flat_row(polygon, size, seed, removal):
    """One tooth rubbed: its outline, and how far it is off the exact one."""
    tool = rub(particles(polygon, size, seed, removal), WORN)
    alive = tool.erosion.alive
    target, height = exact(polygon, WORN)
    ends = [p for p in target if abs(p @ DOWN - height) < 1e-9]
    along = np.array([DOWN[1], -DOWN[0]])
    low, high = sorted(float(p @ along) for p in ends)
    # The flat as the plane feels it: the furthest reach over strips a coarse particle wide, away from its corners.
    strips = np.arange(low + SIZES[-1], high - SIZES[-1], SIZES[-1] / 2)
    across, reach = tool.positions[alive] @ along, tool.positions[alive] @ DOWN + tool.radii[alive]
    off = np.array([reach[abs(across - s) < SIZES[-1] / 2].max() - height for s in strips])
    book = tool.erosion.volume_balance()
    return SimpleNamespace(size=size, seed=seed, off=float(np.sqrt(np.mean(off**2))), mean=float(off.mean()),
                           unexplained=book["unexplained"] / book["archard"], tool=tool,
                           outline=shapes.outlines(tool.positions[alive], tool.radii[alive])[0])


def rate(sizes, errors):
    """Exponent of the errors over the sizes."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def cut_shape(run):
    """Outline (m) at the worn volume CUT_WORN, and the volume that the rule leaves unexplained there, of Archard's."""
    model = run.model
    volume = np.interp(run.times, run.column("time"), run.column("worn_volume"))
    shot = run.snapshot(int(np.argmin(abs(volume - CUT_WORN))))
    book = run.summary["audits"]["mass"]
    alive = shot["alive"]
    return SimpleNamespace(outline=shapes.outlines(model["tool_positions"][alive], model["tool_radii"][alive],
                                                   shot["worn_depth"][alive])[0],
                           worn=float(volume[np.argmin(abs(volume - CUT_WORN))]),
                           unexplained=book["unexplained"] / book["archard"], removed=run.result("particles_removed"),
                           end=book["archard"] / STEEL.density)


def mask(outline, box):
    """Cells of a grid over box = (left, right, bottom, top) m that lie inside a polygon."""
    from matplotlib.path import Path as Polygon
    x, y = (np.arange(box[2 * k] + GRID / 2, box[2 * k + 1], GRID) for k in (0, 1))
    points = np.stack(np.meshgrid(x, y), -1)
    return Polygon(outline).contains_points(points.reshape(-1, 2))


def main(folder):
    """Rub, cut, compare; write the page's pieces."""
    folder.mkdir(parents=True, exist_ok=True)
    polygon = tooth(**OUTLINE)
    with Runs(folder, at_once=1, keep=True) as runs:
        futures = {(size, rule): runs.start(f"cut_{1e3 * size:g}mm_{rule}", "yade_scripts/test_tooth.py", **CUT, removal=rule,
                                            tool_radius_min=(1 - SPREAD) * size / 2, tool_radius_max=(1 + SPREAD) * size / 2)
                   for size, rule in [*((size, "volume") for size in SIZES), (SIZES[1], "depth")]}
        flat = {size: [flat_row(polygon, size, seed, "volume") for seed in SEEDS] for size in SIZES}
        depth = flat_row(polygon, SIZES[1], SEEDS[0], "depth")
        cuts = {key: cut_shape(future.result()) for key, future in futures.items()}
    off = [float(np.sqrt(np.mean([row.off**2 for row in flat[size]]))) for size in SIZES]
    exponent = rate(SIZES, off)
    lines = ["# Particle size and removal rule", "",
             f"A tooth of 30 x 20 mm. Flat: {1e6 * WORN:g} mm2 rubbed off on a plane; `off` is the root mean square distance of the "
             "flat it leaves from the exact plane, three packings.", "",
             "| mean diameter, mm | off, mm | over diameter | volume unexplained | cut: off the finest, of the worn area |",
             "|---|---|---|---|---|"]
    box = (-1e-3, 21e-3, -1e-3, 12e-3)
    finest = mask(cuts[SIZES[0], "volume"].outline, box)
    for size, error in zip(SIZES, off):
        differs = np.sum(mask(cuts[size, "volume"].outline, box) != finest) * GRID**2 / CUT_WORN
        worst = max(abs(row.unexplained) for row in flat[size])
        lines.append(f"| {1e3 * size:g} | {1e3 * error:.3f} | {error / size:.2f} | {worst:.0e} | {differs:.2f} |")
    a, b = cuts[SIZES[1], "volume"], cuts[SIZES[1], "depth"]
    lines += ["", f"The outline converges with the size to the power {exponent:.2f}.", "",
              f"Depth rule, 0.5 mm: explains {100 * depth.unexplained:+.1f} % of Archard's volume too little or much on the flat "
              f"and {100 * b.unexplained:+.1f} % in the cut ({b.removed} particles gone); the conserving rule "
              f"{flat[SIZES[1]][0].unexplained:+.0e} and {a.unexplained:+.0e} ({a.removed} particles gone)."]
    (folder / "particle_size.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    with matplotlib.rc_context(plots.STYLE):
        draw(polygon, flat, cuts, off, exponent).savefig(folder / "particle_size.png")


def closed(outline):
    """x and y (mm) of a polygon, back to its first corner."""
    return 1e3 * np.vstack([outline, outline[:1]]).T


def draw(polygon, flat, cuts, off, exponent):
    """Worn outlines on the plane and in the cut, and how the first converge."""
    figure = Figure(figsize=(14, 4.8), layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=(1, 1, 0.8))
    target, _ = exact(polygon, WORN)
    colours = dict(zip(SIZES, ("#2c6e91", "#c8a15a", "#b5341d")))
    for axes, title in ((left, f"rubbed on a plane, {1e6 * WORN:g} mm²"), (middle, f"cut, {1e6 * CUT_WORN:g} mm²")):
        axes.fill(*closed(polygon), facecolor="#eef0f1", edgecolor="0.6", linewidth=1, linestyle="--")
        axes.set(title=title, aspect="equal", xlabel="mm", xlim=(4, 21), ylim=(-1, 11))
    for size, colour in colours.items():
        left.plot(*closed(flat[size][0].outline), color=colour, linewidth=1.2, label=f"{1e3 * size:g} mm")
        middle.plot(*closed(cuts[size, "volume"].outline), color=colour, linewidth=1.2, label=f"{1e3 * size:g} mm")
    left.plot(*closed(target), color="black", linewidth=1.6, label="exact")
    middle.plot(*closed(cuts[SIZES[1], "depth"].outline), color="0.3", linewidth=1, linestyle=":", label="0.5 mm, depth rule")
    left.legend(loc="upper left")
    middle.legend(loc="upper left")
    sizes = 1e3 * np.array(SIZES)
    for row in [row for rows in flat.values() for row in rows]:
        right.loglog(1e3 * row.size, 1e3 * row.off, ".", color=colours[row.size])
    right.loglog(sizes, 1e3 * np.array(off), "o-", color="black", label=f"power {exponent:.2f}")
    right.loglog(sizes, 1e3 * off[-1] * sizes / sizes[-1], "--", color="0.6", label="power 1")
    right.set(xlabel="mean diameter / mm", ylabel="flat off the exact plane / mm", title="convergence")
    right.set_xticks(sizes, [f"{s:g}" for s in sizes])
    right.minorticks_off()
    right.legend()
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/particle_size"))

"""Does the worn shape depend on the size of the tool's particles? And what does the removal rule change?

    python3 -m calibration.benchmarks.particle_size DIR

Two ways of wearing whose outlines are known exactly, whatever the particles:

- flat: a tooth rubs on a plane, and the particle that bears it wears. What is left is the new tooth without the piece
  of Archard's volume that lies beyond a plane.
- pattern: the friction work that a cut of the test tooth in miniature spreads along the outline, smoothed, wears it
  along its normals. The depth d at the curvature c takes the volume d - c d^2 / 2 off a length.

Both are tried with segments of the same sizes too: both descriptions of the tooth must end at one outline. And with more or
less wear in a visit, which is what the period of wear, the acceleration and the work of a cut make of it.

Sizes are mean diameters. Leaves particle_size.png and particle_size.md in DIR.
"""
import math
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from calibration.campaigns.runs import Runs
from rockwear.model.facet_tool import FacetTool
from rockwear.kernels.polygon import area, tooth
from rockwear.model.materials import STEEL
from rockwear.report import plots, shapes
from rockwear.model.particle_tool import Tool

SIZES = 0.3e-3, 0.5e-3, 0.8e-3
SPREAD = 0.12
"""Radii differ by this part of the mean either way, as M's 0.4 to 0.52 mm."""
SEEDS = 1, 2, 3
OUTLINE = dict(height=0.03, width=0.02, rake=math.radians(10), clearance=math.radians(10), tip_radius=2e-3)
DOWN = np.array([math.sin(math.radians(30)), -math.cos(math.radians(30))])
"""Towards the plane that the tooth rubs on: below and before it."""
WORN, PATTERN_WORN = 20e-6, 4e-6
"""Worn volumes of the comparison, m3 per metre of thickness."""
STRIP = 0.8e-3
"""Length (m) over which the place of a worn face is averaged, that of the largest particles."""
RAYS = 0.05e-3
"""Distance (m) between the normals along which the pattern wears."""
SMOOTH = 2e-3
"""Standard deviation (m) of the smoothing of the pattern."""
CUT = dict(width=0.06, height=0.04, radius_min=1.5e-3, radius_max=2.2e-3, tooth_height=0.03, tooth_width=0.02, rake=10,
           clearance=10, tip_radius=2e-3, depth_of_cut=0.01, start_up=0.008, cycles=0, heat="false", wear_acceleration=1,
           tool_radius_min=0.22e-3, tool_radius_max=0.28e-3, report="false")
PORTIONS = 1 / 64, 1 / 8, 1 / 2, 2
"""Wear in a visit, of a particle's volume, at which the rules are tried."""


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


def rub(tool, volume, portion=1 / 8):
    """Wear `volume` (m3) off what reaches furthest along DOWN, the one particle that bears a rigid tool.

    portion: of a mean particle's volume, the wear in a visit.
    """
    erosion, reach = tool.erosion, tool.positions @ DOWN + tool.radii
    visits = math.ceil(volume / (portion * float(tool.volumes.mean())))
    for _ in range(visits):
        surface = np.fromiter(erosion.surface, int)
        worn = np.zeros(tool.count)
        worn[surface[np.argmax(reach[surface])]] = volume / visits
        erosion.wear(worn)


def unexplained(tool):
    """What a removal rule leaves unexplained, of Archard's volume."""
    balance = tool.erosion.volume_balance()
    return balance["unexplained"] / balance["archard"]


def face(polygon):
    """The exact flat face: its height (m) along DOWN, the direction along it, and its ends (m) in that direction."""
    target, height = exact(polygon, WORN)
    along = np.array([DOWN[1], -DOWN[0]])
    return height, along, *sorted(float(p @ along) for p in target if abs(p @ DOWN - height) < 1e-9)


def flat_of_segments(polygon, size, strip=STRIP):
    """As `flat`, of segments: the one that reaches furthest wears."""
    boundary = FacetTool.of_outline(polygon, segment=size, density=STEEL.density).boundary
    visits = math.ceil(WORN / (size**2 / 8))
    for _ in range(visits):
        reach = np.where(boundary.fixed, -np.inf, (boundary.vertices @ DOWN)[boundary.facets].mean(axis=1))
        boundary.wear(np.where(np.arange(len(reach)) == np.argmax(reach), WORN / visits, 0.0))
    height, along, low, high = face(polygon)
    across, reach = boundary.vertices @ along, boundary.vertices @ DOWN
    off = reach[(across > low + strip) & (across < high - strip) & (abs(reach - height) < strip)] - height
    return SimpleNamespace(outline=boundary.vertices[shapes.loop(boundary.facets)], off=float(np.sqrt(np.mean(off**2))),
                           unexplained=boundary.volume_balance()["unexplained"] / WORN)


def flat(polygon, size, seed, strip=STRIP):
    """A tooth rubbed on a plane: outline, and how far (m) its face is off the exact one, root mean square of strips."""
    tool = particles(polygon, size, seed, "volume")
    rub(tool, WORN)
    alive = tool.erosion.alive
    height, along, low, high = face(polygon)
    across, reach = tool.positions[alive] @ along, tool.positions[alive] @ DOWN + tool.radii[alive]
    places = np.arange(low + strip, high - strip, strip / 2)
    off = np.array([reach[abs(across - place) < strip / 2].max() - height for place in places])
    return SimpleNamespace(outline=left_of(tool), off=float(np.sqrt(np.mean(off**2))), unexplained=unexplained(tool))


def left_of(tool):
    """Outline of the particles that are left."""
    alive = tool.erosion.alive
    return shapes.outlines(tool.positions[alive], tool.radii[alive])[0]


class Pattern:
    """Where a cut wears the outline: density (n,) 1/m of the worn volume along it, normals, curvature."""

    def __init__(self, run):
        model, shot = run.model, run.snapshot(-1)
        points, arc = shapes.contour(model["outline"], RAYS)
        worn = shot["worn_depth"] * model["tool_radii"]
        nearest = cKDTree(points).query(model["tool_positions"])[1]
        density = gaussian_filter1d(np.bincount(nearest, worn, len(points)), SMOOTH / RAYS)
        steps = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        turned = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
        self.inward = np.column_stack([-np.sin(turned), np.cos(turned)])
        curvature = gaussian_filter1d(np.gradient(turned, RAYS), 2)
        self.worn = density > 0.01 * density.max()
        density = np.where(self.worn, density, 0.0)
        self.points, self.density, self.curvature = points, density / (density.sum() * RAYS), curvature

    def depth(self, volume):
        """(n,) m, d of d - c d^2 / 2 = volume times density."""
        area, c = volume * self.density, np.where(abs(self.curvature) < 1, 1e-3, self.curvature)
        return (1 - np.sqrt(np.maximum(1 - 2 * c * area, 0.0))) / c

    def entries(self, tool):
        """For each point the particles that its normal meets, and the depths (m) at which it enters them, in order."""
        tree = cKDTree(tool.positions)
        for point, normal in zip(self.points, self.inward):
            near = np.array(tree.query_ball_point(point + 2.5e-3 * normal, 3.5e-3), int)
            away = tool.positions[near] - point
            ahead, aside = away @ normal, away @ np.array([-normal[1], normal[0]])
            hit = (abs(aside) < tool.radii[near]) & (ahead > -tool.radii[near])
            depth = ahead[hit] - np.sqrt(tool.radii[near][hit]**2 - aside[hit]**2)
            order = np.argsort(depth)
            yield near[hit][order], depth[order]

    def wear(self, tool, volume, portion=1 / 8):
        """Wear `volume` (m3) off the tool. -> (n,) m, the depth at which each normal enters what is left."""
        met = [pair if worn else None for pair, worn in zip(self.entries(tool), self.worn)]
        alive = tool.erosion.alive
        visits = self.visits(volume, 2 * float(tool.radii.mean()), portion * float(tool.volumes.mean()))
        for _ in range(visits):
            worn = np.zeros(tool.count)
            for pair, density in zip(met, self.density):
                if pair:
                    first = pair[0][alive[pair[0]]]
                    worn[first[0]] += volume / visits * density * RAYS
            tool.erosion.wear(worn)
        return np.array([pair[1][alive[pair[0]]][0] if pair else np.nan for pair in met])

    def visits(self, volume, width, most):
        """Visits in which a width (m) of the outline wears by no more than `most` (m3), where the pattern is densest."""
        return math.ceil(volume * self.density.max() * width / most)

    def wear_segments(self, boundary, volume, size):
        """As `wear`, of segments of a size (m)."""
        visits = self.visits(volume, size, size**2 / 8)
        for _ in range(visits):
            first, _ = self.entered(boundary)
            portion = np.where(self.worn, self.density, 0.0) * RAYS * volume / visits
            boundary.wear(np.bincount(first, portion, len(boundary.facets)))
        return self.entered(boundary)[1]

    def entered(self, boundary):
        """(n,) segment that each normal enters first, and (n,) the depth (m) at which it does."""
        begin, end = (boundary.vertices[boundary.facets[:, k]] for k in (0, 1))
        across = np.cross(self.inward[:, None], (end - begin)[None])
        across[abs(across) < 1e-12] = np.nan
        away = begin[None] - self.points[:, None]
        depth, place = np.cross(away, (end - begin)[None]) / across, np.cross(away, self.inward[:, None]) / across
        depth[~((place >= 0) & (place <= 1) & (depth > -STRIP))] = np.inf
        first = np.argmin(depth, axis=1)
        return first, depth[np.arange(len(first)), first]

    def off(self, found, volume):
        """m, root mean square over strips of what a worn face is off the exact one."""
        window = round(STRIP / RAYS)
        off = np.convolve((found - self.depth(volume))[self.worn], np.full(window, 1 / window), "valid")
        return float(np.sqrt(np.mean(off**2)))


def patterned(pattern, polygon, size, seed, removal="volume", portion=1 / 8):
    """A tooth worn by the pattern: outline, and how far (m) it is off the exact one, root mean square over strips."""
    tool = particles(polygon, size, seed, removal)
    found = pattern.wear(tool, PATTERN_WORN, portion)
    return SimpleNamespace(outline=left_of(tool), off=pattern.off(found, PATTERN_WORN), unexplained=unexplained(tool))


def patterned_segments(pattern, polygon, size):
    """As `patterned`, of segments."""
    boundary = FacetTool.of_outline(polygon, segment=size, density=STEEL.density).boundary
    found = pattern.wear_segments(boundary, PATTERN_WORN, size)
    return SimpleNamespace(outline=boundary.vertices[shapes.loop(boundary.facets)], off=pattern.off(found, PATTERN_WORN),
                           unexplained=boundary.volume_balance()["unexplained"] / PATTERN_WORN)


def rate(errors):
    """Exponent of the errors over SIZES."""
    return float(np.polyfit(np.log(SIZES), np.log(errors), 1)[0])


def mean_square(rows):
    """{size: root mean square over the packings}, in the order of SIZES."""
    return [float(np.sqrt(np.mean([row.off**2 for row in rows[size]]))) for size in SIZES]


def main(folder):
    """Rub, wear, compare; write the figure and the table."""
    folder.mkdir(parents=True, exist_ok=True)
    polygon = tooth(**OUTLINE)
    with Runs(folder, at_once=1, keep=True) as runs:
        pattern = Pattern(runs.start("cut", "yade_scripts/tooth_cycles.py", **CUT).result())
    ways = {"flat": {size: [flat(polygon, size, seed) for seed in SEEDS] for size in SIZES},
            "pattern": {size: [patterned(pattern, polygon, size, seed) for seed in SEEDS] for size in SIZES}}
    segments = {"flat": [flat_of_segments(polygon, size) for size in SIZES],
                "pattern": [patterned_segments(pattern, polygon, size) for size in SIZES]}
    off = {name: mean_square(rows) for name, rows in ways.items()}
    lines = ["# Particle size and removal rule", "",
             f"A tooth of 30 x 20 mm, {len(SEEDS)} packings a size. Flat: {1e6 * WORN:g} mm2 rubbed off on a plane. "
             f"Pattern: {1e6 * PATTERN_WORN:g} mm2 worn", "by the friction work of a cut. `off` is the root mean square "
             "distance between the worn face and the exact one.", "",
             "| mean diameter, mm | flat: off, mm | pattern: off, mm | Archard's volume unexplained, at most "
             "| segments of that length, flat: off, mm | pattern: off, mm | unexplained |",
             "|---|---|---|---|---|---|---|"]
    for k, size in enumerate(SIZES):
        worst = max(abs(row.unexplained) for rows in ways.values() for row in rows[size])
        lines.append(f"| {1e3 * size:g} | {1e3 * off['flat'][k]:.3f} | {1e3 * off['pattern'][k]:.3f} | {worst:.0e} | "
                     + "".join(f"{1e3 * rows[k].off:.3f} | " for rows in segments.values())
                     + f"{max(abs(rows[k].unexplained) for rows in segments.values()):.0e} |")
    lines += ["", "Off falls with the size to the power " + " and ".join(
        f"{rate(off[name]):.2f} ({name})" for name in ways)
        + f", of segments {rate([row.off for row in segments['flat']]):.2f} (flat).", "",
        "More or less wear in a visit, 0.5 mm: how far the conserving rule's outline is off, and what the depth rule takes off, "
        "less", "Archard's volume, over it.", "",
        "| wear in a visit, of a particle | conserving rule, pattern: off, mm | depth rule, flat | pattern |", "|---|---|---|---|"]
    for portion in PORTIONS:
        conserving = [patterned(pattern, polygon, SIZES[1], seed, portion=portion) for seed in SEEDS]
        rubbed = particles(polygon, SIZES[1], SEEDS[0], "depth")
        rub(rubbed, WORN, portion)
        lost = unexplained(rubbed), patterned(pattern, polygon, SIZES[1], SEEDS[0], "depth", portion).unexplained
        lines.append(f"| {portion:.3g} | {1e3 * math.sqrt(np.mean([row.off**2 for row in conserving])):.3f} | "
                     + " | ".join(f"{100 * part:+.1f} %" for part in lost) + " |")
    (folder / "particle_size.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))
    with matplotlib.rc_context(plots.STYLE):
        draw(polygon, pattern, ways, off, segments).savefig(folder / "particle_size.png")


def closed(outline):
    """x and y (mm) of a polygon, back to its first corner."""
    return 1e3 * np.vstack([outline, outline[:1]]).T


def draw(polygon, pattern, ways, off, segments):
    """Outlines worn both ways over the exact ones, and how far they are off, over the size."""
    figure = Figure(figsize=(14, 4.8), layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=(1, 1, 0.8))
    worn_face = pattern.points + pattern.depth(PATTERN_WORN)[:, None] * pattern.inward
    targets = {"flat": exact(polygon, WORN)[0], "pattern": worn_face}
    titles = {"flat": f"rubbed on a plane, {1e6 * WORN:g} mm²",
              "pattern": f"worn as by a cut, {1e6 * PATTERN_WORN:g} mm²"}
    for axes, (name, rows) in zip((left, middle), ways.items()):
        axes.fill(*closed(polygon), facecolor="#eef0f1", edgecolor="0.6", linewidth=1, linestyle="--")
        axes.plot(*closed(targets[name]), color="black", linewidth=1.6, label="exact")
        for size, colour in zip(SIZES, ("#2c6e91", "#c8a15a", "#b5341d")):
            axes.plot(*closed(rows[size][0].outline), color=colour, linewidth=1.2, label=f"{1e3 * size:g} mm")
        axes.plot(*closed(segments[name][1].outline), color="#6a3d9a", linewidth=1.2, linestyle="--",
                  label=f"segments, {1e3 * SIZES[1]:g} mm")
        axes.set(title=titles[name], aspect="equal", xlabel="mm", xlim=(-13, 1), ylim=(-0.5, 10.5))
        axes.legend(loc="upper left")
    sizes = 1e3 * np.array(SIZES)
    for (name, errors), marker in zip(off.items(), "os"):
        right.loglog(sizes, 1e3 * np.array(errors), marker + "-", color="black" if name == "flat" else "#7d868c",
                     label=f"{name}, power {rate(errors):.2f}")
        for size in SIZES:
            right.loglog([1e3 * size] * len(SEEDS), [1e3 * row.off for row in ways[name][size]], ".", color="0.6")
    for (name, rows), style in zip(segments.items(), ("^--", "v:")):
        errors = [row.off for row in rows]
        right.loglog(sizes, 1e3 * np.array(errors), style, color="#6a3d9a", label=f"{name}, segments, power {rate(errors):.2f}")
    right.set(xlabel="mean diameter or length / mm", ylabel="worn face off the exact one / mm", title="convergence")
    right.set_ylim(8e-4, 0.4)
    right.set_xticks(sizes, [f"{s:g}" for s in sizes])
    right.set_yticks([0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3], ["0.005", "0.01", "0.02", "0.05", "0.1", "0.2", "0.3"])
    right.minorticks_off()
    right.legend(loc="lower right")
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/particle_size"))

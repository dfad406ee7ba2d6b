"""Loose grains: the heap with its profile and fitted flanks; the tube with its sand, over time."""
import math

import numpy as np

from rockwear.report import palette
from rockwear.report.instants import moment, spread
from rockwear.report.page import Section, number, with_error
from rockwear.report.plots import MM, canvas, discs, grid, save, time_axis, times


def heap(run):
    """Section of the angle of repose."""
    if not run.has("surface_x", "surface_heights", "plate"):
        return None
    return Section("The heap", "Above: the heap from the side at the end, the tops of its highest grains in each strip "
                   "between the walls (points), and straight lines fitted to the flanks. Below: how it came to that. "
                   "Grains that have fallen past the plate are taken out.",
                   [save(run, "heap", profile(run)), save(run, "heap_course", course(run))])


def tube(run):
    """Section of the vibrated tube."""
    if not run.has("tube", "box", "grain_positions"):
        return None
    return Section("The tube", "Above: mass of the sand in the tube over time, beside that of a full tube (to a solid "
                   "fraction of 0.6). Below: box and tube from the side, the nearer half taken away; coloured by "
                   "where the grains were when the vibration began, from the floor (pale) upwards.",
                   [save(run, "tube_mass", mass(run)), save(run, "tube", course_of_tube(run))])


def there(run, shot):
    """((n, 3) m, (n,) m, (n,) places) of the grains that are there, the farthest first."""
    places = shot["grain_positions"]
    order = np.argsort(places[:, 2], kind="stable")
    order = order[np.isfinite(places[order, 0])]
    return places[order], run.model["grain_radii"][order], order


def draw_grains(run, shot, axes):
    """Grains as discs from the side, with those that are fixed."""
    fixed = run.model["fixed_grains"].reshape(-1, 3)
    mean = float(run.model["grain_radii"].mean())
    discs(axes, fixed[:, :2], np.full(len(fixed), mean), facecolors=palette.FIXED, edgecolors=palette.ROCK_EDGE)
    places, radii, _ = there(run, shot)
    discs(axes, places[:, :2], radii, facecolors=palette.ROCK, edgecolors=palette.ROCK_EDGE, linewidths=0.4)


def limits(run):
    """(left, right, bottom, top) mm of the plate, its openings and the fill."""
    half, opening, _ = MM * run.model["plate"]
    highest = max((MM * np.nanmax(run.snapshot(k)["grain_positions"][:, 1]) for k in (-1, run.stage_ends().get(0, 0))
                   if np.isfinite(run.snapshot(k)["grain_positions"]).any()), default=half)
    return -half - opening, half + opening, -0.5 * opening, 1.1 * highest


def profile(run):
    """The heap at the end, its surface and the flanks."""
    figure, (axes,) = canvas(11, 5)
    shot, (left, right, low, high) = run.snapshot(-1), limits(run)
    draw_grains(run, shot, axes)
    x, heights = MM * shot["surface_x"], MM * shot["surface_heights"]
    for strip in heights.T:
        axes.plot(x, strip, ".", color=palette.POINTS, markersize=4)
    half = MM * run.model["plate"][0]
    for side, slope, crest in shot["flanks"]:
        ends = np.array([0.0, half])
        axes.plot(side * ends, MM * crest - slope * ends, color=palette.CRACK, linewidth=0.8)
    angle, error = run.result("angle_of_repose"), run.result("angle_of_repose_standard_error")
    beside = run.result("angle_zhou_2002")
    known = f"; Zhou and others (2002): {number(beside)} deg" if math.isfinite(beside) else ""
    axes.set(xlim=(left, right), ylim=(low, high), aspect="equal", xlabel="mm", ylabel="mm",
             title=f"angle of repose {with_error(angle, error, 'deg')}{known}")
    return figure


def course(run):
    """The box from its opening to the heap."""
    begin = run.stage_ends().get(0, 0)
    chosen = spread(range(begin, len(run.times)), 4)
    left, right, low, high = limits(run)
    figure, panels = grid(len(chosen), 11, (high - low) / (right - left))
    for axes, k in zip(panels, chosen):
        draw_grains(run, run.snapshot(k), axes)
        axes.set(xlim=(left, right), ylim=(low, high), aspect="equal", title=moment(run, k))
    return figure


def mass(run):
    """Sand in the tube over time."""
    if not run.rows:
        return None
    figure, (axes,) = canvas(11, 3.4)
    diameter, length, _ = run.model["tube"]
    full = 0.6 * run.parameter("density") * 0.25 * math.pi * diameter**2 * length
    axes.plot(times(run)[0], 1e3 * run.column("tube_mass"), color=palette.SIMULATED, label="in the tube")
    axes.axhline(1e3 * full, color=palette.GUIDE, linestyle=":", label="full")
    axes.set(ylabel="g", ylim=(0, None))
    axes.legend(loc="upper left")
    time_axis(run, [axes])
    return figure


def course_of_tube(run):
    """Box and tube, cut open, from the beginning of the vibration to its end."""
    begin = run.stage_ends().get(0, 0)
    chosen = spread(range(begin, len(run.times)), 4)
    width, _, _ = MM * run.model["box"]
    diameter, length, axis = MM * run.model["tube"]
    first = run.snapshot(begin)["grain_positions"][:, 1]
    low, high = axis - 0.5 * diameter, axis + 0.5 * diameter
    # Grains that are too soft fall through the floor.
    top = 1.1 * max(MM * float(np.nanmax(first)), high)
    figure, panels = grid(len(chosen), 11, top / (width + length))
    for axes, k in zip(panels, chosen):
        places, radii, order = there(run, run.snapshot(k))
        behind = places[:, 2] < 0
        colours = palette.TRAVEL(0.1 + 0.8 * np.clip(MM * first[order] / top, 0, 1))
        discs(axes, places[behind, :2], radii[behind], facecolors=colours[behind], edgecolors=palette.ROCK_EDGE,
              linewidths=0.3)
        axes.plot([0, 0, length, length, 0, 0, -width, -width], [top, high, high, low, low, 0, 0, top],
                  color=palette.OUTLINE, linewidth=1)
        axes.set(xlim=(-1.05 * width, 1.03 * length), ylim=(-0.03 * top, top), aspect="equal", title=moment(run, k))
    return figure

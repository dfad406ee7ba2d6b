"""The laboratory wear test: the block before and after, and worn depth over distance beside its integral."""
import numpy as np
from matplotlib.patches import Rectangle

from rockwear.report import palette
from rockwear.report.page import Section, number
from rockwear.report.plots import KELVIN, MM, canvas, discs, frame, save


def worn_block(run):
    """Section of the test."""
    if not run.has("block_positions", "block_radii", "alive"):
        return None
    return Section("The test", "Left: the block as it was (pale) and as it is, brought down on the rock by its own "
                   "wear, as in [Rojek 2003, fig. 6.3]. Right: worn depth by the simulation, and by the law under the "
                   "known force.",
                   [save(run, "worn_block", figure(run))])


def figure(run):
    """The block, and depth over distance."""
    drawn, (left, right) = canvas(12, 4.8, 1, 2)
    draw_block(run, left)
    draw_depth(run, right)
    return drawn


def draw_block(run, axes):
    """The block before and after, with force and motion."""
    model, shot = run.model, run.snapshot(-1)
    places, radii, alive = model["block_positions"], model["block_radii"], shot["alive"]
    first = places + (0, run.snapshot(0)["offset"][1])
    width, height = np.ptp(model["outline"], axis=0) * MM
    axes.add_patch(Rectangle((-width, -0.25 * height), 4.2 * width, 0.25 * height, color=palette.ROCK))
    discs(axes, first, radii, facecolors=palette.TOOL_UNWORN)
    shift = np.array([1.3e-3 * width, shot["offset"][1]])
    discs(axes, places[alive] + shift, radii[alive], facecolors=palette.TOOL)
    top = MM * (places[:, 1] + radii).max()
    style = {"arrowstyle": "-|>", "linewidth": 1.5, "color": palette.OUTLINE}
    for x in (0.5, 1.8):
        axes.annotate("", (x * width, top), (x * width, 1.3 * top), arrowprops=style)
    axes.annotate("", (2.9 * width, 0.5 * top), (2.4 * width, 0.5 * top), arrowprops=style)
    axes.text(0.55 * width, 1.2 * top, f"{number(run.parameter('force'))} N")
    axes.text(2.4 * width, 0.58 * top, f"{number(run.parameter('velocity'))} m/s")
    frame(axes, (-0.3 * width, 3.1 * width, -0.25 * height, 1.4 * height),
          f"before, and after {number(run.result('distance'))} m")


def draw_depth(run, axes):
    """Worn depth over distance."""
    distance = run.column("distance")
    for name, label, colour, wide in (("expected_depth", "law under the known force", palette.EXACT, 3),
                                      ("worn_depth", "simulated", palette.SIMULATED, 1),
                                      ("descent", "descent of the block", palette.DESCENT, 1)):
        axes.plot(distance, MM * run.column(name), color=colour, linewidth=wide, label=label)
    axes.set(xlabel="distance / m", ylabel="depth / mm", xlim=(0, None), ylim=(0, None))
    axes.legend(loc="upper left")
    if run.parameter("temperature_rise", 0.0):
        other = axes.twinx()
        other.plot(distance, run.column("temperature") - KELVIN, color=palette.TOOL_HEAT, linewidth=1, linestyle=":")
        other.set_ylabel("temperature / °C (dotted)", color=palette.TOOL_HEAT)
        other.tick_params(axis="y", colors=palette.TOOL_HEAT)
        other.spines["right"].set_visible(True)

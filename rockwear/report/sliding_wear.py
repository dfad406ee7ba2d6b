"""Figures of the laboratory wear test: the block before and after, and worn depth over distance beside its integral."""
import numpy as np
from matplotlib.patches import Rectangle

from rockwear.report.page import Section, machine_tiles, number, percent, quantity, tiles
from rockwear.report.plots import MM, balances, canvas, discs, frame, history, save

ROCK, STEEL, SEPARATED = "#e2d4b4", "#7d868c", "#dfe3e6"


def shows(run):
    """True for a run with a block on flat rock and at least one snapshot."""
    return bool({"block_positions", "block_radii"} <= run.model.keys() and len(run.times))


def sections(run):
    """The sections of the page, in order."""
    def drawn(figure):
        return save(run, figure.__name__, figure(run))

    factor = run.parameter("wear_acceleration", 1.0)
    return [
        Section("Key results", f"{quantity(run.result('distance'), '-')} m of the laboratory, simulated as "
                f"{quantity(run.result('simulated_distance'), 'm')} with {number(factor)} times the wear coefficient.",
                [key_results(run)]),
        Section("The test", "Left: the block as it was (pale) and as it is, brought down on the rock by its own wear. "
                "Right: worn depth by the simulation, and by the law under the known force.", [drawn(worn_block)]),
        Section("History", "Every recorded quantity over time.", [drawn(history)]),
        balances(run)]


def key_results(run):
    """The numbers to see first."""
    deviation = ("k off by", percent(run.result("k_deviation"), 1.0), "of what was given")
    return tiles([
        ("k given", number(run.result("k_given")), ""), ("k returned", number(run.result("k_returned")), "w H / (p s)"),
        deviation, ("worn depth", quantity(run.result("worn_depth"), "m"),
                    f"by the law {quantity(run.result('expected_depth'), 'm')}"),
        ("descent of the block", quantity(run.result("descent"), "m"), "in whole particles"),
        ("pressure", quantity(run.result("pressure"), "Pa"), ""),
        ("temperature", quantity(run.result("temperature_end"), "K"), "at the end"),
        ("particles removed", f"{run.result('particles_removed')} of {run.result('tool_particles')}", ""),
        *machine_tiles(run)])


def worn_block(run):
    """M fig. 6.3 with what became of the block, and depth over distance."""
    model, shot = run.model, run.snapshot(-1)
    places, radii, alive = model["block_positions"], model["block_radii"], shot["alive"]
    first = places + (0, run.snapshot(0)["offset"][1])
    width, height = np.ptp(model["outline"], axis=0) * MM
    figure, (left, right) = canvas(11, 4.8, 1, 2)
    left.add_patch(Rectangle((-width, -0.25 * height), 4.2 * width, 0.25 * height, color=ROCK))
    discs(left, first, radii, facecolors=SEPARATED)
    shift = np.array([1.3e-3 * width, shot["offset"][1]])
    discs(left, places[alive] + shift, radii[alive], facecolors=STEEL)
    top = MM * (places[:, 1] + radii).max()
    style = {"arrowstyle": "-|>", "linewidth": 1.5, "color": "black"}
    for x in (0.5, 1.8):
        left.annotate("", (x * width, top), (x * width, 1.3 * top), arrowprops=style)
    left.annotate("", (2.9 * width, 0.5 * top), (2.4 * width, 0.5 * top), arrowprops=style)
    left.text(0.55 * width, 1.2 * top, f"{number(run.parameter('force', np.nan))} N")
    left.text(2.4 * width, 0.58 * top, f"{number(run.parameter('velocity', np.nan))} m/s")
    frame(left, (-0.3 * width, 3.1 * width, -0.25 * height, 1.4 * height), "before, and after "
          f"{number(run.result('distance'))} m")
    distance = run.column("distance")
    right.plot(distance, MM * run.column("expected_depth"), color="#c8a15a", linewidth=3,
               label="law under the known force")
    right.plot(distance, MM * run.column("worn_depth"), color="black", linewidth=1, label="simulated")
    right.plot(distance, MM * run.column("descent"), color="#3b7fb0", linewidth=1, label="descent of the block")
    right.set(xlabel="distance / m", ylabel="depth / mm", xlim=(0, None), ylim=(0, None))
    right.legend(loc="upper left")
    if run.parameter("temperature_rise", 0.0):
        other = right.twinx()
        other.plot(distance, run.column("temperature") - 273.15, color="#c8252c", linewidth=1, linestyle=":")
        other.set_ylabel("temperature / °C", color="#c8252c")
    return figure

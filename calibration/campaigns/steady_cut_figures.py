"""Figures of campaigns.steady_cut. found: {case: row of steady_cut_numbers.of_case}."""
import numpy as np

from calibration.campaigns.steady_cut_cases import AT_DEPTHS, BASE, CUT, EIGHT, FINEST, FOUR, ROCKS, SETTINGS, depth_of
from calibration.campaigns.steady_cut_numbers import COLUMNS, of_run, scaled
from rockwear.kernels.cutting_envelope import (
    ENERGY_TARGET, OVERBREAK_TARGET, PEAKS_TARGET, SCRATCH_DEPTHS, SCRATCH_ENERGY, SCRATCH_STRENGTH, SCRATCH_THRUST)
from rockwear.report import plots
from rockwear.report.views.steady import draw_groove

MOVED = 0.15
"""Part of specific energy and friction work by which a setting may move them."""


def resolution(found):
    """Figure: what the number of discs in the depth of cut changes, and what it costs."""
    discs = {case: {**CUT, **ROCKS[case]}["discs_per_depth"] for case in (FOUR, EIGHT, BASE, FINEST)
             if case in found}
    drawn, panels = plots.canvas(13, 3.4, 1, 4)
    targets = {"energy": ENERGY_TARGET, "peaks": PEAKS_TARGET, "overbreak": OVERBREAK_TARGET, "thrust": None}
    for axes, (name, target) in zip(panels, targets.items()):
        values, errors = np.array([found[case][name] for case in discs]).T
        if target:
            axes.axhspan(*target, color="#dfe8d8", label="aimed at")
            axes.legend(fontsize=8)
        axes.errorbar(list(discs.values()), values, np.nan_to_num(errors), fmt="o-", color="#444444", capsize=3)
        axes.set(xscale="log", ylim=(0, None), title=next(words for words, of in COLUMNS.items() if of == name))
        axes.set_xticks(list(discs.values()), [f"{count} discs\n{found[case]['cost']:.0f} min/m"
                                               for case, count in discs.items()])
        axes.minorticks_off()
    return drawn


def over_depth(found):
    """Figure: cuts of one rock that differ in size alone, over their depth of cut."""
    cases = [case for case in AT_DEPTHS if case in found]
    drawn, panels = plots.canvas(13, 3.6, 1, 4)
    bands = {"energy": (SCRATCH_ENERGY[0] / SCRATCH_STRENGTH, SCRATCH_ENERGY[1] / SCRATCH_STRENGTH),
             "peaks": PEAKS_TARGET, "overbreak": OVERBREAK_TARGET, "thrust": SCRATCH_THRUST}
    for axes, (name, band) in zip(panels, bands.items()):
        scratch = name in ("energy", "thrust")
        axes.fill_between([min(SCRATCH_DEPTHS) * 1e3, 1e3 * max(SCRATCH_DEPTHS)] if scratch else [0.2, 30.0], *band,
                          color="#dfe8d8", label="scratches, recalled" if scratch else "aimed at")
        if name == "energy":
            axes.plot([5.0, 5.0], ENERGY_TARGET, color="#8aa37b", linewidth=6, alpha=0.5, label="aimed at")
        values, errors = np.array([found[case][name] for case in cases]).T
        axes.errorbar([1e3 * depth_of(case) for case in cases], values, np.nan_to_num(errors), fmt="o-",
                      color="#444444", capsize=3)
        axes.set(xscale="log", ylim=(0, None), xlim=(0.2, 30), xlabel="depth of cut, mm",
                 title=next(words for words, of in COLUMNS.items() if of == name))
        axes.set_xticks([0.3, 1, 5, 20], ["0.3", "1", "5", "20"])
        axes.minorticks_off()
        axes.legend(fontsize=8)
    return drawn


def grooves(runs):
    """Figure: what cuts of one depth leave behind, to one scale. runs: {what it is: RunFolder}."""
    drawn, panels = plots.canvas(8, 2.6 * len(runs), len(runs))
    left = {words: [plots.MM * column for column in run.table("groove.csv", "x", "height")]
            for words, run in runs.items()}
    bottom = min(np.nanmin(height) for _, height in left.values())
    for axes, (words, run) in zip(panels, runs.items()):
        depth = plots.MM * run.parameter("depth_of_cut")
        draw_groove(axes, *left[words], depth, bottom - depth)
        axes.set(ylim=(bottom - depth, 1.4 * depth), xlim=(0, max(x[-1] for x, _ in left.values())))
        axes.set_title(f"{words}: {of_run(run)['force'].value:.1f} kN/m", loc="left")
    panels[-1].set_xlabel("mm")
    return drawn


def price(found):
    """Figure: what a setting moves in specific energy, in friction at the tool, as wear goes, and in the warmth of its
    tip, over what it costs."""
    drawn, panels = plots.canvas(15, 4.4, 1, 3)
    for axes, (name, title) in zip(panels, {"force": "specific energy", "friction": "friction at the tool",
                                            "temperature": "warmth of the tip"}.items()):
        axes.axhspan(1 - MOVED, 1 + MOVED, color="#dfe8d8")
        for number, case in enumerate(case for case in SETTINGS if case in found):
            value, error = scaled(found[case][name], 1 / found[BASE][name].value)
            axes.errorbar(found[case]["cost"], value, np.nan_to_num(error), fmt="o", color=f"C{number}", capsize=3,
                          label=case if "discs" in case else
                          f"sixteen discs, {case}".removesuffix(f", {BASE}"))
        axes.set(xscale="log", ylim=(0, None), xlabel="minutes per metre", title=f"{title} over that of sixteen discs")
        axes.set_xticks([10, 20, 50, 100, 200, 500], [10, 20, 50, 100, 200, 500])
        axes.minorticks_off()
    panels[0].legend(fontsize=8)
    return drawn

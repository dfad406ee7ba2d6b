"""Figures of the studies of heat conduction (heat_studies)."""
import numpy as np

from calibration.benchmarks.heat_studies import MODELS, order
from rockwear.report import plots


def models_figure(found):
    """Conductivity of every packing with every model, and the noise of its temperatures."""
    figure, (left, right) = plots.canvas(10, 4.2, 1, 2, sharey=True)
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
    figure, (left, right) = plots.canvas(9, 3.6, 1, 2)
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
    figure, (left, right) = plots.canvas(9, 3.6, 1, 2)
    size, node, face = np.array(by_size).T
    left.loglog(size, 100 * abs(node), "o-", label="temperature of the node")
    left.loglog(size, 100 * abs(face), "s-", label="extrapolated to the face through the half cell")
    left.set_xticks(size, [f"{s:g}" for s in size])
    left.minorticks_off()
    left.set(xlabel="node diameter / depth of the heat, sqrt(a t)", ylabel="error of the face's temperature / %")
    for size, rows in by_visit.items():
        visit, error = np.array(rows).T
        right.loglog(visit, 100 * abs(error), "o-", label=f"node diameter {size:g} sqrt(a t)")
    right.set_xticks(visit, [f"{v:g}" for v in visit])
    right.minorticks_off()
    right.set(xlabel="time between visits / time of heating", ylabel="additional error of visits / %")
    for axes in (left, right):
        axes.legend(fontsize=8)
    return figure

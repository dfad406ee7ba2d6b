"""Forces on the tool over the time in which it cuts, for runs in which it does something else as well."""
import numpy as np

from rockwear.report import palette
from rockwear.report.curves import draw_forces
from rockwear.report.instants import clock, cutting
from rockwear.report.page import Section, quantity
from rockwear.report.plots import canvas, save


def forces(run):
    """Section of the forces while the tool cuts."""
    at_work = cutting(run)
    if not {"time", "cutting_force"} <= run.columns.keys() or at_work.all() or not at_work.any():
        return None
    return Section("Forces while the tool cuts", "Along and across the direction of the cut. Thin lines are the "
                   "record, thick ones a running mean; cuts stand end to end.",
                   [save(run, "forces", figure(run, at_work))])


def figure(run, at_work):
    """Components of the force over the time of cutting."""
    factor, unit = clock(run)
    step = np.diff(run.column("time"), prepend=0.0)[at_work]
    time = factor * np.cumsum(np.minimum(step, np.median(step)))
    drawn, (axes,) = canvas(12, 3.6)
    for k in np.flatnonzero(np.diff(run.column("stage")[at_work])):
        axes.axvline(time[k], color=palette.GUIDE, linewidth=0.8)
    axes.axhline(0, color=palette.GUIDE, linewidth=0.6)
    draw_forces(run, axes, time, at_work)
    mean = run.mean_over("cutting_force", at_work)
    axes.set(xlabel=f"time of cutting / {unit}", xlim=(0, time[-1]) if time[-1] > 0 else None,
             title=f"mean cutting force {quantity(mean, run.units['cutting_force'])}")
    return drawn

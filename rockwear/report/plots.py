"""Pieces of figures any view can use: canvas, discs, frames in mm, time axes with their stages, bars."""
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from rockwear.report import palette
from rockwear.report.instants import clock, stage_name
from rockwear.report.page import image

STYLE = {"font.size": 10, "axes.titlesize": 11, "axes.spines.top": False, "axes.spines.right": False,
         "axes.grid": False, "figure.facecolor": palette.FIGURE, "savefig.dpi": 110, "legend.frameon": False}
MM, MS = 1e3, 1e3
KELVIN = 273.15
MOST_NAMED = 12
"""Stages of a history whose names still fit above it."""


def save(run, name, figure):
    """Write a figure to the run's folder. -> its html; empty where there is no figure."""
    if figure is None:
        return ""
    path = run.path / "figures" / f"{name}.png"
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path)
    return image(path)


def canvas(width, height, rows=1, columns=1, **options):
    """(figure, axes as a flat list) of so many inches."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, list(figure.subplots(rows, columns, squeeze=False, **options).ravel())


def grid(count, width, shape, *, most=3):
    """(figure, axes) of `count` panels in rows of at most `most`, each `shape` times as tall as wide; figure of `width`
    inches, less where there are fewer panels than fit in a row."""
    columns = 2 if count == 4 and most < 4 else max(1, min(most, count))
    rows = -(-count // columns) or 1
    panel = width / max(columns, min(most, 2))
    figure, panels = canvas(panel * columns, rows * (panel * shape + 0.5), rows, columns)
    for axes in panels[count:]:
        axes.set_axis_off()
    return figure, panels


def discs(axes, positions, radii, **style):
    """Discs at (n, 2) m in axes of mm. -> the collection."""
    collection = EllipseCollection(2 * MM * radii, 2 * MM * radii, np.zeros(len(radii)), units="xy",
                                   offsets=MM * positions, offset_transform=axes.transData, **style)
    axes.add_collection(collection)
    return collection


def closed(points):
    """(n + 1, 2) polygon with its first point again at its end."""
    return np.vstack([points, points[:1]])


def frame(axes, limits, title=""):
    """A true-to-scale view of limits = (left, right, bottom, top) in mm."""
    axes.set(xlim=limits[:2], ylim=limits[2:], aspect="equal", xlabel="mm", title=title)


def rise_scale(highest):
    """Logarithmic scale of temperature rises (K) up to the highest, over three decades."""
    highest = max(highest, 2e-6)
    return LogNorm(1e-3 * highest, highest)


def running_mean(values, window):
    """Mean over `window` values around each one, over fewer at the ends."""
    count = np.convolve(np.ones(len(values)), np.ones(window), "same")
    return np.convolve(values, np.ones(window), "same") / count


def legend(axes, **options):
    """A legend to the right of the axes, where it hides no curve; none without a name to show."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(**{"loc": "center left", "bbox_to_anchor": (1.005, 0.5), "fontsize": 9, **options})


# ---- time

def times(run):
    """Times of the history as they are shown, and their unit."""
    factor, unit = clock(run)
    return factor * run.column("time"), unit


def time_axis(run, panels):
    """Stages and a common time axis for panels one above the other."""
    time, unit = times(run)
    for axes in panels:
        mark_stages(run, axes, named=axes is panels[0])
    last = time.max()
    panels[-1].set(xlabel=f"time / {unit}", xlim=(0, last if np.isfinite(last) and last > 0 else 1))


def mark_stages(run, axes, named=False):
    """Shade every other stage of the history, and name them if there is room."""
    time, stage = times(run)[0], run.column("stage")
    present = np.unique(stage[np.isfinite(stage)]).astype(int)
    if len(present) == 1:
        return
    for k in present:
        begin, end = time[stage == k].min(), time[stage == k].max()
        axes.axvspan(begin, end, color=palette.STAGE_BETWEEN if k % 2 else palette.STAGE, zorder=-5, linewidth=0)
        # Over a shorter stage the name would run into the next.
        if named and len(present) <= MOST_NAMED and end - begin > 0.06 * (time.max() - time.min()):
            axes.text((begin + end) / 2, 1.01, stage_name(run, k), ha="center", va="bottom",
                      transform=axes.get_xaxis_transform())


def working_hours(run, axes):
    """An upper axis of the hours that the accelerated wear stands for; they rest while a worn tool comes to the
    rock."""
    time = times(run)[0]
    hours = run.column("working_time") * run.parameter("wear_acceleration", 0.0) / 3600
    if not np.isfinite(hours + time).all() or not hours.max(initial=0) > 0:
        return
    # From the first moment on, and at the same rate beyond the last.
    hours, time = (np.concatenate([[0.0], values, 2 * values[-1:]]) for values in (hours, time))
    grows = np.append(True, np.diff(hours) > 0)
    upper = axes.secondary_xaxis("top", functions=(lambda t: np.interp(t, time, hours),
                                                   lambda h: np.interp(h, hours[grows], time[grows])))
    upper.set_xlabel("working time × acceleration / h")

"""Figures any scene can use: discs, time series with their stages, and the balances as bars and tables."""
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from rockwear.report.page import SHOWN, Section, beside, image, number, percent, table, words

STYLE = {"font.size": 10, "axes.titlesize": 11, "axes.spines.top": False, "axes.spines.right": False,
         "axes.grid": False, "figure.facecolor": "white", "savefig.dpi": 110, "legend.frameon": False}
MM, MS = 1e3, 1e3


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


def discs(axes, positions, radii, **style):
    """Discs at (n, 2) m in axes of mm. -> the collection."""
    collection = EllipseCollection(2 * MM * radii, 2 * MM * radii, np.zeros(len(radii)), units="xy",
                                   offsets=MM * positions, offset_transform=axes.transData, **style)
    axes.add_collection(collection)
    return collection


def frame(axes, limits, title=""):
    """A true-to-scale view of limits = (left, right, bottom, top) in mm."""
    axes.set(xlim=limits[:2], ylim=limits[2:], aspect="equal", xlabel="mm", title=title)


def spread(items, most):
    """At most so many of the items, evenly spread, the first and the last among them."""
    items = list(items)
    return [items[k] for k in sorted({round(x) for x in np.linspace(0, len(items) - 1, min(most, len(items)))})]


def stage_name(stage):
    """What a stage is called."""
    return f"cycle {stage}" if stage else "start-up"


def mark_stages(run, axes, named=False):
    """Shade every other stage of the history, and name them if there is room."""
    time, stage = MS * run.column("time"), run.column("stage")
    present = np.unique(stage[np.isfinite(stage)]).astype(int)
    for k in present:
        begin, end = time[stage == k].min(), time[stage == k].max()
        axes.axvspan(begin, end, color="#f3ede1" if k % 2 == 0 else "white", zorder=-5, linewidth=0)
        if named and len(present) <= 12:
            axes.text((begin + end) / 2, 1.01, stage_name(k), ha="center", va="bottom",
                      transform=axes.get_xaxis_transform())


def working_hours(run, axes, time):
    """An upper axis of the hours that the accelerated wear stands for; they rest while a worn tool comes to the rock."""
    hours = run.column("working_time") * run.parameter("wear_acceleration", 0.0) / 3600
    if not np.isfinite(hours + time).all() or not hours.max(initial=0) > 0:
        return
    # From the first moment on, and at the same rate beyond the last.
    hours, time = (np.concatenate([[0.0], values, 2 * values[-1:]]) for values in (hours, time))
    grows = np.append(True, np.diff(hours) > 0)
    upper = axes.secondary_xaxis("top", functions=(lambda t: np.interp(t, time, hours),
                                                   lambda h: np.interp(h, hours[grows], time[grows])))
    upper.set_xlabel("working time × acceleration / h")


def running_mean(values, window):
    """Mean over `window` values around each one, over fewer at the ends."""
    count = np.convolve(np.ones(len(values)), np.ones(window), "same")
    return np.convolve(values, np.ones(window), "same") / count


def history(run):
    """Every column of the history over time, a panel a unit."""
    time = MS * run.column("time")
    names = [name for name in run.columns if name not in ("time", "stage")]
    if not len(time) or not names:
        return None
    units = list(dict.fromkeys(run.units[name] for name in names))
    figure, panels = canvas(10, 0.5 + 2 * len(units), len(units), sharex=True)
    for axes, unit in zip(panels, units):
        shown, factor, added = SHOWN.get(unit, (unit, 1.0, 0.0))
        for name in names:
            if run.units[name] == unit:
                axes.plot(time, factor * run.columns[name] + added, linewidth=1, label=words(name))
        axes.set_ylabel(shown)
        axes.legend(loc="upper left", fontsize=8)
        mark_stages(run, axes)
    panels[-1].set_xlabel("time / ms")
    return figure


def energy_bars(run):
    """Where the work put in went, in per cent of it; what the account misses stands apart in red."""
    balance = run.summary.get("balances", {}).get("energy", {})
    source = next((name for name in balance if name.endswith("_work")), None)
    work = balance.get(source, 0.0)
    items = [(name, value) for name, value in balance.items() if name not in ("unit", source, "residual")]
    if not work or not np.isfinite(work) or not items:
        return None
    items = sorted(items, key=lambda item: np.nan_to_num(item[1])) + [("residual", balance.get("residual", np.nan))]
    share = np.array([100 * value / work for _, value in items])
    figure, (axes,) = canvas(9, 0.6 + 0.36 * len(items))
    axes.barh(range(len(items)), np.nan_to_num(share), color=["#b08d57"] * (len(items) - 1) + ["#cc2222"])
    for place, (name, value) in enumerate(items):
        axes.text(max(0, np.nan_to_num(share[place])), place, va="center",
                  s=f"  {percent(value, work)}   {number(value)} {balance['unit']}")
    axes.set_yticks(range(len(items)), [words(name) for name, _ in items])
    axes.set(xlabel=f"% of the {words(source)}, {number(work)} {balance['unit']}",
             xlim=(min(0, 1.1 * np.nanmin(share)), max(1, 1.35 * np.nanmax(share))))
    return figure


REFERENCES = {"mass": "archard", "heat": "generated", "energy": "tool_work"}


def balance_table(run, name):
    """A book of summary.json, each entry also in per cent of the book's reference."""
    balance = run.summary.get("balances", {}).get(name)
    if not balance:
        return ""
    reference = REFERENCES.get(name)
    whole = balance.get(reference, 0.0)
    rows = [(words(entry), number(value), percent(value, whole)) for entry, value in balance.items() if entry != "unit"]
    return table(rows, ("", balance["unit"], f"of {words(reference)}" if reference else ""), name)


def balances(run):
    """Section of the balances: energy as bars, the others as tables."""
    others = [name for name in run.summary.get("balances", {}) if name != "energy"]
    heat = " Heat counts from 0 K: a particle that is removed takes all it holds with it." if "heat" in others else ""
    return Section("Books", "Where the work went" + (", and the other balances." if others else ".") + heat,
                   [save(run, "energy", energy_bars(run)), beside(*(balance_table(run, name) for name in others))])

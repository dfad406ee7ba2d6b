"""Balances of summary.json: energy as bars, the others as tables."""
import numpy as np

from rockwear.report import palette
from rockwear.report.folder import work_entry
from rockwear.report.page import Section, beside, number, percent, table, words
from rockwear.report.plots import canvas, save

REFERENCES = {"mass": "archard", "heat": "generated", "energy": "tool_work", "friction": "tool"}
"""Entry of a balance that its others are compared with."""


def balances(run):
    """Section of the balances."""
    others = [name for name in run.balances if name != "energy"]
    heat = " Stored heat counts from 0 K: a particle that is removed takes all of its own." if "heat" in others else ""
    return Section("Balances", "Where the work went" + (", and the other balances." if others else ".")
                   + " A residual is what a balance misses." + heat,
                   [save(run, "energy", energy_bars(run)), beside(*(balance_table(run, name) for name in others))])


def energy_bars(run):
    """Where the work went, in per cent of it; what the balance misses stands apart in red."""
    balance = run.balances.get("energy", {})
    origin = work_entry(balance)
    work = balance.get(origin, 0.0)
    items = [(name, value) for name, value in balance.items() if name not in ("unit", origin, "residual")]
    if not work or not np.isfinite(work) or not items:
        return None
    items = sorted(items, key=lambda item: np.nan_to_num(item[1])) + [("residual", balance.get("residual", np.nan))]
    share = np.array([100 * value / work for _, value in items])
    figure, (axes,) = canvas(9, 0.6 + 0.36 * len(items))
    axes.barh(range(len(items)), np.nan_to_num(share), color=[palette.BAR] * (len(items) - 1) + [palette.BAR_RESIDUAL])
    for height, (name, value) in enumerate(items):
        axes.text(max(0, np.nan_to_num(share[height])), height, va="center",
                  s=f"  {percent(value, work)}   {number(value)} {balance['unit']}")
    axes.set_yticks(range(len(items)), [words(name) for name, _ in items])
    axes.set(xlabel=f"% of the {words(origin)}, {number(work)} {balance['unit']}",
             xlim=(min(0, 1.1 * np.nanmin(share)), max(1, 1.35 * np.nanmax(share))))
    return figure


def balance_table(run, name):
    """A balance, each entry also in per cent of its reference."""
    balance = run.balances[name]
    if not balance:
        return ""
    reference = REFERENCES.get(name)
    whole = balance.get(reference, 0.0)
    # Nothing to compare: what there was at first is millions of times what has worn.
    rows = [(words(entry), number(value), "–" if entry == "initial" else percent(value, whole))
            for entry, value in balance.items() if entry != "unit"]
    return table(rows, ("", balance.get("unit", ""), f"of {words(reference)}" if reference else ""), name)

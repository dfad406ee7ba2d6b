"""The page of a sweep: a table of parameters and results, a figure for each swept parameter, links to the reports."""
import csv
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from rockwear.report import page, plots

FIRST = ("mean_cutting_force", "peak_cutting_force", "specific_energy", "mean_thrust_force", "overbreak", "worn_volume",
         "mass_lost", "maximum_wear_depth", "tool_temperature_max", "peak_stress", "tensile_strength",
         "youngs_modulus", "poissons_ratio", "fracture_toughness")
"""Results that are shown before others."""
MOST = 6
"""Results that are shown without being asked for."""
MOST_LINES = 8
"""Combinations of the other parameters up to which a figure joins the points of each."""


def write(folder, rows, units, asked=()):
    """Write sweep.html and sweep.csv. rows: those of sweep.__main__; units: of the parameters; asked: names of results
    to show. -> path of the page."""
    found = {row.name: run for row in rows if (run := row.run_folder())}
    swept = [name for name in units if any(name in row.given for row in rows)
             and len({str(row.values.get(name)) for row in rows}) > 1]
    results = list(asked) or shown_results(list(found.values()))
    for name in results:
        if found and not any(name in run.summary["results"] for run in found.values()):
            print(f"no row has a result {name}", file=sys.stderr)
    header = ["row", *swept, *map(page.words, results), "wall time"]
    table = [_line(row, found.get(row.name), swept, units, results) for row in rows]
    sections = [page.Section("Rows", "", [page.table(table, header)])]
    failed = [(row.name, row.failure) for row in rows if row.failure]
    if failed:
        sections.append(page.Section("Failed", "The same command resumes them.", [page.table(failed)]))
    with matplotlib.rc_context(plots.STYLE):
        for name in swept:
            figure = draw(name, [row for row in rows if row.name in found], found, swept, units, results)
            if figure:
                path = folder / f"{name}.png"
                figure.savefig(path)
                sections.append(page.Section(page.words(name), "", [page.image(path)]))
    _write_csv(folder / "sweep.csv", rows, found, swept, units)
    path = folder / "sweep.html"
    path.write_text(page.document(folder.name, f"{len(found)} of {len(rows)} rows done", sections), encoding="utf-8")
    generated.record(path, folder / "sweep.csv")
    return path


def shown_results(runs):
    """Names of results that differ between the runs, those of FIRST first, at most MOST."""
    names = list(dict.fromkeys(name for run in runs for name in run.summary["results"]))
    differ = [name for name in names if not name.endswith("_standard_error")
              and len({value for run in runs if math.isfinite(value := _number(run, name))}) > 1]
    return sorted(differ, key=lambda name: FIRST.index(name) if name in FIRST else len(FIRST))[:MOST]


def _number(run, name):
    value = run.result(name)
    return value if isinstance(value, (int, float)) else math.nan


def _swept(value, unit):
    """A value of a parameter as shown; one in K may be a difference, to which no offset is added."""
    if not isinstance(value, float):
        return value
    return f"{page.number(value)} K" if unit == "K" else page.quantity(value, unit)


def _line(row, run, swept, units, results):
    """Cells of a row of the table."""
    values = [_swept(row.values[name], units[name]) for name in swept]
    if run is None:
        return [row.name, *values, *[""] * len(results), "failed" if row.failure else "not done"]
    name = page.Link(row.name, f"{row.name}/report.html") if (row.folder / "report.html").exists() else row.name
    return [name, *values, *(page.with_error(run.result(name), run.result(f"{name}_standard_error"), run.unit(name))
                             for name in results), page.duration(run.summary["wall_time"]["total"])]


def draw(name, rows, found, swept, units, results):
    """Results over the swept parameter, a line a combination of the others; None without two values or results."""
    values = [row.values[name] for row in rows]
    if len(set(values)) < 2 or not results:
        return None
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values)
    places = sorted(set(values), key=None if numbers else str)
    others = [other for other in swept if other not in (name, "seed")]
    groups = {}
    for row in rows:
        groups.setdefault(", ".join(f"{page.words(o)} {page.number(row.values[o])}" for o in others), []).append(row)
    figure, panels = plots.grid(len(results), 12, 0.6)
    for axes, result in zip(panels, results):
        size = max((abs(value) for row in rows if math.isfinite(value := _number(found[row.name], result))), default=0)
        own = next((u for row in rows if (u := found[row.name].unit(result))), "")
        unit, factor, added = page.shown_unit(own, size)
        for words, of in groups.items():
            of = sorted(of, key=lambda row: places.index(row.values[name]))
            x = [row.values[name] if numbers else places.index(row.values[name]) for row in of]
            y = np.array([_number(found[row.name], result) for row in of]) * factor + added
            line, = axes.plot(x, y, "o", label=words)
            if len(groups) <= MOST_LINES and numbers and name != "seed":
                middle = [float(np.mean(y[np.array(x) == place])) for place in sorted(set(x))]
                axes.plot(sorted(set(x)), middle, "-", color=line.get_color())
        if not numbers:
            axes.set_xticks(range(len(places)), [str(place) for place in places])
            axes.set_xlim(-0.5, len(places) - 0.5)
        axes.ticklabel_format(axis="y", useOffset=False)
        axes.set(xlabel=f"{page.words(name)} / {units[name]}" if units[name] not in ("", "-") else page.words(name),
                 ylabel=f"{page.words(result)} / {unit}" if unit else page.words(result))
    if 1 < len(groups) <= MOST_LINES:
        panels[0].legend(fontsize=8)
    return figure


def _write_csv(path, rows, found, swept, units):
    """All results of all rows that are done, in SI."""
    names = {name: run.unit(name) for run in found.values() for name in run.summary["results"]}
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([
            ["row", *(f"{name} [{units[name] or '-'}]" for name in swept), *(f"{n} [{u}]" for n, u in names.items())],
            *([row.name, *(row.values[name] for name in swept), *(found[row.name].result(name) for name in names)]
              for row in rows if row.name in found)])

"""How a run was made: every result to the last digit, parameters, versions, wall time."""
import math

from rockwear.report.page import Section, beside, folded, percent, quantity, table, words


def results(run):
    """Section of every result of summary.json, as shown and as written."""
    rows = [(words(name), quantity(run.result(name), run.unit(name)), _exact(run.result(name)), run.unit(name))
            for name in run.summary.get("results", {})]
    return Section("All results", "Values in SI are those of summary.json, to the last digit.",
                   [folded("Results", table(rows, ("result", "", "SI", "")))])


def _exact(value):
    """Every digit of a value; nothing where it is not known."""
    return "" if isinstance(value, float) and math.isnan(value) else repr(value)


def how_it_was_run(run):
    """Section of the effective parameters, versions, and wall time by engine."""
    wall = run.summary.get("wall_time", {})
    loop = wall.get("loop", math.nan)
    engines = [(words(name), f"{entry['seconds']:.2f}", percent(entry["seconds"], loop), entry["visits"])
               for name, entry in wall.get("by_engine", {}).items()]
    phases = [(words(name), f"{wall[name]:.2f}") for name in wall if name not in ("unit", "by_engine")]
    versions = list(run.summary.get("versions", {}).items())
    chosen = [(name, f"{value:.12g}" if isinstance(value, float) else value) for name, value in run.parameters.items()]
    return Section("How it was run", "Parameters in SI, defaults included.", [
        folded("All parameters", table(chosen, ("parameter", "value"))),
        folded("Versions and wall time", beside(
            table(versions, ("program", "version")), table(phases, ("phase", "s")),
            table(engines, ("engine", "s", "of the loop", "visits"))))])

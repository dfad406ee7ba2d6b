"""Heat benchmarks: profiles over the exact solutions, errors and convergence, the discs in colour."""
from collections import namedtuple

import numpy as np

from rockwear.report import palette
from rockwear.report.page import Section, number, percent, table, words
from rockwear.report.plots import canvas, discs, save

MARKS = {"random": "o", "square": "s", "triangular": "^"}
DOTS = 150
"""Largest number of discs drawn in a profile."""

Case = namedtuple("Case", "benchmark packing across positions radii stages")
"""One benchmark on one packing: its discs and its stages, as {stage: instant in s}."""


def errors(run):
    """Section of the errors by benchmark and packing."""
    if not shows(run):
        return None
    shown = finest(run)
    return Section("Errors", f"{shown[0].across} diameters across the depth; errors are parts of the range of "
                   "temperature at their instant, over all discs.", [error_table(run, shown, run_errors(run))])


def profiles(run):
    """Section of temperature over depth."""
    if not shows(run):
        return None
    return Section("Profiles", "Lines: exact solutions at the instants of the source. Dots: discs at their depth, "
                   "wherever across the specimen they are.", [save(run, "profiles", profile_figure(run, finest(run)))])


def convergence(run):
    """Section of the errors over the diameter."""
    if not shows(run):
        return None
    return Section("Convergence", "Errors at the last instant over the mean diameter; the dashed line has order 2.",
                   [save(run, "convergence", convergence_figure(read_cases(run), run_errors(run)))])


def fields(run):
    """Section of the discs in colour."""
    if not shows(run):
        return None
    return Section("Temperatures", "The discs at the last instant, from the lowest to the highest temperature.",
                   [save(run, "temperatures", field_figure(run, finest(run)))])


def shows(run):
    """True for a run of the heat benchmarks with at least one instant."""
    return run.has("heat_cases", "exact")


def finest(run):
    """[Case] of the smallest discs."""
    cases = read_cases(run)
    across = max(case.across for case in cases)
    return [case for case in cases if case.across == across]


def read_cases(run):
    """[Case] of the run."""
    model = run.model
    found = []
    for k, name in enumerate(model["heat_cases"].tolist()):
        benchmark, packing, across = name.split("/")
        stages = np.flatnonzero(model["stage_case"] == k)
        found.append(Case(benchmark, packing, int(across), model[f"positions_{k}"], model[f"radii_{k}"],
                          dict(zip(stages.tolist(), model["stage_instant"][stages].tolist()))))
    return found


def run_errors(run):
    """{stage: (largest, rms)} of the stages that are done."""
    found = {}
    for stage in set(run.stages.tolist()):
        shot = at_end(run, stage)
        if shot is not None:
            gap = np.abs(shot["temperature"] - shot["exact"]) / shot["exact"].max()
            found[stage] = gap.max(), np.sqrt(np.mean(gap**2))
    return found


def at_end(run, stage):
    """The snapshot at a stage's end: at its last time; None where the run did not get there."""
    ends = np.cumsum(stage_seconds(run.model))
    at = np.flatnonzero((run.stages == stage) & (run.times >= ends[stage] * (1 - 1e-9)))
    return run.snapshot(at[-1]) if len(at) else None


def stage_seconds(model):
    """(stages,) s that each stage takes."""
    instant, case = model["stage_instant"], model["stage_case"]
    before = np.concatenate([[0.0], instant[:-1]])
    before[np.concatenate([[True], case[1:] != case[:-1]])] = 0.0
    return instant - before


def error_table(run, shown, found_errors):
    """Largest and rms error and order of each benchmark and packing."""
    rows = []
    for case in shown:
        found = [found_errors[stage] for stage in case.stages if stage in found_errors]
        if found:
            largest, rms = (max(column) for column in zip(*found))
            order = run.result(f"{case.benchmark}_{case.packing}_order_in_space")
            rows.append((f"{words(case.benchmark)}, {case.packing}", len(case.radii), percent(largest, 1.0),
                         percent(rms, 1.0), number(order)))
    return table(rows, ("benchmark", "discs", "largest error", "rms error", "order in space"))


def profile_figure(run, shown):
    """Temperature over depth, a row a benchmark, a column a packing."""
    benchmarks, packings = (list(dict.fromkeys(getattr(case, name) for case in shown))
                            for name in ("benchmark", "packing"))
    figure, axes = canvas(1.5 + 3.6 * len(packings), 3 * len(benchmarks), len(benchmarks), len(packings))
    for case in shown:
        panel = axes[benchmarks.index(case.benchmark) * len(packings) + packings.index(case.packing)]
        order = np.argsort(case.positions[:, 0])
        x = case.positions[:, 0]
        some = np.random.default_rng(0).permutation(len(x))[:DOTS]
        greys = palette.greys(len(case.stages))
        for k, (stage, instant) in enumerate(case.stages.items()):
            shot = at_end(run, stage)
            if shot is None:
                continue
            panel.plot(x[order], shot["exact"][order], color=greys[k], linewidth=1, label=f"t = {instant:g} s")
            panel.plot(x[some], shot["temperature"][some], MARKS[case.packing], color=palette.PACKINGS[case.packing],
                       markersize=2.5, zorder=3)
        panel.set(title=f"{words(case.benchmark)}, {case.packing}", xlabel="depth", ylabel="temperature")
        panel.legend(fontsize=8, loc="lower center" if case.benchmark == "slab_source" else "best")
    return figure


def convergence_figure(cases, found_errors):
    """Errors at the last instant over the diameter, a panel a benchmark."""
    benchmarks = list(dict.fromkeys(case.benchmark for case in cases))
    figure, axes = canvas(1.5 + 3.4 * len(benchmarks), 3.4, 1, len(benchmarks), sharey=True)
    for benchmark, panel in zip(benchmarks, axes):
        largest = []
        for packing in dict.fromkeys(case.packing for case in cases):
            same = [case for case in cases if (case.benchmark, case.packing) == (benchmark, packing)
                    and max(case.stages) in found_errors]
            if same:
                size = np.array([1 / case.across for case in same])
                found = np.array([found_errors[max(case.stages)] for case in same])
                mark, colour = MARKS[packing], palette.PACKINGS[packing]
                panel.loglog(size, 100 * found[:, 1], mark + "-", color=colour, label=f"{packing}, rms")
                panel.loglog(size, 100 * found[:, 0], mark + ":", color=colour, markerfacecolor=palette.FIGURE,
                             linewidth=1)
                largest.append((size.max(), 100 * found[0, 1]))
        if largest:
            top, level = max(largest)
            size = np.array([top, min(1 / case.across for case in cases)])
            panel.loglog(size, 0.3 * level * (size / top) ** 2, "--", color=palette.GUIDE, linewidth=1)
        sizes = sorted({1 / case.across for case in cases})
        panel.set(title=words(benchmark), xlabel="mean diameter / depth")
        panel.set_xticks(sizes, [f"1/{round(1 / size)}" for size in sizes], minor=False)
        panel.minorticks_off()
    axes[0].set_ylabel("error / % of the range")
    axes[0].legend(fontsize=8, title="open marks: largest", title_fontsize=8)
    return figure


def field_figure(run, shown):
    """The discs of one packing at the last instant of each benchmark."""
    shown = [case for case in shown if case.packing == shown[0].packing and at_end(run, max(case.stages)) is not None]
    if not shown:
        return None
    size = np.ptp(shown[0].positions, axis=0)
    figure, axes = canvas(10, 0.8 + len(shown) * max(1.2, 9 * size[1] / size[0]), len(shown), 1)
    for case, panel in zip(shown, axes):
        # The collection counts in mm, these benchmarks in units of their own.
        colours = discs(panel, case.positions / 1e3, case.radii / 1e3, cmap=palette.DIMENSIONLESS,
                        array=at_end(run, max(case.stages))["temperature"])
        top = (case.positions + case.radii[:, None]).max(axis=0)
        panel.set(xlim=(0, top[0]), ylim=(0, top[1]), aspect="equal", xlabel="depth",
                  title=f"{words(case.benchmark)}, {case.packing}, t = {case.stages[max(case.stages)]:g} s")
        figure.colorbar(colours, ax=panel, fraction=0.02, pad=0.01)
    return figure

"""What makes a steady cut what it is: causes one at a time, from a rock whose chips come off as a rock's do.

    python3 -m calibration.campaigns.steady_cut DIR [CASE ...] [--read] [--kept] [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Each rock is also crushed in
the laboratory, and the base pulled, in the same packings. Writes into DIR steady_cut.md (tables), steady_cut.json (what
was measured), figures of the base, of the finest discs and over their number (steady_cut*.png), steady_settings.json,
from which calibration.settings chooses, and provenance.json. --kept adds those cases of
calibration/results/steady_cut.json that DIR has no runs of.
"""
import json
import sys
from collections import Counter
from pathlib import Path

import matplotlib

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, wait_for
from calibration.campaigns.steady_cut_cases import AT_DEPTHS, BASE, CASES, EIGHT, ENDS_FREE, FINEST, plan
from calibration.campaigns.steady_cut_figures import grooves, over_depth, price, resolution
from calibration.campaigns.steady_cut_numbers import BEGIN, LOAD, keep, kept, of_case, runs_of
from calibration.campaigns.steady_cut_tables import (
    ACCURACY, CHANGED, causes, changes, envelope, lengths_needed, relations, settings, theories)
from rockwear.report import plane, plots
from rockwear.report.views import cut, steady

DRAWN = {BASE: "steady_cut", FINEST: "steady_cut_finest"}
"""{case: name of its figures}."""
KEPT = Path(__file__).parents[1] / "results" / "steady_cut.json"
"""What was measured in runs that may be gone."""


def with_more_packings(row, kept_row):
    """The row of a case that is of more packings, of equally many the first; minutes are those of the first."""
    if row and kept_row and kept_row["packings"] > row["packings"]:
        return {**kept_row, "cost": row["cost"]}
    return row or kept_row


def write(folder, others):
    """Tables and figures of all runs that exist, and tables of other cases ({case: row of of_case}), too. -> the
    tables, in Markdown."""
    measured = {case: row for case in CASES if (row := of_case(folder, case))}
    found = {case: with_more_packings(measured.get(case), others.get(case)) for case in CASES
             if case in measured or case in others}
    files = [folder / "steady_cut.json"]
    keep(found, files[0])
    without = Counter(row["version"] for case, row in found.items() if row is not measured.get(case))
    lines = [f"Kept from earlier runs: {count} cases of rockwear {version}." for version, count in without.items()]
    lines += [""] * bool(lines)
    lines += ["## Causes, one at a time", "", f"Mean ± standard error: of the packings where there are three, else of "
              f"the cuts' own records, from {BEGIN} depths of cut on. Way under load: part of the way with a cutting "
              f"force above {LOAD:g} of the mean peak. Of packings abreast: peak over mean of the mean force of all "
              "packings, as of a tool so many chips wide. Work in bonds: part of the tool's work that bonds take "
              "in slip and damage, those alone that broke in tension, and in crushing. Energy missed: residual of the "
              "balance over the tool's work, of the worst packing. Minutes on a shared core.", "", *causes(found)]
    if changed := changes(found):
        lines += ["", "## What each changes in the same packings", "", "Mean ± standard error of the differences in "
                  "the same packing; significant: so many standard errors that chance makes as large a change once in "
                  f"{1 / generated.CHANCE:g} cases (Student's t).", "",
                  *generated.table(["", "packings in common", *CHANGED, "significant"], changed)]
    if needed := lengths_needed(found):
        lines += ["", "## How long a cut has to be", "", "How far the mean force of one cut is off, by the scatter of "
                  f"packings and by its own record, and how many depths of cut tell it to {100 * ACCURACY:g} %.", "",
                  *generated.table(["", "depths of one cut", "packings", "record", "depths needed", "minutes"],
                                   needed)]
    if judged := envelope(found):
        lines += ["", "## Against the envelope", "",
                  *generated.table(["cut", "", "range", "basis", "ours", "verdict"], [*judged, *relations(found)])]
    if compared := theories(found):
        lines += ["", "## Theories", "", "Both are known to be unreliable in absolute value. Strengths are those of "
                  "the rock's laboratory; Nishimatsu's with the exponent recalled of his own tests.", "",
                  *generated.table(["", "mean peak Fc, kN/m", "Evans", "Nishimatsu", "thrust / cutting", "Nishimatsu"],
                                   compared)]
    for case, name in DRAWN.items():
        if case in measured:
            run = next(iter(runs_of(folder / "cut", case).values()))
            with matplotlib.rc_context(plots.STYLE):
                for end, figure in (("", cut.figure(run, plane.cut_limits(run))),
                                    ("_forces", steady.force_figure(run))):
                    files.append(folder / f"{name}{end}.png")
                    figure.savefig(files[-1])
    if {BASE, EIGHT} <= set(found):
        with matplotlib.rc_context(plots.STYLE):
            files.append(folder / "steady_cut_resolution.png")
            resolution(found).savefig(files[-1])
            files.append(folder / "steady_cut_price.png")
            price(found).savefig(files[-1])
        files.append(folder / "steady_settings.json")
        files[-1].write_text(json.dumps(settings(found), indent=1) + "\n", encoding="utf-8")
    if sum(case in found for case in AT_DEPTHS) > 2:
        with matplotlib.rc_context(plots.STYLE):
            files.append(folder / "steady_cut_depths.png")
            over_depth(found).savefig(files[-1])
    if {EIGHT, ENDS_FREE} <= set(measured):
        of_ends = {"a rock mass": EIGHT, "a block ten depths long, both ends free": ENDS_FREE}
        with matplotlib.rc_context(plots.STYLE):
            files.append(folder / "steady_cut_ends.png")
            grooves({words: next(iter(runs_of(folder / "cut", case).values()))
                     for words, case in of_ends.items()}).savefig(files[-1])
    generated.record(*files)
    return generated.write_page(folder / "steady_cut.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    others = kept(KEPT) if "--kept" in words else {}
    words = [word for word in words if word != "--kept"]
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {name: runs.start(name, script, **values)
                    for name, (script, values) in plan(words or CASES).items()}
            failed = wait_for(jobs, lambda name, run: name)
    print(write(folder, others))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, CASES, flags=("--read", "--kept"))
    sys.exit(main(place, words, **where))

"""The page that shows a run: report.write(folder) reads the run's folder and draws figures/ and report.html.

    python3 -m rockwear.report FOLDER

Needs numpy, scipy and matplotlib, no YADE, so that a run can be looked at anywhere.
"""
import matplotlib

from rockwear.report import (
    cutting, dredging, heat, laboratory, plots, segments, space, temperatures, sliding_wear as sliding_wear)
from rockwear.report.folder import RunFolder
from rockwear.report.page import Section, parameters, whole_page, whole_results


def write(folder):
    """Draw figures/* and report.html of the run in `folder` from what is there already. -> path of the page."""
    run = RunFolder(folder)
    with matplotlib.rc_context(plots.STYLE):
        kinds = space, temperatures, dredging, cutting, segments, laboratory, sliding_wear, heat
        sections = next((kind.sections(run) for kind in kinds if kind.shows(run)), None) or general(run)
        text = whole_page(run, sections + [whole_results(run), parameters(run)])
    path = run.path / "report.html"
    path.write_text(text, encoding="utf-8")
    return path


def general(run):
    """Sections of a scene without a page of its own: its history and its balances."""
    return [Section("History", "Every recorded quantity over time.", [plots.save(run, "history", plots.history(run))]),
            plots.balances(run)]

"""The page that shows a run: report.write(folder) reads the run's folder and draws figures/ and report.html.

    python3 -m rockwear.report FOLDER

Needs numpy, scipy and matplotlib, no YADE, so that a run can be looked at anywhere.
"""
import matplotlib

from rockwear.report.folder import RunFolder
from rockwear.report.page import document, words
from rockwear.report.pages import sections
from rockwear.report.plots import STYLE


def write(folder):
    """Draw figures/* and report.html of the run in `folder` from what is there already. -> path of the page."""
    run = RunFolder(folder)
    with matplotlib.rc_context(STYLE):
        text = document(words(run.summary.get("scene", "")), run.summary.get("ended", "not known"), sections(run),
                        run.summary.get("warnings", ()))
    path = run.path / "report.html"
    path.write_text(text, encoding="utf-8")
    return path

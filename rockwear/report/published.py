"""What the sources publish, as data (published.json): numbers, statements and figures, in the order of the sources.

A row has id, source (key of the bibliography), place, what, and reading: how we read it, or why it cannot be compared.
Beside them value and unit (SI; two numbers are a range), or stated (a statement in words); a row with neither is a
figure whose numbers the text does not give. Numbers that a source gives as input are defaults of the scenes.
"""
import json
from pathlib import Path

ROWS = json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
CUT_TIMES = 0.01, 0.2, 0.4, 0.65
"""Instants of the first turn's cut in [Rojek 2014, figs. 12, 13, 16], s."""
COOLING_TIMES = 0.03, 0.13, 0.83, 1.35
"""Instants of the first turn's cooling in [Rojek 2014, fig. 14], s after the cut (0.68, 0.78, 1.48 and 2.00 s)."""
_VALUES = {row["id"]: row["value"] for row in ROWS if "value" in row}


def value(name):
    """The published number of a row, in its unit. Raises KeyError."""
    return _VALUES[name]

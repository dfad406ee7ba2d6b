"""The fidelity page: what the sources publish beside what we find, with a verdict a row.

    python3 -m calibration.fidelity [--out PAGE]                                                  (make fidelity)
    python3 -m calibration.fidelity --enter ROW --result NAME --command TEXT --commit C [--set WORDS] FOLDER ...

The first joins rockwear/report/published.json and calibration/results/fidelity.json and writes fidelity.md beside the
latter; nothing is run. The second enters a result of finished runs, one a packing, into fidelity.json: their mean with
its standard error, the command with its commit, and the wall time. What is no mean of runs is entered by hand:

    runs      {name: {command, commit, date, wall}}
    results   [{row, run, and value (SI) [error, packings], or agrees (true, false, null: unclear), or nothing for a
              figure; found: in words; set: what differs from the defaults; explained: {run, why}, of a guess {why}}]
    open      {row: "not run: " or "not entered: " and why}

A row whose numbers differ by more than a factor of 1.5, or whose statement is not found, is explained by a run, or the
page says that it is not, or that it is a guess. A figure without numbers in the source's text may be open, too.
"""
import argparse
import json
import math
import sys
from collections import Counter
from pathlib import Path

import numpy as np

from calibration import generated
from calibration.command import Parser
from rockwear.kernels.checks import ParameterError, finite, not_negative, require
from rockwear.report import published
from rockwear.report.folder import RunFolder
from rockwear.report.page import number, quantity, with_error

OURS = generated.ROOT / "calibration/results/fidelity.json"
FACTOR = 1.5
"""Ratio, either way, from which a difference asks for a run that explains it."""
CLOSE = 0.05
"""Relative difference up to which numbers agree, whatever their errors."""
RUN = "command", "commit", "date", "wall"
WORDS = {True: "agrees", False: "differs", None: "unclear"}
NO_NUMBERS, OPEN = "no numbers in the source", ("not run", "not entered")
COLUMNS = "place", "what", "published", "how it is read", "ours ± standard error (packings)", "ratio", "verdict", "run"


def ratio(row, value):
    """Ours over the published number; of a range over its nearer end, 1 inside."""
    low, high = np.broadcast_to(row["value"], 2)
    return float(value / np.clip(value, low, high))


def verdict(row, result):
    """(word, ratio or nan) of one result of a published row.

    agrees: within two standard errors or CLOSE; near: within FACTOR; differs. fitted, in place of the first two: of a
    number that ours was fitted to. Of a statement: as it was judged. A figure without numbers: shown.
    """
    if "stated" in row:
        return WORDS[result["agrees"]], math.nan
    if "value" not in row:
        return "shown", math.nan
    times = ratio(row, result["value"])
    target = result["value"] / times
    if not 1 / FACTOR <= times <= FACTOR:
        return "differs", times
    if result.get("fitted"):
        return "fitted", times
    close = abs(result["value"] - target) <= max(2 * result.get("error", 0.0), CLOSE * abs(target))
    return ("agrees" if close else "near"), times


def check(rows, ours):
    """Raise ParameterError for a published row without a reading, a run without its origin, a result that fits no row.
    """
    known = {row["id"]: row for row in rows}
    require(len(known) == len(rows), "rows", len(rows), "of different names")
    for name, row in known.items():
        for key in ("source", "place", "what", "reading"):
            require(row.get(key), f"{name}: {key}", row.get(key), "given")
    for name, run in ours["runs"].items():
        for key in RUN:
            require(run.get(key), f"run {name}: {key}", run.get(key), "given")
    for name, why in ours["open"].items():
        require(name in known, "open", name, "a published row")
        kind, _, why = why.partition(": ")
        require(kind in OPEN and why, f"{name}: open", kind, f"{' or '.join(OPEN)}, a colon and why")
    for result in ours["results"]:
        name = result["row"]
        require(name in known, "result", name, "of a published row")
        require(name not in ours["open"], "open", name, "a row without a result")
        row = known[name]
        wanted = "value" if "value" in row else "agrees" if "stated" in row else None
        for key in ("value", "agrees"):
            require((key in result) == (key == wanted), f"{name}: {key}", result.get(key, "missing"),
                    f"given for a published {'number' if key == 'value' else 'statement'} alone")
        if wanted == "value":
            finite(name, result["value"], row["unit"])
            not_negative(f"{name}: error", result.get("error", 0.0), row["unit"])
        else:
            require(result.get("found"), f"{name}: found", result.get("found"), "said in words")
        explained = result.get("explained")
        for run in (result["run"], *([explained["run"]] if explained and "run" in explained else ())):
            require(run in ours["runs"], f"{name}: run", run, "one of the runs, with its command")
        require(not explained or explained.get("why"), f"{name}: why", explained, "said where a run is named")
        require(not explained or verdict(row, result)[0] == "differs", f"{name}: explained", explained,
                "left out where nothing differs")


def cells(row, result, why_open):
    """([cells] of one line of the page, what it counts as). result: None of a row that has none."""
    said = row.get("stated", "–")
    if "value" in row:
        said = " to ".join(quantity(value, row["unit"]) for value in np.atleast_1d(row["value"]).tolist())
    first = [row["place"], row["what"], said, row["reading"]]
    if result is None:
        words = why_open or (OPEN[0] if "value" in row or "stated" in row else NO_NUMBERS)
        return [*first, "–", "–", words, "–"], words.partition(": ")[0]
    word, times = verdict(row, result)
    found = [result["set"]] if "set" in result else []
    if "value" in row:
        packings = f" ({result['packings']})" if "packings" in result else ""
        found.append(with_error(result["value"], result.get("error", math.nan), row["unit"]) + packings)
    found += [result["found"]] if "found" in result else []
    kind, why = {"shown": NO_NUMBERS}.get(word, word), ""
    if word == "differs":
        explained = result.get("explained", {})
        kind += ", explained by a run" if "run" in explained else ", a guess" if explained else ", not explained"
        why = f": {explained['why']}" if explained else ""
    words = f"differs{why} (*{explained['run']}*)" if kind.endswith("by a run") else kind + why
    return [*first, "; ".join(found), "–" if math.isnan(times) else number(times), words, f"*{result['run']}*"], kind


def lines(rows, ours):
    """Lines of the page. Raises ParameterError as `check`."""
    check(rows, ours)
    results = {row["id"]: [found for found in ours["results"] if found["row"] == row["id"]] for row in rows}
    tables, counted = {}, Counter()
    for row in rows:
        for result in results[row["id"]] or [None]:
            line, word = cells(row, result, ours["open"].get(row["id"]))
            tables.setdefault(row["source"], []).append(line)
            counted[word] += 1
    text = ["# The sources' numbers beside ours", "",
            f"Of {sum(counted.values())} lines: "
            + ", ".join(f"{count} {word}" for word, count in counted.most_common()) + ".", "",
            f"agrees: within two standard errors or {100 * CLOSE:g} %; near: within a factor of {FACTOR}; fitted: "
            "within it, and what our rock or its size was fitted to; differs: further off, or a statement that is not "
            "found, with the run that explains it; a guess: no run has tested the explanation. Statements are judged "
            "by hand. ± is the standard error of the mean over packings. "
            f"{NO_NUMBERS[0].upper() + NO_NUMBERS[1:]}: a figure of which the text gives none; what we found stands "
            "beside it. Numbers that a source gives as input are defaults of the scenes and are not listed, but for "
            "counts of particles, which follow from sizes that are ours.", ""]
    for source, table in tables.items():
        text += [f"## [{source}]", "", *generated.table(COLUMNS, table)]
    return text + ["## Runs", "", "Commit: of the code that ran, or of the numbers' entry where it was not noted.", "",
                   *generated.table(["run", "command", "commit", "date", "wall time"],
                                    [[f"*{name}*", f"`{run['command']}`", *(run[key] for key in RUN[1:])]
                                     for name, run in ours["runs"].items()])]


def entered(ours, given):
    """The own results with a mean over finished runs, which replaces an earlier one of the same row and `set`; the row
    is open no more."""
    name = ", ".join(filter(None, (given.enter, given.set)))
    runs = [RunFolder(folder) for folder in given.folders]
    values = np.array([run.result(given.result) for run in runs])
    require(np.isfinite(values).all(), "result", given.result, "a finite number in each summary.json")
    seconds = sum(run.summary["wall_time"]["total"] for run in runs)
    mean, error = map(float, generated.mean_and_error(values))
    result = {"row": given.enter, "run": name, "value": mean, "packings": len(values)}
    if len(values) > 1:
        result["error"] = error
    if given.set:
        result["set"] = given.set
    kept = [old for old in ours["results"] if old["run"] != name]
    still = {row: why for row, why in ours["open"].items() if row != given.enter}
    run = {"command": given.command, "commit": given.commit, "date": generated.ORIGIN["date"],
           "wall": f"{seconds / 60:.0f} min"}
    return {**ours, "runs": {**ours["runs"], name: run}, "results": [*kept, result], "open": still}


def main(words):
    """Write the page, or enter a result. -> exit code."""
    parser = Parser(prog="python3 -m calibration.fidelity", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=OURS.with_suffix(".md"))
    for name in ("enter", "result", "command", "commit", "set"):
        parser.add_argument(f"--{name}", default="")
    parser.add_argument("folders", nargs="*")
    given = parser.parse_args(words)
    try:
        ours = json.loads(OURS.read_text(encoding="utf-8"))
        if given.enter:
            ours = entered(ours, given)
            check(published.ROWS, ours)
            OURS.write_text(json.dumps(ours, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        else:
            generated.write_page(given.out, lines(published.ROWS, ours))
    except (ParameterError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

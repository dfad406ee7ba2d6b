"""The fidelity page: the join of published rows and own results, the verdicts, and what is refused."""
import json
import math
from copy import deepcopy

import pytest

from calibration import fidelity
from rockwear.kernels.checks import ParameterError
from rockwear.report import published

ROW = {"source": "Rojek 2014", "place": "5.1", "reading": "as printed"}
ROWS = [{**ROW, "id": "ucs", "what": "UCS", "value": 60e6, "unit": "Pa"},
        {**ROW, "id": "k", "what": "k", "value": [0.002, 0.003], "unit": "-"},
        {**ROW, "id": "chip", "what": "cut", "stated": "a chip"},
        {**ROW, "id": "map", "what": "temperatures"}]
RUN = {"command": "python3 -m calibration.fidelity", "commit": "0000000", "date": "2026-01-01", "wall": "1 s"}
OURS = {"runs": {"lab": RUN}, "results": [{"row": "ucs", "run": "lab", "value": 58e6, "error": 1.5e6, "packings": 5},
                                          {"row": "chip", "run": "lab", "agrees": True, "found": "a chip of 20 mm"}],
        "open": {"k": "not run: no laboratory"}}


def changed(**result):
    """OURS with another first result."""
    own = deepcopy(OURS)
    own["results"][0] = {**own["results"][0], **result}
    return own


@pytest.mark.parametrize("value, error, word, times", [
    (58e6, 1.5e6, "agrees", 58 / 60), (62.9e6, 0.0, "agrees", 62.9 / 60), (80e6, 11e6, "agrees", 4 / 3),
    (80e6, 9e6, "near", 4 / 3), (90e6, 0.0, "near", 1.5), (90.8e6, 1.1e6, "differs", 90.8 / 60),
    (41e6, 1e6, "near", 41 / 60), (39e6, 1e6, "differs", 0.65)])
def test_the_verdict_on_a_number(value, error, word, times):
    assert fidelity.verdict(ROWS[0], {"value": value, "error": error}) == (word, pytest.approx(times))


@pytest.mark.parametrize("value, word", [(58e6, "fitted"), (80e6, "fitted"), (95e6, "differs")])
def test_a_number_that_ours_was_fitted_to_does_not_agree_with_it(value, word):
    assert fidelity.verdict(ROWS[0], {"value": value, "fitted": True})[0] == word


@pytest.mark.parametrize("value, word, times", [
    (0.0025, "agrees", 1), (0.002, "agrees", 1), (0.0018, "near", 0.9), (0.0045, "near", 1.5), (0.006, "differs", 2)])
def test_the_verdict_on_a_range_counts_from_its_nearer_end(value, word, times):
    assert fidelity.verdict(ROWS[1], {"value": value}) == (word, pytest.approx(times))


def test_the_verdict_on_a_statement_and_on_a_figure():
    assert [fidelity.verdict(ROWS[2], {"agrees": agrees})[0] for agrees in (True, False, None)] == [
        "agrees", "differs", "unclear"]
    word, times = fidelity.verdict(ROWS[3], {"found": "shown"})
    assert word == "shown" and math.isnan(times)


def test_every_published_row_is_a_line_of_the_page():
    page = fidelity.lines(ROWS, OURS)
    table = [line.split(" | ") for line in page if line.startswith("| 5.1")]
    assert [line[1] for line in table] == ["UCS", "k", "cut", "temperatures"]
    assert table[0][2:] == ["60 MPa", "as printed", "58.0 ± 1.5 MPa (5)", "0.967", "agrees", "*lab* |"]
    assert table[1][2] == "0.002 to 0.003" and table[1][6] == "not run: no laboratory"
    assert table[2][4:7] == ["a chip of 20 mm", "–", "agrees"] and table[3][6] == "no numbers in the source"
    assert "Of 4 lines: 2 agrees, 1 not run, 1 no numbers in the source." in page
    assert "| *lab* | `python3 -m calibration.fidelity` | 0000000 | 2026-01-01 | 1 s |" in page


@pytest.mark.parametrize("row", ["map", "ucs"])
@pytest.mark.parametrize("kind", ["not run", "not entered"])
def test_what_was_not_run_is_told_from_what_the_source_gives_no_number_of(row, kind):
    """A figure without numbers may be open, too: a run could show it."""
    own = {**OURS, "results": [one for one in OURS["results"] if one["row"] != row],
           "open": {**OURS["open"], row: f"{kind}: it takes days"}}
    line, word = fidelity.cells(next(one for one in ROWS if one["id"] == row), None, own["open"][row])
    assert word == kind and line[-4:] == ["–", "–", f"{kind}: it takes days", "–"]
    assert f" {2 if kind == 'not run' else 1} {kind}" in "\n".join(fidelity.lines(ROWS, own))


def test_a_figure_with_a_result_of_ours_still_has_no_numbers_in_the_source():
    result = {"row": "map", "run": "lab", "found": "20 K"}
    assert fidelity.cells(ROWS[3], result, None)[0][-4:] == ["20 K", "–", "no numbers in the source", "*lab*"]


def test_a_difference_names_the_run_that_explains_it_or_says_that_there_is_none():
    page = "\n".join(fidelity.lines(ROWS, changed(value=120e6)))
    assert "| 2 | differs, not explained | *lab* |" in page and "1 differs, not explained" in page
    page = "\n".join(fidelity.lines(ROWS, changed(value=120e6, explained={"run": "lab", "why": "half the radius"})))
    assert "| 2 | differs: half the radius (*lab*) | *lab* |" in page and "1 differs, explained by a run" in page
    page = "\n".join(fidelity.lines(ROWS, changed(value=120e6, explained={"why": "half the radius"})))
    assert "| 2 | differs, a guess: half the radius | *lab* |" in page and "1 differs, a guess" in page


def without(name, key):
    """ROWS and OURS where `key` of one row or run is missing."""
    rows, own = deepcopy(ROWS), deepcopy(OURS)
    own["runs"]["lab"].pop(key) if name == "lab" else rows[0].pop(key)
    return rows, own


@pytest.mark.parametrize("rows, own, words", [
    (*without("ucs", "reading"), "ucs: reading"), (*without("lab", "command"), "run lab: command"),
    (*without("lab", "commit"), "run lab: commit"), (ROWS + ROWS[:1], OURS, "different names"),
    (ROWS, changed(row="uc"), "result = uc"), (ROWS, changed(run="field"), "ucs: run = field"),
    (ROWS, changed(row="map"), "map: value"), (ROWS, changed(row="chip"), "chip: value"),
    (ROWS, changed(agrees=True), "ucs: agrees"), (ROWS, changed(error=-1.0), "ucs: error"),
    (ROWS, changed(value=math.nan), "finite"), (ROWS, changed(explained={"run": "lab", "why": "?"}), "nothing differs"),
    (ROWS, changed(value=1e6, explained={"run": "field", "why": "?"}), "ucs: run = field"),
    (ROWS, changed(value=1e6, explained={"run": "lab"}), "ucs: why"),
    (ROWS, {**OURS, "open": {"ucs": "not run: why"}}, "open = ucs"),
    (ROWS, {**OURS, "open": {"k": "no laboratory"}}, "k: open"), (ROWS, {**OURS, "open": {"k": "not run"}}, "k: open")])
def test_what_does_not_match_is_refused(rows, own, words):
    with pytest.raises(ParameterError, match=words):
        fidelity.check(rows, own)


def test_a_result_of_finished_runs_is_entered_with_its_standard_error(tmp_path, monkeypatch):
    for seed, depth in enumerate((0.2e-3, 0.3e-3), 1):
        (tmp_path / str(seed)).mkdir()
        (tmp_path / str(seed) / "summary.json").write_text(json.dumps({
            "results": {"maximum_wear_depth": {"value": depth, "unit": "m"}}, "wall_time": {"total": 90.0}}))
    file = tmp_path / "fidelity.json"
    file.write_text(json.dumps({"runs": {}, "results": [], "open": {}}))
    monkeypatch.setattr(fidelity, "OURS", file)
    words = ["--enter", "m-13.3-depth", "--result", "maximum_wear_depth", "--commit", "0000000", str(tmp_path / "1")]
    assert fidelity.main([*words, "--command", "cut"]) == 0
    assert fidelity.main([*words, str(tmp_path / "2"), "--command", "cut"]) == 0
    own = json.loads(file.read_text())
    assert own["results"] == [{"row": "m-13.3-depth", "run": "m-13.3-depth", "value": pytest.approx(0.25e-3),
                               "packings": 2, "error": pytest.approx(0.05e-3)}]
    assert own["runs"]["m-13.3-depth"]["wall"] == "3 min"
    # With other settings it stands beside it, and what was open is open no more.
    file.write_text(json.dumps({**own, "open": dict.fromkeys(("m-13.3-depth", "m-2.1-ductility"), "not run: x")}))
    assert fidelity.main([*words, "--command", "cut", "--set", "Rn 500"]) == 0
    both = json.loads(file.read_text())
    assert [(one["run"], one.get("set")) for one in both["results"]] == [
        ("m-13.3-depth", None), ("m-13.3-depth, Rn 500", "Rn 500")] and list(both["open"]) == ["m-2.1-ductility"]
    before = file.read_text()
    assert fidelity.main(words) == 2 and file.read_text() == before


def test_the_stored_page_is_that_of_the_stored_results():
    """Data and page are committed together; the first line is on the origin."""
    stored = fidelity.OURS.with_suffix(".md").read_text(encoding="utf-8").splitlines()
    rows = [line for line in fidelity.lines(published.ROWS, json.loads(fidelity.OURS.read_text(encoding="utf-8")))
            if line.startswith("|")]
    assert rows == [line for line in stored if line.startswith("|")]


def test_each_published_number_or_statement_has_a_result_or_a_reason():
    own = json.loads(fidelity.OURS.read_text(encoding="utf-8"))
    named = {result["row"] for result in own["results"]} | own["open"].keys()
    assert [row["id"] for row in published.ROWS if ("value" in row or "stated" in row) and row["id"] not in named] == []

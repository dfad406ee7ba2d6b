"""The verdicts of make validate, and the runs it and the campaigns start."""
import json
import math

import pytest

from calibration.validation import __main__ as validate
from calibration.campaigns.runs import RunFailed, Runs, finished


@pytest.mark.parametrize("got, source, verdict", [
    (60.5, False, "holds"), (62.0, False, "FAILS"), (math.nan, False, "FAILS"), (60.5, True, "agrees"),
    (62.0, True, "differs")])
def test_verdicts(got, source, verdict):
    assert validate.Row("strength", 60.0, got, 1.0, "MPa", source).verdict == verdict


def test_only_what_must_hold_fails_the_validation(tmp_path, monkeypatch):
    def main(*rows):
        monkeypatch.setattr(validate, "SECTIONS", [validate.Section("Title", "Words.", lambda runs: (rows, {}))])
        return validate.main(tmp_path)

    assert main(validate.Row("a", 1.0, 1.0, 0.0), validate.Row("b", 1.0, 2.0, 0.1, source=True)) == 0
    assert "1 differ" in (tmp_path / "validation.html").read_text(encoding="utf-8")
    assert main(validate.Row("a", 1.0, 2.0, 0.1)) == 1
    assert json.loads((tmp_path / "validation.json").read_text(encoding="utf-8"))[0]["verdict"] == "FAILS"


def test_a_finished_run_is_kept_only_for_the_same_values(tmp_path):
    assert not finished(tmp_path, {})
    stored = {"exit_code": 0, "files": {}, "parameters": {"kn": 2e10, "heat": False, "test": "tension"}}
    (tmp_path / "summary.json").write_text(json.dumps(stored), encoding="utf-8")
    assert finished(tmp_path, {"kn": "2e10", "heat": "false", "test": "tension"})
    assert not finished(tmp_path, {"kn": 1e10}) and not finished(tmp_path, {"kt": 1e10})


def test_a_run_that_fails_says_so(tmp_path):
    with Runs(tmp_path) as runs, pytest.raises(RunFailed, match="bad ended with 2: error: sped = 1"):
        runs.start("bad", "yade_scripts/uniaxial.py", sped=1).result()

"""The verdicts of make validate."""
import json
import math

import pytest

from calibration.validation import __main__ as validate


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

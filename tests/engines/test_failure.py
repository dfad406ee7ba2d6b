"""Strength tests end where the stress has fallen, not where it wavers before it has risen."""
import json

from tests.running import ROOT, run_script


def test_a_test_ends_with_a_fall_that_is_more_than_noise(tmp_path):
    file = tmp_path / "found.json"
    done = run_script(ROOT / "tests/engines/scripts/failure.py", str(file))
    assert done.code == 0, done.stderr
    assert json.loads(file.read_text(encoding="utf-8")) == {
        "a fall": [3, "failed at 5 MPa", True], "noise of the first loading": [7, "failed at 19 MPa", True],
        "a part that is no fall": [2, "failed at 9 MPa", True], "nothing broken": None}

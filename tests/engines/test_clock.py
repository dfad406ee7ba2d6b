"""The clock of YADE's own time counts no Python, and the first failure of a step is raised."""
import json

from tests.running import ROOT, run_script


def test_yades_own_time_has_neither_engines_nor_runners_in_it(tmp_path):
    file = tmp_path / "found.json"
    done = run_script(ROOT / "tests/engines/scripts/clock.py", str(file))
    assert done.code == 0, done.stderr
    found = json.loads(file.read_text(encoding="utf-8"))
    assert 0.0 < found["yade"] < found["all"] - found["python"]
    # What fails first is the cause.
    assert found["raised"] == "first"

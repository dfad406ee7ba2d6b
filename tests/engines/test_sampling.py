"""Samples of slip in bonds keep out of step with looks at them."""
import json

from tests.running import ROOT, run_script


def test_samples_of_slip_come_equally_often_at_each_step_after_a_look(tmp_path):
    # A look weakens bonds, and they slip right after it: samples at always the same step miss or overstate it.
    file = tmp_path / "found.json"
    done = run_script(ROOT / "tests/engines/scripts/sampling.py", str(file))
    assert done.code == 0, done.stderr
    found = json.loads(file.read_text(encoding="utf-8"))
    between = found["looks"][1] - found["looks"][0]
    phases = [sum(step % between == phase for step in found["samples"]) for phase in range(between)]
    assert between > 1 and min(phases) > 0 and max(phases) - min(phases) <= 1
    # A sample is the work of one step: what it starts from is kept right before.
    assert {step - 1 for step in found["samples"][1:]} <= set(found["prepared"])

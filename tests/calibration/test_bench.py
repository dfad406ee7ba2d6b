"""make bench: the cost of the engines from turns, and the time of each part on the page."""
import json

import pytest

from calibration.benchmarks import __main__ as bench


def test_engines_cost_what_a_turn_with_them_takes_longer(tmp_path, monkeypatch):
    seconds, begun = iter([1.2e-3, 1e-3, 3e-3, 2e-3, 1.3e-3, 1e-3]), []

    def run(script, place, words):
        begun.append((place.name, words[-1]))
        place.mkdir(parents=True)
        (place / "overhead.json").write_text(json.dumps({"seconds_a_step": next(seconds)}), encoding="utf-8")

    monkeypatch.setattr(bench, "run_script", run)
    monkeypatch.setattr(bench, "TURNS", 3)
    found = bench.engine_cost(tmp_path)
    assert found["overhead"] == pytest.approx([0.2, 0.3, 0.5])
    assert begun[:3] == [("0-alive", "alive"), ("0-dead", "dead"), ("1-alive", "alive")]
    assert bench.in_words(found) == ("All Python engines at the defaults: 30.0 % (20.0 to 50.0) of YADE's own step of "
                                     "1.00 ms")


def test_the_page_tells_how_long_each_part_took(tmp_path, monkeypatch):
    clock = iter([0.0, 90.0, 90.0, 240.0])
    monkeypatch.setattr(bench.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(bench, "PARTS", {"one": lambda folder: ["1"], "two": lambda folder: ["2", ""]})
    bench.main(tmp_path / "out")
    text = (tmp_path / "out/bench.md").read_text(encoding="utf-8")
    assert "\n1\n2\n" in text and "Wall minutes: one 1.5, two 2.5; 4.0 in all." in text

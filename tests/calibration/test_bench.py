"""make bench: the time of each part on the page."""
from calibration.benchmarks import __main__ as bench


def test_the_page_tells_how_long_each_part_took(tmp_path, monkeypatch):
    clock = iter([0.0, 90.0, 90.0, 240.0])
    monkeypatch.setattr(bench.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(bench, "PARTS", {"one": lambda folder: ["1"], "two": lambda folder: ["2", ""]})
    bench.main(tmp_path / "out")
    text = (tmp_path / "out/bench.md").read_text(encoding="utf-8")
    assert "\n1\n2\n" in text and "Wall minutes: one 1.5, two 2.5; 4.0 in all." in text

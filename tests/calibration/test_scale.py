"""The table of scale, from made-up blocks."""
import json

import pytest

from calibration.benchmarks import one_curve, scale


def runs(particles, ns, turns=3):
    """What blocks of three bonds a particle wrote; ns (turns times 10 % apart)."""
    return [{"particles": particles, "bonds": 3 * particles, "cpu": 1e-9 * ns * (1 + 0.1 * turn) * 3 * particles,
             "bytes": 5000.0, "energy": 2.0} for turn in range(turns)]


@pytest.fixture
def found():
    """Every doubling of the size takes 2^0.5 as long per bond, scattered; nothing more along the curve."""
    cases = {**scale.blocks(scale.SIZES), **scale.verlet()}
    made = {name: runs(options["particles"],
                       4 * options["particles"]**0.5 if options.get("order") == "scattered" else 400)
            for name, options in cases.items()}
    return {**made, **{name: runs(options["particles"], 440, 1) for name, options in scale.blocks(scale.LARGE).items()}}


def test_growth_is_of_the_step_and_not_of_the_bond(found):
    first, last = (found[scale.name_of(2, n, "scattered")] for n in (scale.FIRST, scale.LAST))
    assert scale.growth(first, last) == pytest.approx((46**0.5, 1.5))


def test_the_table_has_medians_and_their_scatter(found):
    rates = {name: [10.0 * jobs, 12.0 * jobs, 11.0 * jobs] for name, jobs, _ in scale.THREADS}
    text = "\n".join(scale.table(found, rates))
    assert "From 2000 to 92000 discs: scattered 6.78 times as long per bond and step, exponent 1.50; packing " in text
    assert "| 2 | 20000 | 60000 | 622 ± 57 | 440 ± 40 | 440 ± 40 | 1.00 | 1.00 | 5.0 ± 0.0 | 0e+00 |" in text
    # What ran once has no scatter, and what has no other order no ratio.
    assert "| 2 | 1000000 | 3000000 | – | – | 440 | – | 1.00 | 5.0 | – |" in text
    assert "| two jobs, -j1, together | 22.0 ± 2.0 | 2.00 |" in text
    assert scale.drawn(found)


def test_large_blocks_run_when_they_are_asked_for(tmp_path, monkeypatch):
    made = []

    def block(folder, **options):
        made.append(options)
        return runs(options["particles"], 400, 1)[0]

    monkeypatch.setattr(scale, "block", block)
    monkeypatch.setattr(scale, "together", lambda folder, jobs, threads: 10.0 * jobs)
    scale.measure(tmp_path, False)
    assert max(options["particles"] for options in made) == scale.LAST
    asked = []
    monkeypatch.setattr(one_curve.sys, "argv", ["scale.py", str(tmp_path), "--large"])
    one_curve.main(lambda folder, large=False: asked.append(large) or ["words"], "--large")
    assert asked == [True] and (tmp_path / "scale.md").read_text(encoding="utf-8").endswith("\n\nwords\n")
    scale.curve(tmp_path, large=True)
    assert json.loads((tmp_path / "scale.json").read_text(encoding="utf-8"))["blocks"]["2D-1000000-curve"]

"""Campaigns of the laboratory: runs kept, tables and figures made; what a speed curve concludes."""
import numpy as np
import pytest

from calibration.campaigns import uniaxial as campaign
from calibration.benchmarks import loading_speed
from calibration.campaigns import uniaxial_figures
from calibration.validation import uniaxial as uniaxial_validation

TINY = dict(width=0.03, height=0.02, radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=0.1e6)


def test_a_campaign_keeps_what_is_finished_and_shows_it(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(campaign, "CAMPAIGNS", {
        **{name: ({}, {}, ()) for name in campaign.CAMPAIGNS}, "small": ({"brittle": {}}, TINY, (1, 2))})
    assert campaign.main(tmp_path, ["small"]) == 0
    summaries = sorted(tmp_path.glob("small/*/summary.json"))
    written = [path.stat().st_mtime_ns for path in summaries]
    assert len(summaries) == 4
    assert campaign.main(tmp_path, ["small"]) == 0
    assert [path.stat().st_mtime_ns for path in summaries] == written
    rows = uniaxial_figures.read_csv(tmp_path / "uniaxial.csv")
    strength = {(row["test"], row["seed"]): row["peak_stress"] for row in rows}
    assert all(strength["compression", seed] > 1.5 * strength["tension", seed] > 0 for seed in (1, 2))
    assert "| brittle | 2 |" in (tmp_path / "tables.md").read_text(encoding="utf-8")
    assert (tmp_path / "over_softening.png").exists()


def test_cracks_alike_and_localised():
    rng = np.random.default_rng(0)
    band = np.zeros((40, 40))
    band[10:14] = 1
    assert uniaxial_figures.localised(band) == 1.0
    assert uniaxial_figures.localised(np.ones((40, 40))) == pytest.approx(0.2)
    assert uniaxial_figures.alike(band, band) == pytest.approx(1)
    assert abs(uniaxial_figures.alike(rng.random((40, 40)), rng.random((40, 40)))) < 0.1


def test_the_default_speed_is_the_fastest_below_which_all_is_within_the_tolerance():
    def rows(*off):
        return [{"speed": speed, "low": min(d, 0.0), "high": max(d, 0.0)} for speed, d in zip(loading_speed.SPEEDS, off)]

    assert loading_speed.fastest(rows(0.05, 0.03, 0.015, -0.01, 0.003, 0)) == 0.1
    assert loading_speed.fastest(rows(0.0, 0.0, 0.0, -0.03, 0.0, 0)) == 0.025


def test_sections_of_the_validation_name_runs_their_judges_find():
    class Run:
        summary = {"balances": {"energy": {"residual": 0.0, "platen_work": 1.0}}}

        @staticmethod
        def result(name):
            return 1.0

    for section in uniaxial_validation.SECTIONS[1:]:
        rows, _ = section.judge({name: Run for name in section.runs})
        assert len(rows) >= 4 and all(np.isfinite(row.got) for row in rows)

"""make campaign-wear in miniature: its page, its figures' numbers, the worn shapes that cut fresh rock, runs kept."""
import csv
import subprocess
import sys
from functools import partial

import numpy as np
import pytest

from calibration.campaigns import wear as campaign_wear, sharp_and_worn
from calibration.campaigns.runs import finished
from rockwear.kernels.polygon import area
from rockwear.report.folder import RunFolder

from tests.running import ROOT

ROCK = dict(width=0.045, height=0.03, radius_min=2e-3, radius_max=3e-3)
TINY = dict(ROCK, tooth_height=0.02, tooth_width=0.014, rake=10, clearance=10, tip_radius=2e-3, depth_of_cut=8e-3,
            start_up=9e-4, cycles=2, cycle_time=3e-4, snapshot_period=4e-4, heat="false")
PARTICLES = dict(tool_radius_min=0.4e-3, tool_radius_max=0.6e-3)
SEEDS = 1, 2
CASES = {"ripper, 2e5": dict(wear_acceleration=4e5, report="false"),
         "twice as fast": dict(wear_acceleration=8e5, start_up=6e-4, cycles=1)}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """-> (folder of the finished campaign, a function that runs it again)."""
    folder = tmp_path_factory.mktemp("campaign")

    def run():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(campaign_wear, "CASES", {
                name: (campaign_wear.TOOTH, {**TINY, **PARTICLES, **values}) for name, values in CASES.items()})
            patch.setattr(campaign_wear, "SAME_WORK", {"a hundredth": tuple(CASES), "a quarter": ("test tooth, 9e9",)})
            patch.setattr(sharp_and_worn, "SHAPES", 2)
            patch.setattr(sharp_and_worn, "CUT", {**sharp_and_worn.CUT, **ROCK, "start_up": 6e-4,
                                                  "report": "false"})
            patch.setattr(sharp_and_worn, "main", partial(sharp_and_worn.main, seeds=SEEDS))
            campaign_wear.main(folder)
    run()
    return folder, run


def test_the_page_shows_every_run(campaign):
    page = (campaign[0] / "report.html").read_text(encoding="utf-8")
    for words in (*CASES, "Rate of wear", "until a hundredth of the tooth is worn off", "Sharp and worn"):
        assert words in page
    assert "a quarter" not in page


def test_what_the_figure_of_accelerations_compares(campaign):
    runs = {name: RunFolder(campaign[0] / name.replace(", ", "-").replace(" ", "_")) for name in CASES}
    slow, fast = runs.values()
    assert campaign_wear.profile(slow).sum() == pytest.approx(slow.result("worn_volume"), rel=1e-6)
    lines = campaign_wear.comparison_figure(runs).axes[1].lines
    found, = [line.get_ydata() for line in lines if line.get_marker() == "o"]
    share_of_fast, share_of_slow = (share / share.sum() for share in map(campaign_wear.profile, (fast, slow)))
    assert found == pytest.approx([100 * np.abs(share_of_fast - share_of_slow).sum()])
    assert found[0] > 0


def test_worn_shapes_cut_fresh_rock(campaign):
    folder = campaign[0] / "sharp_and_worn"
    with open(folder / "sharp_and_worn.csv", encoding="utf-8") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert len(rows) == 2 * len(SEEDS) and all(row["mean_cutting_force"] > 0 for row in rows)
    new, worn = (np.loadtxt(folder / f"outlines/tooth_{n}.csv", delimiter=",", skiprows=1) for n in (0, 1))
    assert new[:, 1].min() == 0 == worn[:, 1].min()
    lost = max(row["lost"] for row in rows)
    assert 0 < lost and area(worn) == pytest.approx((1 - lost) * area(new), rel=0.02)
    for seed in SEEDS:
        cuts = [RunFolder(folder / f"tooth_{n}-{seed}") for n in (0, 1)]
        assert len({cut.parameter("depth_of_cut", 0) for cut in cuts}) == 1
        assert np.array_equal(*(cut.model["rock_radii"] for cut in cuts))
        assert all(cut.result("worn_volume") == 0 for cut in cuts)


def test_finished_runs_stay(campaign):
    folder, run = campaign
    written = {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")}
    assert len(written) == len(CASES) + 2 * len(SEEDS)
    run()
    assert {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")} == written


def test_a_cut_with_another_shape_is_cut_again(campaign):
    folder = campaign[0] / "sharp_and_worn"
    outline, cut = folder / "outlines/tooth_1.csv", folder / f"tooth_1-{SEEDS[0]}"
    found, first = finished(cut, {"outline": outline}), outline.read_text(encoding="utf-8")
    try:
        outline.write_text(first.replace("\n", "\n ", 2), encoding="utf-8")
        assert found and not finished(cut, {"outline": outline})
    finally:
        outline.write_text(first, encoding="utf-8")


def test_a_run_that_failed_shows_its_error_and_is_not_kept(tmp_path, monkeypatch, capsys):
    """Its warnings come last, and it leaves a summary as well."""
    values = {**TINY, "tool": "segments", "wear_acceleration": 1e7}
    monkeypatch.setattr(campaign_wear, "CASES", {"too fast": (campaign_wear.TOOTH, values)})
    assert campaign_wear.main(tmp_path) == 1
    assert "too_fast ended with 1: error: the tool's shape cannot follow its wear" in capsys.readouterr().err
    assert (tmp_path / "too_fast/summary.json").exists() and not finished(tmp_path / "too_fast", values)


@pytest.mark.parametrize("rake", [-30, 0, 20])
def test_the_rake_of_a_straight_front_is_its_own(rake):
    slope = np.tan(np.radians(rake))
    tooth = np.array([[0.0, 0.0], [-0.03 * slope, 0.03], [-0.05, 0.03], [-0.05, 0.01]])
    assert np.degrees(sharp_and_worn.effective_rake(tooth, 0.015)) == pytest.approx(rake)


def test_a_folder_that_is_no_run_ends_in_one_line(tmp_path):
    command = [sys.executable, "-m", "calibration.campaigns.sharp_and_worn", tmp_path / "nowhere", tmp_path / "out"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8")
    assert done.returncode == 2 and done.stderr.startswith("error: ") and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_unknown_cases_are_named(tmp_path):
    with pytest.raises(SystemExit, match="no such case: ripper, 9"):
        campaign_wear.main(tmp_path / "out", "ripper, 9")
    assert not (tmp_path / "out").exists()

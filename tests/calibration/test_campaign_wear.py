"""make campaign-wear in miniature: its page, its figures' numbers, runs kept."""
import re

import numpy as np
import pytest

from calibration.campaigns import wear as campaign_wear
from calibration.campaigns.runs import finished
from rockwear.kernels.archard import MET91
from rockwear.report.folder import RunFolder
from tests.running import ROOT, run_script

ROCK = dict(width=0.045, height=0.03, radius_min=2e-3, radius_max=3e-3)
TINY = dict(ROCK, tooth_height=0.02, tooth_width=0.014, rake=10, clearance=10, tip_radius=2e-3, depth_of_cut=8e-3,
            start_up=9e-4, cycles=2, cycle_time=3e-4, snapshot_period=4e-4, tool_temperature=500)
PARTICLES = dict(tool_radius_min=0.4e-3, tool_radius_max=0.6e-3)
CASES = {"ripper, 2e5": dict(wear_acceleration=4e5, report="false"),
         "twice as fast": dict(wear_acceleration=8e5, start_up=6e-4, cycles=1)}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """-> (folder of the finished campaign, a function that runs it again)."""
    folder = tmp_path_factory.mktemp("campaign")

    def run():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(campaign_wear, "CASES", {
                name: (campaign_wear.RIPPER, {**TINY, **PARTICLES, **values}) for name, values in CASES.items()})
            patch.setattr(campaign_wear, "SAME_WORK", {"a hundredth": tuple(CASES), "a quarter": ("test tooth, 9e9",)})
            campaign_wear.main(folder)
    run()
    return folder, run


def test_the_page_shows_every_run(campaign):
    page = (campaign[0] / "report.html").read_text(encoding="utf-8")
    for words in (*CASES, "Rate of wear", "until a hundredth of the tooth is worn off"):
        assert words in page
    assert "a quarter" not in page


def test_the_ripper_wears_by_its_friction_at_the_hardness_of_20_degrees(campaign):
    """k F s / H of its own friction work; without heat, and whatever the temperature of the tool."""
    for name, values in CASES.items():
        run = RunFolder(campaign[0] / name.replace(", ", "-").replace(" ", "_"))
        assert run.summary["scene"] == "ripper"
        assert "heat" not in run.balances
        exact = 0.01128 * values["wear_acceleration"] / 0.3 * run.balances["friction"]["worn_by"] / MET91(293.15)
        assert run.result("worn_volume") == pytest.approx(exact, rel=1e-9, abs=0)


def test_what_the_figure_of_accelerations_compares(campaign):
    runs = {name: RunFolder(campaign[0] / name.replace(", ", "-").replace(" ", "_")) for name in CASES}
    slow, fast = runs.values()
    assert campaign_wear.profile(slow).sum() == pytest.approx(slow.result("worn_volume"), rel=1e-6)
    lines = campaign_wear.comparison_figure(runs).axes[1].lines
    found, = [line.get_ydata() for line in lines if line.get_marker() == "o"]
    share_of_fast, share_of_slow = (share / share.sum() for share in map(campaign_wear.profile, (fast, slow)))
    assert found == pytest.approx([100 * np.abs(share_of_fast - share_of_slow).sum()])
    assert found[0] > 0


def test_finished_runs_stay(campaign):
    folder, run = campaign
    written = {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")}
    assert len(written) == len(CASES)
    run()
    assert {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")} == written


def test_a_run_that_failed_shows_its_error_and_is_not_kept(tmp_path, monkeypatch, capsys):
    """Its warnings come last, and it leaves a summary as well."""
    values = {**TINY, "heat": "false", "tool": "segments", "wear_acceleration": 1e7}
    monkeypatch.setattr(campaign_wear, "CASES", {"too fast": (campaign_wear.TOOTH, values)})
    assert campaign_wear.main(tmp_path) == 1
    assert "too_fast ended with 1: error: the tool's shape cannot follow its wear" in capsys.readouterr().err
    assert (tmp_path / "too_fast/summary.json").exists() and not finished(tmp_path / "too_fast", values)


def defaults(script):
    """{parameter: its default as --help prints it}."""
    words = run_script(ROOT / script, "--help").stdout
    return {name: told.group(1) for name, text in re.findall(r"^  --(\w+) (.*?)(?=^  --|\Z)", words, re.M | re.S)
            if (told := re.search(r"\(default\s+([^\s;)]+)", text))}


@pytest.mark.parametrize("script, in_mass", [(campaign_wear.TOOTH, campaign_wear.TOOTH_IN_MASS),
                                             (campaign_wear.RIPPER, campaign_wear.RIPPER_IN_MASS)])
def test_the_tool_in_a_rock_mass_is_that_of_the_cycles(script, in_mass):
    cycles, steady = defaults(script), defaults(campaign_wear.STEADY)
    assert set(in_mass) <= set(steady)
    own = {"snapshot_period", "checkpoint_interval", "grading_factor", "rock", "window_behind", "window_ahead", "heat",
           "window_height", "ramp_length", "cut_length", "discs_per_depth", "hardness_temperature"}
    shared = set(in_mass) - own
    assert len(shared) > 15
    assert {name: in_mass[name] for name in shared} == {
        name: type(in_mass[name])(cycles[name]) for name in shared}
    mass = in_mass["window_behind"] + in_mass["window_ahead"]
    assert mass > in_mass["tooth_width"] and in_mass["hardness_temperature"] == campaign_wear.LONG[
        "hardness_temperature"]

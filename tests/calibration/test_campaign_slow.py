"""make campaign-slow: the same way at every speed, and what its page tells from chance."""
import json

import pytest

from calibration.campaigns import slow

SCENE = "segments, 8.1"


def made_up(folder, runs, force):
    """Summaries of the runs of a plan; force (kN/m): a function of speed and seed."""
    for (_, speed, seed), (name, *_) in runs.items():
        results = {"mean_cutting_force": 1e3 * force(speed, seed), "peak_cutting_force": 2e5, "mean_thrust_force": 1e4,
                   "tensile_cracks": 30 + seed, "shear_cracks": 1}
        (folder / name).mkdir()
        (folder / name / "summary.json").write_text(json.dumps({
            "results": {name: {"value": value, "unit": "-"} for name, value in results.items()},
            "balances": {"energy": {"tool_friction": 100.0 + seed}}, "parameters": {}}), encoding="utf-8")


def test_every_run_goes_the_same_way_and_heat_has_the_time_of_the_source():
    for (scene, speed, _), (_, _, values) in slow.plan(slow.SCENES, slow.SPEEDS).items():
        if scene.startswith("heat"):
            assert values["time_scale"] * slow.SOURCE == pytest.approx(speed)
        else:
            assert values["velocity"] * values["start_up"] == pytest.approx(slow.WAY) and values["velocity"] == speed


def test_what_the_speed_changes_in_the_same_packings_is_told(tmp_path):
    """Packings scatter by 20 kN/m; at 8 m/s each takes some 3 kN/m more than at 4."""
    runs = slow.plan([SCENE], [8.0, 4.0])
    made_up(tmp_path, runs, lambda speed, seed: 40 + 20 * seed + (3 + 0.1 * seed if speed > 4 else 0))
    fast, slowest = slow.rows(slow.measured(tmp_path, runs), SCENE)
    assert fast[:2] == ["8", 3] and slowest[:2] == ["4", 3] and slowest[-1] == "–"
    assert fast[-1] == "mean force"
    assert slowest[2] == "80 ± 12"


def test_a_change_as_large_as_its_scatter_is_not_told(tmp_path):
    runs = slow.plan([SCENE], [8.0, 4.0])
    made_up(tmp_path, runs, lambda speed, seed: 40 + 20 * seed + (3 * (-1)**seed if speed > 4 else 0))
    assert next(slow.rows(slow.measured(tmp_path, runs), SCENE))[-1] == "–"


def test_the_page_is_of_the_runs_that_exist(tmp_path):
    runs = slow.plan([SCENE], [8.0, 2.0])
    made_up(tmp_path, runs, lambda speed, seed: 50.0 + seed)
    assert slow.main(tmp_path, ["--read"]) == 0
    page = (tmp_path / "slow.md").read_text(encoding="utf-8")
    assert f"## {SCENE}" in page and "8.2" not in page and (tmp_path / "slow.png").stat().st_size > 1e4
    assert "| 8 | 3 |" in page and "| 2 | 3 |" in page and "| 4 | " not in page

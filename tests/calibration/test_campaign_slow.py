"""make campaign-slow: the same way at every speed, and what its page tells from chance."""
import json

import pytest

from calibration.campaigns import slow

SCENE = "segments, 8.1"


def made_up(folder, runs, force):
    """Summaries of the runs of a plan; force (kN/m): a function of speed and seed."""
    for (_, _, speed, seed), (name, *_) in runs.items():
        results = {"mean_cutting_force": 1e3 * force(speed, seed), "peak_cutting_force": 2e5, "mean_thrust_force": 1e4,
                   "tensile_cracks": 30 + seed, "shear_cracks": 1}
        (folder / name).mkdir()
        (folder / name / "summary.json").write_text(json.dumps({
            "results": {name: {"value": value, "unit": "-"} for name, value in results.items()},
            "balances": {"energy": {"tool_friction": 100.0 + seed}}, "parameters": {}}), encoding="utf-8")


def of(scene, *speeds):
    """The runs of slow.plan over the begin of the way, at these speeds."""
    return {key: run for key, run in slow.plan([scene]).items() if key[1] == slow.BEGIN and key[2] in speeds}


@pytest.mark.parametrize("full", [False, True])
def test_runs_of_a_way_differ_in_speed_alone_and_heat_has_the_time_of_the_source(full):
    """And their records have as many rows."""
    for (scene, way, speed, _), (_, _, values) in slow.plan(slow.SCENES, full).items():
        assert values["start_up"] / values["record_period"] == pytest.approx(way / slow.ROW)
        if scene.startswith("heat"):
            assert values["time_scale"] * slow.SOURCE == pytest.approx(speed)
            assert slow.SOURCE * values["start_up"] == pytest.approx(way)
        else:
            assert values["velocity"] * values["start_up"] == pytest.approx(way) and values["velocity"] == speed


def test_the_source_s_speed_is_reached_over_the_whole_way_on_demand_alone():
    ways = [{way for _, way, speed, _ in slow.plan([SCENE], full) if speed == slow.SOURCE} for full in (False, True)]
    assert ways == [{slow.BEGIN}, {slow.BEGIN, slow.WHOLE}]
    names = [name for name, *_ in slow.plan(slow.SCENES, True).values()]
    assert len(set(names)) == len(names) == 3 * 3 * 2 * 6


def test_what_the_speed_changes_in_the_same_packings_is_told(tmp_path):
    """Packings scatter by 20 kN/m; at 8 m/s each takes some 3 kN/m more than at 4."""
    runs = of(SCENE, 8.0, 4.0)
    made_up(tmp_path, runs, lambda speed, seed: 40 + 20 * seed + (3 + 0.1 * seed if speed > 4 else 0))
    fast, slowest = slow.rows(slow.measured(tmp_path, runs)[SCENE, slow.BEGIN])
    assert fast[:2] == ["8", 3] and slowest[:2] == ["4", 3] and slowest[-1] == "–"
    assert fast[-1] == "mean force"
    assert slowest[2] == "80 ± 12"


def test_a_change_as_large_as_its_scatter_is_not_told(tmp_path):
    runs = of(SCENE, 8.0, 4.0)
    made_up(tmp_path, runs, lambda speed, seed: 40 + 20 * seed + (3 * (-1)**seed if speed > 4 else 0))
    assert next(slow.rows(slow.measured(tmp_path, runs)[SCENE, slow.BEGIN]))[-1] == "–"


def test_the_page_is_of_the_runs_that_exist(tmp_path):
    made_up(tmp_path, of(SCENE, 8.0, slow.SOURCE), lambda speed, seed: 50.0 + seed)
    assert slow.main(tmp_path, ["--read"]) == 0
    page = (tmp_path / "slow.md").read_text(encoding="utf-8")
    assert f"## {SCENE}: 4 mm" in page and "40 mm" not in page and "8.2" not in page
    assert (tmp_path / "slow.png").stat().st_size > 1e4
    assert "| 8 | 3 |" in page and "| 0.04 | 3 |" in page and "| 4 | " not in page

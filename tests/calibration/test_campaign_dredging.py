"""make campaign-dredging: what is compared with what, the rise by hand, and the page."""
import json
import math

import numpy as np
import pytest

from calibration.campaigns import dredging
from tests.running import ROOT, run_script

STEEL = dict(tool_conductivity=60.0, tool_density=7830.0, tool_specific_heat=450.0)


class Pick:
    """A run whose pick has worn by these depths; its particles have a radius of 1 mm and an area of 4 mm² each."""

    def __init__(self, depths):
        self.depths = np.asarray(depths, float)
        self.model = {"tool_radii": np.full(len(depths), 1e-3), "tool_volumes": np.full(len(depths), 4e-6)}

    def snapshot(self, _):
        return {"worn_depth": self.depths}

    def parameter(self, name):
        return {**STEEL, "cut_time": 0.65}[name]


def test_runs_differ_by_what_their_case_says_alone():
    known = run_script(ROOT / dredging.SCRIPT, "--help").stdout
    runs = dredging.plan(dredging.PARTS)
    assert len({folder for folder, _ in runs.values()}) == len(runs)
    assert all(f"--{name} " in known for _, values in runs.values() for name in values)
    window = runs["window", 2][1]
    for case, (differs, packings, beside) in dredging.FIRST.items():
        assert runs[case, 2][1] == {**window, **differs} and (case, packings) in runs
        assert beside is None or beside in dredging.FIRST
    slab = sum(window[f"window_{side}"] for side in ("behind", "ahead")) / 16
    assert runs[dredging.REFERENCE, 1][1]["window_ahead"] > 2 * window["window_ahead"] and slab > 2 * 1.5e-3


def test_ratio_of_two_samples_has_the_errors_of_both():
    assert dredging.ratio_cell([2.0], [4.0]) == "0.50"
    assert dredging.ratio_cell([1.0, 3.0], [4.0, 4.0]) == "0.50 ± 0.25"
    assert dredging.ratio_cell([2.0, 2.0], [3.0, 5.0]) == "0.50 ± 0.12"


def test_rise_by_hand_is_that_of_a_half_space_over_the_worn_length():
    """Thin against the depth that heat reaches, the hottest part is the face: 2 q sqrt(t / pi) / e."""
    heat, effusivity = 7e3, math.sqrt(math.prod(STEEL.values()))
    rise = dredging.by_hand(Pick(np.r_[np.full(10, 2e-4), np.zeros(40)]), heat)
    face = 2 * heat / (10 * 2e-3 * 0.65) * math.sqrt(0.65 / math.pi) / effusivity
    assert rise == pytest.approx(face, rel=0.02)
    assert dredging.by_hand(Pick(np.r_[np.full(20, 2e-4), np.zeros(30)]), heat) == pytest.approx(0.5 * face, rel=0.02)
    assert math.isnan(dredging.by_hand(Pick(np.zeros(50)), heat))


def test_rise_by_hand_in_a_thick_part_is_what_its_capacity_allows():
    """A part much deeper than heat reaches holds all of it: its capacity gives the mean."""
    pick = Pick(np.r_[np.full(2, 2e-4), np.zeros(60000)])
    part = 0.01 * pick.model["tool_volumes"].sum()
    all_of_it = 7e3 / (STEEL["tool_density"] * STEEL["tool_specific_heat"] * part)
    assert dredging.by_hand(pick, 7e3) == pytest.approx(all_of_it, rel=0.01)


def test_the_page_is_of_the_runs_that_exist(tmp_path):
    for (case, seed), (name, _) in dredging.plan(["first"]).items():
        if case not in (dredging.REFERENCE, "window"):
            continue
        force = 1e5 * (1.0 if case == "window" else 2.0)
        results = {"mean_cutting_force": force, "mean_thrust_force": 1e4 + seed, "worn_volume": 1e-5,
                   "peak_temperature_hot_1": 284.0}
        (tmp_path / name).mkdir()
        (tmp_path / name / "summary.json").write_text(json.dumps({
            "results": {key: {"value": value, "unit": "-"} for key, value in results.items()},
            "balances": {"energy": {"tool_friction": 100.0}, "heat": {"generated": 50.0}},
            "parameters": {"ambient_temperature": 283.0}}), encoding="utf-8")
    assert dredging.main(tmp_path, ["--read"]) == 0
    page = (tmp_path / "dredging.md").read_text(encoding="utf-8")
    assert "| long window | 5 | 200 ± 0 |" in page and "| window | long window | 0.50 ± 0.00 |" in page
    assert "Three turns" not in page and "4 times" not in page

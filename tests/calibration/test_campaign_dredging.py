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
    for compared, time in dredging.COMPARED.values():
        for case, (differs, packings, beside) in compared.items():
            assert runs[case, 2][1] == {**window, **differs, "cut_time": time} and (case, packings) in runs
            assert beside is None or beside in compared
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


class Turns(Pick):
    """Two turns of a cut and a time in the water; numbers grow from the first."""

    columns = {"stage": [1, 1, 2, 3, 3, 4], "working_time": [0.3, 0.65, 3.88, 4.2, 4.53, 7.76],
               "cutting_force": [1e5, 3e5, 0, 4e5, 6e5, 0], "thrust_force": [1e4, 3e4, 0, 5e4, 7e4, 0],
               "tool_friction": [1e3, 3e3, 3e3, 5e3, 8e3, 8e3], "pick_friction_heat": [8e2, 2e3, 2e3, 3e3, 6e3, 6e3],
               "tool_temperature_hot": [284, 285, 283, 287, 286, 283], "mass_lost": [0, 0.01, 0.01, 0.02, 0.03, 0.03],
               "tool_temperature_max": [290, 288, 283, 295, 299, 283]}
    summary = {"balances": {"energy": {"residual": -20.0, "tool_work": 1e4}}, "wall_time": {"total": 120.0}}

    def column(self, name):
        return np.array(self.columns[name], float)

    def parameter(self, name):
        return {"cycles": 2, "ambient_temperature": 283.0}.get(name) or super().parameter(name)

    def result(self, name):
        return {"rock_particles": 3500, "specific_energy": 6e6}[name]


def test_each_turn_has_its_own_part_of_what_is_summed():
    run = Turns([2e-4] * 10 + [0.0] * 40)
    first, second = dredging.turn_rows(run)
    assert first[:5] == [1, "200", "20", "3", "2"] and second[:5] == [2, "500", "60", "5", "4"]
    assert first[5] == "2" and second[5] == "4" and first[7] == "7" and second[7] == "16"
    assert first[6] == f"{dredging.by_hand(run, 2e3):.3g}" and second[6] == f"{dredging.by_hand(run, 4e3):.3g}"
    assert first[8] == "1" and second[8] == "3"


def test_turns_of_a_pick_that_does_not_wear_have_no_rise_by_hand():
    assert [row[6] for row in dredging.turn_rows(Turns(np.zeros(50)))] == ["–", "–"]


def test_the_page_of_turns_says_what_each_run_cost(tmp_path):
    runs = {("P", 1): Turns([2e-4, 0.0]), ("M-II", 1): Turns([2e-4, 0.0]), ("window", 1): Turns([0.0])}
    page = "\n".join(dredging.turn_tables(runs))
    assert page.count("### ") == 2 and page.count("energy misses 0.2 % of the tool's work; 2 min of wall time.") == 2
    temperature, mass = dredging.figure(runs).axes
    assert len(temperature.lines) == len(mass.lines) == 2
    assert temperature.lines[0].get_ydata().max() == 4 and mass.lines[1].get_ydata().max() == 3


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

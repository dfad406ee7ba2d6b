"""A scene that is laid out in memory anew goes on as if nothing had been done."""
import json

import pytest

from tests.running import BLOCK, BLOCK_OF_TRIANGLES, SMALL, arguments, checks_of

FAST = {"approach": 1e-4, "velocity": 8}
WINDOW = dict(discs_per_depth=0, window_behind=0.014, window_ahead=0.026, window_height=0.02, radius_min=0.8e-3,
              radius_max=1.2e-3, tool_radius_min=4e-4, tool_radius_max=5e-4, tooth_height=0.015, tooth_width=0.01,
              depth_of_cut=5e-3, velocity=20, ramp_length=1e-4, begin_angle=90)
WEAK = {"bond_tension": 2e6, "bond_cohesion": 4e6, "bond_fracture_energy": 1}
IN_SPACE = {"start": 0, "approach": 1e-4, "velocity": 6, "lowering_velocity": 8, "cut_time": 0.045}
CASES = {
    "heat, expansion, wear": ("cutting", {**SMALL, **FAST, "rock_expansion": 1e-5}),
    "segments": ("cutting", {**SMALL, **FAST, "tool": "segments"}),
    "softening in Python": ("cutting", {**SMALL, **FAST, "bond_law": "plastic", "heat": "false"}),
    "window": ("steady_cut", {**WINDOW, "Rn": 3e4, "Rt": 6e4}),
    "window, concrete model": ("steady_cut", {**WINDOW, **WEAK, "bond_law": "cohesive", "bond_crushing": 2e7}),
    "space": ("cutting_3d", {**BLOCK, **IN_SPACE}),
    "triangles": ("cutting_3d", {**BLOCK_OF_TRIANGLES, **IN_SPACE, "tool": "triangles"})}


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("laid_out")
    cases = {case: (scene, arguments(values)) for case, (scene, values) in CASES.items()}
    (folder / "cases.json").write_text(json.dumps(cases), encoding="utf-8")
    return checks_of("laid_out", folder, str(folder / "cases.json"))


@pytest.mark.parametrize("case", CASES)
def test_nothing_is_lost(found, case):
    """Sums over contacts in another order differ in their last digits, and that grows a little."""
    there = found[case]
    assert there["in_order"]
    assert all(difference < 1e-6 for difference in there["differs"].values()), there["differs"]


@pytest.mark.parametrize("case", CASES)
def test_a_resumed_run_is_laid_out_at_the_same_steps(found, case):
    assert set(found[case]["resumed differs"].values()) == {0.0}, found[case]["resumed differs"]


def test_rock_breaks_and_rubs_meanwhile(found):
    assert all(found[case]["friction"] > 0 for case in CASES)
    assert all(found[case]["cracks"] > 10 for case in CASES if "window" in case)

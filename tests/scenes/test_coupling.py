"""Heat and mechanics on each other: thermal expansion, friction heat, and the step between the two."""
import signal

import numpy as np
import pytest

from tests.running import assert_as_if_never_stopped, checks_of, interrupt, tooth_cycles

HOT = dict(rock_expansion=1e-3, start_up=6e-4, cycles=1, cycle_time=3e-4, checkpoint_interval=0.01, heat_period=2e-5,
           report="false")
"""A hundred times the rock's expansion, so that it tells."""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return checks_of("coupling", tmp_path_factory.mktemp("coupling"), "free", "constrained", "followed", "heated_disc",
                     "staggered", "sliding_block", "collisions")


def test_free_heating_leaves_no_stress(found):
    free = found["free"]
    assert free["force_of_strength"] < 1e-9
    assert free["force_relaxed"] < 1e-4
    assert free["strain"] == pytest.approx([free["expected"]] * 2, rel=5e-4)
    assert free["mass"] == pytest.approx(free["cold_mass"], rel=1e-14)


def test_heating_between_two_ends_gives_E_alpha_dtheta(found):
    fixed = found["constrained"]
    assert fixed["uniaxial"] == pytest.approx(fixed["E_alpha_dT"], rel=1e-4)
    assert fixed["packing_heated"] == pytest.approx(fixed["packing_pressed"], rel=5e-4)


def test_heating_fixed_all_around_gives_E_alpha_dtheta_by_one_less_nu(found):
    fixed = found["constrained"]
    assert np.array(fixed["plane"]) / fixed["plane_expected"] == pytest.approx(np.eye(2), abs=1e-9)


def test_work_of_expansion_is_what_the_bonds_store(found):
    assert found["constrained"]["work"] == pytest.approx(found["constrained"]["stored"], rel=1e-9)


def test_whole_softened_and_broken_bonds_answer_heat_as_they_answer_motion(found):
    cases = found["followed"]
    assert {case["broken"] for case in cases.values()} == {0, 1}
    for name, case in cases.items():
        assert case["deviation"] < 1e-9 and case["largest"] > 1e4, name


def test_a_heated_disc_in_a_cold_plate(found):
    """Against plane elasticity, in E alpha dtheta: 1 % of it inside, 0.3 % in the rings around."""
    inside, *around = found["heated_disc"]["rings"]
    rr, exact_rr, tt, exact_tt = inside
    assert rr == pytest.approx(exact_rr, abs=0.01) and tt == pytest.approx(exact_tt, abs=0.01) and rr < -0.4
    for rr, exact_rr, tt, exact_tt in around:
        assert rr == pytest.approx(exact_rr, abs=3e-3) and tt == pytest.approx(exact_tt, abs=3e-3) and rr < 0 < tt


def test_the_staggered_scheme_is_of_first_order_in_the_coupling_step(found):
    case = found["staggered"]
    error = abs(np.array(case["grown"]) / case["exact"] - 1)
    rate = np.polyfit(np.log(case["periods"]), np.log(error), 1)[0]
    assert rate == pytest.approx(1.0, abs=0.1)
    assert error[0] < 1.5e-3 and error[-1] < 2e-4


def test_friction_heat_of_a_sliding_block_is_exact_in_both_bodies(found):
    block = found["sliding_block"]
    assert block["touching"] == [5, 5, 5] and block["force"] == pytest.approx(1, rel=1e-9)
    assert block["slip"] < 0.6 * block["all_slip"]
    assert block["tool_heat"] == pytest.approx(block["tool_exact"], rel=1e-9)
    assert block["rock_heat"] == pytest.approx(block["rock_exact"], rel=1e-9)
    assert block["spread"] < 1e-9


def test_a_cut_with_expansion_closes_its_balances_and_resumes_to_the_last_bit(tmp_path):
    whole, out = tooth_cycles(tmp_path / "whole", **HOT), tmp_path / "out"
    assert whole.code == 0, whole.stderr
    balance = whole.summary["balances"]["energy"]
    assert balance["thermal_expansion"] != 0 and abs(balance["residual"]) < 0.02 * balance["tool_work"]
    assert interrupt(out, signal.SIGTERM, 2, **HOT).code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(tooth_cycles(out, "--resume", **HOT), whole)


@pytest.mark.parametrize("fraction, error", [(0.8, 0.07), (0.08, 5e-4)])
def test_what_a_disc_loses_against_the_tool_is_in_the_sums_of_friction_and_dashpot(found, fraction, error):
    cases = [case for case in found["collisions"] if case["fraction"] == fraction]
    assert [case["angle"] for case in cases] == [20, 45, 70]
    for case in cases:
        assert case["parted"] and case["friction"] > 0.04 * case["lost"]
        assert case["friction"] + case["dashpot"] == pytest.approx(case["lost"], rel=error)


def test_friction_of_a_collision_is_good_at_a_step_where_yades_own_sum_is_lost(found):
    by_case = {(case["angle"], case["fraction"]): case for case in found["collisions"]}
    for angle in (20, 45):
        fine = by_case[angle, 0.08]["friction"]
        assert by_case[angle, 0.8]["friction"] == pytest.approx(fine, rel=0.01)
        assert by_case[angle, 0.8]["yade"] < 0.5 * fine

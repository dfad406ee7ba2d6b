"""Dashpots of bonds [Rojek 2014, eqs 18-22] and damping of grains against the damped oscillator; energy, momentum."""
import math

import pytest

from tests.running import checks_of


@pytest.fixture(scope="module")
def checks(tmp_path_factory):
    return checks_of("dashpots", tmp_path_factory.mktemp("dashpots"))


def test_a_pair_decays_as_the_damped_oscillator(checks):
    assert checks["decay"] == pytest.approx(1, rel=2e-3)


def test_what_the_dashpots_dissipate_closes_the_balance(checks):
    for found in (checks["energy"], checks["strong"]):
        assert found["dissipated"] > 0.2 and abs(found["missed"]) < 2e-3


def test_forces_and_torques_are_internal(checks):
    assert checks["momentum"] < 1e-9


def test_discs_never_bonded_part_with_the_restitution_of_the_damped_oscillator(checks):
    found, ratio = checks["restitution"], 0.1
    assert found["bonds"] == 1 and abs(found["missed"]) < 2e-3
    assert found["ratio"] == pytest.approx(math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2)), rel=5e-3)


def test_a_pair_in_a_grain_decays_by_its_quality_factor(checks):
    assert checks["grain decay"] == pytest.approx(1, rel=1e-3)


def test_visits_in_step_with_a_vibration_do_not_feed_it(checks):
    """Velocities of the leapfrog are half a step behind the positions."""
    assert checks["in step"] <= 1.0


def test_a_ringing_grain_comes_to_rest_as_the_rigid_body_that_it_is(checks):
    found = checks["ringing finely"]
    assert found["bonds"] == 12 and abs(found["missed"]) < 1e-3 and found["momentum"] < 1e-9
    assert found["rigid"] == pytest.approx(1, abs=1e-3)


def test_a_grain_that_rings_hard_does_not_ring_louder(checks):
    """Without damping its energy grows twofold in a quarter of these steps, by YADE's rule for shear."""
    assert checks["ringing"]["kinetic"] < 0.15 and checks["ringing"]["momentum"] < 1e-9

"""Dashpots of bonds [Rojek 2014, eqs 18-22] against the damped oscillator, and their energy and momentum."""
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

"""Pulses of P and S waves that meet a boundary that absorbs, with wavelengths of 20 diameters in a lattice."""
import pytest

from tests.running import checks_of


@pytest.fixture(scope="module")
def checks(tmp_path_factory):
    return checks_of("absorbing", tmp_path_factory.mktemp("absorbing"))


@pytest.mark.parametrize("pulse, limit", [("P0", 0.05), ("S0", 0.06), ("P45", 0.15), ("S45", 0.15)])
def test_little_comes_back(checks, pulse, limit):
    assert checks[pulse]["amplitude"] < limit


def test_the_dashpots_take_what_is_missing(checks):
    assert all(abs(checks[pulse]["missed"]) < 3e-3 for pulse in ("P0", "S0", "P45", "S45"))


def test_a_particle_that_is_released_feels_nothing(checks):
    assert checks["release"] < 1e-6


def test_a_particle_that_is_pulled_off_stays_on_its_spring(checks):
    assert checks["pulled"] == pytest.approx({"force": 1, "shear": 1, "energy": 1}, rel=2e-3)

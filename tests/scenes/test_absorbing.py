"""Pulses of P and S waves that meet a boundary that absorbs, with wavelengths of 20 diameters in a lattice."""
import pytest

from tests.running import checks_of


@pytest.fixture(scope="module")
def checks(tmp_path_factory):
    return checks_of("absorbing", tmp_path_factory.mktemp("absorbing"))


@pytest.mark.parametrize("pulse, limit", [("P0", 0.05), ("S0", 0.05), ("P45", 0.15), ("S45", 0.15)])
def test_little_comes_back(checks, pulse, limit):
    assert checks[pulse]["amplitude"] < limit


@pytest.mark.parametrize("load", ["vertical", "horizontal"])
def test_a_load_that_stays_moves_the_surface_as_that_of_a_half_plane(checks, load):
    """Between 5 and 20 diameters from a load in the middle of a window of 60 x 30."""
    assert checks["settled"][load] == pytest.approx(1, abs=0.1)


def test_the_dashpots_take_what_is_missing(checks):
    assert all(abs(checks[pulse]["missed"]) < 3e-3 for pulse in ("P0", "S0", "P45", "S45"))


def test_a_particle_that_is_released_feels_nothing(checks):
    assert checks["release"] < 1e-6


def test_a_particle_has_all_of_its_mass_again_when_it_is_released(checks):
    """While it is held it lacks a fifth at most, less where the step would not be stable."""
    assert 0.1 < checks["lighter"] <= 0.2 + 1e-9 and checks["lighter_after_release"] == 0


def test_a_particle_that_is_pulled_off_stays_on_its_spring(checks):
    assert checks["pulled"] == pytest.approx({"force": 1, "shear": 1, "energy": 1}, rel=2e-3)

"""Archard's law and the hardness tables against the sources and exact volumes."""
import numpy as np
import pytest

from rockwear.kernels.archard import BRINELL, MET71, MET91, Hardness, wear_coefficient, wear_rate
from rockwear.kernels.checks import ParameterError

TABLE = [0, 200, 300, 400, 500, 600]


@pytest.mark.parametrize("steel, brinell", [(MET71, [500, 491, 480, 439, 362, 241]),
                                            (MET91, [515, 509, 498, 457, 375, 247])])
def test_table_rows_and_interpolation(steel, brinell):
    kelvin = np.array(TABLE) + 273.15
    assert steel(kelvin) == pytest.approx(np.array(brinell) * 9.80665e6, rel=1e-14)
    middle = 0.5 * (kelvin[1:] + kelvin[:-1])
    assert steel(middle) == pytest.approx(0.5 * (steel(kelvin)[1:] + steel(kelvin)[:-1]), rel=1e-14)


def test_outside_the_table_the_end_holds_with_one_warning():
    steel = Hardness(TABLE, [500, 491, 480, 439, 362, 241])
    with pytest.warns(UserWarning, match="leaves the hardness table"):
        assert steel(1000.0) == 241 * BRINELL
    assert steel(200.0) == 500 * BRINELL
    assert steel.leaves(200.0, 300.0) and steel.leaves(300.0, 900.0) and not steel.leaves(*steel.limits)
    assert not Hardness.constant(5e9).leaves(1.0, 3000.0)


@pytest.mark.parametrize("steel", [MET71, Hardness.constant(5e9)])
def test_a_temperature_that_is_no_number_has_no_hardness(steel):
    assert np.isnan(steel.nearest(np.nan))
    assert np.isnan(steel.nearest([np.nan, 300.0])).tolist() == [True, False]


@pytest.mark.parametrize("steel, depth, pressure, celsius, k", [
    (MET71, 1.6e-3, 34e6, 156, 0.0023), (MET71, 1.6e-3, 28.2e6, 146, 0.0028),
    (MET91, 2e-3, 9.1e6, 128, 0.0113), (MET91, 2e-3, 9.0e6, 213, 0.01125)])
def test_laboratory_rows(steel, depth, pressure, celsius, k):
    """[Rojek 2003, eq. 6.12-6.15] rounds k to 1e-4, with 512 HB read at 128 C (table: 511.2) and 10 MPa for one HB."""
    found = wear_coefficient(depth=depth, pressure=pressure, distance=100, hardness=steel(celsius + 273.15))
    assert found * 10e6 / BRINELL == pytest.approx(k, abs=0.7e-4)


def test_archard_volume_of_a_block():
    """A block of area A under the force F over the distance s loses k F s / H."""
    k, force, area, velocity, time, hardness = 0.01, 800.0, 25e-6, 0.117, 850.0, 5e9
    exact = k * force * velocity * time / hardness
    depth = wear_rate(k=k, pressure=force / area, slip_velocity=velocity, hardness=hardness) * time
    assert depth * area == pytest.approx(exact, rel=1e-14)
    assert wear_coefficient(depth=depth, pressure=force / area, distance=velocity * time,
                            hardness=hardness) == pytest.approx(k, rel=1e-14)


def test_slip_direction_does_not_matter():
    assert wear_rate(k=1e-3, pressure=1e6, slip_velocity=-2, hardness=1e9) == pytest.approx(2e-6, rel=1e-14)


@pytest.mark.parametrize("call, name", [
    (lambda: Hardness([0, 0], [1, 2]), "celsius"), (lambda: Hardness([0, 1], [1, -2]), "brinell"),
    (lambda: Hardness([], []), "celsius"), (lambda: Hardness([-300], [500]), "celsius"),
    (lambda: Hardness([0, 1], [1]), "brinell"), (lambda: Hardness([0, np.nan], [1, 2]), "celsius"),
    (lambda: Hardness.constant(0), "hardness"),
    (lambda: wear_rate(k=-1, pressure=1, slip_velocity=1, hardness=1), "k"),
    (lambda: wear_rate(k=1, pressure=-1, slip_velocity=1, hardness=1), "pressure"),
    (lambda: wear_rate(k=1, pressure=1, slip_velocity=1, hardness=0), "hardness"),
    (lambda: wear_coefficient(depth=1, pressure=0, distance=1, hardness=1), "pressure")])
def test_bad_input_names_the_parameter(call, name):
    with pytest.raises(ParameterError, match=f"^{name} = "):
        call()

"""The tool under its mean load: exact states of a bar, and heat that goes out as it comes in; means over a time."""
import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.tool_load import MeanLoad, tool_under_load

N, H, C = 20, 3.0, 2.0
BAR = dict(capacity=np.full(N, C), paths=(np.column_stack([np.arange(N - 1), np.arange(1, N)]), np.full(N - 1, H)),
           temperature=300.0, rock_temperature=np.full(N, 290.0), ambient=280.0)


def at(place, value):
    found = np.zeros(N)
    found[place] = value
    return found


def test_a_bar_with_a_fixed_shank_rises_linearly():
    network = tool_under_load(**BAR, friction_heat=at(0, 60.0), contact=np.zeros(N), convection=np.zeros(N),
                              shank=[N - 1], shank_temperature=310.0)
    assert network.steady_state() == pytest.approx(310 + 60 / H * np.arange(N - 1, -1, -1), rel=1e-12)


def test_with_an_insulated_shank_all_heat_goes_to_rock_and_air():
    contact, air, heat = at(0, 1.5), at(slice(5, 15), 0.2), at(slice(0, 3), 7.0)
    network = tool_under_load(**BAR, friction_heat=heat, contact=contact, convection=air)
    end = network.steady_state()
    out = (contact * (end - 290.0)).sum() + (air * (end - 280.0)).sum()
    assert out == pytest.approx(heat.sum(), rel=1e-10)
    network.advance(3000.0)
    assert network.temperature == pytest.approx(end, rel=1e-9)


def test_with_radiation_too_all_heat_goes_out():
    heat, shining = at(slice(0, 3), 7e3), at(slice(0, 8), 0.3)
    network = tool_under_load(**BAR, friction_heat=heat, contact=at(0, 1.5), convection=at(5, 0.2), radiation=shining)
    end = network.steady_state()
    out = 1.5 * (end[0] - 290.0) + 0.2 * (end[5] - 280.0) + 5.670374419e-8 * shining @ (end**4 - 280.0**4)
    assert out == pytest.approx(heat.sum(), rel=1e-10) and end.max() > 600


def test_no_load_leaves_the_tool_between_rock_and_air():
    network = tool_under_load(**BAR, friction_heat=np.zeros(N), contact=at(0, 1.0), convection=at(0, 1.0))
    assert network.steady_state() == pytest.approx(np.full(N, 285.0), rel=1e-12)


def test_a_load_without_a_way_out_is_refused():
    network = tool_under_load(**BAR, friction_heat=at(0, 1.0), contact=np.zeros(N), convection=np.zeros(N))
    with pytest.raises(ParameterError, match="no node is fixed"):
        network.steady_state()


def test_means_over_two_visits():
    load = MeanLoad(2)
    load.seconds += 4.0
    load.friction_heat += [8.0, 0.0]
    load.contact += [1.0, 0.0]
    load.contact_kelvin += [1.0 * 300.0, 0.0]
    load.contact += [3.0, 0.0]
    load.contact_kelvin += [3.0 * 400.0, 0.0]
    other = MeanLoad(2)
    other.restore(load.state())
    load.contact[:] = 0.0
    heat, contact, rock = other.means(ambient=283.0)
    assert heat.tolist() == [2.0, 0.0] and contact.tolist() == [1.0, 0.0] and rock.tolist() == [375.0, 283.0]

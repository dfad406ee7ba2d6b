"""Wear and temperature that an engineer expects by hand of a steady cut."""
import math
from types import SimpleNamespace

import numpy as np
import pytest

from rockwear.kernels.archard import MET91, Hardness
from rockwear.kernels.moving_source import moving_strip, still_strip
from rockwear.kernels.wear_laws import DissipationArchard, PowerLaw, PressureArchard
from rockwear.scenes.by_hand import heated_length, tip_by_hand, worn_by_hand

WAY = np.linspace(0, 0.2, 11)
STEEL = SimpleNamespace(conductivity=60.0, density=7830.0, specific_heat=450.0)
SANDSTONE = SimpleNamespace(conductivity=5.0, density=2500.0, specific_heat=1970.0)
HEAT = SimpleNamespace(rock=SANDSTONE, tool=STEEL, fraction=0.85, tool_temperature=300.0, tool_share=lambda: 0.75)


@pytest.mark.parametrize("law", [DissipationArchard(k=0.01, mu=0.3), PressureArchard(k=0.01)])
def test_wear_by_hand_is_k_n_s_over_h(law):
    wear = SimpleNamespace(law=law.scaled(300), hardness=Hardness.constant(5e9))
    assert worn_by_hand(wear, temperature=293.0, distance=WAY, thrust=np.full(11, 30e3)) == pytest.approx(
        300 * 0.01 * 30e3 * 0.2 / 5e9)


def test_wear_by_hand_is_of_the_hardness_at_that_temperature():
    cold, hot = (worn_by_hand(SimpleNamespace(law=PressureArchard(k=0.01), hardness=MET91), temperature=kelvin,
                              distance=WAY, thrust=np.full(11, 30e3)) for kelvin in (273.15, 873.15))
    assert hot / cold == pytest.approx(515 / 247)


def test_wear_that_is_not_linear_in_the_force_is_not_known_by_hand():
    law = PowerLaw(k=0.01, mu=0.3, exponent=2.0)
    assert math.isnan(worn_by_hand(SimpleNamespace(law=law, hardness=MET91), temperature=293.0, distance=WAY,
                                   thrust=np.full(11, 30e3)))


@pytest.mark.parametrize("change, length", [({}, math.radians(75) * 5e-4),
                                            ({"wear_flat": 1e-3}, math.radians(70) * 5e-4 + 1e-3),
                                            ({"wear_flat": 1e-3, "flat_angle": 6.0}, math.radians(64) * 5e-4 + 1e-3),
                                            ({"outline": "tool.csv"}, 0.0)])
def test_the_length_that_is_heated_is_the_arc_of_the_tip_and_the_flat(change, length):
    tool = dict(outline="", rake=-20.0, clearance=5.0, tip_radius=5e-4, wear_flat=0.0, flat_angle=0.0)
    assert heated_length(SimpleNamespace(**{**tool, **change})) == pytest.approx(length)


def test_the_tip_by_hand_takes_its_share_or_what_makes_the_rock_as_hot():
    work, strip, velocity = 600.0, 8e-4, 8.0
    share, common = (kelvin - 300 for kelvin in tip_by_hand(
        HEAT, strip=strip, velocity=velocity, distance=0.2, friction_work=work))
    flux = 0.85 * work / (0.2 / velocity) / strip
    tool = still_strip(0.2 / velocity, half_length=strip / 2, flux=flux, **vars(STEEL))
    rock = moving_strip(velocity, half_length=strip / 2, flux=flux, **vars(SANDSTONE))
    assert share == pytest.approx(0.75 * tool)
    # What of the heat does not warm the tool warms the rock as much.
    assert (1 - common / tool) * rock == pytest.approx(common)


def test_friction_that_makes_no_heat_warms_nothing_by_hand():
    cold = SimpleNamespace(**{**vars(HEAT), "fraction": 0.0})
    assert tip_by_hand(cold, strip=8e-4, velocity=8.0, distance=0.2, friction_work=600.0) == (300.0, 300.0)

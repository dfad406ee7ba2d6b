"""What an energy balance tells of itself."""
import pytest

from rockwear.scenes.balances import energy_warnings


@pytest.mark.parametrize("balance, said", [
    ({"tool_work": 100.0, "kinetic": 96.0, "residual": 4.0}, ""),
    ({"tool_work": 100.0, "kinetic": 94.0, "residual": 6.0}, "misses 6 %"),
    ({"tool_work": 1.0, "elastic": 50.0, "residual": -100.0}, "misses -200 %"),
    ({"tool_work": 0.0, "residual": 0.0}, ""),
    ({"tool_work": 0.0, "kinetic": 3e-19, "residual": -3e-19}, ""),
    ({"tool_work": 2e-12, "kinetic": 0.0, "residual": 2e-12}, "misses 100 %")])
def test_a_balance_that_misses_a_twentieth_of_its_largest_entry_warns(balance, said):
    """The residual itself is no entry."""
    lines = energy_warnings(balance)
    assert bool(lines) == bool(said) and said in "".join(lines)

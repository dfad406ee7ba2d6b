"""Removal while the tool is in contact: no kick, no lost heat or mass; a tooth cut in two goes on with one piece."""
import json

import pytest

from tests.running import ROOT, SMALL, arguments, run_script

SCRIPT = ROOT / "tests/scenes/scripts/removal.py"
CUT = {name: value for name, value in SMALL.items() if name != "snapshot_period"}


def removal(**values):
    run = run_script(SCRIPT, *arguments({**CUT, "cycles": 0, **values}))
    assert run.code == 0, run.stderr
    return json.loads(next(line for line in run.stdout.splitlines() if line.startswith("JSON"))[4:])


def balances_close(balances):
    energy, heat, mass = balances["energy"], balances["heat"], balances["mass"]
    assert energy["tool_work"] > 50 and abs(energy["residual"]) < 0.03 * energy["tool_work"]
    assert abs(heat["residual"]) < 1e-5
    assert abs(mass["unexplained"]) < 1e-12 * mass["initial"]


@pytest.mark.parametrize("wear_acceleration, least", [(3e6, 50), (3e5, 5)])
def test_uncovered_particles_come_without_a_push(wear_acceleration, least):
    """What has just been uncovered overlaps no rock: no force from nowhere, and the energy that contacts take with them
    is in the balance."""
    found = removal(wear_acceleration=wear_acceleration, start_up=2e-3)
    assert found["removed"] > least and found["overlaps"] == [] and found["unlisted"] == []
    # The force that they meet rock with at last is that of an approach from outside.
    assert max(found["pushes"], default=0) < 1.01
    balances_close(found["balances"])
    assert 0 < found["balances"]["energy"]["removed_contacts"] < 0.1 * found["balances"]["energy"]["tool_work"]


def test_wear_is_counted_against_the_limit_of_its_rule():
    """By [Rojek 2003, 8.2] a disc goes once its diameter is worn from its breadth, which is more than its part of the
    outline."""
    depth, volume = (removal(removal=rule, wear_acceleration=1, start_up=2e-5) for rule in ("depth", "volume"))
    assert depth["limit"] == pytest.approx([4 * radius**2 for radius in depth["radii"]], rel=1e-12)
    assert volume["limit"] == volume["volumes"] != depth["limit"]


def test_a_tooth_cut_in_two_goes_on_with_the_piece_that_is_fixed():
    found = removal(saw="true", wear_acceleration=100, start_up=1.2e-3)
    assert found["below"] == [0, 0, 0] and found["unlisted"] == []
    assert found["balances"]["mass"]["dropped_pieces"] > 0.005 * found["balances"]["mass"]["initial"]
    balances_close(found["balances"])

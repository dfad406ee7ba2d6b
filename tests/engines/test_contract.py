"""The contract of every engine: name, phase, period, counted visits, log with units, restart equal to the last bit."""
import json

import pytest

from tests.running import ROOT, run_script

NAMES = {"bonds", "tool_contact", "rock_friction", "separation", "path_follower", "wear", "wear_profile", "heat",
         "expansion", "background_damping", "recorder", "energy_guard", "shear_rotation", "platens", "failure",
         "dead_load", "bond_dashpots", "grain_damping", "membrane", "pressed_ends",
         "absorbing_boundary", "grain_contacts", "outflow", "rest", "vibration"}


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("contract")
    done = run_script(ROOT / "tests/engines/scripts/contract.py", str(folder), str(folder / "found.json"))
    assert done.code == 0, done.stderr
    return json.loads((folder / "found.json").read_text(encoding="utf-8"))


def all_of(found, check):
    return {scene: findings[check] for scene, findings in found["findings"].items() if findings[check]}


def test_every_engine_is_covered(found):
    assert found["covered"] == found["engines"]


def test_names_and_phases_are_the_known_ones(found):
    assert set(found["names"]) == NAMES and set(found["phases"]) == {"forces", "between steps"}


def test_an_engine_without_a_visit_cannot_be_made(found):
    assert "act" in found["without a visit"]


def test_state_holds_numbers_arrays_strings_and_dicts_of_them(found):
    assert all_of(found, "state") == {}


def test_log_gives_numbers_with_units(found):
    assert all_of(found, "log") == {}


def test_engines_are_visited_at_their_periods_and_the_visits_are_counted(found):
    assert all_of(found, "visits") == {}


def test_a_saved_and_restored_engine_has_the_same_state(found):
    assert all_of(found, "round trip") == {}


def test_a_restart_between_visits_changes_no_bit(found):
    assert all_of(found, "restart") == {}


def test_the_scenes_change_every_state_before_they_are_saved(found):
    # Else a state that is not restored would go unnoticed. (The heat content at the start has no value before it.)
    assert found["never changed"] == {"heat": ["initial_content"]}

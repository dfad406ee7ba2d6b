"""Bonding, and what comes after it, on a real packing with its overlaps."""
import json

import pytest

from tests.running import ROOT, SMALL, arguments, run_script


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    out = tmp_path_factory.mktemp("bonding") / "out"
    run = run_script(ROOT / "tests/scenes/scripts/bonding.py",
                     *arguments({**SMALL, "kn": 18e9, "kt": 6e9, "mu": 0.6, "heat": "false", "background_damping": 0,
                                 "out": out}))
    assert run.code == 0, run.stderr
    return json.loads(next(line for line in run.stdout.splitlines() if line.startswith("RESULT"))[7:])


def test_exactly_the_pairs_within_the_gap_are_bonded(found):
    assert found["bonds"] == found["pairs"] > 300 and found["others"] == 0


def test_bonds_start_free_of_stress_whatever_the_overlap(found):
    assert found["overlapping"] > 250
    assert found["force_at_rest"] < 1e-6


def test_no_burst_when_every_bond_breaks(found):
    assert found["kinetic_after_all_broke"] < 1e-12 and found["force_after_all_broke"] < 1e-6


def test_a_later_contact_has_exactly_the_constants_asked_for(found):
    contact = found["new_contact"]
    assert contact["is_plain"]
    assert contact["kn"] == pytest.approx(18e9, rel=1e-12) and contact["ks"] == pytest.approx(6e9, rel=1e-12)
    assert contact["friction"] == pytest.approx(0.6, rel=1e-12)
    assert contact["force"] == pytest.approx(contact["expected_force"], rel=1e-9) and contact["force"] > 1e3
    assert contact["friction_ratio"] <= 0.6 * (1 + 1e-9)

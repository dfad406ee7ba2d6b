"""Scenes with bonds that YADE's concrete model carries, and with grains: a restart changes no bit."""
import signal

import pytest

from tests.running import (
    ROOT, SMALL, arguments, assert_as_if_never_stopped, assert_refused, interrupt, refusals, tooth_cycles, value)

SHORT = dict(start_up=6e-4, cycle_time=2e-4, report="false", bond_law="cohesive", kt=8e9)


@pytest.mark.parametrize("options", [dict(heat="false"), dict(grain_edge=4e-3, weibull_modulus=6)],
                         ids=["plain", "grains, scatter and heat"])
def test_a_softening_cut_goes_on_as_if_it_was_never_stopped(tmp_path, options):
    never = tooth_cycles(tmp_path / "never", **SHORT, **options)
    assert never.code == 0, never.stderr
    assert never.summary["balances"]["energy"]["bond_breaking"] > 0
    again = dict(SHORT, **options, checkpoint_interval=0.01)
    stopped = interrupt(tmp_path / "again", signal.SIGTERM, 3, **again)
    assert stopped.code == 128 + signal.SIGTERM
    assert_as_if_never_stopped(tooth_cycles(tmp_path / "again", "--resume", **again), never)


def test_a_softening_cut_closes_its_balance(tmp_path):
    run = tooth_cycles(tmp_path / "out", heat="false", **SHORT)
    assert run.code == 0, run.stderr
    energy = run.summary["balances"]["energy"]
    assert abs(energy["residual"]) < 0.02 * energy["tool_work"]


def test_slip_within_bonds_heats_the_rock(tmp_path):
    run = tooth_cycles(tmp_path / "out", conduction="false", **SHORT)
    assert run.code == 0, run.stderr
    energy, heat = run.summary["balances"]["energy"], run.summary["balances"]["heat"]
    friction = 0.85 * (energy["tool_friction"] + energy["rock_friction"])
    assert 1.1 * friction < heat["generated"] < friction + 0.85 * energy["bond_breaking"]


def test_a_tool_of_segments_cuts_softening_rock(tmp_path):
    run = tooth_cycles(tmp_path / "out", tool="segments", heat="false", **SHORT)
    assert run.code == 0, run.stderr
    assert value(run, "tensile_cracks") + value(run, "shear_cracks") > 0


def test_grains_are_refused_with_a_law_that_is_linear_nowhere(tmp_path):
    script = ROOT / "yade_scripts/tooth_cycles.py"
    words = [*arguments({**SMALL, "bond_law": "padova", "grain_edge": 4e-3}), "--out", tmp_path / "out"]
    (code, said), = refusals(script, tmp_path, [words])
    assert_refused(code, said, "grain_edge = 0.004 m: must be 0 with the law padova")

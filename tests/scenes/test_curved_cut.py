"""A tool on a curved path: it stays on it, its work is that of all forces and torques on it, and the balances close."""
import pytest

from tests.running import ROOT, SMALL, arguments, run_script, value

CURVED = {**SMALL, "start_up": 6e-4, "cycles": 2, "cycle_time": 6e-4, "wear_acceleration": 3e5, "clearance": 30,
          "report": "false"}


@pytest.fixture(scope="module")
def curved(tmp_path_factory):
    out = tmp_path_factory.mktemp("curved") / "out"
    return run_script(ROOT / "tests/scenes/scripts/curved_cut.py", *arguments(CURVED), "--out", str(out), out=out)


def test_it_stays_on_its_path_while_particles_go_and_cycles_begin_anew(curved):
    assert curved.code == 0, curved.stderr
    assert value(curved, "particles_removed") > 3 and value(curved, "turned") > 0.2
    # A chord of 100 steps: v w T^2 / 8, with the fastest particle at 10 m/s.
    period = 100 * value(curved, "time_step")
    assert value(curved, "off_path") < 10 * 200 * period**2 / 8
    assert value(curved, "off_turn") < 1e-12


def test_its_work_is_that_of_all_forces_and_torques(curved):
    assert value(curved, "cutting_work") == pytest.approx(value(curved, "power_work"), rel=1e-9)


def test_its_energy_balance_closes(curved):
    balance = curved.summary["balances"]["energy"]
    assert balance["tool_work"] > 100
    assert abs(balance["residual"]) < 0.02 * balance["tool_work"]

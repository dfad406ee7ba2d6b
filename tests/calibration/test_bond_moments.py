"""The benchmark of moments in bonds: its set-up of YADE's law is the repository's law with kr times rotation added."""
import json

import pytest

from tests.running import ROOT, run_script


@pytest.fixture(scope="module")
def checks(tmp_path_factory):
    file = tmp_path_factory.mktemp("bond_moments") / "checks.json"
    done = run_script(ROOT / "tests/calibration/scripts/bond_moments.py", str(file))
    assert done.code == 0, done.stderr
    return json.loads(file.read_text(encoding="utf-8"))


def test_a_moment_is_the_rolling_stiffness_times_the_relative_rotation(checks):
    assert checks["moment"] > 1.0 and checks["off"] < 1e-9


def test_without_moments_the_rock_is_the_repositorys(checks):
    """But for radii reduced until no discs overlap."""
    assert checks["stiffness"] == pytest.approx(1, abs=0.01) and checks["step"] == pytest.approx(1, abs=1e-5)


def test_moments_stiffen_and_shorten_the_step(checks):
    assert 1.01 < checks["stiffer"] < 1.1 and checks["shorter"] < 0.8

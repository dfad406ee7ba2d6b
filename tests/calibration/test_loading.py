"""Loading of a laboratory test by the strength of its rock."""
import json

import pytest

from calibration.laboratory.loading import LoadedRock, loading, strength
from rockwear.kernels.parameter import Group, Parameter, above_zero, number, text
from rockwear.model import rock_file
from rockwear.run import parameters
from rockwear.scenes.parameters import BONDS, OF_ROCK, SPECIMEN

PROPERTIES = {"ucs": 30e6, "tensile_strength": 3e6, "triaxial": [(20e6, 110e6), (10e6, 80e6)]}


@pytest.mark.parametrize("test, confinement, sought", [
    ("compression", 0.0, 30e6), ("tension", 0.0, 3e6), ("brazilian", 0.0, 3e6), ("triaxial", 0.0, 30e6),
    ("triaxial", 5e6, 50e6), ("triaxial", 10e6, 70e6), ("triaxial", 15e6, 80e6), ("triaxial", 80e6, 90e6)])
def test_strength_that_a_test_looks_for(test, confinement, sought):
    assert strength(test, PROPERTIES, confinement) == pytest.approx(sought)
    assert strength(test, {}, confinement) is None


def test_a_rock_that_fails_at_less_strain_is_loaded_as_much_more_slowly():
    assert loading("tension", 1e-3) == {"speed": 0.084, "strain_max": 6e-3, "record_strain": 5e-6}
    assert loading("compression", 1e-3) == {"speed": 0.0136, "strain_max": 3e-3, "record_strain": 5e-6}


def read(rock, test="compression", **given):
    """Parameters of a test of a rock."""
    def own(name, default):
        return Parameter(name, default, "", above_zero, "")

    of_rock = Parameter("rock", "", "", text, "", presets=LoadedRock(OF_ROCK, test=lambda values: test))
    groups = [SPECIMEN, Group("own", (
        of_rock, own("speed", 0.05), own("strain_max", 0.02), own("record_strain", 1e-5),
        Parameter("confinement", 0.0, "Pa", number(0), ""))), BONDS.without("rock")]
    return parameters.read(groups, [word for name, value in {"rock": rock, **given}.items()
                                    for word in (f"--{name}", str(value))])


def test_measured_strengths_count_before_targets_and_what_is_given_before_both(tmp_path):
    rock = json.loads(rock_file.find("medium_sandstone").read_text(encoding="utf-8"))
    ucs, modulus = (rock["plane"]["measured"][name]["mean"] for name in ("ucs", "youngs_modulus"))
    assert ucs / modulus != pytest.approx(50 / 13000, rel=2e-3)

    def speed(**given):
        (tmp_path / "rock.json").write_text(json.dumps(rock), encoding="utf-8")
        return read(tmp_path / "rock.json", **given)["speed"]

    assert speed() == pytest.approx(13.6 * ucs / modulus, rel=1e-3)
    assert speed(test="triaxial", confinement=5e6) == speed() and speed(speed=0.3) == 0.3
    rock["plane"]["measured"] = {}
    assert speed() == pytest.approx(13.6 * 50 / 13000, rel=1e-3)
    assert speed(test="tension") == pytest.approx(84 * 4.2 / 13000, rel=1e-3)
    del rock["targets"]["youngs_modulus"]
    assert speed() == 0.05


def test_a_soft_rock_is_strained_to_its_failure(tmp_path):
    rock = json.loads(rock_file.find("p_sandstone").read_text(encoding="utf-8"))
    assert read("p_sandstone")["strain_max"] == 0.02
    rock["plane"]["measured"] = {}
    rock["targets"]["youngs_modulus"]["value"] = 1e9
    (tmp_path / "rock.json").write_text(json.dumps(rock), encoding="utf-8")
    assert read(tmp_path / "rock.json")["strain_max"] == pytest.approx(0.18)
    assert read(tmp_path / "rock.json", strain_max=0.01)["strain_max"] == 0.01

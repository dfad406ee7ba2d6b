"""Rock files: the values they give a scene, their conversion to its radii, and one line for each mistake in them."""
import copy
import json

import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.parameter import Parameter, above_zero
from rockwear.model import rock_file
from rockwear.run import parameters
from rockwear.scenes.parameters import BLOCK, BOND_PARAMETERS, BONDS, LOOSE, OF_ROCK, SPECIMEN, rock_parameter

PLANE, SPACE = [SPECIMEN, BONDS], [BLOCK, BONDS]
BRITTLE = {"bond_law": "brittle", "kn": 18e9, "kt": 8e9, "Rn": 4e4, "Rt": 4e5, "mu": 0.8, "bonding_gap": 1e-4,
           "porosity": 0.1}
ROCK = {
    "format": 1, "name": "slate", "source": "a report",
    "targets": {"youngs_modulus": {"value": 18e9, "unit": "Pa"}, "poissons_ratio": {"value": 0.18, "unit": ""},
                "ucs": {"value": 60e6, "unit": "Pa"}, "tensile_strength": {"value": 7e6, "unit": "Pa"},
                "friction_angle": {"value": 40, "unit": "deg"},
                "triaxial": {"value": [[0, 60e6], [5e6, 90e6]], "unit": "Pa"}},
    "plane": {"parameters": BRITTLE, "resolution": {"radius_min": 1e-3, "radius_max": 1.5e-3},
              "measured": {"ucs": {"mean": 59e6, "standard_deviation": 3e6, "packings": 5, "unit": "Pa"},
                           "triaxial": {"mean": [[0, 60e6]], "standard_deviation": [1e6], "packings": 2,
                                        "unit": "Pa"}}},
    "space": {"parameters": {**BRITTLE, "kn": 1e8, "kt": 5e7, "Rn": 800.0, "Rt": 8000.0, "bonding_gap": 5e-4,
                             "porosity": 0.38, "rock_density": 2400.0},
              "resolution": {"radius": 6e-3}, "measured": {}}}


@pytest.fixture(autouse=True)
def no_batch(monkeypatch):
    monkeypatch.delenv("YADE_BATCH", raising=False)


def written(folder, data=ROCK):
    """Path of a rock file."""
    path = folder / "slate.json"
    path.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
    return path


def read(groups, *words):
    return parameters.read(groups, [str(word) for word in words])


def test_the_file_replaces_the_defaults_and_what_is_given_goes_before(tmp_path):
    rock = written(tmp_path)
    assert {name: read(PLANE, "--rock", rock)[name] for name in BRITTLE} == BRITTLE
    found = read(PLANE, "--rock", rock, "--kn", "3e10", "--porosity", "0.13")
    assert (found["kn"], found["porosity"], found["kt"]) == (3e10, 0.13, 8e9)
    # Another law: what the file has for it stays, the rest is the law's own.
    found = read(PLANE, "--rock", rock, "--bond_law", "damage", "--H", "2e9")
    assert (found["bond_law"], found["H"], found["Rn"]) == ("damage", 2e9, 4e4)
    assert read(PLANE, "--rock", rock)["rock"] == str(rock) and read(PLANE)["kt"] == 20e9


def test_a_cell_of_a_table_names_the_rock(tmp_path, monkeypatch):
    monkeypatch.setattr(parameters, "_table_row", lambda: {"rock": str(written(tmp_path)), "Rn": "5e4"})
    found = read(PLANE)
    assert (found["kn"], found["Rn"]) == (18e9, 5e4)


def test_values_are_converted_to_the_radii_of_the_scene_but_not_those_given(tmp_path):
    rock = written(tmp_path)
    found = read(PLANE, "--rock", rock, "--radius_min", 2e-3, "--radius_max", 3e-3, "--Rt", 4e5)
    expected = {"kn": 18e9, "kt": 8e9, "Rn": 8e4, "Rt": 4e5, "mu": 0.8, "bonding_gap": 2e-4, "porosity": 0.1}
    assert {name: found[name] for name in expected} == pytest.approx(expected)
    # In space stresses stay with forces over the square of the radius. The scene itself applies its scale_factor.
    found = read(SPACE, "--rock", rock, "--radius", 12e-3, "--scale_factor", 3)
    assert (found["kn"], found["kt"]) == pytest.approx((2e8, 1e8))
    assert (found["Rn"], found["Rt"], found["bonding_gap"]) == pytest.approx((3200, 32000, 1e-3))
    assert (found["rock_density"], found["porosity"], found["radius"]) == (2400, 0.38, 12e-3)


def test_strengths_follow_the_powers_of_the_file(tmp_path):
    data = copy.deepcopy(ROCK)
    data["plane"]["parameters"] = {
        "bond_law": "cohesive", "kn": 18e9, "kt": 8e9, "mu": 0.8, "bond_tension": 7e6, "bond_cohesion": 2e7,
        "bond_fracture_energy": 30.0, "bond_tension_power": -1.0, "bond_cohesion_power": 0.5, "bonding_gap": 1e-4,
        "porosity": 0.1}
    found = read(PLANE, "--rock", written(tmp_path, data), "--radius_min", 4e-3, "--radius_max", 6e-3)
    assert [found[name] for name in ("bond_tension", "bond_cohesion", "bond_fracture_energy", "bonding_gap")] == (
        pytest.approx([7e6 / 4, 4e7, 30.0, 4e-4]))
    given = read(PLANE, "--rock", written(tmp_path, data), "--radius_min", 4e-3, "--radius_max", 6e-3,
                 "--bond_cohesion_power", 0)
    assert given["bond_cohesion"] == 4e7


COHESIVE = {"bond_law": "cohesive", "kn": 18e9, "kt": 8e9, "mu": 0.8, "bond_tension": 7e6, "bond_cohesion": 2e7,
            "bond_fracture_energy": 30.0, "bond_tension_power": -1.0, "bonding_gap": 1e-4, "porosity": 0.1,
            "grain_edge": 2e-3}


def test_values_are_right_at_the_radii_that_a_scale_factor_makes(tmp_path):
    data = copy.deepcopy(ROCK)
    data["plane"]["parameters"] = COHESIVE
    # The scene multiplies radii and Rn, Rt alone, as that of a dredge pick.
    scaled = [SPECIMEN, rock_parameter(scaled=("Rn", "Rt")), *BOND_PARAMETERS,
              Parameter("scale_factor", 1.0, "", above_zero, "on the radii")]
    found = read(scaled, "--rock", written(tmp_path, data), "--scale_factor", 2)
    expected = {"radius_min": 1e-3, "bond_tension": 3.5e6, "bond_cohesion": 2e7, "bonding_gap": 2e-4,
                "grain_edge": 4e-3}
    assert {name: found[name] for name in expected} == pytest.approx(expected)
    found = read(scaled, "--rock", written(tmp_path), "--scale_factor", 2)
    assert [found[name] for name in BRITTLE] == pytest.approx([*list(BRITTLE.values())[:-2], 2e-4, 0.1])
    # A cut in space all that grows.
    data["space"]["parameters"] = {**COHESIVE, "kn": 1e8, "kt": 5e7, "bonding_gap": 5e-4}
    found = read(SPACE, "--rock", written(tmp_path, data), "--radius", 12e-3, "--scale_factor", 3)
    expected = {"kn": 2e8, "bond_tension": 7e6 / 6, "bonding_gap": 1e-3, "grain_edge": 4e-3}
    assert {name: found[name] for name in expected} == pytest.approx(expected)


def test_a_rock_at_a_size_that_was_not_measured_is_said(tmp_path):
    """Beyond a factor of 2.5, and of 5 where the file says how its strengths follow the size."""
    def said(groups, *words):
        line = ["--rock", str(written(tmp_path, data)), *(str(word) for word in words)]
        return parameters.warnings(groups, parameters.read(groups, line))

    data = copy.deepcopy(ROCK)
    assert said(PLANE, "--radius_min", 2e-3, "--radius_max", 3e-3) == []
    larger, = said(PLANE, "--radius_min", 3e-3, "--radius_max", 4.5e-3)
    smaller, = said(PLANE, "--radius_min", 2.5e-4, "--radius_max", 3.75e-4)
    assert larger.startswith("the rock's particles are 3 times larger than those of 0.00125 m in mean radius that ")
    assert smaller.startswith("the rock's particles are 4 times smaller than ")
    assert parameters.warnings(PLANE, read(PLANE, "--radius_min", 3e-3, "--radius_max", 4.5e-3)) == []
    # A scene that takes contacts alone, and a part that nothing was measured of.
    assert said([BLOCK, LOOSE], "--radius", 6e-2) == said(SPACE, "--radius", 6e-2) == []
    scaled = [*PLANE, Parameter("scale_factor", 1.0, "", above_zero, "on the radii")]
    assert said(scaled, "--scale_factor", 2.4) == []
    assert "are 2.6 times larger" in said(scaled, "--scale_factor", 2.6)[0]
    data["plane"]["parameters"] = COHESIVE
    assert said(scaled, "--scale_factor", 4.9) == []
    assert "are 5.1 times larger" in said(scaled, "--scale_factor", 5.1)[0]


@pytest.mark.parametrize("law, radius, expected", [
    ("damage", 2.0, {"Rn": 2e5, "kn": 2e10, "H": 1e10}), ("padova", 2.0, {
        "padova_m": 2e8 / 2**(1 / 3), "padova_r": -2e5, "padova_eta": 0.8, "padova_cohesion": 2.5e5,
        "padova_tension_b2": -5e9})])
def test_every_law_keeps_its_stresses_over_the_radius(law, radius, expected, tmp_path):
    values = {name: p.default for name, p in OF_ROCK.items()}
    used = {name: values[name] for name, p in OF_ROCK.items() if law in (p.when or {}).get("bond_law", (law,))
            and "grain_edge" not in (p.when or {})}
    data = copy.deepcopy(ROCK)
    data["plane"]["parameters"] = {**used, "bond_law": law}
    found = read(PLANE, "--rock", written(tmp_path, data), "--radius_min", radius * 1e-3, "--radius_max",
                 radius * 1.5e-3)
    assert {name: found[name] for name in expected} == pytest.approx(expected)


def test_loose_rock_takes_contacts_and_density_alone(tmp_path):
    found = read([BLOCK.with_defaults(porosity=0.42), LOOSE], "--rock", written(tmp_path), "--radius", 6e-3)
    assert (found["kn"], found["mu"], found["rock_density"], found["porosity"]) == (1e8, 0.8, 2400, 0.42)


def test_targets_and_measurements_are_read(tmp_path):
    rock = rock_file.read(written(tmp_path), OF_ROCK)
    assert rock.targets["triaxial"] == [(0, 60e6), (5e6, 90e6)] and rock.targets["ucs"] == 60e6
    assert rock.parts["plane"].measured["ucs"] == {"mean": 59e6, "standard_deviation": 3e6, "packings": 5}


def test_every_rock_of_the_library_can_be_used():
    assert "m_sandstone" in rock_file.library()
    for name in rock_file.library():
        rock = rock_file.read(rock_file.find(name), OF_ROCK)
        assert rock.name == name
        for kind in rock.parts:
            assert read({"plane": PLANE, "space": SPACE}[kind], "--rock", name)["rock"] == name
    # The first of them is the scenes' own rock.
    assert {**read(PLANE, "--rock", "m_sandstone"), "rock": ""} == read(PLANE)


def changed(path, value):
    """ROCK with another value at a path of keys, or without it."""
    data = copy.deepcopy(ROCK)
    place = data
    *keys, last = path.split("/")
    for key in keys:
        place = place[key]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return data


REFUSED = [
    (changed("format", 2), "format = 2: must be 1"),
    (changed("name", 3), "name = 3: must be a text"),
    (changed("source", None), "must be with the key source"),
    (changed("colour", "red"), "the file = colour: must be one of format, name, source, targets, plane, space"),
    (changed("plane/resolution", None), "must be with the key resolution"),
    (changed("plane/resolution/radius_max", None), "must be with the key radius_max"),
    (changed("plane/resolution/radius_max", 5e-4), "radius_max = 0.0005 m: must be at least radius_min = 0.001"),
    (changed("plane/resolution/radius_min", 1), "radius_min = 1 m: must be between 1e-06 and 0.1"),
    (changed("plane/parameters/kn", None),
     "plane.parameters = bond_law, kt, Rn, Rt, mu, bonding_gap, porosity: must be with the key kn"),
    (changed("plane/parameters/bond_law", None), "must be with the key bond_law"),
    (changed("plane/parameters/bond_law", "magic"), "bond_law = magic: must be one of brittle"),
    (changed("plane/parameters/bond_law", "damage"), "must be with the key H"),
    (changed("plane/parameters/H", 1e10), "plane.parameters.H = 1e+10 N/m: must be left out with bond_law = brittle"),
    (changed("plane/parameters/kk", 1e10), "kk: must be one of"),
    (changed("plane/parameters/knn", 1e10), "did you mean kn"),
    (changed("plane/parameters/velocity", 4), "velocity: must be one of"),
    (changed("plane/parameters/kn", -1), "plane.parameters.kn = -1 N/m: must be greater than 0"),
    (changed("plane/parameters/kn", "18e9"), 'plane.parameters.kn = "18e9" N/m: must be a number'),
    (changed("plane/parameters/kn", True), "plane.parameters.kn = true N/m: must be a number"),
    (changed("plane/parameters/kn", [1]), "plane.parameters.kn = [1] N/m: must be a number"),
    (changed("plane/parameters/kn", float("nan")), "plane.parameters.kn = nan N/m: must be finite"),
    (changed("plane/parameters/kn", 10**400), "plane.parameters.kn = inf N/m: must be finite"),
    (changed("plane/parameters/Rn", float("inf")), "plane.parameters.Rn = inf N: must be finite"),
    (changed("plane/parameters/kn", 18e3), "plane.parameters.kn = 18000 N/m: must be between 1e+06 and 1e+13"),
    (changed("plane/parameters/kn", 18e15), "plane.parameters.kn = 1.8e+16 N/m: must be between"),
    (changed("plane/parameters/Rn", 0.04), "plane.parameters.Rn = 0.04 N: must be between 2.5 and 2.5e+08"),
    (changed("plane/parameters/Rn", 4e10), "plane.parameters.Rn = 4e+10 N: must be between 2.5 and 2.5e+08"),
    (changed("plane/parameters/mu", 8e5), "plane.parameters.mu = 800000: must be 0 or between 0.001 and 100"),
    (changed("plane/parameters/mu", 8e-7), "plane.parameters.mu = 8e-07: must be 0 or between 0.001 and 100"),
    (changed("plane/parameters/bonding_gap", 1e-10), "bonding_gap = 1e-10 m: must be 0 or between 1e-08 and 1"),
    (changed("plane/parameters/weibull_modulus", 1e-3), "weibull_modulus = 0.001: must be 0 or between 0.5 and 1000"),
    (changed("plane/parameters/weibull_modulus", 3e6), "weibull_modulus = 3e+06: must be 0 or between 0.5 and 1000"),
    (changed("space/parameters/kn", 100.0), "space.parameters.kn = 100 N/m: must be between 1.2e+04"),
    (changed("space/parameters/Rn", 8e8), "space.parameters.Rn = 8e+08 N: must be between"),
    (changed("targets/youngs_modulus/value", 18), "targets.youngs_modulus = 18 Pa: must be between 1e+07 and 1e+12"),
    (changed("targets/youngs_modulus/value", 18e6), "youngs_modulus = 1.8e+07 Pa: must be at least 10 times ucs"),
    (changed("targets/youngs_modulus/value", 18e15), "targets.youngs_modulus = 1.8e+16 Pa: must be between"),
    (changed("targets/youngs_modulus/unit", "GPa"), "targets.youngs_modulus.unit = GPa: must be Pa"),
    (changed("targets/youngs_modulus/unit", None), "must be with the key unit"),
    (changed("targets/ucs/value", 60), "targets.ucs = 60 Pa: must be between 10000 and 1e+09"),
    (changed("targets/ucs/value", 60e12), "targets.ucs = 6e+13 Pa: must be between 10000 and 1e+09"),
    (changed("targets/ucs/value", 6e6), "targets.ucs = 6e+06 Pa: must be more than tensile_strength = 7e+06"),
    (changed("targets/poissons_ratio/value", 0.6), "targets.poissons_ratio = 0.6: must be between -1 and 0.5"),
    (changed("targets/friction_angle/value", 0.7), "targets.friction_angle = 0.7 deg: must be between 2 and 89"),
    (changed("targets/strength", {"value": 1, "unit": "Pa"}), "targets = strength: must be one of youngs_modulus"),
    (changed("targets/triaxial/value", [[5e6, 4e6]]), "sigma1 = 4e+06 Pa: must be more than sigma3 = 5e+06"),
    (changed("targets/triaxial/value", [[5, 60e6]]), "sigma3 = 5 Pa: must be 0 or at least 1000"),
    (changed("targets/triaxial/value", [5e6]), "targets.triaxial = [5000000.0]: must be a list of [sigma3, sigma1]"),
    (changed("plane/measured/ucs/packings", 0), "plane.measured.ucs.packings = 0: must be a whole number"),
    (changed("plane/measured/ucs/mean", 59), "plane.measured.ucs = 59 Pa: must be between"),
    (changed("plane/measured/ucs/standard_deviation", -1), "standard_deviation = -1 Pa: must be at least 0"),
    (changed("plane/measured/triaxial/standard_deviation", 1e6), "must be a number; of triaxial a list"),
    (changed("plane", "rock"), 'plane = "rock": must be an object'),
    ({"format": 1, "name": "a", "source": "b", "targets": {}}, "must be with a part for plane or space"),
    ([1, 2], "the file = [1, 2]: must be an object"), ("{", "must be a readable JSON file"),
    ("", "must be a readable JSON file"), ('{"format": 1, "format": 1}', "format is there twice")]


@pytest.mark.parametrize("data, words", REFUSED, ids=[words for _, words in REFUSED])
def test_mistakes_are_said_in_one_line(data, words, tmp_path):
    with pytest.raises(ParameterError) as caught:
        read(PLANE, "--rock", written(tmp_path, data))
    said = str(caught.value)
    assert said.startswith("rock = ") and words in said and "\n" not in said


@pytest.mark.parametrize("word", ["granite", "granite.json", "/", "a" * 5000, "no\0file"])
def test_a_rock_that_is_not_there(word):
    with pytest.raises(ParameterError, match="must be a file, or one of .*m_sandstone"):
        read(PLANE, "--rock", word)


def test_a_name_that_is_nearly_one_of_the_library():
    with pytest.raises(ParameterError, match="did you mean m_sandstone$"):
        read(PLANE, "--rock", "m_sandston")


def test_a_byte_order_mark_is_none_of_the_file(tmp_path):
    path = written(tmp_path, "\ufeff" + json.dumps(ROCK))
    assert read(PLANE, "--rock", path)["kn"] == 18e9


def test_bytes_that_are_no_text(tmp_path):
    path = tmp_path / "bad.json"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ParameterError, match="must be a readable JSON file"):
        read(PLANE, "--rock", path)


def test_a_scene_that_the_rock_has_nothing_for(tmp_path):
    rock = written(tmp_path, changed("space", None))
    with pytest.raises(ParameterError, match="must be a rock with a part for the space: .* plane alone"):
        read(SPACE, "--rock", rock)
    with pytest.raises(ParameterError, match="plane.parameters.porosity = 0.1: must be a known parameter"):
        read([SPECIMEN.without("porosity"), BONDS], "--rock", rock)

"""What a scene does not need costs nothing: it is not made, and not in YADE."""
import json

import pytest

from tests.running import BLOCK, BLOCK_OF_TRIANGLES, SMALL, arguments, checks_of

EXPANDING, COLD, STILL = {"rock_expansion": 1e-5}, {"heat": "false"}, {"wear_acceleration": 0, "background_damping": 0}
CASES = {
    "heat and expansion": ("cutting", {**SMALL, **EXPANDING}), "heat": ("cutting", SMALL),
    "cold": ("cutting", {**SMALL, **COLD}), "cold, without wear": ("cutting", {**SMALL, **COLD, **STILL}),
    "segments": ("cutting", {**SMALL, **COLD, "tool": "segments"}),
    "grains": ("cutting", {**SMALL, **COLD, "grain_edge": 4e-3}),
    "grains, dashpots": ("cutting", {**SMALL, **COLD, "grain_edge": 4e-3, "bond_damping": 1.0}),
    "heat, segments": ("cutting", {**SMALL, "tool": "segments"}), "space": ("cutting_3d", BLOCK),
    "space, concrete model": ("cutting_3d", {**{name: v for name, v in BLOCK.items() if name not in ("Rn", "Rt")},
                                             "bond_law": "cohesive", "bond_tension": 1e6}),
    "triangles": ("cutting_3d", {**BLOCK_OF_TRIANGLES, "tool": "triangles"})}
OF_HEAT = {"Heat", "HeatNetwork", "ParticleBody", "FacetBody", "Expansion"}


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("needed")
    cases = {case: (scene, arguments(values)) for case, (scene, values) in CASES.items()}
    (folder / "cases.json").write_text(json.dumps(cases), encoding="utf-8")
    return checks_of("needed", folder, str(folder / "cases.json"))


@pytest.mark.parametrize("case", ["cold", "cold, without wear", "segments", "space", "triangles"])
def test_without_heat_no_heat_engine_no_thermal_body_and_no_network(found, case):
    assert not OF_HEAT & set(found[case]["made"])
    assert not {"heat", "expansion"} & set(found[case]["engines"]) and "heat" not in found[case]["balances"]


@pytest.mark.parametrize("case, body", [("heat", "ParticleBody"), ("heat, segments", "FacetBody"),
                                        ("heat and expansion", "ParticleBody")])
def test_with_heat_one_of_each(found, case, body):
    assert {name: found[case]["made"].get(name, 0) for name in OF_HEAT} == {
        "Heat": 1, "HeatNetwork": 1, "ParticleBody": 0, "FacetBody": 0, body: 1, "Expansion": int("expansion" in case)}
    assert "heat" in found[case]["engines"] and "heat" in found[case]["balances"]


@pytest.mark.parametrize("case", CASES)
def test_of_the_tool_only_what_can_meet_rock_is_in_yade(found, case):
    there = found[case]
    assert there["of_tool"] == there["surface"] > 10
    assert there["bodies"] == there["rock"] + there["surface"]
    if "segments" not in case and case != "triangles":
        assert there["surface"] < 0.6 * there["pieces"]


def test_an_engine_is_made_where_its_physics_is(found):
    """No damping that damps nothing, no profile of wear that is none, no path follower for a straight line, no shear
    rotation in the plane."""
    always = ["bonds", "tool_contact", "rock_friction", "separation", "wear", "recorder", "energy_guard"]
    assert sorted(found["cold, without wear"]["engines"]) == sorted(always)
    assert set(found["cold"]["engines"]) - set(always) == {"wear_profile", "background_damping"}
    assert set(found["heat and expansion"]["engines"]) - set(found["cold"]["engines"]) == {"heat", "expansion"}
    for case in ("space", "space, concrete model"):
        assert "shear_rotation" in found[case]["engines"]
    for there in found.values():
        assert "path_follower" not in there["engines"]
        # An engine that has been made is one of the loop: none is made to lie about.
        assert sum(there["made"].get(name, 0) for name in there["made"] if name not in (
            "HeatNetwork", "ParticleBody", "FacetBody")) == len(there["engines"])


def test_the_quality_of_grains_does_not_depend_on_dashpots(found):
    """These take the highest frequency of the rock to a shorter step, and not to a higher frequency."""
    rate, damped = (found[case]["grain_rate"] for case in ("grains", "grains, dashpots"))
    assert rate == damped > 1e4 and found["grains"]["step"] > 2 * found["grains, dashpots"]["step"]

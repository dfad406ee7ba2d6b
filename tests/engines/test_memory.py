"""YADE's vectors in memory: what is read and written is Python's; another layout is refused in one line."""
import json

import pytest

from tests.running import ROOT, checks_of, run_script


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return checks_of("memory", tmp_path_factory.mktemp("memory"))


def test_vectors_are_read_and_written_as_python_gives_them(found):
    assert found["wrong"] == [] and found["wrong together"] == []


def test_numbers_behind_a_vector_are_those_of_python(found):
    for in_memory, in_python in found["behind"].values():
        assert in_memory == in_python
    assert len({tuple(pair[0]) for pair in found["behind"].values()}) == 4


def test_contacts_are_those_of_python(found):
    for in_memory, in_python in found["contacts"].values():
        assert in_memory == in_python
    real = found["contacts"]["real"][0]
    assert True in real and False in real and found["contacts"]["normal_force"][0][0][0] != 0


@pytest.mark.parametrize("what", ["contact of the tool", "velocities", "velocities before", "motions"])
def test_contacts_of_the_tool_and_motions_of_bodies_are_those_of_python(found, what):
    for in_memory, in_python in found[what].values():
        assert in_memory == in_python


@pytest.mark.parametrize("threads", [1, 2])
def test_forces_are_found_in_any_state_of_the_scene_and_left_as_they_are(tmp_path, threads):
    done = run_script(ROOT / "tests/scenes/scripts/forces.py", str(tmp_path / "found.json"), threads=threads)
    assert done.code == 0, done.stderr
    states = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert len(states) == 5 and len({state["word"] for state in states.values()}) == 1
    for state in states.values():
        assert state["memory"] == state["python"] == state["before"]


def test_the_check_leaves_vectors_as_they_are(found):
    assert found["as it is"] is None and found["by reference"] is None
    assert found["left"] == [0.6, 0.0, -0.8]


def test_contacts_stay_where_they_are_until_they_are_searched_again(tmp_path):
    # Of a contact that YADE has erased, engines would read old numbers.
    file = tmp_path / "found.json"
    done = run_script(ROOT / "tests/scenes/scripts/places.py", str(file), "--out", str(tmp_path / "out"))
    assert done.code == 0, done.stderr
    found = json.loads(file.read_text(encoding="utf-8"))
    assert found["wrong"] == 0 and found["asked late"] > 100
    assert found["lost"] == 0 and found["steps"] > 5000 and found["searches"] > 100
    assert found["moved"] > 50 and found["cracks"] > 100 and found["worn"] > 0


def test_one_place_is_found_where_objects_lie_side_by_side(found):
    assert found["packed"] == []


def test_another_layout_is_refused_in_one_line_and_never_a_wrong_number(found):
    said = [*found["other layouts"], found["by value"], found["out of reach"]]
    assert len(said) == 17
    for line in said:
        assert line.startswith("YADE = ") and "must be one whose objects lie in memory as in Debian 12 and 13" in line
        assert "\n" not in line

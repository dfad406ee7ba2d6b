"""Rocks of the library and of files in the scenes: accepted, refused, part of what a run is."""
import json

from tests.running import BLOCK, ROOT, SMALL, arguments, assert_refused, refusals, run_script, tooth_cycles

LIBRARY = ROOT / "rockwear/rocks"


def words(**values):
    return arguments({**SMALL, **values})


def test_a_rock_in_the_plane_and_none_for_space(tmp_path):
    good, override, unknown, broken = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [
        words(rock="m_sandstone", out=tmp_path / "a"), words(rock="m_sandstone", kn=1e10, out=tmp_path / "b"),
        words(rock="sandstone", out=tmp_path / "c"), words(rock="m_sandstone", kn=-1, out=tmp_path / "d")])
    assert good[0] == override[0] == 0
    assert_refused(*unknown, "rock = sandstone: must be a file, or one of ")
    assert_refused(*broken, "kn = -1 N/m: must be greater than 0")
    in_space = arguments({**BLOCK, "rock": "m_sandstone"})
    (space,) = refusals(ROOT / "yade_scripts/cutting_3d_wear.py", tmp_path, [in_space])
    assert_refused(*space, "rock = m_sandstone: must be a rock with a part for the space")


def test_help_shows_it():
    run = run_script(ROOT / "yade_scripts/uniaxial.py", "--help")
    assert run.code == 0 and "--rock NAME|FILE" in run.stdout.partition("\nbonds:")[2].split("\n\n")[0]


def test_a_rock_that_changes_or_moves_is_refused_by_a_resumed_run(tmp_path):
    rock = tmp_path / "mine.json"
    data = json.loads((LIBRARY / "m_sandstone.json").read_text(encoding="utf-8"))
    data["plane"]["parameters"]["kt"] = 1e10

    def write(**values):
        rock.write_text(json.dumps({**data, **values}), encoding="utf-8")

    write()
    first = tooth_cycles(tmp_path / "out", rock=rock, start_up=1e-4, cycles=0, report="false")
    assert first.code == 0, first.stderr
    assert first.summary["parameters"]["kt"] == 1e10 and first.summary["parameters"]["rock"] == str(rock)
    assert list(first.summary["files"]) == ["rock"]
    resumed = words(rock=rock, start_up=1e-4, cycles=0, report="false", out=tmp_path / "out", resume="true")
    write(source="another report")
    said = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    rock.unlink()
    said += refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    assert_refused(*said[0], "must be of the same files: rock is ")
    assert_refused(*said[1], "mine.json: must be a file, or one of ")
    write()
    (again,) = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    assert again[0] == 0, again[1]

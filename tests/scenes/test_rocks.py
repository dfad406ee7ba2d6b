"""Rocks of the library and of files in the scenes: accepted, refused, part of what a run is."""
import json

import pytest

from tests.running import BLOCK, ROOT, SMALL, arguments, assert_refused, history, refusals, run_script, tooth_cycles

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


def test_a_rock_of_the_library_is_cut_in_space(tmp_path):
    """The block of other tests, twenty times smaller; gravity would do 1e-4 of the work."""
    lengths = "width", "height", "depth", "breadth", "tooth_height", "tooth_width", "depth_of_cut"
    values = {**{name: BLOCK[name] / 20 for name in lengths}, "rock": "crushing_sandstone", "radius": 6e-4,
              "scale_factor": 1, "facet": 1e-3, "tip_radius": 2e-4, "tool_kn": 1.5e7, "tool_kt": 6e6, "velocity": 8.0,
              "lowering_velocity": 8.0, "cut_time": 3e-4, "approach": 2e-4, "gravity": 0, "snapshot_period": 1,
              "report": "false", "seed": 1}
    run = run_script(ROOT / "yade_scripts/cutting_3d_triangles.py", *arguments(values), "--out", str(tmp_path),
                     out=tmp_path)
    assert run.code == 0, run.stderr
    energy, results = run.summary["balances"]["energy"], run.summary["results"]
    assert run.summary["parameters"]["bond_crushing"] == 480e6
    assert energy["tool_work"] > 0.05 and abs(energy["residual"]) < 0.01 * energy["tool_work"], energy
    assert results["shear_cracks"]["value"] > 20 and energy["rock_crushing"] > 0


def test_help_shows_it():
    run = run_script(ROOT / "yade_scripts/uniaxial.py", "--help")
    assert "length of the specimen, along the loading" in run.stdout and "across the loading" in run.stdout
    assert run.code == 0 and "--rock NAME|FILE" in run.stdout.partition("\nbonds:")[2].split("\n\n")[0]
    assert "of each platen; with a rock of known strength and E by their ratio, unless it is given" in run.stdout


@pytest.mark.parametrize("script, given, found", [
    ("uniaxial", {"test": "tension"}, {"speed": 0.01457, "record_strain": 8.671e-7, "strain_max": 0.02}),
    ("brazilian", {"speed": 0.03, "diameter": 0.02}, {"speed": 0.03, "record_strain": 8.671e-7})])
def test_a_laboratory_test_is_loaded_by_the_strength_of_its_rock(script, given, found, tmp_path):
    """Bentheim: E 15.582 GPa and 2.7023 MPa in tension were measured. What is given wins."""
    sizes = {} if script == "brazilian" else {"width": 0.02, "height": 0.015}
    words = arguments({**sizes, **given, "rock": "bentheim", "report": "false"})
    run = run_script(ROOT / f"yade_scripts/{script}.py", *words, "--out", str(tmp_path), out=tmp_path)
    assert run.code == 0, run.stderr
    parameters = run.summary["parameters"]
    assert {name: parameters[name] for name in found} == pytest.approx(found, rel=1e-3)
    if script == "uniaxial":
        # At the default of record_strain there are three rows between 10 and 25 % of the peak.
        stress = history(tmp_path)["stress [Pa]"]
        loading = stress[:stress.argmax()] / stress.max()
        assert ((loading > 0.1) & (loading < 0.25)).sum() > 10


def test_a_rock_that_changes_or_moves_is_refused_by_a_resumed_run(tmp_path):
    rock = tmp_path / "mine.json"
    data = json.loads((LIBRARY / "m_sandstone.json").read_text(encoding="utf-8"))
    data["plane"]["parameters"]["kt"] = 1e10

    def write(**values):
        rock.write_text(json.dumps({**data, **values}), encoding="utf-8")

    write()
    given = dict(rock=rock, radius_min=3e-3, radius_max=4.5e-3, start_up=1e-4, cycles=0, report="false")
    first = tooth_cycles(tmp_path / "out", **given)
    assert first.code == 0, first.stderr
    # Its discs are three times as large as those that it was measured with.
    assert any("are 3 times larger than those" in line for line in first.summary["warnings"])
    assert first.summary["parameters"]["kt"] == 1e10 and first.summary["parameters"]["rock"] == str(rock)
    assert list(first.summary["files"]) == ["rock"]
    resumed = words(**given, out=tmp_path / "out", resume="true")
    write(source="another report")
    said = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    rock.unlink()
    said += refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    assert_refused(*said[0], "must be of the same files: rock is ")
    assert_refused(*said[1], "mine.json: must be a file, or one of ")
    write()
    (again,) = refusals(ROOT / "yade_scripts/tooth_cycles.py", tmp_path, [resumed])
    assert again[0] == 0, again[1]

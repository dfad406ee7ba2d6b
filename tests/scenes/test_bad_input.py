"""Bad input ends before the first step: one line that names parameter, value, rule and unit, exit code 2, nothing written."""
import os

import pytest

from tests.running import ROOT, SMALL, arguments, run_script

SCRIPT = ROOT / "yade_scripts/tooth_cycles.py"

CASES = [
    ({"kn": -20e9}, "kn = -2e+10 N/m: must be greater than 0"),
    ({"kt": 0}, "kt = 0 N/m: must be greater than 0"),
    ({"tool_kn": -1}, "tool_kn = -1 N/m: must be greater than 0"),
    ({"Rn": "nan"}, "Rn = nan N: must be finite"),
    ({"Rt": "inf"}, "Rt = inf N: must be finite"),
    ({"mu": -0.1}, "mu = -0.1: must be at least 0"),
    ({"tool_mu": 0}, "tool_mu = 0: must be greater than 0"),
    ({"rock_density": 0}, "rock_density = 0 kg/m3: must be greater than 0"),
    ({"radius_min": "small"}, "radius_min = small m: must be a number"),
    ({"radius_min": 3e-3}, "radius_max = 0.0022 m: must be at least radius_min"),
    ({"porosity": 0.5}, "porosity = 0.5"),
    ({"porosity": -0.1}, "porosity = -0.1"),
    ({"porosity": 0.001}, "porosity = 0.001"),
    ({"width": 0.008}, "must be at most the specimen's width 0.008"),
    ({"bonding_gap": -1e-4}, "bonding_gap = -0.0001 m: must be at least 0"),
    ({"bonding_gap": 0.01}, "bonding_gap = 0.01 m: must be at most radius_min = 0.0015"),
    ({"grading_factor": 0.5}, "grading_factor = 0.5: must be at least 1"),
    ({"seed": 1.5}, "seed = 1.5: must be a whole number"),
    ({"cycles": -1}, "cycles = -1: must be a whole number of at least 0"),
    ({"velocity": 0}, "velocity = 0 m/s: must be greater than 0"),
    ({"start_up": -1}, "start_up = -1 s: must be greater than 0"),
    ({"cycle_time": 1.0}, "cycle_time = 1 s: must be so short"),
    ({"depth_of_cut": 0.05}, "depth_of_cut = 0.05 m: must be more than a rock particle"),
    ({"depth_of_cut": 1e-3}, "depth_of_cut = 0.001 m: must be more than a rock particle"),
    ({"tooth_width": 0.08}, "tooth_width = 0.08"),
    ({"tooth_height": 0.05}, "tooth_height = 0.05"),
    ({"rake": 79, "clearance": 20}, "rake = 79 deg: must be less than 90 degrees less the clearance, 70"),
    ({"rake": -80}, "tooth_width = 0.02 m: must be greater than"),
    ({"tip_radius": 0.05}, "tip_radius = 0.05 m: must be"),
    ({"tool_radius_min": 0.6e-3}, "tool_radius_max = 0.00052 m: must be at least tool_radius_min"),
    ({"tool_radius_max": 2e-3}, "tool_radius_max = 0.002 m: must be at most the rock's radius_min"),
    ({"outline": "nowhere.csv"}, "outline = nowhere.csv: must be a readable CSV file"),
    ({"steel": "butter"}, "steel = butter: must be one of MET71, MET91"),
    ({"removal": "magic"}, "removal = magic: must be one of volume, depth"),
    ({"wear_coefficient": -1}, "wear_coefficient = -1: must be at least 0"),
    ({"wear_law": "modes", "wear_modes": "0.01/1/0.5"}, "modes = 0.5: must be given shares of the friction that add up to 1"),
    ({"wear_law": "power", "wear_exponent": 1e300}, "exponent = 1e+300: must be at most 20"),
    ({"wear_exponent": 2}, "wear_exponent = 2: must be 1 under the law dissipation"),
    ({"wear_modes": "0.01/1/1"}, "wear_modes = 0.01/1/1: must be left out under the law dissipation"),
    ({"tool": "segments", "heat": "false", "removal": "depth"}, "removal = depth: must be volume for a tool of facets"),
    ({"contact_damping": 2}, "contact_damping = 2: must be at most 1"),
    ({"heat_fraction": 1.5}, "heat_fraction = 1.5: must be at most 1"),
    ({"tool_temperature": 1500}, "tool_temperature = 1500 K: must be inside the hardness table of MET91, 273.15 to 873.15"),
    ({"ambient_temperature": 20}, "ambient_temperature = 20 K: must be inside the hardness table"),
    ({"time_step": 1e-5}, "time_step = 1e-05 s: must be at most the stable step"),
    ({"time_step_fraction": 1.5}, "time_step_fraction = 1.5: must be at most 1"),
    ({"sampling_period": 0}, "sampling_period = 0 steps: must be a whole number of at least 1"),
    ({"tool_specific_heat": 1e-6}, "heat_period = 0.0001 s: must be at most 1000 stable heat steps"),
    ({"kn": 1e300, "heat": "false"}, "must be at most 1e+10 of"),
    ({"heat_period": 0}, "heat_period = 0 s: must be greater than 0"),
    ({"heat": "maybe"}, "heat = maybe: must be true or false"),
    ({"checkpoint_interval": 0}, "checkpoint_interval = 0 s: must be greater than 0"),
    ({"velocty": 4}, "velocty = 4: must be a parameter of this scene; did you mean velocity"),
    ({"out": 300 * "n"}, "nnn: must be a folder that can be written (File name too long)"),
    ({"out": "/proc/nowhere"}, "out = /proc/nowhere: must be a folder that can be written"),
    ({"resume": "true"}, "must be an existing checkpoint: there is none to resume from"),
]


def one_line(run, words):
    errors = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.code == 2, run.stderr
    assert len(errors) == 1 and words in errors[0], run.stderr
    assert "Traceback" not in run.stdout + run.stderr


@pytest.mark.parametrize("values, words", CASES, ids=[" ".join(f"{k}={v}" for k, v in values.items()) for values, _ in CASES])
def test_bad_value(values, words, tmp_path):
    run = run_script(SCRIPT, *arguments({**SMALL, "out": tmp_path / "out", **values}), cwd=tmp_path)
    one_line(run, words)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("words, expected", [
    (["--kn"], "kn = : must be given a value"), (["kn", "3"], "argument = kn: must be of the form --name value"),
    (["--kn", "--kt", "3"], "kn = : must be given a value")])
def test_bad_command_line(words, expected, tmp_path):
    run = run_script(SCRIPT, *words, cwd=tmp_path)
    one_line(run, expected)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("rows, expected", [
    ("0,0\n1,0\n", "tooth.csv, 2 vertices: must be at least 3 vertices"),
    ("0,0\n0.02,0.02\n0.02,0\n0,0.02\n", "tooth.csv, 4 vertices: must be free of repeated vertices"),
    ("x,y\n0,0\n1,a\n0,1\n", "tooth.csv: must be two numbers a row, unlike line 3"),
    ("\n".join(f"{k},{k % 2}" for k in range(5000)), "tooth.csv, 5000 vertices: must be of at most 4000")])
def test_bad_outline(rows, expected, tmp_path):
    file = tmp_path / "tooth.csv"
    file.write_text(rows, encoding="utf-8")
    run = run_script(SCRIPT, *arguments({**SMALL, "out": tmp_path / "out", "outline": file}))
    one_line(run, expected)
    assert os.listdir(tmp_path) == ["tooth.csv"]


def test_a_run_replaces_nothing_that_is_not_a_runs(tmp_path):
    thesis = tmp_path / "out/figures/thesis.png"
    thesis.parent.mkdir(parents=True)
    thesis.write_bytes(b"mine")
    one_line(run_script(SCRIPT, *arguments({**SMALL, "out": tmp_path / "out"})), "figures there would be replaced")
    assert thesis.read_bytes() == b"mine"


def test_a_run_does_not_read_from_the_folder_that_it_replaces(tmp_path):
    file = tmp_path / "out/tooth.csv"
    file.parent.mkdir()
    file.write_text("0,0\n0,0.03\n-0.02,0.03\n-0.02,0.005\n", encoding="utf-8")
    one_line(run_script(SCRIPT, *arguments({**SMALL, "out": tmp_path / "out", "outline": file})), "must be outside of")
    assert file.exists() and os.listdir(file.parent) == ["tooth.csv"]


def test_a_checkpoint_belongs_to_the_contents_of_its_files(tmp_path):
    file, out = tmp_path / "tooth.csv", tmp_path / "out"
    values = {**SMALL, "start_up": 1e-4, "cycles": 0, "heat": "false", "report": "false", "outline": file, "out": out}
    file.write_text("0,0\n0,0.03\n-0.02,0.03\n-0.02,0.005\n", encoding="utf-8")
    assert run_script(SCRIPT, *arguments(values)).code == 0
    file.write_text("0,0\n0,0.03\n-0.02,0.03\n-0.02,0.006\n", encoding="utf-8")
    one_line(run_script(SCRIPT, *arguments(values), "--resume"), "of the same files: outline is ")


def test_help_lists_every_parameter_with_its_source():
    run = run_script(SCRIPT, "--help")
    assert run.code == 0
    for words in ("--kn N/m", "default 2e+10 N/m", "--wear_acceleration", "9.2", "--out"):
        assert words in run.stdout

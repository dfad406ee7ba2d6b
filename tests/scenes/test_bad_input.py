"""Bad input ends before the first step: one line that names parameter, value, rule and unit, exit code 2, no files."""
import os

import pytest

from tests.running import ROOT, SMALL, arguments, assert_refused, refusals, run_script

SCRIPT = ROOT / "yade_scripts/tooth_cycles.py"
OWN = {"outline": "tooth.csv"}
WITHOUT_TOOTH = {name: None for name in ("tooth_height", "tooth_width", "rake", "clearance")}
"""Parameters of the miniature that are not given."""

BROKEN_RULES = [
    ({"kn": -20e9}, "kn = -2e+10 N/m: must be greater than 0"),
    ({"kt": 0}, "kt = 0 N/m: must be greater than 0"),
    ({"tool_kn": -1}, "tool_kn = -1 N/m: must be greater than 0"),
    ({"Rn": "nan"}, "Rn = nan N: must be finite"),
    ({"Rt": "inf"}, "Rt = inf N: must be finite"),
    ({"mu": -0.1}, "mu = -0.1: must be 0 or between 0.001 and 100"),
    ({"tool_mu": 0}, "tool_mu = 0: must be greater than 0"),
    ({"rock_density": 0}, "rock_density = 0 kg/m3: must be greater than 0"),
    ({"radius_min": "small"}, "radius_min = small m: must be a number"),
    ({"radius_min": 3e-3}, "radius_max = 0.0022 m: must be at least radius_min"),
    ({"porosity": 0.5}, "porosity = 0.5"),
    ({"porosity": -0.1}, "porosity = -0.1"),
    ({"porosity": 0.001}, "porosity = 0.001"),
    ({"width": 0.008}, "must be at most the specimen's width 0.008"),
    ({"bonding_gap": -1e-4}, "bonding_gap = -0.0001 m: must be 0 or between 1e-08 and 1"),
    ({"bonding_gap": 0.01}, "bonding_gap = 0.01 m: must be at most radius_min = 0.0015"),
    ({"grading_factor": 0.5}, "grading_factor = 0.5: must be at least 1"),
    ({"seed": 1.5}, "seed = 1.5: must be a whole number"),
    ({"cycles": -1}, "cycles = -1: must be a whole number of at least 0"),
    ({"cycles": "1e9"}, "cycles = 1e9: must be a whole number of at most 100000"),
    ({"velocity": 0}, "velocity = 0 m/s: must be greater than 0"),
    ({"start_up": -1}, "start_up = -1 s: must be greater than 0"),
    ({"cycle_time": 1.0}, "cycle_time = 1 s: must be so short"),
    ({"depth_of_cut": 0.05}, "depth_of_cut = 0.05 m: must be more than a rock particle"),
    ({"depth_of_cut": 1e-3}, "depth_of_cut = 0.001 m: must be more than a rock particle"),
    ({"tooth_width": 0.08}, "tooth_width = 0.08"),
    ({"tooth_height": 0.05}, "tooth_height = 0.05"),
    ({"rake": 79, "clearance": 20}, "rake = 79 deg: must be less than 90 degrees minus the clearance, 70"),
    ({"rake": -80}, "tooth_width = 0.02 m: must be greater than"),
    ({"tip_radius": 0.05}, "tip_radius = 0.05 m: must be"),
    ({"tool_radius_min": 0.6e-3}, "tool_radius_max = 0.00052 m: must be at least tool_radius_min"),
    ({"tool_radius_max": 2e-3}, "tool_radius_max = 0.002 m: must be at most the rock's radius_min"),
    ({"tool": "segments", "thermal_radius": 0.02}, "thermal_radius = 0.02 m: must be so that of the particles which "
     "fill the tool 0.0226 is at most "),
    ({"outline": "nowhere.csv", **WITHOUT_TOOTH}, "outline = nowhere.csv: must be a readable CSV file"),
    ({"hardness_table": "butter"}, "hardness_table = butter: must be one of MET71, MET91"),
    ({"removal": "magic"}, "removal = magic: must be one of volume, depth"),
    ({"wear_coefficient": -1}, "wear_coefficient = -1: must be at least 0"),
    ({"wear_law": "modes", "wear_modes": "0.01/1/0.5"},
     "wear_modes = 0.01/1/0.5: must be given shares of the friction that add up to 1"),
    ({"wear_law": "modes", "wear_modes": "0.01/30/1"}, "wear_modes = 0.01/30/1: must be with exponent at most 20"),
    ({"wear_law": "modes", "wear_modes": "0.01/1"}, "wear_modes = 0.01/1: must be k/exponent/share of each mode"),
    ({"wear_law": "modes", "wear_modes": "0.01/1/x"}, "wear_modes = 0.01/1/x: must be a number"),
    ({"wear_law": "power", "wear_exponent": 1e300}, "wear_exponent = 1e+300: must be at most 20"),
    ({"contact_damping": 2}, "contact_damping = 2: must be at most 1"),
    ({"emissivity": 1.5}, "emissivity = 1.5: must be at most 1"),
    ({"emissivity": -0.1}, "emissivity = -0.1: must be at least 0"),
    ({"heat_fraction": 1.5}, "heat_fraction = 1.5: must be at most 1"),
    ({"tool_temperature": 1500},
     "tool_temperature = 1500 K: must be inside the hardness table of MET91, 273.15 to 873.15"),
    ({"hardness_temperature": -0.5}, "hardness_temperature = -0.5 K: must be inside the hardness table of MET91"),
    ({"ambient_temperature": 20}, "ambient_temperature = 20 K: must be inside the hardness table"),
    ({"control_radius": 0.5}, "control_radius = 0.5: must be 0 or between 1 and 20"),
    ({"time_step": 1e-5}, "time_step = 1e-05 s: must be at most the stable step"),
    ({"time_step_fraction": 1.5}, "time_step_fraction = 1.5: must be at most 1"),
    ({"sampling_period": 0}, "sampling_period = 0 steps: must be a whole number of at least 1"),
    ({"sampling_period": 2, "tool": "segments", "heat": "false"},
     "sampling_period = 2 steps: must be 1 for a tool of facets"),
    ({"tool_specific_heat": 1e-6}, "heat_period = 0.0001 s: must be at most 1000 stable heat steps"),
    ({"heat_period": 0}, "heat_period = 0 s: must be greater than 0"),
    ({"heat": "maybe"}, "heat = maybe: must be true or false"),
    ({"checkpoint_interval": 0}, "checkpoint_interval = 0 s: must be greater than 0"),
    ({"velocty": 4}, "velocty = 4: must be a known parameter; did you mean velocity"),
    ({"out": 300 * "n"}, "nnn: must be a folder that can be written (File name too long)"),
    ({"out": "/proc/nowhere"}, "out = /proc/nowhere: must be a folder that can be written"),
    ({"resume": "true"}, "must be an existing checkpoint: there is none to resume from"),
]
OUT_OF_RANGE = [
    ({"kn": 1e300}, "kn = 1e+300 N/m: must be between 1 and 1e+15"),
    ({"kt": 1e99}, "kt = 1e+99 N/m: must be between 1 and 1e+15"),
    ({"tool_kn": 1e99}, "tool_kn = 1e+99 N/m: must be between 1 and 1e+15"),
    ({"tool_kt": 1e99}, "tool_kt = 1e+99 N/m: must be between 1 and 1e+15"),
    ({"rock_density": 2.5}, "rock_density = 2.5 kg/m3: must be between 100 and 1e+06"),
    ({"velocity": 1e99}, "velocity = 1e+99 m/s: must be between 1e-09 and 100000"),
    ({"start_up": 1e99}, "start_up = 1e+99 s: must be between 1e-12 and 1e+08"),
    ({"start_up": 1e-12}, "start-up = 1e-12 s: must be at least half a step, 7."),
    ({"time_scale": 1e5}, "start-up = 0.0012 s: must be at least half a step, 0.007"),
    ({"time_scale": 1e300}, "time_scale = 1e+300: must be between 0.0001 and 100000"),
    ({"tool_radius_min": 1e-300}, "tool_radius_min = 1e-300 m: must be between 1e-09 and 1e+06"),
    ({"tool_radius_min": 1e-9}, "tool_radius_min = 1e-09 m: must be large enough for at most"),
    ({"radius_max": 1e300}, "radius_max = 1e+300 m: must be between 1e-09 and 1e+06"),
    ({"grain_edge": 1e-300}, "grain_edge = 1e-300 m: must be 0 or between 1e-09 and 1e+06"),
    ({"grain_edge": 1e-9}, "grain_edge = 1e-09 m: must be at least 0.00219: a particle a grain"),
    ({"time_step": 1e-320}, "time_step = 9.99989e-321 s: must be 0 or between 1e-15 and 1"),
    ({"snapshot_period": 1e-320}, "snapshot_period = 9.99989e-321 s: must be between 1e-12 and 1e+08"),
    ({"tool_mu": 1e3}, "tool_mu = 1000: must be between 0.001 and 100"),
    ({"wear_acceleration": 1e300}, "wear_acceleration = 1e+300: must be at most 1e+10"),
    ({"wear_coefficient": 1e300}, "wear_coefficient = 1e+300: must be at most 1000"),
    ({"wear_law": "modes", "wear_modes": "1e300/1/1"}, "wear_modes = 1e300/1/1: must be with k at most 1000"),
    ({"velocity": 1e-6, "start_up": 1e4, "cycles": 0, "heat": "false"}, "must be at most 1e+10 of"),
]
NOT_USED = [
    ({"H": 1e9}, "H = 1e+09 N/m: must be left out with bond_law = brittle"),
    ({"tension_only": "true"}, "tension_only = true: must be left out with bond_law = brittle"),
    ({"padova_m": 1e8}, "padova_m = 1e+08 N^(2/3)/m: must be left out with bond_law = brittle"),
    ({"bond_law": "padova", "H": 1e9}, "H = 1e+09 N/m: must be left out with bond_law = padova"),
    ({"wear_exponent": 2}, "wear_exponent = 2: must be left out with wear_law = dissipation"),
    ({"wear_modes": "0.01/1/1"}, "wear_modes = 0.01/1/1: must be left out with wear_law = dissipation"),
    ({"wear_law": "modes", "wear_modes": "0.01/1/1", "wear_coefficient": 0.01},
     "wear_coefficient = 0.01: must be left out with wear_law = modes"),
    ({"segment": 1e-3}, "segment = 0.001 m: must be left out with tool = particles"),
    ({"work_fraction": 0.5}, "work_fraction = 0.5: must be left out with tool = particles"),
    ({"reshape": "true"}, "reshape = true: must be left out with tool = particles"),
    ({"thermal_radius": 1e-3}, "thermal_radius = 0.001 m: must be left out with tool = particles"),
    ({"tool": "segments", "removal": "depth"}, "removal = depth: must be left out with tool = segments"),
    ({"tool": "segments", "tool_radius_min": 4e-4},
     "tool_radius_min = 0.0004 m: must be left out with tool = segments"),
    ({"tool": "segments", "tool_radius_max": 4e-4},
     "tool_radius_max = 0.0004 m: must be left out with tool = segments"),
    ({"tool": "segments", "heat": "false", "thermal_radius": 1e-3},
     "thermal_radius = 0.001 m: must be left out with heat = false"),
    *(({"heat": "false", name: value}, f"{name} = {value}{unit}: must be left out with heat = false")
      for name, value, unit in (
          ("rock_conductivity", 5, " W/mK"), ("tool_specific_heat", 450, " J/kgK"), ("heat_fraction", 0.5, ""),
          ("rock_expansion", 0.1, " 1/K"), ("conduction", "true", ""), ("bond_conductance", "bar", ""),
          ("shank", "fixed", ""), ("ambient_temperature", 300, " K"), ("rock_temperature", 300, " K"),
          ("heat_period", 0.1, " s"), ("surface_period", 0.1, " s"))),
    ({"grain_strength": 15}, "grain_strength = 15: must be left out with grain_edge = 0"),
    ({"grain_quality": 5}, "grain_quality = 5: must be left out with grain_edge = 0"),
    ({"time_step": 1e-8, "time_step_fraction": 0.5},
     "time_step_fraction = 0.5: must be left out with time_step = 1e-08"),
    ({"shank_temperature": 300}, "shank_temperature = 300 K: must be left out with shank = insulated"),
    ({"hardness": 1e9, "hardness_table": "MET71"}, "hardness_table = MET71: must be left out with hardness = 1e+09"),
    ({"hardness": 1e9, "hardness_temperature": 300},
     "hardness_temperature = 300 K: must be left out with hardness = 1e+09"),
    *(({**OWN, **WITHOUT_TOOTH, name: SMALL[name]},
       f"{name} = {SMALL[name]} {unit}: must be left out with outline = tooth.csv")
      for name, unit in (("tooth_height", "m"), ("tooth_width", "m"), ("rake", "deg"), ("clearance", "deg"))),
]
OLD_NAMES = [
    ({"law": "damage"}, "law = damage: must be given as bond_law, its name since 0.2"),
    ({"acceleration": 1}, "acceleration = 1: must be given as wear_acceleration, its name since 0.2"),
    ({"speed_up": 2}, "speed_up = 2: must be given as time_scale, its name since 0.2"),
    ({"coarsening": 2}, "coarsening = 2: must be given as grading_factor, its name since 0.2"),
    ({"steel": "MET91"}, "steel = MET91: must be given as hardness_table, its name since 0.2"),
    ({"root": "fixed"}, "root = fixed: must be given as shank, its name since 0.2"),
    ({"root_temperature": 300}, "root_temperature = 300: must be given as shank_temperature, its name since 0.2"),
    ({"bond_conductance": "cells"}, "bond_conductance = cells: must be given as voronoi, its name since 0.2"),
    ({"bond_conductance": "M"}, "bond_conductance = M: must be given as half_bar, its name since 0.2"),
]
CASES = [*BROKEN_RULES, *OUT_OF_RANGE, *NOT_USED, *OLD_NAMES]
IDS = [" ".join(f"{k}={v}" for k, v in values.items() if v is not None)[:80] for values, _ in CASES]


def words_of(values, out):
    """Command line of the miniature with these values; None leaves one out."""
    return arguments({name: value for name, value in {**SMALL, "out": out, **values}.items() if value is not None})


@pytest.fixture(scope="module")
def refused(tmp_path_factory):
    """What the script said to each of CASES, and whether it wrote anything."""
    folder = tmp_path_factory.mktemp("cases")
    said = refusals(SCRIPT, folder, [words_of(values, folder / "out") for values, _ in CASES])
    return said, sorted(os.listdir(folder))


@pytest.mark.parametrize("case", range(len(CASES)), ids=IDS)
def test_bad_value(refused, case):
    assert_refused(*refused[0][case], CASES[case][1])


def test_bad_values_leave_nothing_behind(refused):
    assert refused[1] == ["cases.json", "checks.json"]


@pytest.mark.parametrize("words, expected", [
    (words_of({"kn": -20e9}, "out"), "kn = -2e+10 N/m: must be greater than 0"),
    (words_of({"tool_specific_heat": 1e-6}, "out"), "heat_period = 0.0001 s: must be at most 1000 stable heat steps"),
    (["--kn"], "kn = nothing N/m: must be given a value")], ids=["rule", "scene", "command line"])
def test_a_process_of_its_own_ends_so(words, expected, tmp_path):
    run = run_script(SCRIPT, *words, cwd=tmp_path)
    assert_refused(run.code, run.stdout + run.stderr, expected)
    assert os.listdir(tmp_path) == []


def test_bad_command_line(tmp_path):
    cases = {"kn = nothing N/m: must be given a value": ["--kn"],
             "argument = kn: must be of the form --name value": ["kn", "3"],
             "kt = 3=4 N/m: must be a number": ["--kt=3=4"],
             "Rn = nothing N: must be given a value": ["--Rn", "--kt", "3"]}
    for expected, (code, said) in zip(cases, refusals(SCRIPT, tmp_path, cases.values())):
        assert_refused(code, said, expected)


def test_bad_outline(tmp_path):
    cases = {
        "tooth.csv, 2 vertices: must be at least 3 vertices": "0,0\n1,0\n",
        "tooth.csv, 4 vertices: must be free of repeated vertices": "0,0\n0.02,0.02\n0.02,0\n0,0.02\n",
        "tooth.csv: must be two numbers a row, unlike line 3": "x,y\n0,0\n1,a\n0,1\n",
        "tooth.csv, 5000 vertices: must be of at most 4000": "\n".join(f"{k},{k % 2}" for k in range(5000))}
    words = []
    for number, rows in enumerate(cases.values()):
        file = tmp_path / str(number) / "tooth.csv"
        file.parent.mkdir()
        file.write_text(rows, encoding="utf-8")
        words.append(words_of({"outline": file, **WITHOUT_TOOTH}, tmp_path / "out"))
    for expected, (code, said) in zip(cases, refusals(SCRIPT, tmp_path, words)):
        assert_refused(code, said, expected)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("script, size, words", [
    ("steady_cut", "tool_radius_min = 0.0002 m is large enough for at most 5000000 particles", []),
    ("steady_cut", "segment = 0.001 m is at least 0.00262: the tool would have more", ["--tool", "segments"]),
    ("cutting_3d_wear", "tool_radius = 0.00225 m is large enough for at most", []),
    ("cutting_3d_triangles", "facet = 0.02 m is at least 0.168", [])])
def test_an_outline_in_other_units_is_named_and_not_what_it_does_not_fit(script, size, words, tmp_path):
    (tmp_path / "mm.csv").write_text("0,0\n0,20\n-8,20\n-8,5\n", encoding="utf-8")
    run = run_script(ROOT / f"yade_scripts/{script}.py", "--outline", "mm.csv", *words, cwd=tmp_path)
    assert_refused(run.code, run.stderr, f"outline = mm.csv, 8 m x 20 m: must be in m, and such that {size}")
    assert os.listdir(tmp_path) == ["mm.csv"]


def test_a_run_replaces_no_file_of_another_origin_and_none_that_it_reads(tmp_path):
    thesis, file = tmp_path / "work/figures/thesis.png", tmp_path / "out/tooth.csv"
    for path, text in ((thesis, "mine"), (file, "0,0\n0,0.03\n-0.02,0.03\n-0.02,0.005\n")):
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
    foreign, inside = refusals(SCRIPT, tmp_path, [words_of({}, tmp_path / "work"),
                                                  words_of({"outline": file, **WITHOUT_TOOTH}, tmp_path / "out")])
    assert_refused(*foreign, "figures there would be replaced")
    assert_refused(*inside, "must be outside of")
    assert thesis.read_text(encoding="utf-8") == "mine" and os.listdir(file.parent) == ["tooth.csv"]


def test_a_checkpoint_belongs_to_the_contents_of_its_files(tmp_path):
    file, out = tmp_path / "tooth.csv", tmp_path / "out"
    words = words_of({"start_up": 1e-4, "cycles": 0, "heat": "false", "report": "false", "outline": file,
                      **WITHOUT_TOOTH}, out)
    file.write_text("0,0\n0,0.03\n-0.02,0.03\n-0.02,0.005\n", encoding="utf-8")
    assert run_script(SCRIPT, *words).code == 0
    file.write_text("0,0\n0,0.03\n-0.02,0.03\n-0.02,0.006\n", encoding="utf-8")
    run = run_script(SCRIPT, *words, "--resume")
    assert_refused(run.code, run.stderr, "of the same files: outline is ")


@pytest.mark.parametrize("values", [{"hardness_temperature": 293.15, "rock_temperature": 268.15},
                                    {"wear_acceleration": 0, "ambient_temperature": 263.15}])
def test_frozen_rock_is_cut_where_nothing_asks_for_the_steel_s_hardness_there(values, tmp_path):
    run = run_script(SCRIPT, *words_of({"start_up": 1e-5, "cycles": 0, "report": "false", **values}, tmp_path / "out"))
    assert run.code == 0, run.stderr


def test_help_lists_every_parameter_with_its_source():
    run = run_script(SCRIPT, "--help")
    assert run.code == 0
    for words in ("--kn N/m", "default 2e+10 N/m", "--wear_acceleration", "9.2", "--out"):
        assert words in run.stdout

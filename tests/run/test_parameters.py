"""Reading parameters: from words and tables to checked values, and one line for each mistake."""
import pytest

from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.parameter import (
    Above, Fixed, Group, Parameter, Presets, above_zero, choice, density, duration, flag, integer, law_parameters,
    listed, number, numbers, speed, stiffness, text)
from rockwear.run import parameters
from rockwear.scenes.parameters import given

BONDS = Group("bonds", (Parameter("bond_law", "brittle", "", choice(*BOND_LAWS), "law of the bonds"),
                        *law_parameters(BOND_LAWS, "bond_law")))
HEAT = Group("heat", (
    Parameter("heat", True, "", flag, "whether heat is computed"),
    Parameter("bond_conductance", "voronoi", "", choice("voronoi", "half_bar", renamed={"M": "half_bar"}), "of bonds"),
    Parameter("hardness_table", "MET91", "", choice("MET71", "MET91"), "hardness"),
    Parameter("convection", 30.0, "W/m2K", number(0), "5 % of nothing", "[Rojek 2003, 7.5]", when={"shank": ("free",)}),
    Parameter("shank", "free", "", choice("free", "fixed"), "of the tool")), when={"heat": (True,)})
OTHERS = Group("others", (
    Parameter("tool_kn", 9e10, "N/m", stiffness, "tool"), Parameter("rock_density", 2500.0, "kg/m3", density, "-"),
    Parameter("velocity", 4.0, "m/s", speed, "of the tool"), Parameter("start_up", 0.1, "s", duration, "at first"),
    Parameter("rake", 0.0, "deg", number(-80, 80), "rake angle"), Parameter("seed", 1, "", integer(0), "of packings"),
    Parameter("velocities", "4,1", "m/s", numbers(above_zero), "of passes"), Parameter("out", "", "", text, "folder"),
    Parameter("grading_factor", 1.0, "", number(1, 8), "of the rock"),
    Parameter("wear_acceleration", 1.0, "", number(0), "of wear")))
GROUPS = [BONDS, HEAT, OTHERS]


@pytest.fixture(autouse=True)
def no_batch(monkeypatch):
    monkeypatch.delenv("YADE_BATCH", raising=False)


def read(words):
    return parameters.read(GROUPS, words.split())


@pytest.mark.parametrize("words, name, value", [
    ("", "kn", 20e9), ("--kn 3e10", "kn", 3e10), ("--kn=3e10", "kn", 3e10), ("--kn 1 --kn 2", "kn", 2.0),
    ("--rake -5", "rake", -5.0), ("--rake -1e-5", "rake", -1e-5), ("--rake=-1e-5", "rake", -1e-5),
    ("--rake -.5", "rake", -0.5), ("--wear-acceleration 7", "wear_acceleration", 7.0), ("--seed 3.0", "seed", 3),
    ("--velocities 4,1e-5", "velocities", "4,1e-05"), ("--heat", "heat", True), ("--heat false", "heat", False),
    ("--heat=no", "heat", False), ("--heat --rake 3", "heat", True), ("--out a=b", "out", "a=b"), ("--out=", "out", ""),
    ("--out -x", "out", "-x"), ("--bond-law damage --tension-only", "tension_only", True),
    ("--bond_law padova --padova_r -1e5", "padova_r", -1e5), ("--bond_law plastic --H 3e9", "H", 3e9)])
def test_words_become_values(words, name, value):
    found = read(words)[name]
    assert found == value and type(found) is type(value)


def test_every_parameter_gets_a_value_in_the_order_of_its_declaration():
    declared = [parameter.name for group in GROUPS for parameter in group]
    assert list(read("--seed 3")) == declared
    assert parameters.read([*BONDS, *HEAT, *OTHERS], ["--seed", "3"]) == read("--seed 3")
    assert listed(read("")["velocities"]) == [4.0, 1.0]


def test_listed_numbers_keep_all_their_digits():
    """Two seeds of a day are not one."""
    assert numbers(integer(0))("seeds", "20240101, 20240102,7", "") == "20240101,20240102,7"
    assert listed(read("--velocities 0.12345678,4")["velocities"]) == [0.12345678, 4.0]


@pytest.mark.parametrize("words, error", [
    ("--velocty 4", "velocty = 4: must be a known parameter; did you mean velocity (--help lists them)"),
    ("--wear_accel 4", "wear_accel = 4: must be a known parameter; did you mean wear_acceleration "
                       "(--help lists them)"),
    ("--zzz", "zzz = : must be a known parameter (--help lists them)"),
    ("--kn", "kn = nothing N/m: must be given a value"), ("--kn --kt 3", "kn = nothing N/m: must be given a value"),
    ("kn 3", "argument = kn: must be of the form --name value"),
    ("-kn 3", "argument = -kn: must be of the form --name value"),
    ("--kn 3 4", "argument = 4: must be of the form --name value"),
    ("--", "argument = --: must be of the form --name value"),
    ("--kn small", "kn = small N/m: must be a number"), ("--kn=", "kn =  N/m: must be a number"),
    ("--kn nan", "kn = nan N/m: must be finite"), ("--kn -2e10", "kn = -2e+10 N/m: must be greater than 0"),
    ("--seed 1.5", "seed = 1.5: must be a whole number of at least 0"),
    ("--heat maybe", "heat = maybe: must be true or false"),
    ("--bond_law magic", "bond_law = magic: must be one of brittle, damage, plastic, padova, coulomb, cohesive"),
    ("--grading_factor 9", "grading_factor = 9: must be at most 8"),
    ("--velocities 4,-1", "velocities = -1 m/s: must be greater than 0")])
def test_mistakes_are_said_in_one_line(words, error):
    with pytest.raises(ParameterError) as caught:
        read(words)
    assert str(caught.value) == error


@pytest.mark.parametrize("words, error", [
    ("--kn 1e99", "kn = 1e+99 N/m: must be between 1 and 1e+15"), ("--kt 1e99", "kt = 1e+99 N/m: must be between"),
    ("--kt 1e-99", "kt = 1e-99 N/m: must be between"), ("--tool_kn 1e99", "tool_kn = 1e+99 N/m: must be between"),
    ("--rock_density 1e-99", "rock_density = 1e-99 kg/m3: must be between"),
    ("--velocity 1e99", "velocity = 1e+99 m/s: must be between"), ("--velocity 1e-99", "velocity = 1e-99 m/s: must be"),
    ("--start_up 1e99", "start_up = 1e+99 s: must be between")])
def test_values_that_no_material_and_no_process_has(words, error):
    with pytest.raises(ParameterError) as caught:
        read(words)
    assert str(caught.value).startswith(error)


@pytest.mark.parametrize("words, error", [
    ("--H 1e10", "H = 1e+10 N/m: must be left out with bond_law = brittle"),
    ("--tension_only --bond_law plastic", "tension_only = true: must be left out with bond_law = plastic"),
    ("--Rt 1e6 --bond_law padova", "Rt = 1e+06 N: must be left out with bond_law = padova"),
    ("--padova_eta 0.8", "padova_eta = 0.8: must be left out with bond_law = brittle"),
    ("--shank fixed --heat false", "shank = fixed: must be left out with heat = false"),
    ("--convection 30 --shank fixed", "convection = 30 W/m2K: must be left out with shank = fixed"),
    ("--convection 30 --heat false", "convection = 30 W/m2K: must be left out with heat = false")])
def test_what_is_not_used_is_refused_though_it_be_the_default(words, error):
    with pytest.raises(ParameterError) as caught:
        read(words)
    assert str(caught.value) == error


def test_a_condition_on_what_is_not_used_or_not_declared():
    first = Parameter("first", "a", "", choice("a", "b"), "-")
    second = Parameter("second", "c", "", choice("c", "d"), "-", when={"first": ("a",)})
    third = Parameter("third", 1.0, "", above_zero, "-", when={"second": ("c",)})
    assert parameters.read([first, second, third], ["--third", "2"])["third"] == 2.0
    assert parameters.read([third], ["--third", "2"])["third"] == 2.0
    # What is not used counts with its default.
    assert parameters.read([first, second, third], ["--first", "b", "--third", "2"])["third"] == 2.0
    fourth = Parameter("fourth", 1.0, "", above_zero, "-", when={"second": ("d",)})
    with pytest.raises(ParameterError, match="^fourth = 2: must be left out with second = c$"):
        parameters.read([first, second, fourth], ["--first", "b", "--fourth", "2"])


class Scaled(Presets):
    """Gives one parameter a multiple of another."""

    def __init__(self, name, other):
        self.name, self.other = name, other

    def defaults(self, value, values):
        return {self.name: value * values[self.other]}


@pytest.mark.parametrize("words, height, width", [
    ("", 1.0, 1.0), ("--high 2", 2.0, 1.0), ("--wide 2", 1.0, 2.0), ("--high 2 --wide 3", 2.0, 6.0),
    ("--high 2 --wide 3 --height 4", 4.0, 12.0), ("--high 2 --wide 3 --width 4", 2.0, 4.0)])
def test_presets_give_defaults_one_after_the_other(words, height, width):
    groups = [*(Parameter(name, 1.0, "m", above_zero, "-") for name in ("length", "height", "width")),
              Parameter("high", 0.0, "", number(0), "-", presets=Scaled("height", "length")),
              Parameter("wide", 0.0, "", number(0), "-", presets=Scaled("width", "height"))]
    values = parameters.read(groups, words.split())
    assert (values["height"], values["width"]) == (height, width)


@pytest.mark.parametrize("words, height, width", [
    ("", 1.0, 1.0), ("--whole", 3.0, 5.0), ("--whole false", 1.0, 1.0), ("--width 7 --whole=true", 3.0, 7.0)])
def test_a_flag_gives_fixed_defaults(words, height, width):
    groups = [*(Parameter(name, 1.0, "m", above_zero, "-") for name in ("height", "width")),
              Parameter("whole", False, "", flag, "-", presets=Fixed(height=3.0, width=5.0))]
    values = parameters.read(groups, words.split())
    assert (values["height"], values["width"]) == (height, width)


def test_what_is_used_above_a_number_alone(capsys):
    groups = [Parameter("edge", 0.0, "m", number(0), "-"),
              Parameter("strength", 1.0, "", number(0), "-", when={"edge": Above(0)})]
    assert parameters.read(groups, ["--edge", "1e-3", "--strength", "2"])["strength"] == 2.0
    with pytest.raises(ParameterError, match="^strength = 2: must be left out with edge = 0$"):
        parameters.read(groups, ["--strength", "2"])
    parameters.describe(groups)
    assert "only with edge above 0" in capsys.readouterr().out


def test_what_a_scene_gives_itself_goes_with_all_that_it_excludes():
    first = Parameter("tool", "a", "", choice("a", "b"), "-")
    group = Group("tool", (first, Parameter("of_a", 1.0, "", number(0), "-", when={"tool": ("a",)}),
                           Parameter("of_b", 1.0, "", number(0), "-", when={"tool": ("b",), "heat": (True,)})))
    names = [[p.name for p in group] for group in given([group, HEAT], tool="b", heat=False)]
    assert names == [[]]
    found = given([group, HEAT], tool="b", heat=True)
    assert [[p.name for p in group] for group in found] == [
        ["of_b"], ["bond_conductance", "hardness_table", "convection", "shank"]]
    assert found[1].when is None and parameters.read(found, ["--shank", "fixed"])["shank"] == "fixed"


@pytest.mark.parametrize("words, error", [
    ("--acceleration 1e5", "acceleration = 1e5: must be given as wear_acceleration, its name since 0.2"),
    ("--coarsening 2", "coarsening = 2: must be given as grading_factor, its name since 0.2"),
    ("--law damage", "law = damage: must be given as bond_law, its name since 0.2"),
    ("--steel MET71", "steel = MET71: must be given as hardness_table, its name since 0.2"),
    ("--bond_conductance M", "bond_conductance = M: must be given as half_bar, its name since 0.2"),
    ("--arm 0.7", "arm = 0.7: must be a known parameter (--help lists them)")])
def test_old_names_are_answered_with_the_new_ones(words, error):
    with pytest.raises(ParameterError) as caught:
        read(words)
    assert str(caught.value) == error


def test_an_old_name_that_is_a_parameter_of_the_scene_is_one():
    assert parameters.read([Parameter("arm", 1.0, "m", above_zero, "-")], ["--arm", "2"]) == {"arm": 2.0}


def test_help_lists_groups_with_defaults_units_sources_and_conditions(capsys):
    parameters.describe(GROUPS)
    words = capsys.readouterr().out
    sections = {block.splitlines()[0]: " ".join(block.split()) for block in words.split("\n\n")}
    assert list(sections)[1:] == ["bonds:", "heat:", "others:"]
    bonds, heat = sections["bonds:"], sections["heat:"]
    assert "--kn N/m normal stiffness of bonds and rock contacts (default 2e+10 N/m; [Rojek 2003, 5.1])" in bonds
    assert "--bond_law brittle|damage|plastic|padova|coulomb|cohesive" in bonds
    assert "only with bond_law = damage or plastic" in bonds
    assert "5 % of nothing (default 30 W/m2K; [Rojek 2003, 7.5]; only with heat = true; shank = free)" in heat
    assert "--heat [true|false]" in heat
    for group in GROUPS:
        assert all(f"--{parameter.name} " in sections[f"{group.title}:"] for parameter in group)
    assert max(map(len, words.splitlines())) <= 120


@pytest.mark.parametrize("words, name", [("a/b", "a_b"), ("..", "_"), (".", "_"), ("v1.5", "v1.5")])
def test_a_row_names_a_folder_of_its_own(words, name):
    assert parameters.file_name(words) == name


def test_groups_are_changed_by_name():
    assert [p.name for p in OTHERS.only("seed", "rake")] == ["rake", "seed"]
    assert [p.name for p in HEAT.without("hardness_table", "shank")] == ["heat", "bond_conductance", "convection"]
    changed = BONDS.with_defaults(kn=1e5, tension_only=True)
    assert {p.name: p.default for p in changed}["kn"] == 1e5 and changed.title == "bonds"
    assert {p.name: p.default for p in BONDS}["kn"] == 20e9
    for wrong in (lambda: BONDS.with_defaults(kk=1), lambda: BONDS.without("kk"), lambda: BONDS.only("kk")):
        with pytest.raises(KeyError, match="not in the group bonds: kk"):
            wrong()

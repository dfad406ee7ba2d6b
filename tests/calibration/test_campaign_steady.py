"""Campaign of the steady cut: its plan, and means over a record and over packings."""
import csv
import json
import math

import numpy as np
import pytest

from calibration import settings
from calibration.campaigns import steady_cut, steady_cut_cases as cases, steady_cut_figures as figures
from calibration.campaigns import steady_cut_numbers as numbers, steady_cut_tables as tables
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.steady_record import Measured
from rockwear.report.folder import RunFolder

DEPTH, FORCE, THRUST, FRICTION = 5e-3, 30e3, 18e3, 3e3


def test_the_plan_changes_one_cause_at_a_time_and_measures_every_rock():
    plan = cases.plan(cases.CASES)
    base = cases.cut_of("base", 1)
    for case in cases.CASES:
        if case in cases.CUTS:
            assert {**base, **cases.CUTS[case]}.items() >= cases.ROCK.items()
        for seed in cases.SEEDS:
            assert f"cut/{cases.slug(case, seed)}" in plan
            tested = f"lab/{cases.slug(cases.rock_of(case), 'compression', seed)}" in plan
            assert tested == (cases.rock_of(case) not in cases.UNTESTED)
    script, values = plan["cut/eight_discs__no_grains-2"]
    changed = {name for name in values if values[name] != cases.cut_of("eight discs", 2).get(name)}
    assert changed == {"grain_edge"}
    assert "rake" not in cases.test_of(cases.SCRATCH, "compression", 1)
    assert [name.rpartition("-")[0] for name in plan][:9:3] == ["cut/base"] * 3


@pytest.mark.parametrize("case, known", [
    ("base", None), ("eight discs", None), ("eight discs, bentheim", "eight discs"), ("wear flat 2 mm", "base"),
    ("eight discs, tip 0.2 mm, rake 15°", "eight discs, tip 0.2 mm"), ("scratch, twice as deep", None),
    ("eight discs, depth 1.2 mm", None), ("eight discs, depth 1.2 mm, wear flat 1 mm", "eight discs, depth 1.2 mm"),
    ("scratch, tool friction 0.6, wear flat 0.2 mm leaning by 5°", "scratch, tool friction 0.6")])
def test_a_case_is_compared_with_the_one_that_it_changes(case, known):
    assert case in cases.CASES and cases.changed_from(case) == known


def test_a_few_packings_have_the_errors_of_their_records_and_three_their_scatter():
    ones = [Measured(1.0, 0.3), Measured(2.0, 0.4)]
    assert numbers.over_packings(ones) == pytest.approx((1.5, 0.25))
    three = numbers.over_packings([*ones, Measured(6.0, math.nan), Measured(math.nan, math.nan)])
    assert three == pytest.approx((3.0, math.sqrt(7 / 3)))
    assert numbers.shown(three) == "3 ± 1.5" and numbers.shown(Measured(math.nan, 1.0)) == "–"


def test_what_comes_before_the_end_of_the_slope_does_not_count(tmp_path):
    write_run(tmp_path / "cut/base-1")
    found = numbers.of_run(RunFolder(tmp_path / "cut/base-1"))
    assert found["force"].value == pytest.approx(1e-3 * FORCE) and found["energy"].value == pytest.approx(FORCE / DEPTH)
    assert found["thrust"].value == pytest.approx(THRUST / FORCE)
    assert found["friction"].value == pytest.approx(1e-3 * FRICTION)
    assert found["overbreak"].value == pytest.approx(0.4) and found["chip"].value == pytest.approx(2.0)
    assert (found["bonds"].value, found["tension"].value, found["crushing"].value) == (0.5, 0.1, 0.3)
    # 1 K per mm, from 3 to 12 depths of cut.
    assert found["temperature"].value == pytest.approx(37.5, abs=0.1)


def test_chips_that_break_abreast_at_places_of_their_own_have_lower_peaks(tmp_path):
    """Triangles, a fourth of a depth long and two depths apart, in two records half a spacing apart: half the peak."""
    way = np.linspace(0, 0.06, 4801)
    for name, shift in (("a", 0.0), ("b", 5e-3)):
        write(tmp_path / name, {})
        force = FORCE * np.maximum(1 - abs((way + shift) % 0.01 - 5e-3) / 6.25e-4, 0.0)
        rows(tmp_path / name / "history.csv", "distance cutting_force", way, force)
    one, other = (RunFolder(tmp_path / name) for name in ("a", "b"))
    alone, both = numbers.abreast([one]), numbers.abreast([one, other])
    # Mean: a sixteenth of the peak, of which the running mean over a tenth of a mm loses some 4 %.
    assert alone.value == pytest.approx(16, rel=0.06) and both.value == pytest.approx(0.5 * alone.value, rel=0.02)
    assert numbers.abreast([one, one]).value == pytest.approx(alone.value)


def test_the_way_under_load_is_not_known_without_peaks():
    distance = np.linspace(0, 0.06, 601)
    half = np.where(distance > 0.03, FORCE, 0.0)
    assert numbers.under_load(distance, half, FORCE, 0.0).value == pytest.approx(0.5, abs=0.01)
    assert math.isnan(numbers.under_load(distance, half, math.nan, 0.0).value)


def test_specific_energy_is_over_the_strength_of_the_same_rock(tmp_path):
    write_run(tmp_path / "cut/base-1")
    for seed, ucs in ((1, 40e6), (2, 60e6)):
        write(tmp_path / "lab" / f"base-compression-{seed}", {"peak_stress": ucs})
    row = numbers.of_case(tmp_path, "base")
    assert row["ucs"].value == pytest.approx(50.0) and row["energy"].value == pytest.approx(FORCE / DEPTH / 50e6)
    assert row["packings"] == 1 and row["way"] == pytest.approx(9) and row["cost"] == pytest.approx(2 / 0.065)
    assert numbers.of_case(tmp_path, "eight discs, no grains") is None
    line, = (line for line in tables.causes({"base": row}) if "| base | 1 | 9 | 50" in line)
    assert line.endswith("| 5.0 | 31 |")


def test_what_was_measured_is_kept_for_tables_without_its_runs(tmp_path):
    write_run(tmp_path / "cut/base-1")
    for seed, ucs in ((1, 40e6), (2, 60e6)):
        write(tmp_path / "lab" / f"base-compression-{seed}", {"peak_stress": ucs})
    found = {case: numbers.of_case(tmp_path, "base") for case in ("base", "eight discs")}
    numbers.keep(found, tmp_path / "kept.json")
    again = numbers.kept(tmp_path / "kept.json")
    assert json.dumps(again) == json.dumps(found)
    assert again["base"]["each"][1]["force"] == found["base"]["each"][1]["force"]
    assert tables.causes(again) == tables.causes(found)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    text = steady_cut.write(elsewhere, again)
    assert "2 cases of rockwear 0.0.0" in text and "| eight discs | 1 | 9 | 50" in text
    assert json.dumps(numbers.kept(elsewhere / "steady_cut.json")) == json.dumps(found)
    # Its own runs come first.
    write_run(elsewhere / "cut/eight_discs-2")
    assert "1 cases of rockwear 0.0.0" in steady_cut.write(elsewhere, again)
    assert numbers.kept(elsewhere / "steady_cut.json")["eight discs"]["each"].keys() == {2}


def test_cuts_are_judged_at_their_own_depth_and_strength(tmp_path):
    for case in ("base", "eight_discs__depth_20_mm"):
        write_run(tmp_path / f"cut/{case}-1")
    for rock in ("base", "eight_discs__depth_20_mm"):
        write(tmp_path / f"lab/{rock}-compression-1", {"peak_stress": 50e6})
    assert not tables.envelope({"base": numbers.of_case(tmp_path, "base")})
    write(tmp_path / "lab/base-tension-1", {"tensile_strength": 4e6})
    found = {case: numbers.of_case(tmp_path, case) for case in ("base", "eight discs, depth 20 mm")}
    judged = {tuple(row[:2]): row[2:] for row in tables.envelope(found)}
    # 30 kN/m at a UCS of 50 MPa.
    assert judged["base", "mean cutting force"][::3] == ["66 to 144 kN/m", "below"]
    assert judged["base", "specific energy"][::3] == ["5 to 20 MJ/m³", "inside"]
    assert ("eight discs, depth 20 mm", "mean cutting force") not in judged
    assert not any("abreast" in case for case, _ in judged)
    found["base"]["abreast"] = Measured(3.0, 0.2)
    more = tables.envelope(found)
    assert [row[5] for row in more if row[0] == "base, packings abreast"] == ["inside", "inside"]
    assert judged["eight discs, depth 20 mm", "overbreak"][3] == "inside"


def test_what_cuts_tell_together():
    def row(force, error, thrust=40.0):
        return {"force": Measured(force, error), "pressed": Measured(thrust, 3.0), "ucs": Measured(50.0, 2.0)}
    found = {"base": row(90.0, 4.0), "wear flat 2 mm": row(40.0, math.nan, 70.0), "eight discs": row(40.0, 4.0),
             **{f"eight discs, {name}": one for name, one in {
                 "depth 1.2 mm": row(40.0 * 0.25**0.8, 2.0), "depth 0.31 mm": row(40.0 * 0.25**1.8, 1.0),
                 "rake 15°": row(40.0 - 0.6 * 20, 4.0),
                 "rake -15°": row(40.0 + 0.6 * 10, 4.0), "wear flat 1 mm": row(60.0, 4.0, 80.0)}.items()}}
    rows = {(case, words.split(", over")[0]): (ours, verdict)
            for case, words, _, _, ours, verdict in tables.relations(found)}
    assert ("eight discs", "change of the mean cutting force per rad of rake") not in rows
    # Another rock's cuts do not count.
    assert rows["eight discs", "mean cutting force over depth, 1 to 20 mm, UCS 48 MPa"] == ("0.8 ± 0.13", "inside")
    assert rows["eight discs", "mean cutting force over depth, scratch"] == ("1 ± 0.24", "inside")
    assert ("base", "mean cutting force over depth, scratch") not in rows
    # 40 kN/m more over 50 MPa times 1 mm; half as much in the cutting force.
    assert rows["eight discs, wear flat 1 mm", "thrust that a wear flat of 1 or 2 mm adds"] == ("0.8 ± 0.085", "inside")
    assert rows["eight discs, wear flat 1 mm", "cutting force that a wear flat adds"] == ("0.5 ± 0.15", "inside")
    assert not tables.relations({"eight discs, depth 20 mm": row(80.0, 8.0)})
    found["eight discs, depth 20 mm"] = row(500.0, math.nan)
    assert {case: ours for case, words, _, _, ours, _ in tables.relations(found) if "20 mm" in words} == {
        "eight discs": "0.8 ± 0.13"}


def test_what_the_rake_changes_is_told_packing_by_packing():
    """-0.5, -0.6 and -0.7 kN/m per degree in packings that differ by more than that."""
    found = {case: {"each": {seed: {"force": Measured(10.0 * seed - 0.1 * (seed + 4) * rake, 4.0)}
                             for seed in seeds}, "force": Measured(30.0, 4.0)}
             for case, rake, seeds in (("eight discs", -5, (1, 2, 3)), ("eight discs, rake 15°", 15, (1, 2, 3, 4)),
                                       ("eight discs, rake -15°", -15, (1, 2, 3)), ("eight discs, no grains", 0, (1,)))}
    slope = numbers.force_over(found, "eight discs", "rake")
    assert slope == pytest.approx((-0.6, 0.1 / math.sqrt(3)))
    (case, _, _, _, ours, verdict), = tables.relations({name: {**row, "ucs": Measured(50.0, 2.0)}
                                                        for name, row in found.items()})
    assert case == "eight discs" and ours.startswith("-3.44e+04 ±") and verdict == "inside"
    del found["eight discs, rake 15°"]["each"][2]
    assert math.isnan(numbers.force_over(found, "eight discs", "rake").value)
    assert math.isnan(numbers.force_over(found, "base", "rake").value)


def of_packings(**values):
    """A row of made-up packings: {quantity: its value in each}."""
    each = {seed: {name: Measured(one[k], 5.0) for name, one in values.items()}
            for k, seed in enumerate(cases.SEEDS)}
    return {"each": each, **{name: numbers.over_packings([row[name] for row in each.values()]) for name in values}}


def test_a_cause_is_judged_by_what_it_changes_in_each_packing():
    """Packings differ by far more than the cause, which adds 3, 4 and 5 kN/m to the force and nothing to the rest."""
    same = {what: [1.0, 2.0, 3.0] for what in tables.CHANGED.values()}
    found = {"eight discs": of_packings(**{**same, "force": [10.0, 40.0, 90.0]}),
             "eight discs, rake 15°": of_packings(**{**same, "force": [14.0, 43.0, 95.0]})}
    assert numbers.difference(found["eight discs, rake 15°"], found["eight discs"], "force") == (
        pytest.approx(4.0), pytest.approx(3**-0.5))
    row, = tables.changes(found)
    assert row[:3] == ["eight discs, rake 15°", 3, "4 ± 0.58 (+9 %)"] and row[-1] == "mean Fc, kN/m"
    # Of fewer packings nothing is told.
    del found["eight discs"]["each"][1]
    row, = tables.changes(found)
    assert row[1] == 2 and row[-1] == "–"


def test_a_cut_has_to_be_as_long_as_its_packings_or_its_record_ask():
    """Packings of 30, 40, 50 kN/m scatter by 25 %, records say 5 of 40: for 10 % six times the nine depths of each."""
    row = {**of_packings(force=[30.0, 40.0, 50.0]), "way": 27, "cost": 100.0}
    base = {**of_packings(force=[40.0] * 3), "way": 27, "cost": 200.0}
    assert tables.lengths_needed({"eight discs": row, "base": base}) == [
        ["base", "9", "0 %", "12 %", "14", "14"], ["eight discs", "9", "25 %", "12 %", "56", "28"]]


@pytest.mark.parametrize("case, other", [
    ("eight discs, rake 15°", "eight discs"), ("eight discs, no grains", "eight discs"), ("wear flat 2 mm", "base"),
    ("eight discs, window 1.5 times as long", "eight discs"), ("window 4 depths high", "base"),
    ("eight discs, window 4 depths high", "eight discs"),
    ("eight discs, tip 0.2 mm, rake 15°", "eight discs, tip 0.2 mm"),
    ("eight discs, fracture energy 30", "eight discs"),
    ("eight discs, depth 1.2 mm, wear flat 1 mm", "eight discs, depth 1.2 mm"), ("base", None), ("eight discs", None),
    ("eight discs, depth 20 mm", None)])
def test_each_case_differs_in_one_cause_from_one_other(case, other):
    assert case in cases.CASES and cases.changed_from(case) == other


def test_a_case_is_told_by_the_row_of_more_packings_and_costs_what_the_last_runs_did():
    few, many = ({"packings": packings, "cost": cost} for packings, cost in ((1, 20.0), (3, 50.0)))
    assert steady_cut.with_more_packings(few, many) == {"packings": 3, "cost": 20.0}
    assert steady_cut.with_more_packings(many, few) is many and steady_cut.with_more_packings(few, None) is few
    assert steady_cut.with_more_packings(None, many) is many


def test_theories_stand_beside_cuts_of_other_rocks_depths_and_rakes():
    row = {"ucs": Measured(40.0, 2.0), "tensile_strength": Measured(4.0, math.nan),
           "peak": Measured(200.0, 10.0), "thrust": Measured(0.9, 0.1)}
    names = "eight discs", "eight discs, rake 15°", "eight discs, rake -15°", "eight discs, wear flat 1 mm"
    found = tables.theories({name: row for name in names})
    assert [line[0] for line in found] == [*names[:3]]
    # A wedge of 90 + 5 degrees: 2 * 4 MPa * 5 mm * sin(47.5) / (1 - sin(47.5)); friction of 0.3 on a rake of -5.
    assert found[0][1:3] == ["200 ± 10", "112"] and found[0][5] == f"{math.tan(math.atan(0.3) + math.radians(5)):.3g}"
    assert float(found[1][2]) < float(found[0][2]) < float(found[2][2])
    # Nishimatsu's plane needs less friction than this rock and so blunt a tool have: 16.7 + 54.9 + 15 degrees are less.
    assert float(found[2][3]) > float(found[0][3])


def test_the_figure_over_the_discs_has_what_is_there():
    row = {name: Measured(value, error) for name, value, error in (
        ("energy", 0.12, 0.02), ("peaks", 5.0, math.nan), ("overbreak", 0.5, 0.1), ("thrust", 0.7, 0.1))}
    found = {"base": {**row, "cost": 120.0}, "eight discs": {**row, "energy": Measured(0.1, 0.03), "cost": 20.0}}
    energy, *others = figures.resolution(found).axes
    points = energy.lines[0].get_xydata()
    assert points.tolist() == [[8, 0.1], [16, 0.12]] and len(others) == 3
    assert [one.get_text() for one in energy.get_xticklabels()] == ["8 discs\n20 min/m", "16 discs\n120 min/m"]


def test_the_figure_over_the_depth_has_cuts_that_differ_in_size_alone():
    row = {name: Measured(0.1, 0.02) for name in ("energy", "peaks", "overbreak", "thrust")}
    found = {"base": row, "eight discs, bentheim": row,
             **{case: {**row, "energy": Measured(0.1 * k, 0.02)} for k, case in enumerate(cases.AT_DEPTHS)}}
    energy = figures.over_depth(found).axes[0]
    points = next(line for line in energy.lines if line.get_marker() == "o").get_xydata()
    assert points == pytest.approx(np.array([[0.3125, 0.0], [1.25, 0.1], [5.0, 0.2], [20.0, 0.3]]))


def test_a_cut_of_another_size_is_of_a_rock_that_is_crushed_in_its_own_discs():
    case = cases.depth_case(1.25e-3)
    cut, lab = cases.cut_of(case, 1), cases.test_of(case, "compression", 1)
    assert cut["cut_length"] == pytest.approx(0.015) and cut["tip_radius"] == pytest.approx(1.25e-4)
    assert lab["radius_max"] == pytest.approx(0.6 * 1.25e-3 / 8) and lab["width"] == pytest.approx(0.01)
    assert not cases.OF_THE_CUT - {"snapshot_period"} & set(lab)


def a_setting(force, friction, temperature, cost):
    """A row with three packings that are alike, of 40 depths each, each of which knows its force to 20 %."""
    values = {"force": force, "friction": friction, "temperature": temperature}
    each = {name: Measured(value, 0.2 * value) for name, value in values.items()}
    means = {name: Measured(value, 0.0) for name, value in values.items()}
    return {"each": dict.fromkeys((1, 2, 3), each), **means, "cost": cost, "way": 120.0}


SETTINGS = {"base": a_setting(40.0, 4.0, 100.0, 200.0), "eight discs": a_setting(30.0, 4.0, 110.0, 20.0),
            "eight discs, window 8 depths high": a_setting(36.0, 2.0, 105.0, 40.0),
            "eight discs, rake 15°": a_setting(40.0, 4.0, 100.0, 1.0)}


def test_settings_are_compared_with_sixteen_discs_over_what_they_cost():
    for axes, at in zip(figures.price(SETTINGS).axes, (0.75, 1.0, 1.1)):
        points = [tuple(line.get_xydata()[0]) for line in axes.lines if line.get_marker() == "o"]
        assert points[:2] == [(200.0, 1.0), (20.0, pytest.approx(at))] and len(points) == 3


def test_settings_to_choose_from_say_what_they_move_and_cost():
    base, eight, high = tables.settings(SETTINGS)
    assert base["options"] == {"discs_per_depth": 16, "velocity": 8.0, "time_step_fraction": 0.9}
    assert set(base["errors"].values()) == {0.0}
    assert eight["options"]["discs_per_depth"] == 8 and eight["minutes_per_depth"] == pytest.approx(0.1)
    assert eight["errors"] == pytest.approx({"specific_energy": 0.25, "wear": 0.0, "temperature": 0.1})
    assert eight["depths_for_tenth"] == pytest.approx(160) and high["lengths"] == {"window_height": 8.0}
    cold = tables.settings({**SETTINGS, "eight discs": a_setting(30.0, 4.0, math.nan, 20.0)})[1]
    assert cold["errors"]["temperature"] is None


def test_a_setting_that_is_not_told_apart_from_another_has_the_larger_error_of_both():
    def scattered(*forces):
        each = {seed: {"force": Measured(force, 0.1), **{name: Measured(4.0, 0.1) for name in ("friction",
                "temperature")}} for seed, force in enumerate(forces, 1)}
        return {**a_setting(sum(forces) / 3, 4.0, 4.0, 20.0), "each": each}

    base, eight = scattered(40.0, 41.0, 39.0), scattered(30.0, 31.0, 29.0)
    for forces, same in (((41.0, 30.0, 42.0), True), ((38.0, 39.0, 37.0), False)):
        found = {"base": base, "eight discs": eight, "eight discs, window 8 depths high": scattered(*forces)}
        _, other, high = (row["errors"]["specific_energy"] for row in tables.settings(found))
        assert other > 0.24 and (high == other) == same, forces


@pytest.mark.parametrize("accuracy, of, setting, off, depths", [
    (0.5, "specific_energy", "eight discs", 0.25, 30),
    (0.25, "specific_energy", "eight discs, window 8 depths high", 0.1, 46), (0.2, "wear", "eight discs", 0.0, 60),
    (0.08, "temperature", "eight discs, window 8 depths high", 0.05, 616), (0.04, "temperature", "base", 0.0, 1500),
    (0.9, "wear", "eight discs", 0.0, 30)])
def test_the_cheapest_setting_that_is_accurate_enough_is_chosen(accuracy, of, setting, off, depths):
    row, found, moved, of_length = settings.choose(tables.settings(SETTINGS), accuracy=accuracy, quantities=[of])
    assert (row["setting"], found) == (setting, depths) and moved == pytest.approx(off)
    assert math.hypot(moved, of_length) == pytest.approx(accuracy)


def test_an_accuracy_that_no_setting_has_is_refused():
    with pytest.raises(ParameterError, match="^accuracy = 0.05: must be above 0.1, which the best"):
        settings.choose(tables.settings(SETTINGS)[1:2], accuracy=0.05, quantities=["temperature"])


def test_the_command_of_a_setting_has_its_lengths_over_the_depth():
    row = tables.settings(SETTINGS)[2]
    command, words = settings.shown(row, 40, 0.1, 0.2, depth=2e-3, quantities=settings.QUANTITIES[:2])
    assert command.endswith("--depth_of_cut 0.002 --tip_radius 0.0002 --discs_per_depth 8 --velocity 8 "
                            "--time_step_fraction 0.9 --window_height 0.016 --accuracy 0.2 --cut_length 0.16")
    assert ("off by 10 % beside sixteen discs at the same speed, by 20 % for its length, some 40 depths of cut; "
            "8 minutes" in words)


@pytest.mark.parametrize("words, said", [
    ([], ""), (["--of", "temperature", "--accuracy", "0.05"], ""), (["--accuracy", "0"], "accuracy = 0"),
    (["--of", "wear,colour"], "of = wear,colour"),
    (["--depth_of_cut", "-1"], "depth_of_cut = -1"), (["--depth_of_cut", "1e-5"], "depth_of_cut = 1e-05 m")])
def test_settings_on_the_command_line(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(settings, "MEASURED", tmp_path / "settings.json")
    settings.MEASURED.write_text(json.dumps(tables.settings(SETTINGS)), encoding="utf-8")
    assert settings.main(words) == (2 if said else 0)
    out, error = capsys.readouterr()
    assert error.startswith(f"error: {said}") and error.count("\n") == 1 if said else "steady_cut.py" in out
    # A cut computes temperatures only where it is told to.
    assert ("--heat true" in out) == ("temperature" in words)


def test_the_settings_that_come_with_the_package_can_be_chosen_from():
    rows = json.loads(settings.MEASURED.read_text(encoding="utf-8"))
    assert settings.choose(rows, accuracy=0.5, quantities=settings.QUANTITIES[:2])


def write(folder, results, **entries):
    """A made-up summary."""
    folder.mkdir(parents=True)
    parameters = {"depth_of_cut": DEPTH, "cut_length": 0.06, "ramp_length": 5e-3, "tool_temperature": 300.0}
    summary = {"parameters": parameters, "versions": {"rockwear": "0.0.0"},
               "results": {name: {"value": value, "unit": ""} for name, value in results.items()}, **entries}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")


def write_run(folder):
    """A cut with constant forces after the slope, and others before."""
    energy = {"tool_work": 2.0, "bond_breaking": 1.0, "rock_crushing": 0.6, "residual": -0.1}
    write(folder, {}, balances={"energy": energy}, wall_time={"total": 120.0})
    distance = np.linspace(0, 0.06, 601)
    early = distance < numbers.BEGIN * DEPTH
    rows(folder / "history.csv", "distance cutting_force thrust_force tool_friction tool_temperature_max",
         distance, np.where(early, 1e6, FORCE), np.where(early, 1e6, THRUST), FRICTION * distance,
         300.0 + 1e3 * distance)
    rows(folder / "groove.csv", "x height", distance, np.where(early, -0.02, -2e-3))
    rows(folder / "cracks.csv", "energy mode", [0.15, 0.05, 0.8], [1, 1, 2])
    late = ~early[::50]
    rows(folder / "chips.csv", "distance particles area length", distance[::50], 10 + late, 1e-5 + late,
         np.where(late, 0.01, 0.05))


def rows(path, names, *columns):
    """A table of columns."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([[f"{name} [-]" for name in names.split()], *np.column_stack(columns).tolist()])


def test_grooves_are_drawn_to_one_scale_with_their_forces(tmp_path):
    runs = {}
    for name in ("shallow", "deep"):
        write_run(tmp_path / name)
        runs[name] = RunFolder(tmp_path / name)
    x, height = runs["deep"].table("groove.csv", "x", "height")
    rows(tmp_path / "deep/groove.csv", "x height", x, height - 4 * DEPTH)
    one, other = figures.grooves(runs).axes
    assert one.get_title(loc="left") == f"shallow: {1e-3 * FORCE:.1f} kN/m"
    assert one.get_ylim() == other.get_ylim() and one.get_ylim()[0] < 1e3 * (height - 4 * DEPTH).min()
    assert one.get_xlim() == other.get_xlim() == (0, 1e3 * x[-1])

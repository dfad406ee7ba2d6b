"""The fitting command on the four published tests and on other tests, as a user runs it."""
import json

import numpy as np
import pytest

from calibration.fitting import wear_fit
from calibration.fitting.wear_fit import EXAMPLE, fit, main, read
from rockwear.kernels.archard import BRINELL, MET91


def rows_of(found):
    return [k for one in found.values() for k, _ in one["rows"]]


def test_the_published_tests_with_the_published_unit_of_hardness_give_the_published_k():
    """[Rojek 2003] rounds a HB to 10 MPa, and its k to 1e-4; the results of eqs. 6.14 and 6.15 are interchanged."""
    found = rows_of(fit(read(EXAMPLE, 1e7), brinell=1e7))
    assert [round(k, 4) for k in found[:2]] == [0.0023, 0.0028]
    assert found[2] == pytest.approx(0.01125, rel=2e-3) and found[3] == pytest.approx(0.0113, rel=2e-3)


def test_the_published_tests_in_si_give_the_published_k_within_their_errors():
    found = fit(read(EXAMPLE))
    singles = [pair for one in found.values() for pair in one["rows"]]
    for (k, u), published in zip(singles, (0.0023, 0.0028, 0.0113, 0.01125)):
        assert abs(k - published) < u < 0.05 * k
    assert found["MET71"]["law"].k == pytest.approx(0.0025, abs=found["MET71"]["fit"].uncertainty[0])
    # The two tests of MET 71 differ by more than their errors; those of MET 91 agree.
    assert found["MET71"]["fit"].misfit > 4 > 1 > found["MET91"]["fit"].misfit


def test_all_linear_forms_give_one_k_and_the_power_law_its_own():
    rows = read(EXAMPLE)
    assert rows_of(fit(rows, law="dissipation", mu=0.42)) == pytest.approx(rows_of(fit(rows)), rel=1e-12)
    assert rows_of(fit(rows, law="power", mu=0.42, exponent=1.0)) == pytest.approx(rows_of(fit(rows)), rel=1e-12)
    square = fit(rows, law="power", exponent=2.0)["MET91"]
    tests = square["tests"]
    exact = tests.depth / tests.distance * (tests.hardness / tests.pressure)**2
    assert square["rows"][0][0] == pytest.approx(exact[0])


def test_errors_propagate_column_by_column(tmp_path):
    """3 % of force, 4 % of depth: 5 % of k; the temperature counts by the slope of H."""
    file = tmp_path / "mine.csv"
    file.write_text("steel,force [kN],area [cm2],distance [km],depth [um],temperature [K],force error [kN],"
                    "depth error [um]\nMET91,1,1,0.5,500,500,0.03,20\n", encoding="utf-8")
    (k, u), = fit(read(file))["MET91"]["rows"]
    assert k == pytest.approx(500e-6 * MET91(500.0) / (1e7 * 500), rel=1e-12)
    assert u / k == pytest.approx(0.05, rel=1e-12)
    file.write_text("steel,pressure [MPa],distance [m],depth [mm],temperature [degC],temperature error [K]\n"
                    "MET91,10,500,0.5,550,10\n", encoding="utf-8")
    (k, u), = fit(read(file))["MET91"]["rows"]
    slope = (375 - 247) / 100 * BRINELL
    assert u / k == pytest.approx(10 * slope / MET91(550 + 273.15), rel=1e-9)


def test_errors_count_as_often_as_their_quantity_stands_in_k(tmp_path):
    """k = (w / s) (H / p)^n, and with measured friction k = w H mu A / (s T), whatever the force."""
    file = tmp_path / "mine.csv"
    file.write_text("pressure [MPa],distance [m],depth [mm],hardness [MPa],pressure error [MPa],hardness error [MPa],"
                    "depth error [mm]\n10,500,0.5,5000,1,200,0.015\n", encoding="utf-8")
    for law, exponent in (("pressure", 1.0), ("dissipation", 1.0), ("power", 2.0)):
        (k, u), = fit(read(file), law=law, exponent=exponent)[""]["rows"]
        assert u / k == pytest.approx(np.hypot(0.03, exponent * np.hypot(0.1, 0.04)), rel=1e-12)
    file.write_text("force [N],friction [N],area [mm2],distance [m],depth [mm],hardness [MPa],force error [N],"
                    "friction error [N],area error [mm2]\n1000,300,30,500,0.5,5000,100,12,0.9\n", encoding="utf-8")
    (_, u), (k, v) = (fit(read(file), law=law)[""]["rows"][0] for law in ("pressure", "dissipation"))
    assert u / k == pytest.approx(np.hypot(0.1, 0.03), rel=1e-12)
    assert v / k == pytest.approx(np.hypot(0.04, 0.03), rel=1e-12)
    # A pressure that is measured by itself: the force counts with friction alone, whether the pressure has an error.
    file.write_text("pressure [MPa],force [N],friction [N],distance [m],depth [mm],hardness [MPa],force error [N],"
                    "friction error [N]\n33,1000,300,500,0.5,5000,100,12\n", encoding="utf-8")
    (_, u), (k, v) = (fit(read(file), law=law)[""]["rows"][0] for law in ("pressure", "dissipation"))
    assert np.isnan(u) and v / k == pytest.approx(np.hypot(0.04, 0.1), rel=1e-12)


def test_an_error_missing_in_a_row_is_said(tmp_path, capsys):
    file = tmp_path / "mine.csv"
    file.write_text("pressure [MPa],distance [m],depth [mm],hardness [MPa],depth error [mm]\n10,500,0.5,5000,0.01\n"
                    "10,500,0.6,5000,\n", encoding="utf-8")
    assert main([str(file)]) == 0 and "some tests state no error" in capsys.readouterr().out
    (_, stated), (_, none) = fit(read(file))[""]["rows"]
    assert stated > 0 and np.isnan(none)


def test_equal_rows_have_no_scatter_and_no_error(tmp_path, capsys):
    file, out = tmp_path / "mine.csv", tmp_path / "out"
    file.write_text("pressure [MPa],distance [m],depth [mm],hardness [MPa]\n" + 2 * "10,500,0.3,5000\n",
                    encoding="utf-8")
    assert main([str(file), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "the scatter of the tests is 0, and no error is known" in said and "+-" not in said
    stored = json.loads((out / "wear_fit.json").read_text(encoding="utf-8"))
    assert stored["steels"][""]["uncertainty"] == [None]


def test_tables_of_other_programs(tmp_path):
    """Empty lines before the header, semicolons or tabs between the cells."""
    file = tmp_path / "mine.csv"
    text = "pressure [MPa],distance [m],depth [mm],hardness [MPa]\n10,500,0.3,5000\n"
    for between in ",;\t":
        file.write_text("\n \n" + text.replace(",", between), encoding="utf-8")
        (k, _), = fit(read(file))[""]["rows"]
        assert k == pytest.approx(3e-4)


def test_own_steel_by_hardness_and_measured_friction(tmp_path):
    file = tmp_path / "mine.csv"
    lines = [f",{p},{p * 2.5 * 0.4},100,{1e3 * 4.0 * (p / 2000)**1.5 * 100},2000" for p in (5, 10, 20, 30)]
    file.write_text("\ufeffsteel,pressure [MPa],friction [N],distance [m],depth [mm],hardness [MPa],force [N]\n"
                    + "\n".join(f"{line},{p * 2.5}" for line, p in zip(lines, (5, 10, 20, 30))) + "\n",
                    encoding="utf-8")
    one = fit(read(file), law="power", mu=0.4, exponent=None)[""]
    assert one["law"].k == pytest.approx(4.0, rel=1e-9) and one["exponent"][0] == pytest.approx(1.5, rel=1e-9)


def test_command_line_leaves_numbers_and_a_figure(tmp_path, capsys):
    assert main([str(EXAMPLE), "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "MET71  all tests: k = 0.0025151" in said and "the tests differ by" in said
    stored = json.loads((tmp_path / "out/wear_fit.json").read_text(encoding="utf-8"))
    assert np.shape(stored["steels"]["MET91"]["k_of_each_test"]) == (2,)
    assert (tmp_path / "out/wear_fit.png").stat().st_size > 1e4


@pytest.mark.parametrize("law", ["pressure", "dissipation", "power"])
def test_the_figure_shows_the_law_through_tests_that_obey_it(law, tmp_path, monkeypatch):
    """Of two tests, the second with twice the load, depth and friction; friction is twice mu times the force."""
    file, panels = tmp_path / "tests.csv", []
    file.write_text("force [N],friction [N],area [mm2],distance [m],depth [mm],hardness [HB]\n1000,600,200,100,1,500\n"
                    "2000,1200,200,100,2,500\n", encoding="utf-8")
    canvas = wear_fit.plots.canvas
    monkeypatch.setattr(wear_fit.plots, "canvas", lambda *size: panels.append(canvas(*size)) or panels[0])
    wear_fit.draw(fit(read(file), law=law), tmp_path / "drawn.png")
    (_, (axes,)), = panels
    points, line = (np.array(one.get_xydata()) for one in axes.lines[::len(axes.lines) - 1])
    assert len(points) == 2 and np.interp(points[:, 0], *line.T) == pytest.approx(points[:, 1], rel=1e-9)
    assert axes.get_xlabel().startswith("pressure" if law == "pressure" else "friction stress")


@pytest.mark.parametrize("unit, said", [("mm", 0), ("m", 1)])
def test_a_k_above_1_is_said_to_be_one_of_wrong_units(tmp_path, capsys, unit, said):
    file = tmp_path / "tests.csv"
    file.write_text(f"pressure [MPa],distance [m],depth [{unit}],hardness [HB]\n50,100,2,450\n", encoding="utf-8")
    assert main([str(file), "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.count("see whether the units") == said


@pytest.mark.parametrize("text, words", [
    ("", "a CSV file with a header"), ("steel,force [lb]\nMET71,1\n", "column force = lb: must be one of N, kN"),
    ("colour [m]\n1\n", "column colour"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K]\nMET71,x,1,1,400\n",
     "pressure in line 2 = x Pa: must be a number"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K]\nMET71,1e6,1,1,1400\n",
     "temperature in line 2 = 1400 K"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K]\nX12,1e6,1,1,400\n", "steel in line 2 = X12"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K]\nMET71,1e6,1,-1,400\n",
     "depth in line 2 = -1 mm: must be greater than 0"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K]\n\nMET71,1e6,0,1,400\n",
     "distance in line 3 = 0 m: must be greater than 0"),
    ("pressure [Pa],distance [m],depth [mm],depth [um],hardness [Pa]\n1e6,1,1,1,5e9\n",
     "column depth = 2: must be there"),
    ("\n\npressure [Pa];distance [m];depth [mm];hardness [Pa]\n1e6;1;1;5e9;3\n",
     "line 4 = 5 cells: must be as long as the header, 4"),
    ("force [N],force [N],area [m2],distance [m],depth [mm],hardness [Pa]\n885,1,1,1,1,5e9\n", "column force = 2"),
    ("steel,pressure [Pa],distance [m],depth [mm],temperature [K],depth error [mm]\nMET71,1e6,1,1,400,-0.1\n",
     "depth error in line 2 = -0.1 mm: must be at least 0"),
    ("steel,force [N],distance [m],depth [mm],temperature [K]\nMET71,1e6,1,1,400\n", "area = nothing"),
    ("pressure [Pa],distance [m],depth [mm],hardness [Pa],force error [N]\n1e6,1,1,5e9,3\n",
     "force error = 3 N: must be given with force"),
    ("pressure [Pa],force [N],distance [m],depth [mm],hardness [Pa]\n1e6,0,1,1,5e9\n",
     "force in line 2 = 0 N: must be greater than 0"),
    ("steel,pressure [Pa],depth [mm],temperature [K]\nMET71,1e6,1,400\n", "distance = nothing"),
    ("force [kN],area [mm2],distance [m],depth [mm],hardness [MPa]\n0.885,26,100,1.6,5000\n885,26,100,1.6,5000\n",
     "force / area in line 3 = 3.40385e+10 Pa: must be less than the hardness, 5e+09, where steel would flow"),
    ("steel,pressure [MPa],distance [m],depth [mm],temperature [degC]\nMET71,34e3,100,1.6,156\n",
     "pressure in line 2 = 3.4e+10 Pa: must be less than the hardness")])
def test_bad_files_end_in_one_line(tmp_path, capsys, text, words):
    file = tmp_path / "bad.csv"
    file.write_text(text, encoding="utf-8")
    assert main([str(file)]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ") and words in said and said.count("\n") == 1


@pytest.mark.parametrize("option, words", [
    (["--exponent", "2"], "exponent = 2: must be left out with wear_law = pressure"),
    (["--exponent", "fit"], "exponent = fit: must be left out with wear_law = pressure"),
    (["--modes", "1/1/1"], "modes = 1/1/1: must be left out with wear_law = pressure")])
def test_options_of_another_law_are_refused(capsys, option, words):
    assert main(option) == 2 and words in capsys.readouterr().err


def test_an_exponent_that_cannot_be_is_said_to_be_fitted(tmp_path, capsys):
    file = tmp_path / "odd.csv"
    file.write_text("pressure [MPa],distance [m],depth [mm],hardness [Pa]\n" + "".join(
        f"{p},100,{w},5e9\n" for p, w in ((1, 3), (2, 2), (4, 1))), encoding="utf-8")
    assert main([str(file), "--wear_law", "power", "--exponent", "fit"]) == 2
    assert "fitted exponent = -0.79" in capsys.readouterr().err


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("force, depth, law", [
    ("1e-20", 1, "power --exponent 20"), ("885", "1e300", "power --exponent 20"),
    ("1e-300", 1, "modes --modes 1/1/0.5,1/2/0.5"), ("1e-300", 1, "pressure"),
    ("885", "1e-320", "power --exponent fit")])
def test_values_out_of_the_range_of_numbers_end_in_one_line(tmp_path, capsys, force, depth, law):
    file = tmp_path / "far.csv"
    file.write_text("force [N],area [mm2],distance [m],depth [mm],hardness [Pa]\n" + "".join(
        f"{f},26,100,{w},5e9\n" for f, w in ((force, depth), (1000, 2), (2000, 4))), encoding="utf-8")
    assert main([str(file), "--wear_law", *law.split()]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: tests = 3: must be in the range of numbers: ") and said.count("\n") == 1


def test_a_file_that_is_not_there(capsys):
    assert main(["nowhere.csv"]) == 2 and "nowhere.csv" in capsys.readouterr().err


def test_documented_columns_are_those_that_are_read():
    for name in wear_fit.UNITS:
        assert name in wear_fit.__doc__

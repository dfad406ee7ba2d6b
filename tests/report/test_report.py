"""The report page, from made-up run folders: whole and odd ones."""
import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rockwear import report
from rockwear.kernels.boundary import prism
from rockwear.kernels.polygon import contour, perimeter
from rockwear.report import page, shapes
from rockwear.report.folder import RunFolder, read_history
from tests.report.made_up import lattice, make_run

ROOT = Path(__file__).parents[2]


def read_page(folder):
    """The page of a run, written anew, without its pictures; what it shows must be inside it."""
    text = report.write(folder).read_text(encoding="utf-8")
    assert re.findall(r'<img src="(?!data:image/(?:png|gif);base64,[A-Za-z0-9+/=]+")', text) == []
    text = re.sub(r"base64,[A-Za-z0-9+/=]+", "", text)
    assert not re.search(r"https?:|<script|<link|url\(|@import", text)
    return text


def figures(folder):
    return {path.name for path in (folder / "figures").iterdir()}


def test_a_whole_run(tmp_path):
    text = read_page(make_run(tmp_path / "run"))
    assert figures(tmp_path / "run") == {"set_up.png", "cut.png", "cut.gif", "history.png", "temperature.png",
                                         "wear.png", "shape.png", "energy.png"}
    assert text.count("<img") == 8
    for shown in (">1000.0<", ">1 kN/m<", "0.0123456789", "1.2 %", "76.9 °C", "50 ns", "50.0 % of the critical",
                  "1 min 23 s", "10.0 % of the loop", "300 MB", ">7000<", "2023.02a", "test &lt;tooth&gt;", "finished",
                  "cycle 1"):
        assert shown in text, shown
    assert re.search(r"<tr><td>residual</td><td[^>]*>4</td><td[^>]*>1.0 %</td>", text)


def test_without_heat_there_is_no_temperature(tmp_path):
    text = read_page(make_run(tmp_path / "run", heat=False))
    assert "temperature.png" not in figures(tmp_path / "run")
    assert "<h2>Temperature</h2>" not in text and "hottest tool</span>" not in text


@pytest.mark.parametrize("odd", [{"broken": 0, "value": 0.0}, {"snapshots": 1, "rows": 1}, {"rows": 0},
                                 {"alive": False}, {"value": math.nan}, {"value": math.inf}],
                         ids=lambda odd: " ".join(f"{k} {v}" for k, v in odd.items()))
def test_odd_runs_have_a_page(tmp_path, odd):
    page = read_page(make_run(tmp_path / "run", **odd))
    assert "Key results" in page and ">nan<" not in page


def test_no_numbers_in_the_arrays(tmp_path):
    folder = make_run(tmp_path / "run")
    for path in (folder / "snapshots").iterdir():
        arrays = dict(np.load(path))
        for name in ("rock_positions", "temperature", "worn_depth"):
            arrays[name][:3] = math.nan
        np.savez(path, **arrays)
    assert "Key results" in read_page(folder)


@pytest.mark.parametrize("missing", ["history.csv", "model.npz", "snapshots"])
def test_a_missing_file_costs_only_its_own_figures(tmp_path, missing):
    folder = make_run(tmp_path / "run")
    (folder / missing).rename(tmp_path / missing)
    text = read_page(folder)
    assert "0.0123456789" in text and "energy.png" in figures(folder)
    assert ("history.png" in figures(folder)) == (missing != "history.csv")


def test_history_with_a_line_cut_short(tmp_path):
    path = tmp_path / "history.csv"
    path.write_text("time [s],force [N/m]\n0,1\n1,nan\n2", encoding="utf-8")
    columns, units = read_history(path)
    np.testing.assert_array_equal(columns["force"], [1, math.nan])
    assert units == {"time": "s", "force": "N/m"}


def test_the_snapshot_after_the_end_is_not_shown_twice(tmp_path):
    folder = make_run(tmp_path / "run")
    last = dict(np.load(folder / "snapshots" / "0003.npz"))
    np.savez(folder / "snapshots" / "0004.npz", **{**last, "stage": 2})
    assert RunFolder(folder).stages.tolist() == [0, 0, 1, 1]


def test_from_the_command_line_without_yade(tmp_path):
    folder = make_run(tmp_path / "run", snapshots=1)
    code = ("import runpy, sys; sys.modules['yade'] = None; sys.argv[1:] = [{!r}]; "
            "runpy.run_module('rockwear.report', run_name='__main__')")
    done = subprocess.run([sys.executable, "-c", code.format(str(folder))], cwd=ROOT, capture_output=True,
                          encoding="utf-8")
    assert done.returncode == 0 and done.stdout.strip().endswith("report.html"), done.stderr
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken/summary.json").write_text("{", encoding="utf-8")
    for other in (tmp_path, tmp_path / "nowhere", tmp_path / "broken", folder / "summary.json"):
        done = subprocess.run([sys.executable, "-m", "rockwear.report", other], cwd=ROOT, capture_output=True,
                              encoding="utf-8")
        assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
        assert f"error: folder = {other}: must be that of a run that has ended" in done.stderr


@pytest.mark.parametrize("word, code, said", [("--help", 0, "report of a run"), ("--no-such", 2, "usage: ")])
def test_help_and_an_unknown_option_from_the_command_line(word, code, said):
    done = subprocess.run([sys.executable, "-m", "rockwear.report", word], cwd=ROOT, capture_output=True,
                          encoding="utf-8")
    assert done.returncode == code and said in (done.stderr if code else done.stdout)
    assert done.stderr.count("\n") == (1 if code else 0)


@pytest.mark.parametrize("value, unit, shown", [(12e3, "N/m", "12 kN/m"), (293.15, "K", "20 °C"), (2104, "-", "2104"),
                                                (1.5e6, "J/m3", "1.5 MJ/m³"), (math.nan, "s", "not known"),
                                                (3e-6, "m3/m", "3 mm³/mm"), (0, "J/m", "0 J/m"), (0.25, "s", "250 ms"),
                                                (2.5, "s", "2.5 s"), (100, "m", "100 m"), (2400, "N", "2.4 kN"),
                                                (math.inf, "m", "inf")])
def test_quantities(value, unit, shown):
    assert page.quantity(value, unit) == shown


@pytest.mark.parametrize("value, error, unit, shown", [
    (123.4e3, 5.67e3, "N/m", "123.4 ± 5.7 kN/m"), (216e3, 11.8e3, "N/m", "216 ± 12 kN/m"),
    (2.4, 0.27, "-", "2.40 ± 0.27"), (0.0051, 0.00021, "m", "5.10 ± 0.21 mm"), (2e3, math.nan, "N/m", "2 kN/m"),
    (2e3, 0.0, "N/m", "2 kN/m"), (math.nan, 1.0, "m", "not known"), (351.15, 5.0, "K", "78.0 ± 5.0 °C")])
def test_means_with_their_errors(value, error, unit, shown):
    assert page.with_error(value, error, unit) == shown


def test_section_of_a_drawn_out_polygon_is_the_polygon():
    polygon = np.array([[0, 0], [0.04, 0.01], [0.03, 0.05], [0, 0.03]])
    vertices, facets = prism(polygon, 0.02, 7e-3)
    cut = shapes.section(vertices, facets, 1e-9)
    assert np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1).sum() == pytest.approx(perimeter(polygon), rel=1e-9)
    rim = np.vstack([polygon, polygon[:1]])
    for a, b in zip(rim, rim[1:]):
        # Every side lies in it, its ends first and last.
        on = np.abs((cut - a) @ [a[1] - b[1], b[0] - a[0]]).max(axis=1) < 1e-12
        assert (cut[on] @ (b - a)).min() == pytest.approx(a @ (b - a))
        assert (cut[on] @ (b - a)).max() == pytest.approx(b @ (b - a))
    assert shapes.section(vertices, facets, 0.011).shape == (0, 2, 2)


def test_outline_of_a_block_of_discs():
    positions, radii = lattice(6, 8, 0.5e-3)
    loop, = shapes.outlines(positions, radii)
    (left, bottom), (right, top) = loop.min(axis=0), loop.max(axis=0)
    np.testing.assert_allclose([left, bottom, right, top], [0, 0, 6e-3, 8e-3], atol=2e-4)
    worn, = shapes.outlines(positions, radii, np.where(positions[:, 1] < 1e-3, 3e-4, 0.0))
    middle = abs(worn[:, 0] - 3e-3) < 1.1e-3
    assert worn[middle, 1].min() == pytest.approx(3e-4)


def test_outline_of_too_little_is_empty():
    for count in (0, 1, 2, 5):
        positions = np.column_stack([np.arange(count), np.zeros(count)])
        assert shapes.outlines(positions, np.full(count, 0.5)) == []


def test_contour_counts_from_the_lowest_point_up_the_front():
    points, arc = contour(np.array([[0, 1.0], [1, 0], [2, 1], [1, 2]])[::-1], 0.1)
    assert np.all(np.diff(arc) > 0) and abs(arc).min() == 0
    assert points[arc == 0].tolist() == [[1, 0]]
    assert np.all(points[(arc > 0) & (arc < 1.4), 0] > 1)


def test_distance_to_a_square():
    square = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    points = np.array([[1.0, 1], [3, 3], [1, -0.5], [0.123, 0.01]])
    np.testing.assert_allclose(shapes.distance_to(points, [np.repeat(square, 2, axis=0), square + 5]),
                               [1, math.sqrt(2), 0.5, 0.01], rtol=1e-12)
    assert np.isnan(shapes.distance_to(np.zeros((1, 2)), [])).all()


def test_chips_are_not_joined_to_the_fixed_rock():
    pairs = np.array([[0, 1], [1, 2], [3, 4]])
    fixed = np.array([True, False, False, False, False])
    assert shapes.chips(5, pairs, np.array([True, False, True]), fixed).tolist() == [False, False, True, True, True]
    assert shapes.chips(5, pairs, np.ones(3, bool), np.zeros(5, bool)).tolist() == [False, False, False, True, True]


def test_cracks_lie_across_their_bonds():
    positions, radii = np.array([[0.0, 0], [1.6, 0], [9, 0]]), np.array([1.0, 0.5, 1])
    segment, = shapes.cracks(positions, radii, np.array([[0, 1], [1, 2]]))
    np.testing.assert_allclose(np.sort(segment, axis=0), [[0.8, -0.5], [0.8, 0.5]])


def test_nothing_has_no_sign():
    assert page.number(-0.0) == "0" and page.quantity(-0.0, "J/m") == "0 J/m" and page.number(-2.5e-3) == "-0.0025"

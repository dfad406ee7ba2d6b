"""The report page, from made-up run folders: whole and odd ones."""
import json
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

ROOT = Path(__file__).parents[2]
HEADER = ["time [s]", "stage [-]", "cutting_force [N/m]", "thrust_force [N/m]", "tool_work [J/m]",
          "kinetic_energy [J/m]", "tool_friction [J/m]", "bond_breaking [J/m]", "mass_lost [-]", "worn_volume [m3/m]",
          "tensile_cracks [-]", "shear_cracks [-]"]
HOT = ["tool_temperature_max [K]", "rock_temperature_max [K]"]


def lattice(columns, rows, radius):
    """Discs on a square lattice from the origin: positions and radii."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel()]) * 2 * radius + radius, np.full(columns * rows, radius)


def neighbours(positions, radius):
    """Pairs of touching discs."""
    distance = np.linalg.norm(positions[:, None] - positions, axis=2)
    return np.argwhere(np.triu(distance < 2.01 * radius, 1))


def make_run(folder, *, heat=True, snapshots=4, rows=30, broken=3, alive=True, value=1.0):
    """A run of start-up and one cycle in `folder`. value: the cutting force in kN/m, wherever it is written."""
    rock, rock_radii = lattice(10, 10, 1e-3)
    tool, tool_radii = lattice(6, 8, 0.5e-3)
    bonds = neighbours(rock, 1e-3)
    (folder / "snapshots").mkdir(parents=True)
    np.savez(folder / "model.npz", rock_radii=rock_radii, rock_fixed=rock[:, 1] < 2e-3, bonds=bonds,
             tool_radii=tool_radii, tool_positions=tool, tool_volumes=np.full(len(tool), 1e-6),
             outline=np.array([[0, 0], [6e-3, 0], [6e-3, 8e-3], [0, 8e-3]]), box=np.array([0.02, 0.02]))
    for k in range(snapshots):
        status = np.zeros(len(bonds), np.int8)
        status[:k * broken] = 1
        left = np.full(len(tool), alive)
        left[5:5 + k] = False
        temperature = np.linspace(293, 293 + 10 * k, len(rock) + len(tool)) if heat else np.empty(0)
        np.savez(folder / "snapshots" / f"{k:04d}.npz", time=1e-3 * k, stage=k // 2, rock_positions=rock,
                 broken_bonds=np.bincount(bonds[status != 0].ravel(), minlength=len(rock)), status=status,
                 temperature=temperature, tool_offset=np.array([-0.006 + 1e-3 * k, 0.017]), alive=left,
                 worn_depth=np.where(left & (tool[:, 1] < 1e-3), 1e-4 * k, 0.0), surface=np.flatnonzero(tool[:, 1] < 1e-3))
    write_history(folder, HEADER + (HOT if heat else []), rows, value)
    write_summary(folder, heat, value)
    return folder


def write_history(folder, header, rows, value):
    time = np.linspace(0, 4e-3, rows)
    waves = [value * 1e3 * (1.1 + np.sin(1e3 * time + k)) for k in range(len(header) - 2)]
    table = np.column_stack([time, time > 2e-3, *waves])
    lines = [",".join(header)] + [",".join(f"{x:.10g}" for x in row) for row in table]
    (folder / "history.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_summary(folder, heat, value):
    numbers = {"mean_cutting_force": (value * 1e3, "N/m"), "mass_lost": (0.0123456789, "-"), "time_step": (5e-8, "s"),
               "critical_time_step": (1e-7, "s"), "rock_particles": (100, "-"), "tensile_cracks": (3, "-")}
    balances = {"energy": {"unit": "J/m", "tool_work": 200.0 * value, "rock_friction": 150.0, "residual": 50.0},
             "mass": {"unit": "kg/m", "archard": 0.0, "removed": 0.0}}
    if heat:
        numbers["tool_temperature_max"] = (350.0, "K")
        balances["heat"] = {"unit": "J/m", "generated": 400.0, "residual": 4.0}
    (folder / "summary.json").write_text(json.dumps({
        "scene": "test_<tooth>", "ended": "finished", "seed": 1, "versions": {"yade": "2023.02a"},
        "parameters": {"velocity": 4.0, "depth_of_cut": 3e-3, "wear_acceleration": 7000.0, "outline": ""},
        "results": {name: {"value": number, "unit": unit} for name, (number, unit) in numbers.items()}, "balances": balances,
        "wall_time": {"unit": "s", "total": 83.0, "loop": 80.0, "python_engines": 8.0,
                      "by_engine": {"wear": {"seconds": 8.0, "visits": 12}}},
        "peak_memory": {"value": 3e8, "unit": "bytes"}}), encoding="utf-8")


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
    assert "Key results" in read_page(make_run(tmp_path / "run", **odd))


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
    done = subprocess.run([sys.executable, "-c", code.format(str(folder))], cwd=ROOT, capture_output=True, encoding="utf-8")
    assert done.returncode == 0 and done.stdout.strip().endswith("report.html"), done.stderr
    done = subprocess.run([sys.executable, "-m", "rockwear.report", tmp_path], cwd=ROOT, capture_output=True, encoding="utf-8")
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "summary.json" in done.stderr


@pytest.mark.parametrize("value, unit, shown", [(12e3, "N/m", "12 kN/m"), (293.15, "K", "20 °C"), (2104, "-", "2104"),
                                                (1.5e6, "J/m3", "1.5 MJ/m³"), (math.nan, "s", "not known"),
                                                (3e-6, "m3/m", "3 mm³/mm"), (0, "J/m", "0 J/m")])
def test_quantities(value, unit, shown):
    assert page.quantity(value, unit) == shown


def test_section_of_a_drawn_out_polygon_is_the_polygon():
    polygon = np.array([[0, 0], [0.04, 0.01], [0.03, 0.05], [0, 0.03]])
    vertices, facets = prism(polygon, 0.02, 7e-3)
    cut = shapes.section(vertices, facets, 1e-9)
    assert np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1).sum() == pytest.approx(perimeter(polygon), rel=1e-9)
    rim = np.vstack([polygon, polygon[:1]])
    for a, b in zip(rim, rim[1:]):
        # Every side lies in it, its ends first and last.
        on = np.abs((cut - a) @ [a[1] - b[1], b[0] - a[0]]).max(axis=1) < 1e-12
        assert (cut[on] @ (b - a)).min() == pytest.approx(a @ (b - a)) and (cut[on] @ (b - a)).max() == pytest.approx(b @ (b - a))
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
    np.testing.assert_allclose(shapes.distance_to(np.array([[1.0, 1], [3, 3], [1, -0.5]]), [square], 1e-3),
                               [1, math.sqrt(2), 0.5], atol=1e-3)
    assert np.isnan(shapes.distance_to(np.zeros((1, 2)), [], 1e-3)).all()


def test_chips_hang_on_the_support():
    pairs = np.array([[0, 1], [1, 2], [3, 4]])
    fixed = np.array([True, False, False, False, False])
    assert shapes.chips(5, pairs, np.array([True, False, True]), fixed).tolist() == [False, False, True, True, True]
    assert shapes.chips(5, pairs, np.ones(3, bool), np.zeros(5, bool)).tolist() == [False, False, False, True, True]


def test_cracks_lie_across_their_bonds():
    positions, radii = np.array([[0.0, 0], [1.6, 0], [9, 0]]), np.array([1.0, 0.5, 1])
    segment, = shapes.cracks(positions, radii, np.array([[0, 1], [1, 2]]))
    np.testing.assert_allclose(np.sort(segment, axis=0), [[0.8, -0.5], [0.8, 0.5]])

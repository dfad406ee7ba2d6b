"""Views of the page on combinations of parts: what a run has is shown, whatever scene it comes from."""
import json
import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest

from rockwear.kernels.boundary import prism, segments
from rockwear.report import bodies, instants, pages, plane, plots
from rockwear.report.folder import RunFolder
from rockwear.report.views import (
    balances, density, forces, granular, history, key_results, outlines, speeds, stages, temperature, trust,
    two_disc)
from tests.report.made_up import HEADER, HOT, lattice, make_run

ROOT = Path(__file__).parents[2]
OUTLINE = np.array([[0, 0], [6e-3, 0], [6e-3, 8e-3], [0, 8e-3]])
PARTICLES = {"tool_radii", "tool_positions", "tool_volumes", "alive", "worn_depth", "surface"}


def titles(run):
    """Titles of the sections that show something."""
    with matplotlib.rc_context(plots.STYLE):
        return [section.title for section in pages.sections(run) if section.html()]


def change(folder, model=lambda arrays: arrays, snapshot=lambda arrays, k: arrays):
    """Write arrays of a run anew."""
    np.savez(folder / "model.npz", **model(dict(np.load(folder / "model.npz"))))
    for k, path in enumerate(sorted((folder / "snapshots").iterdir())):
        np.savez(path, **snapshot(dict(np.load(path)), k))
    return folder


def parameters(folder, **values):
    """Change parameters in summary.json."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    summary["parameters"].update(values)
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")


def with_segments(folder, nodes=None):
    """Make the tool one of segments that recede by 0.1 mm a snapshot at the bottom; nodes (n, 2) m: thermal nodes."""
    vertices, facets = segments(OUTLINE)
    parameters(folder, reshape=True)

    def model(arrays):
        kept = {name: array for name, array in arrays.items() if name not in PARTICLES}
        heat = {} if nodes is None else {"thermal_positions": nodes}
        fixed = np.zeros(len(facets), bool)
        return {**kept, "tool_vertices": vertices, "tool_facets": facets, "tool_fixed": fixed, **heat}

    def snapshot(arrays, k):
        kept = {name: array for name, array in arrays.items() if name not in PARTICLES}
        now = vertices + np.array([0, 1e-4 * k]) * (vertices[:, 1] < 1e-6)[:, None]
        heat = {} if nodes is None else {
            "thermal_alive": np.arange(len(nodes)) >= k,
            "temperature": np.concatenate([np.full(100, 293.0), 300.0 + np.arange(len(nodes)) + k])}
        worn = np.full(len(facets), 1e-9 * k)
        return {**kept, "tool_vertices": now, "tool_facets": facets, "worn_volume": worn, **heat}

    return change(folder, model, snapshot)


def in_space(folder):
    """Make rock and tool of the same run spheres in one layer."""
    def spatial(points):
        return np.column_stack([points, np.zeros(len(points))])

    def model(arrays):
        arrays["block"] = np.array([*arrays.pop("box"), 2e-3])
        count = len(arrays["tool_radii"])
        return {**arrays, "tool_positions": spatial(arrays["tool_positions"]), "tool_fixed": np.zeros(count, bool)}

    return change(folder, model, lambda arrays, k: {**arrays, "rock_positions": spatial(arrays["rock_positions"])})


def test_a_cut_in_the_plane_has_its_sections_in_order(tmp_path):
    assert titles(RunFolder(make_run(tmp_path / "run"))) == [
        "Key results", "Stage by stage", "Set-up", "The cut", "History", "Temperature", "Wear of the tool",
        "Shape of the tool", "Balances", "All results", "How it was run"]


def test_heat_in_space_shows_temperature(tmp_path):
    run = RunFolder(in_space(make_run(tmp_path / "run")))
    shown = titles(run)
    assert {"The cut in perspective", "The cut from the side", "Temperature"} <= set(shown) and "Set-up" not in shown
    assert (run.path / "figures/temperature.png").exists()
    positions, radii, kelvin = bodies.tool_heat(run, run.snapshot(-1))
    alive = run.snapshot(-1)["alive"]
    assert positions.shape == (alive.sum(), 3)
    np.testing.assert_array_equal(kelvin, run.snapshot(-1)["temperature"][100:][alive])


def test_heat_behind_segments_shows_temperature(tmp_path):
    nodes, _ = lattice(6, 8, 0.5e-3)
    run = RunFolder(with_segments(make_run(tmp_path / "run"), nodes))
    assert {"Set-up", "The cut", "Temperature", "Wear along the tool", "Shape of the tool"} <= set(titles(run))
    positions, radii, kelvin = bodies.tool_heat(run, run.snapshot(3))
    np.testing.assert_array_equal(positions, nodes[3:])
    np.testing.assert_allclose(radii, 0.55e-3)
    np.testing.assert_array_equal(kelvin, 303.0 + np.arange(3, len(nodes)))
    assert "tool up to 76.9 °C" in temperature.hottest(run, run.snapshot(3))


def test_heat_of_a_tool_whose_nodes_are_not_written_shows_the_rock(tmp_path):
    run = RunFolder(with_segments(make_run(tmp_path / "run")))
    assert "thermal_positions" not in run.model and "Temperature" in titles(run)
    assert temperature.hottest(run, run.snapshot(3)).startswith("rock up to")
    assert "tool" not in temperature.hottest(run, run.snapshot(3))


def test_segments_without_heat_have_no_temperature(tmp_path):
    run = RunFolder(with_segments(make_run(tmp_path / "run", heat=False)))
    assert "Temperature" not in titles(run)
    assert not bodies.has_heat(run)


def test_worn_depth_of_segments_is_exact(tmp_path):
    run = RunFolder(with_segments(make_run(tmp_path / "run", heat=False)))
    bottom = np.array([[3e-3, 0.0], [3e-3, 8e-3]])
    np.testing.assert_allclose(bodies.gap(run, bottom, run.snapshot(3)), [3e-4, 0], atol=1e-12)
    np.testing.assert_allclose(bodies.gap(run, bottom), 0, atol=1e-12)
    profile = outlines.figure(run).axes[2]
    assert max(line.get_ydata().max() for line in profile.lines) == pytest.approx(0.3, rel=1e-6)


def test_a_density_map_is_shown_where_there_is_one(tmp_path):
    def with_density(arrays, k):
        return {**arrays, "density": np.linspace(1000 + k, 2500, len(arrays["rock_positions"]))}

    def specimen(arrays):
        return {name: array for name, array in arrays.items() if not name.startswith("tool") and name != "outline"}

    plane, space, alone = (make_run(tmp_path / name, heat=False) for name in ("plane", "space", "alone"))
    assert density.density(RunFolder(plane)) is None and density.density in pages.VIEWS
    in_space(space)
    for folder, model in ((plane, dict), (space, dict), (alone, specimen)):
        parameters(folder, control_radius=3.0, rock_density=2500.0)
        run = RunFolder(change(folder, model, with_density))
        assert "within 3 of its radii" in density.density(run).html()
        assert (folder / "figures/density.png").stat().st_size > 1e4
    shown = density.in_plane_figure(RunFolder(plane))
    colours = shown.axes[0].collections[0].get_array()
    np.testing.assert_allclose(colours, np.linspace(1000, 2500, 100) / 2500)
    assert [axes.get_title() for axes in density.in_plane_figure(RunFolder(alone)).axes[:2]] == ["0.00 ms", "3.00 ms"]


def test_volume_of_a_tool_however_it_is_made(tmp_path):
    particles = make_run(tmp_path / "particles")
    assert bodies.tool_volume(RunFolder(particles)) == pytest.approx(48e-6)
    assert bodies.tool_volume(RunFolder(with_segments(make_run(tmp_path / "segments")))) == pytest.approx(48e-6)
    change(particles, lambda arrays: {name: arrays[name] for name in arrays if name != "tool_volumes"})
    assert bodies.tool_volume(RunFolder(in_space(particles))) == pytest.approx(48e-9)


def test_depth_of_triangles_is_that_of_their_corners(tmp_path):
    vertices, facets = prism(OUTLINE, 4e-3, 2e-3)
    folder = in_space(make_run(tmp_path / "run", heat=False))
    parameters(folder, reshape=True)
    lower = np.where(vertices[:, 1:2] < 1e-6, [0, 2e-4, 0], 0.0)
    change(folder, lambda arrays: {**{name: arrays[name] for name in arrays if name not in PARTICLES},
                                   "tool_vertices": vertices, "tool_facets": facets},
           lambda arrays, k: {**{name: arrays[name] for name in arrays if name not in PARTICLES},
                              "tool_vertices": vertices + k * lower, "tool_facets": facets,
                              "worn_volume": np.zeros(len(facets))})
    run = RunFolder(folder)
    x, y, z = vertices.T
    # Those on the rim slide along the new sides.
    inner = (y < 1e-6) & (x > 1e-6) & (x < 6e-3 - 1e-6) & (abs(z) < 2e-3 - 1e-6)
    assert inner.sum() == 3
    np.testing.assert_allclose(bodies.facet_depth(run, run.snapshot(1)), 2e-4 * inner[facets].mean(axis=1), atol=1e-12)


def test_a_stage_without_working_time_has_no_mean_force(tmp_path):
    folder = make_run(tmp_path / "run")
    lines = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
    end = next(line for line in reversed(lines) if not float(line.split(",")[1])).split(",")[0]
    rows = [lines[0] + ",working_time [s]"] + [
        f"{line},{end if float(line.split(',')[1]) else line.split(',')[0]}" for line in lines[1:]]
    (folder / "history.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    run = RunFolder(folder)
    assert np.isnan(stages.mean_at_work(run, "cutting_force", 1)) and stages.mean_at_work(run, "cutting_force", 0) > 0
    assert "<td>cycle 1</td><td class=\"number\">not known</td>" in stages.stages(run).html()


def test_any_column_is_shown(tmp_path):
    """Units and sizes apart, and columns that no view knows beside those that all do."""
    folder = make_run(tmp_path / "run")
    time = np.linspace(0, 4e-3, 30)
    others = {"pore_pressure [Pa]": 1e6 * time, "suction [Pa]": 0.9e6 * time, "sound [Pa]": time}
    lines = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
    added = np.column_stack(list(others.values()))
    rows = [",".join([lines[0], *others])] + [
        ",".join([line, *(f"{x:.6g}" for x in row)]) for line, row in zip(lines[1:], added)]
    (folder / "history.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    drawn = history.figure(RunFolder(folder))
    shown = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in drawn.axes]
    assert shown == [["cutting force", "thrust force"],
                     ["tool work", "kinetic energy", "tool friction", "bond breaking"],
                     ["tensile cracks", "shear cracks"], ["mass lost", "worn by the wear law"],
                     ["hottest of the tool", "hottest of the rock"], ["pore pressure", "suction"], ["sound"]]
    assert len([name for group in shown for name in group]) == len(HEADER) + len(HOT) + 3 - 2


def test_forces_while_the_tool_cuts_are_those_of_its_stages(tmp_path):
    folder = make_run(tmp_path / "run")
    assert forces.forces(RunFolder(folder)) is None
    change(folder, lambda arrays: {**arrays, "stage_names": np.array(["lowering", "cutting"])})
    run = RunFolder(folder)
    assert instants.stage_name(run, 1) == "cutting"
    at_work = instants.cutting(run)
    np.testing.assert_array_equal(at_work, run.column("stage") == 1)
    axes, = forces.figure(run, at_work).axes
    np.testing.assert_allclose(axes.lines[-2].get_ydata(), 1e-3 * run.column("thrust_force")[at_work])
    assert "while it cuts" in key_results.key_results(run).html()


@pytest.mark.parametrize("first, shift, words", [
    (300.0, [10, 18, 19.5, 20], "3 turns"), (300.0, [20, 20], "1 turn"), (400.0, [-5, -20, -30, -40], "4 turns"),
    (400.0, [13, -2, -56, -57], "3 turns"), (300.0, [10], "not known")])
def test_peaks_of_turns_level_off_up_or_down(tmp_path, first, shift, words):
    """A pick hotter than the water cools from turn to turn."""
    folder = make_run(tmp_path / "run")
    parameters(folder, tool_temperature=first)
    rows = [f"{k + 1},{first + change}" for k, change in enumerate(shift)]
    (folder / "turns.csv").write_text("\n".join(["turn [-],peak [K]", *rows]) + "\n", encoding="utf-8")
    assert key_results.levelling(RunFolder(folder)) == words


@pytest.mark.parametrize("size", [1.0, 0.1])
def test_pictures_of_the_tip_are_as_small_as_the_tool(tmp_path, size):
    """Made up 6 x 8 mm, and a tenth of that. They show the tip, and no more than twice the tool."""
    lengths = "rock_radii", "tool_radii", "tool_positions", "outline", "box"
    moving = "rock_positions", "tool_offset", "worn_depth"

    def smaller(names):
        return lambda arrays, k=0: {name: size * one if name in names else one for name, one in arrays.items()}

    run = RunFolder(change(make_run(tmp_path / "run"), smaller(lengths), smaller(moving)))
    shot = run.snapshot(-1)
    lowest = 1e3 * bodies.tip(run)
    for limits, where in ((plane.tip_limits(run), lowest), (plane.worn_limits(run, shot), lowest),
                          (temperature.around_tip(run, shot), lowest + 1e3 * shot["tool_offset"])):
        left, right, bottom, top = limits
        assert left < where[0] < right and bottom < where[1] < top
        assert right - left < 16 * size and top - bottom < 16 * size


def test_times_are_shown_in_ms_or_s(tmp_path):
    folder = make_run(tmp_path / "run")
    run = RunFolder(folder)
    assert instants.clock(run) == (1e3, "ms") and instants.moment(run, 3) == "cycle 1, 3.00 ms"
    change(folder, snapshot=lambda arrays, k: {**arrays, "time": 1.0 * k})
    run = RunFolder(folder)
    assert instants.clock(run) == (1.0, "s") and instants.moment(run, 3) == "cycle 1, 3.000 s"


def test_temperatures_at_several_speeds_are_listed(tmp_path):
    folder = make_run(tmp_path / "run")
    parameters(folder, velocities="4,0.4", wear_velocity=0.4)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    for k, u in enumerate(("4", "0.4")):
        for n, name in enumerate(("hottest_after_the_pass", "hottest_fixed_shank", "hottest_insulated_shank")):
            summary["results"][f"{name}_{u}"] = {"value": 373.15 + 100 * k + 10 * n, "unit": "K"}
    for k, shank in enumerate(("fixed", "insulated")):
        summary["results"][f"worn_volume_from_{shank}_shank"] = {"value": (k + 1) * 1e-6, "unit": "m3/m"}
        summary["results"][f"mass_lost_from_{shank}_shank"] = {"value": 0.01 * (k + 1), "unit": "-"}
    (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    run = RunFolder(folder)
    assert speeds.speed_tables(run) is None
    (folder / "tool_fields.csv").write_text("x [m],y [m],radius [m]\n", encoding="utf-8")
    page = speeds.speed_tables(run).html()
    for shown in ("100 °C", "110 °C", "120 °C", "200 °C", "210 °C", "220 °C", "1 mm³/mm", "2 mm³/mm", "1 %", "2 %"):
        assert f">{shown}<" in page, shown


def test_two_discs_are_drawn_from_their_paths(tmp_path):
    (tmp_path / "paths").mkdir()
    (tmp_path / "summary.json").write_text(json.dumps({"scene": "two_disc", "results": {
        "largest deviation": {"value": 1e-13, "unit": "of Rn"}}}), encoding="utf-8")
    path = np.column_stack([np.linspace(0, 1e-5, 7)] * 2 + [np.arange(7.0), np.zeros(7)] * 2)
    for kind in {kind for kind, *_ in two_disc.SHOWN}:
        np.savetxt(tmp_path / f"paths/plastic_{kind.replace(', ', '_').replace(' ', '_')}.csv", path, delimiter=",",
                   header="un [m],ut [m],Fn [N],Ft [N],Fn drive [N],Ft drive [N]", comments="")
    run = RunFolder(tmp_path)
    assert titles(run) == ["Results", "Forces over displacements", "All results", "How it was run"]
    assert two_disc.driven(run) == ["plastic"] and two_disc.TITLES["plastic"] in two_disc.two_disc(run).html()
    figures = {file.stem for file in (tmp_path / "figures").iterdir()}
    assert figures == {f"figure_4_{number}" for number in range(11, 19)}
    law, points = two_disc.figure(run, "plastic", "tension", "Fn", "un", "").axes[0].lines
    np.testing.assert_allclose(points.get_ydata(), 1e-3 * np.arange(7))
    np.testing.assert_allclose(law.get_xdata(), np.linspace(0, 10, 7))


def test_a_tube_is_drawn_to_its_top_where_all_grains_have_fallen_through_the_floor(tmp_path):
    folder = make_run(tmp_path / "run")
    change(folder, lambda arrays: {"grain_radii": np.full(5, 1e-3), "tube": np.array([0.02, 0.08, 0.014]),
                                   "box": np.array([0.044, 0.1, 0.032])},
           lambda arrays, k: {"time": arrays["time"], "stage": arrays["stage"],
                              "grain_positions": np.full((5, 3), -1.0)})
    for axes in granular.course_of_tube(RunFolder(folder)).axes:
        assert axes.get_ylim()[1] == pytest.approx(1.1 * (14 + 10))


def test_every_colour_stands_in_the_palette():
    named = re.compile(r"""#[0-9a-fA-F]{3,8}\b|colou?rs?=["']|c(olor)?map=["']|colormaps|"C\d"|["']0\.\d+["']""")
    files = [file for file in (ROOT / "rockwear/report").rglob("*.py") if file.name != "palette.py"]
    found = [f"{file.name}: {line.strip()}" for file in files
             for line in file.read_text(encoding="utf-8").splitlines() if named.search(line)]
    assert len(files) > 20 and not found


def test_views_share_no_drawing_but_by_common_modules():
    """A view stands alone: what two need lies beside them."""
    files = list((ROOT / "rockwear/report/views").glob("*.py"))
    assert len(files) > 10
    for file in files:
        assert "report.views" not in file.read_text(encoding="utf-8"), file.name


def test_what_there_was_at_first_has_no_part_of_what_has_worn(tmp_path):
    run = RunFolder(make_run(tmp_path / "run"))
    run.balances["mass"] = {"unit": "kg/m", "initial": 20.0, "archard": 2e-4, "removed": 1e-4}
    shown = balances.balance_table(run, "mass")
    assert "50.0 %" in shown and "–" in shown and "1e+07" not in shown and "10000000" not in shown


def test_the_last_stage_has_lost_what_the_run_has(tmp_path):
    """The last wear comes after the last row of the record."""
    run = RunFolder(make_run(tmp_path / "run"))
    assert stages.lost(run, 1) == 0.0123456789
    assert stages.lost(run, 0) == run.over_stage("mass_lost", np.max, 0)


@pytest.mark.parametrize("trusted, error, end", [(700.0, 0.2, "700 times, and run as much longer."),
                                                 (9e4, 0.05, "90000 times."),
                                                 (9e4, None, "90000 times, and run longer to tell the distribution.")])
def test_who_need_not_run_longer_is_not_told_to(tmp_path, trusted, error, end):
    run = RunFolder(make_run(tmp_path / "run"))
    run.parameters["wear_tolerance"] = 0.1
    for name, number in (("trusted_wear_acceleration", trusted), ("wear_distribution_error", error),
                         ("contact_events_per_particle", 60.0), ("simulated_time", 4e-3)):
        run.summary["results"][name] = {"value": number, "unit": "s" if name == "simulated_time" else "-"}
    assert trust.in_words(run).endswith(end)

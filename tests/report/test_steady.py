"""The view of a steady cut, from a made-up run of triangular forces, craters and chips."""
import json
import math

import matplotlib
import numpy as np
import pytest

from rockwear.kernels.fragments import chip_length
from rockwear.kernels.groove import groove_results
from rockwear.kernels.steady_record import integral, steady_results, with_error
from rockwear.report import pages, plots
from rockwear.report.folder import RunFolder
from rockwear.report.views import steady

DEPTH = 5e-3


def write(path, **columns):
    """A table of the run: {column: (unit, values)}."""
    header = ",".join(f"{name} [{unit}]" for name, (unit, _) in columns.items())
    np.savetxt(path, np.column_stack([values for _, values in columns.values()]), delimiter=",", header=header,
               comments="", fmt="%.6g")


def make_steady(folder, *, chips=40, ramp=0.04, tables=True):
    """A run of so many chips of two depths each and their craters, in `folder`; forces rise over the ramp, m."""
    random = np.random.default_rng(4)
    lengths = 2 * DEPTH * np.exp(0.4 * random.standard_normal(chips))
    heights = 200e3 * np.exp(0.3 * random.standard_normal(chips))
    ends = np.cumsum(lengths)
    distance = np.arange(0, ends[-1], 0.004 * DEPTH)
    chip = np.minimum(np.searchsorted(ends, distance), chips - 1)
    part = (distance - ends[chip] + lengths[chip]) / lengths[chip]
    cutting = (heights[chip] * part * (1 + 0.1 * random.standard_normal(len(part)))) * np.minimum(distance / ramp, 1)
    thrust, work = 0.6 * cutting + 5e3, integral(distance, 0.1 * cutting)
    x = np.arange(0, distance[-1], 0.05 * DEPTH)
    own = np.minimum(np.searchsorted(ends, x), chips - 1)
    behind = (x - ends[own] + lengths[own]) / lengths[own]
    height = 0.4e-3 - 3e-3 * heights[own] / heights.max() * behind * (1 - behind) * 4
    height += 0.1e-3 * random.standard_normal(len(x))
    sizes = np.concatenate([lengths, random.uniform(0.1, 1, 4 * chips) * DEPTH])
    particles = np.maximum(1, (80 * (sizes / DEPTH)**2)).astype(int)
    area = 0.3 * sizes**2
    found = steady_results(distance=distance, cutting=cutting, thrust=thrust, friction_work=work, depth=DEPTH)
    found |= groove_results(x=x, height=height, chip=found["peak_spacing"][0])
    found |= with_error("chip_length", chip_length(particles=particles, area=area, length=sizes), "m")
    folder.mkdir()
    write(folder / "history.csv", time=("s", distance / 2), stage=("-", 0 * distance), distance=("m", distance),
          cutting_force=("N/m", cutting), thrust_force=("N/m", thrust), tool_friction=("J/m", work))
    if tables:
        write(folder / "groove.csv", x=("m", x), height=("m", height))
        write(folder / "chips.csv", distance=("m", np.resize(ends, len(sizes))), particles=("-", particles),
              area=("m2", area), length=("m", sizes), thickness=("m", 0.3 * sizes), y=("m", 0.5 * sizes))
        y, mode = random.gamma(3, DEPTH / 5, 3000) - 0.4 * DEPTH, 1 + (random.random(3000) < 0.2)
        write(folder / "cracks.csv", time=("s", y), x=("m", y), y=("m", y), mode=("-", mode))
    (folder / "summary.json").write_text(json.dumps({
        "scene": "steady_cut", "ended": "finished", "parameters": {"depth_of_cut": DEPTH, "velocity": 2.0},
        "results": {name: {"value": None if isinstance(value, float) and math.isnan(value) else value, "unit": unit}
                    for name, (value, unit) in found.items()}}), encoding="utf-8")
    return RunFolder(folder)


@pytest.fixture(autouse=True)
def style():
    with matplotlib.rc_context(plots.STYLE):
        yield


def test_a_steady_cut_has_its_section(tmp_path):
    run = make_steady(tmp_path / "run")
    titles = [section.title for section in pages.sections(run) if section.html()]
    assert titles[:2] == ["Key results", "Steady cut"]
    assert {file.name for file in (tmp_path / "run/figures").iterdir()} >= {
        "steady_forces.png", "groove.png", "chips_and_cracks.png"}


def test_forces_show_mean_peaks_and_transient(tmp_path):
    run = make_steady(tmp_path / "run")
    upper, lower = steady.force_figure(run).axes
    mean, _, marks = upper.lines
    begin = 1e3 * run.result("transient")
    np.testing.assert_allclose(mean.get_ydata(), 1e-3 * run.result("mean_cutting_force"))
    np.testing.assert_allclose(mean.get_xdata(), [begin, 1e3 * run.column("distance")[-1]])
    assert len(marks.get_xdata()) == run.result("peaks") and marks.get_xdata().min() > begin > 0
    assert marks.get_ydata().mean() == pytest.approx(1e-3 * run.result("mean_peak_cutting_force"))
    np.testing.assert_allclose(lower.lines[0].get_ydata(), 1e-3 * run.result("mean_thrust_force"))
    length = np.ptp(run.column("distance"))
    for axes, name in ((upper, "cutting_force"), (lower, "thrust_force")):
        assert axes.patches[0].get_data().values.mean() == pytest.approx(
            1e-3 * integral(run.column("distance"), run.column(name))[-1] / length)


def test_groove_is_to_scale_in_strips_that_hold_all_of_it(tmp_path):
    run = make_steady(tmp_path / "run")
    strips = steady.groove_figure(run).axes
    x, height = (1e3 * column for column in run.table("groove.csv", "x", "height"))
    assert 1 < len(strips) <= steady.MOST_STRIPS and all(axes.get_aspect() == 1 for axes in strips)
    assert [strips[0].get_xlim()[0], strips[-1].get_xlim()[1]] == pytest.approx([x[0], x[-1]])
    for before, after in zip(strips, strips[1:]):
        assert before.get_xlim()[1] == pytest.approx(after.get_xlim()[0])
    np.testing.assert_allclose(strips[0].lines[0].get_ydata(), height)


def test_cracks_are_counted_by_height_and_mode(tmp_path):
    run = make_steady(tmp_path / "run")
    _, axes = steady.chip_and_crack_figure(run).axes
    length = np.ptp(run.column("distance"))
    y, mode = run.table("cracks.csv", "y", "mode")
    bars = [(bar.get_y() + bar.get_height() / 2, bar.get_width() * length) for bar in axes.patches]
    tension, shear = bars[:len(bars) // 2], bars[len(bars) // 2:]
    assert sum(count for _, count in tension) == pytest.approx(np.sum(mode == 1))
    assert sum(count for _, count in shear) == pytest.approx(np.sum(mode == 2))
    assert sum(count for middle, count in bars if middle < 0) == pytest.approx(np.sum(y < 0))


def test_numbers_stand_with_their_errors(tmp_path):
    text = steady.steady_cut(make_steady(tmp_path / "run")).html()
    assert "106.3 ± 5.3 kN/m" in text and "2.40 ± 0.27" in text and "too short" not in text


def test_wear_and_temperature_stand_beside_those_by_hand(tmp_path):
    run = make_steady(tmp_path / "run")
    assert steady.by_hand(run) == ""
    results = run.summary["results"]
    results |= {"worn_volume": {"value": 2e-7, "unit": "m3/m"}, "worn_volume_by_hand": {"value": 5e-7, "unit": "m3/m"}}
    results |= {"tool_temperature_end": {"value": 373.15, "unit": "K"},
                "tool_temperature_by_blok": {"value": 353.15, "unit": "K"}}
    shown = steady.by_hand(run)
    assert "0.2 mm³/mm" in shown and "0.5 mm³/mm" in shown and "100 °C" in shown and "80 °C" in shown
    assert "strip" not in shown


@pytest.mark.parametrize("chips", [2, 6])
def test_a_short_cut_says_so(tmp_path, chips):
    assert "too short to rely on" in steady.steady_cut(make_steady(tmp_path / "run", chips=chips)).html()


def test_the_legend_of_a_short_cut_names_what_is_drawn(tmp_path):
    """Two chips: no peak after the transient, an error that is not known, and less than ten depths of record."""
    run = make_steady(tmp_path / "run", chips=2)
    assert run.result("peaks") == 0 and math.isnan(run.result("mean_cutting_force_standard_error"))
    upper, _ = steady.force_figure(run).axes
    labels = [words.get_text() for words in upper.get_legend().get_texts()]
    depths = np.ptp(run.column("distance")) / DEPTH
    assert [words for words in labels if words.startswith("means over")] == [f"means over {depths:.3g} depths of cut"]
    assert any(words.endswith("its error is not known") for words in labels)
    assert not any("twice" in words or "peak" in words for words in labels)


def test_what_was_not_written_is_not_shown(tmp_path):
    run = make_steady(tmp_path / "run", tables=False)
    assert steady.steady_cut(run).html().count("<img") == 1
    (tmp_path / "run/history.csv").unlink()
    assert steady.steady_cut(RunFolder(tmp_path / "run")) is None


def test_gaps_and_nan_are_drawn_around(tmp_path):
    folder = tmp_path / "run"
    run = make_steady(folder)
    run.column("cutting_force")[:100] = math.nan
    x, height = run.table("groove.csv", "x", "height")
    write(folder / "groove.csv", x=("m", x), height=("m", np.where(x < 0.05, math.nan, height)))
    write(folder / "chips.csv", distance=("m", [0.1]), particles=("-", [1]), area=("m2", [1e-6]),
          length=("m", [1e-3]), thickness=("m", [1e-3]), y=("m", [0.0]))
    write(folder / "cracks.csv", y=("m", [math.nan]), mode=("-", [1]))
    assert steady.steady_cut(run).html().count("<img") == 3


@pytest.mark.parametrize("length, drawn", [(0.8, False), (1.2, True)])
def test_the_groove_of_a_short_cut_is_no_tower(tmp_path, length, drawn):
    """Shorter than the cut is deep it shows nothing; a little longer, with a deep crater, it fits a page."""
    run = make_steady(tmp_path / "run")
    x = np.linspace(0.0, length * DEPTH, 20)
    write(tmp_path / "run/groove.csv", x=("m", x), height=("m", -40 * DEPTH * x / x[-1]))
    figure = steady.groove_figure(run)
    assert (figure is not None) == drawn
    assert not drawn or figure.get_figheight() < 8


def test_the_title_of_the_groove_says_what_is_known(tmp_path):
    run = make_steady(tmp_path / "run")
    assert "more than" in steady.groove_figure(run).axes[0].get_title(loc="left")
    run.summary["results"]["overbreak"]["value"] = None
    title = steady.groove_figure(run).axes[0].get_title(loc="left")
    assert "more than" not in title and "not known" not in title

"""Figures of strengths over confinement: what is drawn, in numbers, and a rock's file beside its targets."""
import json
import math

import matplotlib
import numpy as np
import pytest

from calibration.fitting import rock_envelope
from calibration.laboratory import envelope_figure
from calibration.laboratory.envelope_figure import Mean, Reference, Strengths
from rockwear.model import rock_file
from rockwear.scenes.parameters import OF_ROCK

matplotlib.use("agg")
SLOPE = 4.0
"""Of sigma1 over sigma3: phi = 36.87 degrees."""
UCS = {1: 27e6, 2: 30e6, 3: 33e6}
"""{packing: Pa}; their standard deviation is 3 MPa, the standard error of the mean its root of three."""


def points(*confinements):
    return [{"sigma3": s, "seed": seed, "peak_stress": ucs + SLOPE * s}
            for seed, ucs in UCS.items() for s in confinements]


def lines(axes):
    """{label: (n, 2) points} of the lines that have one."""
    return {line.get_label(): line.get_xydata() for line in axes.lines if not line.get_label().startswith("_")}


def bars(axes):
    """[(x, y, half the length)] of all error bars of a known length."""
    return [(*segment.mean(axis=0), 0.5 * np.ptp(segment[:, 1]))
            for part in axes.containers for segment in part.lines[2][0].get_segments() if len(segment)]


def test_tests_on_packings_become_means_and_fits():
    found = envelope_figure.of_packings("ours", "k", points(0.0, 10e6), tension=(2e6, 3e6, 4e6))
    assert found.means[1:] == (Mean(0.0, 30e6, pytest.approx(3e6), 3), Mean(10e6, 70e6, pytest.approx(3e6), 3))
    assert found.means[0][:2] == (-3e6, 0.0) and math.isnan(found.means[0].deviation) and found.least == -3e6
    assert len(found.tests) == 9 and (-4e6, 0.0) in found.tests
    assert found.fits[0].cohesion.value == pytest.approx(30e6 / (2 * math.sqrt(SLOPE)))
    lines_of_packings = [fit for fit in found.of_packings if isinstance(fit, envelope_figure.MohrCoulomb)]
    assert [float(fit.sigma1(0.0)) for fit in lines_of_packings] == pytest.approx(list(UCS.values()))


def test_fits_that_are_given_have_no_band_and_two_packings_none_either():
    assert not envelope_figure.of_packings("ours", "k", points(0.0, 10e6), fits=()).of_packings
    two = [point for point in points(0.0, 10e6) if point["seed"] < 3]
    assert not envelope_figure.of_packings("ours", "k", two).of_packings
    assert envelope_figure.through([]) == envelope_figure.through([(0.0, 1e6), (0.0, 2e6)]) == ()


def test_what_is_drawn_of_a_rock():
    """The line with its cut-off and a band of one standard deviation, and bars of the same length."""
    ours = envelope_figure.of_packings("ours", "k", points(0.0, 5e6, 10e6), tension=(3e6, 3e6))
    (axes,) = envelope_figure.figure([ours]).axes
    line = next(found for label, found in lines(axes).items() if label.startswith("Mohr-Coulomb: c 7.5 MPa, φ 36.9°"))
    assert line[0] == pytest.approx((-3, 0)) and line[1] == pytest.approx((-3, 18))
    assert line[-1] == pytest.approx((10.52, 30 + SLOPE * 10.52))
    assert bars(axes) == [pytest.approx((x, 30 + SLOPE * x, 3.0)) for x in (0, 5, 10)]
    band = axes.collections[[len(part.get_paths()[0]) > 10 for part in axes.collections].index(True)]
    at_end = [y for x, y in band.get_paths()[0].vertices if x == pytest.approx(10.52)]
    assert max(at_end) - min(at_end) == pytest.approx(6)


def test_how_far_a_rock_is_off_is_drawn_with_its_standard_error():
    means = Mean(-1e6, 0.0, math.nan, 4), Mean(0.0, 33e6, 6e6, 4), Mean(10e6, 63e6, 0.0, 4)
    ours = Strengths("ours", "k", means=means)
    theirs = envelope_figure.of_packings("theirs", "b", points(0.0, 10e6)[2:4])
    reference = Reference("it", theirs.fits[0].sigma1, ((5e6, 5.0), (math.inf, 10.0)))
    assert envelope_figure.off(ours.means, reference.sigma1) == [
        (0.0, pytest.approx(10), pytest.approx(10)), (10e6, pytest.approx(-10), pytest.approx(0, abs=1e-9))]
    _, lower = envelope_figure.figure([ours, theirs], reference).axes
    assert bars(lower) == [pytest.approx((0, 10, 10)), pytest.approx((10, -10, 0), abs=1e-9)]
    # Their two points and their line are the reference itself.
    same = [line for line in lower.lines if line.get_color() == "b" and line.get_linestyle() in ("--", "None")]
    assert [len(line.get_ydata()) for line in same] == [2, 400] and all(
        abs(line.get_ydata()).max() < 1e-9 for line in same)
    shaded = [part.get_paths()[0].vertices for part in lower.collections if len(part.get_paths()[0]) < 10]
    assert [(v[:, 0].max(), v[:, 1].max()) for v in shaded if len(v) > 2] == [(5, 5), (pytest.approx(10.44), 10)]


def bentheim():
    return rock_file.read(rock_file.find("bentheim"), OF_ROCK)


def test_bentheim_is_drawn_as_its_file_has_it():
    found = laboratory, ours, reference = rock_envelope.compared(bentheim())
    upper, lower = rock_envelope.draw(*found).axes
    triaxial = bentheim().parts["plane"].measured["triaxial"]
    expected = [(1e-6 * sigma3, 1e-6 * sigma1, 1e-6 * deviation)
                for (sigma3, sigma1), deviation in zip(triaxial["mean"], triaxial["standard_deviation"])]
    assert bars(upper)[-7:] == [pytest.approx(bar) for bar in expected]
    assert lines(upper)["laboratory"] == pytest.approx(1e-6 * np.array([(0, 30e6), *bentheim().targets["triaxial"]]))
    # 1.5 times the UCS of 30 MPa: no fit goes beyond, and a fit may be off by 5 % before, and 10 after.
    assert ours.most == 45e6 and reference.allowed == ((45e6, 5.0), (math.inf, 10.0))
    assert {curve[-1, 0] for label, curve in lines(upper).items() if ":" in label and "simulated" not in label} == {45}
    _, found, deviation = expected[-1]
    off, error = 100 * (found / 371.3 - 1), 100 * deviation / math.sqrt(triaxial["packings"]) / 371.3
    assert bars(lower)[-1] == pytest.approx((150, off, error))
    assert rock_envelope.table(ours, reference)[-2].endswith(f"| {off:+.1f} ± {error:.1f} % |")


def test_tests_of_a_laboratory_are_drawn_in_place_of_targets():
    tests = ((0.0, 30e6), (30e6, 187.6e6), (30e6, 158.9e6))
    laboratory, _, reference = rock_envelope.compared(bentheim(), tests)
    assert laboratory.tests == tests and laboratory.fits == rock_envelope.compared(bentheim())[0].fits
    assert reference.sigma1(30e6) == pytest.approx(171.5e6)


def test_numbers_of_an_envelope_are_a_target_too():
    line, curve = rock_envelope.stated({"cohesion": 4.9e6, "friction_angle": 50.6, "hoek_brown_m": 30.0,
                                        "hoek_brown_sigma_ci": 27.4e6})
    assert float(line.sigma1(10e6)) == pytest.approx(105.37e6, rel=1e-4)
    assert float(curve.sigma1(1e6)) == pytest.approx(40.658e6, rel=1e-4)
    (line,) = rock_envelope.stated({"ucs": 27.4e6, "friction_angle": 50.6})
    assert float(line.sigma1(0.0)) == pytest.approx(27.4e6)
    _, reference = rock_envelope.wanted({"ucs": 27.4e6, "friction_angle": 50.6}, 40e6)
    assert float(reference.sigma1(0.0)) == pytest.approx(27.4e6) and reference.allowed == ((40e6, 5.0),)


@pytest.mark.parametrize("words, said", [
    (["m_sandstone"], "rock = m_sandstone: must be a rock with measured triaxial strengths"),
    (["bentheem"], "did you mean bentheim"), (["bentheim", "--points", "nowhere.csv"], "points = nowhere.csv: must be"),
    (["bentheim", "--out", "/dev/null/here"], "out = /dev/null/here: must be a folder")])
def test_what_cannot_be_drawn_is_refused_in_one_line(capsys, words, said):
    assert rock_envelope.main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: ") and said in line


def test_a_rock_without_strengths_to_compare_with_is_refused(tmp_path, capsys):
    data = json.loads(rock_file.find("bentheim").read_text(encoding="utf-8"))
    (tmp_path / "rock.json").write_text(json.dumps({**data, "targets": {}}), encoding="utf-8")
    assert rock_envelope.main([str(tmp_path / "rock.json"), "--out", str(tmp_path)]) == 2
    assert "no targets: must be a rock with targets" in capsys.readouterr().err


def test_the_command_writes_figure_and_origin(tmp_path, capsys):
    assert rock_envelope.main(["bentheim", "--out", str(tmp_path)]) == 0
    lines_of_table = rock_envelope.table(*rock_envelope.compared(bentheim())[1:])
    assert capsys.readouterr().out == "\n".join(lines_of_table) + "\n"
    assert {file.name for file in tmp_path.iterdir()} == {"bentheim_envelope.png", "provenance.json"}

"""The envelope of a rock: fits of tests, points of a laboratory, the page, and bad input."""
import json
import math

import pytest

from calibration.laboratory import envelope

SLOPE = 4.0
"""Of sigma1 over sigma3: phi = 36.87 degrees."""


def points(*confinements, strength=30e6):
    return [{"sigma3": s, "seed": 1, "peak_stress": strength + SLOPE * s, "residual_stress": 3 * s,
             "youngs_modulus": 1e10, "poissons_ratio": 0.2, "failed": True} for s in confinements]


def test_fits_of_points_on_a_line():
    found = envelope.fitted(points(0.0, 5e6, 10e6), [3e6])
    assert found["mohr_coulomb"]["cohesion"]["value"] == pytest.approx(30e6 / (2 * math.sqrt(SLOPE)))
    assert found["mohr_coulomb"]["friction_angle"]["value"] == pytest.approx(math.degrees(2 * math.atan(2)) - 90)
    line, curve = envelope.fits_of(found)
    assert float(line.sigma1(7e6)) == pytest.approx(58e6)
    assert found["hoek_brown"]["tensile_strength"] < float(curve.sigma1(0.0))


def test_what_two_points_do_not_tell_is_no_number():
    """A line through two points has no confidence interval."""
    found = envelope.fitted(points(0.0, 5e6), [3e6])
    assert math.isnan(found["mohr_coulomb"]["cohesion"]["half_width"])
    assert envelope._numbers(found)["mohr_coulomb"]["cohesion"]["half_width"] is None
    json.dumps(envelope._numbers(found), allow_nan=False)
    assert not any("nan" in line for line in envelope.page(found, None) if line.startswith("| simulated"))


def test_points_without_a_curve_keep_their_line():
    flat = [{**point, "peak_stress": 30e6 + 0.9 * point["sigma3"]} for point in points(0.0, 5e6, 10e6)]
    found = envelope.fitted(flat)
    assert "rising faster" in found["hoek_brown"]["refused"] and len(envelope.fits_of(found)) == 1
    assert any("rising faster" in line for line in envelope.page({**found, "tensile_strengths": []}, None))


def test_the_figure_has_both_fits_of_rock_and_laboratory():
    ours = envelope.fitted([{**point, "seed": seed} for point in points(0.0, 5e6, 10e6) for seed in (1, 2)], [3e6, 3e6])
    laboratory = envelope.fitted(points(0.0, 5e6, strength=20e6))
    (axes,) = envelope.draw(ours, laboratory).axes
    drawn = {line.get_label(): line.get_xydata() for line in axes.lines}
    line = drawn[f"Mohr-Coulomb: c {20 / (2 * math.sqrt(SLOPE)):.3g} MPa, φ 36.9°"]
    assert line[0] == pytest.approx((0, 20)) and line[-1, 1] == pytest.approx(20 + SLOPE * line[-1, 0])
    assert drawn["laboratory"].tolist() == [[0, 20], [5, 40]]
    assert len([label for label in drawn if label.startswith("Hoek-Brown")]) == 2
    means = axes.containers[0].lines[0].get_xydata()
    assert means.ravel() == pytest.approx([-3, 0, 0, 30, 5, 50, 10, 70])


@pytest.mark.parametrize("words, said", [
    (["--confinements=-1,2"], "confinements = -1 Pa: must be 0 or between 1000 and 1e+09"),
    (["--confinements", "0,5,10"], "confinements = 5 Pa: must be 0 or between"), (["--seeds", "1.5"], "seeds = 1.5"),
    (["--confinements", "5e6"], "confinements = 5e6 Pa: must be at least two"),
    (["--confinements", "0,1e6,1000e3"], "confinements = 0,1e6,1000e3: must be each given once"),
    (["--seeds", "1,2,1"], "seeds = 1,2,1: must be each given once"), (["--Rn"], "pairs of --name value"),
    (["--points", "nowhere.csv"], "points = nowhere.csv: must be a readable CSV")])
def test_bad_input_ends_in_one_line_before_the_first_run(tmp_path, capsys, words, said):
    assert envelope.main([str(tmp_path / "out"), *words]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and lines[0].startswith("error: ") and said in lines[0]
    assert not (tmp_path / "out").exists()


def test_what_a_run_refuses_is_refused(tmp_path, capsys):
    assert envelope.main([str(tmp_path / "out"), "--rock", "nowhere", "--seeds", "1", "--confinements", "0,1e6"]) == 2
    assert capsys.readouterr().err.splitlines()[-1].startswith("error: ")


def test_a_folder_that_cannot_be_made_is_refused(tmp_path, capsys):
    (tmp_path / "file").touch()
    assert envelope.main([str(tmp_path / "file/out")]) == 2
    assert "file/out: must be a folder that can be written" in capsys.readouterr().err


def test_a_rock_is_measured_fitted_and_drawn(tmp_path):
    """Two confinements, one packing of some 120 discs; the second time nothing runs."""
    out, laboratory = tmp_path / "out", tmp_path / "points.csv"
    laboratory.write_text("sigma3_MPa,sigma1_MPa\n0,80\n10,120\n50,200\n", encoding="utf-8")
    words = [str(out), "--confinements", "0,10e6", "--seeds", "1", "--points", str(laboratory), "--width", "0.03",
             "--height", "0.022", "--kt", "4e9", "--Rt", "1e5"]
    assert envelope.main(words) == 0
    found = json.loads((out / "envelope.json").read_text(encoding="utf-8"))
    assert [point["sigma3"] for point in found["simulated"]["points"]] == [0, 10e6]
    assert found["simulated"]["tensile_strengths"][0] > 1e6
    # Points of the laboratory beyond the largest confinement do not count.
    assert len(found["laboratory"]["points"]) == 2
    assert (out / "envelope.png").stat().st_size > 1e4 and "m_i" in (out / "envelope.md").read_text(encoding="utf-8")
    summaries = [file.stat().st_mtime_ns for file in sorted(out.glob("*/summary.json"))]
    assert len(summaries) == 3 and envelope.main(words) == 0
    assert [file.stat().st_mtime_ns for file in sorted(out.glob("*/summary.json"))] == summaries

"""Campaign of grains: trends computed from numbers, table 2, and the plan of runs."""
import csv
import json
import math
import shutil

import numpy as np
import pytest
from scipy.stats import linregress

from calibration.campaigns import grains, grains_figures, grains_tables
from calibration.campaigns.trends import trend, verdict
from calibration.generated import ROOT

RESULTS = ROOT / "calibration/results/grains"
X = np.array([2.0, 2.0, 5.0, 5.0, 20.0, 20.0])
NOISE = 1 + 0.02 * np.array([1, -1, 1, -1, 1, -1])


def test_a_power_law_is_found_exactly():
    found = trend(X, 3 * X**0.5)
    assert found.exponent == pytest.approx(0.5) and found.change == pytest.approx(math.sqrt(10) - 1)
    assert found.error == pytest.approx(0, abs=1e-9) and found.word == "rises"


def test_the_error_of_a_trend_is_that_of_linear_regression():
    y = X**0.3 * (1 + 0.1 * np.array([1, -1, -1, 1, 0, 0.5]))
    regression = linregress(np.log(X), np.log(y))
    assert trend(X, y).error == pytest.approx(regression.stderr * math.log(10))


@pytest.mark.parametrize("y, word", [(X**0.5, "rises"), (X**-0.2, "falls"), (X**0.02, "unchanged"),
                                     (7 + 0 * X, "unchanged"), ([1, 9, 9, 1, 2, 9], "unclear"),
                                     (X**0.02 * (1 + 0.2 * np.array([1, 0, 0, 0, 0, 1])), "unclear")])
def test_the_word_of_a_trend(y, word):
    found = trend(X, np.asarray(y) * NOISE)
    assert found.word == word
    assert verdict(word, found.word) == ("unclear" if word == "unclear" else "agrees")
    assert word == "unclear" or verdict("rises" if word == "falls" else "falls", found.word) == (
        "agrees" if word == "falls" and found.word == "rises" else "disagrees")


def rows(parameter, law, seeds=(1, 2)):
    """Made-up runs: `law` (value) -> {test: strength}."""
    return [{"parameter": parameter, "value": value, "test": test, "seed": seed,
             "peak_stress": stress * (1 + 0.01 * seed), "youngs_modulus": 4e9, "poissons_ratio": 0.2,
             "peak_strain": 0.01, "failed": True, "tensile_cracks": 9, "shear_cracks": 1, "energy_missing": 0.0}
            for value in (5.0, 10.0, 20.0) for seed in seeds for test, stress in law(value).items()]


def test_cohesion_that_counts_less_under_confinement_agrees():
    def law(less):
        return lambda c: {"compression": 3e6 * c, "5 MPa": 3e6 * c**less + 40e6, "tension": 2e6}

    for power, word in ((0.5, "agrees"), (2.0, "disagrees")):
        points = grains_tables.points(rows("cohesion, MPa", law(power)), "cohesion, MPa", 10.0)
        lines = {line[1]: line for line in grains_tables.trends({"cohesion, MPa": points})}
        assert lines["UCS"][3] == "rises" and lines["UCS"][-1] == "agrees"
        assert float(lines["UCS"][5]) == pytest.approx(1.0)
        assert lines["tensile strength"][2:4] == ["–", "unchanged"]
        assert lines["counts under confinement"][-1] == word


def test_table_2_says_what_is_reached():
    confined = {f"{p} MPa": 27.4e6 + 7.8e6 * p for p in (1, 5, 10)}
    made = [row for row in rows("", lambda _: {"compression": 27.4e6, "tension": 3e6, **confined})
            if row["value"] == 5.0]
    found = grains_tables.measured(made)
    # Mohr-Coulomb's line through points on a line.
    slope = 7.8 * 1.01
    sine = (slope - 1) / (slope + 1)
    assert found["friction_angle"][0] == pytest.approx(math.degrees(math.asin(sine)))
    assert found["cohesion"][0] == pytest.approx(1.01 * 27.4e6 * (1 - sine) / 2 / math.cos(math.asin(sine)), rel=0.02)
    cells = {line.split("|")[1].strip(): line.split("|")[-2].strip() for line in grains_tables.table_2(found)[2:-1]}
    assert cells["UCS, MPa"] == cells["φ, °"] == "yes" and cells["σt, MPa"] == "no"
    entries = grains_tables.as_measured(found)
    assert entries["ucs"]["packings"] == 2 and len(entries["triaxial"]["mean"]) == 3


def test_the_study_varies_one_thing_at_a_time_around_the_rock_of_the_library():
    base = grains.rock()
    assert set(grains_tables.STATED) <= set(grains.study(base))
    for name, cases in grains.study(base).items():
        own = grains.calibrated_value(name, base)
        assert len(cases) >= 3 and own not in cases
    plan = grains.planned("study")
    assert len({place for place, *_ in plan.values()}) == len(plan)
    assert not set(grains.SEEDS) & {1, 2, 3, 4, 5}


def test_strain_is_found_whatever_the_rotation_and_sliding_is_planned_apart():
    rng, (cos, sin) = np.random.default_rng(1), (np.cos(1.1), np.sin(1.1))
    places = rng.random((400, 2))
    sheared = places @ np.array([[1.0, 0.0], [0.3, 1.0]]) @ np.array([[cos, -sin], [sin, cos]]) + 5.0
    # Simple shear by g: E = ((0, g/2), (g/2, g^2/2)).
    found = grains_figures.shear_strain(places, sheared, 0.2)
    assert found == pytest.approx(np.hypot(0.15, 0.3**2 / 4), rel=1e-9)
    assert np.isnan(grains_figures.shear_strain(places[:2], sheared[:2], 2.0)).all()
    plan = grains.planned("sliding")
    assert [key[2:] for key in plan] == [("10 MPa", seed) for seed in grains.SEEDS[:3]]
    assert all(values["strain_max"] > 0.1 for *_, values in plan.values())
    assert not set(plan) & set(grains.planned("calibrated"))


def stored():
    """Rows of the strengths in calibration/results/grains."""
    with open(RESULTS / "grains.csv", newline="", encoding="utf-8") as file:
        return [{**row, "peak_stress": float(row["peak_stress"])} for row in csv.DictReader(file)]


def test_the_envelope_is_drawn_with_the_numbers_of_table_2():
    upper, lower = grains_figures.envelope(stored()).axes
    drawn = {line.get_label(): line.get_xydata() for line in upper.lines}
    line, curve = drawn["Mohr-Coulomb: c 4.9 MPa, φ 50.6°"], drawn["Hoek-Brown: m_i 30, σci 27.4 MPa"]
    assert np.interp(10, *line.T) == pytest.approx(105.37, abs=0.01) and line[0] == pytest.approx((-1.9, 0))
    # Two numbers of the curve by hand: 1 + sqrt(30 * 27.4 + 27.4²), 5 + sqrt(30 * 27.4 * 5 + 27.4²).
    assert np.interp((1, 5), *curve.T) == pytest.approx((40.66, 74.72), abs=0.02)
    assert drawn["laboratory [Bahaaddini 2018]"] == pytest.approx(np.array([(-1.9, 0), (0, 27.4)]))
    assert drawn["model of [Bahaaddini 2018]"] == pytest.approx(np.array([(-1.44, 0), (0, 28.03)]))
    means = upper.containers[0].lines[0].get_xydata()
    assert means == pytest.approx(np.array([(-1.879, 0), (0, 27.78), (1, 37.09), (5, 71.75), (10, 105.54)]), abs=0.01)
    assert lower.containers[0].lines[0].get_ydata() == pytest.approx((1.5, 5.4, 8.1, 0.2), abs=0.06)
    # All tests of 25 packings, at four confinements and in tension.
    assert len(drawn["ours"]) == 125


def test_the_table_beside_the_laboratory_has_standard_errors():
    cells = [line.split(" | ") for line in grains_tables.beside_the_laboratory(stored())[2:-1]]
    assert [cell[4] for cell in cells] == ["+1.5 ± 2.5 %", "+5.4 ± 2.1 %", "+8.1 ± 2.2 %", "+0.2 ± 1.3 %"]
    assert [cell[6] for cell in cells] == ["+1.4 ± 2.5 % |", "-8.8 ± 1.8 % |", "-4.0 ± 2.0 % |", "+0.8 ± 1.3 % |"]
    # A study has no calibrated rock, and a packing alone no error.
    assert len(grains_tables.beside_the_laboratory([{**row, "parameter": "friction"} for row in stored()])) == 3
    assert len(grains_tables.beside_the_laboratory([row for row in stored() if row["seed"] == "166"])) == 3
    assert grains_figures.envelope([row for row in stored() if row["seed"] == "166"])


def test_stored_strengths_are_drawn_without_runs(tmp_path, capsys):
    assert grains.main(tmp_path, ["--stored"]) == 2 and "must hold grains.csv" in capsys.readouterr().err
    shutil.copy(RESULTS / "grains.csv", tmp_path)
    assert grains.main(tmp_path, ["--stored"]) == 0 and "+8.1 ± 2.2 %" in capsys.readouterr().out
    assert json.loads((tmp_path / "provenance.json").read_text(encoding="utf-8")).keys() == {"grains_envelope.png"}

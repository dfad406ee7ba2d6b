"""Campaign of grains: trends computed from numbers, table 2, and the plan of runs."""
import math

import numpy as np
import pytest
from scipy.stats import linregress

from calibration.campaigns import grains, grains_tables
from calibration.campaigns.trends import trend, verdict

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
                                     (7 + 0 * X, "unchanged"), ([1, 9, 9, 1, 2, 9], "unclear")])
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

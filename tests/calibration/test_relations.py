"""The dimensionless relations that a fit begins from."""
import numpy as np
import pytest

from calibration.campaigns import rock_laws, rock_relations
from calibration.fitting.relations import (
    BOND_AREA, STRENGTHS, VARIED, chosen, elastic_guess, stored, strength_guess, strengths)
from rockwear.model.rock import Specimen

DATA = stored()
OVER = "kt_over_kn", "porosity", "cohesion_over_tension", "length_over_radius"


def test_the_relations_are_those_of_packings():
    """E grows and nu falls with kt/kn, and both stay below the triangular lattice of equal discs (E) or near it."""
    found = chosen(DATA, "kt_over_kn")
    ratio, stiffness, nu = found["kt_over_kn"], found["E_over_kn"][:, 0], found["nu"][:, 0]
    assert np.all(np.diff(stiffness) > 0) and np.all(np.diff(nu) < 0)
    assert np.all(stiffness < 2 * np.sqrt(3) * (1 + ratio) / (3 + ratio))
    assert np.all(abs(nu - (1 - ratio) / (3 + ratio)) < 0.15)
    assert found["E_over_kn"][:, 1].max() < 0.05  # packings scatter little


def test_all_cases_of_the_campaign_are_stored_from_three_packings_or_more():
    known = rock_relations.cases(rock_laws.ROCK)
    assert [row["case"] for row in DATA["rows"]] == list(known)
    assert DATA["defaults"] == rock_relations.varied(known["kt/kn = 0.4, gap 0.1 mm"])
    for row in DATA["rows"]:
        assert row["packings"] >= 3
        assert {name: row[name] for name in VARIED} == rock_relations.varied(known[row["case"]])


def test_looser_packings_have_fewer_bonds_and_are_weaker():
    found = chosen(DATA, "porosity")
    for name in ("coordination", "E_over_kn", *STRENGTHS):
        assert found[name][0, 0] > found[name][-1, 0], name
    # Four bonds a disc carry a packing without friction that can no longer be compressed.
    assert np.all(np.diff(found["coordination"][:, 0]) < 0) and 4 < found["coordination"][-1, 0]
    assert np.all(np.diff(chosen(DATA, "bonding_gap")["coordination"][:, 0]) > 0)


def test_bonds_are_as_long_as_those_of_a_packing():
    rock = Specimen(width=0.08, height=0.04, radius_min=1e-3, radius_max=1.5e-3, seed=2, density=2500.0,
                    **{name: DATA["defaults"][name] for name in ("porosity", "bonding_gap")})
    assert rock.crack_area / (2 * rock_relations.RADIUS) == pytest.approx(BOND_AREA, rel=0.02)


# ---- what the campaign makes of its runs

def of_packings(rock, factors):
    """{case: {quantity: (packings,)}} of a made-up rock of power laws, whose packings have these factors."""
    found = {}
    for case, values in rock_relations.cases(rock).items():
        at = rock_relations.varied(values)
        base = at["kt_over_kn"]**0.3 * at["porosity"]**-0.5 * np.array(factors)
        shear, length = at["cohesion_over_tension"]**0.4, at["length_over_radius"]**0.2
        ucs, tension = (values["bond_tension"] * base * part for part in (2 * shear * length, 0.5 * length**0.5))
        found[case] = {"E": values["kn"] * base, "nu": 0.2 * base, "UCS": ucs, "tension": tension,
                       "ratio": ucs / tension, "coordination": 4 + 0 * base}
    return found


FACTORS = 0.9, 1.0, 1.1
"""Of packings: their standard deviation is a tenth."""
MADE_UP = rock_relations.numbers(rock_laws.ROCK, of_packings(rock_laws.ROCK, FACTORS))


def test_error_bands_are_the_standard_deviations_of_packings():
    for row in MADE_UP["rows"]:
        for name in ("E_over_kn", "nu", *STRENGTHS):
            assert row[name][1] == pytest.approx(0.1 * row[name][0]), name
        assert row["UCS_over_tension"][1] == pytest.approx(0) and row["packings"] == 3
    row = next(row for row in MADE_UP["rows"] if row["case"] == "c/σb = 5")
    assert row["UCS_over_bond_tension"][0] == pytest.approx(
        2 * 0.4**0.3 * 0.12**-0.5 * 5**0.4 * (30 * 20e9 / (49e12 * 1.25e-3))**0.2, rel=1e-4)
    # Bonds of twice the strength and the stiffness, their energy too: the same numbers.
    twice = {**rock_laws.ROCK, **{name: 2 * rock_laws.ROCK[name] for name in
                                  ("kn", "kt", "bond_tension", "bond_cohesion", "bond_fracture_energy")}}
    assert rock_relations.varied({**twice, "bonding_gap": 1e-4, "porosity": 0.12}) == MADE_UP["defaults"]


def test_an_exponent_is_that_of_a_power_law():
    x = np.array([1.0, 2.0, 8.0])
    assert rock_relations.slopes(x, np.column_stack([3 * x, x**-0.5, 0 * x + 5])) == pytest.approx([1, -0.5, 0])


def test_the_page_tells_what_changes_by_how_much_and_whether_effects_multiply():
    lines = rock_relations.tables(rock_laws.ROCK, of_packings(rock_laws.ROCK, FACTORS))
    cells = {row[0]: row[1:] for line in lines if line.startswith("|") and (row := line.strip("| ").split(" | "))}
    # Coordination, E/kn, nu, UCS/σb, σt/σb, UCS/σt.
    changed, _, stiffness, _, ucs, tension, ratio = cells["c/σb"]
    assert changed == "0.5 → 10" and "→" not in stiffness + tension and "→" in ucs
    low, high = ucs.split(";")[0].split(" → ")
    assert float(high.split()[0]) / float(low.split()[0]) == pytest.approx(20**0.4, rel=0.01)
    assert ucs.split("; ")[1].startswith("0.4 ±") and ratio.split("; ")[1].startswith("0.4 ±")
    assert "; " not in cells["bonding gap"][3]  # it begins at 0: no exponent
    assert cells["c/σb = 1, kt/kn = 0.2"] == ["1", "1"]


# ---- inversion

def test_the_guess_inverts_the_relations():
    found = chosen(DATA, "kt_over_kn")
    for ratio, (stiffness, _), (nu, _) in zip(found["kt_over_kn"], found["E_over_kn"], found["nu"]):
        assert elastic_guess(youngs_modulus=stiffness * 3e9, poissons_ratio=nu) == pytest.approx((3e9, ratio))


def test_the_guess_stays_within_the_data():
    ratios = chosen(DATA, "kt_over_kn")["kt_over_kn"]
    assert elastic_guess(youngs_modulus=1e9, poissons_ratio=0.49)[1] == ratios[0]
    assert elastic_guess(youngs_modulus=1e9, poissons_ratio=-0.1)[1] == ratios[-1]


@pytest.mark.parametrize("over", OVER)
def test_strengths_are_those_that_are_stored(over):
    found = chosen(DATA, over)
    for k, value in enumerate(found[over]):
        assert strengths(DATA, **{over: value}) == pytest.approx([found[name][k, 0] for name in STRENGTHS])
    low, high = found[over][[0, -1]]
    assert strengths(DATA, **{over: 0.5 * low}) == strengths(DATA, **{over: low})
    assert strengths(DATA, **{over: 2 * high}) == strengths(DATA, **{over: high})


def test_two_changes_at_once_are_about_their_product():
    """UCS to a quarter, at the worst with brittle bonds; the tensile strength to 5 %."""
    both = [row for row in DATA["rows"] if sum(row[name] != DATA["defaults"][name] for name in VARIED) == 2
            and row["bonding_gap"] == DATA["defaults"]["bonding_gap"]]
    assert len(both) == 6
    for row in both:
        expected = strengths(DATA, **{name: row[name] for name in OVER})
        for name, one, allowed in zip(STRENGTHS, expected, (0.25, 0.06)):
            assert row[name][0] == pytest.approx(one, rel=allowed), row["case"]


@pytest.mark.parametrize("tension, shear, length, ratio", [
    (5e6, 0.7, 3.0, 0.1), (40e6, 3.3, 20.0, 0.3), (1e6, 8.0, 60.0, 0.9), (20e6, 1.5, 1.2, 0.4)])
def test_the_inversion_recovers_strengths_between_the_data(tension, shear, length, ratio):
    """Power laws: interpolation by logarithms is exact."""
    base = ratio**0.3 * 0.15**-0.5
    ucs, tensile = 2 * base * shear**0.4 * length**0.2 * tension, 0.5 * base * length**0.1 * tension
    found = strength_guess(MADE_UP, ucs=ucs, tensile_strength=tensile, energy=length * tension**2, least=1.0,
                           kt_over_kn=ratio, porosity=0.15)
    assert found == pytest.approx((tension, shear), rel=1e-3)


def test_the_inversion_recovers_what_is_stored():
    table = chosen(DATA, "cohesion_over_tension")
    for k, shear in enumerate(table["cohesion_over_tension"]):
        ucs, tensile = (9e6 * table[name][k, 0] for name in STRENGTHS)
        found = strength_guess(DATA, ucs=ucs, tensile_strength=tensile, least=1.0,
                               energy=DATA["defaults"]["length_over_radius"] * 81e12)
        assert found == pytest.approx((9e6, shear), rel=1e-3)


@pytest.mark.parametrize("ucs, end", [(5e6, 0), (500e6, -1)])
def test_a_ratio_beyond_the_data_keeps_the_tensile_strength(ucs, end):
    """Bonds without energy: the least counts."""
    shears = chosen(DATA, "cohesion_over_tension")["cohesion_over_tension"]
    tension, shear = strength_guess(DATA, ucs=ucs, tensile_strength=4e6, energy=0.0, least=1.01, kt_over_kn=0.3)
    assert shear == pytest.approx(shears[end])
    at = strengths(DATA, cohesion_over_tension=shears[end], length_over_radius=1.01, kt_over_kn=0.3)
    assert tension * at[1] == pytest.approx(4e6)

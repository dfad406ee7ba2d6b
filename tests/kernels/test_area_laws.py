"""Bond laws by crack area: Coulomb's envelope, and softening by fracture energy, in closed form."""
import math

import numpy as np
import pytest

from rockwear.kernels.bond_laws import Cohesive, Coulomb, ElasticDamage
from rockwear.kernels.compiled import softening_energy
from rockwear.kernels.checks import ParameterError

KN, KT, RN, RT, MU, ENERGY = 2e10, 1e10, 1e5, 1.2e5, 0.5, 0.75
BRITTLE = dict(kn=KN, kt=KT, bond_tension=RN, bond_cohesion=RT, mu=MU)
COULOMB, COHESIVE = Coulomb(**BRITTLE), Cohesive(bond_fracture_energy=ENERGY, **BRITTLE)
ONSET, END = RN / KN, 2 * ENERGY / RN
"""Openings (m) at the peak and at the end: 5 and 15 um."""


def work(force, path):
    """Integral of a force that is a line between the points of its path."""
    return np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(path))


def cycles(law, seed, end):
    """Openings up to `end`, further and further and back in between; every force is a line between two of them."""
    rng, corners = np.random.default_rng(seed), [0.0, 0.7 * law.onset, 0.1 * law.onset, law.onset]
    for reached in law.onset + np.sort(rng.uniform(size=12)) * (end - law.onset):
        corners += [reached, rng.uniform() * reached, reached]
    return np.array([*corners, end])


@pytest.mark.parametrize("law", [COULOMB, COHESIVE], ids=["coulomb", "cohesive"])
@pytest.mark.parametrize("Fn", [-1e6, -2e5, -1e3, 0.0, 3e4, 9e4])
def test_shear_strength_is_cohesion_less_friction_times_tension(law, Fn):
    strength = RT - MU * Fn
    ut = np.array([0.5, 1 - 1e-9, 1 + 1e-9, 2.0]) * strength / KT
    normal, shear = law.drive(np.full(4, Fn / KN), ut)
    slides = MU * max(-Fn, 0.0) if law is COULOMB else strength
    assert shear == pytest.approx([0.5 * strength, strength, slides, slides], rel=1e-8)
    assert normal == pytest.approx([Fn, Fn, *[min(Fn, 0.0) if law is COULOMB else Fn] * 2], rel=1e-12)


@pytest.mark.parametrize("shear", [0.0, 0.5])
def test_coulomb_breaks_at_its_tension_cut_off(shear):
    un = np.array([0.5, 1 - 1e-9, 1 + 1e-9]) * ONSET
    Fn, Ft = COULOMB.drive(un, np.full(3, shear * (RT - MU * RN) / KT))
    assert Fn == pytest.approx([0.5 * RN, RN, 0.0], rel=1e-8) and Ft[-1] == 0.0


def test_the_cone_of_coulomb_ends_in_its_apex():
    weak = Coulomb(**dict(BRITTLE, bond_cohesion=0.2 * RN))
    Fn, _ = weak.drive(np.array([0.399, 0.401]) * ONSET, np.zeros(2))
    assert Fn == pytest.approx([0.399 * RN, 0.0])
    # The softening law slips there without shear, and keeps its strength in tension.
    soft = Cohesive(bond_fracture_energy=ENERGY, **dict(BRITTLE, bond_cohesion=0.2 * RN))
    Fn, Ft = soft.drive(np.array([0.401, 0.7, 1.0]) * ONSET, np.array([1e-6, 2e-6, 3e-6]))
    assert Fn == pytest.approx([0.401 * RN, 0.7 * RN, RN]) and Ft.tolist() == [0.0, 0.0, 0.0]


def test_coulombs_elastic_domain_has_its_slope():
    assert COULOMB.elastic_domain(COULOMB.initial_state()) == (KN, KT, RN, RT, -MU)


def test_tension_softens_as_damage_driven_by_tension_alone():
    damage = ElasticDamage(kn=KN, kt=KT, Rn=RN, Rt=1e9, H=RN / (END - ONSET), mu=MU, tension_only=True)
    for path in (np.linspace(0.0, 1.2 * END, 241), cycles(COHESIVE, 1, 1.1 * END), -cycles(COHESIVE, 2, END)):
        np.testing.assert_allclose(COHESIVE.drive(path, 0 * path)[0], damage.drive(path, 0 * path)[0], atol=1e-9 * RN)
    Fn, _ = COHESIVE.drive(np.array([ONSET, 10e-6, 15e-6]), np.zeros(3))
    assert Fn == pytest.approx([RN, 0.5 * RN, 0.0], abs=1e-9 * RN)


@pytest.mark.parametrize("energy", [0.2500001, 0.5, 30.0, 1e4])
@pytest.mark.parametrize("area", [1.0, 7e-4, 1.7e3])
@pytest.mark.parametrize("seed", range(3))
def test_breaking_costs_the_fracture_energy_whatever_the_cycles(energy, area, seed):
    # A larger bond of the same stiffness stores more, so that the energy it can break with at least is higher.
    energy *= max(area, 1.0)
    law = Cohesive(bond_fracture_energy=energy, **BRITTLE).scaled(area)
    path = cycles(law, seed, law.gone * (1 + 1e-12))
    Fn, _ = law.drive(path, 0 * path)
    assert Fn.max() == pytest.approx(area * RN) and Fn[-1] == 0.0
    least = 0.5 * 1.001 * (area * RN)**2 / KN
    assert work(Fn, path) == pytest.approx(max(energy * area, least), rel=1e-7)
    assert law.fracture_energy() == (pytest.approx(max(energy * area, least), rel=1e-12), math.inf)


@pytest.mark.parametrize("energy", [0.3, ENERGY, 50.0])
@pytest.mark.parametrize("seed", range(3))
def test_what_damage_dissipates_is_the_work_less_what_is_stored(energy, seed):
    law = Cohesive(bond_fracture_energy=energy, **BRITTLE)
    path = cycles(law, seed, 0.98 * law.gone)
    bond, before, done, damaged = law.initial_state(), (0.0, 0.0), 0.0, 0

    def dissipated(softening):
        return softening_energy(softening, law.Rn, law.onset, law.gone)

    for un in path.tolist():
        Fn, Ft = law.respond(bond, un, (0.0,))
        done += 0.5 * (Fn + before[1]) * (un - before[0])
        before, damaged = (un, Fn), damaged + (bond.softening > 0)
        stored = law.stored_energy(bond, un, (0.0,), Fn, Ft)
        assert dissipated(bond.softening) == pytest.approx(done - stored, abs=1e-12 * law.fracture_energy()[0])
    assert damaged > 20 and not bond.broken
    assert dissipated(1.0) == pytest.approx(law.fracture_energy()[0]) and dissipated(0.0) == 0.0


def test_at_its_least_fracture_energy_it_is_brittle():
    law = Cohesive(bond_fracture_energy=1e-4, **BRITTLE)
    assert law.gone == pytest.approx(1.001 * ONSET)
    rng = np.random.default_rng(3)
    for _ in range(20):
        un = np.cumsum(rng.normal(size=200)) * 0.3 * ONSET
        un[(un > ONSET) & (un < 1.001 * ONSET)] = 0.0
        np.testing.assert_allclose(law.drive(un, 0 * un)[0], COULOMB.drive(un, 0 * un)[0], atol=1e-9 * RN)


def test_with_a_boundless_fracture_energy_tension_stays_at_its_peak():
    law = Cohesive(bond_fracture_energy=1e6, **BRITTLE)
    un = np.array([1.0, 3.0, 100.0, 50.0, 1e3]) * ONSET
    assert law.drive(un, 0 * un)[0] == pytest.approx(RN * np.array([1, 1, 1, 0.5, 1]), rel=1e-3)


def test_damage_lowers_the_cohesion_and_without_shear_energy_slip_does_not_damage():
    bond = COHESIVE.initial_state()
    COHESIVE.respond(bond, 10e-6, (0.0,))
    omega = bond.softening
    assert omega == pytest.approx(0.75)
    for un, ut in ((0.0, 1e-4), (-4e-6, 2e-4), (-4e-6, -1e-4), (4e-6, 1e-4)):
        Fn, (Ft,) = COHESIVE.respond(bond, un, (ut,))
        assert Fn == pytest.approx(KN * un * (0.25 if un > 0 else 1.0))
        assert Ft == pytest.approx(math.copysign(0.25 * RT - MU * Fn, ut))
    assert bond.softening == omega


SHEAR_ENERGY = 3.6
SLIPPING = Cohesive(bond_fracture_energy=ENERGY, bond_shear_energy=SHEAR_ENERGY, **BRITTLE)
SLIP_END = 2 * SHEAR_ENERGY / RT
"""60 um, five times what the bond shears before it slips."""


@pytest.mark.parametrize("area", [1.0, 0.3])
@pytest.mark.parametrize("Fn", [0.0, -1e5, -1e6])
def test_slip_takes_the_cohesion_and_the_shear_energy(Fn, area):
    law, Fn = SLIPPING.scaled(area), area * Fn
    friction, strength = -MU * Fn, area * RT
    onset = (strength + friction) / KT
    # Without friction, force falls in a line from the peak to zero at SLIP_END.
    end = SLIP_END + friction / KT
    ut = np.array([0.0, onset, 0.75 * onset + 0.25 * end, end - 1e-12, 2 * end])
    normal, force = law.drive(np.full(5, Fn / KN), ut)
    assert force == pytest.approx([0.0, strength + friction, 0.75 * strength + friction, friction, friction], abs=1e-2)
    assert normal == pytest.approx(Fn)
    # Work up to the end, less that of friction and what unloading gives back.
    spent = work(force[:-1], ut[:-1]) - friction * SLIP_END - 0.5 * friction**2 / KT
    assert spent == pytest.approx(area * SHEAR_ENERGY, rel=1e-6)
    assert law.fracture_energy()[1] == pytest.approx(area * SHEAR_ENERGY)


@pytest.mark.parametrize("sampled", [3, 400])
def test_slip_is_exact_however_it_is_sampled(sampled):
    ut = np.linspace(RT / KT, 0.8 * SLIP_END, sampled)
    _, force = SLIPPING.drive(np.zeros(sampled + 1), np.concatenate([[0.0], ut]))
    assert force[1:] == pytest.approx(RT * (1 - (ut - RT / KT) / (SLIP_END - RT / KT)), rel=1e-9)


def test_slip_back_and_forth_damages_as_slip_in_one_direction():
    bond = SLIPPING.initial_state()
    for ut in (0.5, 0.3, 0.5, 0.2):
        SLIPPING.respond(bond, 0.0, (ut * SLIP_END,))
    # Slip up to 0.5, none on the way of unloading and back, and then the other way.
    (force,), lost = SLIPPING.respond(bond, 0.0, (0.2 * SLIP_END,))[1], 1 - SLIPPING.strength_left(bond.softening)
    first = (0.5 * SLIP_END - RT / KT) / (SLIP_END - RT / KT)
    assert lost > first and -force == pytest.approx((1 - lost) * RT)
    assert 0.2 * SLIP_END - force / KT == pytest.approx(bond.ut_plastic[0])
    assert lost == pytest.approx((first * SLIP_END + (first * SLIP_END - bond.ut_plastic[0])) / SLIP_END)


def test_slip_takes_as_much_of_the_tension_as_of_the_cohesion():
    bond = SLIPPING.initial_state()
    SLIPPING.respond(bond, 0.0, (0.5 * SLIP_END,))
    left = 0.625
    assert SLIPPING.strength_left(bond.softening) == pytest.approx(left)
    opening = END - left * (END - ONSET)
    # Without shear force nothing slips on.
    Fn, _ = SLIPPING.respond(bond, opening, bond.ut_plastic)
    assert Fn == pytest.approx(left * RN)
    assert SLIPPING.respond(bond, 0.5 * opening, bond.ut_plastic)[0] == pytest.approx(0.5 * left * RN)


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_opening_takes_as_much_of_the_cohesion_as_of_the_tension(part):
    """And not as much as of the stiffness, of which a tenth is left early on where the fracture energy is high."""
    law = Cohesive(bond_fracture_energy=30.0, bond_shear_energy=SHEAR_ENERGY, **BRITTLE)
    bond = law.initial_state()
    law.respond(bond, law.onset + part * (law.gone - law.onset), (0.0,))
    assert 1 - bond.softening < 0.1
    _, (force,) = law.respond(bond, 0.0, ((1 - part) * RT / KT,))
    assert force == pytest.approx((1 - part) * RT) and law.strength_left(bond.softening) == pytest.approx(1 - part)
    # What is left to slip takes the same part of the shear energy, by the square of the strength.
    ut = np.linspace((1 - part) * RT / KT, SLIP_END, 200)
    force = [law.respond(bond, 0.0, (x,))[1][0] for x in ut]
    spent = work(np.array(force), ut) + 0.5 * ((1 - part) * RT)**2 / KT
    assert spent == pytest.approx((1 - part)**2 * SHEAR_ENERGY, rel=1e-3)


def test_with_too_little_shear_energy_it_is_brittle_in_shear():
    law = Cohesive(bond_fracture_energy=ENERGY, bond_shear_energy=1e-3, **BRITTLE)
    _, force = law.drive(np.full(2, -1e6 / KN), np.array([0.999, 1.01]) * (RT + MU * 1e6) / KT)
    assert force == pytest.approx([0.999 * (RT + MU * 1e6), MU * 1e6])


def test_friction_remains_after_the_last_of_the_tension():
    Fn, Ft = COHESIVE.drive(np.array([0.0, 16e-6, -2e-6, -2e-6]), np.array([5e-6, 5e-6, 5e-6, 1e-4]))
    assert Fn == pytest.approx([0.0, 0.0, -4e4, -4e4]) and Ft == pytest.approx([5e4, 0.0, 0.0, 0.5 * 4e4])


RC = 3e5
CRUSHING = Cohesive(bond_fracture_energy=ENERGY, bond_crushing=RC, crushing_hardening=0.0, **BRITTLE)
HARDENING = Cohesive(bond_fracture_energy=ENERGY, bond_crushing=RC, crushing_hardening=0.25, **BRITTLE)


def test_crushing_takes_its_strength_times_the_shortening():
    """Up to three times the elastic limit, back to where the force vanishes, and to the limit again."""
    limit = RC / KN
    un = np.array([0.0, -limit, -3 * limit, -2 * limit, -2.5 * limit, -4 * limit])
    Fn, _ = CRUSHING.drive(un, 0 * un)
    assert Fn == pytest.approx([0.0, -RC, -RC, 0.0, -0.5 * RC, -RC], abs=1e-6 * RC)
    path = np.linspace(0.0, -3 * limit, 301)
    Fn, _ = CRUSHING.drive(path, 0 * path)
    assert work(Fn, path) == pytest.approx(RC * 2 * limit + 0.5 * RC * limit, rel=1e-4)


def test_crushing_hardens_with_what_stays():
    """Three limits of compression: of the two beyond the elastic one, 4/5 stay and 1/5 is more force."""
    limit = RC / KN
    un = np.linspace(0.0, -3 * limit, 301)
    Fn, _ = HARDENING.drive(un, 0 * un)
    assert Fn[-1] == pytest.approx(-1.4 * RC) and work(Fn, un) == pytest.approx(0.5 * RC * limit + 2.4 * RC * limit)
    bond = HARDENING.initial_state()
    for opening in un.tolist():
        HARDENING.respond(bond, opening, (0.0,))
    assert bond.un_plastic == pytest.approx(-1.6 * limit)
    assert HARDENING.respond(bond, -2.9 * limit, (0.0,))[0] == pytest.approx(-1.3 * RC)
    assert HARDENING.respond(bond, -3 * limit - 1e-12, (0.0,))[0] == pytest.approx(-1.4 * RC)


def test_a_crushed_bond_holds_from_where_its_force_vanishes():
    limit, bond = RC / KN, CRUSHING.initial_state()
    CRUSHING.respond(bond, -3 * limit, (0.0,))
    assert CRUSHING.respond(bond, -2 * limit + 0.5 * ONSET, (0.0,))[0] == pytest.approx(0.5 * RN)
    CRUSHING.respond(bond, -2 * limit + 1.01 * END, (0.0,))
    assert bond.broken and bond.un_plastic == pytest.approx(-2 * limit)
    # Broken, it presses from there on, and crushes at the same force.
    for un, force in ((-1.9 * limit, 0.0), (-2.5 * limit, -0.5 * RC), (-4 * limit, -RC), (-3.5 * limit, -0.5 * RC)):
        assert CRUSHING.respond(bond, un, (0.0,))[0] == pytest.approx(force, abs=1e-6 * RC)


def test_bonds_that_crush_are_not_all_but_brittle():
    """A brittle one that YADE has crushed would be thrown apart: past its end it pulls the wrong way until a look."""
    given = dict(kn=KN, kt=KT, bond_tension=RN, bond_cohesion=RT, bond_fracture_energy=1e-9, mu=MU)
    brittle, crushing = Cohesive(**given), Cohesive(**given, bond_crushing=RC)
    assert brittle.gone == pytest.approx(1.001 * ONSET) and crushing.gone == pytest.approx(2 * ONSET)
    assert crushing.fracture_energy()[0] == pytest.approx(2 * 0.5 * RN * ONSET)
    assert Cohesive(**{**given, "bond_fracture_energy": 10 * RN * ONSET}, bond_crushing=RC).gone == 20 * ONSET


def test_bonds_within_grains_crush_and_never_break():
    bond = (inner := CRUSHING.scaled(0.3).unbreakable(kn=2 * KN, kt=KT)).initial_state()
    assert inner.respond(bond, -1.0, (0.0,))[0] == pytest.approx(-0.3 * RC) and CRUSHING.kn == KN
    assert CRUSHING.unbreakable(kn=KN, kt=KT).coupling == 0
    Fn, (Ft,) = inner.respond(bond, 1.0, (1.0,))
    assert Fn == pytest.approx(2 * KN * (1.0 - bond.un_plastic)) and Ft == pytest.approx(KT) and not bond.broken


@pytest.mark.parametrize("law, lengths", [(COULOMB, 2.5), (COHESIVE, 1.0)], ids=["coulomb", "cohesive"])
def test_scaled_by_area(law, lengths):
    """Forces grow with the area. Coulomb's displacements do too; those at the end of softening stay, for the energy
    over the area does."""
    larger = law.scaled(2.5)
    assert (larger.Rn, larger.Rt, larger.kn, larger.kt, larger.mu) == (2.5 * RN, 2.5 * RT, KN, KT, MU)
    if law is COHESIVE:
        assert larger.gone == pytest.approx(lengths * END) and larger.onset == pytest.approx(2.5 * ONSET)
        assert larger.fracture_energy()[0] == pytest.approx(2.5 * ENERGY)
    else:
        path = np.random.default_rng(1).normal(size=(2, 300)) * 2 * ONSET
        for force, more in zip(law.drive(*path), larger.drive(*(lengths * path))):
            np.testing.assert_allclose(2.5 * force, more, atol=1e-9 * RN)
    assert law.Rn == RN


def test_bonds_between_coarser_discs_have_other_strengths_and_the_same_energies():
    law = Cohesive(**{**BRITTLE, "bond_fracture_energy": ENERGY}, bond_shear_energy=4.0, bond_tension_power=-0.5,
                   bond_cohesion_power=0.5)
    coarser = law.coarser(4.0)
    assert (coarser.Rn, coarser.Rt, coarser.kn) == (0.5 * RN, 2 * RT, KN)
    assert coarser.fracture_energy() == pytest.approx((ENERGY, 4.0))
    assert vars(law.coarser(1.0)) == vars(law) and COULOMB.coarser(4.0) is COULOMB


@pytest.mark.parametrize("name, bad", [("bond_tension", 0.0), ("bond_cohesion", -1.0), ("mu", -0.1),
                                       ("bond_fracture_energy", 0.0), ("bond_fracture_energy", math.inf),
                                       ("bond_crushing", -1.0), ("bond_cohesion_power", math.nan)])
def test_refusals_name_the_parameter(name, bad):
    with pytest.raises(ParameterError, match=f"^{name} = "):
        Cohesive(**{**BRITTLE, "bond_fracture_energy": ENERGY, name: bad})

"""Bond laws: the two-disc programme of [Rojek 2003, 4.6] in closed form, and what must hold on any path."""
import math

import numpy as np
import pytest
from scipy.integrate import trapezoid

from rockwear.kernels.bond_laws import (
    Cohesive, Coulomb, ElasticBrittle, ElasticDamage, ElastoPlasticSoftening, Hyperbolic, NonlinearElastoPlastic,
    Parabolic)
from rockwear.kernels.checks import ParameterError

KN, KT, RN, RT, H, MU = 2e10, 1e10, 1e5, 6e4, 1e10, 0.839
BRITTLE = dict(kn=KN, kt=KT, Rn=RN, Rt=RT, mu=MU)
SOFT = dict(BRITTLE, H=H)
BY_AREA = dict(kn=KN, kt=KT, bond_tension=RN, bond_cohesion=2 * RT, mu=MU)
ISOTROPIC = dict(kn=KN, kt=KN, Rn=RN, Rt=RN, H=H, mu=MU)
PADOVA_HARDENING = dict(Rc=2e5, compression=Parabolic(b1=1e14, b2=3e9), tension=Parabolic(b1=-1e14, b2=2e9, b3=1e3),
                        shear=Hyperbolic(b1=5e4, b2=3e-3, b3=1.0, d=0.5), mu=0.7)
LAWS = {
    "brittle": ElasticBrittle(**BRITTLE),
    "damage": ElasticDamage(**SOFT),
    "damage by tension only": ElasticDamage(tension_only=True, **SOFT),
    "elasto-plastic": ElastoPlasticSoftening(**SOFT),
    "Padova, softening": NonlinearElastoPlastic(),
    "Padova, hardening": NonlinearElastoPlastic(**PADOVA_HARDENING),
    "Coulomb": Coulomb(**BY_AREA),
    "cohesive": Cohesive(bond_fracture_energy=0.75, **BY_AREA),
}
SOFTENING = [ElasticDamage, ElastoPlasticSoftening]
TOLERANCE = 1e-9  # of the strength, in every comparison with a closed form


def every_law(test):
    return pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())(test)


def both_softening(test):
    return pytest.mark.parametrize("kind", SOFTENING)(test)


@pytest.mark.parametrize("law", [one for one in LAWS.values() if hasattr(one, "stronger")],
                         ids=[name for name, one in LAWS.items() if hasattr(one, "stronger")])
def test_a_bond_within_a_grain_takes_the_energy_of_its_own_stiffness(law):
    """Pulled apart it takes what its law says of it, whatever law it was made from."""
    inner = law.stronger(2.0, kn=4 * KN, kt=3 * KT)
    energy, _ = inner.fracture_energy()
    opening = np.linspace(0.0, 4 * energy / inner.Rn, 20001)
    forces, _, _ = follow(inner, opening, np.zeros((len(opening), 1)))
    assert forces[:, 0].max() == pytest.approx(2 * RN, rel=1e-3) and forces[-1, 0] == 0.0
    assert trapezoid(forces[:, 0], opening) == pytest.approx(energy, rel=2e-3)


def assert_close(force, expected, strength=RN):
    np.testing.assert_allclose(force, expected, rtol=0.0, atol=TOLERANCE * strength)


def line(u, k, R, H):
    """Force of monotone loading: up with k to R, down with H to zero."""
    return np.where(u <= R / k, k * u, np.maximum(R - H * (u - R / k), 0.0))


def follow(law, un, ut):
    """Forces, stored energy and states along a path; ut has a row per step and a column per component."""
    bond, forces, stored, states = law.initial_state(), [], [], []
    for opening, shift in zip(un.tolist(), ut.tolist()):
        Fn, Ft = law.respond(bond, opening, tuple(shift))
        forces.append((Fn, *Ft))
        stored.append(law.stored_energy(bond, opening, shift, Fn, Ft))
        states.append([getattr(bond, name, 0.0) for name in ("softening", "alpha_n", "alpha_c", "alpha_t")])
    return np.array(forces), np.array(stored), np.array(states)


def random_path(seed, components=2, legs=12, steps=300):
    """Straight legs between random points some peak displacements from the origin; drawn to compression or tension."""
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(legs, 1 + components)) * rng.choice([0.5, 2.0, 6.0], size=(legs, 1)) * RN / KN
    corners[:, 0] += rng.choice([-2.0, 0.0, 1.0]) * RN / KN
    corners = np.vstack([np.zeros(1 + components), corners])
    path = np.vstack([start + (end - start) * np.linspace(0.0, 1.0, steps, endpoint=False)[:, None]
                      for start, end in zip(corners, corners[1:])])
    return path[:, 0], path[:, 1:]


# The programme of [Rojek 2003, 4.6]

U = np.linspace(0.0, 30e-6, 301) + 1e-9  # off the corners, where the brittle law jumps
ZERO = np.zeros_like(U)


@both_softening
def test_tension_peaks_at_5_and_ends_at_15_micrometres(kind):
    u = np.array([2.5e-6, 5e-6, 10e-6, 14e-6, 15e-6 * (1 + 1e-12), 20e-6])
    Fn, Ft = kind(**SOFT).drive(u, 0 * u)
    assert_close(Fn, [5e4, 1e5, 5e4, 1e4, 0.0, 0.0])
    assert_close(Ft, 0.0)


@both_softening
def test_tension_and_shear_fall_with_slope_H(kind):
    law = kind(**SOFT)
    assert_close(law.drive(U, ZERO)[0], line(U, KN, RN, H))
    assert_close(law.drive(ZERO, U)[1], line(U, KT, RT, H), RT)


def test_brittle_in_tension_and_shear():
    law = LAWS["brittle"]
    assert_close(law.drive(U, ZERO)[0], np.where(KN * U <= RN, KN * U, 0.0))
    assert_close(law.drive(ZERO, U)[1], np.where(KT * U <= RT, KT * U, 0.0), RT)


def test_unloading_in_tension():
    u = np.array([10e-6, 8e-6, 6e-6, 8e-6, 10e-6, 12e-6])
    assert_close(ElastoPlasticSoftening(**SOFT).drive(u, 0 * u)[0], [5e4, 1e4, -3e4, 1e4, 5e4, 3e4])
    assert_close(ElasticDamage(**SOFT).drive(u, 0 * u)[0], [5e4, 4e4, 3e4, 4e4, 5e4, 3e4])
    u = np.array([4e-6, 1e-6, -1e-6, 6e-6, 4e-6, -1e-6])
    assert_close(ElasticBrittle(**BRITTLE).drive(u, 0 * u)[0], [8e4, 2e4, -2e4, 0.0, 0.0, -2e4])


def test_unloading_in_shear_reverses_and_softens_on_both_sides():
    u = np.array([7e-6, 5e-6, -5e-6, -6e-6])  # at 7 um slip 2 um and 50 kN; yields again at -3 um, down with H
    assert_close(ElastoPlasticSoftening(**SOFT).drive(0 * u, u)[1], [5e4, 3e4, -3e4, -2e4], RT)
    assert_close(ElasticDamage(**SOFT).drive(0 * u, u)[1], [5e4, 5e4 * 5 / 7, -5e4 * 5 / 7, -5e4 * 6 / 7], RT)


@pytest.mark.parametrize("law", [law for law in LAWS.values() if getattr(law, "Rc", math.inf) == math.inf])
def test_compression_is_elastic_and_leaves_the_bond_whole(law):
    bond = law.initial_state()
    for u in (-1e-7, -5e-6, -1e-3, -2e-6):
        assert law.respond(bond, u, (0.0,))[0] == pytest.approx(law.kn * u, rel=1e-12)
    assert bond.softening == 0.0
    Fn, _ = law.respond(bond, 4e-6, (0.0,))
    assert Fn == pytest.approx(law.kn * 4e-6, rel=1e-12)


@both_softening
def test_shear_with_compression_softens_down_to_friction(kind):
    ut = np.linspace(0.0, 60e-6, 601)
    Fn, Ft = kind(**SOFT).drive(-ut / 10, ut)
    assert_close(Fn, -KN * ut / 10)
    assert_close(Ft, np.where(KT * ut <= RT, KT * ut, np.maximum(line(ut, KT, RT, H), MU * KN * ut / 10)), RT)


def test_shear_with_compression_brittle():
    ut = np.linspace(0.0, 60e-6, 601) + 1e-9
    _, Ft = LAWS["brittle"].drive(-ut / 10, ut)
    assert_close(Ft, np.where(KT * ut <= RT, KT * ut, np.minimum(KT * ut, MU * KN * ut / 10)), RT)


@pytest.mark.parametrize("kind", [ElasticBrittle, *SOFTENING])
def test_strong_compression_hands_the_bond_over_to_friction_without_a_jump(kind):
    law = kind(**(BRITTLE if kind is ElasticBrittle else SOFT))
    ut = np.linspace(0.0, 30e-6, 61)
    Fn, Ft = law.drive(np.full_like(ut, -20e-6), ut)   # mu |Fn| = 335.6 kN
    assert MU * KN * 20e-6 > KT * ut[-1]
    assert_close(Ft, KT * ut, RT)


def test_shear_with_tension_elastoplastic_resultant_reaches_the_strength():
    law = ElastoPlasticSoftening(**ISOTROPIC)
    Fn, Ft = law.drive(U, 2 * U)
    assert_close(np.hypot(Fn, Ft), line(U * math.sqrt(5.0), KN, RN, H))
    assert_close(Ft, 2 * Fn)
    peak = law.drive(np.array([RN / KN / math.sqrt(5.0)]), np.array([2 * RN / KN / math.sqrt(5.0)]))
    assert_close(np.hypot(*peak), RN)
    assert peak[0] < RN and peak[1] < RN


def test_shear_with_tension_elastoplastic_follows_the_ellipse():
    law = ElastoPlasticSoftening(**SOFT)
    x, y = KN * U / RN, KT * 2 * U / RT
    trial = np.hypot(x, y)
    loss = np.hypot(x / trial * H / (H + KN), y / trial * H / (H + KT))
    size = np.where(trial <= 1.0, trial, np.maximum((1.0 - trial * loss) / (1.0 - loss), 0.0))
    Fn, Ft = law.drive(U, 2 * U)
    assert_close(Fn, RN * size * x / trial)
    assert_close(Ft, RT * size * y / trial)


def test_shear_with_tension_damage_larger_component_reaches_its_strength():
    Fn, Ft = ElasticDamage(**ISOTROPIC).drive(U, 2 * U)
    assert_close(Ft, line(2 * U, KN, RN, H))
    assert_close(Fn, Ft / 2)


def test_damage_by_tension_only_ignores_shear():
    law = LAWS["damage by tension only"]
    assert_close(law.drive(ZERO, U)[1], KT * U, RT)
    Fn, Ft = law.drive(U, 2 * U)
    left = line(U, KN, RN, H) / (KN * U)
    assert_close(Fn, left * KN * U)
    assert_close(Ft, left * KT * 2 * U)


# The contact that remains

@pytest.mark.parametrize("name", ["brittle", "damage", "damage by tension only", "elasto-plastic"])
def test_broken_bond_is_a_coulomb_contact(name):
    un = np.array([1e-3, -1e-6, -1e-6, -1e-6, -1e-6, -2e-6, 1e-9, -1e-6])
    ut = np.array([0.0, 1e-6, 2e-6, 1.5e-6, -9e-6, -9.1e-6, -9.1e-6, -9.1e-6])
    Fn, Ft = LAWS[name].drive(un, ut)
    limit = MU * 2e4
    assert_close(Fn, [0.0, -2e4, -2e4, -2e4, -2e4, -4e4, 0.0, -2e4])
    assert_close(Ft, [0.0, 1e4, limit, limit - 5e3, -limit, -limit - 1e3, 0.0, 0.0], RT)


def test_damaged_bond_hands_over_its_own_force():
    law = ElasticDamage(**SOFT)
    bond = law.initial_state()
    law.respond(bond, 10e-6, (0.0,))                    # omega = 3/4
    assert bond.softening == pytest.approx(0.75)
    _, (before,) = law.respond(bond, -50e-6, (9.5e-6,))
    assert not bond.broken and before == pytest.approx(0.25 * KT * 9.5e-6)
    _, (after,) = law.respond(bond, -50e-6, (9.7e-6,))  # damage starts again at 9.6 um, far below friction
    assert bond.broken and after == pytest.approx(0.25 * KT * 9.7e-6)
    assert law.respond(bond, -50e-6, (9.8e-6,))[1][0] == pytest.approx(after + KT * 0.1e-6)


# Energy

@pytest.mark.parametrize("law", [LAWS["brittle"], LAWS["damage"], LAWS["elasto-plastic"]])
def test_work_until_broken(law):
    for axis, (k, R) in enumerate(((KN, RN), (KT, RT))):
        expected = 0.5 * R * R / k + 0.5 * R * R / law.H
        assert law.fracture_energy()[axis] == pytest.approx(expected, rel=1e-12)
        u = np.array([0.0, R / k * (1 - 1e-12), R / k * (1 + 1e-12), (R / k + R / law.H) * (1 + 1e-11), 1e-3])
        force = law.drive(*((u, 0 * u) if axis == 0 else (0 * u, u)))[axis]
        work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(u))
        assert work == pytest.approx(expected, rel=1e-9)


@every_law
@pytest.mark.parametrize("seed", range(25))
def test_no_path_creates_energy_and_no_state_heals(law, seed):
    un, ut = random_path(seed)
    forces, stored, states = follow(law, un, ut)
    path = np.column_stack([un, ut])
    work = np.cumsum(np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(path, axis=0), axis=1))
    dissipated = work - stored[1:]
    # The trapezoid cuts the corners of the force, by the order of the square of a step: the slack is that error.
    slack = 0.25 * KN * np.sum(np.diff(path, axis=0) ** 2, axis=1)
    lost = np.diff(dissipated, prepend=0.0)
    assert (lost >= -slack - 1e-12).all()
    assert (np.maximum.accumulate(dissipated) - dissipated).max() <= 5e-4 * RN * RN / KN
    assert (np.diff(states, axis=0) >= 0.0).all()


@pytest.mark.parametrize("name", ["Padova, softening", "Padova, hardening"])
def test_padova_shear_cycle_under_changing_compression_costs_energy(name):
    """[Rojek 2003, eq. 4.13] taken literally would return more than was put in: shear, compress, unload."""
    corners = np.array([[0, 0], [-1e-6, 2e-6], [-40e-6, 2e-6], [-40e-6, -1e-6], [-1e-6, -1e-6], [-1e-6, 0], [0, 0.0]])
    path = np.vstack([a + (b - a) * np.linspace(0, 1, 400, endpoint=False)[:, None]
                      for a, b in zip(corners, corners[1:])])
    law = NonlinearElastoPlastic() if name.endswith("softening") else NonlinearElastoPlastic(
        **dict(PADOVA_HARDENING, Rc=math.inf))
    forces, stored, _ = follow(law, path[:, 0], path[:, 1:])
    work = np.cumsum(np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(path, axis=0), axis=1))
    dissipated = work - stored[1:]
    assert np.diff(dissipated).min() >= -1e-4 * dissipated[-1] and dissipated[-1] > 0.0


# Hard cases: nearly vertical softening, one strength far below the other, cycles around the peak

HARD = [(KN, RN, RT, slope) for slope in (1e4 * KN, 1e-2 * KN)] + [
    (KN, RN, 1e-3 * RN, H), (KN, RN, 1e3 * RN, H), (KN, 1e-3 * RN, 1e-6 * RN, 1e4 * KN), (KN, RN, 1e3 * RN, 1e4 * KN)]


def hard(test):
    """Both softening laws, stiffness, strengths and slope at their extremes."""
    test = pytest.mark.parametrize("kn, Rn, Rt, slope", HARD)(test)
    return both_softening(test)


def around_the_peak(law, seed, step, count):
    """A random walk about the peak in both directions, `step` times the displacements of the peak wide at each step.

    It is held back towards a point near the peak and drifts outwards, through tension as through compression.
    """
    rng = np.random.default_rng(seed)
    centre = rng.uniform([-1.0, -1.2], [1.2, 1.2])
    place, path = np.zeros(2), [np.zeros(2)]
    for k in range(count):
        place = place + step * rng.normal(size=2) + min(step, 1.0) * (centre * (1.0 + k / count) - place)
        path.append(place)
    return np.array(path) * [law.Rn / law.kn, law.Rt / law.kt]


@hard
@pytest.mark.parametrize("step", [1e-3, 0.1, 5.0])
def test_hard_cases_stay_within_the_strength(kind, kn, Rn, Rt, slope, step):
    law = kind(kn=kn, kt=KT, Rn=Rn, Rt=Rt, H=slope, mu=MU)
    broken = 0
    for seed in range(3):
        un, ut = around_the_peak(law, seed, step, 400 if step > 0.01 else 3000).T
        forces, _, states = follow(law, un, ut[:, None])
        Fn, Ft = forces.T
        assert np.isfinite(forces).all() and (np.diff(states, axis=0) >= 0.0).all()
        assert (Fn <= Rn * (1 + 1e-12)).all()
        assert (Fn >= np.minimum(kn * (un - np.maximum.accumulate(un)), 0.0) - 1e-9).all()
        assert (abs(Ft) <= np.maximum(Rt, MU * np.maximum(-Fn, 0.0)) * (1 + 1e-12)).all()
        apart = states[:, 0] == 1.0
        broken += apart.any()
        assert (Fn[apart] <= 0.0).all()
        assert (abs(Ft[apart]) <= MU * abs(Fn[apart]) * (1 + 1e-9)).all()
    assert broken > 0 or slope <= H


@hard
def test_hard_cases_create_no_energy(kind, kn, Rn, Rt, slope):
    law = kind(kn=kn, kt=KT, Rn=Rn, Rt=Rt, H=slope, mu=MU)
    for seed in range(2):
        un, ut = around_the_peak(law, seed, 3e-3, 3000).T
        forces, stored, _ = follow(law, un, ut[:, None])
        steps = np.diff(np.column_stack([un, ut]), axis=0)
        lost = np.sum(0.5 * (forces[1:] + forces[:-1]) * steps, axis=1) - np.diff(stored)
        slack = 0.25 * np.sum([kn, KT] * steps**2, axis=1)
        assert (lost >= -slack - 1e-9 * law.fracture_energy()[0]).all()
        assert lost.sum() >= -1e-9 * law.fracture_energy()[0]


@hard
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("seed", range(3))
def test_cycles_around_the_peak_cost_exactly_the_fracture_energy(kind, kn, Rn, Rt, slope, axis, seed):
    """Loaded further and further, unloaded in between: the work is exact, for every force is a line between corners."""
    law, rng = kind(kn=kn, kt=KT, Rn=Rn, Rt=Rt, H=slope, mu=MU), np.random.default_rng(seed)
    k, R = (kn, Rn) if axis == 0 else (KT, Rt)
    peak, corners = R / k, [0.0, 0.7 * R / k, 0.2 * R / k, R / k]
    for part in np.sort(rng.uniform(size=10)):
        reached = peak + part * R / slope
        force = R - slope * (reached - peak)
        # back, at most to where an elasto-plastic bond is free of stress, and to the same place again
        corners += [reached, reached - rng.uniform() * force / k, reached]
    corners += [(peak + R / slope) * (1 + 1e-12), 2 * (peak + R / slope)]
    shares = [np.sort(np.append(rng.uniform(size=rng.integers(0, 6)), 0.0)) for _ in corners[1:]]
    path = np.concatenate([a + (b - a) * share for a, b, share in zip(corners, corners[1:], shares)] + [corners[-1:]])
    forces = law.drive(*((path, 0 * path) if axis == 0 else (0 * path, path)))[axis]
    work = np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(path))
    assert work == pytest.approx(law.fracture_energy()[axis], rel=1e-6)
    assert forces[-1] == 0.0


# The limit of no softening

@both_softening
@pytest.mark.parametrize("slope", [math.inf, 1e6 * KN, 1e300])
def test_infinite_slope_is_brittle(kind, slope):
    soft, brittle = kind(**dict(SOFT, H=slope)), LAWS["brittle"]
    paths = [(U, ZERO), (ZERO, U), (-U / 10, U), (-U, U), (ZERO - 3e-6, U), (ZERO - 3e-6, 20e-6 * np.sin(U * 1e6))]
    if kind is ElasticDamage:
        paths += [(U, 2 * U)] + [(un, ut[:, 0]) for un, ut in (random_path(seed, 1) for seed in range(10))]
    for un, ut in paths:
        for force, expected in zip(soft.drive(un, ut), brittle.drive(un, ut)):
            assert_close(force, expected)


def test_infinite_slope_with_tension_and_shear_breaks_on_the_ellipse():
    law = ElastoPlasticSoftening(**dict(SOFT, H=math.inf))
    trial = np.hypot(KN * U / RN, KT * 2 * U / RT)
    Fn, Ft = law.drive(U, 2 * U)
    assert_close(Fn, np.where(trial <= 1.0, KN * U, 0.0))
    assert_close(Ft, np.where(trial <= 1.0, KT * 2 * U, 0.0))


# Sampling, symmetry, vectors

STRENGTHS = [(RN, RT), (RN, 1e-4 * RN), (1e-4 * RT, RT), (RN, RN)]


@both_softening
@pytest.mark.parametrize("Rn, Rt", STRENGTHS)
@pytest.mark.parametrize("slope", [1e-3 * KN, H, 1e6 * KN])
def test_proportional_path_does_not_depend_on_its_sampling(kind, Rn, Rt, slope):
    law = kind(kn=KN, kt=KT, Rn=Rn, Rt=Rt, H=slope, mu=MU)
    for direction in np.linspace(-0.5, 0.5, 9) * math.pi:
        # long enough to go past the end of the bond in the direction that ends first
        reach = 1.3 * max(Rn * (1 / KN + 1 / slope), Rt * (1 / KT + 1 / slope))
        s = reach * np.concatenate([np.linspace(0.0, 0.05, 400), np.linspace(0.05, 1.0, 400)[1:]]) * (1 + 1e-7)
        un, ut = s * math.sin(direction), s * math.cos(direction)
        fine = law.drive(un, ut)
        for stop in (len(s) // 3, len(s) // 2, len(s) - 1):
            for few in ([stop], [stop // 3, stop], [0, stop // 7, stop // 2, stop]):
                coarse = law.drive(un[few], ut[few])
                for one, other in zip(coarse, fine):
                    scale = max(Rn, Rt, np.abs(other).max())
                    assert abs(one[-1] - other[stop]) <= TOLERANCE * scale


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("name", ["brittle", "damage", "elasto-plastic", "Padova, softening", "Padova, hardening"])
def test_cycles_in_one_direction_do_not_depend_on_their_sampling(name, axis):
    corners = 1e-6 * np.array([0.0, 4.0, 1.0, 6.5, -3.0, 7.5, -8.0, 8.1, 40.0, -3.0, 2.0])
    legs = [np.linspace(a, b, 50, endpoint=False) for a, b in zip(corners, corners[1:])]
    fine = np.append(np.concatenate(legs), corners[-1])
    every, few = (LAWS[name].drive(*((u, 0 * u) if axis == 0 else (0 * u, u)))[axis] for u in (fine, corners))
    assert_close(every[::50], few)


@pytest.mark.parametrize("stiffening", [-1e5, -1e3, -1e7])
def test_padova_elastic_shear_is_exact_while_compression_grows(stiffening):
    law = NonlinearElastoPlastic(r=stiffening, eta=10.0)
    s = np.linspace(0.0, 5e-6, 1001)
    _, fine = law.drive(-s, s)
    _, coarse = law.drive(-s[[0, 1000]], s[[0, 1000]])
    assert_close(coarse[-1], fine[-1])
    a, b = -law.r, -law.r + law.kn * s[-1]
    assert_close(coarse[-1], law.m * 0.75 * (b ** (4 / 3) - a ** (4 / 3)) / law.kn)


@every_law
def test_shear_force_is_odd(law):
    for seed in range(5):
        un, ut = random_path(seed, 1)
        Fn, Ft = law.drive(un, ut[:, 0])
        Fn_mirrored, Ft_mirrored = law.drive(un, -ut[:, 0])
        np.testing.assert_array_equal(Fn, Fn_mirrored)
        np.testing.assert_array_equal(Ft, -Ft_mirrored)


@every_law
def test_rotating_the_displacement_rotates_the_force(law):
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    for seed in range(5):
        un, ut = random_path(seed, 3, steps=50)
        one, other = follow(law, un, ut)[0], follow(law, un, ut @ turn.T)[0]
        assert_close(other[:, 0], one[:, 0])
        assert_close(other[:, 1:], one[:, 1:] @ turn.T)


@every_law
def test_one_two_and_three_components_agree(law):
    un, ut = random_path(3, 1)
    Fn, Ft = law.drive(un, ut[:, 0])
    direction = np.array([0.6, 0.0, -0.8])
    for axes in ([0.6, 0.8], direction):
        forces = follow(law, un, ut * np.array(axes))[0]
        assert_close(forces[:, 0], Fn)
        assert_close(forces[:, 1:], Ft[:, None] * np.array(axes))


@every_law
@pytest.mark.parametrize("turn_at", [100, 400, 700])
def test_rotating_state_and_displacement_on_the_way_rotates_the_force(law, turn_at):
    """What the engine does when a contact rotates: the vectors named by the state are rotated with ut."""
    for seed in range(5):
        un, ut = random_path(seed, 2, legs=3)
        still, turned = law.initial_state(), law.initial_state()
        for step, (opening, (a, b)) in enumerate(zip(un.tolist(), ut.tolist())):
            if step == turn_at:
                for name in turned.vectors:
                    x, y, *_ = getattr(turned, name)  # three zeros until the first slip
                    setattr(turned, name, (-y, x))
            Fn, (x, y) = law.respond(still, opening, (a, b))
            other, shear = law.respond(turned, opening, (a, b) if step < turn_at else (-b, a))
            assert other == Fn
            assert math.dist(shear, (x, y) if step < turn_at else (-y, x)) <= TOLERANCE * RN


@pytest.mark.parametrize("name", ["brittle", "damage", "damage by tension only"])
def test_the_elastic_domain_of_a_new_bond_is_its_strength(name):
    domain = LAWS[name].elastic_domain(LAWS[name].initial_state())
    assert domain == (KN, KT, RN, RT, 0.0)


def test_the_elastic_domain_of_a_new_elastoplastic_bond_has_its_corner_on_the_ellipse():
    domain = LAWS["elasto-plastic"].elastic_domain(LAWS["elasto-plastic"].initial_state())
    assert domain.Fn == pytest.approx(domain.Ft, rel=1e-12)
    assert (domain.Fn / RN) ** 2 + (domain.Ft / RT) ** 2 == pytest.approx(1.0, rel=1e-12)


def test_a_law_that_is_nowhere_linear_has_no_elastic_domain():
    law = NonlinearElastoPlastic()
    assert law.elastic_domain(law.initial_state()) is None


@pytest.mark.parametrize("name", ["brittle", "damage", "damage by tension only", "elasto-plastic"])
@pytest.mark.parametrize("seed", range(10))
def test_inside_its_elastic_domain_a_bond_is_linear_whatever_its_history(name, seed):
    """At every step of a random path, forces anywhere within the domain are those of constant springs."""
    law, rng = LAWS[name], np.random.default_rng(100 + seed)
    un, ut = random_path(seed, 1, steps=60)
    bond, domains = law.initial_state(), 0
    for opening, shift in zip(un.tolist(), ut[:, 0].tolist()):
        Fn, (Ft,) = law.respond(bond, opening, (shift,))
        if bond.broken:
            break
        domain = law.elastic_domain(bond, Fn, abs(Ft))
        if domain is None:
            continue
        domains += 1
        assert Fn <= domain.Fn and abs(Ft) <= domain.Ft + domain.slope * Fn
        assert domain.kn * (opening - bond.un_plastic) == pytest.approx(Fn, rel=1e-9, abs=TOLERANCE * RN)
        assert domain.kt * (shift - bond.ut_plastic[0]) == pytest.approx(Ft, rel=1e-9, abs=TOLERANCE * RN)
        for compression in rng.uniform(0.0, 5 * RN, 4):
            for normal in (domain.Fn * rng.uniform(), domain.Fn * (1 - 1e-12), -compression):
                limit = min(domain.Ft + domain.slope * normal, 20 * RT)
                if limit < 0.0:
                    continue
                shear = limit * rng.uniform(-1.0, 1.0) * rng.choice([1.0, 1 - 1e-12])
                copy = law.initial_state()
                for field in ("softening", "un_plastic", "ut_plastic"):
                    setattr(copy, field, getattr(bond, field))
                answer = law.respond(copy, bond.un_plastic + normal / domain.kn,
                                     (bond.ut_plastic[0] + shear / domain.kt,))
                assert_close(answer[0], normal)
                assert_close(answer[1][0], shear)
                assert copy.softening <= bond.softening + 1e-12
    assert domains > 0


# The Padova law by itself

def test_padova_tension_with_linear_softening_is_the_simplified_law():
    plastic_modulus = H * KN / (H + KN)
    law = NonlinearElastoPlastic(kn=KN, Rn=RN, c=1e9, tension=Parabolic(b2=-plastic_modulus))
    assert_close(law.drive(U, ZERO)[0], line(U, KN, RN, H))


def test_padova_parabolic_yield_force():
    law = NonlinearElastoPlastic(c=1e9, tension=Parabolic(b1=-1e15, b2=2e9, b3=-2e4))
    un = np.array([6e-6, 9e-6, 9.8e-6])
    Fn, _ = law.drive(un, 0 * un)
    alpha = un - Fn / law.kn
    assert_close(Fn, RN - 1e15 * alpha ** 2 + 2e9 * alpha - 2e4)
    assert (Fn > 0.0).all() and (alpha > 1e-6).all()


def test_padova_shear_threshold_and_hyperbola():
    shear = Hyperbolic(b1=5e4, b2=3e-3, b3=1.0, d=0.5)
    law = NonlinearElastoPlastic(shear=shear, eta=0.6, c=1e5, mu=0.5)
    un = np.full(50, -10e-6)
    ut = np.linspace(0.0, 60e-6, 50)
    Fn, Ft = law.drive(un, ut)
    # kt is that of |Fn| = 200 kN only after the first step, which carries no shear
    kt = law.m * (2e5 + 1e5) ** (1 / 3)
    alpha = ut - Ft / kt
    yields = kt * ut > 0.6 * (1e5 + 2e5)
    assert yields.any() and not yields.all()
    assert_close(Ft, np.where(yields, 0.6 * 3e5 + 5e4 * alpha ** 0.5 / (3e-3 + alpha ** 0.5 + (alpha == 0)), kt * ut))


def test_padova_shear_softens_down_to_friction():
    law = NonlinearElastoPlastic(mu=0.9)
    ut = np.linspace(0.0, 60e-6, 601)
    Fn, Ft = law.drive(np.full_like(ut, -5e-6), ut)    # Fn = -100 kN throughout, so kt is constant
    kt, strength = law.m * 2e5 ** (1 / 3), 0.8 * (1.25e5 + 1e5)
    softening = kt * 5e9 / (kt - 5e9)
    assert_close(Ft, np.minimum(kt * ut, np.maximum(line(ut, kt, strength, softening), 0.9 * 1e5)))


def test_padova_compression_hardens_and_keeps_its_plastic_displacement():
    law = NonlinearElastoPlastic(Rc=1e5, compression=Parabolic(b2=5e9))
    u = np.array([-5e-6, -10e-6, -8e-6, 100e-6, -4e-6, -8e-6])
    Fn, _ = law.drive(u, 0 * u)
    assert_close(Fn, [-1e5, -1.2e5, -8e4, 0.0, 0.0, -8e4])


def test_padova_breaks_at_once_where_softening_is_steeper_than_the_spring():
    law = NonlinearElastoPlastic(tension=Parabolic(b2=-3e10))
    assert_close(law.drive(U, ZERO)[0], np.where(KN * U <= RN, KN * U, 0.0))


# Stiffness

@every_law
def test_no_elastic_step_is_stiffer_than_the_bound(law):
    kn, kt = law.stiffest()
    assert kn >= law.kn and kt >= law.kt
    for seed in range(10):
        un, ut = random_path(seed)
        forces, _, states = follow(law, un, ut)
        elastic = (np.diff(states, axis=0) == 0.0).all(axis=1)
        change = np.diff(forces[:, 0])[elastic]
        assert (abs(change) <= kn * abs(np.diff(un)[elastic]) + 1e-9 * RN).all()


@pytest.mark.parametrize("r", [-1e5, 0.0, 3e4, 1e9])
def test_padova_is_stiffest_at_its_largest_compression_or_at_none(r):
    law = NonlinearElastoPlastic(r=r, eta=10.0)
    kn, kt = law.stiffest()
    assert kn == law.kn
    slopes = []
    for compression in (0.0, *np.geomspace(1e3, 100 * law.Rn, 30)):
        bond = law.initial_state()
        law.respond(bond, -compression / law.kn, (0.0,))
        _, (force,) = law.respond(bond, -compression / law.kn, (1e-9,))
        slopes.append(force / 1e-9)
    assert max(slopes) == pytest.approx(kt, rel=1e-9)
    assert law.scaled(3.0).stiffest() == pytest.approx((kn, kt), rel=1e-12)


def test_a_compressive_strength_above_the_bound_raises_it():
    high, low = NonlinearElastoPlastic(Rc=1e9).stiffest()[1], NonlinearElastoPlastic(Rc=1e5).stiffest()[1]
    assert low == NonlinearElastoPlastic().stiffest()[1]
    assert high == pytest.approx(2e8 * (1e9 + 1e5)**(1 / 3), rel=1e-12)


# Parameters

def test_the_padova_parameters_stand_for_the_law_of_its_defaults():
    values = {parameter.name: parameter.default for parameter in NonlinearElastoPlastic.parameters}
    law, un = NonlinearElastoPlastic.from_values(values), random_path(1, 1)
    for got, expected in zip(law.drive(un[0], un[1][:, 0]), NonlinearElastoPlastic(mu=MU).drive(un[0], un[1][:, 0])):
        np.testing.assert_array_equal(got, expected)


@pytest.mark.parametrize("values, direct", [
    (dict(padova_m=3e8), dict(m=3e8)), (dict(padova_r=1e4), dict(r=1e4)), (dict(padova_eta=0.5), dict(eta=0.5)),
    (dict(padova_cohesion=2e5), dict(c=2e5)), (dict(padova_tension_b2=-1e9), dict(tension=Parabolic(b2=-1e9))),
    (dict(padova_shear_b2=-1e9), dict(shear=Parabolic(b2=-1e9))), (dict(kn=1e10, Rn=2e5, mu=0.2),) * 2])
def test_each_padova_parameter_reaches_the_law(values, direct):
    defaults = {parameter.name: parameter.default for parameter in NonlinearElastoPlastic.parameters}
    law = NonlinearElastoPlastic.from_values({**defaults, **values})
    un = 1e-6 * np.array([1, 3, 5, 6, 7, -9, -9, -9, -9, -9.0])
    ut = 1e-6 * np.array([1, 2, 3, 4, 4, 4, 20, 30, 40, 90.0])
    found = law.drive(un, ut)
    for got, expected in zip(found, NonlinearElastoPlastic(**{"mu": MU, **direct}).drive(un, ut)):
        np.testing.assert_array_equal(got, expected)
    assert any((got != plain).any() for got, plain in zip(found, NonlinearElastoPlastic(mu=MU).drive(un, ut)))


@pytest.mark.parametrize("kind, good", [
    (ElasticBrittle, BRITTLE), (ElasticDamage, SOFT), (ElastoPlasticSoftening, SOFT), (Coulomb, BY_AREA),
    (Cohesive, dict(BY_AREA, bond_fracture_energy=0.75))])
def test_bad_parameters_are_named(kind, good):
    for name in good:
        for bad in (-1.0, math.nan, "stiff", None) + (() if name == "mu" else (0.0,)):
            with pytest.raises(ParameterError, match=f"^{name} = "):
                kind(**dict(good, **{name: bad}))
    with pytest.raises(TypeError):
        kind(*good.values())


@pytest.mark.parametrize("name, bad", [
    ("kn", 0.0), ("m", -1.0), ("r", math.inf), ("eta", -0.1), ("c", 0.0), ("Rn", 0.0), ("Rc", -1.0), ("mu", -1.0),
    ("tension", 1.0), ("compression", Hyperbolic(b1=1.0, b2=1.0, b3=1.0)), ("compression", Parabolic(b2=-1.0)),
    ("shear", None), ("tension", Parabolic(b3=-2e5))])
def test_bad_padova_parameters_are_named(name, bad):
    with pytest.raises(ParameterError, match=name):
        NonlinearElastoPlastic(**{name: bad})


def test_bad_hardening_functions_are_named():
    with pytest.raises(ParameterError, match="b1"):
        Parabolic(b1=1.0, b2=-1.0)
    with pytest.raises(ParameterError, match="^d = "):
        Hyperbolic(b1=1.0, b2=1.0, b3=1.0, d=0.0)
    with pytest.raises(ParameterError, match="tension_only"):
        ElasticDamage(**SOFT, tension_only="yes")


@every_law
def test_bad_paths_are_named(law):
    good = np.zeros(3)
    for un, ut, name in ((np.zeros((3, 1)), good, "un"), (good, np.zeros(2), "ut"),
                         (good, np.array([0.0, np.nan, 0.0]), "ut")):
        with pytest.raises(ParameterError, match=f"^{name} = "):
            law.drive(un, ut)

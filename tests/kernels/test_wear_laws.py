"""Wear laws against closed forms, against each other at Coulomb's limit, and fitted back from tests they made."""
import numpy as np
import pytest

from rockwear.kernels.archard import wear_rate
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.wear_fitting import LaboratoryTest
from rockwear.kernels.wear_laws import (
    FRICTION, NORMAL, WEAR_LAWS, DissipationArchard, PowerLaw, PressureArchard, SumOfModes)

MU, K, H = 0.3, 0.0113, 5e9
AREA = np.array([0.8e-3, 1.0e-3, 0.9e-3])
PUSH, SLIP = np.array([2e3, 5e4, 7e3]), np.array([1e-4, 3e-5, 0.0])


def slid(law, friction=MU):
    """Sums that contacts with the forces PUSH and friction * PUSH leave when they slide by SLIP."""
    forces = {NORMAL: PUSH, FRICTION: friction * PUSH}
    return {(force, n): forces[force]**n * SLIP for force, n in law.needs}


def laboratory(law, p=(10e6, 20e6, 40e6, 80e6), s=(100.0, 100.0, 200.0, 50.0), error=0.0, noise=0.0):
    """Tests as the law itself would have them."""
    p, s, hardness = np.array(p), np.array(s), np.linspace(4.5e9, 5e9, len(p))
    test = LaboratoryTest(pressure=p, friction_stress=MU * p, distance=s, depth=np.ones(len(p)), hardness=hardness,
                          rate_error=np.full(len(p), error), **{f"{name}_error": np.zeros(len(p)) for name in
                                                                ("pressure", "friction", "hardness")})
    modes = getattr(law, "modes", [law])
    test.depth = sum(mode.k * mode.depth_per_k(test) for mode in modes) * (1 + noise)
    return test


def test_pressure_and_dissipation_agree_at_coulombs_limit_and_only_there():
    by_pressure, by_work = PressureArchard(k=K), DissipationArchard(k=K, mu=MU)
    exact = K * PUSH * SLIP / H
    assert by_pressure.volume(slid(by_pressure), H, AREA) == pytest.approx(exact, rel=1e-14)
    assert by_work.volume(slid(by_work), H, AREA) == pytest.approx(exact, rel=1e-14)
    # Rougher contacts than the law was told of dissipate more, and press no more.
    assert by_pressure.volume(slid(by_pressure, 0.6), H, AREA) == pytest.approx(exact, rel=1e-14)
    assert by_work.volume(slid(by_work, 0.6), H, AREA) == pytest.approx(2 * exact, rel=1e-14)


def test_the_dissipation_form_is_archards_volume_of_the_work():
    law, hardness, work = DissipationArchard(k=K, mu=MU), np.array([5e9, 4e9, 3e9]), MU * PUSH * SLIP
    assert law.volume(slid(law), hardness, AREA) == pytest.approx(K / MU * work / hardness, rel=1e-14)


@pytest.mark.parametrize("n", [0.5, 1.0, 1.7, 2.0])
def test_power_law_by_its_reference_stress(n):
    """[Rojek 2003, 6.5] as it is printed, dw = v dt (p_T / (tau H))^n over the area."""
    law = PowerLaw(k=K, mu=MU, exponent=n)
    exact = AREA * SLIP * (MU * PUSH / AREA / (law.reference * H))**n
    assert law.volume(slid(law), H, AREA) == pytest.approx(exact, rel=1e-12)
    if n == 1:
        by_work = DissipationArchard(k=K, mu=MU)
        assert exact == pytest.approx(by_work.volume(slid(by_work), H, AREA), rel=1e-12)


def test_modes_add_up_and_share_the_friction():
    """[Rojek 2003, 6.4]: two linear modes of 30 and 70 % of the dissipation are one of the mean k."""
    modes = SumOfModes([DissipationArchard(k=0.02, mu=MU, share=0.3), DissipationArchard(k=0.005, mu=MU, share=0.7)])
    one = DissipationArchard(k=0.3 * 0.02 + 0.7 * 0.005, mu=MU)
    assert modes.needs == one.needs
    assert modes.volume(slid(modes), H, AREA) == pytest.approx(one.volume(slid(one), H, AREA), rel=1e-14)
    square = PowerLaw(k=K, mu=MU, exponent=2, share=0.5)
    exact = K * AREA * SLIP * (0.5 * PUSH / (AREA * H))**2
    assert square.volume(slid(square), H, AREA) == pytest.approx(exact, rel=1e-12)


VALUES = {"wear_coefficient": K, "wear_exponent": 1.5, "wear_modes": "0.01/1/0.6, 3/2/0.4"}


def law_of(name, mu=MU, **values):
    """The law of this name with VALUES of its parameters, or others."""
    return WEAR_LAWS[name].from_values({**VALUES, **values}, mu)


@pytest.mark.parametrize("name", WEAR_LAWS)
def test_acceleration_multiplies_every_form(name):
    law = law_of(name)
    volume = law.volume(slid(law), H, AREA)
    assert law.scaled(7000).volume(slid(law), H, AREA) == pytest.approx(7000 * volume, rel=1e-12)
    assert law.wears and not law.scaled(0).wears
    if "wear_coefficient" in {parameter.name for parameter in law.parameters}:
        assert law.k == K


def test_values_reach_the_laws():
    power, modes = law_of("power"), law_of("modes").modes
    assert (power.exponent, power.mu, law_of("dissipation").mu) == (1.5, MU, MU)
    assert [(mode.k, mode.exponent, mode.share, mode.mu) for mode in modes] == [(0.01, 1, 0.6, MU), (3, 2, 0.4, MU)]


def test_the_linear_laws_are_the_rate_of_archard():
    law, test = PressureArchard(k=K), laboratory(PressureArchard(k=K))
    assert test.depth / test.distance == pytest.approx(
        wear_rate(k=law.k, pressure=test.pressure, slip_velocity=1.0, hardness=test.hardness), rel=1e-14)


@pytest.mark.parametrize("law", [PressureArchard(k=K), DissipationArchard(k=K, mu=MU),
                                 PowerLaw(k=3.3, mu=MU, exponent=2)])
def test_a_law_finds_its_own_k(law):
    fitted, found = law.fit(laboratory(law))
    assert fitted.k == pytest.approx(law.k, rel=1e-12) and type(fitted) is type(law)
    assert np.isnan(found.uncertainty[0]) and np.isnan(found.misfit)


def test_modes_and_exponent_find_themselves():
    both = SumOfModes([DissipationArchard(k=0.004, mu=MU, share=0.4), PowerLaw(k=2.0, mu=MU, exponent=2, share=0.6)])
    fitted, found = both.fit(laboratory(both))
    assert [mode.k for mode in fitted.modes] == pytest.approx([0.004, 2.0], rel=1e-9)
    power = PowerLaw(k=3.3, mu=MU, exponent=1.6)
    fitted, found, (n, u) = PowerLaw(k=1, mu=MU, exponent=1).fit_exponent(laboratory(power))
    assert (fitted.k, n) == pytest.approx((3.3, 1.6), rel=1e-9) and np.isnan(u)
    assert found.depth == pytest.approx(laboratory(power).depth, rel=1e-9)
    # Tests that agree better than they claim leave what they claim.
    exact = laboratory(power, error=0.05)
    _, _, (_, u) = PowerLaw(k=1, mu=MU, exponent=1).fit_exponent(exact)
    x = np.log(exact.pressure / exact.hardness)
    assert u == pytest.approx(0.05 / np.linalg.norm(x - x.mean()), rel=1e-6)


def test_uncertainty_of_one_row_is_its_error_and_of_many_their_scatter():
    law = PressureArchard(k=K)
    one = laboratory(law, p=[34e6], s=[100.0], error=0.05)
    assert law.fit(one)[1].uncertainty[0] == pytest.approx(0.05 * K, rel=1e-12)
    assert np.isnan(law.fit(laboratory(law, p=[34e6], s=[100.0]))[1].uncertainty[0])
    stated = laboratory(law, error=0.01, noise=np.array([0.1, -0.1, 0.1, -0.1]))
    found = law.fit(stated)[1]
    assert found.misfit > 50 and found.uncertainty[0] > 0.03 * K


@pytest.mark.parametrize("rows", [3, 4, 9])
def test_the_truth_is_within_two_standard_errors_in_95_of_100_cases(rows):
    """However few the tests are: by their scatter alone it would be in 82, 86 and 92."""
    law, rng = PressureArchard(k=K), np.random.default_rng(5)
    within = []
    for _ in range(2000):
        noisy = laboratory(law, p=np.geomspace(5e6, 80e6, rows), s=np.full(rows, 100.0),
                           noise=0.08 * rng.standard_normal(rows))
        fitted, found = law.fit(noisy)
        within.append(abs(fitted.k - K) < 2 * found.uncertainty[0])
    assert 0.94 < np.mean(within) < 0.97


@pytest.mark.parametrize("error", [0.0, 0.2])
def test_k_is_right_in_the_mean_however_much_tests_scatter(error):
    law, rng, ks = PressureArchard(k=K), np.random.default_rng(7), []
    for _ in range(500):
        noise = 0.2 * rng.standard_normal(6)
        fitted, found = law.fit(laboratory(law, p=np.geomspace(5e6, 80e6, 6), s=np.full(6, 100.0), error=error,
                                           noise=noise))
        assert fitted.k == pytest.approx(K * (1 + noise.mean()), rel=1e-12)
        ks.append(fitted.k)
    assert np.mean(ks) == pytest.approx(K, rel=0.01)


@pytest.mark.parametrize("call, name", [
    (lambda: law_of("pressure", wear_coefficient=-1), "k"), (lambda: law_of("power", mu=0), "mu"),
    (lambda: law_of("power", wear_exponent=0), "exponent"), (lambda: law_of("power", wear_exponent=21), "exponent"),
    (lambda: law_of("modes", wear_modes=""), "wear_modes"),
    (lambda: law_of("modes", wear_modes="1/1/0.5"), "wear_modes"),
    (lambda: law_of("modes", wear_modes="1/1/x"), "wear_modes"), (lambda: SumOfModes([]), "modes"),
    (lambda: laboratory(PressureArchard(k=0)).__post_init__(), "depth"),
    (lambda: PowerLaw(k=1, mu=1, exponent=1).fit_exponent(laboratory(PressureArchard(k=K), [1e6, 2e6], [1, 1])),
     "tests"),
    (lambda: SumOfModes([DissipationArchard(k=1, mu=MU, share=0.5)] * 2).fit(laboratory(PressureArchard(k=1))),
     "tests")])
def test_bad_input_names_the_parameter(call, name):
    with pytest.raises(ParameterError, match=f"^{name} = "):
        call()

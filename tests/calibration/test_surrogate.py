"""The solver of the rock fit on made-up laboratories whose answers are known."""
import numpy as np
import pytest

from calibration.fitting.surrogate import Problem, Surrogate, misfit, solve, uncertainty

TRUE = np.log([17e9, 0.45, 8e6, 2.5])
GUESS = np.log([20e9, 0.6, 12e6, 4.0])
EXACT, VAGUE = 0.0, 0.4
JACOBIAN = np.array([[1, 0.2, 0, 0], [0, -0.1, 0, 0], [0, 0, 1, 0.5], [0, 0, 1, 0.05]], float)
DEVIATION = np.array([[EXACT, VAGUE, EXACT, EXACT], [EXACT, VAGUE, EXACT, EXACT], [VAGUE, VAGUE, EXACT, VAGUE],
                      [VAGUE, VAGUE, EXACT, VAGUE]])


def rock(x):
    """Log E, nu, log UCS, log tensile strength of a rock that bends all relations."""
    kn, ratio, tension, shear = np.exp(x)
    ucs = 3.5 * tension * shear**0.7 * ratio**0.1 / (1 + 0.03 * shear)
    return np.array([np.log(0.69 * 3.46 * kn * (1 + ratio) / (3 + ratio)), (1 - ratio) / (3 + ratio) + 0.04,
                     np.log(ucs), np.log(0.7 * tension * shear**0.1 * ratio**-0.05)])


def problem(target, **changes):
    given = dict(target=target, tolerance=np.array([0.02, 0.004, 0.02, 0.04]), low=GUESS - 3,
                 high=GUESS + 3)
    return Problem(**{**given, **changes})


def of(laboratory, noise=1e-3):
    return lambda x: (laboratory(x), np.full(4, noise))


def test_it_finds_known_parameters_in_few_measurements():
    sought = problem(rock(TRUE))
    found = solve(of(rock), Surrogate(JACOBIAN, DEVIATION), sought, start=GUESS, most=8)
    assert found.reached and len(found.steps) <= 6
    assert misfit(rock(found.x), sought) <= 1
    assert found.x == pytest.approx(TRUE, abs=0.06)


def test_exact_scaling_needs_one_step():
    """Only stiffness and strength are wrong: their columns are exact."""
    start = TRUE + [0.3, 0, -0.5, 0]
    found = solve(of(rock), Surrogate(JACOBIAN, DEVIATION), problem(rock(TRUE)), start=start, most=5)
    assert found.reached and len(found.steps) == 2


def test_exact_columns_stay_whatever_the_noise():
    rng = np.random.default_rng(1)
    model = Surrogate(JACOBIAN, DEVIATION)
    for _ in range(5):
        x = GUESS + 0.2 * rng.normal(size=4)
        model.add(x, rock(x) + 0.05 * rng.normal(size=4), np.full(4, 0.05))
    _, slopes, _ = model.about(GUESS)
    assert slopes[:, 2] == pytest.approx(JACOBIAN[:, 2], abs=1e-6)
    assert abs(slopes[2, 3] - JACOBIAN[2, 3]) > 1e-3


def test_noise_is_averaged_over_all_measurements():
    """Seven noisy laboratories: the unknowns come out within a few standard deviations of single measurements."""
    worst = []
    for seed in range(7):
        rng = np.random.default_rng(seed)
        noise = np.array([0.003, 0.002, 0.03, 0.03])
        sought = problem(rock(TRUE), tolerance=np.array([0.02, 0.008, 0.04, 0.06]))
        found = solve(lambda x: (rock(x) + noise * rng.normal(size=4), noise), Surrogate(JACOBIAN, DEVIATION), sought,
                      start=GUESS, most=8)
        worst.append(misfit(rock(found.x), sought))
    assert np.mean(worst) < 1.3 and max(worst) < 2.5


def test_a_target_out_of_reach_ends_at_the_bound_with_the_others_met():
    far = rock(TRUE) + [0, 0, 0.8, 0]
    sought = problem(far, high=np.array([*(GUESS + 3)[:3], np.log(3.0)]))
    found = solve(of(rock), Surrogate(JACOBIAN, DEVIATION), sought, start=GUESS.clip(max=sought.high), most=8)
    assert not found.reached and found.x[3] == pytest.approx(np.log(3.0))
    y = rock(found.x)
    assert y[:2] == pytest.approx(far[:2], abs=0.02)
    # The compromise between both strengths follows their tolerances.
    assert far[2] - y[2] > 0.1 and y[3] > far[3] + 0.1


def test_an_observable_that_could_not_be_measured_changes_nothing():
    model = Surrogate(JACOBIAN, DEVIATION)
    y = rock(GUESS)
    y[2] = np.nan
    model.add(GUESS, y, np.full(4, 1e-3))
    assert np.isinf(misfit(y, problem(rock(TRUE))))
    assert np.isfinite(model.solve(problem(rock(TRUE)), GUESS)).all()


def test_slopes_pass_to_other_specimens_but_not_the_values():
    small, sought = Surrogate(JACOBIAN, DEVIATION), problem(rock(TRUE))
    first = solve(of(rock), small, sought, start=GUESS, most=8)

    def large(x):
        return rock(x) + [0.0, 0.0, -0.15, 0.05]

    found = solve(of(large), small.next_stage(first.x), sought, start=first.x, most=8)
    assert found.reached and len(found.steps) <= 2 + 1


def test_uncertainty_follows_the_scaling_laws():
    model = Surrogate(JACOBIAN, DEVIATION)
    model.add(TRUE, rock(TRUE), np.full(4, 1e-3))
    error = np.array([0.01, 0.0, 0.0, 0.0])
    assert uncertainty(model, problem(rock(TRUE)), TRUE, error) == pytest.approx([0.01, 0, 0, 0], abs=1e-4)
    found = uncertainty(model, problem(rock(TRUE)), TRUE, np.array([0.0, 0.0, 0.0, 0.02]))
    # Of a weaker rock in tension alone: less tension, more of the ratio of shear to tension.
    assert found[2] == pytest.approx(0.02 * 0.5 / 0.45, rel=0.01) and found[3] == pytest.approx(0.02 / 0.45, rel=0.01)

"""The record of a steady cut: forces whose mean, peaks and errors are known."""
import math

import numpy as np
import pytest
from scipy.signal import lfilter

from rockwear.kernels import steady_record
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.steady_record import (
    CELL, blocks, integral, is_known, mean, peaks, ratio, sample_mean, transient, uncertainty)

DEPTH, PEAK = 5e-3, 200e3


def triangles(chips=60, period=2 * DEPTH, rows=500):
    """(distance, force): the force rises to PEAK and drops at once, `rows` intervals a chip."""
    distance = np.arange(chips * rows + 1) * period / rows
    return distance, PEAK * ((np.arange(chips * rows + 1) - 0.5) % rows) / rows


def chips(count, seed, ramp=0.0):
    """(distance, force, peaks): triangles of random length and height, rising over the length of the ramp at first."""
    random = np.random.default_rng(seed)
    lengths = 2 * DEPTH * np.exp(0.4 * random.standard_normal(count))
    heights = PEAK * np.exp(0.3 * random.standard_normal(count))
    ends = np.cumsum(lengths)
    distance = np.arange(0, ends[-1], 0.01 * DEPTH)
    own = np.minimum(np.searchsorted(ends, distance), count - 1)
    force = heights[own] * (distance - ends[own] + lengths[own]) / lengths[own]
    return distance, force * np.minimum(distance / ramp, 1) if ramp else force, heights


def steady_results(distance, cutting, **changed):
    """Those of a thrust of half of the cutting force and friction work of a tenth of it."""
    return steady_record.steady_results(**{
        "distance": distance, "cutting": cutting, "thrust": 0.5 * cutting,
        "friction_work": integral(distance, 0.1 * cutting), "depth": DEPTH, **changed})


def results(distance, cutting, **changed):
    """Values of `steady_results`."""
    return {name: value for name, (value, _) in steady_results(distance, cutting, **changed).items()}


def test_blocks_conserve_the_work_of_uneven_intervals():
    distance = np.array([1.0, 1.5, 1.5, 3.0, 5.0])
    total = integral(distance, [9.0, 2.0, 70.0, 4.0, 1.0])
    assert total.tolist() == [0, 1, 1, 7, 9]
    np.testing.assert_allclose(blocks(distance, total, 4), [1 + 2, 4, 1, 1])
    np.testing.assert_allclose(blocks(distance, total, 2, begin=2.0), [(4 + 0.5) / 1.5, 1])


def test_mean_of_a_slice_is_exact_and_a_constant_has_no_error():
    distance = np.linspace(0, 0.3, 1000)
    assert mean(distance, distance**2, 0.1).value == pytest.approx((0.3**2 - 0.1**2) / 0.2, rel=1e-6)
    assert mean(distance, integral(distance, np.full(1000, 3.0))) == pytest.approx((3.0, 0.0), abs=1e-9)


def test_error_of_pairs_by_hand():
    """Neighbours that all but cancel: pairs are long enough, and their eight means are independent."""
    pairs = np.array([3.0, 1, 4, 1, 5, 9, 2, 6])
    values = np.column_stack([pairs - 100, pairs + 100]).ravel()
    distance = np.arange(17.0)
    found = mean(distance, integral(distance, np.append(0.0, values)))
    # Of seven degrees of freedom Student's t is 2.365, where many have 1.960.
    assert found == pytest.approx((pairs.mean(), 2.365 / 1.960 * pairs.std(ddof=1) / math.sqrt(8)), rel=3e-4)


@pytest.mark.parametrize("memory, least", [(0.0, 0.94), (0.9, 0.87)])
def test_the_mean_is_within_twice_its_error_as_often_as_it_should(memory, least):
    """AR(1) records of 300 rows, of many correlation lengths and of 30: with errors of plain blocks 0.936 and
    0.845."""
    noise = np.random.default_rng(11).standard_normal((1000, 500))
    found = [mean(np.arange(300), integral(np.arange(300), y)) for y in
             lfilter([1.0], [1.0, -memory], noise)[:, 200:]]
    assert np.mean([abs(value) < 2 * error for value, error in found if math.isfinite(error)]) > least


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.9])
def test_error_of_a_correlated_record(memory):
    """AR(1), y_i = memory y_(i-1) + e_i: the mean of n has the error sigma_e / (1 - memory) / sqrt(n)."""
    n, count = 8192, 40
    noise = np.random.default_rng(7).standard_normal((count, n + 200))
    errors = [mean(np.arange(n), integral(np.arange(n), y)).standard_error
              for y in lfilter([1.0], [1.0, -memory], noise)[:, 200:]]
    true = 1 / (1 - memory) / math.sqrt(n)
    assert np.mean(errors) == pytest.approx(true, rel=0.05)
    assert np.std(errors) < 0.2 * true


def test_error_of_chips_is_the_scatter_of_their_means():
    found = np.array([mean(x, integral(x, force)) for x, force, _ in (chips(60, seed) for seed in range(60))])
    assert found[:, 1].mean() == pytest.approx(found[:, 0].std(), rel=0.2)


def test_a_record_too_short_for_its_correlation_has_no_error():
    distance = np.linspace(0, 1, 500)
    assert mean(distance, integral(distance, distance)).value == pytest.approx(0.5, abs=2e-3)
    assert math.isnan(mean(distance, integral(distance, distance)).standard_error)
    assert math.isnan(mean(distance[:6], distance[:6]).standard_error)
    assert math.isnan(mean(np.zeros(0), np.zeros(0)).value) and math.isnan(mean(np.zeros(4), np.zeros(4)).value)


def test_error_of_a_ratio_knows_that_both_move_together():
    x, cutting, _ = chips(100, 1)
    total = integral(x, cutting)
    assert ratio(x, 0.7 * total, total) == pytest.approx((0.7, 0.0), abs=1e-9)
    noise = np.random.default_rng(3).standard_normal(len(x))
    found = ratio(x, 0.7 * total + integral(x, 1e3 * noise), total)
    assert found.standard_error == pytest.approx(1e3 / math.sqrt(len(x)) / mean(x, total).value, rel=0.3)
    assert math.isnan(ratio(x, total, 0 * total).value)


def test_sample_mean_by_hand():
    assert sample_mean([1.0, 3.0]) == pytest.approx((2.0, 1.0))
    # sqrt(2 (3^2 1^2 + 1^2 3^2)) / 4, with a mean of (3 1 + 1 5) / 4 = 2.
    assert sample_mean([1.0, 5.0], [3.0, 1.0]) == pytest.approx((2.0, math.sqrt(2 * 18) / 4))
    assert math.isnan(sample_mean([4.0]).standard_error) and math.isnan(sample_mean([]).value)


@pytest.mark.parametrize("ramp, low, high", [(0.0, 0.0, 0.0), (0.1, 0.06, 0.1), (0.15, 0.1, 0.15)])
def test_transient_of_a_ramp(ramp, low, high):
    """Triangles of one size: the later part of the ramp is within a chip of the rest."""
    x, force = triangles()
    force = force * np.minimum(x / ramp, 1) if ramp else force
    assert low <= transient(x, force, cell=2 * DEPTH) <= high


def test_transient_of_a_step_is_its_end_and_never_beyond_half():
    x = np.linspace(0, 1, 1001)
    assert transient(x, np.where(x <= 0.3, 5.0, 1.0), cell=0.05) == pytest.approx(0.3, abs=1e-9)
    assert transient(x, x, cell=0.05) == pytest.approx(0.5)
    assert transient(x, x, cell=0.3) == pytest.approx(1 / 3)
    assert transient(x, x, cell=2.0) == pytest.approx(0.5)
    assert math.isnan(transient(np.zeros(0), np.zeros(0), cell=1.0))


def test_a_record_that_is_steady_from_the_first_loses_little():
    found = [transient(np.arange(1001), np.random.default_rng(seed).random(1001), cell=20) for seed in range(50)]
    assert np.mean(found) < 100 and np.median(found) < 50


def test_chips_of_random_size_are_found():
    x, force, heights = chips(200, 5)
    found = peaks(x, force, depth=DEPTH)
    assert len(found.force) == pytest.approx(200, rel=0.05)
    assert found.mean().value == pytest.approx(heights.mean(), rel=0.05)
    assert found.mean().standard_error == pytest.approx(heights.std() / math.sqrt(200), rel=0.2)


def test_short_blows_are_read_wherever_they_lie():
    """Saw teeth twice as long as RESOLUTION, at random places: the mean of their last half is 0.75 of the peak."""
    ends = np.cumsum(DEPTH * (1 + np.random.default_rng(8).random(60)))
    x = np.arange(0, ends[-1] + 0.1 * DEPTH, 2e-4 * DEPTH)
    into = x - ends[np.maximum(np.searchsorted(ends, x, "right") - 1, 0)]
    found = peaks(x, PEAK * np.where((into > 0) & (into < 0.04 * DEPTH), into / (0.04 * DEPTH), 0), depth=DEPTH)
    assert len(found.force) == 60
    np.testing.assert_allclose(found.force, 0.75 * PEAK, rtol=0.1)
    assert np.mean(found.force) == pytest.approx(0.75 * PEAK, rel=0.05)


def test_noise_and_small_drops_make_no_peaks():
    x, force = triangles()
    noisy = force + 0.1 * PEAK * np.random.default_rng(2).standard_normal(len(x))
    wavy = force - 0.25 * PEAK * (np.sin(2 * math.pi * x / (0.6 * DEPTH)) > 0.9)
    assert len(peaks(x, noisy, depth=DEPTH).force) == len(peaks(x, wavy, depth=DEPTH).force) == 59


def test_steady_triangles():
    """Peak over mean is 2, but for the part that averaging over RESOLUTION takes off the peak."""
    found = results(*triangles())
    assert found["mean_cutting_force"] == pytest.approx(PEAK / 2, rel=1e-9)
    assert found["specific_energy"] == pytest.approx(PEAK / 2 / DEPTH, rel=1e-9)
    assert found["thrust_over_cutting"] == pytest.approx(0.5) and found["thrust_over_cutting_standard_error"] < 1e-9
    assert found["friction_work_per_metre"] == pytest.approx(0.05 * PEAK)
    assert found["mean_peak_cutting_force"] == pytest.approx(PEAK * (1 - 0.01 / 2), rel=1e-6)
    assert found["peak_over_mean"] == pytest.approx(2 * (1 - 0.01 / 2), rel=1e-6)
    # The last chip ends with the record: it has not dropped.
    assert found["peaks"] == 59 and found["peak_spacing"] == pytest.approx(2 * DEPTH)
    assert found["transient"] == 0 and found["long_enough"] is True


def test_the_transient_is_left_out():
    x, force = triangles()
    found = results(x, np.where(x <= 0.2, 5, 1) * force)
    assert found["transient"] == pytest.approx(0.2) and found["steady_length"] == pytest.approx(0.4)
    assert found["mean_cutting_force"] == pytest.approx(PEAK / 2) and found["peaks"] == 39


@pytest.mark.parametrize("count, enough", [(11, False), (14, True)])
def test_ten_chips_are_long_enough(count, enough):
    """Chips of two depths: eleven have ten drops, but the first two may belong to the transient."""
    x, force = triangles(chips=count)
    force[:len(x) // count + 1] = 0.0
    assert results(x, force)["long_enough"] is enough


def test_a_record_that_never_becomes_steady_is_not_long_enough():
    x, force = triangles()
    found = results(x, force * x)
    assert found["peaks"] > 10 and found["long_enough"] is False


def test_few_chips_or_depths_are_not_long_enough():
    assert results(*triangles(chips=16, period=DEPTH))["long_enough"] is False
    assert results(*triangles(chips=9, period=4 * DEPTH))["long_enough"] is False


def test_a_short_record_is_not_known():
    assert uncertainty(steady_results(*triangles(chips=8))) == math.inf
    x, force, _ = chips(60, 1)
    found = steady_results(x, force)
    force, error = (found[name][0] for name in ("mean_cutting_force", "mean_cutting_force_standard_error"))
    assert 0 < uncertainty(found) == error / force < 0.2


@pytest.mark.parametrize("accuracy", [0.1, 0.05])
def test_a_cut_that_ends_once_it_is_accurate_is_as_accurate(accuracy):
    """Random chips, asked every two depths: errors of the mean of 40 records that end so."""
    errors = []
    for seed in range(40):
        x, force, _ = chips(300, seed)
        total = integral(x, force)
        ends = np.searchsorted(x, np.arange(CELL * DEPTH, x[-1], CELL * DEPTH))
        end = next(end for end in ends if is_known(accuracy, distance=x[:end], cutting=force[:end],
                                                   thrust=0.5 * force[:end], friction_work=total[:end], depth=DEPTH))
        found = steady_results(x[:end], force[:end])
        assert uncertainty(found) <= accuracy
        errors.append(found["mean_cutting_force"][0] / (0.5 * PEAK * math.exp(0.3**2 / 2)) - 1)
    assert 0.4 * accuracy < np.sqrt(np.mean(np.square(errors))) < accuracy
    assert abs(np.mean(errors)) < 0.04


def test_a_tool_that_stands_adds_nothing():
    x, force = triangles(chips=20)
    work = integral(x, 0.1 * force)
    stopped = results(np.append(x, [x[-1]] * 500), np.append(force, np.full(500, 9e9)),
                      friction_work=np.append(work, [work[-1]] * 500))
    for name, value in results(x, force).items():
        assert stopped[name] == pytest.approx(value, nan_ok=True), name


@pytest.mark.parametrize("rows", [0, 1, 2, 9])
def test_next_to_nothing_is_a_record_of_nan(rows):
    found = results(np.arange(float(rows)) * 1e-5, np.ones(rows))
    assert found["long_enough"] is False and math.isnan(found["mean_peak_cutting_force"])


def test_forces_that_are_not_numbers_are_left_out():
    x, force = triangles()
    force[[0, 777]] = math.nan, math.inf
    found = results(x, force, thrust=np.ones(len(x)), friction_work=x)
    assert found["mean_cutting_force"] == pytest.approx(PEAK / 2, rel=1e-2)


def test_no_force_has_no_peaks():
    found = results(np.linspace(0, 1, 2000), np.zeros(2000))
    assert found["peaks"] == 0 and found["mean_cutting_force"] == 0 and math.isnan(found["peak_over_mean"])


def test_a_distance_that_decreases_is_refused():
    with pytest.raises(ParameterError, match="never decreases"):
        results(np.array([0, 2.0, 1.0]), np.ones(3))

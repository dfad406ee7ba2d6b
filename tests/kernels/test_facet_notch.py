"""The joined depth of two facets of a notch: smooth, symmetric, the larger one elsewhere; a disc rests in a notch."""
import math

import numpy as np
import pytest

from rockwear.kernels.facet_notch import ROUNDING, joined_depth

WIDTH = 0.1
COSINE = 1 - 2 * WIDTH / ROUNDING
"""Of the angle between two faces."""


@pytest.mark.parametrize("first, second", [
    (1.0, 0.99), (0.8, 1.0), (1.0, 0.83), (0.5, 1.0), (1.0, 0.1), (2e-6, 2.1e-6)])
def test_its_parts_are_its_derivatives(first, second):
    depth, parts = joined_depth(first, second, COSINE)
    step = 1e-6 * first

    def depth_at(aside, ahead):
        return joined_depth(first + aside * step, second + ahead * step, COSINE)[0]

    assert parts[0] == pytest.approx((depth_at(1, 0) - depth_at(-1, 0)) / (2 * step), rel=1e-8, abs=1e-9)
    assert parts[1] == pytest.approx((depth_at(0, 1) - depth_at(0, -1)) / (2 * step), rel=1e-8, abs=1e-9)
    # It doubles where both double (Euler), and does not depend on the order.
    assert parts[0] * first + parts[1] * second == pytest.approx(depth, rel=1e-12)
    assert joined_depth(second, first, COSINE) == (depth, parts[::-1])


def test_it_is_the_larger_depth_but_for_nearly_equal_ones():
    edge = (1 - WIDTH) / (1 + WIDTH)
    for second in (0.01, 0.5, 0.999 * edge):
        assert joined_depth(1.0, second, COSINE) == (1.0, (1.0, 0.0))
    # Nothing jumps where it begins.
    depth, parts = joined_depth(1.0, edge * (1 + 1e-9), COSINE)
    assert depth == pytest.approx(1.0, abs=1e-9) and parts == pytest.approx((1.0, 0.0), abs=1e-7)
    assert joined_depth(1.0, 1.0, COSINE)[0] == pytest.approx(1 + WIDTH / 2)


def swings(slope, fraction, rate, law, steps=8000):
    """What a disc has gained that swings in a notch, over what its spring holds at rest, all damping counted.

    Facets rise by `slope`; steps of `fraction` of sqrt(m/kn); rate: background damping over sqrt(kn/m); law: function
    of both depths and the cosine between the faces giving (depth, parts).
    """
    radius, load, deep = 1.0, np.array([0.0, 0.08]), 0.08
    normals = np.array([[math.sin(slope), -math.cos(slope)], [-math.sin(slope), -math.cos(slope)]])
    place, velocity = np.array([0.16, -0.16 * math.tan(slope) - (radius - deep) / math.cos(slope)]), np.zeros(2)
    gained, spent = [], 0.0
    for _ in range(steps):
        depths = np.maximum(radius - normals @ place, 0.0)
        one_facet = depths.max(), 1.0 * (depths == depths.max())
        depth, parts = law(*depths, math.cos(2 * slope)) if depths.min() > 0 else one_facet
        force = load + depth * np.asarray(parts) @ normals
        middle = velocity + 0.5 * force * fraction
        gained.append(0.5 * middle @ middle - load @ place + 0.5 * depth**2 + spent)
        velocity = velocity + force * fraction
        spent += 0.5 * velocity @ velocity * (1 - math.exp(-2 * rate * fraction))
        velocity = velocity * math.exp(-rate * fraction)
        place = place + velocity * fraction
    return (np.mean(gained[-100:]) - gained[0]) / (0.5 * deep**2)


def deeper(first, second, cosine):
    return max(first, second), (float(first >= second), float(first < second))


@pytest.mark.parametrize("degrees", [5, 10, 15])
@pytest.mark.parametrize("fraction", [0.4, 0.8])
def test_a_disc_comes_to_rest_in_a_notch(degrees, fraction):
    """The force of the deeper face alone keeps it trembling there, on energy from nowhere."""
    assert abs(swings(math.radians(degrees), fraction, 0.02, joined_depth)) < 0.1
    assert swings(math.radians(degrees), fraction, 0.02, deeper) > 0.5

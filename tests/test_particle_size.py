"""The worn shape converges to the exact one with the size of the tool's particles."""
import math

import numpy as np
import pytest

from calibration.particle_size import DOWN, OUTLINE, exact, flat, flat_of_segments, particles, rub, unexplained
from rockwear.kernels.outline import area, tooth

POLYGON = tooth(**OUTLINE)


def test_the_exact_outline_lacks_the_worn_volume_beyond_a_plane():
    left, height = exact(POLYGON, 20e-6)
    assert area(POLYGON) - area(left) == pytest.approx(20e-6, rel=1e-9)
    assert (left @ DOWN).max() == pytest.approx(height, abs=1e-12)


def test_half_the_size_is_half_the_error():
    coarse, fine = ([flat(POLYGON, size, seed, strip=1.4e-3) for seed in (1, 2, 3)] for size in (1.4e-3, 0.7e-3))
    off = [math.sqrt(np.mean([row.off**2 for row in rows])) for rows in (coarse, fine)]
    assert 1.4 < off[0] / off[1] < 2.9 and off[1] < 0.45 * 0.7e-3
    assert max(abs(row.unexplained) for row in coarse + fine) < 1e-12


def test_segments_end_at_the_same_outline():
    coarse, fine = (flat_of_segments(POLYGON, size, strip=1.4e-3) for size in (0.8e-3, 0.4e-3))
    assert fine.off < 0.1 * 0.4e-3 and coarse.off > 1.5 * fine.off
    assert max(abs(row.unexplained) for row in (coarse, fine)) < 1e-9


def test_the_depth_rule_loses_the_more_the_more_wears_in_a_visit():
    losses = []
    for portion in (1 / 64, 1 / 2):
        tool = particles(POLYGON, 1.4e-3, 1, "depth")
        rub(tool, 20e-6, portion)
        losses.append(unexplained(tool))
    assert losses[1] < losses[0] - 0.05 < -0.1

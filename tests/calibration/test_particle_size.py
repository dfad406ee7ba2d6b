"""The worn shape converges to the exact one with the size of the tool's particles."""
import math
from types import SimpleNamespace

import numpy as np
import pytest

from calibration.benchmarks.worn_outlines import (
    DOWN, OUTLINE, PATTERN_WORN, Pattern, exact, flat, flat_of_segments, particles, patterned, patterned_segments,
    rub, unexplained)
from rockwear.kernels.polygon import area, tooth

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
    coarse, fine = (flat_of_segments(POLYGON, size, strip=1.4e-3, volume=5e-6) for size in (0.8e-3, 0.4e-3))
    assert fine.off < 0.1 * 0.4e-3 and coarse.off > 1.5 * fine.off
    assert max(abs(row.unexplained) for row in (coarse, fine)) < 1e-9


def test_particles_and_segments_wear_to_one_outline_under_one_pattern():
    tool = particles(POLYGON, 0.7e-3, 1, "volume")
    hit = np.exp(-np.sum((tool.positions[:, :2] - [-2e-3, 1e-3])**2, axis=1) / (1.5e-3)**2)
    run = SimpleNamespace(model={"outline": POLYGON, "tool_positions": tool.positions, "tool_radii": tool.radii},
                          snapshot=lambda _: {"worn_depth": np.where(tool.positions[:, 0] > -8e-3, hit, 0.0)})
    pattern = Pattern(run)
    of_particles, of_segments = patterned(pattern, POLYGON, 0.7e-3, 2), patterned_segments(pattern, POLYGON, 0.7e-3)
    assert of_segments.off < 0.05 * 0.7e-3 and of_particles.off < 0.5 * 0.7e-3
    assert pattern.depth(PATTERN_WORN).max() > 0.5e-3
    assert max(abs(row.unexplained) for row in (of_particles, of_segments)) < 1e-9


def test_the_depth_rule_loses_the_more_the_more_wears_in_a_visit():
    losses = []
    for portion in (1 / 64, 1 / 2):
        tool = particles(POLYGON, 1.4e-3, 1, "depth")
        rub(tool, 20e-6, portion)
        losses.append(unexplained(tool))
    assert losses[1] < losses[0] - 0.05 < -0.1

"""Strips beside a way: the arc's map is conformal, and its period is a rotation."""
import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.strip import ArcStrip, StraightStrip

ARC = ArcStrip(centre=(0.3, 0.9), radius=0.8, level=0.06, start=0.4)
POINTS = np.random.default_rng(1).uniform((-0.5, 0.0), (2.0, 0.15), (40, 2))


def test_the_arc_turns_about_its_centre_with_the_strip_beside_it():
    radius = 0.8 * np.exp((0.06 - POINTS[:, 1]) / 0.8)
    angle = 0.4 + POINTS[:, 0] / 0.8
    expected = np.column_stack([0.3 + radius * np.sin(angle), 0.9 - radius * np.cos(angle)])
    assert ARC.place(POINTS) == pytest.approx(expected, abs=1e-15)
    assert ARC.unroll(expected) == pytest.approx(POINTS, abs=1e-14)


def test_the_map_turns_and_stretches_and_does_not_distort():
    step = 1e-6
    stretch, zero = ARC.stretch(POINTS), np.zeros(len(POINTS))
    for vector in np.eye(2):
        along = (ARC.place(POINTS + step * vector) - ARC.place(POINTS - step * vector)) / (2 * step)
        direction = ARC.turned(np.tile(vector, (len(POINTS), 1)), POINTS)
        assert np.linalg.norm(direction, axis=1) == pytest.approx(zero + 1, abs=1e-14)
        assert along == pytest.approx(stretch[:, None] * direction, abs=1e-8)


def test_on_the_level_lengths_are_those_of_the_plane_and_a_period_is_a_rotation():
    on_way = np.column_stack([np.linspace(0, 1, 2001), np.full(2001, 0.06)])
    assert np.linalg.norm(np.diff(ARC.place(on_way), axis=0), axis=1).sum() == pytest.approx(1.0, rel=1e-7)
    apart = POINTS[1:] - POINTS[:-1]
    lengths = ARC.lengths(POINTS[:-1], apart)
    assert lengths == pytest.approx(np.linalg.norm(np.diff(ARC.place(POINTS), axis=0), axis=1), rel=1e-12)
    assert ARC.lengths(POINTS[:-1] + (0.3, 0.0), apart) == pytest.approx(lengths, rel=1e-12)


def test_the_arc_through_points_of_a_circle_is_that_circle():
    angle = np.linspace(-0.3, 1.1, 30)
    points = np.column_stack([2 + 0.5 * np.sin(angle), 1 - 0.5 * np.cos(angle)])
    arc = ArcStrip.through(points, level=0.02, x=0.1)
    assert (*arc.centre, arc.radius) == pytest.approx((2, 1, 0.5), rel=1e-12)
    assert arc.unroll(points) == pytest.approx(np.column_stack([0.1 + 0.5 * (angle + 0.3), np.full(30, 0.02)]),
                                               abs=1e-13)


@pytest.mark.parametrize("points", [[(0, 0), (1, 0)], [(0, 0), (1, 1), (2, 2), (3, 3)]])
def test_no_arc_goes_through_a_line(points):
    with pytest.raises(ParameterError):
        ArcStrip.through(points)


def test_the_straight_strip_is_the_plane():
    strip = StraightStrip()
    assert strip.place(POINTS) is POINTS and strip.unroll(POINTS) is POINTS and strip.turned(POINTS, POINTS) is POINTS
    assert (strip.stretch(POINTS) == 1).all() and strip.frame(0.2).tolist() == [0.2, 0.0]
    assert strip.lengths(POINTS, POINTS) == pytest.approx(np.linalg.norm(POINTS, axis=1))

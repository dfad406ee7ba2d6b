"""Rigid motions: lengths stay, velocities are the derivatives of the path, and the path is the cycloid it should be."""
import math

import numpy as np
import pytest

from rockwear.kernels.rigid_motion import Pose, Straight, SwingAndRotation, rigid_parts

POINTS = np.random.default_rng(3).normal(size=(20, 2))


def motion(**changed):
    values = dict(centre=(0.3, 0.7), swing=(0.2, 0.05), angular_velocity=1.6204, pivot=(0.02, 0.7), start=0.4)
    return SwingAndRotation(**{**values, **changed})


def test_a_quarter_turn():
    assert Pose(np.array([1.0, 2.0]), math.pi / 2).of([[3.0, 0.0]]) == pytest.approx(np.array([[1.0, 5.0]]))


@pytest.mark.parametrize("path", [
    motion(), motion(angular_velocity=-3.0, swing=(0, 0)), Straight(start=(1, 2), velocity=(3, -1))])
def test_lengths_stay_and_velocity_and_spin_are_the_derivatives(path):
    t, dt = 0.37, 1e-5
    before, after = path.pose(t - dt), path.pose(t + dt)
    moved = path.pose(t).of(POINTS)
    lengths = np.linalg.norm(POINTS - POINTS[0], axis=1)
    assert np.linalg.norm(moved - moved[0], axis=1) == pytest.approx(lengths, rel=1e-13)
    assert (after.offset - before.offset) / (2 * dt) == pytest.approx(path.velocity(t), rel=1e-8)
    assert (after.turn - before.turn) / (2 * dt) == pytest.approx(path.angular_velocity, rel=1e-9)
    across = np.array([[0.0, -path.angular_velocity], [path.angular_velocity, 0.0]])
    field = path.velocity(t) + (moved - path.pose(t).offset) @ across.T
    assert (after.of(POINTS) - before.of(POINTS)) / (2 * dt) == pytest.approx(field, rel=1e-7, abs=1e-9)


def test_a_wheel_that_rolls_draws_a_cycloid():
    """x = R (q - sin q), y = R (1 - cos q): a point of the rim, at the bottom at first, of a wheel rolling along +x."""
    radius, angular_velocity = 0.7, 1.6204
    path = SwingAndRotation(centre=(0, radius), swing=(radius * angular_velocity, 0),
                            angular_velocity=-angular_velocity, pivot=(0, radius))
    for t in (0.0, 0.3, 1.0, 3.9):
        angle = angular_velocity * t
        expected = radius * np.array([angle - math.sin(angle), 1 - math.cos(angle)])
        assert path.pose(t).of([[0.0, 0.0]])[0] == pytest.approx(expected, abs=1e-14)


def test_the_pivot_follows_the_centre():
    path = motion()
    for t in (0.0, 2.5):
        assert path.pose(t).of([path.pivot])[0] == pytest.approx(path.centre + path.swing * t, abs=1e-15)


def test_a_chord_of_the_path_is_off_it_by_its_sagitta():
    """(w R T)^2 / 8R at half time, also with a swing: 23 nm in 100 steps, 5 times as fast as [Rojek 2014]."""
    path, period = motion(swing=(5 * 0.2, 0.0), angular_velocity=5 * 1.6204), 100 * 0.638e-6
    tip = path.pivot - (0.0, 0.7)
    begin, half, end = (path.pose(0.1 + t).of([tip])[0] for t in (0.0, period / 2, period))
    off = float(np.linalg.norm(half - (begin + end) / 2))
    assert off == pytest.approx((path.angular_velocity * 0.7 * period)**2 / (8 * 0.7), rel=1e-3)
    assert off < 24e-9


def test_rigid_parts_of_pieces():
    """A rigid motion is its own rigid part; of any other the rest has no momentum, no moment, and its own energy."""
    random = np.random.default_rng(8)
    piece = np.array([0, 1, 0, 2, 1, 0, 1])
    x, v, w = random.normal(size=(7, 2)), random.normal(size=(7, 2)), random.normal(size=7)
    m, inertia = random.uniform(1, 2, 7), random.uniform(1, 2, 7)
    given = dict(positions=x, masses=m, inertias=inertia)
    velocities, spins = rigid_parts(piece, velocities=v, spins=w, **given)
    again = rigid_parts(piece, velocities=velocities, spins=spins, **given)
    np.testing.assert_allclose(again[0], velocities)
    np.testing.assert_allclose(again[1], spins)
    assert velocities[3] == pytest.approx(v[3]) and spins[3] == pytest.approx(w[3])
    rest, turned = v - velocities, w - spins
    for k in range(3):
        own = piece == k
        np.testing.assert_allclose(m[own] @ rest[own], 0, atol=1e-12)
        moment = m * (x[:, 0] * rest[:, 1] - x[:, 1] * rest[:, 0]) + inertia * turned
        assert moment[own].sum() == pytest.approx(0, abs=1e-12)

    def energy(v, w):
        return m @ (v**2).sum(axis=1) + inertia @ w**2
    assert energy(v, w) == pytest.approx(energy(velocities, spins) + energy(rest, turned))

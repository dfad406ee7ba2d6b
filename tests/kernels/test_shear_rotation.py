"""The shear spring of a rotating contact through YADE's rule: it rotates with the contact and conserves energy."""
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rockwear.kernels.shear_rotation import shear_to_start_from, turning_rates

RADII = np.array([[0.010], [0.014]])
KT = np.array([2e6])
DISTANCE = 0.0225
AXES = {"across": (0, 0, 1.0), "slanting": (0.6, 0, 0.8), "along": (1.0, 0, 0)}


def turned_by_yade(shear, orbit, twist):
    """Shear forces (n, 3) N rotated by YADE's rule, ScGeom::rotate. orbit, twist: rotation vectors (n, 3), rad."""
    shear = shear - np.cross(shear, orbit)
    return shear - np.cross(shear, twist)


def yade_step(shear, line, velocity, spins, dt):
    """What YADE's contact geometry and law do with a shear force in one step."""
    before, after = (x / np.linalg.norm(x) for x in (line - dt * velocity, line))
    angular_velocity = spins[0] + spins[1]
    turned = turned_by_yade(shear, np.cross(before, after), 0.5 * dt * (angular_velocity @ before.T) * before)
    arms = RADII - 0.5 * (RADII.sum() - np.linalg.norm(line))
    slip = velocity - np.cross(arms[0] * spins[0] + arms[1] * spins[1], after)
    return turned - KT * dt * (slip - after * (slip @ after.T))


def turning(axis, rate, angle, steps, corrected, shear):
    """A pair that turns as one by `angle` in so many steps. -> the shear force as the pair sees it."""
    axis = np.array(axis)
    dt = angle / rate / steps
    # The chord's rate: what a leapfrog approach_steps a turning pair with.
    spins = np.tile(2 / dt * np.tan(0.5 * rate * dt) * axis, (2, 1, 1))
    for step in range(steps):
        here, there = (Rotation.from_rotvec(axis * rate * dt * n).apply([[DISTANCE, 0, 0]]) for n in (step, step + 1))
        motion = there, (there - here) / dt, spins
        if corrected:
            shear = shear_to_start_from(shear, *motion, RADII, KT, dt)
        shear = yade_step(shear, *motion, dt)
    return Rotation.from_rotvec(-axis * angle).apply(shear)


@pytest.mark.parametrize("axis", AXES)
def test_a_spring_turns_with_its_contact(axis):
    """But for the leapfrog's own error of the second order, where YADE's rule lengthens it or makes it slip."""
    start = np.array([[0, 300.0, -400.0]])
    ours, finer, yades = (np.linalg.norm(turning(AXES[axis], 2000.0, 3.0, steps, corrected, start) - start) / 500
                          for steps, corrected in ((50, True), (100, True), (50, False)))
    assert ours < 1e-3 and finer < 0.26 * ours + 1e-12 and yades > 0.05


def test_a_slanting_turn_makes_no_slip():
    nothing = np.zeros((1, 3))
    assert np.linalg.norm(turning(AXES["slanting"], 2000.0, 3.0, 50, False, nothing)) > 1000
    assert np.linalg.norm(turning(AXES["slanting"], 2000.0, 3.0, 50, True, nothing)) < 1e-8


def test_slip_is_counted_in_full():
    """Spheres that roll past each other without turning as one: the displacement of their points of contact."""
    line, velocity, dt = np.array([[DISTANCE, 0, 0]]), np.array([[0, 2.0, 0]]), 1e-9
    spins = np.array([[[0, 0, 5.0]], [[0, 0, 90.0]]])
    start = shear_to_start_from(np.zeros((1, 3)), line, velocity, spins, RADII, KT, dt)
    found = yade_step(start, line, velocity, spins, dt)
    arms = RADII[:, 0] - 0.5 * (RADII.sum() - DISTANCE)
    assert found[0, 1] == pytest.approx(-KT[0] * dt * (2.0 - arms @ [5.0, 90.0]), rel=1e-6)


def test_turning_rates():
    line = np.array([[0.02, 0, 0]] * 3)
    velocity = np.array([[7.0, 1.0, 0], [3.0, 0, 0], [0, 0, 2.0]])
    spins = np.array([[[0, 9.0, 0], [60.0, 0, 0], [100.0, 0, 4.0]], [[0, 0, 0], [20.0, 5.0, 0], [100.0, 0, 0]]])
    assert turning_rates(line, velocity, spins) == pytest.approx([50.0, 40.0, np.hypot(100.0, 100.0)])

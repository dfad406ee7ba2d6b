"""Crossing from one spring to another in a leapfrog: the equation, and the energy of a particle in a notch."""
import math

import numpy as np
import pytest

from rockwear.kernels.crossing import crossing_force


@pytest.mark.parametrize("seed", range(20))
def test_the_step_does_the_work_of_both_springs_less_what_the_second_holds_more(seed):
    chance = np.random.default_rng(seed)
    before, after, velocity, change = chance.normal(size=(4, 3))
    mass, dt, gain = 0.7, 0.05, 0.02 * chance.random()
    found = crossing_force(before=before, after=after, gain=gain, velocity=velocity, change=change, mass=mass, dt=dt)
    one, other = velocity * dt, (velocity + change + found * dt / mass) * dt
    done = (before + found) @ (one + other) / 2
    assert done == pytest.approx(before @ one / 2 + after @ other / 2 - gain, abs=1e-14)
    # The smaller of two roots: nothing is thrown about.
    assert np.linalg.norm(found) < 20


def test_what_a_slow_particle_cannot_pay_stops_it():
    found = crossing_force(before=np.zeros(2), after=np.zeros(2), gain=1.0, velocity=np.array([0.1, 0.0]), change=np.zeros(2), mass=2.0, dt=0.1)
    # Back by twice its momentum would be as fast again: what takes most is to end with the opposite velocity.
    assert found == pytest.approx([-2.0 * 0.1 / 0.1, 0.0])


def gained(angle, *, crossing, fraction, steps=20000):
    """Energy that a disc in a notch has gained, over that in its spring at rest: the faces turn by twice the angle."""
    stiffness, mass, load, radius = 1e8, 0.0123, np.array([0.0, 1e4]), 1.25e-3
    dt = fraction * math.sqrt(mass / stiffness)
    normals = np.array([[math.sin(angle), -math.cos(angle)], [-math.sin(angle), -math.cos(angle)]])
    place, velocity = np.array([0.4e-3, -0.4e-3 * math.tan(angle) - radius / math.cos(angle)]), np.zeros(2)

    def depths():
        return np.maximum(radius - normals @ place, 0.0)

    def energy():
        return 0.5 * mass * velocity @ velocity - load @ place + 0.5 * stiffness * depths().max()**2

    face, first, last = 0, energy(), []
    for step in range(steps):
        depth = depths()
        force = load + stiffness * depth[face] * normals[face]
        deeper = int(np.argmax(depth))
        if deeper != face and depth[deeper] > depth[face]:
            springs = stiffness * depth[:, None] * normals
            if crossing:
                force = force + crossing_force(before=springs[face], after=springs[deeper], gain=0.5 * stiffness * (depth[deeper]**2 - depth[face]**2),
                                               velocity=velocity, change=force * dt / mass, mass=mass, dt=dt)
            face = deeper
        velocity = velocity + force * dt / mass
        place = place + velocity * dt
        if step > steps - 500:
            last.append(energy() - first)
    return np.mean(last) / (0.5 * load @ load / stiffness)


@pytest.mark.parametrize("degrees, fraction", [(2.5, 0.4), (2.5, 0.8), (5, 0.2), (5, 0.8)])
def test_a_disc_stays_in_its_notch_with_its_energy(degrees, fraction):
    """Some thousand crossings, in steps of 0.4 of the critical one at most; left to the leapfrog it is thrown out."""
    assert abs(gained(math.radians(degrees), crossing=True, fraction=fraction)) < 0.1
    assert abs(gained(math.radians(degrees), crossing=False, fraction=fraction)) > 2

"""A step of the leapfrog in which a particle passes from one spring to another, as over an inner edge between two faces.

Where the force jumps, the leapfrog does not keep the energy: each crossing gives the particle some, about what the force
would do in a step, and in a soft notch, which it crosses every few steps, it is thrown out in the end.
"""
import numpy as np


def crossing_force(*, before, after, gain, velocity, change, mass, dt):
    """(d,) N to be added in the step in which the second spring holds more energy than the first, which still acts.

    F_b and F_a are the forces of the two springs at the particle's place, J the energy that the second holds more, A the
    sum of all other accelerations but that of F_b. The discrete work of the force F of this step on the ways before and
    after it, of v dt and v dt + (A + F/m) dt^2, is to be that of F_b and F_a on their halves, less J:

        F (x1 + x2) / 2 = F_b x1 / 2 + F_a x2 / 2 - J

    F is their mean and a part along the mean way that solves this, the smaller root of a quadratic equation; where there
    is none, for the particle is too slow to pay J, the part that comes nearest. (Ours.)

    before, after (d,) N; gain: J; velocity (d,) m/s, of the half step before, against the wall; change (d,) m/s, that
    the forces of this step with F_b give; mass: kg, of a particle that moves; dt: s.
    """
    half = 0.5 * (np.asarray(after, float) - before)
    change = change + half * dt / mass
    way = (velocity + 0.5 * change) * dt
    size = float(np.linalg.norm(way))
    if not size > 0:
        return half
    along, ease = way / size, dt**2 / mass
    slope = size - 0.5 * float(half @ along) * ease
    missing = gain - 0.5 * float(half @ change) * dt
    root = max(slope**2 - 2 * missing * ease, 0.0)
    return half + along * ((np.copysign(np.sqrt(root), slope) - slope) / ease)

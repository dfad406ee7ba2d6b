"""A membrane around an assembly of discs: which discs it touches, and what a pressure on it exerts on them."""
import numpy as np

from rockwear.kernels.checks import positive

STIFF = 0.02
"""Largest pressure over kn: above it discs overlap by some per cent of a radius, and bonds are no small springs."""
SAMPLES = 4
"""Points in a smallest radius at which the membrane's height is found."""


def upper_chain(positions, radii, *, ball):
    """Indices, in order of x, of the discs that a ball of radius `ball` (m) touches when it rolls over them from above.

    positions: (n, 2) m; radii: (n,) m. The centre of the ball runs along the upper envelope of the discs enlarged by
    its radius, so that it bridges gaps that are narrower than itself. It enters no gap by more than 2 (largest radius +
    ball). Raises ParameterError.
    """
    positive("ball", ball, "m")
    x, y = positions.T
    # Only discs near the top of their own strip can be touched; the others would cost most of the time.
    strip = np.floor((x - x.min()) / (2 * radii.max())).astype(int)
    top = np.full(strip.max() + 1, -np.inf)
    np.maximum.at(top, strip, y)
    near = np.flatnonzero(y > top[strip] - 2 * (radii.max() + ball))
    reach, step = radii[near] + ball, radii.min() / SAMPLES
    offset = np.arange(-int(reach.max() / step) - 1, int(reach.max() / step) + 2)
    place = np.rint((x[near] - x.min()) / step).astype(int)[:, None] + offset
    square = reach[:, None]**2 - (place * step + x.min() - x[near, None])**2
    inside = (square > 0) & (place >= 0) & (place <= (x.max() - x.min()) / step)
    height = (y[near, None] + np.sqrt(np.maximum(square, 0)))[inside]
    disc, place = np.broadcast_to(near[:, None], inside.shape)[inside], place[inside]
    rising = np.argsort(height, kind="stable")
    touched = np.full(place.max() + 1, -1)
    touched[place[rising]] = disc[rising]  # the highest is written last
    touched = np.unique(touched[touched >= 0])
    return touched[np.lexsort((touched, x[touched]))]


def pressure_forces(chain, pressure, *, begin, end):
    """(k, 2) N on discs at `chain` (k, 2) m, in order of x, under a pressure (Pa) from above.

    Each piece of the chain carries pressure times length at right angles, half of it to each of its discs. The first
    and the last disc carry what lies between them and the ends of the membrane at x = `begin` and `end` (m) too, so
    that the sum along y is minus the pressure times (end - begin).
    """
    piece = np.diff(chain, axis=0)
    half = 0.5 * pressure * np.column_stack([piece[:, 1], -piece[:, 0]])
    forces = np.zeros((len(chain), 2))
    forces[:-1] += half
    forces[1:] += half
    forces[0, 1] -= pressure * (chain[0, 0] - begin)
    forces[-1, 1] -= pressure * (end - chain[-1, 0])
    return forces

"""How the displacement of rock goes on beyond where it is known."""
import numpy as np

FITS = 3
"""Fits, each without what the last one shows as loose."""


def continued(points, displaced, wanted, *, tolerance, least):
    """(l, 2) m, displacement at the points `wanted` (l, 2), as that (k, 2) m of `points` (k, 2) goes on; None where
    fewer than `least` of them tell. (Ours.)

    Least squares with a parabola over y and a line along x, whose slope is linear over y. Points that are off by more
    than `tolerance` (m) are loose and do not count. Points are over a length of their own, which scales the sums.
    """
    def basis(at):
        x, y = at.T
        return np.column_stack([np.ones(len(x)), y, y**2, x, x * y])

    for _ in range(FITS):
        if len(points) < least:
            return None
        found = np.linalg.lstsq(basis(points), displaced, rcond=None)[0]
        whole = np.linalg.norm(displaced - basis(points) @ found, axis=1) <= tolerance
        points, displaced = points[whole], displaced[whole]
    return basis(wanted) @ found

"""How the displacement of rock goes on beyond where it is known."""
import numpy as np
from scipy.interpolate import RBFInterpolator

FITS = 3
"""Fits, each without what the last one shows as loose."""
MOST = 1000
"""Points of a fit, a quarter of a second, which grows as their cube. Of more, every second one, or third, and so on."""
SMOOTHING = 0.01
"""Of the spline, with points over the height of the window. In the cut of make run half of a seam's bonds were off
by 0.02 to 0.3 um with 0.01, by up to 0.8 with 0.1, 2.3 with 1, and 1.2 with a parabola over the height and slopes."""


def continued(points, displaced, wanted, *, tolerance, least):
    """(l, 2) m, displacement at the points `wanted` (l, 2), as that (k, 2) m of `points` (k, 2) goes on; None where
    fewer than `least` of them tell, or all lie on a line. (Ours.)

    A thin-plate spline, smoothed, with a linear part. Points that are off by more than `tolerance` (m) are loose and do
    not count. Points are over a length of their own, which scales the smoothing.
    """
    for _ in range(FITS):
        if len(points) < max(least, 3) or _on_a_line(points):
            return None
        some = slice(None, None, -(-len(points) // MOST))
        spline = RBFInterpolator(points[some], displaced[some], kernel="thin_plate_spline", smoothing=SMOOTHING,
                                 degree=1)
        whole = np.linalg.norm(displaced - spline(points), axis=1) <= tolerance
        points, displaced = points[whole], displaced[whole]
    return spline(wanted) if len(points) >= least else None


def _on_a_line(points):
    long, wide = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return wide < 1e-6 * long

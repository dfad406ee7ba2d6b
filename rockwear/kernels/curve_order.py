"""The order of points along a space-filling curve: what is near in space is near in memory."""
import numpy as np

BITS = 16
"""Of each coordinate: the curve passes 2^16 cells along the longest side."""


def curve_order(positions):
    """(n,) indices of points (n, d) along Morton's curve, on which the bits of the coordinates of a cell alternate
    (Morton 1966, "A computer oriented geodetic data base"). Points of one cell keep their order."""
    positions = np.asarray(positions, float)
    low, dimensions = positions.min(axis=0), positions.shape[1]
    longest = np.ptp(positions, axis=0).max() or 1.0
    cells = ((positions - low) / longest * (2**BITS - 1)).astype(np.uint64)
    code = np.zeros(len(positions), np.uint64)
    for bit in range(BITS):
        for axis in range(dimensions):
            code |= (cells[:, axis] >> np.uint64(bit) & np.uint64(1)) << np.uint64(bit * dimensions + axis)
    return np.argsort(code, kind="stable")

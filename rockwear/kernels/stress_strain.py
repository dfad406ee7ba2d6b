"""Strength and elastic constants of a stress-strain curve."""
import math

import numpy as np

from rockwear.kernels.checks import require

ELASTIC_RANGE = 0.1, 0.25
"""Stresses over the peak between which E and nu are taken, the straight part of the curve: in rock of grains the first
cracks open along the load at 0.26 to 0.3 of the peak, and lateral strain then runs ahead of the elastic one."""


def measured(*, stress, axial_strain, lateral_strain):
    """{name: (value, unit)} of a stress-strain curve: its peak, and E and nu as slopes in ELASTIC_RANGE.

    stress: (n,) Pa; strains: (n,), all positive in the direction of the loading. nan where there are fewer than three
    rows from the last one below the range to the first one above it. Raises ParameterError for a curve without rows.
    """
    require(len(stress) > 0, "stress", "without rows", "a curve of at least one", "Pa")
    peak = int(np.argmax(stress))
    low, high = (part * stress[peak] for part in ELASTIC_RANGE)
    # The first row above, and the last one below before it: stray rows elsewhere count for nothing.
    above = int(np.argmax(stress >= high))
    below = np.flatnonzero(np.append(True, stress[:above] < low))[-1] - 1
    rows = np.arange(max(below, 0), above + 1)
    modulus = ratio = math.nan
    if len(rows) > 2:
        modulus = np.polyfit(axial_strain[rows], stress[rows], 1)[0]
        ratio = -np.polyfit(axial_strain[rows], lateral_strain[rows], 1)[0]
    return {"peak_stress": (float(stress[peak]), "Pa"), "peak_strain": (float(axial_strain[peak]), "-"),
            "youngs_modulus": (float(modulus), "Pa"), "poissons_ratio": (float(ratio), "-")}

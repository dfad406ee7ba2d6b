"""Where scenes place a tooth with a flat, whatever vertex its outline begins with, and whichever way round it goes.

    yade -n -x flat_tooth.py CHECKS.json

Writes [{"steady": [whether each disc of a row is left out where a steady cut begins], "pick": [x and y of the tip, y of
the pivot, rad by which a dredge pick starts before its entry]}], first of the tooth as kernels.polygon makes it.
"""
import json
import math
import os
import sys
from types import SimpleNamespace

import numpy as np

from rockwear.kernels.polygon import tooth
from rockwear.run import parameters
from rockwear.scenes import dredging, steady_cut

TOOTH = tooth(height=0.07, width=0.05, rake=0.1, clearance=0.1, tip_radius=1e-3, wear_flat=4e-3)
DISCS = SimpleNamespace(positions=np.column_stack([np.linspace(-1e-3, 12e-3, 14), np.full(14, 2e-3)]),
                        radii=np.full(14, 0.5e-3))


def places(vertices):
    """What is written of one outline."""
    values = SimpleNamespace(**parameters.read(dredging.groups(), []))
    track = dredging.Track(values, vertices)
    return {"steady": steady_cut.above_groove(DISCS, vertices, 0.0, math.radians(20)).tolist(),
            "pick": [*track.tip, track.pivot[1], track.ahead]}


outlines = [np.roll(turned, begin, axis=0) for turned in (TOOTH, TOOTH[::-1]) for begin in range(len(TOOTH))]
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump([places(outline) for outline in outlines], out)
os._exit(0)

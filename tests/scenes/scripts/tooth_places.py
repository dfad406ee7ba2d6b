"""Where scenes place a tooth with a flat, whatever vertex its outline begins with and whichever way round it goes, and
a pick of which the face leans forwards.

    yade -n -x tooth_places.py CHECKS.json

Writes {"flat": [{"steady": [whether each disc of a row is left out where a steady cut begins], "pick": [x and y of the
tip, y of the pivot, rad by which a dredge pick starts before its entry]}], "leaning": such rad}; the first of "flat" is
of the tooth as kernels.polygon makes it.
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

SIZE = dict(height=0.07, width=0.05, clearance=0.1, tip_radius=1e-3)
FLAT = tooth(**SIZE, rake=0.1, wear_flat=4e-3)
DISCS = SimpleNamespace(positions=np.column_stack([np.linspace(-1e-3, 12e-3, 14), np.full(14, 2e-3)]),
                        radii=np.full(14, 0.5e-3))


def track(vertices):
    """That of a dredge pick with this outline."""
    return dredging.Track(SimpleNamespace(**parameters.read(dredging.groups(), [])), vertices)


def left_out(vertices):
    """What a steady cut leaves out of DISCS where it begins."""
    return steady_cut.above_groove(DISCS, vertices, 0.0, slope=math.radians(20), edge=-SIZE["tip_radius"]).tolist()


def places(vertices):
    """What is written of one outline."""
    pick = track(vertices)
    return {"steady": left_out(vertices),
            "pick": [*pick.tip, pick.pivot[1], pick.ahead]}


flat = [places(np.roll(turned, begin, axis=0)) for turned in (FLAT, FLAT[::-1]) for begin in range(len(FLAT))]
leaning = track(tooth(**SIZE, rake=-math.radians(30))).ahead
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump({"flat": flat, "leaning": leaning, "leaning flat": left_out(tooth(**SIZE, rake=0.1, wear_flat=4e-3,
                                                                                flat_angle=0.09))}, out)
os._exit(0)

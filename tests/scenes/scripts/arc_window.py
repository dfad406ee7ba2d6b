"""A pick that enters the window of an arc, and a window twice as long of the same rock.

    yade -n -x arc_window.py CHECKS.json

Writes {"short" or "long": [[m that the tip has gone, J/m of its work, of that by friction]]} from the first touch on,
of the short one "outwards": [part of the normal of each support that points away from the arc's centre], and "padova":
{scale_factor: [tensile strength, cohesion and m^3 of that law]}.
"""
import json
import os
import sys
from unittest import mock

import numpy as np

from rockwear.engines import base
from rockwear.kernels import packing
from rockwear.model import rock_mass
from rockwear.run import parameters
from rockwear.scenes import dredging
from rockwear.scenes.parameters import with_defaults

BEHIND, AHEAD = 0.06, 0.14
STEPS, LOOKS, TIME_STEP = 20, 20, 6e-7


def twice(*, width, bonding_gap, **common):
    """The packing of half the width, twice one behind the other."""
    half = packed_box(width=0.5 * width, bonding_gap=bonding_gap, **common)[0]
    positions = np.vstack([half["positions"], half["positions"] + (0.5 * width, 0.0)])
    radii, scale = np.tile(half["radii"], 2), np.tile(half["scale"], 2)
    pairs = packing.contacts(positions, radii, bonding_gap, np.array([width, 0.0]))
    return {"positions": positions, "radii": radii, "scale": scale}, pairs


def course(ahead, cut_time):
    """[[distance, work, friction] after every few steps] with so long a window (m) ahead of the tip, and `outwards`."""
    groups = with_defaults(dredging.groups(), heat=False, background_damping=0.0, wear_acceleration=0.0,
                           cut_time=cut_time, tool_radius_min=2e-3, tool_radius_max=2e-3, tooth_height=0.07,
                           tooth_width=0.05, time_scale=20.0, window_behind=BEHIND, window_ahead=ahead)
    scene = dredging.make(parameters.read(groups, []))
    assert TIME_STEP < scene.time_step, scene.time_step
    scene.time_step = TIME_STEP
    scene.build()
    away = scene.boundary.places - scene.rock.strip.centre
    outwards = np.sum(scene.boundary.normals * away, axis=1) / np.linalg.norm(away, axis=1)
    found, programme = [], scene.programme
    while len(found) < LOOKS:
        base.run(STEPS)
        if scene.tool.contact.work_done:
            tip = programme.motion.pose(programme.path_time()).of([programme.tip])[0]
            found.append((programme.window.distance(tip), scene.tool.contact.work_done,
                          scene.tool.contact.friction))
        if scene.step % scene.chunk == 0:
            scene.canonical()
            programme.run()
    return found, outwards.tolist()


def padova(scale_factor):
    """[Rn, c, m^3] of a bond."""
    groups = with_defaults(dredging.groups(), bond_law="padova", scale_factor=scale_factor)
    law = dredging.make(parameters.read(groups, [])).bond_law
    return [law.Rn, law.c, law.m**3]


packed_box = rock_mass.packed_box
found = {"padova": {scale_factor: padova(scale_factor) for scale_factor in (2, 4)}}
found["short"], found["outwards"] = course(AHEAD, 0.4)
with mock.patch.object(rock_mass, "packed_box", twice):
    # A shorter cut has a longer window end at the same place: the arc is the same.
    width = BEHIND + AHEAD
    found["long"], _ = course(AHEAD + width, 0.4 - width * (1 + 1 / rock_mass.SLABS) / (0.7 * 1.6204))
with open(sys.argv[1], "w", encoding="utf-8") as out:
    json.dump(found, out)
os._exit(0)

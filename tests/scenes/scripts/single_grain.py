"""One grain on a wall, in the loop of the granular scenes: what it does is known exactly. Writes CHECKS.json.

    yade -n -x single_grain.py CHECKS.json
"""
import json
import math
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from yade import NewtonIntegrator, O, utils

from rockwear.engines import access, base
from rockwear.engines.vibration import Vibration
from rockwear.model.granular import Grains, rectangle
from rockwear.scenes import granular

RADIUS, G = 2.5e-3, 9.81
DEFAULTS = {p.name: p.default for group in (granular.GRAINS, granular.ACCURACY) for p in group.parameters}


class One(granular.Granular):
    """A grain at a height (m) over a wall; slope: of gravity against the wall."""

    def __init__(self, *, height=0.0, slope=0.0, vibration=None, **values):
        self.output = SimpleNamespace(log=lambda: {})
        self.slope, self.vibrates = math.atan(slope), vibration
        v = {**DEFAULTS, "radius_min": RADIUS, "radius_max": RADIUS, "time_step_fraction": 0.1, **values}
        # Away from the seam of the wall's two triangles, where both press.
        grains = Grains(positions=np.array([[0.0, RADIUS + height, 0.3]]), radii=np.array([RADIUS]), density=2500.0)
        super().__init__(v, grains=grains, walls=rectangle((-1, 0, -1), (2, 0, 0), (0, 0, 2)), stages={"all": 10.0})
        self.build()
        if not vibration:
            access.yade_engine(NewtonIntegrator).gravity = (G * math.sin(self.slope), -G * math.cos(self.slope), 0)
        self.state_of = O.bodies[self.ids[0]].state

    def own_engines(self):
        if not self.vibrates:
            return []
        amplitude, frequency = self.vibrates
        return [Vibration(amplitude=amplitude, frequency=frequency, direction=(0, 1, 0), gravity=G, period=3,
                          clock=lambda: self.time)]

    def after(self, seconds):
        """The grain after so many seconds more."""
        base.run(round(seconds / self.time_step))
        return self.state_of


def rebound(restitution):
    """Height of the first rebound over that of the fall."""
    one = One(height=0.02, restitution=restitution)
    one.after(math.sqrt(2 * 0.02 / G) + 0.003)
    highest = 0.0
    while one.state_of.vel[1] > 0:
        highest = one.after(one.time_step).pos[1] - RADIUS
    return highest / 0.02


def rolled(slope, **values):
    """Way (m) of the grain in 0.2 s from rest."""
    one = One(slope=slope, **values)
    one.after(0.2)
    return one.state_of.pos[0]


def lifted(acceleration):
    """Highest gap (m) between the grain and a wall that vibrates at 50 Hz with a peak acceleration over g."""
    omega = 2 * math.pi * 50
    one = One(vibration=(acceleration * G / omega**2, 50.0), restitution=0.3)
    return max(one.after(5e-4).pos[1] - RADIUS for _ in range(200))


def fall_in_a_vibrating_frame():
    """(place (m) after a fall of 0.05 s in the frame of the box, work of gravity and inertia, kinetic energy)."""
    one = One(height=0.5, vibration=(1e-3, 40.0))
    place = one.after(0.05).pos[1] - RADIUS - 0.5
    return place, one.gravity_work(), utils.kineticEnergy(), one.time


found = {"rebound": {e: rebound(e) for e in (0.5, 0.9)},
         "rolled": {"free": rolled(0.2, rolling_resistance=0.0), "held": rolled(0.2, rolling_resistance=0.15),
                    "rolling": rolled(0.2, rolling_resistance=0.1), "sliding": rolled(
                        2.0, rolling_resistance=0.0, wall_friction=0.3)},
         "lifted": {a: lifted(a) for a in (0.8, 1.5)}, "fall": fall_in_a_vibrating_frame()}
Path(sys.argv[-1]).write_text(json.dumps(found), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

"""The test tooth on a curved path, watched from outside: its place at the end, and the power of all forces on it."""

import numpy as np
from yade import O

from rockwear.run import main as run
from rockwear.scenes import cutting
from rockwear.engines.base import Engine
from rockwear.kernels.rigid_motion import SwingAndRotation


class Power(Engine):
    """Work of all forces and torques on the tool's bodies, step by step."""

    name = "power"

    def __init__(self, bodies):
        super().__init__()
        self.bodies, self.work = bodies, 0.0

    def act(self):
        elapsed = self.elapsed()
        for body in self.bodies.ids:
            state = O.bodies[body].state
            self.work -= (O.forces.f(body).dot(state.vel) + O.forces.t(body).dot(state.angVel)) * elapsed

    def state(self):
        return {"work": self.work}

    def restore(self, state):
        self.work = float(state["work"])


class Curved(cutting.Cutting):
    """A turn about a centre 15 mm above the tip at 200 rad/s, and a swing."""

    looking = {*cutting.Cutting.looking, "power"}

    def _motion(self, v):
        straight = super()._motion(v)
        return SwingAndRotation(centre=straight.start + (0, 0.015), swing=(1.0, -0.5), angular_velocity=200.0, pivot=(0, 0.015))

    def _make_engines(self):
        super()._make_engines()
        self.power = Power(self.bodies)
        self._register(self.live[0], self.power, *self.live[1:])

    def _periods(self):
        return {**super()._periods(), "power": 1}

    def results(self):
        tool = self.bodies
        exact = self.motion.pose(self._path_time()).of(self.tool.positions[list(tool.body_of)])
        now = np.array([tuple(O.bodies[body].state.pos)[:2] for body in tool.body_of.values()])
        turn = self.motion.pose(self._path_time()).turn
        tool.connect()
        return {**super().results(), "off_path": (float(np.abs(now - exact).max()), "m"),
                "off_turn": (abs(tool.pose.turn - turn), "rad"), "power_work": (self.power.work, "J/m"),
                "turned": (turn, "rad"), "cutting_work": (self.contact.work_done, "J/m")}


run.main("curved", cutting.PARAMETERS, Curved)

"""The test tooth on a curved path, observed from outside: its place at the end, and the power of all forces on it."""
from types import SimpleNamespace

import numpy as np
from yade import O

from rockwear.engines.base import FORCES, Engine
from rockwear.kernels.rigid_motion import SwingAndRotation
from rockwear.run.main import main
from rockwear.scenes import cutting, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.cut_output import CutOutput
from rockwear.scenes.programme import Cycles


class Power(Engine):
    """Work of all forces and torques on the tool's bodies, step by step."""

    name = "power"
    phase = FORCES

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


class CurvedCycles(Cycles):
    """A rotation about a centre 15 mm above the tip at 200 rad/s, and a swing."""

    def attach(self, scene):
        super().attach(scene)
        self.motion = SwingAndRotation(centre=self.motion.start + (0, 0.015), swing=(1.0, -0.5), angular_velocity=200.0,
                                       pivot=(0, 0.015))


class Output(CutOutput):
    """With how far the tool is off its path, and the work of all forces on it."""

    def results(self):
        tool = self.scene.tool
        pose, bodies = self.scene.programme.motion.pose(self.scene.programme.path_time()), tool.bodies
        exact = pose.of(tool.model.positions[list(bodies.body_of)])
        now = np.array([tuple(O.bodies[body].state.pos)[:2] for body in bodies.body_of.values()])
        bodies.connect()
        return {**super().results(), "off_path": (float(np.abs(now - exact).max()), "m"),
                "off_turn": (abs(bodies.pose.turn - pose.turn), "rad"), "power_work": (self.scene.power.work, "J/m"),
                "turned": (pose.turn, "rad"), "cutting_work": (tool.contact.work_done, "J/m")}


class CurvedCut(Cut):
    """Records the power before the contacts of the tool are sampled."""

    def __init__(self, **given):
        super().__init__(**given)
        self.output = Output(self)

    def _make_engines(self):
        super()._make_engines()
        self.power = Power(self.tool.bodies)
        self._register(self.bonds, self.power, *self.engines[1:])


def make(values):
    """The scene of the test tooth on that path."""
    v = SimpleNamespace(**values)
    return CurvedCut(rock=cutting.box(v), tool=cutting.tool(v), background_damping=v.background_damping,
                     programme=CurvedCycles(times=cutting.times(v), **cutting.motion(v)), **parts.common(v))


main("curved_cut", cutting.GROUPS, make)

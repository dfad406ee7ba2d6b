"""A tool that follows a curved path."""
from yade import O

from rockwear.engines.base import Engine


class PathFollower(Engine):
    """Leads a tool that turns along its path, chord by chord (a straight one needs no leading).

    bodies: scene.ToolBodies; clock: a function giving the time (s) along the path that YADE's positions have now;
    period: steps between visits.
    """

    name = "path_follower"

    def __init__(self, *, bodies, clock, period=1):
        super().__init__(period=period)
        self.bodies, self.clock = bodies, clock

    def act(self):
        # This engine comes after the integrator: positions are already those of the next step.
        self.bodies.aim(self.clock() + O.dt, self.period * O.dt)

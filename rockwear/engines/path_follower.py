"""A tool that follows a curved path."""
from yade import O

from rockwear.engines.base import Engine


class PathFollower(Engine):
    """Sets the velocities of a tool that turns, for one chord of its path after the other (a straight path needs none).

    bodies: the tool's bodies; clock: a function giving the time (s) along the path that YADE's positions have now;
    period: steps between visits, and of a chord.
    """

    name = "path_follower"

    def __init__(self, *, bodies, clock, period=1):
        super().__init__(period=period)
        self.bodies, self.clock = bodies, clock

    def act(self):
        self.bodies.aim(self.clock(), self.period * O.dt)

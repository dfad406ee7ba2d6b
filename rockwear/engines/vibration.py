"""Vibration of a rigid container."""
import math

from yade import NewtonIntegrator, O, Vector3

from rockwear.engines import access
from rockwear.engines.base import Engine


class Vibration(Engine):
    """Sets gravity as it acts in the frame of a container that vibrates with A sin(2 pi f t): g + A (2 pi f)^2
    sin(2 pi f t) along `direction`.

    In that frame the walls stand still, and the inertial force -m a is a part of gravity. The acceleration is that of
    the middle of the time to the next visit.
    amplitude: A, m; frequency: f, Hz; direction: (3,) unit vector; gravity: m/s2, downwards along -y; clock: a function
    giving t, s, and None while the container stands.
    """

    name = "vibration"

    def __init__(self, *, amplitude, frequency, direction, gravity, clock, period=1):
        super().__init__(period=period)
        self.omega, self.clock = 2 * math.pi * frequency, clock
        self.peak = Vector3(*direction) * (amplitude * self.omega**2)
        self.gravity = Vector3(0, -gravity, 0)

    def connect(self):
        self.integrator = access.yade_engine(NewtonIntegrator)

    def act(self):
        now = self.clock()
        if now is not None:
            phase = self.omega * (now + 0.5 * self.period * O.dt)
            self.integrator.gravity = self.gravity + self.peak * math.sin(phase)

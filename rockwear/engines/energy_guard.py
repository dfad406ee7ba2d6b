"""Check of a run's kinetic energy."""
import math

from yade import utils

from rockwear.engines.base import Engine, RunEnded


class EnergyGuard(Engine):
    """Ends a run whose kinetic energy is far above all the work put in, or not a number.

    work: a function giving the work done on the rock so far (J); floor: J of work to assume at least.
    """

    name = "energy_guard"
    runaway = 10.0

    def __init__(self, *, work, floor, period=1):
        super().__init__(period=period)
        self.work, self.floor = work, floor

    def act(self):
        kinetic = utils.kineticEnergy()
        allowed = self.runaway * max(self.work(), self.floor)
        if not math.isfinite(kinetic) or kinetic > allowed:
            raise RunEnded(f"the simulation blew up: kinetic energy {kinetic:g} J is not below {allowed:g} J, "
                           f"{self.runaway:g} times the work done; try a smaller time_step_fraction", False)

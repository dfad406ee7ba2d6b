"""Rotation of the shear springs of bonds that rotate fast."""
import numpy as np
from yade import O

from rockwear.kernels.shear_rotation import shear_to_start_from, turning_rates
from rockwear.engines.access import states
from rockwear.engines.base import Engine
from rockwear.engines.bond_log import INTACT

FAST = 0.003
"""Angle (rad) a step from which a bond counts as rotating fast. Slower chips gain less than 0.2 of their energy a
second in steps of 30 us, a hundredth in a millisecond in steps of 0.3 us; the default background damping takes it 40
times a second, and two thirds in a millisecond."""
SEARCH_PERIOD = 100
"""Steps between searches for such bonds."""


class ShearRotation(Engine):
    """Corrects YADE's rule for shear where bonds rotate fast (kernels.shear_rotation): spinning chips would gain
    energy.

    bonds: engines.bonds.Bonds or cpm_bonds.CpmBonds, in space and with shear that follows the points of contact;
    radii: (n,) m of the bodies 0..n-1. YADE's law starts from what it writes at the beginning of a step.
    """

    name = "shear_rotation"

    def __init__(self, *, bonds, radii, period=1):
        super().__init__(period=period)
        self.bonds, self.radii = bonds, radii
        self.fast = np.zeros(0, int)

    def act(self):
        if O.iter % SEARCH_PERIOD == 0:
            self._find_fast()
        fast = self.fast[self.bonds.status[self.fast] == INTACT]
        if not len(fast):
            return
        shear, stiffness, set_shear = self.bonds.shear(fast)
        ends = self.bonds.ends[fast].T
        line, velocity, spins = self._motion(ends)
        set_shear(shear_to_start_from(shear, line, velocity, spins, self.radii[ends], stiffness, O.dt))

    def _find_fast(self):
        intact = np.flatnonzero(self.bonds.status == INTACT)
        rates = turning_rates(*self._motion(self.bonds.ends[intact].T))
        self.fast = intact[rates * O.dt > FAST]

    def _motion(self, ends):
        """Of the contacts of bodies `ends` (2, n): line (n, 3) m, velocity (n, 3) m/s, spins (2, n, 3) rad/s."""
        bodies, places = np.unique(ends, return_inverse=True)
        found = states(bodies.tolist())[places.reshape(ends.shape)]
        gap = found[1] - found[0]
        return gap[:, :3], gap[:, 3:6], found[:, :, 6:9]

    def state(self):
        return {"fast": self.fast.copy()}

    def restore(self, state):
        self.fast = state["fast"].copy()

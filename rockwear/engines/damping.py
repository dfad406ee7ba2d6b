"""Damping of the rock: of all its motion, and of vibrations within grains."""
import math

import numpy as np
from yade import O, utils

from rockwear.engines.access import FIXED, IN_PLANE
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.bond_log import SEPARATED
from rockwear.engines.memory import MEMORY, WORDS, Motions, lists_of_forces
from rockwear.kernels.compiled import exerted_on
from rockwear.kernels.fragments import pieces
from rockwear.kernels.rigid_motion import rigid_parts


class BackgroundDamping(Engine):
    """F = -rate m v and T = -rate I omega on the rock, as its exact solution v(t) = v(0) exp(-rate t) between visits.

    rate: 1/s; bodies: ids. The operator split has an error of the order rate x period, and saves a force on each body
    in each step. The kinetic energy dissipated is exact: YADE's sum before the visit, times 1 - exp(-2 rate t).
    """

    name = "background_damping"

    def __init__(self, *, rate, bodies, period=1):
        super().__init__(period=period)
        self.rate, self.bodies = rate, bodies
        self.dissipated = 0.0

    def connect(self):
        self.motions = Motions(self.bodies)

    def act(self):
        factor = math.exp(-self.rate * self.elapsed())
        self.dissipated += utils.kineticEnergy() * (1 - factor * factor)
        # What a window holds aside now may be rock later.
        free = np.flatnonzero([state.blockedDOFs != FIXED for state in self.motions.states])
        for name in ("velocity", "spin"):
            self.motions.write(name, free, self.motions.read(name, free) * factor)

    def state(self):
        return {"dissipated": self.dissipated}

    def restore(self, state):
        self.dissipated = float(state["dissipated"])


class GrainDamping(Engine):
    """Vibrations within grains decay as exp(-rate t) between visits: what the motion of a grain's discs is beside that
    of a rigid body. Momentum stays, and the kinetic energy dissipated is exact.

    It takes from the velocities at the time of the positions, half a step after those of the leapfrog: a visit then
    cannot add to a vibration, at whatever phase it comes. Visits that took all of the leapfrog's own velocities, at the
    same phase each time, fed pairs of discs to 20 m/s.

    Bonds within grains do not break, and YADE's rule for shear adds energy to discs that vibrate against each other:
    loose grains that a blow has set ringing would ring louder and louder (calibration/results/trust.md).

    rock: the specimen, in the plane, with grains; bonds: engines.bond_log.BondLog; rate: 1/s.
    """

    name = "grain_damping"
    phase = FORCES

    def __init__(self, *, rock, bonds, rate, period=1):
        super().__init__(period=period)
        self.rock, self.bonds, self.rate = rock, bonds, rate
        self.within = np.equal(*rock.grains[rock.pairs].T)
        self.dissipated = 0.0

    def connect(self):
        self.motions = Motions(range(self.rock.count))

    def act(self):
        rock, lost = self.rock, 1.0 - math.exp(-self.rate * self.elapsed())
        piece = pieces(rock.count, rock.pairs, self.within & (self.bonds.status != SEPARATED))
        # Of grains that a boundary holds in part it is not known how they would move.
        held = np.array([state.blockedDOFs != IN_PLANE for state in self.motions.states])
        free = np.flatnonzero((np.bincount(piece, held) == 0)[piece] & (np.bincount(piece) > 1)[piece])
        if not len(free):
            return
        own = dict(masses=rock.masses[free], inertias=rock.inertias[free])
        forces, torques = (exerted_on(MEMORY, WORDS, lists, free) for lists in lists_of_forces())
        now, turning = self.motions.read("moving", free).T, self.motions.read("turning", free)[0]
        motion = dict(velocities=now + 0.5 * O.dt * forces[:, :2] / own["masses"][:, None],
                      spins=turning + 0.5 * O.dt * torques[:, 2] / own["inertias"])
        velocities, spins = rigid_parts(np.unique(piece[free], return_inverse=True)[1], **own, **motion,
                                        positions=self.motions.read("in_plane", free).T)
        vibration, rolling = motion["velocities"] - velocities, motion["spins"] - spins
        self.dissipated += 0.5 * lost * (2.0 - lost) * float(
            own["masses"] @ (vibration**2).sum(axis=1) + own["inertias"] @ rolling**2)
        self.motions.write("moving", free, (now - lost * vibration).T)
        self.motions.write("turning", free, turning - lost * rolling)

    def state(self):
        return {"dissipated": self.dissipated}

    def restore(self, state):
        self.dissipated = float(state["dissipated"])

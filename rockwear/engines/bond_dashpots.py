"""Dashpots of bonds and of contacts between rock particles, in the plane."""
import numpy as np
from yade import InsertionSortCollider, O, Vector3

from rockwear.engines.access import rock_states, yade_engine
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.bond_log import BROKEN, INTACT
from rockwear.engines.rock_friction import possible_contacts


def coefficients(rock, ratio, *, pairs=None, stiffness=None):
    """(cn, ct), (m,) N s/m: xi 2 sqrt(m_i m_j k / (m_i + m_j)) of each bond [Rojek 2014, eqs 20-22], with its kn, kt.

    ratio: xi; a particle that is fixed counts as infinitely heavy. pairs (m, 2), stiffness (2, m or 1) N/m: of other
    contacts than the bonds.
    """
    pairs, stiffness = (rock.pairs, rock.stiffness()) if pairs is None else (pairs, stiffness)
    inverse = np.where(rock.fixed, 0.0, 1 / rock.masses)[pairs].sum(axis=1)
    reduced = np.divide(1.0, inverse, out=np.zeros(len(inverse)), where=inverse > 0)
    return 2 * ratio * np.sqrt(reduced * stiffness)


class BondDashpots(Engine):
    """Normal and tangential dashpots in parallel with the springs [Rojek 2014, eqs 18-19], bodies 0..n-1.

    They act on the pairs of the rock as long as their bond is intact, later while the two are nearer than when it was
    made, and once they have been apart while they overlap, as other pairs of its particles. rock: the specimen, in the
    plane; bonds: engines.bond_log.BondLog, whose law has the stiffness of other contacts, too; ratio: xi, of the
    critical damping. All velocities are read and all forces added in each step, which costs more than the step itself.
    `dissipated` (J) is the work of the forces over the mean of the velocities before and after each step.
    """

    name = "bond_dashpots"
    phase = FORCES

    def __init__(self, *, rock, bonds, ratio):
        super().__init__()
        self.rock, self.bonds, self.ratio = rock, bonds, ratio
        self.of_bonds = coefficients(rock, ratio)
        self.moving = np.flatnonzero(~rock.fixed).tolist()
        self.forces, self.before, self.dissipated = np.zeros((rock.count, 3)), np.zeros((rock.count, 3)), 0.0

    def connect(self):
        self.seen = None

    def _keep_up(self):
        """Once the collider has run, list the bonds, and behind them the other pairs that may touch before it runs
        again, in an order that a loaded scene has, too."""
        # A checkpoint puts another collider in its place.
        runs = yade_engine(InsertionSortCollider).numAction
        if runs == self.seen:
            return
        rock, self.seen = self.rock, runs
        bodies = possible_contacts(rock.count)[:, 1:]
        low, high = np.sort(bodies, axis=1).T
        keys = np.setdiff1d(low * rock.count + high, np.sort(rock.pairs, axis=1) @ (rock.count, 1))
        other = np.column_stack(np.divmod(keys, rock.count))
        self.first, self.second = np.concatenate([rock.pairs, other]).T
        own = coefficients(rock, self.ratio, pairs=other, stiffness=np.array([self.bonds.law.stiffest()]).T)
        self.normal, self.tangential = np.concatenate([self.of_bonds, own], axis=1)

    def act(self):
        self._keep_up()
        rock, i, j = self.rock, self.first, self.second
        states = rock_states(rock)
        places, motion = states[:, :2], states[:, [3, 4, 8]]
        self._count(motion)
        line = places[j] - places[i]
        distance = np.hypot(*line.T)
        normal = line / distance[:, None]
        half_overlap = 0.5 * (rock.radii[i] + rock.radii[j] - distance)
        on, status, m = half_overlap > 0, self.bonds.status, len(rock.pairs)
        on[:m] = (status == INTACT) | np.where(status == BROKEN, distance[:m] < rock.bond_lengths, on[:m])
        x, y = normal.T
        arms = rock.radii[i] - half_overlap, rock.radii[j] - half_overlap
        relative = motion[j, :2] - motion[i, :2]
        pull = on * self.normal * (relative[:, 0] * x + relative[:, 1] * y)
        shear = on * self.tangential * (relative[:, 1] * x - relative[:, 0] * y
                                        - motion[i, 2] * arms[0] - motion[j, 2] * arms[1])
        along = pull * x - shear * y, pull * y + shear * x
        self.forces = np.stack([
            *(np.bincount(i, part, rock.count) - np.bincount(j, part, rock.count) for part in along),
            np.bincount(i, shear * arms[0], rock.count) + np.bincount(j, shear * arms[1], rock.count)], axis=1)
        add_force, add_torque = O.forces.addF, O.forces.addT
        for body, (fx, fy, torque) in zip(self.moving, self.forces[self.moving].tolist()):
            add_force(body, Vector3(fx, fy, 0.0))
            add_torque(body, Vector3(0.0, 0.0, torque))
        self.before = motion

    def _count(self, motion):
        """Add the work of the forces of the last step."""
        self.dissipated -= 0.5 * float(np.sum(self.forces * (self.before + motion))) * O.dt

    def state(self):
        return {"dissipated": self.dissipated, "forces": self.forces.copy(), "before": self.before.copy()}

    def restore(self, state):
        self.dissipated = float(state["dissipated"])
        self.forces, self.before = state["forces"].copy(), state["before"].copy()

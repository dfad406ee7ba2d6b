"""Constant pressure on the sides of a specimen, and on its ends before their motion is prescribed."""
import math

import numpy as np
from yade import O

from rockwear.engines.access import rock_positions
from rockwear.engines.base import FORCES, Engine
from rockwear.kernels.membrane import pressure_forces, upper_chain


class Membrane(Engine):
    """A pressure on both sides of a specimen along x, by forces on the discs that a membrane there touches.

    rock: the specimen, bodies 0..n-1; ends: (one disc of the left platen, one of the right one), whose motion is that
    of the ends x = 0 and x = width; pressure: a function giving Pa; interval: steps between searches for the discs.

    Both sides carry the pressure from end to end, so that they are in equilibrium with each other. The pressure is a
    force per length of the membrane, which follows the specimen: it stays the same however the sides deform. Between
    searches the forces stay as they are, so that their work is force times displacement.
    """

    name = "membrane"
    phase = FORCES

    def __init__(self, *, rock, ends, pressure, interval=100, period=1):
        super().__init__(period=period)
        self.rock, self.ends, self.pressure, self.interval = rock, list(ends), pressure, interval
        self.bodies, self.loads, self.places = np.zeros(0, int), np.zeros((0, 2)), np.zeros((0, 2))
        self.closed, self.next, self.extent = 0.0, 0, rock.width
        self._list()

    def _list(self):
        self.added = [(body, (fx, fy, 0.0)) for body, (fx, fy) in zip(self.bodies.tolist(), self.loads.tolist())]

    def act(self):
        if O.iter >= self.next:
            self._place()
        for body, load in self.added:
            O.forces.addF(body, load)

    def _place(self):
        positions, radii = rock_positions(self.rock), self.rock.radii
        self.closed += self._work_since(positions[self.bodies])
        moved = positions[self.ends, 0] - self.rock.positions[self.ends, 0]
        left, right = (0.0, self.rock.width) + moved
        self.extent = float(right - left)
        bodies, loads = [], []
        for sign in (1.0, -1.0):
            side = positions * (1.0, sign)
            chain = upper_chain(side, radii, ball=radii.max())
            forces = pressure_forces(side[chain], self.pressure(), begin=left, end=right)
            bodies.append(chain)
            loads.append(forces * (1.0, sign))
        self.bodies, self.loads = np.concatenate(bodies), np.concatenate(loads)
        self.places = positions[self.bodies]
        self.next = O.iter + self.interval
        self._list()

    def _work_since(self, positions):
        return float(np.sum(self.loads * (positions - self.places)))

    @property
    def work(self):
        """J per metre, done on the specimen."""
        return self.closed + self._work_since(rock_positions(self.rock)[self.bodies])

    def across(self, upper):
        """Pa: mean pressure across the line between the discs `upper` (n,) bool and the others, in this step.

        It is what the others exert on them, over the length of the specimen, and shows what the specimen itself feels
        of the pressure, inertia included.
        """
        force = O.forces.f
        total = math.fsum(force(i)[1] for i in np.flatnonzero(upper).tolist())
        return (total - float(self.loads[upper[self.bodies], 1].sum())) / self.extent

    def state(self):
        return {"bodies": self.bodies.copy(), "loads": self.loads.copy(), "places": self.places.copy(),
                "closed": self.closed, "next": self.next, "extent": self.extent}

    def restore(self, state):
        self.bodies, self.loads, self.places = (state[name].copy() for name in ("bodies", "loads", "places"))
        self.closed, self.next, self.extent = float(state["closed"]), int(state["next"]), float(state["extent"])
        self._list()


class PressedEnds(Engine):
    """Two sets of discs, each of which moves along x as one rigid body under a force, until it is released.

    left, right: ids, their motion along x prescribed; masses: (n,) kg of all bodies; force: a function giving the N
    with which each is pressed on the specimen, None once they are released.
    """

    name = "pressed_ends"
    phase = FORCES

    def __init__(self, *, left, right, masses, force, period=1):
        super().__init__(period=period)
        self.ends = [(ids, 1.0 / float(masses[ids].sum()), side) for ids, side in ((left, 1.0), (right, -1.0))]
        self.force = force
        self.velocities = [0.0, 0.0]
        self.work = 0.0

    def act(self):
        elapsed, pressing, force = self.elapsed(), self.force(), O.forces.f
        if pressing is None:
            return
        for end, (ids, per_mass, side) in enumerate(self.ends):
            load, before = side * pressing, self.velocities[end]
            total = math.fsum(force(i)[0] for i in ids) + load
            after = self.velocities[end] = before + total * per_mass * elapsed
            self.work += 0.5 * load * (before + after) * elapsed
            for i in ids:
                state = O.bodies[i].state
                state.vel = (after, state.vel[1], 0.0)

    def state(self):
        return {"velocities": np.array(self.velocities), "work": self.work}

    def restore(self, state):
        self.velocities = state["velocities"].tolist()
        self.work = float(state["work"])

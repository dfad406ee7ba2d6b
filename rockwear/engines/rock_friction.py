"""Friction between rock particles."""
from functools import cache

import numpy as np

from yade import CpmPhys, InsertionSortCollider, JCFpmPhys, O

from rockwear.engines.access import contact_energy, contact_of, yade_engine, yade_friction_law
from rockwear.engines.base import Engine
from rockwear.engines.bond_log import SEPARATED
from rockwear.engines.memory import (
    MEMORY, WORDS, class_of, kernel_layout, list_of_bodies, list_of_contacts, place)
from rockwear.kernels import compiled


@cache
def bond_classes():
    """(2,) what begins the constants of a bond in memory."""
    return np.array([class_of(JCFpmPhys()), class_of(CpmPhys())])


def possible_contacts(particles, others=np.empty(0, int)):
    """(k, 3) indices in memory and bodies of the pairs among bodies 0..particles-1 that YADE holds possible; but for
    those with constants of the classes `others`."""
    if not len(O.interactions):
        return np.empty((0, 3), np.int64)
    return compiled.between_rock(WORDS, kernel_layout(), list_of_contacts(), particles, others)


def _row(contact):
    """(place in memory, body, body) of a contact of YADE's."""
    return place(contact), contact.id1, contact.id2


class RockContacts(Engine):
    """Contacts between rock particles that are no bonds, and the friction energy dissipated there, `total` (J).

    bonds: engines.bonds.Bonds; motion: engines.velocity_increment.VelocityIncrement of the rock, bodies 0..n-1.
    """

    name = "rock_friction"

    def __init__(self, *, bonds, motion, period=1):
        super().__init__(period=period)
        self.bonds, self.motion = bonds, motion
        self.particles = motion.count

    def connect(self):
        self.layout, self.body_list = kernel_layout(), list_of_bodies()
        self.motion.connect()
        self.find_contacts()

    def find_contacts(self):
        """Find the contacts between rock particles that are no bonds, and the pairs that may touch: `places` (k, 3),
        where they lie in memory and their bodies.

        There they stay until the collider runs again or one of their bodies is erased: no other step of YADE's loop
        erases a contact for good. Who erases one from Python has contacts found anew before the loop goes on.
        """
        self.collider = yade_engine(InsertionSortCollider)
        self._find()

    def _find(self):
        self.seen = self.collider.numAction
        self.bonds.parted.clear()
        self.places = compiled.by_bodies(possible_contacts(self.particles, bond_classes()), self.particles)

    def _keep_up(self):
        """Bring `places` up to date, where the collider has run or bonds have parted since."""
        if self.collider.numAction != self.seen:
            self._find()
        elif self.bonds.parted:
            self._add_parted()

    def _add_parted(self):
        """Add the pairs of bonds that have parted, where YADE still holds them possible and no new bond is there."""
        added = []
        for n in self.bonds.parted:
            pair = tuple(self.bonds.pairs[n].tolist())
            if self.bonds.status[n] == SEPARATED and all(O.bodies[i] for i in pair) and O.interactions.has(*pair):
                row = _row(contact_of(*pair))
                if not (self.places == row).all(axis=1).any():
                    added.append(row)
        self.bonds.parted.clear()
        self.places = np.concatenate([self.places, np.array(added, np.int64).reshape(-1, 3)])

    @property
    def contacts(self):
        """YADE's contacts of the pairs that are in contact now."""
        return [contact_of(*pair) for pair in self.touching_pairs().tolist()]

    def touching_pairs(self):
        """(k, 2) bodies of the pairs that are in contact now."""
        self._keep_up()
        return compiled.touching(WORDS, self.layout, self.body_list, self.places)

    def elastic_energy(self):
        """Strain energy (J) of the contacts between rock particles that are no bonds."""
        self.find_contacts()
        return contact_energy(self.contacts)


class RockFriction(RockContacts):
    """Friction work between rock particles, by particle, sampled at each visit.

    A contact that slides dissipates |Ft| times the irreversible slip (kernels.compiled.rub), over the mean of
    the velocities before and after the integrator, whose change `motion` tells. (YADE's sum of plastic dissipation
    is not used: it takes the force after the slip for the mean force, and omits the shear spring of a contact that
    opens. Where particles collide, each time for a few steps, it misses a fifth of the work.)
    """

    def __init__(self, **common):
        super().__init__(**common)
        self.work = np.zeros(self.particles)
        self.total = 0.0

    def act(self):
        elapsed = self.elapsed()
        self._keep_up()
        # What is open has no force.
        broken = [_row(contact) for contact, phys in self.bonds.broken.values() if phys.crackJointAperture == 0.0]
        contacts = np.concatenate([broken, self.places]) if broken else self.places
        friction = np.full(len(contacts), np.nan)
        friction[:len(broken)] = self.bonds.law.mu
        if len(contacts):
            self.total += compiled.rub(
                MEMORY, WORDS, self.layout, self.body_list, self.motion.tables, self.since, contacts, friction, elapsed,
                O.dt, self.work)

    def take_work(self):
        """(n,) friction work (J) of each particle since the last call."""
        taken, self.work = self.work, np.zeros(self.particles)
        return taken

    def state(self):
        return {"work": self.work.copy(), "total": self.total}

    def restore(self, state):
        self.work, self.total = state["work"].copy(), float(state["total"])


class YadeFriction(RockContacts):
    """YADE's sum of plastic dissipation, less the tool's part of it; nothing is sampled.

    That is exact enough where contacts last long against a step. It does not tell which particles dissipate.
    contact: the FacetContact of the tool.
    """

    def __init__(self, *, contact, period=None, **common):
        super().__init__(period=period, **common)
        self.contact = contact

    def act(self):
        self.find_contacts()

    @property
    def total(self):
        """J so far."""
        return yade_friction_law().plasticDissipation() - self.contact.in_yade_balance

    def state(self):
        # YADE does not save it.
        return {"plastic_dissipation": yade_friction_law().plasticDissipation()}

    def restore(self, state):
        yade_friction_law().initPlasticDissipation(float(state["plastic_dissipation"]))

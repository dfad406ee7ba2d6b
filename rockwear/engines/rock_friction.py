"""Friction between rock particles."""
from functools import cache

import numpy as np

from yade import CpmPhys, InsertionSortCollider, JCFpmPhys, O

from rockwear.engines.access import contact_energy, contact_of, yade_engine, yade_friction_law
from rockwear.engines.base import FORCES, Engine
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


class RockContacts(Engine):
    """Contacts between rock particles that are no bonds, and the friction energy dissipated there, `total` (J).

    bonds: engines.bonds.Bonds; motion: engines.velocity_increment.VelocityIncrement of the rock, bodies 0..n-1.
    """

    name = "rock_friction"
    phase = FORCES

    def __init__(self, *, bonds, motion, period=1):
        super().__init__(period=period)
        self.bonds, self.motion = bonds, motion
        self.particles = len(motion.per_mass)

    def connect(self):
        self.layout, self.body_list = kernel_layout(), list_of_bodies()
        self.motion.connect()
        self.held, self.places = {}, np.zeros(0, np.int64)
        self.find_contacts()

    def find_contacts(self):
        """Find the contacts between rock particles that are no bonds, and the pairs that may touch before the collider
        runs again or a bond parts: their `places` (k,) in memory."""
        self.collider = yade_engine(InsertionSortCollider)
        self.seen = self.collider.numAction
        self.bonds.parted.clear()
        found = possible_contacts(self.particles, bond_classes())
        # In the order of their bodies: a loaded scene has them in another order.
        places, new, gone = compiled.changes(found, self.particles, self.places)
        # What Python holds keeps its place in memory, also where YADE erases it, with one of its bodies. So a place
        # that is known is the contact that it was.
        for where in gone.tolist():
            del self.held[where]
        for where, *pair in found[new].tolist():
            # YADE would end where it is asked for contacts of an erased body.
            if all(O.bodies[body] for body in pair):
                self.held[where] = contact_of(*pair)
        if len(self.held) < len(places):
            places = places[[where in self.held for where in places.tolist()]]
        self.places = places

    def _keep_up(self):
        """Bring `possible` up to date, where the collider has run or bonds have parted since."""
        if self.collider.numAction != self.seen:
            self.find_contacts()
        elif self.bonds.parted:
            self._add_parted()

    def _add_parted(self):
        """Add the pairs of bonds that have parted, where YADE still holds them possible and no new bond is there."""
        added = []
        for n in self.bonds.parted:
            pair = tuple(self.bonds.pairs[n].tolist())
            if self.bonds.status[n] == SEPARATED and all(O.bodies[i] for i in pair) and O.interactions.has(*pair):
                interaction = contact_of(*pair)
                where = place(interaction)
                if where not in self.held:
                    self.held[where] = interaction
                    added.append(where)
        self.bonds.parted.clear()
        self.places = np.concatenate([self.places, np.array(added, np.int64)])

    @property
    def possible(self):
        """The pairs that may be in contact, in the order of `places`."""
        return [self.held[where] for where in self.places.tolist()]

    @property
    def contacts(self):
        """Those of the pairs that `find_contacts` found that are in contact now."""
        return [i for i in self.possible if i.isReal]

    def touching_pairs(self):
        """(k, 2) bodies of the pairs that `find_contacts` found that are in contact now."""
        return compiled.touching(WORDS, self.layout, self.body_list, self.places)

    def elastic_energy(self):
        """Strain energy (J) of the contacts between rock particles that are no bonds."""
        self.find_contacts()
        return contact_energy(self.contacts)


class RockFriction(RockContacts):
    """Friction work between rock particles, by particle, sampled at each visit.

    A contact that slides dissipates |Ft| times the irreversible slip (kernels.compiled.friction_work), over the mean of
    the velocities before and after the integrator, whose change `motion` predicts. (YADE's sum of plastic dissipation
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
        broken = [place(contact) for contact, phys in self.bonds.broken.values() if phys.crackJointAperture == 0.0]
        contacts = np.concatenate([broken, self.places]).astype(np.int64) if broken else self.places
        friction = np.full(len(contacts), np.nan)
        friction[:len(broken)] = self.bonds.law.mu
        if len(contacts):
            motion = self.motion
            self.total += compiled.rub(
                MEMORY, WORDS, self.layout, self.body_list, *motion.lists, contacts, friction, motion.per_mass,
                motion.per_inertia, motion.radii, elapsed, O.dt, self.work)

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

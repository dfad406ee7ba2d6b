"""Friction between rock particles."""
import numpy as np

from yade import InsertionSortCollider, JCFpmPhys, O

from rockwear.engines.access import SLIDING, contact_energy, yade_engine, yade_friction_law
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.softening import _lost


class RockFriction(Engine):
    """Friction work between rock particles, and where it went.

    Contacts that slide are sampled at each visit: |Ft| times the irreversible slip (P 36), which is the slip less what
    a rising limit mu |Fn| lets the spring take up. A force of one step works over the mean of the velocities before and
    after it; to be visited before the integrator, which is foreseen. (YADE's own account of Coulomb contacts,
    plasticDissipation, is not used: it takes the force after the slip for the mean, and forgets the shear spring of a
    contact that parts. Where particles collide, each time for a few steps, a fifth of the work is missing there.)
    """

    name = "rock_friction"
    phase = FORCES

    def __init__(self, *, bonds, motion, period=1):
        super().__init__(period=period)
        self.bonds, self.motion = bonds, motion
        self.particles = len(motion.per_mass)
        self.work = np.zeros(self.particles)
        self.total = 0.0

    def connect(self):
        self.find_contacts()

    def find_contacts(self):
        """Look for the contacts between rock particles that are no bonds, and for pairs that may come to touch before
        the collider runs again or a bond is let go."""
        self.collider = yade_engine(InsertionSortCollider)
        self.seen = self.collider.numAction, self.bonds.gone
        found = [i for i in O.interactions.all() if max(i.id1, i.id2) < self.particles
                 and not isinstance(i.phys, JCFpmPhys)]
        # A loaded scene has them in another order.
        self.possible = sorted(found, key=lambda i: (i.id1, i.id2))

    @property
    def contacts(self):
        """The contacts that `find_contacts` found or has foreseen, as far as they are real now."""
        return [i for i in self.possible if i.isReal]

    def act(self):
        elapsed = self.elapsed()
        if (self.collider.numAction, self.bonds.gone) != self.seen:
            self.find_contacts()
        mu = self.bonds.law.mu
        for interaction, phys in self.bonds.broken.values():
            if phys.crackJointAperture == 0.0:
                self._sample(interaction, phys, mu, elapsed)
        for interaction in self.possible:
            if interaction.isReal:
                phys = interaction.phys
                self._sample(interaction, phys, phys.tangensOfFrictionAngle, elapsed)

    def _sample(self, interaction, phys, mu, elapsed):
        limit, tangential = mu * phys.normalForce.norm(), phys.shearForce.norm()
        if not tangential > SLIDING * limit > 0.0 or _lost(interaction):
            return
        normal = interaction.geom.normal
        velocity = interaction.geom.incidentVel(interaction, False) + 0.5 * self.motion.gain(interaction, normal)
        slip = -phys.shearForce.dot(velocity) / tangential
        taken_up = -mu * phys.kn / phys.ks * normal.dot(velocity)
        work = tangential * max(slip - taken_up, 0.0) * elapsed
        self.total += work
        self.work[interaction.id1] += 0.5 * work
        self.work[interaction.id2] += 0.5 * work

    def take_work(self):
        """(n,) friction work (J) of each particle since the last call."""
        taken, self.work = self.work, np.zeros(self.particles)
        return taken

    def elastic_energy(self):
        """Strain energy (J) of the new contacts between rock particles."""
        self.find_contacts()
        return contact_energy(self.contacts)

    def state(self):
        return {"work": self.work.copy(), "total": self.total}

    def restore(self, state):
        self.work, self.total = state["work"].copy(), float(state["total"])


class YadeFriction(RockFriction):
    """RockFriction that nobody visits: YADE's account, less the tool's part of it.

    That is enough where contacts last long against a step, and nobody asks which particles their friction went to.
    contact: the FacetContact, restored before.
    """

    def __init__(self, *, contact, **common):
        self.contact = contact
        super().__init__(**common)

    @property
    def total(self):
        """J so far."""
        return yade_friction_law().plasticDissipation() - self.contact.in_yade_balance

    @total.setter
    def total(self, value):
        yade_friction_law().initPlasticDissipation(value + self.contact.in_yade_balance)

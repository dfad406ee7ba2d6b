"""Bonds of the rock: YADE's C++ brittle law carries them, this side notices what breaks and keeps the books."""
import math
from collections import namedtuple

import numpy as np
from yade import (FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack,
                  Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM, O)

from . import SLIDING, Engine, contact_energy, law_functor

INTACT, BROKEN, GONE = 0, 1, 2
"""Status of a bond: GONE is broken, long apart and let go; a later meeting is a new contact."""

Crack = namedtuple("Crack", "time x y z normal_x normal_y normal_z mode energy body_1 body_2")
"""One broken bond: s, m, unit normal, 1 tension or 2 shear, J set free, ids of the particles."""


class Bonds(Engine):
    """The elastic perfectly brittle law (M 4.1; P 23-27) of all bonds, with a crack log.

    pairs: (m, 2) body ids; kn, kt: N/m; normal_strength, shear_strength: (m,) N; mu: friction after breakage;
    clock: a function giving the time (s) for the crack log.

    YADE's JCFpm law gives Fn = kn un, Ft = kt ut until Fn > Rn or |Ft| > Rt. Its friction angle is zero, so that the
    shear strength does not grow with compression; at breakage mu is handed over and the contact keeps its reference
    length, so that overlaps of the packing never turn into forces. Two counters of the law are the tripwire: only
    when one moves are the bonds looked at.
    """

    name = "bonds"

    def __init__(self, *, pairs, kn, kt, normal_strength, shear_strength, mu, clock):
        super().__init__()
        self.pairs = np.asarray(pairs)
        self.kn, self.kt, self.mu = kn, kt, mu
        self.normal_strength, self.shear_strength = normal_strength, shear_strength
        self.status = np.full(len(self.pairs), INTACT, np.int8)
        self.cracks = []
        self.energy_released = 0.0
        self.clock = clock

    def bond(self):
        """Give every fresh JCFpm interaction its stiffness and strength (once, after the bonding step)."""
        for (i, j), normal, shear in zip(self.pairs.tolist(), self.normal_strength, self.shear_strength):
            phys = O.interactions[i, j].phys
            phys.kn, phys.ks, phys.FnMax, phys.FsMax = self.kn, self.kt, float(normal), float(shear)
            phys.isCohesive, phys.tanFrictionAngle = True, 0.0

    def connect(self):
        """Find the interactions of the scene that is in O now."""
        self.law = law_functor(Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM)
        self.intact, self.broken = {}, {}
        for n, (i, j) in enumerate(self.pairs.tolist()):
            if self.status[n] != GONE:
                interaction = O.interactions[i, j]
                (self.intact if self.status[n] == INTACT else self.broken)[n] = (interaction, interaction.phys)
        self._read_counters()

    def _read_counters(self):
        self.counts = (self.law.nbTensCracks, self.law.nbShearCracks)
        self.tension_energy = self.law.totalTensCracksE

    def act(self):
        """Look at two counters; where one has moved, find and book the bonds that broke in this step."""
        if (self.law.nbTensCracks, self.law.nbShearCracks) == self.counts:
            return
        tension_energy = self.law.totalTensCracksE - self.tension_energy
        self._read_counters()
        broken = [n for n, (_, phys) in self.intact.items() if not phys.isCohesive]
        openings = [self._opening(n) for n in broken]
        in_tension = [un > self.normal_strength[n] / self.kn for n, un in zip(broken, openings)]
        strain_energy = sum(un * un for un, tension in zip(openings, in_tension) if tension)
        for n, un, tension in zip(broken, openings, in_tension):
            interaction, phys = self.broken[n] = self.intact.pop(n)
            self.status[n] = BROKEN
            phys.tanFrictionAngle = self.mu
            energy = tension_energy * un * un / strain_energy if tension else self._shear_energy(n, un)
            self.energy_released += energy
            geom = interaction.geom
            self.cracks.append(Crack(self.clock(), *geom.contactPoint, *geom.normal,
                                     1 if tension else 2, energy, *self.pairs[n].tolist()))

    def _opening(self, n):
        interaction, phys = self.intact[n]
        return phys.initD - interaction.geom.penetrationDepth

    def _shear_energy(self, n, un):
        """Strain energy (J) that a bond sheared off at Rt sets free: all of it if open, else down to Coulomb's force."""
        strength = self.shear_strength[n]
        if un > 0:
            return 0.5 * self.kn * un * un + 0.5 * strength**2 / self.kt
        return 0.5 * max(strength**2 - (self.mu * self.kn * un)**2, 0.0) / self.kt

    def let_go(self):
        """Erase broken contacts whose particles are apart, both by radii and by the bond's own length."""
        for n, (interaction, phys) in list(self.broken.items()):
            if interaction.geom.penetrationDepth < min(0.0, phys.initD):
                O.interactions.erase(interaction.id1, interaction.id2)
                self.status[n] = GONE
                del self.broken[n]
        # The order in which a loaded scene would find them: sums come out equal to the last digit.
        self.broken = dict(sorted(self.broken.items()))

    def in_contact(self):
        """(m,) bool: bonds that are intact, or broken and pressed together; what heat may pass through."""
        touching = self.status == INTACT
        for n, (_, phys) in self.broken.items():
            touching[n] = phys.normalForce.squaredNorm() > 0
        return touching

    def elastic_energy(self):
        """Strain energy (J) of all bonds and of broken bonds in contact, sum of Fn^2/2kn + Ft^2/2kt."""
        energy = 0.0
        for group in (self.intact, self.broken):
            for _, phys in group.values():
                energy += 0.5 * (phys.normalForce.squaredNorm() / self.kn + phys.shearForce.squaredNorm() / self.kt)
        return energy

    def state(self):
        return {"status": self.status.copy(), "cracks": np.array(self.cracks, float).reshape(-1, len(Crack._fields)),
                "energy_released": self.energy_released}

    def restore(self, state):
        self.status = state["status"].copy()
        self.cracks = [Crack(*row[:7], int(row[7]), row[8], int(row[9]), int(row[10])) for row in state["cracks"].tolist()]
        self.energy_released = float(state["energy_released"])

    def log(self):
        modes = [crack.mode for crack in self.cracks]
        return {"tensile_cracks": (modes.count(1), "-"), "shear_cracks": (modes.count(2), "-")}


class RockFriction(Engine):
    """Friction work between rock particles, and where it went.

    Broken bonds that slide, sampled at each visit (YADE's law keeps no account of them): |Ft| times the irreversible
    slip (P 36), which is the slip less what a rising limit mu |Fn| lets the spring take up. A force of one step works
    over the mean of the velocities before and after it; to be visited before the integrator, which is foreseen.
    New contacts: exactly what YADE's Coulomb law dissipated since the last visit, shared out by |Ft| times slip.
    """

    name = "rock_friction"
    refresh = 100
    """Visits between two searches for new contacts."""

    def __init__(self, *, bonds, motion):
        super().__init__()
        self.bonds, self.motion = bonds, motion
        self.particles = len(motion.per_mass)
        self.work = np.zeros(self.particles)
        self.sampled = 0.0
        self.booked = 0.0

    def connect(self):
        self.law = law_functor(Law2_ScGeom_FrictPhys_CundallStrack)
        self.find_contacts()

    def find_contacts(self):
        """Look for the contacts between rock particles that are no bonds and never were."""
        self.contacts = [i for i in O.interactions
                         if max(i.id1, i.id2) < self.particles and isinstance(i.phys, FrictPhys)]
        self.until_search = self.refresh

    def act(self):
        elapsed = self.elapsed()
        self.until_search -= 1
        if not self.until_search:
            self.find_contacts()
        for interaction, phys in self.bonds.broken.values():
            normal = phys.normalForce.norm()
            if normal > 0:
                force = phys.shearForce
                tangential = force.norm()
                if tangential > SLIDING * self.bonds.mu * normal:
                    self._book(interaction, self._slip_power(interaction, force, tangential) * elapsed)
        self._share_exact_work()

    def _slip_power(self, interaction, force, tangential):
        normal = interaction.geom.normal
        velocity = interaction.geom.incidentVel(interaction, True) + 0.5 * self.motion.gain(interaction, normal)
        slip = -force.dot(velocity) / tangential
        taken_up = -self.bonds.mu * self.bonds.kn / self.bonds.kt * normal.dot(velocity)
        return tangential * max(slip - taken_up, 0.0)

    def _share_exact_work(self):
        total = self.law.plasticDissipation() - self.booked
        if total <= 0:
            return
        sliding = [(i, i.phys.shearForce.norm() * i.geom.shearInc.norm()) for i in self.contacts
                   if i.isReal and i.phys.shearForce.norm() > SLIDING * i.phys.tangensOfFrictionAngle * i.phys.normalForce.norm()]
        weight = math.fsum(w for _, w in sliding)
        if weight > 0:
            for interaction, w in sliding:
                self._share(interaction, total * w / weight)
            self.booked += total

    def _book(self, interaction, work):
        self.sampled += work
        self._share(interaction, work)

    def _share(self, interaction, work):
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

    @property
    def total(self):
        """All friction work between rock particles so far, J."""
        return self.sampled + self.law.plasticDissipation()

    @property
    def shared(self):
        """Friction work that has been given to particles so far, J."""
        return self.sampled + self.booked

    def state(self):
        return {"work": self.work.copy(), "sampled": self.sampled, "booked": self.booked,
                "dissipation": self.law.plasticDissipation()}

    def restore(self, state):
        self.work = state["work"].copy()
        self.sampled, self.booked = float(state["sampled"]), float(state["booked"])
        law_functor(Law2_ScGeom_FrictPhys_CundallStrack).initPlasticDissipation(float(state["dissipation"]))

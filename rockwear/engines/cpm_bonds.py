"""Bonds carried by YADE's concrete model: softening in C++, looked at from Python now and then.

C++ erases a bond that has opened to its end; if its particles meet again, that is a plain contact, by their radii
(which must not overlap when they are bonded). YADE turns the total shear strain of a bond with the contact, but not its
plastic part. And of what a bond slips in a step YADE takes only the part that its limit is of the trial force: a bond
whose limit is low beside what a step adds keeps the rest as a strain, and pushes with it when it closes and its limit
rises, with energy out of nothing. So slip is taken out of both strains: of bonds that move in every step, else by
looks. Neither damage nor strains are in YADE's saved scenes: `state` holds them, and `erase_separated`, at every
canonical point, sets the damage from omega, which is all that a restart knows.
"""
import math
from collections import namedtuple
from functools import cache

import numpy as np
from yade import CpmPhys, Ig2_Sphere_Sphere_ScGeom, O, ScGeom

from rockwear.engines.access import contact_of, geometry_functor
from rockwear.engines.bond_log import BROKEN, INTACT, SEPARATED, BondLog, Crack
from rockwear.engines.crushing import let_crush, reference_length
from rockwear.engines.memory import (
    MARKS, MEMORY, TRIED, WORDS, Places, check, kernel_layout, list_of_bodies, offset, place, require_memory)
from rockwear.kernels import compiled
from rockwear.kernels.bond_laws.cohesive import UNBREAKABLE

LOOK_PERIOD = 10
"""Steps between looks at all bonds."""
WEAK = 0.5
"""Part of the shear strength below which a bond is in view though it has not slipped."""


_Contact = namedtuple("_Contact", "interaction geom phys")
"""A bond in YADE. As long as these are kept, its vectors lie where they do."""

_VECTORS = {"normal": lambda contact: contact.geom.normal, "increment": lambda contact: contact.geom.shearInc,
            "normal_force": lambda contact: contact.phys.normalForce,
            "shear_force": lambda contact: contact.phys.shearForce,
            "strain": lambda contact: contact.phys.epsT, "slipped": lambda contact: contact.phys.epsTPl}
"""Vectors of a bond that looks read, and partly write, for many bonds at once: looks at single ones cost a third of
YADE's own time."""
_BEHIND_SLIP = {"omega": "omega", "cohesion": "undamagedCohesion", "length": "refLength", "E": "E", "G": "G",
                "onset": "epsCrackOnset", "fracture": "epsFracture", "kappa": "kappaD"}
"""Numbers of a bond: their names in YADE."""
_GROUPS = {"bond": compiled.BOND, "forces": ("normal", "normal_force", "shear_force")}
"""What is read together."""
_STATE = "dissipated", "by_slip", "slip_taken", "omega", "active", "in_view", "seen", "slid"
"""What a checkpoint holds as it is."""


@cache
def _behind_slip():
    """{name: how far} behind epsTPl YADE keeps numbers that it does not give by reference. Raises ParameterError where
    memory is not what Python shows."""
    tried = [CpmPhys(isCohesive=True, epsCrackOnset=1e-4 + 1e-6 * k, epsFracture=1e-2 + 1e-4 * k, refLength=2.1 + k,
                     E=1e3 + k, G=2e3 + k, undamagedCohesion=0.1 + k) for k in range(TRIED)]
    check(_Contact(None, ScGeom(), tried[0]), _VECTORS)
    for k, phys in enumerate(tried):
        phys.setDamage(0.123 + 0.1 * k)
    slipped = [phys.epsTPl for phys in tried]
    found = {name: offset(name, slipped, [getattr(phys, of) for phys in tried]) for name, of in _BEHIND_SLIP.items()}
    # Nothing but memory sets epsNPl, which lies behind kappaD.
    MEMORY[place(slipped[0]) + found["kappa"] + 1] = MARKS[0]
    require_memory(tried[0].epsNPl == MARKS[0], "epsNPl")
    return {**found, "crushed": found["kappa"] + 1}


@cache
def _behind_normal():
    """{name: how far} behind the normal YADE keeps the radii and the overlap (m) of a contact. Raises
    ParameterError."""
    tried = [ScGeom(refR1=1.1 + k, refR2=2.3 + k, penetrationDepth=0.123 + k) for k in range(TRIED)]
    normals = [geom.normal for geom in tried]
    return {name: offset(name, normals, [getattr(geom, of) for geom in tried])
            for name, of in {"radius1": "refR1", "radius2": "refR2", "overlap": "penetrationDepth"}.items()}


def _numbers():
    """{name: (vector, how far behind it)} of a bond, for engines.memory.Places."""
    return {**{name: ("slipped", behind) for name, behind in _behind_slip().items()},
            **{name: ("normal", behind) for name, behind in _behind_normal().items()}}


def _dot(a, b):
    return np.einsum("ij,ij->j", a, b)


class CpmBonds(BondLog):
    """All bonds of the rock under a law that YADE's concrete model (Law2_ScGeom_CpmPhys_Cpm) is.

    The C++ law gives every force. A look reads the damage omega and the slip of all bonds, for the crack log and for
    the energy. What tension dissipates follows from omega alone. Slip and its work, the force of the two ends of a step
    times what a bond slipped, are added up in every step, but only of bonds that are weak, or had slipped or softened
    by one of the last looks: few do at a time, and for long. In a cut 93 % of the work was theirs. That of the others
    is what they slipped when a look finds it, times the shear force that they bear then; of those that broke meanwhile
    it is lost. What a bond slipped before it is found for the first time, the law tells from a straight path to where
    it is found.

    C++ knows no damage by slip: a look counts what the bond slipped since the last one and raises the damage by it. A
    bond that slip has broken stays a contact in YADE until it opens; what it slips until then counts here too. And
    C++ takes the part of the cohesion that is left to be that of the stiffness: every step sets the cohesion so that
    what is left is what the law says.

    C++ crushes a bond in compression; the work follows from what it is shorter, epsNPl. A look hardens it. A crushed
    bond that opens to its end stays a contact, without cohesion, as long as its particles are nearer than when it was
    made, and its slip counts as that of one that slip has broken.

    period: steps between two looks; the engine itself is visited in every step. With 1, or where `every_bond` is set,
    every bond is sampled that has ever slipped or softened.
    """

    def __init__(self, *, period=LOOK_PERIOD, **common):
        super().__init__(period=1, **common)
        count = len(self.pairs)
        self.between_looks, self.every_bond = period, period == 1
        self.dissipated, self.by_slip, self.slip_taken = np.zeros(count), np.zeros(count), np.zeros(count)
        self.omega, self.active = np.zeros(count), np.zeros(count, bool)
        """Damage at the last look; whether the bond had slipped or softened by then."""
        self.in_view, self.seen = np.zeros(count, bool), np.zeros(count, bool)
        """Whether its slip is added up: it slipped or softened before the last look in its turn, or since it by another
        look, or is weak. Whether it did since the last look in its turn."""
        self.slid = np.zeros(count)
        """m that the bonds in view slipped since the last look."""
        self.moving, self.before = np.zeros(0, int), np.zeros((0, 3))
        self.table = np.array([[getattr(law, name) for law in self.laws] for name in compiled.LAW], float)
        self.crushes = bool((self.table[compiled.RC] < math.inf).any())
        self.crushed = np.zeros(count)
        """YADE's plastic strain epsNPl of the bonds at the last look, <= 0."""
        self.contacts, self.lengths, self.strains = {}, np.zeros(count), None  # lengths: m, of the bonds that are there
        self.places = Places(count, vectors=_VECTORS, groups=_GROUPS, numbers=_numbers())
        self.where = self.places.of("bond")
        self.rising = np.zeros(0, int)
        """Bonds whose damage rose between the last two looks, by opening: every step sets their cohesion."""
        self.pulled_apart = None
        """Bonds that YADE has pulled apart and that touch on, because they are crushed; None where it is not known."""

    @staticmethod
    def reference_overlap(phys):
        """penetrationDepth (m) at which the bond was made."""
        return phys.refPD

    def bond(self, numbers):
        if self.crushes:
            let_crush()
        for n in numbers.tolist():
            phys, law = contact_of(*self.pairs[n].tolist()).phys, self.laws[n]
            length = phys.refLength = reference_length(law, phys.refLength)
            phys.kn, phys.ks, phys.crossSection = law.kn, law.kt, 1.0
            phys.E, phys.G, phys.tanFrictionAngle = law.kn * length, law.kt * length, law.mu
            phys.undamagedCohesion, phys.isCohesive, phys.damLaw = law.Rt, True, 0
            if law.Rn < UNBREAKABLE:
                phys.epsCrackOnset, phys.epsFracture = law.onset / length, law.gone / length
            else:
                phys.neverDamage = True

    def connect(self):
        """Find the interactions of the scene that is in O now, and give them the strains of a restart."""
        self.layout, self.body_list = kernel_layout(), list_of_bodies()
        self.contacts = {}
        self.shear_by_radii = geometry_functor(Ig2_Sphere_Sphere_ScGeom).avoidGranularRatcheting
        self._follow(np.flatnonzero(self.status != SEPARATED))
        if self.strains is not None:
            numbers, omegas, strains, slipped, crushed = self.strains
            damaged = omegas > 0.0
            compiled.set_damages(MEMORY, self.where, numbers[damaged], omegas[damaged])
            self.places.write("strain", numbers, strains)
            self.places.write("slipped", numbers, slipped)
            self.places.write("crushed", numbers, crushed)
            self.strains = None
        self._prepare()

    def _take_up(self, numbers):
        for array in (*(getattr(self, name) for name in _STATE), self.crushed):
            array[numbers] = 0
        self._follow(numbers)
        # Not of bonds that have left: their memory is no longer theirs.
        self.rising = np.zeros(0, int)
        self._prepare()

    def _follow(self, numbers):
        self.pulled_apart = None
        found = []
        for n in numbers.tolist():
            interaction = contact_of(*self.pairs[n].tolist())
            found.append(_Contact(interaction, interaction.geom, interaction.phys))
            self.ends[n] = interaction.id1, interaction.id2
            self.lengths[n] = found[-1].phys.refLength
        self.contacts.update(zip(numbers.tolist(), found))
        self.places.find(numbers, found)

    def act(self):
        """Sample the work of slip, and look at the bonds in their turn."""
        if len(self.moving):
            self.energy_released += compiled.sample_slip(
                MEMORY, self.where, self.moving, self.before, self.status, SEPARATED, self.shear_by_radii, self.table,
                self.lengths, self.slid, self.dissipated, self.by_slip)
        if O.iter % self.between_looks == 0:
            self._look()
            self.in_view, self.seen = self.seen, np.zeros(len(self.seen), bool)
            self._prepare()
        if len(self.rising):
            compiled.weaken(MEMORY, self.where, self.rising, self.table)

    def _prepare(self):
        """Keep the forces before a step of the bonds whose slip is added up."""
        self.in_view |= compiled.weak(self.table, self.omega, self.status, SEPARATED, WEAK)
        self.moving, self.before = compiled.shear_forces(
            MEMORY, self.where, self.status, SEPARATED, self.active if self.every_bond else self.in_view)

    def look_at_all(self):
        """Bring damage and status of all bonds up to date."""
        self._look()
        self._prepare()

    def _look(self):
        if self.pulled_apart is None:
            self.pulled_apart = (
                np.flatnonzero((self.status == BROKEN) & (self.omega >= 1.0)).tolist() if self.crushes else [])
        for n in self.pulled_apart:
            # Those without cohesion YADE may have erased meanwhile.
            if not self.contacts[n].interaction.isReal:
                self._separate(n)
        sums = self.dissipated, self.by_slip
        numbers, self.rising, gone, crushing, softening = compiled.look(
            MEMORY, self.where, self.status, SEPARATED, self.table, float(self.law.hardening), self.crushes,
            self.omega, self.active, self.slid, self.crushed, self.lengths, *sums)
        self.energy_crushed += crushing
        self.energy_released += crushing + softening
        if not len(numbers):
            return
        known = self.active[numbers]
        found, late = numbers[~known], known & ~self.in_view[numbers] & (not self.every_bond)
        self.active[found] = self.in_view[numbers] = self.seen[numbers] = True
        self.energy_released += compiled.begin(MEMORY, self.where, found, self.table, float(self.law.hardening), *sums)
        if len(gone):
            self._part(gone)
            left = self.status[numbers] != SEPARATED
            numbers, late = numbers[left], late[left]
        spent, work = compiled.relieve(
            MEMORY, self.where, numbers, late, self.table, self.omega, self.slid, self.lengths, *sums)
        self.energy_released += work
        self._log(spent)
        self.status[spent] = BROKEN

    def _part(self, gone):
        """YADE has broken these bonds."""
        self.pulled_apart = None
        apart = [n for n in gone.tolist() if not self.contacts[n].interaction.isReal]
        for n in apart:
            # Its last shear force went with it: YADE leaves that of the step before.
            self._dissipate(n, 0.5 * self.contacts[n].phys.shearForce.squaredNorm() / self.laws[n].kt)
        self._log(gone)
        self.status[gone] = BROKEN
        for n in gone.tolist():
            # Beyond omega = 1 a cohesive bond would push where it should pull.
            self.contacts[n].phys.isCohesive = False
        for n in apart:
            self._separate(n)

    def _dissipate(self, n, work):
        """Add work (J) of slip of a bond."""
        self.dissipated[n] += work
        self.by_slip[n] += work
        self.energy_released += work

    def _log(self, numbers):
        """Add bonds that break now to the cracks."""
        rows = compiled.between_ends(MEMORY, WORDS, self.layout, self.body_list, self.ends[numbers])
        for n, row in zip(numbers.tolist(), rows.tolist()):
            if self.status[n] == INTACT and not math.isnan(row[0]):
                mode = 1 if self.by_slip[n] <= 0.5 * self.dissipated[n] else 2
                self.cracks.append(Crack(self.clock(), *row, mode, float(self.dissipated[n]), *self.pairs[n].tolist()))

    def _separate(self, n):
        if self.status[n] != SEPARATED:
            self.parted.append(n)
        self.status[n] = SEPARATED
        self.pulled_apart = None
        self.contacts.pop(n, None)
        self.lengths[n] = 0.0

    def erase_separated(self):
        """At a canonical point: all bonds up to date, those of erased bodies separated, damage as a restart sets it."""
        self.look_at_all()
        kept = np.array([body is not None for body in map(O.bodies.__getitem__, range(int(self.pairs.max()) + 1))])
        for n in np.flatnonzero(~kept[self.pairs].all(axis=1)).tolist():
            self._separate(n)
        damaged = np.flatnonzero(self.omega * (self.status != SEPARATED))
        compiled.set_damages(MEMORY, self.where, damaged, self.places.read("omega", damaged)[0])
        # A restart does not know them, and until the next look some of them may leave.
        self.rising = np.zeros(0, int)
        self._prepare()

    def _shift(self, n, shift):
        contact = self.contacts[n]
        contact.phys.refPD += shift
        return contact.geom, contact.phys

    def shear(self, numbers):
        """What YADE turns with bonds and adds slip to, strains (k, 3), how much of it a metre of slip takes, (k,) 1/m,
        and a function that sets it."""
        return (self.places.read("strain", numbers).T, -1.0 / self.lengths[numbers],
                lambda shear: self.places.write("strain", numbers, shear.T))

    def softening(self):
        """(m,) from 0, a bond in its initial state, to 1, a broken one."""
        return np.where(self.status == INTACT, np.minimum(self.omega, 1.0), 1.0)

    def in_contact(self):
        touching, broken = self.status == INTACT, np.flatnonzero(self.status == BROKEN)
        normal, force, _ = np.split(self.places.read("forces", broken), 3)
        touching[broken] = _dot(force, normal) > 0.0
        return touching

    def elastic_energy(self):
        """Strain energy (J) of all bonds, sum of Fn^2/2kn + Ft^2/2kt with the secant kn of softened ones."""
        self.look_at_all()
        n = np.flatnonzero(self.status != SEPARATED)
        normal, force, shear = np.split(self.places.read("forces", n), 3)
        kn, kt = self.table[[compiled.KN, compiled.KT]][:, n]
        kept = np.where(_dot(force, normal) < 0.0, 1.0 - self.omega[n], 1.0)
        return math.fsum(0.5 * (_dot(force, force) / (kn * kept) + _dot(shear, shear) / kt))

    def take_slip_work(self, particles):
        work, self.slip_taken = 0.5 * (self.by_slip - self.slip_taken), self.by_slip.copy()
        return np.bincount(self.pairs.ravel(), np.repeat(work, 2), particles)

    def state(self):
        there = np.flatnonzero(self.status != SEPARATED)
        return {**super().state(), **{name: getattr(self, name).copy() for name in _STATE},
                "crushed": self.crushed.copy(),
                "strain": self.places.read("strain", there).T, "plastic_strain": self.places.read("slipped", there).T}

    def restore(self, state):
        super().restore(state)
        for name in _STATE:
            setattr(self, name, state[name].copy())
        self.crushed = state["crushed"].copy()
        there = np.flatnonzero(self.status != SEPARATED)
        self.strains = there, self.omega[there], state["strain"].T, state["plastic_strain"].T, state["crushed"][there]

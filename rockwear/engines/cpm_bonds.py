"""Bonds carried by YADE's concrete model: softening in C++, looked at from Python now and then.

C++ erases a bond that has opened to its end; if its particles meet again, that is a plain contact, by their radii
(which must not overlap when they are bonded). YADE turns the total shear strain of a bond with the contact, but not its
plastic part: a look takes the slip so far out of both. Of a bond with little or no shear strength left YADE takes too
little slip, and pushes with the rest when it closes: that of loose bonds is taken out in every step. Neither damage nor
strains are in YADE's saved scenes: `state` holds them, and `erase_separated`, at every canonical point, sets the damage
from omega, which is all that a restart knows.
"""
import math
from collections import namedtuple
from functools import cache

import numpy as np
from yade import CpmPhys, Ig2_Sphere_Sphere_ScGeom, O, ScGeom

from rockwear.engines import crushing
from rockwear.engines.access import contact_of, geometry_functor
from rockwear.engines.bond_log import BROKEN, INTACT, SEPARATED, BondLog, Crack
from rockwear.engines.memory import MARKS, MEMORY, TRIED, Places, check, offset, place, require_memory
from rockwear.kernels.bond_laws.cohesive import UNBREAKABLE, softening_energy

LOOK_PERIOD = 10
"""Steps between looks at all bonds."""
STRAIGHT = 10
"""Points on the path that a bond is taken to have come before the first look that finds it softened or slipped."""
LOOSE = 0.5
"""Damage from which on the slip of a bond that slip does not damage is taken out of its strains in every step."""
SPENT = 1.0 - 1e-6
"""Damage of a bond that slip has broken: YADE keeps it, as a contact with friction, until it opens."""


def _slip_before(law, contact):
    """Work (J) of slip of a bond as if it had come to its displacements on a straight path."""
    phys, bond, work, before = contact.phys, law.initial_state(), 0.0, 0.0
    un = law.opening(min(phys.omega, 1.0)) if phys.omega else -phys.normalForce.dot(contact.geom.normal) / law.kn
    ut = phys.epsT.norm() * phys.refLength
    for k in range(1, STRAIGHT + 1):
        _, (Ft,) = law.respond(bond, un * k / STRAIGHT, (ut * k / STRAIGHT,))
        work, before = work + 0.5 * (Ft + before) * ut / STRAIGHT, Ft
    # What the present force stores is not spent; where it is above the law's, `_damage` tells what the fall gives.
    return work - 0.5 * phys.shearForce.squaredNorm() / law.kt


_Contact = namedtuple("_Contact", "interaction geom phys")
"""A bond in YADE. As long as these are kept, its vectors lie where they do."""

_VECTORS = {"normal": lambda contact: contact.geom.normal, "increment": lambda contact: contact.geom.shearInc,
            "normal_force": lambda contact: contact.phys.normalForce,
            "shear_force": lambda contact: contact.phys.shearForce,
            "strain": lambda contact: contact.phys.epsT, "slipped": lambda contact: contact.phys.epsTPl}
"""Vectors of a bond that looks read, and partly write, for many bonds at once: looks at single ones cost a third of
YADE's own time."""
_GROUPS = {"slip": ("slipped", "shear_force"), "looked_at": ("slipped", "omega", "crushed"),
           "loose": ("strain", "slipped", "shear_force"), "strain": ("strain",), "limits": ("onset", "fracture"),
           "damage": ("omega", "kappa"),
           "forces": ("normal", "normal_force", "shear_force"), "moved": ("increment", "radius1", "radius2", "overlap"),
           **crushing.GROUPS}
"""What is read together."""
SLIPPED, SHEAR, OMEGA, CRUSHED = slice(0, 3), slice(3, 6), 3, 4
"""Rows of the groups "slip" and "looked_at"."""
_STATE = "dissipated", "by_slip", "slip_taken", "omega", "active"
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
    names = {"omega": "omega", "cohesion": "undamagedCohesion", **crushing.LONGER, **crushing.SHORTER}
    found = {name: offset(name, slipped, [getattr(phys, of) for phys in tried]) for name, of in names.items()}
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


def _differ(a, b):
    """(k,) bool: whether vectors (3, k) differ."""
    return (a[0] != b[0]) | (a[1] != b[1]) | (a[2] != b[2])


def _vanish(a):
    """(k,) bool: whether vectors (3, k) are 0."""
    return (a[0] == 0.0) & (a[1] == 0.0) & (a[2] == 0.0)


def _moved(places, numbers, by_radii):
    """(3, k) m, how far the shear forces of bonds moved in the last step: YADE's increment, where it is `by_radii`
    without the factor, radii over distance, of translations (kernels.stability). Fine bonds open by their radii."""
    increment, (first, second, overlap) = np.split(places.read("moved", numbers), 2)
    return increment * (1.0 - overlap / (first + second)) if by_radii else increment


def _take_slip(places, numbers, normal, force, stiffness):
    """Take the slip out of YADE's shear strains of bonds and leave the elastic part, in the plane of the contact.
    normal, force (N): (3, k), of the contact and the shear force; stiffness: N, force over strain. -> (k,) the slip, a
    strain."""
    elastic = force - normal * _dot(force, normal)
    length = np.sqrt(_dot(elastic, elastic))
    # As long as the force, nearly in the plane of which it lies.
    elastic *= np.sqrt(_dot(force, force)) / np.where(length > 0.0, -length * stiffness, 1.0)
    slip = places.read("strain", numbers) - elastic
    places.write("strain", numbers, elastic)
    places.write("slipped", numbers, 0.0)
    return np.sqrt(_dot(slip, slip))


def _set_damage(places, numbers, omega):
    """CpmPhys.setDamage of many bonds that can break: their damage (k,), and the strain from which on it rises."""
    onset, fracture = places.read("limits", numbers)
    strain = onset / (1.0 - omega * (1.0 - onset / fracture))
    places.write("damage", numbers, (omega, np.where(omega > 0.0, strain, 0.0)))


def _weaken(omega, cohesion, coupling, Rt):
    """Set the cohesion in YADE, of which it takes the part 1 - omega. (k,) omega, cohesion: their places."""
    if len(omega):
        MEMORY[cohesion] = Rt / (1.0 - coupling * MEMORY.take(omega, mode="wrap"))


def _let_slip(numbers, places, kt, lengths):
    """Leave loose bonds (k,) the elastic part of their shear strains, as `_take_slip` does, but without the turn into
    the plane of the contact: that is for looks, this comes in every step. places: of the group "loose"; kt (N/m),
    lengths (m): of all bonds."""
    if len(numbers):
        MEMORY[places[:3]] = MEMORY.take(places[6:], mode="wrap") / (-kt[numbers] * lengths[numbers])
        MEMORY[places[3:6]] = 0.0


class _Kept:
    """The bonds that a function gives, and where in memory lies what `name` says of them, until `forget`."""

    def __init__(self, places, name, bonds):
        self.places, self.name, self.bonds, self.found = places, name, bonds, None

    def forget(self):
        """Other bonds are there now, or meet the condition."""
        self.found = None

    def now(self):
        """Numbers (k,), places (c, k)."""
        if self.found is None:
            numbers = self.bonds()
            self.found = numbers, self.places.of(self.name, numbers)
        return self.found


def _forget(*kept):
    for one in kept:
        one.forget()


class CpmBonds(BondLog):
    """All bonds of the rock under a law that YADE's concrete model (Law2_ScGeom_CpmPhys_Cpm) is.

    The C++ law gives every force. A look reads the damage omega and the slip of all bonds, for the crack log and for
    the energy. What tension dissipates follows from omega alone. The work of slip is a sample: that of one step, the
    force of its two ends times what the bonds slipped, counts for all steps between two samples. (Forces of looks ten
    steps apart, half a period of a bond, overstate it, because bonds slip while their force is low.) Samples are a step
    further apart than looks: a look weakens bonds, they slip in the steps that follow it, and samples that always came
    at the same step after a look missed 3 to 5 % of the work. What a bond slipped before it is found to have, the law
    tells from a straight path to where it is found.

    C++ knows no damage by slip: a look counts what the bond slipped since the last one and raises the damage by it. A
    bond that slip has broken stays a contact in YADE until it opens; what it slips until then is booked here too. And
    C++ takes the part of the cohesion that is left to be that of the stiffness: every step sets the cohesion so that
    what is left is what the law says.

    C++ crushes a bond in compression; the work follows from what it is shorter, epsNPl. A look hardens it. A crushed
    bond that opens to its end stays a contact, without cohesion, as long as its particles are nearer than when it was
    made, and books its slip as one that slip has broken.

    period: steps between two looks; 1: looks and samples in every step. The engine itself is visited in every step.
    """

    def __init__(self, *, period=LOOK_PERIOD, **common):
        super().__init__(period=1, **common)
        count = len(self.pairs)
        self.between_looks, self.between_samples = period, period + 1 if period > 1 else 1
        self.dissipated, self.by_slip, self.slip_taken = np.zeros(count), np.zeros(count), np.zeros(count)
        self.omega, self.active = np.zeros(count), np.zeros(count, bool)
        """Damage at the last look; whether the bond had slipped or softened by then."""
        self.kn, self.kt, self.Rn, self.Rt, self.mu, self.onset, self.gone, self.slip_end, self.coupling = (
            np.array([getattr(law, name) for law in self.laws])
            for name in ("kn", "kt", "Rn", "Rt", "mu", "onset", "gone", "slip_end", "coupling"))
        self.contacts, self.lengths, self.strains = {}, np.zeros(count), None  # lengths: m, of the bonds that are there
        self.places = Places(count, vectors=_VECTORS, groups=_GROUPS, numbers=_numbers())
        self.there = _Kept(self.places, "looked_at", lambda: np.flatnonzero(self.status != SEPARATED))
        self.slipping = _Kept(self.places, "slip", lambda: np.flatnonzero(self.active & (self.status != SEPARATED)))
        self.loose = _Kept(self.places, "loose", lambda: np.flatnonzero(
            (self.slip_end == math.inf) & (self.omega > LOOSE) & (self.status == INTACT)))
        self.crushing = crushing.Crushing(laws=self.laws, hardening=self.law.hardening, places=self.places)
        self.rising = self._weakened(np.zeros(0, int))
        """Of the bonds whose damage rose between the last two looks, by opening: every step sets their cohesion."""

    @staticmethod
    def reference_overlap(phys):
        """penetrationDepth (m) at which the bond was made."""
        return phys.refPD

    def bond(self, numbers):
        self.crushing.begin()
        for n in numbers.tolist():
            phys, law = contact_of(*self.pairs[n].tolist()).phys, self.laws[n]
            length = phys.refLength = self.crushing.reference_length(n, phys.refLength)
            phys.kn, phys.ks, phys.crossSection = law.kn, law.kt, 1.0
            phys.E, phys.G, phys.tanFrictionAngle = law.kn * length, law.kt * length, law.mu
            phys.undamagedCohesion, phys.isCohesive, phys.damLaw = law.Rt, True, 0
            if law.Rn < UNBREAKABLE:
                phys.epsCrackOnset, phys.epsFracture = law.onset / length, law.gone / length
            else:
                phys.neverDamage = True

    def connect(self):
        """Find the interactions of the scene that is in O now, and give them the strains of a restart."""
        self.contacts = {}
        self.shear_by_radii = geometry_functor(Ig2_Sphere_Sphere_ScGeom).avoidGranularRatcheting
        self._follow(np.flatnonzero(self.status != SEPARATED))
        if self.strains is not None:
            numbers, omegas, strains, slipped, crushed = self.strains
            damaged = omegas > 0.0
            _set_damage(self.places, numbers[damaged], omegas[damaged])
            self.places.write("strain", numbers, strains)
            self.places.write("slipped", numbers, slipped)
            self.places.write("crushed", numbers, crushed)
            self.strains = None
        self._prepare()

    def _take_up(self, numbers):
        for array in (self.dissipated, self.by_slip, self.slip_taken, self.omega, self.active, self.crushing.strains):
            array[numbers] = 0
        self._follow(numbers)
        # Not of bonds that have left: their memory is no longer theirs.
        self.rising = self._weakened(np.zeros(0, int))
        self._prepare()

    def _follow(self, numbers):
        _forget(self.there, self.slipping, self.loose)
        found = []
        for n in numbers.tolist():
            interaction = contact_of(*self.pairs[n].tolist())
            found.append(_Contact(interaction, interaction.geom, interaction.phys))
            self.ends[n] = interaction.id1, interaction.id2
            self.lengths[n] = found[-1].phys.refLength
        self.contacts.update(zip(numbers.tolist(), found))
        self.places.find(numbers, found)

    def act(self):
        """Sample the work of slip and look at the bonds, each in its turn."""
        if O.iter % self.between_samples == 0:
            self._sample()
        if O.iter % self.between_looks == 0:
            self.look_at_all()
        _weaken(*self.rising)
        _let_slip(*self.loose.now(), self.kt, self.lengths)
        if (O.iter + 1) % self.between_samples == 0:
            self._prepare()

    def _weakened(self, numbers):
        """What `_weaken` takes of these bonds (k,)."""
        return (*(self.places.of(name, numbers)[0] for name in ("omega", "cohesion")), self.coupling[numbers],
                self.Rt[numbers])

    def _prepare(self):
        """Keep slip and force (N) of the bonds as they are before a step whose work is sampled."""
        numbers, places = self.slipping.now()
        self.before = numbers, places, MEMORY.take(places, mode="wrap")

    def _sample(self):
        """The work of slip of the last step."""
        numbers, places, before = self.before
        # The memory of bonds that have separated meanwhile is no longer theirs.
        there = self.status[numbers] != SEPARATED
        if not there.all():
            numbers, places, before = numbers[there], places[:, there], before[:, there]
        now = MEMORY.take(places, mode="wrap")
        # YADE leaves the slip of a bond without any shear strength as it is.
        let_go = _vanish(now[SHEAR]) & ~_vanish(before[SHEAR])
        slid = np.flatnonzero(_differ(now[SLIPPED], before[SLIPPED]) | let_go)
        if not len(slid):
            return
        numbers, force, force_before = numbers[slid], now[SHEAR, slid], before[SHEAR, slid]
        work = -_dot(force + force_before, _moved(self.places, numbers, self.shear_by_radii))
        stored = (_dot(force, force) - _dot(force_before, force_before)) / self.kt[numbers]
        self._dissipate(numbers, 0.5 * self.between_samples * (work - stored), True)

    def look_at_all(self):
        """Bring damage and status of all bonds up to date."""
        if self.crushing.possible:
            # Those without cohesion YADE may have erased meanwhile.
            for n in np.flatnonzero((self.status == BROKEN) & (self.omega >= 1.0)).tolist():
                if not self.contacts[n].interaction.isReal:
                    self._separate(n)
        there, places = self.there.now()
        now = MEMORY.take(places, mode="wrap")
        if self.crushing.possible:
            numbers, work = self.crushing.harden(there, now[CRUSHED], self.lengths)
            self.energy_crushed += float(np.sum(work))
            self._dissipate(numbers, work, True)
        omega, changed = now[OMEGA], (now[OMEGA] != self.omega[there]) | ~_vanish(now[SLIPPED])
        active, places = self.slipping.now()
        let_go = active[_vanish(MEMORY.take(places[SHEAR], mode="wrap"))]
        changed[np.searchsorted(there, let_go)] = True
        numbers, omega = there[changed], omega[changed]
        self.rising = self._weakened(numbers[:0])
        if not len(numbers):
            return
        self._begin(numbers[~self.active[numbers]])
        self._soften(numbers, omega)
        numbers = numbers[self.status[numbers] != SEPARATED]
        forces = self.places.read("forces", numbers)
        slip = _take_slip(self.places, numbers, forces[:3], forces[6:],
                          self.kt[numbers] * self.lengths[numbers]) * self.lengths[numbers]
        damaged = (slip > 0.0) & (self.omega[numbers] < SPENT) & (self.slip_end[numbers] < math.inf)
        if damaged.any():
            self._damage(numbers[damaged], slip[damaged], forces[:, damaged])
        _weaken(*self._weakened(numbers[self.coupling[numbers] > 0.0]))

    def _begin(self, numbers):
        """These bonds are found to have slipped or softened."""
        if len(numbers):
            self.active[numbers] = True
            self.slipping.forget()
        for n in numbers.tolist():
            self._dissipate(n, _slip_before(self.laws[n], self.contacts[n]), True)

    def _soften(self, numbers, omega):
        """What YADE has raised the damage of these bonds to."""
        before, self.omega[numbers] = self.omega[numbers], omega
        self.loose.forget()
        rises = omega > before
        rising, gone = numbers[rises], numbers[rises & (omega >= 1.0)]
        of = dict(Rn=self.Rn[rising], onset=self.onset[rising], gone=self.gone[rising])
        spent = softening_energy(np.minimum(omega[rises], 1.0), **of) - softening_energy(before[rises], **of)
        self._dissipate(rising, spent, False)
        self.rising = self._weakened(rising[(omega[rises] < 1.0) & (self.coupling[rising] > 0.0)])
        for n in gone.tolist():
            interaction, _, phys = self.contacts[n]
            if interaction.isReal:
                self._log(n)
                # Beyond omega = 1 a cohesive bond would push where it should pull.
                phys.isCohesive, self.status[n] = False, BROKEN
            else:
                # Its last shear force went with it: YADE leaves that of the step before.
                self._dissipate(n, 0.5 * phys.shearForce.squaredNorm() / self.kt[n], True)
                self._log(n)
                self._separate(n)

    def _damage(self, numbers, slip, forces):
        """Raise the damage of bonds by their slip (m). In the next step their forces fall to what the law then allows;
        what that dissipates is booked now, and the forces, which YADE only gives out, are those of then.
        forces: what _GROUPS says of them."""
        before, coupling = self.omega[numbers], self.coupling[numbers]
        left = np.maximum((1.0 - before) / (1.0 - coupling * before) - slip / self.slip_end[numbers], 0.0)
        omega = np.minimum((1.0 - left) / (1.0 - coupling * left), SPENT)
        normal, shear = forces[3:6], forces[6:]
        Fn, Ft = -_dot(normal, forces[:3]), np.sqrt(_dot(shear, shear))
        kept = np.where(Fn > 0.0, (1.0 - omega) / (1.0 - before), 1.0)
        self._dissipate(numbers, 0.5 * Fn**2 * (1.0 - kept) / (self.kn[numbers] * (1.0 - before)), False)
        self.places.write("normal_force", numbers, normal * kept)
        # Where every step is sampled, the slip of the next one is in its sample.
        if self.between_looks > 1:
            limit = np.maximum(left * self.Rt[numbers] - self.mu[numbers] * kept * Fn, 0.0)
            falls = Ft > limit
            fallen = numbers[falls]
            self._dissipate(fallen, 0.5 * (Ft[falls]**2 - limit[falls]**2) / self.kt[fallen], True)
            self.places.write("shear_force", fallen, shear[:, falls] * (limit[falls] / Ft[falls]))
        self.omega[numbers] = omega
        _set_damage(self.places, numbers, omega)
        for n in numbers[omega == SPENT].tolist():
            self._log(n)
            self.status[n] = BROKEN

    def _dissipate(self, numbers, work, by_slip):
        self.dissipated[numbers] += work
        self.energy_released += float(np.sum(work))
        if by_slip:
            self.by_slip[numbers] += work

    def _log(self, n):
        """Add a bond that breaks now to the cracks."""
        first, second = (O.bodies[end] for end in self.ends[n].tolist())
        if self.status[n] != INTACT or first is None or second is None:
            return
        place, line = 0.5 * (first.state.pos + second.state.pos), second.state.pos - first.state.pos
        mode = 1 if self.by_slip[n] <= 0.5 * self.dissipated[n] else 2
        self.cracks.append(Crack(self.clock(), *place, *line.normalized(), mode, float(self.dissipated[n]),
                                 *self.pairs[n].tolist()))

    def _separate(self, n):
        if self.status[n] != SEPARATED:
            self.parted.append(n)
        self.status[n] = SEPARATED
        _forget(self.there, self.slipping, self.loose)
        self.contacts.pop(n, None)
        self.lengths[n] = 0.0

    def erase_separated(self):
        """At a canonical point: all bonds up to date, those of erased bodies separated, damage as a restart sets it."""
        self.look_at_all()
        kept = np.array([body is not None for body in map(O.bodies.__getitem__, range(int(self.pairs.max()) + 1))])
        for n in np.flatnonzero(~kept[self.pairs].all(axis=1)).tolist():
            self._separate(n)
        damaged = np.flatnonzero(self.omega * (self.status != SEPARATED))
        _set_damage(self.places, damaged, self.places.read("omega", damaged)[0])
        # A restart does not know them, and until the next look some of them may leave.
        self.rising = self._weakened(np.zeros(0, int))
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

    def elastic_energy(self):
        """Strain energy (J) of all bonds, sum of Fn^2/2kn + Ft^2/2kt with the secant kn of softened ones."""
        self.look_at_all()
        n = np.flatnonzero(self.status != SEPARATED)
        normal, force, shear = np.split(self.places.read("forces", n), 3)
        kept = np.where(_dot(force, normal) < 0.0, 1.0 - self.omega[n], 1.0)
        return math.fsum(0.5 * (_dot(force, force) / (self.kn[n] * kept) + _dot(shear, shear) / self.kt[n]))

    def take_slip_work(self, particles):
        work, self.slip_taken = 0.5 * (self.by_slip - self.slip_taken), self.by_slip.copy()
        return np.bincount(self.pairs.ravel(), np.repeat(work, 2), particles)

    def state(self):
        there = np.flatnonzero(self.status != SEPARATED)
        return {**super().state(), **{name: getattr(self, name).copy() for name in _STATE},
                "crushed": self.crushing.strains.copy(),
                "strain": self.places.read("strain", there).T, "plastic_strain": self.places.read("slipped", there).T}

    def restore(self, state):
        super().restore(state)
        for name in _STATE:
            setattr(self, name, state[name].copy())
        self.crushing.strains = state["crushed"].copy()
        there = np.flatnonzero(self.status != SEPARATED)
        self.strains = there, self.omega[there], state["strain"].T, state["plastic_strain"].T, state["crushed"][there]

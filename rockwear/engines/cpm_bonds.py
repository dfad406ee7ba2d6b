"""Bonds carried by YADE's concrete model: softening in C++, looked at from Python now and then."""
import math
from collections import namedtuple

import numpy as np
from yade import O, Vector3

from rockwear.engines.bond_log import BROKEN, INTACT, SEPARATED, BondLog, Crack

LOOK_PERIOD = 10
"""Steps between looks at a bond that has slipped or softened."""
SHARES = 4
"""The others are looked at so many times more rarely."""
STRAIGHT = 10
"""Points on the path that a bond is taken to have come before the first look that finds it softened or slipped."""
ZERO = Vector3.Zero
SPENT = 1.0 - 1e-6
"""Damage of a bond that slip has broken: YADE keeps it, as a contact with friction, until it opens."""
UNBREAKABLE = 1e29
"""Strength (N) from which a bond is not to break at all."""


def _in_plane(vector, normal):
    """A vector turned into the plane of a contact, nearly in which it lies."""
    tangential = vector - normal * normal.dot(vector)
    length = tangential.norm()
    return tangential * (vector.norm() / length) if length > 0.0 else tangential


def _turn_of(n, turns):
    return turns[n % len(turns)]


def _slip_before(law, contact):
    """Work (J) of slip of a bond as if it had come to its displacements on a straight path."""
    phys, bond, work, before = contact.phys, law.initial_state(), 0.0, 0.0
    un = law.opening(min(phys.omega, 1.0)) if phys.omega else -phys.normalForce.dot(contact.geom.normal) / law.kn
    ut = phys.epsT.norm() * phys.refLength
    for k in range(1, STRAIGHT + 1):
        _, (Ft,) = law.respond(bond, un * k / STRAIGHT, (ut * k / STRAIGHT,))
        work, before = work + 0.5 * (Ft + before) * ut / STRAIGHT, Ft
    return work - 0.5 * before**2 / law.kt


def _lost_by_damage(law, contact, omega):
    """(J of the normal force, J of slip) that a bond dissipates in the next step, where its damage is raised to omega
    and its forces fall to what the law then allows."""
    phys = contact.phys
    Fn, shear, left = -phys.normalForce.dot(contact.geom.normal), contact.shear_force.norm(), 1.0 - phys.omega
    kept = (1.0 - omega) / left if Fn > 0.0 else 1.0
    limit = law.shear_limit(omega, kept * Fn)
    return 0.5 * Fn**2 * (1.0 - kept) / (law.kn * left), 0.5 * max(shear**2 - limit**2, 0.0) / law.kt


_Contact = namedtuple("_Contact", "interaction geom phys slipped shear_force")
"""A bond in YADE, with epsTPl and shearForce. YADE gives these by reference: they are what they are now at any time."""


def _turn(contact):
    """Turn the slipped part of the strain into the plane of the contact: the total strain less the elastic one."""
    phys, slipped = contact.phys, contact.slipped
    elastic = _in_plane(contact.shear_force, contact.geom.normal) / (-phys.ks * phys.refLength)
    # In place: this is YADE's own vector.
    slipped += phys.epsT - elastic - slipped


class CpmBonds(BondLog):
    """All bonds of the rock under a law that YADE's concrete model (Law2_ScGeom_CpmPhys_Cpm) is.

    The C++ law gives every force. A look reads the damage omega and the slip of a bond, for the crack log and for the
    energy. What tension dissipates follows from omega alone. The work of slip is a sample: that of one step, the force
    of its two ends times what the bond slipped, counts for all steps between two looks. (Forces of looks ten steps
    apart, half a period of a bond, overstate it, because bonds slip while their force is low.) Bonds have their turns
    one after the other, bond n at steps n, n + period, ..., so that samples of many bonds even out and every step costs
    the same. Bonds that have neither softened nor slipped are looked at more rarely; what one slipped before it
    is found to have, the law tells from a straight path to where it is found.

    C++ knows no damage by slip: a look counts what the bond slipped since the last one and raises the damage by it. A
    bond that slip has broken stays a contact in YADE until it opens; what it slips until then is booked here too.

    C++ erases a bond that has opened to its end; if its particles meet again, that is a plain contact, by their radii
    (which must not overlap when they are bonded). YADE turns the total shear strain of a bond with the contact, but not
    its plastic part: a look turns that part too. Neither damage nor strains are in YADE's saved scenes: `state` holds
    them, and `erase_separated`, at every canonical point, sets the damage from omega, which is all that a restart
    knows.

    period: steps between two looks at a bond; 1: all bonds in every step. The engine itself is visited in every step.
    """

    def __init__(self, *, period=LOOK_PERIOD, **common):
        super().__init__(period=1, **common)
        self.between_looks = period
        self.between_quiet = period * SHARES if period > 1 else 1
        self.dissipated, self.by_slip = np.zeros(len(self.pairs)), np.zeros(len(self.pairs))
        self.slip_taken, self.strains = np.zeros(len(self.pairs)), None
        self.quiet, self.active, self.forces_before = [], [], {}

    @staticmethod
    def reference_overlap(phys):
        """penetrationDepth (m) at which the bond was made."""
        return phys.refPD

    def bond(self, numbers):
        for n in numbers.tolist():
            phys, law = O.interactions[tuple(self.pairs[n].tolist())].phys, self.laws[n]
            length = phys.refLength
            phys.kn, phys.ks, phys.crossSection = law.kn, law.kt, 1.0
            phys.E, phys.G, phys.tanFrictionAngle = law.kn * length, law.kt * length, law.mu
            phys.undamagedCohesion, phys.isCohesive, phys.damLaw = law.Rt, True, 0
            if law.Rn < UNBREAKABLE:
                phys.epsCrackOnset, phys.epsFracture = law.onset / length, law.gone / length
            else:
                phys.neverDamage = True

    def connect(self):
        """Find the interactions of the scene that is in O now, and give them the strains of a restart."""
        # By turn: {number: contact} and {number: (contact, omega and slipped part of the strain at the last look)}.
        self.quiet = [{} for _ in range(self.between_quiet)]
        self.active = [{} for _ in range(self.between_looks)]
        self._follow(np.flatnonzero(self.status != SEPARATED))
        if self.strains is not None:
            self._set_strains(*self.strains)
            self.strains = None
        self._prepare()

    def _take_up(self, numbers):
        self.dissipated[numbers] = self.by_slip[numbers] = self.slip_taken[numbers] = 0.0
        self._follow(numbers)

    def _follow(self, numbers):
        for n in numbers.tolist():
            interaction = O.interactions[tuple(self.pairs[n].tolist())]
            phys = interaction.phys
            _turn_of(n, self.quiet)[n] = _Contact(interaction, interaction.geom, phys, phys.epsTPl, phys.shearForce)

    def _set_strains(self, omegas, totals, plastics):
        for n, omega, total, plastic in zip(sorted(self._intact()), omegas.tolist(), totals.tolist(),
                                            plastics.tolist()):
            contact = _turn_of(n, self.quiet)[n]
            strain = contact.phys.epsT
            for k in range(3):
                strain[k], contact.slipped[k] = total[k], plastic[k]
            if omega or any(plastic):
                contact.phys.setDamage(omega)
                self._keep(n, _turn_of(n, self.quiet).pop(n))

    def _keep(self, n, contact):
        """Remember the damage and slip of an active bond as they are now."""
        _turn_of(n, self.active)[n] = contact, contact.phys.omega, contact.slipped * 1.0

    def _prepare(self):
        """Keep the forces (N) of the bonds whose turn is in the next step."""
        turn = self.active[(O.iter + 1) % len(self.active)]
        self.forces_before = {n: contact.shear_force * -1.0 for n, (contact, _, _) in turn.items()}

    def act(self):
        """Look at the bonds whose turn it is."""
        for n, (contact, omega, slipped) in list(self.active[O.iter % len(self.active)].items()):
            # YADE leaves the slip of a bond without any shear strength as it is.
            if contact.slipped == slipped and contact.phys.omega == omega and contact.shear_force != ZERO:
                continue
            self._look(n, contact, omega, slipped, self.forces_before.get(n))
        self._look_at_quiet(self.quiet[O.iter % len(self.quiet)])
        self._prepare()

    def _look_at_quiet(self, turn):
        for n, contact in list(turn.items()):
            if contact.slipped != ZERO or contact.phys.omega:
                del turn[n]
                self._dissipate(n, _slip_before(self.laws[n], contact), True)
                self._damage(n, contact, 0.0, ZERO)

    def _look(self, n, contact, omega_before, slipped_before, force_before=None):
        """Bring an active bond up to date; with its force at the start of the step, sample its slip."""
        force, law = -contact.shear_force, self.laws[n]
        if contact.phys.omega >= 1.0:
            # Its last shear force went with it: YADE leaves that of the step before.
            self._dissipate(n, 0.5 * force.squaredNorm() / law.kt, True)
        elif force_before is not None:
            work = (force + force_before).dot(contact.geom.shearInc)
            stored = (force.squaredNorm() - force_before.squaredNorm()) / law.kt
            self._dissipate(n, 0.5 * self.between_looks * (work - stored), True)
        self._damage(n, contact, omega_before, slipped_before)

    def _damage(self, n, contact, omega_before, slipped_before):
        """Bring the damage up to date; turn the slip of a bond that has not opened to its end."""
        law, omega = self.laws[n], contact.phys.omega
        if omega > omega_before:
            self._dissipate(n, law.dissipated(min(omega, 1.0)) - law.dissipated(omega_before), False)
        if omega >= 1.0:
            self._log(n, contact)
            self._separate(n)
            return
        _turn(contact)
        slip = (contact.slipped - _in_plane(slipped_before, contact.geom.normal)).norm() * contact.phys.refLength
        if slip and omega < SPENT and law.slip_end < math.inf:
            omega = min(omega + slip / law.slip_end, SPENT)
            in_tension, in_shear = _lost_by_damage(law, contact, omega)
            self._dissipate(n, in_tension, False)
            # Where there is a look at every step, the slip of the next one is in its sample.
            if self.between_looks > 1:
                self._dissipate(n, in_shear, True)
            contact.phys.setDamage(omega)
            if omega == SPENT:
                self._log(n, contact)
                self.status[n] = BROKEN
        self._keep(n, contact)

    def _dissipate(self, n, work, by_slip):
        self.dissipated[n] += work
        self.energy_released += work
        if by_slip:
            self.by_slip[n] += work

    def _log(self, n, contact):
        """Add a bond that breaks now to the cracks."""
        first, second = O.bodies[contact.interaction.id1], O.bodies[contact.interaction.id2]
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
        _turn_of(n, self.active).pop(n, None)
        _turn_of(n, self.quiet).pop(n, None)

    def look_at_all(self):
        """Bring damage and status of all bonds up to date."""
        for turn in self.active:
            for n, (contact, omega, slipped) in list(turn.items()):
                if contact.phys.omega != omega:
                    self._look(n, contact, omega, slipped)
        for turn in self.quiet:
            self._look_at_quiet(turn)

    def erase_separated(self):
        """At a canonical point: all bonds up to date, those of erased bodies separated, damage as a restart sets it."""
        self.look_at_all()
        kept = np.array([body is not None for body in map(O.bodies.__getitem__, range(int(self.pairs.max()) + 1))])
        for n in np.flatnonzero(~kept[self.pairs].all(axis=1)).tolist():
            self._separate(n)
        self.quiet = [dict(sorted(turn.items())) for turn in self.quiet]
        self.active = [dict(sorted(turn.items())) for turn in self.active]
        for n, (contact, omega, slipped) in [bond for turn in self.active for bond in turn.items()]:
            if contact.slipped != slipped:
                self._damage(n, contact, omega, slipped)
            if contact.phys.omega:
                contact.phys.setDamage(contact.phys.omega)
        self._prepare()

    def _shift(self, n, shift):
        turn = _turn_of(n, self.active)
        contact = turn[n][0] if n in turn else _turn_of(n, self.quiet)[n]
        contact.phys.refPD += shift
        return contact.geom, contact.phys

    def _intact(self):
        """{number: contact} of all bonds."""
        found = {n: contact for turn in self.active for n, (contact, _, _) in turn.items()}
        for turn in self.quiet:
            found.update(turn)
        return found

    def softening(self):
        """(m,) from 0, a bond in its initial state, to 1, a broken one."""
        found = np.where(self.status == INTACT, 0.0, 1.0)
        for n, (_, omega, _) in [bond for turn in self.active for bond in turn.items()]:
            found[n] = min(omega, 1.0)
        return found

    def elastic_energy(self):
        """Strain energy (J) of all bonds, sum of Fn^2/2kn + Ft^2/2kt with the secant kn of softened ones."""
        self.look_at_all()
        energy = []
        for _, geom, phys, _, _ in self._intact().values():
            # epsN would tell tension too, but YADE does not save it.
            kn = phys.kn * (1.0 - phys.omega if phys.normalForce.dot(geom.normal) < 0.0 else 1.0)
            energy.append(0.5 * (phys.normalForce.squaredNorm() / kn + phys.shearForce.squaredNorm() / phys.ks))
        return math.fsum(energy)

    def take_slip_work(self, particles):
        work, self.slip_taken = 0.5 * (self.by_slip - self.slip_taken), self.by_slip.copy()
        return np.bincount(self.pairs.ravel(), np.repeat(work, 2), particles)

    def state(self):
        bonds = [contact.phys for _, contact in sorted(self._intact().items())]
        return {**super().state(), "dissipated": self.dissipated.copy(), "by_slip": self.by_slip.copy(),
                "slip_taken": self.slip_taken.copy(), "omega": np.array([phys.omega for phys in bonds], float),
                "strain": np.array([phys.epsT for phys in bonds], float).reshape(-1, 3),
                "plastic_strain": np.array([phys.epsTPl for phys in bonds], float).reshape(-1, 3)}

    def restore(self, state):
        super().restore(state)
        self.dissipated, self.by_slip = state["dissipated"].copy(), state["by_slip"].copy()
        self.slip_taken = state["slip_taken"].copy()
        self.strains = state["omega"], state["strain"], state["plastic_strain"]

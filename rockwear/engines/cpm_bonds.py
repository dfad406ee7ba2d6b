"""Bonds carried by YADE's concrete model: softening in C++, looked at from Python now and then."""
import math

import numpy as np
from yade import O, Vector3

from rockwear.engines.bond_log import INTACT, SEPARATED, BondLog, Crack

LOOK_PERIOD = 10
"""Steps between looks at the bonds that slip or soften."""
SHARES = 8
"""The others are looked at in so many turns."""
UNSLIPPED = Vector3.Zero
UNBREAKABLE = 1e29
"""Strength (N) from which a bond is not to break at all."""


def _carried(vector, normal):
    """A tangential vector of an earlier look, turned into the plane of the contact as it lies now."""
    tangential = vector - normal * normal.dot(vector)
    length = tangential.norm()
    return tangential * (vector.norm() / length) if length > 0.0 else tangential


class CpmBonds(BondLog):
    """All bonds of the rock under a law that YADE's concrete model (Law2_ScGeom_CpmPhys_Cpm) is.

    The C++ law gives every force. A look reads the damage omega and the slip of bonds, for the crack log and for the
    energy: what damage dissipates follows from omega alone, and the work of slip from the displacements and forces of
    two looks by the trapezoidal rule. C++ erases a bond that has opened to its end; if its particles meet again, that
    is a plain contact, by their radii (which must not overlap when they are bonded). Bonds that have neither softened
    nor slipped are looked at in turns, so that the cost stays a few percent of the step's.

    YADE turns the total shear strain of a bond with the contact, but not its plastic part: a look turns that part too.
    Neither damage nor strains are in YADE's saved scenes: `state` holds them, and `erase_separated`, at every
    canonical point, sets the damage from omega, which is all that a restart knows.
    """

    def __init__(self, *, period=LOOK_PERIOD, **common):
        super().__init__(period=period, **common)
        self.dissipated, self.by_slip = np.zeros(len(self.pairs)), np.zeros(len(self.pairs))
        self.turn, self.strains = 0, None
        self.active = {}

    @staticmethod
    def reference_overlap(phys):
        """penetrationDepth (m) at which the bond was made."""
        return phys.refPD

    def bond(self):
        """Give every new interaction the constants of its law (once, after the bonding step)."""
        for (i, j), law in zip(self.pairs.tolist(), self.laws):
            phys = O.interactions[i, j].phys
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
        self.quiet, self.active = {}, {}
        for n in np.flatnonzero(self.status == INTACT).tolist():
            interaction = O.interactions[tuple(self.pairs[n].tolist())]
            phys = interaction.phys
            # YADE gives this vector by reference: it is what it is now at any time.
            self.quiet[n] = interaction, interaction.geom, phys, phys.epsTPl
        if self.strains is not None:
            self._set_strains(*self.strains)
            self.strains = None
        self.separations = int(np.sum(self.status == SEPARATED))

    def _set_strains(self, omegas, totals, plastics):
        for n, omega, total, plastic in zip(list(self.quiet), omegas.tolist(), totals.tolist(), plastics.tolist()):
            _, geom, phys, held = self.quiet[n]
            for k in range(3):
                phys.epsT[k], held[k] = total[k], plastic[k]
            if omega or any(plastic):
                phys.setDamage(omega)
                self.active[n] = self.quiet.pop(n), omega, self._shear(geom, phys)

    def act(self):
        """Look at the active bonds, and at a share of the quiet ones."""
        share = [n for n in self.quiet if n % SHARES == self.turn]
        self.turn = (self.turn + 1) % SHARES
        self._look([*self.active, *share])

    def _look(self, numbers):
        """Bring dissipation and status of these bonds up to date."""
        for n in list(numbers):
            if n in self.active:
                contact, omega, before = self.active[n]
                if contact[2].omega == omega and contact[3] == before[2]:
                    continue
            else:
                contact, omega, before = self.quiet[n], 0.0, None
                if contact[2].omega == 0.0 and contact[3] == UNSLIPPED:
                    continue
                self.active[n] = self.quiet.pop(n), 0.0, None
            self._account(n, contact[1], contact[2], omega, before)

    @staticmethod
    def _shear(geom, phys):
        """Tangential displacement (m), force (N) on the second body, in the law's sign, and the strain that slipped."""
        return phys.epsT * phys.refLength, _carried(-phys.shearForce, geom.normal), Vector3(phys.epsTPl)

    def _account(self, n, geom, phys, omega_before, before):
        law, omega, normal, length = self.laws[n], phys.omega, geom.normal, phys.refLength
        gone = omega >= 1.0 and not phys.neverDamage
        total, force, _ = self._shear(geom, phys)
        if gone:
            force = force * 0.0
        elastic = force / law.kt
        if before is None:
            # All shear force that a bond had before it broke is gone with it.
            lost = total * min(law.kt, law.Rt / max(total.norm(), 1e-300)) if gone else force
            slip, mean = total - elastic, 0.5 * (force + lost)
        else:
            total_before, force_before = (_carried(vector, normal) for vector in before[:2])
            slip, mean = total - total_before - elastic + force_before / law.kt, 0.5 * (force + force_before)
        work = mean.dot(slip)
        self.by_slip[n] += work
        if omega > omega_before:
            work += law.dissipated(min(omega, 1.0)) - law.dissipated(omega_before)
        self.dissipated[n] += work
        self.energy_released += work
        if gone:
            self._break(n)
            return
        plastic = (total - elastic) / length
        contact = self.active[n][0]
        for k in range(3):
            contact[3][k] = plastic[k]
        self.active[n] = contact, omega, (total, force, plastic)

    def _break(self, n):
        interaction = self.active[n][0][0]
        self._separate(n)
        first, second = O.bodies[interaction.id1], O.bodies[interaction.id2]
        if first is None or second is None:
            return
        place, line = 0.5 * (first.state.pos + second.state.pos), second.state.pos - first.state.pos
        mode = 1 if self.by_slip[n] <= 0.5 * self.dissipated[n] else 2
        self.cracks.append(Crack(self.clock(), *place, *line.normalized(), mode, float(self.dissipated[n]),
                                 *self.pairs[n].tolist()))

    def _separate(self, n):
        self.separations += self.status[n] != SEPARATED
        self.status[n] = SEPARATED
        self.active.pop(n, None)
        self.quiet.pop(n, None)

    def look_at_all(self):
        """Bring dissipation and status of all bonds up to date."""
        self._look([*self.active, *self.quiet])

    def erase_separated(self):
        """At a canonical point: all bonds up to date, those of erased bodies separated, damage as a restart sets it."""
        self.look_at_all()
        kept = np.array([body is not None for body in map(O.bodies.__getitem__, range(int(self.pairs.max()) + 1))])
        for n in np.flatnonzero(~kept[self.pairs].all(axis=1)).tolist():
            self._separate(n)
        self.quiet, self.active = dict(sorted(self.quiet.items())), dict(sorted(self.active.items()))
        for n, (contact, omega, _) in self.active.items():
            _, geom, phys, _ = contact
            if omega:
                phys.setDamage(omega)
            self.active[n] = contact, omega, self._shear(geom, phys)

    def _shift(self, n, shift):
        _, geom, phys, _ = self.active[n][0] if n in self.active else self.quiet[n]
        phys.refPD += shift
        return geom, phys

    def _intact(self):
        """{number: (interaction, geom, phys, its epsTPl)} of all bonds."""
        return {**self.quiet, **{n: contact for n, (contact, _, _) in self.active.items()}}

    def softening(self):
        """(m,) from 0, a bond in its initial state, to 1, a broken one."""
        found = np.where(self.status == INTACT, 0.0, 1.0)
        for n, (_, omega, _) in self.active.items():
            found[n] = min(omega, 1.0)
        return found

    def elastic_energy(self):
        """Strain energy (J) of all bonds, sum of Fn^2/2kn + Ft^2/2kt with the secant kn of softened ones."""
        self.look_at_all()
        energy = []
        for _, geom, phys, _ in self._intact().values():
            # epsN would tell tension too, but YADE does not save it.
            kn = phys.kn * (1.0 - phys.omega if phys.normalForce.dot(geom.normal) < 0.0 else 1.0)
            energy.append(0.5 * (phys.normalForce.squaredNorm() / kn + phys.shearForce.squaredNorm() / phys.ks))
        return math.fsum(energy)

    def state(self):
        bonds = [contact[2] for _, contact in sorted(self._intact().items())]
        return {**super().state(), "dissipated": self.dissipated.copy(), "by_slip": self.by_slip.copy(),
                "turn": self.turn, "omega": np.array([phys.omega for phys in bonds], float),
                "strain": np.array([phys.epsT for phys in bonds], float).reshape(-1, 3),
                "plastic_strain": np.array([phys.epsTPl for phys in bonds], float).reshape(-1, 3)}

    def restore(self, state):
        super().restore(state)
        self.dissipated, self.by_slip = state["dissipated"].copy(), state["by_slip"].copy()
        self.turn = int(state["turn"])
        self.strains = state["omega"], state["strain"], state["plastic_strain"]

"""Bonds of the rock: YADE's C++ brittle law carries them to their peak, a bond law of ours from there to the end."""
import math
import numpy as np

from collections import namedtuple

from scipy.spatial.transform import Rotation
from yade import Ig2_Sphere_Sphere_ScGeom, Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM, O, Subdomain, Vector3

from rockwear.engines.access import geometry_functor, law_functor
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.softening import SofteningBond, _lost, _set_domain


INTACT, BROKEN, SEPARATED = 0, 1, 2
"""Status of a bond: SEPARATED is broken, long apart and let go; a later meeting is a new contact."""

ROLLED = 0.02
"""Shear displacement over r_i + r_j from which, in space, the normals no longer tell how long it is."""

PATIENCE = 8
"""Steps without yielding after which a carried bond goes back to YADE's law. Going back and tripping again costs about
as much as carrying a bond so long, so that no path costs much more than twice what it must."""

TURNED, TURNING_PERIOD = 1.0, 200
"""Angle (rad) by which bonded particles may roll on each other until they count as bonded anew, and steps between looks.
A chip of two discs, joined by one bond, may roll like two wheels; in these steps by less than two radians."""

Crack = namedtuple("Crack", "time x y z normal_x normal_y normal_z mode energy body_1 body_2")
"""One broken bond: s, m, unit normal, 1 tension or 2 shear, J dissipated until it was gone, ids of the particles."""


def _as_long_as_held(ut, carried):
    """Tangential displacement `ut` of this step with the length that the strain energy of the last step tells."""
    phys, increment = carried.phys, carried.geom.shearInc
    before = ut - increment
    fixed = 2.0 * phys.ks * (phys.strainEnergy - 0.5 * carried.Fn**2 / phys.kn)
    length = math.sqrt(max(fixed, 0.0)) / phys.ks
    return before.normalized() * length + increment


def _strain_energy(phys):
    """Strain energy (J) of a contact, Fn^2/2kn + Ft^2/2kt."""
    return 0.5 * (phys.normalForce.squaredNorm() / phys.kn + phys.shearForce.squaredNorm() / phys.ks)


class Bonds(Engine):
    """All bonds of the rock under one law (M ch. 4), with a crack log.

    pairs: (m, 2) body ids; law: of rockwear.kernels.bond_laws; strength_factor: (m,), a bond obeys law.scaled(factor);
    clock: a function giving the time (s) for the crack log.

    YADE's JCFpm law gives Fn = kn un, Ft = kt ut until Fn > FnMax or |Ft| > FsMax + slope Fn, which are the law's
    elastic_domain. Two counters of the C++ law tell that a domain was tripped, and a sum which: the C++ law adds up the
    crossSection of what breaks, which serves as the bond's label. In the same step a tripped bond goes into `carried`,
    and Python gives its force in every step. Most of them soften for a moment and are elastic again for long: a bond
    that has not yielded for some steps is `resting`, with YADE's law, within a new domain about its present forces. So
    Python pays for bonds that yield, not for bonds past their peak. Once a bond is gone YADE's law gives the Coulomb
    contact that remains. It keeps its reference length, so that overlaps of the packing never turn into forces. A
    brittle bond is gone in the step of its trip, and costs nothing afterwards.

    A law without a elastic_domain (nothing is linear within) has all its bonds, and their contacts afterwards, carried by
    Python: some microseconds a bond and step, which is fine for small specimens only.

    Particles may be erased from O at any time, by anyone: their bonds are then SEPARATED, with what they held, and are no
    cracks.

    Where a domain is tripped YADE's law forgets the shear force, or cuts it. What it was follows from where the two
    bodies have turned since they were bonded; a bond that has slipped and goes to rest, or whose particles have turned
    far against each other (TURNED), counts as bonded anew, with the normals that give its elastic displacement. That is
    exact in 2D; in 3D its error grows with the cube of the angle, and is below 1e-6 of the strength where Rt/kt is 5
    thousandths of a radius. Spheres that have rolled far on each other do not come back as they were: from ROLLED on
    only the direction is taken from the normals, and the length from the strain energy that YADE's law kept of the step
    before. The same holds throughout where shear is that of the points of contact (not ratcheting_free, see
    scene.put_loop), which normals do not tell.
    """

    name = "bonds"
    phase = FORCES

    def __init__(self, *, pairs, law, strength_factor=None, clock, period=1):
        super().__init__(period=period)
        self.pairs = np.asarray(pairs)
        self.bodies = np.unique(self.pairs).tolist()
        self.law = law
        factors = np.ones(len(self.pairs)) if strength_factor is None else np.asarray(strength_factor, float)
        scaled = {factor: law.scaled(factor) for factor in np.unique(factors).tolist()}
        self.laws = [scaled[factor] for factor in factors.tolist()]
        self.native = law.elastic_domain(law.initial_state()) is not None
        self.status = np.full(len(self.pairs), INTACT, np.int8)
        self.normals = np.zeros((len(self.pairs), 2, 3))
        self.cracks = []
        self.carried, self.resting = {}, {}
        self.energy_released = 0.0
        self.clock = clock

    def bond(self):
        """Give every fresh JCFpm interaction its stiffness and elastic_domain (once, after the bonding step)."""
        for n, ((i, j), law) in enumerate(zip(self.pairs.tolist(), self.laws)):
            interaction = O.interactions[i, j]
            phys, normal = interaction.phys, interaction.geom.normal
            # The label by which the C++ law tells what it broke.
            phys.crossSection = n + 1
            for side, body in enumerate((interaction.id1, interaction.id2)):
                self.normals[n, side] = O.bodies[body].state.ori.conjugate() * normal
            if self.native:
                _set_domain(phys, law.elastic_domain(law.initial_state()))
            else:
                phys.kn, phys.ks = law.kn, law.kt
                carried = self.carried[n] = SofteningBond(law=law, bond=law.initial_state(), length=phys.initD)
                carried.connect(interaction)
                carried.release()

    def connect(self):
        """Find the interactions of the scene that is in O now."""
        self.functor = law_functor(Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM)
        self.ratcheting_free = geometry_functor(Ig2_Sphere_Sphere_ScGeom).avoidGranularRatcheting
        self.intact, self.broken, self.ends = {}, {}, self.pairs.copy()
        self.gone = int(np.sum(self.status == SEPARATED))
        for n, (i, j) in enumerate(self.pairs.tolist()):
            if self.status[n] != SEPARATED:
                interaction = O.interactions[i, j]
                self.ends[n] = interaction.id1, interaction.id2
                for softened in (self.carried, self.resting):
                    if n in softened:
                        softened[n].connect(interaction)
                if self.status[n] == BROKEN:
                    self.broken[n] = interaction, interaction.phys
                elif n not in self.carried:
                    self.intact[n] = interaction, interaction.phys
        self._read_counters()

    def _read_counters(self):
        self.counts = self.functor.nbTensCracks, self.functor.nbShearCracks
        self.functor.totalCracksSurface = 0.0

    def act(self):
        """The forces of carried bonds; and where one of two counters has moved, the bonds that tripped in this step."""
        forces, functor = O.forces, self.functor
        if O.iter % TURNING_PERIOD == 0 and self.native:
            self._follow_rolling()
        for n, carried in list(self.carried.items()):
            if _lost(carried.interaction):
                self._forget(n)
                continue
            spent = carried.advance(carried.trial(), forces)
            if spent is None:
                carried.quiet += 1
                if carried.quiet >= PATIENCE and self.native:
                    self._rest(n, carried)
            else:
                carried.quiet = 0
                if self.status[n] == INTACT:
                    self._book(n, carried, spent)
        if (functor.nbTensCracks, functor.nbShearCracks) != self.counts:
            tripped = self._tripped()
            self._read_counters()
            for n in tripped:
                self._trip(n)

    def _tripped(self):
        """Bonds that tripped in this step: one is told by the label that was added, several are searched for."""
        number = self.functor.nbTensCracks + self.functor.nbShearCracks - sum(self.counts)
        if O.numThreads > 1:
            number = len(self.intact)  # threads that count at once may lose a count
        elif number == 1:
            return [int(self.functor.totalCracksSurface) - 1]
        found = []
        # What came to rest last comes first: most of those that trip together have just tripped before.
        for n, (_, phys) in reversed(self.intact.items()):
            if not phys.isCohesive:
                found.append(n)
                if len(found) == number:
                    break
        return sorted(found)

    def _trip(self, n):
        """Carry a bond from here on, as our law answers where YADE's has given way."""
        interaction, phys = self.intact.pop(n)
        if _lost(interaction):
            self._forget(n)
            return
        carried = self.resting.pop(n, None) or SofteningBond(law=self.laws[n], bond=self.laws[n].initial_state(), length=phys.initD)
        self.carried[n] = carried
        carried.connect(interaction)
        carried.release()
        first, second = O.bodies[interaction.id1].state, O.bodies[interaction.id2].state
        geom, bond = carried.geom, carried.bond
        carried.un = carried.length - geom.penetrationDepth - (second.vel - first.vel).dot(geom.normal) * O.dt
        carried.Fn = phys.kn * (carried.un - bond.un_plastic)
        softening = bond.softening
        ut = self._shear_displacement(n, geom, first, second)
        far = self.normals[n, :, 2].any() and ut.norm() > ROLLED * sum(carried.radii)
        if far or not self.ratcheting_free:
            ut = _as_long_as_held(ut, carried)
        spent = carried.advance(ut, O.forces)
        if bond.softening == softening:
            # The domain lies within the strength, or where an elastic stiffness changes.
            self._rest(n, carried)
            return
        self._book(n, carried, spent)

    def _rest(self, n, carried):
        """Give a bond that does not yield back to YADE's law; what has softened is as if bonded anew."""
        if not carried.rest():
            carried.quiet = 0
            return
        del self.carried[n]
        self.intact[n] = carried.interaction, carried.phys
        if carried.bond.softening > 0.0:
            self.resting[n] = carried
            self._bond_anew(n, carried.interaction)

    def _bond_anew(self, n, interaction):
        """Set the normals at bonding such that `_shear_displacement` is the elastic displacement of now."""
        geom, phys = interaction.geom, interaction.phys
        elastic = phys.shearForce * (-1.0 / phys.ks)
        angle = elastic.norm() / (geom.refR1 + geom.refR2)
        bonded = geom.normal * math.cos(angle) - elastic.normalized() * math.sin(angle)
        for side, body in enumerate((interaction.id1, interaction.id2)):
            self.normals[n, side] = O.bodies[body].state.ori.conjugate() * bonded

    def _follow_rolling(self):
        """Bond anew what has rolled far: an angle of more than half a turn could not be told from one of less."""
        found = np.flatnonzero(self.status == INTACT)
        if not len(found):
            return
        there = [body for body in self.bodies if O.bodies[body] is not None]
        turns = np.tile([0.0, 0.0, 0.0, 1.0], (max(self.bodies) + 1, 1))
        turns[there] = np.reshape(Subdomain().getStateValuesFromIds(there), (-1, 13))[:, 9:]
        first, second = (Rotation.from_quat(turns[self.ends[found, side]]).apply(self.normals[found, side])
                         for side in (0, 1))
        for n in found[np.sum(first * second, axis=1) < math.cos(TURNED)].tolist():
            if n in self.intact and not _lost(self.intact[n][0]):
                self._bond_anew(n, self.intact[n][0])

    def _shear_displacement(self, n, geom, first, second):
        """Tangential displacement (Vector3, m) of a bond in which nothing has slipped.

        R1 (n - n1) + R2 (n - n2), arcs in place of chords; n1, n2: the normal at bonding as each body has turned it.
        """
        normal, found = geom.normal, Vector3.Zero
        for state, radius, bonded in zip((first, second), (geom.refR1, geom.refR2), self.normals[n].tolist()):
            turned = state.ori * Vector3(*bonded)
            cos = turned.dot(normal)
            aside = turned - normal * cos
            sin = aside.norm()
            if sin > 0.0:
                found -= aside * (radius * math.atan2(sin, cos) / sin)
        return found

    def _book(self, n, carried, spent):
        """Energy dissipated in a bond; and where that was the last of it, the crack."""
        carried.spent += spent
        self.energy_released += spent
        if not carried.bond.broken:
            return
        interaction, geom = carried.interaction, carried.geom
        self.status[n] = BROKEN
        self.broken[n] = interaction, carried.phys
        if self.native:
            carried.hand_over()
            del self.carried[n]
        self.cracks.append(Crack(self.clock(), *geom.contactPoint, *geom.normal, 1 if carried.opened else 2,
                                 carried.spent, *self.pairs[n].tolist()))

    def _forget(self, n):
        self.gone += self.status[n] != SEPARATED
        self.status[n] = SEPARATED
        for group in (self.intact, self.broken, self.carried, self.resting):
            group.pop(n, None)

    def erase_separated(self):
        """Erase broken contacts whose particles are apart, both by radii and by the bond's own length."""
        bodies = O.bodies
        erased = [i for i in self.bodies if bodies[i] is None]
        if erased:
            self.bodies = [i for i in self.bodies if bodies[i] is not None]
            for n in np.flatnonzero(np.isin(self.pairs, erased).any(axis=1)).tolist():
                self._forget(n)
        for n, (interaction, phys) in list(self.broken.items()):
            if interaction.geom.penetrationDepth < min(0.0, phys.initD):
                O.interactions.erase(interaction.id1, interaction.id2)
                self._forget(n)
        # The order in which a loaded scene would find them: sums come out equal to the last digit.
        self.broken = dict(sorted(self.broken.items()))
        self.carried = dict(sorted(self.carried.items()))

    def expand(self, numbers, growth, overlap):
        """Radii have grown: r_i + r_j of bonds `numbers` by `growth`, their overlap at rest by `overlap` (m).

        -> J, the work of the expansion against the forces of the last step.
        """
        work = 0.0
        for n, longer, shift in zip(numbers.tolist(), growth.tolist(), overlap.tolist()):
            if self.status[n] == SEPARATED:
                continue
            if n in self.carried:
                carried = self.carried[n]
                carried.length += shift
                interaction, phys = carried.interaction, carried.phys
            else:
                interaction, phys = self.intact[n] if self.status[n] == INTACT else self.broken[n]
            phys.initD += shift
            pressing = phys.normalForce.dot(interaction.geom.normal)
            if pressing or self.status[n] == INTACT:
                work += (longer - shift) * (pressing + 0.5 * phys.kn * (longer - shift))
        return work

    def contact(self, n):
        """YADE's phys of the intact bond n."""
        return self.carried[n].phys if n in self.carried else self.intact[n][1]

    def in_contact(self):
        """(m,) bool: bonds that are intact, or broken and pressed together; what heat may pass through."""
        touching = self.status == INTACT
        for n, (_, phys) in self.broken.items():
            touching[n] = phys.normalForce.squaredNorm() > 0
        return touching

    def softening(self):
        """(m,) from 0, a initial_state bond, to 1, a broken one."""
        found = np.where(self.status == INTACT, 0.0, 1.0)
        for n, softened in (*self.carried.items(), *self.resting.items()):
            found[n] = softened.bond.softening
        return found

    def elastic_energy(self):
        """Strain energy (J) of all bonds and of broken bonds in contact, sum of Fn^2/2kn + Ft^2/2kt."""
        contacts = [phys for group in (self.intact, self.broken) for _, phys in group.values()]
        contacts += [carried.phys for n, carried in self.carried.items() if n not in self.broken]
        return math.fsum(map(_strain_energy, contacts))

    def state(self):
        return {"status": self.status.copy(), "normals": self.normals.copy(), "energy_released": self.energy_released,
                "cracks": np.array(self.cracks, float).reshape(-1, len(Crack._fields)),
                "carried": self._rows(self.carried), "resting": self._rows(self.resting)}

    def _rows(self, softened):
        """A row of numbers for each bond with a state of its own."""
        scalars = self.law.initial_state().scalars
        rows = [(n, c.length, c.un, c.Fn, c.spent, c.quiet, *(getattr(c.bond, name) for name in scalars))
                for n, c in softened.items()]
        return np.array(rows, float).reshape(-1, 6 + len(scalars))

    def restore(self, state):
        self.status, self.normals = state["status"].copy(), state["normals"].copy()
        self.cracks = [Crack(*row[:7], int(row[7]), row[8], int(row[9]), int(row[10])) for row in state["cracks"].tolist()]
        self.energy_released = float(state["energy_released"])
        self.carried, self.resting = self._from_rows(state["carried"]), self._from_rows(state["resting"])

    def _from_rows(self, rows):
        found = {}
        for n, length, un, Fn, spent, quiet, *values in rows.tolist():
            law = self.laws[int(n)]
            bond = law.initial_state()
            for name, value in zip(bond.scalars, values):
                setattr(bond, name, value)
            found[int(n)] = SofteningBond(law=law, bond=bond, length=length, un=un, Fn=Fn, spent=spent, quiet=quiet)
        return found

    def log(self):
        modes = [crack.mode for crack in self.cracks]
        return {"tensile_cracks": (modes.count(1), "-"), "shear_cracks": (modes.count(2), "-")}


class Separation(Engine):
    """Lets broken bonds go whose particles are apart, so that nobody looks at them any more."""

    name = "separation"

    def __init__(self, bonds, *, period=1):
        super().__init__(period=period)
        self.bonds = bonds

    def act(self):
        self.bonds.erase_separated()

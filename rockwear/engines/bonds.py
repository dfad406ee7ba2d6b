"""Bonds of the rock: YADE's C++ brittle law within their elastic domain, a Python bond law beyond it."""
import math
import numpy as np

from yade import Ig2_Sphere_Sphere_ScGeom, Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM, O, Vector3

from rockwear.engines.access import body_erased, contact_of, geometry_functor, law_functor
from rockwear.engines.base import FORCES
from rockwear.engines.bond_log import BROKEN, INTACT, SEPARATED, BondLog, Crack
from rockwear.engines.bonding_normals import BondingNormals
from rockwear.engines.softening import SofteningBond, from_rows, set_elastic_domain, to_rows


LARGE_SHEAR = 0.02
"""Shear displacement over r_i + r_j from which, in space, its length does not follow from the normals."""

ELASTIC_STEPS = 8
"""Steps without yielding after which a softening bond returns to YADE's law. A return and a second yield cost about as
much as so many steps in Python, so that no path costs much more than twice the minimum."""

ROLLING_PERIOD = 200
"""Steps between checks for rolled bonds. In these steps a chip of two discs, joined by one bond, may roll by less than
two radians."""


def _strain_energy(phys):
    """Strain energy (J) of a contact, Fn^2/2kn + Ft^2/2kt."""
    return 0.5 * (phys.normalForce.squaredNorm() / phys.kn + phys.shearForce.squaredNorm() / phys.ks)


def _with_stored_length(ut, softening):
    """Tangential displacement `ut` of this step, its length taken from the strain energy of the last step."""
    phys, increment = softening.phys, softening.geom.shearInc
    before = ut - increment
    stored = 2.0 * phys.ks * (phys.strainEnergy - 0.5 * softening.Fn**2 / phys.kn)
    length = math.sqrt(max(stored, 0.0)) / phys.ks
    return before.normalized() * length + increment


class Bonds(BondLog):
    """All bonds of the rock under one law [Rojek 2003, ch. 4].

    YADE's JCFpm law gives Fn = kn un, Ft = kt ut until Fn > FnMax or |Ft| > FsMax + slope Fn, which are set to the
    elastic domain of the bond law. Two counters of the C++ law tell that a bond has left its domain, and a sum tells
    which: the C++ law adds up the crossSection of what breaks, which holds the bond's label. In the same step such a
    bond enters `softening_bonds`, and Python gives its force at every step. Most bonds yield for a few steps and are
    elastic again for many: a bond that has not yielded for ELASTIC_STEPS is in `returned`, with YADE's law and a new
    domain around its present forces. So Python's cost is that of yielding bonds, not of all beyond their peak. For
    a broken bond YADE's law gives the Coulomb contact that remains, with the bond's reference overlap, so that overlaps
    of the packing never turn into forces. A brittle bond breaks in the step that leaves the domain.

    With a law that has no elastic domain (it is linear nowhere) all bonds, also broken ones, are `softening_bonds`:
    some microseconds a bond and step, suitable for small specimens only.

    Any body may be erased from O at any time: its bonds are then SEPARATED, with their energy, and are no cracks.

    Where a bond leaves its domain YADE's law erases or cuts the shear force, which is found again from the normals at
    bonding, see BondingNormals. In space their error grows with the angle: beyond LARGE_SHEAR they give the direction
    only, and the strain energy that YADE's law kept of the last step gives the length. The same holds for all bonds
    where shear follows the points of contact (avoidGranularRatcheting off), which normals do not represent.
    """

    phase = FORCES

    def __init__(self, **common):
        super().__init__(**common)
        self.bodies = np.unique(self.pairs).tolist()
        self.has_domain = self.law.elastic_domain(self.law.initial_state()) is not None
        self.normals = BondingNormals(len(self.pairs))
        self.softening_bonds, self.returned = {}, {}

    @staticmethod
    def reference_overlap(phys):
        """penetrationDepth (m) at which the bond was made."""
        return phys.initD

    def bond(self, numbers):
        for n in numbers.tolist():
            interaction, law = contact_of(*self.pairs[n].tolist()), self.laws[n]
            phys = interaction.phys
            # The label by which the C++ law tells what it broke.
            phys.crossSection = n + 1
            self.normals.set(n, interaction, interaction.geom.normal)
            if self.has_domain:
                set_elastic_domain(phys, law.elastic_domain(law.initial_state()))
            else:
                phys.kn, phys.ks = law.kn, law.kt
                softening = self.softening_bonds[n] = self._initial(n, phys)
                softening.connect(interaction)
                softening.release()

    def _initial(self, n, phys):
        return SofteningBond(law=self.laws[n], bond=self.laws[n].initial_state(), overlap=phys.initD)

    def connect(self):
        """Find the interactions of the scene that is in O now."""
        self.functor = law_functor(Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM)
        self.shear_by_radii = geometry_functor(Ig2_Sphere_Sphere_ScGeom).avoidGranularRatcheting
        self.elastic, self.broken = {}, {}
        for n, (i, j) in enumerate(self.pairs.tolist()):
            if self.status[n] != SEPARATED:
                interaction = contact_of(i, j)
                self.ends[n] = interaction.id1, interaction.id2
                for group in (self.softening_bonds, self.returned):
                    if n in group:
                        group[n].connect(interaction)
                if self.status[n] == BROKEN:
                    self.broken[n] = interaction, interaction.phys
                elif n not in self.softening_bonds:
                    self.elastic[n] = interaction, interaction.phys
        self._read_counters()

    def _take_up(self, numbers):
        for n in numbers.tolist():
            interaction = contact_of(*self.pairs[n].tolist())
            self.ends[n] = interaction.id1, interaction.id2
            if n not in self.softening_bonds:
                self.elastic[n] = interaction, interaction.phys
        self.elastic = dict(sorted(self.elastic.items()))

    def _read_counters(self):
        self.counts = self.functor.nbTensCracks, self.functor.nbShearCracks
        self.functor.totalCracksSurface = 0.0

    def act(self):
        """The forces of softening bonds; if one of two counters has increased, the bonds that left their domain."""
        forces, functor = O.forces, self.functor
        if O.iter % ROLLING_PERIOD == 0 and self.has_domain:
            self._follow_rolling()
        for n, softening in list(self.softening_bonds.items()):
            if body_erased(softening.interaction):
                self._separate(n)
                continue
            dissipated = softening.advance(softening.trial(), forces)
            if dissipated is None:
                softening.elastic_steps += 1
                if softening.elastic_steps >= ELASTIC_STEPS and self.has_domain:
                    self._return_to_yade(n, softening)
            else:
                softening.elastic_steps = 0
                if self.status[n] == INTACT:
                    self._dissipate(n, softening, dissipated)
        if (functor.nbTensCracks, functor.nbShearCracks) != self.counts:
            yielded = self._yielded()
            self._read_counters()
            for n in yielded:
                self._yield(n)

    def _yielded(self):
        """Bonds that left their domain in this step: the added label tells one, several are searched for."""
        number = self.functor.nbTensCracks + self.functor.nbShearCracks - sum(self.counts)
        if O.numThreads > 1:
            number = len(self.elastic)  # threads that count at once may lose a count
        elif number == 1:
            return [int(self.functor.totalCracksSurface) - 1]
        found = []
        # The last to return come first: most bonds that yield together have yielded shortly before.
        for n, (_, phys) in reversed(self.elastic.items()):
            if not phys.isCohesive:
                found.append(n)
                if len(found) == number:
                    break
        return sorted(found)

    def _yield(self, n):
        """Give the force of a bond from Python, in this step and from now on."""
        interaction, phys = self.elastic.pop(n)
        if body_erased(interaction):
            self._separate(n)
            return
        softening = self.softening_bonds[n] = self.returned.pop(n, None) or self._initial(n, phys)
        softening.connect(interaction)
        softening.release()
        first, second = O.bodies[interaction.id1].state, O.bodies[interaction.id2].state
        geom, bond = softening.geom, softening.bond
        softening.un = softening.overlap - geom.penetrationDepth - (second.vel - first.vel).dot(geom.normal) * O.dt
        softening.Fn = phys.kn * (softening.un - bond.un_plastic)
        before = bond.softening
        ut = self.normals.shear_displacement(n, geom, first, second)
        far = self.normals.in_space(n) and ut.norm() > LARGE_SHEAR * sum(softening.radii)
        if far or not self.shear_by_radii:
            ut = _with_stored_length(ut, softening)
        dissipated = softening.advance(ut, O.forces)
        if bond.softening == before:
            # The domain is smaller than the strength, or ends where an elastic stiffness changes.
            self._return_to_yade(n, softening)
            return
        self._dissipate(n, softening, dissipated)

    def _return_to_yade(self, n, softening):
        """Return a bond that does not yield to YADE's law."""
        if not softening.return_to_yade():
            softening.elastic_steps = 0
            return
        del self.softening_bonds[n]
        self.elastic[n] = softening.interaction, softening.phys
        if softening.bond.softening > 0.0:
            self.returned[n] = softening
            self.normals.set_elastic(n, softening.interaction)

    def _follow_rolling(self):
        """Set the normals of bonds anew whose particles have rolled far on each other."""
        intact = np.flatnonzero(self.status == INTACT)
        if not len(intact):
            return
        existing = [body for body in self.bodies if O.bodies[body] is not None]
        for n in self.normals.rolled(intact, self.ends, existing).tolist():
            if n in self.elastic and not body_erased(self.elastic[n][0]):
                self.normals.set_elastic(n, self.elastic[n][0])

    def _dissipate(self, n, softening, dissipated):
        """Add the energy (J) dissipated in a bond in this step; log the crack if it broke."""
        softening.dissipated += dissipated
        self.energy_released += dissipated
        if not softening.bond.broken:
            return
        interaction, geom = softening.interaction, softening.geom
        self.status[n] = BROKEN
        self.broken[n] = interaction, softening.phys
        if self.has_domain:
            softening.convert_to_friction()
            del self.softening_bonds[n]
        self.cracks.append(Crack(self.clock(), *geom.contactPoint, *geom.normal, 1 if softening.tensile else 2,
                                 softening.dissipated, *self.pairs[n].tolist()))

    def _separate(self, n):
        if self.status[n] != SEPARATED:
            self.parted.append(n)
        self.status[n] = SEPARATED
        for group in (self.elastic, self.broken, self.softening_bonds, self.returned):
            group.pop(n, None)

    def erase_separated(self):
        """Erase broken contacts whose particles are apart, both by radii and by the bond's own reference overlap."""
        bodies = O.bodies
        erased = [i for i in self.bodies if bodies[i] is None]
        if erased:
            self.bodies = [i for i in self.bodies if bodies[i] is not None]
            for n in np.flatnonzero(np.isin(self.pairs, erased).any(axis=1)).tolist():
                self._separate(n)
        for n, (interaction, phys) in list(self.broken.items()):
            if interaction.geom.penetrationDepth < min(0.0, phys.initD):
                O.interactions.erase(interaction.id1, interaction.id2)
                self._separate(n)
        # The order in which a loaded scene would find them: sums come out equal to the last digit.
        self.broken = dict(sorted(self.broken.items()))
        self.softening_bonds = dict(sorted(self.softening_bonds.items()))

    def _shift(self, n, shift):
        for group in (self.softening_bonds, self.returned):
            if n in group:
                group[n].overlap += shift
        if n in self.softening_bonds:
            interaction, phys = self.softening_bonds[n].interaction, self.softening_bonds[n].phys
        else:
            interaction, phys = self.elastic[n] if self.status[n] == INTACT else self.broken[n]
        phys.initD += shift
        return interaction.geom, phys

    def shear(self, numbers):
        """What YADE turns with intact bonds and adds slip to, (k, 3) N, how much of it a metre of slip takes, (k,) N/m,
        and a function that sets it."""
        contacts = [self.softening_bonds[n].phys if n in self.softening_bonds else self.elastic[n][1]
                    for n in numbers.tolist()]

        def set_to(shear):
            for phys, force in zip(contacts, shear.tolist()):
                phys.shearForce = Vector3(*force)
        return np.array([phys.shearForce for phys in contacts]), np.array([phys.ks for phys in contacts]), set_to

    def softening(self):
        """(m,) from 0, a bond in its initial state, to 1, a broken one."""
        found = np.where(self.status == INTACT, 0.0, 1.0)
        for n, softening in (*self.softening_bonds.items(), *self.returned.items()):
            found[n] = softening.bond.softening
        return found

    def elastic_energy(self):
        """Strain energy (J) of all bonds and of broken bonds in contact, sum of Fn^2/2kn + Ft^2/2kt."""
        contacts = [phys for group in (self.elastic, self.broken) for _, phys in group.values()]
        contacts += [softening.phys for n, softening in self.softening_bonds.items() if n not in self.broken]
        return math.fsum(map(_strain_energy, contacts))

    def state(self):
        scalars = self.law.initial_state().scalars
        return {**super().state(), "normals": self.normals.normals.copy(),
                "softening_bonds": to_rows(self.softening_bonds, scalars), "returned": to_rows(self.returned, scalars)}

    def restore(self, state):
        super().restore(state)
        self.normals.normals = state["normals"].copy()
        self.softening_bonds = from_rows(state["softening_bonds"], self.laws)
        self.returned = from_rows(state["returned"], self.laws)

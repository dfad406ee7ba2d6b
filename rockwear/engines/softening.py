"""One bond past its elastic domain: our law gives its force in place of YADE's."""
from yade import O, Vector3


UNLIMITED = 1e30
"""A strength (N) that no bond reaches."""

NO_CHANGE = 1e-13
"""Difference of two forces that is round-off, as a fraction of the force."""


class SofteningBond:
    """A contact whose force is given by a law of ours, step by step, in place of the force of YADE's law.

    law, bond: the law and its state; length: penetrationDepth (m) at which the opening is zero; un, Fn: opening (m)
    and normal force (N) of the last step; spent: J dissipated so far; quiet: steps since it last yielded; opened: True
    if it broke by opening.

    YADE's contact is left such that its own law makes the next elastic trial: shearForce is our tangential force, and
    kn, ks and initD are secants, so that -shearForce/ks is the elastic tangential displacement, which the C++ law
    turns with the contact and carries forward. Where nothing yields, its trial is the answer, and nothing is written.
    """

    __slots__ = ("interaction", "geom", "phys", "bodies", "radii",
                 "law", "bond", "length", "un", "Fn", "spent", "quiet", "opened")

    def __init__(self, *, law, bond, length, un=0.0, Fn=0.0, spent=0.0, quiet=0):
        self.law, self.bond, self.length, self.un, self.Fn = law, bond, length, un, Fn
        self.spent, self.quiet = spent, int(quiet)

    def connect(self, interaction):
        """The contact of the scene that is in O now."""
        self.interaction, self.geom, self.phys = interaction, interaction.geom, interaction.phys
        self.bodies, self.radii = (interaction.id1, interaction.id2), (self.geom.refR1, self.geom.refR2)

    def release(self):
        """No elastic_domain any more: each step comes to `advance`."""
        phys = self.phys
        phys.isCohesive, phys.FnMax, phys.FsMax, phys.tanFrictionAngle = True, UNLIMITED, UNLIMITED, 0.0
        self.quiet = 0

    def rest(self):
        """Leave the bond to YADE's law, within a new elastic_domain. -> True if our law has one to give."""
        domain = self.law.elastic_domain(self.bond, self.Fn, self.phys.shearForce.norm())
        if domain:
            _set_domain(self.phys, domain)
        return domain is not None

    def trial(self):
        """Elastic tangential displacement (Vector3, m) as YADE's law has carried it into this step."""
        phys = self.phys
        return phys.shearForce * (-1.0 / phys.ks)

    def advance(self, ut, forces):
        """This step's force, in place of the one that YADE's law has applied.

        ut: as `trial` gives it, m; forces: O.forces.
        -> J dissipated, the work of the forces over the step (by the trapezoid, as leapfrog does it) less the gain in
        stored energy; None where YADE's force stands.
        """
        geom, phys, law, bond = self.geom, self.phys, self.law, self.bond
        normal, increment, penetration = geom.normal, geom.shearInc, geom.penetrationDepth
        un, last, un_plastic = self.length - penetration, self.un, bond.un_plastic
        bond.turned(ut, increment)
        Fn, Ft = law.respond(bond, un, (ut[0], ut[1], ut[2]))
        pull, shear = normal * -Fn, Vector3(-Ft[0], -Ft[1], -Ft[2])
        change = pull + shear - phys.normalForce - phys.shearForce
        before, self.un, self.Fn = self.Fn, un, Fn
        if bond.softening < 1.0:
            if change.squaredNorm() <= NO_CHANGE**2 * (Fn * Fn + shear.squaredNorm()):
                return None
        else:
            self.opened = law.kn * (un - un_plastic) / law.Rn >= law.kt * ut.norm() / law.Rt
        (first, second), (arm_1, arm_2), moment = self.bodies, self.radii, change.cross(normal)
        forces.addF(first, -change)
        forces.addF(second, change)
        forces.addT(first, moment * (arm_1 - 0.5 * penetration))
        forces.addT(second, moment * (arm_2 - 0.5 * penetration))

        kt, ut_before = phys.ks, ut - increment
        elastic = ut - Vector3(bond.ut_plastic)
        work = (before + Fn) * (un - last) + (ut_before * kt - shear).dot(increment)
        released = before * (last - un_plastic) + kt * ut_before.squaredNorm()
        stored = Fn * (un - bond.un_plastic) - shear.dot(elastic)

        phys.normalForce, phys.shearForce = pull, shear
        phys.initD = self.length - bond.un_plastic
        force = shear.norm()
        if force > 0.0:
            phys.ks = force / elastic.norm()
        if Fn != 0.0:
            phys.kn = Fn / (un - bond.un_plastic)
        return 0.5 * (work + released - stored)

    def hand_over(self):
        """Leave what remains to YADE's law: Coulomb friction, on the reference and with the stiffness of our law."""
        phys, law = self.phys, self.law
        phys.isCohesive, phys.FnMax, phys.FsMax, phys.tanFrictionAngle = False, 0.0, 0.0, law.mu
        phys.kn, phys.ks, phys.initD = law.kn, law.kt, self.length - self.bond.un_plastic


def _lost(interaction):
    """True if a body of the contact has been erased: neither a YADE interaction nor the container of them will say so."""
    bodies = O.bodies
    return bodies[interaction.id1] is None or bodies[interaction.id2] is None


def _set_domain(phys, domain):
    """Make YADE's law that of the elastic_domain."""
    phys.kn, phys.ks, phys.tanFrictionAngle = domain.kn, domain.kt, -domain.slope
    phys.FnMax, phys.FsMax = min(domain.Fn, UNLIMITED), min(domain.Ft, UNLIMITED)
    phys.isCohesive = True

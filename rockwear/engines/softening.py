"""Bonds beyond their elastic domain: a Python bond law gives their force in place of YADE's law."""
import numpy as np

from yade import Vector3

UNLIMITED = 1e30
"""A strength (N) that no bond reaches."""

NO_CHANGE = 1e-13
"""Difference of two forces that is round-off, as a fraction of the force."""


class SofteningBond:
    """A contact whose force a Python bond law gives at each step, in place of the force of YADE's law.

    law, bond: the law and the state of its bond; overlap: penetrationDepth (m) at which the opening is zero; un, Fn:
    opening (m) and normal force (N) of the last step; dissipated: J so far; elastic_steps: steps since it last yielded;
    radii: m, of the particles when YADE's law was released (later thermal expansion does not lengthen the lever arms);
    tensile: True if it broke in tension, False if in shear.

    YADE's contact is kept such that its own law makes the next elastic trial: shearForce is the tangential force, and
    kn, ks and initD are secant values, so that -shearForce/ks is the elastic tangential displacement, which the C++ law
    rotates with the contact and increments. Where nothing yields, the trial is the answer, and nothing is written.
    """

    __slots__ = ("interaction", "geom", "phys", "bodies",
                 "law", "bond", "overlap", "un", "Fn", "dissipated", "elastic_steps", "radii", "tensile")

    def __init__(self, *, law, bond, overlap, un=0.0, Fn=0.0, dissipated=0.0, elastic_steps=0, radii=(0.0, 0.0)):
        self.law, self.bond, self.overlap, self.un, self.Fn = law, bond, overlap, un, Fn
        self.dissipated, self.elastic_steps, self.radii = dissipated, int(elastic_steps), radii

    def connect(self, interaction):
        """Use this contact of the scene that is in O now."""
        self.interaction, self.geom, self.phys = interaction, interaction.geom, interaction.phys
        self.bodies = interaction.id1, interaction.id2

    def release(self):
        """Remove the limits of YADE's law: from now on `advance` gives the force of each step."""
        phys, self.radii = self.phys, (self.geom.refR1, self.geom.refR2)
        phys.isCohesive, phys.FnMax, phys.FsMax, phys.tanFrictionAngle = True, UNLIMITED, UNLIMITED, 0.0
        self.elastic_steps = 0

    def return_to_yade(self):
        """Return the bond to YADE's law, within a new elastic domain. -> True if the bond law has one to give."""
        domain = self.law.elastic_domain(self.bond, self.Fn, self.phys.shearForce.norm())
        if domain:
            set_elastic_domain(self.phys, domain)
        return domain is not None

    def convert_to_friction(self):
        """Leave a broken bond to YADE's law as a contact with Coulomb friction, at the reference overlap and with the
        stiffness of the bond law."""
        phys, law = self.phys, self.law
        phys.isCohesive, phys.FnMax, phys.FsMax, phys.tanFrictionAngle = False, 0.0, 0.0, law.mu
        phys.kn, phys.ks, phys.initD = law.kn, law.kt, self.overlap - self.bond.un_plastic

    def trial(self):
        """Elastic tangential displacement (Vector3, m) in this step if nothing yields."""
        phys = self.phys
        return phys.shearForce * (-1.0 / phys.ks)

    def advance(self, ut, forces):
        """Put this step's force in place of the one that YADE's law has applied.

        ut: as `trial` gives it, m; forces: O.forces.
        -> J dissipated, the work of the forces over the step (trapezoidal rule, as the leapfrog integrator) less the
        gain in stored energy; None where YADE's force stands.
        """
        geom, phys, law, bond = self.geom, self.phys, self.law, self.bond
        normal, increment, penetration = geom.normal, geom.shearInc, geom.penetrationDepth
        un, last, un_plastic = self.overlap - penetration, self.un, bond.un_plastic
        bond.turned(ut, increment)
        Fn, Ft = law.respond(bond, un, (ut[0], ut[1], ut[2]))
        pull, shear = normal * -Fn, Vector3(-Ft[0], -Ft[1], -Ft[2])
        change = pull + shear - phys.normalForce - phys.shearForce
        before, self.un, self.Fn = self.Fn, un, Fn
        if bond.softening < 1.0:
            if change.squaredNorm() <= NO_CHANGE**2 * (Fn * Fn + shear.squaredNorm()):
                return None
        else:
            self.tensile = law.kn * (un - un_plastic) / law.Rn >= law.kt * ut.norm() / law.Rt
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
        phys.initD = self.overlap - bond.un_plastic
        force = shear.norm()
        if force > 0.0:
            phys.ks = force / elastic.norm()
        if Fn != 0.0:
            phys.kn = Fn / (un - bond.un_plastic)
        return 0.5 * (work + released - stored)


def set_elastic_domain(phys, domain):
    """Make the limits of YADE's law those of the elastic domain."""
    phys.kn, phys.ks, phys.tanFrictionAngle = domain.kn, domain.kt, -domain.slope
    phys.FnMax, phys.FsMax = min(domain.Fn, UNLIMITED), min(domain.Ft, UNLIMITED)
    phys.isCohesive = True


def to_rows(softening_bonds, scalars):
    """A row of numbers for each bond of {number: SofteningBond}; scalars: names of those in the state of a bond."""
    rows = [(n, s.overlap, s.un, s.Fn, s.dissipated, s.elastic_steps, *s.radii,
             *(getattr(s.bond, name) for name in scalars)) for n, s in softening_bonds.items()]
    return np.array(rows, float).reshape(-1, 8 + len(scalars))


def from_rows(rows, laws):
    """{number: SofteningBond} of what `to_rows` gave; laws: of all bonds."""
    found = {}
    for n, overlap, un, Fn, dissipated, elastic_steps, radius_1, radius_2, *values in rows.tolist():
        law = laws[int(n)]
        bond = law.initial_state()
        for name, value in zip(bond.scalars, values):
            setattr(bond, name, value)
        found[int(n)] = SofteningBond(law=law, bond=bond, overlap=overlap, un=un, Fn=Fn, dissipated=dissipated,
                                      elastic_steps=elastic_steps, radii=(radius_1, radius_2))
    return found

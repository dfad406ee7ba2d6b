"""Building blocks of scenes: what is put into YADE, and how."""
import math

import numpy as np
from yade import (Bo1_Sphere_Aabb, ForceResetter, FrictMat, FrictViscoMat, Ig2_Sphere_Sphere_ScGeom,
                  InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys,
                  Ip2_FrictMat_FrictViscoMat_FrictViscoPhys, Ip2_JCFpmMat_JCFpmMat_JCFpmPhys, JCFpmMat,
                  Law2_ScGeom_FrictPhys_CundallStrack, Law2_ScGeom_FrictViscoPhys_CundallStrackVisco,
                  Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM, MatchMaker, NewtonIntegrator, O, utils)

from . import engines

ROCK_MASK, TOOL_MASK = 1, 3
"""Bodies meet where masks share a bit; bit 2 is avoided within the tool."""


def exactly(value):
    """A constant of a contact, whatever the materials say."""
    return MatchMaker(algo="val", val=value)


def put_materials(*, mu, tool_mu, contact_damping):
    """The three materials of a cut: rock while it is bonded, rock afterwards, and the tool.

    Rock changes its material after bonding: a bond stays the bond it is, and every later contact is a plain Coulomb
    contact. Stiffness is given by the contact laws, not by these.
    """
    O.materials.append(JCFpmMat(type=1, young=1e9, poisson=1.0, frictionAngle=0.0, density=1.0, tensileStrength=1.0,
                                cohesion=1.0, label="bonding rock"))
    O.materials.append(FrictMat(young=1e9, poisson=0.3, frictionAngle=math.atan(mu), density=1.0, label="loose rock"))
    O.materials.append(FrictViscoMat(young=1e9, poisson=0.3, frictionAngle=math.atan(tool_mu), density=1.0,
                                     betan=contact_damping, label="steel"))


def put_rock(rock):
    """The specimen's particles as bodies 0..n-1, its supported ones held."""
    for position, radius, mass, inertia, held in zip(rock.positions.tolist(), rock.radii.tolist(), rock.masses.tolist(),
                                                     rock.inertias.tolist(), rock.supported):
        body = finite_disc(position, radius, material="bonding rock", mask=ROCK_MASK, mass=mass, inertia=inertia)
        if held:
            body.state.blockedDOFs = "xyzXYZ"
        O.bodies.append(body)


def put_loop(*, kn, kt, mu, tool_kn, tool_kt, tool_mu):
    """YADE's own loop: bonds, rock on rock, tool on rock (M 4.5), explicit integration without numerical damping."""
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], avoidSelfInteractionMask=2),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1),
             Ip2_FrictMat_FrictMat_FrictPhys(kn=exactly(kn), ks=exactly(kt), frictAngle=exactly(math.atan(mu))),
             Ip2_FrictMat_FrictViscoMat_FrictViscoPhys(kn=exactly(tool_kn), kRatio=exactly(tool_kt / tool_kn),
                                                       frictAngle=exactly(math.atan(tool_mu)))],
            [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(neverErase=True),
             Law2_ScGeom_FrictPhys_CundallStrack(traceEnergy=True),
             Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True)]),
        NewtonIntegrator(damping=0.0)]


def make_bonds(rock, bonds):
    """Bond the pairs of the specimen, stress-free as they lie (one step of no length), and end the bonding."""
    for i, j in rock.pairs.tolist():
        utils.createInteraction(i, j)
    O.dt = 0.0
    O.step()
    bonds.bond()
    loose = O.materials["loose rock"]
    for i in range(rock.count):
        O.bodies[i].mat = loose


def finite_disc(position, radius, *, material, mask, mass, inertia):
    """A disc of unit thickness: a YADE sphere that stays in the plane, with a disc's mass and inertia."""
    body = utils.sphere((*position, 0.0), radius, material=material, mask=mask)
    body.state.mass, body.state.inertia = mass, (inertia,) * 3
    body.state.blockedDOFs = "zXY"
    return body


class ToolBodies:
    """The tool's skin in YADE: only these particles take part in contact detection.

    They hold no mass: the tool is led, and no kinetic energy of it enters the audit.
    """

    def __init__(self, tool, velocity):
        self.tool, self.velocity = tool, velocity
        self.count = tool.count
        self.body_of = {}
        self.ids = []
        self.offset = np.zeros(2)

    def connect(self):
        """Follow YADE: where the tool is now."""
        if self.body_of:
            index, body = next(iter(self.body_of.items()))
            self.offset = np.array(O.bodies[body].state.pos)[:2] - self.tool.positions[index]

    def add(self, indices):
        """Put particles `indices` of the tool into YADE, where the tool is now."""
        self.connect()
        for index in indices:
            body = finite_disc(self.tool.positions[index] + self.offset, float(self.tool.radii[index]), material="steel",
                               mask=TOOL_MASK, mass=0.0, inertia=0.0)
            body.state.blockedDOFs = "xyzXYZ"
            body.state.vel = (*self.velocity, 0.0)
            self.body_of[int(index)] = O.bodies.append(body)
        self.ids = list(self.body_of.values())

    def erase(self, indices):
        """Take particles out of YADE. -> strain energy (J) of the contacts that vanish with them."""
        self.connect()
        energy = 0.0
        for index in indices:
            body = self.body_of.pop(int(index), None)
            if body is None:
                continue
            energy += engines.contact_energy(O.interactions.withBody(body))
            O.bodies.erase(body)
        self.ids = list(self.body_of.values())
        return energy

    def state(self):
        """Which body is which particle."""
        return {"bodies": np.array(list(self.body_of.items()), int).reshape(-1, 2), "offset": self.offset.copy()}

    def restore(self, state):
        """Take back what `state` gave."""
        self.body_of = {int(i): int(body) for i, body in state["bodies"]}
        self.ids = list(self.body_of.values())
        self.offset = state["offset"].copy()

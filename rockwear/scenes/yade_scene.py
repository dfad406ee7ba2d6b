"""Building blocks of scenes: what is put into YADE, and how."""
import math
from contextlib import contextmanager

import numpy as np
from yade import (
    Bo1_Facet_Aabb, Bo1_Sphere_Aabb, CpmMat, ForceResetter, FrictMat, FrictViscoMat, Ig2_Facet_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop, Ip2_CpmMat_CpmMat_CpmPhys,
    Ip2_FrictMat_FrictMat_FrictPhys, Ip2_FrictMat_FrictViscoMat_FrictViscoPhys,
    Ip2_FrictViscoMat_FrictViscoMat_FrictViscoPhys, Ip2_JCFpmMat_JCFpmMat_JCFpmPhys,
    Ip2_ViscElMat_ViscElMat_ViscElPhys, JCFpmMat, Law2_ScGeom_CpmPhys_Cpm, Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_FrictViscoPhys_CundallStrackVisco, Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM,
    Law2_ScGeom_ViscElPhys_Basic, MatchMaker, NewtonIntegrator, O, log, utils)

from rockwear.engines import access
from rockwear.engines.bonds import Bonds
from rockwear.engines.cpm_bonds import CpmBonds

# It would call it a bug that its lists of bodies are off; see Scene._refresh_bounds.
log.setLevel("BodyContainer", log.ERROR)

CARRIERS = {"JCFpm": Bonds, "Cpm": CpmBonds}
"""{law of YADE that carries the bonds: engine}."""
ROCK_MASK, TOOL_MASK = 13, 15
"""Bodies meet where masks share a bit; bit 2 is avoided within the tool."""
SIDE_MASKS = ROCK_MASK, 4, 8
"""Of rock by its side of a cut: none, and the two that do not meet."""


BONDING = 1, 2
"""Steps before which contacts of bonding rock are bonds: JCFpm's, CPM's."""


def exactly(value):
    """A constant of a contact, whatever the materials say."""
    return MatchMaker(algo="val", val=value)


def bonding_material(yade_law):
    """The material of rock while it is bonded; `Bonds.bond` gives each bond its own constants."""
    if yade_law == "Cpm":
        return CpmMat(young=1e9, poisson=1.0, frictionAngle=0.0, density=1.0, sigmaT=1.0, epsCrackOnset=1.0,
                      relDuctility=10.0, damLaw=0, label="bonding rock")
    return JCFpmMat(type=1, young=1e9, poisson=1.0, frictionAngle=0.0, density=1.0, tensileStrength=1.0, cohesion=1.0,
                    label="bonding rock")


def put_rock_materials(*, mu, loose=FrictMat, yade_law="JCFpm"):
    """Rock while it is bonded, and rock afterwards.

    Rock changes its material after bonding: a bond stays the bond it is, and every later contact is a plain Coulomb
    contact. Stiffness is given by the contact laws, not by these. loose: FrictViscoMat beside a tool of facets;
    yade_law: of kernels.bond_laws.
    """
    O.materials.append(bonding_material(yade_law))
    O.materials.append(loose(young=1e9, poisson=0.3, frictionAngle=math.atan(mu), density=1.0, label="loose rock"))


def put_tool_material(*, mu, contact_damping):
    """The tool's material, its friction and dashpot."""
    O.materials.append(FrictViscoMat(young=1e9, poisson=0.3, frictionAngle=math.atan(mu), density=1.0,
                                     betan=contact_damping, label="steel"))


def put_rock(rock):
    """The specimen's particles as bodies 0..n-1, its fixed ones without degrees of freedom."""
    columns = (rock.places.tolist(), rock.radii.tolist(), rock.masses.tolist(), rock.inertias.tolist(), rock.fixed,
               rock.side.tolist())
    for position, radius, mass, inertia, fixed, side in zip(*columns):
        particle = finite_disc if len(position) == 2 else sphere
        body = particle(position, radius, material="bonding rock", mask=SIDE_MASKS[side], mass=mass, inertia=inertia)
        if fixed:
            body.state.blockedDOFs = access.FIXED
        O.bodies.append(body)


def put_loop(*, rock, tool=None, damping=0.0, ratcheting_free=True):
    """YADE's own loop: bonds, rock on rock, tool on rock [Rojek 2003, 4.5], explicit integration.

    rock: kn, kt (N/m) and mu of contacts within the rock, a bond law or the like; tool: those of its contacts, None
    without a tool; damping: non-viscous (Cundall's), a fraction of each force; ratcheting_free: shear between spheres
    by their full radii, YADE's way, which does not see where they really touch (kernels.stability); False: as the
    points of contact move, so that the springs give back what they took.
    """
    parameters = [Ip2_FrictMat_FrictMat_FrictPhys(kn=exactly(rock.kn), ks=exactly(rock.kt),
                                                  frictAngle=exactly(math.atan(rock.mu)))]
    laws = [Law2_ScGeom_FrictPhys_CundallStrack()]
    if tool:
        parameters.append(Ip2_FrictMat_FrictViscoMat_FrictViscoPhys(
            kn=exactly(tool.kn), kRatio=exactly(tool.kt / tool.kn), frictAngle=exactly(math.atan(tool.mu))))
        laws.append(Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True))
    geometry = [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=ratcheting_free)]
    _put_engines([Bo1_Sphere_Aabb()], geometry, parameters, laws, damping)


def put_loop_with_facets(*, rock, tool, damping=0.0, ratcheting_free=True):
    """The same beside a tool of facets.

    YADE puts a facet first into its contacts, and has no functor for (tool, rock) in this order. Tool and loose rock
    are of one kind here, FrictViscoMat, and the constants go by the pair of materials; rock has no dashpot. One law
    then keeps one sum of plastic dissipation, which engines.facet_contact divides.

    A loaded scene looks again for the functor of each contact it has, by the materials of now: of loose rock and its
    support of a boundary it finds the last one, which leaves a contact as it is.
    """
    loose, steel = O.materials["loose rock"].id, O.materials["steel"].id

    def by_pair(of_rock, of_tool):
        return MatchMaker(matches=((loose, loose, of_rock), (loose, steel, of_tool)))

    parameters = [Ip2_FrictViscoMat_FrictViscoMat_FrictViscoPhys(
        kn=by_pair(rock.kn, tool.kn), kRatio=by_pair(rock.kt / rock.kn, tool.kt / tool.kn),
        frictAngle=by_pair(math.atan(rock.mu), math.atan(tool.mu))), Ip2_FrictMat_FrictMat_FrictPhys()]
    geometry = [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=ratcheting_free), Ig2_Facet_Sphere_ScGeom()]
    _put_engines([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], geometry, parameters,
                 [Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True)], damping)


def bond_loop(geometry, parameters=(), laws=()):
    """InteractionLoop for bonds of either YADE law and for supports of a boundary, beside other contacts."""
    return InteractionLoop(
        geometry, [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=BONDING[0]),
                   Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=BONDING[1]), Ip2_ViscElMat_ViscElMat_ViscElPhys(),
                   *parameters],
        [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(neverErase=True), Law2_ScGeom_CpmPhys_Cpm(),
         Law2_ScGeom_ViscElPhys_Basic(), *laws])


def _put_engines(bounds, geometry, parameters, laws, damping):
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(bounds, avoidSelfInteractionMask=2),
        bond_loop(geometry, parameters, laws),
        NewtonIntegrator(damping=damping)]


def bonds_engine(rock, law, clock, **options):
    """The engine of a rock's bonds, for the carrier that their law asks for. options: of that carrier."""
    return CARRIERS[law.yade_law](pairs=rock.pairs, law=law, laws=rock.laws, clock=clock, **options)


def make_bonds(rock, bonds):
    """Bond the pairs of the specimen, stress-free as they lie (one step of no length), and end the bonding."""
    bonds.begin(rock.bonded)
    for i, j in rock.pairs[rock.bonded].tolist():
        utils.createInteraction(i, j)
    O.dt = 0.0
    O.step()
    bonds.bond(np.flatnonzero(rock.bonded))
    loose = O.materials["loose rock"]
    for i in range(rock.count):
        O.bodies[i].mat = loose


@contextmanager
def standing_still():
    """Steps within are of no length and call no engine of ours: contacts and their forces alone are made anew."""
    engines, time_step = O.engines, O.dt
    access.put_engines([ForceResetter(), access.yade_engine(InteractionLoop)])
    O.dt = 0.0
    try:
        yield
    finally:
        access.put_engines(engines)
        O.dt = time_step


def bond_again(rock, numbers):
    """Bond these pairs (k,) of the rock in a scene that runs and stands still, without force as they lie."""
    ends = np.unique(rock.pairs[numbers]).tolist()
    bonding, loose = O.materials["bonding rock"], O.materials["loose rock"]
    cohesive = [access.parameter_functor(Ip2_JCFpmMat_JCFpmMat_JCFpmPhys),
                access.parameter_functor(Ip2_CpmMat_CpmMat_CpmPhys)]
    # YADE's loop cannot make a contact in a loaded scene before its first step.
    O.step()
    for body in ends:
        O.bodies[body].mat = bonding
    cohesive[0].cohesiveTresholdIteration = cohesive[1].cohesiveThresholdIter = -1
    for i, j in rock.pairs[numbers].tolist():
        utils.createInteraction(i, j)
    cohesive[0].cohesiveTresholdIteration, cohesive[1].cohesiveThresholdIter = BONDING
    O.step()
    for body in ends:
        O.bodies[body].mat = loose


def finite_disc(position, radius, *, material, mask, mass, inertia):
    """A disc of unit thickness: a YADE sphere that stays in the plane, with a disc's mass and inertia."""
    body = sphere((*position, 0.0), radius, material=material, mask=mask, mass=mass, inertia=inertia)
    body.state.blockedDOFs = access.IN_PLANE
    return body


def sphere(position, radius, *, material, mask, mass, inertia):
    """A sphere in space."""
    body = utils.sphere(position, radius, material=material, mask=mask)
    body.state.mass, body.state.inertia = mass, (inertia,) * 3
    return body

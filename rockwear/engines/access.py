"""YADE's own objects in the scene that is in O: engines, functors, contacts.

Of a sequence that YADE is given, as a vector of engines or of numbers, it keeps a reference to each element for good.
What is given again and again is therefore given through this module: `put_engines`, `contact_of`, `states`.
"""
import ctypes
import sys
from functools import cache

import numpy as np
from yade import (
    Bo1_Sphere_Aabb, BoundDispatcher, InteractionLoop, Law2_ScGeom_FrictViscoPhys_CundallStrackVisco, NewtonIntegrator,
    O, Sphere, Subdomain)

from rockwear.engines.memory import MEMORY, WORDS, kernel_layout, list_of_bodies
from rockwear.kernels import compiled
from rockwear.kernels.files import require_room

MOST_BYTES = 300
"""Of a body or a contact in a saved scene: 116 to 167 in one of bonded discs."""

IN_PLANE, IN_PLANE_WITHOUT_TURNING, FIXED = "zXY", "zXYZ", "xyzXYZ"
"""Degrees of freedom that YADE blocks: of particles in the plane, of such that do not turn, of bodies that do not move
by themselves."""


def yade_engine(kind):
    """YADE's engine of the type `kind` in the scene that is in O now."""
    return next(engine for engine in O.engines if isinstance(engine, kind))


def law_functor(kind):
    """The contact law of the type `kind` in the scene that is in O now."""
    functors = yade_engine(InteractionLoop).lawDispatcher.functors
    return next(functor for functor in functors if isinstance(functor, kind))


def geometry_functor(kind):
    """The contact geometry of the type `kind` in the scene that is in O now."""
    functors = yade_engine(InteractionLoop).geomDispatcher.functors
    return next(functor for functor in functors if isinstance(functor, kind))


def parameter_functor(kind):
    """What makes the constants of contacts, of the type `kind`, in the scene that is in O now."""
    functors = yade_engine(InteractionLoop).physDispatcher.functors
    return next(functor for functor in functors if isinstance(functor, kind))


def yade_friction_law():
    """The contact law that sums up plastic dissipation."""
    return law_functor(Law2_ScGeom_FrictViscoPhys_CundallStrackVisco)


@cache
def _kept():
    """How many references YADE keeps to each element of a sequence that it is given: 1 in 2023.02 and 2025.2, where
    its converter does not give back what it takes them by."""
    one = Bo1_Sphere_Aabb()
    before = sys.getrefcount(one)
    BoundDispatcher([one])
    return sys.getrefcount(one) - before


def put_engines(engines):
    """O.engines = engines, so that those that leave the loop are freed: a collider holds 192 bytes a body."""
    O.engines = engines
    for engine in engines:
        for _ in range(_kept()):
            ctypes.pythonapi.Py_DecRef(ctypes.py_object(engine))


@cache
def _the_one(number):
    """The first integer that was equal to this one: what YADE keeps of it costs nothing more."""
    return number


def contact_of(first, second):
    """YADE's contact of two bodies, found or possible."""
    return O.interactions[_the_one(first), _the_one(second)]


def states(bodies):
    """(k, 13) place (m), velocity (m/s), angular velocity (rad/s) and orientation of these bodies, integers, in YADE
    now, by its one bulk read."""
    values = Subdomain().getStateValuesFromIds(list(map(_the_one, bodies)))
    return np.fromiter(values, float).reshape(len(bodies), 13)


def collide_next_step():
    """Have the collider run in the very next step, as it does in a loaded scene.

    Otherwise it waits until some particle leaves its bounds, and contacts are missed meanwhile. A fastest velocity of
    zero makes it run.
    """
    yade_engine(NewtonIntegrator).maxVelocitySq = 0.0


def body_erased(interaction):
    """True if a body of the interaction has been erased; neither the interaction nor O.interactions tells."""
    bodies = O.bodies
    return bodies[interaction.id1] is None or bodies[interaction.id2] is None


def overlap_of_spheres(interaction):
    """Overlap (m) of two spheres at their present positions; of other shapes, as YADE last found it."""
    first, second = O.bodies[interaction.id1], O.bodies[interaction.id2]
    if not (isinstance(first.shape, Sphere) and isinstance(second.shape, Sphere)):
        return interaction.geom.penetrationDepth
    # A loaded scene has no penetrationDepth before its first step.
    return first.shape.radius + second.shape.radius - (second.state.pos - first.state.pos).norm()


def contact_energy(interactions, overlap=overlap_of_spheres):
    """Strain energy (J) of contacts that are no bonds, sum of kn un^2/2 + Ft^2/2kt.

    Dashpots store none, nor do contacts that have just opened: YADE erases them in the next step, with their tangential
    force. (YADE's own elasticEnergy() needs a step since the scene was loaded, and takes a dashpot's force for a
    spring's.)
    """
    energy = 0.0
    for i in interactions:
        depth = overlap(i)
        if depth > 0:
            energy += 0.5 * (i.phys.kn * depth**2 + i.phys.shearForce.squaredNorm() / i.phys.ks)
    return energy


def rock_states(rock):
    """(n, 13) `states` of the specimen's particles in YADE now."""
    return states(range(rock.count))


def rock_positions(rock):
    """(n, d) m of the specimen's particles in YADE now, nan of one that has been erased."""
    found = compiled.positions(MEMORY, WORDS, kernel_layout(), list_of_bodies(), rock.count)
    return found[:, :rock.positions.shape[1]]


def damped_energy():
    """J that non-viscous damping has taken since YADE tracks energy."""
    return O.energy["nonviscDamp"] if "nonviscDamp" in O.energy.keys() else 0.0


def save(path):
    """Save YADE's scene to `path`. Raises OSError where the disk has no room for it."""
    # On a full disk YADE would try again without end.
    require_room(path.parent, MOST_BYTES * (len(O.bodies) + O.interactions.countReal()))
    O.save(str(path))

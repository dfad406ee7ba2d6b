"""YADE's own objects in the scene that is in O: engines, functors, contacts."""
from yade import InteractionLoop, Law2_ScGeom_FrictViscoPhys_CundallStrackVisco, NewtonIntegrator, O, Sphere


SLIDING = 1 - 1e-9
"""|Ft| / mu |Fn| from which a contact slid in this step: YADE's laws return it to Coulomb's limit to round-off. (A looser
test takes contacts that only tremble near the limit for sliding, and their work piles up.)"""


def yade_engine(kind):
    """YADE's engine of the type `kind` in the scene that is in O now."""
    return next(engine for engine in O.engines if isinstance(engine, kind))


def law_functor(kind):
    """The contact law of the type `kind` in the scene that is in O now."""
    return next(functor for functor in yade_engine(InteractionLoop).lawDispatcher.functors if isinstance(functor, kind))


def geometry_functor(kind):
    """The contact geometry of the type `kind` in the scene that is in O now."""
    return next(functor for functor in yade_engine(InteractionLoop).geomDispatcher.functors if isinstance(functor, kind))


def collide_next_step():
    """Have the collider run in the very next step, as it does in a loaded scene.

    Left to itself it would wait until some particle leaves its bounds, and contacts would be missed meanwhile. What
    asks it to is a fastest velocity of zero.
    """
    yade_engine(NewtonIntegrator).maxVelocitySq = 0.0


def overlap_of_spheres(interaction):
    """Overlap (m) of two spheres as they lie; of other shapes, as YADE last found it."""
    first, second = O.bodies[interaction.id1], O.bodies[interaction.id2]
    if not (isinstance(first.shape, Sphere) and isinstance(second.shape, Sphere)):
        return interaction.geom.penetrationDepth
    # A loaded scene has no penetrationDepth before its first step.
    return first.shape.radius + second.shape.radius - (second.state.pos - first.state.pos).norm()


def contact_energy(interactions, overlap=overlap_of_spheres):
    """Strain energy (J) of contacts that are no bonds, sum of kn un^2/2 + Ft^2/2kt; dashpots store none, nor do contacts
    that have just opened: YADE drops them in the next step, and their tangential force with them.

    (YADE's own elasticEnergy() needs a step since the scene was loaded, and counts the dashpots' force as a spring's.)
    """
    energy = 0.0
    for i in interactions:
        depth = overlap(i)
        if depth > 0:
            energy += 0.5 * (i.phys.kn * depth**2 + i.phys.shearForce.squaredNorm() / i.phys.ks)
    return energy


def yade_friction_law():
    """The contact law that keeps YADE's account of friction."""
    return law_functor(Law2_ScGeom_FrictViscoPhys_CundallStrackVisco)

"""Engines: what hangs into YADE's loop. An engine knows what one visit does; PyRunner knows when it comes.

YADE keeps PyRunner commands as strings, so that a saved scene survives a new process: the string names an engine,
and the table of live engines below finds it.
"""
from time import perf_counter

from yade import InteractionLoop, NewtonIntegrator, O, PyRunner, Sphere

_live = {}
failures = []
"""What engines raised inside YADE's loop, which would otherwise lose it."""


SLIDING = 1 - 1e-9
"""|Ft| / mu |Fn| from which a contact slid in this step: YADE's laws return it to Coulomb's limit to round-off. (A looser
test takes contacts that only tremble near the limit for sliding, and their work piles up.)"""


class Engine:
    """One visit in `act`; `state`/`restore` carry what must survive a restart; `log` names what a recorder may write."""

    name = None
    """The name under which PyRunner finds the engine."""

    def __init__(self):
        self.last_iteration = O.iter
        self.wall_time = 0.0
        self.visits = 0

    def act(self):
        """One visit, at the present step."""
        raise NotImplementedError(f"{type(self).__name__} has no visit")

    def elapsed(self):
        """Seconds of the simulation since the last call. (PyRunner may come late or early: nobody assumes its period.)"""
        steps = O.iter - self.last_iteration
        self.last_iteration = O.iter
        return steps * O.dt

    def connect(self):
        """Find YADE's objects again: the scene in O has just been built or loaded."""

    def state(self):
        """What must survive a restart: a dict of numbers, copied arrays, and dicts of them."""
        return {}

    def restore(self, state):
        """Take back what `state` gave."""

    def log(self):
        """{name: (value, unit)} of what may be recorded now."""
        return {}


def fire(*names):
    """One visit of each of the named engines, its wall time counted. PyRunner calls this."""
    for name in names:
        engine = _live[name]
        begin = perf_counter()
        try:
            engine.act()
        except Exception as error:
            failures.append(error)
            O.pause()
        engine.wall_time += perf_counter() - begin
        engine.visits += 1


def enlist(engines):
    """Make these engines, and no others, the ones that `fire` finds."""
    _live.clear()
    failures.clear()
    _live.update({engine.name: engine for engine in engines})


def runners(periods):
    """PyRunners that visit engines at their periods: {name: steps}, in order. Engines of one period share a runner,
    for a runner's own cost is that of several short visits."""
    groups = {}
    for name, period in periods.items():
        groups.setdefault(int(period), []).append(name)
    return [PyRunner(command=f"import rockwear.engines; rockwear.engines.fire({', '.join(map(repr, names))})",
                     iterPeriod=period) for period, names in groups.items()]


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

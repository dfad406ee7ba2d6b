"""Python engines in YADE's loop: what a visit does, in which phase of the step it comes, what survives a restart."""
import sys
from abc import ABC, abstractmethod
from functools import partial
from time import perf_counter

from yade import O, PyRunner

PHASES = START, FORCES, MOTION = "start", "forces", "motion"
"""Phases of a step: before its forces; after the forces and before the integrator; after the integrator."""

_registered = {}

failures = []
"""Exceptions of engines, which YADE's loop would otherwise lose."""

yade_time = 0.0
"""Wall time (s) of YADE's own engines in `run`, by YADE's clocks; what runners of Python cost beside the engines that
they call is not in it."""


class Engine(ABC):
    """One visit in `act`; `state`/`restore` carry what must survive a restart; `log` names what a recorder may write.

    period: steps between visits; None: YADE's loop never calls this engine.
    """

    name = None
    """The name by which `call` finds the engine, unique in a scene."""
    phase = MOTION

    def __init__(self, *, period=1):
        self.period = period
        self.last_iteration = O.iter
        self.wall_time = 0.0
        self.visits = 0

    @abstractmethod
    def act(self):
        """One visit, at the present step."""

    def elapsed(self):
        """Simulated seconds since the last call; a visit may come earlier or later than the period says."""
        steps = O.iter - self.last_iteration
        self.last_iteration = O.iter
        return steps * O.dt

    def connect(self):
        """Find YADE's objects: the scene in O has just been built or loaded."""

    def state(self):
        """What must survive a restart: a dict of numbers, strings, copied arrays, and dicts of them."""
        return {}

    def restore(self, state):
        """Set what `state` gave."""

    def log(self):
        """{name: (value, unit)} of what may be recorded now."""
        return {}


def call(*names):
    """One visit of each of the named engines; adds to their wall times. Commands of PyRunners call this."""
    for name in names:
        engine = _registered[name]
        begin = perf_counter()
        try:
            engine.act()
        except Exception as error:
            failures.append(error)
        engine.wall_time += perf_counter() - begin
        engine.visits += 1


def register(engines):
    """Make these engines, and no others, the ones that `call` finds, also from the runners of a loaded scene."""
    _registered.clear()
    failures.clear()
    _registered.update({engine.name: engine for engine in engines})
    for phase in PHASES:
        for names in _groups(engines, phase).values():
            _command(names)


def insert(engines):
    """Insert PyRunners of these engines into O.engines, whose last one is the integrator, by phase and period.

    Within a phase engines keep their order; those of one period share a runner, at the place of the first of them,
    because a runner alone costs as much as several short visits.
    """
    start, forces, motion = ([PyRunner(command=_command(names), iterPeriod=period, updateGlobals=False)
                              for period, names in _groups(engines, phase).items()]
                             for phase in PHASES)
    O.engines = start + O.engines[:-1] + forces + O.engines[-1:] + motion


def _groups(engines, phase):
    """{period: names} of the engines of a phase."""
    groups = {}
    for engine in engines:
        if engine.phase == phase and engine.period:
            groups.setdefault(int(engine.period), []).append(engine.name)
    return groups


def _command(names):
    """What a runner of these engines runs. YADE reads it anew at every visit, as a statement of its main module: a call
    without arguments takes half the time of one that has the names in it."""
    function = "_".join(("visit", *names))
    setattr(sys.modules["__main__"], function, partial(call, *names))
    return f"{function}()"


def run(steps):
    """Run YADE's loop for so many steps. Raises what an engine raised, RunEnded among it.

    (O.run waits in slices of 40 ms, which a short run would spend asleep.)
    """
    global yade_time
    O.timingEnabled = True
    native = [engine for engine in O.engines if not isinstance(engine, PyRunner)]
    before = sum(engine.execTime for engine in native)
    try:
        for _ in range(steps):
            O.step()
            if failures:
                raise failures.pop()
    finally:
        yade_time += 1e-9 * (sum(engine.execTime for engine in native) - before)


class RunEnded(Exception):
    """The run cannot or need not go on; str() is one line. `healthy` tells a result from a failure."""

    def __init__(self, message, healthy):
        super().__init__(message)
        self.healthy = healthy

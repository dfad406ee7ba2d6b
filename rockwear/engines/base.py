"""Python engines and YADE's loop: what a visit does, whether it comes within a step, what survives a restart."""
import sys
from abc import ABC, abstractmethod
from functools import partial
from time import perf_counter

from yade import O, PyRunner

FORCES, BETWEEN = "forces", "between steps"
"""When a visit comes: within a step, after its forces and before the integrator, by a PyRunner in YADE's loop; or
between two steps, from `run`. A PyRunner takes 10 to 40 us beside what it runs, so that within a step comes only what
adds to its forces or changes what its integrator takes."""

_registered = {}
_between = []
"""(steps between visits, function that makes them) of the engines that come between steps."""

failures = []
"""Exceptions of engines, which YADE's loop would otherwise lose."""

yade_time = 0.0
"""Wall time (s) of YADE's own engines in `run`, by YADE's clocks; what runners of Python cost beside the engines that
they call is not in it."""


class Engine(ABC):
    """One visit in `act`; `state`/`restore` carry what must survive a restart; `log` names what a recorder may write.

    period: steps between visits; None: there are none.
    """

    name = None
    """The name by which `call` finds the engine, unique in a scene."""
    phase = BETWEEN

    def __init__(self, *, period=1):
        self.period = period
        self.last_iteration = O.iter
        self.wall_time = 0.0
        self.visits = 0

    @abstractmethod
    def act(self):
        """One visit, at the present step."""

    def start_clock(self):
        """The next step is the first that counts for `elapsed`."""
        # A runner sits out its first step.
        self.last_iteration = O.iter - (self.phase == FORCES)

    @property
    def since(self):
        """s by which bodies have moved on, at a visit, since the forces of the step."""
        return 0.0 if self.phase == FORCES else O.dt

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
    """One visit of each of the named engines; adds to their wall times."""
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
    """Make these engines, and no others, the ones that are visited, also by the runners of a loaded scene."""
    _registered.clear()
    failures.clear()
    _registered.update({engine.name: engine for engine in engines})
    _between[:] = [(period, partial(call, *names)) for period, names in _groups(engines, BETWEEN).items()]
    for names in _groups(engines, FORCES).values():
        _command(names)


def insert(engines):
    """Insert PyRunners of those of these engines that come within a step into O.engines, whose last one is the
    integrator.

    They keep their order; those of one period share a runner, at the place of the first of them, because a runner alone
    costs as much as several short visits.
    """
    runners = [PyRunner(command=_command(names), iterPeriod=period, updateGlobals=False)
               for period, names in _groups(engines, FORCES).items()]
    O.engines = O.engines[:-1] + runners + O.engines[-1:]


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


def run(steps, skipped=0):
    """Run YADE's loop for so many steps, and visit the engines that come between them. Raises what an engine raised,
    RunEnded among it.

    skipped: steps that YADE has counted and that count for no period. (O.run waits in slices of 40 ms, which a short
    run would spend asleep.)
    """
    global yade_time
    O.timingEnabled = True
    native = [engine for engine in O.engines if not isinstance(engine, PyRunner)]
    before = sum(engine.execTime for engine in native)
    begin = O.iter - skipped
    try:
        for step in range(begin + 1, begin + steps + 1):
            O.step()
            for period, visit in _between:
                if step % period == 0:
                    visit()
            if failures:
                raise failures[0]
    finally:
        yade_time += 1e-9 * (sum(engine.execTime for engine in native) - before)


class RunEnded(Exception):
    """The run cannot or need not go on; str() is one line. `healthy` tells a result from a failure."""

    def __init__(self, message, healthy):
        super().__init__(message)
        self.healthy = healthy

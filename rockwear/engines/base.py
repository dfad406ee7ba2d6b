"""An engine of ours in YADE's loop: what a visit does, in which phase of the step it comes, what survives a restart."""
from time import perf_counter

from yade import O, PyRunner


_live = {}

failures = []
"""What engines raised inside YADE's loop, which would otherwise lose it."""


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


def register(engines):
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
    return [PyRunner(command=f"import rockwear.engines.base; rockwear.engines.base.fire({', '.join(map(repr, names))})",
                     iterPeriod=period) for period, names in groups.items()]


class RunEnded(Exception):
    """The run cannot or need not go on; str() is one line. `healthy` tells a result from a failure."""

    def __init__(self, message, healthy):
        super().__init__(message)
        self.healthy = healthy

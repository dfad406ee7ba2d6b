"""Time series of a run, and the watch over its health."""
import math

import numpy as np
from yade import O, utils

from . import Engine


class RunEnded(Exception):
    """The run cannot or need not go on; str() is one line. `healthy` tells a result from a failure."""

    def __init__(self, message, healthy):
        super().__init__(message)
        self.healthy = healthy


class Recorder(Engine):
    """Rows of named values at a regular interval. `sources`: functions giving {name: (value, unit)}."""

    name = "recorder"

    def __init__(self, sources):
        super().__init__()
        self.sources = sources
        self.header, self.rows = [], []

    def act(self):
        found = [item for source in self.sources for item in source().items()]
        self.header = [f"{name} [{unit}]" for name, (_, unit) in found]
        self.rows.append([value for _, (value, _) in found])

    def columns(self):
        """{name: (rows,) values}."""
        rows = np.array(self.rows, float).reshape(-1, max(1, len(self.header)))
        return {name.split(" [")[0]: rows[:, i] for i, name in enumerate(self.header)}

    def state(self):
        return {"header": list(self.header), "rows": np.array(self.rows, float)}

    def restore(self, state):
        self.header, self.rows = [str(name) for name in state["header"]], state["rows"].tolist()

    def write(self, path):
        """history.csv, a row a visit."""
        write_table(path, self.header, self.rows)


def write_table(path, header, rows):
    """A CSV file: a header of `name [unit]`, then rows of numbers; in place at once or not at all."""
    lines = [",".join(header)] + [",".join(f"{value:.10g}" for value in row) for row in rows]
    temporary = path.with_suffix(".new")
    temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")
    temporary.replace(path)


class Watch(Engine):
    """Ends a run whose energy runs away: kinetic energy far above all the work put in, or not a number.

    work: a function giving the work done on the rock so far (J); floor: J below which nothing is judged.
    """

    name = "watch"
    runaway = 10.0

    def __init__(self, *, work, floor):
        super().__init__()
        self.work, self.floor = work, floor

    def act(self):
        kinetic = utils.kineticEnergy()
        allowed = self.runaway * max(self.work(), self.floor)
        if not math.isfinite(kinetic) or kinetic > allowed:
            raise RunEnded(f"the simulation blew up at t = {O.time:g} s: kinetic energy {kinetic:g} J is not below "
                           f"{allowed:g} J, {self.runaway:g} times the work done; try a smaller time_step_fraction", False)

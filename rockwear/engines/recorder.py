"""Time series of a run."""
from yade import O

from rockwear.engines.base import Engine
from rockwear.engines.history import History


class Recorder(Engine):
    """Rows of named values at a regular interval, the last of a stage at its end (`close`): each source that takes
    `elapsed` covers all time. `sources`: functions giving {name: (value, unit)}.

    history: that of a recorder which this one follows.
    """

    name = "recorder"

    def __init__(self, sources, *, period=1, history=None):
        super().__init__(period=period)
        self.sources = sources
        self.history = history or History()

    def act(self):
        found = [item for source in self.sources for item in source().items()]
        self.history.append([f"{name} [{unit}]" for name, (_, unit) in found], [value for _, (value, _) in found])

    def close(self):
        """The last row of a stage, unless there is one of this step already."""
        if O.iter > self.last_iteration:
            self.act()

    def columns(self):
        """{name: (rows,) values}."""
        rows = self.history.rows
        return {name.split(" [")[0]: rows[:, i] for i, name in enumerate(self.history.header)}

    def state(self):
        return self.history.state()

    def restore(self, state):
        self.history.restore(state)

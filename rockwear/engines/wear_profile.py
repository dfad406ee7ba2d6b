"""Distribution of wear along the tool's outline."""
import math
import numpy as np

from rockwear.engines.base import Engine


class WearProfile(Engine):
    """Volume worn off each place along the tool's initial outline in each interval between visits, the `increments`:
    what the rules of [Rocky] are judged by.

    A cycle that begins with the same tool and rock as the last one repeats it and gives no new samples: its wear is
    added to the intervals of the last one.

    wear: a WearEngine; place: (m,) number of the place that each piece of its tool belongs to.
    """

    name = "wear_profile"

    def __init__(self, *, wear, place, period=1):
        super().__init__(period=period)
        self.wear, self.place, self.places = wear, place, int(place.max()) + 1
        self.clear()

    def clear(self):
        """Begin a new record."""
        self.increments, self.worn = [], np.zeros(self.places)
        self.interval = self.cycle = 0
        self.shape = math.nan

    def begin_cycle(self, shape):
        """A cycle begins, in the same rock as all cycles. shape: a number that differs where the tool's shape does."""
        if shape == self.shape:
            self.interval = self.cycle
        else:
            self.interval = self.cycle = len(self.increments)
        self.shape = shape

    def act(self):
        now = np.bincount(self.place, self.wear.worn, self.places)
        if self.interval == len(self.increments):
            self.increments.append(np.zeros(self.places))
        self.increments[self.interval] += now - self.worn
        self.interval += 1
        self.worn = now

    def state(self):
        return {"increments": np.array(self.increments).reshape(-1, self.places), "worn": self.worn.copy(),
                "interval": self.interval, "cycle": self.cycle, "shape": self.shape}

    def restore(self, state):
        self.increments, self.worn = list(state["increments"].copy()), state["worn"].copy()
        self.interval, self.cycle, self.shape = int(state["interval"]), int(state["cycle"]), float(state["shape"])

"""Where along the tool's outline wear happens."""
import math
import numpy as np

from rockwear.engines.base import Engine


class WearProfile(Engine):
    """Where along the tool's first outline wear happened, span of time by span: what R's rules are judged by.

    A cycle that begins with the tool and the rock of the last one repeats it and samples nothing new: its wear is added to
    the spans of the last one.

    wear: a WearEngine; place: (m,) number of the place that each piece of its tool belongs to.
    """

    name = "wear_profile"

    def __init__(self, *, wear, place, period=1):
        super().__init__(period=period)
        self.wear, self.place, self.places = wear, place, int(place.max()) + 1
        self.clear()

    def clear(self):
        """Begin a record of nothing."""
        self.increments, self.booked = [], np.zeros(self.places)
        self.span = self.cycle = 0
        self.shape = math.nan

    def begin_cycle(self, shape):
        """A cycle begins, in the rock that all cycles begin in. shape: a number that differs where the tool's shape does."""
        if shape == self.shape:
            self.span = self.cycle
        else:
            self.span = self.cycle = len(self.increments)
        self.shape = shape

    def act(self):
        now = np.bincount(self.place, self.wear.worn, self.places)
        if self.span == len(self.increments):
            self.increments.append(np.zeros(self.places))
        self.increments[self.span] += now - self.booked
        self.span += 1
        self.booked = now

    def state(self):
        return {"increments": np.array(self.increments).reshape(-1, self.places), "booked": self.booked.copy(),
                "span": self.span, "cycle": self.cycle, "shape": self.shape}

    def restore(self, state):
        self.increments, self.booked = list(state["increments"].copy()), state["booked"].copy()
        self.span, self.cycle, self.shape = int(state["span"]), int(state["cycle"]), float(state["shape"])

"""Archard wear of a tool of particles, and the removal of worn particles."""
import math
import numpy as np

from rockwear.engines.base import Engine
from rockwear.kernels.wear_laws import WORK


class WearEngine(Engine):
    """Base of wear of a tool of particles and of facets.

    contact: the ToolContact that gives where and under what force the tool slides; law: of kernels.wear_laws,
    accelerated; hardness: kernels.archard.Hardness; temperature: a function giving (m,) K of the pieces (particles,
    facets); count: of pieces; volume_unit: of what is recorded.

    `events` counts for each piece how often a contact began to slide on it, as far as visits can tell them apart;
    `worn` (count,) is the volume in m3 worn off it by the law, `limit` that at which it is gone: what the rules of
    [Rocky] are judged by.
    """

    name = "wear"

    def __init__(self, *, contact, law, hardness, temperature, count, volume_unit="m3/m", period=1):
        super().__init__(period=period)
        self.contact, self.law, self.volume_unit = contact, law, volume_unit
        self.hardness, self.temperature = hardness, temperature
        self.forget_temperatures()
        self.contact_energy_removed = self.work_used = 0.0
        self.events, self.rubbed = np.zeros(count, int), np.zeros(count, bool)

    def forget_temperatures(self):
        """A new tool has worn at none."""
        self.coldest, self.hottest = math.inf, -math.inf

    def take_slid(self):
        """What slid since the last visit, see ToolContact.take_slid, counted as work and events; None if nothing
        did."""
        slid = self.contact.take_slid()
        rubbed = self.at_places(slid[WORK]) > 0
        self.events += rubbed & ~self.rubbed
        self.rubbed = rubbed
        if not rubbed.any():
            return None
        self.work_used += float(slid[WORK].sum())
        return slid

    def at_places(self, values):
        """What `values` (m,) of the present pieces are for the pieces of the initial shape."""
        return values

    def hardness_now(self, slid):
        """(m,) Pa at the present temperatures, of which those that wear count for `warnings`."""
        temperature = self.temperature()
        worn = temperature[slid[WORK] > 0]
        self.coldest, self.hottest = min(self.coldest, float(worn.min())), max(self.hottest, float(worn.max()))
        return self.hardness.nearest(temperature)

    def warnings(self):
        """A line where worn pieces had temperatures (K) beyond the hardness table."""
        if not self.hardness.leaves(self.coldest, self.hottest):
            return []
        first, last = self.hardness.limits
        return [f"what wore, at {self.coldest:.1f} to {self.hottest:.1f} K, leaves the hardness table "
                f"({first:g} to {last:g} K): the nearest row holds"]

    def state(self):
        return {"contact_energy_removed": self.contact_energy_removed, "work_used": self.work_used,
                "events": self.events.copy(), "rubbed": self.rubbed.copy(),
                "coldest": self.coldest, "hottest": self.hottest}

    def restore(self, state):
        for name in ("contact_energy_removed", "work_used", "coldest", "hottest"):
            setattr(self, name, float(state[name]))
        self.events, self.rubbed = state["events"].copy(), state["rubbed"].copy()


class Wear(WearEngine):
    """Wear with H(theta) by the laws of [Rojek 2003, sec. 6.3-6.4; Rojek 2014, eq. 61], and removal of worn particles.

    erosion: kernels.erosion.Erosion of the tool; tool: its bodies; on_removal(worn, loose): called with the particles
    that were removed because they were worn away, and because nothing holds them any more.
    """

    def __init__(self, *, erosion, tool, on_removal, **common):
        super().__init__(count=tool.count, **common)
        self.erosion, self.tool, self.on_removal = erosion, tool, on_removal

    @property
    def worn(self):
        return self.erosion.worn

    @property
    def limit(self):
        return self.erosion.limit

    def act(self):
        slid = self.take_slid()
        if slid is None:
            return
        removed, uncovered = self.erosion.wear(self.law.volume(slid, self.hardness_now(slid), self.erosion.areas))
        if removed:
            self._remove(removed, uncovered)

    def _remove(self, removed, uncovered):
        loose = self.erosion.detached().tolist()
        self.erosion.drop(loose)
        self.contact_energy_removed += self.tool.erase(removed + loose)
        self.contact.forget_erased()
        self.tool.add([i for i in uncovered if self.erosion.alive[i]])
        self.on_removal(removed, loose)

    def state(self):
        return {**super().state(), "erosion": self.erosion.state()}

    def restore(self, state):
        super().restore(state)
        self.erosion.restore(state["erosion"])

    def log(self):
        return {"mass_lost": (self.erosion.mass_fraction_lost, "-"),
                "worn_volume": (self.erosion.archard_volume, self.volume_unit)}

"""Archard wear of a tool of particles, and their removal."""
import math
import numpy as np

from rockwear.engines.base import Engine
from rockwear.kernels.wear_laws import WORK


class WearEngine(Engine):
    """What wear of a tool of particles and of facets has in common.

    contact: the ToolContact that says where and under what force the tool slides; law: of kernels.wear_laws, accelerated;
    count: pieces (particles, facets) of the tool. `events` counts for each piece how often a contact began to rub it, as
    far as visits can tell them apart; `worn` (count,) is the volume in m3 worn off it, whatever it had to give, `limit`
    that at which it is gone: what R's rules are judged by. volume_unit: of what is recorded.
    """

    name = "wear"

    def __init__(self, *, contact, law, count, volume_unit="m3/m", period=1):
        super().__init__(period=period)
        self.contact, self.law, self.volume_unit = contact, law, volume_unit
        self.contact_energy_removed = self.work_used = 0.0
        self.events, self.rubbed = np.zeros(count, int), np.zeros(count, bool)

    def take_slid(self):
        """What slid since the last visit, its work and the contacts that have begun counted; None without any."""
        slid = self.contact.take_slid()
        rubbed = self.at_places(slid[WORK]) > 0
        self.events += rubbed & ~self.rubbed
        self.rubbed = rubbed
        if not rubbed.any():
            return None
        self.work_used += float(slid[WORK].sum())
        return slid

    def at_places(self, values):
        """What `values` (count,) of the pieces are for the pieces as they were made."""
        return values

    def warnings(self):
        """Lines on what in this run's wear is not to be relied on."""
        return []

    def state(self):
        return {"contact_energy_removed": self.contact_energy_removed, "work_used": self.work_used,
                "events": self.events.copy(), "rubbed": self.rubbed.copy()}

    def restore(self, state):
        self.contact_energy_removed, self.work_used = float(state["contact_energy_removed"]), float(state["work_used"])
        self.events, self.rubbed = state["events"].copy(), state["rubbed"].copy()


class Wear(WearEngine):
    """Wear with H(theta) by the laws of M 6.3-6.4 (P 61), and the removal of particles worn away.

    erosion: kernels.erosion.Erosion of the tool; temperature: a function giving (m,) K of the tool particles.
    """

    def __init__(self, *, contact, erosion, tool, law, hardness, temperature, on_removal, **common):
        super().__init__(contact=contact, law=law, count=tool.count, **common)
        self.erosion, self.tool = erosion, tool
        self.hardness, self.temperature = hardness, temperature
        self.on_removal = on_removal
        self.coldest, self.hottest = math.inf, -math.inf

    @property
    def worn(self):
        return self.erosion.worn

    @property
    def limit(self):
        return self.erosion.volumes

    def act(self):
        slid = self.take_slid()
        if slid is None:
            return
        temperature = self.temperature()
        met = temperature[self.rubbed]
        self.coldest, self.hottest = min(self.coldest, float(met.min())), max(self.hottest, float(met.max()))
        volume = self.law.volume(slid, self.hardness.nearest(temperature), self.erosion.areas)
        removed, uncovered = self.erosion.wear(volume)
        if removed:
            self._remove(removed, uncovered)

    def _remove(self, removed, uncovered):
        loose = self.erosion.detached().tolist()
        self.erosion.drop(loose)
        self.contact_energy_removed += self.tool.erase(removed + loose)
        self.contact.forget_erased()
        self.tool.add([i for i in uncovered if self.erosion.alive[i]])
        self.on_removal(removed, loose)

    def warnings(self):
        """A line where what was worn had temperatures (K) beyond the table of hardness."""
        if not self.hardness.leaves(self.coldest, self.hottest):
            return []
        first, last = self.hardness.limits
        return [f"what wore, at {self.coldest:.1f} to {self.hottest:.1f} K, leaves the hardness table ({first:g} to {last:g} K): "
                "the nearest row holds"]

    def state(self):
        return {**super().state(), **self.erosion.state(), "coldest": self.coldest, "hottest": self.hottest}

    def restore(self, state):
        super().restore(state)
        self.erosion.restore(state)
        self.coldest, self.hottest = float(state["coldest"]), float(state["hottest"])

    def log(self):
        return {"mass_lost": (self.erosion.mass_fraction_lost, "-"),
                "worn_volume": (self.erosion.archard_volume, self.volume_unit)}

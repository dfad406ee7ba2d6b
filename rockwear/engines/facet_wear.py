"""Wear of a tool of facets: it moves the vertices."""
import math

import numpy as np

from rockwear.engines.base import RunEnded
from rockwear.engines.facet_contact import SLIP
from rockwear.engines.wear import WearEngine
from rockwear.kernels.boundary import altitudes, area_vectors
from rockwear.kernels.remeshing import CROWDED
from rockwear.kernels.worn_boundary import Folded, STEPS, STRIDE, WornAway


class FacetWear(WearEngine):
    """Wear of a tool of facets: the volume worn off each facet becomes a motion of the vertices [Rocky, sec. 2.5].

    boundary: kernels.worn_boundary.WornBoundary; tool: its bodies; work_fraction: the part of the friction work that
    counts as the tool's ([Rocky, eq. 2-53] takes one half, Archard's law all of it); reshape: False keeps the shape,
    and only `worn` grows; wear_acceleration: the law's, for messages; on_remeshing(): called when facets have come to
    other parts of the surface, whose friction so far belongs to where they were. `limit` is a layer of a facet as deep
    as the initial facet's smallest altitude: what a particle of that size would be.

    `recession` is the mean over the worn volume of the depth that a facet recedes over the distance slid on it, dw/ds
    of Archard's law. Where it is not small, a face recedes from what presses on it: the contact is relieved, and wear
    is no longer proportional to the acceleration, the first rule of [Rocky]. A facet that remeshing moves to another
    part of the surface then counts for the place where it lies. Raises RunEnded where a facet would recede further in
    one update than vertices can go, where the boundary would fold, and where a particle lies at the inner side of a
    facet.
    """

    def __init__(self, *, boundary, tool, work_fraction=1.0, reshape=True, wear_acceleration=1.0,
                 on_remeshing=lambda: None, **common):
        super().__init__(count=len(boundary.facets), **common)
        self.boundary, self.tool = boundary, tool
        self.work_fraction, self.reshape, self.wear_acceleration = work_fraction, reshape, wear_acceleration
        self.on_remeshing = on_remeshing
        self.worn = np.zeros(len(boundary.facets))
        self.receded = 0.0
        self.limit = self._areas() * altitudes(boundary.vertices, boundary.facets)

    def _areas(self):
        return np.linalg.norm(area_vectors(self.boundary.vertices, self.boundary.facets), axis=1)

    def act(self):
        slid = self.take_slid()
        if self.reshape:
            self._check_sides()
        if slid is None:
            return
        areas = self._areas()
        volume = self.work_fraction * self.law.volume(slid, self.hardness_now(slid), areas)
        if self.reshape:
            self._check_speed(volume / areas)
        # What is too fast is not worn: the boundary has not counted it either.
        self.worn += self.at_places(volume)
        if not self.reshape:
            return
        rubbed = slid[SLIP] > 0
        self.receded += float(np.sum(volume[rubbed]**2 / (areas * slid[SLIP])[rubbed]))
        stored, remeshed = self.contact.elastic_energy(), self.boundary.remeshed
        try:
            moved = self.boundary.wear(volume)
        except WornAway as end:
            raise RunEnded(f"the tool is worn away: {end}", True) from None
        except Folded as end:
            raise RunEnded(f"the tool's shape cannot follow its wear: {end}", False) from None
        if moved:
            if self.boundary.remeshed != remeshed:
                self.on_remeshing()
                self.contact.neighbours = self.boundary.neighbours()
            self.contact.shape_has_changed()
            self.tool.reshape()
            self.contact_energy_removed += stored - self.contact.elastic_energy()

    def at_places(self, values):
        return np.bincount(self.boundary.place, values, len(self.worn))

    def _check_speed(self, depth):
        # The facets around a crowded one take over what falls on it.
        now = altitudes(self.boundary.vertices, self.boundary.facets)
        size = np.maximum(now, CROWDED * self.boundary.size)
        depth = depth * now / size
        worst = int(np.argmax(depth / size))
        if depth[worst] > STEPS * STRIDE * size[worst]:
            raise self._too_fast(f"a facet of {1e3 * size[worst]:.3g} mm would recede by {1e3 * depth[worst]:.3g} mm "
                                 "at once")

    def _check_sides(self):
        place = self.contact.contact_inside_tool()
        if place is not None:
            raise self._too_fast(f"a rock particle has come to lie inside of it at {place}")

    def _too_fast(self, words):
        return RunEnded(f"the tool's shape cannot follow its wear: {words}; "
                        f"lower wear_acceleration = {self.wear_acceleration:g}", False)

    @property
    def recession(self):
        """-, mean of dw/ds; nan without wear."""
        return self.receded / self.volume if self.volume > 0 else math.nan

    @property
    def volume(self):
        """m3 that the wear law has worn so far."""
        return float(self.worn.sum())

    def state(self):
        return {**super().state(), "receded": self.receded, "worn": self.worn.copy(), "boundary": self.boundary.state()}

    def restore(self, state):
        super().restore(state)
        self.receded = float(state["receded"])
        self.worn = state["worn"].copy()
        self.boundary.restore(state["boundary"])
        self.contact.neighbours = self.boundary.neighbours()

    def log(self):
        return {"mass_lost": (1 - self.boundary.volume / self.boundary.first_volume, "-"),
                "worn_volume": (self.volume, self.volume_unit)}

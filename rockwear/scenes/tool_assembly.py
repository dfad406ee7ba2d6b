"""A rigid tool in a scene, of particles or of facets, in the plane or in space: bodies, contact, wear, shape."""
import math
from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from yade import FrictMat, FrictViscoMat

from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.facet_wear import FacetWear
from rockwear.engines.rock_friction import RockFriction, YadeFriction
from rockwear.engines.tool_contact import ToolContact
from rockwear.engines.wear import Wear
from rockwear.engines.wear_profile import WearProfile
from rockwear.kernels.checks import require
from rockwear.kernels.wear_statistics import RECESSION, places
from rockwear.model.contact import PLANE
from rockwear.model.facet_tool import write_stl
from rockwear.model.thermal_body import ParticleBody
from rockwear.scenes import yade_scene
from rockwear.scenes.physics import two_digits
from rockwear.scenes.tool_bodies import FacetBodies, SphereBodies, ToolBodies

PROFILE_PERIOD = 10
"""Visits of the wear between rows of its profile."""


class ToolAssembly(ABC):
    """What a scene asks of a tool.

    model: a tool of rockwear.model; outline: (k, 2) m, its section with the plane of the cut when new; contact_law:
    model.contact.ContactLaw; wear: scenes.physics.ToolWear; units: PLANE or SPACE. `make_engines` makes `bodies`,
    `contact`, `wear_engine` and `profile`.
    """

    piece = "a particle"
    """What of the tool wears away in one."""
    loose_material = FrictMat
    """YADE's material of rock that is no longer bonded."""
    work_fraction = 1.0
    """Part of the friction work that wears the tool."""
    put_loop = staticmethod(yade_scene.put_loop)

    def __init__(self, *, model, outline, contact_law, wear, units, sampling_period=1):
        self.model, self.outline, self.contact_law, self.wear, self.units = model, outline, contact_law, wear, units
        self.sampling_period = sampling_period

    @property
    def count(self):
        """Pieces of the tool."""
        return self.model.count

    def foremost(self, below):
        """Largest x (m) in the tool's frame of what is left of it below a height (m), -inf for nothing."""
        return self.model.foremost(below=below)

    def make_engines(self, *, motion, increment, wear_period, temperature, on_removal):
        """Make the tool's bodies and engines. motion: of kernels.rigid_motion; increment: VelocityIncrement of the
        rock; temperature: a function giving (pieces,) K; on_removal(worn, loose): told of particles that have gone,
        and without any of facets that have come to other places."""
        self.bodies = self._make_bodies(motion)
        self.contact = self._make_contact(increment)
        self.wear_engine = self._make_wear(wear_period, temperature, on_removal)
        self.profile = None
        if self._shape_changes():
            self.profile = WearProfile(wear=self.wear_engine, place=places(self.outline, self.model.positions[:, :2]),
                                       period=PROFILE_PERIOD * wear_period)

    @abstractmethod
    def _make_bodies(self, motion):
        """The tool's bodies in YADE."""

    @abstractmethod
    def _make_contact(self, increment):
        """The engine of the contacts."""

    @abstractmethod
    def _make_wear(self, period, temperature, on_removal):
        """The engine of the wear."""

    def _shape_changes(self):
        return self.wear.law.wears

    def rock_friction(self, bonds, increment, period):
        """The engine that sums up friction within the rock, whose sum in YADE may be one with the tool's."""
        return RockFriction(bonds=bonds, motion=increment, period=period)

    @property
    @abstractmethod
    def thermal_body(self):
        """model.thermal_body.ThermalBody of the tool. Raises ParameterError for a tool that has none."""

    @abstractmethod
    def insert(self):
        """Put the new tool into YADE."""

    @abstractmethod
    def insert_again(self):
        """Bring the tool that a loaded scene holds to its present shape."""

    @abstractmethod
    def mark_of_shape(self):
        """A number that differs where the tool's shape does."""

    @abstractmethod
    def volume_balance(self):
        """{entry: m3} of what the wear law wore and where it is."""

    def mass_balance(self):
        """{entry: kg}: the volume balance times the tool's density."""
        density = self.model.density
        return {"initial": self.model.area * density, **{name: value * density for name,
                                                         value in self.volume_balance().items()}}

    def friction_balance(self):
        """{entry: J}: friction at the tool, and what of it has worn it."""
        return {"tool": self.contact.friction,
                "worn_by": self.wear_engine.work_used + float(self.contact.wearing_work.sum())}

    @property
    def removed_energy(self):
        """J of contacts that vanished with what wore away."""
        return self.wear_engine.contact_energy_removed

    # ---- what the folder of a run shows

    @abstractmethod
    def model_arrays(self):
        """{name: array} that stays the same."""

    @abstractmethod
    def snapshot(self):
        """{name: array} of now."""

    @abstractmethod
    def points(self, temperature):
        """(places (n, d) m in the tool's frame, {field: (n,)}, corners (m, d) of its facets among them or None) for
        ParaView; temperature: (pieces,) K, None without heat."""

    @abstractmethod
    def results(self):
        """{name: (value, unit)}."""

    @abstractmethod
    def words(self):
        """How far it is worn, in a few words."""

    def slow_recession(self):
        """Largest wear acceleration at which the surface recedes slowly against the slip; of particles any."""
        return math.inf

    def warnings(self):
        """Lines on what of its wear is not to be relied on."""
        return self.wear_engine.warnings()

    def write_shape(self, folder):
        """Write the shape into the folder where another run can take it."""


class ParticleAssembly(ToolAssembly):
    """A tool of particles: a model.particle_tool.Tool, or LayeredTool in space. Only its surface particles are in
    YADE."""

    def _make_bodies(self, motion):
        return (ToolBodies if self.units is PLANE else SphereBodies)(self.model, motion)

    def _make_contact(self, increment):
        return ToolContact(tool=self.bodies, motion=increment, needs=self.wear.law.needs,
                           sampling_period=self.sampling_period)

    def _make_wear(self, period, temperature, on_removal):
        return Wear(contact=self.contact, erosion=self.model.erosion, tool=self.bodies, law=self.wear.law,
                    hardness=self.wear.hardness, temperature=temperature, on_removal=on_removal,
                    volume_unit=self.units.volume, period=period)

    @cached_property
    def thermal_body(self):
        return ParticleBody(self.model)

    def insert(self):
        self.bodies.add(sorted(self.model.erosion.surface))

    def insert_again(self):
        erosion = self.model.erosion
        self.bodies.erase([i for i in self.bodies.body_of if not erosion.alive[i]])
        self.bodies.add([i for i in sorted(erosion.surface) if i not in self.bodies.body_of])

    def mark_of_shape(self):
        return float(np.count_nonzero(self.model.erosion.alive))

    def volume_balance(self):
        return self.model.erosion.volume_balance()

    def model_arrays(self):
        tool = self.model
        return {"tool_radii": tool.radii, "tool_positions": tool.positions, "tool_volumes": tool.volumes,
                "tool_fixed": tool.fixed}

    def snapshot(self):
        erosion = self.model.erosion
        return {"alive": erosion.alive, "worn_depth": erosion.stored / erosion.areas,
                "surface": np.array(sorted(erosion.surface), int)}

    def points(self, temperature):
        alive = self.model.erosion.alive
        fields = {"diameter": 2 * self.model.radii[alive], "worn_depth": self.snapshot()["worn_depth"][alive]}
        if temperature is not None:
            fields["temperature"] = temperature[alive]
        return self.model.positions[alive], fields, None

    def results(self):
        erosion, unit = self.model.erosion, self.units.volume
        found = {"mass_lost": (erosion.mass_fraction_lost, "-"), "worn_volume": (erosion.archard_volume, unit),
                 "particles_removed": (int(np.sum(~erosion.alive)), "-"), "dropped_volume": (erosion.lost_with_pieces,
                                                                                             unit),
                 "tool_particles": (self.model.count, "-")}
        if self.units is not PLANE:
            found["maximum_wear_depth"] = float((erosion.worn / erosion.areas).max()), "m"
        return found

    def words(self):
        return f"{100 * self.model.erosion.mass_fraction_lost:.2f} % of the tool worn"

    def warnings(self):
        tool, found = self.model, super().warnings()
        if not tool.held:
            found.append(f"the shank holds {np.count_nonzero(tool.fixed)} of the tool's {tool.count} particles: its "
                         "outline has no level top (+y) or upright back (-x)")
        return found


class FacetAssembly(ToolAssembly):
    """A tool of facets, a model.facet_tool.FacetTool: segments in the plane, triangles in space.

    Its vertices move with the wear unless reshape is False.

    work_fraction: part of the friction work that wears the tool; thermal_body: a function that makes the body behind
    the facets, for heat.
    """

    piece = "a layer as deep as its facet"
    loose_material = FrictViscoMat
    put_loop = staticmethod(yade_scene.put_loop_with_facets)

    def __init__(self, *, thermal_body, work_fraction=1.0, reshape=True, **common):
        super().__init__(**common)
        require(self.sampling_period == 1, "sampling_period", self.sampling_period, "1 for a tool of facets", "steps")
        self.work_fraction, self.reshape, self._thermal_body = work_fraction, reshape, thermal_body

    def _make_bodies(self, motion):
        return FacetBodies(self.model, motion)

    def _make_contact(self, increment):
        return FacetContact(tool=self.bodies, motion=increment, needs=self.wear.law.needs,
                            neighbours=self.model.boundary.neighbours())

    def _make_wear(self, period, temperature, on_removal):
        return FacetWear(contact=self.contact, boundary=self.model.boundary, tool=self.bodies, law=self.wear.law,
                         hardness=self.wear.hardness, temperature=temperature, work_fraction=self.work_fraction,
                         reshape=self.reshape, wear_acceleration=self.wear.acceleration, on_remeshing=on_removal,
                         volume_unit=self.units.volume, period=period)

    def _shape_changes(self):
        return super()._shape_changes() and self.reshape

    def rock_friction(self, bonds, increment, period):
        if len(bonds.pairs):
            return super().rock_friction(bonds, increment, period)
        return YadeFriction(contact=self.contact, bonds=bonds, motion=increment, period=None)

    @cached_property
    def thermal_body(self):
        return self._thermal_body()

    def insert(self):
        self.bodies.add(range(self.model.count))

    def insert_again(self):
        self.bodies.reshape()

    def mark_of_shape(self):
        return self.model.boundary.volume

    def volume_balance(self):
        balance, worn = self.model.boundary.volume_balance(), self.wear_engine.volume
        return balance if self.reshape else {**balance, "archard": worn, "shape_kept": worn}

    @property
    def removed_energy(self):
        # Less what contacts began with that the new shape caused.
        return super().removed_energy - self.contact.reshaping_energy

    def model_arrays(self):
        tool = self.model
        return {"tool_vertices": tool.first, "tool_facets": tool.first_facets, "tool_fixed": tool.boundary.fixed}

    def snapshot(self):
        boundary = self.model.boundary
        return {"tool_vertices": boundary.vertices, "tool_facets": boundary.facets,
                "worn_volume": self.wear_engine.worn}

    def points(self, temperature):
        boundary, fields = self.model.boundary, {"worn_depth": self.model.depth_below}
        if temperature is not None:
            # The mean of the facets at each vertex.
            vertex, of_facet = boundary.facets.ravel(), np.repeat(temperature, boundary.facets.shape[1])
            fields["temperature"] = np.bincount(vertex, of_facet) / np.bincount(vertex)
        return boundary.vertices, fields, boundary.facets

    def results(self):
        # Where the shape is kept, what each facet would have gone back.
        depth = self.model.worn_depth if self.reshape else self.wear_engine.worn / self.model.areas
        found = {**self.wear_engine.log(), "broken_off": (self.model.boundary.broken_off, self.units.volume),
                 "facets": (self.model.count, "-"), "maximum_wear_depth": (float(depth.max()), "m")}
        return {**found, "recession_per_slip": (self.wear_engine.recession, "-")} if self.reshape else found

    def words(self):
        return f"{100 * self.wear_engine.log()['mass_lost'][0]:.2f} % of the tool worn"

    def slow_recession(self):
        recession = self.wear_engine.recession
        return self.wear.acceleration * RECESSION / recession if self.reshape and recession > 0 else math.inf

    def warnings(self):
        recession, found = self.wear_engine.recession, super().warnings()
        if not self.model.boundary.fixed.any():
            found.append("the shank holds no facet of the tool, which has neither a level top (+y) nor an upright back "
                         "(-x): all of its faces wear")
        if not recession > RECESSION or not self.reshape:
            return found
        return [*found,
                f"the face recedes by {recession:.2g} of the way that rock slides on it, away from what presses there: "
                "less wears than the same work at a lower wear acceleration would. Use wear_acceleration = "
                f"{two_digits(self.wear.trusted(self))} at most instead of {self.wear.acceleration:g}, and run that "
                "much longer"]

    def write_shape(self, folder):
        if self.units is not PLANE and self._shape_changes():
            write_stl(folder / "tool.stl", self.model.boundary.vertices, self.model.boundary.facets)

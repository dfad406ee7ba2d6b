"""The cut with a tool of segments in place of particles (M 8.1), worn by moving its vertices (R 2.5)."""
from dataclasses import replace

import numpy as np
from yade import FrictViscoMat

from rockwear.scenes import yade_scene
from rockwear.scenes.tool_bodies import FacetBodies
from rockwear.run import vtk
from rockwear.scenes.cutting import Cutting
from rockwear.scenes.cutting import parameters as cutting_parameters
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.facet_contact import FacetContact
from rockwear.engines.facet_wear import FacetWear
from rockwear.model.facet_tool import FacetTool
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Parameter, above_zero, choice, flag, number

OF_FACETS = [
    Parameter("segment", 1e-3, "m", above_zero, "longest segment of the tool's outline", "ours"),
    Parameter("work_fraction", 1.0, "", number(0, 1), "part of the friction work that wears the tool", "M 6.9; R 2-53: 0.5"),
    Parameter("reshape", True, "", flag, "move the vertices; false: note where wear falls and keep the shape"),
]


RECESSION = 0.1
"""Recession over slip up to which an acceleration is trusted: friction was 10 % below that of a tool that keeps its shape
at 0.16, 32 % at 1.1, 73 % at 3.6 (calibration/campaigns/two_tools.py, seed 1)."""
TOOL = Parameter("tool", "particles", "", choice("particles", "segments"), "what the tool is made of", "M 8.2, M 8.1")


def cut(values):
    """The cut with the tool that `values` chooses."""
    return (FacetCutting if values["tool"] == "segments" else Cutting)(values)


def parameters(**defaults):
    """Those of the cut, without heat by default, and those of the segments."""
    own = {p.name for p in OF_FACETS}
    common = cutting_parameters(**{"heat": False, **{k: v for k, v in defaults.items() if k not in own}})
    return [p for p in common if p.name != "removal"] + [replace(p, default=defaults.get(p.name, p.default)) for p in OF_FACETS]


def check_sampling(values):
    """Raise ParameterError unless contacts are sampled in every step, as those that pass from facet to facet must be."""
    require(values["sampling_period"] == 1, "sampling_period", values["sampling_period"], "1 for a tool of facets", "steps")


class FacetCutting(Cutting):
    """Cutting with a tool of segments. Its hardness is that at the tool's first temperature: it has no heat."""

    loose_rock, put_loop = FrictViscoMat, staticmethod(yade_scene.put_loop_with_facets)
    piece = "a layer as deep as its facet"

    def __init__(self, values):
        require(not values["heat"], "heat", "true", "false: heat is for a tool of particles")
        removal = values.get("removal", "volume")
        require(removal == "volume", "removal", removal, "volume for a tool of facets; --reshape false keeps its shape")
        check_sampling(values)
        super().__init__(values)

    def _make_tool(self, vertices):
        return FacetTool.of_outline(vertices, segment=self.v.segment, density=self.v.tool_density)

    def _make_tool_engines(self, motion):
        v, tool = self.v, self.tool
        self.bodies = FacetBodies(tool, self.motion)
        self.contact = FacetContact(tool=self.bodies, motion=motion, needs=self.wear_law.needs, neighbours=tool.boundary.neighbours())
        self.rock_friction = RockFriction(bonds=self.bonds, motion=motion)
        self.wear = FacetWear(contact=self.contact, boundary=tool.boundary, tool=self.bodies, law=self.wear_law,
                              hardness=self.hardness, temperature=self._tool_temperature, work_fraction=v.work_fraction,
                              reshape=v.reshape, wear_acceleration=v.wear_acceleration, volume_unit=self.volume_unit)

    def _profile(self):
        return super()._profile() if self.v.reshape else None

    def _mark_of_shape(self):
        return self.tool.boundary.volume

    def _put_tool(self):
        self.bodies.add(range(self.tool.count))

    def _put_tool_back(self):
        self.bodies.reshape()

    # ---- balances

    def _volume_balance(self):
        balance, worn = self.tool.boundary.volume_balance(), self.wear.volume
        return balance if self.v.reshape else {**balance, "archard": worn, "shape_kept": worn}

    # ---- what a run's folder shows

    def model(self):
        rock, tool = self.rock, self.tool
        return {"rock_radii": rock.radii, "rock_fixed": rock.fixed, "bonds": rock.pairs,
                "box": np.array([rock.width, rock.height]), "tool_vertices": tool.first, "tool_facets": tool.first_facets,
                "outline": self.outline, "tool_fixed": tool.boundary.fixed}

    def snapshot(self):
        return {**self._rock_and_pose(), "tool_vertices": self.tool.boundary.vertices,
                "tool_facets": self.tool.boundary.facets, "worn_volume": self.wear.worn}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtk and tool.NNNN.vtk: diameter, broken bonds; the tool's vertices."""
        shot = self.snapshot()
        vtk.write(folder / f"rock.{number:04d}.vtk", shot["rock_positions"],
                  {"diameter": 2 * self.rock.radii, "broken_bonds": shot["broken_bonds"]})
        vtk.write(folder / f"tool.{number:04d}.vtk", self.bodies.pose.of(shot["tool_vertices"]),
                  {"worn_depth": self.tool.depth_below})

    def _worn_words(self):
        return f"{100 * self.wear.log()['mass_lost'][0]:.2f} % of the tool worn"

    def _worn_results(self):
        # Where the shape is kept, what each facet would have gone back.
        depth = self.tool.worn_depth if self.v.reshape else self.wear.worn / self.tool.areas
        found = {**self.wear.log(), "broken_off": (self.tool.boundary.broken_off, self.volume_unit),
                 "facets": (self.tool.count, "-"), "maximum_wear_depth": (float(depth.max()), "m")}
        return {**found, "recession_per_slip": (self.wear.recession, "-")} if self.v.reshape else found

    def warnings(self):
        recession = self.wear.recession
        found = super().warnings()
        if not self.v.reshape or not recession > RECESSION:
            return found
        return [*found,
                f"the face recedes by {recession:.2g} of the way that rock slides on it, away from what presses there: less "
                f"wears than the same work at a lower acceleration would. Accelerate at most "
                f"{self.v.wear_acceleration * RECESSION / recession:.2g} times instead of {self.v.wear_acceleration:g}, and run that "
                "much longer"]

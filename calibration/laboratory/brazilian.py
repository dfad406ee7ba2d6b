"""Brazilian test: a disc of rock pressed along a diameter until it splits."""
import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from yade import O

from calibration.laboratory.loaded_specimen import SpecimenOutput, SpecimenTest, groups
from rockwear.engines import access
from rockwear.engines.bonds import INTACT
from rockwear.kernels import brazilian
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Parameter, length, number
from rockwear.model.rock import CutOut

GROUPS = groups(
    Parameter("diameter", 0.05, "m", length, "of the disc", "(ISRM 1978): 54 mm"),
    Parameter("loading_angle", 20.0, "deg", number(1, 60), "of the arc over which each platen holds the rim",
              "measured, calibration/results/laboratory.md; (ISRM 1978): 10"),
    without=("width", "height"), test=lambda values: "brazilian", gauge=0.25, speed=0.02, strain_max=0.05)
CORNERS = 180
"""Of the polygon for the disc; its area is 0.02 % too small."""
SAMPLES = 20
"""Points on a bond by which the part of it in the gauge is found."""
FIRST = 3
"""Cracks that count as the first."""


class BrazilianOutput(SpecimenOutput):
    """What the folder of a Brazilian test shows."""

    def log(self):
        found = super().log()
        across, along = self.scene.centre_stresses()
        return {**found, "force": (self.scene.stress * self.scene.section, "N/m"),
                "centre_tension": (across, "Pa"), "centre_compression": (-along, "Pa")}

    def found(self, columns):
        scene, force = self.scene, columns["force"].max()
        first = [(crack.x, crack.y) for crack in scene.bonds.cracks[:FIRST]]
        off = np.linalg.norm(np.subtract(first, scene.centre), axis=1).mean() / scene.radius if first else math.nan
        return {"peak_force": (float(force), "N/m"),
                "tensile_strength": (float(brazilian.tensile_strength(force, scene.v.diameter)), "Pa"),
                "first_cracks_radius": (float(off), "of the disc's radius"), "split": (scene.split(), "-")}

    def warnings(self):
        if self.scene.split():
            return super().warnings()
        return [*super().warnings(), "the disc did not split from jaw to jaw: it failed otherwise, if at all, and "
                "2P/(pi D) is no measure of its tensile strength"]


class BrazilianTest(SpecimenTest):
    """A disc between two jaws. values: {name: value} of all GROUPS.

    Each jaw is the discs within `grip` of the rim along an arc of `loading_angle`; they move along x at a constant
    speed, free across it and free to turn. A point load would crush the rim of a rock whose bonds are no stronger in
    shear than in tension. `stress` is 2P/(pi D), the tension at the centre.
    """

    output_class = BrazilianOutput

    def _specimen(self):
        v = self.v
        # The packing reaches further, so that its walls leave no order in the disc.
        side = v.diameter + 4 * v.radius_max
        v.width = v.height = side
        self.radius, self.centre = 0.5 * v.diameter, np.full(2, 0.5 * side)
        angle = np.arange(CORNERS) * 2 * math.pi / CORNERS
        return CutOut(super()._specimen(), bonding_gap=v.bonding_gap,
                      polygon=self.centre + self.radius * np.column_stack([np.cos(angle), np.sin(angle)]))

    def _ends(self):
        grip = self.v.grip or 2 * float(self.rock.radii.max())
        x, y = (self.rock.positions - self.centre).T
        held = (np.hypot(x, y) > self.radius - grip) & (
            abs(y) < abs(x) * math.tan(math.radians(0.5 * self.v.loading_angle)))
        left, right = np.flatnonzero(held & (x < 0)), np.flatnonzero(held & (x > 0))
        require(len(left) and len(right), "loading_angle", self.v.loading_angle, "wide enough to hold a disc on each "
                "side", "deg")
        require(2 * grip < self.radius, "grip", grip, f"less than a quarter of the diameter {self.v.diameter:g}", "m")
        return left, right

    def _gauge(self):
        off = np.linalg.norm(self.rock.positions - self.centre, axis=1)
        return np.flatnonzero(off <= self.v.gauge * self.radius)

    def _section(self):
        return 0.5 * math.pi * self.v.diameter

    def _further_engines(self):
        first, second = np.moveaxis(self.rock.positions[self.rock.pairs], 1, 0) - self.centre
        along = (np.arange(SAMPLES)[:, None, None] + 0.5) / SAMPLES
        inside = np.linalg.norm(first + along * (second - first), axis=2) <= self.v.gauge * self.radius
        part = inside.mean(axis=0)
        self.central_bonds = [(n, part[n]) for n in np.flatnonzero(part).tolist()]
        return ()

    def centre_stresses(self):
        """(across, along) the loading, Pa, tension positive: the mean over the gauge, -1/A sum of force times the part
        of the branch that lies in it."""
        across = along = 0.0
        for n, part in self.central_bonds:
            interaction = access.contact_of(*self.rock.pairs[n].tolist()) if self.bonds.status[n] == INTACT else None
            # A bond that has just broken in C++ counts as intact up to the next look at it.
            if not (interaction and interaction.isReal):
                continue
            force = interaction.phys.normalForce + interaction.phys.shearForce
            branch = O.bodies[interaction.id2].state.pos - O.bodies[interaction.id1].state.pos
            along -= part * force[0] * branch[0]
            across -= part * force[1] * branch[1]
        area = math.pi * (self.v.gauge * self.radius)**2
        return across / area, along / area

    def split(self):
        """Whether no intact bonds join the disc's upper to its lower half between the jaws."""
        x, y = (self.rock.positions - self.centre).T / self.radius
        between = abs(x) < 0.6
        pairs = self.rock.pairs[self.bonds.status == INTACT]
        pairs = pairs[between[pairs].all(axis=1)]
        part = connected_components(coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(x),) * 2), directed=False)[1]
        return not np.intersect1d(part[between & (y > 0.3)], part[between & (y < -0.3)]).size

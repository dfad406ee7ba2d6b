"""The angle of repose: a box is drained through openings beside a plate, on which a heap stays [Rojek 2003, ch. 14]."""
import math
from types import SimpleNamespace

import numpy as np

from rockwear.engines.outflow import Outflow
from rockwear.engines.rest import Rest
from rockwear.kernels import repose
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, choice, duration, number
from rockwear.model.granular import DrainedBox, poured
from rockwear.scenes.granular import ACCURACY, AT_REST, GRAINS, SETTLING, Granular, GranularOutput, check_radii

SOLID = 0.57
"""Part of the box that settled spheres fill, for the size of the plate."""
HEADROOM = 2.3**3 / (4 / 3 * math.pi / SOLID)
"""Height of the grains before they settle over that after."""
CUT_OFF = 0.95
"""Part of the height of the fill from which a crest may be the fill's own surface."""

GROUPS = [
    GRAINS,
    Group("box", (
        Parameter("thickness", 4.0, "diameters", number(1.05, 1000), "between front and back wall, of a mean grain; "
                  "four are those of Zhou, Xu, Yu and Zulli (2002), whose test this is; wider boxes give lower heaps"),
        Parameter("plate", "rough", "", choice("rough", "smooth"), "what the heap stands on: fixed grains, or a wall, "
                  "from which grains that roll freely roll off"),
        Parameter("fill_ratio", 1.2, "", number(0.2, 4), "height of the fill over half the plate's length; a heap "
                  "steeper than that would be cut off"),
        Parameter("opening", 6.0, "diameters", number(2, 100), "width of the opening on either side of the plate"))),
    Group("motion", (
        SETTLING,
        Parameter("draining", 2.0, "s", duration, "longest time for the heap to form; it ends once all is at rest"))),
    ACCURACY,
    Group("output", (Parameter("snapshot_period", 0.05, "s", duration, "simulated time between the pictures"),))]


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError."""
    return Heap(values)


def plate(v):
    """Half the plate's length (m) at which so many grains fill the box up to fill_ratio of it."""
    d = v.radius_min + v.radius_max
    mean_cube = 0.25 * (v.radius_max + v.radius_min) * (v.radius_max**2 + v.radius_min**2)
    area = v.particles * 4 / 3 * math.pi * mean_cube / SOLID / (v.thickness * d)
    opening = v.opening * d
    # 2 (L + opening) fill_ratio L = area
    return 0.5 * (math.sqrt(opening**2 + 2 * area / v.fill_ratio) - opening)


def crest_of(heights):
    """Height (m) of the crest in a surface (k, strips) m: the largest mean over the strips; 0 without a grain."""
    return max((float(np.nanmean(row)) for row in heights if np.isfinite(row).any()), default=0.0)


class Heap(Granular):
    """Grains settle in a box over a plate; the openings beside it are opened, and the heap that stays is measured."""

    def __init__(self, values):
        v = SimpleNamespace(**values)
        check_radii(v)
        d = v.radius_min + v.radius_max
        length = plate(v)
        require(length > 4 * d, "particles", v.particles, f"more, for a plate of at least 8 diameters: it has "
                f"{2 * length / d:.2g}")
        depth = v.thickness * d
        height = HEADROOM * v.fill_ratio * length * 1.5 + 10 * d
        self.box = DrainedBox(half_length=length, opening=v.opening * d, depth=depth, height=height)
        low, high = self.box.inside
        rough = v.plate == "rough"
        grains = poured(low=low, high=high, floor=0.5 * d if rough else 0.0, count=v.particles,
                        radius_min=v.radius_min, radius_max=v.radius_max, density=v.density, seed=v.seed)
        self.cell = d
        self.output = HeapOutput(self)
        super().__init__(values, grains=grains, walls=self.box.walls, gates=self.box.gates,
                         fixed=self.box.rough_plate(d) if rough else np.empty((0, 3)),
                         stages={"settling": v.settling, "draining": v.draining})

    def own_engines(self):
        d = 2 * float(self.grains.radii.mean())
        self.outflow = Outflow(bodies=self.ids, below=-3 * d, period=100)
        # Nothing has begun to move when the gates have just gone.
        fall = math.sqrt(2 * 3 * d / self.v.gravity)
        self.rest = Rest(limit=AT_REST * self.energy_scale, period=200,
                         watching=lambda: self.stage == 1 and self.time - self.clock > 3 * fall)
        return [self.outflow, self.rest]

    def heap(self):
        """(x (k,) m, heights (k, strips) m, flanks (m, 3)) of kernels.repose, now; no flanks while all grains are
        there: the surface is that of the fill then."""
        positions, left = self.positions()
        x, heights = repose.surface(positions, self.grains.radii[left], half_length=self.box.half_length,
                                    half_depth=0.5 * self.box.depth, cell=self.cell)
        fallen = self.outflow.erased > 0
        return x, heights, repose.flanks(x, heights, self.box.half_length) if fallen else np.empty((0, 3))


class HeapOutput(GranularOutput):
    """What the folder of a heap shows."""

    def __init__(self, scene):
        super().__init__(scene)
        self.carried_out = lambda: scene.outflow.kinetic

    def log(self):
        return {**super().log(), **self.scene.outflow.log()}

    def results(self):
        """{name: (value, unit)}: the angle with its standard error over flanks and strips, and what goes with it."""
        scene, v = self.scene, self.scene.v
        x, heights, flanks = scene.heap()
        mean, error = (math.degrees(value) for value in repose.angle(flanks))
        sides = [math.degrees(repose.angle(flanks[flanks[:, 0] == side])[0]) for side in (-1, 1)]
        mean_radius = 0.5 * (v.radius_min + v.radius_max)
        zhou = repose.zhou(friction=v.friction, wall_friction=v.wall_friction,
                           rolling=v.rolling_resistance * mean_radius,
                           wall_rolling=1.5 * v.rolling_resistance * mean_radius, diameter=2 * mean_radius)
        found = {"angle_of_repose": (mean, "deg"), "angle_of_repose_standard_error": (error, "deg"),
                 "angle_left": (sides[0], "deg"), "angle_right": (sides[1], "deg"), "flanks": (len(flanks), "-"),
                 "heap_height": (crest_of(heights), "m"), "plate_half_length": (scene.box.half_length, "m"),
                 "mass_on_plate": (float(scene.grains.masses.sum()) - scene.outflow.mass, "kg"),
                 "grains_left": (scene.grains.count - scene.outflow.erased, "-")}
        if v.rolling_resistance > 0:
            found["angle_zhou_2002"] = math.degrees(zhou), "deg"
        return {**found, **self.common_results()}

    def warnings(self):
        scene, found = self.scene, super().warnings()
        if scene.finished and self.rest() > AT_REST:
            found.append(f"the heap is not at rest: its kinetic energy is {self.rest():.2g} of that of a fall by a "
                         "diameter; a longer draining lets it come to rest")
        _, heights, flanks = scene.heap()
        if not scene.outflow.erased:
            found.append("no grain has fallen past the plate, and there is no angle of repose: a longer draining or a "
                         "wider opening lets them fall")
        elif not len(flanks):
            found.append("no flank of the heap is long enough to have a slope: use more particles")
        if scene.stage > 0 and crest_of(heights) > CUT_OFF * scene.v.fill_ratio * scene.box.half_length:
            found.append("the heap is as high as the fill was, and may be cut off: a larger fill_ratio lets it have "
                         "its crest; or grains have jammed in an opening that is too narrow")
        return found

    def model(self):
        box = self.scene.box
        return {**super().model(), "plate": np.array([box.half_length, box.opening, box.depth])}

    def snapshot(self):
        x, heights, flanks = self.scene.heap()
        return {**super().snapshot(), "surface_x": x, "surface_heights": heights, "flanks": flanks}

    def progress(self):
        return f"{self.scene.grains.count - self.scene.outflow.erased} grains, {self.rest():.2g} of a fall's energy"

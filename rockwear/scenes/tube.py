"""Sand in a box that vibrates flows into a horizontal tube at its side [Rojek 2003, ch. 14]."""
import math
from types import SimpleNamespace

import numpy as np

from rockwear.engines.vibration import Vibration
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, above_zero, choice, duration, length, length_or_zero
from rockwear.model.granular import TubeBox, poured
from rockwear.scenes.granular import ACCURACY, GRAINS, SETTLING, Granular, GranularOutput, check_radii
from rockwear.scenes.parameters import with_defaults

DIRECTIONS = {"vertical": (0.0, 1.0, 0.0), "along": (1.0, 0.0, 0.0), "across": (0.0, 0.0, 1.0)}
LOOSE = 0.5
"""Part of the box that grains fill before they settle, for the height of its walls."""
VISITS = 100
"""Values of the acceleration in a period of the vibration, where the time step is short enough."""
LEAST_VISITS = 20
"""Of them at least: with fewer the box does not vibrate as it is told to."""

GROUPS = with_defaults([
    GRAINS,
    Group("box", (
        Parameter("width", 0.044, "m", length, "of the box of sand, along the tube"),
        Parameter("depth", 0.032, "m", length, "of the box, across the tube"),
        Parameter("tube_diameter", 0.02, "m", length, "of the tube, the circle in a polygon of 16 sides"),
        Parameter("tube_length", 0.08, "m", length, "of the tube, which is closed at its end"),
        Parameter("tube_axis", 0.014, "m", length, "height of the tube's axis over the floor of the box"))),
    Group("motion", (
        SETTLING,
        Parameter("amplitude", 2e-4, "m", length_or_zero, "of the vibration; 0.2 mm at 50 Hz are 2 g, as flasks of "
                  "lost foam casting are vibrated with; 0: what gravity alone does"),
        Parameter("frequency", 50.0, "Hz", above_zero, "of the vibration"),
        Parameter("direction", "vertical", "", choice(*DIRECTIONS), "of the vibration; along: the tube's axis"),
        Parameter("vibrating", 1.0, "s", duration, "time of vibration after the settling"))),
    ACCURACY,
    Group("output", (Parameter("snapshot_period", 0.1, "s", duration, "simulated time between the pictures"),))],
    radius_min=1.5e-3, radius_max=2e-3, density=2650.0)


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError."""
    return VibratedTube(values)


def check_tube(v):
    """Raise ParameterError for a tube that no grain fits into, or that does not fit into the side of the box."""
    rim = 0.5 * v.tube_diameter / math.cos(math.pi / 16)
    require(v.tube_diameter > 2 * v.radius_max, "tube_diameter", v.tube_diameter,
            f"more than the largest grain, {2 * v.radius_max:g}", "m")
    require(2 * rim < v.depth, "tube_diameter", v.tube_diameter, f"less than {0.98 * v.depth:g}, so that the tube fits "
            "into the side of the box", "m")
    require(v.tube_axis > rim, "tube_axis", v.tube_axis, f"more than {rim:.3g}, the tube's own radius", "m")
    fastest = v.amplitude * 2 * math.pi * v.frequency
    require(fastest < 10, "amplitude", v.amplitude, "so small that the box is slower than 10 m/s: it reaches "
            f"{fastest:.3g}", "m")


class VibratedTube(Granular):
    """Grains settle in a box, some into the tube at its side; then the box vibrates, and the sand in the tube is
    weighed.

    Places and velocities are those in the frame of the box, in which the walls stand still.
    """

    def __init__(self, values):
        v = SimpleNamespace(**values)
        check_radii(v)
        check_tube(v)
        mean_cube = 0.25 * (v.radius_max + v.radius_min) * (v.radius_max**2 + v.radius_min**2)
        fill = v.particles * 4 / 3 * math.pi * mean_cube / (v.width * v.depth)
        top = v.tube_axis + v.tube_diameter
        require(fill / 0.6 > top, "particles", v.particles,
                f"more, for a fill that covers the tube to a height of {top:g} m: it comes to {fill / 0.6:.2g}")
        self.box = TubeBox(width=v.width, depth=v.depth, height=2 * fill / LOOSE + 8 * v.radius_max,
                           diameter=v.tube_diameter, length=v.tube_length, axis=v.tube_axis)
        low, high = self.box.inside
        grains = poured(low=low, high=high, count=v.particles, radius_min=v.radius_min, radius_max=v.radius_max,
                        density=v.density, seed=v.seed)
        self.output = TubeOutput(self)
        super().__init__(values, grains=grains, walls=self.box.walls,
                         stages={"settling": v.settling, "vibration": v.vibrating})
        fastest = 1 / (LEAST_VISITS * self.time_step)
        require(v.amplitude == 0 or v.frequency <= fastest, "frequency", v.frequency, f"at most {fastest:.3g}, so that "
                f"a period has {LEAST_VISITS} time steps of {self.time_step:.3g} s", "Hz")

    def own_engines(self):
        v = self.v
        if v.amplitude == 0:
            return []
        period = max(1, int(1 / (VISITS * v.frequency * self.time_step)))
        self.vibration = Vibration(amplitude=v.amplitude, frequency=v.frequency, direction=DIRECTIONS[v.direction],
                                   gravity=v.gravity, period=period,
                                   clock=lambda: self.time - self.clock if self.stage == 1 else None)
        return [self.vibration]

    def tube_mass(self):
        """kg of the grains whose centres are in the tube."""
        places, left = self.positions()
        return float(self.grains.masses[left[places[:, 0] > 0]].sum())

    def acceleration(self):
        """Peak acceleration of the box over gravity."""
        return self.v.amplitude * (2 * math.pi * self.v.frequency)**2 / self.v.gravity


class TubeOutput(GranularOutput):
    """What the folder of a vibrated tube shows."""

    def log(self):
        return {**super().log(), "tube_mass": (self.scene.tube_mass(), "kg")}

    def results(self):
        """{name: (value, unit)}: masses in the tube, and the mean rate of inflow while the box vibrates."""
        scene, columns = self.scene, self.scene.recorder.columns()
        mass, time, stage = (columns.get(name, np.zeros(0)) for name in ("tube_mass", "time", "stage"))
        now, at_first = scene.tube_mass(), float(mass[stage == 0][-1]) if (stage == 0).any() else 0.0
        vibrated = scene.time - scene.v.settling
        capacity = 0.6 * scene.v.density * scene.box.tube_volume
        last = (stage == 1) & (time > time.max(initial=0.0) - 0.25 * scene.v.vibrating)
        slope = float(np.polyfit(time[last], mass[last], 1)[0]) if np.count_nonzero(last) > 2 else math.nan
        return {"tube_mass": (now, "kg"), "tube_mass_by_gravity": (at_first, "kg"),
                "tube_fill": (now / capacity, "-"), "tube_fill_by_gravity": (at_first / capacity, "-"),
                "inflow_rate": ((now - at_first) / vibrated if vibrated > 0.5 * scene.time_step else 0.0, "kg/s"),
                "inflow_rate_end": (slope, "kg/s"), "peak_acceleration": (scene.acceleration(), "g"),
                **self.common_results()}

    def warnings(self):
        found, scene = super().warnings(), self.scene
        places, left = scene.positions()
        outside = ~((places[:, 0] > -scene.v.width) & (places[:, 0] < scene.v.tube_length) & (places[:, 1] > 0)
                    & (abs(places[:, 2]) < 0.5 * scene.v.depth))
        if outside.any():
            found.append(f"{np.count_nonzero(outside)} grains have left the box: a stiffer grain (young) or a smaller "
                         "amplitude keeps them")
        return found

    def model(self):
        box = self.scene.box
        return {**super().model(), "tube": np.array([box.diameter, box.length, box.axis]),
                "box": np.array([box.width, box.height, box.depth])}

    def progress(self):
        return f"{1e3 * self.scene.tube_mass():.3g} g in the tube"

"""The steady cut: a tool on a straight way through a rock mass without end, of which a window moves along with it."""
import math
from types import SimpleNamespace

import numpy as np
from yade import O

from rockwear.engines.access import rock_positions
from rockwear.engines.bond_log import INTACT
from rockwear.kernels.checks import require
from rockwear.kernels.cut_sizes import cut_sizes
from rockwear.kernels.fragments import chip_length
from rockwear.kernels.groove import groove_results
from rockwear.kernels.parameter import Group, Parameter, Presets, choice, length, length_or_zero, number, zero_or
from rockwear.kernels.polygon import reach
from rockwear.kernels.rigid_motion import Straight
from rockwear.kernels.steady_record import (
    CELL, ENOUGH_CHIPS, LONG_ENOUGH, is_known, steady_results, uncertainty, with_error)
from rockwear.model.rock_mass import SLABS, RockMass
from rockwear.scenes import parameters, parts
from rockwear.scenes.by_hand import heated_length, tip_by_hand, worn_by_hand
from rockwear.scenes.cut import Cut
from rockwear.scenes.cut_record import CHIPS, GROOVE, CutRecord, table
from rockwear.scenes.output import crack_table
from rockwear.scenes.physics import Boundary
from rockwear.scenes.programme import Programme
from rockwear.scenes.rock_window import RockWindow

LEAST_SPEED = 0.05
"""Part of the cutting velocity with which the ramp of speed begins."""
SAMPLING_PERIOD = 3
"""Steps between samples of the contacts of a tool of particles."""
END = 0.1
"""Part of the way at its end whose mean is the temperature of the tip at the end."""
BOUNDARIES = "absorbing", "fixed", "free"


class OfTheCut(Presets):
    """kernels.cut_sizes: what the depth of cut and the number of discs in it give."""

    def defaults(self, value, values):
        sizes = cut_sizes(values["depth_of_cut"], value, velocity=values["velocity"],
                          blunt=4 * values["tip_radius"] + values["wear_flat"], rake=math.radians(values["rake"]))
        return {**sizes, "sampling_period": SAMPLING_PERIOD} if values["tool"] == "particles" else sizes


WINDOW = Group("rock", (
    Parameter("discs_per_depth", 0.0, "", zero_or(4, 64), "rock discs in the depth of cut, 16 for a result: gives the "
              "radii of rock and tool, window, grading, tooth, ramp_length and periods; 0: they are given",
              "ours", presets=OfTheCut()),
    Parameter("window_behind", 0.03, "m", length, "length of the window behind the tip"),
    Parameter("window_ahead", 0.06, "m", length, "length of the window ahead of the tip"),
    Parameter("window_height", 0.04, "m", length, "height of the window"),
    Parameter("boundary", BOUNDARIES[0], "", choice(*BOUNDARIES), "of the window: springs and dashpots of the rock "
              "beyond; nothing moves; or the same at the bottom alone"),
    *(p for p in parameters.SPECIMEN.parameters if p.name not in ("width", "height"))))
STEADY = Group("motion", (
    *(p for p in parameters.CUT_MOTION if p.name != "approach"),
    Parameter("cut_length", 0.1, "m", length, "way of the tool"),
    Parameter("accuracy", 0.0, "", zero_or(1e-3, 1), "standard error of the mean cutting force over it: the cut ends "
              "where it is as small, and was in two thirds of a record that is long enough, or after cut_length; 0: "
              "after cut_length"),
    Parameter("ramp_length", 5e-3, "m", length_or_zero, "way on which the tool comes to its velocity, from a groove "
              "that fits it"),
    Parameter("free_chips", "stay", "", choice("stay", "leave"), "what chips do that nothing touches: a fast tool "
              "meets them again, a slow one does not", "calibration/results/steady_cut.md"),
    Parameter("begin_angle", 20.0, "deg", number(5, 90), "slope on which the rock rises ahead of the tool at first, as "
              "behind a chip; 90: as the face of the tool"),
    parameters.DAMPING, *parameters.OTHER_DAMPING))
GROUPS = parameters.with_defaults([
    WINDOW, parameters.BONDS, parameters.PLANE_TOOL, parameters.CONTACT, STEADY, parameters.WEAR, parameters.HEAT,
    parameters.ACCURACY, parameters.DENSITY_MAP], rock_sampling_period=7, time_step_fraction=0.95)


def groups(**defaults):
    """The scene's parameter groups with other defaults."""
    return parameters.with_defaults(GROUPS, **defaults)


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError."""
    v = SimpleNamespace(**values)
    parts.check_radii(v)
    check_window(v)
    outline = parts.outline(v)
    parts.check_height(v, outline, "depth_of_cut", v.depth_of_cut)
    tool = parts.plane_tool(v, outline)
    # The rock takes longest to pack: all else is refused before.
    rock = RockMass(width=v.window_behind + v.window_ahead, height=v.window_height, radius_min=v.radius_min,
                    radius_max=v.radius_max, porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap,
                    grading_factor=v.grading_factor, fine_depth=v.fine_depth, density=v.rock_density)
    path = v.window_height - v.depth_of_cut
    rock.leave_out(above_groove(rock, outline + [v.window_behind, path], path, slope=math.radians(v.begin_angle),
                                edge=v.window_behind - v.tip_radius))
    record = CutRecord(rock=rock, start=(v.window_behind, path))
    programme = SteadyCut(
        velocity=v.velocity * v.time_scale, cut_length=v.cut_length, ramp_length=v.ramp_length, accuracy=v.accuracy,
        start=(v.window_behind, path), record=record, chips_leave=v.free_chips == "leave", strip=heated_length(v),
        window=RockWindow(rock=rock, behind=v.window_behind, held_below=v.window_height - 2 * v.depth_of_cut,
                          sides=v.boundary != "free", record=record))
    return Cut(tool=tool, programme=programme, rock=parts.bond(rock, v), time_scale=v.time_scale,
               boundary=Boundary(v.boundary),
               background_damping=v.background_damping, **parts.common(v))


def check_window(v):
    """Raise ParameterError for a window in which there is no room for the cut."""
    require(2 * v.radius_max < v.depth_of_cut < 0.5 * v.window_height, "depth_of_cut", v.depth_of_cut,
            f"more than a rock particle, {2 * v.radius_max:g}, and less than half of window_height = "
            f"{v.window_height:g}", "m")
    require(v.window_ahead >= 4 * v.depth_of_cut, "window_ahead", v.window_ahead,
            f"at least four times depth_of_cut = {v.depth_of_cut:g}: chips are as long", "m")
    blunt = 0.0 if v.outline else v.tip_radius + v.wear_flat
    require(v.window_behind >= max(2 * v.depth_of_cut, v.depth_of_cut + blunt), "window_behind", v.window_behind,
            f"at least twice depth_of_cut = {v.depth_of_cut:g}, and it and tip_radius + wear_flat = {blunt:g}", "m")
    lift = 0.0 if v.outline else v.wear_flat * math.sin(math.radians(v.flat_angle))
    require(lift <= 0.5 * v.depth_of_cut, "wear_flat", v.wear_flat,
            f"such that its edge is at most half of depth_of_cut = {v.depth_of_cut:g} above its heel: with "
            f"flat_angle = {v.flat_angle:g} deg it is {lift:.3g}", "m")
    slab = (v.window_behind + v.window_ahead) / SLABS
    require(slab >= 2 * v.radius_max, "radius_max", v.radius_max,
            f"at most {slab / 2:g}: half of a slab of the window", "m")
    require(v.cut_length > v.ramp_length, "cut_length", v.cut_length, f"more than ramp_length = {v.ramp_length:g}", "m")


def above_groove(rock, outline, path, *, slope, edge):
    """(n,) bool: particles of the rock that reach above the way of the tool at y = `path` (m) behind its front, or
    above a plane that rises from its cutting edge.

    outline: (k, 2) m, the tool where it begins; slope: rad, of the plane; edge: m, x of the cutting edge, which is not
    the tool's lowest place where a flat leans.
    """
    (x, y), r = rock.positions.T, rock.radii
    heights = np.linspace(-1.0, 1.0, 9)[:, None] * r + y
    front = np.where(heights > path, reach(outline, np.maximum(heights, path)), -np.inf).max(axis=0)
    # How far a disc reaches above the plane.
    over = (y - path) * math.cos(slope) - (x - edge) * math.sin(slope) + r
    return (y + r > path) & ((x - r < front) | (over > 0))


class SteadyCut(Programme):
    """A tool that comes up to its velocity in a groove that fits it and then cuts on at a constant depth.

    velocity: m/s of the mechanics; cut_length, ramp_length: m; accuracy: of the mean cutting force, at which the cut
    ends before, 0: it does not; start: (2,) m, where the tool's origin begins; window: RockWindow; record: CutRecord of
    what leaves it; chips_leave: whether chips that nothing touches leave at the end of a chunk of steps; strip: m of
    the tool's outline that friction heats by hand, 0: not known.
    """

    def __init__(self, *, velocity, cut_length, ramp_length, accuracy, start, window, record, chips_leave,
                 strip):
        super().__init__(Straight(start=start, velocity=(velocity, 0.0)), {"stage_names": np.array(["cut"])})
        self.origin = start
        self.velocity, self.cut_length, self.ramp_length = velocity, cut_length, ramp_length
        self.accuracy, self.window, self.record, self.chips_leave = accuracy, window, record, chips_leave
        self.strip = strip
        self.way, self.speed, self.since = 0.0, 0.0, 0

    def stages(self):
        return {"cut": (self.cut_length + self.ramp_length) / self.velocity * self.scene.time_scale}

    def begin(self):
        super().begin()
        self.since = O.iter
        self.window.begin(self.scene)

    @property
    def distance(self):
        """m that the tool has gone."""
        return self.way + self.speed * (O.iter - self.since) * self.scene.time_step

    def run(self):
        before, self.way, self.since = self.way, self.distance, O.iter
        if self._is_known(before):
            self.scene.stages[self.scene.stage] = "cut", self.step
            return True
        self.window.follow(self.way)
        if self.chips_leave:
            self.window.remove_free_chips(self.way)
        self.since = O.iter
        ramp = 2 * self.ramp_length / self.velocity
        reached = (self.step + 0.5 * self.scene.chunk) * self.scene.time_step
        speed = self.velocity * (min(1.0, max(LEAST_SPEED, reached / ramp)) if ramp else 1.0)
        if speed != self.speed:
            self.speed = speed
            self.scene.tool.bodies.go_on((speed, 0.0))
        return False

    def _is_known(self, before):
        """Whether the mean force is known well enough; asked once in so many depths of cut. before: m, the way when it
        was asked last."""
        asked = CELL * self.scene.depth_of_cut
        if not (self.accuracy > 0 and self.way // asked > before // asked):
            return False
        columns = self.scene.recorder.columns()
        return bool(columns) and is_known(self.accuracy, **self._forces(columns))

    def _forces(self, columns):
        """What steady_results takes."""
        return dict(distance=columns["distance"], cutting=columns["cutting_force"], thrust=columns["thrust_force"],
                    friction_work=columns["tool_friction"], depth=self.scene.depth_of_cut)

    def log(self):
        return {"distance": (self.distance, "m")}

    def _record(self):
        """(groove (k, 2), chips (l, 6)) up to now, without what lies within a depth of cut of the tip."""
        behind = self.origin[0] + self.distance - self.scene.depth_of_cut
        groove, chips = self.record.whole(positions=rock_positions(self.scene.rock), distance=self.distance,
                                          behind=behind, intact=self.scene.bonds.status == INTACT)
        return np.array(groove).reshape(-1, len(GROOVE)), np.array(chips).reshape(-1, len(CHIPS))

    def results(self, columns):
        found = {}
        if columns:
            found = steady_results(**self._forces(columns))
            begin = found["transient"][0]
            (x, height), chips = (part[part[:, 0] > begin].T for part in self._record())
            found.update(groove_results(x=x, height=height, chip=found["peak_spacing"][0]))
            length = chip_length(particles=chips[1], area=chips[2], length=chips[3])
            found.update(with_error("chip_length", length, "m"))
            found["peak_cutting_force"] = float(columns["cutting_force"].max()), self.scene.units.force
            found.update(self._by_hand(columns))
        return {**found, **self.window.results()}

    def _by_hand(self, columns):
        """scenes.by_hand of the whole record, beside the hottest of the tool at its end."""
        scene, way, work = self.scene, columns["distance"], float(columns["tool_friction"][-1])
        worn = scene.tool.work_fraction * worn_by_hand(
            scene.tool.wear, temperature=scene.first_temperature, distance=way, thrust=columns["thrust_force"])
        found = {"worn_volume_by_hand": (worn, scene.units.volume)}
        if scene.heat_model:
            end = columns["tool_temperature_max"][way >= (1 - END) * way[-1]]
            found["tool_temperature_end"] = float(end.mean()), "K"
            if self.strip and work > 0:
                names = "tool_temperature_by_hand", "tool_temperature_by_blok"
                tip = tip_by_hand(scene.heat_model, strip=self.strip, velocity=self.velocity / scene.time_scale,
                                  distance=float(way[-1]), friction_work=work)
                found.update((name, (kelvin, "K")) for name, kelvin in zip(names, tip))
        return found

    def warnings(self):
        cracks, columns = self.scene.bonds.cracks, self.scene.recorder.columns()
        found = self.window.warnings(cracks)
        if not cracks:
            found.append("no bond broke: the tool was pressed into the rock, and cut nothing")
        forces = steady_results(**self._forces(columns)) if columns else {}
        if forces and not forces["long_enough"][0]:
            found.append(f"means are of {forces['steady_length'][0] / self.scene.depth_of_cut:.1f} depths of cut and "
                         f"{forces['peaks'][0]} chips after the transient: a cut_length for {LONG_ENOUGH} and "
                         f"{ENOUGH_CHIPS} makes their errors reliable")
        known = uncertainty(forces) if self.accuracy and forces else 0.0
        if known > self.accuracy:
            far = (f"is known to {100 * known:.0f} %" if known < math.inf else
                   "is of a record too short to rely on its error")
            found.append(f"the mean cutting force {far}, and was to be known to {100 * self.accuracy:g} %: a longer "
                         "cut_length tells it")
        return found

    def tables(self, ended):
        groove, chips = self._record()
        x, y = self.origin
        cracks = [crack._replace(x=crack.x - x, y=crack.y - y) for crack in self.scene.bonds.cracks]
        return {"groove.csv": table(GROOVE, groove.tolist()), "chips.csv": table(CHIPS, chips.tolist()),
                **crack_table(cracks)}

    def state(self):
        return {**super().state(), "window": self.window.state(), "record": self.record.state(), "way": self.way,
                "speed": self.speed, "since": self.since}

    def restore(self, state):
        super().restore(state)
        self.way, self.speed, self.since = float(state["way"]), float(state["speed"]), int(state["since"])
        self.window.restore(state["window"], self.scene)
        self.record.restore(state["record"])

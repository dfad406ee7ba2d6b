"""Dredging: a pick of a cutter head that swings and turns cuts rock, and cools in water in between [Rojek 2014, ch.
5]."""
import math
from types import SimpleNamespace

import numpy as np

from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.boundary import foremost, segments
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import (
    Fixed, Group, Parameter, above_zero, duration, flag, integer, law_parameters, length, number)
from rockwear.kernels.polygon import nearest_on_edges, tip
from rockwear.kernels.rigid_motion import SwingAndRotation
from rockwear.kernels.strip import ArcStrip
from rockwear.model.rock import CutOut, Specimen
from rockwear.model.rock_mass import SLABS, RockMass
from rockwear.scenes import parameters, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.physics import Boundary
from rockwear.scenes.rock_window import RockWindow
from rockwear.scenes.turns import Turns

WIDEST_WINDOW = 2.0
"""rad about the axis of rotation: a longer one comes too near to a full turn."""
LAST_ANGLE = 170.0
"""deg from the lowest point of the path, before which cut and rock end: at 180 the chip has no thickness."""
STRENGTHS = {p.name: p.size_power[0] for p in law_parameters(BOND_LAWS, "bond_law") if p.size_power[0]}
SCALED = {"radius_min": 1, "radius_max": 1, **STRENGTHS}
"""Powers of scale_factor with which parameters grow: the macroscopic strength stays."""
WITHOUT = {"width", "height", "grading_factor", "fine_depth", "velocity", "depth_of_cut", "start_up", "cycle_time",
           "cycles"}
"""Parameters of a straight cut through a box."""
ROCK = (
    Parameter("full", False, "", flag, "the defaults of scale_factor, backing and window that give the source's 92,000 "
              "discs", presets=Fixed(scale_factor=1.0, backing=0.436, window=False)),
    Parameter("backing", 0.06, "m", length, "rock behind the path of the pick, fixed at its far side"),
    Parameter("window", True, "", flag, "rock only near the tip, in a window that moves along with the pick; false: "
              "all rock along the path is there from the start"),
    Parameter("window_behind", 0.12, "m", length, "length of the window behind the tip", when={"window": (True,)}),
    Parameter("window_ahead", 0.14, "m", length, "its length ahead of the tip", when={"window": (True,)}),
    Parameter("run_out", 0.06, "m", length, "rock ahead of the pick at the end of the cut",
              when={"window": (False,)}),
    Parameter("scale_factor", 4.0, "", number(1, 10), "factor on the radii of rock and, for the same macroscopic "
              "strength, on the strengths of its bonds; 1: the source's"))
MOTION = (
    Parameter("feed", 0.06, "m", length, "swing between two picks on the same track; the free surface of the rock "
              "is the path of the pick before, and the chip feed x sin(angle) thick",
              "ours: [Rojek 2014] has a figure only"),
    Parameter("cutter_radius", 0.7, "m", length, "distance of the tip from the axis of rotation",
              "[Rojek 2014, 5.1]"),
    Parameter("angular_velocity", 1.6204, "rad/s", above_zero, "of the cutter head", "[Rojek 2014, 5.1]"),
    Parameter("swing", 0.2, "m/s", number(0), "velocity of the cutter head", "[Rojek 2014, 5.1]"),
    Parameter("entry_angle", 25.0, "deg", number(1, 150), "from the lowest point of the path, where the pick enters",
              "ours: [Rojek 2014] has a figure only"),
    Parameter("cut_time", 0.65, "s", duration, "of cutting in a turn", "[Rojek 2014, 5.3]"),
    Parameter("cycles", 3, "", integer(1, parameters.MOST_CYCLES),
              "turns, each a cut into fresh rock and cooling in water", "[Rojek 2014, 5.3]"),
    Parameter("cooling_period", 0.01, "s", duration, "between steps while the pick cools"))
OUTPUT = Group("output", (Parameter("snapshot_period", 0.05, "s", duration, "between the pictures of the report"),))


def groups():
    """The scene's parameter groups."""
    found = []
    bonds = Group("bonds", (parameters.rock_parameter(scaled=STRENGTHS), *parameters.BOND_PARAMETERS))
    for group in (parameters.SPECIMEN, bonds, parameters.PLANE_TOOL, parameters.CONTACT, parameters.CYCLES,
                  parameters.WEAR, parameters.HEAT, parameters.ACCURACY, parameters.DENSITY_MAP):
        own = {"rock": ROCK, "motion": MOTION}.get(group.title, ())
        kept = tuple(p for p in group.parameters if p.name not in WITHOUT)
        found.append(Group(group.title, (*own, *kept), group.when))
    return parameters.with_defaults(
        [*found, OUTPUT], kt=4e9, Rn=0.1e6, Rt=0.1e6, mu=0.8, tooth_height=0.15, tooth_width=0.15, rake=10.0,
        clearance=20.0,
        tip_radius=0.008, tool_radius_min=1e-3, tool_radius_max=1e-3, tool_kn=50e9, tool_kt=50e9, tool_mu=0.4,
        contact_damping=0.0, approach=1e-3, time_scale=5.0, hardness_table="MET71",
        wear_coefficient=0.0025, wear_acceleration=1e4, rock_expansion=1e-5, convection=5000.0,
        ambient_temperature=283.0,
        rock_temperature=283.0, tool_temperature=283.0,
        # Of the friction in the rock, 44 % of the work of 19 ms in a cut, 2, 4 and 8 steps between samples miss or add
        # 0.7, 2.6 and 7.1 %, at 0.60, 0.49 and 0.36 of the time that samples of every step take (steps of half the
        # critical one).
        rock_sampling_period=2, heat_period=1e-3, surface_period=0.01, record_period=2e-3)


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError.

    One pick of a dredge cutter head: cut, cool in water, and again, each time into fresh rock. The head swings along
    +x and turns counter-clockwise, so that the pick cuts upwards in front of it (undercutting). The rock is the part
    of the rock
    mass that feels the pick: from the path of the pick before it on the same track, which is the free surface, to
    `backing` behind its own path. Each turn is a cut of `cut_time` and cooling for the rest of 2 pi /
    angular_velocity. While nothing touches the tool the mechanics stand still, and only heat flows.

    With a window the rock is a rock mass along an arc: it goes on behind the entry, below the pick's path, and ahead of
    the end of the cut. Only the part of it near the tip is there, held by an absorbing boundary at its ends
    and at its far side. Its particles grow with the distance from the arc's centre. Each turn begins anew with the
    window that the approach left: what slabs took along in the turn before, chips and cracks, is gone.
    """
    scaled = {name: values["scale_factor"]**power * values[name] for name, power in SCALED.items() if name in values}
    v = SimpleNamespace(**{**values, **scaled})
    v.depth_of_cut = v.feed
    parts.check_radii(v)
    turn_time = 2 * math.pi / v.angular_velocity
    check_cut(v, turn_time)
    vertices = parts.outline(v)
    track = Track(v, vertices)
    window = track.window(v) if v.window else None
    rock = parts.bond(window.rock, v) if window else track.rock(v)
    programme = Turns(motion=track.motion(v.time_scale),
                      approach_time=v.approach / (v.cutter_radius * v.angular_velocity), cut_time=v.cut_time,
                      turn_time=turn_time, cycles=v.cycles, cooling_period=v.cooling_period, chip_area=track.chip_area,
                      arrays={"free_surface": track.free_surface, "own_path": track.own_path}, window=window,
                      tip=track.tip)
    return Cut(rock=rock, tool=parts.plane_tool(v, vertices), programme=programme, time_scale=v.time_scale,
               boundary=Boundary("absorbing") if window else None,
               background_damping=v.background_damping, **parts.common(v))


def check_cut(v, turn_time):
    """Raise ParameterError for a cut that does not fit into a turn or into the rock, or is none by the head's turn."""
    require(v.cutter_radius > v.feed, "cutter_radius", v.cutter_radius, f"more than feed = {v.feed:g}", "m")
    tip_speed = v.cutter_radius * v.angular_velocity
    require(tip_speed > v.swing, "angular_velocity", v.angular_velocity, f"more than {v.swing / v.cutter_radius:.3g}, "
            f"so that the pick turns faster than it moves with swing = {v.swing:g} m/s", "rad/s")
    require(v.cut_time < turn_time, "cut_time", v.cut_time, f"less than a turn, {turn_time:g}", "s")
    last = v.entry_angle + math.degrees(v.angular_velocity * v.cut_time)
    require(last < LAST_ANGLE, "cut_time", v.cut_time,
            f"so short that the cut, from {v.entry_angle:g} degrees on, ends before {LAST_ANGLE:g} degrees", "s")
    require(tip_speed * v.cut_time > 2 * v.radius_max, "cut_time", v.cut_time, "so long that the cut, "
            f"{tip_speed * v.cut_time:.3g} m, is longer than a rock particle, {2 * v.radius_max:g}", "s")
    thinnest = v.feed * min(math.sin(math.radians(v.entry_angle)), math.sin(math.radians(last)))
    require(thinnest > 2 * v.radius_max, "feed", v.feed, f"so large that the chip, {thinnest:g} m at its thinnest, "
            f"is thicker than a rock particle, {2 * v.radius_max:g}", "m")
    require(v.backing > 6 * v.radius_max, "backing", v.backing,
            f"more than three rock particles, {6 * v.radius_max:g}", "m")
    require(v.backing <= v.cutter_radius, "backing", v.backing, f"at most cutter_radius = {v.cutter_radius:g}", "m")
    if v.window:
        check_window(v)
    else:
        longest = v.cutter_radius * math.radians(LAST_ANGLE - last)
        require(v.run_out < longest, "run_out", v.run_out, f"less than {longest:.3g}, so that the rock, whose cut ends "
                f"at {last:.3g} degrees, ends before {LAST_ANGLE:g} degrees", "m")


def check_window(v):
    """Raise ParameterError for a window in which there is no room for the cut."""
    require(v.window_ahead >= 2 * v.feed, "window_ahead", v.window_ahead,
            f"at least twice feed = {v.feed:g}: chips are longer than they are thick", "m")
    require(v.window_behind >= v.feed, "window_behind", v.window_behind, f"at least feed = {v.feed:g}", "m")
    whole, longest = v.window_behind + v.window_ahead, WIDEST_WINDOW * v.cutter_radius
    require(whole <= longest, "window_behind + window_ahead", whole,
            f"at most {longest:g}, an arc of {WIDEST_WINDOW:g} rad about the axis of rotation", "m")
    slab = (v.window_behind + v.window_ahead) / SLABS
    require(slab >= 2 * v.radius_max, "window_ahead", v.window_ahead,
            f"at least {SLABS * 2 * v.radius_max - v.window_behind:g}: a slab of the window takes a rock particle", "m")


class Track:
    """The path of the pick through the rock, and of the pick before it. vertices: (k, 2) m, the pick's outline."""

    def __init__(self, v, vertices):
        self.tip = tip(vertices)
        parts.check_height(v, vertices, "feed", v.feed)
        front = foremost(*segments(vertices), self.tip[1] + v.feed) - self.tip[0]
        self.pivot = self.tip + (0.0, v.cutter_radius)
        self.ahead = (v.approach + v.radius_max + front) / v.cutter_radius
        """rad by which the pick starts before its entry."""
        self.begin = math.radians(v.entry_angle) - self.ahead
        self.radius, self.swing, self.spin = v.cutter_radius, v.swing, v.angular_velocity
        self._lay_out(v)

    def _lay_out(self, v):
        first = self.ahead / self.spin
        last = first + v.cut_time + v.run_out / (self.radius * self.spin)
        start, end = self.swing * first, self.swing * last
        angle = np.linspace(self.begin + self.spin * first, self.begin + self.spin * last, 60)
        own, far = self._arc(angle, self.radius), self._arc(angle, self.radius + v.backing)
        before = self._arc(np.linspace(angle[0] - 1.0, angle[-1] + 1.0, 240), self.radius)
        before[:, 0] -= v.feed
        # The free surface from the entry's radius to the last one. The path goes on past 180 degrees.
        seen = [np.unwrap(np.arctan2(before[:, 0] - x, -before[:, 1])) for x in (start, end)]
        free = before[(seen[0] >= angle[0]) & (seen[1] <= angle[-1])]
        self.free, self.own, self.far, self.ends = free, own, far, (start, end)
        self.chip_area = v.feed * self.radius * (math.cos(angle[0]) - math.cos(angle[0] + self.spin * v.cut_time))

    def _place(self, points):
        """Put the origin where all points (n, 2) m have coordinates of at least 0. -> (2,) m, their extent."""
        self.origin = -points.min(axis=0)
        return tuple(np.ptp(points, axis=0).tolist())

    @property
    def free_surface(self):
        """(k, 2) m, the path of the pick before."""
        return self.free + self.origin

    @property
    def own_path(self):
        """(k, 2) m of the tip."""
        return self.own + self.origin

    def _arc(self, angle, radius):
        """Points (n, 2) m at `radius` from the centre, which is at the origin at first."""
        x = self.swing * (angle - self.begin) / self.spin + radius * np.sin(angle)
        return np.column_stack([x, -radius * np.cos(angle)])

    def motion(self, time_scale):
        """The motion that brings the tip to the entry of the rock, `time_scale` times as fast as the process."""
        return SwingAndRotation(centre=self.origin, swing=(self.swing * time_scale, 0.0),
                                angular_velocity=self.spin * time_scale, pivot=self.pivot, start=self.begin)

    def rock(self, v):
        """The rock along the track, fixed at its far side and where no chip can reach its ends."""
        polygon = np.vstack([self.free, self.far[::-1]])
        width, height = self._place(polygon)
        whole = Specimen(width=width, height=height, radius_min=v.radius_min, radius_max=v.radius_max,
                         porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap, density=v.rock_density)
        rock = CutOut(whole, polygon=polygon + self.origin, bonding_gap=v.bonding_gap)
        depth = [np.linalg.norm(rock.positions - self.origin - (x, 0.0), axis=1) - self.radius for x in self.ends]
        sides = [_distance(rock.positions, self.far + self.origin)] + [
            np.where(below > 0.5 * v.backing, _distance(rock.positions,
                     np.array([self.own[k], self.far[k]]) + self.origin), np.inf)
            for k, below in zip((0, -1), depth)]
        rock.fixed = np.min(sides, axis=0) < 2 * v.radius_max
        return parts.bond(rock, v)

    def window(self, v):
        """The window of a rock mass along the arc nearest to the path of the tip.

        At first it reaches from window_behind behind the tip to window_ahead ahead of it. Behind the entry the rock
        ends at the tip's own path, from there on at the path of the pick before.
        """
        width = v.window_behind + v.window_ahead
        entry = self.begin + self.ahead
        last = entry + self.spin * v.cut_time + (v.window_ahead + width / SLABS) / self.radius
        path = self._arc(np.linspace(self.begin, last, 200), self.radius)
        strip = ArcStrip.through(path, level=v.backing, x=v.window_behind)
        entry, end = strip.unroll(self._arc(np.array([entry, last]), self.radius))[:, 0]
        wide = self._arc(np.linspace(self.begin - 0.2 - v.window_behind / self.radius, last + 0.2, 1000), self.radius)
        own, free = strip.unroll(wide), strip.unroll(wide - (v.feed, 0.0))
        own, free = own[own[:, 0] < entry] - (0.0, v.radius_max), free[free[:, 0] >= entry]
        height = float(free[free[:, 0] < end, 1].max()) + v.radius_max
        along = np.linspace(0.0, end, 200)
        extent = self._place(np.vstack([strip.place(np.column_stack([along, np.full(200, y)])) for y in (0, height)]))
        rock = RockMass(
            width=width, height=height, radius_min=v.radius_min, radius_max=v.radius_max, porosity=v.porosity,
            seed=v.seed, bonding_gap=v.bonding_gap, density=v.rock_density, extent=extent,
            strip=ArcStrip.through(path + self.origin, level=v.backing, x=v.window_behind),
            surface=np.vstack([own, free]).T)
        return RockWindow(rock=rock, behind=v.window_behind, held_below=0.5 * v.backing)


def _distance(points, line):
    """(n,) m, distance of points from a line of segments (k, 2)."""
    foot, _ = nearest_on_edges(points, line[:-1], np.diff(line, axis=0))
    return np.linalg.norm(points - foot, axis=1)

"""Dredging: a pick of a cutter head that swings and turns cuts rock, and cools in water in between (P 5, M 12)."""
import math

import numpy as np
from scipy.spatial import cKDTree

from rockwear.scenes.cutting import Cutting, parameters
from rockwear.kernels.checks import require
from rockwear.kernels.conduction import HeatNetwork, calibrated_conductance
from rockwear.kernels.polygon import nearest_on_edges
from rockwear.kernels.packing import contacts
from rockwear.kernels.rigid_motion import SwingAndRotation
from rockwear.kernels.parameter import Parameter, above_zero, flag, integer, number
from rockwear.model.rock import CutOut

COOLING_CHUNK = 20
"""Cooling steps between two looks at the clock."""
TURNS = 40
"""Turns for which the mean heating of the cuts is repeated."""
HOTTEST = 0.01
"""Part of the tool's mass whose mean temperature is recorded beside that of the hottest particle."""


def dredging_parameters(full):
    """The parameters of the scene; full: with the discs of P, some 92,000, as defaults."""
    size = dict(scale_factor=1.0, backing=0.436) if full else dict(scale_factor=4.0, backing=0.06)
    own = [
        Parameter("full", False, "", flag, "the defaults of scale_factor and backing that give P's 92,000 discs of rock"),
        Parameter("scale_factor", size["scale_factor"], "", number(1, 10), "factor on the radii of rock and, for the same "
                  "macroscopic strength, on the strengths of its bonds; 1: P's"),
        Parameter("backing", size["backing"], "m", above_zero,
                  "rock behind the path of the pick, held at its far side"),
        Parameter("run_out", 0.06, "m", above_zero, "rock ahead of the pick at the end of the cut"),
        Parameter("feed", 0.06, "m", above_zero, "swing between two picks on the same track; the free surface of the "
                  "rock is the path of the pick before, and the chip feed x sin(angle) thick", "ours: P has a figure only"),
        Parameter("cutter_radius", 0.7, "m", above_zero, "distance of the tip from the axis of rotation", "P 5.1"),
        Parameter("angular_velocity", 1.6204, "rad/s", above_zero, "of the cutter head", "P 5.1"),
        Parameter("swing", 0.2, "m/s", number(0), "velocity of the cutter head", "P 5.1"),
        Parameter("entry_angle", 25.0, "deg", number(1, 150), "from the lowest point of the path, where the pick enters",
                  "ours: P has a figure only"),
        Parameter("cut_time", 0.65, "s", above_zero, "of cutting in a turn", "P 5.3"),
        Parameter("cycles", 3, "", integer(1), "turns, each a cut into fresh rock and cooling in water", "P 5.3"),
        Parameter("cooling_period", 0.01, "s", above_zero, "between steps while the pick cools"),
        Parameter("snapshot_period", 0.05, "s", above_zero, "between the pictures of the report"),
    ]
    gone = {"width", "height", "grading_factor", "fine_depth", "velocity", "depth_of_cut", "start_up", "cycle_time"}
    gone |= {parameter.name for parameter in own}
    return own + [p for p in parameters(
        kt=4e9, Rn=0.1e6, Rt=0.1e6, mu=0.8, tooth_height=0.15, tooth_width=0.15, rake=10.0, clearance=20.0,
        tip_radius=0.008, tool_radius_min=1e-3, tool_radius_max=1e-3, tool_kn=50e9, tool_kt=50e9, tool_mu=0.4,
        contact_damping=0.0, time_step_fraction=0.5, approach=1e-3, time_scale=5.0, hardness_table="MET71",
        wear_coefficient=0.0025, wear_acceleration=1e4,
        rock_expansion=1e-5, convection=5000.0,
        ambient_temperature=283.0, rock_temperature=283.0, tool_temperature=283.0,
        # Of the friction in the rock, 44 % of the work of 19 ms in a cut, 2, 4 and 8 steps between samples miss or add
        # 0.7, 2.6 and 7.1 %, at 0.60, 0.49 and 0.36 of the time that samples of every step take.
        rock_sampling_period=2, heat_period=1e-3, surface_period=0.01, record_period=2e-3) if p.name not in gone]


class Dredging(Cutting):
    """One pick of a dredge cutter head: cut, cool in water, and again, each time into fresh rock (P 5.1, M 12).

    The head swings along +x and turns counter-clockwise, so that the pick cuts upwards in front of it (undercutting).
    The rock is the part of the rock mass that feels the pick: from the path of the pick before it on the same track,
    which is the free surface, to `backing` behind its own path. Each turn is a cut of `cut_time` and cooling for the
    rest of 2 pi / angular_velocity. While nothing touches the tool the mechanics stand still, and only heat flows.
    """

    @property
    def cooling(self):
        """True while the pick turns in water. Stages: approach, then cut and cooling in turn."""
        return not self.finished and self.stage > 0 and self.stage % 2 == 0

    # ---- parameters and geometry

    def __init__(self, values):
        self.cooled = 0
        self.worn_heat = 0.0
        coarse = {name: values["scale_factor"] * values[name] for name in ("radius_min", "radius_max", "Rn", "Rt")}
        super().__init__({**values, **coarse})

    def _check_cut(self, v):
        self.turn_time = 2 * math.pi / v.angular_velocity
        require(v.cut_time < self.turn_time, "cut_time", v.cut_time, f"less than a turn, {self.turn_time:g}", "s")
        last = v.entry_angle + math.degrees(v.angular_velocity * v.cut_time)
        require(last < 170, "cut_time", v.cut_time,
                f"so short that the cut, from {v.entry_angle:g} degrees on, ends before 170 degrees", "s")
        thinnest = v.feed * min(math.sin(math.radians(v.entry_angle)), math.sin(math.radians(last)))
        require(thinnest > 2 * v.radius_max, "feed", v.feed, f"so large that the chip, {thinnest:g} m at its thinnest, "
                f"is thicker than a rock particle, {2 * v.radius_max:g}", "m")
        require(v.backing > 6 * v.radius_max, "backing", v.backing,
                f"more than three rock particles, {6 * v.radius_max:g}", "m")

    def _check_size(self, v, vertices):
        tip = vertices[np.argmin(vertices[:, 1])]
        height = float(np.ptp(vertices[:, 1]))
        require(height > v.feed, "tooth_height", height, f"more than feed = {v.feed:g}", "m")
        edge = np.linspace(vertices, np.roll(vertices, -1, axis=0), 50).reshape(-1, 2)
        front = edge[edge[:, 1] < tip[1] + v.feed, 0].max() - tip[0]
        self.pivot = tip + (0.0, v.cutter_radius)
        self.lead = (v.approach + v.radius_max + front) / v.cutter_radius

    def _head(self, v, time_scale, origin):
        """The motion that brings the tip to the entry of the rock, `time_scale` times as fast as the process."""
        return SwingAndRotation(centre=origin, swing=(v.swing * time_scale, 0.0), angular_velocity=v.angular_velocity * time_scale,
                                pivot=self.pivot, start=math.radians(v.entry_angle) - self.lead)

    def _specimen(self, v):
        head = self._head(v, 1.0, (0.0, 0.0))
        first, last = self.lead / v.angular_velocity, self.lead / v.angular_velocity + v.cut_time + v.run_out / (v.cutter_radius * v.angular_velocity)
        start, end = v.swing * first, v.swing * last
        angle = np.linspace(head.start + v.angular_velocity * first, head.start + v.angular_velocity * last, 60)
        own = _arc(angle, v.cutter_radius, v.swing, v.angular_velocity, head.start)
        far = _arc(angle, v.cutter_radius + v.backing, v.swing, v.angular_velocity, head.start)
        before = _arc(np.linspace(angle[0] - 1.0, angle[-1] + 1.0, 240), v.cutter_radius, v.swing, v.angular_velocity, head.start)
        before[:, 0] -= v.feed
        # The free surface from the entry's radius to the last one.
        seen = [np.arctan2(before[:, 0] - x, -before[:, 1]) for x in (start, end)]
        free = before[(seen[0] >= angle[0]) & (seen[1] <= angle[-1])]
        polygon = np.vstack([free, far[::-1]])
        origin = -polygon.min(axis=0)
        self.free_surface, self.own_path = free + origin, own + origin
        self.chip_area = v.feed * v.cutter_radius * (math.cos(angle[0]) - math.cos(angle[0] + v.angular_velocity * v.cut_time))
        width, height = np.ptp(polygon, axis=0)
        rock = CutOut(width=float(width), height=float(height), radius_min=v.radius_min, radius_max=v.radius_max,
                      porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap, density=v.rock_density,
                      polygon=polygon + origin)
        self.motion = self._head(v, v.time_scale, origin)
        # The rock mass goes on behind the far side, and beside the ends where no chip can reach them.
        depth = [np.linalg.norm(rock.positions - origin - (x, 0.0), axis=1) - v.cutter_radius for x in (start, end)]
        sides = [_near(rock.positions, far + origin)] + [
            np.where(below > 0.5 * v.backing, _near(rock.positions, np.array([own[k], far[k]]) + origin), np.inf)
            for k, below in zip((0, -1), depth)]
        rock.fixed = np.min(sides, axis=0) < 2 * v.radius_max
        return rock

    def _motion(self, v):
        return self.motion

    def _stages(self, v):
        stages = {"approach": v.approach / (v.cutter_radius * v.angular_velocity)}
        for n in range(1, v.cycles + 1):
            stages.update({f"cut {n}": v.cut_time, f"cooling {n}": self.turn_time - v.cut_time})
        return stages

    def _plan(self, stages):
        super()._plan(stages)
        self.stages = [(name, max(1, round(stages[name] / self.v.cooling_period)) if "cooling" in name else steps)
                       for name, steps in self.stages]
        self.cooling_step = (self.turn_time - self.v.cut_time) / self.stages[2][1]

    def _fitted_to_rock(self):
        # The rock is no box: its conductance is fitted to a square of the packing that it is cut out of.
        v, rock = self.v, self.rock
        positions, radii = rock.whole
        size = np.array([rock.width, rock.height])
        inside = np.all(abs(positions - size / 2) < min(size.min() / 2, 25 * v.radius_max), axis=1)
        return calibrated_conductance(positions=positions[inside], conductance=1.0, conductivity=v.rock_conductivity,
                                      edges=contacts(positions[inside], radii[inside], v.bonding_gap))[0]

    # ---- stages

    @property
    def step(self):
        return self.cooled if self.cooling else super().step

    @property
    def time(self):
        return self.clock + self.cooled * self.cooling_step if self.cooling else super().time

    def run_chunk(self):
        if not self.cooling:
            super().run_chunk()
            return
        for _ in range(min(COOLING_CHUNK, self.stages[self.stage][1] - self.cooled)):
            if self.heat:
                self.heat.cool(self.cooling_step)
            self.cooled += 1
            self.recorder.act()

    def _begin_stage(self, folder):
        self.cooled = 0
        if not self.cooling:
            super()._begin_stage(folder)
        elif self.heat:
            self.heat.leave_rock()

    def _foremost(self):
        """Every turn approach_steps the pick through the whole rock, however worn it is."""
        return 0.0

    def _make_engines(self):
        super()._make_engines()
        if self.heat:
            self.recorder.sources.append(self._heat_log)

    def _on_removal(self, worn, loose):
        if self.heat:
            network = self.heat.network
            capacity, before = network.capacity, network.balance["removed"]
        super()._on_removal(worn, loose)
        if self.heat:
            lost = float((capacity - network.capacity).sum())
            self.worn_heat += before - network.balance["removed"] - lost * self.v.tool_temperature

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "cooled": self.cooled, "worn_heat": self.worn_heat}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self.cooled = int(state["cooled"])
        self.worn_heat = float(state["worn_heat"])

    # ---- what a run's folder shows

    def _heat_log(self):
        hot, mean = self._hot_and_mean(self.heat.network)
        return {"tool_temperature_hot": (hot, "K"), "tool_temperature_mean": (mean, "K"),
                "water_heat": (-self.heat.network.balance["convected"], "J/m"),
                "pick_friction_heat": (float(self.heat.load.friction_heat.sum()), "J/m"),
                "pick_heat_worn_away": (self.worn_heat, "J/m")}

    def _hot_and_mean(self, network):
        """Mean temperatures (K) of the hottest part of the tool's mass, and of all of it."""
        capacity, temperature = network.capacity[self.rock.count:], network.temperature[self.rock.count:]
        order = np.argsort(-temperature)
        order = order[capacity[order] > 0]
        hottest = order[:max(1, round(HOTTEST * len(order)))]
        return (float(np.average(temperature[part], weights=capacity[part])) for part in (hottest, order))

    def repeated_turns(self, count):
        """Rows of turns.csv: the heating of all cuts so far, in the mean, again and again from the cold.

        Each tool particle takes the mean power of its friction, and exchanges heat with the water and, by the mean
        conductance, with the rock that it touched; then it cools. peak, cooled: K of the hottest part at the end of
        cutting and of cooling; mean: K of the whole then; absorbed, released: J/m of friction and to water and rock,
        which become equal in the stationary state (P 5.3). No heat goes with worn particles here.
        """
        state = self.heat.network.state()
        # Rock that has cooled down keeps out of the book.
        state["temperature"] = np.repeat([self.v.ambient_temperature, self.v.tool_temperature],
                                         [self.rock.count, self.tool.count])
        network = HeatNetwork(capacity=np.ones(len(state["capacity"])), edges=np.empty((0, 2), int), conductance=0.0,
                              temperature=0.0)
        network.restore(state)
        there = np.flatnonzero(self.heat.body.alive)
        # What particles took up that are gone since comes to the nearest that are left.
        heir = cKDTree(self.tool.positions[there]).query(self.tool.positions)[1]
        power, touch, rock_temperature = self.heat.averages()
        power, touch, warmth = (np.bincount(heir, values, len(there))
                                for values in (power, touch, touch * rock_temperature))
        tool, v = self.rock.count + there, self.v
        water = state["convection"][tool]
        wetted = np.divide(water * v.ambient_temperature + warmth, water + touch,
                           out=np.full(len(tool), v.ambient_temperature), where=water + touch > 0)
        rows = []
        for turn in range(1, count + 1):
            balance = network.balance
            network.source(tool, power)
            network.convect(tool, water + touch, wetted)
            network.advance(v.cut_time)
            peak, _ = self._hot_and_mean(network)
            network.source(tool, 0.0)
            network.convect(tool, water, v.ambient_temperature)
            network.advance(self.turn_time - v.cut_time)
            absorbed, released = (abs(network.balance[name] - balance[name]) for name in ("generated", "convected"))
            rows.append((turn, peak, *self._hot_and_mean(network), absorbed, released))
        return rows

    def tables(self):
        """Beside the cracks, where the pick's temperature would go in further turns."""
        found = super().tables()
        if self.heat and self.finished:
            header = ["turn [-]", "peak [K]", "cooled [K]", "mean [K]", "absorbed [J/m]", "released [J/m]"]
            found["turns.csv"] = header, self.repeated_turns(TURNS)
        return found

    def model(self):
        return {**super().model(), "free_surface": self.free_surface, "own_path": self.own_path}

    def _cut_area(self):
        cuts = self.stage // 2
        if self.stage % 2 and not self.finished:
            cuts += self.step / self.stages[self.stage][1]
        return self.chip_area * cuts

    def results(self):
        found, columns = super().results(), self.recorder.columns()
        stage = columns.get("stage", np.zeros(0))
        cutting = stage % 2 == 1
        for name in ("cutting_force", "thrust_force"):
            if cutting.any():
                found[f"mean_{name}"] = float(columns[name][cutting].mean()), "N/m"
        for n in range(1, self.v.cycles + 1):
            now = stage == 2 * n - 1
            if now.any():
                found[f"mass_lost_after_cut_{n}"] = float(columns["mass_lost"][now].max()), "-"
                for name in ("max", "hot") if self.heat else ():
                    found[f"peak_temperature_{name}_{n}"] = float(columns[f"tool_temperature_{name}"][now].max()), "K"
        return found


def _arc(angle, radius, swing, angular_velocity, start):
    """Points (n, 2) m at `radius` from the centre, which is at the origin when the cutter_radius is at `start` (rad)."""
    return np.column_stack([swing * (angle - start) / angular_velocity + radius * np.sin(angle), -radius * np.cos(angle)])


def _near(points, line):
    """(n,) m, distance of points from a line of segments (k, 2)."""
    foot, _ = nearest_on_edges(points, line[:-1], np.diff(line, axis=0))
    return np.linalg.norm(points - foot, axis=1)

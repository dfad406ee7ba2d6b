"""A pick's turns: cuts into fresh rock, and cooling in water, in which only heat flows [Rojek 2014, 5.3]."""
import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels.conduction import HeatNetwork, hot_and_mean
from rockwear.scenes.programme import Programme, forces

COOLING_CHUNK = 20
"""Cooling steps between two looks at the clock."""
REPEATED = 40
"""Turns for which the mean heating of the cuts is repeated."""


class Turns(Programme):
    """Approach, then cut and cooling in turn, each cut into the rock that the approach left.

    motion: of kernels.rigid_motion; approach_time, cut_time, turn_time: s of the process; cycles: turns;
    cooling_period: s between steps while the pick cools and the mechanics stand still; chip_area: m2 of rock that a
    cut goes through; arrays: {name: array} for the report; window: RockWindow, or None with all rock there; tip: (2,)
    m of the pick in its own frame, which a window follows. With a window each cut is into the rock of the window as the
    approach left it.
    """

    def __init__(self, *, motion, approach_time, cut_time, turn_time, cycles, cooling_period, chip_area, arrays,
                 window=None, tip=(0.0, 0.0)):
        super().__init__(motion, arrays)
        self.window, self.tip = window, tip
        self.approach_time, self.cut_time, self.turn_time = approach_time, cut_time, turn_time
        self.cycles, self.cooling_period, self.chip_area = cycles, cooling_period, chip_area
        self.cooled = 0

    def stages(self):
        found = {"approach": self.approach_time}
        for n in range(1, self.cycles + 1):
            found.update({f"cut {n}": self.cut_time, f"cooling {n}": self.turn_time - self.cut_time})
        return found

    def planned(self):
        times = self.stages()
        self.scene.stages = [(name, max(1, round(times[name] / self.cooling_period)) if "cooling" in name else steps)
                             for name, steps in self.scene.stages]
        self.cooling_step = (self.turn_time - self.cut_time) / self.scene.stages[2][1]

    def begin(self):
        super().begin()
        if self.window:
            self.window.begin(self.scene)

    # ---- the clock

    @property
    def cooling(self):
        """True while the pick turns in water."""
        return not self.scene.finished and self.scene.stage > 0 and self.scene.stage % 2 == 0

    @property
    def step(self):
        return self.cooled if self.cooling else super().step

    @property
    def time(self):
        return self.scene.clock + self.cooled * self.cooling_step if self.cooling else super().time

    def run(self):
        if not self.cooling:
            if self.window:
                self.window.follow(self.window.distance(self.motion.pose(self.path_time()).of([self.tip])[0]))
            return False
        scene = self.scene
        for _ in range(min(COOLING_CHUNK, scene.stages[scene.stage][1] - self.cooled)):
            if scene.heat:
                scene.heat.cool(self.cooling_step)
            self.cooled += 1
            scene.recorder.act()
        return True

    # ---- stages

    def begin_stage(self, folder):
        scene, self.cooled = self.scene, 0
        if scene.heat and scene.stage == 1:
            # The mean heating is of the cuts: nothing heats the pick on its approach.
            scene.heat.start_average()
        if self.cooling:
            if scene.heat:
                scene.heat.leave_rock()
            return
        self.start.begin_stage(folder)
        if scene.tool.profile and not scene.finished:
            scene.tool.profile.begin_cycle(scene.tool.mark_of_shape())

    # ---- what a checkpoint holds

    def state(self):
        window = {"window": self.window.state()} if self.window else {}
        return {**super().state(), **window, "cooled": self.cooled}

    def restore(self, state):
        super().restore(state)
        if self.window:
            self.window.restore(state["window"], self.scene)
        self.cooled = int(state["cooled"])

    # ---- what the folder of a run shows

    def log(self):
        return {"working_time": (self.scene.time, "s")}

    def heat_log(self):
        heat = self.scene.heat
        hot, mean = hot_and_mean(heat.network, self.scene.rock.count)
        return {"tool_temperature_hot": (hot, "K"), "tool_temperature_mean": (mean, "K"),
                "water_heat": (-heat.network.balance["convected"], "J/m"),
                "pick_friction_heat": (float(heat.load.friction_heat.sum()), "J/m"),
                "pick_heat_worn_away": (self._heat_worn_away(), "J/m")}

    def _heat_worn_away(self):
        """J/m above its first temperature that what has gone of the tool took along."""
        heat = self.scene.heat
        lost = float(heat.tool_capacity.sum() - heat.network.capacity[heat.n:].sum())
        return -heat.network.balance["removed"] - lost * self.scene.heat_model.tool_temperature

    def cut_area(self):
        """Area (m2) of the rock that the tool has gone through."""
        stage = self.scene.stage
        cuts = stage // 2
        if stage % 2 and not self.scene.finished:
            cuts += self.step / self.scene.stages[stage][1]
        return self.chip_area * cuts

    def results(self, columns):
        scene, area = self.scene, self.cut_area()
        stage = columns.get("stage", np.zeros(0))
        cutting = stage % 2 == 1 if (stage % 2 == 1).any() else slice(None)
        found = {"working_time": (scene.time, "s"), **forces(columns, scene.units.force, cutting),
                 "specific_energy": (scene.tool.contact.work_done / area if area else 0.0, "J/m3")}
        for n in range(1, self.cycles + 1):
            now = stage == 2 * n - 1
            if now.any():
                found[f"mass_lost_after_cut_{n}"] = float(columns["mass_lost"][now].max()), "-"
                for name in ("max", "hot") if scene.heat else ():
                    found[f"peak_temperature_{name}_{n}"] = float(columns[f"tool_temperature_{name}"][now].max()), "K"
        return {**found, **self.window.results()} if self.window else found

    def warnings(self):
        return self.window.warnings(self.cracks() + self.scene.bonds.cracks) if self.window else []

    def tables(self, ended):
        """Where the pick's temperature would go in further turns."""
        if not (ended and self.scene.heat and self.scene.finished):
            return {}
        header = ["turn [-]", "peak [K]", "cooled [K]", "mean [K]", "absorbed [J/m]", "released [J/m]"]
        return {"turns.csv": (header, self.repeated_turns(REPEATED))}

    def repeated_turns(self, count):
        """Rows of turns.csv: the heating of all cuts so far, in the mean, again and again from the cold.

        Each tool node takes the mean power of its friction, and exchanges heat with the water and, by the mean
        conductance, with the rock that it touched; then it cools. peak, cooled: K of the hottest part at the end of
        cutting and of cooling; mean: K of the whole then; absorbed, released: J/m of friction, and to water and rock,
        which become equal in the stationary state [Rojek 2014, 5.3]. No heat goes with worn particles here.
        """
        scene, model = self.scene, self.scene.heat_model
        state = scene.heat.network.state()
        rock, nodes = scene.rock.count, len(state["capacity"]) - scene.rock.count
        # Rock that has cooled down keeps out of the balance.
        state["temperature"] = np.repeat([model.ambient, model.tool_temperature], [rock, nodes])
        network = HeatNetwork(capacity=np.ones(rock + nodes), edges=np.empty((0, 2), int), conductance=0.0,
                              temperature=0.0)
        network.restore(state)
        there = np.flatnonzero(network.capacity[rock:] > 0)
        # What particles took up that are gone since comes to the nearest that are left.
        places = scene.heat.body.positions
        heir = cKDTree(places[there]).query(places)[1]
        power, touch, rock_temperature = scene.heat.averages()
        power, touch, warmth = (np.bincount(heir, values, len(there))
                                for values in (power, touch, touch * rock_temperature))
        tool = rock + there
        water = state["convection"][tool]
        wetted = np.divide(water * model.ambient + warmth, water + touch, out=np.full(len(tool), model.ambient),
                           where=water + touch > 0)
        rows = []
        for turn in range(1, count + 1):
            balance = network.balance
            network.source(tool, power)
            network.convect(tool, water + touch, wetted)
            network.advance(self.cut_time)
            peak, _ = hot_and_mean(network, rock)
            network.source(tool, 0.0)
            network.convect(tool, water, model.ambient)
            network.advance(self.turn_time - self.cut_time)
            change = {name: now - balance[name] for name, now in network.balance.items()}
            rows.append((turn, peak, *hot_and_mean(network, rock), change["generated"],
                         -change["convected"] - change["radiated"]))
        return rows

"""Programmes of motion: what the tool does in which stage, and what becomes of the rock between stages."""
import math
import shutil
from abc import ABC, abstractmethod

import numpy as np
from yade import O

from rockwear.engines import access
from rockwear.engines.bond_log import crack_array, cracks_of
from rockwear.kernels.rigid_motion import Straight


class Programme(ABC):
    """What a scene asks of a programme; `motion` (of kernels.rigid_motion) is the path of the tool,
    `arrays` {name: array} are for the report.

    The scene is a scenes.cut.Cut, given by `attach`. Its `stage` counts the stages that `stages` names.
    """

    damping_rates = None
    """(stages,) 1/s of background damping by stage; None where it stays the same."""

    window = None
    """scenes.rock_window.RockWindow that moves along with the tool; None where all rock is there from the start."""

    warnings = staticmethod(list)
    """A function giving lines on what of a run is not to be relied on; none, if a programme has not its own."""

    def __init__(self, motion=None, arrays=None):
        self.motion, self.arrays = motion, arrays or {}

    def attach(self, scene):
        """The scene whose programme this is."""
        self.scene, self.start = scene, StartState(scene)

    @abstractmethod
    def stages(self):
        """{name: s} of the stages."""

    def planned(self):
        """The scene has turned the stages into steps."""

    def begin(self):
        """The scene stands before its first step."""
        self.path_start = O.iter

    # ---- the clock

    @property
    def step(self):
        """Steps of the present stage that are done."""
        return O.iter - self.scene.first_iteration

    @property
    def time(self):
        """Simulated seconds of the process over all stages."""
        return self.scene.clock + self.step * self.scene.time_step * self.scene.time_scale

    def path_time(self):
        """Seconds of the mechanics along the path; rock that is put back puts back this clock too."""
        return (O.iter - self.path_start) * self.scene.time_step

    def heat_time_scale(self):
        """Seconds of the process, in which heat flows, in a second of the mechanics."""
        return self.scene.time_scale

    def fastest(self):
        """Greatest speed of the tool, m/s of the mechanics."""
        return float(np.linalg.norm(self.motion.velocity(0.0)))

    def run(self):
        """Run to the next canonical point; False where the mechanics do so."""
        return False

    # ---- between stages

    def close_stage(self):
        """The present stage ends."""

    def begin_stage(self, folder):
        """The next stage, which is the scene's by now, begins."""

    def stage_begun(self, folder):
        """The balances of the stage have begun."""

    def reaches_rock(self):
        """Whether anything of the tool still meets the rock."""
        return True

    # ---- what a checkpoint holds

    def state(self):
        """What must survive a restart."""
        return {"path_start": self.path_start, "start": self.start.state()}

    def restore(self, state):
        """Take back what `state` gave."""
        self.path_start = int(state["path_start"])
        self.start.restore(state["start"])

    def save(self, directory, folder):
        """Write files into `directory` of a checkpoint of the run in `folder`."""
        self.start.save(directory, folder)

    def load(self, directory, folder):
        """Take the files back."""
        self.start.load(directory, folder)

    # ---- what the folder of a run shows

    def cracks(self):
        """Bonds that broke in rock that has been replaced since."""
        return self.start.cracks

    def log(self):
        """{name: (value, unit)} of the history."""
        return {}

    def heat_log(self):
        """{name: (value, unit)} of the history of a scene with heat."""
        return {}

    @abstractmethod
    def results(self, columns):
        """{name: (value, unit)}: times and forces, from the history's columns."""

    def tables(self, ended):
        """{file: (header, rows)} of further tables, costly ones once the run has `ended`."""
        return {}


class StartState:
    """Rock and tool's bodies as the first stage left them, for stages that begin from there [Rojek 2003, 9.1]."""

    FILE = "start_up.yade.gz"

    def __init__(self, scene):
        self.scene, self.kept, self.cracks = scene, {}, []

    def begin_stage(self, folder):
        """Keep what the first stage has left; put it back before each further one."""
        if self.scene.stage == 1:
            self.keep(folder)
        elif not self.scene.finished:
            self.put_back(folder)

    def keep(self, folder):
        """Keep what is there now."""
        scene = self.scene
        scene.canonical()
        access.save(folder / self.FILE)
        self.kept = {"bonds": scene.bonds.state(), "bodies": scene.tool.bodies.state()}
        if scene.programme.window:
            self.kept["window"] = scene.programme.window.kept()
            self.kept["path_start"] = scene.programme.path_start
        if scene.heat:
            self.kept["rock_temperature"] = scene.heat.network.temperature[:scene.rock.count].copy()

    def put_back(self, folder):
        """The rock as it was kept, and in it the tool as it is worn now."""
        scene, bonds = self.scene, self.scene.bonds
        released = bonds.energy_released, bonds.energy_crushed
        self.cracks += bonds.cracks[len(self.kept["bonds"]["cracks"]):]
        O.load(str(folder / self.FILE))
        bonds.restore(self.kept["bonds"])
        bonds.energy_released, bonds.energy_crushed = released
        scene.tool.bodies.restore(self.kept["bodies"])
        if scene.programme.window:
            scene.programme.window.put_back(self.kept["window"])
            scene.programme.path_start = int(self.kept["path_start"])
        scene.connect_again()
        scene.tool.insert_again()
        if scene.heat:
            scene.heat.replace_rock(self.kept["rock_temperature"])
            scene.heat.find_surfaces()
        scene.canonical()

    def state(self):
        """What must survive a restart."""
        return {"kept": self.kept, "cracks": crack_array(self.cracks)}

    def restore(self, state):
        """Take back what `state` gave."""
        self.kept = state.get("kept", {})
        self.cracks = cracks_of(state["cracks"])

    def save(self, directory, folder):
        """Copy the file into `directory` of a checkpoint of the run in `folder`."""
        if self.kept:
            shutil.copy(folder / self.FILE, directory)

    def load(self, directory, folder):
        """Copy it back."""
        if (directory / self.FILE).exists():
            shutil.copy(directory / self.FILE, folder)


class Cycles(Programme):
    """A start-up cut, then cycles, each in the rock that the start-up left, with the tool as it is worn [Rojek 2003,
    9.1].

    times: {stage: s}, the start-up first; velocity: m/s of the process; depth_of_cut: m; surface: height of the rock's
    surface, m; approach: free way before the tool meets the rock, m; ahead: m below the surface where its foremost
    point counts for that.
    """

    def __init__(self, *, times, velocity, depth_of_cut, surface, approach, ahead, time_scale=1.0):
        super().__init__()
        self.times, self.velocity, self.depth_of_cut = times, velocity, depth_of_cut
        self.surface, self.approach, self.ahead, self.time_scale = surface, approach, ahead, time_scale

    def attach(self, scene):
        super().attach(scene)
        x = -self.approach - scene.tool.foremost(below=self.ahead)
        self.motion = Straight(start=(x, self.surface - self.depth_of_cut),
                               velocity=(self.velocity * self.time_scale, 0.0))
        self.foremost_when_new = scene.foremost()

    def stages(self):
        return self.times

    def planned(self):
        scene = self.scene
        steps, approach = np.array([steps for _, steps in scene.stages]), scene.steps_in(self.approach / self.velocity)
        # Each cycle begins with what the start-up leaves of the way.
        left = max(0, approach - int(steps[0]))
        self.approach_steps = np.minimum([approach, *[left] * (len(steps) - 1)], steps)
        """Steps of each stage in which the tool comes to the rock: the new one, a worn one to where the new one stood.
        """

    @property
    def working_time(self):
        """Simulated seconds without those in which the tool came to the rock."""
        scene = self.scene
        steps = self.approach_steps[:scene.stage].sum()
        if not scene.finished:
            steps += min(scene.step, self.approach_steps[scene.stage])
        return scene.time - float(steps) * scene.time_step * scene.time_scale

    def begin_stage(self, folder):
        scene = self.scene
        self.start.begin_stage(folder)
        if not scene.finished:
            self._add_approach()
            if scene.tool.profile:
                scene.tool.profile.begin_cycle(self._mark_of_shape())

    def _mark_of_shape(self):
        return self.scene.tool.mark_of_shape()

    def _add_approach(self):
        """Lengthen the stage by the way that a worn tool is behind a new one, so that each goes through the same
        rock."""
        scene, behind = self.scene, self.foremost_when_new - self.scene.foremost()
        if 0.0 < behind < math.inf:
            name, steps = scene.stages[scene.stage]
            more = scene.steps_in(behind / self.velocity)
            self.approach_steps[scene.stage] += more
            scene.stages[scene.stage] = name, steps + more

    def reaches_rock(self):
        return math.isfinite(self.scene.foremost())

    def state(self):
        steps = np.array([steps for _, steps in self.scene.stages])
        return {**super().state(), "stage_steps": steps, "approach_steps": self.approach_steps}

    def restore(self, state):
        super().restore(state)
        scene = self.scene
        scene.stages = [(name, int(steps)) for (name, _), steps in zip(scene.stages, state["stage_steps"])]
        self.approach_steps = state["approach_steps"].copy()

    def log(self):
        return {"working_time": (self.working_time, "s")}

    def cut_area(self):
        """Area (m2) of the rock that the tool has gone through."""
        return self.depth_of_cut * self.velocity * self.working_time

    def results(self, columns):
        scene, area, working_time = self.scene, self.cut_area(), self.working_time
        # On its way to the rock the tool meets no force, and that way is no cut.
        return {"working_time": (working_time, "s"),
                **forces(columns, scene.units.force, seconds=working_time or scene.time),
                "specific_energy": (scene.tool.contact.work_done / area if area else 0.0, "J/m3")}


def forces(columns, unit, rows=slice(None), seconds=None):
    """{name: (value, unit)} of mean and peak cutting force and mean thrust in rows of the history, nan without any.

    A row has the mean over the time since the row before. Means are over `seconds`, that of the rows by default.
    """
    if not columns:
        return {name: (math.nan, unit) for name in ("mean_cutting_force", "peak_cutting_force", "mean_thrust_force")}
    elapsed = np.diff(columns["time"], prepend=0.0)[rows]
    cutting, thrust = (columns[f"{name}_force"][rows] for name in ("cutting", "thrust"))
    seconds = seconds or float(elapsed.sum())
    return {"mean_cutting_force": (float(cutting @ elapsed) / seconds, unit),
            "peak_cutting_force": (float(cutting.max()), unit),
            "mean_thrust_force": (float(thrust @ elapsed) / seconds, unit)}


class LowerAndCut(Programme):
    """The tool is lowered into the rock and then drawn through it [Rojek 2003, ch. 13].

    ways: [(stage, s, (2,) m/s of the tool)]; start: (2,) m, place of the tool's origin at first; damping_rates:
    (stages,) 1/s, or None.
    """

    def __init__(self, *, ways, start, damping_rates=None):
        super().__init__(Straight(start=start, velocity=ways[0][2]),
                         {"stage_names": np.array([name for name, _, _ in ways])})
        self.ways, self.damping_rates = ways, damping_rates

    def stages(self):
        return {name: seconds for name, seconds, _ in self.ways}

    def fastest(self):
        return max(float(np.linalg.norm(velocity)) for _, _, velocity in self.ways)

    def reaches_rock(self):
        return math.isfinite(self.scene.foremost())

    def begin_stage(self, folder):
        if not self.scene.finished:
            self.scene.tool.bodies.go_on(self.ways[self.scene.stage][2])

    def results(self, columns):
        cut = columns["stage"] == len(self.ways) - 1 if columns else np.zeros(0, bool)
        return forces(columns, self.scene.units.force, cut) if cut.any() else {}

"""Temperatures of a tooth at several speeds: transient, quasi-stationary, and wear started from either [Rojek 2003,
ch. 11]."""
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from rockwear.kernels.archard import Hardness
from rockwear.kernels.checks import require
from rockwear.kernels.free_surface import free_surface
from rockwear.kernels.parameter import Parameter, duration, integer, listed, numbers, speed
from rockwear.kernels.tool_load import tool_under_load
from rockwear.scenes import cutting, parameters, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.programme import Cycles

SHANKS = ("fixed", "insulated")
UNWORN = Hardness.constant(1e30)
"""A tool too hard to wear: the passes without wear."""
GIVEN = {"cycles": 1, "shank": "insulated", "heat": True, "time_scale": 1.0, "tool": "particles"}
"""Parameters of the cut that are the programme's here."""
SHANK_TEMPERATURE = replace(*parameters.HEAT.only("shank_temperature").parameters, when=None)
PASSES = (
    Parameter("velocities", "4,0.4,0.04", "m/s", numbers(speed), "of the process, a pass each",
              "[Rojek 2003, 11.2]"),
    Parameter("wear_velocity", 0.4, "m/s", speed, "of the process in the passes with wear", "[Rojek 2003, 11.4]"),
    Parameter("wear_passes", 1, "", integer(0, parameters.MOST_CYCLES),
              "passes with wear from each of the two quasi-stationary fields"),
    Parameter("long_time", 60.0, "s", duration, "of heating under the mean load, after each pass"))


def groups(**defaults):
    """The scene's parameter groups with other defaults."""
    own = {"motion": PASSES, "heat": (SHANK_TEMPERATURE,)}
    return parameters.with_defaults(
        [replace(group, parameters=(*group.parameters, *own.get(group.title, ())))
         for group in parameters.given(cutting.GROUPS, **GIVEN)], **defaults)


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError."""
    v = SimpleNamespace(**{**values, **GIVEN})
    parts.check_radii(v)
    cutting.check_cut(v, v.start_up + v.cycle_time)
    velocities = listed(v.velocities)
    # They name stages, results and tables, in six digits.
    require(len({f"{u:g}" for u in velocities}) == len(velocities), "velocities", v.velocities,
            "each given once, different in six digits", "m/s")
    require(v.wear_passes == 0 or v.wear_velocity in velocities, "wear_velocity", v.wear_velocity,
            f"one of velocities = {v.velocities}", "m/s")
    require(v.conduction, "conduction", "false", "true: without it no temperature is quasi-stationary")
    require(max(v.convection, v.emissivity, v.contact_conductance) > 0, "convection", v.convection,
            "greater than 0 where emissivity and contact_conductance are 0: an insulated tool has to lose its heat",
            "W/m2K")
    programme = Passes(velocities=velocities, wear_velocity=v.wear_velocity, wear_passes=v.wear_passes,
                       start_up=v.start_up,
                       pass_time=v.cycle_time, long_time=v.long_time, shank_temperature=v.shank_temperature,
                       **cutting.motion(v))
    # The rock takes longest to pack: all else is refused before.
    return Cut(tool=cutting.tool(v), programme=programme, background_damping=v.background_damping, **parts.common(v),
               rock=cutting.box(v))


class Passes(Cycles):
    """Passes of one tooth over the rock that its start-up left, the tool each time whole and at its first temperature.

    The mechanics run at `velocity`, the process at each of `velocities` (m/s): heat sees that many more seconds
    ([Rojek 2003, 12.1] does the same, five times). The rock is slow to either, so that the friction work of a metre
    of cut is the same, and all passes are samples of equal sliding distance. After each, the mean load of the pass
    heats the tool alone, for `long_time` (s) and for ever [Rojek 2003, 11.3], once with the shank at its temperature,
    once insulated. Passes with wear then start from the two quasi-stationary fields of `wear_velocity`, each with a
    whole tool.
    """

    def __init__(self, *, velocities, wear_velocity, wear_passes, start_up, pass_time, long_time, shank_temperature,
                 **motion):
        wear = [(f"wear from the {shank} shank's field, pass {n + 1}", wear_velocity, shank, n == 0)
                for shank in SHANKS for n in range(wear_passes)]
        passes = [(f"{u:g} m/s", u, None, True) for u in velocities]
        # (name, velocity of the process, shank whose field starts it, whether it starts with a whole tool)
        self.schedule = [("start-up", motion["velocity"], None, True), *passes, *wear]
        super().__init__(times={name: pass_time if k else start_up for k, (name, *_) in enumerate(self.schedule)},
                         **motion)
        self.velocities, self.pass_time, self.long_time = velocities, pass_time, long_time
        self.shank_temperature = shank_temperature
        self.passes, self.worn = {}, {}

    def attach(self, scene):
        super().attach(scene)
        self.whole = scene.tool.model.erosion.state()

    def heat_time_scale(self):
        return self.velocity / self.schedule[self.scene.stage][1]

    def begin(self):
        super().begin()
        self._enter()

    def _enter(self):
        """Set what depends on the stage alone."""
        _, _, shank, _ = self.schedule[self.scene.stage]
        self.scene.tool.wear_engine.hardness = self.scene.tool.wear.hardness if shank else UNWORN
        self.scene.heat.shank_temperature = self.shank_temperature if shank == "fixed" else None

    # ---- stages

    def close_stage(self):
        scene = self.scene
        _, velocity, shank, _ = self.schedule[scene.stage]
        scene.tool.wear_engine.act()
        scene.heat.act()
        if shank:
            erosion = scene.tool.model.erosion
            self.worn[shank] = np.array([erosion.archard_volume, erosion.mass_fraction_lost])
        elif scene.stage:
            self.passes[f"{velocity:g}"] = np.array([*scene.heat.averages(), scene.heat.tool_temperature()])

    def begin_stage(self, folder):
        if self.scene.stage > 1 and not self.scene.finished:
            self._prepare_tool()
        super().begin_stage(folder)

    def stage_begun(self, folder):
        if self.scene.stage == 1:
            self.start.kept["rock_temperature"][:] = self.scene.heat_model.rock_temperature
            self._prepare_tool()
            self.start.put_back(folder)
        self.scene.heat.start_average()

    def _prepare_tool(self):
        self._enter()
        if self.schedule[self.scene.stage][3]:
            self._renew_tool()

    def _mark_of_shape(self):
        # No pass is like another: they differ in velocity or in the field.
        return np.nan

    def _renew_tool(self):
        """A whole tool at its first temperature, or with the field that the stage starts from."""
        scene, tool = self.scene, self.scene.tool
        tool.wear_engine.forget_temperatures()
        _, velocity, shank, _ = self.schedule[scene.stage]
        tool.model.erosion.restore({name: np.copy(value) for name, value in self.whole.items()})
        # What is said of the wear is said of this tool alone.
        tool.wear_engine.events[:] = 0
        if tool.profile:
            tool.profile.clear()
        cold = np.full(tool.count, scene.heat_model.tool_temperature)
        scene.heat.renew_tool(self.field(velocity, shank) if shank else cold)

    # ---- the tool under the mean load

    def loaded(self, velocity, shank):
        """HeatNetwork of the tool from the end of its pass on, under the mean load of the pass."""
        model, tool, heat = self.scene.heat_model, self.scene.tool.model, self.scene.heat
        friction_heat, contact, rock_temperature, temperature = self.passes[f"{velocity:g}"]
        free = free_surface(positions=tool.positions, radii=tool.radii)
        free[tool.fixed | (contact > 0)] = 0.0
        return tool_under_load(capacity=heat.tool_capacity, paths=heat.tool_paths, temperature=temperature,
                               friction_heat=friction_heat, contact=contact, rock_temperature=rock_temperature,
                               convection=model.convection * free, radiation=model.emissivity * free,
                               ambient=model.ambient,
                               shank=np.flatnonzero(tool.fixed) if shank == "fixed" else (),
                               shank_temperature=self.shank_temperature)

    def field(self, velocity, shank):
        """(m,) K, quasi-stationary."""
        return self.loaded(velocity, shank).steady_state()

    def warming(self, velocity, shank):
        """(n, 2): seconds of the process, from the end of the pass on, and the hottest particle's K."""
        network, time = self.loaded(velocity, shank), self.pass_time * self.velocity / velocity
        rows = [(time, network.temperature.max())]
        for later in np.geomspace(time, max(self.long_time, time), 60)[1:]:
            network.advance(later - rows[-1][0])
            rows.append((later, network.temperature.max()))
        return np.array(rows)

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "passes": dict(self.passes), "worn": dict(self.worn)}

    def restore(self, state):
        super().restore(state)
        self.passes, self.worn = dict(state.get("passes", {})), dict(state.get("worn", {}))
        if not self.scene.finished:
            self._enter()

    # ---- what the folder of a run shows

    def results(self, columns):
        found = super().results(columns)
        for u in self.velocities:
            if f"{u:g}" not in self.passes:
                continue
            friction_heat, contact, rock, temperature = self.passes[f"{u:g}"]
            found[f"friction_heat_of_the_tool_{u:g}"] = (float(friction_heat.sum()), "W/m")
            found[f"conductance_to_the_rock_{u:g}"] = (float(contact.sum()), "W/mK")
            found[f"hottest_after_the_pass_{u:g}"] = (float(temperature.max()), "K")
            for shank in SHANKS:
                found[f"hottest_{shank}_shank_{u:g}"] = (float(self.field(u, shank).max()), "K")
        for shank, (volume, lost) in self.worn.items():
            found[f"worn_volume_from_{shank}_shank"] = (float(volume), "m3/m")
            found[f"mass_lost_from_{shank}_shank"] = (float(lost), "-")
        return found

    def tables(self, ended):
        if not ended:
            return {}
        tool, done = self.scene.tool.model, [u for u in self.velocities if f"{u:g}" in self.passes]
        fields = {f"pass_{u:g}": self.passes[f"{u:g}"][3] for u in done}
        fields.update({f"{shank}_{u:g}": self.field(u, shank) for u in done for shank in SHANKS})
        warming = {f"{shank}_{u:g}": self.warming(u, shank) for u in done for shank in SHANKS}
        columns = np.column_stack([tool.positions, tool.radii, *fields.values()])
        header = ["x [m]", "y [m]", "radius [m]", *(f"{name} [K]" for name in fields)]
        pairs = np.hstack(list(warming.values())) if warming else np.empty((0, 0))
        words = [word for name in warming for word in (f"time_{name} [s]", f"{name} [K]")]
        return {"tool_fields.csv": (header, columns.tolist()), "warming.csv": (words, pairs.tolist())}

"""Temperatures of a tooth at several speeds: transient, quasi-stationary, and wear started from either (M 11)."""
import numpy as np

from rockwear.scenes.cutting import Cutting, parameters
from rockwear.kernels.archard import Hardness
from rockwear.kernels.checks import require
from rockwear.kernels.free_surface import free_surface
from rockwear.kernels.tool_load import tool_under_load
from rockwear.kernels.parameter import Parameter, above_zero, integer, listed, numbers

SHANKS = ("fixed", "insulated")
UNWORN = Hardness.constant(1e30)
"""A tool too hard to wear: the passes without wear."""


def temperature_parameters(**defaults):
    """Parameters of the cut, and those of the passes; `cycles` and `root` are up to the scene."""
    own = [
        Parameter("velocities", "4,0.4,0.04", "m/s", numbers(above_zero), "of the process, a pass each", "M 11.2"),
        Parameter("wear_velocity", 0.4, "m/s", above_zero, "of the process in the passes with wear", "M 11.4"),
        Parameter("wear_passes", 1, "", integer(0), "passes with wear from each of the two quasi-stationary fields"),
        Parameter("long_time", 60.0, "s", above_zero, "of heating under the mean load, after each pass"),
    ]
    return own + [p for p in parameters(**defaults) if p.name not in ("cycles", "shank", "heat", "time_scale")]


class Temperatures(Cutting):
    """Passes of one tooth over the rock that its start-up left, the tool each time whole and at its first temperature.

    The mechanics run at `velocity`, the process at each of `velocities`: heat sees that many more seconds (M 12.1 does
    the same, five times). The rock is slow to either, so that the friction work of a metre of cut is the same, and all
    passes are samples of equal sliding distance. After each, the mean load of the pass heats the tool alone, for
    `long_time` and for ever (M 11.3), once with the root held at its temperature, once with it insulated. Passes with
    wear then start from the two quasi-stationary fields of `wear_velocity`, each with a whole tool.
    """

    def __init__(self, values):
        values = {**values, "cycles": 1, "shank": "insulated", "heat": True, "time_scale": 1.0}
        super().__init__(values)
        v = self.v
        self.velocities = listed(v.velocities)
        require(v.wear_passes == 0 or v.wear_velocity in self.velocities, "wear_velocity", v.wear_velocity,
                f"one of velocities = {v.velocities}", "m/s")
        wear = [(f"wear from the {shank} root's field, pass {n + 1}", v.wear_velocity, shank, n == 0)
                for shank in SHANKS for n in range(v.wear_passes)]
        passes = [(f"{u:g} m/s", u, None, True) for u in self.velocities]
        # (name, velocity of the process, root whose field starts it, whether it starts with a whole tool)
        self.schedule = [("start-up", v.velocity, None, True), *passes, *wear]
        self._plan({name: v.cycle_time if k else v.start_up for k, (name, *_) in enumerate(self.schedule)})
        self.whole = self.tool.erosion.state()
        self.passes, self.worn = {}, {}

    # ---- YADE

    def _heat(self):
        heat = super()._heat()
        heat.time_scale = lambda: self.pace
        return heat

    def build(self):
        super().build()
        self._enter()

    def _enter(self):
        """Set what depends on the stage alone."""
        _, velocity, shank, _ = self.schedule[self.stage]
        self.pace = self.v.velocity / velocity
        self.wear.hardness = self.hardness if shank else UNWORN
        self.heat.shank_temperature = self.v.shank_temperature if shank == "fixed" else None

    def end_stage(self, folder):
        name, velocity, shank, _ = self.schedule[self.stage]
        self.wear.act()
        self.heat.act()
        if shank:
            erosion = self.tool.erosion
            self.worn[shank] = np.array([erosion.archard_volume, erosion.mass_fraction_lost])
        elif self.stage:
            self.passes[f"{velocity:g}"] = np.array([*self.heat.averages(), self.heat.tool_temperature()])
        super().end_stage(folder)
        if self.stage == 1:
            self.start["rock_temperature"][:] = self.v.rock_temperature
            self._put_back(folder)
        self.heat.start_average()

    def _put_back(self, folder):
        self._enter()
        if self.schedule[self.stage][3]:
            self._whole_tool()
        super()._put_back(folder)

    def _mark_of_shape(self):
        # No pass is like another: they differ in velocity or in the field.
        return np.nan

    def _whole_tool(self):
        """A whole tool at its first temperature, or with the field that the stage starts from."""
        _, velocity, shank, _ = self.schedule[self.stage]
        self.tool.erosion.restore({name: np.copy(value) for name, value in self.whole.items()})
        # What is said of the wear is said of this tool alone.
        self.wear.events[:] = 0
        if self.profile:
            self.profile.clear()
        cold = np.full(self.tool.count, self.v.tool_temperature)
        self.heat.renew_tool(self.field(velocity, shank) if shank else cold)

    # ---- the tool under the mean load

    def loaded(self, velocity, shank):
        """HeatNetwork of the tool from the end of its pass on, under the mean load of the pass."""
        v, tool, heat = self.v, self.tool, self.heat
        friction_heat, contact, rock_temperature, temperature = self.passes[f"{velocity:g}"]
        air = v.convection * free_surface(positions=tool.positions, radii=tool.radii)
        air[tool.fixed | (contact > 0)] = 0.0
        return tool_under_load(capacity=heat.tool_capacity, paths=heat.tool_paths, temperature=temperature,
                               friction_heat=friction_heat, contact=contact, rock_temperature=rock_temperature,
                               convection=air, ambient=v.ambient_temperature,
                               shank=np.flatnonzero(tool.fixed) if shank == "fixed" else (),
                               shank_temperature=v.shank_temperature)

    def field(self, velocity, shank):
        """(m,) K, quasi-stationary."""
        return self.loaded(velocity, shank).steady_state()

    def warming(self, velocity, shank):
        """(n, 2): seconds of the process, from the end of the pass on, and the hottest particle's K."""
        network, time = self.loaded(velocity, shank), self.v.cycle_time * self.v.velocity / velocity
        rows = [(time, network.temperature.max())]
        for later in np.geomspace(time, max(self.v.long_time, time), 60)[1:]:
            network.advance(later - rows[-1][0])
            rows.append((later, network.temperature.max()))
        return np.array(rows)

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "passes": dict(self.passes), "worn": dict(self.worn)}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self.passes, self.worn = dict(state.get("passes", {})), dict(state.get("worn", {}))
        if not self.finished:
            self._enter()

    # ---- what a run's folder shows

    def results(self):
        found = super().results()
        for u in self.velocities:
            if f"{u:g}" not in self.passes:
                continue
            friction_heat, contact, rock, temperature = self.passes[f"{u:g}"]
            found[f"friction_heat_of_the_tool_{u:g}"] = (float(friction_heat.sum()), "W/m")
            found[f"conductance_to_the_rock_{u:g}"] = (float(contact.sum()), "W/mK")
            found[f"hottest_after_the_pass_{u:g}"] = (float(temperature.max()), "K")
            for shank in SHANKS:
                found[f"hottest_{shank}_root_{u:g}"] = (float(self.field(u, shank).max()), "K")
        for shank, (volume, lost) in self.worn.items():
            found[f"worn_volume_from_{shank}_root"] = (float(volume), "m3/m")
            found[f"mass_lost_from_{shank}_root"] = (float(lost), "-")
        return found

    def tables(self):
        tool, done = self.tool, [u for u in self.velocities if f"{u:g}" in self.passes]
        fields = {f"pass_{u:g}": self.passes[f"{u:g}"][3] for u in done}
        fields.update({f"{shank}_{u:g}": self.field(u, shank) for u in done for shank in SHANKS})
        warming = {f"{shank}_{u:g}": self.warming(u, shank) for u in done for shank in SHANKS}
        columns = np.column_stack([tool.positions, tool.radii, *fields.values()])
        header = ["x [m]", "y [m]", "radius [m]", *(f"{name} [K]" for name in fields)]
        pairs = np.hstack(list(warming.values())) if warming else np.empty((0, 0))
        words = [word for name in warming for word in (f"time_{name} [s]", f"{name} [K]")]
        return {**super().tables(), "tool_fields.csv": (header, columns.tolist()), "warming.csv": (words, pairs.tolist())}

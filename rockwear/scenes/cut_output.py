"""What the folder of a cut shows."""
import math

import numpy as np
from yade import utils

from rockwear.engines import access
from rockwear.kernels.archard import KELVIN
from rockwear.run import vtk
from rockwear.scenes.balances import energy_warnings, with_residual
from rockwear.scenes.output import Output


class CutOutput(Output):
    """Output of a scenes.cut.Cut, whatever its parts."""

    def energy_balance(self):
        """{entry: J}: the tool's work, where it went, and what the balance misses."""
        contact = self.scene.tool.contact
        balance = {"tool_work": contact.work_done, **self.scene.energy.changes(), "tool_friction": contact.friction,
                   "rock_friction": self.scene.rock_friction.total, "contact_dashpots": contact.dashpot_dissipated,
                   "bond_breaking": self.scene.bonds.energy_released,
                   "background_damping": self.scene.damping.dissipated if self.scene.damping else 0.0,
                   "removed_contacts": self.scene.tool.removed_energy}
        if self.scene.expansion:
            balance["thermal_expansion"] = -self.scene.expansion.work
        return with_residual(balance, "tool_work")

    def balances(self):
        friction = {**self.scene.tool.friction_balance(), "rock": self.scene.rock_friction.total}
        found = {"energy": (self.energy_balance(), self.scene.units.energy), "friction": (friction, self.scene.units.energy),
                 "mass": (self.scene.tool.mass_balance(), self.scene.units.mass)}
        if self.scene.heat:
            found["heat"] = self.scene.heat.balance(), self.scene.units.energy
        return found

    def history(self):
        """Functions that give the columns of the history."""
        scene = self.scene
        found = [self._log, scene.tool.wear_engine.log, scene.bonds.log]
        return [*found, scene.heat.log, scene.programme.heat_log] if scene.heat else found

    def _log(self):
        scene, contact, bodies = self.scene, self.scene.tool.contact, self.scene.tool.bodies
        unit, joule = scene.units.force, scene.units.energy
        elapsed, impulse = scene.recorder.elapsed(), contact.take_impulse()
        bodies.connect()
        # Along the direction in which the tool looks, normal to it, and across.
        force = np.append(impulse[:2] @ bodies.pose.rotation, impulse[2])
        force = force / elapsed if elapsed else force
        columns = {"time": (scene.time, "s"), "stage": (scene.stage, "-"), **scene.programme.log(),
                   "cutting_force": (-force[0], unit), "thrust_force": (force[1], unit)}
        if not scene.in_plane:
            columns["side_force"] = force[2], unit
        columns["tool_work"] = contact.work_done, joule
        if scene.in_plane:
            columns["kinetic_energy"] = utils.kineticEnergy(), joule
        return {**columns, "tool_friction": (contact.friction, joule), "bond_breaking": (self.scene.bonds.energy_released, joule)}

    def model(self):
        rock = self.scene.rock
        size = {"box": np.array([rock.width, rock.height])} if self.scene.in_plane else {
            "block": np.array([rock.width, rock.height, rock.depth])}
        return {"rock_radii": rock.radii, "rock_fixed": rock.fixed, "bonds": rock.pairs, "outline": self.scene.tool.outline, **size,
                **self.scene.tool.model_arrays(), **self.scene.programme.model_arrays()}

    def snapshot(self):
        rock = self.scene.rock
        self.scene.tool.bodies.connect()
        pose = self.scene.tool.bodies.pose
        return {"time": self.scene.time, "stage": self.scene.stage, "rock_positions": access.rock_positions(rock),
                "broken_bonds": np.bincount(rock.pairs[self.scene.bonds.status != 0].ravel(), minlength=rock.count),
                "status": self.scene.bonds.status, "tool_offset": pose.offset, "tool_turn": pose.turn,
                "temperature": self.scene.heat.network.temperature if self.scene.heat else np.empty(0), **self.scene.tool.snapshot()}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtk and tool.NNNN.vtk: diameter, broken bonds, temperature; the tool's pieces, worn depth."""
        shot, rock = self.snapshot(), self.scene.rock
        fields = {"diameter": 2 * rock.radii, "broken_bonds": shot["broken_bonds"]}
        places, of_tool = self.scene.tool.points()
        if self.scene.heat:
            fields["temperature"] = shot["temperature"][:rock.count]
        vtk.write(folder / f"rock.{number:04d}.vtk", shot["rock_positions"], fields)
        turned = self.scene.tool.bodies.pose.of(places[:, :2])
        vtk.write(folder / f"tool.{number:04d}.vtk", np.column_stack([turned, places[:, 2:]]), of_tool)

    def cracks(self):
        return self.scene.programme.cracks() + self.scene.bonds.cracks

    def progress(self):
        cracks = self.scene.bonds.log()
        words = [f"{cracks['tensile_cracks'][0] + cracks['shear_cracks'][0]} cracks", self.scene.tool.words()]
        if self.scene.heat:
            words.append(f"hottest {self.scene.heat.log()['tool_temperature_max'][0] - KELVIN:.0f} C")
        return ", ".join(words)

    def results(self):
        columns = self.scene.recorder.columns()
        found = {"simulated_time": (self.scene.time, "s"), "time_step": (self.scene.time_step, "s"),
                 "critical_time_step": (self.scene.critical_step, "s"), "bonded_critical_time_step": (self.scene.bonded_step, "s"),
                 **self.scene.notes, **self.scene.programme.results(columns), **self.scene.tool.results(), **self.scene.bonds.log(),
                 **{f"rock_{name}": value for name, value in self.scene.rock.report().items()}}
        if self.scene.tool.profile:
            found.update(self.scene.tool.wear.trust(self.scene.tool))
        if self.scene.heat:
            for name in ("tool_temperature_max", "rock_temperature_max"):
                found[name] = (float(np.nanmax(columns[name])) if name in columns else math.nan, "K")
        return found

    def tables(self):
        found, profile = {**super().tables(), **self.scene.programme.tables()}, self.scene.tool.profile
        if profile:
            header = [f"place_{n} [{self.scene.units.volume}]" for n in range(profile.places)]
            found["wear_profile.csv"] = header, profile.increments
        return found

    def warnings(self):
        return [*energy_warnings(self.energy_balance()), *self._wear_warnings()]

    def _wear_warnings(self):
        tool = self.scene.tool
        if not tool.profile:
            return tool.warnings() if tool.wear.law.wears else []
        short = [] if math.isfinite(self.scene.foremost()) else [
            f"nothing of the tool is left below the rock's surface, of its lowest {self.scene.depth_of_cut:g} m: it cuts no more"]
        return [*short, *tool.warnings(), *tool.wear.warnings(tool)]

    def write_shape(self, folder):
        self.scene.tool.write_shape(folder)

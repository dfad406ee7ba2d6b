"""What the folder of a cut shows."""
import math

import numpy as np
from yade import utils

from rockwear.engines import access
from rockwear.engines.bond_log import crack_counts
from rockwear.kernels.archard import KELVIN
from rockwear.kernels.rigid_motion import Pose
from rockwear.run import vtk
from rockwear.scenes.balances import energy_warnings, with_residual
from rockwear.scenes.output import Output, crack_table, density_map

SHALLOW = 0.05
"""Part of the depth of cut that may be missing below the tool's lowest particle without a word."""


class CutOutput(Output):
    """Output of a scenes.cut.Cut, whatever its parts."""

    def energy_balance(self):
        """{entry: J}: the tool's work, where it went, and what the balance misses."""
        scene = self.scene
        contact = scene.tool.contact
        balance = {"tool_work": contact.work_done, **scene.energy.changes(), "tool_friction": contact.friction,
                   "rock_friction": scene.rock_friction.total, "contact_dashpots": contact.dashpot_dissipated,
                   "bond_breaking": scene.bonds.energy_breaking,
                   "rock_crushing": scene.bonds.energy_crushed,
                   "background_damping": scene.damping.dissipated if scene.damping else 0.0,
                   "removed_contacts": scene.tool.removed_energy}
        if scene.grain_damping:
            balance["grain_damping"] = scene.grain_damping.dissipated
        if scene.dashpots:
            balance["bond_dashpots"] = scene.dashpots.dissipated
        if scene.boundary:
            balance["boundary_dashpots"] = scene.boundary.absorbed
        if scene.expansion:
            balance["thermal_expansion"] = -scene.expansion.work
        return with_residual(balance, "tool_work")

    def balances(self):
        scene = self.scene
        friction = {**scene.tool.friction_balance(), "rock": scene.rock_friction.total}
        found = {"energy": (self.energy_balance(), scene.units.energy), "friction": (friction, scene.units.energy),
                 "mass": (scene.tool.mass_balance(), scene.units.mass)}
        if scene.heat:
            found["heat"] = scene.heat.balance(), scene.units.energy
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
        if bodies.angular_velocity:
            bodies.connect()
        # Along the direction in which the tool looks, normal to it, and across.
        force = np.append(impulse[:2] @ bodies.pose.rotation, impulse[2])
        force = force / elapsed if elapsed else force
        # 0.0 - x is never -0.0: a tool that meets nothing has a force of 0.
        columns = {"time": (scene.time, "s"), "stage": (scene.stage, "-"), **scene.programme.log(),
                   "cutting_force": (0.0 - force[0], unit), "thrust_force": (force[1], unit)}
        if not scene.in_plane:
            columns["side_force"] = force[2], unit
        columns["tool_work"] = contact.work_done, joule
        if scene.in_plane:
            columns["kinetic_energy"] = utils.kineticEnergy(), joule
        return {**columns, "tool_friction": (contact.friction, joule),
                "bond_breaking": (scene.bonds.energy_breaking, joule),
                "rock_crushing": (scene.bonds.energy_crushed, joule)}

    def model(self):
        scene = self.scene
        rock = scene.rock
        size = {"box": np.array(rock.extent)} if scene.in_plane else {
            "block": np.array([rock.width, rock.height, rock.depth])}
        heat = {"thermal_positions": scene.tool.thermal_body.positions} if scene.heat else {}
        return {"rock_radii": rock.radii, "rock_fixed": rock.anchored, "bonds": rock.pairs,
                "outline": scene.tool.outline,
                **size, **heat, **scene.tool.model_arrays(), **scene.programme.arrays}

    def snapshot(self):
        scene = self.scene
        rock = scene.rock
        scene.tool.bodies.connect()
        pose = scene.tool.bodies.pose
        heat = {"temperature": scene.heat.network.temperature,
                "thermal_alive": scene.tool.thermal_body.alive} if scene.heat else {"temperature": np.empty(0)}
        places = rock.shown(access.rock_positions(rock))
        return {"time": scene.time, "stage": scene.stage, "rock_positions": places,
                **density_map(rock, places, scene.control_radius),
                "broken_bonds": np.bincount(rock.pairs[(scene.bonds.status != 0) & rock.bonded].ravel(),
                                            minlength=rock.count),
                "status": scene.bonds.status, "tool_offset": pose.offset - rock.frame[:2],
                "tool_turn": pose.turn,
                **heat, **scene.tool.snapshot()}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtp and tool.NNNN.vtp: diameter, broken bonds, density, temperature; the tool's pieces, worn
        depth."""
        scene = self.scene
        shot, rock = self.snapshot(), scene.rock
        fields = {"diameter": 2 * rock.radii, "broken_bonds": shot["broken_bonds"]}
        if "density" in shot:
            fields["density"] = shot["density"]
        if scene.heat:
            fields["temperature"] = shot["temperature"][:rock.count]
        places, of_tool, facets = scene.tool.points(scene.heat.temperature_of_pieces() if scene.heat else None)
        there = np.isfinite(shot["rock_positions"]).all(axis=1)
        vtk.write(folder, "rock", number, scene.time, shot["rock_positions"][there],
                  {name: values[there] for name, values in fields.items()})
        turned = Pose(shot["tool_offset"], shot["tool_turn"]).of(places[:, :2])
        vtk.write(folder, "tool", number, scene.time, np.column_stack([turned, places[:, 2:]]), of_tool,
                  facets)

    def progress(self):
        scene = self.scene
        cracks = scene.bonds.log()
        words = [f"{cracks['tensile_cracks'][0] + cracks['shear_cracks'][0]} cracks", scene.tool.words()]
        if scene.heat:
            words.append(f"hottest {scene.heat.log()['tool_temperature_max'][0] - KELVIN:.0f} C")
        return ", ".join(words)

    def results(self):
        scene = self.scene
        columns = scene.recorder.columns()
        found = {"simulated_time": (scene.time, "s"), "time_step": (scene.time_step, "s"),
                 "critical_time_step": (scene.critical_step, "s"),
                 "bonded_critical_time_step": (scene.bonded_step, "s"),
                 **scene.notes, **scene.programme.results(columns), **scene.tool.results(),
                 **crack_counts(self._cracks()),
                 **{f"rock_{name}": value for name, value in scene.rock.report().items()}}
        if scene.tool.profile:
            found.update(scene.tool.wear.trust(scene.tool))
        if scene.heat:
            now = scene.heat.log()
            for name in ("tool_temperature_max", "rock_temperature_max"):
                # Heat goes on after the last row.
                found[name] = float(np.nanmax([*columns.get(name, ()), now[name][0]])), "K"
        return found

    def _cracks(self):
        """Those in rock that has been replaced since, too."""
        return self.scene.programme.cracks() + self.scene.bonds.cracks

    def tables(self):
        return self._tables(ended=True)

    def growing_tables(self):
        return self._tables(ended=False)

    def _tables(self, ended):
        scene = self.scene
        profile = scene.tool.profile
        found = {**crack_table(self._cracks()), **scene.programme.tables(ended)}
        if profile:
            header = [f"place_{n} [{scene.units.volume}]" for n in range(profile.places)]
            found["wear_profile.csv"] = header, profile.increments
        return found

    def warnings(self):
        balance = self.energy_balance()
        idle = [] if balance["tool_work"] else ["the tool did not meet the rock: forces, wear and heat are 0"]
        return [*idle, *energy_warnings(balance), *self.scene.programme.warnings(), *self._depth_warnings(),
                *self._wear_warnings()]

    def _depth_warnings(self):
        """That the new tool's particles do not fill its outline down to the tip."""
        missed, asked = self.scene.tool.model.blunted, self.scene.depth_of_cut
        return [] if missed <= SHALLOW * asked else [
            f"the tool's lowest particle ends {missed:.2g} m above the tip of its outline: it cut {asked - missed:.3g} "
            f"m deep and not {asked:g}, over which specific energy counts. Smaller tool particles fill a sharper tip"]

    def _wear_warnings(self):
        scene = self.scene
        tool = scene.tool
        if not tool.profile:
            return tool.warnings() if tool.wear.law.wears else []
        short = [] if math.isfinite(scene.foremost()) else [
            f"nothing of the tool is left below the rock's surface, of its lowest {scene.depth_of_cut:g} m: it cuts no "
            "more"]
        return [*short, *tool.warnings(), *tool.wear.warnings(tool)]

    def write_shape(self, folder):
        self.scene.tool.write_shape(folder)

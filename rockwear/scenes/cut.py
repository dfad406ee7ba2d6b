"""A cut, put together from parts: a rock, a tool assembly, a programme of motion, and the physics that it needs."""
import numpy as np
from yade import O

from rockwear.engines import access
from rockwear.engines.base import FORCES, RunEnded
from rockwear.engines.bond_dashpots import BondDashpots
from rockwear.engines.damping import BackgroundDamping, GrainDamping
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.path_follower import PathFollower
from rockwear.engines.recorder import Recorder
from rockwear.engines.separation import Separation
from rockwear.engines.shear_rotation import ShearRotation
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.model.contact import PLANE
from rockwear.scenes import yade_scene
from rockwear.scenes.accuracy import chosen_step
from rockwear.scenes.balances import StoredEnergy
from rockwear.scenes.cut_output import CutOutput
from rockwear.scenes.scene import Scene
from rockwear.scenes.time_step import plane_steps, space_steps

PATH_PERIOD = 100
"""Steps N between the corners of a curved path, which chords leave by (v dt N)^2 / 8R: 23 nm at 5.7 m/s and 0.7 m."""
BOUNDARY_PERIOD = 10
"""Steps between samples of the energy that the boundary absorbs."""
DAMPED = 0.2
"""Part of the rock's velocity that one visit of the background damping may take: between visits it moves undamped."""
SEPARATION_PERIOD = GUARD_PERIOD = 200
"""Steps between looks for separated bonds, and at the energy."""


class Cut(Scene):
    """A rigid tool cuts rock.

    rock: a specimen of model.rock; bond_law: of kernels.bond_laws, which also gives the stiffness and friction of
    contacts in the rock; tool: a ToolAssembly; programme: a Programme; accuracy: scenes.accuracy.Accuracy; heat,
    expansion, gravity, boundary: of scenes.physics, or None; background_damping: 1/s; non_viscous_damping: of each
    force; bond_damping: of the critical damping of bonds, in the plane; grain_quality: quality factor of vibrations
    within grains at the highest frequency of the bonded rock, 0: they are not damped; time_scale: mechanical over
    physical rate; depth_of_cut: m, to which depth the tool must reach to cut; notes: {name: (value, unit)} of further
    results; first_temperature: K of a tool without heat; control_radius: of the density map, in particle radii, 0 for
    none.

    In the plane the balances count per metre of thickness.
    """

    def __init__(self, *, rock, bond_law, tool, programme, accuracy, depth_of_cut, first_temperature, heat=None,
                 expansion=None, gravity=None, boundary=None, background_damping=0.0, non_viscous_damping=0.0,
                 bond_damping=0.0, grain_quality=0.0, time_scale=1.0, notes=None, control_radius=0.0):
        super().__init__()
        self.rock, self.bond_law, self.tool, self.programme, self.accuracy = rock, bond_law, tool, programme, accuracy
        self.heat_model, self.expansion_model, self.gravity, self.boundary_model = heat, expansion, gravity, boundary
        self.background_damping, self.time_scale = background_damping, time_scale
        self.non_viscous_damping, self.bond_damping = non_viscous_damping, bond_damping
        self.grain_quality = grain_quality
        self.depth_of_cut, self.first_temperature, self.notes = depth_of_cut, first_temperature, notes or {}
        self.control_radius = control_radius
        self.units = tool.units
        self.in_plane = self.units is PLANE
        # YADE's shear by full radii gains energy where spheres overlap by a tenth of their size.
        self.ratcheting_free = self.in_plane
        if rock.laws is None:
            rock.bond(bond_law)
        programme.attach(self)
        if self.in_plane:
            self.bonded_step, self.contact_step = plane_steps(rock, tool.contact_law, bond_damping)
        else:
            self.bonded_step, self.contact_step = space_steps(rock, bond_law, tool.contact_law)
        self.critical_step = min(self.bonded_step, self.contact_step)
        self.time_step = chosen_step(accuracy, self.critical_step)
        self._plan(programme.stages())
        programme.planned()
        if programme.window:
            self.chunk = min(self.chunk, programme.window.most_steps(programme.fastest() * self.time_step))
        self.energy = StoredEnergy(self.stored_energy)
        self.output = CutOutput(self)

    def foremost(self):
        """x (m) in the tool's frame of the foremost of what is left of it below the rock's surface, -inf for
        nothing."""
        return self.tool.foremost(below=self.depth_of_cut)

    # ---- YADE

    def build(self):
        O.reset()
        contact = self.tool.contact_law
        yade_scene.put_rock_materials(mu=self.bond_law.mu, loose=self.tool.loose_material,
                                      yade_law=self.bond_law.yade_law)
        yade_scene.put_tool_material(mu=contact.mu, contact_damping=contact.damping)
        yade_scene.put_rock(self.rock)
        self.tool.put_loop(rock=self.bond_law, tool=contact, ratcheting_free=self.ratcheting_free,
                           damping=self.non_viscous_damping)
        O.trackEnergy = self.non_viscous_damping > 0
        self._make_engines()
        yade_scene.make_bonds(self.rock, self.bonds)
        self.tool.insert()
        self._insert_engines()
        self.programme.begin()
        if self.heat:
            self.heat.begin()
            self.heat_model.check_period(self.heat, self.accuracy.heat_period)
        self.energy.begin()
        self.canonical()
        if self.gravity:
            self.gravity.switch_on()

    def _make_engines(self):
        rock, tool, accuracy = self.rock, self.tool, self.accuracy
        self.bonds = yade_scene.bonds_engine(rock, self.bond_law, lambda: self.time)
        increment = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=rock.fixed,
                                      gravity=self.gravity.vector if self.gravity else None)
        tool.make_engines(motion=self.programme.motion, increment=increment, wear_period=accuracy.wear_period,
                          temperature=self._tool_temperature, on_removal=self._on_removal)
        self.rock_friction = tool.rock_friction(self.bonds, increment, accuracy.rock_sampling_period)
        self._make_heat()
        self.damping = self._make_damping()
        self.grain_damping = None
        if self.grain_quality and rock.grains is not None:
            # Q = omega / rate of a mode of the frequency omega, of which 2 over the critical step is the highest, where
            # no dashpots of bonds make this step shorter.
            step = plane_steps(rock, tool.contact_law)[0] if self.bond_damping else self.bonded_step
            self.grain_damping = GrainDamping(rock=rock, bonds=self.bonds, period=accuracy.damping_period,
                                              rate=2.0 / (self.grain_quality * step))
        self.dashpots = None
        if self.bond_damping:
            self.dashpots = BondDashpots(rock=rock, bonds=self.bonds, ratio=self.bond_damping)
        self.boundary = None
        if self.boundary_model:
            self.boundary = self.boundary_model.engine(rock, period=BOUNDARY_PERIOD, step=self.time_step,
                                                       critical=self.bonded_step)
        self.recorder = Recorder(self.output.history(), period=max(1, self.steps_in(accuracy.record_period)))
        self.guard = EnergyGuard(work=lambda: tool.contact.work_done, floor=self._least_energy(), period=GUARD_PERIOD)
        if self.non_viscous_damping:
            # After the step it cannot be told how fast bodies were before it.
            tool.contact.phase = self.rock_friction.phase = FORCES
        curved = self.programme.motion.angular_velocity
        turned_in_space = not self.in_plane and len(rock.pairs)
        self._register(
            self.bonds, self.dashpots, tool.contact, self.rock_friction,
            ShearRotation(bonds=self.bonds, radii=rock.radii) if turned_in_space else None,
            Separation(self.bonds, period=SEPARATION_PERIOD) if self.bond_law.yade_law == "JCFpm" else None,
            PathFollower(bodies=tool.bodies, clock=self.programme.path_time, period=PATH_PERIOD) if curved else None,
            tool.wear_engine, tool.profile, self.heat, self.expansion, self.damping, self.grain_damping,
            self.boundary, self.recorder, self.guard)

    def _make_heat(self):
        self.heat = self.expansion = None
        if not self.heat_model:
            return
        period = max(1, self.steps_in(self.accuracy.heat_period))
        common = dict(rock=self.rock, bonds=self.bonds, rock_friction=self.rock_friction,
                      tool_contact=self.tool.contact)
        self.heat = self.heat_model.engine(
            **common, body=self.tool.thermal_body, wear_acceleration=self.tool.wear.acceleration,
            time_scale=self.programme.heat_time_scale, surface_period=self.accuracy.surface_period, period=period)
        if self.expansion_model:
            self.expansion = self.expansion_model.engine(**common, heat=self.heat, period=period)

    def _make_damping(self):
        rates = self.programme.damping_rates or [self.background_damping]
        if not any(rates):
            return None
        most = max(1, int(DAMPED / (max(rates) * self.time_step)))
        return BackgroundDamping(rate=rates[0], bodies=range(self.rock.count),
                                 period=min(self.accuracy.damping_period, most))

    def _least_energy(self):
        """J that the run may hold whatever the tool's work: a heavy particle at five times the tool's speed, a fall
        by a radius."""
        rock = self.rock
        fall = float(rock.masses.sum()) * self.gravity.g * float(rock.radii.max()) if self.gravity else 0.0
        return 25 * float(rock.masses.max()) * self.programme.fastest()**2 + fall

    def _connect(self):
        super()._connect()
        self.tool.bodies.connect()

    def skip(self, steps):
        super().skip(steps)
        self.programme.path_start += steps

    def connect_again(self):
        """The scene in O has been loaded."""
        self._connect()
        self.first_iteration = O.iter

    def _tool_temperature(self):
        return self.heat.temperature_of_pieces() if self.heat else np.full(self.tool.count, self.first_temperature)

    def _on_removal(self, worn=(), loose=()):
        if self.heat:
            self.heat.remove(worn, loose)
        if not self.tool.bodies.body_of:
            # A simulation that blows up may wear the tool away before its guard comes by.
            self.guard.act()
            raise RunEnded("the tool is worn away", True)

    # ---- stages

    @property
    def step(self):
        return self.programme.step

    @property
    def time(self):
        return self.programme.time

    def run_chunk(self):
        if not self.programme.run():
            super().run_chunk()

    def canonical(self):
        super().canonical()
        self.tool.contact.find_contacts()
        if not self.heat:
            # Nobody else takes contact times, and new pairs come as long as the cut goes on.
            self.tool.contact.take_heating()

    def end_stage(self, folder):
        """Close the balances of the stage; the programme prepares the next one."""
        self.programme.close_stage()
        for engine in (self.tool.wear_engine, self.tool.profile, self.damping, self.boundary, self.heat):
            if engine:
                engine.act()
        self.recorder.close()
        self.energy.close()
        super().end_stage(folder)
        self._set_damping()
        self.programme.begin_stage(folder)
        self.energy.begin()
        if not self.finished and not self.programme.reaches_rock():
            raise RunEnded("nothing of the tool reaches the rock any more", True)
        self.programme.stage_begun(folder)

    def _set_damping(self):
        rates = self.programme.damping_rates
        if self.damping and rates:
            self.damping.rate = rates[min(self.stage, len(rates) - 1)]

    def close_balances(self):
        """Rock is about to be replaced: what it stores now is what it has gained."""
        if self.heat:
            self.heat.act()
        self.energy.close()

    def open_balances(self, numbers):
        """The particles `numbers` (k,) are untouched rock now."""
        if self.damping:
            self.damping.connect()
        self.canonical()
        if self.heat:
            self.heat.renew_rock(numbers, self.heat_model.rock_temperature)
        self.energy.begin()

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "energy": self.energy.state(), "bodies": self.tool.bodies.state(),
                "programme": self.programme.state()}

    def save(self, directory, folder):
        super().save(directory, folder)
        self.programme.save(directory, folder)

    def restore(self, state, directory, folder):
        self.programme.load(directory, folder)
        super().restore(state, directory, folder)
        self.programme.restore(state["programme"])
        self.energy.restore(state["energy"])

    def _restore_engines(self, state):
        self.tool.bodies.restore(state["bodies"])
        super()._restore_engines(state)
        self._set_damping()

    # ---- balances

    def stored_energy(self):
        found = super().stored_energy()
        found["contact_elastic"] += self.tool.contact.elastic_energy()
        if self.boundary:
            found["boundary_elastic"] = self.boundary.elastic_energy()
        if self.non_viscous_damping:
            # It is not stored, but a stage that begins anew resets YADE's sum like the stored energies.
            found["non_viscous_damping"] = access.damped_energy()
        if self.gravity:
            found["potential"] = float(self.rock.masses @ access.rock_positions(self.rock)[:, 1]) * self.gravity.g
        return found

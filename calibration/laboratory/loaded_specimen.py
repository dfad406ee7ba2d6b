"""Laboratory tests: a specimen of bonded rock, discs or spheres, held and loaded at its two ends.

The platens are the specimen's own particles at its left and right ends, which move along x at a constant speed, free
across it and free to turn: each end is perfectly capped and without friction. Rough platens hold these particles across
and against turning as well.
"""
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from yade import O

from calibration.laboratory.loading import SCALED, LoadedRock
from rockwear.engines import access
from rockwear.engines.base import FORCES
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.failure import Failure
from rockwear.engines.platens import Platens
from rockwear.engines.recorder import Recorder
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.separation import Separation
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, above_zero, choice, length_or_zero, number, speed
from rockwear.kernels.stability import critical_time_step
from rockwear.model.contact import PLANE, SPACE
from rockwear.model.rock import Block, Specimen
from rockwear.run import vtk
from rockwear.scenes import parameters, parts, yade_scene
from rockwear.scenes.accuracy import chosen_step
from rockwear.scenes.balances import energy_warnings, with_residual
from rockwear.scenes.output import Output, crack_table, density_map
from rockwear.scenes.scene import Scene

LOADING = (
    Parameter("speed", 0.05, "m/s", speed, "of each platen", "make bench; [Rojek 2003, 5.1] has 0.001"),
    Parameter("platens", "smooth", "", choice("smooth", "rough"), "rough: ends held across and against turning"),
    Parameter("grip", 0.0, "m", length_or_zero, "particles with their centres so near an end move with it; 0: a "
              "largest diameter"),
    Parameter("damping", 0.3, "", number(0, 0.95), "Cundall's non-viscous damping", "measured, see UniaxialTest"),
    Parameter("gauge", 0.5, "", number(0.05, 1), "middle part of length and height in which strain is measured"),
    Parameter("drop", 0.5, "", number(0, 1), "the test ends where stress has fallen to this part of its peak"),
    Parameter("strain_max", 0.02, "", above_zero, "the test ends at this shortening or lengthening over the width"),
    Parameter("record_strain", 1e-5, "", above_zero, "shortening over the width between rows of history.csv"))
"""Parameters of every test."""
BY_THE_ROCK = "with a rock of known strength and E by their ratio, unless it is given"
LOOK_IN_SPACE = 2
"""Steps between looks at softening bonds in space, where steps are long against the time in which a bond opens: with 10
the energy balance misses 5 %, with 3 0.6 %, with 2 less."""

IN_THE_PLANE = parameters.SPECIMEN
IN_SPACE = parameters.BLOCK.without("scale_factor", "full", "gravity")
"""The specimen."""
SIDES = {"width": "length of the specimen, along the loading", "height": "height of the specimen, across the loading",
         "depth": "depth of the specimen, across the loading"}
"""{parameter of a specimen: what it is in a test}."""


def groups(*own, rock=IN_THE_PLANE, without=(), test=None, **defaults):
    """Parameter groups of a test. own: its own Parameters, before those of every test; rock: IN_THE_PLANE or IN_SPACE;
    without: names of those of every test that it does not have; test: {name: value} -> name of the test whose loading
    a rock decides on (loading.LoadedRock), None: it does not; defaults: other than there."""
    def kept(group):
        return replace(group, parameters=tuple(replace(p, meaning=SIDES.get(p.name, p.meaning)) for p in
                                               group.parameters if p.name not in without))

    bonds, loading = parameters.BONDS.parameters, LOADING
    if test:
        bonds = [replace(p, presets=LoadedRock(parameters.OF_ROCK, test=test)) if p.name == "rock" else p
                 for p in bonds]
        loading = [replace(p, meaning=f"{p.meaning}; {BY_THE_ROCK}") if p.name in SCALED else p for p in loading]
    return parameters.with_defaults(
        [kept(rock), replace(parameters.BONDS, parameters=bonds),
         kept(Group("loading", (*own, *loading))),
         parameters.ACCURACY.only("time_step_fraction", "time_step", "rock_sampling_period"), parameters.DENSITY_MAP],
        **{"time_step_fraction": 0.6, **defaults})


class SpecimenTest(Scene):
    """A test along x between two platens. values: {name: value} of all parameters of `groups`.

    A test says `sign` (1: the platens part, -1: they approach), `output_class`, and where it differs from the others
    what the methods _specimen, _ends, _gauge, _section, _durations, _mean_motion and _further_engines give, which
    engines work on the specimen (`works`), and what falls when it fails (`strength_measure`).

    Stress and strains count positive in the direction of the loading: stress is the platens' mean force over the
    section, and axial and lateral strain are the slopes of the plane that fits best through the displacements of the
    particles of the gauge. (The travel of the platens would count the ends' own compliance as rock.)
    """

    sign, output_class = -1, None
    beside_strength_measure = noise = 0.0
    """Pa that the specimen bears beside `strength_measure`, and by which that may fall without failure."""

    def __init__(self, values):
        super().__init__()
        v = self.v = SimpleNamespace(**values)
        self.law = parts.bond_law(v)
        self.rock = rock = parts.bond(self._specimen(), v)
        self.left, self.right = self._ends()
        self.prescribed = np.zeros(rock.count, bool)
        self.prescribed[self.left] = self.prescribed[self.right] = True
        self.section = self._section()
        self.stress = 0.0
        self._place_gauge()
        self._choose_time_step()
        self._plan(self._durations())
        self.output = self.output_class(self)

    # ---- what a test may give otherwise

    def _specimen(self):
        """The rock: of rockwear.model.rock."""
        v = self.v
        common = dict(width=v.width, height=v.height, porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap,
                      density=v.rock_density)
        if "depth" in vars(v):
            return Block(depth=v.depth, radius=v.radius, **common)
        require(v.radius_max >= v.radius_min, "radius_max", v.radius_max, f"at least radius_min = {v.radius_min:g}",
                "m")
        return Specimen(radius_min=v.radius_min, radius_max=v.radius_max, grading_factor=v.grading_factor,
                        fine_depth=v.fine_depth, **common)

    def _ends(self):
        """Indices of the particles of the left and of the right platen."""
        rock = self.rock
        grip = self.v.grip or 2 * float(rock.radii.max())
        x = rock.positions[:, 0]
        left, right = np.flatnonzero(x < grip), np.flatnonzero(x > rock.width - grip)
        require(len(left) and len(right), "grip", grip, "deep enough to hold a particle at each end", "m")
        require(2 * grip < rock.width, "grip", grip, f"less than half the width {rock.width:g}", "m")
        return left, right

    def _gauge(self):
        """Indices of the particles in whose displacements strain is measured."""
        off = np.abs(self.rock.positions - self.rock.centre)
        return np.flatnonzero(np.all(off <= 0.5 * self.v.gauge * np.array(self.rock.size), axis=1))

    def _section(self):
        """m, in space m2: stress is the platens' force over it."""
        return math.prod(self.rock.size[1:])

    def _durations(self):
        """{stage: s}."""
        return {"loading": self.loading_time}

    def _mean_motion(self):
        """(n, d) m/s, of a homogeneous body between the platens, with nu of the lattice (plane) or the Voigt bound
        (space)."""
        v, law, places = self.v, self.law, self.rock.positions
        begin, end = places[self.left, 0].mean(), places[self.right, 0].mean()
        rate = 2 * self.sign * v.speed / (end - begin)
        off = places - self.rock.centre
        off[:, 0] = places[:, 0] - 0.5 * (begin + end)
        nu = (law.kn - law.kt) / ((self.rock.dimensions + 1) * law.kn + law.kt)
        return rate * off * [1.0, *[-nu] * (self.rock.dimensions - 1)]

    def _further_engines(self):
        """Engines of this test alone; they come between the bonds and the friction."""
        return ()

    def works(self):
        """{name: J, in the plane per metre} done on the specimen, the platens' first."""
        return {"platen_work": self.platens.work}

    def strength_measure(self):
        """Pa: the test ends where this has fallen."""
        return self.stress

    # ---- set-up

    @property
    def loading_time(self):
        """s until strain_max."""
        return self.v.strain_max * self.rock.width / (2 * self.v.speed)

    def _place_gauge(self):
        self.inside = self._gauge()
        least = 2 if self.rock.depth is None else 4
        require(len(self.inside) >= least, "gauge", self.v.gauge, f"wide enough to hold {least} particles")
        # Least squares: displacement = a + slopes . position, solved once for the slopes.
        points = np.column_stack([np.ones(len(self.inside)), self.rock.positions[self.inside]])
        self.slopes = np.linalg.pinv(points)[1:]

    def _choose_time_step(self):
        rock, (kn, kt) = self.rock, self.rock.stiffness()
        self.critical_step = critical_time_step(
            positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias, bonds=rock.pairs,
            kn=kn, kt=kt, ratcheting_free=rock.depth is None)
        self.time_step = chosen_step(self.v, self.critical_step)

    def build(self):
        """Fill YADE's scene: bodies, bonds, engines; the specimen already in its mean motion."""
        O.reset()
        v, rock = self.v, self.rock
        yade_scene.put_rock_materials(mu=self.law.mu, yade_law=self.law.yade_law)
        yade_scene.put_rock(rock)
        yade_scene.put_loop(rock=self.law, damping=v.damping, ratcheting_free=rock.depth is None)
        O.trackEnergy = True
        self._make_engines()
        yade_scene.make_bonds(rock, self.bonds)
        self._hold_ends()
        self._set_off()
        self._insert_engines()
        self.base = self.stored_energy()
        self.canonical()

    def _hold_ends(self):
        rough = self.v.platens == "rough"
        across, turns, never = ("y", "Z", "zXY") if self.rock.depth is None else ("yz", "XYZ", "")
        for i, prescribed in enumerate(self.prescribed):
            state = O.bodies[i].state
            state.blockedDOFs = never + ("x" if prescribed else "") + (across if prescribed and rough else "") + (
                turns if prescribed and rough else "")
            if prescribed:
                # YADE would count what it damps of a motion that is prescribed.
                state.isDamped = False

    def _set_off(self):
        """Put the specimen into its mean motion: set off from rest, it would ring."""
        motion = np.zeros((self.rock.count, 3))
        motion[:, :self.rock.dimensions] = self._mean_motion()
        motion[self.left, 0], motion[self.right, 0] = -self.sign * self.v.speed, self.sign * self.v.speed
        motion[self.prescribed & (self.v.platens == "rough"), 1:] = 0.0
        for i, velocity in enumerate(motion.tolist()):
            O.bodies[i].state.vel = velocity

    def _make_engines(self):
        v, rock = self.v, self.rock
        row = max(1, round(v.record_strain * rock.width / (2 * v.speed * self.time_step)))
        often = {"period": LOOK_IN_SPACE} if rock.depth is not None and self.law.yade_law == "Cpm" else {}
        self.bonds = yade_scene.bonds_engine(rock, self.law, lambda: self.time, **often)
        motion = VelocityIncrement(masses=rock.masses, inertias=rock.inertias, radii=rock.radii, fixed=self.prescribed)
        self.rock_friction = RockFriction(bonds=self.bonds, motion=motion, period=v.rock_sampling_period)
        # What the integrator's damping has taken cannot be told after it.
        self.rock_friction.phase = FORCES
        self.platens = Platens(left=self.left.tolist(), right=self.right.tolist(), velocity=self.sign * v.speed,
                               period=min(row, v.rock_sampling_period))
        self.recorder = Recorder([self.output.log, self.bonds.log], period=row)
        self.failure = Failure(stress=self.strength_measure, broken=lambda: self.bonds.cracks, drop=v.drop,
                               beside=self.beside_strength_measure, noise=self.noise, period=row)
        guard = EnergyGuard(work=lambda: sum(self.works().values()), floor=0.5 * rock.masses.sum() * v.speed**2,
                            period=200)
        self._register(self.bonds, *self._further_engines(), self.rock_friction, Separation(self.bonds, period=200),
                       self.platens, self.recorder, self.failure, guard)

    # ---- what is measured

    def platen_travel(self):
        """m by which the platens have approached or parted."""
        return 2 * self.v.speed * self.time

    def displacements(self):
        """(n, d) m since the specimen was bonded."""
        return access.rock_positions(self.rock) - self.rock.positions

    def strains(self):
        """(axial, lateral) in the gauge now, positive in the direction of the loading; in space lateral is the mean of
        the two directions across."""
        axial, *lateral = np.diagonal(self.slopes @ self.displacements()[self.inside])
        return self.sign * float(axial), self.sign * float(np.mean(lateral))

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "base": self.base, "stress": self.stress}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self.base = {name: float(value) for name, value in state["base"].items()}
        self.stress = float(state["stress"])


class SpecimenOutput(Output):
    """What the folder of a laboratory test shows."""

    @property
    def energy(self):
        """Unit of energy."""
        return (PLANE if self.scene.rock.depth is None else SPACE).energy

    @property
    def failed(self):
        """Whether the stress has fallen to `drop` of its peak."""
        return bool(self.scene.failure.has_fallen(self.scene.strength_measure()))

    def warnings(self):
        found = energy_warnings(self.balances()["energy"][0])
        if not self.failed:
            found.append(f"the stress has not fallen to {self.scene.v.drop:g} of its peak: strengths are what the "
                         "specimen bore up to here; a larger strain_max tells more")
        columns = self.scene.recorder.columns()
        results = self.found(columns) if columns else {}
        unknown = [name for name, (value, _) in results.items() if math.isnan(value)]
        if unknown or not results:
            found.append(f"not known: {', '.join(unknown) or 'strengths and moduli'}; the record is too short or too "
                         "coarse for them: a lower record_strain or speed tells more")
        return found

    def log(self):
        """{name: (value, unit)} of the history."""
        pull, difference = self.scene.platens.take_mean()
        self.scene.stress = self.scene.sign * pull / self.scene.section
        axial, lateral = self.scene.strains()
        travel = self.scene.platen_travel() / self.scene.rock.width
        return {"time": (self.scene.time, "s"), "stage": (self.scene.stage, "-"), "stress": (self.scene.stress, "Pa"),
                "unbalanced_stress": (difference / self.scene.section, "Pa"), "axial_strain": (axial, "-"),
                "lateral_strain": (lateral, "-"), "platen_strain": (travel, "-"),
                "bond_breaking": (self.scene.bonds.energy_breaking, self.energy)}

    def found(self, columns):
        """{name: (value, unit)} that the history's columns show, the test's own results."""
        return {}

    def results(self):
        """{name: (value, unit)} of the run."""
        columns, scene = self.scene.recorder.columns(), self.scene
        found = {"failed": (self.failed, "-")}
        if columns:
            found.update(self.found(columns))
            for name in ("tensile_cracks", "shear_cracks"):
                found[f"{name}_at_peak"] = int(columns[name][columns["stress"].argmax()]), "-"
        return {**found, "simulated_time": (scene.time, "s"), "time_step": (scene.time_step, "s"),
                "critical_time_step": (scene.critical_step, "s"), **scene.bonds.log(),
                **{f"rock_{name}": value for name, value in scene.rock.report().items()}}

    def _damped(self):
        return access.damped_energy()

    def balances(self):
        """The energy balance, in the plane per metre of thickness: the work on the specimen, where it went, and what
        the balance misses."""
        source, *others = works = self.scene.works()
        balance = {source: works[source], **{f"against_{name}": -works[name] for name in others}}
        balance.update({name: now - self.scene.base[name] for name, now in self.scene.stored_energy().items()})
        balance.update(rock_friction=self.scene.rock_friction.total,
                       bond_breaking=self.scene.bonds.energy_breaking,
                       rock_crushing=self.scene.bonds.energy_crushed, numerical_damping=self._damped())
        return {"energy": (with_residual(balance, source), self.energy)}

    def model(self):
        """Arrays that stay the same all through a run."""
        rock = self.scene.rock
        return {"rock_positions": rock.positions, "rock_radii": rock.radii, "bonds": rock.pairs,
                "rock_prescribed": self.scene.prescribed, "gauge": self.scene.inside,
                "box" if rock.depth is None else "block": np.array(rock.size),
                **({} if rock.grains is None else {"grains": rock.grains})}

    def snapshot(self):
        """Arrays that show the scene now."""
        broken = np.bincount(self.scene.rock.pairs[self.scene.bonds.status !=
                             0].ravel(), minlength=self.scene.rock.count)
        return {"time": self.scene.time, "stage": self.scene.stage,
                "rock_positions": access.rock_positions(self.scene.rock), "displacement": self.scene.displacements(),
                "broken_bonds": broken, "status": self.scene.bonds.status, "softening": self.scene.bonds.softening(),
                **density_map(self.scene.rock, access.rock_positions(self.scene.rock), self.scene.v.control_radius)}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtp: diameter, broken bonds, displacement, density."""
        shot = self.snapshot()
        vtk.write(folder, "rock", number, self.scene.time, shot["rock_positions"],
                  {"diameter": 2 * self.scene.rock.radii, "broken_bonds": shot["broken_bonds"],
                   **{name: shot[name] for name in ("density",) if name in shot},
                   **{f"displacement_{axis}": moved for axis, moved in zip("xyz", shot["displacement"].T)}})

    def tables(self):
        return crack_table(self.scene.bonds.cracks)

    def progress(self):
        return f"{self.scene.stress / 1e6:.3g} MPa, {len(self.scene.bonds.cracks)} cracks"

"""The virtual laboratory: a specimen of bonded rock compressed or pulled between two platens (M 5.1).

The platens are the specimen's own discs at its left and right ends, led along x at a constant speed, free across it and
free to turn: each end is perfectly capped and without friction, so that the whole specimen is under uniaxial stress.
Rough platens hold these discs across and against turning as well.
"""
import math
from types import SimpleNamespace

import numpy as np
from yade import O

from rockwear.scenes import yade_scene
from rockwear.scenes.scene import Scene
from rockwear.run import vtk
from rockwear.scenes import cutting
from rockwear.engines.bonds import Bonds
from rockwear.engines.separation import Separation
from rockwear.engines.rock_friction import RockFriction
from rockwear.engines.velocity_increment import VelocityIncrement
from rockwear.engines.failure import Failure
from rockwear.engines.platens import Platens
from rockwear.engines.energy_guard import EnergyGuard
from rockwear.engines.recorder import Recorder
from rockwear.kernels.bond_laws import linear_law
from rockwear.kernels.checks import require
from rockwear.kernels.stability import critical_time_step
from rockwear.kernels.parameter import Parameter, above_zero, choice, number
from rockwear.model.rock import Specimen

SHARED = ("width height radius_min radius_max porosity seed bonding_gap kn kt Rn Rt bond_law H mu rock_density "
          "time_step_fraction time_step rock_sampling_period").split()
"""Parameters that are those of the cut."""

PARAMETERS = [p for p in cutting.parameters(time_step_fraction=0.6) if p.name in SHARED] + [
    Parameter("test", "compression", "", choice("compression", "tension"), "direction of loading", "M 5.1"),
    Parameter("speed", 0.05, "m/s", above_zero, "of each platen", "make bench; M 5.1 has 0.001"),
    Parameter("platens", "smooth", "", choice("smooth", "rough"), "rough: ends held across and against turning"),
    Parameter("rotation", "free", "", choice("free", "blocked"), "of all discs; blocked: no disc ever turns"),
    Parameter("grip", 0.0, "m", number(0), "discs with their centres so near an end are led; 0: a largest diameter"),
    Parameter("damping", 0.3, "", number(0, 0.95), "Cundall's non-viscous damping", "measured, see UniaxialTest"),
    Parameter("gauge", 0.5, "", number(0.05, 1), "middle part of length and height in which strain is measured"),
    Parameter("drop", 0.5, "", number(0, 1), "the test ends where stress has fallen to this part of its peak"),
    Parameter("strain_max", 0.02, "", above_zero, "the test ends at this shortening or lengthening over the width"),
    Parameter("record_strain", 1e-5, "", above_zero, "shortening over the width between rows of history.csv"),
]

ELASTIC_RANGE = 0.1, 0.4
"""Stresses over the peak between which E and nu are taken."""


class UniaxialTest(Scene):
    """Uniaxial compression or direct tension along x. values: {name: value} of all PARAMETERS.

    Stress and strains count positive in the direction of the loading: stress is the platens' mean force over the
    section height x 1 m, and axial and lateral strain are the slopes of the plane that fits best through the
    displacements of the discs in the middle of the specimen. (The travel of the platens would count the ends' own
    compliance as rock.)

    Speed: the default is the fastest at which, and below which, strength and E of every packing
    stay within 2 % of those at 0.0125 m/s, for M's bonds and P's, in compression and tension (make bench redraws the
    curve; calibration/results/uniaxial.md shows it). At 0.1 m/s strengths are up to 4 % too high. A rock of less strength
    strains less until it fails: load it as much more slowly. Stronger damping delays the rock's relaxation: at 0.7 and 0.2 m/s M's tensile strength is 10 % too high. What the damping itself does: M's UCS
    is 182, 186 and 189 MPa at 0.1, 0.3 and 0.7 (0.05 m/s).

    Cundall's damping switches with the sign of each velocity and stiffens what it damps: long before a step of 0.8 of
    the critical one blows up, the discs chatter, and the damping of the chatter drags on the moving specimen. With
    kt = kn/5 and damping 0.3 it makes E 1 % (lattice) to 4 % (P's rock) too high; at 0.7 of the step, or damping 0.2,
    it is gone. Hence the default of 0.6.
    """

    def __init__(self, values):
        self.values = values
        v = self.v = SimpleNamespace(**values)
        require(v.radius_max >= v.radius_min, "radius_max", v.radius_max, f"at least radius_min = {v.radius_min:g}",
                "m")
        self.law = linear_law(v.bond_law, kn=v.kn, kt=v.kt, Rn=v.Rn, Rt=v.Rt, H=v.H, mu=v.mu)
        self.rock = rock = self._specimen()
        grip = v.grip or 2 * float(rock.radii.max())
        x = rock.positions[:, 0]
        self.left, self.right = np.flatnonzero(x < grip), np.flatnonzero(x > rock.width - grip)
        require(len(self.left) and len(self.right), "grip", grip, "deep enough to hold a disc at each end", "m")
        require(2 * grip < rock.width, "grip", grip, f"less than half the width {rock.width:g}", "m")
        self.prescribed = np.zeros(rock.count, bool)
        self.prescribed[self.left] = self.prescribed[self.right] = True
        self.sign = 1 if v.test == "tension" else -1
        self.stress = 0.0
        self._place_gauge()
        self._choose_time_step()
        self._plan({v.test: v.strain_max * rock.width / (2 * v.speed)})

    def _specimen(self):
        v = self.v
        return Specimen(width=v.width, height=v.height, radius_min=v.radius_min, radius_max=v.radius_max,
                        porosity=v.porosity, seed=v.seed, bonding_gap=v.bonding_gap, density=v.rock_density)

    def _place_gauge(self):
        rock, size = self.rock, np.array([self.rock.width, self.rock.height])
        off = np.abs(rock.positions - size / 2)
        self.inside = np.flatnonzero(np.all(off <= 0.5 * self.v.gauge * size, axis=1))
        require(len(self.inside) > 1, "gauge", self.v.gauge, "wide enough to hold two discs")
        # Least squares: displacement = a + slopes . position, solved once for the slopes.
        points = np.column_stack([np.ones(len(self.inside)), rock.positions[self.inside]])
        self.slopes = np.linalg.pinv(points)[1:]

    def _choose_time_step(self):
        v, rock = self.v, self.rock
        self.critical_step = critical_time_step(
            positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias, bonds=rock.pairs,
            kn=v.kn, kt=v.kt)
        require(v.time_step <= self.critical_step, "time_step", v.time_step,
                f"at most the stable step {self.critical_step:.3e} of this scene", "s")
        self.time_step = v.time_step or v.time_step_fraction * self.critical_step

    # ---- YADE

    def build(self):
        """Fill YADE's scene: bodies, bonds, engines; the specimen already in its mean motion."""
        O.reset()
        v, rock = self.v, self.rock
        yade_scene.put_rock_materials(mu=v.mu)
        yade_scene.put_rock(rock)
        yade_scene.put_loop(kn=v.kn, kt=v.kt, mu=v.mu, damping=v.damping)
        O.trackEnergy = True
        self._make_engines()
        yade_scene.make_bonds(rock, self.bonds)
        self._set_off()
        self._insert_engines()
        self.base = self._stored_energy()
        self.canonical()

    def _set_off(self):
        """The motion of a homogeneous body with the lattice's nu: set off from rest, the specimen would ring."""
        v, (x, y), rough = self.v, self.rock.positions.T, self.v.platens == "rough"
        begin, end = x[self.left].mean(), x[self.right].mean()
        rate = 2 * self.sign * v.speed / (end - begin)
        along = rate * (x - 0.5 * (begin + end))
        along[self.left], along[self.right] = -self.sign * v.speed, self.sign * v.speed
        across = -rate * (v.kn - v.kt) / (3 * v.kn + v.kt) * (y - 0.5 * self.rock.height)
        across[self.prescribed & rough] = 0.0
        for i, (vx, vy, prescribed) in enumerate(zip(along.tolist(), across.tolist(), self.prescribed)):
            state = O.bodies[i].state
            state.vel = (vx, vy, 0)
            state.blockedDOFs = ("x" if prescribed else "") + ("y" if prescribed and rough else "") + "zXY" + (
                "Z" if v.rotation == "blocked" or prescribed and rough else "")
            if prescribed:
                # YADE would count what it damps of a motion that is prescribed.
                state.isDamped = False

    def _make_engines(self):
        v, rock = self.v, self.rock
        self.bonds = Bonds(pairs=rock.pairs, law=self.law, strength_factor=rock.strength_factor,
                           clock=lambda: self.time)
        inertias = np.full(rock.count, np.inf) if v.rotation == "blocked" else rock.inertias
        motion = VelocityIncrement(masses=rock.masses, inertias=inertias, radii=rock.radii, fixed=self.prescribed)
        self.rock_friction = RockFriction(bonds=self.bonds, motion=motion)
        self.platens = Platens(left=self.left.tolist(), right=self.right.tolist(), velocity=self.sign * v.speed)
        self.recorder = Recorder([self._log, self.bonds.log])
        self.failure = Failure(stress=lambda: self.stress, broken=lambda: self.bonds.cracks, drop=v.drop)
        self.watch = EnergyGuard(work=lambda: self.platens.work, floor=0.5 * rock.masses.sum() * v.speed**2)
        self._register(self.bonds, self.rock_friction, Separation(self.bonds), self.platens, self.recorder, self.failure,
                     self.watch)

    def _periods(self):
        v = self.v
        row = max(1, round(v.record_strain * self.rock.width / (2 * v.speed * self.time_step)))
        return {"bonds": 1, "rock_friction": v.rock_sampling_period, "platens": min(row, v.rock_sampling_period),
                "recorder": row, "failure": row, "separation": 200, "energy_guard": 200}

    # ---- what is measured

    def displacements(self):
        """(n, 2) m since the specimen was bonded."""
        return self.rock.current_positions() - self.rock.positions

    def strains(self):
        """(axial, lateral) in the middle of the specimen now, positive in the direction of the loading."""
        slopes = self.slopes @ self.displacements()[self.inside]
        return self.sign * float(slopes[0, 0]), self.sign * float(slopes[1, 1])

    def _log(self):
        pull, difference = self.platens.take_mean()
        self.stress = self.sign * pull / self.rock.height
        axial, lateral = self.strains()
        travel = 2 * self.v.speed * self.time / self.rock.width
        return {"time": (self.time, "s"), "stage": (self.stage, "-"), "stress": (self.stress, "Pa"),
                "unbalanced_stress": (difference / self.rock.height, "Pa"), "axial_strain": (axial, "-"),
                "lateral_strain": (lateral, "-"), "platen_strain": (travel, "-"),
                "bond_breaking": (self.bonds.energy_released, "J/m")}

    def results(self):
        """{name: (value, unit)} of the run."""
        columns = self.recorder.columns()
        found = {"failed": (self.stress < self.v.drop * self.failure.peak, "-")}
        if columns:
            found.update(measured(**{name: columns[name] for name in ("stress", "axial_strain", "lateral_strain")}))
            for name in ("tensile_cracks", "shear_cracks"):
                found[f"{name}_at_peak"] = int(columns[name][columns["stress"].argmax()]), "-"
        return {**found, "simulated_time": (self.time, "s"), "time_step": (self.time_step, "s"),
                "critical_time_step": (self.critical_step, "s"), **self.bonds.log(),
                **{f"rock_{name}": value for name, value in self.rock.report().items()}}

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "base": self.base, "stress": self.stress}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self.base = {name: float(value) for name, value in state["base"].items()}
        self.stress = float(state["stress"])

    # ---- balances

    def _damped(self):
        return O.energy["nonviscDamp"] if "nonviscDamp" in O.energy.keys() else 0.0

    def balances(self):
        """The energy book, J per metre of thickness: the platens' work, where it went, and what the account misses."""
        balance = {"platen_work": self.platens.work}
        balance.update({name: now - self.base[name] for name, now in self._stored_energy().items()})
        balance.update(rock_friction=self.rock_friction.total, bond_breaking=self.bonds.energy_released,
                    numerical_damping=self._damped())
        balance["residual"] = balance["platen_work"] - math.fsum(list(balance.values())[1:])
        return {"energy": (balance, "J/m")}

    # ---- what a run's folder shows

    def model(self):
        """Arrays that stay the same all through a run."""
        rock = self.rock
        return {"rock_positions": rock.positions, "rock_radii": rock.radii, "bonds": rock.pairs, "rock_prescribed": self.prescribed,
                "gauge": self.inside, "box": np.array([rock.width, rock.height])}

    def snapshot(self):
        """Arrays that show the scene now."""
        broken = np.bincount(self.rock.pairs[self.bonds.status != 0].ravel(), minlength=self.rock.count)
        return {"time": self.time, "stage": self.stage, "rock_positions": self.rock.current_positions(),
                "displacement": self.displacements(), "broken_bonds": broken, "status": self.bonds.status,
                "softening": self.bonds.softening()}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtk: diameter, broken bonds, displacement."""
        shot = self.snapshot()
        x, y = shot["displacement"].T
        vtk.write(folder / f"rock.{number:04d}.vtk", shot["rock_positions"],
                  {"diameter": 2 * self.rock.radii, "broken_bonds": shot["broken_bonds"], "displacement_x": x,
                   "displacement_y": y})

    def progress(self):
        """A few words on how it stands."""
        return f"{self.stress / 1e6:.3g} MPa, {len(self.bonds.cracks)} cracks"


def measured(*, stress, axial_strain, lateral_strain):
    """{name: (value, unit)} of a stress-strain curve: its peak, and E and nu as slopes in ELASTIC_RANGE before it.

    stress: (n,) Pa; strains: (n,), all positive in the direction of the loading. nan where fewer than three rows are
    in the range.
    """
    peak = int(np.argmax(stress))
    low, high = (part * stress[peak] for part in ELASTIC_RANGE)
    # From the last row below the range to the first above it, so that a stray row counts for nothing.
    above = int(np.argmax(stress >= high))
    rows = np.flatnonzero((stress[:above] >= low) & (stress[:above] <= high))
    modulus = ratio = math.nan
    if len(rows) > 2:
        modulus = np.polyfit(axial_strain[rows], stress[rows], 1)[0]
        ratio = -np.polyfit(axial_strain[rows], lateral_strain[rows], 1)[0]
    return {"peak_stress": (float(stress[peak]), "Pa"), "peak_strain": (float(axial_strain[peak]), "-"),
            "youngs_modulus": (float(modulus), "Pa"), "poissons_ratio": (float(ratio), "-")}

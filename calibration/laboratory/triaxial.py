"""Confined compression in the plane: a pressure on all sides of a specimen, then more on its ends [Bahaaddini 2018].

First the pressure rises on the sides, by a membrane, and on the ends, by the platens. Then the platens approach at
constant speed while the membrane keeps the pressure.
"""
import math

import numpy as np
from yade import utils

from calibration.laboratory.loaded_specimen import SpecimenOutput, SpecimenTest, groups
from calibration.laboratory.strength_table import CONFINEMENT
from rockwear.engines.confinement import Membrane, PressedEnds
from rockwear.kernels.checks import require
from rockwear.kernels.membrane import STIFF
from rockwear.kernels.parameter import Parameter, integer
from rockwear.kernels.stress_strain import measured

GROUPS = groups(
    Parameter("confinement", 10e6, "Pa", CONFINEMENT, "pressure on the sides, and first on the ends too",
              "[Bahaaddini 2018]: 0 to 10 MPa"),
    Parameter("membrane_interval", 100, "steps", integer(1), "between searches for the discs at the sides",
              "calibration/results/laboratory.md"),
    test=lambda values: "triaxial", speed=0.1)

HELD = 0.5
"""Part of the confinement by which the mean of what is held may differ without a warning."""
NOISE = 0.2
"""Of the confinement: by no more the deviatoric stress falls and rises in the first loading."""
TRANSITS = 20
"""Least duration of the rise of the pressure, in times that a wave needs through the specimen."""


class TriaxialOutput(SpecimenOutput):
    """What the folder of a confined compression test shows."""

    def log(self):
        confined = self.scene.membrane
        pressure = confined.across(self.scene.upper) if confined else 0.0
        return {**super().log(), "lateral_stress": (pressure, "Pa")}

    def found(self, columns):
        first = int(np.searchsorted(columns["stage"], len(self.scene.stages) - 1))
        stress, held = (columns[name][first:] for name in ("stress", "lateral_stress"))
        if len(stress) < 2:
            return {}
        confinement = self.scene.v.confinement
        strains = {name: columns[name][first:] - (columns[name][first - 1] if first else 0.0)
                   for name in ("axial_strain", "lateral_strain")}
        found = measured(stress=stress - confinement, **strains)
        found["peak_stress"] = found["peak_stress"][0] + confinement, "Pa"
        return {**found, "residual_stress": (float(stress[-max(1, len(stress) // 20):].mean()), "Pa"),
                "confinement_held": (float(held.mean()), "Pa"), "confinement_scatter": (float(held.std()), "Pa")}

    def warnings(self):
        columns, asked = self.scene.recorder.columns(), self.scene.v.confinement
        held = self.found(columns).get("confinement_held", (asked, "Pa"))[0] if columns else asked
        return super().warnings() + ([
            f"the specimen held a confinement of {held:.3g} Pa in the mean and not of {asked:.3g}: its strengths are "
            "no better known; a smaller membrane_interval or speed tells more"
        ] if abs(held - asked) > HELD * asked else [])


class TriaxialTest(SpecimenTest):
    """Confined compression along x. values: {name: value} of all GROUPS.

    Stress is the whole axial stress sigma1; what falls at failure is the deviatoric stress sigma1 - sigma3. E and nu
    are those of the second stage, in which sigma3 stays the same. A specimen whose deviatoric stress does not fall to
    `drop` of its peak before strain_max is reported as not failed.

    `confinement_held` is what one half of the specimen exerts on the other across the loading, mean and scatter over
    the second stage; what the membrane applies is exact. Both are the same until the specimen bursts: then Cundall's
    damping and inertia resist the motion outwards (calibration/results/laboratory.md, where the speed is justified).
    """

    output_class = TriaxialOutput

    def __init__(self, values):
        super().__init__(values)
        self.upper = self.rock.positions[:, 1] > 0.5 * self.rock.height

    def _durations(self):
        confining = {"confining": self._rise() / 0.8} if self.v.confinement else {}
        return {**confining, "axial": self.loading_time}

    def _rise(self):
        """s in which the pressure rises: strained half as fast as later, and many waves long."""
        v, law = self.v, self.law
        require(v.confinement <= STIFF * law.kn, "confinement", v.confinement, f"at most {STIFF:g} kn = "
                f"{STIFF * law.kn:g}", "Pa")
        modulus = 2 * math.sqrt(3) * law.kn * (law.kn + law.kt) / (3 * law.kn + law.kt)
        wave = math.sqrt(modulus / self.rock.density)
        return max(v.confinement / modulus * v.width / v.speed, TRANSITS * max(self.rock.size) / wave)

    @property
    def axial(self):
        """Whether the platens approach at their own speed."""
        return self.stage >= len(self.stages) - 1

    def pressure(self):
        """Pa now; it rises smoothly and ends its rise before the stage ends."""
        if self.axial:
            return self.v.confinement
        part = min(1.0, self.time / (0.8 * self.stages[0][1] * self.time_step))
        return self.v.confinement * math.sin(0.5 * math.pi * part)**2

    @property
    def beside_strength_measure(self):
        """Pa."""
        return self.v.confinement

    @property
    def noise(self):
        """Pa."""
        return NOISE * self.v.confinement

    def strength_measure(self):
        return max(self.stress - self.v.confinement, 0.0) if self.axial else 0.0

    def platen_travel(self):
        return super().platen_travel() - 2 * self.v.speed * self.clock if self.axial else 0.0

    # ---- the two stages

    def _further_engines(self):
        self.membrane = self.pressed = None
        if not self.v.confinement:
            return ()
        self.membrane = Membrane(rock=self.rock, ends=(int(self.left[0]), int(self.right[0])), pressure=self.pressure,
                                 interval=self.v.membrane_interval)
        self.pressed = PressedEnds(left=self.left.tolist(), right=self.right.tolist(), masses=self.rock.masses,
                                   force=lambda: None if self.axial else self.pressure() * self.section)
        return self.membrane, self.pressed

    def _set_off(self):
        if self.axial:
            super()._set_off()

    def _insert_engines(self):
        super()._insert_engines()
        self._lead()

    def _lead(self):
        """The platens work only where their motion is prescribed."""
        self.platens.velocity = self.sign * self.v.speed if self.axial else 0.0

    def end_stage(self, folder):
        super().end_stage(folder)
        if self.axial and not self.finished:
            before = utils.kineticEnergy()
            self._set_off()
            self.base["kinetic"] += utils.kineticEnergy() - before
            self._lead()

    def works(self):
        if not self.membrane:
            return super().works()
        return {**super().works(), "membrane": self.membrane.work, "pressed_ends": self.pressed.work}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self._lead()

"""Fracture toughness: a notched compact tension specimen, in which the opening drives a crack steadily."""
import math

import numpy as np

from calibration.laboratory.loaded_specimen import IN_SPACE, SpecimenOutput, SpecimenTest, groups
from rockwear.kernels import fracture
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Parameter, length, number

OWN = (
    Parameter("size", 0.08, "m", length, "W, from the load line to the back; the specimen is 1.2 W x 1.25 W",
              "ASTM E399"),
    Parameter("notch", 0.4, "", number(fracture.SHORTEST, 0.8), "length of the notch over W", "measured"))
BY_SIZE = "width", "height", "grip", "gauge", "platens"
"""Parameters of other tests that follow from the size."""
LOADED = dict(drop=0.15, strain_max=0.02)
GROUPS = groups(*OWN, without=BY_SIZE, **LOADED, speed=0.02, record_strain=1e-5)
GROUPS_IN_SPACE = groups(*OWN, without=BY_SIZE, rock=IN_SPACE, **LOADED, speed=0.01, record_strain=2e-6, size=0.025,
                         depth=0.01, radius=6e-4, bond_law="cohesive", kn=22e6, kt=5.6e6)
"""In space specimens are small, and waves from the pins count at 0.02 m/s."""
LEAST_SIZE = 16
"""Over the largest radius."""
PIN, PIN_PLACE, MOUTH = 0.125, 0.275, 0.25
"""Over W: half the length of a row of pin discs, its middle's distance from the notch, the load line's from the front,
all as of the pins of ASTM E399."""


class ToughnessOutput(SpecimenOutput):
    """What the folder of a toughness test shows."""

    def log(self):
        found = super().log()
        return {**found, "force": (self.scene.stress * self.scene.rock.height, "N/m"),
                "opening": (self.scene.opening(), "m")}

    def found(self, columns):
        v = self.scene.v
        curve = fracture.resistance_curve(force=columns["force"], opening=columns["opening"], width=v.size,
                                          notch=v.notch)
        return {"fracture_toughness": (fracture.toughness(curve["modulus"], curve["energy"]), "Pa sqrt(m)"),
                "fracture_energy": (curve["energy"], "J/m2"), "youngs_modulus": (curve["modulus"], "Pa"),
                "peak_toughness": (curve["peak_intensity"], "Pa sqrt(m)"),
                "peak_force": (float(columns["force"].max()), "N/m"),
                "crack_length": (float(curve["crack"][-1] * v.size), "m")}


class ToughnessTest(SpecimenTest):
    """The compact tension specimen of ASTM E399. values: {name: value} of all GROUPS, or of GROUPS_IN_SPACE.

    In space its thickness is the block's depth, its two faces are free, and forces are per metre of thickness, too.
    The notch runs along y from the front, y = 0; the pins part along x. A pin is a row of discs along the load line:
    prescribed in more than one row they would keep the arms from turning (that makes E 1.6 times and K 1.4 times too
    large). The opening is measured at the notch, so that what gives way at the pins does not count. The specimen is
    stable under a given opening, and so the whole growth of the crack can be followed: fracture_energy is the work that
    is not stored, over the growth of the equivalent elastic crack; fracture_toughness is sqrt(E G_f);
    peak_toughness is K at the peak force, too small unless W is many times the process zone.
    """

    sign, output_class = 1, ToughnessOutput
    peak_stress, at_peak = 0.0, math.nan
    """Pa, largest stress so far, and m/Pa, opening over stress at that moment."""

    def __init__(self, values):
        least = LEAST_SIZE * values.get("radius", values.get("radius_max"))
        require(values["size"] >= least, "size", values["size"], f"at least {least:g}: so few discs give way elsewhere "
                "than at the notch", "m")
        super().__init__({**values, "width": 1.2 * values["size"], "height": 1.25 * values["size"],
                          "platens": "smooth"})

    def _specimen(self):
        rock, v = super()._specimen(), self.v
        rock.cut((0.6 * v.size, -rock.height), (0.6 * v.size, (MOUTH + v.notch) * v.size))
        return rock

    def _on_the_load_line(self):
        return abs(self.rock.positions[:, 1] - MOUTH * self.v.size) < 0.6 * float(self.rock.radii.max())

    def _ends(self):
        x = self.rock.positions[:, 0] / self.v.size - 0.6
        row = self._on_the_load_line()
        left, right = (np.flatnonzero(row & (abs(x - place) < PIN)) for place in (-PIN_PLACE, PIN_PLACE))
        require(len(left) and len(right), "size", self.v.size, "larger, or of another seed: no disc on the load line "
                f"is in a pin, {2 * PIN * self.v.size:.3g} m long", "m")
        return left, right

    def _place_gauge(self):
        """The discs along the notch near the load line."""
        x, y = self.rock.positions.T[:2]
        off, reach = x - 0.6 * self.v.size, 2.5 * float(self.rock.radii.max())
        near = (abs(y - MOUTH * self.v.size) < reach) & (abs(off) < 1.6 * reach)
        self.lips = np.flatnonzero(near & (off < 0)), np.flatnonzero(near & (off > 0))
        self.inside = np.concatenate(self.lips)

    def _mean_motion(self):
        return np.zeros_like(self.rock.positions)

    def opening(self):
        """m, of the notch at the load line."""
        left, right = (self.displacements()[lip, 0].mean() for lip in self.lips)
        return float(right - left)

    def strength_measure(self):
        """Pa: nothing once the equivalent crack is past the part of the ligament whose energy counts. Bridges behind
        it can hold a fifth of the peak ten times as long as the crack grew."""
        if self.stress > self.peak_stress:
            self.peak_stress, self.at_peak = self.stress, self.opening() / self.stress
        growth = fracture.compliance(fracture.END) / fracture.compliance(self.v.notch)
        return 0.0 if self.opening() > growth * self.at_peak * self.stress else self.stress

    def state(self):
        return {**super().state(), "peak_stress": self.peak_stress, "at_peak": self.at_peak}

    def restore(self, state, directory, folder):
        super().restore(state, directory, folder)
        self.peak_stress, self.at_peak = float(state["peak_stress"]), float(state["at_peak"])

    def strains(self):
        """(opening over the width, nothing across)."""
        return self.opening() / self.rock.width, math.nan

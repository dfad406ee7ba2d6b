"""Uniaxial compression and direct tension: a specimen of bonded rock between two platens [Rojek 2003, 5.1].

The specimen is under uniaxial stress: its ends are the platens of `loaded_specimen`, its sides are free.
"""
from operator import itemgetter

from calibration.laboratory.loaded_specimen import IN_SPACE, SpecimenOutput, SpecimenTest, groups
from rockwear.kernels.parameter import Parameter, choice
from rockwear.kernels.stress_strain import measured

TEST = Parameter("test", "compression", "", choice("compression", "tension"), "direction of loading",
                 "[Rojek 2003, 5.1]")
GROUPS = groups(TEST, test=itemgetter("test"))
GROUPS_IN_SPACE = groups(
    TEST, test=itemgetter("test"), rock=IN_SPACE, width=0.05, height=0.025, depth=0.025, radius=1.5e-3,
    bond_law="cohesive", kn=55e6, kt=14e6)


class UniaxialOutput(SpecimenOutput):
    """What the folder of a uniaxial test shows."""

    def found(self, columns):
        found = measured(**{name: columns[name] for name in ("stress", "axial_strain", "lateral_strain")})
        return {**found, "tensile_strength": found["peak_stress"]} if self.scene.v.test == "tension" else found


class UniaxialTest(SpecimenTest):
    """Uniaxial compression or direct tension along x. values: {name: value} of all GROUPS, or of GROUPS_IN_SPACE.

    Speed: the default is the fastest at which, and below which, strength and E of every packing stay within 2 % of
    those at 0.0125 m/s, for the bonds of [Rojek 2003] and [Rojek 2014], in compression and tension (make bench
    redraws the curve; calibration/results/uniaxial.md shows it). At 0.1 m/s strengths are up to 4 % too high. A rock
    of less strength strains less until it fails and is to be loaded as much more slowly: that of a file, with its
    strength and E, is (loading.LoadedRock). Stronger damping delays the rock's
    relaxation: at 0.7 and 0.2 m/s the tensile strength with the bonds of [Rojek 2003] is 10 % too high. What the
    damping itself does: their UCS is 182, 186 and 189 MPa at 0.1, 0.3 and 0.7 (0.05 m/s).

    Cundall's damping switches with the sign of each velocity and stiffens what it damps: long before a step of 0.8 of
    the critical one blows up, the discs chatter, and the damping of the chatter drags on the moving specimen. With
    kt = kn/5 and damping 0.3 it makes E 1 % (lattice) to 4 % (rock of [Rojek 2014]) too high; at 0.7 of the step, or
    damping 0.2, it is gone. Hence the default of 0.6.
    """

    output_class = UniaxialOutput

    @property
    def sign(self):
        """1: tension."""
        return 1 if self.v.test == "tension" else -1

    def _durations(self):
        return {self.v.test: self.loading_time}

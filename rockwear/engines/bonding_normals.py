"""Shear displacement of bonds from the rotation of their particles."""
import math
import numpy as np

from scipy.spatial.transform import Rotation
from yade import O, Vector3

from rockwear.engines.access import states

FULL_ROLL = 1.0
"""Angle (rad) by which bonded particles may roll on each other until their normals at bonding are set anew."""


class BondingNormals:
    """Normal of each bond at bonding, in the frames of its two bodies.

    n1, n2 being these normals as the bodies have rotated them since, R1 and R2 the radii and n the present normal, the
    shear displacement of a bond in which nothing has slipped is

        ut = R1 (n - n1) + R2 (n - n2),   arcs in place of chords.

    After slip the normals are set such that this is the elastic displacement. It is exact in the plane; in space its
    error grows with the cube of the angle, and is below 1e-6 of the strength where Rt/kt is 5 thousandths of a radius.
    """

    def __init__(self, count):
        self.normals = np.zeros((count, 2, 3))

    def set(self, n, interaction, normal):
        """Bond n has this normal (Vector3) at bonding, in the global frame."""
        for side, body in enumerate((interaction.id1, interaction.id2)):
            self.normals[n, side] = O.bodies[body].state.ori.conjugate() * normal

    def set_elastic(self, n, interaction):
        """Set the normals such that `shear_displacement` is the elastic displacement of now."""
        geom, phys = interaction.geom, interaction.phys
        elastic = phys.shearForce * (-1.0 / phys.ks)
        angle = elastic.norm() / (geom.refR1 + geom.refR2)
        self.set(n, interaction, geom.normal * math.cos(angle) - elastic.normalized() * math.sin(angle))

    def in_space(self, n):
        """True unless the bond lies in the plane z = 0."""
        return self.normals[n, :, 2].any()

    def shear_displacement(self, n, geom, first, second):
        """Tangential displacement (Vector3, m) of bond n since the normals were set. first, second: states of its
        bodies."""
        normal, found = geom.normal, Vector3.Zero
        for state, radius, bonded in zip((first, second), (geom.refR1, geom.refR2), self.normals[n].tolist()):
            rotated = state.ori * Vector3(*bonded)
            cos = rotated.dot(normal)
            aside = rotated - normal * cos
            sin = aside.norm()
            if sin > 0.0:
                found -= aside * (radius * math.atan2(sin, cos) / sin)
        return found

    def rolled(self, numbers, ends, bodies):
        """Those of the bonds `numbers` (k,) whose particles have rolled on each other by FULL_ROLL: an angle of more
        than half a turn could not be distinguished from one of less.

        ends: (m, 2) ids of the bodies of all bonds; bodies: ids of all that exist.
        """
        orientations = np.tile([0.0, 0.0, 0.0, 1.0], (ends.max() + 1, 1))
        orientations[bodies] = states(bodies)[:, 9:]
        first, second = (Rotation.from_quat(orientations[ends[numbers, side]]).apply(self.normals[numbers, side])
                         for side in (0, 1))
        return numbers[np.sum(first * second, axis=1) < math.cos(FULL_ROLL)]

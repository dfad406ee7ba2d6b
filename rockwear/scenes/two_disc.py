"""Two particles, one bond: driven along a path of relative displacements, the forces read back [Rojek 2003, 4.6]."""
from collections import namedtuple

import numpy as np
from yade import (Bo1_Sphere_Aabb, ForceResetter, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, NewtonIntegrator, O,
                  Quaternion, Vector3, utils)

from rockwear.engines import base
from rockwear.scenes import yade_scene

Response = namedtuple("Response", "un ut Fn Ft bonds")
"""What YADE did: (n,) opening and (n, 2) tangential displacement (m) as its contact saw them, (n,) and (n, 2) force (N)
on the second particle as it was summed up, in the law's signs; and the engine of the bond."""

TIME_STEP = 1e-6
BEYOND = 1.25
"""Where the paths of `programme` end, over the displacement at which a bond is gone."""


class PairDriver(base.Engine):
    """Reads the bond's displacements and forces of this step, then sets the velocities to the next point.

    un: (n,) m; ut: (n, 2) m along two tangents; first, second: body ids; axes: 3x3, columns normal and tangents at the
    start; spin: Vector3, angle (rad) by which the pair is turned rigidly at every step. The first particle stays
    where it is. The second is moved along the normal for un, and rolls over the first for ut.
    """

    name = "pair_driver"
    phase = base.FORCES

    def __init__(self, *, un, ut, first, second, axes, spin, bonds):
        super().__init__()
        self.un, self.ut = un.tolist(), ut.tolist()
        self.first, self.second = O.bodies[first].state, O.bodies[second].state
        self.bodies = first, second
        self.axes = [Vector3(*axis) for axis in axes.T]
        self.turn = Quaternion(spin.normalized(), spin.norm()) if spin.norm() > 0 else Quaternion.Identity
        self.spin, self.bonds = spin, bonds
        self.radius = O.bodies[second].shape.radius
        self.length = (self.second.pos - self.first.pos).norm()
        interaction = O.interactions[first, second]
        self.geom, self.initial = interaction.geom, bonds.reference_overlap(interaction.phys)
        self.sign = 1 if interaction.id1 == first else -1
        self.sheared = [0.0, 0.0]
        self.rows = []

    def act(self):
        self._sample()
        if len(self.rows) < len(self.un):
            self._move(len(self.rows))

    def _sample(self):
        normal, *tangents = self.axes
        force, increment = O.forces.f(self.bodies[1]), self.geom.shearInc * self.sign
        self.sheared = [sheared + increment.dot(tangent) for sheared, tangent in zip(self.sheared, tangents)]
        self.rows.append((self.initial - self.geom.penetrationDepth, *self.sheared, -force.dot(normal),
                          *(-force.dot(tangent) for tangent in tangents)))

    def _move(self, step):
        self.axes = normal, *tangents = [self.turn * axis for axis in self.axes]
        slip = sum(((now - before) * tangent for now, before, tangent
                    in zip(self.ut[step], self.ut[step - 1], tangents)), Vector3.Zero)
        goal = self.first.pos + normal * (self.length + self.un[step])
        self.second.vel = (goal - self.second.pos) / O.dt
        self.first.angVel = self.spin / O.dt
        self.second.angVel = (self.spin - normal.cross(slip) / self.radius) / O.dt


def drive_pair(law, un, ut, *, radii=(1.25e-3, 1.25e-3), axes=None, spin=(0.0, 0.0, 0.0), swapped=False, period=1):
    """Make a bond of `law` between two particles in YADE and drive it along a path. -> Response.

    law: of rockwear.kernels.bond_laws; un: (n,) m; ut: (n,) or (n, 2) m, along one or two tangents; the path starts at
    zero; radii: m; axes: 3x3, normal and tangents as columns; spin: rad a step, turns the pair as a rigid body;
    swapped: the particle that stays gets the higher id; period: steps between visits of the engine of the bond.
    """
    un, ut = np.asarray(un, float), np.asarray(ut, float).reshape(len(un), -1)
    ut = np.pad(ut, ((0, 0), (0, 2 - ut.shape[1])))
    axes = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]) if axes is None else np.asarray(axes, float)
    _put_pair(radii, axes[:, 0], swapped, law.yade_law)
    bonds = yade_scene.CARRIERS[law.yade_law](pairs=np.array([[0, 1]]), law=law, clock=lambda: O.time, period=period)
    utils.createInteraction(0, 1)
    O.dt = 0.0
    O.step()
    bonds.bond(np.array([0]))
    O.dt = TIME_STEP
    first, second = (1, 0) if swapped else (0, 1)
    driver = PairDriver(un=un, ut=ut, first=first, second=second, axes=axes, spin=Vector3(*spin), bonds=bonds)
    base.register([bonds, driver])
    base.insert([bonds, driver])
    bonds.connect()
    base.run(len(un) + 1)  # a runner sits out its first step
    rows = np.array(driver.rows[:len(un)])
    return Response(un=rows[:, 0], ut=rows[:, 1:3], Fn=rows[:, 3], Ft=rows[:, 4:6], bonds=bonds)


def _put_pair(radii, normal, swapped, yade_law):
    O.reset()
    O.materials.append(yade_scene.bonding_material(yade_law))
    centres = [np.zeros(3), sum(radii) * normal]
    for centre, radius in reversed([*zip(centres, radii)]) if swapped else zip(centres, radii):
        O.bodies.append(utils.sphere(centre.tolist(), radius, fixed=True))
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
                 yade_scene.bond_loop([Ig2_Sphere_Sphere_ScGeom()]), NewtonIntegrator(damping=0.0)]


def programme(law, end_n, end_t, steps):
    """Paths of [Rojek 2003, 4.6] as {name: (un, ut)}; end_n, end_t: displacement (m) at which a bond is gone in
    tension and shear.

    steps: on the longest leg of each. Shear with compression: tangential rate 10 times the normal one; with tension:
    twice. Unloading goes to where an elasto-plastic bond is free of stress.
    """
    yield_n = law.Rn / law.kn
    rest = end_n - yield_n
    corners = [0.0, yield_n + 0.3 * rest, 0.3 * end_n, yield_n + 0.6 * rest, 0.6 * end_n, BEYOND * end_n]
    legs = [start + (stop - start) * np.linspace(0.0, 1.0, steps, endpoint=False)
            for start, stop in zip(corners, corners[1:])]
    un, ut = (BEYOND * end * np.linspace(0.0, 1.0, steps) for end in (end_n, end_t))
    cycles = np.concatenate(legs)
    return {"tension": (un, 0 * un), "tension, unloading and reloading": (cycles, 0 * cycles),
            "compression": (-un, 0 * un), "shear": (0 * ut, ut), "shear with compression": (-ut / 10, ut),
            "shear with tension": (ut / 2, ut)}

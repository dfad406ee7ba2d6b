"""Damping of bonds and of grains; writes {check: number} to the file named last."""
import json
import math
import sys

import numpy as np
from yade import O, utils

from rockwear.engines import base
from rockwear.engines.access import rock_states
from rockwear.engines.bond_dashpots import BondDashpots
from rockwear.engines.damping import GrainDamping
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.rigid_motion import rigid_parts
from rockwear.kernels.stability import critical_time_step
from rockwear.model.rock import Arranged
from rockwear.scenes import yade_scene

LAW = ElasticBrittle(kn=2e10, kt=8e9, Rn=1e12, Rt=1e12, mu=0.5)
RADIUS, RATIO = 1e-3, 0.1
BLOCK = 2500 * 0.01**2
"""kg, of all discs together."""


def built(places, velocities, ratio=RATIO, **grains):
    """Touching discs with these velocities (n, 3): x, y, angular. grains: options of GrainDamping; they are one grain
    then. -> rock, bonds, damping."""
    O.reset()
    rock = Arranged(positions=np.array(places), radius=RADIUS, width=0.01, height=0.01, density=2500.0)
    rock.bond(LAW)
    yade_scene.put_rock_materials(mu=LAW.mu)
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=LAW)
    bonds = yade_scene.bonds_engine(rock, LAW, lambda: O.time)
    yade_scene.make_bonds(rock, bonds)
    if grains:
        rock.grains = np.zeros(rock.count, int)
        damping = GrainDamping(rock=rock, bonds=bonds, **grains)
    else:
        damping = BondDashpots(rock=rock, bonds=bonds, ratio=ratio)
    for body, (x, y, spin) in zip(O.bodies, velocities):
        body.state.vel, body.state.angVel = (x, y, 0), (0, 0, spin)
    base.register([bonds, damping])
    base.insert([bonds, damping])
    bonds.connect()
    damping.connect()
    return rock, bonds, damping


def decrement(**grains):
    """Logarithmic decrement of a pair that oscillates along its line."""
    rock, _, _ = built([(1e-3, 1e-3), (3e-3, 1e-3)], [(-0.01, 0, 0), (0.01, 0, 0)], **grains)
    O.dt = 2 * math.pi / math.sqrt(2 * LAW.kn / rock.masses[0]) / 500
    gap = []
    for _ in range(2200):
        base.run(1)
        gap.append(O.bodies[1].state.pos[0] - O.bodies[0].state.pos[0] - 2 * RADIUS)
    gap = np.array(gap)
    tops = [gap[k] for k in range(1, len(gap) - 1) if gap[k - 1] < gap[k] >= gap[k + 1]]
    return math.log(tops[0] / tops[3]) / 3


def energy(ratio):
    """What the balance of three discs that shear, turn and stretch misses, over the energy at first."""
    triangle = [(1e-3, 1e-3), (3e-3, 1e-3), (2e-3, (1 + math.sqrt(3)) * 1e-3)]
    rock, bonds, dashpots = built(triangle, [(0.02, -0.01, 30), (-0.01, 0.03, -50), (0.0, 0.0, 20)], ratio)
    O.dt = 0.05 * critical_time_step(positions=rock.positions, radii=rock.radii, masses=rock.masses,
                                     inertias=rock.inertias, bonds=rock.pairs, kn=LAW.kn, kt=LAW.kt)
    first = utils.kineticEnergy()
    base.run(3000)
    left = utils.kineticEnergy() + bonds.elastic_energy()
    return {"missed": (left + dashpots.dissipated - first) / first, "dissipated": dashpots.dissipated / first}


def sums(rock):
    """(momentum (2,) and angular momentum of the discs, the sums of their magnitudes)."""
    states = [(b.state.pos, b.state.vel, b.state.angVel[2]) for b in O.bodies]
    parts = [(m * v[0], m * v[1], m * (x[0] * v[1] - x[1] * v[0]) + i * w)
             for (x, v, w), m, i in zip(states, rock.masses, rock.inertias)]
    return np.sum(parts, axis=0), np.sum(np.abs(parts), axis=0)


def momentum():
    """Change of the momentum (2,) and of the angular momentum of the discs, over the sums of their magnitudes."""
    triangle = [(1e-3, 1e-3), (3e-3, 1e-3), (2e-3, (1 + math.sqrt(3)) * 1e-3)]
    rock, _, _ = built(triangle, [(0.02, -0.01, 30), (-0.01, 0.03, -50), (0.0, 0.0, 20)])
    O.dt = 1e-9
    before, size = sums(rock)
    base.run(2000)
    return float(np.max(abs(sums(rock)[0] - before) / size))


def ringing(fraction, steps, speed):
    """A loose grain of seven discs that vibrate at this speed (m/s), flies and turns, with a quality factor of 100.
    fraction: of the critical step."""
    hexagon = [(0.0, 0.0), *((2 * RADIUS * math.cos(k * math.pi / 3), 2 * RADIUS * math.sin(k * math.pi / 3))
                             for k in range(6))]
    own = speed * np.random.default_rng(5).normal(size=(7, 2))
    velocities = [(u + 3.0 - 500 * y, v + 500 * x, 500.0) for (x, y), (u, v) in zip(hexagon, own)]
    shape = dict(radii=np.full(7, RADIUS), masses=np.full(7, BLOCK / 7), kn=LAW.kn, kt=LAW.kt)
    critical = critical_time_step(positions=np.array(hexagon), inertias=0.5 * shape["masses"] * RADIUS**2,
                                  bonds=np.array([(0, k) for k in range(1, 7)] + [(k, k % 6 + 1) for k in range(1, 7)]),
                                  **shape)
    rock, bonds, damping = built(hexagon, velocities, rate=0.02 / critical, period=100)
    O.dt = fraction * critical
    first, (before, size) = utils.kineticEnergy(), sums(rock)
    rest = rigid_energy(rock)
    base.run(steps)
    left = utils.kineticEnergy() + bonds.elastic_energy()
    return {"bonds": len(rock.pairs), "missed": (left + damping.dissipated - first) / first,
            "momentum": float(np.max(abs(sums(rock)[0] - before) / size)), "rigid": left / rest,
            "kinetic": utils.kineticEnergy() / first}


def rigid_energy(rock):
    """Kinetic energy (J) of the discs as one rigid body."""
    states = rock_states(rock)
    velocities, spins = rigid_parts(np.zeros(rock.count, int), positions=states[:, :2], masses=rock.masses,
                                    inertias=rock.inertias, velocities=states[:, 3:5], spins=states[:, 8])
    return 0.5 * float(rock.masses @ (velocities**2).sum(axis=1) + rock.inertias @ spins**2)


def in_step():
    """Largest amplitude of pairs that oscillate along their line, stretched at first, over that at first; each is
    visited at an interval of its own, some at the same phase of each oscillation."""
    found = []
    for period in range(10, 32):
        rock, _, _ = built([(1e-3, 1e-3), (3e-3, 1e-3)], [(-1.0, 0, 0), (1.0, 0, 0)], rate=1e9, period=period)
        # Ten steps and a half an oscillation.
        O.dt = 2 * math.pi / math.sqrt(2 * LAW.kn / rock.masses[0]) / 10.5
        gap = []
        for _ in range(40 * period):
            base.run(1)
            gap.append(abs(O.bodies[1].state.pos[0] - O.bodies[0].state.pos[0] - 2 * RADIUS))
        found.append(max(gap[-2 * period:]) / max(gap[:period]))
    return max(found)


def restitution():
    """Of two discs that were never bonded and collide, far from a pair that is; and what the balance misses over the
    energy at first."""
    places = [(1e-3, 1e-3), (3.0001e-3, 1e-3), (8e-3, 8e-3), (8e-3, 6e-3)]
    rock, _, dashpots = built(places, [(0.1, 0, 0), (-0.1, 0, 0), (0, 0, 0), (0, 0, 0)])
    O.dt = 2 * math.pi / math.sqrt(2 * LAW.kn / rock.masses[0]) / 2000
    first = utils.kineticEnergy()
    while O.bodies[0].state.vel[0] > 0 or O.interactions.has(0, 1) and O.interactions[0, 1].isReal:
        base.run(1)
    left = utils.kineticEnergy()
    return {"bonds": len(rock.pairs), "ratio": -O.bodies[0].state.vel[0] / 0.1,
            "missed": (left + dashpots.dissipated - first) / first}


OMEGA = math.sqrt(2 * LAW.kn / (BLOCK / 2))
"""rad/s, of a pair along its line."""
checks = {"decay": decrement() / (2 * math.pi * RATIO / math.sqrt(1 - RATIO**2)),
          "grain decay": decrement(rate=OMEGA / 40, period=5) * 40 / math.pi, "in step": in_step(),
          "restitution": restitution(), "energy": energy(RATIO), "strong": energy(0.7), "momentum": momentum(),
          "ringing finely": ringing(0.02, 20000, 1.0), "ringing": ringing(0.6, 20000, 10.0)}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)

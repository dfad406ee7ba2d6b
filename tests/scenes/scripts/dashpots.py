"""Dashpots of bonds; writes {check: number} to the file named last."""
import json
import math
import sys

import numpy as np
from yade import O, utils

from rockwear.engines import base
from rockwear.engines.bond_dashpots import BondDashpots
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.stability import critical_time_step
from rockwear.model.rock import Arranged
from rockwear.scenes import yade_scene

LAW = ElasticBrittle(kn=2e10, kt=8e9, Rn=1e12, Rt=1e12, mu=0.5)
RADIUS, RATIO = 1e-3, 0.1


def built(places, velocities, ratio=RATIO):
    """Touching discs with these velocities (n, 3): x, y, angular. -> dashpots, bonds."""
    O.reset()
    rock = Arranged(positions=np.array(places), radius=RADIUS, width=0.01, height=0.01, density=2500.0)
    rock.bond(LAW)
    yade_scene.put_rock_materials(mu=LAW.mu)
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=LAW)
    bonds = yade_scene.bonds_engine(rock, LAW, lambda: O.time)
    yade_scene.make_bonds(rock, bonds)
    dashpots = BondDashpots(rock=rock, bonds=bonds, ratio=ratio)
    for body, (x, y, spin) in zip(O.bodies, velocities):
        body.state.vel, body.state.angVel = (x, y, 0), (0, 0, spin)
    base.register([bonds, dashpots])
    base.insert([bonds, dashpots])
    bonds.connect()
    return rock, bonds, dashpots


def decay():
    """Logarithmic decrement of a pair that oscillates along its line, over the exact 2 pi xi / sqrt(1 - xi^2)."""
    rock, _, _ = built([(1e-3, 1e-3), (3e-3, 1e-3)], [(-0.01, 0, 0), (0.01, 0, 0)])
    O.dt = 2 * math.pi / math.sqrt(2 * LAW.kn / rock.masses[0]) / 500
    gap = []
    for _ in range(2200):
        base.run(1)
        gap.append(O.bodies[1].state.pos[0] - O.bodies[0].state.pos[0] - 2 * RADIUS)
    gap = np.array(gap)
    tops = [gap[k] for k in range(1, len(gap) - 1) if gap[k - 1] < gap[k] >= gap[k + 1]]
    return math.log(tops[0] / tops[3]) / 3 / (2 * math.pi * RATIO / math.sqrt(1 - RATIO**2))


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


def momentum():
    """Change of the momentum (2,) and of the angular momentum of the discs, over the sums of their magnitudes."""
    triangle = [(1e-3, 1e-3), (3e-3, 1e-3), (2e-3, (1 + math.sqrt(3)) * 1e-3)]
    rock, _, _ = built(triangle, [(0.02, -0.01, 30), (-0.01, 0.03, -50), (0.0, 0.0, 20)])
    O.dt = 1e-9

    def sums():
        states = [(b.state.pos, b.state.vel, b.state.angVel[2]) for b in O.bodies]
        parts = [(m * v[0], m * v[1], m * (x[0] * v[1] - x[1] * v[0]) + i * w)
                 for (x, v, w), m, i in zip(states, rock.masses, rock.inertias)]
        return np.sum(parts, axis=0), np.sum(np.abs(parts), axis=0)

    before, size = sums()
    base.run(2000)
    return float(np.max(abs(sums()[0] - before) / size))


checks = {"decay": decay(), "energy": energy(RATIO), "strong": energy(0.7), "momentum": momentum()}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(checks, file)

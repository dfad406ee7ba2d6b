"""Time per step and memory of a block of bonded particles through which waves run, in YADE by itself.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/scale_block.py --out DIR [--name value ...]

In the plane a random packing; in space touching spheres in a cubic lattice, which needs no packing and has as many
bonds. Bonds never break. Writes DIR/scale_block.json. calibration/benchmarks/scale.py runs it.
"""
import json
import math
import os
import resource
import sys
import time
from pathlib import Path

import numpy as np
from yade import InsertionSortCollider, O

from rockwear.engines import access
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.curve_order import curve_order
from rockwear.kernels.parameter import Group, Parameter, choice, integer, number
from rockwear.model import rock as packings
from rockwear.model.rock import Arranged, RockAssembly, Specimen
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import yade_scene

RADIUS, GAP, DENSITY, VELOCITY = 1e-3, 1e-4, 2500.0, 10.0
STIFFNESS = {2: 20e9, 3: 50e6}
"""N/m; discs 1 m thick are 400 times as heavy as spheres."""
TIME_STEP = 1e-7
WARM_UP = 5
"""Steps."""
GROUPS = [Group("block", (
    Parameter("particles", 2000, "", integer(100), "about so many"),
    Parameter("dimensions", 2, "", integer(2), "2 or 3"),
    Parameter("order", "curve", "", choice("curve", "packing", "scattered"), "of the particles in "
              "memory; packing: as they are packed, in space row by row"),
    Parameter("verlet", 0.0, "", number(0), "YADE's Verlet distance over the least radius; 0: its default"),
    Parameter("steps", 1000, "", integer(1), "steps timed")))]


def block(v):
    """The rock."""
    packings.ORDERED = math.inf  # a large specimen would come in the order of the curve
    if v["dimensions"] == 2:
        mean_square = (1 + 1.5 + 1.5**2) / 3 * RADIUS**2
        side = math.sqrt(v["particles"] * math.pi * mean_square / 0.88)
        rock = Specimen(width=side, height=side, radius_min=RADIUS, radius_max=1.5 * RADIUS, porosity=0.12, seed=1,
                        bonding_gap=GAP, density=DENSITY)
    else:
        across = round(v["particles"]**(1 / 3))
        places = RADIUS * (2 * np.indices((across,) * 3).reshape(3, -1).T + [1, 1, 1 - across])
        rock = Arranged(positions=places, radius=RADIUS, density=DENSITY, **dict.fromkeys(
            ("width", "height", "depth"), 2 * across * RADIUS))
    order = np.arange(rock.count)
    if v["order"] == "scattered":
        order = np.random.default_rng(1).permutation(order)
    elif v["order"] == "curve":
        order = curve_order(rock.positions)
    number_of = np.argsort(order)
    pairs = np.sort(number_of[rock.pairs], axis=1)
    return RockAssembly(positions=rock.positions[order], radii=rock.radii[order], width=rock.width, height=rock.height,
                        depth=rock.depth, density=DENSITY, pairs=pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])


def build(rock, v):
    """Put the rock into YADE and set it in motion."""
    kn = STIFFNESS[v["dimensions"]]
    law = ElasticBrittle(kn=kn, kt=0.4 * kn, Rn=1e30, Rt=1e30, mu=0.5)
    rock.bond(law)
    yade_scene.put_rock_materials(mu=law.mu)
    yade_scene.put_rock(rock)
    yade_scene.put_loop(rock=law)
    if v["verlet"]:
        access.yade_engine(InsertionSortCollider).verletDist = v["verlet"] * float(rock.radii.min())
    yade_scene.make_bonds(rock, yade_scene.bonds_engine(rock, law, lambda: 0.0))
    O.dt = TIME_STEP
    waves = VELOCITY * np.sin(np.pi * rock.positions / (20 * RADIUS))
    for body, wave in enumerate(waves.tolist()):
        O.bodies[body].state.vel = (*wave[1::-1], 0.0)


def resident():
    """Bytes of memory in use."""
    pages = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1])
    return pages * resource.getpagesize()


def main():
    """Build, time and write."""
    servers.close()
    v = parameters.read([*GROUPS, COMMON], sys.argv[1:])
    rock = block(v)
    before = resident()
    build(rock, v)
    O.run(WARM_UP, True)
    used = resident() - before
    begin, begin_wall = time.process_time(), time.perf_counter()
    O.run(v["steps"], True)
    cpu, wall = ((end - start) / v["steps"] for end, start in (
        (time.process_time(), begin), (time.perf_counter(), begin_wall)))
    folder = Path(v["out"])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scale_block.json").write_text(json.dumps({
        **{name: v[name] for name in ("dimensions", "order", "verlet")}, "particles": rock.count,
        "bonds": len(rock.pairs), "cpu": cpu, "wall": wall, "bytes": used / rock.count,
        "energy": float(0.5 * rock.masses @ np.sum(access.rock_states(rock)[:, 3:6]**2, axis=1))}), encoding="utf-8")
    os._exit(0)


main()

"""The cut that peers repeat, in YADE: its model, read out of YADE, its record and its time per step.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/peers/cut.py --out DIR [--name value ...]

Rock: touching equal discs in a triangular lattice, so that bonds and later contacts have one reference length and one
lever arm in every code. Bonds break in tension alone, their strengths scatter, nothing is damped, the tool keeps its
shape. Other parameters are those of yade_scripts/tooth_cycles.py. Writes model.npz into DIR, and record.json or,
without steps, stretch.npy: forces of the bonds after a uniform strain.
"""
import json
import math
import os
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from yade import O, PyRunner

from calibration.benchmarks.peers import STRAIN, TIMED
from rockwear.engines import base
from rockwear.kernels.parameter import Parameter, choice, integer
from rockwear.model.rock import Arranged
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import cutting, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.programme import Cycles

RADIUS = 0.75e-3
DEFAULTS = dict(width=0.06, height=0.035, radius_min=RADIUS, radius_max=RADIUS, kt=8e9, Rn=3e4, Rt=1e12,
                weibull_modulus=4, contact_damping=0.0, background_damping=0.0, removal="none", wear_acceleration=0.0,
                heat=False, tooth_height=0.03, tooth_width=0.02, rake=10.0, clearance=10.0, tip_radius=2e-3,
                approach=2e-5, depth_of_cut=0.006, start_up=0.01, cycles=0)
OPTIONS = (Parameter("steps", 3000, "", integer(0), "steps of the cut; 0: a uniform strain instead"),
           Parameter("sample", 20, "steps", integer(1), "between samples of forces and bonds"),
           Parameter("engines", "alive", "", choice("alive", "dead"), "Python engines; dead: YADE by itself"))
CANONICAL = 1000
"""Steps between canonical points."""


def lattice(v):
    """The rock."""
    columns = int((v.width / v.radius_max - 1) / 2)
    rows = int((v.height / v.radius_max - 2) / math.sqrt(3)) + 1
    column, row = np.meshgrid(np.arange(columns), np.arange(rows))
    places = 1 + np.column_stack([(2 * column + row % 2).ravel(), (math.sqrt(3) * row).ravel()])
    return Arranged(positions=v.radius_max * places, radius=v.radius_max, width=v.width, height=v.height,
                    density=v.rock_density)


def make(values):
    """The scene of {name: value}."""
    v = SimpleNamespace(**values)
    rock = lattice(v)
    rock.fix("bottom")
    rock.fix("left", "right", below=v.height - 3 * v.depth_of_cut)
    scene = Cut(rock=parts.bond(rock, v), tool=cutting.tool(v), background_damping=v.background_damping,
                programme=Cycles(times=cutting.times(v), **cutting.motion(v)), **parts.common(v))
    # Shear as the points of contact move: the lever arms of the peers.
    scene.ratcheting_free = False
    return scene


def model(scene):
    """{name: array} of what is in YADE now: what a peer needs to repeat it."""
    ids = scene.tool.bodies.ids
    states, tool = [O.bodies[i].state for i in range(scene.rock.count)], [O.bodies[i] for i in ids]
    bonds = [O.interactions[i, j].phys for i, j in scene.rock.pairs.tolist()]
    contact = scene.tool.contact_law
    return {"positions": np.array([s.pos for s in states])[:, :2], "masses": np.array([s.mass for s in states]),
            "radii": np.array([O.bodies[i].shape.radius for i in range(scene.rock.count)]),
            "inertias": np.array([s.inertia[2] for s in states]),
            "fixed": np.array([s.blockedDOFs == "xyzXYZ" for s in states]), "pairs": scene.rock.pairs,
            "kn": np.array([b.kn for b in bonds]), "kt": np.array([b.ks for b in bonds]),
            "Rn": np.array([b.FnMax for b in bonds]), "Rt": np.array([b.FsMax for b in bonds]),
            "mu": scene.bond_law.mu,
            "tool_positions": np.array([b.state.pos for b in tool])[:, :2],
            "tool_radii": np.array([b.shape.radius for b in tool]), "tool_velocity": tool[0].state.vel[0],
            "tool_kn": contact.kn, "tool_kt": contact.kt, "tool_mu": contact.mu, "time_step": O.dt}


def stretched(scene):
    """(m,) N of the bonds, tension positive, after STRAIN of the places."""
    for i, place in enumerate(scene.rock.positions):
        O.bodies[i].state.pos = (*place + STRAIN @ place, 0.0)
    O.dt = 0.0
    O.step()
    contacts = [O.interactions[i, j] for i, j in scene.rock.pairs.tolist()]
    return np.array([-c.phys.normalForce.dot(c.geom.normal) for c in contacts])


def sample(scene):
    """(step, Fx, Fy of the rock on the tool, N/m, intact bonds): forces are those at the start of the last step."""
    force = sum((O.forces.f(i) for i in scene.tool.bodies.ids), start=O.forces.f(0) * 0)
    return scene.step - 1, force[0], force[1], len(scene.rock.pairs) - len(scene.bonds.cracks)


def cut(scene, values):
    """[samples], and seconds of processor time per step up to the sample at TIMED or the last one before."""
    alone = values["engines"] == "dead"
    base.register([] if alone else scene.engines)
    for engine in O.engines:
        engine.dead = alone and isinstance(engine, PyRunner)
    begin = time.process_time()
    base.run(1)
    rows, seconds = [sample(scene)], 0.0
    for done in range(values["sample"], values["steps"] + 1, values["sample"]):
        base.run(values["sample"])
        rows.append(sample(scene))
        if done <= TIMED:
            seconds = (time.process_time() - begin) / scene.step
        if done % CANONICAL == 0 and not alone:
            scene.canonical()
    return rows, seconds


def main():
    """Build, run and write."""
    servers.close()
    values = parameters.read([*cutting.groups(**DEFAULTS), COMMON, *OPTIONS], sys.argv[1:])
    scene, folder = make(values), Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    scene.build()
    np.savez(folder / "model.npz", **model(scene))
    if not values["steps"]:
        np.save(folder / "stretch.npy", stretched(scene))
    rows, seconds = cut(scene, values) if values["steps"] else ([], 0.0)
    record = {"rows": rows, "seconds": seconds, "steps": scene.step - 1, "sample": values["sample"]}
    (folder / "record.json").write_text(json.dumps(record), encoding="utf-8")
    os._exit(0)


if __name__ == "__main__":
    main()

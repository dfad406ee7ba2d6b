"""Grains as YADE's polyhedra: what a step costs beside that of bonded discs, and whether they can be bonded.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/polyhedra.py --out DIR [--name value ...]

Discs in the grains of the Hawkesbury rock are compressed to failure in the laboratory, with the parameters of
yade_scripts/uniaxial.py. The same grains are then Voronoi prisms, one layer, between two walls that approach as fast.
They repel each other with k V, V (m3) being the volume of an overlap, and by friction; k = kn / (sqrt(3) edge), N/m3:
a row of prisms, sqrt(3) edge apart, has E = kn, as discs have within 1 %. Writes DIR/polyhedra.json and polyhedra.md.
"""
import json
import os
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import yade
from scipy.spatial import Voronoi
from yade import O, log, polyhedra_utils, system, utils

from calibration import generated
from calibration.laboratory.uniaxial import GROUPS, UniaxialTest
from rockwear.engines import base
from rockwear.kernels.polygon import area, perimeter
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON

GIVEN = "--rock=hawkesbury", "--width=0.1", "--height=0.05"
TURNS, WARM_UP, TIMED, STRAIN = 3, 20, 100, 3e-3
"""Runs of each; steps of prisms before those that are timed, and steps timed; half the strain at which discs fail."""


def discs(values):
    """The laboratory's compression to failure, with its Python engines. -> (the test, {quantity: value})."""
    scene = UniaxialTest(values)
    scene.build()
    began = time.process_time()
    with suppress(base.RunEnded):
        base.run(scene.stages[0][1])
    return scene, {"bodies": scene.rock.count, "contacts": len(scene.rock.pairs), "steps": scene.step,
                   "ms": 1e3 * (time.process_time() - began) / scene.step, "time_step": O.dt}


def cells(rock):
    """[(n, 2) m, corners] of the grains: Voronoi cells of their centres, with images of these behind all sides."""
    centres = np.array([rock.positions[rock.grains == grain].mean(axis=0) for grain in range(rock.grains.max() + 1)])
    across, along = centres * [-1, 1], centres * [1, -1]
    diagram = Voronoi(np.vstack([centres, across, across + [2 * rock.width, 0], along, along + [0, 2 * rock.height]]))
    return [diagram.vertices[diagram.regions[cell]] for cell in diagram.point_region[:len(centres)]]


def put(outlines, v):
    """Prisms, one edge of a grain thick, in YADE's scene. v: the test's parameters. -> k, in YADE young / 2. The shear
    stiffness young poisson / 2, N/m, is kt/kn times that of a face of edge x edge."""
    O.reset()
    edge, k = v.grain_edge, v.kn / (np.sqrt(3) * v.grain_edge)
    O.materials.append(yade.PolyhedraMat(young=2 * k, poisson=v.kt / v.kn * edge**2, density=v.rock_density,
                                         frictionAngle=np.arctan(v.mu), label="grain"))
    for outline in outlines:
        O.bodies.append(polyhedra_utils.polyhedra(O.materials["grain"], v=[
            (x, y, z) for x, y in outline.tolist() for z in (-0.5 * edge, 0.5 * edge)]))
        O.bodies[-1].state.blockedDOFs = "zXY"
    O.engines = [
        yade.ForceResetter(),
        yade.InsertionSortCollider([yade.Bo1_Polyhedra_Aabb(), yade.Bo1_Wall_Aabb()], verletDist=0.01 * edge),
        yade.InteractionLoop([yade.Ig2_Wall_Polyhedra_PolyhedraGeom(), yade.Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
                             [yade.Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
                             [yade.Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()]),
        yade.NewtonIntegrator(damping=v.damping)]
    return k


def prisms(outlines, v):
    """The grains between two walls, shortened by STRAIN as they begin. -> {quantity: value}. The time step is the same
    part of a critical one as of discs, sqrt(2 m / (k S)) for a prism of the mass m whose sides have the area S."""
    k = put(outlines, v)
    for body in O.bodies:
        body.state.pos -= (STRAIN * body.state.pos[0], 0, 0)
    for x, velocity in ((0.0, v.speed), ((1 - STRAIN) * v.width, -v.speed)):
        O.bodies.append(utils.wall(x, axis=0, material="grain"))
        O.bodies[-1].state.vel = velocity, 0, 0
    O.dt = v.time_step_fraction * np.sqrt(2 * v.rock_density / k * min(area(o) / perimeter(o) for o in outlines))
    O.run(WARM_UP, True)
    began = time.process_time()
    O.run(TIMED, True)
    return {"bodies": len(outlines), "contacts": O.interactions.countReal(), "time_step": O.dt,
            "ms": 1e3 * (time.process_time() - began) / TIMED}


def pair(v, gap):
    """[N] on a prism that overlaps another by `gap` (m) and then, pulled away, is as far from it."""
    square, forces = v.grain_edge * np.array([(0, 0), (1, 0), (1, 1), (0, 1)]), []
    put([square, square + [v.grain_edge - gap, 0]], v)
    O.dt = 0.0
    for _ in range(2):
        O.step()
        forces.append(O.forces.f(1)[0])
        O.bodies[1].state.pos += (2 * gap, 0, 0)
    return forces


def main():
    """Measure, print and write."""
    servers.close()
    log.setLevel("Polyhedra_support.cpp", log.ERROR)  # else YADE writes a line for every contact that begins
    values, turns = parameters.read([*GROUPS, COMMON], [*GIVEN, *sys.argv[1:]]), []
    folder = Path(values["out"] or "out/polyhedra")
    folder.mkdir(parents=True, exist_ok=True)
    for scene, row in map(discs, TURNS * [values]):
        turns.append((row, prisms(cells(scene.rock), scene.v)))
    first, second = ({of: np.median([row[of] for row in rows]) for of in rows[0]} for rows in zip(*turns))
    found = {"discs": first, "polyhedra": second, "forces": pair(scene.v, 1e-6), "turns": turns,
             "laws": [law for law in system.childClasses("LawFunctor") if "Polyhedra" in law]}
    (folder / "polyhedra.json").write_text(json.dumps(found, indent=1), encoding="utf-8")
    rows = [[name, f"{row['bodies']:g}", f"{row['contacts']:g}", f"{row['ms']:.3g}", f"{row['ms'] / first['ms']:.3g}",
             f"{1e6 * row['time_step']:.3g}", bonds] for name, row, bonds in (
                 ("discs in grains", first, values["bond_law"]), ("polyhedra", second, "none"))]
    print(generated.write_page(folder / "polyhedra.md", [
        f"Processor time, medians of {TURNS} turns. Discs: a compression to failure, {first['steps']:g} steps, with "
        f"Python engines. Polyhedra: {TIMED} steps of YADE alone; contacts are bounding boxes that meet.", "",
        *generated.table(["", "bodies", "contacts", "ms a step", "over that of discs", "time step, µs", "bonds"], rows),
        "Two prisms: {:.4g} N at an overlap of 1 µm, {:g} N at a gap of 1 µm. YADE's laws for polyhedra: {}.".format(
            *found["forces"], ", ".join(found["laws"]))]))
    sys.stdout.flush()
    os._exit(0)


main()

"""The same cut in Kratos: discs CylinderContinuumParticle2D, bonds DEM_KDEM2D, contacts DEM_D_Linear_Custom_Constants.

`write` turns the model that cut.py has read out of YADE into the files that kratos_run.py reads, a script for the
Python of the peer's environment. Bonds of DEM_KDEM2D of this version have, between two equal discs of radius r,

    kn = pi / 4 STIFFNESS E r / (1 - nu^2),    kt / kn = 2 (1 - nu) / (2 - nu),

whatever their area: E and nu are those with which both are the model's, and no more than that (nu is 0.75 where
kt / kn is 0.4). With friction angle phi, a bond breaks at a tension of 2 tau cos(phi) / (1 + sin(phi)) times its area,
or at a shear of tau. Areas are set to 1 and tan(phi) to SHEAR, so that tension breaks a bond at Rn and shear at
SHEAR Rn, which is never reached. Broken bonds and new contacts have springs and Coulomb friction. There is no bending,
no dashpot, and no stress of the plane that feeds back on a bond.
"""
import json
import math
import subprocess
from pathlib import Path

import numpy as np

from calibration.benchmarks.peers import TIMED, PeerFailed

NAME = "Kratos"
PACKAGES = "KratosMultiphysics==10.4.4", "KratosDEMApplication==10.4.4"
SCRIPT = Path(__file__).with_name("kratos_run.py")
STIFFNESS = 1.432 * 0.31225
"""Constants of Kratos's law: of its normal stiffness, and radius of a bond over that of its discs."""
SHEAR = 1e6
"""Shear strength of bonds, in tensile strengths."""
SKIN = 0.3
"""Of the search for neighbours, in radii: bonds that reach further are lost."""
SEARCH = 1
"""Steps between two searches: new neighbours that do not touch are dropped, so that later searches find contacts late
(with 10, cuts part at step 920 and not at 1320; with 50, nearly all bonds break)."""


def elastic_constants(kn, kt, radius):
    """(Young's modulus, Pa, Poisson's ratio) with which bonds of discs (m) have springs kn and kt (N/m2)."""
    ratio = kt / kn
    nu = 2 * (1 - ratio) / (2 - ratio)
    return 4 * kn * (1 - nu**2) / (math.pi * STIFFNESS * radius), nu


def contact(kn, kt, mu):
    """{property: value} of contacts and bonds without dashpots, rolling friction and bending."""
    return {"K_NORMAL": kn, "K_TANGENTIAL": kt, "STATIC_FRICTION": mu, "DYNAMIC_FRICTION": mu, "FRICTION_DECAY": 0.0,
            "CONTACT_INTERNAL_FRICC": SHEAR, "ROTATIONAL_MOMENT_COEFFICIENT": 0.0, "IS_UNBREAKABLE": False,
            "COEFFICIENT_OF_RESTITUTION": 1.0, "DAMPING_GAMMA": 0.0, "ROLLING_FRICTION": 0.0,
            "ROLLING_FRICTION_WITH_WALLS": 0.0, "DEM_ROLLING_FRICTION_MODEL_NAME": "DEMRollingFrictionModelBounded"}


def settings(model, contact_mesh):
    """Kratos's parameters. contact_mesh: whether forces of single bonds can be read, which the step pays for."""
    step = float(model["time_step"])
    return {"Dimension": 2, "ElementType": "CylinderContinuumParticle2D", "GravityZ": 0.0, "RotationOption": True,
            "PoissonEffectOption": False, "ShearStrainParallelToBondOption": False, "GlobalDamping": 0.0,
            "TranslationalIntegrationScheme": "Symplectic_Euler", "RotationalIntegrationScheme": "Direct_Integration",
            "MaxTimeStep": step, "FinalTime": 1.0, "NeighbourSearchFrequency": SEARCH, "DeltaOption": "Absolute",
            "SearchTolerance": SKIN * float(model["radii"].min()), "AmplifiedSearchRadiusExtension": 1.0,
            "ContactMeshOption": contact_mesh, "do_print_results_option": False, "dem_inlet_option": False,
            "solver_settings": {"strategy": "continuum_sphere_strategy"},
            "problem_data": {"problem_name": "cut", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                             "end_time": 1.0}}


def write(model, folder, *, contact_mesh=False, **job):
    """Write arrays and constants into `folder`. job: steps, sample and timed (steps), or strain.

    Raises PeerFailed where discs or springs of the bonds differ: Kratos derives the springs from properties of discs.
    """
    if any(np.ptp(model[name]) > 1e-12 * model[name].max() for name in ("radii", "masses", "kn", "kt")):
        raise PeerFailed("Kratos has one radius, mass, kn and kt for all bonded discs")
    radius, kn, kt = (float(model[name][0]) for name in ("radii", "kn", "kt"))
    young, poisson = elastic_constants(kn, kt, radius)
    folder.mkdir(parents=True, exist_ok=True)
    arrays = {name: model[name] for name in ("positions", "radii", "fixed", "pairs", "tool_positions", "tool_radii")}
    np.savez(folder / "kratos.npz", tau=model["Rn"] * (math.hypot(1, SHEAR) + SHEAR) / 2, **arrays)
    job |= {"settings": settings(model, contact_mesh), "tool_velocity": float(model["tool_velocity"]),
            "disc": {"YOUNG_MODULUS": young, "POISSON_RATIO": poisson,
                     "PARTICLE_DENSITY": float(model["masses"][0]) / (math.pi * radius**2)},
            "of_rock": contact(kn, kt, float(model["mu"])),
            "of_tool": contact(*(float(model[name]) for name in ("tool_kn", "tool_kt", "tool_mu")))}
    (folder / "kratos.json").write_text(json.dumps(job, indent=1), encoding="utf-8")


def run(environment, folder):
    """Run kratos_run.py in `folder`. -> what it found. Raises PeerFailed."""
    done = subprocess.run([str(environment / "bin/python"), str(SCRIPT)], cwd=folder, env={"OMP_NUM_THREADS": "1"},
                          capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
    if done.returncode:
        said = (done.stderr.strip() or done.stdout.strip()).splitlines()
        raise PeerFailed(f"Kratos ended with {done.returncode}: {[*said[-1:], 'nothing said'][0]}")
    return json.loads((folder / "result.json").read_text(encoding="utf-8"))


def cut(environment, model, folder, *, steps, sample):
    """The cut. -> (rows (n, 4) like those of cut.py, seconds of processor time per step of the first TIMED)."""
    write(model, folder, steps=steps, sample=sample, timed=min(TIMED, steps))
    found = run(environment, folder)
    return np.array(found["rows"]), found["seconds"]


def stretched(environment, model, folder, strain):
    """(m,) N of the bonds, tension positive, after a displacement gradient `strain`. Without the tool: see settings."""
    bare = {**model, "tool_positions": model["tool_positions"][:0], "tool_radii": model["tool_radii"][:0]}
    write(bare, folder, contact_mesh=True, strain=np.asarray(strain).tolist())
    return np.array(run(environment, folder)["forces"])

"""Moments in bonds: what rolling stiffness and rolling resistance do to a rock, by YADE's own law (CohFrict).

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/bond_moments.py --out DIR

Compression, direct tension and confined compression of the specimens of calibration/campaigns/rock_laws.py, with
brittle bonds of Coulomb's law that carry moments too. The moment of a bond is its rolling stiffness kr = ratio kt r_i
r_j (N m) times the relative rotation of its discs. YADE erases a bond that opens: its discs then meet by their radii,
which do not overlap, as with softening bonds. A run that DIR holds is not repeated. Writes DIR/bond_moments.json, a row
a run, and bond_moments.md.
"""
import json
import math
import os
import sys
import time
from pathlib import Path
from statistics import median
from types import SimpleNamespace

import numpy as np
from scipy.sparse import csr_matrix, diags, vstack
from scipy.sparse.linalg import eigsh
from yade import (
    Bo1_Sphere_Aabb, CohFrictMat, ForceResetter, Ig2_Sphere_Sphere_ScGeom6D, InsertionSortCollider, InteractionLoop,
    Ip2_CohFrictMat_CohFrictMat_CohFrictPhys, Law2_ScGeom6D_CohFrictPhys_CohesionMoment, NewtonIntegrator, O, PyRunner,
    utils)

from calibration import generated
from calibration.campaigns.rock_laws import BOX, CONFINED_AT, PULL, ROCK, SPEED
from calibration.laboratory.loaded_specimen import SpecimenOutput, SpecimenTest
from calibration.laboratory.triaxial import GROUPS, NOISE, TriaxialTest
from rockwear.engines import access, base
from rockwear.engines.confinement import Membrane
from rockwear.engines.failure import Failure
from rockwear.engines.platens import Platens
from rockwear.engines.recorder import Recorder
from rockwear.kernels.stability import contact_rows
from rockwear.kernels.stress_strain import measured
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import yade_scene

LIMITLESS = -1.0
"""Of a rolling moment: elastic."""


def case(ratio, *, everywhere=False, eta=LIMITLESS, beta=0.0):
    """ratio: of the rolling stiffness; everywhere: contacts have moments too, and broken bonds keep theirs; eta: of
    largest moments, over normal force and lesser radius; beta: of the stress of bending that counts, see `Bending`."""
    return SimpleNamespace(ratio=ratio, everywhere=everywhere, eta=eta, beta=beta)


CASES = {
    "0": case(0.0), "0.1": case(0.1), "0.5": case(0.5), "2": case(2.0), "8": case(8.0),
    "2, contacts too": case(2.0, everywhere=True), "2, all roll at η = 0.1": case(2.0, everywhere=True, eta=0.1),
    "0.3, β = 0.25": case(0.3, beta=0.25), "0.3, β = 1": case(0.3, beta=1.0), "2, β = 1": case(2.0, beta=1.0)}
"""kr of a face of the width A that a bond stands for is kn A^2/12, here 0.3 kt r^2; beta = 1 is that face's own."""
OURS = "law of rockwear"
TESTS = {"compression": (-1, SPEED, 0.0), "tension": (1, PULL, 0.0), "confined": (-1, 0.1, CONFINED_AT)}
"""{test: (sign, speed of a platen, confinement)}."""
SEEDS = 3
CONFINED = OURS, "0", "0.1", "2", "0.3, β = 1"
TURNS, TIMED = 5, 400
"""Runs of each law for their cost, and steps of each."""


def critical_step(rock, kn, kt, kr):
    """s, for discs whose bonds carry moments: a row sqrt(kr) (phi_j - phi_i) for each in the stiffness of
    kernels.stability. kn, kt (N/m), kr (N m): (m,)."""
    (i, j), n, m = rock.pairs.T, rock.count, len(rock.pairs)
    line = rock.positions[j] - rock.positions[i]
    length = np.linalg.norm(line, axis=1)
    arms = (0.5 * (length + side * (rock.radii[i] - rock.radii[j])) for side in (1, -1))
    springs = contact_rows(n, i, j, line / length[:, None], *arms, kn, kt)
    turns = csr_matrix((np.repeat(np.sqrt(kr), 2) * np.tile([-1.0, 1.0], m),
                        (3 * rock.pairs + 2).ravel(), np.arange(0, 2 * m + 1, 2)), shape=(m, 3 * n))
    rows = vstack([springs, turns]) @ diags(np.column_stack([rock.masses, rock.masses, rock.inertias]).ravel()**-0.5)
    return 2 / math.sqrt(eigsh(rows.T @ rows, k=1, which="LA", tol=1e-6, return_eigenvectors=False,
                               v0=np.random.default_rng(0).standard_normal(3 * n))[0])


class Bending(base.Engine):
    """Breaks the bonds whose outermost fibre tears: Fn + 6 beta |M| / A > Rn of a face of the width A (m), 1 m thick.

    limits: (m,) A/beta. YADE's law of 2023 has no such limit.
    """

    name, phase = "bending", base.FORCES

    def __init__(self, bonds, limits, *, period=10):
        super().__init__(period=period)
        self.bonds = [(bond, bond.phys, bond.phys.normalAdhesion, limit) for bond, limit in zip(bonds, limits)]

    def act(self):
        self.bonds = [bond for bond in self.bonds if bond[0].isReal and not bond[1].cohesionBroken]
        for interaction, phys, Rn, limit in self.bonds:
            if 6 * abs(phys.moment_bending[2]) / limit - phys.normalForce.dot(interaction.geom.normal) > Rn:
                phys.normalAdhesion, phys.shearAdhesion, phys.cohesionBroken = 0.0, 0.0, True


class MomentTest(SpecimenTest):
    """Compression or tension with moments in bonds, and a membrane at its sides. moments: of `case`."""

    output_class = SpecimenOutput

    def __init__(self, values, moments):
        self.moments = moments
        super().__init__(values)

    def _durations(self):
        return {"loading": self.loading_time}

    def _further_engines(self):
        beta = self.moments.beta
        bending = Bending(self.bonded, self.rock.bond_areas / beta) if beta else None
        membrane = Membrane(rock=self.rock, ends=(int(self.left[0]), int(self.right[0])), pressure=self.pressure,
                            interval=self.v.membrane_interval) if self.v.confinement else None
        return bending, membrane

    def pressure(self):
        """Pa, which rises while the platens strain an elastic rock of E = kn by four times as much."""
        part = min(1.0, self.time / (4 * self.v.confinement / self.law.kn * self.loading_time / self.v.strain_max))
        return self.v.confinement * math.sin(0.5 * math.pi * part)**2

    def strength_measure(self):
        return max(self.stress - self.v.confinement, 0.0)

    def _choose_time_step(self):
        rock = self.rock
        self.kr = self.moments.ratio * self.law.kt * rock.radii[rock.pairs].prod(axis=1)
        self.critical_step = critical_step(rock, *rock.stiffness(), self.kr)
        self.time_step = self.v.time_step_fraction * self.critical_step

    def build(self):
        O.reset()
        rock, law, m = self.rock, self.law, self.moments
        for position, radius, mass, inertia in zip(rock.positions.tolist(), rock.radii.tolist(), rock.masses.tolist(),
                                                   rock.inertias.tolist()):
            # By YADE's rule kn = 2 E_i r_i E_j r_j / (E_i r_i + E_j r_j) every contact has the same.
            material = CohFrictMat(
                young=law.kn / radius, poisson=law.kt / law.kn, frictionAngle=math.atan(law.mu), density=1.0,
                normalCohesion=1e30, shearCohesion=1e30, momentRotationLaw=m.ratio > 0, alphaKr=m.ratio, alphaKtw=0.0,
                etaRoll=m.eta, etaTwist=LIMITLESS)
            O.bodies.append(yade_scene.finite_disc(position, radius, material=material, mask=yade_scene.ROCK_MASK,
                                                   mass=mass, inertia=inertia))
        constants = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionOnNewContacts=True)
        O.engines = [
            ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
            InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(avoidGranularRatcheting=True)], [constants],
                            [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(
                                always_use_moment_law=m.everywhere, useIncrementalForm=m.eta != LIMITLESS)]),
            NewtonIntegrator(damping=self.v.damping)]
        self._bond(constants)
        self._make_engines()
        self._hold_ends()
        self._set_off()
        self._insert_engines()

    def _bond(self, constants):
        """Bond the pairs, without force as they lie, in a step of no length."""
        for i, j in self.rock.pairs.tolist():
            utils.createInteraction(i, j)
        O.dt = 0.0
        O.step()
        constants.setCohesionOnNewContacts = False
        self.bonded = [access.contact_of(i, j) for i, j in self.rock.pairs.tolist()]
        for interaction, law in zip(self.bonded, self.rock.laws):
            phys = interaction.phys
            phys.normalAdhesion, phys.shearAdhesion, phys.unp = law.Rn, law.Rt, interaction.geom.penetrationDepth

    def _make_engines(self):
        v = self.v
        row = max(1, round(v.record_strain * self.rock.width / (2 * v.speed * self.time_step)))
        self.bonds = SimpleNamespace(energy_breaking=math.nan)
        self.platens = Platens(left=self.left.tolist(), right=self.right.tolist(), velocity=self.sign * v.speed)
        self.recorder = Recorder([self.output.log], period=row)
        self.failure = Failure(stress=self.strength_measure, broken=lambda: True, drop=v.drop,
                               beside=v.confinement, noise=NOISE * v.confinement, period=row)
        self._register(*self._further_engines(), self.platens, self.recorder, self.failure)


def made(name, test, seed, **changes):
    """The test of a case, built. changes: {parameter: value}."""
    sign, speed, confinement = TESTS[test]
    given = {**ROCK, **BOX, "seed": seed, "speed": speed, "confinement": confinement, **changes}
    if name == OURS:
        given["bond_law"] = "coulomb"
        del given["bond_fracture_energy"]
    values = parameters.read(GROUPS, [f"--{parameter}={value}" for parameter, value in given.items()])
    scene = TriaxialTest(values) if name == OURS else MomentTest(values, CASES[name])
    scene.sign = sign
    scene.build()
    return scene


def run(name, test, seed):
    """A test to its end. -> {quantity: value}."""
    scene = made(name, test, seed)
    try:
        while not scene.finished:
            base.run(scene.stages[scene.stage][1])
            scene.end_stage(None)
    except base.RunEnded as ended:
        print(name, test, seed, ended, flush=True)
    columns = scene.recorder.columns()
    found = measured(**{quantity: columns[quantity] for quantity in ("stress", "axial_strain", "lateral_strain")})
    return {"case": name, "test": test, "seed": seed, **{quantity: value for quantity, (value, _) in found.items()},
            "failed": scene.output.failed, "time_step": scene.time_step}


def cost(names):
    """{case: us of processor time a step of YADE by itself}, the cases in turns, the median."""
    found = {name: [] for name in names}
    for name in [*found] * TURNS:
        made(name, "compression", 1)
        O.engines = [engine for engine in O.engines if not isinstance(engine, PyRunner)]
        began = time.process_time()
        O.run(TIMED, True)
        found[name].append(1e6 * (time.process_time() - began) / TIMED)
    return {name: median(values) for name, values in found.items()}


def page(rows, costs):
    """Lines of Markdown: a row a case."""
    def of(name, test, quantity):
        return np.array([row[quantity] for row in sorted(rows, key=lambda row: row["seed"])
                         if (row["case"], row["test"]) == (name, test)])

    def cell(values, beyond=False):
        return f"{'> ' * beyond}{values.mean():.3g} ± {values.std(ddof=1):.2g}" if len(values) else "–"

    def cells(name):
        ucs, tension, confined = (1e-6 * of(name, test, "peak_stress") for test in TESTS)
        slope = (confined - ucs[:len(confined)]) / (1e-6 * CONFINED_AT)
        beyond = not of(name, "confined", "failed").all()
        return [name, cell(ucs), cell(tension), cell(ucs / tension),
                cell(1e-9 * of(name, "compression", "youngs_modulus")), cell(of(name, "compression", "poissons_ratio")),
                cell(confined, beyond), cell(np.degrees(np.arcsin((slope - 1) / (slope + 1))), beyond),
                f"{1e6 * of(name, 'compression', 'time_step').mean():.3f}"]

    return [f"Mean ± standard deviation of {SEEDS} packings; strengths in MPa, E in GPa, time step in µs; φ, °, "
            f"from UCS and the strength at {1e-6 * CONFINED_AT:g} MPa. >: one has not failed at a strain of 2 %.", "",
            *generated.table(["kr over kt r²", "UCS", "σt", "UCS/σt", "E", "ν", "confined", "φ", "time step"],
                             [cells(name) for name in (OURS, *CASES)]),
            "Processor time of YADE a step, µs: " + ", ".join(f"{name} {us:.0f}" for name, us in costs.items()) + "."]


def main():
    """Run what is not there yet, and write."""
    servers.close()
    folder = Path(parameters.read([COMMON], sys.argv[1:])["out"] or "out/bond_moments")
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "bond_moments.json"
    stored = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {"rows": [], "cost": {}}
    done = {(row["case"], row["test"], row["seed"]) for row in stored["rows"]}
    jobs = [(name, test, seed) for test in TESTS for seed in range(1, SEEDS + 1) for name in (OURS, *CASES)
            if test != "confined" or name in CONFINED]
    for job in jobs:
        if job not in done:
            stored["rows"].append(run(*job))
            file.write_text(json.dumps(stored, indent=1), encoding="utf-8")
    if not stored["cost"]:
        stored["cost"] = cost([OURS, "0", "2"])
        file.write_text(json.dumps(stored, indent=1), encoding="utf-8")
    print(generated.write_page(folder / "bond_moments.md", page(stored["rows"], stored["cost"])))
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()

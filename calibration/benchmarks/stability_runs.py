"""Hard cases for the critical time step, each run in YADE below and above it.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/stability_runs.py [--particles n] [--bisect] [--out DIR]

Every case is an assembly of unbreakable bonds, without damping except for named dashpots. It starts with random
velocities, small enough to stay linear, with the same energy in every mode. At a fraction f of the critical step its
kinetic energy cannot exceed 1/(1 - f) times the initial one; beyond the critical step energy grows exponentially, at
1.05 by a factor of three per step. The two results are six decades apart.
"""
import json
import math
import os
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from yade import ForceEngine, GlobalStiffnessTimeStepper, InsertionSortCollider, O, utils

from calibration.benchmarks.stability import ABOVE, BELOW, UNSTABLE
from rockwear import __version__
from rockwear.engines.softening import UNLIMITED
from rockwear.kernels.packing import contacts, pack
from rockwear.kernels.parameter import Parameter, flag, integer, text
from rockwear.kernels.stability import critical_time_step
from rockwear.run import parameters, servers
from rockwear.scenes import yade_scene

PARAMETERS = [
    Parameter("particles", 500, "", integer(50), "in each case, about"),
    Parameter("bisect", False, "", flag, "find YADE's own limit to 1e-3 as well"),
    Parameter("out", "out/stability", "", text, "folder of summary.json"),
]
DENSITY, RADIUS = 2841.0, 1e-3
AMPLITUDE = 1e-9
"""Displacement in the first step over the radius."""
PRESSED = 1e-3
"""Overlap of the contacts with the tool over the tool particle's radius."""
STEPS = 2000


@dataclass
class Assembly:
    """Particles (n, d) in m, bonds (m, 2) with kn and kt (m,) in N/m, and the contacts of a tool if there is one.

    touched: (k,) particles, each pressed from above by its own tool particle; tool_kn, tool_kt in N/m; damping: of
    these contacts, a fraction of the critical damping.
    """

    positions: np.ndarray
    radii: np.ndarray
    bonds: np.ndarray
    kn: np.ndarray
    kt: np.ndarray
    touched: tuple = ()
    tool_radius: float = 0.45e-3
    tool_kn: float = 90e9
    tool_kt: float = 90e9
    damping: float = 0.0

    def __post_init__(self):
        self.dimensions = self.positions.shape[1]
        self.masses, self.inertias = lumped(self.radii, self.dimensions)
        up = np.eye(self.dimensions)[1]
        reach = self.radii[list(self.touched)] + (1 - PRESSED) * self.tool_radius
        self.tool_positions = self.positions[list(self.touched)] + reach[:, None] * up
        self.dashpots = 2 * self.damping * np.sqrt(self.tool_kn * self.masses[list(self.touched)])

    def critical_step(self, **changes):
        """The kernel's critical time step (s); changes: {argument: other value}."""
        n, k = len(self.positions), len(self.touched)
        tool = np.arange(n, n + k)
        mass, inertia = lumped(np.full(k, self.tool_radius), self.dimensions)
        arguments = dict(
            positions=np.vstack([self.positions, self.tool_positions]), fixed=tool,
            radii=np.append(self.radii, np.full(k, self.tool_radius)), masses=np.append(self.masses, mass),
            inertias=np.append(self.inertias, inertia),
            bonds=np.vstack([self.bonds, np.column_stack([self.touched, tool]).astype(int)]),
            kn=np.append(self.kn, np.full(k, self.tool_kn)), kt=np.append(self.kt, np.full(k, self.tool_kt)),
            cn=np.append(np.zeros(len(self.bonds)), self.dashpots), ratcheting_free=True)
        return critical_time_step(**{**arguments, **changes})


def lumped(radii, dimensions):
    """Masses (kg) and moments of inertia (kg m2) of discs of unit thickness, or of spheres."""
    masses = DENSITY * math.pi * (radii**2 if dimensions == 2 else 4 / 3 * radii**3)
    return masses, (0.5 if dimensions == 2 else 0.4) * masses * radii**2


def bonded(positions, radii, gap=0.0, kn=20e9, kt=20e9):
    """All pairs with a gap of at most `gap` (m), bonded."""
    bonds = contacts(positions, radii, gap)
    return Assembly(positions, radii, bonds, np.full(len(bonds), kn), np.full(len(bonds), kt))


def lattice(n, **options):
    """Equal touching discs in a triangular lattice."""
    side = round(math.sqrt(n))
    a, b = np.meshgrid(np.arange(side), np.arange(side))
    positions = RADIUS * np.column_stack([(2 * a + b % 2).ravel(), math.sqrt(3) * b.ravel()])
    return bonded(positions, np.full(len(positions), RADIUS), 1e-6 * RADIUS, **options)


def packed(n, ratio=1.5, porosity=0.12, dimensions=2, **options):
    """A random packing, the largest radius `ratio` times the least."""
    power = np.arange(dimensions + 1)
    mean = (ratio**power).mean() if ratio > 1 else 1.0  # of r^dimensions, r uniform in 1..ratio
    volume = mean * RADIUS**dimensions * (math.pi if dimensions == 2 else 4 / 3 * math.pi)
    p = pack(box=((n * volume / (1 - porosity)) ** (1 / dimensions),) * dimensions, radius_min=RADIUS,
             radius_max=ratio * RADIUS, porosity=porosity, seed=1)
    return bonded(p.positions, p.radii, **options)


def with_tiny_particle(n):
    """A lattice with one small disc between three others, in the middle."""
    a = lattice(n)
    row = np.flatnonzero(abs(a.positions[:, 1] - np.median(a.positions[:, 1])) < RADIUS)
    hole = a.positions[row[len(row) // 2]] + RADIUS * np.array([1.0, 1 / math.sqrt(3)])
    return bonded(np.vstack([a.positions, hole]), np.append(a.radii, (2 / math.sqrt(3) - 1) * RADIUS), 1e-6 * RADIUS)


def touched_by_tool(a, **options):
    """A tool particle on every disc with free space above it, and with enough bonds not to roll away from it."""
    radius, count = Assembly.tool_radius, np.bincount(a.bonds.ravel(), minlength=len(a.positions))
    free = []
    for i, (x, r) in enumerate(zip(a.positions, a.radii)):
        away = np.linalg.norm(a.positions - x - np.array([0.0, r + radius]), axis=1) - a.radii - radius
        away[i] = math.inf
        if count[i] > 2 and away.min() > 0.01 * RADIUS:
            free.append(i)
    return replace(a, touched=tuple(free), **options)


def softened(a, broken=0.0):
    """Bonds at random fractions of their stiffness; a fraction `broken` of them removed."""
    rng = np.random.default_rng(2)
    left = rng.uniform(size=len(a.bonds)) >= broken
    secant = rng.uniform(0.01, 1.0, len(a.bonds))
    return replace(a, bonds=a.bonds[left], kn=(secant * a.kn)[left], kt=(secant * a.kt)[left])


CASES = {
    "equal lattice": lattice,
    "wide radius range": lambda n: packed(n, ratio=6, porosity=0.05),
    "stiff tool on soft rock, 90:20": lambda n: touched_by_tool(packed(n)),
    "90 % contact damping": lambda n: touched_by_tool(packed(n), damping=0.9),
    "90 % contact damping, kt = kn/5": lambda n: touched_by_tool(packed(n, kt=4e9), damping=0.9, tool_kt=18e9),
    "kt = 5 kn": lambda n: packed(n, kt=100e9),
    "kt = kn/5": lambda n: packed(n, kt=4e9),
    "kt = kn/3": lambda n: packed(n, kt=20e9 / 3),
    "high coordination": lambda n: packed(n, porosity=0.05, gap=1.5 * RADIUS),
    "one tiny particle": with_tiny_particle,
    "softened bonds": lambda n: softened(packed(n)),
    "softened and broken bonds": lambda n: softened(packed(n), broken=0.3),
    "spheres": lambda n: packed(n, porosity=0.36, dimensions=3),
}
INTACT = {"softened bonds": packed, "softened and broken bonds": packed}
"""Damaged cases, and their intact assemblies: the step of the intact one must be safe for the damaged one too."""


def build(a):
    """Fill YADE's scene with the assembly at rest and in equilibrium. No collider: the contacts are given."""
    O.reset()
    yade_scene.put_rock_materials(mu=1.0)
    yade_scene.put_tool_material(mu=1e3, contact_damping=a.damping)
    for material in O.materials:
        material.young = (a.tool_kn if material.label == "steel" else a.kn.max()) / a.radii.mean()
        material.poisson = 0.25
    count = len(a.positions)
    for position, radius, mass, inertia in zip(a.positions.tolist(), a.radii.tolist(), a.masses.tolist(),
                                               a.inertias.tolist()):
        O.bodies.append(particle(position, radius, "bonding rock", yade_scene.ROCK_MASK, mass, inertia))
    for position, mass, inertia in zip(a.tool_positions.tolist(), *lumped(np.full(len(a.touched), a.tool_radius), 2)):
        O.bodies.append(particle(position, a.tool_radius, "steel", yade_scene.TOOL_MASK, mass, inertia))
        O.bodies[-1].state.blockedDOFs = "xyzXYZ"
    yade_scene.put_loop(rock=SimpleNamespace(kn=1.0, kt=1.0, mu=1.0),
                        tool=SimpleNamespace(kn=a.tool_kn, kt=a.tool_kt, mu=1e3))
    O.dt = 0.0
    for i, j in a.bonds.tolist():
        utils.createInteraction(i, j)
    O.engines = [engine for engine in O.engines if not isinstance(engine, InsertionSortCollider)]
    O.step()
    for (i, j), kn, kt in zip(a.bonds.tolist(), a.kn.tolist(), a.kt.tolist()):
        phys = O.interactions[i, j].phys
        phys.kn, phys.ks, phys.isCohesive, phys.FnMax, phys.FsMax = kn, kt, True, UNLIMITED, UNLIMITED
    loose = O.materials["loose rock"]
    for i in range(count):
        O.bodies[i].mat = loose
    for k, i in enumerate(a.touched):
        utils.createInteraction(i, count + k)
    O.step()
    # An external force balances the tool's contact force.
    push = ForceEngine(ids=list(a.touched), force=(0, a.tool_kn * PRESSED * a.tool_radius, 0))
    O.engines = O.engines[:-1] + [push, O.engines[-1]]


def particle(position, radius, material, mask, mass, inertia):
    """A disc of the plane, or a sphere."""
    make = yade_scene.finite_disc if len(position) == 2 else yade_scene.sphere
    return make(position, radius, material=material, mask=mask, mass=mass, inertia=inertia)


def perturb(a, step):
    """Random velocities, the same energy for each degree of freedom."""
    rng = np.random.default_rng(3)
    speed = AMPLITUDE * a.radii.mean() / step * math.sqrt(a.masses.mean())
    for body, mass, inertia in zip(O.bodies, a.masses.tolist(), a.inertias.tolist()):
        v, angular_velocity = rng.standard_normal((2, 3)) * speed
        if a.dimensions == 2:
            v[2] = angular_velocity[:2] = 0.0
        body.state.vel = (v / math.sqrt(mass)).tolist()
        body.state.angVel = (angular_velocity / math.sqrt(inertia)).tolist()


def growth(a, step, steps=STEPS, enough=UNSTABLE):
    """Largest kinetic energy over the initial one in `steps` steps; ends once it reaches `enough`."""
    build(a)
    perturb(a, step)
    O.dt, first, largest = step, utils.kineticEnergy(), 1.0
    for _ in range(0, steps, 20):
        for _ in range(20):
            O.step()
        largest = max(largest, utils.kineticEnergy() / first)
        if not largest < enough:
            break
    return largest


def limit(a, critical, low=0.9, high=1.1):
    """YADE's own limit over the kernel's, to 1e-3."""
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growth(a, middle * critical, enough=1e5) >= 1e5 else (middle, high)
    return 0.5 * (low + high)


def choices(a, critical):
    """The time steps (s) that YADE's estimators choose."""
    build(a)
    stepper = GlobalStiffnessTimeStepper()
    chosen = {"p_wave": utils.PWaveTimeStep(), "rayleigh": utils.RayleighWaveTimeStep()}
    O.engines = O.engines[:-1] + [stepper, O.engines[-1]]
    perturb(a, critical)
    O.step()
    chosen["global_stiffness_at_first"] = O.dt
    # It ignores contacts without force: all have one once the particles have moved.
    stepper.active, O.dt = False, 1e-3 * critical
    for _ in range(3):
        O.step()
    stepper.active = True
    O.step()
    chosen["global_stiffness"] = O.dt
    # With viscEl it adds the least 2 m/c of a particle. It is not called with viscEl here: it treats any contact as a
    # ViscElPhys and would read memory that other contacts do not have.
    if a.damping:
        viscous = 2 * stepper.timestepSafetyCoefficient * (a.masses[list(a.touched)] / a.dashpots).min()
        chosen["global_stiffness_viscous"] = min(chosen["global_stiffness"], viscous)
    return chosen


def examine(name, particles, bisect):
    """{quantity: value} of a case."""
    a = CASES[name](particles)
    critical = a.critical_step()
    found = {"particles": len(a.positions), "bonds": len(a.bonds), "touched": len(a.touched), "critical_step": critical,
             "coordination": 2 * len(a.bonds) / len(a.positions), **choices(a, critical),
             "plain_shear": a.critical_step(ratcheting_free=False),
             "below": growth(a, BELOW * critical), "above": growth(a, ABOVE * critical)}
    if name in INTACT:
        found["intact_step"] = INTACT[name](particles).critical_step()
        found["below_intact"] = growth(a, BELOW * found["intact_step"])
    if bisect:
        found["limit"] = limit(a, critical)
    return found


def main():
    """Examine every case; write summary.json."""
    servers.close()
    v = SimpleNamespace(**parameters.read(PARAMETERS, sys.argv[1:]))
    cases = {}
    for name in CASES:
        began = time.process_time()
        cases[name] = examine(name, v.particles, v.bisect)
        print(f"{name}: {time.process_time() - began:.1f} s", flush=True)
    folder = Path(v.out)
    folder.mkdir(parents=True, exist_ok=True)
    summary = {"scene": "stability", "versions": {"rockwear": __version__}, "parameters": vars(v), "cases": cases}
    (folder / "summary.json").write_text(json.dumps(summary, indent=1), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0)


main()

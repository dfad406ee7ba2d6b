"""Pulses that meet a boundary that absorbs; writes {check: number} to the file named last.

    yade -n -x absorbing.py [lattice|packing] FILE
"""
import json
import math
import sys

import numpy as np
from yade import O, utils

from rockwear.engines import base
from rockwear.engines.access import rock_states
from rockwear.engines.absorbing_boundary import AbsorbingBoundary
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.elastic_moduli import Moduli, elastic_moduli
from rockwear.kernels.stability import critical_time_step
from rockwear.kernels.viscous_spring import shares
from rockwear.model.rock import Arranged, Specimen
from rockwear.scenes import yade_scene

LAW = ElasticBrittle(kn=2e10, kt=5e9, Rn=1e30, Rt=1e30, mu=0.5)
RADIUS = 1e-3
WIDTH, HEIGHT = 130, 80
"""Diameters."""
AMPLITUDES = 1e-12, 1e-10, 1e-8, 1e-6
"""m, one after the other in one block: what is left of a pulse is nothing beside the next."""
LOAD_STEP = 1e-12
"""s of the one step that gives the rock the displacements of the pulse."""


def lattice(width=WIDTH, height=HEIGHT):
    """Discs that touch in equilateral triangles; width, height: diameters."""
    rows = round(height * 2 / math.sqrt(3))
    places = np.array([(RADIUS * (1 + 2 * column + row % 2), RADIUS * (1 + math.sqrt(3) * row))
                       for row in range(rows) for column in range(width)])
    box = RADIUS * (2 * width + 1), RADIUS * (2 + math.sqrt(3) * (rows - 1))
    return Arranged(positions=places, radius=RADIUS, width=box[0], height=box[1], density=2500.0)


def packing():
    """Discs of two thirds to four thirds of the mean radius."""
    return Specimen(width=2 * RADIUS * WIDTH, height=2 * RADIUS * HEIGHT, radius_min=0.8 * RADIUS,
                    radius_max=1.2 * RADIUS, porosity=0.12, seed=1, bonding_gap=0.1 * RADIUS, density=2500.0)


class Pulse:
    """A beam of P or S waves towards the bottom of a block: Gaussian along its way and across."""

    def __init__(self, rock, kind, degrees, wavelength, speed, amplitude):
        angle = math.radians(degrees)
        self.way = np.array([math.sin(angle), -math.cos(angle)])
        self.aside = np.array([math.cos(angle), math.sin(angle)])
        self.shear = kind == "S"
        self.k, self.speed, self.amplitude = 2 * math.pi / wavelength, speed, amplitude
        self.lengths = 0.6 * wavelength, wavelength
        self.height = 0.5 * rock.height
        self.from_centre = rock.positions - (0.5 * rock.width - self.height * math.tan(angle), self.height)

    def at(self, time):
        """(n, 3) m, m and rad: displacements, the gradient or the curl of a potential, and rotations, half their
        curl. (A beam along its way alone would be P and S, and the part of the wrong speed goes back.)"""
        k, (length, breadth) = self.k, self.lengths
        s, a = self.from_centre @ self.way - self.speed * time, self.from_centre @ self.aside
        size = self.amplitude * np.exp(-0.5 * (s / length)**2 - 0.5 * (a / breadth)**2)
        sine, cosine = size * np.sin(k * s) / k, size * np.cos(k * s)
        along, aside = cosine - s / length**2 * sine, -a / breadth**2 * sine
        if not self.shear:
            return np.column_stack([np.outer(along, self.way) + np.outer(aside, self.aside), np.zeros(len(s))])
        turn = ((s / length**2)**2 + (a / breadth**2)**2 - 1 / length**2 - 1 / breadth**2 - k**2) * sine
        turn -= 2 * s / length**2 * cosine
        return np.column_stack([np.outer(along, self.aside) - np.outer(aside, self.way), 0.5 * turn])


def move(velocities):
    for body, (x, y, spin) in zip(O.bodies, velocities.tolist()):
        body.state.vel, body.state.angVel = (x, y, 0), (0, 0, spin)


class Block:
    """A block of rock in YADE, its other sides free."""

    def __init__(self, rock, damping=0.0, fraction=0.7):
        """damping: non-viscous; fraction: of the critical step."""
        self.rock = rock
        self.rock.bond(LAW)
        low = 8 * RADIUS
        self.moduli = elastic_moduli(positions=rock.positions, radii=rock.radii, bonds=rock.pairs, kn=LAW.kn, kt=LAW.kt,
                                     box=((low, low), (rock.width - low, rock.height - low)))
        self.density = float(rock.masses.sum()) / (rock.width * rock.height)
        if isinstance(rock, Arranged):
            # The density of the lattice: its box is wider than its cells.
            self.density = float(rock.masses[0]) / (2 * math.sqrt(3) * RADIUS**2)
        O.reset()
        yade_scene.put_rock_materials(mu=LAW.mu)
        yade_scene.put_rock(rock)
        yade_scene.put_loop(rock=LAW, ratcheting_free=False, damping=damping)
        self.bonds = yade_scene.bonds_engine(rock, LAW, lambda: O.time)
        yade_scene.make_bonds(rock, self.bonds)
        critical = critical_time_step(
            positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias, bonds=rock.pairs,
            kn=LAW.kn, kt=LAW.kt)
        # At 0.8 the dashpots of the lattice would be cut by a tenth.
        self.step = fraction * critical
        self.boundary = AbsorbingBoundary(moduli=self.moduli, density=self.density, period=2, step=self.step,
                                          critical=critical)
        self.engines = [self.bonds, self.boundary]
        base.register(self.engines)
        base.insert(self.engines)
        self.bonds.connect()

    def hold_bottom(self):
        low = np.flatnonzero(self.rock.positions[:, 1] < 1.05 * self.rock.radii)
        x, y = self.rock.positions[low].T
        distances = np.hypot(x - 0.5 * self.rock.width, self.rock.height - y)
        self.boundary.hold(low, [(0.0, -1.0)] * len(low), shares(x, 0, self.rock.width), distances)

    def energy(self):
        return utils.kineticEnergy() + self.bonds.elastic_energy() + self.boundary.elastic_energy()

    def give(self, pulse):
        """The displacements of the pulse in one step of almost no length, then its velocities."""
        O.dt = LOAD_STEP
        move(pulse.at(0.0) / LOAD_STEP)
        base.run(1)
        O.dt = self.step
        move((pulse.at(0.0) - pulse.at(-self.step)) / self.step)

    def fastest(self, wavelength):
        """Largest speed (m/s) of a particle that is not within a wavelength of the free sides."""
        x, values = self.rock.positions[:, 0], rock_states(self.rock)[:, 3:5]
        return float(np.hypot(*values[abs(x - 0.5 * self.rock.width) < 0.5 * self.rock.width - wavelength].T).max())


def reflected(block, kind, degrees, wavelength, amplitude):
    """Amplitude of what comes back over that of the pulse: of speed, and by energies; and the energy that is missed."""
    rock, speed = block.rock, block.moduli.speeds(block.density)["PS".index(kind)]
    pulse = Pulse(rock, kind, degrees, wavelength, speed, amplitude)
    block.give(pulse)
    block.hold_bottom()
    base.run(1)
    first, speed_first = block.energy(), block.fastest(wavelength)
    before = block.boundary.absorbed
    base.run(round(rock.height / math.cos(math.radians(degrees)) / speed / block.step))
    block.boundary.act()
    left = block.energy()
    return {"amplitude": block.fastest(wavelength) / speed_first, "by_energy": math.sqrt(left / first),
            "missed": (first - left - (block.boundary.absorbed - before)) / first}


RELAXED = 5000
"""Steps in which displacements come to rest."""
STATIC = 60, 30
"""Diameters of a window under a load that stays."""
NEAR, FAR = 5.0, 20.0
"""Diameters from the load between which displacements of the surface are compared."""


def settled():
    """Difference of displacements of the surface near and far from a load on it, over that of a half-plane.

    Of a line load P, normal or along the surface, displacements along it go as -2 P / (pi E) ln(distance) (Flamant).
    """
    found = {}
    for direction, along in (("vertical", 1), ("horizontal", 0)):
        # Non-viscous damping makes forces larger that slow a particle down, those of dashpots too.
        block = Block(lattice(*STATIC), damping=0.5, fraction=0.5)
        rock, (x, y) = block.rock, block.rock.positions.T
        faces = [(y < 1.05 * RADIUS, (0.0, -1.0), x, rock.width, rock.height),
                 (x < 1.05 * RADIUS, (-1.0, 0.0), y, rock.height, 0.5 * rock.width),
                 (x > rock.width - 1.05 * RADIUS, (1.0, 0.0), y, rock.height, 0.5 * rock.width)]
        parts = [(np.flatnonzero(face), normal, shares(place[face], 0, length), np.full(face.sum(), distance))
                 for face, normal, place, length, distance in faces]
        block.boundary.hold(np.concatenate([numbers for numbers, *_ in parts]),
                            [normal for numbers, normal, *_ in parts for _ in numbers],
                            *(np.concatenate([part[k] for part in parts]) for k in (2, 3)))
        top = np.flatnonzero(y > y.max() - 0.5 * RADIUS)
        away = abs(x[top] - 0.5 * rock.width)
        loaded, load = top[away.argmin()], np.zeros(3)
        away = abs(x[top] - x[loaded]) / (2 * RADIUS)
        load[along] = -1.0
        O.forces.setPermF(int(loaded), load.tolist())
        O.dt = block.step
        base.run(RELAXED)
        moved = (rock_states(rock)[:, :2] - rock.positions)[top, along] / load[along]
        near, far = (moved[abs(away - distance) < 0.1].mean() for distance in (NEAR, FAR))
        found[direction] = (near - far) / (2 / (math.pi * block.moduli.young) * math.log(FAR / NEAR))
    return found


def release(block):
    """Energy that particles gain when they are let go, over what the springs of half a radius would hold."""
    before, springs = block.energy(), float(np.sum(block.boundary.kn)) * RADIUS**2 / 8
    block.boundary.release(block.boundary.numbers.copy())
    base.run(3)
    return abs(block.energy() - before) / springs


def masses(block):
    """Largest part of a particle's mass that is not there."""
    return max(1 - O.bodies[n].state.mass / mass for n, mass in enumerate(block.rock.masses.tolist()))


def pulled():
    """Force on a particle that is pulled off by ten radii, over that of its spring and dashpot; the energies of the
    spring over the work."""
    O.reset()
    yade_scene.put_rock_materials(mu=LAW.mu)
    particle = O.bodies.append(utils.sphere((0, 0, 0), RADIUS, material=O.materials[0]))
    yade_scene.put_loop(rock=LAW)
    O.dt = 1e-7
    boundary = AbsorbingBoundary(moduli=Moduli(2e10, 0.2, 2e10 / 2.4), density=2500.0, period=10, step=O.dt,
                                 critical=1e-5)
    base.register([boundary])
    base.insert([boundary])
    boundary.hold([particle], [(0.0, -1.0)], [2 * RADIUS], [0.1])
    state, (speed, steps) = O.bodies[particle].state, (10.0, 10000)
    state.blockedDOFs, state.vel = "xyzXYZ", (0.5 * speed, speed, 0)
    base.run(steps)
    kn, kt, cn, ct = (float(getattr(boundary, name)[0]) for name in ("kn", "kt", "cn", "ct"))
    way = speed * steps * O.dt
    return {"force": -O.forces.f(particle)[1] / (kn * way + cn * speed),
            "shear": -O.forces.f(particle)[0] / (kt * 0.5 * way + ct * 0.5 * speed),
            "energy": boundary.elastic_energy() / (0.5 * (kn + 0.25 * kt) * way**2)}


def main():
    kind = sys.argv[-2] if sys.argv[-2] == "packing" else "lattice"
    make, wavelength = {"lattice": (lattice, 40 * RADIUS), "packing": (packing, 40 * RADIUS)}[kind]
    block = Block(make())
    pulses = [(wave, degrees) for wave in "PS" for degrees in (0, 45)]
    found = {f"{wave}{degrees}": reflected(block, wave, degrees, wavelength, amplitude)
             for (wave, degrees), amplitude in zip(pulses, AMPLITUDES)}
    found["lighter"] = masses(block)
    found["release"], found["lighter_after_release"] = release(block), masses(block)
    found["pulled"] = pulled()
    found["settled"] = settled()
    with open(sys.argv[-1], "w", encoding="utf-8") as file:
        json.dump(found, file)


main()

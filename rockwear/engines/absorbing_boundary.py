"""A boundary that absorbs: springs and dashpots between rock particles and bodies at rest, as native contacts."""
import numpy as np
from yade import O, Vector3, ViscElMat, utils

from rockwear.engines.access import IN_PLANE, IN_PLANE_WITHOUT_TURNING
from rockwear.engines.base import Engine
from rockwear.engines.memory import MEMORY, Motions
from rockwear.kernels.checks import require
from rockwear.kernels.compiled import dashpot_power, gone_far, split
from rockwear.kernels.viscous_spring import stable_dashpots, stable_masses, viscous_spring

SUPPORT_RADIUS = 1e4
"""Radius of a support over that of its particle: their line keeps its direction, and its spring its linearity."""
MATERIAL = "absorbing boundary"
IDLE_PLACE = Vector3(0, 0, 1e9)
NO_SLIP = 1e9
"""Coefficient of friction of a support."""
FOLLOWED = 0.5
"""Way of a particle along the normal, over its radius, from which its support begins anew where it then is."""
HELD_MASS = 0.8
"""Of a particle's mass while it is held: it stands for the rock up to the boundary, and reaches beyond. With all of its
mass S waves come back with 5.7 % in place of 2.5 (calibration/results/boundary.md)."""
COLUMNS = "numbers", "supports", "radii", "masses", "places", "normals", "forces", "kn", "kt", "cn", "ct"
"""What is kept of each held particle. Its radius is that at which it was held; heat may change it later. Its mass is
all of it."""


class AbsorbingBoundary(Engine):
    """Holds rock particles in the plane by springs and dashpots of kernels.viscous_spring.

    moduli: kernels.elastic_moduli.Moduli of the rock; density: kg/m3 of its bulk; step, critical: s, time step and that
    of the bonded rock: where few particles stand for a large face, they keep as much of their mass as leaves the step
    stable, and dashpots are cut where that is not enough; period: steps between samples of the energy. `hold` and
    `release` may be called between any two steps once the rock is bonded; a held particle must be free to move. Both
    change its mass and not its velocity: the kinetic energy is another one afterwards.

    A support is a sphere at rest that nothing else meets. It reaches to the far side of its particle, so that they
    touch at the particle's centre: the contact does not turn it. A held particle does not turn: where YADE measures
    shear by full radii, a loose one would roll along its support without any force. The force of that overlap, and what
    else is constant, is a permanent force on the particle. YADE's law has no tension, and would erase the contact of a
    particle that has moved inwards by its diameter: before that its support follows it, and what the spring exerts by
    then becomes constant. So springs are linear however far a particle moves. Idle supports wait for the next particle.

    `absorbed` (J) is the work of the dashpots, by the trapezoidal rule over samples; `followed` (J) what springs held
    where their supports followed. `elastic_energy` is what they hold with that.
    """

    name = "absorbing_boundary"

    def __init__(self, *, moduli, density, step, critical, period=10):
        super().__init__(period=period)
        self.moduli, self.density, self.step, self.critical = moduli, density, step, critical
        self.numbers, self.supports, self.idle = (np.empty(0, int) for _ in range(3))
        self.places, self.normals, self.forces = (np.empty((0, 2)) for _ in range(3))
        self.radii, self.masses, self.kn, self.kt, self.cn, self.ct = (np.empty(0) for _ in range(6))
        self.absorbed = self.followed = self.power = 0.0
        self._find()

    def connect(self):
        self._find()
        # YADE does not save permanent forces.
        self._set_forces(range(len(self.numbers)))

    def _find(self):
        """Follow the held particles of the scene that is in O now."""
        self.motions = Motions(self.numbers.tolist())

    def hold(self, numbers, normals, areas, distances, displacements=0.0):
        """Hold these particles (k,) where they are now.

        normals (k, 2): outwards; areas (k,) m2 of the boundary that each stands for; distances (k,) m from the load;
        displacements (k, 2) m: of each from where its springs are at rest. A particle may come twice, for two faces at
        right angles. If it is held already, what its springs exerted becomes a constant force. Raises ParameterError.
        """
        numbers, given = np.asarray(numbers, int), np.asarray(normals, float)
        require(given.shape == (len(numbers), 2), "normals", f"array of shape {given.shape}", "of shape (k, 2)")
        self.act()
        held, first, which = np.unique(numbers, return_index=True, return_inverse=True)
        normals = given[first] / np.linalg.norm(given[first], axis=1)[:, None]
        constants = viscous_spring(moduli=self.moduli, density=self.density, areas=areas, distances=distances)
        # On a face at right angles to the first one, normal and tangent change places.
        along = np.abs(np.sum(given * normals[which], axis=1)) > np.sqrt(0.5) * np.linalg.norm(given, axis=1)
        total = [np.bincount(which, np.where(along, one, other), len(held)) for one, other in (
            constants[0:2], constants[1::-1], constants[2:4], constants[3:1:-1])]
        exerted = self._springs(np.broadcast_to(displacements, given.shape)[first], normals, *total[:2])
        exerted += self._release(held)
        masses = np.array([O.bodies[number].state.mass for number in held.tolist()])
        stiff = dict(masses=masses, springs=np.maximum(*total[:2]), step=self.step, critical=self.critical)
        lighter = np.clip(stable_masses(dashpots=np.maximum(*total[2:]), **stiff), HELD_MASS * masses, masses)
        most = stable_dashpots(**stiff)
        total[2:] = (np.minimum(dashpots, most) for dashpots in total[2:])
        start = len(self.numbers)
        radii = [O.bodies[number].shape.radius for number in held.tolist()]
        places = Motions(held.tolist()).read("in_plane").T
        new = (held, self._supports(len(held)), radii, masses, places, normals, exerted, *total)
        for column, values in zip(COLUMNS, new):
            setattr(self, column, np.concatenate([getattr(self, column), values]))
        self._find()
        added = range(start, len(self.numbers))
        for k in added:
            self._connect_support(k)
        self._set_forces(added)
        for number, mass in zip(held.tolist(), lighter.tolist()):
            # What spin it has is lost.
            state = O.bodies[number].state
            state.blockedDOFs, state.angVel, state.mass = IN_PLANE_WITHOUT_TURNING, Vector3.Zero, mass
        self.power = self._power()

    def release(self, numbers):
        """Let these particles (k,) go. Those that are not held stay as they are."""
        self.act()
        self._release(np.asarray(numbers, int))
        self.power = self._power()

    def _release(self, numbers):
        """-> (k, 2) N that the boundary exerted on each, without the dashpots."""
        exerted = np.zeros((len(numbers), 2))
        gone = np.flatnonzero(np.isin(self.numbers, numbers))
        if not len(gone):
            return exerted
        now = {int(number): force for number, force in zip(self.numbers[gone], self._exerted()[gone])}
        for k, number in enumerate(numbers.tolist()):
            exerted[k] = now.get(number, 0.0)
        for k in gone.tolist():
            state = O.bodies[int(self.numbers[k])].state
            state.blockedDOFs, state.mass = IN_PLANE, float(self.masses[k])
            # The loop would make the contact again, as one of rock on rock, if the two still met.
            O.bodies[int(self.supports[k])].state.pos = IDLE_PLACE
            O.interactions.erase(int(self.numbers[k]), int(self.supports[k]))
            O.forces.setPermF(int(self.numbers[k]), Vector3.Zero)
        self.idle = np.concatenate([self.idle, self.supports[gone]])
        for column in COLUMNS:
            setattr(self, column, np.delete(getattr(self, column), gone, axis=0))
        self._find()
        return exerted

    def _follow(self):
        """Move the supports of particles that have gone far along the normal, so that they touch at the centre again:
        what the springs exert by then becomes constant."""
        if not gone_far(MEMORY, self.motions.of("in_plane"), self.places, self.normals, FOLLOWED * self.radii):
            return
        along, _ = split(self._moved(), self.normals)
        far = np.flatnonzero(np.abs(along) > FOLLOWED * self.radii)
        before, way = self._energies()[far].sum(), along[far, None] * self.normals[far]
        self.forces[far] -= self.kn[far, None] * way
        self.places[far] += way
        self.followed += float(before - self._energies()[far].sum())
        for k, (x, y) in zip(far.tolist(), way.tolist()):
            O.bodies[int(self.supports[k])].state.pos += Vector3(x, y, 0)
        self._set_forces(far.tolist())

    def _supports(self, count):
        """(count,) ids of idle supports, new ones where there are too few."""
        if MATERIAL not in (material.label for material in O.materials):
            O.materials.append(ViscElMat(kn=1.0, ks=1.0, cn=0.0, cs=0.0, label=MATERIAL))
        while len(self.idle) < count:
            body = utils.sphere((0, 0, 0), 1.0, material=MATERIAL, mask=0, fixed=True)
            body.bounded = False
            self.idle = np.append(self.idle, O.bodies.append(body))
        taken, self.idle = self.idle[:count], self.idle[count:]
        return taken

    def _connect_support(self, k):
        particle, support = O.bodies[int(self.numbers[k])], O.bodies[int(self.supports[k])]
        radius = float(self.radii[k])
        support.shape.radius = SUPPORT_RADIUS * radius
        support.state.pos = particle.state.pos + Vector3(*self.normals[k], 0) * ((SUPPORT_RADIUS - 1) * radius)
        before, particle.mat = particle.mat, O.materials[MATERIAL]
        phys = utils.createInteraction(particle.id, support.id).phys
        particle.mat = before
        phys.kn, phys.ks, phys.cn, phys.cs = (float(getattr(self, name)[k]) for name in ("kn", "kt", "cn", "ct"))
        phys.tangensOfFrictionAngle = NO_SLIP

    def _set_forces(self, held):
        for k in held:
            constant = self.forces[k] + 2 * self.radii[k] * self.kn[k] * self.normals[k]
            O.forces.setPermF(int(self.numbers[k]), Vector3(*constant, 0))
        # Else a step right after one of YADE's loop goes without permanent forces.
        O.forces.f(0, sync=True)

    def _moved(self):
        """(k, 2) m that the held particles have moved by."""
        return self.motions.read("in_plane").T - self.places

    @staticmethod
    def _springs(moved, normals, kn, kt):
        """(k, 2) N that springs exert on particles that have moved by (k, 2) m."""
        x, y = normals.T
        pull, shear = kn * (moved[:, 0] * x + moved[:, 1] * y), kt * (moved[:, 1] * x - moved[:, 0] * y)
        return -np.column_stack([pull * x - shear * y, pull * y + shear * x])

    def _exerted(self):
        """(k, 2) N of springs and constant forces on the held particles."""
        return self.forces + self._springs(self._moved(), self.normals, self.kn, self.kt)

    def _energies(self):
        """(k,) J of springs and constant forces."""
        moved = self._moved()
        along, across = split(moved, self.normals)
        return 0.5 * (self.kn * along**2 + self.kt * across**2) - np.sum(self.forces * moved, axis=1)

    def _power(self):
        """W that the dashpots take now."""
        return dashpot_power(MEMORY, self.motions.of("moving"), self.normals, self.cn, self.ct)

    def act(self):
        """Add the work of the dashpots since the last visit, and follow particles that have gone far."""
        elapsed, before = self.elapsed(), self.power
        self.power = self._power()
        self.absorbed += 0.5 * (before + self.power) * elapsed
        self._follow()

    def elastic_energy(self):
        """J of the springs, less the work of the constant forces."""
        return self.followed + float(self._energies().sum())

    def log(self):
        return {"absorbed_energy": (self.absorbed, "J"), "boundary_power": (self.power, "W")}

    def state(self):
        return {**{name: getattr(self, name).copy() for name in (*COLUMNS, "idle")},
                "absorbed": self.absorbed, "followed": self.followed, "power": self.power}

    def put_back(self, state):
        """YADE's scene is again what it was at `state`; the sums of energy go on."""
        for name in (*COLUMNS, "idle"):
            setattr(self, name, state[name].copy())
        self.power = float(state["power"])

    def restore(self, state):
        self.put_back(state)
        self.absorbed, self.followed = (float(state[name]) for name in ("absorbed", "followed"))

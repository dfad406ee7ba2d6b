"""Building blocks of scenes: what is put into YADE, and how; and what all scenes do alike on their way."""
import math

import numpy as np
from yade import (Bo1_Facet_Aabb, Bo1_Sphere_Aabb, ForceResetter, FrictMat, FrictViscoMat, Ig2_Facet_Sphere_ScGeom,
                  Ig2_Sphere_Sphere_ScGeom,
                  InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys,
                  Ip2_FrictMat_FrictViscoMat_FrictViscoPhys, Ip2_FrictViscoMat_FrictViscoMat_FrictViscoPhys,
                  Ip2_JCFpmMat_JCFpmMat_JCFpmPhys, JCFpmMat,
                  Law2_ScGeom_FrictPhys_CundallStrack, Law2_ScGeom_FrictViscoPhys_CundallStrackVisco,
                  Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM, MatchMaker, NewtonIntegrator, O, Quaternion,
                  Vector3, log, utils)

from . import engines
from .engines.bonds import Crack
from .facet_tool import corners, incentres
from .kernels.boundary import nearest_on_triangle
from .kernels.rigid_motion import Pose

# It would call it a bug that its lists of bodies are off; see Scene._fresh_bounds.
log.setLevel("BodyContainer", log.ERROR)
ROCK_MASK, TOOL_MASK = 1, 3
"""Bodies meet where masks share a bit; bit 2 is avoided within the tool."""


def exactly(value):
    """A constant of a contact, whatever the materials say."""
    return MatchMaker(algo="val", val=value)


def put_rock_materials(*, mu, loose=FrictMat):
    """Rock while it is bonded, and rock afterwards.

    Rock changes its material after bonding: a bond stays the bond it is, and every later contact is a plain Coulomb
    contact. Stiffness is given by the contact laws, not by these. loose: FrictViscoMat beside a tool of facets.
    """
    O.materials.append(JCFpmMat(type=1, young=1e9, poisson=1.0, frictionAngle=0.0, density=1.0, tensileStrength=1.0,
                                cohesion=1.0, label="bonding rock"))
    O.materials.append(loose(young=1e9, poisson=0.3, frictionAngle=math.atan(mu), density=1.0, label="loose rock"))


def put_steel(*, mu, contact_damping):
    """The tool's material, its friction and dashpot."""
    O.materials.append(FrictViscoMat(young=1e9, poisson=0.3, frictionAngle=math.atan(mu), density=1.0,
                                     betan=contact_damping, label="steel"))


def put_rock(rock):
    """The specimen's particles as bodies 0..n-1, its supported ones held."""
    for position, radius, mass, inertia, held in zip(rock.positions.tolist(), rock.radii.tolist(), rock.masses.tolist(),
                                                     rock.inertias.tolist(), rock.supported):
        particle = finite_disc if len(position) == 2 else sphere
        body = particle(position, radius, material="bonding rock", mask=ROCK_MASK, mass=mass, inertia=inertia)
        if held:
            body.state.blockedDOFs = "xyzXYZ"
        O.bodies.append(body)


def put_loop(*, kn, kt, mu, tool=None, damping=0.0, ratcheting_free=True):
    """YADE's own loop: bonds, rock on rock, tool on rock (M 4.5), explicit integration.

    tool: (kn, kt, mu) of its contacts, None without a tool; damping: non-viscous (Cundall's), a fraction of each force;
    ratcheting_free: shear between spheres by their full radii, YADE's way, which does not see where they really touch
    (kernels.stability); false: as the points of contact move, so that the springs give back what they took.
    """
    parameters = [Ip2_FrictMat_FrictMat_FrictPhys(kn=exactly(kn), ks=exactly(kt), frictAngle=exactly(math.atan(mu)))]
    laws = [Law2_ScGeom_FrictPhys_CundallStrack()]
    if tool:
        tool_kn, tool_kt, tool_mu = tool
        parameters.append(Ip2_FrictMat_FrictViscoMat_FrictViscoPhys(
            kn=exactly(tool_kn), kRatio=exactly(tool_kt / tool_kn), frictAngle=exactly(math.atan(tool_mu))))
        laws.append(Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True))
    geometry = [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=ratcheting_free)]
    _put_engines([Bo1_Sphere_Aabb()], geometry, parameters, laws, damping)


def put_loop_with_facets(*, kn, kt, mu, tool, damping=0.0, ratcheting_free=True):
    """The same beside a tool of facets.

    YADE puts a facet first into its contacts, and has no functor for (steel, rock) in this order. Steel and loose rock
    are of one kind here, FrictViscoMat, and the constants go by the pair of materials; rock has no dashpot. One law then
    keeps one account of friction, which engines.facets divides.
    """
    rock, steel = O.materials["loose rock"].id, O.materials["steel"].id

    def by_pair(of_rock, of_tool):
        return MatchMaker(matches=((rock, rock, of_rock), (rock, steel, of_tool)))

    tool_kn, tool_kt, tool_mu = tool
    parameters = [Ip2_FrictViscoMat_FrictViscoMat_FrictViscoPhys(
        kn=by_pair(kn, tool_kn), kRatio=by_pair(kt / kn, tool_kt / tool_kn),
        frictAngle=by_pair(math.atan(mu), math.atan(tool_mu)))]
    geometry = [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=ratcheting_free), Ig2_Facet_Sphere_ScGeom()]
    _put_engines([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], geometry, parameters,
                 [Law2_ScGeom_FrictViscoPhys_CundallStrackVisco(traceEnergy=True)], damping)


def _put_engines(bounds, geometry, parameters, laws, damping):
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(bounds, avoidSelfInteractionMask=2),
        InteractionLoop(geometry, [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1), *parameters],
                        [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(neverErase=True), *laws]),
        NewtonIntegrator(damping=damping)]


def make_bonds(rock, bonds):
    """Bond the pairs of the specimen, stress-free as they lie (one step of no length), and end the bonding."""
    for i, j in rock.pairs.tolist():
        utils.createInteraction(i, j)
    O.dt = 0.0
    O.step()
    bonds.bond()
    loose = O.materials["loose rock"]
    for i in range(rock.count):
        O.bodies[i].mat = loose


def finite_disc(position, radius, *, material, mask, mass, inertia):
    """A disc of unit thickness: a YADE sphere that stays in the plane, with a disc's mass and inertia."""
    body = sphere((*position, 0.0), radius, material=material, mask=mask, mass=mass, inertia=inertia)
    body.state.blockedDOFs = "zXY"
    return body


def sphere(position, radius, *, material, mask, mass, inertia):
    """A sphere in space."""
    body = utils.sphere(position, radius, material=material, mask=mask)
    body.state.mass, body.state.inertia = mass, (inertia,) * 3
    return body


class ToolBodies:
    """The tool's skin in YADE, led along a motion: only these particles take part in contact detection.

    They hold no mass: the tool is led, and no kinetic energy of it enters the audit.

    tool: a tool.Tool; motion: of kernels.rigid_motion. `pose` is where the tool is, `velocities` {particle: (vx, vy)}
    and `spin` (rad/s) are how YADE moves it in this step.
    """

    def __init__(self, tool, motion):
        self.tool, self.motion = tool, motion
        self.count, self.positions = tool.count, tool.positions
        self.body_of = {}
        self.ids = []
        self.pose = motion.pose(0.0)
        self.velocities, self.spin = {}, motion.spin

    def connect(self):
        """Follow YADE: where the tool is now, and how it moves."""
        for index, body in self.body_of.items():
            self.velocities[index] = tuple(O.bodies[body].state.vel)[:2]
        if self.body_of:
            index, body = next(iter(self.body_of.items()))
            state = O.bodies[body].state
            turned = Pose(np.zeros(2), 2 * math.atan2(state.ori[2], state.ori[3]))
            self.pose = Pose(np.array(state.pos)[:2] - turned.of(self.positions[[index]])[0], turned.turn)

    def aim(self, time, period):
        """Lead every particle along the chord from where it is to where the motion has it `period` s after `time`.

        Between two visits a particle is off its path by at most v w period^2 / 8, and no error ever builds up.
        """
        goal = self.motion.pose(time + period)
        places = goal.of(self.positions[list(self.body_of)]).tolist()
        for (index, body), (x, y) in zip(self.body_of.items(), places):
            state = O.bodies[body].state
            here = state.pos
            velocity = self.velocities[index] = (x - here[0]) / period, (y - here[1]) / period
            state.vel = (*velocity, 0.0)

    def add(self, indices):
        """Put particles `indices` of the tool into YADE, where the tool is now."""
        self.connect()
        places = self.pose.of(self.positions[np.asarray(indices, int)]).tolist()
        origin, velocity = self._moving_point()
        for index, (x, y) in zip(indices, places):
            body = self._body(int(index), x, y)
            state = body.state
            state.blockedDOFs = "xyzXYZ"
            self._set_off(int(index), state, x, y, origin, velocity)
            state.angVel = (0.0, 0.0, self.spin)
            state.ori = Quaternion((0, 0, 1), self.pose.turn)
            self.body_of[int(index)] = O.bodies.append(body)
        self.ids = list(self.body_of.values())

    def _body(self, index, x, y):
        return finite_disc((x, y), float(self.tool.radii[index]), material="steel", mask=TOOL_MASK, mass=0.0, inertia=0.0)

    def _set_off(self, index, state, x, y, origin, velocity):
        """Move it as a point at (x, y) of a body does whose `origin` has this velocity."""
        self.velocities[index] = (velocity[0] - self.spin * (y - origin[1]), velocity[1] + self.spin * (x - origin[0]))
        state.vel = (*self.velocities[index], 0.0)

    def go_on(self, velocity):
        """Move straight on at another velocity (2,), m/s."""
        for index, body in self.body_of.items():
            self.velocities[index] = tuple(velocity)
            O.bodies[body].state.vel = (*velocity, 0.0)

    def velocity_at(self, index, interaction, tool_first):
        """(vx, vy, vz) m/s of the tool where this contact of particle `index` is."""
        vx, vy = self.velocities[index]
        if self.spin:
            # The contact point turns with the tool about its particle's centre.
            geom = interaction.geom
            arm = self.spin * (self.tool.radii[index] - 0.5 * geom.penetrationDepth) * (1 if tool_first else -1)
            vx, vy = vx - arm * geom.normal[1], vy + arm * geom.normal[0]
        return vx, vy, 0.0

    def _moving_point(self):
        """A point of the tool, m, and its velocity, m/s."""
        if not self.body_of:
            return self.pose.offset, self.motion.velocity(0.0)
        index = next(iter(self.body_of))
        return self.pose.of(self.positions[[index]])[0], self.velocities[index]

    def erase(self, indices):
        """Take particles out of YADE. -> strain energy (J) of the contacts that vanish with them."""
        self.connect()
        energy = 0.0
        for index in indices:
            body = self.body_of.pop(int(index), None)
            if body is None:
                continue
            del self.velocities[int(index)]
            energy += engines.contact_energy(O.interactions.withBody(body))
            O.bodies.erase(body)
        self.ids = list(self.body_of.values())
        return energy

    def state(self):
        """Which body is which particle, and where the tool is."""
        return {"bodies": np.array(list(self.body_of.items()), int).reshape(-1, 2), "offset": self.pose.offset.copy(),
                "turn": self.pose.turn}

    def restore(self, state):
        """Take back what `state` gave; `connect` finds the rest in YADE."""
        self.body_of = {int(i): int(body) for i, body in state["bodies"]}
        self.ids = list(self.body_of.values())
        self.pose = Pose(state["offset"].copy(), float(state["turn"]))
        self.velocities = {}


class SphereBodies(ToolBodies):
    """The skin of a tool of spheres, led in the plane of the cut. tool: a tool.LayeredTool."""

    def __init__(self, tool, motion):
        super().__init__(tool, motion)
        self.positions = tool.positions[:, :2]

    def _body(self, index, x, y):
        place = x, y, float(self.tool.positions[index, 2])
        return sphere(place, float(self.tool.radii[index]), material="steel", mask=TOOL_MASK, mass=0.0, inertia=0.0)


class FacetBodies(ToolBodies):
    """A tool's facets in YADE, led like particles; each is the triangle that facet_tool.corners gives.

    tool: a facet_tool.FacetTool. `positions` (m, 2) and `heights` (m,) m are the bodies' centres in the tool's frame as
    they are in YADE, `local` (m, 3, 3) m their corners about them; `reshape` brings all to the tool's present shape.
    """

    def __init__(self, tool, motion):
        self.tool, self.motion, self.count = tool, motion, tool.count
        self.body_of, self.ids = {}, []
        self.pose = motion.pose(0.0)
        self.velocities, self.spin = {}, motion.spin
        self._measure()

    def _measure(self):
        triangles = corners(self.tool.boundary.vertices, self.tool.boundary.facets)
        centres = incentres(triangles)
        self.positions, self.heights, self.local = centres[:, :2], centres[:, 2], triangles - centres[:, None]

    def _body(self, index, x, y):
        body = utils.facet([(0, 0, 0), (1, 0, 0), (0, 1, 0)], material="steel", mask=TOOL_MASK)
        self._form(body, index, x, y)
        return body

    def _form(self, body, index, x, y):
        body.shape.setVertices(*[Vector3(corner) for corner in self.local[index].tolist()])
        body.state.pos = (x, y, float(self.heights[index]))

    def reshape(self):
        """Give YADE's facets the shape that the tool's boundary has now, where the tool is now."""
        self.connect()
        before = np.column_stack([self.positions, self.heights, self.local.reshape(self.count, 9)])
        origin, velocity = self._moving_point()
        self._measure()
        after = np.column_stack([self.positions, self.heights, self.local.reshape(self.count, 9)])
        changed = np.flatnonzero((before != after).any(axis=1)).tolist()
        for index, (x, y) in zip(changed, self.pose.of(self.positions[changed]).tolist()):
            body = O.bodies[self.body_of[index]]
            self._form(body, index, x, y)
            self._set_off(index, body.state, x, y, origin, velocity)
        # Facets may now reach where no contact was possible before: the collider is to run in the next step.
        engines.yade_engine(NewtonIntegrator).maxVelocitySq = 0.0

    def velocity_at(self, index, interaction, tool_first):
        vx, vy = self.velocities[index]
        if self.spin:
            x, y, _ = interaction.geom.contactPoint - O.bodies[self.body_of[index]].state.pos
            vx, vy = vx - self.spin * y, vy + self.spin * x
        return vx, vy, 0.0

    def outward(self, index):
        """(3,) normal of facet `index` in the tool's frame, of any length, as YADE has the facet."""
        first, second, third = self.local[index]
        normal = np.cross(second - first, third - first)
        # corners() puts a segment's base across the plane so that its triangle looks inwards.
        return -normal if self.tool.boundary.dimension == 2 else normal

    def meeting(self, interaction):
        """Overlap (m) of a facet and a sphere as they lie, and the direction (Vector3) from the facet to the sphere."""
        facet, sphere = O.bodies[interaction.id1], O.bodies[interaction.id2]
        if not hasattr(sphere.shape, "radius"):
            facet, sphere = sphere, facet
        state = facet.state
        place = state.ori.conjugate() * (sphere.state.pos - state.pos)
        nearest = nearest_on_triangle(np.array(place), np.array(facet.shape.vertices))
        way = place - Vector3(*nearest)
        return sphere.shape.radius - way.norm(), state.ori * way.normalized()

    def state(self):
        return {**super().state(), "positions": self.positions.copy(), "heights": self.heights.copy(),
                "local": self.local.copy()}

    def restore(self, state):
        super().restore(state)
        for name in ("positions", "heights", "local"):
            setattr(self, name, state[name].copy())


NEVER = 2**62
"""Steps that no run has."""


class Scene:
    """What rockwear.run leads: bonded rock with engines, in stages of steps, over canonical points, into checkpoints.

    A scene sets `rock` (a Specimen) and `time_step` (s), and plans its stages. `build` fills YADE's scene;
    `_make_engines` makes `bonds`, `rock_friction`, `recorder` and lists all engines in `live`, in the order of their
    visits; `_periods` says how often each is visited, None for one that others call. `model`, `snapshot`, `progress`,
    `results` and `audits` say what a run's folder shows.
    """

    leading = {"turning"}
    """Engines that come first in a step, before its forces."""
    looking = {"bonds", "rock_friction"}
    """Engines that look at the forces of this step and come before the integrator; the others come after it."""
    speed_up = 1.0
    """Seconds of the process in a second of the mechanics (M 12.1: "mechanical process scaled"). All times of a scene
    but its time step are those of the process."""

    def _plan(self, stages):
        """stages: {name: s}."""
        # Chunks between canonical points depend on the scene alone, so that every run of it passes the same points.
        self.chunk = int(min(2000, max(100, 12_000_000 // max(1, len(self.rock.pairs)))))
        self.stages = [(name, max(1, self._steps(seconds))) for name, seconds in stages.items()]
        self.stage, self.clock = 0, 0.0

    def _steps(self, seconds):
        """Steps in so many seconds of the process."""
        return round(min(seconds / (self.time_step * self.speed_up), NEVER))

    def _enlist(self, *live):
        """Make these engines the scene's own; None stands for one that it does not need."""
        self.live = [engine for engine in live if engine]
        engines.enlist(self.live)

    def _hang_in(self):
        """Hang the engines into YADE's loop, from now on with the scene's time step."""
        O.dt = self.time_step
        periods = self._periods()
        names = [engine.name for engine in self.live if periods[engine.name]]
        first = [name for name in names if name in self.leading]
        before = [name for name in names if name in self.looking]
        after = [name for name in names if name not in self.leading | self.looking]
        first, before, after = (engines.runners({name: periods[name] for name in group}) for group in (first, before, after))
        O.engines = first + O.engines[:-1] + before + O.engines[-1:] + after
        self._connect()
        self.first_iteration = O.iter

    def _connect(self):
        for engine in self.live:
            engine.last_iteration = O.iter - 1
            engine.connect()

    # ---- stages

    @property
    def step(self):
        """Steps of the present stage that are done."""
        return O.iter - self.first_iteration

    @property
    def time(self):
        """Simulated seconds over all stages."""
        return self.clock + self.step * self.time_step * self.speed_up

    @property
    def finished(self):
        """True after the last stage."""
        return self.stage >= len(self.stages)

    @property
    def stage_done(self):
        """True when the present stage has run all its steps."""
        return self.step >= self.stages[self.stage][1]

    def run_chunk(self):
        """Run to the next canonical point. Raises what an engine raised, RunEnded among it."""
        O.run(min(self.chunk, self.stages[self.stage][1] - self.step), True)
        if engines.failures:
            raise engines.failures.pop()
        self.canonical()

    def canonical(self):
        """Bring YADE into the one state that a saved and loaded scene has too: no half-found contacts, bounds fresh.

        Without it a loaded scene finds contacts in another order, sums forces in another order, and differs in the
        last digit at first and in everything soon.
        """
        self.bonds.let_go()
        self._fresh_bounds()
        self.rock_friction.find_contacts()

    def _fresh_bounds(self):
        # Else, once a body has been erased, a fresh collider would know of no body that an earlier one has known.
        O.bodies.enableRedirection = False
        O.interactions.eraseNonReal()
        # Sorting leaves equal bounds (of facets with a common vertex, of particles in a layer) in the order of the
        # collider's past, and a loaded one has none.
        old = engines.yade_engine(InsertionSortCollider)
        fresh = InsertionSortCollider(boundDispatcher=old.boundDispatcher, verletDist=old.verletDist,
                                      avoidSelfInteractionMask=old.avoidSelfInteractionMask, doSort=True,
                                      numAction=old.numAction)
        O.engines = [fresh if isinstance(engine, InsertionSortCollider) else engine for engine in O.engines]
        engines.collide_next_step()

    def end_stage(self, folder):
        """Go on to the next stage; `folder` is the run's."""
        self.clock, self.first_iteration = self.time, O.iter
        self.stage += 1

    # ---- what a checkpoint holds

    def state(self):
        """All of ours that a restart needs, beside YADE's scene."""
        return {"stage": self.stage, "first_iteration": self.first_iteration, "clock": self.clock,
                "engines": {engine.name: engine.state() for engine in self.live},
                "last_iteration": {engine.name: engine.last_iteration for engine in self.live}}

    def save(self, directory, folder):
        """Write YADE's scene into `directory` of a checkpoint of the run in `folder`."""
        O.save(str(directory / "scene.yade.gz"))

    def restore(self, state, directory, folder):
        """Go back to a checkpoint: `state`, and YADE's scene in `directory`."""
        O.load(str(directory / "scene.yade.gz"))
        self._make_engines()
        self.stage, self.first_iteration, self.clock = int(state["stage"]), int(state["first_iteration"]), float(state["clock"])
        self._restore_engines(state)
        self._connect()
        for engine in self.live:
            engine.last_iteration = int(state["last_iteration"][engine.name])

    def _restore_engines(self, state):
        for engine in self.live:
            engine.restore(state["engines"].get(engine.name, {}))

    # ---- books

    def _stored_energy(self):
        """J per metre of thickness, of the rock."""
        return {"kinetic": utils.kineticEnergy(), "elastic": self.bonds.elastic_energy(),
                "contact_elastic": self.rock_friction.elastic_energy()}

    # ---- what a run's folder shows

    def cracks(self):
        """Every bond that broke, as engines.bonds.Crack."""
        return self.bonds.cracks

    def warnings(self):
        """Lines on what in this run's results is not to be relied on."""
        return []

    def write_shape(self, folder):
        """Write the tool's shape, where it may have changed and another run can take it for its own, into the folder."""

    def tables(self):
        """{file: (header, rows)} of further tables: the cracks in order of time."""
        units = "s m m m - - - - J - -".split()
        return {"cracks.csv": ([f"{name} [{unit}]" for name, unit in zip(Crack._fields, units)], sorted(self.cracks()))}

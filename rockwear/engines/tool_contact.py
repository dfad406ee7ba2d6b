"""What the tool meets: forces, friction work by particle, and who touches whom."""
import numpy as np

from yade import InsertionSortCollider, O, Vector3

from rockwear.engines.access import SLIDING, contact_energy, yade_engine
from rockwear.engines.base import FORCES, Engine
from rockwear.kernels.wear_laws import NORMAL, WORK


class ToolContact(Engine):
    """Samples the contacts of the tool's surface: force, friction work by particle, and who touches whom.

    tool: the tool's bodies (see scene.ToolBodies); motion: engines.motion.VelocityIncrement of the rock;
    needs: sums (force, exponent) of F^exponent times slip by tool particle that the wear law takes (kernels.wear_laws);
    sampling_period: steps between samples, each of which stands for all of them. To be visited in every step.

    A contact that slides dissipates the slip that its spring does not take up, (|trial force| - |Ft|) / ks, times the
    mean of the forces before and after the step: so the leapfrog's work and the springs' energy balance exactly. (YADE's
    own account, plasticDissipation, takes the force after it. A collision lasts about ten steps and begins with the
    dashpot's full force: a cut of 12 ms was 4 % short, single collisions by a factor.) Tool work, F v dt with the velocity of the tool at
    the contact point, and the work of the contact dashpots are sampled with it. Contacts are looked for only among those
    that the collider has found possible since it last ran.
    """

    name = "tool_contact"
    phase = FORCES
    reshaping_energy = 0.0
    """J with which contacts have begun that no work was done for."""

    def __init__(self, *, tool, motion, needs=(WORK,), sampling_period=1, period=1):
        super().__init__(period=period)
        self.tool, self.motion, self.sampling_period = tool, motion, sampling_period
        particles = len(motion.per_mass)
        self.tool_work = np.zeros(tool.count)
        self.rock_work = np.zeros(particles)
        self.slid = {need: np.zeros(tool.count) for need in dict.fromkeys((WORK, *needs))}
        self.touching = {}
        self.friction = self.work_done = self.dashpot_dissipated = 0.0
        self.impulse = np.zeros(3)

    def connect(self):
        self.find_contacts()
        self._note_springs()

    def find_contacts(self):
        """Note the contacts that the collider holds possible now."""
        self.collider = yade_engine(InsertionSortCollider)
        self.collided = self.collider.numAction
        self.possible = []
        for index, body in self.tool.body_of.items():
            for interaction in O.interactions.withBodyAll(body):
                first = interaction.id1 == body
                self.possible.append((interaction, index, interaction.id2 if first else interaction.id1, first))

    def forget_erased(self):
        """Contacts of erased bodies, which still look real, are not sampled any more."""
        self.possible = [contact for contact in self.possible if contact[1] in self.tool.body_of]

    def act(self):
        if self.collider.numAction != self.collided:
            self.find_contacts()
        if O.iter % self.sampling_period == 0:
            self._sample_all()
        if (O.iter + 1) % self.sampling_period == 0:
            self._note_springs()

    def _sample_all(self):
        elapsed = self.elapsed()
        for contact in self.possible:
            if contact[0].isReal:
                self._sample(contact, elapsed)

    def _note_springs(self):
        # YADE hands out its own vectors, which change with the next step.
        self.springs = {(index, rock): Vector3(interaction.phys.shearForce)
                        for interaction, index, rock, _ in self.possible if interaction.isReal}

    def _sample(self, contact, elapsed):
        interaction, index, rock, tool_first = contact
        phys = interaction.phys
        normal, shear = phys.normalForce, phys.shearForce
        # YADE puts N + S on the second body and its opposite on the first.
        sign = -elapsed if tool_first else elapsed
        x, y, z = (normal[0] + shear[0]) * sign, (normal[1] + shear[1]) * sign, (normal[2] + shear[2]) * sign
        self.impulse[0] += x
        self.impulse[1] += y
        self.impulse[2] += z
        vx, vy, vz = self.tool.velocity_at(index, interaction, tool_first)
        self.work_done -= x * vx + y * vy + z * vz
        self.touching[index, rock] = self.touching.get((index, rock), 0.0) + elapsed
        if phys.cn > 0:
            dashpot = phys.normalViscous
            gain = dashpot.dot(self.motion.of(rock)) * (0.5 if tool_first else -0.5)
            self.dashpot_dissipated += (dashpot.squaredNorm() / phys.cn + gain) * elapsed
        tangential = shear.norm()
        if tangential > 0 and tangential >= SLIDING * phys.tangensOfFrictionAngle * normal.norm():
            before, slip = self._slip(contact)
            self._book(contact, before, tangential, slip * elapsed / O.dt)

    def _book(self, contact, before, after, slip):
        """Share out a slip (m) under a tangential force (N) before and after it."""
        interaction, index, rock, _ = contact
        force = 0.5 * (before + after)
        work = force * slip
        self.friction += work
        self.tool_work[index] += work
        self.rock_work[rock] += work
        # A dashpot may pull; what presses the surfaces together is no more than compression.
        pressing = max(interaction.phys.normalForce.dot(interaction.geom.normal), 0.0)
        for (kind, exponent), summed in self.slid.items():
            summed[index] += (pressing if kind == NORMAL else force)**exponent * slip

    def _slip(self, contact):
        """Tangential force (N) before this step, and what slipped in it for good (m)."""
        interaction, index, rock, _ = contact
        phys, geom = interaction.phys, interaction.geom
        trial = geom.shearInc * -phys.ks
        before = self.springs.get((index, rock), Vector3.Zero)
        size = before.norm()
        if size > 0:
            # YADE turns the spring with the contact.
            turned = before - geom.normal * before.dot(geom.normal)
            trial += turned * (size / turned.norm())
        slip = max(trial.norm() - phys.shearForce.norm(), 0.0) / phys.ks
        return size, slip - self._too_long(interaction, slip) if slip > 0 else 0.0

    @staticmethod
    def _too_long(interaction, slip):
        """What YADE's slip has too much, m: it turns spheres about their full radii, and scales translations up to match
        (kernels.stability), while forces work over the way of the surfaces where they touch."""
        geom, force = interaction.geom, interaction.phys.shearForce
        size, length = force.norm(), geom.shearInc.norm()
        if not size * length > 0:
            return 0.0
        excess = force.dot(geom.incidentVel(interaction, False) * O.dt - geom.shearInc) / size
        # Some of the step's way may have gone into the spring.
        return excess * min(slip / length, 1.0)

    def take_slid(self):
        """{(force, exponent): (m,) sum of F^exponent times slip, N^exponent m} of tool particles since the last call."""
        taken, self.slid = self.slid, {need: np.zeros(self.tool.count) for need in self.slid}
        return taken

    @property
    def wearing_work(self):
        """(m,) friction work (J) at each tool particle that wear has not taken yet."""
        return self.slid[WORK]

    def take_heating(self):
        """Friction work (J) at tool and rock particles, and seconds in touch by (tool, rock) pair, since the last call."""
        taken = self.tool_work, self.rock_work, self.touching
        self.tool_work, self.rock_work = np.zeros(self.tool.count), np.zeros(len(self.rock_work))
        self.touching = {}
        return taken

    def take_impulse(self):
        """(3,) impulse (N s) on the tool since the last call."""
        taken, self.impulse = self.impulse, np.zeros(3)
        return taken

    def elastic_energy(self):
        """Strain energy (J) of the tool's contacts."""
        return contact_energy(i for body in self.tool.ids for i in O.interactions.withBody(body))

    def state(self):
        pairs = sorted(self.touching)
        return {"tool_work": self.tool_work.copy(), "rock_work": self.rock_work.copy(),
                "slid": np.array(list(self.slid.values())),
                "touching": np.array([(i, j, self.touching[i, j]) for i, j in pairs], float).reshape(-1, 3),
                "friction": self.friction, "work_done": self.work_done,
                "dashpot_dissipated": self.dashpot_dissipated, "impulse": self.impulse.copy()}

    def restore(self, state):
        for name in ("tool_work", "rock_work", "impulse"):
            setattr(self, name, state[name].copy())
        self.slid = dict(zip(self.slid, state["slid"].copy()))
        self.touching = {(int(i), int(j)): t for i, j, t in state["touching"].tolist()}
        for name in ("friction", "work_done", "dashpot_dissipated"):
            setattr(self, name, float(state[name]))

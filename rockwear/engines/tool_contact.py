"""Contacts of the tool: forces, friction work by particle, and the time that each pair is in contact."""
from collections import namedtuple

import numpy as np

from yade import InsertionSortCollider, O, Vector3

from rockwear.engines.access import SLIDING, contact_energy, yade_engine
from rockwear.engines.base import FORCES, Engine
from rockwear.kernels.wear_laws import NORMAL, WORK

Contact = namedtuple("Contact", "interaction piece rock tool_first")
"""A contact of the tool: YADE's interaction, the tool's piece (particle or facet) and the rock particle, and whether
the piece is the interaction's first body."""


class ToolContact(Engine):
    """Samples the contacts of the tool's surface: force, friction work by piece, and contact time by pair.

    tool: the tool's bodies; motion: engines.velocity_increment.VelocityIncrement of the rock; needs: sums
    (force, exponent) of F^exponent times slip by piece that the wear law takes (kernels.wear_laws); sampling_period:
    steps between samples, each of which stands for all of them. To be called at every step.

    A contact that slides dissipates the slip that its spring does not take up, (|trial force| - |Ft|) / ks, times the
    mean of the forces before and after the step, so that the work of the leapfrog integrator and the energy of the
    springs balance exactly. (YADE's sum of plastic dissipation takes the force after the step. A collision lasts about
    ten steps and begins with the dashpot's full force: a cut of 12 ms was 4 % short, single collisions by a factor.)
    Tool work, F v dt with the velocity of the tool at the contact point, and the work of the contact dashpots are
    sampled with it. Only contacts that the collider has found possible since it last ran are examined.

    `reshaping_energy` (J) is that with which contacts begin when the tool's shape changes: no work is done for it.
    """

    name = "tool_contact"
    phase = FORCES
    reshaping_energy = 0.0

    def __init__(self, *, tool, motion, needs=(WORK,), sampling_period=1, period=1):
        super().__init__(period=period)
        self.tool, self.motion, self.sampling_period = tool, motion, sampling_period
        self.tool_work = np.zeros(tool.count)
        self.rock_work = np.zeros(len(motion.per_mass))
        self.slid = {need: np.zeros(tool.count) for need in dict.fromkeys((WORK, *needs))}
        self.touching = {}
        self.friction = self.work_done = self.dashpot_dissipated = 0.0
        self.impulse = np.zeros(3)

    def connect(self):
        self.find_contacts()
        self._store_shear(self._real())

    def find_contacts(self):
        """Find the contacts that the collider holds possible now."""
        self.collider = yade_engine(InsertionSortCollider)
        self.collided = self.collider.numAction
        self.possible = []
        for piece, body in self.tool.body_of.items():
            for interaction in O.interactions.withBodyAll(body):
                first = interaction.id1 == body
                self.possible.append(Contact(interaction, piece, interaction.id2 if first else interaction.id1, first))

    def forget_erased(self):
        """Sample contacts of erased bodies, which still look real, no more."""
        self.possible = [contact for contact in self.possible if contact.piece in self.tool.body_of]

    def act(self):
        if self.collider.numAction != self.collided:
            self.find_contacts()
        real = self._real()
        if O.iter % self.sampling_period == 0:
            self._sample_all(real)
        if (O.iter + 1) % self.sampling_period == 0:
            self._store_shear(real)

    def _real(self):
        """Those of `possible` that are in contact now."""
        return [contact for contact in self.possible if contact[0].isReal]

    def _sample_all(self, real):
        elapsed = self.elapsed()
        for contact in real:
            self._sample(contact, elapsed)

    def _store_shear(self, real):
        # YADE hands out its own vectors, which change with the next step.
        self.shear_before = {(piece, rock): Vector3(interaction.phys.shearForce)
                             for interaction, piece, rock, _ in real}

    def _sample(self, contact, elapsed):
        interaction, piece, rock, tool_first = contact
        phys = interaction.phys
        normal, shear = phys.normalForce, phys.shearForce
        # YADE puts N + S on the second body and its opposite on the first.
        sign = -elapsed if tool_first else elapsed
        x, y, z = (normal[0] + shear[0]) * sign, (normal[1] + shear[1]) * sign, (normal[2] + shear[2]) * sign
        self.impulse[0] += x
        self.impulse[1] += y
        self.impulse[2] += z
        vx, vy, vz = self.tool.velocity_at(piece, interaction, tool_first)
        self.work_done -= x * vx + y * vy + z * vz
        self.touching[piece, rock] = self.touching.get((piece, rock), 0.0) + elapsed
        if phys.cn > 0:
            dashpot = phys.normalViscous
            gain = dashpot.dot(self.motion.of(rock)) * (0.5 if tool_first else -0.5)
            self.dashpot_dissipated += (dashpot.squaredNorm() / phys.cn + gain) * elapsed
        tangential = shear.norm()
        if tangential > 0 and tangential >= SLIDING * phys.tangensOfFrictionAngle * normal.norm():
            before, slip = self._slip(contact)
            self._add_slip(contact, before, tangential, slip * elapsed / O.dt)

    def _add_slip(self, contact, before, after, slip):
        """Add a slip (m) under a tangential force (N) before and after the step to all sums."""
        interaction, piece, rock, _ = contact
        force = 0.5 * (before + after)
        work = force * slip
        self.friction += work
        self.tool_work[piece] += work
        self.rock_work[rock] += work
        # A dashpot may pull; only compression presses the surfaces together.
        pressing = max(interaction.phys.normalForce.dot(interaction.geom.normal), 0.0)
        for (kind, exponent), summed in self.slid.items():
            summed[piece] += (pressing if kind == NORMAL else force)**exponent * slip

    def _slip(self, contact):
        """Tangential force (N) before this step, and the irreversible slip (m) in it."""
        interaction, piece, rock, _ = contact
        phys, geom = interaction.phys, interaction.geom
        trial = geom.shearInc * -phys.ks
        before = self.shear_before.get((piece, rock), Vector3.Zero)
        size = before.norm()
        if size > 0:
            # YADE rotates the spring with the contact.
            rotated = before - geom.normal * before.dot(geom.normal)
            trial += rotated * (size / rotated.norm())
        slip = max(trial.norm() - phys.shearForce.norm(), 0.0) / phys.ks
        return size, slip - self._excess(interaction, slip) if slip > 0 else 0.0

    @staticmethod
    def _excess(interaction, slip):
        """Excess (m) of YADE's slip over that of the surfaces at the contact point, over which forces work: YADE
        rotates spheres about their full radii and scales translations to match (kernels.stability)."""
        geom, force = interaction.geom, interaction.phys.shearForce
        size, length = force.norm(), geom.shearInc.norm()
        if not size * length > 0:
            return 0.0
        excess = force.dot(geom.incidentVel(interaction, False) * O.dt - geom.shearInc) / size
        # Part of the step's displacement may have gone into the spring.
        return excess * min(slip / length, 1.0)

    def take_slid(self):
        """{(force, exponent): (m,) sum of F^exponent times slip, N^exponent m} by piece since the last call."""
        taken, self.slid = self.slid, {need: np.zeros(self.tool.count) for need in self.slid}
        return taken

    @property
    def wearing_work(self):
        """(m,) friction work (J) at each piece that wear has not taken yet."""
        return self.slid[WORK]

    def take_heating(self):
        """Friction work (J) by piece and by rock particle, and contact time (s) by (piece, rock), since the last
        call."""
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

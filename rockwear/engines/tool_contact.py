"""Contacts of the tool: forces, friction work by particle, and the time that each pair is in contact."""
import math
from collections import namedtuple

import numpy as np

from yade import InsertionSortCollider, O

from rockwear.engines.access import SLIDING, contact_energy, yade_engine
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.memory import ContactReader, place
from rockwear.kernels.wear_laws import NORMAL, WORK

Contact = namedtuple("Contact", "interaction piece rock tool_first")
"""A contact of the tool: YADE's interaction, the tool's piece (particle or facet) and the rock particle, and whether
the piece is the interaction's first body."""

Values = namedtuple("Values", "normal_force shear_force viscous_force friction ks cn normal increment")
"""What YADE has of a contact now: forces (N), its friction, stiffness (N/m) and damping (N s/m), the normal and the
shear increment (m) of the step; vectors are tuples."""
NO_FORCE = (0.0, 0.0, 0.0)
"""N, in a contact that has just been made."""


def dot(a, b):
    """Of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def norm(a):
    """Of a vector."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


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
        self.constants, self.geometry = (ContactReader(part, *names) for part, names in (
            ("phys", Values._fields[:6]), ("geom", Values._fields[6:])))

    def connect(self):
        self.find_contacts()
        self._store_shear(self._now())

    def find_contacts(self):
        """Find the contacts that the collider holds possible now."""
        self.collider = yade_engine(InsertionSortCollider)
        self.collided = self.collider.numAction
        found = []
        for piece, body in self.tool.body_of.items():
            for interaction in O.interactions.withBodyAll(body):
                first = interaction.id1 == body
                found.append(Contact(interaction, piece, interaction.id2 if first else interaction.id1, first))
        self._keep(found)

    def forget_erased(self):
        """Sample contacts of erased bodies, which still look real, no more."""
        self._keep([contact for contact in self.possible if contact.piece in self.tool.body_of])

    def _keep(self, contacts):
        # What Python holds keeps its place in memory.
        self.possible, self.places = contacts, [place(contact.interaction) for contact in contacts]

    def act(self):
        if self.collider.numAction != self.collided:
            self.find_contacts()
        sampled, stored = O.iter % self.sampling_period == 0, (O.iter + 1) % self.sampling_period == 0
        if sampled or stored:
            now = self._now()
            if sampled:
                self._sample_all(now)
            if stored:
                self._store_shear(now)

    def _now(self):
        """[(contact, Values)] of those of `possible` that are in contact now."""
        return [(contact, self._values(where)) for contact, where in zip(self.possible, self.places)
                if contact[0].isReal]

    def _values(self, where):
        """Values of the contact at this place in memory, which must be in contact now."""
        constants, geometry = self.constants.of(where), self.geometry.of(where)
        return Values(constants[:3], constants[3:6], constants[6:9], *constants[9:], geometry[:3], geometry[3:])

    def _sample_all(self, now):
        elapsed = self.elapsed()
        for contact, values in now:
            self._sample(contact, values, elapsed)

    def _store_shear(self, now):
        self.shear_before = {contact[1:3]: values.shear_force for contact, values in now}

    def _sample(self, contact, now, elapsed):
        interaction, piece, rock, tool_first = contact
        normal, shear = now.normal_force, now.shear_force
        # YADE puts N + S on the second body and its opposite on the first.
        sign = -elapsed if tool_first else elapsed
        x, y, z = (normal[0] + shear[0]) * sign, (normal[1] + shear[1]) * sign, (normal[2] + shear[2]) * sign
        self.impulse[0] += x
        self.impulse[1] += y
        self.impulse[2] += z
        vx, vy, vz = self.tool.velocity_at(piece, interaction, tool_first)
        self.work_done -= x * vx + y * vy + z * vz
        self.touching[piece, rock] = self.touching.get((piece, rock), 0.0) + elapsed
        if now.cn > 0:
            dashpot = now.viscous_force
            gain = dot(dashpot, self.motion.of(rock)) * (0.5 if tool_first else -0.5)
            self.dashpot_dissipated += (dot(dashpot, dashpot) / now.cn + gain) * elapsed
        tangential = norm(shear)
        if tangential > 0 and tangential >= SLIDING * now.friction * norm(normal):
            before, slip = self._slip(contact, now)
            self._add_slip(contact, now, before, tangential, slip * elapsed / O.dt)

    def _add_slip(self, contact, now, before, after, slip):
        """Add a slip (m) under a tangential force (N) before and after the step to all sums."""
        _, piece, rock, _ = contact
        force = 0.5 * (before + after)
        work = force * slip
        self.friction += work
        self.tool_work[piece] += work
        self.rock_work[rock] += work
        # A dashpot may pull; only compression presses the surfaces together.
        pressing = max(dot(now.normal_force, now.normal), 0.0)
        for (kind, exponent), summed in self.slid.items():
            summed[piece] += (pressing if kind == NORMAL else force)**exponent * slip

    def _slip(self, contact, now):
        """Tangential force (N) before this step, and the irreversible slip (m) in it."""
        ks, (nx, ny, nz) = now.ks, now.normal
        x, y, z = (-ks * along for along in now.increment)
        before = self.shear_before.get(contact[1:3], NO_FORCE)
        size = norm(before)
        if size > 0:
            # YADE rotates the spring with the contact.
            along = dot(before, now.normal)
            rotated = before[0] - nx * along, before[1] - ny * along, before[2] - nz * along
            scale = size / norm(rotated)
            x, y, z = x + rotated[0] * scale, y + rotated[1] * scale, z + rotated[2] * scale
        slip = max(norm((x, y, z)) - norm(now.shear_force), 0.0) / ks
        return size, slip - self._excess(contact.interaction, now, slip) if slip > 0 else 0.0

    @staticmethod
    def _excess(interaction, now, slip):
        """Excess (m) of YADE's slip over that of the surfaces at the contact point, over which forces work: YADE
        rotates spheres about their full radii and scales translations to match (kernels.stability)."""
        force, increment = now.shear_force, now.increment
        size, length = norm(force), norm(increment)
        if not size * length > 0:
            return 0.0
        way = interaction.geom.incidentVel(interaction, False) * O.dt
        excess = dot(force, (way[0] - increment[0], way[1] - increment[1], way[2] - increment[2])) / size
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

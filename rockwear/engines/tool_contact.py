"""Contacts of the tool: forces, friction work by particle, and the time that each pair is in contact."""
from collections import namedtuple

import numpy as np

from yade import InsertionSortCollider, O

from rockwear.engines.access import contact_energy, yade_engine
from rockwear.engines.base import FORCES, Engine
from rockwear.engines.memory import MEMORY, WORDS, kernel_layout, list_of_bodies, place
from rockwear.kernels import compiled
from rockwear.kernels.wear_laws import NORMAL, WORK

Contact = namedtuple("Contact", "interaction piece rock tool_first")
"""A contact of the tool: YADE's interaction, the tool's piece (particle or facet) and the rock particle, and whether
the piece is the interaction's first body."""


class ToolContact(Engine):
    """Samples the contacts of the tool's surface: force, friction work by piece, and contact time by pair.

    tool: the tool's bodies; motion: engines.velocity_increment.VelocityIncrement of the rock; needs: sums
    (force, exponent) of F^exponent times slip by piece that the wear law takes (kernels.wear_laws); sampling_period:
    steps between samples, each of which stands for all of them. To be called at every step.

    A contact that slides dissipates its slip times the mean of the forces before and after the step
    (kernels.compiled.sample_tool, tool_slip). (YADE's sum of plastic dissipation takes the force after the step. A
    collision lasts about ten steps and begins with the dashpot's full force: a cut of 12 ms was 4 % short, single
    collisions by a factor.) Tool work and the work of the contact dashpots are sampled with it. Only contacts that the
    collider has found possible since it last ran are examined.

    `reshaping_energy` (J) is that with which contacts begin when the tool's shape changes: no work is done for it.
    """

    name = "tool_contact"
    phase = FORCES
    reshaping_energy = 0.0
    least_stiffness = 0.0
    """N/m, of contacts that count."""

    def __init__(self, *, tool, motion, needs=(WORK,), sampling_period=1, period=1):
        super().__init__(period=period)
        self.tool, self.motion, self.sampling_period = tool, motion, sampling_period
        self.tool_work = np.zeros(tool.count)
        self.rock_work = np.zeros(len(motion.per_mass))
        needs = list(dict.fromkeys((WORK, *needs)))
        self.presses = np.array([kind == NORMAL for kind, _ in needs])
        self.exponents = np.array([exponent for _, exponent in needs], float)
        self._begin_slid(needs)
        self.touching, self.possible = {}, []
        self.before, self.real = np.zeros((0, 3)), np.zeros(0, bool)
        """Shear forces (N) of `possible` before this step, and which were in contact then."""
        self.friction = self.work_done = self.dashpot_dissipated = 0.0
        self.impulse = np.zeros(3)

    def _begin_slid(self, needs):
        self.sums = np.zeros((len(needs), self.tool.count))
        self.slid = dict(zip(needs, self.sums))

    def connect(self):
        self.layout, self.bodies = kernel_layout(), list_of_bodies()
        self.possible = []
        self.find_contacts()
        self._store_shear()

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
        row = {contact[1:3]: k for k, contact in enumerate(self.possible)}
        before, real = self.before, self.real
        self.before, self.real = np.zeros((len(contacts), 3)), np.zeros(len(contacts), bool)
        for k, contact in enumerate(contacts):
            if contact[1:3] in row:
                known = row[contact[1:3]]
                self.before[k], self.real[k] = before[known], real[known]
        # What Python holds keeps its place in memory.
        self.possible = contacts
        self.places, self.pieces, self.rocks = (np.array(values, int) for values in (
            [place(contact.interaction) for contact in contacts], [contact.piece for contact in contacts],
            [contact.rock for contact in contacts]))
        self.first = np.array([contact.tool_first for contact in contacts], bool)

    def act(self):
        if self.collider.numAction != self.collided:
            self.find_contacts()
        sampled, stored = O.iter % self.sampling_period == 0, (O.iter + 1) % self.sampling_period == 0
        if sampled:
            self._sample_all()
        if stored:
            self._store_shear()

    def _sample_all(self):
        """Sample those of `possible` that are in contact now. -> J, friction as YADE counts it."""
        elapsed = self.elapsed()
        numbers = compiled.touching(MEMORY, WORDS, self.layout, self.places, self.least_stiffness)
        if not len(numbers):
            return 0.0
        rocks = []
        for k in numbers.tolist():
            _, piece, rock, _ = self.possible[k]
            self.touching[piece, rock] = self.touching.get((piece, rock), 0.0) + elapsed
            rocks.append(rock)
        friction, done, dashpots, in_yade = compiled.sample_tool(
            MEMORY, WORDS, self.layout, self.bodies, numbers, self.places, self.pieces, self.rocks, self.first,
            self.before, self.motion.of(rocks), elapsed, O.dt, self.presses, self.exponents, self.tool_work,
            self.rock_work, self.sums, self.impulse)
        self.friction += friction
        self.work_done += done
        self.dashpot_dissipated += dashpots
        return in_yade

    def _store_shear(self):
        compiled.shear_forces(MEMORY, WORDS, self.layout, self.places, self.before, self.real)

    def take_slid(self):
        """{(force, exponent): (m,) sum of F^exponent times slip, N^exponent m} by piece since the last call."""
        taken = self.slid
        self._begin_slid(taken)
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
                "slid": self.sums.copy(),
                "touching": np.array([(i, j, self.touching[i, j]) for i, j in pairs], float).reshape(-1, 3),
                "friction": self.friction, "work_done": self.work_done,
                "dashpot_dissipated": self.dashpot_dissipated, "impulse": self.impulse.copy()}

    def restore(self, state):
        for name in ("tool_work", "rock_work", "impulse"):
            setattr(self, name, state[name].copy())
        self._begin_slid(self.slid)
        self.sums[:] = state["slid"]
        self.touching = {(int(i), int(j)): t for i, j, t in state["touching"].tolist()}
        for name in ("friction", "work_done", "dashpot_dissipated"):
            setattr(self, name, float(state[name]))

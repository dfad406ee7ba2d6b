"""Contacts of the tool: forces, friction work by particle, and the time that each pair is in contact."""
from collections import namedtuple

import numpy as np

from yade import InsertionSortCollider, O

from rockwear.engines.access import contact_energy, yade_engine
from rockwear.engines.base import Engine
from rockwear.engines.memory import MEMORY, WORDS, kernel_layout, list_of_bodies, places
from rockwear.kernels import compiled
from rockwear.kernels.wear_laws import NORMAL, WORK

Contact = namedtuple("Contact", "interaction piece rock tool_first place")
"""A contact of the tool: YADE's interaction, the tool's piece (particle or facet) and the rock particle, whether the
piece is the interaction's first body, and where the interaction lies in memory."""


def _contact(interaction, piece, body, where):
    first = interaction.id1 == body
    return Contact(interaction, piece, interaction.id2 if first else interaction.id1, first, where)


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
    reshaping_energy = 0.0
    least_stiffness = 0.0
    """N/m, of contacts that count."""

    def __init__(self, *, tool, motion, needs=(WORK,), sampling_period=1, period=1):
        super().__init__(period=period)
        self.tool, self.motion, self.sampling_period = tool, motion, sampling_period
        self.tool_work = np.zeros(tool.count)
        self.rock_work = np.zeros(motion.count)
        needs = list(dict.fromkeys((WORK, *needs)))
        self.needs = np.array([[kind == NORMAL, exponent] for kind, exponent in needs], float).T.copy()
        self.totals = np.zeros(6)
        self._begin_slid(needs)
        self._begin_contacts()

    def _begin_slid(self, needs):
        self.sums = np.zeros((len(needs), self.tool.count))
        self.slid = dict(zip(needs, self.sums))

    def _begin_contacts(self):
        self.possible, self.seconds, self.touched = [], np.zeros(0), {}
        """Contacts that may be, the contact time (s) of each, and that of pairs that are not among them."""
        self.places, self.parts = np.zeros(0, np.int64), np.zeros((3, 0), np.int64)
        """Where `possible` lie in memory; their pieces, rock particles and which of the two is first."""
        self.before = np.zeros((0, 4))
        """Shear forces (N) of `possible` before this step, and 1 where they were in contact then."""

    def connect(self):
        self.layout, self.body_list = kernel_layout(), list_of_bodies()
        self.motion.connect()
        self.find_contacts()

    def find_contacts(self):
        """Find the contacts that the collider, which may be another one, holds possible now, and the forces that the
        next step begins with: steps may have been skipped."""
        self.collider = yade_engine(InsertionSortCollider)
        self._find()
        self._visit(0.0, sampled=False, stored=True)

    def _find(self):
        self.collided = self.collider.numAction
        found = [(interaction, piece, body) for piece, body in self.tool.body_of.items()
                 for interaction in O.interactions.withBodyAll(body)]
        where = places([interaction for interaction, _, _ in found])
        if np.array_equal(where, self.places):
            return
        # What Python holds keeps its place in memory: a place that is known is the contact that it was.
        known = dict(zip(self.places.tolist(), range(len(self.places))))
        rows = [known.get(at, -1) for at in where.tolist()]
        self._keep([self.possible[row] if row >= 0 else _contact(*one, at)
                    for row, one, at in zip(rows, found, where.tolist())], np.array(rows, int))

    def forget_erased(self):
        """Sample contacts of erased bodies, which still look real, no more."""
        rows = [k for k, contact in enumerate(self.possible) if contact.piece in self.tool.body_of]
        self._keep([self.possible[row] for row in rows], np.array(rows, int))

    def _keep(self, contacts, rows):
        """These are the possible contacts from now on; rows (k,): their numbers until now, -1 of new ones."""
        left = np.ones(len(self.possible), bool)
        left[rows[rows >= 0]] = False
        for k in np.flatnonzero(left & (self.seconds > 0.0)).tolist():
            self.touched[self.possible[k][1:3]] = self.seconds[k]
        # The last row, or column, is that of contacts that are not known.
        self.before = np.append(self.before, np.zeros((1, 4)), axis=0)[rows]
        self.seconds = np.append(self.seconds, 0.0)[rows]
        numbers = np.append(np.vstack([self.parts, self.places]), np.zeros((4, 1), np.int64), axis=1).take(rows, axis=1)
        for k in np.flatnonzero(rows < 0).tolist():
            numbers[:, k] = contacts[k][1:]
            # A pair may come back.
            self.seconds[k] = self.touched.pop(contacts[k][1:3], 0.0)
        self.possible, self.parts, self.places = contacts, numbers[:3], numbers[3]

    def touching(self):
        """{(piece, rock): s in contact since `take_heating`}."""
        there = {contact[1:3]: time for contact, time in zip(self.possible, self.seconds.tolist()) if time > 0.0}
        return {**self.touched, **there}

    def act(self):
        if self.collider.numAction != self.collided:
            self._find()
        step, period = O.iter, self.sampling_period
        sampled, stored = step % period == 0, (step + 1) % period == 0
        if sampled or stored:
            self._visit(self.elapsed() if sampled else 0.0, sampled, stored)

    def _visit(self, elapsed, sampled, stored):
        """What contacts do in this step, for `elapsed` (s), is sampled, their shear forces are stored. -> J of friction
        as YADE counts it."""
        if not len(self.places):
            return 0.0
        return compiled.sample_tool(
            MEMORY, WORDS, self.layout, self.body_list, self.motion.tables, self.since, self.places,
            self.least_stiffness, self.parts, self.needs, self.before, elapsed, O.dt, sampled, stored, self.seconds,
            self.tool_work, self.rock_work, self.sums, self.totals)

    @property
    def friction(self):
        """J so far."""
        return float(self.totals[compiled.FRICTION_WORK])

    @property
    def work_done(self):
        """J, of the tool so far."""
        return float(self.totals[compiled.TOOL_WORK])

    @property
    def dashpot_dissipated(self):
        """J so far."""
        return float(self.totals[compiled.DASHPOT_WORK])

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
        taken = self.tool_work, self.rock_work, self.touching()
        self.tool_work, self.rock_work = np.zeros(self.tool.count), np.zeros(len(self.rock_work))
        self.seconds[:], self.touched = 0.0, {}
        return taken

    def take_impulse(self):
        """(3,) impulse (N s) on the tool since the last call."""
        taken = self.totals[compiled.IMPULSE:].copy()
        self.totals[compiled.IMPULSE:] = 0.0
        return taken

    def elastic_energy(self):
        """Strain energy (J) of the tool's contacts."""
        return contact_energy(i for body in self.tool.ids for i in O.interactions.withBody(body))

    def state(self):
        touching = sorted(self.touching().items())
        return {"tool_work": self.tool_work.copy(), "rock_work": self.rock_work.copy(), "slid": self.sums.copy(),
                "touching": np.array([(*pair, time) for pair, time in touching], float).reshape(-1, 3),
                "friction": self.friction, "work_done": self.work_done, "dashpot_dissipated": self.dashpot_dissipated,
                "impulse": self.totals[compiled.IMPULSE:].copy()}

    def restore(self, state):
        self.tool_work, self.rock_work = state["tool_work"].copy(), state["rock_work"].copy()
        self.totals[[compiled.FRICTION_WORK, compiled.TOOL_WORK, compiled.DASHPOT_WORK]] = (
            state["friction"], state["work_done"], state["dashpot_dissipated"])
        self.totals[compiled.IMPULSE:] = state["impulse"]
        self._begin_slid(self.slid)
        self.sums[:] = state["slid"]
        self._begin_contacts()
        self.touched = {(int(i), int(j)): t for i, j, t in state["touching"].tolist()}

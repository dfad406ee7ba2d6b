"""Contacts of a tool of facets, which pass from facet to facet."""
import math
import numpy as np

from yade import O, Vector3

from rockwear.engines.access import contact_energy, yade_friction_law
from rockwear.engines.tool_contact import ToolContact
from rockwear.kernels.facet_notch import joined_depth
from rockwear.kernels.wear_laws import FRICTION, WORK


MUTE = 2.0**-100
"""Factor on the stiffness of a contact that does not count: not zero, which YADE divides by, and exact to undo."""

SILENT = 1e-9
"""N/m, stiffness below which a contact is one of these. So YADE's own scene says which are muted, saved ones too."""

FACE = 1 - 1e-13
"""Cosine between a contact's and its facet's normal above which the facet is touched inside, not at its rim."""

SHALLOW = 0.8
"""Cosine between neighbouring facets above which an inner edge is no corner: a particle whose overlap is more than
1 - SHALLOW of its radius would leave one of the two, past the edge, while it still presses there."""

SLIP = (FRICTION, 0.0)
"""The sum that is the way slid."""

EVEN = 1e-9
"""Two contacts are equally deep if their depths differ by less than this part of the particle's radius."""


class FacetContact(ToolContact):
    """ToolContact of a tool of facets, where a particle at an edge touches several facets and yet only one surface.

    Of the contacts of one particle, one at the rim of its facet counts for nothing as long as a neighbouring facet is
    touched more deeply: it is the same contact seen from next door. It is muted. When the particle goes on to that
    facet, the contact there takes over the shear force, turned to the new normal, so that neither the history nor the
    energy of the sliding contact is lost. Two facets of an inner corner are both touched inside, and both count. Where
    they are nearly in one plane (SHALLOW) only the deeper one does: within a strip as wide as its overlap times their
    angle a particle would meet the force of two faces, and at its end lose one with all its energy. Where both are
    about equally deep the contact is one with their joined depth (kernels.inner_edge): `notches` are these pairs
    (facet that counts, facet beside it, particle). Coulomb's limit there is that of the depth in the facet that counts.

    Where the shape has changed, particles touch other facets in the next step, or more deeply, than they did. `born` is
    the energy, J, with which such contacts begin: no work has been done for it.

    YADE's account of friction is one for rock and tool here: `in_yade_balance` is the tool's part of it, slip times the force
    after it. Every step is to be sampled.
    """

    def __init__(self, *, neighbours, needs=(WORK,), **common):
        super().__init__(needs=(*needs, SLIP), **common)
        self.neighbours = neighbours
        self.in_yade_balance = self.reshaping_energy = 0.0
        self.notches, self.reshaped = [], False

    def connect(self):
        super().connect()
        self.functor = yade_friction_law()

    def find_contacts(self):
        super().find_contacts()
        groups = {}
        for contact in self.possible:
            groups.setdefault(contact[2], []).append(contact)
        self.shared = [(rock, group) for rock, group in sorted(groups.items()) if len(group) > 1]

    def act(self):
        if self.collider.numAction != self.collided:
            self.find_contacts()
        fixed = self._energy(known=self.springs) if self.reshaped else 0.0
        self.notches = []
        successions = [pair for rock, group in self.shared for pair in self._judge(rock, group)]
        self._sample_all()
        acting = {new[1:3]: old for old, new in successions}
        for one, other in self._pairs():
            self._join(one, other, acting.get(one[1:3], one))
        for old, new in successions:
            self._hand_over(old, new)
        if self.reshaped:
            self.reshaping_energy += self._energy() - fixed
        self.reshaped = False
        self._note_springs()

    def shape_has_changed(self):
        """The contacts of the next step are those with another shape."""
        self.reshaped = True

    def _energy(self, known=None):
        """J in the springs of contacts, or of those `known`, at the depths that YADE has found in this step."""
        return self._stored((contact[0] for contact in self.possible
                             if contact[0].isReal and (known is None or contact[1:3] in known)), as_found)

    def _stored(self, interactions, meeting):
        """J in the springs of these contacts and in what is joined. meeting: as_found or the like."""
        return (contact_energy(interactions, lambda interaction: meeting(interaction)[0])
                + math.fsum(self._joined_energy(pair, meeting) for pair in self._pairs()))

    def _pairs(self):
        """The contacts of the notches: [(contact that counts, contact beside it)]."""
        real = {contact[1:3]: contact for contact in self.possible if contact[0].isReal} if self.notches else {}
        found = [(real.get((one, rock)), real.get((other, rock))) for one, other, rock in self.notches]
        return [pair for pair in found if None not in pair]

    def _book(self, contact, before, after, slip):
        if not muted(contact):
            super()._book(contact, before, after, slip)
            self.in_yade_balance += slip * after

    def _judge(self, rock, group):
        """Silence the contacts of a particle that have just come to be and count for nothing; wake what counts and has
        no predecessor. -> pairs (contact, its successor)."""
        real = [contact for contact in group if contact[0].isReal]
        if len(real) < 2:
            for contact in real:
                self._wake(contact)
            return []
        standing, doubled = self._ranked(rock, real)
        self.notches += [(one[1], other[1], rock) for one in standing for other in self._beside(one, doubled)]
        ending = [contact for contact in doubled if not muted(contact)]
        successions = []
        for new in standing:
            if muted(new):
                old = next((contact for contact in ending if contact[1] in self.neighbours[new[1]]), None)
                if old is None:
                    self._wake(new)
                else:
                    ending.remove(old)
                    successions.append((old, new))
        for contact in ending:
            self._cancel(contact)
            self._silence(contact)
        return successions

    def _ranked(self, rock, real):
        """Contacts that count, and those that a neighbouring facet's deeper contact makes double."""
        even = EVEN * O.bodies[rock].shape.radius
        rows = []
        for contact in real:
            # Of equally deep ones the one inside its facet stands first, then the one that counts already.
            rows.append((-round(contact[0].geom.penetrationDepth / even), not self._inside(contact),
                         muted(contact), contact[1], contact))
        rows.sort(key=lambda row: row[:4])
        standing, doubled, before = [], [], []
        for _, outside, _, index, contact in rows:
            normal = contact[0].geom.normal
            same = any(index in self.neighbours[other[1]] and (outside or normal.dot(other[0].geom.normal) > SHALLOW)
                       for other in before)
            (doubled if same else standing).append(contact)
            before.append(contact)
        return standing, doubled

    def _beside(self, one, doubled):
        """[the one of the doubled contacts that is joined with contact `one`, or has acted for it], or none."""
        near = [(parts, other[1], other) for other in doubled if other[1] in self.neighbours[one[1]]
                for parts in [self._joined(one, other, as_found)[1]] if parts and (parts[0] < 1 or not muted(other))]
        return [other for _, _, other in sorted(near, key=lambda row: row[:2])[:1]]

    def _joined(self, one, other, meeting):
        """(joined depth, its parts) of two contacts; (0, None) where one is open. meeting: as_found or the like.

        Only those inside of both facets are joined: at a rim the angle would change with the place, and none of it is a
        potential's.
        """
        (first, along), (second, aside) = meeting(one[0]), meeting(other[0])
        if min(first, second) <= 0:
            return 0.0, None
        inside = self._looks_along(one, along) and self._looks_along(other, aside)
        return joined_depth(first, second, abs(along.dot(aside)) if inside else 1.0)

    def _inside(self, contact):
        return self._looks_along(contact, contact[0].geom.normal)

    def _looks_along(self, contact, direction):
        body = O.bodies[self.tool.body_of[contact[1]]]
        return abs(direction.dot(body.state.ori * body.shape.normal)) > FACE

    def contact_inside_tool(self):
        """Where (x, y, z in m) a particle that counts touches a facet inside its rim from within the tool, or None.

        YADE's facets have two sides. The normal of a contact runs from its first body to the second.
        """
        for contact in self.possible:
            interaction, index, _, tool_first = contact
            if interaction.isReal and not muted(contact) and self._inside(contact):
                body = O.bodies[self.tool.body_of[index]]
                outward = body.state.ori * Vector3(*self.tool.outward(index))
                if (interaction.geom.normal.dot(outward) > 0) != tool_first:
                    return "({:.4g}, {:.4g}, {:.4g}) m".format(*interaction.geom.contactPoint)
        return None

    def _wake(self, contact):
        if muted(contact):
            phys = contact[0].phys
            phys.kn, phys.ks, phys.cn = phys.kn / MUTE, phys.ks / MUTE, phys.cn / MUTE

    def _cancel(self, contact):
        """Take the contact's force off the particle in this step, and its friction off YADE's account."""
        interaction, _, rock, tool_first = contact
        counted = self._slip(contact)[1] * interaction.phys.shearForce.norm()
        self.functor.initPlasticDissipation(self.functor.plasticDissipation() - counted)
        force = interaction.phys.normalForce + interaction.phys.shearForce
        force = -force if tool_first else force
        O.forces.addF(rock, force)
        O.forces.addT(rock, (interaction.geom.contactPoint - O.bodies[rock].state.pos).cross(force))

    def _silence(self, contact):
        phys = contact[0].phys
        phys.kn, phys.ks, phys.cn = phys.kn * MUTE, phys.ks * MUTE, phys.cn * MUTE
        phys.normalForce = phys.shearForce = phys.normalViscous = Vector3.Zero

    def _hand_over(self, old, new):
        shear = Vector3(old[0].phys.shearForce)
        size, normal = shear.norm(), new[0].geom.normal
        self._silence(old)
        self._wake(new)
        turned = shear - normal * shear.dot(normal)
        if size > 0 and turned.norm() > 0:
            if old[3] != new[3]:
                turned = -turned
            new[0].phys.shearForce = turned * (size / turned.norm())

    def _join(self, one, other, acting):
        """Put the force of the joined depth of two contacts in place of that of the contact that has acted in this step."""
        depth, parts = self._joined(one, other, as_found)
        if parts is None or muted(acting) or acting[0].phys.normalForce.norm() < SILENT:
            return
        _, index, rock, _ = acting
        force = (inwards(one) * (depth * parts[0]) + inwards(other) * (depth * parts[1])
                 - inwards(acting) * acting[0].geom.penetrationDepth) * acting[0].phys.kn
        O.forces.addF(rock, force)
        self.impulse -= np.array(force) * O.dt
        self.work_done += force.dot(Vector3(*self.tool.velocity_at(index, acting[0], acting[3]))) * O.dt

    def _joined_energy(self, pair, meeting):
        """J that the joined depth of two contacts holds more than the one of them that counts."""
        counting, (depth, parts) = pair[1] if muted(pair[0]) else pair[0], self._joined(*pair, meeting)
        if parts is None or muted(counting):
            return 0.0
        return 0.5 * counting[0].phys.kn * (depth**2 - meeting(counting[0])[0]**2)

    def elastic_energy(self):
        return self._stored((i for body in self.tool.ids for i in O.interactions.withBody(body)), self.tool.meeting)

    def state(self):
        return {**super().state(), "in_yade_balance": self.in_yade_balance, "reshaping_energy": self.reshaping_energy, "reshaped": self.reshaped,
                "notches": np.array(self.notches, int).reshape(-1, 3)}

    def restore(self, state):
        super().restore(state)
        self.in_yade_balance, self.reshaping_energy = float(state["in_yade_balance"]), float(state["reshaping_energy"])
        self.reshaped = bool(state["reshaped"])
        self.notches = [tuple(row) for row in state["notches"].tolist()]


def muted(contact):
    """Whether this entry (interaction, facet, particle, facet first) of the contacts is muted."""
    return contact[0].phys.kn < SILENT


def inwards(contact):
    """Direction (-) in which a contact presses the particle."""
    return contact[0].geom.normal if contact[3] else -contact[0].geom.normal


def as_found(interaction):
    """Overlap (m) of a contact and its normal, as YADE found them in this step."""
    return interaction.geom.penetrationDepth, interaction.geom.normal

"""Contacts of a tool of facets, which pass from facet to facet."""
import math
import numpy as np

from yade import O, Vector3

from rockwear.engines.access import contact_energy, yade_friction_law
from rockwear.engines.base import FORCES
from rockwear.engines.memory import MEMORY, WORDS
from rockwear.engines.tool_contact import ToolContact
from rockwear.kernels import compiled
from rockwear.kernels.facet_notch import joined_depth
from rockwear.kernels.wear_laws import FRICTION, WORK


INACTIVE = 2.0**-100
"""Factor on the stiffness of an inactive contact: not zero, by which YADE would divide, and exact to undo."""

INACTIVE_STIFFNESS = 1e-9
"""N/m, stiffness below which a contact is inactive. So YADE's scene tells which are, also after it was saved."""

INSIDE = 1 - 1e-13
"""Cosine between the normals of a contact and its facet above which the contact lies inside the facet, not on its
rim."""

SHALLOW = 0.8
"""Cosine between adjacent facets above which a notch counts as one surface: a particle whose overlap is more than
1 - SHALLOW of its radius would lose the contact with one of the two, beyond the edge, while it still presses there."""

SLIP = (FRICTION, 0.0)
"""The sum that is the sliding distance."""

EVEN = 1e-9
"""Two contacts are equally deep if their depths differ by less than this part of the particle's radius."""


class FacetContact(ToolContact):
    """ToolContact of a tool of facets, where a particle at an edge touches several facets and yet only one surface.

    Of the contacts of one particle, one on the rim of its facet is inactive while an adjacent facet is touched more
    deeply: it is a duplicate reported by the facet beside. When the particle moves on to that facet, the contact there
    takes over the shear force, rotated to the new normal, so that the history and the energy of the sliding contact
    are kept. Two facets of a notch are both touched inside, and both contacts are active. Where the facets are nearly
    in one plane (SHALLOW) only the deeper one is: otherwise, within a strip as wide as its overlap times the angle, a
    particle would feel the force of two facets, and at the end of the strip lose one with all its energy. Where both
    are about equally deep they act as one contact with their joined depth (kernels.facet_notch): `notches` are these
    pairs (active facet, facet beside it, particle). Coulomb's limit there is that of the depth in the active facet.

    When the shape has changed, particles touch other facets in the next step, or more deeply. `reshaping_energy` (J) is
    that with which such contacts begin.

    YADE's sum of plastic dissipation is one for rock and tool here: `in_yade_balance` is the tool's part of it, slip
    times the force after it. Every step is sampled.
    """

    phase = FORCES
    # A duplicate has no force, and no contact time in which heat would pass.
    least_stiffness = INACTIVE_STIFFNESS

    def __init__(self, *, neighbours, needs=(WORK,), **common):
        super().__init__(needs=(*needs, SLIP), **common)
        self.neighbours = neighbours
        self.in_yade_balance = self.reshaping_energy = 0.0
        self.notches, self.reshaped = [], False

    def connect(self):
        super().connect()
        self.functor = yade_friction_law()

    def _find(self):
        super()._find()
        groups = {}
        for contact in self.possible:
            groups.setdefault(contact.rock, []).append(contact)
        self.shared = [(rock, group) for rock, group in sorted(groups.items()) if len(group) > 1]

    def act(self):
        if self.collider.numAction != self.collided:
            self._find()
        stored = self._energy(of=np.flatnonzero(self.before[:, 3])) if self.reshaped else 0.0
        self.notches = []
        successions = [pair for rock, group in self.shared for pair in self._select(rock, group)]
        self.in_yade_balance += self._visit(self.elapsed(), sampled=True, stored=False)
        acting = {pieces(new): old for old, new in successions}
        for one, other in self._pairs():
            self._join(one, other, acting.get(pieces(one), one))
        for old, new in successions:
            transfer(old, new)
        if self.reshaped:
            self.reshaping_energy += self._energy() - stored
        self.reshaped = False
        self._visit(0.0, sampled=False, stored=True)

    def shape_has_changed(self):
        """The contacts of the next step are those with another shape."""
        self.reshaped = True

    def _energy(self, of=None):
        """J in the springs of contacts, or of those numbers `of` them, at the depths that YADE has found in this
        step."""
        contacts = self.possible if of is None else [self.possible[k] for k in of.tolist()]
        return self._stored((one.interaction for one in contacts if one.interaction.isReal), as_found)

    def _stored(self, interactions, depth_of):
        """J in the springs of these contacts and of joined ones. depth_of: as_found or the like."""
        return (contact_energy(interactions, lambda interaction: depth_of(interaction)[0])
                + math.fsum(self._joined_energy(pair, depth_of) for pair in self._pairs()))

    def _pairs(self):
        """The contacts of the notches: [(active contact, contact beside it)]."""
        if not self.notches:
            return []
        real = {pieces(contact): contact for contact in self.possible if contact.interaction.isReal}
        found = [(real.get((one, rock)), real.get((other, rock))) for one, other, rock in self.notches]
        return [pair for pair in found if None not in pair]

    def _select(self, rock, group):
        """Make new duplicates among the contacts of a particle inactive, and others active that have no predecessor.
        -> pairs (contact, its successor)."""
        real = [contact for contact in group if contact.interaction.isReal]
        if len(real) < 2:
            for contact in real:
                activate(contact)
            return []
        counting, duplicates = self._ranked(rock, real)
        self.notches += [(one.piece, other.piece, rock) for one in counting for other in self._beside(one, duplicates)]
        ending = [contact for contact in duplicates if not inactive(contact)]
        successions = []
        for new in counting:
            if inactive(new):
                old = next((contact for contact in ending if contact.piece in self.neighbours[new.piece]), None)
                if old is None:
                    activate(new)
                else:
                    ending.remove(old)
                    successions.append((old, new))
        for contact in ending:
            self._cancel(contact)
            deactivate(contact)
        return successions

    def _ranked(self, rock, real):
        """Contacts that count, and the duplicates of an adjacent facet's deeper contact."""
        even = EVEN * O.bodies[rock].shape.radius
        rows = []
        for contact in real:
            # Of equally deep ones those inside their facet come first, then those that are active already.
            rows.append((-round(contact.interaction.geom.penetrationDepth / even), not self._inside(contact),
                         inactive(contact), contact.piece, contact))
        rows.sort(key=lambda row: row[:4])
        counting, duplicates, before = [], [], []
        for _, outside, _, piece, contact in rows:
            normal = contact.interaction.geom.normal
            same = any(piece in self.neighbours[other.piece]
                       and (outside or normal.dot(other.interaction.geom.normal) > SHALLOW) for other in before)
            (duplicates if same else counting).append(contact)
            before.append(contact)
        return counting, duplicates

    def _beside(self, one, duplicates):
        """[the duplicate that is joined with contact `one`, or has acted for it], or none."""
        near = [(parts, other.piece, other) for other in duplicates if other.piece in self.neighbours[one.piece]
                for parts in [self._joined(one, other, as_found)[1]] if parts and (parts[0] < 1 or not inactive(other))]
        return [other for _, _, other in sorted(near, key=lambda row: row[:2])[:1]]

    def _joined(self, one, other, depth_of):
        """(joined depth, its derivatives) of two contacts; (0, None) where one is open. depth_of: as_found or the like.

        Only contacts inside both facets are joined: on a rim the angle would change with the position, and the force
        would have no potential.
        """
        (first, along), (second, aside) = depth_of(one.interaction), depth_of(other.interaction)
        if min(first, second) <= 0:
            return 0.0, None
        inside = self._along_normal(one, along) and self._along_normal(other, aside)
        return joined_depth(first, second, abs(along.dot(aside)) if inside else 1.0)

    def _inside(self, contact):
        return self._along_normal(contact, contact.interaction.geom.normal)

    def _along_normal(self, contact, direction):
        body = O.bodies[self.tool.body_of[contact.piece]]
        return abs(direction.dot(body.state.ori * body.shape.normal)) > INSIDE

    def contact_inside_tool(self):
        """Where (x, y, z in m) a particle touches a facet, inside its rim, from within the tool; None without any.

        YADE's facets have two sides. The normal of a contact points from its first body to the second.
        """
        for contact in self.possible:
            interaction, piece, _, tool_first, _ = contact
            if interaction.isReal and not inactive(contact) and self._inside(contact):
                body = O.bodies[self.tool.body_of[piece]]
                outward = body.state.ori * Vector3(*self.tool.outward(piece))
                if (interaction.geom.normal.dot(outward) > 0) != tool_first:
                    return "({:.4g}, {:.4g}, {:.4g}) m".format(*interaction.geom.contactPoint)
        return None

    def _cancel(self, contact):
        """Take the contact's force off the particle in this step, and its friction off YADE's sum of plastic
        dissipation."""
        interaction, _, rock, tool_first, where = contact
        slip = compiled.tool_slip(MEMORY, WORDS, self.layout, self.body_list, self.motion.tables, self.since, where,
                                  self.before[self.possible.index(contact)], O.dt)
        counted = slip * interaction.phys.shearForce.norm()
        self.functor.initPlasticDissipation(self.functor.plasticDissipation() - counted)
        force = interaction.phys.normalForce + interaction.phys.shearForce
        force = -force if tool_first else force
        O.forces.addF(rock, force)
        O.forces.addT(rock, (interaction.geom.contactPoint - O.bodies[rock].state.pos).cross(force))

    def _join(self, one, other, acting):
        """Put the force of the joined depth of two contacts in place of that of the contact that acts in this step."""
        depth, parts = self._joined(one, other, as_found)
        if parts is None or inactive(acting) or acting.interaction.phys.normalForce.norm() < INACTIVE_STIFFNESS:
            return
        interaction, _, rock, tool_first, where = acting
        force = (outwards(one) * (depth * parts[0]) + outwards(other) * (depth * parts[1])
                 - outwards(acting) * interaction.geom.penetrationDepth) * interaction.phys.kn
        O.forces.addF(rock, force)
        self.totals[compiled.IMPULSE:] -= np.array(force) * O.dt
        of_first, of_second = compiled.velocities(MEMORY, WORDS, self.layout, self.body_list, self.motion.tables,
                                                  self.since, where)
        self.totals[compiled.TOOL_WORK] += force.dot(Vector3(*(of_first if tool_first else of_second))) * O.dt

    def _joined_energy(self, pair, depth_of):
        """J that the joined depth of two contacts holds more than the active one of them."""
        active, (depth, parts) = pair[1] if inactive(pair[0]) else pair[0], self._joined(*pair, depth_of)
        if parts is None or inactive(active):
            return 0.0
        return 0.5 * active.interaction.phys.kn * (depth**2 - depth_of(active.interaction)[0]**2)

    def elastic_energy(self):
        return self._stored((i for body in self.tool.ids for i in O.interactions.withBody(body)), self.tool.meeting)

    def state(self):
        return {**super().state(), "in_yade_balance": self.in_yade_balance, "reshaping_energy": self.reshaping_energy,
                "reshaped": self.reshaped, "notches": np.array(self.notches, int).reshape(-1, 3)}

    def restore(self, state):
        super().restore(state)
        self.in_yade_balance, self.reshaping_energy = float(state["in_yade_balance"]), float(state["reshaping_energy"])
        self.reshaped = bool(state["reshaped"])
        self.notches = [tuple(row) for row in state["notches"].tolist()]


def pieces(contact):
    """(facet, particle) of a contact."""
    return contact[1:3]


def inactive(contact):
    """Whether the contact counts for nothing."""
    return contact[0].phys.kn < INACTIVE_STIFFNESS


def activate(contact):
    """Let an inactive contact act from the next step on."""
    if inactive(contact):
        phys = contact.interaction.phys
        phys.kn, phys.ks, phys.cn = phys.kn / INACTIVE, phys.ks / INACTIVE, phys.cn / INACTIVE


def deactivate(contact):
    """Make a contact inactive and free of force."""
    phys = contact.interaction.phys
    phys.kn, phys.ks, phys.cn = phys.kn * INACTIVE, phys.ks * INACTIVE, phys.cn * INACTIVE
    phys.normalForce = phys.shearForce = phys.normalViscous = Vector3.Zero


def transfer(old, new):
    """Transfer the shear force of contact `old`, which becomes inactive, to its successor."""
    shear = Vector3(old.interaction.phys.shearForce)
    size, normal = shear.norm(), new.interaction.geom.normal
    deactivate(old)
    activate(new)
    rotated = shear - normal * shear.dot(normal)
    if size > 0 and rotated.norm() > 0:
        if old.tool_first != new.tool_first:
            rotated = -rotated
        new.interaction.phys.shearForce = rotated * (size / rotated.norm())


def outwards(contact):
    """Direction in which a contact pushes the particle, out of the tool."""
    return contact.interaction.geom.normal if contact.tool_first else -contact.interaction.geom.normal


def as_found(interaction):
    """Overlap (m) of a contact and its normal, as YADE found them in this step."""
    return interaction.geom.penetrationDepth, interaction.geom.normal

"""The window of a rock mass: moves along with the tool, holds its ends, keeps account of the rock that leaves it."""
import numpy as np
from yade import O, Quaternion, Vector3

from rockwear.engines.access import rock_states
from rockwear.engines.bond_log import INTACT
from rockwear.model.rock_mass import WHOLE
from rockwear.scenes import yade_scene

FREE = "zXY"
HELD = "xyzXYZ"
MOST_LATE = 0.75
"""Part of a slab by which the window follows late while the tool is under load."""


class FixedBoundary:
    """Particles at the ends of the window that do not move: a rigid wall, which reflects every wave."""

    def hold(self, numbers, normals, areas, distances, displacements):
        """Hold these particles (k,); all else counts for nothing here, see AbsorbingBoundary."""
        for n in numbers.tolist():
            state = O.bodies[n].state
            state.blockedDOFs, state.vel, state.angVel = HELD, Vector3.Zero, Vector3.Zero

    def release(self, numbers):
        """Hold these particles no more."""
        for n in numbers.tolist():
            O.bodies[n].state.blockedDOFs = FREE


class RockWindow:
    """Moves the window of rock by a slab whenever the tool has gone as far; its tip stays `behind` (m) from the left
    end, and up to a slab more.

    The slab behind leaves with all that it has become: chips that it broke into go wherever they are, with their
    momentum and heat. It goes in ahead as untouched rock, at rest, bonded with the rock that is there as it lies, at
    the rock's first temperature. Chips that lie where it goes in leave too (`cleared` counts their particles), and
    bonds across a crack that has reached the end are not made (`missed`).
    This happens between two steps, and balances count it as no change.

    rock: model.rock_mass.RockMass; record: scenes.cut_record.CutRecord of what leaves; sides: whether the ends are held
    too, and not the bottom alone.
    """

    def __init__(self, *, rock, behind, record, sides=True):
        self.rock, self.behind, self.record, self.sides = rock, behind, record, sides
        self.held, self.cleared, self.missed = np.zeros(0, int), 0, 0

    def begin(self, scene, boundary):
        """The scene has been built: hold the ends."""
        self.scene, self.boundary = scene, boundary
        self._hold_bottom(np.flatnonzero(self.rock.anchored & ~self.rock.absent))
        self._hold_sides()
        for n in np.flatnonzero(self.rock.absent).tolist():
            O.bodies[n].state.blockedDOFs = HELD

    def follow(self, distance, under_load=False):
        """Bring the window along to where the tool has gone so far (m).

        Under load it waits, for part of a slab at most: rock that comes in, at rest, beside rock that is pressed
        together would be torn off when the load falls.
        """
        late = MOST_LATE if under_load else 0.0
        while distance >= self.rock.begin + (1.0 + late) * self.rock.slab_length:
            self.advance(distance)

    def whole_record(self, distance, behind):
        """(groove, chips) rows of all the rock further back than x = `behind` (m)."""
        return self.record.whole(positions=rock_states(self.rock)[:, :2], distance=distance, behind=behind,
                                 intact=self.scene.bonds.status == INTACT)

    def advance(self, distance=0.0):
        """Move on by a slab; distance: m that the tool has gone."""
        scene, rock, bonds = self.scene, self.rock, self.scene.bonds
        scene.close_books()
        positions = rock_states(rock)[:, :2]
        self.record.book(positions=positions, intact=bonds.status == INTACT, distance=distance)
        if self.sides:
            self.boundary.release(self.held)
        moved = rock.advance()
        displacement, made, in_the_way = rock.fit(moved, positions)
        bottom = moved[rock.anchored[moved]]
        self.boundary.release(bottom)
        self._put(moved, rock.places[moved] + displacement, FREE)
        self._put(in_the_way, rock.places[in_the_way], HELD)
        # YADE's loop would find contacts of supports anew, as of rock.
        O.interactions.eraseNonReal()
        left = np.isin(rock.pairs, [*moved, *in_the_way]).any(axis=1)
        made = np.flatnonzero(made)
        self.cleared += len(in_the_way)
        self.missed += int(np.sum(left & rock.bonded)) - len(made)
        scene.skip(yade_scene.bond_again(rock, made))
        bonds.renew(np.flatnonzero(left), made)
        self._hold_bottom(bottom)
        self._hold_sides()
        scene.open_books(moved)

    def _put(self, numbers, places, blocked):
        for n, (x, y) in zip(numbers.tolist(), places.tolist()):
            for interaction in O.interactions.withBody(n):
                O.interactions.erase(interaction.id1, interaction.id2)
            state = O.bodies[n].state
            state.blockedDOFs = blocked
            state.pos, state.ori = Vector3(x, y, 0.0), Quaternion((0, 0, 1), 0.0)
            state.vel = state.angVel = Vector3.Zero

    def _hold_bottom(self, numbers):
        self._hold(numbers, (0.0, -1.0), self.rock.width, self.rock.height,
                   np.flatnonzero(self.rock.anchored))

    def _hold_sides(self):
        if not self.sides:
            return
        rock = self.rock
        left, right = (part[~rock.anchored[part]] for part in rock.at_ends())
        y = rock_states(rock)[left, 1]
        # What is above the groove may be chips.
        left = left[y < rock.height - 2 * self.scene.depth_of_cut]
        # In a low window there may be none.
        if len(left):
            self._hold(left, (-1.0, 0.0), float(rock.positions[left, 1].max()), self.behind, left)
        self._hold(right, (1.0, 0.0), rock.height, rock.width - self.behind, right)
        self.held = np.concatenate([left, right])

    def _hold(self, numbers, normal, length, distance, face):
        """Hold particles of a face (its particles: `face`) of this length (m), so far (m) from the load."""
        radii = self.rock.radii
        areas = length * radii[numbers] / radii[face].sum()
        count = len(numbers)
        # Springs are at rest in untouched rock, unless a crack has moved it.
        moved = (rock_states(self.rock)[:, :2] - self.rock.places)[numbers]
        moved[np.linalg.norm(moved, axis=1) > WHOLE * radii[numbers]] = 0.0
        self.boundary.hold(numbers, np.tile(normal, (count, 1)), areas, np.full(count, distance), moved)

    def state(self):
        """What a restart needs."""
        return {"rock": self.rock.state(), "record": self.record.state(), "held": self.held.copy(),
                "cleared": self.cleared, "missed": self.missed}

    def restore(self, state, scene, boundary):
        """Take back what `state` gave."""
        self.scene, self.boundary = scene, boundary
        self.rock.restore(state["rock"])
        self.record.restore(state["record"])
        self.held = state["held"].astype(int)
        self.cleared, self.missed = int(state["cleared"]), int(state["missed"])

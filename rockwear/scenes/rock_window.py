"""The window of a rock mass: moves along with the tool, holds its ends, keeps account of the rock that leaves it."""
import numpy as np
from yade import O, Quaternion, Vector3

from rockwear.engines.access import rock_states
from rockwear.scenes import yade_scene

FREE = "zXY"
HELD = "xyzXYZ"


class FixedBoundary:
    """Particles at the ends of the window that do not move: a rigid wall, which reflects every wave."""

    def hold(self, numbers, normals, areas, distances):
        """Hold these particles (k,); normals (k, 2), areas (k,) m2 and distances (k,) m of the load count for nothing
        here."""
        for n in numbers.tolist():
            state = O.bodies[n].state
            state.blockedDOFs, state.vel, state.angVel = HELD, Vector3.Zero, Vector3.Zero

    def let_go(self, numbers):
        """Hold these particles no more."""
        for n in numbers.tolist():
            O.bodies[n].state.blockedDOFs = FREE


class RockWindow:
    """Moves the window of a model.rock_mass.RockMass by a slab whenever the tool is `behind` (m) further than its left
    end and a slab.

    The slab behind leaves with all that it has become: chips that it broke into go wherever they are, with their
    momentum and heat. It goes in ahead as untouched rock, at rest, bonded with the rock that is there as it lies, at
    the rock's first temperature. Chips that lie where it goes in leave too (`cleared` counts their particles), and
    bonds across a crack that has reached the end are not made (`missed`). This happens between two steps, and balances count it as no change. `groove` and
    `chips` are the record of what has left; see `_book`.
    """

    def __init__(self, *, rock, behind, sides=True):
        self.rock, self.behind, self.sides = rock, behind, sides
        self.held, self.cleared, self.missed = np.zeros(0, int), 0, 0

    def begin(self, scene, boundary):
        """The scene has been built: hold the ends."""
        self.scene, self.boundary = scene, boundary
        self._hold_bottom(np.flatnonzero(self.rock.anchored & ~self.rock.absent))
        self._hold_sides()
        for n in np.flatnonzero(self.rock.absent).tolist():
            O.bodies[n].state.blockedDOFs = HELD

    def follow(self, tip):
        """Bring the window along to where the tip of the tool is at x = `tip` (m)."""
        while tip - self.behind >= self.rock.begin + self.rock.slab_length:
            self._advance()

    def _advance(self):
        scene, rock, bonds = self.scene, self.rock, self.scene.bonds
        scene.close_books()
        if self.sides:
            self.boundary.let_go(self.held)
        moved = rock.advance()
        offset, made, in_the_way = rock.fit(moved, rock_states(rock)[:, :2])
        bottom = moved[rock.anchored[moved]]
        self.boundary.let_go(bottom)
        self._put(moved, rock.places[moved] + offset, FREE)
        self._put(in_the_way, rock.places[in_the_way], HELD)
        left = np.isin(rock.pairs, [*moved, *in_the_way]).any(axis=1)
        made = np.flatnonzero(made)
        self.cleared += len(in_the_way)
        self.missed += int(np.sum(left & rock.bonded)) - len(made)
        yade_scene.bond_again(rock, made)
        scene.skip_step()
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
        self._hold(left, (-1.0, 0.0), float(rock.positions[left, 1].max()), self.behind, left)
        self._hold(right, (1.0, 0.0), rock.height, rock.width - self.behind, right)
        self.held = np.concatenate([left, right])

    def _hold(self, numbers, normal, length, distance, face):
        """Hold particles of a face (its particles: `face`) of this length (m), so far (m) from the load."""
        radii = self.rock.radii
        areas = length * radii[numbers] / radii[face].sum()
        count = len(numbers)
        self.boundary.hold(numbers, np.tile(normal, (count, 1)), areas, np.full(count, distance))

    def state(self):
        """What a restart needs."""
        return {"rock": self.rock.state(), "held": self.held.copy(), "cleared": self.cleared,
                "missed": self.missed}

    def restore(self, state, scene, boundary):
        """Take back what `state` gave."""
        self.scene, self.boundary = scene, boundary
        self.rock.restore(state["rock"])
        self.held = state["held"].astype(int)
        self.cleared, self.missed = int(state["cleared"]), int(state["missed"])

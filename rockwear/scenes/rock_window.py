"""The window of a rock mass: moves along with the tool, holds its ends, keeps account of the rock that leaves it."""
import numpy as np
from yade import O, Quaternion, Vector3

from rockwear.engines.access import FIXED, IN_PLANE, rock_positions
from rockwear.engines.bond_log import INTACT
from rockwear.model.rock_mass import WHOLE
from rockwear.scenes import yade_scene

MOST_LATE = 2.0
"""Slabs by which the window follows late while rock that entered would not fit."""
MOST_MISSED = 0.005
"""Part of all bonds of rock that entered that may be missing without a warning; bonds with rock that was there are a
sixth of them."""
NEAR_BOTTOM, MOST_NEAR_BOTTOM = 0.1, 0.02
"""Part of the window's height, and part of all cracks that may lie there without a warning."""


class FixedBoundary:
    """Particles at the ends of the window that do not move: a rigid wall, which reflects every wave."""

    def hold(self, numbers, normals, areas, distances, displacements):
        """Hold these particles (k,); all else counts for nothing here, see AbsorbingBoundary."""
        for n in numbers.tolist():
            state = O.bodies[n].state
            state.blockedDOFs, state.vel, state.angVel = FIXED, Vector3.Zero, Vector3.Zero

    def release(self, numbers):
        """Hold these particles no more."""
        for n in numbers.tolist():
            O.bodies[n].state.blockedDOFs = IN_PLANE


class RockWindow:
    """Moves the window of rock by a slab whenever the tool has gone as far; its tip stays `behind` (m) from the end
    behind it, and up to a slab more. Lengths are those of the rock's strip, straight or along an arc.

    The slab behind leaves with all that it has become: chips that it broke into go wherever they are, with their
    momentum and heat. It goes in ahead as untouched rock, at rest, at the rock's first temperature, displaced as the
    rock that is there; its bonds have the lengths of untouched rock, so that no stress is left when the load falls.
    Chips that lie where it goes in are removed, as free ones are where they are to (`cleared` counts the particles of
    both), and bonds across what has moved apart there are not made (`missed`, of all `entered`).
    This happens between two steps, and balances count it as no change.

    rock: model.rock_mass.RockMass; held_below: m, height up to which the end behind is held: what is above may be
    chips; sides: whether the ends are held too, and not the bottom alone; record: scenes.cut_record.CutRecord of what
    leaves, if any.
    """

    def __init__(self, *, rock, behind, held_below, sides=True, record=None):
        self.rock, self.behind, self.held_below, self.sides, self.record = rock, behind, held_below, sides, record
        self.held, self.cleared, self.missed, self.entered = np.zeros(0, int), 0, 0, 0

    def attach(self, scene):
        """The scene has been built or loaded."""
        self.scene, self.boundary = scene, scene.boundary or FixedBoundary()

    def begin(self, scene):
        """The scene has been built: hold the ends."""
        self.attach(scene)
        self._hold_bottom(np.flatnonzero(self.rock.anchored & ~self.rock.absent))
        self._hold_sides()
        for n in np.flatnonzero(self.rock.absent).tolist():
            O.bodies[n].state.blockedDOFs = FIXED

    def distance(self, place):
        """m that a tool whose tip is at `place` (2,) m has gone."""
        return float(self.rock.strip.unroll(np.array([place]))[0, 0]) - self.behind

    def most_steps(self, way):
        """Steps, of `way` (m) each, in which the tool goes no further than the window may be late."""
        return max(1, int(MOST_LATE * self.rock.slab_length / way))

    def follow(self, distance):
        """Bring the window along to where the tool has gone so far (m).

        It waits, for some slabs at most, until the rock ahead would fit: right after a blow, and under heavy load, what
        enters would not.
        """
        slab = self.rock.slab_length
        while distance >= self.rock.begin + slab:
            if distance < self.rock.begin + (1.0 + MOST_LATE) * slab and not self._fits():
                break
            self.advance(distance)

    def _fits(self):
        rock = self.rock
        return rock.misfit(rock_positions(rock), self.scene.bonds.status == INTACT) <= 1.0

    def advance(self, distance=0.0):
        """Move on by a slab; distance: m that the tool has gone."""
        scene, rock, bonds = self.scene, self.rock, self.scene.bonds
        scene.close_balances()
        positions, intact = rock_positions(rock), bonds.status == INTACT
        if self.record:
            self.record.note(positions=positions, intact=intact, distance=distance)
        if self.sides:
            self.boundary.release(self.held)
        moved = rock.advance()
        displacement, made, longer, in_the_way = rock.fit(moved, positions, intact)
        if scene.expansion:
            scene.expansion.renew(moved)
        bottom = moved[rock.anchored[moved]]
        self.boundary.release(np.concatenate([bottom, in_the_way]))
        there = ~rock.absent[moved]
        self._put(moved[there], (rock.places[moved] + displacement)[there], IN_PLANE)
        self._put_aside(np.concatenate([moved[~there], in_the_way]))
        # YADE's loop would find contacts of supports anew, as of rock.
        O.interactions.eraseNonReal()
        left = np.isin(rock.pairs, [*moved, *in_the_way]).any(axis=1)
        made = np.flatnonzero(made)
        self.cleared += len(in_the_way)
        entered = int(np.sum(left & rock.bonded))
        self.entered, self.missed = self.entered + entered, self.missed + entered - len(made)
        before = O.iter
        with yade_scene.standing_still():
            yade_scene.bond_again(rock, made)
            bonds.renew(np.flatnonzero(left), made, longer[made])
            O.step()
        scene.skip(O.iter - before)
        self._hold_bottom(bottom)
        self._hold_sides()
        scene.open_balances(moved)

    def remove_free_chips(self, distance):
        """Remove the chips that nothing touches: neither rock, nor another chip, nor the tool, nor what holds the
        window. Their heat goes with them; balances count it as no change. distance: m that the tool has gone."""
        scene, rock, bonds = self.scene, self.rock, self.scene.bonds
        touched = [contact.rock for contact in scene.tool.contact.possible if contact.interaction.isReal]
        gone = self.record.record_free_chips(
            positions=rock_positions(rock), intact=bonds.status == INTACT, distance=distance,
            pairs=np.concatenate([rock.pairs[bonds.in_contact()], scene.rock_friction.touching_pairs()]),
            held=np.concatenate([self.held, touched]).astype(int))
        if not len(gone):
            return
        scene.close_balances()
        rock.absent[gone] = True
        self._put_aside(gone)
        O.interactions.eraseNonReal()
        left = np.isin(rock.pairs, gone).any(axis=1)
        bonds.renew(np.flatnonzero(left), np.zeros(0, int), np.zeros(0))
        self.cleared += len(gone)
        scene.open_balances(gone)

    def _put_aside(self, numbers):
        self._put(numbers, self.rock.places[numbers], FIXED)

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
        y = rock.strip.unroll(rock_positions(rock)[left])[:, 1]
        left = left[y < self.held_below]
        # In a low window there may be none.
        if len(left):
            self._hold(left, (-1.0, 0.0), float(rock.positions[left, 1].max()), self.behind, left)
        self._hold(right, (1.0, 0.0), rock.top(rock.end), rock.width - self.behind, right)
        self.held = np.concatenate([left, right])

    def _hold(self, numbers, normal, length, distance, face):
        """Hold particles of a face (its particles: `face`) of this length (m), so far (m) from the load."""
        rock, radii = self.rock, self.rock.radii
        areas = length * radii[numbers] / (radii / rock.stretch)[face].sum()
        count = len(numbers)
        # Springs are at rest in untouched rock, unless a crack has moved it.
        places = rock.places
        moved = (rock_positions(rock) - places)[numbers]
        moved[np.linalg.norm(moved, axis=1) > WHOLE * rock.height] = 0.0
        normals = rock.strip.turned(np.tile(normal, (count, 1)), rock.strip.unroll(places[numbers]))
        self.boundary.hold(numbers, normals, areas, np.full(count, distance), moved)

    def results(self):
        """{name: (value, unit)}."""
        return {"window_passed": (self.rock.begin, "m"), "chip_particles_cleared": (self.cleared, "-"),
                "bonds_missed_ahead": (self.missed, "-")}

    def warnings(self, cracks):
        """Lines on cracks (of engines.bond_log) that reached the bottom, and on bonds that rock entered without."""
        heights = self.rock.strip.unroll(np.array([(crack.x, crack.y) for crack in cracks]).reshape(-1, 2))[:, 1]
        deep, found = int(np.sum(heights < NEAR_BOTTOM * self.rock.height)), []
        if deep > MOST_NEAR_BOTTOM * len(cracks):
            found.append(f"{deep} of {len(cracks)} cracks lie in the lowest {100 * NEAR_BOTTOM:g} % of the window, "
                         "where its bottom rules what they do; a higher window tells how much")
        if self.missed > MOST_MISSED * self.entered:
            found.append(f"{self.missed} of {self.entered} bonds of rock that entered the window were not made, where "
                         "cracks or blows had moved its end apart: a larger window_ahead tells how much it matters")
        return found

    def state(self):
        """What a restart needs."""
        return {"rock": self.rock.state(), "held": self.held.copy(), "cleared": self.cleared, "missed": self.missed,
                "entered": self.entered}

    def restore(self, state, scene):
        """Take back what `state` gave."""
        self.attach(scene)
        self._restore_place(state)
        self.cleared, self.missed, self.entered = (int(state[name]) for name in ("cleared", "missed", "entered"))

    def _restore_place(self, state):
        self.rock.restore(state["rock"])
        self.held = state["held"].astype(int)

    def kept(self):
        """What `put_back` needs."""
        return {**self.state(), "boundary": self.scene.boundary.state() if self.scene.boundary else {}}

    def put_back(self, kept):
        """The rock in YADE is again what it was when `kept` was taken; what is counted goes on."""
        self._restore_place(kept)
        if self.scene.boundary:
            self.scene.boundary.put_back(kept["boundary"])

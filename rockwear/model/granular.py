"""Loose spheres and the walls around them: a box that is drained for its heap, a box with a horizontal tube."""
import math
from dataclasses import dataclass

import numpy as np

from rockwear.kernels.checks import require

SPACING, JITTER = 2.3, 0.14
"""Of the grid on which spheres stand before they settle, and how far they are off it, in largest radii."""


@dataclass(frozen=True)
class Grains:
    """Loose spheres. positions: (n, 3) m; radii: (n,) m; density: kg/m3 of the grains themselves."""

    positions: np.ndarray
    radii: np.ndarray
    density: float

    @property
    def count(self):
        """Number of spheres."""
        return len(self.radii)

    @property
    def masses(self):
        """(n,) kg."""
        return self.density * 4 / 3 * math.pi * self.radii**3

    @property
    def inertias(self):
        """(n,) kg m2."""
        return 0.4 * self.masses * self.radii**2


def poured(*, low, high, count, radius_min, radius_max, density, seed, floor=0.0):
    """Grains that do not touch, layer by layer from the floor of a box upwards, to settle under gravity.

    low, high: (x, z) m, corners of the box; floor: m, its height; count: spheres; radii (m) are uniform between the
    two; seed: of radii and places. Raises ParameterError where not even one sphere fits between the walls.
    """
    room = np.subtract(high, low) - 2 * radius_max
    require(room.min() >= 0, "radius_max", radius_max,
            f"at most {0.5 * min(np.subtract(high, low)):g}, for a sphere to fit between the walls", "m")
    columns = [max(1, int(width / (SPACING * radius_max)) + 1) for width in room]
    rng = np.random.default_rng([seed, count])
    k = np.arange(count)
    layer, place = np.divmod(k, columns[0] * columns[1])
    across = np.column_stack(np.divmod(place, columns[1]))
    # A single column stands in the middle.
    x, z = (start + radius_max + width * (index / (n - 1) if n > 1 else 0.5 + 0.0 * index)
            for start, width, n, index in zip(low, room, columns, across.T))
    off = JITTER * radius_max * rng.uniform(-1, 1, (count, 3))
    places = np.column_stack([x, floor + radius_max * (1 + JITTER + SPACING * layer), z]) + off
    places[:, 0] = np.clip(places[:, 0], low[0] + radius_max, high[0] - radius_max)
    places[:, 2] = np.clip(places[:, 2], low[1] + radius_max, high[1] - radius_max)
    return Grains(positions=places, radii=rng.uniform(radius_min, radius_max, count), density=density)


def rectangle(corner, first, second):
    """(2, 3, 3) m: two triangles of the rectangle from a corner along two edges, (3,) m each."""
    a, b, c = np.asarray(corner, float), np.asarray(first, float), np.asarray(second, float)
    return np.array([(a, a + b, a + b + c), (a, a + b + c, a + c)])


class DrainedBox:
    """A box over a plate with an opening on either side, which gates close at first.

    half_length: m, of the plate, |x| below it; opening: m, of each gap beside it; depth: m between the two walls, z;
    height: m of the walls. walls, gates: (k, 3, 3) m, triangles that stay, and those that go.
    """

    def __init__(self, *, half_length, opening, depth, height):
        self.half_length, self.opening, self.depth, self.height = half_length, opening, depth, height
        end, low, z = half_length + opening, -opening, 0.5 * depth
        across, plate = (0, 0, depth), (2 * half_length, 0, 0)
        self.walls = np.concatenate([
            rectangle((-half_length, 0, -z), plate, across),
            *(rectangle((side * end, low, -z), (0, height - low, 0), across) for side in (-1, 1)),
            *(rectangle((-end, low, side), (2 * end, 0, 0), (0, height - low, 0)) for side in (-z, z))])
        self.gates = np.concatenate([rectangle((-end, 0, -z), (opening, 0, 0), across),
                                     rectangle((half_length, 0, -z), (opening, 0, 0), across)])

    def rough_plate(self, diameter):
        """(n, 3) m: grains of a diameter (m) side by side, half sunk into the plate."""
        columns, rows = (max(1, int(size / diameter * (1 + 1e-9))) for size in (2 * self.half_length, self.depth))
        x, z = np.meshgrid(self.half_length * ((2 * np.arange(columns) + 1) / columns - 1),
                           0.5 * self.depth * ((2 * np.arange(rows) + 1) / rows - 1), indexing="ij")
        return np.column_stack([x.ravel(), np.zeros(x.size), z.ravel()])

    @property
    def inside(self):
        """((x, z), (x, z)) m: corners of the room for the fill."""
        end = self.half_length + self.opening
        return (-end, -0.5 * self.depth), (end, 0.5 * self.depth)


class TubeBox:
    """A box of sand, from whose right side (x = 0) a round horizontal tube leads, closed at its end.

    width, depth, height: m of the box, along x, z and y; diameter, length: m of the tube; axis: m, height of its axis
    over the floor; sides: of the polygon that stands for its circle, which lies around it. walls: (k, 3, 3) m.
    """

    def __init__(self, *, width, depth, height, diameter, length, axis, sides=16):
        self.width, self.depth, self.height = width, depth, height
        self.diameter, self.length, self.axis = diameter, length, axis
        z = 0.5 * depth
        floor_and_sides = [
            rectangle((-width, 0, -z), (width, 0, 0), (0, 0, depth)),
            rectangle((-width, 0, -z), (0, height, 0), (0, 0, depth)),
            *(rectangle((-width, 0, side), (width, 0, 0), (0, height, 0)) for side in (-z, z))]
        angles = 2 * math.pi * (np.arange(sides) + 0.5) / sides
        rim = 0.5 * diameter / math.cos(math.pi / sides) * np.column_stack([np.sin(angles), np.cos(angles)])
        self.ring = np.column_stack([np.zeros(sides), axis + rim[:, 0], rim[:, 1]])
        self.walls = np.concatenate([*floor_and_sides, self._mouth(), self._tube()])

    def _tube(self):
        """The tube's wall and its end."""
        along, following = np.array([self.length, 0, 0]), np.roll(self.ring, -1, axis=0)
        end = np.array([self.length, self.axis, 0.0])
        staves = [(a, b, b + along) for a, b in zip(self.ring, following)]
        staves += [(a, b + along, a + along) for a, b in zip(self.ring, following)]
        return np.array(staves + [(end, a + along, b + along) for a, b in zip(self.ring, following)])

    def _mouth(self):
        """The box's side around the mouth: a fan to each of the side's four corners, and between the fans."""
        corners = np.array([(0, self.height, 0.5 * self.depth), (0, self.height, -0.5 * self.depth),
                            (0, 0, -0.5 * self.depth), (0, 0, 0.5 * self.depth)])
        angle = np.arctan2(self.ring[:, 1] - self.axis, self.ring[:, 2])
        # A point of the ring sees the corner of its own quadrant.
        quadrant = np.floor(np.mod(angle, 2 * math.pi) / (0.5 * math.pi)).astype(int) % 4
        found = []
        for k, (point, own) in enumerate(zip(self.ring, quadrant)):
            after = (k + 1) % len(self.ring)
            found.append((corners[own], point, self.ring[after]))
            if quadrant[after] != own:
                found.append((corners[own], self.ring[after], corners[quadrant[after]]))
        return np.array(found)

    @property
    def inside(self):
        """((x, z), (x, z)) m: corners of the room for the fill."""
        return (-self.width, -0.5 * self.depth), (0.0, 0.5 * self.depth)

    @property
    def tube_volume(self):
        """m3 of the tube."""
        return 0.25 * math.pi * self.diameter**2 * self.length

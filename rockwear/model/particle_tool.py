"""The tool: a parametric or given outline filled with particles, rigid, with a surface that meets the rock."""
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels import polygon as outline, packing
from rockwear.kernels.voronoi import cells
from rockwear.kernels.checks import positive, require
from rockwear.kernels.conduction import calibrated_conductance
from rockwear.kernels.erosion import Erosion
from rockwear.model.cache import cached

POROSITY = 0.13
"""Of the packing that fills the outline (P 5.2). Its mass and volume are those of the outline."""
NEIGHBOUR_GAP = 0.2
"""Particles whose gap is below this part of the mean radius are joined by a bar, where bars conduct."""
NEAREST = 3
"""So many nearest particles are joined in any case: what rattles in its cage is not insulated."""


def neighbours(positions, radii):
    """Pairs (m, 2), i < j, of particles that bars join."""
    near = packing.contacts(positions, radii, NEIGHBOUR_GAP * float(radii.mean()))
    closest = cKDTree(positions).query(positions, NEAREST + 1)[1][:, 1:]
    own = np.repeat(np.arange(len(radii)), NEAREST)
    return np.unique(np.sort(np.vstack([near, np.column_stack([own, closest.ravel()])]), axis=1), axis=0)


class ParticleTool:
    """What all tools of particles have: positions (n, 2 or 3) m, radii (n,) m, and their erosion (kernels.erosion)."""

    def foremost(self, below):
        """Largest x reached by particles with any part below the height `below` (both m, in the tool's own frame), as long
        as they are not worn away; -inf for none."""
        low = (self.positions[:, 1] - self.radii < below) & self.erosion.alive
        return float((self.positions[low, 0] + self.radii[low]).max(initial=-np.inf))


class Tool(ParticleTool):
    """Particles that fill an outline (k, 2) m, each standing for its part of the outline's area times 1 m.

    radius_min, radius_max: m; removal: "volume" or "depth" (kernels.erosion); conductivity: W/m K; density: kg/m3,
    specific_heat: J/kg K. `fixed` marks particles at the top and the back, where the shank holds the tool: they are
    no surface. Everything else whose cell reaches the outline is surface, and a particle that goes uncovers those whose cells
    have a face with its own: by their gaps some across a pore would stay out of contact, and rock would come to lie in them.
    """

    def __init__(self, *, vertices, radius_min, radius_max, seed, removal, material):
        positive("tool_radius_min", radius_min, "m")
        self.vertices = np.asarray(vertices, float)
        self.area = outline.area(self.vertices)
        stored = cached(lambda: self._fill(radius_min, radius_max, seed, material.conductivity),
                        polygon=self.vertices.tolist(), radius_min=radius_min, radius_max=radius_max, seed=seed,
                        porosity=POROSITY, gap=NEIGHBOUR_GAP, nearest=NEAREST, conductivity=material.conductivity)
        self.positions, self.radii, self.pairs = stored["positions"], stored["radii"], stored["pairs"]
        self.conductance = float(stored["conductance"])
        self.count = len(self.radii)
        self.volumes = self.area * self.radii**2 / np.sum(self.radii**2)
        self.material = material
        self.fixed = self._fixed()
        surface = np.flatnonzero(self.cells.at_walls & ~self.fixed)
        self.erosion = Erosion(radii=self.radii, volumes=self.volumes, pairs=self.cells.edges, surface=surface,
                               fixed=np.flatnonzero(self.fixed), rule=removal)

    def _fill(self, radius_min, radius_max, seed, conductivity):
        filled = packing.pack(polygon=self.vertices, radius_min=radius_min, radius_max=radius_max, porosity=POROSITY,
                              seed=seed)
        # One conductance for every pair, fitted on a square of the same packing: the outline itself may be any shape.
        side = 50 * radius_max
        square = packing.pack(box=(side, side), radius_min=radius_min, radius_max=radius_max, porosity=POROSITY, seed=seed)
        fitted = calibrated_conductance(positions=square.positions, conductivity=conductivity, conductance=1.0,
                                        edges=neighbours(square.positions, square.radii))
        return {"positions": filled.positions, "radii": filled.radii, "conductance": fitted[0],
                "pairs": neighbours(filled.positions, filled.radii)}

    def _fixed(self):
        x, y = self.positions.T
        top, back = self.vertices[:, 1].max(), self.vertices[:, 0].min()
        return (y > top - 1.5 * self.radii) | (x < back + 1.5 * self.radii)

    @cached_property
    def cells(self):
        """kernels.cells.Cells: the part of the outline that each particle stands for."""
        return cells(self.positions, polygon=self.vertices)

    @property
    def density(self):
        """kg/m3 of the outline's area; particles carry it through their share of that area."""
        return self.material.density

    @property
    def masses(self):
        """(m,) kg, the mass each particle stands for; they add up to the outline's."""
        return self.material.density * self.volumes


class LayeredTool(ParticleTool):
    """Spheres of one radius (m) that fill an outline (k, 2) m drawn out across the cut.

    They lie in equal layers a diameter apart, about z = 0: each is the same packing of the outline, whose outermost
    particles touch its sides. So the faces are as smooth as spheres can make them. Layers fill `breadth` (m) but for
    less than a diameter. Every sphere stands for the same part of the tool's volume. `fixed` marks those at the top,
    where the shank holds the tool; everything else at the boundary is surface. removal: of kernels.erosion.
    """

    def __init__(self, *, vertices, radius, breadth, seed, removal, density):
        positive("tool_radius", radius, "m")
        self.vertices, self.density = np.asarray(vertices, float), density
        layers = int(positive("breadth", breadth, "m") / (2 * radius) + 1e-9)
        require(layers > 1, "breadth", breadth, f"at least two particles, {4 * radius:g}", "m")
        stored = cached(lambda: self._fill(radius, seed), section=self.vertices.tolist(), radius=radius, seed=seed,
                        porosity=POROSITY)
        self.breadth = 2 * radius * layers
        self._stack(stored["positions"], layers, float(stored["radii"][0]))
        self.area = outline.area(self.vertices) * self.breadth
        self.volumes = np.full(self.count, self.area / self.count)
        self.masses = density * self.volumes
        number, one = np.arange(self.count), len(stored["radii"])
        section = cells(stored["positions"], polygon=self.vertices)
        pairs = np.vstack([*(section.edges + one * layer for layer in range(layers)),
                           np.column_stack([number[:-one], number[one:]])])
        self.fixed = self.positions[:, 1] > self.vertices[:, 1].max() - 1.5 * self.radii
        outermost = (number < one) | (number >= self.count - one) | np.tile(section.at_walls, layers)
        self.erosion = Erosion(radii=self.radii, volumes=self.volumes, pairs=pairs, thickness=2 * self.radii,
                               surface=np.flatnonzero(outermost & ~self.fixed), fixed=np.flatnonzero(self.fixed),
                               rule=removal)

    def _fill(self, radius, seed):
        filled = packing.pack(polygon=self.vertices, radius_min=radius, radius_max=radius, porosity=POROSITY, seed=seed)
        return {"positions": filled.positions, "radii": filled.radii}

    def _stack(self, places, layers, radius):
        z = 2 * radius * (np.arange(layers) - 0.5 * (layers - 1))
        self.positions = np.column_stack([np.tile(places, (layers, 1)), np.repeat(z, len(places))])
        self.count = len(self.positions)
        # YADE's collider finds particles with equal coordinates in one order as a run goes on, in another in a resumed one.
        self.positions += 1e-6 * radius * np.random.default_rng(0).uniform(-1, 1, self.positions.shape)
        self.radii = np.full(self.count, radius)

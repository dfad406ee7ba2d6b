"""The tool as a body that stores and conducts heat: its thermal nodes, and how its particles or facets belong to them.

In the plane areas are lengths and volumes are areas, per metre of thickness.
"""
from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels.boundary import area_vectors, distance
from rockwear.kernels.checks import positive, require
from rockwear.kernels.free_surface import free_surface
from rockwear.kernels.surface_recession import outside
from rockwear.kernels.voronoi import cells, layered


class ThermalBody(ABC):
    """Nodes of a tool's heat. A piece is what meets the rock: a particle or a facet.

    positions (n, 2 or 3) m in the tool's frame; volumes (n,) m3 by the particles' sizes; fixed (n,) bool: held by the
    shank. `cells` gives their Voronoi cells.
    """

    def __init__(self, *, positions, volumes, fixed):
        self.positions, self.volumes, self.fixed = positions, volumes, fixed

    @property
    def count(self):
        """Number of nodes, n."""
        return len(self.positions)

    @property
    @abstractmethod
    def cells(self):
        """kernels.voronoi.Cells: the part of the tool that each node represents."""

    @property
    @abstractmethod
    def alive(self):
        """(n,) bool: the nodes that the tool still has."""

    @property
    @abstractmethod
    def node_of(self):
        """(pieces,) int: the node of each piece."""

    @property
    @abstractmethod
    def contact_areas(self):
        """(pieces,) m2 through which a piece exchanges heat with a rock particle at most."""

    @abstractmethod
    def exposed(self, touched):
        """(n,) m2 of free surface now; touched: (pieces,) bool, pieces in contact with rock, which are not free."""

    def capacities(self, material, model):
        """(n,) J/K of a model.materials.Material: of the Voronoi cells if these conduct, else of the particles' own
        volumes as in the sources. model: of kernels.conduction.PATHS."""
        volumes = self.cells.volumes if model == "voronoi" else self.volumes
        return material.density * volumes * material.specific_heat

    def paths(self, model, conductivity):
        """Pairs (m, 2) of nodes that exchange heat and their conductances (m,) W/K; conductivity: W/(m K).

        Raises ParameterError for another model than "voronoi" here, and for a conductivity of 0.
        """
        require(model == "voronoi", "bond_conductance", model, "voronoi for a tool in space")
        return self.cells.edges, self.cells.conductance(conductivity)

    def follow(self):
        """Follow the tool's shape. -> nodes that its surface has passed since the last call, outermost first.

        Nodes that are particles are reported by the wear instead.
        """
        return []

    def renew(self):
        """The tool is whole again."""

    def state(self):
        """What must survive a restart."""
        return {}

    def restore(self, state):
        """Set what `state` gave."""


class ParticleBody(ThermalBody):
    """Thermal body of a tool of particles, which are its nodes: of a model.particle_tool.Tool or LayeredTool."""

    def __init__(self, tool):
        super().__init__(positions=tool.positions, volumes=tool.volumes, fixed=tool.fixed)
        self.tool = tool
        self._node_of = np.arange(tool.count)

    @cached_property
    def cells(self):
        tool = self.tool
        if tool.positions.shape[1] == 2:
            return tool.cells
        # Its particles are ordered by layers, one diameter deep.
        layers = round(tool.breadth / (2 * float(tool.radii[0])))
        section = cells(tool.positions[:tool.count // layers, :2], polygon=tool.vertices)
        return layered(section, layers, tool.breadth / layers)

    @property
    def alive(self):
        return self.tool.erosion.alive

    @property
    def node_of(self):
        return self._node_of

    @property
    def contact_areas(self):
        """A = 2 r b [Rojek 2014, eq. 66], b = 2 r in space."""
        return self.tool.erosion.areas

    def exposed(self, touched):
        found, alive = np.zeros(self.count), np.flatnonzero(self.alive)
        if len(alive):
            found[alive] = free_surface(positions=self.positions[alive], radii=self.tool.radii[alive])
        found[self.fixed | touched] = 0.0
        return found

    def paths(self, model, conductivity):
        in_plane = self.positions.shape[1] == 2
        return self.tool.paths(model, conductivity) if in_plane else super().paths(model, conductivity)


class FacetBody(ThermalBody):
    """Thermal body behind the facets of a tool: particles that fill its outline and serve for heat alone.

    tool: a model.facet_tool.FacetTool; fill: a model.particle_tool.Tool of the tool's outline when new. In space the
    tool is this outline drawn out across the cut by `breadth` (m), symmetric to z = 0, and the fill is repeated in
    layers, as deep as its particles are wide on average.

    The node of a facet is the living node nearest to its middle. A node dies when the receding surface has passed its
    centre (of one that lies outside of the new tool's facets, when it has gone on from there), the last one never: it
    stands for what is left of the tool. Its free surface is that of the facets which belong to it and are not fixed to
    the shank.
    """

    def __init__(self, tool, *, fill, breadth=None):
        self.boundary, self.fill = tool.boundary, fill
        self.breadth = None if breadth is None else positive("breadth", breadth, "m")
        layers = 1 if breadth is None else max(1, round(self.breadth / (2 * float(fill.radii.mean()))))
        self.layers = layers
        positions, volumes = fill.positions, fill.volumes
        if breadth is not None:
            depth = self.breadth / layers
            across = depth * (np.arange(layers) - 0.5 * (layers - 1))
            positions = np.column_stack([np.tile(positions, (layers, 1)), np.repeat(across, len(positions))])
            volumes = depth * np.tile(volumes, layers)
        super().__init__(positions=positions, volumes=volumes, fixed=np.tile(fill.fixed, layers))
        self._alive = np.ones(self.count, bool)
        shape = tool.first, tool.first_facets
        self._outside_at_first = np.where(outside(positions, *shape), distance(positions, *shape), 0.0)
        self._forget_shape()
        self.follow()

    def _forget_shape(self):
        """Look at all nodes at the next call of `follow`."""
        self._shape = None
        # m, by which the surface has at least to move to pass each node.
        self._margin = np.zeros(self.count)

    @cached_property
    def cells(self):
        section = self.fill.cells
        return section if self.breadth is None else layered(section, self.layers, self.breadth / self.layers)

    @property
    def alive(self):
        return self._alive

    @property
    def node_of(self):
        return self._node_of

    @property
    def contact_areas(self):
        return np.linalg.norm(area_vectors(self.boundary.vertices, self.boundary.facets), axis=1)

    def exposed(self, touched):
        free = ~self.boundary.fixed & ~touched
        return np.bincount(self.node_of[free], self.contact_areas[free], self.count)

    def paths(self, model, conductivity):
        return self.fill.paths(model, conductivity) if self.breadth is None else super().paths(model, conductivity)

    def follow(self):
        vertices, facets = self.boundary.vertices, self.boundary.facets
        if self._shape:
            if all(map(np.array_equal, self._shape, (vertices, facets))):
                return []
            self._margin -= _motion(*self._shape, vertices, facets) * (1 + 1e-9)
        self._shape = vertices.copy(), facets.copy()
        near = np.flatnonzero(self._alive & (self._margin <= 0))
        away, first = distance(self.positions[near], vertices, facets), self._outside_at_first[near]
        gone = outside(self.positions[near], vertices, facets) & (away > first * (1 + 1e-9))
        self._margin[near] = np.where(first > 0, 0.0, away)
        passed = near[gone][np.argsort(-away[gone], kind="stable")][:self._alive.sum() - 1]
        self._alive[passed] = False
        living = np.flatnonzero(self._alive)
        self._node_of = living[cKDTree(self.positions[living]).query(vertices[facets].mean(axis=1))[1]]
        return passed.tolist()

    def renew(self):
        self._alive[:] = True
        self._forget_shape()
        self.follow()

    def state(self):
        return {"alive": self._alive.copy(), "node_of": self._node_of.copy()}

    def restore(self, state):
        self._alive, self._node_of = np.array(state["alive"], bool), np.array(state["node_of"], int)
        self._forget_shape()


def _motion(old, old_facets, new, new_facets):
    """m that no point of a surface has moved further than, given its shape before and after."""
    if np.array_equal(old_facets, new_facets):
        return np.linalg.norm(new - old, axis=1).max()
    # Remeshing moves vertices along the surface. No point of a facet is further from a vertex than its longest side.
    sides = [np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
             for corners in (old[old_facets], new[new_facets])]
    return max(distance(new, old, old_facets).max(), distance(old, new, new_facets).max()) + max(sides)

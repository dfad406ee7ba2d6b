"""The tool: a parametric or given outline filled with particles, rigid, with a surface that meets the rock."""
import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels import packing
from rockwear.kernels import polygon as outline
from rockwear.kernels.boundary import held_sides, segments
from rockwear.kernels.voronoi import cells
from rockwear.kernels.checks import ParameterError, known_as, positive, require
from rockwear.kernels.conduction import calibrated_conductance, paths
from rockwear.kernels.erosion import Erosion
from rockwear.model.cache import cached

POROSITIES = 0.13, 0.11, 0.09
"""Of the packing that fills the outline [Rojek 2014, 5.2]: the first at which it is jammed. Particles of nearly equal
radii lie in lattices, some of which are loose at more. Its mass and volume are those of the outline."""
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


def pack(**where):
    """packing.pack at the first of POROSITIES at which the particles are jammed. Raises ParameterError."""
    for porosity in POROSITIES:
        try:
            return packing.pack(porosity=porosity, **where)
        except ParameterError as error:
            if error.name != "porosity" or porosity == POROSITIES[-1]:
                raise


class ParticleTool:
    """A rigid tool of particles that wear away.

    vertices: (k, 2) m, its outline; positions: (n, 2 or 3) m; radii: (n,) m; area: m2 of the outline, in space m3 of
    the volume; volumes: (n,) m3, the part that each particle stands for; density: kg/m3; surface: (n,) bool, those open
    to wear at first; pairs: (m, 2), neighbours that cover one another; back: whether the shank holds the tool at the
    back, too; removal and thickness: of kernels.erosion.

    `fixed` (n,) bool are the particles that the shank holds, those within 1.5 radii of the top (of the back) and in any
    case the topmost: no surface at first, they wear once those before them are gone. `held`: whether the outline has a
    level top (or an upright back) for it.
    """

    def __init__(self, *, vertices, positions, radii, area, volumes, density, surface, pairs, removal, back=False,
                 thickness=1.0):
        self.vertices, self.positions, self.radii, self.area = vertices, positions, radii, area
        self.volumes, self.density, self.count = volumes, density, len(radii)
        self.masses = density * volumes
        (x, y), sides = positions[:, :2].T, held_sides(*segments(vertices)).any(axis=1)
        self.held = bool(sides[0] or back and sides[1])
        self.fixed = fixed = y > vertices[:, 1].max() - 1.5 * radii
        if back:
            fixed |= x < vertices[:, 0].min() + 1.5 * radii
        fixed[np.argmax(y)] = True
        self.erosion = Erosion(radii=radii, volumes=volumes, pairs=pairs, thickness=thickness, rule=removal,
                               surface=np.flatnonzero(surface & ~fixed), fixed=np.flatnonzero(fixed))

    @property
    def blunted(self):
        """m by which the lowest particle ends above the outline's tip."""
        return float((self.positions[:, 1] - self.radii).min() - self.vertices[:, 1].min())

    def foremost(self, below):
        """Largest x reached by particles with any part below the height `below` (both m, in the tool's own frame), as
        long as they are not worn away; -inf for none."""
        low = (self.positions[:, 1] - self.radii < below) & self.erosion.alive
        return float((self.positions[low, 0] + self.radii[low]).max(initial=-np.inf))


def fill(vertices, *, radius_min, radius_max, seed):
    """{"positions": (n, 2) m, "radii": (n,) m} of a packing that fills a polygon (k, 2) m; kept in the cache."""
    def make():
        filled = pack(polygon=vertices, radius_min=radius_min, radius_max=radius_max, seed=seed)
        return {"positions": filled.positions, "radii": filled.radii}

    return cached(make, fill=np.asarray(vertices).tolist(), radius_min=radius_min, radius_max=radius_max, seed=seed,
                  porosity=POROSITIES)


def fitted_conductance(*, radius_min, radius_max, seed, conductivity):
    """W/K, one conductance for every pair of `neighbours`, fitted on a square of the same packing as `fill` has: the
    outline itself may be any shape. conductivity: W/m K."""
    def make():
        side = 50 * radius_max
        square = pack(box=(side, side), radius_min=radius_min, radius_max=radius_max, seed=seed)
        return {"conductance": calibrated_conductance(positions=square.positions, conductivity=conductivity,
                                                      conductance=1.0,
                                                      edges=neighbours(square.positions, square.radii))[:1]}

    return float(cached(make, fit=[radius_min, radius_max, seed, conductivity], porosity=POROSITIES, gap=NEIGHBOUR_GAP,
                        nearest=NEAREST)["conductance"][0])


class Tool(ParticleTool):
    """Particles that fill an outline (k, 2) m, each standing for its part of the outline's area times 1 m.

    radius_min, radius_max: m; removal: "volume", "depth" or "none" (kernels.erosion); density: kg/m3 of the outline's
    area, which particles carry through their share of it. The shank fixes particles at the top and the back (or at
    the "top" alone): they are no surface. `cells` (kernels.voronoi.Cells) are the parts of the outline. Every other
    particle whose Voronoi cell reaches the outline is a surface particle, and a particle that goes uncovers those whose
    cells have a face with its own: by their gaps some across a pore would stay out of contact, and rock would come to
    lie in them.
    """

    def __init__(self, *, vertices, radius_min, radius_max, seed, removal, density, shank="top and back"):
        positive("tool_radius_min", radius_min, "m")
        vertices, area = np.asarray(vertices, float), outline.area(vertices)
        self._packing = dict(radius_min=radius_min, radius_max=radius_max, seed=seed)
        with known_as(radius_min="tool_radius_min", radius_max="tool_radius_max"):
            filled = fill(vertices, **self._packing)
        positions, radii = filled["positions"], filled["radii"]
        self.cells = cells(positions, polygon=vertices)
        super().__init__(vertices=vertices, positions=positions, radii=radii, area=area,
                         volumes=area * radii**2 / np.sum(radii**2), density=density, surface=self.cells.at_walls,
                         pairs=self.cells.edges, removal=removal, back=shank == "top and back")

    def paths(self, model, conductivity):
        """Pairs (m, 2) of particles that exchange heat and their conductances (m,) W/K; model: of conduction.PATHS."""
        return paths(model, conductivity, pairs=neighbours(self.positions, self.radii), cells=lambda: self.cells,
                     fitted=lambda: fitted_conductance(**self._packing, conductivity=conductivity))


class LayeredTool(ParticleTool):
    """Spheres of one radius (m) that fill an outline (k, 2) m drawn out across the cut.

    They lie in equal layers a diameter apart, about z = 0: each is the same packing of the outline, whose outermost
    particles touch its sides. So the faces are as smooth as spheres can make them. Layers fill `breadth` (m) but for
    less than a diameter. Every sphere stands for the same part of the tool's volume. `fixed` marks those at the top,
    where the shank holds the tool; everything else at the boundary is surface. removal: of kernels.erosion.
    """

    def __init__(self, *, vertices, radius, breadth, seed, removal, density):
        positive("tool_radius", radius, "m")
        vertices = np.asarray(vertices, float)
        layers = int(positive("breadth", breadth, "m") / (2 * radius) + 1e-9)
        require(layers > 1, "breadth", breadth, f"at least two particles, {4 * radius:g}", "m")
        with known_as(radius_min="tool_radius", radius_max="tool_radius"):
            filled = fill(vertices, radius_min=radius, radius_max=radius, seed=seed)
        layer = filled["positions"]
        self.breadth, self.layers, self.section = 2 * radius * layers, layers, cells(layer, polygon=vertices)
        number, one = np.arange(layers * len(layer)), len(layer)
        pairs = np.vstack([*(self.section.edges + one * k for k in range(layers)),
                           np.column_stack([number[:-one], number[one:]])])
        outermost = (number < one) | (number >= len(number) - one) | np.tile(self.section.at_walls, layers)
        positions, radii = _stack(layer, layers, filled["radii"][0]), np.tile(filled["radii"], layers)
        area = outline.area(vertices) * self.breadth
        super().__init__(vertices=vertices, positions=positions, radii=radii, area=area,
                         volumes=np.full(len(number), area / len(number)), density=density, surface=outermost,
                         pairs=pairs, removal=removal, thickness=2 * radii)


def _stack(places, layers, radius):
    """(n, 3) m: layers of a packing (m, 2), a diameter apart about z = 0."""
    z = 2 * radius * (np.arange(layers) - 0.5 * (layers - 1))
    positions = np.column_stack([np.tile(places, (layers, 1)), np.repeat(z, len(places))])
    # YADE's collider finds particles with equal coordinates in one order as a run goes on, in another in a resumed one.
    return positions + 1e-6 * radius * np.random.default_rng(0).uniform(-1, 1, positions.shape)

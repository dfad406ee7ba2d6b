"""Specimens of bonded rock: packing (kept in a cache), support, bonds, and the particles in YADE."""
import math
import numpy as np

from functools import cached_property

from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from rockwear.kernels import packing, polygon as outline
from rockwear.kernels.checks import ParameterError, not_negative, positive, require, within
from rockwear.kernels.voronoi import cells
from rockwear.model.cache import cached


TILE = 8000
"""Particles above which a specimen is put together from periodic tiles."""


def graded_radius(*, top, fine_depth, grading_factor, over):
    """A field of the radius factor: 1 from the surface y = top down to fine_depth, rising to `grading_factor` over `over` m."""
    def factor(points):
        depth = top - points[:, 1]
        return 1 + (grading_factor - 1) * np.clip((depth - fine_depth) / over, 0, 1)
    return factor


def pack_uniform(box, *, radius_min, radius_max, **common):
    """A packing of the whole box at once, or for large boxes of periodic tiles of at most TILE particles each."""
    area = math.pi * (radius_min**2 + radius_min * radius_max + radius_max**2) / 3
    count = box[0] * box[1] / area
    if not count > TILE:
        return packing.pack(box=box, radius_min=radius_min, radius_max=radius_max, **common)
    require(count <= packing.MAX_PARTICLES, "radius_min", radius_min,
            f"large enough for at most {packing.MAX_PARTICLES} particles", "m")
    side = math.sqrt(TILE * area)
    repeats = [math.ceil(length / side) for length in box]
    part = packing.pack(box=tuple(length / n for length, n in zip(box, repeats)), periodic=(True, True),
                        radius_min=radius_min, radius_max=radius_max, **common)
    return packing.tile(part, repeats)


class Specimen:
    """A box of bonded discs of thickness 1 m.

    width, height: m; radius_min, radius_max: m, uniform in between; porosity: 1 - sum of areas over the box's area;
    seed: of the packing; bonding_gap: largest gap over which particles are bonded (P 6), m; grading_factor: factor by
    which radii grow below fine_depth (m) over as much depth again. Strengths of bonds grow with that factor, so that the macroscopic
    strength stays uniform; in 2D a bond's stiffness sets the macroscopic one whatever the radius.
    Raises ParameterError naming the parameter.
    """

    def __init__(self, *, width, height, radius_min, radius_max, porosity, seed, bonding_gap, grading_factor=1.0,
                 fine_depth=0.035, density):
        positive("width", width, "m"), positive("height", height, "m")
        not_negative("bonding_gap", bonding_gap, "m")
        require(bonding_gap <= radius_min, "bonding_gap", bonding_gap,
                f"at most radius_min = {radius_min:g}: bonds join neighbours", "m")
        within("grading_factor", grading_factor, 1, 8)
        positive("fine_depth", fine_depth, "m")
        self.width, self.height = width, height
        key = dict(box=[width, height], radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed)
        if grading_factor > 1:
            key.update(grading_factor=grading_factor, fine_depth=fine_depth)

        def make():
            common = dict(radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed)
            field = graded_radius(top=height, fine_depth=fine_depth, grading_factor=grading_factor, over=fine_depth)
            made = (packing.pack(box=(width, height), radius_scale=field, **common) if grading_factor > 1
                    else pack_uniform((width, height), **common))
            return {"positions": made.positions, "radii": made.radii, "scale": made.scale}

        stored = cached(make, **key)
        self.positions, self.radii, self.scale = stored["positions"], stored["radii"], stored["scale"]
        self._weigh(density)
        self.pairs = packing.contacts(self.positions, self.radii, bonding_gap)
        require(len(self.pairs) > self.count, "bonding_gap", bonding_gap, "large enough to bond the packing", "m")
        self.strength_factor = self.scale[self.pairs].mean(axis=1)

    def _weigh(self, density):
        """Masses and inertias: particles carry the mass of the pores, bulk density over solid fraction (P 63)."""
        self.density, self.count = density, len(self.radii)
        self.porosity = 1 - float(np.sum(np.pi * self.radii**2)) / (self.width * self.height)
        self.masses = density / (1 - self.porosity) * np.pi * self.radii**2
        self.inertias = 0.5 * self.masses * self.radii**2
        self.fixed = np.zeros(self.count, bool)

    def fix(self, *faces, below=math.inf, within=1.05):
        """Hold the particles with centres `within` so many radii of these faces ("bottom", "left", "right") of the box,
        below a height (m): within 1.05 are those that touch it."""
        y, touches = self.positions[:, 1], self._near_faces(within * self.radii)
        for face in faces:
            if face not in touches:
                raise ParameterError("support", face, f"one of {', '.join(touches)}")
            self.fixed |= touches[face] & (y < below)

    def _near_faces(self, reach):
        """{face: (n,) bool, which particles have their centres within `reach` (n,) m of it}."""
        x, y = self.positions.T[:2]
        return {"bottom": y < reach, "left": x < reach, "right": x > self.width - reach}

    def report(self):
        """{name: (value, unit)}: how the packing came out."""
        i, j = self.pairs.T
        distance = np.linalg.norm(self.positions[i] - self.positions[j], axis=1)
        overlap = np.clip(1 - distance / (self.radii[i] + self.radii[j]), 0, None)
        return {"particles": (self.count, "-"), "bonds": (len(self.pairs), "-"), "porosity": (self.porosity, "-"),
                "coordination": (2 * len(self.pairs) / self.count, "-"),
                "mean_overlap": (float(overlap.mean()), "of a diameter")}

    @cached_property
    def cells(self):
        """kernels.cells.Cells: the part of the box that each particle stands for."""
        return cells(self.positions, box=(self.width, self.height))

    def current_positions(self):
        """(n, d) m, of the particles in YADE now, by its one bulk read."""
        from yade import Subdomain
        values = np.fromiter(Subdomain().getStateValuesFromIds(list(range(self.count))), float)
        return values.reshape(self.count, 13)[:, :self.positions.shape[1]]


class CutOut(Specimen):
    """The part of a specimen whose particles have their centres inside a polygon (k, 2) m, without loose pieces.

    whole: positions and radii of the specimen that it was cut out of; the others as in Specimen.
    """

    def __init__(self, *, polygon, bonding_gap, **of_the_box):
        super().__init__(bonding_gap=bonding_gap, **of_the_box)
        self.polygon, self.whole = np.asarray(polygon, float), (self.positions, self.radii)
        kept = np.flatnonzero(outline.inside(self.positions, self.polygon))
        pairs = packing.contacts(self.positions[kept], self.radii[kept], bonding_gap)
        joined = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(kept), len(kept)))
        part = connected_components(joined, directed=False)[1]
        kept = kept[part == np.argmax(np.bincount(part))]
        for name in ("positions", "radii", "scale", "masses", "inertias", "fixed"):
            setattr(self, name, getattr(self, name)[kept])
        self.count = len(kept)
        self.pairs = packing.contacts(self.positions, self.radii, bonding_gap)
        self.strength_factor = self.scale[self.pairs].mean(axis=1)

    @cached_property
    def cells(self):
        """kernels.cells.Cells: the part of the polygon that each particle stands for."""
        return cells(self.positions, polygon=self.polygon)


class Arranged(Specimen):
    """Equal discs of one radius (m) at given places (n, 2) m of a box, the touching ones bonded: lattices and the like."""

    def __init__(self, *, positions, radius, width, height, density):
        self.positions, self.width, self.height = np.asarray(positions, float), width, height
        self.radii, self.scale = np.full(len(positions), float(radius)), np.ones(len(positions))
        self._weigh(density)
        self.pairs = packing.contacts(self.positions, self.radii, 1e-6 * radius)
        self.strength_factor = np.ones(len(self.pairs))


class Block(Specimen):
    """A box of equal spheres: x from 0 to `width` along the cut, y from 0 to `height` upwards, z across by `depth`,
    centred at z = 0, all m.

    radius: m; porosity: 1 - sum of volumes over the box's volume; bonding_gap: m; density: kg/m3 of the bulk. With
    bonded=False nothing is bonded, and the box and all distances are enlarged until no two spheres overlap: a loose
    fill that gravity has still to settle. Raises ParameterError naming the parameter.
    """

    def __init__(self, *, width, height, depth, radius, porosity, seed, bonding_gap, density, bonded=True):
        box = positive("width", width, "m"), positive("height", height, "m"), positive("depth", depth, "m")
        not_negative("bonding_gap", bonding_gap, "m")
        require(bonding_gap <= radius, "bonding_gap", bonding_gap, f"at most radius = {radius:g}: bonds join neighbours", "m")

        def make():
            made = packing.pack(box=box, radius_min=radius, radius_max=radius, porosity=porosity, seed=seed, jammed=bonded)
            return {"positions": made.positions, "radii": made.radii}

        stored = cached(make, box=list(box), radius=radius, porosity=porosity, seed=seed, jammed=bonded)
        places, self.radii = stored["positions"], stored["radii"]
        self.loosened = 1.0 if bonded else self._clear(places)
        self.width, self.height, self.depth = (self.loosened * length for length in box)
        self.positions = self.loosened * (places - (0.0, 0.0, 0.5 * depth))
        self._weigh(density)
        near = self.near(bonding_gap)
        require(not bonded or len(near) > self.count, "bonding_gap", bonding_gap, "large enough to bond the packing", "m")
        self.pairs = near if bonded else near[:0]
        self.strength_factor = np.ones(len(self.pairs))

    def _clear(self, places):
        """Factor on all distances that leaves no overlap."""
        i, j = packing.contacts(places, self.radii).T
        distance = np.linalg.norm(places[i] - places[j], axis=1)
        return 1 + 1e-9 + float(np.max((self.radii[i] + self.radii[j]) / distance - 1, initial=0.0))

    def _weigh(self, density):
        self.density, self.count = density, len(self.radii)
        volumes = packing.volumes(self.radii, 3)
        self.porosity = 1 - float(volumes.sum()) / (self.width * self.height * self.depth)
        self.masses = density / (1 - self.porosity) * volumes
        self.inertias = 0.4 * self.masses * self.radii**2
        self.fixed = np.zeros(self.count, bool)

    def _near_faces(self, reach):
        z = self.positions[:, 2]
        return {**super()._near_faces(reach), "front": z > 0.5 * self.depth - reach, "back": z < reach - 0.5 * self.depth}

    def leave_out(self, gone):
        """Take particles (n,) bool out of the box, which keeps its size, as long as nothing is bonded."""
        for name in ("positions", "radii", "masses", "inertias", "fixed"):
            setattr(self, name, getattr(self, name)[~gone])
        self.count = len(self.radii)

    def near(self, gap):
        """Pairs (m, 2) of particles whose gap was at most so wide (m) before the block was loosened."""
        return packing.contacts(self.positions, self.radii, gap + (self.loosened - 1) * (2 * self.radii.max() + gap))

    def report(self):
        if len(self.pairs):
            return super().report()
        return {"particles": (self.count, "-"), "porosity": (self.porosity, "-")}

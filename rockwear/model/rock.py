"""Rock: assemblies of bonded discs or spheres, their packing kept in a cache."""
import math
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.special import gammainc

from rockwear.kernels import packing
from rockwear.kernels.bond_laws import Cohesive, ElasticBrittle
from rockwear.kernels.bond_laws.cohesive import UNBREAKABLE
from rockwear.kernels import polygon as outline
from rockwear.kernels.checks import ParameterError, known_as, not_negative, positive, require, within
from rockwear.kernels.conduction import calibrated_conductance, paths
from rockwear.kernels.curve_order import curve_order
from rockwear.kernels.grains import grains
from rockwear.kernels.voronoi import cells
from rockwear.model.cache import cached


TILE = 8000
"""Particles above which a specimen is put together from periodic tiles."""
ORDERED = 3000
"""Particles above which a packing is ordered along a curve: a step of YADE then takes 0.9 to 0.7 of the time
(calibration/results/scale.md). With fewer no difference is seen."""
SCATTER_LIMITS = 0.05, 5.0
"""Least and largest strength over the mean of Weibull's law where strengths scatter."""
BORDER, INSIDE = 4.0, 10
"""Mean radii from a border within which particles lack bonds, or neighbours of such; least number of others."""


def graded_radius(*, top, fine_depth, grading_factor, over):
    """A field of the radius factor: 1 from the surface y = top down to fine_depth, rising to `grading_factor` over
    `over` m."""
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


def ordered(stored):
    """{name: (n, ...)} of the particles of a packing; a large one so that neighbours are near in memory."""
    if len(stored["radii"]) <= ORDERED:
        return stored
    order = curve_order(stored["positions"])
    return {name: column[order] for name, column in stored.items()}


def packed_box(*, width, height, radius_min, radius_max, porosity, seed, bonding_gap, grading_factor, fine_depth,
               along=False):
    """Discs in a box and the pairs of them to bond, checked and kept in the cache; parameters as of a Specimen.

    along: whether the packing repeats itself along x. -> {"positions", "radii", "scale"}, (m, 2) int.
    """
    positive("width", width, "m"), positive("height", height, "m")
    not_negative("bonding_gap", bonding_gap, "m")
    require(bonding_gap <= radius_min, "bonding_gap", bonding_gap,
            f"at most radius_min = {radius_min:g}: bonds join neighbours", "m")
    within("grading_factor", grading_factor, 1, 8)
    positive("fine_depth", fine_depth, "m")
    key = dict(box=[width, height], radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed)
    field = None
    if grading_factor > 1:
        key.update(grading_factor=grading_factor, fine_depth=fine_depth)
        field = graded_radius(top=height, fine_depth=fine_depth, grading_factor=grading_factor, over=fine_depth)
    if along:
        key.update(periodic=[True, False])

    def make():
        common = dict(radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed)
        try:
            made = (packing.pack(box=(width, height), radius_scale=field, periodic=(along, False), **common)
                    if field or along else pack_uniform((width, height), **common))
        except ParameterError as error:
            if error.name != "radius_scale":
                raise
            raise ParameterError("grading_factor", grading_factor, error.rule) from None
        return {"positions": made.positions, "radii": made.radii, "scale": made.scale}

    stored = ordered(cached(make, **key))
    period = np.array([width, 0.0]) if along else None
    pairs = packing.contacts(stored["positions"], stored["radii"], bonding_gap, period)
    require(len(pairs) > len(stored["radii"]), "bonding_gap", bonding_gap, "large enough to bond the packing", "m")
    return stored, pairs


class RockAssembly:
    """Particles of thickness 1 m in the plane, or spheres in space, in a box, and the pairs of them that are bonded.

    positions: (n, 2 or 3) m; radii: (n,) m; width, height (and depth): m of the box; density: kg/m3 of the bulk; pairs:
    (m, 2), i < j; scale: (n,), by how much the grading of the rock has enlarged each particle. Particles carry the
    mass of the pores, bulk density over solid fraction [Rojek 2014, eq. 63]; porosity: of the packing, where it does
    not fill the box. `fixed` (n,) bool: particles that do not move; `absent` (n,) bool: that are not there; `side`
    (n,): 1 and 2 on the two sides of a cut, 0 elsewhere. `bond` gives the bonds their laws.
    """

    laws = grains = None
    """(m,) law of each bond; (n,) number of the grain of each particle, where the rock has grains."""
    frame = np.zeros(3)
    """m, the origin of what pictures show."""
    period = None
    """(2,) m with which the rock repeats itself along x, None where it does not."""
    stretch = 1.0
    """(n,) length in the plane over length in `positions`, which another strip than the straight one has."""

    def __init__(self, *, positions, radii, width, height, density, pairs, scale=None, depth=None, porosity=None):
        self.positions, self.radii, self.density = np.asarray(positions, float), radii, density
        self.width, self.height, self.depth, self.count = width, height, depth, len(radii)
        self.pairs = pairs
        self.scale = np.ones(len(radii)) if scale is None else scale
        if depth is None:
            self.porosity = 1 - float(np.sum(np.pi * radii**2)) / (width * height) if porosity is None else porosity
            self.masses = density / (1 - self.porosity) * np.pi * radii**2
            self.inertias = 0.5 * self.masses * radii**2
        else:
            volumes = packing.volumes(radii, 3)
            self.porosity = 1 - float(volumes.sum()) / (width * height * depth)
            self.masses = density / (1 - self.porosity) * volumes
            self.inertias = 0.4 * self.masses * radii**2
        self.fixed, self.absent = np.zeros((2, self.count), bool)
        self.side = np.zeros(self.count, int)
        self.extent = width, height
        """(2,) m that pictures in the plane show."""

    @property
    def size(self):
        """The box, m: (width, height), or with its depth."""
        return (self.width, self.height) if self.depth is None else (self.width, self.height, self.depth)

    @property
    def dimensions(self):
        """2 in the plane, 3 in space."""
        return len(self.size)

    @property
    def centre(self):
        """(d,) m of the box; z = 0 is in its middle."""
        return 0.5 * np.array([self.width, self.height, *[0.0] * (self.dimensions - 2)])

    @property
    def volume(self):
        """m2 or m3 that the particles fill with their pores."""
        return float(self.masses.sum()) / self.density

    @property
    def places(self):
        """(n, d) m of the particles as the scene begins."""
        return self.positions

    def shown(self, positions):
        """Places (n, d) m in pictures of particles at `positions` (n, d) m; nan for those that are not there."""
        return positions

    @property
    def bonded(self):
        """(m,) bool: pairs that are bonded as the scene begins."""
        return np.ones(len(self.pairs), bool)

    def goes_on(self):
        """(n,) bool, particles at whose far side rock goes on: it is no surface."""
        return self.fixed

    @property
    def anchored(self):
        """(n,) bool: particles that hold what is rock and no chip."""
        return self.fixed

    @property
    def bond_lengths(self):
        """(m,) m between the centres of each pair."""
        return np.linalg.norm(packing.separation(self.positions, *self.pairs.T, self.period), axis=1)

    def layouts(self):
        """(positions (n, d) m, bonds (m,) bool) that show all bonds between neighbours as they lie."""
        return [(self.positions, np.ones(len(self.pairs), bool))]

    @property
    def strength_factor(self):
        """(m,) A bond between enlarged particles is so many times as strong: the rock's strength stays uniform."""
        return self.scale[self.pairs].mean(axis=1)

    @property
    def bond_areas(self):
        """(m,) m2 of crack that a bond stands for, in the plane per metre of thickness: that of the bonds inside."""
        return self.crack_area * self.strength_factor**(self.dimensions - 1)

    @cached_property
    def crack_area(self):
        """m2 of crack, in the plane per metre of thickness, that a bond between particles of scale 1 stands for.

        A straight line meets (2/pi) sum d / A bonds per length, a plane sum d / (2 V) per area, d being the lengths of
        the bonds in an area A or a volume V in which their directions are evenly spread; in graded rock locally so.
        Particles near a border or a notch lack bonds: the sums are over the cells of those farther than BORDER from
        it, each with half of its bonds, and over all only where fewer than INSIDE are so far.
        """
        i, j = self.pairs.T
        halves = 0.5 * np.bincount(np.concatenate([i, j]), np.tile(self.bond_lengths, 2), self.count)
        depth = np.min(0.5 * np.array(self.size) - abs(self.positions - self.centre), axis=1)
        inside = (self.side == 0) & (depth > BORDER * self.scale * np.mean(self.radii / self.scale))
        if np.count_nonzero(inside) < INSIDE:
            inside, shares = np.ones(self.count, bool), self.masses / self.density
        else:
            # Cells inside do not feel the walls; particles of a lattice may lie in those of the box.
            low = self.positions.min(axis=0) - self.radii.max()
            shares = cells(self.positions - low, box=np.ptp(self.positions, axis=0) + 2 * self.radii.max()).volumes
            shares = self.stretch**self.dimensions * shares
        power = self.dimensions - 1
        return (0.5 * math.pi if power == 1 else 2.0) * float(
            np.sum((shares / self.scale**power)[inside]) / halves[inside].sum())

    def bond(self, law, *, grain_edge=0.0, within_grains=None, grain_strength=0.0, weibull_modulus=0.0, seed=0):
        """Give every bond its law, `laws` (m,), as the rock's law asks for at its place.

        law: of kernels.bond_laws; grain_edge: m, mean edge of grains among particles of scale 1, and `scale` times that
        elsewhere, which keeps the strength of the rock, 0 for none; within_grains: (kn, kt), N/m, of the bonds within a
        grain; grain_strength: their strengths over those between grains, 0: they do not break; weibull_modulus: of the
        scatter of strengths about their mean, 0 for none; seed: of grains and scatter. Raises ParameterError.
        """
        sizes = self.bond_areas if law.by_area else self.strength_factor
        if weibull_modulus:
            sizes = sizes * _scatter(weibull_modulus, len(self.pairs), seed)
        within = np.zeros(len(self.pairs), bool)
        if grain_edge:
            # Seeds are drawn among the particles: where those are coarser, grains are as much larger.
            finest = float(np.sum(self.masses / self.scale**self.dimensions)) / self.density
            self.grains = grains(self.positions, volume=finest, edge=grain_edge, seed=seed, period=self.period)
            within = self.grains[self.pairs[:, 0]] == self.grains[self.pairs[:, 1]]
            require(law.linear, "grain_edge", grain_edge, f"0 with the law {law.name}, which is linear nowhere", "m")
        kinds = list(zip(sizes.tolist(), self.strength_factor.tolist()))
        scaled = {(size, ratio): law.coarser(ratio).scaled(size) for size, ratio in sorted(set(kinds))}
        if grain_edge:
            inner = _within_grains(law, scaled, *(within_grains or (law.kn, law.kt)), grain_strength)
        self.laws = [(inner if inside else scaled)[kind] for kind, inside in zip(kinds, within)]
        if law.yade_law == "Cpm":
            self._clear_overlaps()

    def _clear_overlaps(self):
        """Reduce radii until no bonded particles overlap; masses stay. YADE's concrete model erases a bond that breaks,
        and the contact that follows would press with the whole overlap."""
        i, j = self.pairs.T
        overlap = self.radii[i] + self.radii[j] - self.bond_lengths
        largest = np.zeros(self.count)
        np.maximum.at(largest, i, overlap)
        np.maximum.at(largest, j, overlap)
        self.radii = self.radii - 0.5 * largest

    def stiffness(self):
        """(kn, kt), (m,) N/m: upper bounds of the stiffness of each bond, for the critical time step."""
        kinds = {law: law.stiffest() for law in set(self.laws)}
        return np.array([kinds[law] for law in self.laws]).reshape(-1, 2).T

    def fix(self, *faces, below=math.inf, within=1.05):
        """Fix the particles with centres `within` so many radii of these faces ("bottom", "left", "right") of the box,
        below a height (m): within 1.05 are those that touch it."""
        y, touches = self.positions[:, 1], self._near_faces(within * self.radii)
        for face in faces:
            if face not in touches:
                raise ParameterError("fix", face, f"one of {', '.join(touches)}")
            self.fixed |= touches[face] & (y < below)

    def cut(self, start, end):
        """Leave out the bonds across the segment from `start` to `end`, (2,) m: a notch of no width, in space all
        through the depth.

        The particles within a largest diameter of it are of side 1, on the left of the way from start to end, or 2,
        and so are all that lose a bond. Those of different sides never touch unless they are bonded, so that overlaps
        of the packing across the notch push nothing apart.
        """
        along = np.subtract(end, start)
        length = np.linalg.norm(along)
        cosine, sine = along / length
        x, y = np.array([[cosine, sine], [-sine, cosine]]) @ (self.positions[:, :2] - start).T
        i, j = self.pairs.T
        part = np.divide(y[i], y[i] - y[j], out=np.full(len(i), -1.0), where=y[i] != y[j])
        at = x[i] + part * (x[j] - x[i])
        crossed = (part >= 0) & (part <= 1) & (at >= 0) & (at <= length)
        beside = (x > 0) & (x < length) & (abs(y) <= 2 * self.radii.max())
        beside[self.pairs[crossed]] = True
        self.pairs = self.pairs[~crossed]
        self.side[beside] = np.where(y[beside] > 0, 1, 2)

    def _near_faces(self, reach):
        """{face: (n,) bool, which particles have their centres within `reach` (n,) m of it}."""
        x, y, *across = self.positions.T
        near = {"bottom": y < reach, "left": x < reach, "right": x > self.width - reach}
        for z in across:
            near.update(front=z > 0.5 * self.depth - reach, back=z < reach - 0.5 * self.depth)
        return near

    def report(self):
        """{name: (value, unit)}: how the packing came out."""
        if not len(self.pairs):
            return {"particles": (self.count, "-"), "porosity": (self.porosity, "-")}
        i, j = self.pairs.T
        overlap = np.clip(1 - self.bond_lengths / (self.radii[i] + self.radii[j]), 0, None)
        return {"particles": (self.count, "-"), "bonds": (len(self.pairs), "-"), "porosity": (self.porosity, "-"),
                "coordination": (2 * len(self.pairs) / self.count, "-"),
                "mean_overlap": (float(overlap.mean()), "of a diameter")}

    @cached_property
    def cells(self):
        """kernels.voronoi.Cells: the part of the box that each particle stands for."""
        return cells(self.positions, box=self.size)

    def paths(self, model, conductivity):
        """Pairs (m, 2) of particles that exchange heat and their conductances (m,) W/K; model: of conduction.PATHS."""
        thickness = 1.0 if self.depth is None else 2 * float(self.radii.mean())
        return paths(model, conductivity, pairs=self.pairs, cells=lambda: self.cells, thickness=thickness,
                     fitted=lambda: self._fitted_conductance(conductivity))

    def _fitted_conductance(self, conductivity):
        return calibrated_conductance(positions=self.positions, edges=self.pairs,
                                      conductance=1.0, conductivity=conductivity)[0]


class Specimen(RockAssembly):
    """A box of bonded discs of thickness 1 m.

    width, height: m; radius_min, radius_max: m, uniform in between; porosity: 1 - sum of areas over the box's area;
    seed: of the packing; bonding_gap: largest gap over which particles are bonded [Rojek 2014, eq. 6], m;
    grading_factor: factor by which radii grow below fine_depth (m) over as much depth again. Strengths of bonds grow
    with that factor, so that the macroscopic strength stays uniform; in the plane a bond's stiffness sets the
    macroscopic one whatever the radius. Raises ParameterError naming the parameter.
    """

    def __init__(self, *, width, height, radius_min, radius_max, porosity, seed, bonding_gap, grading_factor=1.0,
                 fine_depth=0.035, density):
        stored, pairs = packed_box(
            width=width, height=height, radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed,
            bonding_gap=bonding_gap, grading_factor=grading_factor, fine_depth=fine_depth)
        self.radius_max = radius_max
        super().__init__(positions=stored["positions"], radii=stored["radii"], width=width, height=height,
                         density=density, pairs=pairs, scale=stored["scale"])


class CutOut(RockAssembly):
    """The part of a specimen whose particles have their centres inside a polygon (k, 2) m, without loose pieces."""

    def __init__(self, specimen, *, polygon, bonding_gap):
        self.polygon, self.specimen, self.bonding_gap = np.asarray(polygon, float), specimen, bonding_gap
        kept = np.flatnonzero(outline.inside(specimen.positions, self.polygon))
        pairs = packing.contacts(specimen.positions[kept], specimen.radii[kept], bonding_gap)
        joined = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(kept), len(kept)))
        part = connected_components(joined, directed=False)[1]
        kept = kept[part == np.argmax(np.bincount(part))]
        positions, radii = specimen.positions[kept], specimen.radii[kept]
        pairs = packing.contacts(positions, radii, bonding_gap)
        super().__init__(positions=positions, radii=radii, width=specimen.width, height=specimen.height,
                         density=specimen.density, pairs=pairs, porosity=specimen.porosity,
                         scale=specimen.scale[kept])

    @property
    def crack_area(self):
        """m2 of crack of a bond: as in the specimen."""
        return self.specimen.crack_area

    @cached_property
    def cells(self):
        """kernels.voronoi.Cells: the part of the polygon that each particle stands for."""
        return cells(self.positions, polygon=self.polygon)

    def _fitted_conductance(self, conductivity):
        # The rock is no box: its conductance is fitted to a square of the packing that it is cut out of.
        positions, radii = self.specimen.positions, self.specimen.radii
        size = np.array([self.width, self.height])
        inside = np.all(abs(positions - size / 2) < min(size.min() / 2, 25 * self.specimen.radius_max), axis=1)
        pairs = packing.contacts(positions[inside], radii[inside], self.bonding_gap)
        return calibrated_conductance(positions=positions[inside],
                                      conductance=1.0, conductivity=conductivity, edges=pairs)[0]


class Arranged(RockAssembly):
    """Equal discs or spheres of one radius (m) at given places (n, 2 or 3) m of a box, the touching ones bonded:
    lattices and the like. depth: of a box in space, None in the plane."""

    def __init__(self, *, positions, radius, width, height, density, depth=None):
        radii = np.full(len(positions), float(radius))
        super().__init__(positions=positions, radii=radii, width=width, height=height, depth=depth, density=density,
                         pairs=packing.contacts(np.asarray(positions, float), radii, 1e-6 * radius))


class Block(RockAssembly):
    """A box of equal spheres: x from 0 to `width` along the cut, y from 0 to `height` upwards, z across by `depth`,
    centred at z = 0, all m.

    radius: m; porosity: 1 - sum of volumes over the box's volume; bonding_gap: m; density: kg/m3 of the bulk. With
    bonded=False nothing is bonded, and the box and all distances are enlarged until no two spheres overlap: a loose
    fill that gravity has still to settle. Raises ParameterError naming the parameter.
    """

    def __init__(self, *, width, height, depth, radius, porosity, seed, bonding_gap, density, bonded=True):
        box = positive("width", width, "m"), positive("height", height, "m"), positive("depth", depth, "m")
        not_negative("bonding_gap", bonding_gap, "m")
        require(bonding_gap <= radius, "bonding_gap", bonding_gap,
                f"at most radius = {radius:g}: bonds join neighbours", "m")

        def make():
            with known_as(radius_min="radius", radius_max="radius"):
                made = packing.pack(box=box, radius_min=radius, radius_max=radius, porosity=porosity, seed=seed,
                                    jammed=bonded)
            return {"positions": made.positions, "radii": made.radii}

        stored = ordered(cached(make, box=list(box), radius=radius, porosity=porosity, seed=seed, jammed=bonded))
        places, radii = stored["positions"], stored["radii"]
        self.loosened = 1.0 if bonded else _clearance(places, radii)
        width, height, depth = (self.loosened * length for length in box)
        positions = self.loosened * (places - (0.0, 0.0, 0.5 * box[2]))
        pairs = self._near(positions, radii, bonding_gap)
        require(not bonded or len(pairs) > len(radii), "bonding_gap",
                bonding_gap, "large enough to bond the packing", "m")
        super().__init__(positions=positions, radii=radii, width=width, height=height, depth=depth, density=density,
                         pairs=pairs if bonded else pairs[:0])

    @cached_property
    def cells(self):
        """kernels.voronoi.Cells: the part of the block that each sphere stands for."""
        return cells(self.positions + (0.0, 0.0, 0.5 * self.depth), box=self.size)

    def leave_out(self, gone):
        """Take particles (n,) bool out of the box, which keeps its size, as long as nothing is bonded."""
        for name in ("positions", "radii", "masses", "inertias", "fixed", "side"):
            setattr(self, name, getattr(self, name)[~gone])
        self.count = len(self.radii)

    def near(self, gap):
        """Pairs (m, 2) of particles whose gap was at most so wide (m) before the block was loosened."""
        return self._near(self.positions, self.radii, gap)

    def _near(self, positions, radii, gap):
        return packing.contacts(positions, radii, gap + (self.loosened - 1) * (2 * radii.max() + gap))


def _scatter(modulus, count, seed):
    """(count,) strengths over their mean, by Weibull's law of this modulus, drawn within SCATTER_LIMITS of the mean of
    all of the law and divided by the mean of those.

    With x over the mean of the law and c = Gamma(1 + 1/m), the chance to exceed x is exp(-(c x)^m), and its integral
    from 0 to x the regularised incomplete gamma function P(1/m, (c x)^m).
    """
    factor, limits = math.gamma(1 + 1 / modulus), np.array(SCATTER_LIMITS)
    low, high = gammainc(1 / modulus, (factor * limits)**modulus)
    drawn = np.random.default_rng([seed, count]).weibull(modulus, count) / factor
    return np.clip(drawn, *limits) / (limits[0] + high - low)


def _within_grains(law, scaled, kn, kt, strength):
    """{kind: law} of bonds within grains, of these stiffnesses (N/m) and so many times the strengths, 0: that do not
    break. scaled: {kind: law} of those between grains."""
    if strength:
        return {kind: one.stronger(strength, kn=kn, kt=kt) for kind, one in scaled.items()}
    if isinstance(law, Cohesive):
        return {kind: one.unbreakable(kn=kn, kt=kt) for kind, one in scaled.items()}
    return dict.fromkeys(scaled, ElasticBrittle(kn=kn, kt=kt, Rn=UNBREAKABLE, Rt=UNBREAKABLE, mu=law.mu))


def _clearance(places, radii):
    """Factor on all distances that leaves no overlap."""
    i, j = packing.contacts(places, radii).T
    distance = np.linalg.norm(places[i] - places[j], axis=1)
    return 1 + 1e-9 + float(np.max((radii[i] + radii[j]) / distance - 1, initial=0.0))

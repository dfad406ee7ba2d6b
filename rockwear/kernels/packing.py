"""Dense random packings of discs and spheres, by minimising the overlap energy of soft particles.

    E = ½ Σ_contacts (r_i + r_j − d_ij)₊² + Σ_walls (r_i − d_i)₊²

Particles of the given total volume at random positions repel each other where they overlap. A wall repels like the
mirror image of the particle, so that overlaps at walls equal those inside. The minimum (L-BFGS) is a jammed packing in
static equilibrium. Its overlaps are small and increase with decreasing porosity: bonds made on it are stress-free at
their initial distance, as with the initial gaps g0 of [Rojek 2014, eq. 6].

Porosity is 1 − Σ V_i / V of nominal particle volumes, overlaps counted twice.
"""
import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from rockwear.kernels.checks import ParameterError, positive, require, within
from rockwear.kernels.polygon import area, check_polygon, nearest, nearest_on_edges, sides

MARGIN = 0.6  # of the neighbour list, in least radii; it is renewed when a particle has moved by half of it
FORCE_TOLERANCE = 1e-4  # largest unbalanced force at the minimum, for unit contact stiffness, in least radii
ENERGY_TOLERANCE = 1e-8  # or relative decrease of E in MEMORY steps: on the chords of an arc discs do not come to rest
TILE_TOLERANCE = 0.3  # unbalanced force of a tiled specimen over the mean overlap of its tile
MAX_ITERATIONS = 10_000
AT_REST = 0.005  # imbalance that will do when they are over: equal spheres of 35 % porosity are at 0.001 to 0.002 then
LONGEST_STEP = 0.5  # component of a particle's displacement in an iteration, in least radii
SHORTEST_STEP = 1e-12  # below it the energy changes by rounding only
MEMORY = 10  # steps kept by L-BFGS
MAX_IMBALANCE = 0.05  # jammed packings end near 1e-4, marginal ones at 0.02, loose ones above 0.055
REGRADINGS = 2
MAX_PARTICLES = 5_000_000
LEAST_INRADIUS = 3  # inscribed radius of a container, in largest particle radii
POROSITY_LIMITS = {2: (0.02, 0.20), 3: (0.20, 0.42)}


@dataclass(frozen=True)
class Packing:
    """Particles in a container: positions (n, d) and radii (n,) in m.

    `box` (d,) are the sides of a box with one corner at the origin, closed by walls except where `periodic` (d,);
    for a packing in a `polygon` (k, 2) it is None. `scale` (n,) is the factor by which the grading field enlarged each
    radius. `imbalance` is the sum of the unbalanced forces on the particles over the sum of the contact forces.
    """

    positions: np.ndarray
    radii: np.ndarray
    scale: np.ndarray
    imbalance: float
    box: tuple = None
    periodic: tuple = None
    polygon: np.ndarray = None

    @property
    def period(self):
        """Sides (d,) in m of the periodic directions, 0 in the others; None where there is none."""
        return _period(self.box, self.periodic) if self.box and any(self.periodic) else None


def _period(box, periodic):
    return np.where(periodic, box, 0.0)


def volumes(radii, dimensions):
    """Areas π r² of discs (m2) or volumes 4/3 π r³ of spheres (m3)."""
    return math.pi * radii**2 if dimensions == 2 else 4 / 3 * math.pi * radii**3


def porosity(packing):
    """1 − Σ V_i / V with nominal particle volumes: what overlaps is counted twice."""
    volume = math.prod(packing.box) if packing.box else area(packing.polygon)
    return 1 - volumes(packing.radii, packing.positions.shape[1]).sum() / volume


def coordination(packing, gap=0.0):
    """Mean number of neighbours of a particle whose surfaces are at most `gap` (m) apart, walls not counted."""
    return 2 * len(contacts(packing.positions, packing.radii, gap, packing.period)) / len(packing.radii)


def mean_overlap(packing):
    """Mean over the touching pairs of (r_i + r_j − d)/(r_i + r_j): the overlap as a fraction of a diameter."""
    i, j = contacts(packing.positions, packing.radii, 0.0, packing.period).T
    distance = np.linalg.norm(separation(packing.positions, i, j, packing.period), axis=1)
    return float(np.mean(1 - distance / (packing.radii[i] + packing.radii[j]))) if len(i) else 0.0


def separation(positions, i, j, period=None):
    """Vectors (m, d) from particles i to particles j (m,), to the nearest image where `period` (d,) is not 0."""
    delta = positions[j] - positions[i]
    if period is None:
        return delta
    return delta - period * np.rint(delta / np.where(period > 0, period, np.inf))


def contacts(positions, radii, gap_max=0.0, period=None):
    """Pairs (m, 2), i < j in ascending order, with |x_j − x_i| − r_i − r_j <= gap_max [Rojek 2014, eq. 6].

    positions (n, d), radii (n,), gap_max and the sides `period` (d,; 0: not periodic) in m. A periodic side must be
    longer than twice the greatest distance 2 r + gap_max. Particles are searched by classes of radius, each within a
    factor of 2, so that a few large particles do not widen the search for all.
    """
    positions, radii = np.asarray(positions, dtype=float), np.asarray(radii, dtype=float)
    found = [np.empty((0, 2), dtype=np.intp)]
    if len(radii):
        wrapped = wrap(positions, period)
        size = np.floor(np.log2(radii / radii.min()))
        classes = [np.flatnonzero(size == c) for c in np.unique(size)]
        trees = [cKDTree(wrapped[ids], boxsize=period) for ids in classes]
        largest = [radii[ids].max() for ids in classes]
        for a, ids in enumerate(classes):
            reach = max(2 * largest[a] + gap_max, 0.0)
            found.append(ids[trees[a].query_pairs(reach, output_type="ndarray")])
            for b in range(a + 1, len(classes)):
                reach = max(largest[a] + largest[b] + gap_max, 0.0)
                near = trees[a].sparse_distance_matrix(trees[b], reach, output_type="ndarray")
                found.append(np.column_stack([ids[near["i"]], classes[b][near["j"]]]))
    pairs = np.sort(np.concatenate(found), axis=1)
    i, j = pairs.T
    distance = np.linalg.norm(separation(positions, i, j, period), axis=1)
    pairs = pairs[distance - radii[i] - radii[j] <= gap_max]
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def wrap(positions, period):
    """Positions (n, d) mapped into [0, period) where `period` (d,) is not 0; as they are without one."""
    if period is None:
        return positions
    inside = np.where(period > 0, np.mod(positions, np.where(period > 0, period, 1.0)), positions)
    # the remainder of a tiny negative number rounds to the period itself
    return np.where((period > 0) & (inside >= period), 0.0, inside)


class _Box:
    """Box [0, side] with walls on the sides that are not periodic."""

    def __init__(self, side, periodic):
        self.low, self.high = np.zeros(len(side)), np.asarray(side, dtype=float)
        self.walled = ~np.asarray(periodic, dtype=bool)
        self.volume = float(np.prod(self.high))
        self.inradius = self.high.min() / 2
        self.period = None if self.walled.all() else _period(self.high, periodic)

    def depth(self, points):
        """Distance (n,) from the boundary, negative outside."""
        return np.where(self.walled, np.minimum(points, self.high - points), np.inf).min(1)

    def repel(self, points, radii):
        """Energy of the walls and its gradient (n, d)."""
        low = self.walled * np.maximum(radii[:, None] - points, 0.0)
        high = self.walled * np.maximum(points + radii[:, None] - self.high, 0.0)
        return (low**2).sum() + (high**2).sum(), 2 * (high - low)


class _Polygon:
    """Polygon whose sides, the edges between two corners, are walls.

    A disc in a corner is repelled by both sides: with the nearest one alone the gradient of its energy would be
    discontinuous on the bisector, and L-BFGS would not converge. The chords of an arc are one wall.
    """

    period = None

    def __init__(self, vertices):
        self.vertices = vertices
        self.low, self.high = vertices.min(0), vertices.max(0)
        self.volume = area(vertices)
        trial = self.low + _halton(2, scramble=False).random(4096) * (self.high - self.low)
        self.inradius = self.depth(trial).max()
        self.sides = sides(vertices)

    def depth(self, points):
        """Distance (n,) from the boundary, negative outside."""
        return -nearest(points, self.vertices)[0]

    def repel(self, points, radii):
        """Energy of the walls and its gradient (n, 2)."""
        distance, _, normal = nearest(points, self.vertices)
        escaped = np.where(distance > 0, radii + distance, 0.0)
        energy, gradient = (escaped**2).sum(), 2 * escaped[:, None] * normal
        for start, edge in self.sides:
            outward = nearest_on_edges(points, start, edge)[0] - points
            away = np.linalg.norm(outward, axis=1)
            overlap = np.where(distance > 0, 0.0, np.maximum(radii - away, 0.0))
            energy += (overlap**2).sum()
            gradient += (2 * overlap / np.maximum(away, 1e-12 * radii))[:, None] * outward
        return energy, gradient


class _Energy:
    """Overlap energy of the particles as a function of their flattened positions, with its gradient."""

    def __init__(self, container, radii, unit):
        self.container, self.radii, self.unit = container, radii, unit
        self.listed_at = None

    def _list(self, positions):
        margin = MARGIN * self.unit
        self.listed_at = positions.copy()
        self.pairs = contacts(positions, self.radii, margin, self.container.period)
        self.at_wall = np.flatnonzero(self.container.depth(positions) < self.radii + margin)

    def __call__(self, flat):
        x = flat.reshape(len(self.radii), -1) * self.unit
        if self.listed_at is None or ((x - self.listed_at) ** 2).sum(1).max() > (MARGIN / 2 * self.unit) ** 2:
            self._list(x)
        i, j = self.pairs.T
        delta = separation(x, i, j, self.container.period)
        distance = np.sqrt((delta**2).sum(1))
        overlap = np.maximum(self.radii[i] + self.radii[j] - distance, 0.0)
        # coincident centres have no direction of repulsion: another neighbour must separate them
        push = (overlap / np.maximum(distance, 1e-12 * self.unit))[:, None] * delta
        n = len(x)
        gradient = np.column_stack([np.bincount(i, p, n) - np.bincount(j, p, n) for p in push.T]).astype(float)
        wall_energy, wall_push = self.container.repel(x[self.at_wall], self.radii[self.at_wall])
        gradient[self.at_wall] += wall_push
        self.contact_force = overlap.sum() / self.unit
        return (0.5 * _dot(overlap, overlap) + wall_energy) / self.unit**2, gradient.ravel() / self.unit


class _NotConverged(Exception):
    """Particles are not AT_REST after MAX_ITERATIONS."""


def _dot(a, b):
    return np.einsum("i,i", a, b)  # in one thread, unlike a @ b


def _minimise(energy, x, tolerance):
    """(a minimum of `energy`, a function x -> (value, gradient), near x, whether it was reached within
    MAX_ITERATIONS): L-BFGS with backtracking.

    Nocedal and Wright, Numerical Optimization, algorithms 7.4, 7.5 and 3.1, with no component of a step longer than
    LONGEST_STEP. Not scipy's, which sums by a threaded BLAS from scipy 1.15 on: the packing of a seed would depend on
    the number of threads, and on busy cores the synchronisation made it many times slower.
    """
    value, gradient = energy(x)
    memory, stalled = deque(maxlen=MEMORY), 0
    for _ in range(MAX_ITERATIONS):
        if np.abs(gradient).max() <= tolerance:
            return x, True
        step = -gradient
        weights = []
        for dx, dg, curvature in reversed(memory):
            weights.append(_dot(dx, step) / curvature)
            step -= weights[-1] * dg
        if memory:
            dx, dg, curvature = memory[-1]
            step *= curvature / _dot(dg, dg)
        for (dx, dg, curvature), weight in zip(memory, reversed(weights)):
            step += (weight - _dot(dg, step) / curvature) * dx
        step *= min(1.0, LONGEST_STEP / np.abs(step).max())
        slope = _dot(gradient, step)
        new_value, new_gradient = energy(x + step)
        while new_value > value + 1e-4 * slope:
            step, slope = 0.5 * step, 0.5 * slope
            if np.abs(step).max() < SHORTEST_STEP:
                return x, True
            new_value, new_gradient = energy(x + step)
        dg = new_gradient - gradient
        curvature = _dot(step, dg)
        if curvature > 0:
            memory.append((step, dg, curvature))
        x, gained, value, gradient = x + step, value - new_value, new_value, new_gradient
        stalled = stalled + 1 if gained <= ENERGY_TOLERANCE * value else 0
        if stalled == MEMORY:
            return x, True
    return x, False


def _relax(container, positions, radii, tolerance=FORCE_TOLERANCE):
    """Positions (n, d) at a minimum of the overlap energy near the given ones, and their imbalance. Raises
    _NotConverged."""
    unit = radii.min()
    energy = _Energy(container, radii, unit)
    x, reached = _minimise(energy, (positions / unit).ravel(), tolerance)
    _, gradient = energy(x)
    relaxed = x.reshape(positions.shape) * unit
    relaxed = wrap(relaxed, container.period)
    unbalanced = np.linalg.norm(gradient.reshape(positions.shape), axis=1).sum()
    imbalance = float(unbalanced / energy.contact_force) if energy.contact_force else math.inf
    if not reached and imbalance > AT_REST:
        raise _NotConverged
    return relaxed, imbalance


def _scale_at(radius_scale, points, largest):
    """Values (n,) of the grading field, checked."""
    if radius_scale is None:
        return np.ones(len(points))
    scale = np.asarray(radius_scale(points), dtype=float)
    require(scale.shape == (len(points),), "radius_scale", f"array of shape {scale.shape}", "one factor a point")
    require(((scale >= 1) & (scale <= largest)).all(), "radius_scale", f"{scale.min():g}..{scale.max():g}",
            f"between 1 and {largest:.4g}: the largest particles must fit into the container")
    return scale


def _halton(dimensions, **options):
    """scipy's Halton sequence: slow to import, and of no use where packings are kept."""
    from scipy.stats import qmc
    return qmc.Halton(dimensions, **options)


def _scatter(container, radius, solid, scale_at, rng):
    """Positions (n, d), numbers (n,) in [0, 1) for the radii, and scales (n,) of particles of volume about `solid`.

    Positions are from a scrambled Halton sequence, which is more even than independent ones: displacements are short.
    A point is kept with probability scale^-d, so that the solid volume is uniform.
    """
    dimensions = len(container.low)
    halton = _halton(dimensions + 1, seed=rng)
    batch = 1 + int(solid / volumes(radius(0.5), dimensions))
    points, draws, scales = np.empty((0, dimensions)), np.empty(0), np.empty(0)
    filled = np.zeros(1)
    while filled[-1] < solid:
        trial = halton.random(batch)
        new = container.low + trial[:, :-1] * (container.high - container.low)
        inside = container.depth(new) > 0
        new, lot = new[inside], trial[inside, -1]
        scale = scale_at(new)
        kept = lot < scale**-dimensions
        points, scales = np.vstack([points, new[kept]]), np.append(scales, scale[kept])
        draws = np.append(draws, rng.random(kept.sum()))
        filled = np.append(0.0, np.cumsum(volumes(radius(draws) * scales, dimensions)))
    n = int(np.abs(filled - solid).argmin())
    return points[:n], draws[:n], scales[:n]


def _fit_radii(radius, draws, scales, solid, dimensions):
    """Radii (n,) whose volumes add up to `solid`.

    The numbers u are replaced by u^p, which keeps the radii within their bounds. Equal radii do not depend on p: a
    common factor corrects them for a fraction of a particle.
    """
    def excess(p):
        return volumes(radius(draws**p) * scales, dimensions).sum() - solid

    if excess(0.5) > 0 > excess(2.0):
        return radius(draws ** brentq(excess, 0.5, 2.0)) * scales
    radii = radius(draws) * scales
    return radii * (solid / volumes(radii, dimensions).sum()) ** (1 / dimensions)


def pack(*, box=None, polygon=None, radius_min, radius_max, porosity, seed, radius_scale=None, periodic=False,
         jammed=True):
    """Jammed random packing of discs (2D) or spheres (3D) in a box or of discs in a polygon, as a Packing.

    box        sides (w, h) or (w, h, d) in m, one corner at the origin; or
    polygon    vertices (k, 2) in m of any simple polygon: discs touch it from inside
    radius_min, radius_max    radii are uniform in between (m)
    porosity   1 − Σ V_i / V, met to rounding. Measured on discs with r_max/r_min = 1.5 in 109 mm: 0.03 leaves a mean
               overlap of 5 % of a diameter, 0.12 one of 1.8 % and 4.6 neighbours a disc, 0.16 one of 0.4 % and 4.1;
               at 0.18 the discs are no longer jammed (periodic: 0.17). Spheres: 0.20 leaves 5.3 %, 0.36 1.2 %,
               0.40 0.1 %; loose at 0.42 (periodic: 0.38).
    seed       integer; the same seed gives the same packing on the same numpy and scipy
    radius_scale    grading field f(positions (n, d)) -> factors (n,), at least 1: the radius at a place is a draw from
               [radius_min, radius_max] times the field there
    jammed     False: loose particles are accepted, for a fill that is to settle
    periodic   one flag, or one for each direction: periodic boundary in place of two walls

    Discs of nearly equal radii form hexagonal patches: keep r_max/r_min above 1.2 where isotropy matters. Time: about a
    second for 2,100 discs, 4 s for a tooth of 6,300; for larger specimens see `tile`.

    Raises ParameterError for lengths that are not positive, radius_min > radius_max, a container whose inscribed
    radius is less than LEAST_INRADIUS particle radii, a field below 1, and a porosity outside POROSITY_LIMITS, or at
    which the particles are not jammed, or so nearly jammed that MAX_ITERATIONS do not suffice.
    """
    container, where = _container(box, polygon, periodic)
    dimensions = len(container.low)
    radius_min, radius_max = positive("radius_min", radius_min, "m"), positive("radius_max", radius_max, "m")
    require(radius_min <= radius_max, "radius_min", radius_min, f"at most radius_max = {radius_max:g}", "m")
    largest = container.inradius / LEAST_INRADIUS
    require(radius_max <= largest, "radius_max", radius_max,
            f"at most {largest:g}, 1/{LEAST_INRADIUS} of the radius inscribed in the container", "m")
    porosity = within("porosity", porosity, *POROSITY_LIMITS[dimensions])
    solid = (1 - porosity) * container.volume
    require(solid / volumes(radius_min, dimensions) <= MAX_PARTICLES, "radius_min", radius_min,
            f"large enough for at most {MAX_PARTICLES} particles", "m")
    require(isinstance(seed, (int, np.integer)) and seed >= 0, "seed", seed, "an integer of at least 0")
    rng = np.random.default_rng(seed)

    def radius(u):
        return radius_min + (radius_max - radius_min) * u

    def scale_at(points):
        return _scale_at(radius_scale, points, largest / radius_max)

    positions, draws, scale = _scatter(container, radius, solid, scale_at, rng)
    radii = _fit_radii(radius, draws, scale, solid, dimensions)
    try:
        positions, imbalance = _relax(container, positions, radii)
        # the particles have moved in the grading field: fit the radii to their new positions
        for _ in range(REGRADINGS if radius_scale is not None else 0):
            scale = scale_at(positions)
            radii = _fit_radii(radius, draws, scale, solid, dimensions)
            positions, imbalance = _relax(container, positions, radii)
    except _NotConverged:
        raise ParameterError("porosity", porosity, "lower or higher: so near to the jamming transition the packing is "
                             f"not in equilibrium after {MAX_ITERATIONS} iterations") from None
    require(imbalance <= MAX_IMBALANCE or not jammed, "porosity", porosity,
            "lower: with this one the packing is loose, not jammed")
    return Packing(positions, radii, scale, imbalance, **where)


def _container(box, polygon, periodic):
    """The container, and its fields in a Packing."""
    require((box is None) != (polygon is None), "box", box, "given, or else polygon, not both")
    if box is None:
        vertices = check_polygon(polygon)
        require(not np.any(periodic), "periodic", periodic, "False in a polygon")
        return _Polygon(vertices), {"polygon": vertices}
    require(np.ndim(box) == 1 and len(box) in (2, 3), "box", box, "two or three sides", "m")
    lengths = tuple(positive("box", side, "m") for side in box)
    require(np.shape(periodic) in ((), (len(lengths),)), "periodic", periodic, "one flag, or one for each direction")
    flags = tuple(bool(flag) for flag in np.broadcast_to(periodic, len(lengths)))
    return _Box(lengths, flags), {"box": lengths, "periodic": flags}


def tile(packing, repeats):
    """A large specimen: a periodic packing repeated `repeats` (d,) times and relaxed between walls.

    Repetition leaves no seam. The outer walls push particles in, and the packing is relaxed until the unbalanced forces
    are below TILE_TOLERANCE times the mean overlap: the overlaps near the walls stay some 10 % above those inside. A
    tile of 3,800 discs repeated 5 x 5 times takes some 20 s. Returns a Packing with walls on all sides and the porosity
    of the tile. Raises ParameterError for a packing that is not periodic in all directions and repeats that are not
    positive integers.
    """
    require(packing.box is not None and all(packing.periodic), "packing", f"periodic: {packing.periodic}",
            "periodic in all directions")
    counts = np.asarray(repeats)
    require(counts.shape == (len(packing.box),) and counts.dtype.kind in "iu" and (counts > 0).all(),
            "repeats", repeats, "one positive integer for each direction")
    corners = np.indices(repeats).reshape(len(repeats), -1).T * packing.box
    positions = (packing.positions + corners[:, None, :]).reshape(-1, len(repeats))
    radii, scale = np.tile(packing.radii, len(corners)), np.tile(packing.scale, len(corners))
    box, periodic = tuple(k * side for k, side in zip(repeats, packing.box)), (False,) * len(repeats)
    positions, imbalance = _relax(_Box(box, periodic), positions, radii, TILE_TOLERANCE * mean_overlap(packing))
    return Packing(positions, radii, scale, imbalance, box=box, periodic=periodic)

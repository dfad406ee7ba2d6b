"""Teeth worn in two ways whose outlines are known exactly, whatever the size of particles or segments.

- flat: a tooth rubs on a plane, and the particle in contact wears. The result is the new tooth without the part of
  Archard's volume beyond a plane.
- pattern: the friction work of a miniature cut, smoothed along the outline, wears it along its normals. At the
  curvature c a depth d takes the volume d - c d^2 / 2 per unit of length.
"""
import math
from types import SimpleNamespace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from rockwear.kernels.polygon import area, contour, cross
from rockwear.model.facet_tool import FacetTool
from rockwear.model.materials import STEEL
from rockwear.model.particle_tool import Tool
from rockwear.report import shapes

SPREAD = 0.12
"""Radii vary by this fraction of the mean, as 0.4 to 0.52 mm in [Rojek 2003, 9.2]."""
OUTLINE = dict(height=0.03, width=0.02, rake=math.radians(10), clearance=math.radians(10), tip_radius=2e-3)
DOWN = np.array([math.sin(math.radians(30)), -math.cos(math.radians(30))])
"""Direction of the plane that the tooth rubs on: below and in front of it."""
WORN, PATTERN_WORN = 20e-6, 4e-6
"""Worn volumes of the comparison, m3 per metre of thickness."""
STRIP = 0.8e-3
"""Length (m) over which the position of a worn face is averaged, the size of the largest particles."""
RAYS = 0.05e-3
"""Distance (m) between the normals along which the pattern wears."""
SMOOTH = 2e-3
"""Standard deviation (m) of the smoothing of the pattern."""


def cut_off(polygon, height):
    """Part of a polygon (k, 2) up to `height` along DOWN."""
    kept = []
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
        over = a @ DOWN - height, b @ DOWN - height
        if over[0] <= 0:
            kept.append(a)
        if over[0] * over[1] < 0:
            kept.append(a + (b - a) * over[0] / (over[0] - over[1]))
    return np.array(kept)


def exact(polygon, volume):
    """(outline, height along DOWN) of the polygon without the area `volume` that is furthest along DOWN."""
    heights = polygon @ DOWN
    height = brentq(lambda h: area(polygon) - area(cut_off(polygon, h)) - volume, heights.min() + 1e-6, heights.max())
    return cut_off(polygon, height), height


def particles(polygon, size, seed, removal):
    """The tooth filled with particles of a mean diameter."""
    return Tool(vertices=polygon, radius_min=(1 - SPREAD) * size / 2, radius_max=(1 + SPREAD) * size / 2, seed=seed,
                removal=removal, density=STEEL.density)


def rub(tool, volume, portion=1 / 8):
    """Wear `volume` (m3) off the particle that is furthest along DOWN, the only one in contact with the plane.

    portion: wear in a visit, over the mean volume of a particle.
    """
    erosion, reach = tool.erosion, tool.positions @ DOWN + tool.radii
    visits = math.ceil(volume / (portion * float(tool.volumes.mean())))
    for _ in range(visits):
        surface = np.fromiter(erosion.surface, int)
        worn = np.zeros(tool.count)
        worn[surface[np.argmax(reach[surface])]] = volume / visits
        erosion.wear(worn)


def unexplained(tool):
    """Residual of the volume balance over Archard's volume."""
    balance = tool.erosion.volume_balance()
    return balance["unexplained"] / balance["archard"]


def face(polygon, volume):
    """The exact flat face after `volume` (m3) of wear: height (m) along DOWN, direction, ends (m) along it."""
    target, height = exact(polygon, volume)
    along = np.array([DOWN[1], -DOWN[0]])
    return height, along, *sorted(float(p @ along) for p in target if abs(p @ DOWN - height) < 1e-9)


def flat_of_segments(polygon, size, strip=STRIP, volume=WORN):
    """As `flat`, for segments: the furthest segment wears."""
    boundary = FacetTool.of_outline(polygon, segment=size, density=STEEL.density).boundary
    visits = math.ceil(volume / (size**2 / 8))
    for _ in range(visits):
        reach = np.where(boundary.fixed, -np.inf, (boundary.vertices @ DOWN)[boundary.facets].mean(axis=1))
        boundary.wear(np.where(np.arange(len(reach)) == np.argmax(reach), volume / visits, 0.0))
    height, along, low, high = face(polygon, volume)
    across, reach = boundary.vertices @ along, boundary.vertices @ DOWN
    off = reach[(across > low + strip) & (across < high - strip) & (abs(reach - height) < strip)] - height
    return worn_segments(boundary, float(np.sqrt(np.mean(off**2))), volume)


def worn_segments(boundary, off, volume):
    """Result of a boundary of segments: outline, distance `off` (m) from the exact one, residual of its worn volume."""
    return SimpleNamespace(outline=boundary.vertices[shapes.loop(boundary.facets)], off=off,
                           unexplained=boundary.volume_balance()["unexplained"] / volume)


def flat(polygon, size, seed, strip=STRIP):
    """A tooth rubbed on a plane: outline, and rms distance (m) of its face from the exact one, averaged over strips."""
    tool = particles(polygon, size, seed, "volume")
    rub(tool, WORN)
    alive = tool.erosion.alive
    height, along, low, high = face(polygon, WORN)
    across, reach = tool.positions[alive] @ along, tool.positions[alive] @ DOWN + tool.radii[alive]
    places = np.arange(low + strip, high - strip, strip / 2)
    off = np.array([reach[abs(across - place) < strip / 2].max() - height for place in places])
    return SimpleNamespace(outline=outline_of(tool), off=float(np.sqrt(np.mean(off**2))), unexplained=unexplained(tool))


def outline_of(tool):
    """Outline of the remaining particles."""
    alive = tool.erosion.alive
    return shapes.outlines(tool.positions[alive], tool.radii[alive])[0]


class Pattern:
    """Distribution of wear of a cut: density (n,) 1/m of the worn volume along the outline, normals, curvature."""

    def __init__(self, run):
        model, shot = run.model, run.snapshot(-1)
        points, arc = contour(model["outline"], RAYS)
        worn = shot["worn_depth"] * model["tool_radii"]
        nearest = cKDTree(points).query(model["tool_positions"])[1]
        density = gaussian_filter1d(np.bincount(nearest, worn, len(points)), SMOOTH / RAYS)
        steps = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        turned = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
        self.inward = np.column_stack([-np.sin(turned), np.cos(turned)])
        curvature = gaussian_filter1d(np.gradient(turned, RAYS), 2)
        self.worn = density > 0.01 * density.max()
        density = np.where(self.worn, density, 0.0)
        self.points, self.density, self.curvature = points, density / (density.sum() * RAYS), curvature

    def depth(self, volume):
        """(n,) m, d of d - c d^2 / 2 = volume times density."""
        area, c = volume * self.density, np.where(abs(self.curvature) < 1, 1e-3, self.curvature)
        return (1 - np.sqrt(np.maximum(1 - 2 * c * area, 0.0))) / c

    def entries(self, tool):
        """For each point the particles that its normal intersects, and the depths (m) of intersection, in order."""
        tree = cKDTree(tool.positions)
        for point, normal in zip(self.points, self.inward):
            near = np.array(tree.query_ball_point(point + 2.5e-3 * normal, 3.5e-3), int)
            away = tool.positions[near] - point
            ahead, aside = away @ normal, away @ np.array([-normal[1], normal[0]])
            hit = (abs(aside) < tool.radii[near]) & (ahead > -tool.radii[near])
            depth = ahead[hit] - np.sqrt(tool.radii[near][hit]**2 - aside[hit]**2)
            order = np.argsort(depth)
            yield near[hit][order], depth[order]

    def wear(self, tool, volume, portion=1 / 8):
        """Wear `volume` (m3) off the tool. -> (n,) m, depth at which each normal enters the remaining tool."""
        met = [pair if worn else None for pair, worn in zip(self.entries(tool), self.worn)]
        alive = tool.erosion.alive
        visits = self.visits(volume, 2 * float(tool.radii.mean()), portion * float(tool.volumes.mean()))
        for _ in range(visits):
            worn = np.zeros(tool.count)
            for pair, density in zip(met, self.density):
                if pair:
                    first = pair[0][alive[pair[0]]]
                    worn[first[0]] += volume / visits * density * RAYS
            tool.erosion.wear(worn)
        return np.array([pair[1][alive[pair[0]]][0] if pair else np.nan for pair in met])

    def visits(self, volume, width, most):
        """Number of visits so that a width (m) of the outline wears by at most `most` (m3) in each."""
        return math.ceil(volume * self.density.max() * width / most)

    def wear_segments(self, boundary, volume, size):
        """As `wear`, for segments of a size (m)."""
        visits = self.visits(volume, size, size**2 / 8)
        for _ in range(visits):
            first, _ = self.entered(boundary)
            portion = np.where(self.worn, self.density, 0.0) * RAYS * volume / visits
            boundary.wear(np.bincount(first, portion, len(boundary.facets)))
        return self.entered(boundary)[1]

    def entered(self, boundary):
        """(n,) segment that each normal enters first, and (n,) depth (m) of the intersection."""
        begin, end = (boundary.vertices[boundary.facets[:, k]] for k in (0, 1))
        inward, legs = self.inward[:, None], (end - begin)[None]
        across = cross(inward, legs)
        across[abs(across) < 1e-12] = np.nan
        away = begin[None] - self.points[:, None]
        depth, place = cross(away, legs) / across, cross(away, inward) / across
        depth[~((place >= 0) & (place <= 1) & (depth > -STRIP))] = np.inf
        first = np.argmin(depth, axis=1)
        return first, depth[np.arange(len(first)), first]

    def off(self, found, volume):
        """rms distance (m) of a worn face from the exact one, averaged over strips."""
        window = round(STRIP / RAYS)
        off = np.convolve((found - self.depth(volume))[self.worn], np.full(window, 1 / window), "valid")
        return float(np.sqrt(np.mean(off**2)))


def patterned(pattern, polygon, size, seed, removal="volume", portion=1 / 8):
    """A tooth worn by the pattern: outline, and rms distance (m) from the exact one, averaged over strips."""
    tool = particles(polygon, size, seed, removal)
    found = pattern.wear(tool, PATTERN_WORN, portion)
    return SimpleNamespace(outline=outline_of(tool), off=pattern.off(found, PATTERN_WORN),
                           unexplained=unexplained(tool))


def patterned_segments(pattern, polygon, size):
    """As `patterned`, for segments."""
    boundary = FacetTool.of_outline(polygon, segment=size, density=STEEL.density).boundary
    found = pattern.wear_segments(boundary, PATTERN_WORN, size)
    return worn_segments(boundary, pattern.off(found, PATTERN_WORN), PATTERN_WORN)

"""Polygons in the plane: area, perimeter, signed distance, and profiles of cutting teeth.

A polygon is an array (k, 2) of vertices in m, in order, the last connected with the first. It is simple: no two edges
meet except neighbours at their common vertex.
"""
import math
import re

import numpy as np
from scipy.spatial import cKDTree

from rockwear.kernels.checks import ParameterError, finite, not_negative, positive, require
from rockwear.kernels.files import read_cells

ARC_CHORD_ERROR = 1e-3  # sagitta of the chords that replace an arc, as a fraction of its radius
CORNER = math.radians(10)  # a vertex at which the direction changes by more is a corner
MAX_VERTICES = 4000  # of a file: the test for simple polygons compares all pairs of edges
OTHER_UNITS = {"mm", "cm", "um", "µm", "in", "inch", "ft"}  # that the head of a file may not name
LEVEL = 1e-6  # vertices of which the coordinates differ by a smaller part of the extent lie at one level
CHUNK = 2_000_000  # point-edge pairs processed together: some 100 MB of temporaries


def cross(a, b):
    """(...) vector products of vectors (..., 2) in the plane."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def signed_area(polygon):
    """Area (m2) by the shoelace formula, ½ Σ (x_i y_{i+1} − x_{i+1} y_i): positive for counter-clockwise vertices."""
    # relative to one vertex: no loss of digits for a small polygon far from the origin
    p = np.asarray(polygon, dtype=float) - np.asarray(polygon, dtype=float)[0]
    return 0.5 * float(cross(p, np.roll(p, -1, axis=0)).sum())


def area(polygon):
    """Enclosed area in m2, for either orientation."""
    return abs(signed_area(polygon))


def perimeter(polygon):
    """Length of the boundary in m."""
    p = np.asarray(polygon, dtype=float)
    return float(np.linalg.norm(np.roll(p, -1, axis=0) - p, axis=1).sum())


def is_simple(polygon):
    """Whether no two edges of the polygon meet, except neighbours at their common vertex.

    Edges P→P+d and Q→Q+e that are not parallel meet where P + s d = Q + t e, s, t in [0, 1]; parallel ones where they
    lie on one line and overlap. All pairs of edges are compared.
    """
    p = np.asarray(polygon, dtype=float)
    k = len(p)
    d = np.roll(p, -1, axis=0) - p
    length = np.linalg.norm(d, axis=1)
    if k < 3 or not (length > 0).all():
        return False
    i, j = np.triu_indices(k, 1)
    gap = p[j] - p[i]
    det = cross(d[i], d[j])
    tiny = 1e-12
    parallel = np.abs(det) <= tiny * length[i] * length[j]
    safe = np.where(parallel, 1.0, det)
    s, t = cross(gap, d[j]) / safe, cross(gap, d[i]) / safe
    crossing = ~parallel & (s >= -tiny) & (s <= 1 + tiny) & (t >= -tiny) & (t <= 1 + tiny)
    along = (gap * d[i]).sum(1) / length[i] ** 2
    reach = (d[i] * d[j]).sum(1) / length[i] ** 2
    overlap = np.minimum(1.0, np.maximum(along, along + reach)) - np.maximum(0.0, np.minimum(along, along + reach))
    collinear = parallel & (np.abs(cross(d[i], gap)) <= tiny * length[i] * (length[i] + np.linalg.norm(gap, axis=1)))
    neighbours = (j == i + 1) | ((i == 0) & (j == k - 1))
    # neighbours share one point; they must not overlap
    touching = crossing | (collinear & (overlap >= -tiny))
    folded = collinear & (overlap > tiny)
    return not bool(np.where(neighbours, folded, touching).any())


def check_polygon(polygon, name="polygon"):
    """`polygon` as a counter-clockwise float array (k, 2).

    A last vertex equal to the first is removed. Raises ParameterError (under `name`) unless the polygon has at least 3
    vertices, all finite, and is simple.
    """
    try:
        p = np.array(polygon, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(name, "(not numbers)", "a list of x, y vertices") from None
    require(p.ndim == 2 and p.shape[1:] == (2,), name, f"array of shape {p.shape}", "a list of x, y vertices")
    require(np.isfinite(p).all(), name, f"{len(p)} vertices", "finite")
    if len(p) > 1 and (p[0] == p[-1]).all():
        p = p[:-1]
    require(len(p) >= 3, name, f"{len(p)} vertices", "at least 3 vertices")
    require(is_simple(p), name, f"{len(p)} vertices", "free of repeated vertices and of edges that meet or cross")
    return p if signed_area(p) > 0 else p[::-1].copy()


def thinned(polygon, off):
    """The polygon (k, 2) m without vertices at most `off` (m) from the edges then left, by Douglas and Peucker's rule.

    Both ends of what lies on each side of its bounding box are kept, and so are its extent, a flat and its tip. Between
    two vertices kept the one furthest from the line between them is kept too, as long as it is further than `off`.
    """
    count, kept = len(polygon), np.zeros(len(polygon), bool)
    for seen in (polygon, -polygon):
        for axis in (0, 1):
            level = np.flatnonzero(seen[:, axis] < seen[:, axis].min() + LEVEL * np.ptp(seen[:, axis]))
            along = seen[level, 1 - axis]
            kept[level[[along.argmin(), along.argmax()]]] = True
    ends = np.flatnonzero(kept)
    runs = list(zip(ends, np.append(ends[1:], ends[0] + count)))
    while runs:
        first, last = runs.pop()
        between = polygon[np.arange(first + 1, last) % count]
        start, end = polygon[first % count], polygon[last % count]
        away = np.linalg.norm(between - nearest_on_edges(between, start[None], (end - start)[None])[0], axis=1)
        if away.max(initial=0.0) > off:
            # Of a side along the line the first: in spite of round-off its end.
            furthest = first + 1 + int(np.argmax(away > (1 - LEVEL) * away.max()))
            kept[furthest % count] = True
            runs += [(first, furthest), (furthest, last)]
    return polygon[kept]


def _chunks(points, edges):
    step = max(1, CHUNK // edges)
    return [slice(first, first + step) for first in range(0, len(points), step)]


def sides(polygon):
    """Sides of a polygon (k, 2) m, the edges between two corners: [(start (e, 2), edge (e, 2))]; one if no corners."""
    p = np.asarray(polygon, dtype=float)
    edge = np.roll(p, -1, axis=0) - p
    heading = np.arctan2(edge[:, 1], edge[:, 0])
    turn = np.abs(np.angle(np.exp(1j * (heading - np.roll(heading, 1)))))
    corners = np.flatnonzero(turn > CORNER)
    first = corners[0] if len(corners) else 0
    order = np.roll(np.arange(len(p)), -first)
    return [(p[run], edge[run]) for run in np.split(order, corners[1:] - first)]


def nearest_on_edges(points, start, edge):
    """Nearest points (n, 2) on the segments start → start + edge (k, 2) to points (n, 2) in m; their segments (n,)."""
    squared = (edge * edge).sum(1)
    foot, segment = np.empty_like(points), np.empty(len(points), dtype=np.intp)
    for chunk in _chunks(points, len(start)):
        x = points[chunk]
        rx, ry = x[:, :1] - start[:, 0], x[:, 1:] - start[:, 1]
        t = np.clip((rx * edge[:, 0] + ry * edge[:, 1]) / squared, 0.0, 1.0)
        best = ((rx - t * edge[:, 0]) ** 2 + (ry - t * edge[:, 1]) ** 2).argmin(1)
        segment[chunk] = best
        foot[chunk] = start[best] + t[np.arange(len(x)), best, None] * edge[best]
    return foot, segment


def inside(points, polygon):
    """(n,) bool, whether points (n, 2) are inside the polygon (k, 2), by the even-odd rule."""
    start = np.asarray(polygon, dtype=float)
    edge = np.roll(start, -1, axis=0) - start
    # the slope of a horizontal edge is not used: no point is between its ends in y
    slope = edge[:, 0] / np.where(edge[:, 1] == 0, 1.0, edge[:, 1])
    within = np.empty(len(points), dtype=bool)
    for chunk in _chunks(points, len(start)):
        rx, ry = points[chunk, :1] - start[:, 0], points[chunk, 1:] - start[:, 1]
        between = (ry >= 0) != (ry - edge[:, 1] >= 0)
        within[chunk] = (between & (rx < ry * slope)).sum(1) % 2 == 1
    return within


def nearest(points, polygon):
    """Signed distance, nearest boundary point and outward normal of points (n, 2), polygon counter-clockwise.

    Returns distance (n,) in m, negative inside; foot (n, 2) in m; normal (n, 2), the unit gradient of the distance,
    (x − foot)/distance, or the nearest edge's outward normal for a point on the boundary itself.
    """
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    start = np.asarray(polygon, dtype=float)
    edge = np.roll(start, -1, axis=0) - start
    length = np.linalg.norm(edge, axis=1)
    foot, segment = nearest_on_edges(points, start, edge)
    away = points - foot
    distance = np.where(inside(points, start), -1.0, 1.0) * np.linalg.norm(away, axis=1)
    outward = (np.column_stack([edge[:, 1], -edge[:, 0]]) / length[:, None])[segment]
    on_boundary = (np.abs(distance) <= 1e-12 * length.max())[:, None]
    return distance, foot, np.where(on_boundary, outward, away / np.where(on_boundary, 1.0, distance[:, None]))


def signed_distance(points, polygon):
    """Distance (n,) in m of points (n, 2) m from a polygon (k, 2) m: negative inside. Raises as check_polygon."""
    return nearest(points, check_polygon(polygon))[0]


def tooth(*, height, width, rake, clearance, tip_radius, wear_flat=0.0, flat_angle=0.0):
    """Profile of a cutting tooth that moves in +x: vertices (k, 2) in m, counter-clockwise.

    The rake face is in front (+x), inclined backwards from the vertical by the rake angle `rake` (rad; negative:
    forwards). The clearance face is below and rises backwards (−x) from the horizontal by the clearance angle
    `clearance` (rad, at least 0). Both are tangent to the tip circle of radius `tip_radius` (m, 0: sharp), which
    touches the lines x = 0 and y = 0: the lowest point of the tooth is at y = 0, x = −tip_radius, and the foremost
    point of the tip at x = 0 unless `rake` is negative. The top is horizontal at y = `height` (m) and `width` (m) long;
    the back is vertical. A worn tooth has a flat of the length `wear_flat` (m) behind the tip circle, at whose end the
    clearance face begins. It lies along y = 0, or leans by `flat_angle` (rad, at least 0) into the rock, so that its
    heel is the lowest point, at y = 0, and the tip circle that much higher.

    The wedge angle is β = π/2 − rake − clearance. The tangent points are at tip_radius/tan(β/2) from the sharp edge, so
    that rounding removes the area tip_radius² (1/tan(β/2) − (π − β)/2) where there is no flat. The arc is divided into
    chords with a sagitta of at most ARC_CHORD_ERROR times its radius.

    Raises ParameterError for lengths that are not positive, angles that leave no wedge, and a tip circle or a clearance
    face that does not fit between top, back and rake face.
    """
    height, width = positive("height", height, "m"), positive("width", width, "m")
    rake, clearance = finite("rake", rake, "rad"), not_negative("clearance", clearance, "rad")
    tip_radius, wear_flat = not_negative("tip_radius", tip_radius, "m"), not_negative("wear_flat", wear_flat, "m")
    flat_angle = not_negative("flat_angle", flat_angle, "rad")
    require(abs(rake) < math.pi / 2, "rake", rake, "between -90 and 90 degrees, both excluded", "rad")
    require(clearance < math.pi / 2, "clearance", clearance, "less than 90 degrees", "rad")
    wedge = math.pi / 2 - rake - clearance
    require(wedge > 0, "rake", rake, f"less than 90 degrees minus the clearance, {90 - math.degrees(clearance):g}",
            "rad")
    require(flat_angle < math.pi / 2 + rake, "flat_angle", flat_angle,
            f"less than 90 degrees plus the rake, {90 + math.degrees(rake):g}", "rad")

    # directions of the outward normals of the two faces (or of the flat), between which the arc extends
    first, last = -math.pi / 2 + (flat_angle if wear_flat else -clearance), rake
    pieces = max(1, math.ceil((last - first) / (2 * math.acos(1 - ARC_CHORD_ERROR)))) if tip_radius > 0 else 0
    turn = np.linspace(first, last, pieces + 1)
    tip = tip_radius * np.column_stack([np.cos(turn) - 1, np.sin(turn) + 1])
    if wear_flat:
        tip = np.vstack([tip[0] - wear_flat * np.array([math.cos(flat_angle), math.sin(flat_angle)]), tip])
        tip[:, 1] -= tip[0, 1]
    (heel_x, heel_y), (front_x, front_y) = tip[0], tip[-1]
    # A long flat that leans lifts what is before it.
    lifts = ("wear_flat", wear_flat) if wear_flat * math.sin(flat_angle) > tip_radius else ("tip_radius", tip_radius)
    require(front_y < height, *lifts, "so small that the rake face begins below the top", "m")
    top_x = front_x - (height - front_y) * math.tan(rake)
    back_x = top_x - width
    require(back_x < heel_x, "width", width, f"greater than {top_x - heel_x:g}: the back must lie behind the tip", "m")
    back_y = heel_y + (heel_x - back_x) * math.tan(clearance)
    require(back_y < height, "clearance", clearance, "so small that its face meets the back below the top", "rad")
    return check_polygon(np.vstack([tip, [[top_x, height], [back_x, height], [back_x, back_y]]]), "tooth")


def read_outline(path):
    """Polygon (k, 2) in m from a CSV file of x, y rows, counter-clockwise whatever the file's order.

    Between x and y is a comma, a semicolon or a tab, and numbers have points. One header line is allowed, of words
    without numbers and of no other unit than m; blank lines and lines that begin with # are skipped. Raises
    ParameterError (outline) for a file that cannot be read, a row that is not two numbers, more than MAX_VERTICES, and
    as check_polygon.
    """
    vertices = []
    for place, (line, row) in enumerate(read_cells(path, "outline", comment="#")):
        try:
            x, y = map(float, row)
        except ValueError:
            if place == 0 and not any(re.match(r"\s*[-+.\d]", cell) for cell in row):
                _check_header(path, row)
                continue
            raise ParameterError("outline", path, f"two numbers a row, unlike line {line}: {','.join(row)}") from None
        vertices.append((x, y))
    require(len(vertices) <= MAX_VERTICES, "outline", f"{path}, {len(vertices)} vertices", f"of at most {MAX_VERTICES}")
    try:
        return check_polygon(np.reshape(vertices, (-1, 2)), "outline")
    except ParameterError as error:
        raise ParameterError("outline", f"{path}, {error.value}", error.rule) from None


def _check_header(path, row):
    other = [word for cell in row for word in re.findall("[a-zµ]+", cell.lower()) if word in OTHER_UNITS]
    require(not other, "outline", f"{path}, {','.join(row)}", "in m")


def tip_vertex(vertices):
    """Number of the vertex at the tip of a tool that moves in +x: the foremost of its lowest ones (n, 2 or 3) m."""
    x, y = vertices[:, 0], vertices[:, 1]
    return int(np.argmax(np.where(y < y.min() + LEVEL * np.ptp(y), x, -np.inf)))


def tip(vertices):
    """(2,) m, the tip of a tool of vertices (n, 2 or 3) m: as far in front as tip_vertex, as low as the lowest one."""
    return np.array([vertices[tip_vertex(vertices), 0], vertices[:, 1].min()])


def reach(polygon, heights):
    """Largest x (m) of a polygon (k, 2) m at each of the heights y (any shape, m), -inf where it has none."""
    heights = np.asarray(heights, float)
    found = np.full(heights.shape, -np.inf)
    for (x, y), (dx, dy) in zip(polygon, np.roll(polygon, -1, axis=0) - polygon):
        if dy == 0.0:
            at, inside_edge = np.full(heights.shape, max(x, x + dx)), heights == y
        else:
            part = (heights - y) / dy
            at, inside_edge = x + part * dx, (part >= 0) & (part <= 1)
        found = np.where(inside_edge, np.maximum(found, at), found)
    return found


def nearest_arc(points, along, arc):
    """(m,) m, arc length of the contour point nearest to each point (m, 2) m; along, arc: from `contour`."""
    return arc[cKDTree(along).query(points)[1]]


def contour(outline, spacing):
    """Points (n, 2) m every `spacing` m along a polygon (k, 2) m, and their arc length (n,) m from its tip.

    The arc length is positive up the front (greater x) and negative along the clearance face; ascending.
    """
    x, y = outline.T
    if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0:
        outline = outline[::-1]
    closed = np.roll(outline, -tip_vertex(outline), axis=0)
    closed = np.vstack([closed, closed[:1]])
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    arc = np.arange(0, way[-1], spacing)
    points = np.column_stack([np.interp(arc, way, closed[:, k]) for k in (0, 1)])
    arc = np.where(arc > way[-1] / 2, arc - way[-1], arc)
    order = np.argsort(arc)
    return points[order], arc[order]

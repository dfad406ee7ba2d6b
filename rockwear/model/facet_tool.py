"""The tool as a closed boundary of facets: segments from an outline, triangles from an STL file or a drawn-out
outline."""
import math
import warnings

import numpy as np

from rockwear.kernels.boundary import area_vectors, check_boundary, distance, foremost, held_sides, refine, segments
from rockwear.kernels.checks import ParameterError, positive, require
from rockwear.kernels.polygon import area, check_polygon, perimeter, thinned
from rockwear.kernels.worn_boundary import WornBoundary


MOST_FACETS = 20_000
"""A tool may have: by then an update of its wear takes seconds."""
CUT_OFF = 1e-3
"""Largest distance of a vertex left out from the outline, over the length of a segment."""


def check_size(name, size, least):
    """Raise ParameterError (name) for facets of a size (m) less than `least`, of which the tool would have too many."""
    require(size >= least, name, size, f"at least {least:.3g}: the tool would have more than {MOST_FACETS} facets", "m")


class FacetTool:
    """A rigid tool whose facets are worn. vertices (n, d) m, facets (m, d), density kg/m3, d = 2 or 3.

    It moves in +x, y is up (and z across, in space). The facets of its top and of its back are held by the shank:
    they are never worn and stay in their planes, unless `fixed` (m,) bool says others.
    """

    def __init__(self, *, vertices, facets, density, fixed=None):
        vertices, facets = check_boundary(vertices, facets, "tool")
        self.first, self.first_facets = vertices, facets
        self.density = positive("tool_density", density, "kg/m3")
        if fixed is None:
            fixed = held_sides(vertices, facets).any(axis=0)
        self.boundary = WornBoundary(vertices=vertices, facets=facets, fixed=fixed)
        self.count = len(facets)

    @classmethod
    def of_outline(cls, polygon, *, segment, density):
        """Segments of at most `segment` m along a polygon (k, 2), longer ones cut in halves.

        Vertices that stand closer than its shape needs are left out: no more than CUT_OFF of `segment` is cut off the
        outline, and of its area no more than that part.
        """
        check_size("segment", segment, perimeter(polygon) / MOST_FACETS)
        off = CUT_OFF * min(positive("segment", segment, "m"), area(polygon) / perimeter(polygon))
        vertices, facets = refine(*segments(thinned(check_polygon(polygon), off)), segment)
        return cls(vertices=vertices, facets=facets, density=density)

    blunted = 0.0
    """m by which its lowest point lies above the outline's tip."""

    @property
    def area(self):
        """m2 of the new outline; in space the volume, m3."""
        return self.boundary.first_volume

    @property
    def positions(self):
        """(m, d) m, the middles of the facets as they were made."""
        return self.first[self.first_facets].mean(axis=1)

    @property
    def areas(self):
        """(m,) m2 of the facets as they were made; in the plane lengths, m."""
        return np.linalg.norm(area_vectors(self.first, self.first_facets), axis=1)

    @property
    def worn_depth(self):
        """(n,) m by which the surface has gone back from each of its first vertices: from there to what is nearest of
        it.

        On a face that is the recession along its normal; at an edge that has become another, the way to the nearest of
        it. It depends on the two shapes alone, whatever vertices and facets they are made of.
        """
        return distance(self.first, self.boundary.vertices, self.boundary.facets)

    @property
    def depth_below(self):
        """(n,) m from each vertex as it is now to the surface as it was made."""
        return distance(self.boundary.vertices, self.first, self.first_facets)

    def foremost(self, below):
        """Largest x that the tool has below the height `below` (both m, in its own frame), -inf for none."""
        return foremost(self.boundary.vertices, self.boundary.facets, below)


def corners(vertices, facets):
    """(m, 3, 3) m, corners of the triangles that stand for the facets in YADE.

    A segment P-Q becomes one isosceles triangle with its base across the plane at P and its apex at Q: its section with
    the plane is the segment, and the point nearest to any disc's centre lies in the plane.
    """
    if vertices.shape[1] == 3:
        return vertices[facets]
    begin, end = (np.column_stack([vertices[facets[:, k]], np.zeros(len(facets))]) for k in (0, 1))
    half = np.linalg.norm(end - begin, axis=1, keepdims=True) / np.sqrt(3) * [0, 0, 1]
    return np.stack([begin - half, begin + half, end], axis=1)


def incentres(triangles):
    """(m, 3) m, centres of the inscribed circles, which YADE takes for the centres of its facets."""
    opposite = np.linalg.norm(np.roll(triangles, -1, axis=1) - np.roll(triangles, -2, axis=1), axis=2)
    return np.einsum("mk,mkd->md", opposite, triangles) / opposite.sum(axis=1)[:, None]


def read_stl(path, *, scale=1.0, most=math.inf):
    """(vertices (n, 3) m, facets (m, 3)) of an STL file, binary or text, its numbers times `scale`; equal corners are
    one.

    Raises ParameterError (stl) for a file that cannot be read, has more than `most` triangles, or a surface that is
    open, flipped, folded or inside out.
    """
    positive("scale", scale)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from stl.mesh import Mesh
            triangles = np.array(Mesh.from_file(str(path), calculate_normals=False).vectors, float)
    except ImportError:
        raise ParameterError("stl", str(path), "readable: the Debian package python3-stl is missing") from None
    except TypeError:
        # What numpy-stl says of an empty file.
        triangles = np.empty((0, 3, 3))
    except (OSError, RuntimeError, ValueError, AssertionError) as error:
        raise ParameterError("stl", str(path), f"a readable STL file ({str(error).splitlines()[0]})") from None
    require(len(triangles), "stl", str(path), "a file of triangles: it holds none")
    require(len(triangles) <= most, "stl", f"{path}, {len(triangles)} triangles", f"a tool of at most {most:g}")
    require(np.isfinite(triangles).all(), "stl", str(path), "a file of triangles with finite corners")
    points, number = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    try:
        return check_boundary(points * scale, number.reshape(-1, 3))
    except ParameterError as error:
        raise ParameterError("stl", f"{path}, {error.value}", error.rule, error.unit) from None


def write_stl(path, vertices, facets):
    """Write triangles (m, 3) of vertices (n, 3) as a binary STL file; its numbers have single precision."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from stl.mesh import Mesh
    mesh = Mesh(np.zeros(len(facets), dtype=Mesh.dtype))
    mesh.vectors[:] = np.asarray(vertices)[facets]
    mesh.update_normals()
    with open(path, "wb") as file:
        # numpy-stl's own header has the time and the path: no two files of one tool would be the same.
        file.write(b"rockwear, m".ljust(80) + np.array(len(facets), "<u4").tobytes())
        mesh.data.tofile(file)

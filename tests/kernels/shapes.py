"""Boundaries that tests of facets share, and their exact volume."""
import math
from fractions import Fraction

import numpy as np

from rockwear.kernels.boundary import prism, segments
from rockwear.kernels.polygon import tooth

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]) * 0.01
BLADE = np.array([[-1, 0], [1, 0], [1, 20], [-1, 20.0]]) * 1e-3
TOOTH = tooth(height=0.07, width=0.045, rake=0.0, clearance=math.radians(3), tip_radius=4e-3)


def cube(size=1.3e-3):
    return prism(SQUARE, 0.01, size)


def ring(sides, radius=0.01):
    angle = 2 * np.pi * np.arange(sides) / sides
    return segments(radius * np.column_stack([np.cos(angle), np.sin(angle)]))


def sphere(fineness=4, radius=0.01):
    """An octahedron whose facets are divided in four `fineness` times, its vertices on the sphere."""
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    facets = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(fineness):
        a, b, c = (vertices[facets[:, k]] for k in range(3))
        corners = np.stack([a, b, c, a + b, b + c, c + a])
        corners /= np.linalg.norm(corners, axis=2, keepdims=True)
        parts = [corners[[0, 3, 5]], corners[[3, 1, 4]], corners[[5, 4, 2]], corners[[3, 4, 5]]]
        triangles = np.concatenate([part.transpose(1, 0, 2) for part in parts])
        vertices, number = np.unique(triangles.reshape(-1, 3).round(12), axis=0, return_inverse=True)
        facets = number.reshape(-1, 3)
    return vertices * radius, facets


def exact_volume(vertices, facets):
    """In rational numbers, of the coordinates as they are stored."""
    points = [[Fraction(x) for x in point] for point in vertices.tolist()]
    total = Fraction(0)
    for facet in facets.tolist():
        if len(facet) == 2:
            (a, b), (c, d) = (points[i] for i in facet)
            total += a * d - b * c
        else:
            a, b, c = (points[i] for i in facet)
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                      + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return total / math.factorial(len(facets[0]))

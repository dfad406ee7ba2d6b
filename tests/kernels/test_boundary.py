"""How far points are from a boundary of facets, and how far a worn one has gone back."""
import numpy as np
import pytest

from rockwear.kernels.boundary import distance, nearest_on_triangle, prism, refine, segments

SQUARE = np.array([[0, 0], [0.04, 0], [0.04, 0.03], [0, 0.03]])


def shape(dimension):
    return prism(SQUARE, 0.02, 6e-3) if dimension == 3 else refine(*segments(SQUARE), 6e-3)


def test_distance_from_triangles_is_that_of_the_nearest_point_of_each():
    vertices, facets = shape(3)
    points = np.random.default_rng(0).uniform(-0.02, 0.06, (60, 3))
    exact = [min(np.linalg.norm(nearest_on_triangle(point, corners) - point) for corners in vertices[facets]) for point in points]
    assert distance(points, vertices, facets) == pytest.approx(np.array(exact), rel=1e-12)
    assert distance(np.empty((0, 3)), vertices, facets).shape == (0,)


def test_distance_from_segments_is_that_of_the_box():
    points = np.random.default_rng(0).uniform(-0.02, 0.06, (60, 2))
    outside = np.maximum(np.abs(points - SQUARE.mean(axis=0)) - 0.5 * np.ptp(SQUARE, axis=0), 0)
    inner = (points[:, 0] > 0) & (points[:, 0] < 0.04) & (points[:, 1] > 0) & (points[:, 1] < 0.03)
    depth = np.minimum(points, SQUARE.max(axis=0) - points).min(axis=1)
    exact = np.where(inner, depth, np.linalg.norm(outside, axis=1))
    assert distance(points, *shape(2)) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_worn_depth_is_the_recession_of_a_face_whatever_way_its_vertices_went(dimension):
    first, facets = shape(dimension)
    vertices = first.copy()
    front = np.isclose(first[:, 0], 0.04)
    vertices[front, 0] -= 2e-3
    # Those inside the face slide along it as well, and some of the sound top slide along that.
    inside = front & (first[:, 1] > 0.004) & (first[:, 1] < 0.026)
    vertices[inside, 1] += 1e-3
    top = np.isclose(first[:, 1], 0.03) & (first[:, 0] > 0.01) & (first[:, 0] < 0.03)
    vertices[top, 0] += 1e-3
    depth = distance(first, vertices, facets)
    assert inside.any() and top.any()
    assert depth[front] == pytest.approx(np.full(front.sum(), 2e-3), rel=1e-12)
    assert depth[~front] == pytest.approx(np.zeros((~front).sum()), abs=1e-15)

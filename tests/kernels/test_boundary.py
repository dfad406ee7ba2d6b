"""Boundaries of facets: what is refused, refinement, crossings, distances, and how far a worn one has receded."""
import numpy as np
import pytest

from rockwear.kernels.boundary import (
    altitudes, check_boundary, crossings, distance, foremost, nearest_on_triangle, prism, refine, segments, volume)
from rockwear.kernels.checks import ParameterError
from tests.kernels.shapes import SQUARE, TOOTH, cube, exact_volume, ring, sphere

BOX = np.array([[0, 0], [0.04, 0], [0.04, 0.03], [0, 0.03]])


# ---- what is refused

@pytest.mark.parametrize("make", [cube, lambda: ring(20), sphere, lambda: prism(TOOTH, 0.02, 3e-3)])
def test_sound_boundaries_pass(make):
    vertices, facets = check_boundary(*make())
    assert volume(vertices, facets) > 0
    assert float(exact_volume(vertices, facets)) == pytest.approx(volume(vertices, facets), rel=1e-12)


def damaged(kind):
    vertices, facets = cube()
    if kind == "hole":
        return vertices, facets[:-1]
    if kind == "flipped":
        facets[7] = facets[7, ::-1]
    if kind == "inside out":
        return vertices, facets[:, ::-1]
    if kind == "flat":
        vertices[facets[3, 0]] = vertices[facets[3, 1]]
    if kind == "nan":
        vertices[5, 1] = np.nan
    if kind == "crossing":
        return np.vstack([vertices, vertices + 5e-3]), np.vstack([facets, facets + len(vertices)])
    if kind == "unknown":
        facets[0, 0] = len(vertices)
    return vertices, facets


@pytest.mark.parametrize("kind, words", [
    ("hole", "closed: it has holes"), ("flipped", "some facets are flipped"), ("inside out", "normals outwards"),
    ("flat", "free of degenerate facets"), ("nan", "finite"), ("unknown", "known vertices"),
    ("crossing", "facets that intersect")])
def test_damaged_boundaries_are_refused(kind, words):
    with pytest.raises(ParameterError, match=words):
        check_boundary(*damaged(kind), name="stl")


@pytest.mark.parametrize("facets, words", [
    ([[0, 1], [1, 2], [2, 3]], "holes"), ([[0, 1], [2, 1], [2, 3], [3, 0]], "flipped")])
def test_damaged_polygons_are_refused(facets, words):
    with pytest.raises(ParameterError, match=words):
        check_boundary(SQUARE, facets)


# ---- meshes

@pytest.mark.parametrize("make", [cube, lambda: ring(7), lambda: segments(TOOTH)])
def test_refining_keeps_the_shape_and_the_boundary_closed(make):
    vertices, facets = check_boundary(*make())
    fine = check_boundary(*refine(vertices, facets, 7e-4))
    assert volume(*fine) == pytest.approx(volume(vertices, facets), rel=1e-12)
    corners = fine[0][fine[1]]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max() <= 7e-4 * (1 + 1e-9)


def test_a_prism_has_the_volume_of_its_polygon():
    vertices, facets = check_boundary(*cube(2e-3))
    assert volume(vertices, facets) == pytest.approx(1e-6, rel=1e-12)
    assert altitudes(vertices, facets).min() > 0.5e-3


def test_segments_that_cross_are_found():
    bow = np.array([[0, 0], [1, 1], [1, 0], [0, 1.0]])
    assert len(crossings(bow, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))) == 1
    assert len(crossings(*segments(TOOTH))) == 0


def test_triangles_that_run_through_each_other_are_found():
    corner = np.vstack([np.zeros(3), np.eye(3)])
    facets = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    both = np.vstack([facets, facets + 4])
    assert len(crossings(np.vstack([corner, corner + 0.2]), both)) == 3
    assert len(crossings(np.vstack([corner, corner + 0.4]), both)) == 0
    assert len(crossings(np.vstack([20 * corner - 5, corner]), both)) == 0
    assert len(crossings(np.vstack([20 * corner - 0.2, corner]), both)) == 0
    assert len(crossings(np.vstack([20 * corner - [0.2, 0.2, -0.5], corner]), both)) == 3
    assert len(crossings(*sphere())) == 0
    vertices = np.vstack([corner, corner + 0.2, corner + 5])
    for moved, found in (range(4), 3), (range(4, 8), 3), ([5], 1), ([0], 0), (range(8, 12), 0):
        assert len(crossings(vertices, np.vstack([both, facets + 8]), np.isin(range(12), moved))) == found


@pytest.mark.parametrize("point, nearest", [
    ((0.2, 0.2, 1), (0.2, 0.2, 0)), ((-1, 0.5, 1), (0, 0.5, 0)), ((2, -1, 0), (1, 0, 0)), ((1, 1, 3), (0.5, 0.5, 0))])
def test_nearest_point_of_a_triangle(point, nearest):
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    assert nearest_on_triangle(np.array(point, float), triangle) == pytest.approx(np.array(nearest, float))


# ---- distance

def shape(dimension):
    return prism(BOX, 0.02, 6e-3) if dimension == 3 else refine(*segments(BOX), 6e-3)


def test_distance_from_triangles_is_that_of_the_nearest_point_of_each():
    vertices, facets = shape(3)
    points = np.random.default_rng(0).uniform(-0.02, 0.06, (20, 3))
    exact = [min(np.linalg.norm(nearest_on_triangle(point, corners) - point) for corners in vertices[facets])
             for point in points]
    assert distance(points, vertices, facets) == pytest.approx(np.array(exact), rel=1e-12)
    assert distance(np.empty((0, 3)), vertices, facets).shape == (0,)


def test_distance_from_segments_is_that_of_the_box():
    points = np.random.default_rng(0).uniform(-0.02, 0.06, (60, 2))
    outside = np.maximum(np.abs(points - BOX.mean(axis=0)) - 0.5 * np.ptp(BOX, axis=0), 0)
    inner = (points[:, 0] > 0) & (points[:, 0] < 0.04) & (points[:, 1] > 0) & (points[:, 1] < 0.03)
    depth = np.minimum(points, BOX.max(axis=0) - points).min(axis=1)
    exact = np.where(inner, depth, np.linalg.norm(outside, axis=1))
    assert distance(points, *shape(2)) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_worn_depth_is_the_recession_of_a_face_whatever_way_its_vertices_went(dimension):
    first, facets = shape(dimension)
    vertices = first.copy()
    front = np.isclose(first[:, 0], 0.04)
    vertices[front, 0] -= 2e-3
    # Those inside the face slide along it as well, and some of the unworn top slide along that.
    inside = front & (first[:, 1] > 0.004) & (first[:, 1] < 0.026)
    vertices[inside, 1] += 1e-3
    top = np.isclose(first[:, 1], 0.03) & (first[:, 0] > 0.01) & (first[:, 0] < 0.03)
    vertices[top, 0] += 1e-3
    depth = distance(first, vertices, facets)
    assert inside.any() and top.any()
    assert depth[front] == pytest.approx(np.full(front.sum(), 2e-3), rel=1e-12)
    assert depth[~front] == pytest.approx(np.zeros((~front).sum()), abs=1e-15)


# ---- where it ends in front

@pytest.mark.parametrize("extent", [segments, lambda polygon: prism(polygon, 0.02, 1.0)])
def test_the_foremost_of_a_leaning_face_is_where_its_edge_crosses_the_height(extent):
    """Whatever the length of its edges; a face that leans back ends at its foot."""
    forwards, level = extent(np.array([[0, 0], [1, 2], [0, 2.0]])), [0.5, 0.75, 2.0, 3.0]
    assert [foremost(*forwards, below=y) for y in level] == [0.25, 0.375, 1.0, 1.0]
    backwards = extent(np.array([[0, 0], [1, 0], [0, 2.0]]))
    assert [foremost(*backwards, below=y) for y in level] == [1.0, 1.0, 1.0, 1.0]
    assert foremost(*backwards, below=0.0) == -np.inf


def test_the_foremost_of_a_face_with_a_bulge_is_a_vertex():
    assert foremost(*segments(np.array([[0, 0], [3, 1], [1, 3], [0, 3.0]])), below=2.0) == 3.0

"""STL files in and out, and the triangles that stand for facets."""
import math
import struct

import numpy as np
import pytest

from rockwear.model.facet_tool import FacetTool, corners, incentres, read_stl, write_stl
from rockwear.kernels.boundary import distance, nearest_on_triangle, prism, volume
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.polygon import area, perimeter, tooth


TOOTH = tooth(height=0.07, width=0.045, rake=0.1, clearance=math.radians(5), tip_radius=4e-3)


def test_stl_there_and_back(tmp_path):
    vertices, facets = prism(TOOTH, 0.02, 6e-3)
    write_stl(tmp_path / "tooth.stl", vertices, facets)
    again = read_stl(tmp_path / "tooth.stl")
    assert len(again[0]) == len(vertices) and len(again[1]) == len(facets)
    assert volume(*again) == pytest.approx(volume(vertices, facets), rel=1e-6)
    assert volume(*read_stl(tmp_path / "tooth.stl", scale=2.0)) == pytest.approx(8 * volume(*again), rel=1e-12)


def test_two_files_of_one_tool_are_the_same(tmp_path):
    for name in ("tooth.stl", "another name.stl"):
        write_stl(tmp_path / name, *prism(TOOTH, 0.02, 6e-3))
    first, second = ((tmp_path / name).read_bytes() for name in ("tooth.stl", "another name.stl"))
    assert first == second and not first.startswith(b"solid")


def test_more_triangles_than_a_tool_may_have_are_refused(tmp_path):
    write_stl(tmp_path / "tooth.stl", *prism(TOOTH, 0.02, 6e-3))
    count = len(prism(TOOTH, 0.02, 6e-3)[1])
    assert len(read_stl(tmp_path / "tooth.stl", most=count)[1]) == count
    with pytest.raises(ParameterError, match=f"stl = .*tooth.stl, {count} triangles: must be a tool of at most "):
        read_stl(tmp_path / "tooth.stl", most=count - 1)


def test_stl_as_text(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    lines = ["solid pick"]
    for facet in ([0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]):
        places = ("vertex %g %g %g" % tuple(points[i]) for i in facet)
        lines += ["facet normal 0 0 0", "outer loop", *places, "endloop", "endfacet"]
    (tmp_path / "pick.stl").write_text("\n".join([*lines, "endsolid pick", ""]), encoding="utf-8")
    assert volume(*read_stl(tmp_path / "pick.stl")) == pytest.approx(1 / 6)


def broken(kind, path):
    vertices, facets = prism(TOOTH, 0.02, 6e-3)
    if kind == "hole":
        facets = facets[1:]
    if kind == "flipped":
        facets[5] = facets[5, ::-1]
    if kind == "inside out":
        facets = facets[:, ::-1]
    write_stl(path, vertices, facets)


@pytest.mark.parametrize("kind, words", [("hole", "holes"), ("flipped", "flipped"), ("inside out", "normals outwards")])
def test_damaged_surfaces_are_refused(kind, words, tmp_path):
    broken(kind, tmp_path / "tooth.stl")
    with pytest.raises(ParameterError, match=words) as caught:
        read_stl(tmp_path / "tooth.stl")
    assert str(caught.value).startswith("stl = ") and "\n" not in str(caught.value)


@pytest.mark.parametrize("content", [
    None, b"", b"not a mesh", b"solid\nfacet normal 0 0", b"\0" * 80 + struct.pack("<I", 900)])
def test_unreadable_files_are_refused(content, tmp_path):
    if content is not None:
        (tmp_path / "tooth.stl").write_bytes(content)
    with pytest.raises(ParameterError) as caught:
        read_stl(tmp_path / "tooth.stl")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("content", [b"", b"solid x\nendsolid x\n", b"\0" * 84])
def test_a_file_without_a_triangle_is_said_to_hold_none(content, tmp_path):
    (tmp_path / "tooth.stl").write_bytes(content)
    with pytest.raises(ParameterError, match="tooth.stl: must be a file of triangles: it holds none$"):
        read_stl(tmp_path / "tooth.stl")


def test_a_segment_in_yade_is_a_triangle_whose_nearest_point_lies_in_the_plane():
    vertices, facets = np.array([[0, 0], [1, 0.5], [0.2, 2]]) * 1e-3, np.array([[0, 1], [1, 2], [2, 0]])
    chance = np.random.default_rng(0)
    for triangle, (i, j) in zip(corners(vertices, facets), facets):
        p, along = vertices[i], vertices[j] - vertices[i]
        for point in chance.uniform(-1e-3, 3e-3, (30, 2)):
            exact = np.append(p + along * np.clip((point - p) @ along / (along @ along), 0, 1), 0.0)
            assert nearest_on_triangle(np.append(point, 0.0), triangle) == pytest.approx(exact, abs=1e-15)


def test_the_incentre_is_as_far_from_all_sides():
    triangles = np.random.default_rng(1).random((20, 3, 3))
    for triangle, centre in zip(triangles, incentres(triangles)):
        sides = [(triangle[k], triangle[(k + 1) % 3]) for k in range(3)]
        away = [np.linalg.norm(np.cross(q - p, centre - p)) / np.linalg.norm(q - p) for p, q in sides]
        assert away == pytest.approx([away[0]] * 3, rel=1e-12)


def test_top_and_back_are_fixed_to_the_shank():
    tool = FacetTool.of_outline(TOOTH, segment=2e-3, density=7830.0)
    fixed = tool.first[tool.first_facets[tool.boundary.fixed]]
    rear = tool.first[:, 0].min() + 1e-12
    assert ((fixed[..., 1] > 0.07 - 1e-12).all(axis=1) | (fixed[..., 0] < rear).all(axis=1)).all()
    sides = np.linalg.norm(np.diff(fixed, axis=1), axis=2).sum()
    top, back = tool.first[tool.first[:, 1] > 0.07 - 1e-12], tool.first[tool.first[:, 0] < rear]
    assert sides == pytest.approx(np.ptp(top[:, 0]) + np.ptp(back[:, 1]), rel=1e-9)
    assert tool.foremost(below=0.01) == pytest.approx(0.0, abs=1e-4)


def test_a_tool_that_leans_forwards_ends_in_front_as_far_whatever_its_segments():
    leaning = tooth(height=0.03, width=0.025, rake=-math.radians(30), clearance=math.radians(3), tip_radius=1e-3)
    found = [FacetTool.of_outline(leaning, segment=size, density=7830.0).foremost(below=0.01) for size in (1e-3, 0.1)]
    exact = leaning[:, 0].max() - 0.02 * math.tan(math.radians(30))
    assert found == pytest.approx([exact, exact], rel=1e-12)


def finely(polygon, spacing):
    """The polygon with so many m between vertices, its own among them."""
    edges = zip(polygon, np.roll(polygon, -1, axis=0))
    return np.vstack([np.linspace(p, q, math.ceil(np.linalg.norm(q - p) / spacing), endpoint=False) for p, q in edges])


def in_order(vertices):
    """The vertices in an order of their own, without round-off."""
    return np.unique(vertices.round(12), axis=0)


SHARP = tooth(height=0.07, width=0.045, rake=0.1, clearance=math.radians(5), tip_radius=0, wear_flat=4e-3)


@pytest.mark.parametrize("size", [1e-3, 4e-3])
def test_segments_do_not_depend_on_how_finely_straight_sides_are_drawn(size):
    fine, few = finely(SHARP, 0.12e-3), FacetTool.of_outline(SHARP, segment=size, density=7830.0)
    assert len(fine) > 1500
    for vertices in (fine, np.roll(fine, 700, axis=0), fine[::-1]):
        tool = FacetTool.of_outline(vertices, segment=size, density=7830.0)
        np.testing.assert_allclose(in_order(tool.first), in_order(few.first), atol=1e-15)
        assert tool.boundary.fixed.sum() == few.boundary.fixed.sum()


def test_a_round_tip_drawn_finely_has_as_many_segments_as_its_shape_needs():
    """Arcs within a thousandth of a segment of their chords; corners, extent and area of the outline."""
    radius, size, turn = 4e-3, 1e-3, np.linspace(-math.pi / 2, 0, 1500)
    arc = radius * np.column_stack([np.cos(turn) - 1, np.sin(turn) + 1])
    outline = np.vstack([[[-0.045, 0]], arc, [[0, 0.07], [-0.045, 0.07]]])
    tool = FacetTool.of_outline(finely(outline, 0.2e-3), segment=size, density=7830.0)
    # Halves of a run are kept, so that chords are half as long as they may be, or longer.
    chord = math.sqrt(8 * radius * 1e-3 * size)
    at_tip = tool.positions[(tool.positions > -radius).all(axis=1) & (tool.positions[:, 1] < radius)]
    assert 0.5 * math.pi * radius / chord < len(at_tip) < 2.1 * 0.5 * math.pi * radius / chord + 2
    assert tool.count - len(at_tip) < 2.1 * perimeter(outline) / size
    for corner in outline[[0, -2, -1]]:
        assert (tool.first == corner).all(axis=1).any()
    assert tool.area == pytest.approx(area(outline), rel=1e-3)
    assert distance(outline, tool.first, tool.first_facets).max() <= 1e-3 * size


@pytest.mark.parametrize("values", [
    dict(height=0.07, width=0.045, rake=0.0, clearance=3.0, tip_radius=4e-3),
    dict(height=0.085, width=0.06, rake=25.0, clearance=12.0, tip_radius=5e-3),
    dict(height=0.15, width=0.15, rake=10.0, clearance=20.0, tip_radius=8e-3),
    dict(height=0.03, width=0.02, rake=10.0, clearance=10.0, tip_radius=2e-3),
    dict(height=0.012, width=0.01, rake=-5.0, clearance=5.0, tip_radius=5e-4)])
def test_the_teeth_of_the_scenes_keep_all_their_vertices(values):
    shape = tooth(**{**values, **{name: math.radians(values[name]) for name in ("rake", "clearance")}})
    tool = FacetTool.of_outline(shape, segment=1e-3, density=7830.0)
    assert (tool.first[:len(shape)] == shape).all()

"""Polygons: exact areas and distances, the tooth, outlines read from files."""
import math

import numpy as np
import pytest

from rockwear.kernels import polygon as outline
from rockwear.kernels.checks import ParameterError

SQUARE = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
ELL = np.array([[0.0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]])
TOOTH = {"height": 0.05, "width": 0.03, "rake": 0.1, "clearance": 0.15, "tip_radius": 0.002}


def test_area_and_perimeter():
    assert outline.area(SQUARE) == 4 and outline.perimeter(SQUARE) == 8
    assert outline.area(ELL) == 3 and outline.perimeter(ELL) == 8
    assert outline.signed_area(SQUARE[::-1]) == -4
    assert outline.area(SQUARE + 1e8) == 4
    turn = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    assert outline.area(np.column_stack([np.cos(turn), np.sin(turn)])) == pytest.approx(50 * math.sin(np.pi / 50))


def exact_square_distance(p):
    """Signed distance from the square [0, 2]²."""
    q = np.abs(p - 1) - 1
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0)


@pytest.mark.parametrize("polygon", [SQUARE, SQUARE[::-1], np.roll(SQUARE, 1, axis=0)])
def test_signed_distance_of_the_square(polygon):
    p = np.vstack([np.random.default_rng(1).uniform(-1, 3, (5000, 2)), SQUARE, [[1, 0], [1, 1], [0, -1], [-1, 2]]])
    assert outline.signed_distance(p, polygon) == pytest.approx(exact_square_distance(p), abs=1e-14)


def test_signed_distance_in_chunks(monkeypatch):
    p = np.random.default_rng(1).uniform(-1, 3, (1000, 2))
    whole = outline.signed_distance(p, ELL)
    monkeypatch.setattr(outline, "CHUNK", 100)
    assert (outline.signed_distance(p, ELL) == whole).all()


def test_reentrant_corner():
    p = np.array([[0.9, 0.8], [1.5, 1.5], [1.1, 1.1], [0.5, 0.5]])
    assert outline.signed_distance(p, ELL) == pytest.approx([-math.hypot(0.1, 0.2), 0.5, 0.1, -0.5])


def test_nearest_point_and_normal():
    p = np.array([[1, 0.1], [1, -0.1], [3, 3], [2, 1.0]])
    distance, foot, normal = outline.nearest(p, SQUARE)
    assert distance == pytest.approx([-0.1, 0.1, math.sqrt(2), 0])
    assert foot == pytest.approx(np.array([[1, 0], [1, 0], [2, 2], [2, 1]]))
    half = math.sqrt(0.5)
    assert normal == pytest.approx(np.array([[0, -1], [0, -1], [half, half], [1, 0]]))


def test_normal_is_the_gradient_of_the_distance():
    p = np.random.default_rng(3).uniform(-0.01, 0.06, (500, 2))
    shape, h = outline.tooth(**TOOTH), 1e-9
    distance, foot, normal = outline.nearest(p, shape)
    assert p == pytest.approx(foot + distance[:, None] * normal, abs=1e-15)
    slope = [(outline.signed_distance(p + h * e, shape) - outline.signed_distance(p - h * e, shape)) / (2 * h)
             for e in np.eye(2)]
    smooth = np.abs(np.linalg.norm(slope, axis=0) - 1) < 1e-4  # not on the ridge between two edges
    assert smooth.mean() > 0.98
    assert np.transpose(slope)[smooth] == pytest.approx(normal[smooth], abs=1e-4)


def sharp_area(height, width, rake, clearance):
    """Quadrilateral of rake face, top, vertical back and clearance face, sharp at the origin."""
    top = -height * math.tan(rake)
    back = top - width
    corners = np.array([[0, 0], [top, height], [back, height], [back, -back * math.tan(clearance)]])
    return outline.area(corners)


@pytest.mark.parametrize("rake, clearance", [(0.1, 0.15), (0.0, 0.0), (-0.3, 0.2), (0.6, 0.1)])
def test_tooth_area(rake, clearance):
    """Sharp wedge less what rounding takes; the chords take at most their sagitta along the arc."""
    shape = outline.tooth(**{**TOOTH, "rake": rake, "clearance": clearance})
    radius, wedge = 0.002, math.pi / 2 - rake - clearance
    # the circle that touches both faces has its centre at (-R, R); the sharp edge lies on its bisector
    apex = np.linalg.solve([[math.cos(rake), math.sin(rake)], [-math.sin(clearance), -math.cos(clearance)]],
                           [radius + (-radius * math.cos(rake) + radius * math.sin(rake)),
                            radius + (radius * math.sin(clearance) - radius * math.cos(clearance))])
    top = apex[0] - (0.05 - apex[1]) * math.tan(rake)
    back = top - 0.03
    sharp = outline.area([apex, [top, 0.05], [back, 0.05], [back, apex[1] + (apex[0] - back) * math.tan(clearance)]])
    lost = radius**2 * (1 / math.tan(wedge / 2) - (math.pi - wedge) / 2)
    arc = radius * (math.pi - wedge)
    assert sharp - lost - arc * 1e-3 * radius < outline.area(shape) <= sharp - lost + 1e-15
    assert lost > 5 * arc * 1e-3 * radius


def test_sharp_tooth():
    shape = outline.tooth(**{**TOOTH, "tip_radius": 0})
    assert len(shape) == 4 and (shape[0] == 0).all()
    assert outline.area(shape) == pytest.approx(sharp_area(0.05, 0.03, 0.1, 0.15), rel=1e-12)


def test_tooth_lies_as_documented():
    shape = outline.tooth(**TOOTH)
    assert outline.signed_area(shape) > 0
    sagitta = 1e-3 * 0.002
    assert shape[:, 1].min() == pytest.approx(0, abs=sagitta) and shape[:, 1].min() >= 0
    assert shape[:, 0].max() == pytest.approx(0, abs=sagitta) and shape[:, 0].max() <= 0
    assert shape[shape[:, 1].argmin(), 0] == pytest.approx(-0.002, abs=2e-4)
    top = shape[np.isclose(shape[:, 1], 0.05)]
    assert len(top) == 2 and np.ptp(top[:, 0]) == pytest.approx(0.03)
    edges = np.diff(shape[-4:], axis=0)
    assert math.atan2(-edges[0, 0], edges[0, 1]) == pytest.approx(0.1)  # rake face leans back
    heel = shape[0] - shape[-1]
    assert math.atan2(-heel[1], heel[0]) == pytest.approx(0.15)  # clearance face rises backwards
    arc = np.linalg.norm(shape[:-3] - [-0.002, 0.002], axis=1)
    assert arc == pytest.approx(np.full(len(arc), 0.002))


@pytest.mark.parametrize("change, name", [
    ({"height": 0}, "height"), ({"width": -1}, "width"), ({"tip_radius": -1e-3}, "tip_radius"),
    ({"rake": 1.5}, "rake"), ({"rake": -2.0}, "rake"), ({"rake": float("nan")}, "rake"),
    ({"clearance": -0.1}, "clearance"), ({"clearance": 1.6}, "clearance"),
    ({"tip_radius": 0.1}, "tip_radius"), ({"clearance": 1.2}, "clearance"),
    ({"width": 0.001, "rake": -0.5}, "width"), ({"wear_flat": -1e-3}, "wear_flat"), ({"wear_flat": 0.04}, "width"),
    ({"wear_flat": 0.12, "flat_angle": 0.5}, "wear_flat"),
    ({"flat_angle": -0.1}, "flat_angle"), ({"flat_angle": 0.5, "rake": -1.2}, "flat_angle"),
])
def test_tooth_errors(change, name):
    with pytest.raises(ParameterError) as error:
        outline.tooth(**{**TOOTH, **change})
    assert error.value.name == name and "\n" not in str(error.value)


def test_a_wear_flat_is_cut_off_the_clearance_face():
    """The flat lies on y = 0 from the lowest point of the tip circle to where the clearance face begins."""
    shape = outline.tooth(**TOOTH, wear_flat=0.004)
    assert shape[0] == pytest.approx([-0.006, 0.0], abs=1e-15) and shape[1] == pytest.approx([-0.002, 0.0], abs=1e-15)
    heel = shape[0] - shape[-1]
    assert math.atan2(-heel[1], heel[0]) == pytest.approx(0.15)
    # Against a tooth without clearance the wedge below the clearance face behind the flat is missing.
    level = outline.tooth(**{**TOOTH, "clearance": 0.0})
    behind = shape[0, 0] - shape[-1, 0]
    assert outline.area(level) - outline.area(shape) == pytest.approx(0.5 * behind**2 * math.tan(0.15))


def test_a_flat_that_leans_into_the_rock_has_its_heel_lowest_and_is_as_long():
    level, leaning = (outline.tooth(**TOOTH, wear_flat=0.004, flat_angle=angle) for angle in (0.0, 0.1))
    heel, begin, *_ = leaning
    assert heel[1] == 0 and leaning[1:, 1].min() == begin[1] == pytest.approx(0.004 * math.sin(0.1))
    assert begin[0] - heel[0] == pytest.approx(0.004 * math.cos(0.1))
    # The arc goes on from the flat: the tip circle is the same, and higher.
    raised = leaning[1:-3] - [0.0, begin[1] - 0.002 * (1 - math.cos(0.1))]
    assert np.hypot(*(raised - [-0.002, 0.002]).T) == pytest.approx(0.002)
    assert np.hypot(*(level[1:-3] - [-0.002, 0.002]).T) == pytest.approx(0.002)
    assert outline.tooth(**TOOTH, flat_angle=0.1).tolist() == outline.tooth(**TOOTH).tolist()


def test_thinning_keeps_corners_and_drops_what_lies_between():
    edge = np.linspace(0, 2, 41)[:-1, None]
    drawn = np.vstack([a + (b - a) * edge / 2 for a, b in zip(ELL, np.roll(ELL, -1, axis=0))])
    assert outline.thinned(drawn, 1e-6).tolist() == ELL.tolist()
    bent = np.array([[0.0, 0], [1, -0.1], [2, 0], [2.1, 1], [2, 2], [0, 2]])
    assert outline.thinned(bent, 0.099).tolist() == bent.tolist()
    # Both lie at the outer sides of the bounding box, where nothing is cut off.
    inwards = np.array([[0.0, 0], [1, 0.1], [2, 0], [2, 2], [0, 2]])
    assert len(outline.thinned(inwards, 0.099)) == 5 and len(outline.thinned(inwards, 0.101)) == 4


FLAT = np.array([[0.0, 0], [1, 0], [2, 0], [3, 2], [0, 2]])


@pytest.mark.parametrize("raised", [(0, 0, 0), (1e-18, 0, 2e-18), (0, 1e-7, 1e-7)])
def test_the_tip_is_the_front_end_of_a_flat_whatever_vertex_is_the_first(raised):
    """Also where round-off has raised it above the other vertices of the flat."""
    level = FLAT + np.pad(np.outer(raised, [0, 1]), [(0, 2), (0, 0)])
    for turned in (level, level[::-1]):
        for begin in range(len(level)):
            vertices = np.roll(turned, begin, axis=0)
            assert outline.tip(vertices).tolist() == [2, 0]
            points, arc = outline.contour(vertices, 0.125)
            assert points[arc == 0] == pytest.approx(np.array([[2, 0]]), abs=1e-6)
            flat = points[:, 1] < 1e-6
            assert flat.sum() == 17 and arc[flat] == pytest.approx(points[flat, 0] - 2, abs=1e-6)
            assert points[arc == 1.5] == pytest.approx(np.array([[2, 0] + 1.5 * np.sqrt([0.2, 0.8])]), abs=1e-6)


def test_the_tip_of_a_worn_tooth_is_ahead_of_its_flat():
    shape = outline.tooth(**TOOTH, wear_flat=0.004)
    points, arc = outline.contour(shape, 1e-4)
    flat = points[:, 1] < 1e-12
    assert outline.tip(shape) == pytest.approx([-0.002, 0], abs=1e-15)
    assert flat.sum() > 40 and arc[flat] == pytest.approx(points[flat, 0] + 0.002, abs=1e-9)


@pytest.mark.parametrize("text", ["x,y\n0,0\n0,2\n2,2\n2,0\n", "0,0\n2,0\n2,2\n0,2\n0,0\n",
                                  "# a square\n\n x [m], y [m]\n0, 0\n2, 0\n2, 2\n\n0, 2\n",
                                  "\ufeffx;y\n0;0\n2;0\n2;2\n0;2\n", "# x; y\n0\t0\n2.0\t0\n# a corner\n2\t2\n0\t2\n"])
def test_read_outline(tmp_path, text):
    path = tmp_path / "tool.csv"
    path.write_text(text, encoding="utf-8")
    shape = outline.read_outline(path)
    assert shape.shape == (4, 2) and outline.signed_area(shape) == 4


@pytest.mark.parametrize("text, rule", [
    ("", "at least 3"), ("x,y\n0,0\n1,0\n", "at least 3"), ("0,0\n1,0\n0,a\n", "line 3"),
    ("0,0\n1,0,0\n0,1\n", "line 2"), ("0.0l,0\n0,2\n2,2\n2,0\n", "line 1"), ("x_mm,y_mm\n0,0\n2,0\n2,2\n", "in m"),
    ("0,0\n1,nan\n0,1\n", "3 vertices: must be finite"), ("0,0\n1,1\n1,0\n0,1\n", "cross"),
    ("0,0\n1,0\n1,0\n0,1\n", "repeated"),
    ("0;0\n2;0\n2,5;2\n0;2\n", "two numbers a row, unlike line 3"), ("0\t0\n2,5\t0\n2\t2\n", "unlike line 2"),
    ("0,0\n2,5,0\n2,2\n", "unlike line 2"), ("0;0\n2,0\n2;2\n", "unlike line 2"), ("x [m];y [mm]\n0;0\n", "in m"),
    ("0,0\n1,0\n2,0\n", "cross"), ("0,0\n2,0\n2,2\n1,0\n0,2\n", "meet"), ("0,0\n2,0\n1,0\n1,1\n", "meet"),
])
def test_bad_outlines(tmp_path, text, rule):
    path = tmp_path / "tool.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError, match=rule) as error:
        outline.read_outline(path)
    assert error.value.name == "outline" and "\n" not in str(error.value)


def test_missing_outline(tmp_path):
    with pytest.raises(ParameterError, match="readable"):
        outline.read_outline(tmp_path / "nothing.csv")

"""Where a tooth begins: one with a flat by the front end of it, one that leans forwards by its foremost point."""
import math

import pytest

from tests.running import checks_of

RADIUS, BEFORE = 0.7, 1e-3 + 1.5e-3
"""m of the cutter; m from the foremost point of a pick to its entry: approach and largest disc."""


@pytest.fixture(scope="module")
def placed(tmp_path_factory):
    return checks_of("tooth_places", tmp_path_factory.mktemp("placed"))


def test_a_tooth_with_a_flat_lies_the_same_whatever_vertex_its_outline_begins_with(placed):
    first, *others = placed["flat"]
    assert len(others) > 20 and all(other == first for other in others)
    x, y, pivot, ahead = first["pick"]
    assert (x, y, pivot) == pytest.approx((-1e-3, 0.0, RADIUS), abs=1e-15)
    # From the tip to the front of its circle, less what its chords cut off.
    assert ahead * RADIUS - BEFORE == pytest.approx(1e-3, rel=1e-3)
    # Discs of 0.5 mm, 2 mm above the path, up to where the plane that rises from the tip reaches them.
    least = -1e-3 + (2e-3 + 0.5e-3 / math.cos(math.radians(20))) / math.tan(math.radians(20))
    assert first["steady"] == [-1e-3 + 1e-3 * k < least for k in range(14)]
    # The heel of a flat that leans is lower, and 4 mm behind the edge that cuts.
    assert placed["leaning flat"] == first["steady"]


def test_a_pick_that_leans_forwards_starts_clear_of_its_entry(placed):
    """Its face goes through the point of the tip circle that has the face's direction, and ends at feed, 60 mm up."""
    lean = math.radians(30)
    x, y = 1e-3 * math.cos(lean), 1e-3 - 1e-3 * math.sin(lean)
    front = x + (0.06 - y) * math.tan(lean)
    # From the lowest vertex of the chords, which is not right below the centre.
    assert placed["leaning"] * RADIUS - BEFORE == pytest.approx(front, abs=5e-5)

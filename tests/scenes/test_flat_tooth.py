"""A tooth with a flat: scenes place it by the front end of the flat."""
import math

import pytest

from tests.running import checks_of


def test_a_tooth_with_a_flat_lies_the_same_whatever_vertex_its_outline_begins_with(tmp_path):
    first, *others = checks_of("flat_tooth", tmp_path)
    assert len(others) > 20 and all(other == first for other in others)
    x, y, pivot, ahead = first["pick"]
    assert (x, y, pivot) == pytest.approx((-1e-3, 0.0, 0.7), abs=1e-15)
    # Approach, largest disc and the way from the tip to the front of its circle, less what its chords cut off.
    assert ahead * 0.7 == pytest.approx(1e-3 + 1.5e-3 + 1e-3, rel=1e-3)
    # Discs 2 mm above the path, of 0.5 mm: the plane of 20 degrees that rises from the tip reaches them at 5.957 mm.
    least = -1e-3 + (2e-3 + 0.5e-3 / math.cos(math.radians(20))) / math.tan(math.radians(20))
    assert first["steady"] == [-1e-3 + 1e-3 * k < least for k in range(14)]

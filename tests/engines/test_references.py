"""YADE keeps a reference to each element of a sequence that it is given: what we give it again and again is freed."""
import pytest

from tests.running import checks_of


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return checks_of("references", tmp_path_factory.mktemp("references"))


def test_engines_that_others_replace_are_freed_and_the_rest_goes_on(found):
    replaced = found["replaced"]
    assert replaced["loop"] == ["ForceResetter", "InsertionSortCollider", "InteractionLoop", "NewtonIntegrator"]
    assert replaced["freed"] == 200 and replaced["contacts"] == 599


def test_numbers_of_bodies_are_not_kept(found):
    """200 calls with new numbers, of two and of 600 bodies."""
    assert found["contact"] == found["states"] == 1
    assert found["bodies"] == [300, 301] and found["places"] == pytest.approx([297.0, 4.95])

"""The heat engine over thermal bodies: exact heat, exact exchange, closed balances, recession and restart."""
import pytest

from tests.running import checks_of

SPACES = ["plane", "space"]


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return checks_of("heat", tmp_path_factory.mktemp("heat"))


@pytest.mark.parametrize("space", SPACES)
def test_heat_of_rubbed_facets_arrives_in_the_body(found, space):
    got = found[space]["friction"]
    assert got["warm"] == got["nodes"] and len(got["warm"]) == 2
    assert got["spread"] > got["count"] / 2
    assert got["tool"] == pytest.approx(got["tool_exact"], rel=1e-12)
    assert got["rock"] == pytest.approx(got["rock_exact"], rel=1e-11)
    # A facet has the temperature of its node, the hottest one.
    assert got["hottest"] == pytest.approx(300.0, abs=1e-9)
    assert got["missing"] < 1e-14


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("contact", ["perfect", "moderate"])
def test_facets_of_one_node_exchange_heat_as_one_contact(found, space, contact):
    got = found[space]["exchange"][contact]
    assert got["gap"] == pytest.approx(got["exact"], rel=1e-12, abs=1e-9)
    assert got["mixture"] == pytest.approx(got["whole"], rel=1e-14)
    assert got["touch"] == pytest.approx(got["touch_exact"], rel=1e-12) and got["rock_mean"] == pytest.approx(300.0)


@pytest.mark.parametrize("space", SPACES)
def test_a_node_on_two_particles_does_not_overshoot(found, space):
    got = found[space]["shared"]
    for row in got["rows"]:
        assert row == pytest.approx(3 * [got["mixed"]], rel=1e-12)


@pytest.mark.parametrize("space", SPACES)
def test_free_surfaces_of_tool_and_rock_radiate(found, space):
    got = found[space]["radiating"]
    assert got["coldest"] < 900 and got["dark"] > 20 and got["rock_cooled"] > 0.1
    assert got["error"] < 0.5 and got["rock"] < 1e-3 * got["rock_cooled"]
    assert got["radiated"] < 0 and got["missing"] < 1e-13


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("acceleration", ["1.0", "10000.0"])
def test_a_receding_surface_takes_nodes_and_the_balance_closes(found, space, acceleration):
    got = found[space]["worn"][acceleration]
    assert got["dead"] >= 20 and got["gone"] and got["facets_alive"]
    assert got["missing"] < 1e-14 and got["shank"] == 0.0
    assert got["made"] > 100 and got["to_air"] > 0


@pytest.mark.parametrize("space", SPACES)
def test_accelerated_wear_leaves_its_heat_behind(found, space):
    slow, fast = (found[space]["worn"][acceleration] for acceleration in ("1.0", "10000.0"))
    assert slow["dead"] == fast["dead"] and slow["taken"] > 20
    assert abs(fast["taken"]) < 0.05 * slow["taken"] and fast["hottest"] > slow["hottest"]


@pytest.mark.parametrize("space", SPACES)
def test_a_restored_engine_goes_on_bit_for_bit(found, space):
    got = found[space]["restart"]
    assert got["same_at_once"] and got["same"] and got["dead"] >= 20


def test_friction_stays_where_it_arose_when_facets_change_places(found):
    got = found["remeshed"]
    assert got["moved"] > 5
    assert got["rise"] == pytest.approx(got["should"], rel=1e-9, abs=1e-9)


def test_a_whole_tool_replaces_a_worn_one(found):
    got = found["renewed"]
    assert got["dead"] > 20 and got["alive"] == got["count"] and got["missing"] < 1e-14


def test_other_rock_is_not_exposed_before_the_next_search_for_surfaces(found):
    got = found["rock renewed"]
    at_once, first, second, third = got["rows"]
    assert at_once == [350.0, 300.0] and got["replaced"] == pytest.approx(got["exact"], rel=1e-13)
    # The air has 280 K.
    assert first[0] == second[0] == 350.0 and 280.0 < third[0] < 349.99
    assert 300.0 > first[1] > second[1] > third[1] > 280.0 and got["missing"] < 1e-14


def test_rock_that_is_not_there_stays_as_warm_as_it_is(found):
    gone, there = found["absent"]
    assert gone == 300.0 and 280.0 < there < 299.9


def test_pieces_that_fall_off_take_no_heat_of_what_is_worn(found):
    kept, left = found["fallen"]
    assert kept > 1 and abs(left) < 1e-6 * kept


def test_spheres_in_space_close_their_balance(found):
    got = found["particles"]
    assert got["gone"] == 10 and got["hottest"] and got["shank"] == 0.0 and got["missing"] < 1e-14
    entries = got["entries"]
    assert entries["generated"] > 0 > max(entries["convected"], entries["removed"]) and entries["into_fixed"] != 0

"""Thermal bodies: nodes and pieces, free surface, exact conduction, nodes that a receding surface passes."""
from types import SimpleNamespace

import numpy as np
import pytest

from rockwear.kernels.boundary import area_vectors, prism, volume
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.conduction import HeatNetwork
from rockwear.kernels.polygon import tooth
from rockwear.kernels.voronoi import cells
from rockwear.model.facet_tool import FacetTool
from rockwear.model.materials import Material
from rockwear.model.particle_tool import LayeredTool
from rockwear.model.thermal_body import FacetBody, ParticleBody

STEEL = Material(density=8000.0, specific_heat=500.0, conductivity=60.0)
LENGTH, HEIGHT, BREADTH = 0.016, 0.008, 0.006
BLOCK = np.array([[0, 0], [LENGTH, 0], [LENGTH, HEIGHT], [0, HEIGHT]])


class Grid(SimpleNamespace):
    """Squares of 1 mm that fill BLOCK, in place of a packing."""

    def __init__(self):
        x, y = np.meshgrid(np.arange(16) + 0.5, np.arange(8) + 0.5)
        positions = 1e-3 * np.column_stack([x.ravel(), y.ravel()])
        super().__init__(positions=positions, radii=np.full(128, 0.5e-3), volumes=np.full(128, 1e-6),
                         fixed=positions[:, 1] > HEIGHT - 1e-3, cells=cells(positions, polygon=BLOCK))

    def paths(self, model, conductivity):
        assert model == "bar"
        return self.cells.edges, np.full(len(self.cells.edges), conductivity)


def of_facets(dimension):
    """A tool of facets in the shape of BLOCK, and the body behind it."""
    if dimension == 2:
        tool = FacetTool.of_outline(BLOCK, segment=0.5e-3, density=STEEL.density)
        return tool, FacetBody(tool, fill=Grid())
    vertices, facets = prism(BLOCK, BREADTH, 3e-3)
    tool = FacetTool(vertices=vertices, facets=facets, density=STEEL.density)
    return tool, FacetBody(tool, fill=Grid(), breadth=BREADTH)


def recede(tool, depth):
    """The bottom of the block wears evenly by `depth`."""
    areas = area_vectors(tool.boundary.vertices, tool.boundary.facets)
    size = np.linalg.norm(areas, axis=1)
    tool.boundary.wear(np.where(areas[:, 1] < -0.9 * size, size * depth, 0.0))


@pytest.fixture(scope="module")
def layered_tool():
    outline = tooth(height=0.02, width=0.012, rake=0.2, clearance=0.1, tip_radius=2e-3)
    return LayeredTool(vertices=outline, radius=0.7e-3, breadth=0.006, seed=1, removal="volume", density=STEEL.density)


# ---- what belongs to what

@pytest.mark.parametrize("dimension", [2, 3])
def test_facets_belong_to_the_nodes_behind_them(dimension):
    tool, body = of_facets(dimension)
    assert body.alive.all() and body.positions.shape == (body.count, dimension)
    middles = tool.boundary.vertices[tool.boundary.facets].mean(axis=1)
    away = np.linalg.norm(middles[:, None] - body.positions, axis=2)
    assert np.array_equal(away[np.arange(tool.count), body.node_of], away.min(axis=1))
    assert body.contact_areas.sum() == pytest.approx(0.048 if dimension == 2 else 2 * LENGTH * HEIGHT + 0.048 * BREADTH)


@pytest.mark.parametrize("dimension", [2, 3])
def test_heat_capacity_is_that_of_the_tool(dimension):
    tool, body = of_facets(dimension)
    for model in ("voronoi", "bar"):
        assert body.capacities(STEEL, model).sum() == pytest.approx(8000 * 500 * tool.area, rel=1e-12)
    assert tool.area == pytest.approx(LENGTH * HEIGHT * (1 if dimension == 2 else BREADTH))


@pytest.mark.parametrize("dimension", [2, 3])
def test_free_surface_is_that_of_the_facets_but_for_shank_and_contact(dimension):
    tool, body = of_facets(dimension)
    touched = np.zeros(tool.count, bool)
    touched[np.flatnonzero(~tool.boundary.fixed)[:3]] = True
    free = ~tool.boundary.fixed & ~touched
    assert body.exposed(touched).sum() == pytest.approx(body.contact_areas[free].sum(), rel=1e-12)
    exposed, (x, y, *z) = body.exposed(np.zeros(tool.count, bool)), body.positions.T
    inner = (x > 1e-3) & (x < LENGTH - 1e-3) & (y > 1e-3) & (y < HEIGHT - 1e-3)
    assert np.all(exposed[inner & (abs(z[0]) < 0.4 * BREADTH) if z else inner] == 0)
    if not z:
        assert exposed[(y < 1e-3) & (x > 1e-3) & (x < LENGTH - 1e-3)] == pytest.approx(1e-3)


def test_particles_are_their_own_nodes(layered_tool):
    tool, body = layered_tool, ParticleBody(layered_tool)
    assert np.array_equal(body.node_of, np.arange(tool.count)) and body.alive is tool.erosion.alive
    assert body.contact_areas == pytest.approx(4 * tool.radii**2)
    assert body.capacities(STEEL, "voronoi").sum() == pytest.approx(4e6 * tool.area, rel=2e-3)
    exposed = body.exposed(np.zeros(tool.count, bool))
    assert np.all(exposed[tool.fixed] == 0)
    inner = np.setdiff1d(np.arange(tool.count), [*tool.erosion.surface])
    assert exposed[inner].sum() < 0.01 * exposed.sum()
    touched = np.zeros(tool.count, bool)
    touched[np.argmax(exposed)] = True
    assert body.exposed(touched).sum() == pytest.approx(exposed.sum() - exposed.max())


def test_particles_in_space_conduct_through_their_cells_alone(layered_tool):
    for body in (ParticleBody(layered_tool), of_facets(3)[1]):
        with pytest.raises(ParameterError, match="bond_conductance = bar: must be voronoi"):
            body.paths("bar", 60.0)


def test_other_paths_of_a_fill_in_the_plane():
    edges, conductance = of_facets(2)[1].paths("bar", 60.0)
    assert len(edges) == 15 * 8 + 16 * 7 and np.all(conductance == 60.0)


# ---- conduction

def conducted(body, axis, length):
    """W per K that nodes conduct between the first and the last of their planes across an axis."""
    edges, conductance = body.paths("voronoi", 60.0)
    network = HeatNetwork(capacity=body.capacities(STEEL, "voronoi"), edges=edges, conductance=conductance,
                          temperature=0.0)
    place = body.positions[:, axis]
    first, last = (abs(place - end) < 1e-6 for end in (place.min(), place.max()))
    network.fix(first, 0.0)
    network.fix(last, 1.0)
    temperature = network.steady_state()
    assert temperature == pytest.approx((place - place.min()) / np.ptp(place), abs=1e-9)
    i, j = edges.T
    across = first[i] != first[j]
    return float((conductance * abs(temperature[j] - temperature[i]))[across].sum()) * np.ptp(place) / length


@pytest.mark.parametrize("axis, length, area", [
    (0, LENGTH, HEIGHT * BREADTH), (1, HEIGHT, LENGTH * BREADTH), (2, BREADTH, LENGTH * HEIGHT)])
def test_a_prism_conducts_as_its_material(axis, length, area):
    assert conducted(of_facets(3)[1], axis, length) == pytest.approx(60.0 * area / length, rel=1e-9)


def test_layers_of_particles_conduct_across_as_their_material(layered_tool):
    body, depth = ParticleBody(layered_tool), 2 * layered_tool.radii[0]
    section = body.cells.volumes.sum() / layered_tool.breadth
    edges, conductance = body.paths("voronoi", 60.0)
    across = abs(np.diff(body.positions[edges][:, :, 2], axis=1)[:, 0]) > 0.5 * depth
    layers = round(layered_tool.breadth / depth)
    assert layers == 4 and depth == pytest.approx(layered_tool.breadth / layers, rel=2e-3)
    whole = 60.0 * section / (layered_tool.breadth / layers) * (layers - 1)
    assert conductance[across].sum() == pytest.approx(whole, rel=1e-9)


# ---- recession

@pytest.mark.parametrize("dimension", [2, 3])
def test_nodes_die_when_the_surface_has_passed_them(dimension):
    tool, body = of_facets(dimension)
    bottom = body.positions[:, 1] < 1e-3
    recede(tool, 0.4e-3)
    assert body.follow() == [] and body.alive.all()
    recede(tool, 0.2e-3)
    passed = body.follow()
    assert len(passed) > 0.8 * bottom.sum() and np.all(bottom[passed])
    assert body.follow() == [] and np.array_equal(np.flatnonzero(~body.alive), np.sort(passed))
    assert body.alive[body.node_of].all()
    left = tool.area * (1 - 0.6e-3 / HEIGHT)
    assert volume(tool.boundary.vertices, tool.boundary.facets) == pytest.approx(left, rel=0.01)


def test_the_outermost_dies_first():
    tool, body = of_facets(2)
    recede(tool, 1.6e-3)
    passed = body.follow()
    heights = body.positions[passed, 1]
    assert len(passed) >= 28 and np.all(np.diff(np.round(heights, 6)) >= 0)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_last_node_stands_for_what_is_left(dimension):
    """Friction of facets of which no node is left would have nowhere to go."""
    tool, body = of_facets(dimension)
    for _ in range(22):
        recede(tool, 0.35e-3)
        body.follow()
    left = volume(tool.boundary.vertices, tool.boundary.facets) / tool.area
    assert 0.02 < left < 0.5e-3 / HEIGHT
    assert body.alive.sum() == 1 and body.alive[body.node_of].all()


@pytest.mark.parametrize("dimension", [2, 3])
def test_shapes_followed_by_steps_and_at_once_are_equal(dimension):
    tool, body = of_facets(dimension)
    late, found = FacetBody(tool, fill=Grid(), breadth=body.breadth), []
    for _ in range(5):
        recede(tool, 0.35e-3)
        found += body.follow()
    assert sorted(found) == sorted(late.follow()) and len(found) > 15
    assert np.array_equal(body.node_of, late.node_of)


def test_remeshing_passes_no_node_by_itself_and_hides_none():
    """Deep wear in many steps, over which facets crowd at the corners and are moved elsewhere."""
    tool, body = of_facets(2)
    late = FacetBody(tool, fill=Grid())
    for _ in range(40):
        recede(tool, 0.1e-3)
        body.follow()
    assert tool.boundary.remeshed > 3
    late.follow()
    assert np.array_equal(body.alive, late.alive) and 40 < (~body.alive).sum() < 70


def test_a_body_is_restored_and_renewed():
    tool, body = of_facets(2)
    new = tool.boundary.state()
    recede(tool, 1.6e-3)
    body.follow()
    state = body.state()
    recede(tool, 1e-3)
    other = FacetBody(tool, fill=Grid())
    other.restore(state)
    assert np.array_equal(other.node_of, state["node_of"])
    assert other.follow() == body.follow() and np.array_equal(other.node_of, body.node_of)
    assert np.array_equal(other.alive, body.alive) and not np.array_equal(state["alive"], body.alive)
    tool.boundary.restore(new)
    body.renew()
    assert body.alive.all() and np.array_equal(body.node_of, FacetBody(tool, fill=Grid()).node_of)


def test_nodes_outside_of_a_coarse_boundary_live_until_it_recedes():
    """The outline of the fill is a little wider than the facets."""
    tool = FacetTool.of_outline(BLOCK + [0, 0.7e-3], segment=0.5e-3, density=STEEL.density)
    body = FacetBody(tool, fill=Grid())
    assert body.alive.all() and body.follow() == []
    recede(tool, 0.05e-3)
    passed = body.follow()
    assert passed and np.all(body.positions[passed, 1] < 1e-3)

"""Voronoi cells: closed, without gap, and so exact for linear temperatures; and which neighbours conduct."""
import numpy as np
import pytest

from rockwear.kernels import polygon as outline
from rockwear.kernels.voronoi import cells, conducting, layered
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.conduction import HeatNetwork, effective_conductivity
from rockwear.kernels.packing import contacts, pack

NOTCHED = np.array([[0, 0], [0.05, 0], [0.05, 0.02], [0.03, 0.02], [0.03, 0.04], [0, 0.04]])
TOOTH = outline.tooth(height=0.03, width=0.02, rake=0.2, clearance=0.1, tip_radius=4e-3)


def grid(*counts):
    return np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, len(counts)) + 0.5


def triangles(nx, ny):
    column, row = np.meshgrid(np.arange(nx), np.arange(ny))
    return np.column_stack([(column + 0.5 * (row % 2)).ravel() + 0.25, (row * np.sqrt(0.75)).ravel() + 0.5])


def scattered(*box, n=300, seed=0):
    """Points thrown at random: far more irregular than any packing."""
    return np.random.default_rng(seed).uniform(0.001, 0.999, (n, len(box))) * box


def rock(seed=1, porosity=0.12, ratio=1.5):
    box = (0.04, 0.03)
    packing = pack(box=box, radius_min=1e-3, radius_max=ratio * 1e-3, porosity=porosity, seed=seed)
    return packing.positions, packing.radii, box


# ---- closed and without gap

@pytest.mark.parametrize("box", [(0.03, 0.05), (3.0, 2.0, 1.5)])
def test_cells_divide_a_box(box):
    found = cells(scattered(*box), box=box)
    assert found.volumes.sum() == pytest.approx(np.prod(box), rel=1e-12) and (found.volumes > 0).all()
    for side, (_, areas, _) in found.walls.items():
        assert areas.sum() == pytest.approx(np.prod(box) / box[side // 2], rel=1e-12)


@pytest.mark.parametrize("box", [(0.03, 0.05), (3.0, 2.0, 1.5)])
@pytest.mark.parametrize("seed", range(3))
def test_a_linear_temperature_is_exactly_steady(box, seed):
    positions = scattered(*box, seed=seed)
    found = cells(positions, box=box)
    slope = np.arange(1, len(box) + 1) * 10
    network = HeatNetwork(capacity=np.ones(len(positions)), edges=found.edges, conductance=found.conductance(5.0),
                          temperature=0.0)
    coefficient, heat = np.zeros(len(positions)), np.zeros(len(positions))
    for side in found.walls:  # every side is held at the linear field, at the feet of the particles
        nodes, conductance = found.wall_conductance(side, 5.0)
        foot = positions[nodes].copy()
        foot[:, side // 2] = box[side // 2] * (side % 2)
        np.add.at(coefficient, nodes, conductance)
        np.add.at(heat, nodes, conductance * (foot @ slope))
    touching = coefficient > 0
    network.convect(touching, coefficient[touching], heat[touching] / coefficient[touching])
    assert network.steady_state() == pytest.approx(positions @ slope, rel=1e-9)


def conducted(found, low, high, conductivity=5.0):
    """W through cells whose sides `low` and `high` are held 1 K apart, and the stationary temperatures."""
    heat, area = np.zeros(len(found.volumes)), np.zeros(len(found.volumes))
    for side, kelvin in ((low, 0.0), (high, 1.0)):
        nodes, conductance = found.wall_conductance(side, conductivity)
        np.add.at(area, nodes, conductance)
        np.add.at(heat, nodes, conductance * kelvin)
    network = HeatNetwork(capacity=found.volumes, edges=found.edges, conductance=found.conductance(conductivity),
                          temperature=0.0)
    held = area > 0
    network.convect(held, area[held], heat[held] / area[held])
    temperature = network.steady_state()
    nodes, conductance = found.wall_conductance(high, conductivity)
    return float(conductance @ (1.0 - temperature[nodes])), temperature


def test_a_packing_of_spheres_between_two_faces_conducts_exactly():
    box = 0.04, 0.03, 0.025
    positions = pack(box=box, radius_min=2e-3, radius_max=3e-3, porosity=0.4, seed=1).positions
    found = cells(positions, box=box)
    for axis in range(3):
        watt, temperature = conducted(found, 2 * axis, 2 * axis + 1)
        assert watt == pytest.approx(5.0 * np.prod(box) / box[axis]**2, rel=1e-9)
        assert temperature == pytest.approx(positions[:, axis] / box[axis], abs=1e-9)


def test_a_fin_of_random_cells_converges_with_the_square_of_their_size():
    """A bar between a hot and a cold face, cooled along its length: sinh, in space, over a random arrangement."""
    errors, counts = [], np.array([4, 8, 12])
    for across in counts:
        box, steps = (1.0, 0.25, 0.25), np.array([across * 2, across, across])
        places = (grid(*steps) + np.random.default_rng(0).uniform(-0.2, 0.2, (steps.prod(), 3))) / steps * box
        found = cells(places, box=box)
        network = HeatNetwork(capacity=np.ones(len(places)), edges=found.edges, conductance=found.conductance(1.0),
                              temperature=0.0)
        # Cooled in the volume, T'' = 25 T: the same equation as that of a thin fin.
        coefficient, heat = 25.0 * found.volumes, np.zeros(len(places))
        for side, kelvin in ((0, 0.0), (1, 1.0)):
            nodes, conductance = found.wall_conductance(side, 1.0)
            coefficient[nodes] += conductance
            heat[nodes] += conductance * kelvin
        network.convect(range(len(places)), coefficient, heat / coefficient)
        gap = network.steady_state() - np.sinh(5 * places[:, 0]) / np.sinh(5)
        errors.append(np.sqrt(np.mean(gap**2)))
    assert errors[-1] < 1.2e-3 and -np.polyfit(np.log(counts), np.log(errors), 1)[0] > 1.8


# ---- layers

def test_layers_of_a_section_divide_its_prism():
    positions, _, box = rock()
    section = cells(positions, box=box)
    found, depth = layered(section, 5, 0.002), 5 * 0.002
    assert found.volumes.sum() == pytest.approx(np.prod(box) * depth, rel=1e-12)
    areas = {side: areas.sum() for side, (_, areas, _) in found.walls.items()}
    assert [areas[side] for side in (-2, -1)] == pytest.approx([np.prod(box)] * 2, rel=1e-12)
    assert [areas[side] for side in range(4)] == pytest.approx(np.repeat(np.prod(box) / np.array(box), 2) * depth)
    n = len(positions)
    assert (found.edges[:, 0] < found.edges[:, 1]).all() and np.all(np.diff(found.edges @ [5 * n, 1]) > 0)


def test_layers_are_the_cells_of_the_repeated_particles():
    """The diagram of all particles in space has the same cells, apart from what is left of degenerate corners."""
    positions, box = scattered(1.0, 0.8, n=40), (1.0, 0.8, 0.6)
    deep = np.vstack([np.column_stack([positions, np.full(40, z)]) for z in (0.1, 0.3, 0.5)])
    whole, found = cells(deep, box=box), layered(cells(positions, box=box[:2]), 3, 0.2)
    assert found.volumes == pytest.approx(whole.volumes, rel=1e-9)
    assert np.array_equal(found.edges, whole.edges)
    assert found.faces == pytest.approx(whole.faces, rel=1e-6, abs=1e-9)
    assert found.distances == pytest.approx(whole.distances, rel=1e-12)
    for side, same in ((0, 0), (1, 1), (2, 2), (3, 3), (-2, 4), (-1, 5)):
        one, other = (dict(zip(nodes.tolist(), areas / away))
                      for nodes, areas, away in (found.walls[side], whole.walls[same]))
        assert one == pytest.approx(other, rel=1e-6)


def test_layers_conduct_exactly_along_and_across():
    positions, _, box = rock()
    found = layered(cells(positions, box=box), 4, 0.003)
    box = *box, 0.012
    for axis, sides in enumerate(((0, 1), (2, 3), (-2, -1))):
        assert conducted(found, *sides)[0] == pytest.approx(5.0 * np.prod(box) / box[axis]**2, rel=1e-9)


@pytest.mark.parametrize("wrong", [(0, 0.1), (3, 0.0), (3, np.nan)])
def test_layers_without_depth_are_refused(wrong):
    with pytest.raises(ParameterError):
        layered(cells(scattered(1.0, 1.0, n=10), box=(1, 1)), *wrong)


# ---- in a polygon

@pytest.mark.parametrize("polygon, off, wall_off", [(np.array([[0, 0], [0.04, 0], [0.02, 0.03]]), 1e-12, 1e-12),
                                                    (TOOTH, 2e-4, 0.01), (NOTCHED, 2e-3, 0.04)])
def test_cells_divide_a_polygon(polygon, off, wall_off):
    packing = pack(polygon=polygon, radius_min=0.4e-3, radius_max=0.52e-3, porosity=0.13, seed=1)
    found = cells(packing.positions, polygon=polygon)
    assert found.volumes.sum() == pytest.approx(outline.area(polygon), rel=off)
    assert sum(a.sum() for _, a, _ in found.walls.values()) == pytest.approx(outline.perimeter(polygon), rel=wall_off)


def test_the_order_of_the_particles_changes_nothing():
    positions, _, box = rock()
    order = np.random.default_rng(0).permutation(len(positions))
    found, shuffled = cells(positions, box=box), cells(positions[order], box=box)
    assert shuffled.volumes == pytest.approx(found.volumes[order], rel=1e-9)
    pairs = {tuple(sorted(pair)): face for pair, face in zip(order[shuffled.edges].tolist(), shuffled.faces)}
    assert [pairs[tuple(pair)] for pair in found.edges.tolist()] == pytest.approx(found.faces, rel=1e-6, abs=1e-9)


# ---- conductivity without a fit

@pytest.mark.parametrize("positions, box, bonds", [
    (grid(12, 10), (12, 10), 1.0), (grid(6, 5, 7), (6, 5, 7), 1.0), (triangles(12, 14), None, 1 / np.sqrt(3))])
def test_on_lattices_the_faces_are_the_textbook_conductances(positions, box, bonds):
    box = box or positions.max(axis=0) + 0.5
    found = cells(positions, box=box)
    inside = (np.minimum(positions, box - positions) > 1).all(axis=1)[found.edges].all(axis=1)
    assert found.conductance(3.0)[inside] == pytest.approx(3.0 * bonds)
    got = effective_conductivity(positions=positions, edges=found.edges, conductance=found.conductance(3.0))
    assert got == pytest.approx([3.0] * len(box), rel=1e-3)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("porosity, ratio", [(0.12, 1.5), (0.16, 1.5), (0.05, 1.2), (0.12, 2.5)])
def test_random_packings_conduct_as_the_material(seed, porosity, ratio):
    positions, radii, box = rock(seed, porosity, ratio)
    found = cells(positions, box=box)
    got = effective_conductivity(positions=positions, edges=found.edges, conductance=found.conductance(5.0))
    assert got.mean() == pytest.approx(5.0, rel=1e-9)
    assert got == pytest.approx([5.0, 5.0], rel=0.01)  # a window across some 200 cells does not see directions better


def test_every_contact_of_a_packing_has_its_face():
    positions, radii, box = rock(ratio=2.5)
    found, bonds = cells(positions, box=box), contacts(positions, radii, 1e-4)
    n = len(positions)
    assert np.isin(bonds @ [n, 1], found.edges @ [n, 1]).mean() > 0.99


# ---- what conducts

def intact(seed=1):
    positions, radii, box = rock(seed)
    found, n = cells(positions, box=box), len(positions)
    joined = np.isin(found.edges @ [n, 1], contacts(positions, radii, 1e-4) @ [n, 1])
    return positions, found, joined, n


def test_pores_of_sound_rock_are_closed():
    _, found, joined, n = intact()
    assert joined.mean() < 0.9 and conducting(found.edges, joined, ~joined, n).all()


def test_a_crack_through_all_contacts_cuts_all_heat():
    positions, found, joined, n = intact()
    upper = positions[:, 1] > 0.015 + 0.003 * np.sin(300 * positions[:, 0])
    across = upper[found.edges[:, 0]] != upper[found.edges[:, 1]]
    left = conducting(found.edges, joined & ~across, ~joined, n)
    assert across.sum() > (across & joined).sum() > 10
    assert not left[across].any() and left[~across].all()


def test_a_crack_of_one_contact_leaves_its_neighbours():
    square = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]])  # 0-2 is the diagonal of a pore 0 1 2 3
    joined = np.array([True, False, True, True, True])
    facing = ~joined
    assert conducting(square, joined, facing, 4).all()
    joined[0] = False  # the bond 0-1 breaks: 3 still closes the pore
    assert conducting(square, joined, facing, 4).tolist() == [False, True, True, True, True]
    joined[2] = False
    assert conducting(square, joined, facing, 4).tolist() == [False, False, False, True, True]


# ---- what is refused

@pytest.mark.parametrize("wrong", [
    dict(positions=np.zeros((3, 4)), box=(1, 1)), dict(positions=[[0.5, 0.5]], box=(1, 1)),
    dict(positions=[[0.5, 0.5], [0.2, 2.0]], box=(1, 1)), dict(positions=[[0.5, 0.5], [0.2, 0.3]], box=(1, 0)),
    dict(positions=[[0.5, 0.5], [0.2, 0.3]], box=(1, 1, 1)), dict(positions=[[0.5, 0.5], [0.2, 0.3]]),
    dict(positions=[[0.5, 0.5], [0.2, 0.3]], box=(1, 1), polygon=NOTCHED),
    dict(positions=[[0.04, 0.03], [0.01, 0.01]], polygon=NOTCHED)])
def test_wrong_input_is_refused(wrong):
    with pytest.raises(ParameterError):
        cells(**wrong)

"""Cells of packings: closed, without gap, and so exact for linear temperatures; and which neighbours conduct."""
import numpy as np
import pytest

from rockwear.kernels import polygon as outline
from rockwear.kernels.voronoi import cells, conducting
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

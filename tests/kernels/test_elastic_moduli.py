"""Elastic constants of bonded packings, and the springs and dashpots of a boundary that follow from them."""
import math

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.elastic_moduli import Moduli, elastic_moduli, stiffness_tensor
from rockwear.kernels.packing import contacts, pack
from rockwear.kernels.stability import contact_rows
from rockwear.kernels.stability import critical_time_step
from rockwear.kernels.viscous_spring import shares, stable_dashpots, stable_masses, viscous_spring

KN, KT = 2e10, 5e9


def lattice(columns, rows, radius=1e-3):
    """A periodic cell of discs that touch in equilateral triangles."""
    places = np.array([(radius * (1 + 2 * column + row % 2), radius * (1 + math.sqrt(3) * row))
                       for row in range(rows) for column in range(columns)])
    cell = radius * np.array([2 * columns, math.sqrt(3) * rows])
    radii = np.full(len(places), radius)
    return {"positions": places, "radii": radii, "bonds": contacts(places, radii, 1e-9, period=cell),
            "kn": KN, "kt": KT, "box": ((0, 0), cell), "periodic": (True, True)}


@pytest.mark.parametrize("cell", [(4, 4), (7, 6)])
def test_a_triangular_lattice_is_exact(cell):
    """C11 = sqrt(3)/4 (3 kn + kt), C12 = sqrt(3)/4 (kn - kt), G = sqrt(3)/4 (kn + kt)."""
    along, across, shear = math.sqrt(3) / 4 * np.array([3 * KN + KT, KN - KT, KN + KT])
    exact = np.array([[along, across, 0], [across, along, 0], [0, 0, shear]])
    assert stiffness_tensor(**lattice(*cell)) == pytest.approx(exact, rel=1e-9, abs=1.0)
    found = elastic_moduli(**lattice(*cell))
    assert found == pytest.approx((along - across**2 / along, across / along, shear), rel=1e-9)
    assert found.speeds(2500.0) == pytest.approx((math.sqrt(along / 2500), math.sqrt(shear / 2500)), rel=1e-9)


def test_particles_that_hang_on_one_bond_carry_nothing():
    cell = lattice(4, 4)
    exact = stiffness_tensor(**cell)
    n, places, radii = 16, cell["positions"], cell["radii"]
    hanging = places[[3, 9]] + [[2e-4, 1e-4], [1e-4, -3e-4]]
    pair = places[5] + [[3e-4, 3e-4], [5e-4, 3e-4]]
    more = dict(cell, positions=np.vstack([places, hanging, pair]), radii=np.concatenate([radii, np.full(4, 1e-4)]),
                bonds=np.vstack([cell["bonds"], [[3, n], [9, n + 1], [n + 2, n + 3]]]))
    np.testing.assert_allclose(stiffness_tensor(**more), exact, rtol=1e-9, atol=1e-9 * exact.max())


def test_a_rim_that_holds_the_strain_gives_what_the_periodic_packing_has():
    packing = pack(box=(0.04, 0.04), radius_min=5e-4, radius_max=7.5e-4, porosity=0.12, seed=1, periodic=(True, True))
    common = {"positions": packing.positions, "radii": packing.radii, "kn": KN, "kt": KT}
    exact = elastic_moduli(**common, bonds=contacts(packing.positions, packing.radii, 5e-5, period=packing.period),
                           box=((0, 0), packing.box), periodic=(True, True))
    held = elastic_moduli(**common, bonds=contacts(packing.positions, packing.radii, 5e-5),
                          box=((5e-3, 5e-3), (0.035, 0.035)))
    assert exact.shear == pytest.approx(exact.young / 2 / (1 + exact.poisson), rel=1e-9)
    assert held == pytest.approx(exact, rel=0.03)


def test_a_boundary_has_the_impedance_of_the_rock():
    moduli = Moduli(young=2e10, poisson=0.25, shear=8e9)
    found = viscous_spring(moduli=moduli, density=2500.0, areas=[1e-3, 2e-3], distances=[0.1, 0.2])
    fast, slow = moduli.speeds(2500.0)
    # The reflection of a plane wave at normal incidence, (1 - z)/(1 + z), is at most 5 %.
    for dashpot, speed in ((found.cn, fast), (found.ct, slow)):
        z = dashpot / (2500.0 * speed * np.array([1e-3, 2e-3]))
        assert abs((1 - z) / (1 + z)) == pytest.approx([0, 0], abs=0.05)
    assert found.kn[0] == found.kn[1] and found.kt[0] < found.kn[0]
    with pytest.raises(ParameterError, match="distances = array m: must be greater than 0"):
        viscous_spring(moduli=moduli, density=2500.0, areas=[1e-3], distances=[0.0])


def test_shares_of_a_boundary_add_up():
    found = shares([0.7, 0.1, 0.4], 0.0, 1.0)
    assert found == pytest.approx([0.45, 0.25, 0.3])


def half_plane(columns, rows):
    """Places (n, 2) m from the load and stiffness (sparse) of a block of a lattice held at its bottom and sides."""
    cell = lattice(columns, rows)
    places = cell["positions"]
    i, j = contacts(places, cell["radii"], 1e-9).T
    line = places[j] - places[i]
    length = np.linalg.norm(line, axis=1)
    rows_of_bonds = contact_rows(len(places), i, j, line / length[:, None], 0.5 * length, 0.5 * length,
                                 np.full(len(i), KN), np.full(len(i), KT))
    moduli, (x, y) = elastic_moduli(**lattice(4, 4)), places.T
    held = np.zeros((len(places), 3))
    for face, normal, share in ((y < 1.1e-3, 1, 2e-3), ((x < 2.1e-3) | (x > x.max() - 1.1e-3), 0, math.sqrt(3) * 1e-3)):
        found = viscous_spring(moduli=moduli, density=2500.0, areas=np.full(face.sum(), share),
                               distances=np.hypot(x - x.mean(), y.max() - y)[face])
        held[face, normal] += found.kn
        held[face, 1 - normal] += found.kt
    return places - (x.mean(), y.max()), rows_of_bonds.T @ rows_of_bonds + sparse.diags(held.ravel())


def settlements(columns, rows, at, direction):
    """(k,) m by which the load at the surface moves more than the places `at` (k, 2)."""
    places, stiffness = half_plane(columns, rows)
    loaded = (places[:, 1] > -1e-4) & (abs(places[:, 0]) < 4e-3)
    force = np.zeros((len(places), 3))
    force[loaded, direction] = 1.0 / loaded.sum()
    # A symmetric matrix: a third of the time of the general order.
    moved = splu(stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                 options={"SymmetricMode": True}).solve(force.ravel()).reshape(-1, 3)[:, direction]
    nearest = [np.argmin(np.hypot(*(places - place).T)) for place in at]
    return moved[loaded].mean() - moved[nearest]


@pytest.mark.parametrize("direction", [0, 1])
def test_a_window_is_as_stiff_as_the_half_plane(direction):
    """Against a block four times as large; at depth and along the surface, near the load and near the boundary."""
    width, height = 80e-3, math.sqrt(3) * 23e-3
    at = np.array([(0, -0.3 * height), (0, -0.9 * height), (0.25 * width, 0), (0.4 * width, 0),
                   (-0.4 * width, -0.5 * height)])
    window, large = (settlements(factor * 40, factor * 23, at, direction) for factor in (1, 4))
    assert window == pytest.approx(large, rel=0.1)


@pytest.mark.parametrize("part, spring", [(0.3, 0.0), (0.8, 0.0), (0.95, 0.0), (0.8, 1e9)])
def test_dashpots_leave_the_step_stable(part, spring):
    """A chain of discs of which one is held: the exact limit of bonds and dashpots is not below the step, and for a
    disc that no bond holds it is the step."""
    x = np.column_stack([2e-3 * np.arange(6), np.zeros(6)])
    common = dict(positions=x, radii=np.full(6, 1e-3), masses=np.full(6, 8e-3), inertias=np.full(6, 4e-9),
                  fixed=[0])
    chain = dict(bonds=[[k, k + 1] for k in range(5)], kn=1e10, kt=4e9)
    critical = critical_time_step(**common, **chain)
    step = part * critical
    most, = stable_dashpots(masses=[8e-3], springs=[spring], step=step, critical=critical)
    held = dict(ground=([5], [[1.0, 0.0]], spring, 0.0, most))
    assert most > 0 and critical_time_step(**common, **chain, **held) >= step
    alone = critical_time_step(**common, bonds=np.empty((0, 2), int), kn=0.0, kt=0.0,
                               ground=([5], [[1.0, 0.0]], spring, 0.0, stable_dashpots(
                                   masses=[8e-3], springs=[spring], step=step, critical=1e9)[0]))
    assert alone == pytest.approx(step, rel=1e-5)


@pytest.mark.parametrize("part, spring, dashpot", [(0.3, 0.0, 1e3), (0.8, 1e9, 1e3), (0.8, 1e9, 0.0), (0.7, 0.0, 8e3)])
def test_a_lighter_disc_leaves_the_step_stable(part, spring, dashpot):
    """The same chain, its last disc as light as the bound allows; for a disc that no bond holds that is exact."""
    x = np.column_stack([2e-3 * np.arange(6), np.zeros(6)])
    masses = np.full(6, 8e-3)
    common = dict(positions=x, radii=np.full(6, 1e-3), inertias=np.full(6, 4e-9), fixed=[0])
    chain = dict(bonds=[[k, k + 1] for k in range(5)], kn=1e10, kt=4e9)
    critical = critical_time_step(masses=masses, **common, **chain)
    springs = dict(springs=[spring], dashpots=[dashpot], step=part * critical)
    held = dict(ground=([5], [[1.0, 0.0]], spring, 0.0, dashpot))
    lighter = np.append(masses[:5], stable_masses(masses=masses[5:], critical=critical, **springs))
    assert lighter[5] > 0 and critical_time_step(masses=lighter, **common, **chain, **held) >= part * critical
    alone = np.append(masses[:5], stable_masses(masses=masses[5:], critical=1e9, **springs))
    assert critical_time_step(masses=alone, **common, bonds=np.empty((0, 2), int), kn=0.0, kt=0.0,
                              **held) == pytest.approx(part * critical, rel=1e-5)


@pytest.mark.parametrize("step", [0.0, 2e-7])
def test_dashpots_at_a_step_that_is_not_stable_without_them(step):
    with pytest.raises(ParameterError, match="step = "):
        stable_dashpots(masses=[1.0], springs=[0.0], step=step, critical=1e-7)

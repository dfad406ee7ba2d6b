"""Elastic constants of bonded packings, and the springs and dashpots of a boundary that follow from them."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.elastic_moduli import Moduli, elastic_moduli, stiffness_tensor
from rockwear.kernels.packing import contacts, pack
from rockwear.kernels.viscous_spring import shares, viscous_spring

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

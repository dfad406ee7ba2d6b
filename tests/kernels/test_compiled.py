"""What is compiled follows the law that it stands for."""
import numpy as np
import pytest

from rockwear.kernels import compiled
from rockwear.kernels.bond_laws import Cohesive

KN, KT, TENSION, COHESION = 2e10, 1e10, 1e5, 3e5
LAWS = {"coupled": dict(bond_fracture_energy=2.0, bond_shear_energy=20.0),
        "free to slip": dict(bond_fracture_energy=2.0),
        "crushing": dict(bond_fracture_energy=2.0, bond_shear_energy=20.0, bond_crushing=4e5),
        "brittle": dict(bond_fracture_energy=0.3, bond_shear_energy=5.0)}


def work_of_the_law(law, un, ut):
    """J against the shear force on a straight path, by the trapezoidal rule over as many points."""
    bond, work, before = law.initial_state(), 0.0, 0.0
    for k in range(1, compiled.STRAIGHT + 1):
        _, (force,) = law.respond(bond, un * k / compiled.STRAIGHT, (ut * k / compiled.STRAIGHT,))
        work, before = work + 0.5 * (force + before) * ut / compiled.STRAIGHT, force
    return work, bond


@pytest.mark.parametrize("name", LAWS)
def test_slip_on_a_straight_path_takes_the_work_of_the_law(name):
    law = Cohesive(kn=KN, kt=KT, bond_tension=TENSION, bond_cohesion=COHESION, mu=0.6, **LAWS[name])
    table = np.array([[getattr(law, attribute)] for attribute in compiled.LAW])
    random, seen = np.random.default_rng(3), set()
    for un, ut in zip(random.uniform(-8, 12, 2000) * law.onset, random.uniform(0, 6, 2000) * COHESION / KT):
        expected, bond = work_of_the_law(law, float(un), float(ut))
        assert compiled.slip_work(0, table, law.hardening, un, ut) == pytest.approx(expected, rel=1e-9)
        seen.add((bond.broken, bond.softening > 0, bond.un_plastic < 0, bond.ut_plastic[0] > 0))
    # Broken and whole bonds, crushed ones where the law crushes, and sliding: all are among them.
    assert {broken for broken, *_ in seen} == {True, False} and {slid for *_, slid in seen} == {True, False}
    assert any(crushed for _, _, crushed, _ in seen) == (name == "crushing")

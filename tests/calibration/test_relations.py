"""The dimensionless relations that a fit begins from."""
import numpy as np
import pytest

from calibration.fitting.relations import elastic_guess, relations


def test_the_relations_are_those_of_packings():
    """E grows and nu falls with kt/kn, and both stay below the triangular lattice of equal discs (E) or near it."""
    found = relations()
    ratio, stiffness, nu = found["kt_over_kn"], found["E_over_kn"][:, 0], found["nu"][:, 0]
    assert np.all(np.diff(stiffness) > 0) and np.all(np.diff(nu) < 0)
    assert np.all(stiffness < 2 * np.sqrt(3) * (1 + ratio) / (3 + ratio))
    assert np.all(abs(nu - (1 - ratio) / (3 + ratio)) < 0.15)
    assert found["E_over_kn"][:, 1].max() < 0.05  # packings scatter little


def test_the_guess_inverts_the_relations():
    found = relations()
    for ratio, (stiffness, _), (nu, _) in zip(found["kt_over_kn"], found["E_over_kn"], found["nu"]):
        assert elastic_guess(youngs_modulus=stiffness * 3e9, poissons_ratio=nu) == pytest.approx((3e9, ratio))


def test_the_guess_stays_within_the_data():
    assert elastic_guess(youngs_modulus=1e9, poissons_ratio=0.49)[1] == relations()["kt_over_kn"][0]
    assert elastic_guess(youngs_modulus=1e9, poissons_ratio=-0.1)[1] == relations()["kt_over_kn"][-1]

"""Strength and elastic constants of stress-strain curves that are known."""
import math

import numpy as np
import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.stress_strain import measured


def curve(crack=0.26, rows=400):
    """Straight with E = 13 GPa and nu = 0.25; from `crack` of the peak on lateral strain grows ten times as fast."""
    axial = np.linspace(0, 4e-3, rows)
    stress = 13e9 * np.where(axial < 3.8e-3, axial, 0.1 * axial)
    lateral = -0.25 * axial - 2.25 * np.clip(axial - crack * 3.8e-3, 0, None)
    return dict(stress=stress, axial_strain=axial, lateral_strain=lateral)


def test_elastic_constants_are_those_before_cracks_open():
    found = measured(**curve())
    assert found["youngs_modulus"] == (pytest.approx(13e9, rel=1e-9), "Pa")
    assert found["poissons_ratio"] == (pytest.approx(0.25, rel=1e-9), "-")
    assert found["peak_stress"][0] == pytest.approx(13e9 * 3.8e-3, rel=5e-3)
    assert found["peak_strain"][0] == pytest.approx(3.8e-3, rel=5e-3)


def test_a_curve_without_rows_is_refused():
    with pytest.raises(ParameterError, match="stress = without rows Pa: must be a curve of at least one"):
        measured(stress=np.empty(0), axial_strain=np.empty(0), lateral_strain=np.empty(0))


def test_noise_before_and_after_the_range_counts_for_nothing():
    noisy = curve()
    noisy["stress"][0], noisy["stress"][300] = 0.2 * noisy["stress"].max(), 0.2 * noisy["stress"].max()
    assert measured(**noisy)["youngs_modulus"][0] == pytest.approx(13e9, rel=0.02)


def test_a_row_on_either_side_of_a_short_range_is_enough():
    assert measured(**curve(rows=8))["youngs_modulus"][0] == pytest.approx(13e9, rel=1e-9)


def test_few_rows_have_a_strength_and_no_modulus():
    found = measured(**curve(rows=4))
    assert found["peak_stress"][0] > 0 and math.isnan(found["youngs_modulus"][0])

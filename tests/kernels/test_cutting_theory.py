"""Evans and Nishimatsu in cases that can be done by hand."""
import math

import pytest

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.cutting_theory import evans, mohr_coulomb, nishimatsu


def test_evans_with_a_vertical_face():
    shank = math.sqrt(0.5)
    assert evans(tensile_strength=7e6, depth=0.01, rake=0.0) == pytest.approx(2 * 7e4 * shank / (1 - shank), rel=1e-12)


def test_evans_friction_blunts_the_wedge():
    sharp = evans(tensile_strength=1e6, depth=0.01, rake=0.4)
    assert evans(tensile_strength=1e6, depth=0.01, rake=0.4, friction_angle=0.2) == pytest.approx(
        evans(tensile_strength=1e6, depth=0.01, rake=0.0), rel=1e-12)
    assert sharp < evans(tensile_strength=1e6, depth=0.01, rake=0.0)


def test_nishimatsu_without_friction_is_the_tresca_wedge():
    """phi = phi_rt = n = 0 and a vertical face: the force 2 c d of a plane at 45 degrees, straight ahead."""
    cutting, thrust = nishimatsu(shear_strength=5e6, internal_friction=0.0, depth=0.02, rake=0.0, friction_angle=0.0)
    assert (cutting, thrust) == pytest.approx((2 * 5e6 * 0.02, 0.0))


def test_nishimatsu_resolves_its_resultant():
    values = dict(shear_strength=5e6, internal_friction=0.6, depth=0.02, rake=0.2, friction_angle=0.3, distribution=1.0)
    cutting, thrust = nishimatsu(**values)
    resultant = 2 * 5e6 * 0.02 * math.cos(0.6) / (2 * (1 - math.sin(0.7)))
    assert math.hypot(cutting, thrust) == pytest.approx(resultant, rel=1e-12)
    assert thrust / cutting == pytest.approx(math.tan(0.1), rel=1e-12)


def test_mohr_coulomb_touches_both_circles():
    cohesion, angle = mohr_coulomb(compressive_strength=60e6, tensile_strength=7e6)
    assert 2 * cohesion * math.cos(angle) / (1 - math.sin(angle)) == pytest.approx(60e6, rel=1e-12)
    assert 2 * cohesion * math.cos(angle) / (1 + math.sin(angle)) == pytest.approx(7e6, rel=1e-12)


@pytest.mark.parametrize("call", [
    lambda: evans(tensile_strength=1e6, depth=0.01, rake=-math.pi / 2),
    lambda: nishimatsu(shear_strength=1e6, internal_friction=0.8, depth=0.01, rake=-0.5, friction_angle=0.3),
    lambda: mohr_coulomb(compressive_strength=1e6, tensile_strength=2e6)])
def test_beyond_the_theory(call):
    with pytest.raises(ParameterError):
        call()

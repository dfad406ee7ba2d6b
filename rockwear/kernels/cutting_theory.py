"""Cutting forces of the classical plane theories, for comparison with a simulation [Rojek 2003, sec. 2.1-2.2].

Both theories are unreliable in absolute value and useful for trends. Angles in radians, forces per m of width.
"""
import math

from rockwear.kernels.checks import not_negative, positive, require


def evans(*, tensile_strength, depth, rake, friction_angle=0.0):
    """Cutting force (N/m) of a wedge that breaks the rock in tension along an arc (Evans 1962 [Rojek 2003, sec. 2.1]).

        F_c = 2 sigma_t d sin(theta + phi_rt) / (1 - sin(theta + phi_rt)),  theta = (pi / 2 - alpha) / 2

    tensile_strength sigma_t: Pa; depth of cut d: m; rake alpha; friction_angle phi_rt of tool on rock (source: 0).
    Raises ParameterError for values that are not positive and where theta + phi_rt is not between 0 and pi/2.
    """
    positive("tensile_strength", tensile_strength, "Pa"), positive("depth", depth, "m")
    angle = (math.pi / 2 - rake) / 2 + not_negative("friction_angle", friction_angle, "rad")
    require(0 < angle < math.pi / 2, "rake", rake, "such that (pi/2 - rake)/2 + friction_angle is between 0 and pi/2",
            "rad")
    return 2 * tensile_strength * depth * math.sin(angle) / (1 - math.sin(angle))


def nishimatsu(*, shear_strength, internal_friction, depth, rake, friction_angle, distribution=0.0):
    """Cutting and thrust force (N/m) of rock that fails in shear on a plane (Nishimatsu 1972 [Rojek 2003, sec. 2.2]).

        F = 2 tau_u d cos(phi) / ((n + 1) (1 - sin(phi_rt + phi - alpha)))

    is the resultant; the cutting force is F cos(phi_rt - alpha), the thrust force F sin(phi_rt - alpha).
    shear_strength tau_u: Pa, unconfined; depth of cut d: m; rake alpha; internal_friction phi; friction_angle phi_rt of
    tool on rock; distribution: exponent n of the stress along the shear plane. -> (cutting, thrust), N/m.
    Raises ParameterError for values out of range and where phi_rt + phi - alpha is not
    between -pi/2 and pi/2.
    """
    positive("shear_strength", shear_strength, "Pa"), positive("depth", depth, "m")
    not_negative("distribution", distribution)
    angle = friction_angle + internal_friction - rake
    require(abs(angle) < math.pi / 2, "rake", rake,
            "such that friction_angle + internal_friction - rake is between -pi/2 and pi/2", "rad")
    resultant = 2 * shear_strength * depth * math.cos(internal_friction) / ((distribution + 1) * (1 - math.sin(angle)))
    return resultant * math.cos(friction_angle - rake), resultant * math.sin(friction_angle - rake)


def mohr_coulomb(*, compressive_strength, tensile_strength):
    """Cohesion c (Pa) and angle of internal friction phi of the tangent to the Mohr circles of both uniaxial tests.

        sin(phi) = (UCS - sigma_t) / (UCS + sigma_t),  c = sqrt(UCS sigma_t) / 2

    compressive_strength UCS, tensile_strength sigma_t: Pa. Raises ParameterError unless 0 < sigma_t < UCS.
    """
    positive("tensile_strength", tensile_strength, "Pa")
    require(compressive_strength > tensile_strength, "compressive_strength", compressive_strength,
            f"more than the tensile strength {tensile_strength:g}", "Pa")
    angle = math.asin((compressive_strength - tensile_strength) / (compressive_strength + tensile_strength))
    return math.sqrt(compressive_strength * tensile_strength) / 2, angle

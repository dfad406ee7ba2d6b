"""Cutting forces of the classical plane theories, as orientation beside a simulation (M 2.1-2.2).

Both are known to be unreliable in absolute value; what they say of trends is worth a line in a figure. Angles in radians,
per m of width.
"""
import math

from rockwear.kernels.checks import not_negative, positive, require


def evans(*, tensile_strength, depth, rake, friction_angle=0.0):
    """Cutting force (N/m) of a wedge that breaks the rock in tension along an arc (Evans 1962; M 2.1).

        F_c = 2 sigma_t d sin(theta + phi_rt) / (1 - sin(theta + phi_rt)),  theta = (pi / 2 - alpha) / 2

    tensile_strength sigma_t: Pa; depth of cut d: m; rake alpha; friction_angle phi_rt of tool on rock (M has none).
    Raises ParameterError for a wedge and friction that add up to a right angle.
    """
    positive("tensile_strength", tensile_strength, "Pa"), positive("depth", depth, "m")
    angle = (math.pi / 2 - rake) / 2 + not_negative("friction_angle", friction_angle, "rad")
    require(0 < angle < math.pi / 2, "rake", rake, "such that (pi/2 - rake)/2 + friction_angle is between 0 and pi/2", "rad")
    return 2 * tensile_strength * depth * math.sin(angle) / (1 - math.sin(angle))


def nishimatsu(*, shear_strength, internal_friction, depth, rake, friction_angle, distribution=0.0):
    """(cutting, thrust) force (N/m) where the rock fails in shear along a plane (Nishimatsu 1972; M 2.2).

        F = 2 tau_u d cos(phi) / ((n + 1) (1 - sin(phi_rt + phi - alpha)))

    is the resultant; the cutting force is F cos(phi_rt - alpha), the thrust F sin(phi_rt - alpha). shear_strength tau_u:
    Pa, unconfined; internal_friction phi; friction_angle phi_rt of tool on rock; distribution n of the stress along
    the plane. Raises ParameterError where phi_rt + phi - alpha reaches a right angle.
    """
    positive("shear_strength", shear_strength, "Pa"), positive("depth", depth, "m")
    not_negative("distribution", distribution)
    angle = friction_angle + internal_friction - rake
    require(abs(angle) < math.pi / 2, "rake", rake, "such that friction_angle + internal_friction - rake is within pi/2",
            "rad")
    resultant = 2 * shear_strength * depth * math.cos(internal_friction) / ((distribution + 1) * (1 - math.sin(angle)))
    return resultant * math.cos(friction_angle - rake), resultant * math.sin(friction_angle - rake)


def mohr_coulomb(*, compressive_strength, tensile_strength):
    """(cohesion in Pa, angle of internal friction) of the line that touches the circles of both uniaxial tests.

        sin(phi) = (UCS - sigma_t) / (UCS + sigma_t),  c = sqrt(UCS sigma_t) / 2
    """
    positive("tensile_strength", tensile_strength, "Pa")
    require(compressive_strength > tensile_strength, "compressive_strength", compressive_strength,
            f"more than the tensile strength {tensile_strength:g}", "Pa")
    angle = math.asin((compressive_strength - tensile_strength) / (compressive_strength + tensile_strength))
    return math.sqrt(compressive_strength * tensile_strength) / 2, angle

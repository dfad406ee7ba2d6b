"""What an engineer expects by hand of a steady cut in the plane: how much wears, and how warm the tip becomes."""
import math

from rockwear.kernels.moving_source import common_share, moving_strip, still_strip
from rockwear.kernels.steady_record import integral


def heated_length(v):
    """m of the outline that rubs on the rock by hand, from a tooth's parameters: its round tip, which turns from the
    flat, or the clearance face, to the rake face, and its flat. 0 where the outline is given."""
    turn = math.pi / 2 + math.radians(v.rake + (-v.flat_angle if v.wear_flat else v.clearance))
    return 0.0 if v.outline else turn * v.tip_radius + v.wear_flat


def worn_by_hand(wear, *, temperature, distance, thrust):
    """m3/m: k N s/H [Rojek 2003, eq. 6.7] as if the thrust force N slid all the way s; nan for a law that is not linear
    in the force.

    wear: scenes.physics.ToolWear; temperature: K, at which the hardness is taken; distance: (n,) m; thrust: (n,) N/m.
    """
    if any(exponent != 1 for _, exponent in wear.law.needs):
        return math.nan
    return float(wear.law.rate(1.0, wear.hardness.nearest(temperature)) * integral(distance, thrust)[-1])


def tip_by_hand(heat, *, strip, velocity, distance, friction_work):
    """(K, K) of the tip at the end of a cut whose friction heat comes evenly on a strip of its surface.

    kernels.moving_source.still_strip of the tool's share of the heat; and of the share by Blok's rule, with which the
    surfaces of tool and rock are as hot. Both take the tool for a half-space.
    heat: scenes.physics.HeatModel; strip: m, length along the outline; velocity: m/s of the process; distance: m;
    friction_work: J/m at the tool. Raises ParameterError for a strip or a velocity that is not above 0.
    """
    seconds = distance / velocity
    flux = heat.fraction * friction_work / seconds / strip
    # The share does not depend on the flux, which heat_fraction = 0 makes 0.
    tool, rock = ({"half_length": strip / 2, "flux": 1.0, "conductivity": m.conductivity, "density": m.density,
                   "specific_heat": m.specific_heat} for m in (heat.tool, heat.rock))
    still, moving = still_strip(seconds, **tool), moving_strip(velocity, **rock)
    return tuple(heat.tool_temperature + share * flux * still
                 for share in (heat.tool_share(), common_share(still, moving)))

"""The tool alone under the mean load of its cut: how it warms up in minutes, and where that ends (M 11.3)."""
import numpy as np

from rockwear.kernels.conduction import HeatNetwork


def tool_under_load(*, capacity, paths, temperature, friction_heat, contact, rock_temperature, convection, ambient,
                    shank=(), shank_temperature=None):
    """HeatNetwork of a tool that cuts steadily, from the means over a pass (M 11.3: "average heat generation rate").

    Each particle takes up its mean friction heat and gives heat to the rock it meets and to the air,

        C dT/dt = q - G (T - T_rock) - hA (T - T_air) + conduction.

    The rock goes by and is always as warm as it was on the mean in the pass. Between a pass of some milliseconds and
    the minutes in which a tooth warms up lies a factor of 10^4, so that the jumps of the force are gone in the mean.

    capacity (m,) J/K; paths: pairs (k, 2) and conductances (k,) W/K; temperature (m,) K at first; friction_heat (m,) W;
    contact (m,) W/K, G; rock_temperature (m,) K; convection (m,) W/K, hA; ambient: K of the air; root: particles
    held at shank_temperature, K. Raises ParameterError as HeatNetwork does; steady_state() does where a load has no way out.
    """
    network = HeatNetwork(capacity=capacity, edges=paths[0], conductance=paths[1], temperature=temperature)
    every = np.arange(len(network.temperature))
    network.source(every, friction_heat)
    whole = contact + convection
    outside = np.divide(contact * rock_temperature + convection * ambient, whole,
                        out=np.full(every.size, float(ambient)), where=whole > 0)
    network.convect(every, whole, outside)
    if len(shank):
        network.fix(shank, shank_temperature)
    return network

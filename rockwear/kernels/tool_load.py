"""The tool alone under the mean load of its cut: how it warms up, and its stationary state [Rojek 2003, 11.3]."""
import numpy as np

from rockwear.kernels.conduction import HeatNetwork


class MeanLoad:
    """Thermal load of a tool, averaged over time: friction heat and exchange with the rock, by node.

    Sums over `seconds`: friction_heat (m,) J; contact (m,) J/K, conductance to the rock times time; contact_kelvin (m,)
    J, the same times the temperature of the rock.
    """

    SUMS = "friction_heat", "contact", "contact_kelvin"

    def __init__(self, count):
        self.seconds = 0.0
        self.friction_heat, self.contact, self.contact_kelvin = np.zeros((3, count))

    def means(self, ambient):
        """Means over the time: friction heat, W; conductance to the rock, W/K; temperature of the rock at the node's
        contacts, K, or `ambient` (K) for a node that had none; three arrays (m,)."""
        rock = np.divide(self.contact_kelvin, self.contact, out=np.full(len(self.contact), float(ambient)),
                         where=self.contact > 0)
        return self.friction_heat / self.seconds, self.contact / self.seconds, rock

    def state(self):
        """What must survive a restart."""
        return {"seconds": self.seconds, **{name: getattr(self, name).copy() for name in self.SUMS}}

    def restore(self, state):
        """Set what `state` gave."""
        self.seconds = float(state["seconds"])
        for name in self.SUMS:
            setattr(self, name, np.array(state[name]))


def tool_under_load(*, capacity, paths, temperature, friction_heat, contact, rock_temperature, convection, ambient,
                    radiation=0.0, shank=(), shank_temperature=None):
    """HeatNetwork of a tool that cuts steadily, from means over a pass [Rojek 2003, 11.3].

    Each node takes up its mean friction heat and gives heat to the rock it touches and to the air,

        C dT/dt = q - G (T - T_rock) - hA (T - T_air) - sigma eA (T^4 - T_air^4) + conduction.

    The rock passes by and keeps its mean temperature of the pass. A pass takes milliseconds, the warming of a tooth
    minutes: a ratio of 10^4, over which fluctuations of the force average out.

    capacity (m,) J/K; paths: pairs (k, 2) and conductances (k,) W/K; temperature (m,) K at first; friction_heat (m,) W;
    contact (m,) W/K, G; rock_temperature (m,) K; convection (m,) W/K, hA; ambient: K of the air; radiation: scalar
    or (m,) m2, eA; shank: nodes held at shank_temperature, K. Raises ParameterError as HeatNetwork does; steady_state()
    does where a load has no way out.
    """
    network = HeatNetwork(capacity=capacity, edges=paths[0], conductance=paths[1], temperature=temperature)
    every = np.arange(len(network.temperature))
    network.source(every, friction_heat)
    whole = contact + convection
    outside = np.divide(contact * rock_temperature + convection * ambient, whole,
                        out=np.full(every.size, float(ambient)), where=whole > 0)
    network.convect(every, whole, outside)
    if np.any(radiation):
        network.radiate(every, radiation, ambient)
    if len(shank):
        network.fix(shank, shank_temperature)
    return network

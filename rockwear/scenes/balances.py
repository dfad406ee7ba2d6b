"""Balances of energy over stages, and what they tell."""
import math

ENERGY_MISSED = 0.05
"""Part of its largest entry that the energy balance may miss without a warning."""
LEAST_ENERGY = 1e-15
"""J, or J/m in the plane: no larger entries are round-off. A bond of 1 N and 1e10 N/m holds 5e-11."""


class StoredEnergy:
    """Changes of the stored energies over all stages; between stages the rock may be replaced, and that is no change.

    stored: a function giving {name: J} now.
    """

    def __init__(self, stored):
        self.stored, self.closed, self.base = stored, {}, {}

    def begin(self):
        """A stage begins with what is stored now."""
        self.base = self.stored()

    def close(self):
        """The stage ends."""
        self.closed = {name: self.closed.get(name, 0.0) + (value - self.base[name]) for name,
                       value in self.stored().items()}

    def changes(self):
        """{name: J} over all stages up to now."""
        return {name: self.closed.get(name, 0.0) + value - self.base[name] for name, value in self.stored().items()}

    def state(self):
        """What must survive a restart."""
        return {"closed": dict(self.closed), "base": dict(self.base)}

    def restore(self, state):
        """Take back what `state` gave."""
        self.closed = {name: float(value) for name, value in state.get("closed", {}).items()}
        self.base = {name: float(value) for name, value in state["base"].items()}


def with_residual(balance, source):
    """The balance {entry: J} with what its entry `source` holds more than all others: `residual`."""
    return {**balance, "residual": balance[source] - math.fsum(value for name, value in balance.items()
                                                               if name != source)}


def energy_warnings(balance):
    """Lines where an energy balance misses more than ENERGY_MISSED of its largest entry, if that is no round-off."""
    largest = max(abs(value) for name, value in balance.items() if name != "residual")
    part = balance["residual"] / largest if largest > LEAST_ENERGY else 0.0
    return [] if abs(part) <= ENERGY_MISSED else [
        f"the energy balance misses {100 * part:.3g} % of its largest entry: results are no better known than that; a "
        "smaller sampling period or time_step_fraction may tell why"]

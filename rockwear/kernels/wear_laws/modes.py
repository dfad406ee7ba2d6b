"""The sum of several wear modes."""
import numpy as np

from rockwear.kernels.checks import ParameterError, finite, require
from rockwear.kernels.parameter import Parameter, text
from rockwear.kernels.wear_laws.base import WEAR_COEFFICIENT, WearLaw
from rockwear.kernels.wear_laws.power import PowerLaw


class SumOfModes(WearLaw):
    """The sum of several modes [Rojek 2003, 6.4]. modes: laws of one mode, each with its own k, share and exponent.

    Raises ParameterError without a mode, or where the shares do not add up to 1.
    """

    name = "modes"
    parameters = (Parameter("wear_modes", "", "", text, "k/exponent/share of the friction for each mode, with commas "
                            "between modes", "[Rojek 2003, 6.4-6.5]"),)

    def __init__(self, modes):
        super().__init__()
        self.modes = list(modes)
        require(len(self.modes) > 0, "modes", len(self.modes), "at least one")
        shares = sum(mode.share for mode in self.modes)
        require(abs(shares - 1) < 1e-9, "modes", shares, "given shares of the friction that add up to 1")

    @classmethod
    def from_values(cls, values, mu):
        given = values["wear_modes"]
        try:
            return cls(_mode(word, mu) for word in given.split(","))
        except ParameterError as error:
            # The user knows one word for all modes, not the arguments of their laws.
            argument = "" if error.name in ("modes", "wear_modes") else f"with {error.name} "
            raise ParameterError("wear_modes", given, f"{argument}{error.rule}") from None

    @property
    def needs(self):
        return tuple(dict.fromkeys(need for mode in self.modes for need in mode.needs))

    @property
    def wears(self):
        return any(mode.wears for mode in self.modes)

    def volume(self, slid, hardness, area):
        return sum(mode.volume(slid, hardness, area) for mode in self.modes)

    def rate(self, pressure, hardness):
        return sum(mode.rate(pressure, hardness) for mode in self.modes)

    def scaled(self, factor):
        return SumOfModes([mode.scaled(factor) for mode in self.modes])

    def depths(self, test):
        return [mode.depth_per_k(test) for mode in self.modes]

    def error_of(self, test):
        """As WearLaw.error_of; of modes with different exponents the largest error counts."""
        return np.max([mode.error_of(test) for mode in self.modes], axis=0)

    def _with(self, k):
        return SumOfModes([mode._with([one]) for mode, one in zip(self.modes, k)])


def _mode(word, mu):
    parts = word.split("/")
    if len(parts) != 3:
        raise ParameterError("wear_modes", word.strip(), "k/exponent/share of each mode, with commas between modes")
    exponent, share = (finite("wear_modes", part) for part in parts[1:])
    return PowerLaw(k=WEAR_COEFFICIENT.rule("k", parts[0], ""), mu=mu, exponent=exponent, share=share)

"""A power of the friction stress."""
import numpy as np

from rockwear.kernels.parameter import Parameter, number
from rockwear.kernels.wear_fitting import fit_line
from rockwear.kernels.wear_laws.base import FRICTION, STEEPEST, WEAR_COEFFICIENT, SingleMode


class PowerLaw(SingleMode):
    """dw/ds = (p_T / (tau H))^n with tau = mu k^(-1/n) [Rojek 2003, 6.5].

    mu: Coulomb's coefficient; exponent: n; share: of the friction that is of this mode.
    """

    name = "power"
    parameters = (WEAR_COEFFICIENT, Parameter("wear_exponent", 1.0, "", number(1e-3, STEEPEST), "n of the power law, "
                                              "k (p / H)^n", "[Rojek 2003, 6.5]; the value is ours"))
    force = FRICTION

    def __init__(self, *, k, mu, exponent, share=1.0):
        super().__init__(k=k, mu=mu, share=share, exponent=exponent)

    @classmethod
    def from_values(cls, values, mu):
        return cls(k=values["wear_coefficient"], mu=mu, exponent=values["wear_exponent"])

    @property
    def reference(self):
        """tau, the reference stress of this mode over the hardness, -; infinite for k = 0."""
        return np.inf if self.k == 0 else self.mu * self.k**(-1 / self.exponent)

    def fit_exponent(self, test):
        """The same law with k and n both fitted, from tests at different p / H. -> (law, Fit, (n, its uncertainty)).

        A straight line through log(w / s) over log(p / H), weighted by the errors where all are known. Raises
        ParameterError for fewer than three tests, or equal p / H.
        """
        load = self.share * self.load(test)[0]

        def power(k, exponent):
            return PowerLaw(k=k, mu=self.mu, exponent=exponent, share=self.share)
        return fit_line(power, self, test, load)

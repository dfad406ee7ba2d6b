"""Archard's law in the friction work."""
from rockwear.kernels.wear_laws.base import FRICTION, WEAR_COEFFICIENT, SingleMode


class DissipationArchard(SingleMode):
    """dw/ds = (k / mu) p_T / H [Rojek 2003, eq. 6.9].

    mu: Coulomb's coefficient; share: of the friction that is of this mode.
    """

    name = "dissipation"
    parameters = (WEAR_COEFFICIENT,)
    force = FRICTION

    def __init__(self, *, k, mu, share=1.0):
        super().__init__(k=k, mu=mu, share=share)

    @classmethod
    def from_values(cls, values, mu):
        return cls(k=values["wear_coefficient"], mu=mu)

"""Archard's law in the pressure."""
from rockwear.kernels.wear_laws.base import WEAR_COEFFICIENT, SingleMode


class PressureArchard(SingleMode):
    """dw/ds = k p_n / H [Rojek 2003, eq. 6.7]."""

    name = "pressure"
    parameters = (WEAR_COEFFICIENT,)

    def __init__(self, *, k):
        super().__init__(k=k)

    @classmethod
    def from_values(cls, values, mu):
        return cls(k=values["wear_coefficient"])

"""Thermal data of rock and steel [Rojek 2003, 7.4; Rojek 2014, 5.1]."""
from dataclasses import dataclass, fields

from rockwear.kernels.checks import positive


@dataclass(frozen=True)
class Material:
    """Bulk data of a solid: density (kg/m3), specific_heat (J/kg K), conductivity (W/m K). Raises ParameterError."""

    density: float
    specific_heat: float
    conductivity: float

    def __post_init__(self):
        for field in fields(self):
            positive(field.name, getattr(self, field.name))


STEEL = Material(density=7830.0, specific_heat=450.0, conductivity=60.0)
SANDSTONE = Material(density=2500.0, specific_heat=1970.0, conductivity=5.0)

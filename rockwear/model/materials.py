"""The materials of the sources: thermal data of rock, steel and media (M 7.4-7.5, P 5.1)."""
from dataclasses import dataclass, fields

from rockwear.kernels.checks import positive


@dataclass(frozen=True)
class Material:
    """Bulk data of a solid: density (kg/m3), specific_heat (J/kg K), conductivity (W/m K)."""

    density: float
    specific_heat: float
    conductivity: float

    def __post_init__(self):
        for field in fields(self):
            positive(field.name, getattr(self, field.name))

    def particle_density(self, porosity):
        """Density (kg/m3) of the particles of a packing with this porosity: bulk / (1 - n) (P 63)."""
        return self.density / (1 - porosity)


STEEL = Material(density=7830, specific_heat=450, conductivity=60)
SANDSTONE = Material(density=2500, specific_heat=1970, conductivity=5)
SANDY_SOIL = Material(density=1820, specific_heat=1004, conductivity=0.58)
MARBLE = Material(density=2700, specific_heat=860, conductivity=3)
TUFF = Material(density=2500, specific_heat=950, conductivity=2)
DRY_SAND = Material(density=1600, specific_heat=800, conductivity=0.35)

CONVECTION = {"air": 30.0, "forced air": 100.0, "water": 5000.0}
"""Heat transfer coefficients (W/m2 K) at a free surface (M 7.5); water may reach 25000."""

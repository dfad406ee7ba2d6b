"""The contact between tool and rock, and the units of a scene in the plane and in space."""
from dataclasses import dataclass

from rockwear.kernels.checks import not_negative, positive


@dataclass(frozen=True)
class ContactLaw:
    """Contact of the tool with the rock [Rojek 2003, 4.5]: linear springs, a dashpot, Coulomb friction; no tension.

    kn, kt: N/m; mu: friction coefficient; damping: dashpot as a fraction of the critical one. Raises ParameterError.
    """

    kn: float
    kt: float
    mu: float
    damping: float = 0.0

    def __post_init__(self):
        positive("tool_kn", self.kn, "N/m"), positive("tool_kt", self.kt, "N/m")
        not_negative("tool_mu", self.mu), not_negative("contact_damping", self.damping)


@dataclass(frozen=True)
class Units:
    """Units of forces, energies, volumes and masses; in the plane all count per metre of thickness."""

    force: str
    energy: str
    volume: str
    mass: str


PLANE = Units(force="N/m", energy="J/m", volume="m3/m", mass="kg/m")
SPACE = Units(force="N", energy="J", volume="m3", mass="kg")

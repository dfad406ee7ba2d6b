"""The physics that a scene may need: wear, heat, thermal expansion, gravity. Each is an object that is there or not."""
import math
from dataclasses import dataclass

import numpy as np
from yade import NewtonIntegrator, Vector3

from rockwear.engines import access
from rockwear.engines.absorbing_boundary import AbsorbingBoundary
from rockwear.engines.expansion import Expansion
from rockwear.engines.heat import Heat
from rockwear.kernels.archard import Hardness
from rockwear.kernels.checks import require
from rockwear.kernels.conduction import HeatNetwork, effusivity, effusivity_share
from rockwear.kernels.wear_statistics import distribution_error, events_per_particle, trusted_wear_acceleration
from rockwear.model.materials import Material

MOST_HEAT_STEPS = 1000
"""Into which the time between two visits may have to be divided."""
LOST = 0.1
"""Part of Archard's volume that a rule of removal may lose without a warning."""


def two_digits(value):
    """A number to two digits, without an exponent where that is usual."""
    return f"{float(f'{value:.2g}'):g}"


@dataclass(frozen=True)
class ToolWear:
    """How the tool wears: a law with its wear acceleration in it, and the hardness over temperature.

    law: of kernels.wear_laws; acceleration: the factor on its coefficient; removal: rule of kernels.erosion; tolerance:
    error of the wear distribution up to which an acceleration is trusted.
    """

    law: object
    hardness: Hardness
    acceleration: float = 1.0
    removal: str = "volume"
    tolerance: float = 0.1

    def trust(self, tool):
        """{name: (value, unit)}: the two rules for accelerated wear [Rocky], judged from the run's own record, and up
        to which acceleration they and a slow recession of facets (`tool.slow_recession`) are kept."""
        error, events, _ = self._by_the_record(tool)
        return {"wear_distribution_error": (error, "-"), "contact_events_per_particle": (events, "-"),
                "trusted_wear_acceleration": (self.trusted(tool), "-")}

    def trusted(self, tool):
        """The acceleration up to which the two rules, where the tool has a profile, and a slow recession are kept."""
        return min(self._by_the_record(tool)[2] if tool.profile else math.inf, tool.slow_recession())

    def _by_the_record(self, tool):
        """(error of the distribution, contact events per particle, acceleration that the two rules allow)."""
        engine = tool.wear_engine
        error = distribution_error(tool.profile.increments)
        kept = self.removal == "none"
        events = math.inf if kept else events_per_particle(events=engine.events, worn=engine.worn, limit=engine.limit)
        return error, events, trusted_wear_acceleration(wear_acceleration=self.acceleration, error=error, events=events,
                                                        tolerance=self.tolerance)

    def warnings(self, tool):
        """Lines on how well the distribution of wear is known, and on wear that the rule of removal lost."""
        return [*self._lost(tool), *self._distrust(tool)]

    def _lost(self, tool):
        balance = tool.volume_balance()
        lost = -balance["unexplained"] / balance["archard"] if balance["archard"] > 0 else 0.0
        return [] if lost <= LOST else [
            f"removal = {self.removal} has lost {100 * lost:.2g} % of Archard's volume: removal = volume conserves it, "
            "and less is lost at a lower wear_acceleration or a shorter wear_period"]

    def _distrust(self, tool):
        error, events, trusted = self._by_the_record(tool)
        if math.isnan(events) or (math.isfinite(error) and trusted >= self.acceleration):
            return []
        if not math.isfinite(error):
            known = "cannot be told from a run as short as this"
        else:
            known = f"is known to {100 * error:.2g} %" + " only" * (error > self.tolerance)
        longer = self.acceleration <= max(trusted, 1.0) or self.removal == "none"
        advice = "run longer" if longer else (
            f"use wear_acceleration = {two_digits(max(self.trusted(tool), 1.0))} at most instead of "
            f"{self.acceleration:g}, and run that much longer")
        goes = f", and {tool.piece} goes in {two_digits(events)} contact events" if math.isfinite(events) else ""
        return [f"where the tool wears {known}{goes}: to trust the "
                f"distribution of wear to {100 * self.tolerance:g} %, {advice}"]


@dataclass(frozen=True)
class HeatModel:
    """Heat in rock and tool [Rojek 2003, ch. 7; Rojek 2014, 3.2-3.5]: friction, conduction, exchange, convection,
    radiation.

    rock, tool: model.materials.Material; paths: how particles conduct, one of kernels.conduction.PATHS; fraction:
    part of friction work that becomes heat; sharing: "effusivity" or "equal"; contact_conductance, convection: W/m2K;
    emissivity: of free surfaces; rock_temperature, tool_temperature, ambient: K at first and of the air;
    shank_temperature: K at which the shank holds the tool, None where it is insulated; conduction: False leaves all
    heat where it arises.
    """

    rock: Material
    tool: Material
    paths: str
    fraction: float
    sharing: str
    contact_conductance: float
    convection: float
    emissivity: float
    rock_temperature: float
    tool_temperature: float
    ambient: float
    shank_temperature: float = None
    conduction: bool = True

    def engine(self, *, rock, body, bonds, rock_friction, tool_contact, wear_acceleration, time_scale, surface_period,
               period):
        """engines.heat.Heat of a specimen and a model.thermal_body.ThermalBody."""
        capacity = np.concatenate([self._rock_masses(rock) * self.rock.specific_heat,
                                   body.capacities(self.tool, self.paths)])
        temperature = np.repeat([self.rock_temperature, self.tool_temperature], [rock.count, body.count])
        network = HeatNetwork(capacity=capacity, temperature=temperature, edges=np.empty((0, 2), int), conductance=0.0)
        return Heat(network=network, bonds=bonds, rock_friction=rock_friction, tool_contact=tool_contact, rock=rock,
                    body=body,
                    heat_fraction=self.fraction, tool_share=self.tool_share(),
                    contact_conductance=self.contact_conductance,
                    convection=self.convection, emissivity=self.emissivity, ambient=self.ambient,
                    rock_paths=rock.paths(self.paths, self.rock.conductivity),
                    tool_paths=body.paths(self.paths, self.tool.conductivity), conduction=self.conduction,
                    shank_temperature=self.shank_temperature, surface_period=surface_period,
                    wear_acceleration=wear_acceleration, time_scale=time_scale, period=period)

    def _rock_masses(self, rock):
        """(n,) kg: of the Voronoi cells where heat passes their faces, else the particles' own as in the sources."""
        return rock.density * rock.cells.volumes if self.paths == "voronoi" else rock.masses

    def tool_share(self):
        """Part of the heat of tool-rock friction that the tool takes."""
        if self.sharing == "equal":
            return 0.5
        tool, rock = (effusivity(m.conductivity, m.density, m.specific_heat) for m in (self.tool, self.rock))
        return effusivity_share(tool, rock)

    def check_period(self, heat, period):
        """Raise ParameterError (heat_period) where a period (s) would take too many stable heat steps."""
        longest = MOST_HEAT_STEPS * heat.network.stable_step()
        require(period <= longest, "heat_period", period,
                f"at most {MOST_HEAT_STEPS} stable heat steps, {longest:.3g} s with these conductivities and "
                "capacities", "s")


@dataclass(frozen=True)
class ThermalExpansion:
    """Thermal expansion of the rock [Rojek 2014, eq. 11]. coefficient: 1/K; reference: K."""

    coefficient: float
    reference: float

    def engine(self, *, rock, heat, bonds, rock_friction, tool_contact, period):
        """engines.expansion.Expansion."""
        return Expansion(coefficient=self.coefficient, rock=rock, reference=self.reference, bonds=bonds,
                         temperature=lambda: heat.network.temperature[:rock.count], period=period,
                         loose=lambda: [*rock_friction.contacts, *(entry[0] for entry in tool_contact.possible)])


@dataclass(frozen=True)
class Boundary:
    """What holds the ends of a rock mass: "absorbing", springs and dashpots of the rock beyond; "fixed", nothing moves;
    "free", nothing moves at the bottom, and the sides are free."""

    kind: str

    def engine(self, rock, *, period, step, critical):
        """engines.absorbing_boundary.AbsorbingBoundary; None where nothing moves."""
        if self.kind != "absorbing":
            return None
        return AbsorbingBoundary(moduli=rock.moduli(), density=rock.density, period=period, step=step,
                                 critical=critical)


@dataclass(frozen=True)
class Gravity:
    """Gravity g (m/s2), downwards along -y."""

    g: float

    @property
    def vector(self):
        """Vector3, m/s2; None without gravity."""
        return Vector3(0, -self.g, 0) if self.g else None

    def switch_on(self):
        """Let YADE's integrator apply it."""
        if self.g:
            access.yade_engine(NewtonIntegrator).gravity = self.vector

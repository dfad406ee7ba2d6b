"""Parts of a cut, made from a scene's parameters."""
import math
from contextlib import contextmanager

import numpy as np

from rockwear.kernels.archard import BRINELL, KELVIN, MET71, MET91, Hardness
from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.polygon import read_outline, tip, tooth
from rockwear.kernels.wear_laws import WEAR_LAWS
from rockwear.model.contact import PLANE, ContactLaw
from rockwear.model.facet_tool import FacetTool
from rockwear.model.materials import Material
from rockwear.model.particle_tool import Tool
from rockwear.model.thermal_body import FacetBody
from rockwear.scenes.accuracy import Accuracy
from rockwear.scenes.physics import HeatModel, ThermalExpansion, ToolWear
from rockwear.scenes.tool_assembly import FacetAssembly, ParticleAssembly

HARDNESS = {"MET71": MET71, "MET91": MET91}
NEVER_TURNS = 1e9
"""Moment of inertia of particles that do not turn, over their own."""
SIZES = "tool_radius_min", "tool_radius_max", "tool_radius", "segment", "facet"
"""Parameters, m, of what an outline is filled or covered with."""


def bond_law(v):
    """The law of the bonds; of loose rock, which has none, one that gives its stiffness and friction."""
    values = vars(v)
    if "bond_law" in values:
        return BOND_LAWS[v.bond_law].from_values(values)
    return BOND_LAWS["brittle"].from_values({**values, "Rn": v.kn, "Rt": v.kn})


def bond(rock, v):
    """Give the rock's bonds their laws. -> the rock."""
    law, values = bond_law(v), vars(v)
    if "bond_law" in values:
        if v.rotation == "blocked":
            rock.inertias = NEVER_TURNS * rock.inertias
        rock.bond(law, grain_edge=v.grain_edge, within_grains=(v.grain_kn or law.kn, v.grain_kt or law.kt),
                  grain_strength=v.grain_strength, weibull_modulus=v.weibull_modulus, seed=v.seed)
    return rock


def outline(v):
    """(k, 2) m: the outline of the tool in its own frame, from a file or from the parameters of a tooth."""
    if v.outline:
        # Its tip is where the tooth of the parameters has its own, wherever the file has its origin.
        vertices = read_outline(v.outline)
        return vertices - tip(vertices) - [v.tip_radius, 0.0]
    try:
        vertices = tooth(height=v.tooth_height, width=v.tooth_width, rake=math.radians(v.rake),
                         clearance=math.radians(v.clearance), tip_radius=v.tip_radius, wear_flat=v.wear_flat,
                         flat_angle=math.radians(v.flat_angle))
    except ParameterError as error:
        # The kernel's words for them, and its radians, are not those of the scene.
        if error.unit == "rad":
            raise ParameterError(error.name, getattr(v, error.name), error.rule, "deg") from None
        name = {"height": "tooth_height", "width": "tooth_width"}.get(error.name, error.name)
        raise ParameterError(name, error.value, error.rule, error.unit) from None
    # The chords of a round tip may end above its lowest point, from which the depth of cut counts.
    return vertices - [0.0, vertices[:, 1].min()]


def check_extent(v, name, found, good, rule):
    """Raise ParameterError where an extent (m) of the tool is not good: by `name`, its parameter, or the outline's."""
    given = ("outline", f"{v.outline}, {found:g} m in {name.removeprefix('tooth_')}") if v.outline else (name, found)
    require(good, *given, rule, "" if v.outline else "m")


def check_height(v, vertices, name, depth):
    """Raise ParameterError for an outline (k, 2) m no higher than the depth (m) of its cut, parameter `name`."""
    height = float(np.ptp(vertices[:, 1]))
    check_extent(v, "tooth_height", height, height > depth, f"more than {name} = {depth:g} m")


@contextmanager
def as_outline(v, vertices):
    """A context in which a ParameterError of SIZES is one of the outline (k, 2) m where a file gives it: not in m it
    fits none of them."""
    try:
        yield
    except ParameterError as error:
        if not v.outline or error.name not in SIZES:
            raise
        width, height = np.ptp(vertices, axis=0)
        raise ParameterError("outline", f"{v.outline}, {width:g} m x {height:g} m",
                             f"in m, and such that {error.name} = {error.value:g} m is {error.rule}") from None


def hardness(v, wears=True):
    """Hardness of the tool: constant, the table's at one temperature, or the table, which the first temperatures must
    then be in. wears: whether anything asks for it."""
    if v.hardness > 0:
        return Hardness.constant(v.hardness)
    table = HARDNESS[v.hardness_table]
    low, high = table.limits
    if v.hardness_temperature != -1:
        require(low <= v.hardness_temperature <= high, "hardness_temperature", v.hardness_temperature,
                f"inside the hardness table of {v.hardness_table}, {low:g} to {high:g}, or -1 for the tool's own", "K")
        return Hardness.constant(table(v.hardness_temperature))
    used = ("tool_temperature", "rock_temperature", "ambient_temperature",
            "shank_temperature") if v.heat else ("tool_temperature",)
    for name in used if wears else ():
        value = getattr(v, name)
        require(low <= value <= high, name, value,
                f"inside the hardness table of {v.hardness_table}, {low:g} to {high:g}", "K")
    return Hardness(table.kelvin - KELVIN, table.pascal / BRINELL)


def tool_wear(v):
    """scenes.physics.ToolWear."""
    law = WEAR_LAWS[v.wear_law].from_values(vars(v), mu=v.tool_mu).scaled(v.wear_acceleration)
    return ToolWear(law=law, hardness=hardness(v, law.wears), acceleration=v.wear_acceleration,
                    removal=v.removal if v.tool == "particles" else "volume", tolerance=v.wear_tolerance)


def contact_law(v):
    """model.contact.ContactLaw of tool and rock."""
    return ContactLaw(kn=v.tool_kn, kt=v.tool_kt, mu=v.tool_mu, damping=v.contact_damping)


def accuracy(v):
    """scenes.accuracy.Accuracy."""
    names = Accuracy.__dataclass_fields__
    return Accuracy(**{name: getattr(v, name) for name in names})


def heat(v):
    """scenes.physics.HeatModel, None without heat."""
    if not v.heat:
        return None
    return HeatModel(
        rock=Material(density=v.rock_density, specific_heat=v.rock_specific_heat, conductivity=v.rock_conductivity),
        tool=Material(density=v.tool_density, specific_heat=v.tool_specific_heat, conductivity=v.tool_conductivity),
        paths=v.bond_conductance, fraction=v.heat_fraction, sharing=v.heat_sharing,
        contact_conductance=v.contact_conductance, convection=v.convection, emissivity=v.emissivity,
        rock_temperature=v.rock_temperature, tool_temperature=v.tool_temperature,
        ambient=v.ambient_temperature, shank_temperature=v.shank_temperature if v.shank == "fixed" else None,
        conduction=v.conduction)


def expansion(v):
    """scenes.physics.ThermalExpansion of the rock, None without heat or expansion."""
    return ThermalExpansion(coefficient=v.rock_expansion,
                            reference=v.rock_temperature) if v.heat and v.rock_expansion else None


def check_radii(v):
    """Raise ParameterError for radii of rock or tool in the wrong order."""
    require(v.radius_max >= v.radius_min, "radius_max", v.radius_max, f"at least radius_min = {v.radius_min:g}", "m")
    if v.tool == "particles":
        require(v.tool_radius_max >= v.tool_radius_min, "tool_radius_max", v.tool_radius_max,
                f"at least tool_radius_min = {v.tool_radius_min:g}", "m")
        require(v.tool_radius_max <= v.radius_min, "tool_radius_max", v.tool_radius_max,
                f"at most the rock's radius_min = {v.radius_min:g}: a smooth tool needs finer particles", "m")


def thermal_fill(v, vertices):
    """Particles that stand for the heat of a tool of facets with this outline (k, 2) m. Raises ParameterError."""
    try:
        return Tool(vertices=vertices, radius_min=0.87 * v.thermal_radius, radius_max=1.13 * v.thermal_radius,
                    seed=v.seed, removal="none", density=v.tool_density)
    except ParameterError as error:
        if not error.name.startswith("tool_radius"):
            raise
        raise ParameterError("thermal_radius", v.thermal_radius, "so that of the particles which fill the tool "
                             f"{error.value:g} is {error.rule}", "m") from None


def plane_tool(v, vertices):
    """The tool assembly of an outline (k, 2) m in the plane, of particles or segments."""
    common = dict(outline=vertices, contact_law=contact_law(v), wear=tool_wear(v), units=PLANE,
                  sampling_period=v.sampling_period)
    with as_outline(v, vertices):
        if v.tool == "segments":
            model = FacetTool.of_outline(vertices, segment=v.segment, density=v.tool_density)
            return FacetAssembly(model=model, work_fraction=v.work_fraction, reshape=v.reshape,
                                 thermal_body=lambda: FacetBody(model, fill=thermal_fill(v, vertices)), **common)
        model = Tool(vertices=vertices, radius_min=v.tool_radius_min, radius_max=v.tool_radius_max, seed=v.seed,
                     removal=v.removal, density=v.tool_density)
    return ParticleAssembly(model=model, **common)


def common(v):
    """What a Cut is given whatever its tool and programme."""
    return dict(bond_law=bond_law(v), non_viscous_damping=v.non_viscous_damping,
                bond_damping=getattr(v, "bond_damping", 0.0), grain_quality=getattr(v, "grain_quality", 0.0),
                accuracy=accuracy(v), depth_of_cut=v.depth_of_cut, heat=heat(v), expansion=expansion(v),
                first_temperature=v.tool_temperature, control_radius=v.control_radius)

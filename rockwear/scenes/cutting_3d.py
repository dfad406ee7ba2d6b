"""The cut in space: a tooth lowered into bonded or loose spheres, then drawn through them [Rojek 2003, ch. 13]."""
import math
from types import SimpleNamespace

import numpy as np
from scipy.spatial import ConvexHull

from rockwear.kernels.boundary import area_vectors, prism, refine
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, length_or_zero, number
from rockwear.kernels.polygon import area, perimeter, tip
from rockwear.model.contact import SPACE
from rockwear.model.facet_tool import MOST_FACETS, FacetTool, check_size, read_stl
from rockwear.model.particle_tool import LayeredTool
from rockwear.model.rock import Block
from rockwear.model.thermal_body import FacetBody
from rockwear.scenes import parameters, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.physics import Gravity
from rockwear.scenes.programme import LowerAndCut
from rockwear.scenes.tool_assembly import FacetAssembly, ParticleAssembly

SNAPSHOT = Group("output", (Parameter("snapshot_period", 0.05, "s", parameters.duration,
                                      "simulated time between the pictures "
                                      "of the report"),))
GROUPS = parameters.with_defaults(
    [parameters.BLOCK, parameters.BONDS, parameters.SPACE_TOOL, parameters.CONTACT, parameters.LOWERING,
     parameters.WEAR,
     parameters.HEAT, parameters.ACCURACY, SNAPSHOT, parameters.DENSITY_MAP],
    kn=1e6, kt=1e6, Rn=9.0, Rt=90.0, mu=0.5, tool_kn=1e6, tool_kt=1e6, tool_mu=0.1, contact_damping=0.0,
    hardness=1.0,
    wear_coefficient=0.0, wear_acceleration=1.0, removal="none", heat=False, damping_period=100, rock_sampling_period=8,
    wear_period=10, record_period=2e-3, heat_period=2e-3,
    surface_period=0.02)
SETTLING = (
    Parameter("settling", 0.4, "s", parameters.duration, "time for the fill to settle under gravity"),
    Parameter("settling_damping", 50.0, "1/s", number(0), "background damping while it settles"),
    Parameter("freeboard", 0.06, "m", length_or_zero, "how far the box's sides stand above the fill"))
LOOSE_GROUPS = [
    {"bonds": parameters.LOOSE, "motion": Group("motion", (*group.parameters, *SETTLING))}.get(group.title, group)
    for group in parameters.given(GROUPS, heat=False)]
SCALED = {**{p.name: p.size_power[1] for group in (parameters.BONDS, parameters.CONTACT) for p in group.parameters},
          "radius": 1, "tool_radius": 1, "thermal_radius": 1}
"""Powers of the scale factor with which parameters grow: lengths with it, while stresses stay."""


def groups(**defaults):
    """Parameter groups of the cut in bonded rock with other defaults."""
    return parameters.with_defaults(GROUPS, **defaults)


def loose_groups(**defaults):
    """Parameter groups of the cut in loose spheres with other defaults."""
    return parameters.with_defaults(LOOSE_GROUPS, **{"kn": 1e6, "kt": 1e6, "mu": 0.1, **defaults})


def make(values):
    """The scene in bonded rock of {name: value} of all parameters. Raises ParameterError."""
    v = scaled(values)
    check_cut(v)
    rock = Block(width=v.width, height=v.height, depth=v.depth, radius=v.radius, porosity=v.porosity, seed=v.seed,
                 bonding_gap=v.bonding_gap, density=v.rock_density)
    # The tooth is lowered at the left end, where the block is free so that a chip can break out.
    rock.fix("bottom", "right", "front", "back")
    rock.fix("left", below=v.height - 2 * v.depth_of_cut)
    return Cut(rock=parts.bond(rock, v), tool=tool(v), programme=LowerAndCut(ways=ways(v), start=start(v)),
               gravity=Gravity(v.gravity), background_damping=v.background_damping, notes=notes(v), **parts.common(v))


def make_loose(values):
    """The scene in loose spheres, which settle under gravity first, in a box of fixed ones [Rojek 2003, 13.1]."""
    v = scaled({**values, "heat": False, "heat_period": 0.0, "surface_period": 0.0})
    check_cut(v)
    cutter = tool(v)
    room = 3 * v.radius - v.tip_radius - float(cutter.outline[:, 0].min())
    require(v.start > room, "start", v.start, f"more than {room:g}, for the tooth to clear the box behind it", "m")
    rock = Block(width=v.width, height=v.height + v.freeboard, depth=v.depth, radius=v.radius, porosity=v.porosity,
                 seed=v.seed,
                 bonding_gap=0.0, density=v.rock_density, bonded=False)
    # So many are fixed that none of the others can slip through.
    rock.fix("bottom", "left", "right", "front", "back", within=2)
    rock.leave_out((rock.positions[:, 1] > v.height - v.radius) & ~rock.fixed)
    programme = LowerAndCut(ways=[("settling", v.settling, (0.0, 0.0)), *ways(v)], start=start(v),
                            damping_rates=[v.settling_damping, v.background_damping, v.background_damping])
    return Cut(rock=rock, tool=cutter, programme=programme, gravity=Gravity(v.gravity), notes=notes(v),
               **parts.common(v))


def scaled(values):
    """The parameters with the scale factor applied."""
    v = SimpleNamespace(**values)
    for name, power in SCALED.items():
        if power and name in values:
            setattr(v, name, v.scale_factor**power * values[name])
    return v


def check_cut(v):
    """Raise ParameterError for a way or a depth that the block has no room for."""
    require(v.velocity * v.cut_time < v.width - v.start, "cut_time", v.cut_time,
            f"so short that the tool's way, {v.velocity * v.cut_time:g} m, stays within the block: it starts at "
            f"{v.start:g} of {v.width:g} m", "s")
    require(2 * v.radius < v.depth_of_cut < v.height, "depth_of_cut", v.depth_of_cut,
            f"more than a rock particle, {2 * v.radius:g}, and less than the block's height {v.height:g}", "m")


def ways(v):
    """[(stage, s, velocity (2,) m/s of the tool)]."""
    return [("lowering", (v.approach + v.depth_of_cut) / v.lowering_velocity, (0.0, -v.lowering_velocity)),
            ("cutting", v.cut_time, (v.velocity, 0.0))]


def start(v):
    """(2,) m: the place of the tool's origin at first."""
    return v.start + v.tip_radius, v.height + v.approach


def notes(v):
    """Further results."""
    return {"scale_factor": (v.scale_factor, "-")}


def tool(v):
    """The tool assembly: spheres in layers, triangles of an outline drawn out across the cut, or an STL file."""
    common = dict(contact_law=parts.contact_law(v), wear=parts.tool_wear(v), units=SPACE,
                  sampling_period=v.sampling_period)
    if v.stl:
        require(not v.heat, "stl", v.stl, "left out with heat = true: heat is for a tool with an outline")
        seen, model = stl_tool(v)
        return FacetAssembly(model=model, outline=seen, work_fraction=v.work_fraction, reshape=v.reshape,
                             thermal_body=None, **common)
    require(v.breadth < v.depth, "breadth", v.breadth, f"less than the block's depth {v.depth:g}", "m")
    outline = parts.outline(v)
    parts.check_height(v, outline, "depth_of_cut", v.depth_of_cut)
    if v.tool == "triangles":
        with parts.as_outline(v, outline):
            check_facet(v, 2 * area(outline) + perimeter(outline) * v.breadth)
        corners, facets = prism(outline, v.breadth, v.facet)
        model = FacetTool(vertices=corners, facets=facets, density=v.tool_density)
        return FacetAssembly(
            model=model, outline=outline, work_fraction=v.work_fraction, reshape=v.reshape, **common,
            thermal_body=lambda: FacetBody(model, fill=parts.thermal_fill(v, outline), breadth=v.breadth))
    require(v.tool_radius < v.radius, "tool_radius", v.tool_radius, f"less than that of the rock, {v.radius:g}", "m")
    with parts.as_outline(v, outline):
        model = LayeredTool(vertices=outline, radius=v.tool_radius, breadth=v.breadth, seed=v.seed, removal=v.removal,
                            density=v.tool_density)
    return ParticleAssembly(model=model, outline=outline, **common)


def stl_tool(v):
    """(outline (k, 2) m from the side, FacetTool) of an STL file."""
    vertices, facets = read_stl(v.stl, most=MOST_FACETS)
    size = np.ptp(vertices, axis=0)
    require(size[0] < v.width and size[2] < v.depth, "stl", f"{v.stl}, {size[0]:g} x {size[1]:g} x {size[2]:g}",
            f"shorter and narrower than the block, {v.width:g} x {v.height:g} x {v.depth:g}", "m")
    require(size[1] > v.depth_of_cut, "stl", f"{v.stl} of a height of {size[1]:g}",
            f"higher than depth_of_cut = {v.depth_of_cut:g}", "m")
    check_facet(v, float(np.linalg.norm(area_vectors(vertices, facets), axis=1).sum()))
    # Its tip goes where the tooth of the parameters has its own, wherever the file has its origin.
    (x, y), z = tip(vertices), vertices[:, 2]
    vertices, facets = refine(vertices - [x + v.tip_radius, y, 0.5 * (z.min() + z.max())], facets, 1.5 * v.facet)
    require(len(facets) <= MOST_FACETS, "facet", v.facet, f"so large that {v.stl} is divided into at most "
            f"{MOST_FACETS} facets: these are {len(facets)}", "m")
    seen = vertices[:, :2]
    return seen[ConvexHull(seen).vertices], FacetTool(vertices=vertices, facets=facets, density=v.tool_density)


def check_facet(v, surface):
    """Raise ParameterError for triangles, halves of squares, of which a surface (m2) would have too many."""
    check_size("facet", v.facet, math.sqrt(2 * surface / MOST_FACETS))

"""The cut in the plane: a tooth through a box of bonded rock, start-up and cycles [Rojek 2003, ch. 8-10]."""
from types import SimpleNamespace

import numpy as np

from rockwear.kernels.checks import require
from rockwear.model.rock import Specimen
from rockwear.scenes import parameters, parts
from rockwear.scenes.cut import Cut
from rockwear.scenes.programme import Cycles

GROUPS = [parameters.SPECIMEN, parameters.BONDS, parameters.PLANE_TOOL, parameters.CONTACT, parameters.CYCLES,
          parameters.WEAR,
          parameters.HEAT, parameters.ACCURACY, parameters.DENSITY_MAP]


def groups(**defaults):
    """The scene's parameter groups with other defaults."""
    return parameters.with_defaults(GROUPS, **defaults)


def make(values):
    """The scene of {name: value} of all parameters. Raises ParameterError."""
    v = SimpleNamespace(**values)
    parts.check_radii(v)
    check_cut(v, v.start_up + (v.cycle_time if v.cycles else 0.0))
    # The rock takes longest to pack: all else is refused before.
    return Cut(tool=tool(v), programme=Cycles(times=times(v), **motion(v)), time_scale=v.time_scale,
               background_damping=v.background_damping, **parts.common(v), rock=box(v))


def check_cut(v, seconds):
    """Raise ParameterError for a depth of cut or a way, in so many seconds, that the specimen has no room for."""
    require(2 * v.radius_max < v.depth_of_cut < v.height, "depth_of_cut", v.depth_of_cut,
            f"more than a rock particle, {2 * v.radius_max:g}, and less than the specimen's height {v.height:g}", "m")
    require(seconds * v.velocity <= v.width, "cycle_time", v.cycle_time,
            f"so short that the tool's travel, {seconds * v.velocity:g} m at {v.velocity:g} m/s with the start-up, "
            f"stays within the specimen's width {v.width:g} m", "s")


def box(v):
    """The specimen; it stands for a part of a rock mass: its sides are fixed where no chip can reach them."""
    rock = Specimen(width=v.width, height=v.height, radius_min=v.radius_min, radius_max=v.radius_max,
                    porosity=v.porosity,
                    seed=v.seed, bonding_gap=v.bonding_gap, grading_factor=v.grading_factor, fine_depth=v.fine_depth,
                    density=v.rock_density)
    rock.fix("bottom")
    rock.fix("left", "right", below=v.height - 3 * v.depth_of_cut)
    return parts.bond(rock, v)


def tool(v):
    """The tool assembly, no larger than the specimen."""
    vertices = parts.outline(v)
    width, height = np.ptp(vertices, axis=0).tolist()
    parts.check_extent(v, "tooth_width", width, width <= v.width, f"at most the specimen's width {v.width:g} m")
    parts.check_extent(v, "tooth_height", height, height <= v.height, f"at most the specimen's height {v.height:g} m")
    parts.check_height(v, vertices, "depth_of_cut", v.depth_of_cut)
    return parts.plane_tool(v, vertices)


def times(v):
    """{stage: s}."""
    return {"start-up": v.start_up, **{f"cycle {n + 1}": v.cycle_time for n in range(v.cycles)}}


def motion(v):
    """What a programme of straight cuts asks for."""
    return dict(velocity=v.velocity, depth_of_cut=v.depth_of_cut, surface=v.height, approach=v.approach,
                ahead=v.depth_of_cut + 2 * v.radius_max, time_scale=v.time_scale)

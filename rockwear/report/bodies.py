"""Rock and tool of a run: what they are made of, where they are in a snapshot, how warm they are, how they look."""
import numpy as np
from matplotlib.colors import to_rgba
from scipy.spatial import cKDTree

from rockwear.kernels import polygon
from rockwear.kernels.boundary import area_vectors, distance, volume
from rockwear.kernels.rigid_motion import Pose
from rockwear.report import palette, shapes
from rockwear.report.instants import stage_name


# ---- what there is

def has_rock(run):
    """True for a run whose snapshots show bonded or loose rock."""
    return run.has("rock_positions", "rock_radii", "rock_fixed") and "bonds" in run.model


def has_particles(run):
    """True for a tool of particles."""
    return has_rock(run) and run.has("tool_positions", "tool_radii", "tool_offset", "alive")


def has_facets(run):
    """True for a tool of facets: segments in the plane, triangles in space."""
    return has_rock(run) and run.has("tool_vertices", "tool_facets", "tool_offset")


def has_tool(run):
    """True for a cut: rock and a tool."""
    return has_particles(run) or has_facets(run)


def has_heat(run):
    """True for a cut with temperatures."""
    return has_tool(run) and run.has("temperature")


def in_space(run):
    """True for rock of spheres, false for discs."""
    return has_rock(run) and run.snapshot(0)["rock_positions"].shape[1] == 3


def in_plane(run):
    """True for a cut in the plane."""
    return has_tool(run) and not in_space(run)


def is_loose(run):
    """True where nothing was ever bonded."""
    return len(run.model["bonds"]) == 0


def keeps_shape(run):
    """True for facets that collect wear without going back."""
    return "tool_facets" in run.model and not run.parameter("reshape", False)


def tool_volume(run):
    """Volume of the new tool, m3 or m3/m; nan where it is not known."""
    if "tool_volumes" in run.model:
        return float(run.model["tool_volumes"].sum())
    if has_particles(run):
        return float(((2 * run.model["tool_radii"]) ** run.model["tool_positions"].shape[1]).sum())
    return volume(run.model["tool_vertices"], run.model["tool_facets"]) if "tool_vertices" in run.model else np.nan


# ---- where it is

def pose(shot):
    """Where the tool is now, in the plane."""
    return Pose(shot["tool_offset"], float(shot.get("tool_turn", 0.0)))


def place(shot, points):
    """Points (n, d) of the tool's own frame where they are now."""
    return pose(shot).of(points) if points.shape[1] == 2 else points + np.array([*shot["tool_offset"], 0.0])


def tool_loops(run, shot):
    """Polygons (k, 2) m, in the tool's own frame, of what is left of a tool in the plane, worn depth taken off."""
    if has_facets(run):
        return [shot["tool_vertices"][shapes.loop(shot["tool_facets"])]]
    model, alive = run.model, shot["alive"]
    return shapes.outlines(model["tool_positions"][alive], model["tool_radii"][alive], shot["worn_depth"][alive])


def gap(run, points, shot=None):
    """(n,) m from points (n, 2) of the tool's own frame to the surface of what is left of a tool in the plane; of the
    new tool without a snapshot."""
    model = run.model
    if has_facets(run):
        now = shot or model
        return distance(points, now["tool_vertices"], now["tool_facets"])
    loops = tool_loops(run, shot) if shot else shapes.outlines(model["tool_positions"], model["tool_radii"])
    return shapes.distance_to(points, loops)


def tip(run):
    """(2,) m, tip of the new outline, in the tool's own frame."""
    return polygon.tip(run.model["outline"])


def facet_depth(run, shot):
    """(m,) m worn off the facets: how far their corners lie below the first surface, in the mean; of a shape that is
    kept, the volume over the area."""
    first, facets = run.model["tool_vertices"], run.model["tool_facets"]
    if keeps_shape(run):
        return shot["worn_volume"] / np.linalg.norm(area_vectors(first, facets), axis=1)
    return distance(shot["tool_vertices"], first, facets)[shot["tool_facets"]].mean(axis=1)


# ---- how warm it is

def rock_temperature(run, shot):
    """(n,) K of the rock."""
    return shot["temperature"][:len(run.model["rock_radii"])]


def tool_heat(run, shot):
    """(positions (n, d) m in the tool's own frame, radii (n,) m, temperatures (n,) K) of what is left of the tool.

    Thermal nodes are the tool's particles, or stand inside a tool of facets by themselves; none where a run does not
    say where they are.
    """
    values, model = shot["temperature"][len(run.model["rock_radii"]):], run.model
    if has_particles(run):
        alive = shot["alive"]
        return model["tool_positions"][alive], model["tool_radii"][alive], values[alive]
    positions = model.get("thermal_positions", np.empty((0, shot["rock_positions"].shape[1])))
    if not len(positions):
        return positions, np.empty(0), np.empty(0)
    alive = shot.get("thermal_alive", np.ones(len(positions), bool))
    # Nodes have no size of their own: discs that touch the nearest ones, a little larger to leave fewer gaps.
    near = cKDTree(positions).query(positions, min(2, len(positions)))[0].reshape(len(positions), -1)[:, -1]
    return positions[alive], 0.55 * near[alive], values[alive]


# ---- how it looks

def rock_colours(run, shot):
    """(n, 4) colour of each piece of rock: bonded ones by the share of their bonds that is broken, chips apart, loose
    ones by how far they have moved, fixed ones grey."""
    fixed, bonds = run.model["rock_fixed"], run.model["bonds"]
    if is_loose(run):
        begin = run.snapshot(run.stage_ends()[0])["rock_positions"]
        travel = np.linalg.norm(shot["rock_positions"] - begin, axis=1)
        colours = palette.TRAVEL(np.clip(travel / (4 * run.model["rock_radii"]), 0.08, 0.9))
    else:
        count, intact = len(fixed), shot["status"] == 0
        share = (np.bincount(bonds[~intact].ravel(), minlength=count)
                 / np.maximum(np.bincount(bonds.ravel(), minlength=count), 1))
        chip = shapes.chips(count, bonds, intact, fixed)
        colours = np.where(chip[:, None], palette.CHIP(share), palette.DAMAGE(share))
    colours[fixed] = to_rgba(palette.FIXED)
    return colours


def words_on_rock(run):
    """What the colours of the rock mean."""
    if is_loose(run):
        since = f"since the end of the {stage_name(run, 0)}"
        return f"Colour: how far each particle has moved {since}. Grey: fixed."
    return ("Blue: chips, pieces that no chain of bonds joins to the held rock. The darker a particle, the more of "
            "its bonds are broken. Grey: held.")

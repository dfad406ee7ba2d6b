"""Wear of a tool of particles in the plane: worn depth of each particle, and the particles removed."""
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from rockwear.report import palette
from rockwear.report.bodies import has_particles, in_plane
from rockwear.report.instants import first_cut, turns, worn
from rockwear.report.page import Section
from rockwear.report.plane import draw_new_outline, tip_limits, worn_limits
from rockwear.report.plots import MM, discs, frame, grid, save


def wear_particles(run):
    """Section of the wear by particle."""
    if not has_particles(run) or not in_plane(run):
        return None
    title = ("Accumulated wear during the first cut, as in [Rojek 2014, fig. 16]" if turns(run) else "Wear of the tool")
    return Section(title, "Depth worn off each particle that is left, and in pale red the particles that were removed, "
                   "so far. Line: the new tool.", [save(run, "wear", figure(run))])


def figure(run):
    """Worn depth of each particle at several instants."""
    shown = first_cut(run) if turns(run) else worn(run, 4)
    if not shown:
        return None
    shots = {label: run.snapshot(k) for label, k in shown.items()}
    last = list(shots.values())[-1]
    limits = tip_limits(run) if turns(run) else worn_limits(run, last)
    deepest = max(shot["worn_depth"][shot["alive"]].max(initial=0) for shot in shots.values())
    norm = Normalize(0, MM * max(1e-6, deepest))
    drawn, panels = grid(len(shots), 12, (limits[3] - limits[2]) / (limits[1] - limits[0]), most=4 if turns(run) else 2)
    for (label, shot), axes in zip(shots.items(), panels):
        paint(run, axes, shot, norm)
        frame(axes, limits, f"{label}\n{int((~shot['alive']).sum())} removed, {int(wearing(shot).sum())} being worn")
    drawn.colorbar(ScalarMappable(norm, palette.WEAR), ax=panels, label="worn depth of a particle / mm", shrink=0.7)
    return drawn


def wearing(shot):
    """(n,) bool: particles that are worn and still there."""
    return shot["alive"] & (shot["worn_depth"] > 0)


def paint(run, axes, shot, norm):
    """Particles by their worn depth, unworn ones pale, removed ones pale red."""
    places, radii, now = run.model["tool_positions"], run.model["tool_radii"], wearing(shot)
    unworn, gone = shot["alive"] & ~now, ~shot["alive"]
    discs(axes, places[unworn], radii[unworn], facecolors=palette.TOOL_UNWORN, edgecolors=palette.FIGURE)
    discs(axes, places[gone], radii[gone], facecolors=palette.REMOVED, edgecolors=palette.REMOVED_EDGE, linewidths=0.6)
    discs(axes, places[now], radii[now], array=MM * shot["worn_depth"][now], norm=norm, cmap=palette.WEAR,
          edgecolors=palette.PARTICLE_EDGE, linewidths=0.4)
    draw_new_outline(run, axes)

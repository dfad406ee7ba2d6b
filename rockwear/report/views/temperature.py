"""Temperature of rock and tool: in the plane, near the tip over the first turn, and in space."""
import numpy as np
from matplotlib.cm import ScalarMappable

from rockwear.report import palette
from rockwear.report.bodies import has_heat, in_space, place, rock_temperature, tip, tool_heat
from rockwear.report.instants import course_in_space, first_cooling, first_cut, moment, turns
from rockwear.report.page import Section, quantity
from rockwear.report.plane import draw_new_outline, paint_temperature, tip_limits
from rockwear.report.plots import KELVIN, MM, canvas, discs, frame, grid, rise_scale, save
from rockwear.report.solid import (
    ABOVE, BELOW, FRONT, READABLE, SIDE, behind_middle, paint, panels_without_axes, sphere_polygons, whole_frame)

NEAR = 15.0
"""Half the width (mm) of a picture of rock and tool at the tip; less of small tools."""
TOOL_VIEWS = {"from above": ABOVE, "from in front": FRONT, "from in front and below": BELOW}


def temperature(run):
    """Section of the temperature field."""
    if not has_heat(run) or turns(run):
        return None
    figure = in_space_figure(run) if in_space(run) else in_plane_figure(run)
    return Section("Temperature", "Rise above the coldest start, on a logarithmic scale.",
                   [save(run, "temperature", figure)])


def heating(run):
    """Section of the tip's temperature in the first cut of a run in turns."""
    if not has_heat(run) or not turns(run):
        return None
    return Section("Temperature during the first cut, as in [Rojek 2014, fig. 13]", "The tip of the pick, in its own "
                   "frame. Heat arises in the contact and falls off steeply behind it. Line: the new pick.",
                   [save(run, "heating", tip_figure(run, first_cut(run), 1))])


def cooling(run):
    """Section of the tip's temperature in the first cooling of a run in turns."""
    if not has_heat(run) or not turns(run):
        return None
    return Section("Temperature while the pick cools in water after the first cut, as in [Rojek 2014, fig. 14]",
                   "Water takes heat from the surface, and conduction spreads it through the body.",
                   [save(run, "cooling", tip_figure(run, first_cooling(run), 2))])


def scale(run, shots):
    """(coldest at the start, logarithmic scale of the rise above it) for some snapshots."""
    cold = float(np.nanmin(run.snapshot(0)["temperature"]))
    rises = [np.nanmax(values, initial=cold) - cold for shot in shots
             for values in (rock_temperature(run, shot), tool_heat(run, shot)[2])]
    return cold, rise_scale(max(rises))


def rise_label(cold):
    """Words at the colours."""
    return f"rise above {quantity(cold, 'K')} / K"


def hottest(run, shot):
    """Highest temperatures now, in words."""
    bodies = {"rock": rock_temperature(run, shot), "tool": tool_heat(run, shot)[2]}
    return ", ".join(f"{name} up to {quantity(float(np.nanmax(values)), 'K')}" for name, values in bodies.items()
                     if np.isfinite(values).any())


# ---- in the plane

def in_plane_figure(run):
    """Temperature at the end of the first stage and of the run: the whole, and the tip."""
    ends = run.stage_ends()
    shown = sorted({next(iter(ends.values())), len(run.times) - 1})
    shots = [run.snapshot(k) for k in shown]
    cold, norm = scale(run, shots)
    width, height = MM * run.model["box"]
    figure, panels = canvas(12, 5.2 * len(shown), len(shown), 2)
    for whole, near, k, shot in zip(panels[::2], panels[1::2], shown, shots):
        for axes in (whole, near):
            painted = paint_temperature(axes, run, shot, cold, norm)
        top = MM * place(shot, run.model["outline"])[:, 1].max()
        frame(whole, (-0.25 * width, 1.03 * width, 0, max(top, height) + 3), moment(run, k))
        frame(near, around_tip(run, shot), f"at the tip: {hottest(run, shot)}")
    figure.colorbar(painted, ax=panels, label=rise_label(cold), shrink=0.7, extend="min")
    return figure


def around_tip(run, shot):
    """Limits in mm around the tip where it is now, more of them above it."""
    x, y = MM * place(shot, tip(run)[None])[0]
    margin = min(NEAR, 0.75 * MM * np.ptp(run.model["outline"][:, 1]))
    return x - margin, x + margin, y - 0.5 * margin, y + 1.5 * margin


def tip_figure(run, shown, stage):
    """The tip in the tool's own frame at several instants, one scale for all of a stage."""
    if not shown:
        return None
    values = np.concatenate([tool_heat(run, run.snapshot(k))[2] for k in np.flatnonzero(run.stages == stage)])
    if not len(values):
        return None
    low, high = values.min(), values.max()
    norm = rise_scale(high - low)
    figure, panels = grid(len(shown), 12, 1.0, most=4)
    for axes, (label, k) in zip(panels, shown.items()):
        positions, radii, kelvin = tool_heat(run, run.snapshot(k))
        painted = discs(axes, positions, radii, array=np.maximum(kelvin - low, norm.vmin), norm=norm,
                        cmap=palette.TEMPERATURE, linewidths=0)
        draw_new_outline(run, axes)
        frame(axes, tip_limits(run), label)
    figure.colorbar(painted, ax=panels, label=f"rise above {low - KELVIN:.1f} °C / K", shrink=0.8)
    return figure


# ---- in space

def in_space_figure(run):
    """Rock and tool cut open at the middle plane, at instants of the cut; below, the tool's surface at the end."""
    shown = course_in_space(run, 3)
    shots = [run.snapshot(k) for k in shown.values()]
    cold, norm = scale(run, shots)
    figure, panels = panels_without_axes(12, 7, 2, 3)
    for axes, label, shot in zip(panels, shown, shots):
        paint(axes, *(warm_spheres(*body, norm, cold, SIDE) for body in opened(run, shot)),
              frame=whole_frame(run, SIDE), darkest=READABLE)
        axes.set_title(label)
    last = shots[-1]
    positions, radii, kelvin = tool_heat(run, last)
    for axes, (title, view) in zip(panels[3:], TOOL_VIEWS.items()):
        if len(kelvin):
            paint(axes, warm_spheres(positions, radii, kelvin, norm, cold, view), edge=0.15, darkest=READABLE)
            axes.set_title(f"tool {title}")
    panels[len(shots) - 1].set_title(f"{list(shown)[-1]}\n{hottest(run, last)}")
    figure.colorbar(ScalarMappable(norm, palette.TEMPERATURE), ax=panels, label=rise_label(cold), shrink=0.7,
                    extend="min")
    return figure


def opened(run, shot):
    """(positions, radii, K) of rock and tool at and behind the middle plane."""
    radii, z = run.model["rock_radii"], shot["rock_positions"][:, 2]
    slab = (z < 0.5 * radii) & (z > -3 * radii)
    yield shot["rock_positions"][slab], radii[slab], rock_temperature(run, shot)[slab]
    positions, sizes, kelvin = tool_heat(run, shot)
    slab = behind_middle(positions, sizes)
    yield place(shot, positions[slab]), sizes[slab], kelvin[slab]


def warm_spheres(positions, radii, kelvin, norm, cold, view):
    """Polygons of spheres in the colour of their rise."""
    return sphere_polygons(positions, radii, palette.TEMPERATURE(norm(np.maximum(kelvin - cold, norm.vmin))), view)

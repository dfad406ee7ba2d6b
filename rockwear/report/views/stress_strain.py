"""A specimen between platens: stress over strain, and how it failed."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba

from rockwear.report import palette, shapes
from rockwear.report.page import Section
from rockwear.report.plots import MM, canvas, discs, frame, save
from rockwear.report.solid import ABOVE, SIDE, READABLE, behind_middle, paint, panels_without_axes, sphere_polygons

ARROWS = 900
"""Largest number of arrows in the displacement field."""


def stress_strain(run):
    """Section of stress over strain. Not of tests whose stress is uneven: they show forces."""
    if not {"stress", "axial_strain", "lateral_strain", "platen_strain"} <= run.columns.keys() or not run.rows or (
            "force" in run.columns):
        return None
    text = ("Strain is measured in the middle of the specimen; dashed, from the platens' travel. Cracks count all "
            "broken bonds.")
    if "lateral_stress" in run.columns:
        text += (" The stress across is that between upper and lower half of the specimen; what is applied to the "
                 "sides is constant.")
    return Section("Stress and strain", text, [save(run, "stress_strain", curves(run))])


def failure(run):
    """Section of the specimen at the end."""
    if not run.has("rock_prescribed", "rock_radii", "bonds", "displacement", "softening"):
        return None
    if "block" in run.model:
        return Section("Failure", "Left: the specimen from above. Right: the slab behind its middle, from the side. "
                       "The darker a sphere, the more of its bonds are soft or broken; the motion of grey spheres is "
                       "prescribed.", [save(run, "failure", block(run))])
    return Section("Failure", "Left: displacements since the start, less their mean, arrows enlarged, colour their "
                   "size. Right: broken bonds in red, drawn across the bond; the darker a disc, the softer its bonds; "
                   "the motion of grey discs is prescribed.", [save(run, "failure", specimen(run))])


def curves(run):
    """Stress and the number of cracks over strain."""
    stress = 1e-6 * run.column("stress")
    figure, (axes,) = canvas(9, 4.8)
    travel = 100 * run.column("platen_strain")
    axes.plot(100 * run.column("axial_strain"), stress, color=palette.STRESS, label="axial, in the middle")
    axes.plot(travel, stress, color=palette.STRESS_OF_TRAVEL, linestyle="--", linewidth=1,
              label="axial, by the platens")
    axes.plot(100 * run.column("lateral_strain"), stress, color=palette.LATERAL, linewidth=1, label="lateral")
    if "lateral_stress" in run.columns:
        axes.plot(travel, 1e-6 * run.column("lateral_stress"), color=palette.CONFINEMENT, linewidth=1,
                  label="stress across")
    # Past the peak the lateral strain is the opening of cracks and may be any multiple of the axial one.
    widest = travel.max() or 1.0
    axes.set(xlabel="strain / %", ylabel="stress / MPa", xlim=(-0.6 * widest, 1.2 * widest))
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=4)
    other = axes.twinx()
    other.plot(travel, run.column("tensile_cracks") + run.column("shear_cracks"), color=palette.CRACK, linewidth=1)
    other.set_ylabel("cracks", color=palette.CRACK)
    other.tick_params(axis="y", colors=palette.CRACK)
    other.spines["right"].set_visible(True)
    return figure


def specimen(run):
    """Displacement field, and broken bonds."""
    size = MM * run.model["box"]
    limits = (-0.03 * size[0], 1.03 * size[0], -0.03 * size[0], size[1] + 0.03 * size[0])
    figure, (left, right) = canvas(12, 1 + 5.5 * size[1] / size[0], 1, 2)
    shot = run.snapshot(-1)
    arrows = draw_displacements(left, run, shot, 0.06 * size[0])
    figure.colorbar(arrows, ax=left, label="displacement / mm", shrink=0.8)
    frame(left, limits, "displacements")
    frame(right, limits, f"{draw_cracks(right, run, shot)} broken bonds")
    return figure


def block(run):
    """The specimen in space from above, and cut open."""
    figure, panels = panels_without_axes(12, 4.5, 1, 2)
    shot, radii = run.snapshot(-1), run.model["rock_radii"]
    places, colours = shot["rock_positions"], colours_by_softness(run, shot)
    for axes, view, shown in ((panels[0], ABOVE, np.ones(len(radii), bool)),
                              (panels[1], SIDE, behind_middle(places, radii))):
        paint(axes, sphere_polygons(places[shown], radii[shown], colours[shown], view), darkest=READABLE)
    panels[0].set_title(f"{np.count_nonzero(shot['status'])} broken bonds")
    return figure


def draw_displacements(axes, run, shot, longest):
    """Displacements less their mean, the largest drawn `longest` mm long. -> what a colour bar is drawn of"""
    places, moved = shot["rock_positions"], shot["displacement"]
    moved = moved - moved.mean(axis=0)
    length = np.linalg.norm(moved, axis=1)
    show = np.random.default_rng(0).permutation(len(length))[:ARROWS]
    largest = np.percentile(length, 95) or 1.0
    return axes.quiver(*(MM * places[show]).T, *moved[show].T, MM * length[show], cmap=palette.DISPLACEMENT,
                       angles="xy", scale_units="xy", scale=largest / longest, width=0.003, clim=(0, MM * largest))


def draw_cracks(axes, run, shot):
    """Discs by the softness of their bonds, and broken bonds. -> their number"""
    bonds = run.model["bonds"]
    discs(axes, shot["rock_positions"], run.model["rock_radii"], facecolors=colours_by_softness(run, shot))
    broken = bonds[shot["status"] != 0]
    lines = shapes.cracks(shot["rock_positions"], run.model["rock_radii"], broken)
    axes.add_collection(LineCollection(MM * lines, colors=palette.CRACK, linewidths=1))
    return len(broken)


def colours_by_softness(run, shot):
    """(n, 4) colours of the particles, the mean softness of their bonds."""
    bonds, count = run.model["bonds"], len(run.model["rock_radii"])
    softness = np.bincount(bonds.ravel(), np.repeat(shot["softening"], 2), count)
    softness /= np.maximum(np.bincount(bonds.ravel(), minlength=count), 1)
    colours = palette.DAMAGE(np.clip(softness, 0, 1))
    colours[run.model["rock_prescribed"]] = to_rgba(palette.FIXED)
    return colours

"""A Brazilian or toughness test: force over displacement, and the resistance of a growing crack."""
import numpy as np

from rockwear.kernels import fracture
from rockwear.report import palette
from rockwear.report.page import Section
from rockwear.report.plots import MM, canvas, legend, save


def load_displacement(run):
    """Section of force over displacement."""
    if not {"force", "platen_strain"} <= run.columns.keys() or len(run.column("force")) < 2:
        return None
    if "opening" not in run.columns:
        return Section("Force and displacement", "Force between the jaws over their approach. Cracks count all broken "
                       "bonds.", [save(run, "load_displacement", pressed(run))])
    return Section("Force and crack", "Left: force over the opening of the notch at the load line. Right: K of the "
                   "sharp crack that is as compliant as the specimen, over its length with the notch; dashed: the "
                   "fracture toughness.", [save(run, "load_displacement", opened(run))])


def draw_force(run, axes, displacement):
    """Force and the number of cracks over a displacement, m."""
    axes.plot(1e6 * displacement, 1e-3 * run.column("force"), color=palette.STRESS)
    axes.set_ylabel("force / kN/m")
    other = axes.twinx()
    other.plot(1e6 * displacement, run.column("tensile_cracks") + run.column("shear_cracks"), color=palette.CRACK,
               linewidth=1)
    other.set_ylabel("cracks", color=palette.CRACK)
    other.tick_params(axis="y", colors=palette.CRACK)
    other.spines["right"].set_visible(True)


def pressed(run):
    """The Brazilian test."""
    figure, (axes,) = canvas(9, 4.8)
    draw_force(run, axes, run.column("platen_strain") * run.model["box"][0])
    axes.set_xlabel("approach of the jaws / µm")
    return figure


def opened(run):
    """The toughness test."""
    figure, (left, right) = canvas(12, 4.8, 1, 2)
    draw_force(run, left, run.column("opening"))
    left.set_xlabel("opening / µm")
    width, notch = run.parameters["size"], run.parameters["notch"]
    curve = fracture.resistance_curve(force=run.column("force"), opening=run.column("opening"), width=width,
                                      notch=notch)
    right.plot(MM * width * curve["crack"], 1e-6 * curve["intensity"], ".", color=palette.POINTS, markersize=3,
               label="equivalent crack")
    toughness = run.result("fracture_toughness")
    if np.isfinite(toughness):
        right.axhline(1e-6 * toughness, color=palette.GUIDE, linestyle="--", label="sqrt(E G_f)")
    right.set(xlabel="notch and crack / mm", ylabel="K / MPa√m", ylim=(0, None))
    legend(right)
    return figure

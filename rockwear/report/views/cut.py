"""The cut in the plane: rock, cracks and tool at several instants, and as a moving picture."""
import numpy as np
from matplotlib.animation import PillowWriter

from rockwear.report import palette
from rockwear.report.bodies import in_plane, words_on_rock
from rockwear.report.instants import course, moment, spread, turns
from rockwear.report.page import Section, image
from rockwear.report.plane import CutPicture, cut_limits
from rockwear.report.plots import canvas, frame, grid, save

MOST_FRAMES = 40


def cut(run):
    """Section of the cut."""
    if not in_plane(run):
        return None
    name, title = (("failure", "Failure of the rock in the first cut, as in [Rojek 2014, fig. 12]") if turns(run) else
                   ("cut", "The cut"))
    limits = cut_limits(run)
    return Section(title, "Red: broken bonds, drawn across the bond where its discs are still near each other. "
                   + words_on_rock(run), [save(run, name, figure(run, limits)), moving_picture(run, limits)])


def figure(run, limits):
    """The cut at several instants."""
    shown = course(run)
    if not shown:
        return None
    drawn, panels = grid(len(shown), 12, (limits[3] - limits[2]) / (limits[1] - limits[0]))
    for axes, (label, k) in zip(panels, shown.items()):
        CutPicture(run, axes, run.snapshot(k), linewidths=0.2, edgecolors=palette.ROCK_EDGE)
        frame(axes, limits, label)
    return drawn


def moving_picture(run, limits):
    """The cut as an animated GIF, of the cuts alone where the tool cools between them. -> html"""
    shown = spread(np.flatnonzero(run.stages % 2 == 1) if turns(run) else range(len(run.times)), MOST_FRAMES)
    if len(shown) < 2:
        return ""
    drawn, (axes,) = canvas(7.2, 0.7 + 6.4 * (limits[3] - limits[2]) / (limits[1] - limits[0]))
    picture = CutPicture(run, axes, run.snapshot(shown[0]), linewidths=0, antialiaseds=False)
    path = run.path / "figures" / "cut.gif"
    writer = PillowWriter(fps=6)
    with writer.saving(drawn, path, dpi=80):
        for k in shown:
            picture.show(run.snapshot(k))
            frame(axes, limits, moment(run, k))
            writer.grab_frame()
    return image(path)

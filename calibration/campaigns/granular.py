"""Granular flow [Rojek 2003, ch. 14]: the angle of repose over friction and rolling resistance, and sand that flows
into a tube over amplitude and frequency.

    python3 -m calibration.campaigns.granular DIR [--jobs N | --scheduler ADDRESS]

Runs that finished are kept. Writes granular.md, granular.png and provenance.json into DIR.
"""
import sys

import numpy as np

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, wait_for
from rockwear.report import palette, plots

HEAP, TUBE = "yade_scripts/angle_of_repose.py", "yade_scripts/vibrated_tube.py"
FRICTIONS, ROLLING = (0.1, 0.3, 0.5, 0.8), (0.0, 0.1, 0.3)
SIZE = dict(particles=1500, report="false")
MIDDLE = dict(friction=0.5, rolling_resistance=0.1)
CHECKS = {
    "seed 2": dict(seed=2), "twice as many grains": dict(particles=3000),
    "rolling resistance 0.02": dict(rolling_resistance=0.02), "no friction on walls": dict(wall_friction=0.0)}
"""{what differs from the middle point: values}."""
VIBRATIONS = (0.0, 50.0), (1e-4, 30.0), (2e-4, 30.0), (4e-4, 30.0), (1e-4, 60.0)
"""(amplitude, m; frequency, Hz); the last two have the same peak acceleration."""
SAND = dict(vibrating=0.5, report="false")


def heap_values():
    """{key: values} of all heaps; keys: (friction, rolling resistance), or what is checked."""
    found = {(mu, eta): {**SIZE, "friction": mu, "rolling_resistance": eta} for eta in ROLLING for mu in FRICTIONS}
    return {**found, **{name: {**SIZE, **MIDDLE, **change} for name, change in CHECKS.items()}}


def tube_values():
    """{(amplitude, frequency): values} of all tubes, without vibration first."""
    return {(a, f): {**SAND, "amplitude": a, "frequency": f} for a, f in VIBRATIONS}


def folder_of(key):
    """Name of a run's folder."""
    words = key if isinstance(key, str) else "_".join(f"{value:g}" for value in key)
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in words)


def angle_of(run):
    """The angle with its error, as text."""
    return f"{run.result('angle_of_repose'):.1f} ± {run.result('angle_of_repose_standard_error'):.1f}"


def zhou_of(run):
    """The angle of the relation, as text; it has none without rolling resistance or friction on walls."""
    return f"{run.result('angle_zhou_2002'):.1f}" if run.result("angle_zhou_2002") > 0 else "-"


def heap_words(key, run):
    """A line on a finished heap."""
    return f"{folder_of(key)}: {angle_of(run)} deg"


def tube_words(key, run):
    """A line on a finished tube."""
    return f"{folder_of(key)}: {1e3 * run.result('tube_mass'):.3g} g"


def heap_lines(runs):
    """Tables of the heaps, as lines of Markdown."""
    rows = [[f"{eta:g}", *(angle_of(runs[mu, eta]) for mu in FRICTIONS)] for eta in ROLLING]
    lines = ["## Angle of repose, degrees, over friction and rolling resistance", "",
             *generated.table(["rolling resistance", *(f"friction {mu:g}" for mu in FRICTIONS)], rows)]
    lines += ["The relation of Zhou, Xu, Yu and Zulli (2002) for the same numbers; it was made for rolling resistances "
              f"up to about {zhou_reach(runs):.2f} in this measure.", ""]
    rows = [[f"{eta:g}", *(f"{runs[mu, eta].result('angle_zhou_2002'):.1f}" for mu in FRICTIONS)]
            for eta in ROLLING if eta > 0]
    lines += generated.table(["rolling resistance", *(f"friction {mu:g}" for mu in FRICTIONS)], rows)
    lines += ["## Checks at friction 0.5 and rolling resistance 0.1", ""]
    keys = [(MIDDLE["friction"], MIDDLE["rolling_resistance"]), *CHECKS]
    rows = [[key if isinstance(key, str) else "the point itself", angle_of(runs[key]),
             zhou_of(runs[key]), f"{1e3 * runs[key].result('heap_height'):.0f}",
             runs[key].result("grains_left"), f"{runs[key].result('kinetic_over_fall_energy'):.1g}",
             f"{runs[key].summary['wall_time']['total']:.0f}"] for key in keys]
    return lines + generated.table(["run", "angle, deg", "Zhou and others", "height, mm", "grains left",
                                    "kinetic energy over a fall's", "wall time, s"], rows)


def zhou_reach(runs):
    """The rolling resistance that is 0.1 mm with these grains."""
    run = next(iter(runs.values()))
    return 1e-4 / (0.5 * (run.parameter("radius_min") + run.parameter("radius_max")))


def tube_lines(runs):
    """Table of the tubes, as lines of Markdown."""
    rows = [[f"{1e3 * a:g}", f"{f:g}" if a else "-", f"{run.result('peak_acceleration'):.2f}",
             f"{1e3 * run.result('tube_mass_by_gravity'):.2f}", f"{1e3 * run.result('tube_mass'):.2f}",
             f"{100 * run.result('tube_fill'):.0f}", f"{1e3 * run.result('inflow_rate'):.2f}",
             f"{run.summary['wall_time']['total']:.0f}"] for (a, f), run in runs.items()]
    return ["## Sand in the tube after half a second of vibration", "", *generated.table(
        ["amplitude, mm", "frequency, Hz", "peak acceleration, g", "by gravity, g", "at the end, g", "of the tube, %",
         "inflow, g/s", "wall time, s"], rows)]


def draw(heaps, tubes):
    """Angle over friction, and mass over time."""
    figure, (left, right) = plots.canvas(12, 4.6, 1, 2)
    for eta, colour in zip(ROLLING, palette.OTHER_LINES):
        runs = [heaps[mu, eta] for mu in FRICTIONS]
        left.errorbar(FRICTIONS, [run.result("angle_of_repose") for run in runs], color=colour, marker="o", capsize=3,
                      yerr=[run.result("angle_of_repose_standard_error") for run in runs],
                      label=f"rolling resistance {eta:g}")
        if eta > 0:
            left.plot(FRICTIONS, [run.result("angle_zhou_2002") for run in runs], color=colour, linestyle=":")
    friction = np.linspace(0, max(FRICTIONS), 50)
    left.plot(friction, np.degrees(np.arctan(friction)), color=palette.GUIDE, linewidth=1, label="friction angle")
    left.set(xlabel="friction", ylabel="angle of repose / deg", xlim=(0, 0.85), ylim=(0, None),
             title="dotted: the relation of Zhou and others (2002)")
    left.legend(loc="lower right", fontsize=9)
    for ((a, f), run), colour in zip(tubes.items(), palette.OTHER_LINES):
        right.plot(run.column("time"), 1e3 * run.column("tube_mass"), color=colour,
                   label=f"{1e3 * a:g} mm, {f:g} Hz: {run.result('peak_acceleration'):.1f} g" if a else "no vibration")
    right.set(xlabel="time / s", ylabel="sand in the tube / g", xlim=(0, None), ylim=(0, None),
              title="vibration begins at 0.25 s")
    right.legend(fontsize=9)
    return figure


def main(folder, **where):
    """Run what is not there yet, and write the page. -> exit code."""
    folder.mkdir(parents=True, exist_ok=True)
    with Runs(folder, keep=True, **where) as runs:
        heaps = {key: runs.start(f"heap_{folder_of(key)}", HEAP, **values) for key, values in heap_values().items()}
        tubes = {key: runs.start(f"tube_{folder_of(key)}", TUBE, **values) for key, values in tube_values().items()}
        if wait_for(heaps, heap_words) | wait_for(tubes, tube_words):
            return 1
    heaps, tubes = ({key: job.result() for key, job in jobs.items()} for jobs in (heaps, tubes))
    draw(heaps, tubes).savefig(folder / "granular.png", dpi=110)
    generated.record(folder / "granular.png")
    print(generated.write_page(folder / "granular.md", heap_lines(heaps) + tube_lines(tubes)))
    return 0


if __name__ == "__main__":
    place, _, where = command_line(__spec__.name, flags=())
    sys.exit(main(place, **where))

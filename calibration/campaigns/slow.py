"""Cuts that [Rojek 2003, ch. 8, 10] makes at 0.04 m/s: what the speed of the mechanics changes, down to the source's.

    python3 -m calibration.campaigns.slow DIR [SCENE ...] [--full] [--read] [--jobs N | --scheduler ADDRESS]

The same ways of the same packings at several speeds: the whole 40 mm, and the first 4 mm, in which the chip breaks off,
down to the source's speed (a million steps a run, twenty minutes). --full adds the whole way at the slowest speeds
(nine million steps a run, hours). N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run;
finished runs are not repeated, so that an interrupted campaign resumes. --read starts no run and evaluates those that
exist. Writes into DIR slow.md (a table a scene and way), slow.png and provenance.json.
"""
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from rockwear.report import palette, plots

WHOLE, BEGIN = 0.04, 0.004
"""m: the way of the source, and its begin."""
SOURCE = 0.04
"""m/s."""
SPEEDS = 8.0, 4.0, 2.0, 1.0
SLOWEST = 0.4, SOURCE
"""m/s of the mechanics."""
ROW = 4e-5
"""m of way between rows of the record, whose forces are means over it: peaks are of as long a way at every speed."""
SEEDS = 1, 2, 3
COMMON = dict(grading_factor=3, report="false", snapshot_period=1)


def _as_fast(speed, way):
    """A cut whose tool is so fast."""
    return dict(velocity=speed, start_up=way / speed, record_period=ROW / speed)


def _scaled(speed, way):
    """A cut whose heat has the time of the source's speed, and whose mechanics are so fast."""
    return dict(time_scale=speed / SOURCE, start_up=way / SOURCE, record_period=ROW / SOURCE)


SCENES = {"segments, 8.1": ("yade_scripts/cutting_segments.py", _as_fast),
          "particles, 8.2": ("yade_scripts/cutting_particles.py", _as_fast),
          "heat, 10.1": ("yade_scripts/cutting_thermal.py", _scaled)}
"""{scene: (script, parameters of a speed and a way)}."""
QUANTITIES = {"mean force, kN/m": lambda run: 1e-3 * run.result("mean_cutting_force"),
              "peak force, kN/m": lambda run: 1e-3 * run.result("peak_cutting_force"),
              "mean thrust, kN/m": lambda run: 1e-3 * run.result("mean_thrust_force"),
              "friction at the tool, J/m": lambda run: run.summary["balances"]["energy"]["tool_friction"],
              "cracks": lambda run: run.result("tensile_cracks") + run.result("shear_cracks")}
"""{heading: number of a run}. Wear is the friction at the tool times a constant."""
DRAWN = {WHOLE: ("mean force, kN/m", "friction at the tool, J/m"), BEGIN: ("mean force, kN/m", "cracks")}


def plan(scenes, full=False):
    """{(scene, way, speed, seed): (folder, script, parameters)}, the short and the fast ones first."""
    ways = [(speed, way) for way in (BEGIN, WHOLE) for speed in (*SPEEDS, *SLOWEST)
            if full or way == BEGIN or speed in SPEEDS]
    return {(scene, way, speed, seed): (f"{scene.split(',')[0]}-{1e3 * way:g}mm-{speed:g}-{seed}", script,
                                        dict(COMMON, **at(speed, way), seed=seed))
            for speed, way in ways for seed in SEEDS for scene, (script, at) in SCENES.items() if scene in scenes}


def measured(folder, runs):
    """{(scene, way): {speed: {seed: {heading: number}}}} of the runs of a plan that exist."""
    found = {}
    for (scene, way, speed, seed), run in existing({key: folder / name for key, (name, *_) in runs.items()}).items():
        found.setdefault((scene, way), {}).setdefault(speed, {})[seed] = {
            heading: float(number(run)) for heading, number in QUANTITIES.items()}
    return found


def rows(found):
    """Rows of a table of {speed: packings}: means at each speed, and what differs significantly in the same packings
    from the slowest."""
    slowest = found[min(found)]
    for speed in sorted(found, reverse=True):
        packings = found[speed]
        common = packings.keys() & slowest.keys()
        changes = {heading: [packings[seed][heading] - slowest[seed][heading] for seed in common]
                   for heading in QUANTITIES}
        differs = [heading.split(",")[0] for heading, of in changes.items()
                   if generated.significant(*generated.mean_and_error(of), len(common))]
        yield [f"{speed:g}", len(packings), *(generated.mean_cell([one[heading] for one in packings.values()])
                                              for heading in QUANTITIES), ", ".join(differs) or "–"]


def figure(found):
    """DRAWN over the speed, a panel each, a row a way; error bars are standard errors over packings."""
    ways = {way: headings for way, headings in DRAWN.items() if any(one == way for _, one in found)}
    drawn, panels = plots.canvas(10, 3.6 * len(ways), len(ways), 2)
    pairs = [(way, heading) for way, headings in ways.items() for heading in headings]
    for axes, (way, heading) in zip(panels, pairs):
        of_way = {scene: found[scene, way] for scene in SCENES if (scene, way) in found}
        for scene, colour in zip(SCENES, palette.OTHER_LINES):
            if scene in of_way:
                speeds = sorted(of_way[scene])
                values, errors = np.array([generated.mean_and_error(
                    [one[heading] for one in of_way[scene][speed].values()]) for speed in speeds]).T
                axes.errorbar(speeds, values, errors, fmt="o-", color=colour, capsize=3, label=scene)
        axes.set(xscale="log", xlabel="speed of the mechanics / m/s", ylabel=heading.replace(", ", " / "),
                 title=f"first {1e3 * way:g} mm" if way == BEGIN else f"whole way, {1e3 * way:g} mm")
        present = sorted({speed for speeds in of_way.values() for speed in speeds})
        axes.set_xticks(present, [f"{speed:g}" for speed in present])
        axes.minorticks_off()
        axes.set_ylim(bottom=0)
    max(panels, key=lambda axes: len(axes.containers)).legend()
    return drawn


def write(folder, runs):
    """Table and figure of the runs that exist. -> the table, in Markdown."""
    found = measured(folder, runs)
    lines = ["Mean ± standard error over packings. Differs: from the slowest in the same packings, by more than chance "
             f"makes once in {1 / generated.CHANCE:g} cases (Student's t). Peaks: of means over {1e3 * ROW:g} mm.", ""]
    for scene in SCENES:
        for way in (WHOLE, BEGIN):
            if (scene, way) in found:
                lines += [f"## {scene}: {1e3 * way:g} mm", "", *generated.table(
                    ["m/s", "packings", *QUANTITIES, "differs"], rows(found[scene, way]))]
    with matplotlib.rc_context(plots.STYLE):
        figure(found).savefig(folder / "slow.png")
    generated.record(folder / "slow.png")
    return generated.write_page(folder / "slow.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    scenes = [word for word in words if word in SCENES] or list(SCENES)
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(name, script, **values)
                    for key, (name, script, values) in plan(scenes, "--full" in words).items()}
            failed = wait_for(jobs, lambda key, run: "{}: {:g} m, {:g} m/s, packing {}".format(*key))
    print(write(folder, plan(SCENES, full=True)))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, SCENES, flags=("--full", "--read"))
    sys.exit(main(place, words, **where))

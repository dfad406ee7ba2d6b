"""Sensitivity of the tip's temperature: parameters that the publications leave open, one at a time, in one figure.

    python3 -m calibration.campaigns.tip_temperature DIR [--quick] [--jobs N | --scheduler ADDRESS]

Particle size at the tool's surface; conductance between particles, from tool to rock, and to air or water; sharing of
friction heat; loading speed. Each goes from its low to its high choice, beside the scatter over packings. --quick takes
rock discs twice as large (a tenth of the time, and fewer contacts at the tip). Writes a figure, tip_temperature.md,
a JSON file for each scene and provenance.json into DIR.

SCENES lists for each scene its script, its values, and the temperatures (K) among its results.
"""
import json

import numpy as np

from calibration import generated
from calibration.campaigns.runs import Runs, as_they_end, command_line
from rockwear.report import plots

RIPPER = dict(velocities=0.4, wear_passes=0, report="false", snapshot_period=1, grading_factor=3)
QUICK = dict(radius_min=2e-3, radius_max=3e-3, Rn=0.2e6, Rt=2e6)
"""Twice the discs at the same macroscopic strength."""
SCENES = {"ripper at 0.4 m/s": ("yade_scripts/ripper_temperature.py", RIPPER, {
    "after a pass": "hottest_after_the_pass_0.4", "quasi-stationary, shank held": "hottest_fixed_shank_0.4",
    "quasi-stationary, shank insulated": "hottest_insulated_shank_0.4"})}


def size(radius):
    """Tool discs of this radius (m), within a fifth."""
    return dict(tool_radius_min=0.8 * radius, tool_radius_max=1.2 * radius)


def loading(factor):
    """The mechanics `factor` times as fast, over the same distance."""
    return dict(velocity=4.0 * factor, start_up=1e-4 / factor, cycle_time=0.005 / factor, heat_period=1e-4 / factor,
                record_period=2e-5 / factor)


OPEN = {
    "packing (scatter)": {"seed 1": {}, "seed 2": dict(seed=2), "seed 3": dict(seed=3)},
    "tool discs at the surface": {"0.35 mm": size(0.35e-3), "0.5 mm": {}, "0.8 mm": size(0.8e-3)},
    "conductance between particles": {"voronoi": {}, **{name: dict(bond_conductance=name)
                                                        for name in ("bar", "half_bar")}},
    "conductance tool to rock": {"150 W/m²K": dict(contact_conductance=150), "1500 W/m²K": {},
                                 "15000 W/m²K": dict(contact_conductance=15000)},
    "air or water": {"air, 30": {}, **{f"water, {h}": dict(convection=h) for h in (5000, 25000)}},
    "sharing of friction heat": {"equal": {}, "effusivity": dict(heat_sharing="effusivity")},
    "loading speed": {"8 m/s": loading(2), "4 m/s": {}, "1 m/s": loading(0.25)},
}
"""{parameter: {choice: values}}; a choice without values is the scene's default, which runs once."""


def measure(folder, scene, quick=False, **where):
    """{parameter: {choice: {temperature: rise in K}}} of a scene; finished runs are kept. where: options of Runs."""
    script, values, temperatures = SCENES[scene]
    values = {**values, **(QUICK if quick else {})}
    with Runs(folder, keep=True, **where) as runs:
        default = runs.start("default", script, **values)
        jobs = {(what, choice): runs.start(f"{what}-{choice}".translate(str.maketrans(" /,²()", "______")), script,
                                           **{**values, **change}) if change else default
                for what, choices in OPEN.items() for choice, change in choices.items()}
        ended = {one: one.result() for one in as_they_end(jobs.values())}
        found = {key: ended[job] for key, job in jobs.items()}

    def rise(run, result):
        return run.result(result) - run.parameter("tool_temperature", 0.0)

    return {what: {choice: {name: rise(found[what, choice], result) for name, result in temperatures.items()}
                   for choice in choices} for what, choices in OPEN.items()}


def merged(rises):
    """[(K, names)] of {name: K} in rising order; values within an eighth of each other share a label."""
    found = []
    for name, rise in sorted(rises.items(), key=lambda entry: entry[1]):
        if found and rise < 1.125 * found[-1][0]:
            found[-1][1].append(name)
        else:
            found.append((rise, [name]))
    return found


def draw(scene, measured):
    """A panel for each temperature: a bar from the lowest to the highest rise, a mark for each choice."""
    names = list(next(iter(next(iter(measured.values())).values())))
    figure, panels = plots.canvas(5 * len(names), 0.8 + 0.75 * len(measured), 1, len(names), sharey=True)
    for axes, name in zip(panels, names):
        for row, (what, choices) in enumerate(measured.items()):
            rises = np.array([choice[name] for choice in choices.values()])
            colour = "0.55" if "scatter" in what else "#b5541c"
            axes.barh(row, np.ptp(rises), left=rises.min(), height=0.25, color=colour, alpha=0.5)
            axes.plot(rises, np.full(len(rises), row), "|", color=colour, markersize=14, markeredgewidth=2)
            for k, (rise, names_of_it) in enumerate(merged(dict(zip(choices, rises)))):
                axes.text(rise, row + (0.2 if k % 2 else -0.2), ", ".join(names_of_it), ha="center", fontsize=7,
                          va="top" if k % 2 else "bottom")
        every = [choice[name] for choices in measured.values() for choice in choices.values()]
        axes.set(xscale="log", xlabel="rise of the hottest particle / K", title=name,
                 xlim=(min(every) / 1.5, max(every) * 1.5))
    panels[0].set_yticks(range(len(measured)), list(measured))
    panels[0].set_ylim(len(measured) - 0.4, -0.6)
    figure.suptitle(f"{scene}: sensitivity of the tip's temperature")
    return figure


def table(scene, measured):
    """Rises in K, as lines of Markdown."""
    names = SCENES[scene][2]
    return [f"## {scene}: rise of the hottest particle, K", "", *generated.table(
        ["parameter", "choice", *names],
        [[what, choice, *(f"{rises[name]:.3g}" for name in names)] for what, choices in measured.items()
         for choice, rises in choices.items()])]


def main(folder, quick, **where):
    """Measure every scene; write a figure and the numbers of each."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for scene in SCENES:
        place = folder / scene.replace(" ", "_").replace("/", "_")
        measured = measure(place, scene, quick, **where)
        files = folder / f"{place.name}.json", folder / f"{place.name}.png"
        files[0].write_text(json.dumps(measured, indent=1), encoding="utf-8")
        draw(scene, measured).savefig(files[1], dpi=110)
        generated.record(*files)
        lines += table(scene, measured)
    print(generated.write_page(folder / "tip_temperature.md", lines))


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, flags=("--quick",))
    main(place, "--quick" in words, **where)

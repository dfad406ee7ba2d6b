"""Dredging at the sources' own discs, in a window along the arc: three turns, and the errors of window and scaling.

    python3 -m calibration.campaigns.dredging DIR [turns] [first] [whole] [--read] [--jobs N | --scheduler ADDRESS]

`turns`: three turns of [Rojek 2014, 5] and of the models of [Rojek 2003, 12], discs of 1 to 1.5 mm (about an hour
each). `first`: the first part of the arc, in a window and in one so long that nothing enters that the pick could feel
or meet, at other rates of the mechanics, steps and sizes of discs. `whole`: a whole cut in coarse discs, at other
rates of the mechanics and in other windows. Without any of these words: all. N runs at a time (2), or as many as a
dask scheduler's workers take; a folder a run; finished runs are not repeated, so that an interrupted campaign resumes.
--read starts no run and evaluates those that exist. Writes into DIR dredging.md, dredging.png and provenance.json.
"""
import math
import sys

import matplotlib
import numpy as np
from scipy.integrate import trapezoid

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from rockwear.kernels.analytic import diffusivity, half_space_under_flux
from rockwear.kernels.conduction import HOTTEST
from rockwear.report import palette, plots

SCRIPT, PARTS = "yade_scripts/dredge_pick.py", ("turns", "first", "whole")
WINDOW = dict(scale_factor=1, window_behind=0.06, window_ahead=0.14, time_step_fraction=0.95)
FAST = dict(WINDOW, backing=0.04, time_scale=10)
"""Three turns within the hour. What its window and the faster mechanics change is part of `whole`."""
ROCK_2003 = dict(kt=20e9, Rt=1e6, mu=0.839, hardness_table="MET91", wear_coefficient=0.01128)
WORN_2003 = dict(ROCK_2003, wear_acceleration=7000, hardness_temperature=293)
TURNS = {
    "P": ("[Rojek 2014, 5]", {}, (1, 2)),
    "M-I": ("[Rojek 2003, 12.1.2], I unworn", dict(ROCK_2003, wear_acceleration=0), (1,)),
    "M-I-worn": ("[Rojek 2003, 12.1.3], I", WORN_2003, (1, 2)),
    "M-II": ("[Rojek 2003, 12.2], II", dict(WORN_2003, tool_radius_min=0.7e-3, tool_radius_max=0.7e-3,
                                            tooth_height=0.1386, tooth_width=0.1386), (1,))}
"""{name: (what it is, parameters, seeds)} of the sources' three turns."""
LONG, COARSE = dict(window_behind=0.12, window_ahead=0.3, backing=0.12), dict(scale_factor=4)
REFERENCE, COARSE_WINDOW, COARSE_REFERENCE = (
    "long window", "discs 4 times as coarse", "discs 4 times as coarse, long window")
FIRST = {
    REFERENCE: (LONG, 5, None),
    "window": ({}, 5, REFERENCE),
    "mechanics 2.5 times as fast as the process, not 5": (dict(time_scale=2.5), 5, REFERENCE),
    "10 times": (dict(time_scale=10), 5, REFERENCE),
    "step 0.5 of the critical one, not 0.95": (dict(time_step_fraction=0.5), 5, REFERENCE),
    COARSE_WINDOW: (COARSE, 40, COARSE_REFERENCE),
    COARSE_REFERENCE: ({**LONG, **COARSE}, 40, REFERENCE),
    "coarse, mechanics 2.5 times as fast": (dict(COARSE, time_scale=2.5), 40, COARSE_WINDOW),
    "coarse, 10 times": (dict(COARSE, time_scale=10), 40, COARSE_WINDOW),
    "coarse, backing of 40 mm, not 60": (dict(COARSE, backing=0.04), 40, COARSE_WINDOW),
    "coarse, step 0.5 of the critical one": (dict(COARSE, time_step_fraction=0.5), 40, COARSE_WINDOW)}
"""{case: (what differs, packings, the case beside which it stands)} of the first part of the arc, with the rock and the
pick of [Rojek 2014]."""
SLIM = dict(COARSE, backing=FAST["backing"])
WHOLE_CUT = "whole cut, discs 4 times as coarse"
WHOLE = {
    WHOLE_CUT: (SLIM, 32, None),
    "whole cut, 10 times": (dict(SLIM, time_scale=10), 32, WHOLE_CUT),
    "whole cut, mechanics 2.5 times as fast": (dict(SLIM, time_scale=2.5), 32, WHOLE_CUT),
    "whole cut, mechanics as fast as the process": (dict(SLIM, time_scale=1), 32, WHOLE_CUT),
    "whole cut, long window": ({**SLIM, **LONG}, 32, WHOLE_CUT),
    "whole cut, backing of 120 mm, not 40": (dict(SLIM, backing=0.12), 32, WHOLE_CUT),
    "whole cut, 0.12 m behind the pick, not 0.06": (dict(SLIM, window_behind=0.12), 32, WHOLE_CUT),
    "whole cut, 0.12 m behind, backing of 60 mm: the default": (dict(COARSE, window_behind=0.12), 32, WHOLE_CUT)}
"""The same of a whole cut."""
COMPARED = {"first": (FIRST, 0.05), "whole": (WHOLE, 0.65)}
"""{part: (cases, s of cutting)}: at first a way of 57 mm, into chips of 25 to 30 mm."""
QUIET = dict(report="false", snapshot_period=1)
MEASURED = {
    "mean force, kN/m": lambda run: 1e-3 * run.result("mean_cutting_force"),
    "mean thrust, kN/m": lambda run: 1e-3 * run.result("mean_thrust_force"),
    "friction at the pick, J/m": lambda run: run.summary["balances"]["energy"]["tool_friction"],
    "heat, J/m": lambda run: run.summary["balances"]["heat"]["generated"],
    "worn, mm²": lambda run: 1e6 * run.result("worn_volume"),
    "hottest 1 %, K above the water": lambda run: run.result("peak_temperature_hot_1") - run.parameter(
        "ambient_temperature")}
"""{heading: number of a run}."""


def plan(words):
    """{(name, seed): (folder, parameters)} of the runs that these words ask for."""
    found = {}
    if "turns" in words:
        for name, (_, values, seeds) in TURNS.items():
            found.update({(name, seed): (f"source-{name}-{seed}", dict(FAST, **values, seed=seed))
                          for seed in seeds})
    for part, (compared, time) in COMPARED.items():
        if part not in words:
            continue
        cases = [(number, case, seed) for number, (case, (_, packings, _)) in enumerate(compared.items())
                 for seed in range(1, 1 + packings)]
        # As large a part of each case as of the others is there at any time.
        cases.sort(key=lambda one: one[2] / compared[one[1]][1])
        found.update({(case, seed): (f"{part}-{number}-{seed}", dict(
            {**WINDOW, **QUIET, **compared[case][0]}, cut_time=time, cycles=1, seed=seed))
            for number, case, seed in cases})
    return found


def case_tables(found, compared):
    """Lines: each of the cases `compared`, and over that beside which it stands."""
    cases = {case: [run for (one, _), run in found.items() if one == case] for case in compared}
    numbers = {case: {heading: list(map(number, runs)) for heading, number in MEASURED.items()}
               for case, runs in cases.items() if runs}
    lines = generated.table(["case", "packings", *MEASURED], (
        [case, len(next(iter(of.values()))), *map(generated.mean_cell, of.values())] for case, of in numbers.items()))
    return lines + ["Over another case:", "", *generated.table(["case", "over", *MEASURED], (
        [case, beside, *(ratio_cell(of[heading], numbers[beside][heading]) for heading in MEASURED)]
        for case, of in numbers.items() if (beside := compared[case][2]) in numbers))]


def ratio_cell(values, reference):
    """A table's cell: mean over mean of two independent samples, with its standard error."""
    (mean, error), (of, its) = map(generated.mean_and_error, (values, reference))
    ratio = mean / of
    spread = abs(ratio) * math.hypot(error / mean, its / of)
    return f"{ratio:.2f}" + (f" ± {spread:.2f}" if math.isfinite(spread) else "")


def by_hand(run, heat):
    """K by which the hottest 1 % of a pick would rise as a half-space under the heat (J/m) that it takes up in a cut.

    The heat comes evenly over the cut and over the length of contact, (sum d)^2 / sum d^2 particles for worn depths d.
    """
    worn = run.snapshot(-1)["worn_depth"]
    if not worn.any():
        return math.nan
    time, material = run.parameter("cut_time"), {name: run.parameter(f"tool_{name}") for name in (
        "conductivity", "density", "specific_heat")}
    length = float(worn.sum()**2 / (worn**2).sum() * 2 * run.model["tool_radii"].mean())
    depth = HOTTEST * float(run.model["tool_volumes"].sum()) / length
    x = np.linspace(0.0, min(depth, 8 * math.sqrt(diffusivity(**material) * time)), 1000)
    rise = half_space_under_flux(x, time, flux=heat / (length * time), **material)
    return float(trapezoid(rise, x)) / depth


def turn_rows(run):
    """Rows of a run's turns: forces, friction, heat of the pick, temperatures ours and by hand, mass lost."""
    stage, columns = run.column("stage"), {name: run.column(name) for name in (
        "cutting_force", "thrust_force", "tool_friction", "pick_friction_heat", "tool_temperature_hot",
        "tool_temperature_max", "mass_lost")}
    water = run.parameter("ambient_temperature")
    before = dict(tool_friction=0.0, pick_friction_heat=0.0)
    for turn in range(1, int(run.parameter("cycles")) + 1):
        cut = {name: column[stage == 2 * turn - 1] for name, column in columns.items()}
        made = {name: cut[name][-1] - past for name, past in before.items()}
        before = {name: cut[name][-1] for name in before}
        rise = by_hand(run, made["pick_friction_heat"])
        yield [turn, *(f"{1e-3 * cut[name].mean():.3g}" for name in ("cutting_force", "thrust_force")),
               f"{1e-3 * made['tool_friction']:.3g}", f"{1e-3 * made['pick_friction_heat']:.3g}",
               f"{cut['tool_temperature_hot'].max() - water:.3g}", "–" if math.isnan(rise) else f"{rise:.3g}",
               f"{cut['tool_temperature_max'].max() - water:.3g}", f"{100 * cut['mass_lost'].max():.3g}"]


def turn_tables(found):
    """Lines: each of the sources' runs, turn by turn."""
    lines = []
    for (name, seed), run in found.items():
        if name not in TURNS:
            continue
        energy, wall = run.summary["balances"]["energy"], run.summary["wall_time"]["total"]
        lines += [f"### {TURNS[name][0]}, packing {seed}", "", *generated.table(
            ["turn", "mean force, kN/m", "mean thrust, kN/m", "friction at the pick, kJ/m", "into the pick, kJ/m",
             "hottest 1 %, K above the water", "by hand", "hottest particle", "mass lost, %"], turn_rows(run)),
            f"{run.result('rock_particles')} rock particles at a time; specific energy "
            f"{1e-6 * run.result('specific_energy'):.3g} MJ/m³; energy misses "
            f"{100 * abs(energy['residual']) / energy['tool_work']:.2g} % of the tool's work; {wall / 60:.0f} min of "
            "wall time.", ""]
    return lines


def figure(found):
    """Temperature of the hottest part, and mass lost, over the time of the sources' turns."""
    drawn, panels = plots.canvas(10, 4, 1, 2)
    shown = [(TURNS[name][0], run) for (name, _), run in found.items() if name in TURNS]
    for (label, run), colour in zip(shown, palette.OTHER_LINES):
        time = run.column("working_time")
        panels[0].plot(time, run.column("tool_temperature_hot") - run.parameter("ambient_temperature"), color=colour,
                       label=label)
        panels[1].plot(time, 100 * run.column("mass_lost"), color=colour)
    panels[0].set(xlabel="time / s", ylabel="hottest 1 % above the water / K", ylim=(0, None))
    panels[1].set(xlabel="time / s", ylabel="mass lost / %", ylim=(0, None))
    panels[0].legend()
    return drawn


def write(folder):
    """Tables and figure of the runs that exist. -> the tables, in Markdown."""
    found = existing({key: folder / name for key, (name, _) in plan(PARTS).items()})
    lines = ["Mean ± standard error over packings."]
    if any(name in TURNS for name, _ in found):
        lines += ["", "## Three turns", "", *turn_tables(found)]
        with matplotlib.rc_context(plots.STYLE):
            figure(found).savefig(folder / "dredging.png")
        generated.record(folder / "dredging.png")
    for compared, time in COMPARED.values():
        if any(name in compared for name, _ in found):
            lines += ["", f"## The first {time:g} s", "", *case_tables(found, compared)]
    return generated.write_page(folder / "dredging.md", lines, [run.path for run in found.values()])


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed, parts = 0, [word for word in words if word in PARTS] or PARTS
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(name, SCRIPT, **values) for key, (name, values) in plan(parts).items()}
            failed = wait_for(jobs, lambda key, run: "{}, packing {}".format(*key))
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, PARTS)
    sys.exit(main(place, words, **where))

"""A groove in space: what a tool's sides add to the cut of a slice.

    python3 -m calibration.campaigns.groove DIR [RADIUS ...] [--read] [--jobs N | --scheduler ADDRESS]

Tools of the breadths BREADTHS cut `crushing_sandstone` in space, of spheres of the radii RADII (mm), and a rock of
grains (GRAINY) to the same depth. The mean force grows as that of a slice times the breadth, and what is left at no
breadth is cut at the tool's two sides. Other tools of 13 mm, and rocks less tough, stand beside that one. The rocks are
tested in the laboratory, too. N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run;
finished runs are not repeated, so that an interrupted campaign resumes. --read starts no run and evaluates those that
exist. Writes into DIR groove.md, groove.png and provenance.json.
"""
import itertools
import math
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from calibration.campaigns.steady_cut_numbers import difference, of_forces, over_packings, scaled, shown
from calibration.fitting import in_space
from rockwear.kernels import steady_record
from rockwear.kernels.fragments import pieces
from rockwear.report import palette, plots
from rockwear.report.folder import RunFolder

SCRIPT = "yade_scripts/cutting_3d_triangles.py"
BREADTHS = {"6.5": 6.5e-3, "13": 13e-3, "26": 26e-3}
"""{mm: m}. A laboratory's chisel is 13 mm wide."""
RADII = {"0.45": 4.5e-4, "0.6": 6e-4, "0.9": 9e-4}
"""{mm: m}: 5.6 spheres in the depth of cut, four, and three."""
SEEDS = 1, 2, 3
BESIDE = 0.01
"""m of rock at either side of the tool, two depths of cut, up to spheres that are fixed."""
DRAWN = "0.6", "13"
BEGIN = 1
"""Depths of cut that do not count: the tool begins at a free face."""
ROCK = "crushing_sandstone"
CUT = dict(rock=ROCK, scale_factor=1.0, width=0.045, height=0.015, gravity=0.0,
           tooth_height=0.012, tooth_width=0.008, rake=-5.0, clearance=5.0, tip_radius=5e-4, facet=2e-3,
           tool_kn=1.5e7, tool_kt=6e6, tool_mu=0.3, contact_damping=0.2, velocity=8.0, lowering_velocity=8.0,
           depth_of_cut=5e-3, start=0.0, approach=1e-3, cut_time=3.75e-3, background_damping=500.0,
           snapshot_period=5e-4, record_period=5e-6, report="false")
"""Six depths of way; else as in campaigns.steady_cut."""
GRAINY = "interlocked_sandstone"
"""A rock of grains, whose toughness is that of a sandstone."""
SLOWER = {"13, 4 m/s": 4.0, "13, 2 m/s": 2.0, f"13, {GRAINY}, 2 m/s": 2.0}
"""{case: m/s}."""
ROCKS = {"90 and 1000 J/m2": {},
         "30 and 1000 J/m2": dict(bond_fracture_energy=30.0),
         "30 and 300 J/m2": dict(bond_fracture_energy=30.0, bond_shear_energy=300.0),
         "10 and 300 J/m2": dict(bond_fracture_energy=10.0, bond_shear_energy=300.0)}
"""{rock: parameters} that are less tough, the first as it is: fracture energies of its bonds in tension and shear."""
TOUGHER, *BRITTLER = ROCKS
OTHERS = {
    "13, rake -15": dict(rake=-15.0), "13, rake 15": dict(rake=15.0),
    "13, flat 1": dict(wear_flat=1e-3), "13, flat 2": dict(wear_flat=2e-3),
    "13, 10 deep": dict(depth_of_cut=0.01, width=0.075, height=0.03, depth=0.053, tooth_height=0.024,
                        tooth_width=0.016, cut_time=7.5e-3),
    **{f"13, {rock}": ROCKS[rock] for rock in BRITTLER},
    f"13, {GRAINY}, held 25 mm below": dict(height=0.03)}
"""{case: parameters} of tools 13 mm wide that differ from those of CUT in one thing: degrees, mm of wear flat, mm of
depth with six of them of way and two beside, rock, mm of rock below the path, where others have 10."""
OF_GRAINS = {f"{name}, {GRAINY}": breadth for name, breadth in BREADTHS.items()}
"""{case: m}: breadths in GRAINY."""
ALL_BREADTHS = {**BREADTHS, **OF_GRAINS}
CASES = {"0.45": ["13", "13, flat 2"], "0.6": [*ALL_BREADTHS], "0.9": [*ALL_BREADTHS, *SLOWER, *OTHERS]}
"""{radius: cases}."""
LABORATORY = {"compression": (in_space.SCRIPT, "peak_stress", in_space.SIDES, dict(test="compression", speed=0.1)),
              "toughness": (in_space.NOTCHED, "fracture_toughness", in_space.NOTCHED_SIDES, {})}
"""{test: (script, result, sides of the specimen over the radius, other parameters)}."""
TOUGH = "0.9"
"""Radius at which the rocks stand beside one another."""
QUANTITIES = {"mean force, kN": "force", "over depth and breadth, MJ/m³": "energy", "peak / mean": "peaks",
              "thrust / cutting": "thrust", "friction, kN": "friction", "groove over tool": "section",
              "overbreak / depth": "overbreak", "carried off over tool": "carried_off",
              "carried off below / depth": "carried_below"}
"""{heading: quantity of of_run}."""
CHANGES = {"force, kN": "force", "thrust, kN": "pressed", "friction, kN": "friction", "peak / mean": "peaks",
           "groove over tool": "section", "overbreak / depth": "overbreak",
           "carried off below / depth": "carried_below"}
"""{heading: quantity of of_run} of the table beside the tool of CUT."""
BASE, GRAINY_BASE = "13", f"13, {GRAINY}"
"""Cases beside which the others stand, those of GRAINY beside the second."""


def plan(radii):
    """{(radius, case, seed): (folder, script, parameters)}, one packing of all first. A case is one of CASES, or (test,
    rock) of LABORATORY and ROCKS."""
    found = {}
    for seed in SEEDS:
        for name in radii:
            rock = dict(rock=ROCK, radius=RADII[name], seed=seed)
            for case in CASES[name]:
                place = f"cut/{name}-{file_name(case)}-{seed}"
                found[name, case, seed] = place, SCRIPT, {**CUT, **rock, **changed(case)}
            for test, of in (itertools.product(LABORATORY, ROCKS) if name == TOUGH else [("compression", TOUGHER)]):
                place = f"lab/{name}-{test}-{file_name(of)}-{seed}"
                found[name, (test, of), seed] = place, *specimen(test, {**rock, **ROCKS[of], "report": "false"})
    return found


def specimen(test, rock):
    """(script, parameters) of a test of LABORATORY on a rock of these parameters."""
    script, _, sides, more = LABORATORY[test]
    return script, {**rock, **in_space.sized(sides, rock["radius"]), **more}


def named(radius, case, seed):
    """A run of the plan in words."""
    return f"spheres of {radius} mm, {case if isinstance(case, str) else ' of '.join(case)}, packing {seed}"


def changed(case):
    """Parameters of a case other than those of CUT."""
    rock = dict(rock=GRAINY) if GRAINY in case else {}
    other = slower(SLOWER[case]) if case in SLOWER else OTHERS.get(case, {})
    return {**wider(ALL_BREADTHS.get(case, BREADTHS[BASE])), **rock, **other}


def file_name(case):
    """As in the name of a folder: 13-4mps for "13, 4 m/s"."""
    return case.replace(", ", "-").replace(" m/s", "mps").replace(" ", "_").replace("/", "")


def wider(breadth):
    """Parameters of a tool of a breadth (m)."""
    return dict(breadth=breadth, depth=float(f"{breadth + 2 * BESIDE:.6g}"))


def slower(speed):
    """Parameters of a tool so fast (m/s) that goes as far."""
    times = {name: CUT[name] * CUT["velocity"] / speed for name in ("cut_time", "snapshot_period", "record_period")}
    return dict(times, velocity=speed, lowering_velocity=speed)


def of_run(run):
    """{quantity: Measured} of one cut, from BEGIN depths of cut on. Forces in kN; energy, that of the mean force over
    depth and breadth, in MJ/m3; section: of the groove over that of the tool in the rock; overbreak: mean depth of the
    rock that came off below the path, over the depth of cut; carried_off, carried_below: the same of the rock that has
    gone farther than the depth of cut. The rest is broken, but lies where it was."""
    depth, breadth = run.parameter("depth_of_cut"), run.parameter("breadth")
    cut = run.column("stage") == run.column("stage").max()
    time, cutting, thrust, friction = (run.column(name)[cut] for name in (
        "time", "cutting_force", "thrust_force", "tool_friction"))
    distance = run.parameter("velocity") * (time - time[0])
    begin = BEGIN * depth
    found, _ = of_forces(distance, cutting, thrust, friction, depth=depth, begin=begin)
    (above, below), (gone_above, gone_below) = broken(run, begin, float(distance[-1]) - depth, farther=(0.0, depth))
    tool = depth * breadth
    energy = run.balances["energy"]
    others = {"section": (above + below) / tool, "overbreak": below / tool,
              "carried_off": (gone_above + gone_below) / tool, "carried_below": gone_below / tool,
              "missed": energy["residual"] / energy["tool_work"]}
    return {**found, "energy": scaled(found["force"], 1e-3 / tool),
            **{name: steady_record.Measured(value, math.nan) for name, value in others.items()}}


def broken(run, begin, end, farther):
    """[(above, below) the tool's path]: m2 of rock in a section across the cut that has come off between `begin` and
    `end` m of way, and gone at least as far as each of `farther` (m)."""
    first, height = run.snapshot(0)["rock_positions"], run.parameter("height") - run.parameter("depth_of_cut")
    gone = np.linalg.norm(run.snapshot(-1)["rock_positions"] - first, axis=1)
    here = off(run) & (first[:, 0] > begin) & (first[:, 0] < end)
    volume = run.parameter("width") * run.parameter("height") * run.parameter("depth") / len(first)
    over = first[:, 1] > height
    return [tuple(np.count_nonzero(here & (gone >= least) & part) * volume / (end - begin) for part in (over, ~over))
            for least in farther]


def off(run):
    """(n,) bool: spheres that no bonds hold to the fixed ones any more."""
    piece = pieces(len(run.model["rock_radii"]), run.model["bonds"], run.snapshot(-1)["status"] == 0)
    return ~np.isin(piece, piece[run.model["rock_fixed"]])


def measured(folder):
    """({radius: {case: {seed: {quantity: Measured}}}}, {(radius, test, rock): [Pa, or Pa sqrt(m)]}) of the runs that
    exist."""
    cuts, strengths = {}, {}
    places = {key: folder / place for key, (place, *_) in plan(RADII).items()}
    for (radius, case, seed), run in existing(places).items():
        if isinstance(case, str):
            cuts.setdefault(radius, {}).setdefault(case, {})[seed] = of_run(run)
        else:
            strengths.setdefault((radius, *case), []).append(run.result(LABORATORY[case[0]][1]))
    return cuts, strengths


def rocks_table(found, strengths):
    """Rows of the table of ROCKS: toughness, UCS and the force of the tool of BASE. found: {case: {seed: {quantity:
    Measured}}}."""
    for rock in ROCKS:
        cut = found.get(BASE if rock == TOUGHER else f"{BASE}, {rock}", {})
        ucs, toughness = (np.array(strengths.get((TOUGH, test, rock), [])) for test in LABORATORY)
        if len(ucs) and len(toughness) and cut:
            force = over_packings([one["force"] for one in cut.values()])
            energy = over_packings([one["energy"] for one in cut.values()])
            yield [rock, generated.mean_cell(1e-6 * toughness), generated.mean_cell(1e-6 * ucs), shown(force),
                   shown(scaled(energy, 100 / (1e-6 * ucs.mean()))), f"{len(toughness)}, {len(ucs)}, {len(cut)}"]


def sides(found, breadths=BREADTHS):
    """(slice, kN/m; sides, kN), each Measured: the line of the mean force over the breadth, in each of the packings
    that have all of `breadths` {case: m}; unknown without one."""
    seeds = sorted(set.intersection(*(set(found.get(name, {})) for name in breadths)))
    if not seeds:
        return steady_record.UNKNOWN, steady_record.UNKNOWN
    lines = [np.polyfit(list(breadths.values()), [found[name][seed]["force"].value for name in breadths], 1)
             for seed in seeds]
    return tuple(map(steady_record.sample_mean, np.transpose(lines)))


def rows(found):
    """Rows of the table of a radius, a case each."""
    for name, of in found.items():
        cells = (shown(over_packings([one[quantity] for one in of.values()])) for quantity in QUANTITIES.values())
        yield [name, len(of), *cells, f"{100 * max(abs(one['missed'].value) for one in of.values()):.2g} %"]


def changes(found):
    """Rows of the table of a radius: what each case changes in the packings that its base has, too."""
    for name, each in found.items():
        beside = found.get(GRAINY_BASE if GRAINY in name else BASE, {})
        seeds = each.keys() & beside.keys() if name not in ALL_BREADTHS else ()
        if seeds:
            here, base = (_over({seed: of[seed] for seed in seeds}) for of in (each, beside))
            by = [(difference(here, base, what), base[what].value) for what in CHANGES.values()]
            yield [name, len(seeds), *(f"{shown(change)} ({100 * change.value / of:+.0f} %)" for change, of in by)]


def _over(each):
    """{quantity: Measured} over packings, with themselves as "each"."""
    return {"each": each, **{what: over_packings([one[what] for one in each.values()]) for what in CHANGES.values()}}


def figure(cuts, run):
    """The mean force over the breadth, and a section across the groove of a run (None: without)."""
    drawn, panels = plots.canvas(11, 4, 1, 2 if run else 1)
    axes = panels[0]
    for (radius, found), colour in zip(cuts.items(), palette.OTHER_LINES):
        for name, of in ((name, found[name]) for name in BREADTHS if name in found):
            axes.plot([1e3 * BREADTHS[name]] * len(of), [one["force"].value for one in of.values()], "o", color=colour)
        a_slice, edges = sides(found)
        if math.isfinite(a_slice.value):
            breadth = np.array([0.0, 1.05 * max(BREADTHS.values())])
            axes.plot(1e3 * breadth, a_slice.value * breadth + edges.value, color=colour,
                      label=f"spheres of {radius} mm: {edges.value:.2g} kN, and {a_slice.value:.2g} kN/m")
            axes.plot(1e3 * breadth, a_slice.value * breadth, "--", color=colour)
    axes.plot([], [], "--", color=palette.GUIDE, label="without the sides")
    axes.legend()
    axes.set(xlabel="breadth of the tool / mm", ylabel="mean cutting force / kN", ylim=(0, None),
             xlim=(0, 1050 * max(BREADTHS.values())))
    if run:
        section(panels[1], run)
    return drawn


def section(axes, run):
    """Rock across the cut where the tool has passed: what came off, and the tool's own section."""
    first, loose = run.snapshot(0)["rock_positions"], off(run)
    radius, (_, height, depth) = run.parameter("radius"), run.model["block"]
    breadth, cut = run.parameter("breadth"), run.parameter("depth_of_cut")
    here = np.abs(first[:, 0] - 2.5 * cut) < radius
    for these, colour in ((here & ~loose, palette.ROCK), (here & loose, palette.REMOVED)):
        plots.discs(axes, first[these][:, [2, 1]], np.full(np.count_nonzero(these), radius), facecolors=colour,
                    edgecolors=palette.ROCK_EDGE, linewidths=0.3)
    corners = np.array([(-1, 0), (-1, -1), (1, -1), (1, 0)]) * (0.5 * breadth, cut) + (0, height)
    axes.plot(*(1e3 * corners).T, color=palette.PATH, label="the tool's section")
    plots.frame(axes, (-500 * depth, 500 * depth, 0, 1.2e3 * height), "across the groove: red has come off")
    axes.legend(loc="upper right")


def write(folder):
    """Tables and figure of the runs that exist. -> the tables, in Markdown."""
    cuts, strengths = measured(folder)
    lines = ["Mean ± standard error: of the packings where there are three, else of the cuts' own records, from "
             f"{BEGIN} depth of cut on. Groove over tool: section of the rock that came off over depth times breadth. "
             "Carried off: the part of it that has gone farther than the depth of cut. Energy missed: residual of the "
             "balance over the tool's work, of the worst packing.", ""]
    for radius, found in cuts.items():
        lines += [f"## Spheres of {radius} mm", ""]
        ucs = strengths.get((radius, "compression", TOUGHER))
        if ucs:
            lines += [f"UCS {generated.mean_cell(1e-6 * np.array(ucs))} MPa ({len(ucs)} packings).", ""]
        lines += generated.table(["breadth, mm", "packings", *QUANTITIES, "energy missed"], rows(found))
        beside = list(changes(found))
        if beside:
            lines += [f"Beside a tool {BASE} mm wide in the same rock, in packings in common:", "",
                      *generated.table(["case", "packings", *CHANGES], beside)]
        rocks = list(rocks_table(found, strengths)) if radius == TOUGH else []
        if rocks:
            lines += ["Rocks that differ in the fracture energies of their bonds, in tension and in shear:", "",
                      *generated.table(["rock", "K_IC, MPa√m", "UCS, MPa", "mean force, kN", "over depth and breadth, "
                                        "% of the UCS", "packings of each"], rocks)]
        for rock, breadths in ((ROCK, BREADTHS), (GRAINY, OF_GRAINS)):
            a_slice, edges = sides(found, breadths)
            if math.isfinite(a_slice.value):
                lines += [f"The mean force in `{rock}` is {shown(edges)} kN at the sides and {shown(a_slice)} kN per "
                          "metre of breadth (mean of the lines of each packing that has all breadths).", ""]
    if cuts:
        drawn = next((RunFolder(folder / f"cut/{'-'.join(DRAWN)}-{seed}")
                      for seed in cuts.get(DRAWN[0], {}).get(DRAWN[1], {})), None)
        with matplotlib.rc_context(plots.STYLE):
            figure(cuts, drawn).savefig(folder / "groove.png")
        generated.record(folder / "groove.png")
    return generated.write_page(folder / "groove.md", lines)


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed."""
    failed = 0
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(place, script, **values)
                    for key, (place, script, values) in plan(words or RADII).items()}
            failed = wait_for(jobs, lambda key, run: named(*key))
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, RADII)
    sys.exit(main(place, words, **where))

"""Campaign of grains: the Hawkesbury sandstone of [Bahaaddini 2018], and the parameter study around it.

    python3 -m calibration.campaigns.grains DIR [calibrated|study|sliding ...] [--read | --stored]
        [--jobs N | --scheduler ADDRESS]

N runs at a time (2), or as many as a dask scheduler's workers take; a folder a run; finished runs are not repeated, so
that an interrupted campaign resumes. --read starts no run and evaluates those that exist. Writes into DIR grains.csv
(strengths and moduli of every run), grains.md (tables), hawkesbury.json (the rock file with what was measured), the
figures and provenance.json. --stored needs no runs: it draws grains_envelope.png of the strengths in DIR/grains.csv.
"""
import csv
import json
import sys
from pathlib import Path

import matplotlib

from calibration import generated
from calibration.campaigns import grains_figures as figures
from calibration.campaigns import grains_tables as tables
from calibration.campaigns.runs import Runs, command_line, existing, wait_for
from calibration.campaigns.uniaxial_tables import write_csv
from rockwear.model import rock_file
from rockwear.report import plots
from rockwear.scenes.parameters import OF_ROCK

ROCK = "hawkesbury"
SPECIMEN = dict(width=0.1, height=0.05, report="false", snapshot_period=1, rock_sampling_period=50)
"""[Bahaaddini 2018, 3.1], loaded along its length."""
CONFINEMENTS = 1e6, 5e6, 10e6
"""Pa, in the range of [Bahaaddini 2018, fig. 8]."""
STUDIED = 5e6
"""Pa, confinement of the parameter study [Bahaaddini 2018, sec. 4]."""
SEEDS = tuple(range(166, 191))
"""Packings that the rock was not calibrated on."""
STUDY_SEEDS = 61, 62, 63, 64
SLIDING_SEEDS = SEEDS[:3]
"""Packings that are pressed at the highest confinement until what has failed slides."""


def rock():
    """{name: value} of the rock's micro-parameters and radii."""
    part = rock_file.read(rock_file.find(ROCK), OF_ROCK).parts["plane"]
    return {**part.parameters, **part.resolution}


def tests(*confinements):
    """{test: (script, values)}; what their speeds do: calibration/results/grains.md."""
    uniaxial, triaxial = "yade_scripts/uniaxial.py", "yade_scripts/triaxial.py"
    return {"compression": (uniaxial, dict(test="compression", speed=0.1, strain_max=0.02, record_strain=4e-5)),
            "tension": (uniaxial, dict(test="tension", speed=0.02, strain_max=0.003, record_strain=2e-6)),
            **{f"{1e-6 * pressure:g} MPa": (triaxial, dict(confinement=pressure, speed=0.2, strain_max=0.035, drop=0.7,
                                                           record_strain=1e-4))
               for pressure in confinements}}


def study(base):
    """{parameter: {its value: values that differ from the calibrated ones}}; base: as of `rock`.

    Bulk and shear modulus of the blocks are in the lattice of discs: its bulk modulus follows the normal stiffness
    alone, and its shear modulus the sum of both. What varies the contacts leaves the grains as they are.
    """
    kn, kt = base["kn"], base["kt"]
    grain_kn, grain_kt = base.get("grain_kn") or kn, base.get("grain_kt") or kt
    grains = dict(grain_kn=grain_kn, grain_kt=grain_kt)

    def varied(name, *factors, **others):
        return {base[name] * factor: {name: base[name] * factor, **others} for factor in factors}

    return {"grain edge, mm": {1e3 * edge: dict(grain_edge=edge) for edge in (2e-3, 5e-3, 10e-3, 20e-3)},
            "block normal stiffness, GN/m": {1e-9 * grain_kn * f: dict(grain_kn=grain_kn * f, grain_kt=grain_kt * f)
                                             for f in (0.5, 0.7, 1.5)},
            "block tangential stiffness, GN/m": {1e-9 * grain_kt * f: dict(grain_kn=grain_kn, grain_kt=grain_kt * f)
                                                 for f in (0.4, 0.7, 1.6)},
            "contact normal stiffness, GN/m": {1e-9 * kn * f: dict(kn=kn * f, kt=kt * f, **grains)
                                               for f in (0.53, 0.75, 1.67)},
            "contact stiffness ratio kn/kt": {kn / kt / f: dict(kt=kt * f, **grains) for f in (0.4, 0.7, 1.6)},
            "cohesion, MPa": {1e-6 * c: v for c, v in varied("bond_cohesion", 0.4, 0.65, 1.6).items()},
            "friction": varied("mu", 0.4, 0.7, 1.4),
            "tensile strength, MPa": {1e-6 * t: v for t, v in varied("bond_tension", 0.4, 0.65, 1.6).items()}}


def calibrated_value(parameter, base):
    """The rock's own value of a parameter of `study`."""
    kn, kt = base["kn"], base["kt"]
    return {"grain edge, mm": 1e3 * base["grain_edge"],
            "block normal stiffness, GN/m": 1e-9 * (base.get("grain_kn") or kn),
            "block tangential stiffness, GN/m": 1e-9 * (base.get("grain_kt") or kt),
            "contact normal stiffness, GN/m": 1e-9 * kn, "contact stiffness ratio kn/kt": kn / kt,
            "cohesion, MPa": 1e-6 * base["bond_cohesion"], "friction": base["mu"],
            "tensile strength, MPa": 1e-6 * base["bond_tension"]}[parameter]


def planned(campaign):
    """{(parameter, value, test, seed): (folder, script, values)} of a campaign, packing by packing; parameter "" is the
    calibrated rock."""
    base = rock()
    if campaign == "calibrated":
        cases, seeds, which = {("", 0.0): {}}, SEEDS, tests(*CONFINEMENTS)
    elif campaign == "sliding":
        highest = {test: job for test, job in tests(CONFINEMENTS[-1]).items() if "MPa" in test}
        cases, seeds, which = {(campaign, 0.0): dict(strain_max=0.12, drop=0.5)}, SLIDING_SEEDS, highest
    else:
        cases = {(name, x): change for name, points in study(base).items() for x, change in points.items()}
        seeds, which = STUDY_SEEDS, tests(STUDIED)
    jobs = {}
    for seed in seeds:
        for test, (script, values) in which.items():
            for (name, x), change in cases.items():
                folder = "".join(c if c.isalnum() or c in "-." else "_" for c in f"{name}-{x:.4g}-{test}-{seed}")
                jobs[name, x, test, seed] = (f"{campaign}/{folder}", script,
                                             {**base, **SPECIMEN, **values, "seed": seed, **change})
    return jobs


CAMPAIGNS = "calibrated", "study", "sliding"


def found(folder):
    """{(parameter, value, test, seed): RunFolder} of all runs that exist."""
    places = {key: folder / place for campaign in CAMPAIGNS for key, (place, *_) in planned(campaign).items()}
    return existing(places)


def write(folder):
    """Tables, rock file and figures of all runs that exist. -> the tables, in Markdown."""
    runs, base = found(folder), rock()
    rows = [tables.row_of(*key, run) for key, run in runs.items()]
    write_csv(folder / "grains.csv", rows)
    points = {name: tables.points(rows, name, calibrated_value(name, base)) for name in study(base)}
    written = [folder / "grains.csv", folder / "hawkesbury.json"]
    measured = tables.measured(rows)
    rock_data = json.loads(rock_file.find(ROCK).read_text(encoding="utf-8"))
    rock_data["plane"]["measured"] = tables.as_measured(measured)
    written[1].write_text(json.dumps(rock_data, indent=1) + "\n", encoding="utf-8")
    own = {(test, seed): run for (name, _, test, seed), run in runs.items() if not name}
    slid = [run for (name, *_), run in runs.items() if name == "sliding"]
    with matplotlib.rc_context(plots.STYLE):
        for name, figure in figures.drawn(own, points, rows, slid):
            written.append(folder / f"{name}.png")
            figure.savefig(written[-1])
    generated.record(*filter(Path.exists, written))
    return generated.write_page(folder / "grains.md", tables.page(rows, measured, points))


def stored(folder):
    """Draw grains_envelope.png of the folder's grains.csv. -> its table, in Markdown. Raises OSError."""
    with open(folder / "grains.csv", newline="", encoding="utf-8") as file:
        rows = [{**row, "peak_stress": float(row["peak_stress"])} for row in csv.DictReader(file)]
    written = folder / "grains_envelope.png"
    with matplotlib.rc_context(plots.STYLE):
        figures.envelope(rows).savefig(written)
    generated.record(written)
    return "\n".join(tables.beside_the_laboratory(rows))


def _line(key, run):
    name, x, test, seed = key
    return f"{name or 'calibrated'} {x:.4g}, {test}, packing {seed}: {1e-6 * run.result('peak_stress'):.2f} MPa"


def main(folder, words, **where):
    """where: options of Runs. -> exit code: 1 where a run failed, 2 where nothing is stored."""
    failed = 0
    if "--stored" in words:
        try:
            print(stored(folder))
        except OSError as error:
            print(f"error: DIR = {folder} must hold grains.csv ({error.strerror})", file=sys.stderr)
            return 2
        return 0
    if "--read" not in words:
        with Runs(folder, keep=True, **where) as runs:
            jobs = {key: runs.start(place, script, **values)
                    for campaign in [word for word in CAMPAIGNS if word in words] or CAMPAIGNS
                    for key, (place, script, values) in planned(campaign).items()}
            failed = wait_for(jobs, _line)
    print(write(folder))
    return failed


if __name__ == "__main__":
    place, words, where = command_line(__spec__.name, CAMPAIGNS, ("--read", "--stored"))
    sys.exit(main(place, words, **where))

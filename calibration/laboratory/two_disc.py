"""The two-disc programme [Rojek 2003, 4.6]: one bond under tension, compression, shear and both, for every bond law."""
import json
import math
import os
import platform
import sys
import time

import numpy as np
import yade

from rockwear import __version__, report
from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import Group, Parameter, integer, length, text
from rockwear.run import parameters, run_folder, servers
from rockwear.scenes.parameters import BONDS
from rockwear.scenes.two_disc import BEYOND, drive_pair, programme

GROUPS = [
    BONDS.without("rock", "bond_law", "bonding_gap", "weibull_modulus", "rotation", "grain_edge",
                  "grain_strength", "grain_kn", "grain_kt").with_defaults(
        kn=2e10, kt=2e10, Rn=1e5, Rt=1e5, H=1e10, bond_tension=1e5, bond_cohesion=1e5, bond_fracture_energy=0.75,
        mu=0.839),
    Group("test", (
        Parameter("radius", 1.25e-3, "m", length, "of both discs"),
        Parameter("steps", 403, "", integer(10), "points on the longest leg of a path"))),
    Group("output", (
        Parameter("out", "", "", text, "folder of the results; out/two_disc when empty, a subfolder a row in a "
                  "batch"),))]
AGREEMENT = 1e-6
"""Largest difference between YADE and `drive`, as a fraction of the tensile strength, that is a success."""


def main():
    """Run all. Ends the process: 0 done; 2 a parameter or folder that cannot be used; 1 YADE and the laws differ."""
    code = run()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # YADE's threads make an ordinary exit crash now and then after all work is done.


def run():
    """The exit code of `main`."""
    servers.close()
    if "--help" in sys.argv:
        parameters.describe(GROUPS)
        return 0
    began = time.time()
    try:
        values = parameters.read(GROUPS, sys.argv[1:])
        laws = {name: (law, *ends(law, values)) for name, law in make_laws(values).items()}
        check_paths(laws, values)
        folder = run_folder.find("two_disc", values["out"])
        held = run_folder.take(folder)
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    with held:
        run_folder.empty(folder)
        found = {name: run_law(law, *both, values) for name, (law, *both) in laws.items()}
        results = judge(found, laws)
        deviation = results["largest deviation"][0]
        agree = deviation <= AGREEMENT
        ended = "finished" if agree else f"YADE and the bond laws differ by {deviation:.1e}, allowed is {AGREEMENT:g}"
        write(folder, found, results, values, began, ended, int(not agree))
    print(f"YADE against drive: at most {deviation:.1e} of the strength; report: {folder / 'report.html'}")
    if not agree:
        print(f"error: {ended}", file=sys.stderr)
    return int(not agree)


def make_laws(values):
    """{name: law} of every bond law; that of Padova is scaled to the strength Rn."""
    laws = {name: law.from_values(values) for name, law in BOND_LAWS.items()}
    laws["padova"] = BOND_LAWS["padova"].from_values({**values, "Rn": 1e5}).scaled(values["Rn"] / 1e5)
    return laws


def ends(law, values):
    """Displacements (m) at which a bond is gone in tension and in shear."""
    if hasattr(law, "tension"):
        return -law.Rn / law.tension.b2, -law.Rt / law.shear.b2
    return tuple(R / k + R / values["H"] for R, k in ((law.Rn, law.kn), (law.Rt, law.kt)))


def check_paths(laws, values):
    """Raise ParameterError where a path goes further than the radius. laws: {name: (law, *ends)}."""
    reach, slope = values["radius"] / BEYOND, values["H"]
    both = [pair for law, *found in laws.values() for pair in zip(ends(law, {**values, "H": math.inf}), found)]
    without = max(elastic for elastic, _ in both)
    require(without < reach, "radius", values["radius"], f"more than {BEYOND * without:.3g}, where the paths end", "m")
    least = max(slope * (end - elastic) / (reach - elastic) for elastic, end in both)
    require(slope > least, "H", slope, f"more than {least:.3g}, so that the paths end before the radius, "
            f"{values['radius']:g} m", "N/m")


def run_law(law, end_n, end_t, values):
    """{programme: columns of the path}: displacements, YADE's forces, and those of `drive`."""
    found = {}
    for kind, (un, ut) in programme(law, end_n, end_t, values["steps"]).items():
        got = drive_pair(law, un, ut, radii=(values["radius"], values["radius"]))
        Fn, Ft = law.drive(got.un, got.ut[:, 0])
        found[kind] = {"un": got.un, "ut": got.ut[:, 0], "Fn": got.Fn, "Ft": got.Ft[:, 0],
                       "Fn drive": Fn, "Ft drive": Ft, "released": got.bonds.energy_released}
    return found


def judge(found, laws):
    """{name: (value, unit)}: deviations, and what [Rojek 2003] says of its figures."""
    results = {"largest deviation": (0.0, "of Rn")}
    for name, kinds in found.items():
        for kind, path in kinds.items():
            deviation = max(float(abs(path[force] - path[f"{force} drive"]).max()) for force in ("Fn", "Ft"))
            results[f"{name}, {kind}: deviation"] = deviation / laws[name][0].Rn, "of Rn"
    results["largest deviation"] = max(value for value, _ in results.values()), "of Rn"
    for name in ("plastic", "damage"):
        law, tension = laws[name][0], found[name]["tension"]
        peak = int(tension["Fn"].argmax())
        results[f"{name}, tension: peak"] = float(tension["Fn"][peak]), "N"
        results[f"{name}, tension: opening at the peak"] = float(tension["un"][peak]), "m"
        results[f"{name}, tension: opening at the end"] = float(tension["un"][tension["Fn"] > 0][-1]), "m"
        results[f"{name}, tension: work until gone"] = found[name]["tension"]["released"], "J"
        results[f"{name}, tension: the same, exact"] = law.fracture_energy()[0], "J"
        both = found[name]["shear with tension"]
        results[f"{name}, shear with tension: largest resultant"] = float(np.hypot(both["Fn"], both["Ft"]).max()), "N"
        results[f"{name}, shear with tension: largest Ft"] = float(both["Ft"].max()), "N"
        results[f"{name}, shear with tension: largest Fn"] = float(both["Fn"].max()), "N"
    return results


def write(folder, found, results, values, began, ended, code):
    """paths/*.csv, summary.json, and the report with its figures. ended, code: how the run ends, its exit code."""
    (folder / "paths").mkdir()
    for name, kinds in found.items():
        for kind, path in kinds.items():
            columns = [column for column in path if column != "released"]
            header = ",".join(f"{column} [{'m' if column in ('un', 'ut') else 'N'}]" for column in columns)
            np.savetxt(folder / "paths" / f"{name}_{kind.replace(', ', '_').replace(' ', '_')}.csv",
                       np.column_stack([path[column] for column in columns]), "%.12g", ",", header=header, comments="")
    summary = {"scene": "two_disc", "ended": ended, "exit_code": code, "parameters": values, "seed": None,
               "versions": {"rockwear": __version__, "yade": yade.config.version, "python": platform.python_version(),
                            "numpy": np.__version__},
               "results": {name: {"value": value, "unit": unit} for name, (value, unit) in results.items()},
               "balances": {}, "wall_time": {"unit": "s", "total": time.time() - began}}
    (folder / "summary.json").write_text(json.dumps(summary, indent=1), encoding="utf-8")
    report.write(folder)

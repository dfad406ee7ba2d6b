"""The two-disc programme [Rojek 2003, 4.6]: one bond under tension, compression, shear and both, for every bond law."""
import json
import os
import platform
import sys
import time
from pathlib import Path

import numpy as np
import yade

from rockwear import __version__, report
from rockwear.kernels.bond_laws import BOND_LAWS, NonlinearElastoPlastic
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.parameter import Group, Parameter, above_zero, integer, text
from rockwear.run import parameters, servers
from rockwear.scenes.parameters import BONDS
from rockwear.scenes.two_disc import lead, programme

PARAMETERS = [
    Parameter("kn", 2e10, "N/m", above_zero, "normal stiffness", "M 4.6"),
    Parameter("kt", 2e10, "N/m", above_zero, "tangential stiffness", "as kn"),
    Parameter("Rn", 1e5, "N", above_zero, "tensile strength", "M 4.6"),
    Parameter("Rt", 1e5, "N", above_zero, "shear strength", "M 4.6, there called k_t"),
    Parameter("H", 1e10, "N/m", above_zero, "slope of softening against total displacement", "M 4.6"),
    Parameter("mu", 0.839, "", number(0), "friction after breakage", "M 4.6"),
    Parameter("radius", 1.25e-3, "m", above_zero, "of both discs"),
    Parameter("steps", 403, "", integer(10), "points on the longest leg of a path"),
    Parameter("out", "", "", text, "folder of the results; out/two_disc when empty, a subfolder a row in a batch"),
]
AGREEMENT = 1e-6
"""Largest difference between YADE and `drive`, as a fraction of the tensile strength, that is a success."""

COMMON = [("tension", "Fn", "un"), ("tension, unloading and reloading", "Fn", "un"), ("compression", "Fn", "un"),
          ("shear", "Ft", "ut"), ("shear with compression", "Fn", "un"), ("shear with compression", "Ft", "ut")]
SHEAR_WITH_TENSION = [("shear with tension", "Fn", "ut"), ("shear with tension", "Ft", "ut")]
FIGURES = {"plastic": COMMON + SHEAR_WITH_TENSION,
           "damage": COMMON + [("shear with tension", "Ft", "ut"), ("shear with tension", "Fn", "un")],
           "brittle": COMMON + SHEAR_WITH_TENSION, "padova": COMMON + SHEAR_WITH_TENSION}
"""Law: what its figures show, (programme, force, displacement), in M's order where M has them."""
FIRST_FIGURE = {"plastic": 11, "damage": 19}
TITLES = {"plastic": "Elasto-plastic bond with linear softening (M 4.6.1)",
          "damage": "Elastic damage with linear softening (M 4.6.2)",
          "brittle": "Elastic perfectly brittle bond",
          "padova": "Elasto-plastic bond with nonlinear softening (Padova)"}


def main():
    """Run all. Ends the process: 0 done; 2 a parameter or folder that cannot be used; 1 YADE and the laws differ."""
    if "--help" in sys.argv:
        print(f"yade -n -x {sys.argv[0]} [--name value ...]")
        parameters.describe(PARAMETERS)
        return 0
    began = time.time()
    try:
        values = parameters.read(PARAMETERS, sys.argv[1:])
        laws = make_laws(values)
        folder = make_folder(values["out"])
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    found = {name: run_law(law, *ends, values) for name, (law, *ends) in laws.items()}
    results = judge(found, laws)
    write(folder, found, results, values, began)
    deviation = results["largest deviation"][0]
    print(f"YADE against drive: at most {deviation:.1e} of the strength; report: {folder / 'report.html'}")
    if not deviation <= AGREEMENT:
        print(f"error: YADE and the bond laws differ by {deviation:.1e}, allowed is {AGREEMENT:g}", file=sys.stderr)
        return 1
    return 0


def make_folder(out):
    """The folder of the results. Raises ParameterError."""
    row = parameters.batch_row()
    folder = Path(out or Path("out") / "two_disc") / (row or "")
    try:
        for name in ("figures", "paths"):
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ParameterError("out", str(folder), f"a folder that can be written ({error.strerror})") from None
    return folder


def make_laws(v):
    """{name: (law, end in tension, end in shear)}, displacements in m."""
    linear = {name: v[name] for name in ("kn", "kt", "Rn", "Rt", "H", "mu")}
    ends = v["Rn"] / v["kn"] + v["Rn"] / v["H"], v["Rt"] / v["kt"] + v["Rt"] / v["H"]
    laws = {name: (linear_law(name, **linear), *ends) for name in ("plastic", "damage", "brittle")}
    padova = NonlinearElastoPlastic(kn=v["kn"], mu=v["mu"]).scaled(v["Rn"] / 1e5)
    laws["padova"] = padova, -padova.Rn / padova.tension.b2, -padova.Rt / padova.shear.b2
    return laws


def run_law(law, end_n, end_t, v):
    """{programme: columns of the path}: displacements, YADE's forces, and those of `drive`."""
    found = {}
    for kind, (un, ut) in programme(law, end_n, end_t, v["steps"]).items():
        got = lead(law, un, ut, radii=(v["radius"], v["radius"]))
        Fn, Ft = law.drive(got.un, got.ut[:, 0])
        found[kind] = {"un": got.un, "ut": got.ut[:, 0], "Fn": got.Fn, "Ft": got.Ft[:, 0],
                       "Fn drive": Fn, "Ft drive": Ft, "released": got.bonds.energy_released}
    return found


def judge(found, laws):
    """{name: (value, unit)}: deviations, and what M says of its figures."""
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


def draw(path, force, displacement, title, file):
    """One figure: YADE's points over the line of `drive`."""
    names = {"un": "opening [µm]", "ut": "tangential displacement [µm]", "Fn": "normal force [kN]",
             "Ft": "tangential force [kN]"}
    figure, axes = plt.subplots(figsize=(4.6, 3.3), constrained_layout=True)
    u = 1e6 * path[displacement]
    every = max(1, len(u) // 60)
    axes.plot(u, 1e-3 * path[f"{force} drive"], color="#c8a15a", linewidth=2, label="law")
    axes.plot(u[::every], 1e-3 * path[force][::every], ".", color="#2a4d69", markersize=4, label="YADE")
    axes.set(xlabel=names[displacement], ylabel=names[force])
    axes.set_title(title, fontsize=9)
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.savefig(file, dpi=100)
    plt.close(figure)
    return file


def write(folder, found, results, values, began):
    """paths/*.csv, figures/*.png, summary.json and report.html."""
    sections = []
    for name, figures in FIGURES.items():
        for kind, path in found[name].items():
            columns = [column for column in path if column != "released"]
            header = ",".join(f"{column} [{'m' if column in ('un', 'ut') else 'N'}]" for column in columns)
            np.savetxt(folder / "paths" / f"{name}_{kind.replace(', ', '_').replace(' ', '_')}.csv",
                       np.column_stack([path[column] for column in columns]), "%.12g", ",", header=header, comments="")
        files = []
        for place, (kind, force, displacement) in enumerate(figures):
            first = FIRST_FIGURE.get(name)
            label = f"4.{first + place}" if first else f"{name} {place + 1}"
            file = folder / "figures" / f"figure_{label.replace('.', '_').replace(' ', '_')}.png"
            title = f"{'M fig. ' if first else ''}{label}: {kind}"
            files.append(draw(found[name][kind], force, displacement, title, file))
        words = "Points: YADE. Line: the law's own drive at the same displacements."
        sections.append(page.Section(TITLES[name], words, [page.beside(*map(page.image, files))]))
    summary = {"scene": "two_disc", "ended": "finished", "parameters": values, "seed": None,
               "versions": {"rockwear": __version__, "yade": yade.config.version, "python": platform.python_version(),
                            "numpy": np.__version__},
               "results": {name: {"value": value, "unit": unit} for name, (value, unit) in results.items()},
               "balances": {}, "wall_time": {"unit": "s", "total": time.time() - began}}
    (folder / "summary.json").write_text(json.dumps(summary, indent=1), encoding="utf-8")
    rows = [(name, f"{value:.6g}", unit) for name, (value, unit) in results.items()]
    table = page.Section("Results", f"YADE must agree with drive to {AGREEMENT:g} of the strength.",
                         [page.table(rows, ("quantity", "value", "unit"))])
    run = RunFolder(folder)
    text_of_page = page.whole_page(run, [table, *sections, page.parameters(run)])
    (folder / "report.html").write_text(text_of_page, encoding="utf-8")

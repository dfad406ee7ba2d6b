"""Sharp and worn: the effect of a tooth's wear on the cut.

    python3 -m calibration.campaigns.sharp_and_worn WORN_RUN DIR [SEED ...] [--jobs N | --scheduler ADDRESS]

WORN_RUN is the folder of a finished run of a wearing tooth (make campaign-wear writes some). Its outlines, new and at
equal steps of its mass loss, become teeth without wear; each cuts the same fresh specimens at the same depth, one
packing for each seed. Writes into DIR the outlines, the runs (finished ones are kept), sharp_and_worn.csv and .md, a
figure and a page: cutting and thrust force, specific energy and chip size against the mass lost, beside the theories of
Evans and Nishimatsu.
"""
import math
import sys
from pathlib import Path

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import RunFailed, Runs, placement
from calibration.campaigns.two_tools import scatter
from calibration.campaigns.uniaxial_tables import write_csv
from rockwear.kernels import cutting_theory
from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.fragments import pieces
from rockwear.report import page, plots, shapes
from rockwear.report.bodies import tool_loops
from rockwear.report.folder import RunFolder

SHAPES = 4
"""Number of outlines, the new one included."""
SEEDS = 1, 2, 3, 4
"""Several packings, because a single cut is known to a third only."""
CUT = dict(cycles=0, start_up=0.012, wear_acceleration=0, heat="false", grading_factor=3)
"""48 mm of cut at 4 m/s in graded rock; no wear, no heat."""
SAME = "velocity depth_of_cut tool_kn tool_kt tool_mu contact_damping bond_law tool_radius_min tool_radius_max".split()
"""Parameters of the cuts that are those of WORN_RUN, with those of its bond law."""
STRENGTH = {"compressive_strength": 164e6, "tensile_strength": 30.4e6}
"""Pa; of the rock of [Rojek 2003, 5.1] in the virtual laboratory (calibration/results/uniaxial.md)."""
QUANTITIES = {"mean_cutting_force": ("mean cutting force", "N/m"), "peak_cutting_force": ("peak cutting force", "N/m"),
              "mean_thrust_force": ("mean thrust force", "N/m"),
              "specific_energy": ("specific energy", "J/m3"), "chip_size": ("median chip, by mass", "m")}


def stages(run):
    """Snapshots of the new tooth and at equal steps of its mass loss. -> [(share of the mass lost, snapshot)]."""
    volumes = run.model["tool_volumes"]
    lost = np.array([volumes[~run.snapshot(k)["alive"]].sum() for k in range(len(run.times))]) / volumes.sum()
    chosen = [int(np.argmin(abs(lost - share * lost[-1]))) for share in np.linspace(0, 1, SHAPES)]
    return [(float(lost[k]), run.snapshot(k)) for k in chosen]


def outline(run, shot):
    """(k, 2) m: outline of the worn tooth, its lowest point at y = 0."""
    polygon = max(tool_loops(run, shot), key=len)
    return polygon - [0.0, polygon[:, 1].min()]


def effective_rake(polygon, depth):
    """Angle (rad) from the vertical of the line from the tip to the front at the rock's surface; negative: blunt."""
    following = np.roll(polygon, -1, axis=0)
    through = (polygon[:, 1] < depth) != (following[:, 1] < depth)
    (x, y), (x_next, y_next) = polygon[through].T, following[through].T
    front = np.max(x + (depth - y) / (y_next - y) * (x_next - x))
    return math.atan2(polygon[np.argmin(polygon[:, 1]), 0] - front, depth)


def chip_size(run):
    """Equivalent diameter (m) of a chip's area, the median by mass over all chips of more than one disc."""
    shot, model = run.snapshot(-1), run.model
    loose = shapes.chips(len(model["rock_radii"]), model["bonds"], shot["status"] == 0, model["rock_fixed"])
    number = pieces(len(model["rock_radii"]), model["bonds"], shot["status"] == 0)
    count = np.bincount(number[loose], minlength=number.max() + 1)
    area = np.bincount(number[loose], math.pi * model["rock_radii"][loose]**2, number.max() + 1)
    area = np.sort(area[count > 1])
    if not len(area):
        return math.nan
    return 2 * math.sqrt(area[np.searchsorted(np.cumsum(area), 0.5 * area.sum())] / math.pi)


def measure(run):
    """{quantity: value} of one cut."""
    return {**{name: run.result(name) for name in QUANTITIES if name != "chip_size"}, "chip_size": chip_size(run)}


def theory(rake, run):
    """{name: cutting force, N/m} of the classical theories, nan beyond their range."""
    friction = math.atan(run.parameter("tool_mu", 0.3))
    cohesion, internal = cutting_theory.mohr_coulomb(**STRENGTH)
    depth = run.parameter("depth_of_cut", math.nan)
    found = {"Evans": lambda: cutting_theory.evans(
                 tensile_strength=STRENGTH["tensile_strength"], depth=depth, rake=rake),
             "Nishimatsu": lambda: cutting_theory.nishimatsu(
                 shear_strength=cohesion, internal_friction=internal, depth=depth, rake=rake,
                 friction_angle=friction)[0]}

    def value(force):
        try:
            return force()
        except ValueError:
            return math.nan
    return {name: value(force) for name, force in found.items()}


def figure(teeth, rows):
    """Outlines, and the four quantities against the mass lost."""
    drawn, panels = plots.canvas(12, 7.2, 2, 3)
    colours = matplotlib.colormaps["plasma"](np.linspace(0, 0.85, len(teeth)))
    for tooth, colour in zip(teeth, colours):
        closed = np.vstack([tooth["outline"], tooth["outline"][:1]])
        panels[0].plot(*plots.MM * closed.T, color=colour, label=f"{100 * tooth['lost']:.1f} % lost")
    low = plots.MM * min(tooth["outline"][:, 1].min() for tooth in teeth)
    tip = plots.MM * teeth[0]["outline"][np.argmin(teeth[0]["outline"][:, 1]), 0]
    plots.frame(panels[0], (tip - 32, tip + 12, low - 2, low + 32), "outlines")
    panels[0].legend(fontsize=8)
    for axes, (name, (label, unit)) in zip(panels[1:], QUANTITIES.items()):
        shown, factor, _ = page.SHOWN.get(unit, (unit, 1.0, 0.0))
        lost = 100 * np.array([row["lost"] for row in rows])
        values = factor * np.array([row[name] for row in rows])
        axes.plot(lost, values, "o", color="#c8a15a", markersize=4, label="one packing")
        middle, error = np.array([scatter(values[lost == x]) for x in np.unique(lost)]).T
        axes.errorbar(np.unique(lost), middle, error, color="#444444", capsize=3, label="mean, its standard error")
        axes.set(title=label, xlabel="mass lost / %", ylabel=shown, ylim=(0, 1.1 * np.nanmax(values)))
        if name == "peak_cutting_force":
            # The theories give the force at which a chip breaks off; for a blunt tool they are far from the peak.
            for theory_name, style in (("Evans", "s:"), ("Nishimatsu", "^--")):
                axes.plot([100 * tooth["lost"] for tooth in teeth], [factor * tooth[theory_name] for tooth in teeth],
                          style, markersize=4, color="#2c6e91", label=theory_name)
            highest = np.nanmax([values.max(), *(factor * tooth[theory_name] for tooth in teeth
                                                 for theory_name in ("Evans", "Nishimatsu"))])
            axes.set(yscale="log", ylim=(0.3 * np.nanmin(values), 2 * highest))
            axes.legend(fontsize=8)
    return drawn


def main(worn_run, folder, seeds=SEEDS, **where):
    """Run the missing cuts, and write tables, figure and page. where: options of Runs."""
    folder, run = Path(folder), RunFolder(worn_run)
    require({"tool_volumes", "rock_radii"} <= set(run.model) and len(run.times), "WORN_RUN", str(worn_run),
            "the folder of a cut in the plane with a tool of particles")
    (folder / "outlines").mkdir(parents=True, exist_ok=True)
    law = [parameter.name for parameter in BOND_LAWS[run.parameters["bond_law"]].parameters]
    common = {name: run.parameters[name] for name in [*SAME, *law] if name in run.parameters}
    teeth = []
    for number, (lost, shot) in enumerate(stages(run)):
        polygon = outline(run, shot)
        path = folder / "outlines" / f"tooth_{number}.csv"
        np.savetxt(path, polygon, delimiter=",", header="x [m],y [m]", comments="")
        rake = effective_rake(polygon, run.parameter("depth_of_cut", math.nan))
        teeth.append({"lost": lost, "outline": polygon, "path": path, "rake": rake, **theory(rake, run)})
    with Runs(folder, keep=True, **where) as runs:
        cuts = {(number, seed): runs.start(f"tooth_{number}-{seed}", "yade_scripts/tooth_cycles.py", seed=seed,
                                           outline=tooth["path"], **common, **CUT)
                for seed in seeds for number, tooth in enumerate(teeth)}
        rows = [{"tooth": number, "lost": teeth[number]["lost"], "seed": seed, **measure(future.result())}
                for (number, seed), future in cuts.items()]
    write_csv(folder / "sharp_and_worn.csv", rows)
    write_page(folder, teeth, rows)


def write_page(folder, teeth, rows):
    """sharp_and_worn.png, the table as sharp_and_worn.md, and report.html with both."""
    with matplotlib.rc_context(plots.STYLE):
        drawn = figure(teeth, rows)
        path = folder / "sharp_and_worn.png"
        drawn.savefig(path)
    cuts = []
    for number, tooth in enumerate(teeth):
        of = [row for row in rows if row["tooth"] == number]
        cells = []
        for name, (_, unit) in QUANTITIES.items():
            middle, error = scatter(np.array([row[name] for row in of]))
            cells.append(f"{page.quantity(middle, unit)} ± {page.percent(error, middle)}")
        cuts.append([f"{100 * tooth['lost']:.1f} % lost", f"{math.degrees(tooth['rake']):.0f}°", *cells,
                     *(page.quantity(tooth[name], "N/m") for name in ("Evans", "Nishimatsu"))])
    header = ("tooth", "effective rake", *(label for label, _ in QUANTITIES.values()), "Evans", "Nishimatsu")
    section = page.Section(
        "Effect of wear on the cut", "The same specimens cut at the same depth by the new tooth and by its worn "
        "outlines; ± is the standard error of the mean over packings. The theories give the force at which a chip "
        "breaks off, to be compared with the peak. They take the rake of the line from the lowest point to the front "
        "at the rock's surface, and the strengths of the virtual laboratory.",
        [page.image(path), page.table(cuts, header)])
    text = page.document("sharp and worn", f"{len(rows)} cuts", [section])
    (folder / "report.html").write_text(text, encoding="utf-8")
    generated.write_page(folder / "sharp_and_worn.md", generated.table(header, cuts))
    generated.record(path, folder / "sharp_and_worn.csv", folder / "report.html")


if __name__ == "__main__":
    matplotlib.use("Agg")
    where, words = placement(sys.argv[1:])
    if len(words) < 2:
        sys.exit(__doc__)
    try:
        main(words[0], words[1], tuple(map(int, words[2:])) or SEEDS, **where)
    except (OSError, ParameterError, RunFailed) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1 if isinstance(error, RunFailed) else 2)

"""Two discs and one bond, [Rojek 2003, section 4.6]: forces over displacements for each bond law, a figure a
programme."""
from rockwear.report import palette
from rockwear.report.folder import read_history
from rockwear.report.page import Section, beside, table
from rockwear.report.plots import canvas, save

COMMON = [("tension", "Fn", "un"), ("tension, unloading and reloading", "Fn", "un"), ("compression", "Fn", "un"),
          ("shear", "Ft", "ut"), ("shear with compression", "Fn", "un"), ("shear with compression", "Ft", "ut")]
SHEAR_WITH_TENSION = [("shear with tension", "Fn", "ut"), ("shear with tension", "Ft", "ut")]
FIGURES = {"plastic": COMMON + SHEAR_WITH_TENSION,
           "damage": COMMON + [("shear with tension", "Ft", "ut"), ("shear with tension", "Fn", "un")],
           "brittle": COMMON + SHEAR_WITH_TENSION, "padova": COMMON + SHEAR_WITH_TENSION}
"""Law: what its figures show, (programme, force, displacement), in the order of [Rojek 2003] where that has them."""
FIRST_FIGURE = {"plastic": 11, "damage": 19}
TITLES = {"plastic": "Elasto-plastic bond with linear softening [Rojek 2003, 4.6.1]",
          "damage": "Elastic damage with linear softening [Rojek 2003, 4.6.2]",
          "brittle": "Elastic perfectly brittle bond",
          "padova": "Elasto-plastic bond with nonlinear softening (Padova)"}
AXES = {"un": "opening / µm", "ut": "tangential displacement / µm", "Fn": "normal force / kN",
        "Ft": "tangential force / kN"}
MOST_POINTS = 60


def two_disc(law):
    """The view of one law: a run's section of it."""
    def view(run):
        figures = [save(run, name, figure(run, law, *shown, title)) for name, shown, title in labels(law)
                   if path_of(run, law, shown[0]).exists()]
        words = "Points: YADE. Line: the law's own drive at the same displacements."
        return Section(TITLES[law], words, [beside(*figures)]) if figures else None
    return view


def two_disc_results(run):
    """Section of how well YADE and the laws agree."""
    if not any(path_of(run, law, "tension").exists() for law in FIGURES):
        return None
    rows = [(name, f"{entry['value']:.6g}", entry["unit"]) for name, entry in run.summary.get("results", {}).items()]
    return Section("Results", "Deviations of YADE's forces from the law's own drive, as parts of the tensile strength, "
                   "and what [Rojek 2003] says of its figures.", [table(rows, ("quantity", "value", "unit"))])


def labels(law):
    """[(name of the figure's file, what it shows, its title)] of a law."""
    for place, shown in enumerate(FIGURES[law]):
        number = f"4.{FIRST_FIGURE[law] + place}" if law in FIRST_FIGURE else f"{law} {place + 1}"
        source = f"[Rojek 2003, fig. {number}]" if law in FIRST_FIGURE else number
        yield f"figure_{number.replace('.', '_').replace(' ', '_')}", shown, f"{source}: {shown[0]}"


def path_of(run, law, programme):
    """File of the path that a law was driven along."""
    return run.path / "paths" / f"{law}_{programme.replace(', ', '_').replace(' ', '_')}.csv"


def figure(run, law, programme, force, displacement, title):
    """YADE's points over the line of the law."""
    columns, _ = read_history(path_of(run, law, programme))
    drawn, (axes,) = canvas(4.6, 3.3)
    u, every = 1e6 * columns[displacement], max(1, len(columns["un"]) // MOST_POINTS)
    axes.plot(u, 1e-3 * columns[f"{force} drive"], color=palette.EXACT, linewidth=2, label="law")
    axes.plot(u[::every], 1e-3 * columns[force][::every], ".", color=palette.POINTS, markersize=4, label="YADE")
    axes.set(xlabel=AXES[displacement], ylabel=AXES[force])
    axes.set_title(title, fontsize=9)
    axes.legend()
    return drawn

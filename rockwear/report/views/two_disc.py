"""Two discs and one bond, [Rojek 2003, section 4.6]: forces over displacements for each bond law, a figure a
programme."""
from rockwear.report import palette
from rockwear.report.folder import read_history
from rockwear.report.page import Section, beside, heading, table
from rockwear.report.plots import canvas, save

COMMON = [("tension", "Fn", "un"), ("tension, unloading and reloading", "Fn", "un"), ("compression", "Fn", "un"),
          ("shear", "Ft", "ut"), ("shear with compression", "Fn", "un"), ("shear with compression", "Ft", "ut")]
SHOWN = COMMON + [("shear with tension", "Fn", "ut"), ("shear with tension", "Ft", "ut")]
"""What the figures of a law show, (programme, force, displacement)."""
IN_THE_ORDER_OF_ITS_SOURCE = {
    "damage": COMMON + [("shear with tension", "Ft", "ut"), ("shear with tension", "Fn", "un")]}
FIRST_FIGURE = {"plastic": 11, "damage": 19}
"""Number of a law's first figure in [Rojek 2003, chapter 4]."""
TITLES = {"plastic": "Elasto-plastic bond with linear softening [Rojek 2003, 4.6.1]",
          "damage": "Elastic damage with linear softening [Rojek 2003, 4.6.2]",
          "brittle": "Elastic perfectly brittle bond",
          "padova": "Elasto-plastic bond with nonlinear softening (Padova)"}
AXES = {"un": "opening / µm", "ut": "tangential displacement / µm", "Fn": "normal force / kN",
        "Ft": "tangential force / kN"}
MOST_POINTS = 60


def two_disc(run):
    """Section of all laws that were driven."""
    laws = driven(run)
    if not laws:
        return None
    pieces = [piece for law in laws
              for piece in (heading(TITLES.get(law, f"Bond law {law}")), beside(*drawn(run, law)))]
    return Section("Forces over displacements", "Points: YADE. Line: the law's own drive at the same displacements.",
                   pieces)


def two_disc_results(run):
    """Section of how well YADE and the laws agree."""
    if not driven(run):
        return None
    rows = [(name, f"{entry['value']:.6g}", entry["unit"]) for name, entry in run.summary.get("results", {}).items()]
    return Section("Results", "Deviations of YADE's forces from the law's own drive, as parts of the tensile strength, "
                   "and what [Rojek 2003] says of its figures.", [table(rows, ("quantity", "value", "unit"))])


def driven(run):
    """Names of the laws whose paths are there, those of the source first."""
    found = {path.name.removesuffix("_tension.csv") for path in (run.path / "paths").glob("*_tension.csv")
             if not path.name.endswith("_with_tension.csv")}
    return sorted(found, key=lambda law: (list(TITLES).index(law) if law in TITLES else len(TITLES), law))


def drawn(run, law):
    """Pictures of a law, as html."""
    for place, shown in enumerate(IN_THE_ORDER_OF_ITS_SOURCE.get(law, SHOWN)):
        number = f"4.{FIRST_FIGURE[law] + place}" if law in FIRST_FIGURE else f"{law} {place + 1}"
        title = f"[Rojek 2003, fig. {number}]" if law in FIRST_FIGURE else number
        if path_of(run, law, shown[0]).exists():
            yield save(run, f"figure_{number.replace('.', '_').replace(' ', '_')}",
                       figure(run, law, *shown, f"{title}: {shown[0]}"))


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

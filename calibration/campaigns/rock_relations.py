"""Dimensionless relations of bonded packings [Rojek 2014, 5.2]: cases, numbers, tables, figure; run by
calibration.campaigns.rock_laws.

    E/kn, nu, UCS/σb, σt/σb  over  kt/kn, bonding gap, porosity, c/σb, G_f kn/(σb² r)

σb, c: tensile strength and cohesion of the bonds, Pa, in the source the forces Rn and Rt over a bond's area; G_f: their
fracture energy, J/m2; r: mean radius of the discs, m. Gap and porosity set the coordination number, that of bonds.
"""
import numpy as np

from calibration import generated
from calibration.fitting.relations import STRENGTHS, VARIED, chosen, strengths
from rockwear.report import palette, plots

RADIUS = 1.25e-3
"""m, mean radius of the discs."""
POROSITY, GAP = 0.12, 1e-4
"""Of the scenes; the gap in m. Packings of all porosities from 0.04 to 0.16 come to rest."""
SEEDS = 1, 2, 3
STAYS = 0.01
"""Change of a quantity over what is varied, over it, below which it counts as none."""
QUANTITIES = {"coordination": "coordination", "E_over_kn": "E/kn", "nu": "ν", "UCS_over_bond_tension": "UCS/σb",
              "tension_over_bond_tension": "σt/σb", "UCS_over_tension": "UCS/σt"}
"""{name in relations.json: label}."""
KNOBS = {"kt_over_kn": "kt/kn", "cohesion_over_tension": "c/σb", "length_over_radius": "G_f kn/(σb² r)",
         "porosity": "porosity", "bonding_gap": "bonding gap"}
"""{one of VARIED: label}."""
COLUMNS = {"stiffness of the bonds": "kt/kn", "packing": "coordination number of bonds",
           "strength of the bonds": "c/σb", "fracture energy of the bonds": "G_f kn/(σb² r)"}
"""{title: label of the axis} of the figure."""
PUBLISHED = {"kt_over_kn": (0.2, {"E_over_kn": 0.9, "nu": 0.18, "UCS_over_tension": 60 / 7}),
             "cohesion_over_tension": (1.0, {"UCS_over_bond_tension": 0.85, "tension_over_bond_tension": 0.099,
                                             "UCS_over_tension": 60 / 7})}
"""{one of KNOBS: (value, {quantity: value})} that [Rojek 2014, 5.2] expects of its numbers: 18 GPa, 0.18, 60 and 7 MPa
of kn = 20 GN/m, kt = 4 GN/m and brittle bonds of Rn = Rt = 0.1 MN/m, 71 MPa over the 1.415 mm of a bond here."""


def cases(rock):
    """{case: parameters}: of `rock` one quantity varied at a time, kt/kn at each gap; and cases in which two of them
    differ, which tell whether their effects multiply."""
    kn, tension = rock["kn"], rock["bond_tension"]
    one = {f"kt/kn = {ratio:g}, gap {gap:g} mm": dict(kt=ratio * kn, bonding_gap=1e-3 * gap)
           for gap in (0.0, 0.1, 0.2) for ratio in (0.05, 0.2, 0.4, 0.7, 1.0)}
    one |= {f"porosity {porosity:g}": dict(porosity=porosity) for porosity in (0.05, 0.08, 0.14, 0.16)}
    one |= {f"c/σb = {shear:g}": dict(bond_cohesion=shear * tension) for shear in (0.5, 1.0, 2.0, 5.0, 10.0)}
    one |= {f"G_f = {energy:g} J/m²": dict(bond_fracture_energy=energy) for energy in (3.5, 10.0, 100.0, 300.0)}
    two = {f"c/σb = {shear:g}, kt/kn = {ratio:g}": dict(bond_cohesion=shear * tension, kt=ratio * kn)
           for shear, ratio in ((1.0, 0.2), (5.0, 0.2), (1.0, 0.7))}
    two |= {f"c/σb = {shear:g}, G_f = {energy:g} J/m²": dict(bond_cohesion=shear * tension, bond_fracture_energy=energy)
            for shear, energy in ((1.0, 3.5), (1.0, 100.0), (5.0, 100.0))}
    return {case: {"bonding_gap": GAP, "porosity": POROSITY, **rock, **changes}
            for case, changes in {**one, **two}.items()}


def varied(rock):
    """{one of VARIED: value} of the parameters of a case, in four digits."""
    found = (rock["kt"] / rock["kn"], rock["bonding_gap"], rock["porosity"],
             rock["bond_cohesion"] / rock["bond_tension"],
             rock["bond_fracture_energy"] * rock["kn"] / (rock["bond_tension"]**2 * RADIUS))
    return {name: float(f"{value:.4g}") for name, value in zip(VARIED, found)}


def scaled(rock, values):
    """{name in relations.json: (packings,)} of {quantity: (packings,) values} that a case of this rock has."""
    return {"coordination": values["coordination"], "E_over_kn": values["E"] / rock["kn"], "nu": values["nu"],
            **{name: values[quantity] / rock["bond_tension"] for name, quantity in zip(STRENGTHS, ("UCS", "tension"))},
            "UCS_over_tension": values["ratio"]}


def numbers(rock, found):
    """The content of relations.json. rock: that of `cases`; found: {case: {quantity: (packings,) values}}, of two
    packings or more."""
    known = cases(rock)
    return {"defaults": varied({"bonding_gap": GAP, "porosity": POROSITY, **rock}),
            "rows": [{"case": case, **varied(known[case]), "packings": len(values["E"]),
                      **{name: [float(np.mean(of_packings)), float(np.std(of_packings, ddof=1))]
                         for name, of_packings in scaled(known[case], values).items()}}
                     for case, values in found.items()]}


def series(rock, found, over):
    """[(value, {name: (packings,)})] over one of VARIED, rising, the others at their defaults."""
    known, defaults = cases(rock), varied({"bonding_gap": GAP, "porosity": POROSITY, **rock})
    at = {case: varied(known[case]) for case in found}
    return sorted(((at[case][over], scaled(known[case], values)) for case, values in found.items()
                   if all(at[case][name] == defaults[name] for name in VARIED if name != over)), key=lambda one: one[0])


def slopes(x, values):
    """(packings,) exponents: slopes of straight lines through log values (k, packings) over log x (k,)."""
    return np.polyfit(np.log(x), np.log(values), 1)[0]


def tables(rock, found):
    """Lines of Markdown: how strongly each quantity depends on what is varied, and whether effects multiply."""
    rows = []
    for over, label in KNOBS.items():
        x, ours = zip(*series(rock, found, over))
        count = min(len(values["nu"]) for values in ours)
        cells = []
        for name in QUANTITIES:
            of_packings = np.array([values[name][:count] for values in ours])
            ends = [f"{one.mean():.3g} ± {one.std(ddof=1):.1g}" for one in of_packings[[0, -1]]]
            changes = abs(np.diff(of_packings[[0, -1]].mean(axis=1)))[0] > STAYS * of_packings[0].mean()
            cells.append(" → ".join(ends) if changes else ends[0])
            if changes and x[0] > 0 and name != "nu":
                cells[-1] += f"; {generated.mean_cell(slopes(x, of_packings))}"
        rows.append([label, f"{x[0]:.3g} → {x[-1]:.3g}", *cells])
    data = numbers(rock, found)
    at = [(row, {name: row[name] for name in VARIED if row[name] != data["defaults"][name]}) for row in data["rows"]]
    both = [[row["case"], *(f"{row[name][0] / one:.3g}" for name, one in zip(STRENGTHS, strengths(data, **changes)))]
            for row, changes in at if len(changes) == 2 and "bonding_gap" not in changes]
    return ["From the least to the greatest value of what is varied, mean ± standard deviation of packings; then the "
            "exponent, the slope of its logarithm over that of what is varied through all values, mean ± standard "
            f"error. One number: changes of less than {100 * STAYS:g} %.", "",
            *generated.table(["varied", "from → to", *QUANTITIES.values()], rows),
            "Two changes at once: what was measured over the product of the single effects.", "",
            *generated.table(["", "UCS", "σt"], both)]


def draw(data):
    """Relations [Rojek 2014, 5.2]: a row each quantity, a column what is varied; bars are the standard deviation of
    packings."""
    names = {name: label for name, label in QUANTITIES.items() if name != "coordination"}
    figure, axes = plots.canvas(12, 12, len(names), 4, sharey="row", sharex="col")
    panels = np.reshape(axes, (len(names), 4))
    gaps = sorted({row["bonding_gap"] for row in data["rows"]})
    lines = [(0, "kt_over_kn", chosen(data, "kt_over_kn", bonding_gap=gap), f"gap {1e3 * gap:g} mm") for gap in gaps]
    lines += [(1, "coordination", chosen(data, "porosity"), "porosity 0.05 to 0.16"),
              (1, "coordination", chosen(data, "bonding_gap"), "gap 0 to 0.2 mm"),
              *((column, over, chosen(data, over), "other bonds") for column, over in
                ((2, "cohesion_over_tension"), (3, "length_over_radius")))]
    colours = dict(zip((line[3] for line in lines), palette.OTHER_LINES))
    for column, over, found, label in lines:
        x = found[over][:, 0] if over == "coordination" else found[over]
        for name, axis in zip(names, panels[:, column]):
            mean, deviation = found[name].T
            axis.errorbar(x, mean, deviation, fmt="o-", color=colours[label], capsize=3, label=label)
    for column, over in ((0, "kt_over_kn"), (2, "cohesion_over_tension")):
        value, expected = PUBLISHED[over]
        for name, axis in zip(names, panels[:, column]):
            if name in expected:
                axis.plot(value, expected[name], "*", markersize=12, color=palette.PUBLISHED, zorder=5,
                          label="expected by the source")
    for column, (title, label) in enumerate(COLUMNS.items()):
        panels[0, column].set_title(title)
        panels[-1, column].set_xlabel(label)
    for axis, label in zip(panels[:, 0], names.values()):
        axis.set_ylabel(label)
        axis.set_ylim(0, 1.05 * axis.get_ylim()[1])
    for axis, ticks in zip(panels[-1, 2:], ((0.5, 1, 2, 5, 10), (1, 3, 10, 30, 100))):
        axis.set_xscale("log")
        axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.minorticks_off()
    figure.align_ylabels(panels[:, 0])
    for axis in panels[0, :2]:
        axis.legend()
    return figure

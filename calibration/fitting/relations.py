"""Dimensionless relations of a bonded packing [Rojek 2014, 5.2], measured once (calibration.campaigns.rock_laws) and
kept in relations.json, with the scatter of packings; inverted for the first guess of a fit.

What was varied, one at a time: VARIED; bare discs of 1 to 1.5 mm, `cohesive` bonds, friction 0.8. σb, c, G_f: tensile
strength (Pa), cohesion (Pa) and fracture energy (J/m2) of the bonds, r: mean radius (m).
"""
import json
from pathlib import Path

import numpy as np

DATA = Path(__file__).with_name("relations.json")
VARIED = "kt_over_kn", "bonding_gap", "porosity", "cohesion_over_tension", "length_over_radius"
"""bonding_gap: m; cohesion_over_tension: c/σb; length_over_radius: G_f kn/(σb² r), all but 1 for brittle bonds."""
STRENGTHS = "UCS_over_bond_tension", "tension_over_bond_tension"
BOND_AREA = 0.566
"""Of a bond over the diameter of a disc and a metre, at the defaults of the data: σb times it is the force of a brittle
bond over the diameter."""
ROUNDS = 30
"""Of the inversion for the strengths: each leaves less than half of the error."""


def chosen(data, over, **others):
    """{name: (k,), or (k, 2) mean and standard deviation of packings} over one of VARIED, rising.

    data: the content of relations.json; others: {varied: value} where the default of the data does not count.
    """
    at = {**data["defaults"], **others}
    rows = sorted((row for row in data["rows"] if all(row[name] == at[name] for name in VARIED if name != over)),
                  key=lambda row: row[over])
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def stored():
    """The content of relations.json."""
    return json.loads(DATA.read_text(encoding="utf-8"))


def elastic_guess(*, youngs_modulus, poissons_ratio):
    """(kn in N/m, kt/kn) for which a packing has this E (Pa) and nu; kt/kn at the end of the data beyond it."""
    found = chosen(stored(), "kt_over_kn")
    ratios, nu, stiffness = found["kt_over_kn"], found["nu"][:, 0], found["E_over_kn"][:, 0]
    ratio = float(np.interp(-poissons_ratio, -nu, ratios))
    return youngs_modulus / float(np.interp(ratio, ratios, stiffness)), ratio


def strengths(data, **at):
    """(UCS/σb, σt/σb) of bare discs at these values of VARIED but the bonding gap, the others at the defaults of data.

    Effects multiply: UCS/σb = u₀ Π u_i(x_i)/u₀, each u_i along one of VARIED, u₀ at the defaults, where all meet.
    Logarithms are interpolated over logarithms; beyond the data their ends count.
    """
    base = next(row for row in data["rows"] if all(row[name] == data["defaults"][name] for name in VARIED))
    total = np.log([base[name][0] for name in STRENGTHS])
    for over, value in at.items():
        found = chosen(data, over)
        places = np.log([value, data["defaults"][over]])
        total += [np.subtract(*np.interp(places, np.log(found[over]), np.log(found[name][:, 0]))) for name in STRENGTHS]
    return tuple(np.exp(total).tolist())


def strength_guess(data, *, ucs, tensile_strength, energy, least, **at):
    """(σb in Pa, c/σb) for which bare discs have this UCS and tensile strength (Pa); at: as `strengths` has it.

    energy: kn G_f/r in Pa², which is kept: length_over_radius = energy/σb², but no less than `least`. c/σb is at an
    end of the data where UCS over tensile strength is beyond them; the tensile strength is met there, too.
    """
    ratios = chosen(data, "cohesion_over_tension")["cohesion_over_tension"]
    tension = tensile_strength
    for _ in range(ROUNDS):
        length = max(energy / tension**2, least)
        compressive, tensile = np.log([strengths(data, cohesion_over_tension=ratio, length_over_radius=length, **at)
                                       for ratio in ratios]).T
        rise = np.maximum.accumulate(compressive - tensile)
        shear = np.interp(np.log(ucs / tensile_strength), rise, np.log(ratios))
        tension = tensile_strength / float(np.exp(np.interp(shear, np.log(ratios), tensile)))
    return tension, float(np.exp(shear))

"""Tables of the campaign of grains: table 2 of [Bahaaddini 2018], and the trends of its parameter study."""
import math
from collections import defaultdict

import numpy as np

from calibration import generated
from calibration.campaigns.trends import trend, verdict
from calibration.campaigns.uniaxial_tables import shown
from calibration.laboratory import envelope_figure
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.strength_envelope import Estimate, HoekBrown, MohrCoulomb, hoek_brown, mohr_coulomb
from rockwear.report import published

PROPERTIES = {"ucs": ("UCS, MPa", 1e-6, 0.05, True), "youngs_modulus": ("E, GPa", 1e-9, 0.05, True),
              "poissons_ratio": ("ν", 1, 0.02, False), "tensile_strength": ("σt, MPa", 1e-6, 0.1, True),
              "cohesion": ("c, MPa", 1e-6, 0.1, True), "friction_angle": ("φ, °", 1, 2, False),
              "hoek_brown_m": ("m_i", 1, 3, False), "hoek_brown_sigma_ci": ("σ_ci, MPa", 1e-6, 0.1, True)}
"""{property of a rock file: (name, factor to its unit, how far ours may be from the laboratory, whether that is
relative)}."""
UNITS = {"poissons_ratio": "", "friction_angle": "deg", "hoek_brown_m": ""}
"""Those that are not in Pa."""

STRENGTHS = {"ucs": "UCS", "confined": "strength at 5 MPa", "tensile_strength": "tensile strength"}
ELASTIC = {"youngs_modulus": "E", "poissons_ratio": "ν"}
STATED = {
    "grain edge, mm": {"ucs": "rises", "confined": "rises", "tensile_strength": "rises", "youngs_modulus": "rises",
                       "poissons_ratio": "falls"},
    "block normal stiffness, GN/m": {"ucs": "unchanged", "youngs_modulus": "rises", "poissons_ratio": "falls"},
    "block tangential stiffness, GN/m": {"ucs": "unchanged", "youngs_modulus": "rises", "poissons_ratio": "falls"},
    "cohesion, MPa": {"ucs": "rises", "confined": "rises"},
    "friction": {"ucs": "rises", "confined": "rises"}}
"""{parameter: {property: its trend}} in [Bahaaddini 2018, abstract, 4.1]. (The copy at hand ends at the contacts'
normal stiffness: what the source says of their stiffness and tensile strength is not known here.)"""
CONFINED = {"cohesion, MPa": ("less", -1), "friction": ("more", 1)}
"""What counts less or more under confinement [Bahaaddini 2018, abstract]."""
RESULTS = ("peak_stress", "peak_strain", "youngs_modulus", "poissons_ratio", "failed", "tensile_cracks", "shear_cracks")


def row_of(parameter, value, test, seed, run):
    """{column: value} of a run in SI, with the relative residual of energy."""
    balance = run.summary["balances"]["energy"]
    return {"parameter": parameter, "value": value, "test": test, "seed": seed,
            **{name: run.result(name) for name in RESULTS},
            "energy_missing": balance["residual"] / balance["platen_work"]}


def properties(rows):
    """{seed: {property: value}} of packings of one rock, as far as their tests exist. rows: as of row_of."""
    by_seed, found = defaultdict(dict), {}
    for row in rows:
        by_seed[row["seed"]][row["test"]] = row
    for seed, tests in sorted(by_seed.items()):
        own = found[seed] = {}
        if "compression" in tests:
            row = tests["compression"]
            own.update(ucs=row["peak_stress"], youngs_modulus=row["youngs_modulus"],
                       poissons_ratio=row["poissons_ratio"])
        if "tension" in tests:
            own["tensile_strength"] = tests["tension"]["peak_stress"]
        if "5 MPa" in tests:
            own["confined"] = tests["5 MPa"]["peak_stress"]
        confined = {1e6 * float(test.split()[0]): row["peak_stress"] for test, row in tests.items() if "MPa" in test}
        if "ucs" in own and len(confined) > 1:
            own.update(envelope({0.0: own["ucs"], **confined}))
            own["triaxial"] = sorted({0.0: own["ucs"], **confined}.items())
    return found


def envelope(strengths):
    """{property: value} of the envelopes through {sigma3: sigma1}, Pa; without tension, as in [Bahaaddini 2018]."""
    sigma3, sigma1 = np.array(sorted(strengths.items())).T
    line = mohr_coulomb(sigma3, sigma1)
    found = {"cohesion": line.cohesion.value, "friction_angle": line.friction_angle.value}
    try:
        curve = hoek_brown(sigma3, sigma1)
    except ParameterError:
        return found
    return {**found, "hoek_brown_m": curve.m_i.value, "hoek_brown_sigma_ci": curve.sigma_ci.value}


def measured(rows):
    """{property: (n,) values, one a packing} of the calibrated rock; "triaxial" (n, points, 2) of complete packings."""
    values = defaultdict(list)
    for own in properties([row for row in rows if not row["parameter"]]).values():
        for name, value in own.items():
            values[name].append(value)
    if "triaxial" in values:
        most = max(map(len, values["triaxial"]))
        values["triaxial"] = [points for points in values["triaxial"] if len(points) == most]
    return {name: np.array(found) for name, found in values.items()}


def as_measured(found):
    """The same as a rock file has it; properties of one packing have no scatter and are left out."""
    entries = {}
    for name in (*PROPERTIES, "triaxial"):
        values = found.get(name, ())
        if len(values) < 2:
            continue
        mean, deviation = values.mean(axis=0), values.std(axis=0, ddof=1)
        if name == "triaxial":
            shown_mean, shown_deviation = np.round(mean[1:], -3).tolist(), np.round(deviation[1:, 1], -3).tolist()
        else:
            shown_mean, shown_deviation = float(f"{mean:.4g}"), float(f"{deviation:.2g}")
        entries[name] = {"mean": shown_mean, "standard_deviation": shown_deviation, "packings": len(values),
                         "unit": UNITS.get(name, "Pa")}
    return entries


def points(rows, parameter, calibrated):
    """{property: {value of the parameter: [its values by packing]}}, with the calibrated rock on the same packings."""
    varied = [row for row in rows if row["parameter"] == parameter]
    seeds = {row["seed"] for row in varied}
    varied += [{**row, "value": calibrated} for row in rows if not row["parameter"] and row["seed"] in seeds]
    found = defaultdict(lambda: defaultdict(list))
    for value in sorted({row["value"] for row in varied}):
        for own in properties([row for row in varied if row["value"] == value]).values():
            for name in (*STRENGTHS, *ELASTIC):
                if name in own and own[name] > 0:
                    found[name][value].append(own[name])
    return found


def trend_of(values):
    """Trend of {value of a parameter: [values of a property]}, None of less than three points."""
    pairs = [(x, y) for x, ys in values.items() for y in ys]
    return trend(*np.array(pairs).T) if len(pairs) > 2 and len(values) > 1 else None


def trends(points_of):
    """[[cells]] of the table of trends. points_of: {parameter: as of `points`}."""
    lines = []
    for parameter, by_property in points_of.items():
        laws = {name: trend_of(values) for name, values in by_property.items()}
        for name, words in {**STRENGTHS, **ELASTIC}.items():
            law = laws.get(name)
            if law is None:
                continue
            stated = STATED.get(parameter, {}).get(name)
            lines.append([parameter, words, stated or "–", law.word, f"{100 * law.change:+.0f} %",
                          f"{law.exponent:+.2f}", verdict(stated, law.word) if stated else "–"])
        free, held = laws.get("ucs"), laws.get("confined")
        if parameter in CONFINED and free and held:
            word, sign = CONFINED[parameter]
            counts = "more" if abs(held.exponent) > abs(free.exponent) else "less"
            lines.append([parameter, "counts under confinement", word, counts, "–",
                          f"{abs(held.exponent) - abs(free.exponent):+.2f}",
                          "agrees" if counts == word else "disagrees"])
    return lines


def table_2_value(name, of):
    """A property in [Bahaaddini 2018, table 2], in the units of PROPERTIES. of: "laboratory" or "model"."""
    return PROPERTIES[name][1] * published.value(f"v-table2-{name}-{of}")


def table_2_fits(of):
    """(MohrCoulomb, HoekBrown) of [Bahaaddini 2018, table 2]. of: "laboratory" or "model"."""
    names = ("cohesion", "friction_angle"), ("hoek_brown_m", "hoek_brown_sigma_ci")
    return tuple(kind(*(Estimate(published.value(f"v-table2-{name}-{of}"), math.nan) for name in pair), math.nan)
                 for kind, pair in zip((MohrCoulomb, HoekBrown), names))


def tested(rows):
    """(points, tension) of the calibrated rock, as envelope_figure.of_packings takes them."""
    own = [row for row in rows if not row["parameter"]]
    points = [{"sigma3": 1e6 * float(row["test"].split()[0]) if "MPa" in row["test"] else 0.0, "seed": row["seed"],
               "peak_stress": row["peak_stress"]} for row in own if row["test"] != "tension"]
    return points, [row["peak_stress"] for row in own if row["test"] == "tension"]


def reached(name, value):
    """Whether the value, in the units of PROPERTIES, is within the tolerance."""
    _, _, tolerance, relative = PROPERTIES[name]
    target = table_2_value(name, "laboratory")
    return abs(value - target) <= tolerance * (target if relative else 1)


def table_2(found):
    """Lines of table 2 of [Bahaaddini 2018] with ours: mean ± standard deviation."""
    lines = []
    for name, (words, scale, tolerance, relative) in PROPERTIES.items():
        target, model = (table_2_value(name, of) for of in ("laboratory", "model"))
        values = scale * np.asarray(found.get(name, ()))
        digits = 3 if name == "poissons_ratio" else 2 if target < 10 else 1
        allowed = f"± {100 * tolerance:g} %" if relative else f"± {tolerance:g}"
        verdicts = ("yes" if reached(name, values.mean()) else "no") if len(values) else "–"
        lines.append([words, f"{target:g} ({allowed})", f"{model:g}", shown(values.tolist(), 1, digits),
                      str(len(values)), verdicts])
    return generated.table(["property", "laboratory (ours may be off by)", "model of [Bahaaddini 2018]", "ours",
                            "packings", "reached"], lines)


def confined(rows):
    """Lines of a table of the calibrated rock over confinement: strength, strain, cracks, and whether stress fell."""
    own = [row for row in rows if not row["parameter"]]
    lines = []
    for test in dict.fromkeys(row["test"] for row in own):
        of = [row for row in own if row["test"] == test]
        shear = [100 * row["shear_cracks"] / max(1, row["tensile_cracks"] + row["shear_cracks"]) for row in of]
        lines.append([test, str(len(of)), shown([row["peak_stress"] for row in of], 1e-6),
                      shown([row["peak_strain"] for row in of], 100, 2), f"{sum(row['failed'] for row in of)}",
                      shown([row["tensile_cracks"] + row["shear_cracks"] for row in of], 1, 0), shown(shear, 1, 0),
                      f"{100 * max((abs(row['energy_missing']) for row in of), default=math.nan):.1f}"])
    return generated.table(["test", "packings", "strength, MPa", "strain there, %", "failed", "cracks in the end",
                            "of them shear, %", "largest energy residual, %"], lines)


def beside_the_laboratory(rows):
    """Lines of a table of the calibrated rock's strengths beside the laboratory's line and curve."""
    means = envelope_figure.of_packings("", "", *tested(rows)).means
    compared = [(fit.sigma1, envelope_figure.off(means, fit.sigma1)) for fit in table_2_fits("laboratory")]
    lines = []
    for k, mean in enumerate(mean for mean in means if mean.sigma3 >= 0):
        cells = [[f"{1e-6 * float(sigma1(mean.sigma3)):.1f}", "{1:+.1f} ± {2:.1f} %".format(*found[k])]
                 for sigma1, found in compared]
        lines.append([f"{1e-6 * mean.sigma3:g}", f"{1e-6 * mean.sigma1:.1f} ± "
                      f"{1e-6 * mean.deviation / math.sqrt(mean.tests):.1f}", mean.tests, *cells[0], *cells[1]])
    return generated.table(["σ3, MPa", "σ1 ± standard error, MPa", "packings", "laboratory's line, MPa", "ours off it",
                            "laboratory's curve, MPa", "ours off it"], lines)


def page(rows, found, points_of):
    """Lines of the generated page."""
    lines = []
    if found:
        lines = ["### Table 2 of [Bahaaddini 2018]", "", *table_2(found),
                 "### The calibrated rock over confinement", "", *confined(rows),
                 "### Strengths beside the laboratory's line and curve", "", *beside_the_laboratory(rows)]
    table = trends(points_of)
    if table:
        agree = [line[-1] for line in table if line[-1] != "–"]
        counts = ", ".join(f"{agree.count(word)} {word}" for word in ("agrees", "disagrees", "unclear"))
        lines += ["### Trends of the parameter study", "", f"Of {len(agree)} stated trends: {counts}.", "",
                  *generated.table(["parameter", "property", "[Bahaaddini 2018]", "ours", "change over the range",
                                    "exponent", "verdict"], table)]
    return lines

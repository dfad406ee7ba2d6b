"""Wear coefficient k from laboratory wear tests [Rojek 2003, 6.6]: force, area, distance, depth and temperature.

    python3 -m calibration.fitting.wear_fit [FILE.csv] [--wear_law pressure] [--out DIR] ...       (--help)

One row for each test: a block pressed with a known force slides over a known distance. Between the cells are commas,
semicolons or tabs. The header has `name [unit]`:

    steel          MET71, MET91, or any name where `hardness` is given
    force          N, kN            area      mm2, cm2, m2         or pressure (Pa, MPa), which has precedence
    distance       m, km            depth     um, mm, m            worn over that distance
    temperature    degC, K          hardness  HB, Pa, MPa          has precedence over steel and temperature
    friction       N, kN            measured friction force; default: mu times the force

`<name> error [unit]` is the standard error of a column, where known. Default FILE: the four tests of [Rojek 2003, 6.6],
with half the last digit as errors. Its depths are differences: 2.0 - 0.4 mm and 6 - 4 mm, over 100 m. Its published k
take 10 MPa for 1 HB (option --brinell 1e7); the results of eqs. 6.14 and 6.15 are interchanged there.
"""
import argparse
import json
import sys
from pathlib import Path

import numpy as np

from calibration import generated
from calibration.command import Parser
from rockwear.kernels.archard import BRINELL, KELVIN, MET71, MET91
from rockwear.kernels.checks import ParameterError, finite, positive, require
from rockwear.kernels.files import read_cells
from rockwear.kernels.wear_fitting import LaboratoryTest
from rockwear.kernels.wear_laws import NORMAL, WEAR_LAWS, PowerLaw, SumOfModes
from rockwear.report import plots

EXAMPLE = Path(__file__).with_name("wear_tests.csv")
STEELS = {"MET71": MET71, "MET91": MET91}
UNITS = {"force": {"N": 1, "kN": 1e3}, "friction": {"N": 1, "kN": 1e3}, "area": {"mm2": 1e-6, "cm2": 1e-4, "m2": 1},
         "pressure": {"Pa": 1, "MPa": 1e6}, "distance": {"m": 1, "km": 1e3}, "depth": {"um": 1e-6, "mm": 1e-3, "m": 1},
         "temperature": {"degC": 1, "K": 1}, "hardness": {"HB": BRINELL, "Pa": 1, "MPa": 1e6}}
SI = {"force": "N", "friction": "N", "area": "m2", "pressure": "Pa", "distance": "m", "depth": "m", "hardness": "Pa"}
NEEDED = "distance", "depth"
LINEAR = "pressure", "dissipation"
"""Laws whose k is Archard's."""


def read(file, brinell=BRINELL):
    """[{name: SI value}] of a CSV file's rows; errors as "name error", and the row's "line". Raises ParameterError with
    column and line."""
    found = read_cells(file, "file")
    require(len(found) > 1, "file", str(file), "a CSV file with a header and at least one row")
    (_, heads), *rows = found
    names = [_name_and_unit(head)[0] for head in heads]
    twice = next((name for name in names if names.count(name) > 1), None)
    require(not twice, f"column {twice}", names.count(twice), "there once")
    for line, row in rows:
        require(len(row) == len(heads), f"line {line}", f"{len(row)} cells", f"as long as the header, {len(heads)}")
    return [_row(dict(zip(heads, row)), line, brinell) for line, row in rows]


def _name_and_unit(head):
    name, _, unit = (word.strip(" ]") for word in head.partition("["))
    return name, unit


def _row(row, line, brinell):
    found = {"line": line}
    for head, text in row.items():
        name, unit = _name_and_unit(head)
        if name == "steel":
            found["steel"] = text.strip()
            continue
        quantity = name.removesuffix(" error")
        if quantity not in UNITS or unit not in UNITS[quantity]:
            options = ", ".join(UNITS.get(quantity, UNITS))
            raise ParameterError(f"column {name}", unit, f"one of {options}{'' if quantity in UNITS else ', or steel'}")
        if not text.strip():
            continue
        value = finite(f"{name} in line {line}", text, unit)
        require(value >= 0 or not name.endswith(" error"), f"{name} in line {line}", value, "at least 0", unit)
        require(value > 0 or name != quantity or quantity == "temperature", f"{name} in line {line}", value,
                "greater than 0", unit)
        if unit == "degC" and quantity == name:
            value += KELVIN
        found[name] = value * (brinell if unit == "HB" else UNITS[quantity][unit])
    return found


def tests_of(rows, *, mu, brinell=BRINELL):
    """LaboratoryTest of rows of `read`. Raises ParameterError for what is missing, not positive, or outside a table,
    and for pressures at which steel would flow."""
    columns = [_measured(row, mu, brinell) for row in rows]
    return LaboratoryTest(**{name: np.array([column[name] for column in columns]) for name in columns[0]})


def _measured(row, mu, brinell):
    """{field of LaboratoryTest: value} of a row."""
    for name in NEEDED:
        require(name in row, name, "nothing", "given in every row")
    of = {name: _relative_error(row, name) for name in SI}
    if "pressure" in row:
        pressure = row["pressure"]
    else:
        for name in ("force", "area"):
            require(name in row, name, "nothing", "given in every row without a pressure")
        pressure = row["force"] / row["area"]
    # A pressure without an error of its own, beside an area, is the quotient as well.
    quotient = {"force", "area"} <= row.keys() and not of["pressure"]
    pressure_error = np.hypot(of["force"], of["area"]) if quotient else of["pressure"]
    friction, friction_error = mu * pressure, pressure_error
    if "friction" in row:
        require("force" in row, "force", "nothing", "given with friction")
        friction = pressure * row["friction"] / row["force"]
        # Force over area times friction over force: the force is in neither.
        friction_error = np.hypot(of["friction"], of["area"]) if quotient else np.hypot.reduce(
            [of["friction"], of["force"], of["pressure"]])
    hardness, hardness_error = _hardness(row, of, brinell)
    require(pressure < hardness, f"{'pressure' if 'pressure' in row else 'force / area'} in line {row['line']}",
            pressure, f"less than the hardness, {hardness:.4g}, where steel would flow", "Pa")
    return {"pressure": pressure, "friction_stress": friction, "distance": row["distance"], "depth": row["depth"],
            "hardness": hardness, "rate_error": np.hypot(of["depth"], of["distance"]), "pressure_error": pressure_error,
            "friction_error": friction_error, "hardness_error": hardness_error}


def _relative_error(row, name):
    """Stated standard error of a quantity of the row over its value, 0 where none is stated."""
    error = row.get(f"{name} error", 0.0)
    require(name in row or not error, f"{name} error", error, f"given with {name}", SI[name])
    return error / positive(name, row[name], SI[name]) if name in row else 0.0


def _hardness(row, errors, brinell):
    """(hardness in Pa, its relative standard error)."""
    if "hardness" in row:
        return row["hardness"], errors["hardness"]
    steel, kelvin = row.get("steel", ""), row.get("temperature")
    require(steel in STEELS, f"steel in line {row['line']}", steel, f"one of {', '.join(STEELS)}, or hardness given")
    require(kelvin is not None, "temperature", "nothing", "given in every row without a hardness")
    table = STEELS[steel]
    low, high = table.limits
    require(low <= kelvin <= high, f"temperature in line {row['line']}", kelvin,
            f"inside the table of {steel}, {low:g} to {high:g}", "K")
    error = row.get("temperature error", 0.0)
    ends = table(np.clip([kelvin - error, kelvin + error], low, high))
    value = table(kelvin) * brinell / BRINELL
    return value, abs(ends[1] - ends[0]) / 2 / table(kelvin)


def fit(rows, *, law="pressure", mu=0.3, exponent=1.0, modes="", brinell=BRINELL):
    """Fit the law to each steel's rows. -> {steel: {"tests", "error", "law", "fit", "rows": [(k, error)], "exponent"}}.

    exponent: of the power law; None fits it too. Each row is also fitted alone unless the law has several modes. Raises
    ParameterError, for an exponent or modes that the law does not have too.
    """
    require(law == "power" or exponent == 1, "exponent", exponent or "fit", f"left out with wear_law = {law}")
    require(law == "modes" or not modes, "modes", modes, f"left out with wear_law = {law}")
    values = {"wear_coefficient": 1.0, "wear_exponent": exponent or 1.0, "wear_modes": modes}
    start = WEAR_LAWS[law].from_values(values, mu)
    found = {}
    for steel in dict.fromkeys(row.get("steel", "") for row in rows):
        own = [row for row in rows if row.get("steel", "") == steel]
        tests = tests_of(own, mu=mu, brinell=brinell)
        if law == "power" and exponent is None:
            fitted, result, n = start.fit_exponent(tests)
        else:
            (fitted, result), n = start.fit(tests), None
        single = []
        if not isinstance(fitted, SumOfModes):
            alone = PowerLaw(k=1.0, mu=mu, exponent=fitted.exponent) if law == "power" else start
            for row in own:
                _, one = alone.fit(tests_of([row], mu=mu, brinell=brinell))
                single.append((float(one.k[0]), float(one.uncertainty[0])))
        found[steel] = {"error": fitted.error_of(tests), "tests": tests, "law": fitted, "fit": result, "rows": single,
                        "exponent": n}
    return found


def plus_minus(value, uncertainty):
    """A value with its standard error."""
    if not np.isfinite(uncertainty):
        return f"{value:.5g} (no error known: give errors, or several rows that differ)"
    part = f" ({100 * uncertainty / value:.1f} %)" if value else ""
    return f"{value:.5g} +- {uncertainty:.2g}{part}"


def lines(found):
    """The printed results, line by line."""
    for steel, one in found.items():
        for number, (k, u) in enumerate(one["rows"], 1):
            p, s, w = (one["tests"].pressure[number - 1] / 1e6, one["tests"].distance[number - 1],
                       one["tests"].depth[number - 1] * 1e3)
            yield f"{steel:6s} test {number}: {p:5.1f} MPa, {s:g} m, {w:g} mm    k = {plus_minus(k, u)}"
        for number, (k, u) in enumerate(zip(one["fit"].k, one["fit"].uncertainty), 1):
            mode = f" mode {number}" if len(one["fit"].k) > 1 else ""
            yield f"{steel:6s} all tests{mode}: k = {plus_minus(k, u)}"
        if one["exponent"]:
            yield f"{steel:6s} exponent n = {plus_minus(*one['exponent'])}"
        errors = one["error"]
        if len(errors) > len(one["fit"].k) and np.isnan(one["fit"].uncertainty).all():
            yield f"{steel:6s} the scatter of the tests is 0, and no error is known"
        if np.any(errors > 0) and not np.all(errors > 0):
            yield f"{steel:6s} some tests state no error: equal weights, the error of k is their scatter"
        if one["law"].name in LINEAR and one["fit"].k[0] > 1:
            yield (f"{steel:6s} k above 1 is more than what is pressed together can lose: see whether the units of the "
                   "columns are right")
        if one["fit"].misfit > 4:
            yield (f"{steel:6s} the tests differ by {one['fit'].misfit**0.5:.1f} times their stated errors: "
                   "k is not one number here, or the errors are larger")


def draw(found, file):
    """Worn depth over sliding distance against the law's load, p / H or p_T / (mu H): tests with their errors, and the
    law as a line or points."""
    figure, (axes,) = plots.canvas(6.5, 4.5)
    for number, (steel, one) in enumerate(found.items()):
        tests, colour, several = one["tests"], f"C{number}", isinstance(one["law"], SumOfModes)
        single = one["law"].modes[0] if several else one["law"]
        load, error = single.load(tests)
        x, rate = 1e3 * load, 1e6 * tests.depth / tests.distance
        axes.errorbar(x, rate, yerr=rate * tests.rate_error, xerr=x * error, fmt="o", color=colour, capsize=3, zorder=3)
        if several:
            words = ", ".join(f"{k:.3g}" for k in one["fit"].k)
            axes.plot(x, 1e6 * one["fit"].depth / tests.distance, "x", color=colour,
                      label=f"{steel or 'tests'}: k = {words}")
            continue
        grid = np.linspace(0, 1.15 * x.max(), 100)
        law = one["law"]
        axes.plot(grid, 1e6 * law.k * (1e-3 * grid)**law.exponent, color=colour,
                  label=f"{steel or 'tests'}: k = {plus_minus(law.k, one['fit'].uncertainty[0])}")
    load = "pressure / hardness" if single.force == NORMAL else "friction stress / (µ hardness)"
    axes.set(xlabel=f"{load}, 1e-3", ylabel="worn depth / distance, µm/m", xlim=(0, None), ylim=(0, None))
    axes.legend(frameon=False)
    figure.savefig(file, dpi=110)


def main(words=None):
    """Command line. -> exit code: 0, or 2 for invalid input, reported in one line."""
    parser = Parser(prog="python3 -m calibration.fitting.wear_fit", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default=str(EXAMPLE),
                        help="CSV file; default: the four tests of [Rojek 2003, 6.6]")
    parser.add_argument("--wear_law", default="pressure", choices=sorted(WEAR_LAWS))
    parser.add_argument("--mu", default="0.3", help="friction coefficient, where friction is not measured")
    parser.add_argument("--exponent", default="1", help="n of the power law, or fit")
    parser.add_argument("--modes", default="", help="of several modes: k/exponent/share, ... (k is fitted)")
    parser.add_argument("--brinell", default=str(BRINELL), help="Pa per HB")
    parser.add_argument("--out", default="", help="folder for wear_fit.json and wear_fit.png")
    given = parser.parse_args(words)
    try:
        brinell, mu = positive("brinell", given.brinell, "Pa"), positive("mu", given.mu)
        exponent = None if given.exponent == "fit" else positive("exponent", given.exponent)
        found = fit(read(given.file, brinell), law=given.wear_law, mu=mu, exponent=exponent, modes=given.modes,
                    brinell=brinell)
        if given.out:
            _write(Path(given.out), found, given.wear_law)
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print("\n".join(lines(found)))
    return 0


def _write(folder, found, law):
    try:
        folder.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"wear_law": law, "steels": {steel: {
            "k": one["fit"].k.tolist(), "uncertainty": _plain(one["fit"].uncertainty),
            "exponent": one["exponent"] and _plain(one["exponent"]),
            "k_of_each_test": [k for k, _ in one["rows"]],
            "uncertainty_of_each_test": _plain(u for _, u in one["rows"])}
            for steel, one in found.items()}}, indent=1)
        (folder / "wear_fit.json").write_text(text, encoding="utf-8")
        draw(found, folder / "wear_fit.png")
        generated.record(folder / "wear_fit.json", folder / "wear_fit.png")
    except OSError as error:
        raise ParameterError("out", str(folder), f"a folder that can be written ({error.strerror})") from None


def _plain(values):
    """Numbers for JSON, null for what is not known."""
    return [float(value) if np.isfinite(value) else None for value in values]


if __name__ == "__main__":
    sys.exit(main())

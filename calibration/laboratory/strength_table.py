"""Tables of a laboratory's confined strengths, the one format that envelopes and fits read."""
import re

from rockwear.kernels.checks import ParameterError, finite, require
from rockwear.kernels.files import read_cells
from rockwear.kernels.parameter import zero_or
from rockwear.model.rock_file import PROPERTIES

UNITS = {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9}
"""{unit in the header of a column, in any case: Pa}."""
OTHER_UNITS = {"psi", "ksi", "mpsi", "psf", "ksf", "tsf", "bar", "mbar", "kbar", "hpa", "atm", "torr", "kgf", "kg",
               "lbf", "n", "kn", "mn", "mm2", "cm2", "m2", "mm²", "cm²", "m²"}
"""Words of units that stresses come in elsewhere."""
LEAST = 1e3
"""Pa, the least stress but 0: what is less has another unit than its header says."""
CONFINEMENT = zero_or(LEAST, 1e9)
"""A rule: Pa, the confinement of a test."""


def read(path, parameter):
    """[(sigma3, sigma1)], Pa, row by row, of a CSV file with the columns sigma3 and sigma1, between commas, semicolons
    or tabs, in Pa or in the unit of UNITS that the header names: sigma3_MPa, sigma1 (kPa), sigma1_peak_GPa.

    Further columns are allowed. Raises ParameterError, of the name `parameter`.
    """
    rows = read_cells(path, parameter)
    heads = [head.strip() for head in rows[0][1]] if rows else []
    columns = []
    for number in (3, 1):
        fitting = [k for k, head in enumerate(heads) if re.match(rf"(sigma|σ)[ _]?{number}(?![0-9])", head.lower())]
        require(len(fitting) == 1, parameter, str(path), f"a table with one column sigma{number}")
        columns.append((fitting[0], _factor(path, parameter, heads[fitting[0]])))
    found = [tuple(_stress(path, parameter, line, row, *column) for column in columns) for line, row in rows[1:]]
    require(found, parameter, str(path), "a table with at least one row")
    return found


def _factor(path, parameter, head):
    """Pa, of the unit in a header."""
    words = re.split(r"[\s_()\[\]{}/,.:^*-]+", head.lower())
    named = [word for word in words if word in UNITS]
    right = len(named) <= 1 and not OTHER_UNITS.intersection(words) and (named or not re.search(r"[(\[{/]", head))
    require(right, parameter, f"{path}, column {head}", "a stress in Pa, kPa, MPa or GPa")
    return UNITS[named[0]] if named else 1.0


def _stress(path, parameter, line, row, place, factor):
    try:
        value = factor * finite(parameter, row[place])
        require(value == 0 or LEAST <= value <= PROPERTIES["triaxial"][2], parameter, value, "a stress")
    except (IndexError, ParameterError):
        raise ParameterError(parameter, str(path), f"a table of stresses in Pa, unlike line {line}: "
                             f"{','.join(row)[:60]} (a column in MPa says so in its header)") from None
    return value

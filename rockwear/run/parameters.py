"""Parameters of a run from the command line or a yade-batch table."""
import difflib
import os
import sys
from pathlib import Path

from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import flag


def read(parameters, arguments):
    """{name: checked value} of all parameters, from `--name value` arguments or the row that yade-batch gives.

    A flag may stand without a value. Raises ParameterError for an unknown name, a missing value or a broken rule.
    """
    known = {parameter.name: parameter for parameter in parameters}
    given = {**_table_row(), **_arguments(arguments, known)}
    for name, value in given.items():
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            raise ParameterError(name, value, f"a parameter of this scene{f'; did you mean {close[0]}' if close else ''}"
                                              " (--help lists them)")
    return {name: parameter.check(given.get(name, parameter.default)) for name, parameter in known.items()}


def _arguments(arguments, known):
    given, rest = {}, list(arguments)
    while rest:
        word = rest.pop(0)
        if not word.startswith("--") or len(word) < 3:
            raise ParameterError("argument", word, "of the form --name value")
        name, equals, value = word[2:].partition("=")
        name = name.replace("-", "_")
        if not equals:
            if rest and not rest[0].startswith("--"):
                value = rest.pop(0)
            elif name in known and known[name].rule is flag:
                value = "true"
            else:
                raise ParameterError(name, "", "given a value")
        given[name] = value
    return given


def _batch_table():
    """(number of the line that this run is for, {number: {column: text}}) of yade-batch; None outside a batch."""
    place = os.environ.get("YADE_BATCH")
    if not place:
        return None
    from yade.utils import TableParamReader
    table, line = place.rsplit(":", 1)
    # YADE's reader takes the last character of every line for its break.
    require(Path(table).read_bytes().endswith(b"\n"), "table", table, "closed by a line break")
    return int(line), TableParamReader(table).paramDict()


def _table_row():
    """{column: text} of the row's parameters; nothing outside a batch."""
    line, rows = _batch_table() or (0, {0: {}})
    return {name: value for name, value in rows[line].items() if not name.startswith("!") and name != "description"}


def batch_row():
    """A folder's name for the row that yade-batch runs, with its line where rows share a name; None outside a batch."""
    found = _batch_table()
    if found is None:
        return None
    line, rows = found
    names = {number: _folder_name(row.get("description") or f"row {number}") for number, row in rows.items()}
    return names[line] if list(names.values()).count(names[line]) == 1 else f"{names[line]}_line_{line}"


def _folder_name(words):
    return "".join(c if c.isalnum() or c in "-_.=," else "_" for c in words)


def describe(parameters, file=sys.stdout):
    """Print every parameter with its default, unit, meaning and source."""
    for parameter in parameters:
        print(f"  --{parameter.name} {parameter.default} [{parameter.unit or '-'}]\n"
              f"        {parameter.meaning} ({parameter.source})", file=file)

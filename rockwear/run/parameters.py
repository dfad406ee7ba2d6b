"""Parameters of a run from the command line or a yade-batch table."""
import argparse
import difflib
import os
import sys
from dataclasses import replace
from pathlib import Path

from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.parameter import RENAMED_IN, Above, Group, file, flag, text, unmet, words

RENAMED = {
    "acceleration": ("wear_acceleration",), "speed_up": ("time_scale",),
    "coarsening": ("grading_factor", "scale_factor"), "coarseness": ("scale_factor",), "law": ("bond_law",),
    "steel": ("hardness_table",), "root": ("shank",), "root_temperature": ("shank_temperature",),
    "arm": ("cutter_radius",), "spin": ("angular_velocity",),
}
"""{old name of a parameter: the new names, of which a scene has one}."""

LEFT_OUT = "-"
"""A cell of a table whose row does not give the parameter of the column."""


def flat(groups):
    """{name: Parameter} of Groups and single Parameters; where two have one name, the first."""
    found = {}
    for group in groups:
        for parameter in (group if isinstance(group, Group) else (group,)):
            found.setdefault(parameter.name, parameter)
    return found


def read(groups, arguments):
    """{name: checked value} of all parameters, from `--name value` arguments and the row that yade-batch gives.

    groups: Groups, or single Parameters. A flag may stand without a value. Raises ParameterError for an unknown name, a
    missing value, a broken rule, and for a parameter that is given but not used with the others. What presets give
    replaces the declared defaults, in the order of their declaration; what is given beside them goes before.
    """
    known = flat(groups)
    given = {**_table_row(), **_arguments(groups, arguments)}
    for name, value in given.items():
        if name not in known:
            raise ParameterError(name, value, _advice(name, known))
    known = _with_presets(known, given)
    values = _checked(known, given)
    for name in given:
        reason = unmet(known[name], values, known)
        if reason:
            raise ParameterError(name, _word(values[name]), f"left out with {reason} = {_word(values[reason])}",
                                 known[name].unit)
    return values


def _checked(known, given):
    return {name: parameter.check(given.get(name, parameter.default)) for name, parameter in known.items()}


def _with_presets(known, given):
    """{name: Parameter} with the defaults that presets give."""
    for preset in [name for name, parameter in known.items() if parameter.presets]:
        values = _checked(known, given)
        found = known[preset].presets.defaults(values[preset], values) if values[preset] else {}
        known = {name: replace(one, default=found.get(name, one.default)) for name, one in known.items()}
    return known


def defaults(groups, values):
    """{name: default} of all parameters; what presets give goes before what is declared. values: all, as of `read`."""
    known = flat(groups)
    found = {name: parameter.default for name, parameter in known.items()}
    for name, parameter in known.items():
        if parameter.presets and values[name]:
            found.update(parameter.presets.defaults(values[name], values))
    return found


def warnings(groups, values):
    """Lines on what in given values is not to be relied on; values: all, as of `read`."""
    return [line for name, parameter in flat(groups).items() if parameter.presets and values[name]
            for line in parameter.presets.warnings(values[name], values)]


def _advice(name, known):
    """The rule that an unknown name breaks."""
    renamed = [new for new in RENAMED.get(name, ()) if new in known]
    if renamed:
        return f"given as {renamed[0]}, its name since {RENAMED_IN}"
    close = difflib.get_close_matches(name, known, n=1)
    return f"a known parameter{f'; did you mean {close[0]}' if close else ''} (--help lists them)"


def _word(value):
    if isinstance(value, float):
        return f"{value:g}"
    return str(value).lower() if isinstance(value, bool) else str(value) or "none"


def _condition(values):
    return f"above {values.low:g}" if isinstance(values, Above) else f"= {' or '.join(map(_word, values))}"


def _formatter(prog):
    return argparse.HelpFormatter(prog, max_help_position=26, width=118)


def _parser(groups, usage=None):
    """argparse's parser: one argument group a title, nothing converted, defaults left to `read`."""
    parser = argparse.ArgumentParser(
        usage=usage or f"yade -n -x {sys.argv[0]} [--name value ...]", add_help=False, allow_abbrev=False,
        exit_on_error=False, argument_default=argparse.SUPPRESS, formatter_class=_formatter)
    sections, known, declared = {}, flat(groups), flat(groups)
    for group in groups:
        title = group.title if isinstance(group, Group) else "parameters"
        section = sections[title] = sections.get(title) or parser.add_argument_group(title)
        for parameter in (group if isinstance(group, Group) else (group,)):
            if known.pop(parameter.name, None) is None:
                continue
            values = {"nargs": "?", "const": "true"} if parameter.rule is flag else {}
            section.add_argument(f"--{parameter.name}", metavar=_metavar(parameter),
                                 help=_description(parameter, declared).replace("%", "%%"), **values)
    return parser


def _metavar(parameter):
    options = getattr(parameter.rule, "options", ("true", "false") if parameter.rule is flag else ())
    if parameter.presets and parameter.presets.metavar:
        return parameter.presets.metavar
    named = {text: "TEXT", words: "TEXT", file: "FILE"}
    return "|".join(options) or parameter.unit or named.get(parameter.rule, "NUMBER")


def _description(parameter, declared):
    """Meaning, default with its unit, source, and the condition of use among the declared parameters."""
    default = f"{_word(parameter.default)} {parameter.unit}".strip()
    used = "; ".join(f"{name} {_condition(values)}" for name, values in (parameter.when or {}).items()
                     if name in declared)
    return f"{parameter.meaning} (default {default}; {parameter.source}{f'; only with {used}' if used else ''})"


def _arguments(groups, arguments):
    """{name: text} of the command line."""
    try:
        found, others = _parser(groups).parse_known_args(_joined(arguments))
    except argparse.ArgumentError as error:
        name = error.argument_name.lstrip("-")
        known = flat(groups).get(name)
        raise ParameterError(name, "nothing", "given a value", known.unit if known else "") from None
    unknown = dict(word[2:].partition("=")[::2] for word in others)
    return {**vars(found), **unknown}


def _joined(words):
    """`--name value` as `--name=value`, which argparse reads whatever the value begins with; - in names as _."""
    joined = []
    for word in words:
        name, equals, value = word.partition("=")
        if word.startswith("--") and len(name) > 2:
            joined.append(f"--{name[2:].replace('-', '_')}{equals}{value}")
        elif joined and "=" not in joined[-1]:
            joined[-1] += f"={word}"
        else:
            raise ParameterError("argument", word, "of the form --name value")
    return joined


def _batch_table():
    """(number of the line that this run is for, {number: {column: text}}) of yade-batch; None outside a batch."""
    place = os.environ.get("YADE_BATCH")
    if not place:
        return None
    table, line = place.rsplit(":", 1)
    return int(line), read_table(table)


def read_table(path):
    """{number of the line: {column: text}} of a yade-batch table, by YADE's own reader. Raises ParameterError."""
    from yade.utils import TableParamReader
    try:
        written = Path(path).read_text(encoding="utf-8")
        # YADE's reader drops the last character of every line, also where it is no line break, and cells beyond the
        # header. It takes a byte order mark for a part of the first name, and the last of two columns of one name.
        require(not written.startswith("\ufeff"), "table", str(path), "without a byte order mark")
        require(written.endswith("\n"), "table", str(path), "closed by a line break")
        lines = [cells for line in written.split("\n") if (cells := line.partition("#")[0].split())]
        require(len(set(map(len, lines))) == 1, "table", str(path),
                "a table of yade-batch: a header, then a cell a column in every row")
        names = [name.removesuffix("!") for name in lines[0]]
        twice = next((name for name in names if names.count(name) > 1), None)
        require(twice is None, "table", f"{path}, column {twice}", "there once")
        return TableParamReader(str(path)).paramDict()
    except OSError as error:
        raise ParameterError("table", str(path), f"a file that can be read ({error.strerror})") from None
    except UnicodeError:
        raise ParameterError("table", str(path), "a table of yade-batch, in UTF-8") from None


def of_row(row):
    """{parameter: text} of a table's row {column: text}: no description, no `!column`, no cell that is LEFT_OUT."""
    return {name: value for name, value in row.items()
            if not name.startswith("!") and name != "description" and value != LEFT_OUT}


def _table_row():
    """{parameter: text} of the row that yade-batch gives; nothing outside a batch."""
    line, rows = _batch_table() or (0, {0: {}})
    return of_row(rows[line])


def batch_row():
    """A folder's name for the row that yade-batch runs, with its line where rows share a name; None outside a batch."""
    found = _batch_table()
    if found is None:
        return None
    line, rows = found
    names = row_names(rows)
    return names[line] if list(names.values()).count(names[line]) == 1 else f"{names[line]}_line_{line}"


def row_names(rows):
    """{number of the line: name for a folder} of a table's rows."""
    return {number: file_name(row.get("description") or f"row {number}") for number, row in rows.items()}


def file_name(words):
    """The words as the name of a file or folder: what may not be in one as _, and so dots alone, which name others."""
    name = "".join(c if c.isalnum() or c in "-_.=," else "_" for c in words)
    return name if name.strip(".") else "_"


def describe(groups, usage=None):
    """Print every parameter by group, with its unit, meaning, default, source and condition of use.

    usage: how the program is called, where it is no YADE script.
    """
    print(_parser(groups, usage).format_help(), end="")

"""The rows of a table, checked by the script that is to run them, in one process of YADE.

    yade -n -x rows.py TABLE SCRIPT FILE

Writes as JSON {"rows": [{"name", "given": {parameter: text}, "values": {parameter: value}, "threads",
"environment": {name: text}}, ...], "units": {parameter: unit}}, or {"error": the line that says what is wrong}.
"""
import ast
import json
import os
import runpy
import sys
from pathlib import Path

from rockwear.kernels.checks import ParameterError, require
from rockwear.run import main as run
from rockwear.run import parameters

THREADS = "!OMP_NUM_THREADS", "!THREADS"
"""Columns of yade-batch that set the threads of a row. Other columns with ! set an environment variable, but for"""
OF_THE_BATCH = "!EXEC", "!SCRIPT", "!AFFINITY", "!COUNT"


def declared_by(script):
    """Parameter groups that a script passes to rockwear.run.main. Raises ParameterError for any other script."""
    try:
        tree = ast.parse(Path(script).read_text(encoding="utf-8"))
    except (OSError, ValueError, SyntaxError) as error:
        raise ParameterError("script", script, f"a Python script that can be read ({error})") from None
    modules = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    require(run.__name__ in modules, "script", script, f"one that runs its scene by {run.__name__}")
    found, sys.argv = [], [script]
    run.main = lambda name, groups, make_scene: found.extend([*groups, run.COMMON])
    runpy.run_path(script)
    return found


def checked(line, row, name, groups):
    """One row, checked. Raises ParameterError."""
    given = parameters.of_row(row)
    others = {column[1:]: text for column, text in row.items() if column.startswith("!") and column not in THREADS}
    threads = next((row[column] for column in THREADS if row.get(column, "-") != "-"), "1")
    try:
        require(threads.isdecimal() and int(threads) > 0, "threads", threads, "a number of at least 1")
        for column in OF_THE_BATCH:
            require(column not in row, column, row.get(column), "left out: only yade-batch knows it")
        values = parameters.read(groups, [f"--{key}={value}" for key, value in given.items()])
    except ParameterError as error:
        raise ParameterError(error.name, error.value, f"{error.rule} (line {line})", error.unit) from None
    return {"name": name, "given": {key: value for key, value in given.items() if key not in ("out", "resume")},
            "threads": int(threads), "environment": others, "out": given.get("out", ""),
            "values": {key: value for key, value in values.items() if key not in run.NOT_IDENTITY}}


def read(table, script):
    """What is written. Raises ParameterError."""
    rows, groups = parameters.read_table(table), declared_by(script)
    require(rows, "table", table, "a table with at least one row")
    names, lines = parameters.row_names(rows), {}
    for line, name in names.items():
        require(name not in lines, "description", rows[line]["description"],
                f"different from that of line {lines.get(name)}: rows of one name share a folder")
        lines[name] = line
    return {"rows": [checked(line, rows[line], names[line], groups) for line in sorted(rows)],
            "units": {name: parameter.unit for name, parameter in parameters.flat(groups).items()}}


table, script, file = sys.argv[-3:]
try:
    found = read(table, script)
except ParameterError as error:
    found = {"error": str(error)}
Path(file).write_text(json.dumps(found), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

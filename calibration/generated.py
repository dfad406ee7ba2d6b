"""Generated files: tables in Markdown, and the command, commit, versions, date and machine of each.

A page of tables begins with a line on its origin (`write_page`), and names the versions of the runs that it is from
where they are of another version. Files of other kinds are entered in provenance.json of
their folder (`record`). Conclusions stand in files that no command writes (calibration/results/*.md).
"""
import datetime
import json
import math
import os
import platform
import re
import shlex
import subprocess
import sys
import textwrap
from collections import Counter
from contextlib import suppress
from pathlib import Path

import numpy as np
from scipy.special import stdtrit

from rockwear import __version__

ROOT = Path(__file__).resolve().parents[1]
MANIFEST = "provenance.json"
WIDTH = 120
"""Of lines of text in Markdown."""
CHANCE = 0.05
"""How often chance alone may make a change that counts as significant."""


def _said(*command):
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL,
                              check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return done.stdout.strip()


def machine(cpuinfo="/proc/cpuinfo"):
    """{what is known of "processor", "cores" that this process may use, "load" over the last minute}."""
    found = {}
    with suppress(OSError):
        model = re.search(r"^model name\s*:\s*(.+)$", Path(cpuinfo).read_text(encoding="utf-8"), re.MULTILINE)
        found.update({"processor": " ".join(model[1].split())} if model else {})
    with suppress(OSError, AttributeError):
        found["cores"] = len(os.sched_getaffinity(0))
    with suppress(OSError, AttributeError):
        found["load"] = round(os.getloadavg()[0], 1)
    return found


def machine_words(found):
    """What `machine` found, in some words."""
    cores = found.get("cores")
    said = [found.get("processor"), cores and f"{cores} core{'s' if cores > 1 else ''}",
            f"load {found['load']} at the start" if "load" in found else None]
    return ", ".join(filter(None, said)) or "unknown machine"


ORIGIN = {"command": shlex.join([Path(sys.orig_argv[0]).name, *sys.orig_argv[1:]]),
          "commit": _said("git", "describe", "--always", "--dirty", "--exclude=*"),
          "date": datetime.date.today().isoformat(),
          "versions": {"rockwear": __version__, "yade": _said("yade", "--version").rpartition(" ")[2],
                       "python": platform.python_version(), "numpy": np.__version__},
          "machine": machine()}
"""Of this process. Taken at the import, because code and load are those of the start."""


def table(columns, rows):
    """Lines of a table in Markdown, an empty one at its end. columns: the header's cells."""
    return [f"| {' | '.join(columns)} |", "|---" * len(columns) + "|",
            *(f"| {' | '.join(map(str, row))} |" for row in rows), ""]


def mean_and_error(values):
    """(mean, standard error) of (n,) numbers; nan for the error of one, and for both of none."""
    values = np.asarray(values, float)
    return (values.mean() if len(values) else math.nan,
            values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan)


def mean_cell(values):
    """A table's cell: the mean of (n,) numbers, with its standard error where there are several."""
    mean, error = mean_and_error(values)
    return f"{mean:.3g}" + (f" ± {error:.2g}" if math.isfinite(error) else "")


def significant(change, error, packings):
    """Whether chance makes as large a mean change, of this standard error over so many packings, in fewer than CHANCE
    of the cases (Student's t). Of less than three packings nothing is known."""
    return packings > 2 and abs(change) > stdtrit(packings - 1, 1 - 0.5 * CHANCE) * error


def versions_of(runs):
    """{version of rockwear: how many of the runs with these summary.json}."""
    found = Counter()
    for file in runs:
        try:
            found[json.loads(file.read_text(encoding="utf-8"))["versions"]["rockwear"]] += 1
        except (OSError, ValueError, KeyError):
            found["an unknown version"] += 1
    return found


def write_page(path, lines, folders=None):
    """Write lines of Markdown, wrapped except for tables, below a line on their origin. -> the text.

    folders: of the runs that they are from; all below that of `path` if not given. Where one was made by another
    version than this one, a line says so.
    """
    path = Path(path)
    made_by = versions_of(sorted(path.parent.rglob("summary.json")) if folders is None else
                          [Path(folder) / "summary.json" for folder in folders])
    if set(made_by) - {__version__}:
        counts = ", ".join(f"{count} by {version}" for version, count in sorted(made_by.items()))
        lines = [f"**Runs, by version of rockwear: {counts}; this is {__version__}.**", "", *lines]
    versions = ", ".join(f"{program} {version}" for program, version in ORIGIN["versions"].items())
    origin = (f"*Generated by `{ORIGIN['command']}` at commit {ORIGIN['commit']}, {ORIGIN['date']}; {versions}; "
              f"{machine_words(ORIGIN['machine'])}.*")
    wrapped = [short for line in [origin, "", *lines] for short in (
        [line] if line.startswith("|") else textwrap.wrap(
            line, WIDTH, break_long_words=False, break_on_hyphens=False,
            subsequent_indent="  " if line.startswith("- ") else "") or [""])]
    text = "\n".join(wrapped).rstrip("\n") + "\n"
    path.write_text(text, encoding="utf-8")
    return text


def record(*paths):
    """Enter files in provenance.json of their folders; what other commands wrote there stays entered."""
    for path in map(Path, paths):
        manifest = path.with_name(MANIFEST)
        entries = json.loads(manifest.read_text(encoding="utf-8")) if manifest.exists() else {}
        entries[path.name] = ORIGIN
        manifest.write_text(json.dumps(entries, indent=1, sort_keys=True) + "\n", encoding="utf-8")

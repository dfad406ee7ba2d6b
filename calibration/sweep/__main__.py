"""Run every row of a yade-batch table, here or on a cluster, and gather the results on one page.

    python3 -m calibration.sweep TABLE SCRIPT [--out DIR] [--jobs N | --scheduler ADDRESS]
    python3 -m calibration.sweep TABLE SCRIPT [--out DIR] --slurm FILE | --read

A row is a run of SCRIPT in DIR/ROW, named by the table's description, with the values of the row as its parameters; its
words go to DIR/ROW.log. Each value of all rows is checked by its rule before the first one runs; files, and values
that do not fit together, once their row begins. The same command again keeps the rows that have finished with this
version of rockwear and resumes the others from their checkpoints. Writes sweep.html and sweep.csv into DIR. Exit code
0: all rows are done; 1: some failed, each said in one line; 2: bad input, said in one line; 128 + n: stopped by signal
n. --read runs nothing and gathers what there is: 1 where rows are missing.

On a cluster, start `dask scheduler` on one machine and `dask worker ADDRESS --nthreads N` on each, N rows at a time;
all see the same folders. A worker lost in mid-row costs one checkpoint interval, and the row goes on elsewhere; the
scheduler gives a row up with its fourth worker (DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES, 3).

By Slurm, --slurm FILE writes a job array, `sbatch FILE` runs it, `sbatch --array=4 FILE` the fourth row alone, and the
same command with --read gathers the rows afterwards. Tried with Slurm 22.05 on one machine: five tensile tests, one of
which fails, and rows that scancel, the time limit and preemption stop; each went on from its checkpoint.
"""
import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from calibration.campaigns import runs, yade_job
from calibration.command import Parser, made
from calibration.generated import ROOT
from calibration.sweep import page, slurm
from rockwear.kernels.checks import ParameterError, require
from rockwear.report.folder import RunFolder

FAILED = "failed: "
"""How a line begins that says why a row failed."""


@dataclass
class Row:
    """A row of the table. given: {parameter: text} of its cells; values: {parameter: value} of all parameters;
    failure: why it failed, nothing before."""

    name: str
    given: dict
    values: dict
    threads: int
    folder: Path
    job: dict
    failure: str = ""

    @property
    def done(self):
        """Whether the row has finished with these values."""
        return runs.finished(self.folder, self.values)

    def run_folder(self):
        """RunFolder of a finished row, else None."""
        return RunFolder(self.folder) if self.done else None


def read_rows(table, script, out, row=None):
    """([Row], {parameter: unit}, folder of the sweep). row: the one that is to run, from 1; None for all. Raises
    ParameterError before anything has run."""
    require(Path(table).is_file(), "table", table, "a file")
    require(Path(script).is_file(), "script", script, "a file")
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "rows.json"
        done = subprocess.run(["yade", "-n", "-x", "-j1", str(ROOT / "calibration/sweep/rows.py"), str(table),
                               str(script), str(file)], env={**os.environ, "PYTHONPATH": str(ROOT)},
                              capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
        if not file.exists():
            raise ParameterError("script", script, "one that YADE can read: " + (
                done.stderr.strip().splitlines() or ["nothing said"])[-1])
        found = json.loads(file.read_text(encoding="utf-8"))
    if "error" in found:
        raise SweepError(found["error"])
    count = len(found["rows"])
    require(row is None or 1 <= row <= count, "row", row, f"from 1 to {count}")
    folder = made(Path(out or _common_out(found["rows"]) or Path("out") / Path(table).stem))
    script = Path(script).resolve()
    rows = []
    for row in found["rows"]:
        words = [word for name, value in row["given"].items() for word in (f"--{name}", value)]
        place = folder / row["name"]
        rows.append(Row(row["name"], row["given"], row["values"], row["threads"], place,
                        runs.job(script, place, words, row["threads"], row["environment"])))
    return rows, found["units"], folder


class SweepError(Exception):
    """Bad input; str() is the line that says it."""


def _common_out(rows):
    """The column `out` of a table, where all rows have the same."""
    found = {row["out"] for row in rows}
    return found.pop() if len(found) == 1 else ""


def run_all(rows, folder, **where):
    """Run the rows that are not done; a row that fails has its `failure` set."""
    with runs.Runs(folder, keep=True, **where) as started:
        row_of = {runs.Started(row.folder) if row.done else started.submit(row.job): row for row in rows}
        for one in runs.as_they_end(row_of):
            row_of[one].failure = str(one.exception() or "")
            if row_of[one].failure:
                print(f"{FAILED}{row_of[one].failure}", file=sys.stderr, flush=True)


def run_one(row):
    """Run one row here, without a scheduler; where it fails, the last line of its log says so. -> exit code as of a
    sweep."""
    if row.done:
        return 0
    (row.folder / "summary.json").unlink(missing_ok=True)
    code, said = yade_job.run(row.job)
    if code:
        line = f"{FAILED}{row.name} ended with {code}: {said}"
        print(line, file=sys.stderr)
        with open(row.job["log"], "a", encoding="utf-8") as log:
            print(line, file=log)
    return 1 if code else 0


def read_failures(rows):
    """Set the `failure` of each row that run_one has seen fail."""
    for row in rows:
        log = Path(row.job["log"])
        lines = log.read_text(encoding="utf-8", errors="replace").splitlines() if log.exists() else []
        if lines and lines[-1].startswith(FAILED) and not row.done:
            row.failure = lines[-1].removeprefix(FAILED)
            print(lines[-1], file=sys.stderr)


def main(words):
    """-> exit code."""
    parser = Parser(prog="python3 -m calibration.sweep", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", metavar="TABLE", help="a table of yade-batch")
    parser.add_argument("script", metavar="SCRIPT", help="a YADE script of a scene, yade_scripts/steady_cut.py for one")
    parser.add_argument("--out", metavar="DIR", help="folder of the results (default: the table's column out, else "
                        "out/ and the table's name)")
    runs.add_placement(parser)
    parser.add_argument("--results", nargs="+", default=(), metavar="NAME", help="results to show, of those in the "
                        "rows' summary.json")
    other = parser.add_mutually_exclusive_group()
    other.add_argument("--slurm", metavar="FILE", help="write a job array for sbatch, a row a job, and run nothing")
    other.add_argument("--read", action="store_true", help="run nothing, gather the rows that there are")
    other.add_argument("--row", type=int, metavar="N", help="run the Nth row alone, here; this is what a job of the "
                       "array does")
    options = parser.parse_args(words)
    alone = options.slurm or options.read or options.row is not None
    try:
        where = {} if alone else runs.placement(words)[0]
        rows, units, folder = read_rows(options.table, options.script, options.out, options.row)
        if options.slurm:
            return slurm.write(Path(options.slurm), rows, options.table, options.script, folder)
        if options.row is not None:
            return run_one(rows[options.row - 1])
        if options.read:
            read_failures(rows)
        else:
            run_all(rows, folder, **where)
    except (ParameterError, SweepError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    done, failed = sum(row.done for row in rows), sum(bool(row.failure) for row in rows)
    print(f"{done} of {len(rows)} rows are done, {failed} failed: {page.write(folder, rows, units, options.results)}")
    return 0 if done == len(rows) and not failed else 1


def _stop(number, frame):
    # Slurm signals every process of a job, and its script this one once more, while the run writes its checkpoint.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    print(f"\nstopped by signal {number}; the same command resumes", flush=True)
    raise SystemExit(128 + number)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _stop)
    signal.signal(signal.SIGINT, _stop)
    sys.exit(main(sys.argv[1:]))

"""Scenes run in processes of their own, each into its folder, where a dask scheduler puts them: here or elsewhere."""
import argparse
import asyncio
import concurrent.futures
import importlib.util
import json
import logging
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path

from calibration.campaigns import yade_job
from calibration.campaigns.progress import Progress
from calibration.command import Parser, help_if_asked, split
from calibration.generated import ROOT
from rockwear import __version__
from rockwear.kernels.checks import ParameterError, require
from rockwear.model import rock_file
from rockwear.report.folder import RunFolder
from rockwear.run.checkpoint import digest

PLACEMENT = "[--jobs N | --scheduler ADDRESS]"
"""Options of `placement`."""
PATIENCE = 5
"""s in which a scheduler must answer."""
GONE = OSError, asyncio.CancelledError, concurrent.futures.CancelledError
"""What dask raises where the scheduler has gone."""
GIVEN = "given.json"
"""In a run's folder: the values that `Runs.start` gave it."""
LOST = 10
"""Workers that a run may lose here before it counts as the cause."""


class RunFailed(RuntimeError):
    """A YADE script ended with an exit code other than 0 (`code`; None where its workers were lost)."""

    def __init__(self, words, code=None):
        super().__init__(words)
        self.code = code


def command(script, folder, words=(), threads=1):
    """[word, ...] that run a YADE script into `folder`."""
    return ["yade", "-n", "-x", f"-j{threads}", str(ROOT / script), "--out", str(folder), *words]


def run_script(script, folder, words=()):
    """Run a YADE script (a path from the root of the repository) into `folder`. Raises RunFailed."""
    done = subprocess.run(command(script, folder, words), env={**os.environ, "PYTHONPATH": str(ROOT)},
                          capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["nothing said"]
        errors = [line for line in said if line.startswith("error: ")]
        raise RunFailed(f"{Path(folder).name} ended with {done.returncode}: {(errors or said)[-1]}", done.returncode)


def job(script, folder, words=(), threads=1, environment=None):
    """The job (campaigns.yade_job) that runs a YADE script into `folder`; its words go to a file beside the folder."""
    folder = Path(folder).resolve()
    return {"command": command(script, folder, words, threads), "folder": str(folder), "log": f"{folder}.log",
            "directory": os.getcwd(), "environment": {"PYTHONPATH": str(ROOT), **(environment or {})}}


class Started:
    """A run that has been queued or was there already."""

    def __init__(self, folder, future=None, log=None):
        self.folder, self.future, self.log = Path(folder), future, log

    @property
    def over(self):
        """Whether the run has ended."""
        return self.future is None or self.future.done()

    def exception(self):
        """RunFailed, or None; waits for the run."""
        if self.future is None:
            return None
        from distributed.scheduler import KilledWorker
        try:
            code, said = self.future.result()
        except KilledWorker:
            return RunFailed(f"{self.folder.name} was given up: too many of its workers were lost")
        except GONE:
            return RunFailed(f"{self.folder.name} was left: the scheduler was lost")
        return RunFailed(f"{self.folder.name} ended with {code}: {said}", code) if code else None

    def result(self):
        """Its RunFolder; waits for the run. Raises RunFailed."""
        failed = self.exception()
        if failed:
            raise failed
        return RunFolder(self.folder)


class ByValue:
    """A function of yade_job that arrives as itself where our package is not: on workers, and since dask 2025 on the
    scheduler, too."""

    def __init__(self, function):
        import cloudpickle
        cloudpickle.register_pickle_by_value(yade_job)
        self.function, self.pickled = function, cloudpickle.dumps(function)

    def __call__(self, *arguments):
        return self.function(*arguments)

    def __reduce__(self):
        return pickle.loads, (self.pickled,)


class Runs:
    """Runs in subfolders of `folder`, `at_once` at a time on this machine, or as many as the workers of `scheduler` (an
    address) take.

    With `keep`, runs that `finished` are not repeated, and others resume from their checkpoints. Use it as a context:
    an exception within it stops the runs under way, which resume when they are started again.
    """

    def __init__(self, folder, *, at_once=2, keep=False, scheduler=None):
        self.folder, self.at_once, self.keep, self.scheduler = Path(folder), at_once, keep, scheduler
        self.client = self.cluster = self.scratch = None
        self.futures = []

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if self.client is None:
            return
        with suppress(*GONE):
            if kind is None:
                for future in self.futures:
                    future.exception()
            else:
                self.client.cancel(self.futures)
            self.client.close()
        if self.cluster:
            self.cluster.close()
            self.scratch.cleanup()

    def start(self, name, script, **values):
        """Queue a run of `script` (a path from the root of the repository). One with other values, or with a value that
        is given no more, does not stand for it. -> Started."""
        folder = self.folder / name
        if self.keep and finished(folder, values) and _given(folder) == _words(values):
            return Started(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / GIVEN).write_text(json.dumps(_words(values)), encoding="utf-8")
        return self.submit(job(script, folder, [w for key, v in values.items() for w in (f"--{key}", str(v))]))

    def submit(self, one):
        """Queue a job, whatever there is of it; without `keep` it does not resume. -> Started."""
        if self.client is None:
            self._connect()
        for old in ("summary.json", *([] if self.keep else ["checkpoint/current.json"])):
            # A worker tells by these what was done since.
            (Path(one["folder"]) / old).unlink(missing_ok=True)
        self.futures.append(self.client.submit(ByValue(yade_job.run_on_worker), one, pure=False))
        return Started(one["folder"], self.futures[-1], one["log"])

    def _connect(self):
        if self.scheduler:
            self.client = connected(self.scheduler)
            return
        require_dask()
        import dask
        import distributed
        self.scratch = tempfile.TemporaryDirectory()
        # Runs start in the order in which they were queued, none behind a long one while another worker is idle.
        with dask.config.set({"distributed.scheduler.allowed-failures": LOST,
                              "distributed.scheduler.worker-saturation": 1.0}), _uninterrupted():
            self.cluster = distributed.LocalCluster(
                n_workers=self.at_once, threads_per_worker=1, dashboard_address=":0", memory_limit=0,
                silence_logs=logging.CRITICAL, local_directory=self.scratch.name)
        self.client = distributed.Client(self.cluster)


@contextmanager
def _uninterrupted():
    """Processes that begin in this context do not hear Ctrl-C; this one ends them, its runs with a checkpoint."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def require_dask():
    """Raise ParameterError where dask.distributed is not installed."""
    require(importlib.util.find_spec("distributed"), "python3-distributed", "missing", "installed (make setup-sweep)")


def connected(address):
    """A client of the dask scheduler at `address`. Raises ParameterError where none answers."""
    require_dask()
    import distributed
    for name in ("distributed", "distributed.client", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        return distributed.Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise ParameterError("scheduler", address, f"the address of a dask scheduler that answers within {PATIENCE} s "
                             f"({type(error).__name__})") from None


def placement(words):
    """({option of Runs: value}, the other words) of a command line with --jobs N or --scheduler ADDRESS.

    Ends the program with exit code 2 where they cannot be used.
    """
    parser = Parser(add_help=False, argument_default=argparse.SUPPRESS)
    add_placement(parser)
    found, others = parser.parse_known_args(words)
    try:
        if "--read" not in others:
            require_dask()
        if hasattr(found, "scheduler"):
            connected(found.scheduler).close()
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    return vars(found), others


def command_line(campaign, cases=(), flags=("--read",)):
    """(folder, the other words, {option of Runs: value}) of the command line DIR [CASE ...] [FLAG ...] [where to run].

    campaign: a module's name; cases, flags: words that may come with the folder. Ends the program: after the usage
    where --help asks for it, with exit code 2 and one line where the words cannot be used.
    """
    help_if_asked()
    where, words = placement(sys.argv[1:])
    known = *cases, *flags
    (folder,), words = split(words, campaign, " ".join(["DIR", *(f"[{word}]" for word in known), PLACEMENT]),
                             known=known)
    if "--read" in words and not folder.is_dir():
        print(f"error: DIR = {folder} must be the folder of a campaign, whose runs --read reads", file=sys.stderr)
        sys.exit(2)
    return folder, words, where


def add_placement(parser):
    """The options that say where runs run."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--jobs", dest="at_once", type=_count, metavar="N", help="runs at a time on this machine "
                       "(default 2)")
    where.add_argument("--scheduler", metavar="ADDRESS", help="of a dask scheduler, tcp://HOST:PORT, whose workers see "
                       "the same folders")


def _count(word):
    if not word.isdecimal() or int(word) < 1:
        raise argparse.ArgumentTypeError(f"{word} is not a number of at least 1")
    return int(word)


def as_they_end(started):
    """Each of these Started once it has ended; a line says how all of them stand, and the time left, in between."""
    left = list(dict.fromkeys(started))
    progress = Progress(left) if any(not one.over for one in left) else None
    while left:
        ended, left = [one for one in left if one.over], [one for one in left if not one.over]
        for one in ended:
            if progress:
                progress.failed += one.exception() is not None
                progress.clear()
            yield one
        if progress:
            progress.show()
        if left:
            _wait_for_next(left, progress.period)
    if progress:
        progress.close()


def _wait_for_next(started, timeout):
    """Wait until one of these Started has ended, at most so many seconds."""
    import distributed
    try:
        distributed.wait([one.future for one in started], timeout=timeout, return_when="FIRST_COMPLETED")
    except GONE:
        # TimeoutError is an OSError; one whose scheduler was lost says so itself.
        pass


def wait_for(jobs, words):
    """Wait for runs {key: Started}; print words(key, folder) of each, or why it failed. -> 1 where one failed, else
    0."""
    failed, key_of = 0, {one: key for key, one in jobs.items()}
    for one in as_they_end(jobs.values()):
        try:
            print(words(key_of[one], one.result()), flush=True)
        except RunFailed as error:
            print(error, file=sys.stderr, flush=True)
            failed = 1
    return failed


def ended_well(jobs):
    """({key: RunFolder} of those runs {key: Started} that end well, [what the others said]); waits for all. Those that
    do not are said on stderr."""
    found, failures = {}, []
    for key, job in jobs.items():
        try:
            found[key] = job.result()
        except RunFailed as error:
            failures.append(str(error))
            print(f"left out: {error}", file=sys.stderr, flush=True)
    return found, failures


def finished(folder, values):
    """True for a folder with the summary of a run that finished, with these values, the same input files and this
    version of rockwear: another one may find other results, and one table is not to mix them."""
    try:
        summary = RunFolder(folder).summary
        parameters, version = summary["parameters"], summary["versions"]["rockwear"]
        same_files = all(digest(_path(name, parameters[name])) == found for name, found in summary["files"].items())
    except (OSError, ValueError, KeyError):
        return False
    return summary["exit_code"] == 0 and version == __version__ and same_files and all(
        name in parameters and _same(parameters[name], value) for name, value in values.items())


def _words(values):
    return {name: str(value) for name, value in values.items()}


def _given(folder):
    """What `Runs.start` noted in this folder; None where it did not."""
    try:
        return json.loads((folder / GIVEN).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def existing(places):
    """{key: RunFolder} of the folders {key: path} that hold a run that has ended."""
    return {key: RunFolder(place) for key, place in places.items() if (place / "summary.json").exists()}


def _path(name, value):
    return rock_file.find(value) if name == "rock" else Path(value)


def _same(stored, value):
    try:
        return float(stored) == float(value)
    except (TypeError, ValueError):
        return str(stored).lower() == str(value).lower()

"""Scenes run in processes of their own, so many at a time, each into its folder."""
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from calibration.generated import ROOT
from rockwear.model import rock_file
from rockwear.report.folder import RunFolder
from rockwear.run.checkpoint import digest


class RunFailed(RuntimeError):
    """A YADE script ended with an exit code other than 0."""


def run_script(script, folder, words=()):
    """Run a YADE script (a path from the root of the repository) into `folder`. Raises RunFailed."""
    done = subprocess.run(["yade", "-n", "-x", "-j1", str(ROOT / script), "--out", str(folder), *words],
                          env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, encoding="utf-8",
                          stdin=subprocess.DEVNULL)
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["nothing said"]
        errors = [line for line in said if line.startswith("error: ")]
        raise RunFailed(f"{Path(folder).name} ended with {done.returncode}: {(errors or said)[-1]}")


class Runs:
    """Runs in subfolders of `folder`, `at_once` at a time.

    With `keep`, runs that finished with the same values and the same input files are not repeated. Use it as a context:
    an exception within it waits for the runs under way and starts no others.
    """

    def __init__(self, folder, *, at_once=2, keep=False):
        self.folder, self.keep = Path(folder), keep
        self.pool = ThreadPoolExecutor(at_once)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self.pool.shutdown(wait=True, cancel_futures=kind is not None)

    def start(self, name, script, **values):
        """Queue a run of `script` (a path from the root of the repository). -> Future of its RunFolder.

        The future raises RunFailed where the run fails.
        """
        return self.pool.submit(self._run, self.folder / name, script, values)

    def _run(self, folder, script, values):
        if self.keep and finished(folder, values):
            return RunFolder(folder)
        words = [word for name, value in values.items() for word in (f"--{name}", str(value))]
        if self.keep and (folder / "checkpoint").exists() and not (folder / "summary.json").exists():
            words.append("--resume")
        run_script(script, folder, words)
        return RunFolder(folder)


def wait_for(jobs, words):
    """Wait for runs {key: Future of its RunFolder}; print words(key, folder) of each, or why it failed. -> 1 where one
    failed, else 0."""
    failed = 0
    for key, job in jobs.items():
        try:
            print(words(key, job.result()), flush=True)
        except RunFailed as error:
            print(error, file=sys.stderr, flush=True)
            failed = 1
    return failed


def finished(folder, values):
    """True for a folder with the summary of a run that finished, with these values and the same input files."""
    try:
        summary = RunFolder(folder).summary
        parameters = summary["parameters"]
        same_files = all(digest(_path(name, parameters[name])) == found for name, found in summary["files"].items())
    except (OSError, ValueError, KeyError):
        return False
    return summary["exit_code"] == 0 and same_files and all(
        name in parameters and _same(parameters[name], value) for name, value in values.items())


def _path(name, value):
    return rock_file.find(value) if name == "rock" else Path(value)


def _same(stored, value):
    try:
        return float(stored) == float(value)
    except (TypeError, ValueError):
        return str(stored).lower() == str(value).lower()

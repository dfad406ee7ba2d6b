"""One run of a YADE script on the machine where a scheduler puts it.

This goes to dask's workers by value and imports the standard library only: a worker needs YADE and the folders, and no
package of ours on its path.
"""
import fcntl
import json
import os
import subprocess
import time
from pathlib import Path

POLL = 0.2
"""s between looks at what one waits for."""
OTHER_RUN, OTHER_CHECKPOINT = "error: out =", "error: checkpoint ="
"""How a run begins to say that another writes its folder, and that it does not fit the checkpoint there."""


def run_on_worker(job):
    """`run` on a worker of dask, until its task is cancelled."""
    from distributed import get_worker
    worker = get_worker()
    key = worker.get_current_task()

    def dropped():
        task = worker.state.tasks.get(key)
        return task is None or task.state == "cancelled"

    return run(job, dropped)


def run(job, dropped=lambda: False):
    """Run a job to its end, from its checkpoint if there is one. -> (exit code, what it said last).

    job: {"command": [word, ...] with --out, "folder", "log": paths, "environment": {name: text} beside that of the
    worker, "directory": in which it runs}; dropped(): whether the run is no longer wanted. It is then stopped by
    SIGTERM, at which it writes a checkpoint.

    A run that finished meanwhile is not repeated: the scheduler also sends a job again when it has lost its worker.
    """
    try:
        return _run_to_end(job, dropped)
    except OSError as error:
        # Raised, it would look as if the scheduler had gone.
        return 1, f"error: {error}"


def _run_to_end(job, dropped):
    folder = Path(job["folder"])
    folder.parent.mkdir(parents=True, exist_ok=True)
    while True:
        _wait_for_others(folder, dropped)
        if _is_finished(folder):
            return 0, ""
        resume = (folder / "checkpoint/current.json").exists()
        code, said = _run(job, ["--resume"] if resume else [], dropped)
        if code == 2 and resume and said.startswith(OTHER_CHECKPOINT):
            code, said = _run(job, [], dropped)
        if code != 2 or not said.startswith(OTHER_RUN) or not _is_locked(folder):
            return code, said


def _is_finished(folder):
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))["exit_code"] == 0
    except (OSError, ValueError, KeyError):
        return False


def _is_locked(folder):
    """Whether a run writes the folder (rockwear.run.lock)."""
    try:
        with open(folder / "lock", "r+", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False


def _wait_for_others(folder, dropped):
    while _is_locked(folder) and not dropped():
        time.sleep(POLL)


def _run(job, words, dropped):
    # The kernel ends the run with the thread that started it, and so with its worker: else two would write one folder.
    command = ["setpriv", "--pdeathsig", "KILL", *job["command"], *words]
    environment = {**os.environ, **job["environment"]}
    with open(job["log"], "a" if words else "w", encoding="utf-8") as log:
        begin = log.tell()
        process = subprocess.Popen(command, cwd=job["directory"], env=environment, stdin=subprocess.DEVNULL,
                                   stdout=log, stderr=subprocess.STDOUT)
        try:
            while process.poll() is None:
                if dropped():
                    break
                time.sleep(POLL)
        finally:
            # Also where this program itself is stopped.
            if process.poll() is None:
                process.terminate()
            process.wait()
    said = Path(job["log"]).read_bytes()[begin:].decode(errors="replace").strip().splitlines() or ["nothing said"]
    return process.returncode, ([line for line in said if line.startswith("error: ")] or said)[-1]

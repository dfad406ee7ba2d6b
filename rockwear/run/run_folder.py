"""The folder of a run: where it is, what a new run replaces in it, and that one run at a time writes it."""
import os
import shutil
from pathlib import Path

from rockwear.kernels.checks import ParameterError
from rockwear.run import lock, parameters

FOLDERS = "snapshots", "checkpoint", "figures", "vtk", "paths"
"""Folders that a new run removes."""
FILES = ("model.npz", "summary.json", "history.csv", "cracks.csv", "groove.csv", "chips.csv", "turns.csv",
         "wear_profile.csv", "tool_fields.csv", "warming.csv", "errors.csv", "tool.stl", "report.html")
"""Files that a new run removes."""


def find(name, out):
    """Path of the folder `out` of a run of the scene `name`, out/NAME when empty, a subfolder a row in a batch.

    Raises ParameterError where nothing can be written, or files of another origin than a run would be replaced.
    """
    folder = Path(out or Path("out") / name) / (parameters.batch_row() or "")
    existing = folder
    try:
        while not existing.exists():
            existing = existing.parent
        writable = existing.is_dir() and os.access(existing, os.W_OK)
    except OSError as error:
        raise _cannot_be_written(folder, error) from None
    if not writable:
        raise ParameterError("out", str(folder), "a folder that can be written")
    foreign = [old for old in (*FOLDERS, *FILES) if (folder / old).exists()]
    if foreign and not (folder / lock.FILE).exists():
        raise ParameterError("out", str(folder), f"a folder of runs: {', '.join(foreign)} there would be replaced")
    return folder


def take(folder):
    """Make `folder`, and lock it for this process. -> the open file that holds the lock.

    Raises ParameterError where it cannot be made, or another run writes it.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _cannot_be_written(folder, error) from None
    return lock.hold(folder)


def empty(folder):
    """Remove what an earlier run has left in `folder`."""
    for old in FOLDERS:
        shutil.rmtree(folder / old, ignore_errors=True)
    for old in FILES:
        (folder / old).unlink(missing_ok=True)


def _cannot_be_written(folder, error):
    return ParameterError("out", str(folder), f"a folder that can be written ({error.strerror})")

"""Checkpoints: YADE's scene and the state of the Python engines in one folder. The last good one is never lost."""
import errno
import gzip
import hashlib
import json
import os
import shutil
import zlib
from pathlib import Path

import numpy as np

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.files import require_room

FORMAT = "rockwear checkpoint 4"
HEADER = 1000
"""Bytes that an array takes in a file beside its numbers, at most."""


class CheckpointError(ParameterError):
    """A checkpoint that cannot be used: str() is one line that says why."""

    def __init__(self, folder, rule):
        super().__init__("checkpoint", str(folder), rule)


def _flatten(tree, prefix=""):
    for name, value in tree.items():
        if isinstance(value, dict):
            yield from _flatten(value, f"{prefix}{name}/")
        else:
            yield prefix + name, np.asarray(value)


def _unflatten(flat):
    tree = {}
    for path, value in flat.items():
        *folders, name = path.split("/")
        branch = tree
        for folder in folders:
            branch = branch.setdefault(folder, {})
        branch[name] = value[()] if value.ndim == 0 else value
    return tree


def digest(file):
    """SHA-256 of a file's bytes, in hexadecimal."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def save(folder, *, identity, state, write_scenes):
    """Write a checkpoint into `folder`.

    identity: a dict that a resuming run must match (scene, parameters, versions); state: a nested dict of numbers and
    arrays; write_scenes(directory): writes YADE's files there. The new set is complete, with its digests, before
    current.json points to it; only then the old set is removed.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    number = 1 + max((int(p.name) for p in folder.iterdir() if p.name.isdigit()), default=0)
    directory = folder / str(number)
    directory.mkdir()
    try:
        write_scenes(directory)
        arrays = dict(_flatten(state))
        # On a full disk numpy's writer leaves an error of its own behind.
        require_room(directory, sum(array.nbytes + HEADER for array in arrays.values()))
        np.savez(directory / "state.npz", **arrays)
        _check_whole(directory)
        files = {file.name: digest(file) for file in sorted(directory.iterdir())}
        pointer = folder / "current.json.new"
        current = {"format": FORMAT, "set": number, "files": files, "identity": identity}
        pointer.write_text(json.dumps(current, indent=1), encoding="utf-8")
        for file in [*directory.iterdir(), pointer]:
            with open(file, "rb") as stream:
                os.fsync(stream.fileno())
        os.replace(pointer, folder / "current.json")
    except OSError:
        shutil.rmtree(directory, ignore_errors=True)
        raise
    for old in folder.iterdir():
        if old.name.isdigit() and int(old.name) < number:
            shutil.rmtree(old, ignore_errors=True)


def _check_whole(directory):
    """Raise OSError where a scene was not written to its end (a full disk): YADE reports no error."""
    for file in directory.glob("*.gz"):
        try:
            with gzip.open(file) as stream:
                while stream.read(1 << 20):
                    pass
        except (EOFError, zlib.error) as error:
            raise OSError(errno.ENOSPC, f"{file.name} was not written to its end") from error


def load(folder, identity):
    """-> (state, directory of YADE's files) of the checkpoint in `folder`.

    Raises CheckpointError where there is none, where a file is missing, cut short or changed, and where it belongs to
    another scene, other parameters, or another version of rockwear or YADE.
    """
    folder = Path(folder)
    try:
        current = json.loads((folder / "current.json").read_text(encoding="utf-8"))
    except OSError:
        raise CheckpointError(folder, "an existing checkpoint: there is none to resume from") from None
    except ValueError:
        raise CheckpointError(folder, "whole: current.json cannot be read") from None
    if not isinstance(current, dict) or current.get("format") != FORMAT:
        raise CheckpointError(folder, f"of the format '{FORMAT}'")
    entries = current.get("identity"), current.get("files")
    if not all(isinstance(entry, dict) for entry in entries) or "set" not in current:
        raise CheckpointError(folder, "whole: current.json lacks some of identity, files and set")
    for name, expected in identity.items():
        found = current["identity"].get(name)
        if found != expected:
            raise CheckpointError(folder, f"of the same {name}: {_difference(found, expected)}")
    directory = folder / str(current["set"])
    for name, written in current["files"].items():
        if not (directory / name).is_file() or digest(directory / name) != written:
            raise CheckpointError(folder, f"whole: {name} is missing or damaged")
    with np.load(directory / "state.npz") as flat:
        return _unflatten(dict(flat)), directory


def _difference(found, expected):
    if isinstance(found, dict) and isinstance(expected, dict):
        name = next(n for n in sorted({*found, *expected}) if found.get(n) != expected.get(n))
        return f"{name} is {found.get(name)} there and {expected.get(name)} here"
    return f"{found} there, {expected} here"

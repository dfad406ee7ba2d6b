"""Packings kept in a cache folder."""
import hashlib
import json
import numpy as np
import os

from contextlib import suppress
from pathlib import Path
from zipfile import BadZipFile


CACHE_VERSION = 2


def cache_folder():
    """Where packings are kept: $ROCKWEAR_CACHE, or rockwear in the user's cache folder."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("ROCKWEAR_CACHE") or Path(base) / "rockwear")


def cached(make, **key):
    """`make()`, a dict of arrays, or what an earlier call with the same key has left in the cache folder.

    A cache that cannot be read or written is passed over.
    """
    digest = hashlib.sha256(json.dumps([CACHE_VERSION, key], sort_keys=True).encode()).hexdigest()[:24]
    file = cache_folder() / f"{digest}.npz"
    try:
        with np.load(file) as stored:
            return dict(stored)
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        pass
    arrays = make()
    temporary = file.with_suffix(f".{os.getpid()}.npz")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        np.savez(temporary, **arrays)
        os.replace(temporary, file)
    except OSError:
        # Where the folder cannot be made, nor can a file in it be looked for.
        with suppress(OSError):
            temporary.unlink()
    return arrays

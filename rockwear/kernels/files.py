"""Files that are whole or not there, and whose errors name them."""
import errno
import io
import os
import shutil
from contextlib import contextmanager

import numpy as np


@contextmanager
def naming(path):
    """Name `path` in an OSError that names no file, as that of a full disk does not."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


def require_room(folder, size):
    """Raise OSError unless so many bytes are free on the disk of `folder`."""
    if shutil.disk_usage(folder).free < size:
        raise OSError(errno.ENOSPC, f"No space left for {size} bytes", str(folder))


@contextmanager
def replacing(path):
    """A binary file to write, which takes the place of `path` once it is whole. An OSError names `path`."""
    temporary = path.with_name(f"{path.name}.new")
    with naming(path):
        try:
            with open(temporary, "wb") as file:
                yield file
            os.replace(temporary, path)
        except OSError:
            temporary.unlink(missing_ok=True)
            raise


def write_arrays(path, arrays):
    """Write {name: array} as a compressed .npz file that is whole or not there. An OSError names `path`.

    It is made in memory: where numpy's writer meets a full disk, it leaves an error of its own behind.
    """
    made = io.BytesIO()
    np.savez_compressed(made, **arrays)
    with replacing(path) as file:
        file.write(made.getbuffer())

"""Files that are whole or not there, and whose errors name them."""
import errno
import os
import shutil
from contextlib import contextmanager


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

"""Files that are whole or not there, and whose errors name them; tables as other programs write them."""
import csv
import errno
import io
import os
import shutil
from contextlib import contextmanager

import numpy as np

from rockwear.kernels.checks import ParameterError


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


def read_cells(path, parameter, comment=None):
    """[(number of the line, [cell])] of a CSV file, no row empty and none that begins with `comment`; between the cells
    are commas, semicolons or tabs, as in the first row. Raises ParameterError, of the name `parameter`."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            lines = [(number, line) for number, line in enumerate(file.read().splitlines(), 1)
                     if line.strip() and not (comment and line.lstrip().startswith(comment))]
        between = next((mark for mark in "\t;" if lines and mark in lines[0][1]), ",")
        rows = csv.reader((line for _, line in lines), delimiter=between, skipinitialspace=True)
        return [(number, row) for (number, _), row in zip(lines, rows) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(parameter, str(path), f"a readable CSV file ({error})") from None

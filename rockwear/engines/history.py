"""Rows of numbers on the disk as they come: a run killed at any time has all of its rows, and memory stays flat."""
import io
import os
from itertools import islice

import numpy as np

from rockwear.kernels.files import naming, replacing

AT_ONCE = 256
"""Rows that are turned into text together: the text of a whole table, at each checkpoint, takes memory for good."""


def text_of(rows):
    """Rows of numbers as lines of a CSV file."""
    return "".join(",".join(f"{value:.10g}" for value in row) + "\n" for row in rows).encode()


def write_table(path, header, rows):
    """A CSV file: a header of `name [unit]`, then rows of numbers; in place at once or not at all."""
    rows = iter(rows)
    with replacing(path) as file:
        file.write((",".join(header) + "\n").encode())
        while some := list(islice(rows, AT_ONCE)):
            file.write(text_of(some))


class History:
    """Rows of as many numbers as the header has names, in two files: exact (8 bytes a number), and as CSV.

    In memory until `open` gives it its files.
    """

    def __init__(self):
        self.header, self.count = [], 0
        self.exact, self.csv = io.BytesIO(), io.BytesIO()
        self.paths = "exact", "csv"

    def append(self, header, row):
        """Add a row; the header of the first one holds for all."""
        if not self.header:
            self.header = list(header)
            self._write(self.csv, self.paths[1], (",".join(self.header) + "\n").encode())
        self._write(self.exact, self.paths[0], np.array(row, float).tobytes())
        self._write(self.csv, self.paths[1], text_of([row]))
        self.count += 1

    def _write(self, file, path, data):
        with naming(path):
            file.write(data)
            file.flush()

    def open(self, exact, csv):
        """Go on in these files: after the rows of `exact` that count, of which `csv` is made afresh.

        -> False where `exact` has fewer rows.
        """
        before = self.exact.getvalue()
        with naming(exact):
            self.exact = open(exact, "a+b")
            size = 8 * len(self.header) * self.count - len(before)
            if self.exact.seek(0, os.SEEK_END) < size:
                return False
            self.exact.truncate(size)
            self.exact.write(before)
            self.exact.flush()
        with replacing(csv) as file:
            if self.header:
                file.write((",".join(self.header) + "\n").encode())
            for first in range(0, self.count, AT_ONCE):
                file.write(text_of(self._rows(first, AT_ONCE).tolist()))
        self.csv, self.paths = open(csv, "ab"), (exact, csv)
        return True

    def _rows(self, first, most):
        """(n, columns) from the row `first` on."""
        width = 8 * len(self.header)
        self.exact.seek(first * width)
        rows = np.frombuffer(self.exact.read(width * min(most, self.count - first)), float)
        self.exact.seek(0, os.SEEK_END)
        return rows.reshape(-1, max(1, len(self.header)))

    @property
    def rows(self):
        """(n, columns) of all rows."""
        return self._rows(0, self.count)

    def state(self):
        """How many rows there are; the rows stay in their files."""
        if not isinstance(self.exact, io.BytesIO):
            with naming(self.paths[0]):
                os.fsync(self.exact.fileno())
        return {"header": np.array(self.header, str), "rows": self.count}

    def restore(self, state):
        """Set what `state` gave; `open` then finds the rows."""
        self.header, self.count = [str(name) for name in state["header"]], int(state["rows"])

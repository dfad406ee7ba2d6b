"""Many of YADE's vectors at once, as one array, from where they lie in memory.

YADE gives a vector of a body or contact by reference, and each costs Python a microsecond to read. An instance of
Boost.Python, through which it does so, points to a holder, and the holder to the vector. The places of many vectors
make an index into the process's memory, seen as one array of numbers, and numpy gathers them fifty times as fast.

Where this is so depends on the versions of Python, Boost and YADE. `check` tries it on one object before any place is
used, through the process's memory file, where a wrong address is an error and no crash.
"""
import ctypes
import os
import sys

import numpy as np
from yade import config

from rockwear.kernels.checks import require

INSTANCE, HOLDER = 40, 16
"""Bytes from the beginning of an instance to its pointer to the holder (behind count, type, size, dictionary and weak
references), and from that of a holder to its pointer to the object (behind its functions and the next holder)."""
SIZE = 8
"""Bytes of a number, and of a pointer."""
MEMORY = np.frombuffer((ctypes.c_double * 2**44).from_address(SIZE))
"""All memory that a process of 64 bits may have, but for its first number."""
MARKS = (0.31415926535, -9.87654321e-3, 5.55e11)
"""Written by Python and looked for in memory; no vector of YADE's has them."""


def _pointer(address):
    return ctypes.c_uint64.from_address(address).value


def place(vector):
    """Index in MEMORY of the first component of a vector that YADE gave by reference."""
    return _pointer(_pointer(id(vector) + INSTANCE) + HOLDER) // SIZE - 1


def _peek(address, count, kind=float):
    """(count,) numbers from an address of which nothing is known; fewer, or none, where there is no memory."""
    try:
        with open("/proc/self/mem", "rb", buffering=0) as memory:
            found = os.pread(memory.fileno(), SIZE * count, address)
    except (OSError, OverflowError):
        return np.empty(0, kind)
    return np.frombuffer(found[:len(found) // SIZE * SIZE], kind)


def _found(vector, values):
    """Whether memory has these values (3,) where a vector should lie."""
    address = id(vector)
    for behind in (INSTANCE, HOLDER):
        pointer = _peek(address + behind, 1, np.uint64)
        if not len(pointer):
            return False
        address = int(pointer[0])
    return address % SIZE == 0 and np.array_equal(_peek(address, 3), values)


def _require(condition, what):
    require(condition, "YADE", config.version, f"one that gives its vectors by reference: {what} does not lie in "
            f"memory where rockwear looks for it (Python {sys.version.split()[0]}); another bond_law does without")


def check(found, of):
    """Raise ParameterError unless memory has what Python writes into the vectors of an object of YADE's.

    of: {name: function that gives the vector of the object `found`}. Its vectors are left as they are.
    """
    for name, vector in of.items():
        before = list(vector(found))
        for k, mark in enumerate(MARKS):
            vector(found)[k] = mark
        same = list(vector(found)) == list(MARKS) and _found(vector(found), MARKS)
        for k, value in enumerate(before):
            vector(found)[k] = value
        _require(same, name)


REACH = 64
"""Numbers before and after a vector among which another one of its object is looked for."""


def offset(vector, name, value):
    """How far behind a vector that YADE gave by reference its object's number `name` lies, the only one of this value.
    Raises ParameterError."""
    first = SIZE * (place(vector) + 1)
    found = np.flatnonzero(_peek(first - SIZE * REACH, 2 * REACH) == value) - REACH
    _require(len(found) == 1, name)
    return int(found[0])


class Vectors:
    """Vectors of many numbered objects, {name: function that gives the vector of an object}.

    An object must be kept as long as its vectors are read.
    """

    def __init__(self, count, of):
        self.of = of
        self.places = {name: np.zeros((count, 3), np.int64) for name in of}

    def find(self, n, found):
        """The object n is `found` from now on."""
        for name, vector in self.of.items():
            self.places[name][n] = place(vector(found)) + np.arange(3)

    def read(self, name, numbers):
        """(k, 3) the vectors of these objects (k,)."""
        return MEMORY[self.places[name][numbers]]

    def write(self, name, numbers, values):
        """Set the vectors of these objects (k,) to the values (k, 3)."""
        MEMORY[self.places[name][numbers]] = values

    def number(self, name, behind, numbers):
        """(k,) the number so far behind a vector of each of these objects (k,), see `offset`."""
        return MEMORY[self.places[name][numbers, 0] + behind]

    def set_number(self, name, behind, numbers, values):
        """Set the number so far behind a vector of each of these objects (k,) to the values (k,)."""
        MEMORY[self.places[name][numbers, 0] + behind] = values

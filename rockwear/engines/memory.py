"""Many of YADE's vectors at once, as one array, from where they lie in memory.

YADE gives a vector of a body or contact by reference, and each costs Python a microsecond to read. An instance of
Boost.Python, through which it does so, points to a holder, and the holder to the vector. The places of many vectors
make an index into the process's memory, seen as one array of numbers, and numpy gathers them fifty times as fast.
"""
import ctypes

import numpy as np

INSTANCE, HOLDER = 40, 16
"""Bytes from the beginning of an instance to its pointer to the holder (behind count, type, size, dictionary and weak
references), and from that of a holder to its pointer to the object (behind its functions and the next holder)."""
SIZE = 8
"""Bytes of a number, and of a pointer."""
MEMORY = np.frombuffer((ctypes.c_double * 2**44).from_address(SIZE))
"""All memory that a process of 64 bits may have, but for its first number."""


def _pointer(address):
    return ctypes.c_uint64.from_address(address).value


def place(vector):
    """Index in MEMORY of the first component of a vector that YADE gave by reference."""
    return _pointer(_pointer(id(vector) + INSTANCE) + HOLDER) // SIZE - 1


REACH = 64
"""Numbers before and after a vector among which another one of its object is looked for."""


def offset(vector, value):
    """How far behind a vector that YADE gave by reference the only such value lies. Raises RuntimeError."""
    first = place(vector)
    found = np.flatnonzero(MEMORY[first - REACH:first + REACH] == value) - REACH
    if len(found) != 1:
        raise RuntimeError(f"{value} is {len(found)} times near a vector of YADE's, not once")
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

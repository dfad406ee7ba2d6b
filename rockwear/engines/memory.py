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
from functools import cache
from operator import attrgetter

import numpy as np
from yade import Body, FrictViscoPhys, Interaction, O, ScGeom, State, config

from rockwear.kernels.checks import require
from rockwear.kernels import compiled

INSTANCE, HOLDER = 40, 16
"""Bytes from the beginning of an instance to its pointer to the holder (behind count, type, size, dictionary and weak
references), and from that of a holder to its pointer to the object (behind its functions and the next holder)."""
SIZE = 8
"""Bytes of a number, and of a pointer."""
MEMORY = np.frombuffer((ctypes.c_double * 2**45).from_address(SIZE))
"""All memory that a process may have with addresses of 48 bits, but for its first number."""
WORDS = MEMORY.view(np.int64)
"""The same as integers: pointers, counts, numbers of bodies."""
MARKS = (0.31415926535, -9.87654321e-3, 5.55e11)
"""Written by Python and looked for in memory; no vector of YADE's has them."""


def _pointer(address):
    return ctypes.c_uint64.from_address(address).value


def place(found):
    """Index in MEMORY of an object of YADE's, or of the first component of a vector that YADE gave by reference."""
    return _pointer(_pointer(id(found) + INSTANCE) + HOLDER) // SIZE - 1


def places(objects):
    """(k,) `place` of each of these objects."""
    pointers = np.fromiter(map(id, objects), np.int64, len(objects))
    for behind in (INSTANCE, HOLDER):
        pointers = WORDS.take(pointed(pointers + behind))
    return pointed(pointers)


def pointed(pointers):
    """(k,) indices in MEMORY of what these pointers (k,) point to."""
    return (pointers >> 3) - 1


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
    return address % SIZE == 0 and address < 2**48 and np.array_equal(_peek(address, 3), values)


def require_memory(condition, what):
    """Raise ParameterError where memory is not as expected; what: is not found."""
    require(condition, "YADE", config.version, f"one whose objects lie in memory as in Debian 12 and 13: {what} is not "
            f"found there (Python {sys.version.split()[0]})")


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
        require_memory(same, name)


REACH = 64
"""Numbers before and after an object or a vector among which others of the object are looked for."""


def offset(name, objects, values):
    """How far behind objects, or vectors that YADE gave by reference, their numbers or integers `values` lie: the one
    place that holds for all. `name` says what they are. Raises ParameterError."""
    same = np.ones(2 * REACH, bool)
    for found, value in zip(objects, values):
        near = _peek(SIZE * (place(found) + 1 - REACH), 2 * REACH, np.int64 if isinstance(value, int) else float)
        # What lies before or behind them may be a copy.
        same &= near == value if len(near) == len(same) else False
    behind = np.flatnonzero(same) - REACH
    require_memory(len(behind) == 1, name)
    return int(behind[0])


class Places:
    """Where vectors and numbers of many numbered objects lie, to be read and written together.

    vectors: {name: function that gives the vector of an object by reference}; numbers: {name: (vector, how far behind
    it)}, see `offset`; groups: {name: names of vectors and numbers that are read at once}. All of these names can be
    read and written. An object must be kept as long as it is.
    """

    def __init__(self, count, *, vectors, numbers, groups):
        self.vectors = vectors
        order = {name: k for k, name in enumerate(vectors)}
        columns = {name: [(k, along) for along in range(3)] for name, k in order.items()}
        columns |= {name: [(order[vector], behind)] for name, (vector, behind) in numbers.items()}
        columns |= {name: [column for part in parts for column in columns[part]] for name, parts in groups.items()}
        self.rows = {name: np.array(of).T[:, :, None] for name, of in columns.items()}
        self.places = {name: np.zeros((len(of), count), np.int64) for name, of in columns.items()}

    def find(self, numbers, objects):
        """The objects of these numbers (k,) are `objects` from now on."""
        self._set(numbers, np.array([places(list(map(vector, objects))) for vector in self.vectors.values()]))

    def _set(self, numbers, first):
        """The vectors of these objects (k,) lie there, (v, k) indices in MEMORY, from now on."""
        for name, (vector, along) in self.rows.items():
            self.places[name][:, numbers] = first[vector[:, 0]] + along

    def of(self, name, numbers=None):
        """(c, k) indices in MEMORY of what lies under this name in the objects (k,), or in all of them."""
        return self.places[name] if numbers is None else self.places[name].take(numbers, axis=1)

    def read(self, name, numbers=None):
        """(c, k) what lies under this name in the objects (k,), or in all of them."""
        # MEMORY has no end that an index could be beyond, and to look for one takes time.
        return MEMORY.take(self.of(name, numbers), mode="wrap")

    def write(self, name, numbers, values):
        """Set it to the values, (c, k) or what broadcasts to it."""
        MEMORY[self.of(name, numbers)] = values


# ---- bodies

TRIED = 5
"""States of bodies, or contacts, that are made to find out how they lie in memory."""


@cache
def _position():
    """How far behind its velocity YADE keeps the position of a body, which it gives by value only. Raises
    ParameterError."""
    states = [State() for _ in range(TRIED)]
    for k, state in enumerate(states):
        state.pos = [mark * (k + 1.0) for mark in MARKS]
    check(states[0], {"velocity": attrgetter("vel"), "spin": attrgetter("angVel")})
    found = [offset("position", [state.vel for state in states], [state.pos[along] for state in states]) - along
             for along in range(3)]
    require_memory(found[0] == found[1] == found[2], "position")
    return found[0]


DEGREES = "xyzXYZ"
"""Degrees of freedom of a body, as YADE names them: the bits of its mask of blocked ones, the lowest first."""


@cache
def _blocked():
    """How far behind a body's state YADE keeps the mask of its blocked degrees of freedom. Raises ParameterError."""
    states, same = [State() for _ in range(TRIED)], np.ones(REACH, bool)
    for k, state in enumerate(states):
        mask = 11 * (k + 1) % 64
        state.blockedDOFs = "".join(name for bit, name in enumerate(DEGREES) if mask >> bit & 1)
        near = _peek(SIZE * (place(state) + 1), REACH, np.int64)
        same &= near & 0xffffffff == mask if len(near) == REACH else False
    found = np.flatnonzero(same)
    require_memory(len(found) == 1, "blocked degrees of freedom")
    return int(found[0])


class Motions(Places):
    """Where these bodies are and how they move now; here they are numbered from 0. bodies: ids.

    "velocity" (m/s) and "spin" (rad/s) are vectors; "in_plane" is x, y (m), "moving" their rates (m/s), "turning" that
    about z (rad/s).
    """

    def __init__(self, bodies):
        self.states = [O.bodies[body].state for body in bodies]
        x = _position()
        super().__init__(
            len(self.states), vectors={"velocity": attrgetter("vel"), "spin": attrgetter("angVel")},
            numbers={"x": ("velocity", x), "y": ("velocity", x + 1), "vx": ("velocity", 0), "vy": ("velocity", 1),
                     "turning": ("spin", 2)},
            groups={"in_plane": ("x", "y"), "moving": ("vx", "vy")})
        layout = kernel_layout()
        found = compiled.states_of(WORDS, layout, list_of_bodies(), np.array(bodies, np.int64))
        self._set(np.arange(len(self.states)), found + layout[[compiled.VELOCITY, compiled.SPIN], None])


# ---- contacts

CONTAINER = 24
"""Words of YADE's container of contacts among which its list of them is looked for."""


def class_of(found):
    """What all objects of YADE's of one class begin with: the place of its functions."""
    return int(WORDS[place(found)])


_FORCES = {"normal_force": "normalForce", "shear_force": "shearForce", "viscous_force": "normalViscous"}
_CONSTANTS = {"friction": "tangensOfFrictionAngle", "kn": "kn", "ks": "ks", "cn": "cn"}
_GEOMETRY = {"normal": "normal", "increment": "shearInc", "point": "contactPoint"}
"""Vectors and numbers of a contact: their names in YADE."""


@cache
def contact_layout():
    """{name: how far behind} of a contact's pointers to its geometry and its constants and of its two bodies; behind
    the constants, of the forces (N), the friction and the stiffness and damping (N/m, N s/m) of a contact with
    friction, of which the viscous ones are there at the tool only; behind the geometry, of the normal, the shear
    increment and the point of contact (m). Raises ParameterError."""
    geoms, physes = [ScGeom() for _ in range(TRIED)], [FrictViscoPhys() for _ in range(TRIED)][::-1]
    contacts = [Interaction(id1=11 * k, id2=12345 + k) for k in range(TRIED)]
    marks = {name: [mark * (1.0 + k) for mark in MARKS * TRIED] for k, name in enumerate(_CONSTANTS)}
    for k, (contact, geom, phys) in enumerate(zip(contacts, geoms, physes)):
        contact.geom, contact.phys = geom, phys
        for name, attribute in _CONSTANTS.items():
            setattr(phys, attribute, marks[name][k])
    found = {}
    for one, names in ((physes[0], _FORCES), (geoms[0], _GEOMETRY)):
        vectors = {name: attrgetter(attribute) for name, attribute in names.items()}
        check(one, vectors)
        found |= {name: place(vector(one)) - place(one) for name, vector in vectors.items()}
    # A class has its table of functions first.
    require_memory(class_of(physes[0]) == class_of(physes[1]) != class_of(geoms[0]), "class")
    return {"geom": offset("geom", contacts, [SIZE * (place(geom) + 1) for geom in geoms]),
            "phys": offset("phys", contacts, [SIZE * (place(phys) + 1) for phys in physes]),
            "bodies": offset("bodies", contacts, [contact.id1 + (contact.id2 << 32) for contact in contacts]),
            **{name: offset(name, physes, values) for name, values in marks.items()}, **found}


@cache
def kernel_layout():
    """(18,) what compiled.CONTACT says, of contacts and of bodies. Raises ParameterError."""
    bodies, states = [Body() for _ in range(TRIED)], [State() for _ in range(TRIED)][::-1]
    for body, state in zip(bodies, states):
        # The state a body is made with can lie right behind it, and with it a second pointer to that state.
        body.state = state
    found = {**contact_layout(), "state": offset("state", bodies, [SIZE * (place(state) + 1) for state in states]),
             **{name: place(getattr(states[0], of)) - place(states[0])
                for name, of in (("velocity", "vel"), ("spin", "angVel"))}}
    found["position"], found["blocked"] = found["velocity"] + _position(), _blocked()
    return np.array([found[name] for name in compiled.CONTACT])


def list_of_bodies():
    """Index in MEMORY of the pointer to the list of the scene's bodies, by number: pairs of pointers, to the body and
    to the count of its owners. A body that has been erased is no pointer. Raises ParameterError."""
    return place(O.bodies) + _word_of_bodies()


@cache
def _word_of_bodies():
    """Which word of the container of bodies begins the list of them."""
    bodies = map(O.bodies.__getitem__, range(len(O.bodies)))
    return _word_of_list("list of bodies", O.bodies, [0 if one is None else SIZE * (place(one) + 1) for one in bodies])


FORCES, TORQUES = 32, 3
"""Words of YADE's scene among which its forces are looked for, and from these on to torques."""
COMPARED = 1000
"""Bodies whose forces are compared."""


def lists_of_forces():
    """Indices in MEMORY of the pointers to the lists of the scene's forces and torques (compiled.exerted). Raises
    ParameterError."""
    word = _word_of_forces()
    return place(O.forces) + word, place(O.forces) + word + TORQUES


@cache
def _word_of_forces():
    """Which word of the scene is that of forces: there is for all bodies what Python has. Where the first body feels
    none, it takes some meanwhile; without any YADE may have no list yet."""
    still = not np.any(O.forces.f(0)) and not np.any(O.forces.t(0))
    added = np.array(MARKS) if still else np.zeros(3)
    O.forces.addF(0, added)
    O.forces.addT(0, added)
    try:
        return _word_with_forces(place(O.forces))
    finally:
        O.forces.addF(0, -added)
        O.forces.addT(0, -added)


def _word_with_forces(scene):
    size, bodies = 3 * SIZE * O.numThreads, range(min(len(O.bodies), COMPARED))
    for word in range(FORCES):
        begin, end, _ = _peek(SIZE * (scene + 1 + word), 3, np.int64).tolist()
        if end - begin != size or not all(map(_is_list, _peek(begin, size // SIZE, np.int64).reshape(-1, 3).tolist())):
            continue
        # Beyond the end of the list of permanent ones Python has any numbers.
        last = int(np.subtract(*WORDS[scene + word + compiled.PERMANENT:][1::-1])) // (3 * SIZE) or len(bodies)
        exerted = [[tuple(given(body)) for body in bodies[:last]] for given in (O.forces.f, O.forces.t)]
        if all(np.array_equal([compiled.exerted(MEMORY, WORDS, scene + word + behind, body) for body in bodies[:last]],
                              values) for behind, values in zip((0, TORQUES), exerted)):
            # To have their values YADE would have to make the sums, which changes what it has.
            summed = scene + 1 + word + compiled.SUMMED
            require_memory(all(_is_list(_peek(SIZE * (summed + behind), 3, np.int64).tolist())
                               for behind in (0, TORQUES)), "sum of forces")
            return word
    require_memory(False, "forces")
    return None


def _is_list(ends):
    """Whether these begin, end and end of the room, bytes, are those of a list of vectors; that of a thread may be
    empty."""
    begin, end, _ = ends
    return begin == end or (begin % SIZE == 0 and 0 < begin < end and (end - begin) % (3 * SIZE) == 0
                            and len(_peek(begin, 1)) == 1)


def list_of_contacts():
    """Index in MEMORY of the pointer to the list of the scene's contacts, as `list_of_bodies`."""
    return place(O.interactions) + _word_of_contacts()


@cache
def _word_of_contacts():
    """Which word of the container of contacts begins the list of them."""
    return _word_of_list("list of contacts", O.interactions,
                         [SIZE * (place(contact) + 1) for contact in O.interactions.all()])


def _word_of_list(name, container, pointers):
    """Which word of a container of YADE's begins its list of what these `pointers` point to. Raises ParameterError."""
    for word in range(CONTAINER):
        begin, end = _peek(SIZE * (place(container) + 1 + word), 2, np.int64).tolist()
        if end - begin == 2 * SIZE * len(pointers):
            found = _peek(begin, 2 * len(pointers), np.int64)[::2]
            if np.array_equal(found, pointers):
                return word
    require_memory(False, name)
    return None

"""What both carriers of bonds share: the laws, the status of each bond, the crack log, the energy dissipated."""
from abc import abstractmethod
from collections import namedtuple

import numpy as np

from rockwear.engines.base import Engine

INTACT, BROKEN, SEPARATED = 0, 1, 2
"""Status of a bond. SEPARATED: broken and erased after its particles had parted; a later contact is a new one."""

Crack = namedtuple("Crack", "time x y z normal_x normal_y normal_z mode energy body_1 body_2")
"""One broken bond: s, m, unit normal, 1 tension or 2 shear, J dissipated in all, ids of the particles."""


class BondLog(Engine):
    """Bonds of the rock with a crack log.

    pairs: (m, 2) body ids; law: of rockwear.kernels.bond_laws; laws: (m,), the law of each bond, `law` itself if not
    given; clock: a function giving the time (s) for the crack log. `broken` {number: (interaction, phys)} are bonds
    that are frictional contacts with the reference length of the bond; `energy_released` (J) what bonds dissipated,
    `energy_crushed` the part of it that crushing took.
    """

    name = "bonds"

    def __init__(self, *, pairs, law, laws=None, clock, period=1):
        super().__init__(period=period)
        self.pairs = np.asarray(pairs)
        # In the order in which YADE has the two bodies.
        self.ends = self.pairs.copy()
        self.law, self.laws = law, [law] * len(self.pairs) if laws is None else laws
        self.status = np.full(len(self.pairs), INTACT, np.int8)
        self.cracks, self.broken, self.clock = [], {}, clock
        self.counted = crack_counts([])
        self.energy_released = self.energy_crushed = 0.0
        self.parted = []
        """Numbers of the bonds that have separated since `RockContacts` took note of them."""

    @property
    def energy_breaking(self):
        """J that bonds dissipated, but in crushing."""
        return self.energy_released - self.energy_crushed

    def begin(self, there):
        """Only these bonds (m,) bool are there at first; the others may be made later."""
        self.status[~there] = SEPARATED

    @abstractmethod
    def bond(self, numbers):
        """Give the new interactions of the bonds `numbers` (k,) their constants, after the step that made them."""

    def renew(self, left, made, longer):
        """Rock has been replaced between two steps: the bonds `left` (k,) are gone, `made` (l,) have just been made.

        longer (l,): m by which the particles of each are further apart than where it is without force.
        """
        for n in left.tolist():
            self._separate(n)
        self.status[made] = INTACT
        self.bond(made)
        self._take_up(made)
        for n, shift in zip(made.tolist(), longer.tolist()):
            self._shift(n, shift)

    @abstractmethod
    def _separate(self, n):
        """Forget the bond n."""

    @abstractmethod
    def _take_up(self, numbers):
        """Follow these new bonds from now on."""

    @abstractmethod
    def _shift(self, n, shift):
        """Raise the reference overlap of bond n by `shift` (m). -> its geom and phys."""

    def expand(self, numbers, growth, overlap):
        """Radii have grown: r_i + r_j of bonds `numbers` by `growth`, their reference overlap by `overlap` (m).

        -> J, the work of the expansion against the forces of the last step.
        """
        work = 0.0
        for n, longer, shift in zip(numbers.tolist(), growth.tolist(), overlap.tolist()):
            if self.status[n] == SEPARATED:
                continue
            geom, phys = self._shift(n, shift)
            pressing = phys.normalForce.dot(geom.normal)
            if pressing or self.status[n] == INTACT:
                work += (longer - shift) * (pressing + 0.5 * phys.kn * (longer - shift))
        return work

    def in_contact(self):
        """(m,) bool: bonds that are intact, or broken and under compression; these conduct heat."""
        touching = self.status == INTACT
        for n, (_, phys) in self.broken.items():
            touching[n] = phys.normalForce.squaredNorm() > 0
        return touching

    def take_slip_work(self, particles):
        """(particles,) J that slip within bonds has dissipated since the last call: each particle half of its bonds'.

        Only bonds of YADE's concrete model tell: others soften in one with their slip.
        """
        return np.zeros(particles)

    def state(self):
        return {"status": self.status.copy(), "energy_released": self.energy_released,
                "energy_crushed": self.energy_crushed,
                "cracks": crack_array(self.cracks)}

    def restore(self, state):
        self.status = state["status"].copy()
        self.energy_released, self.energy_crushed = float(state["energy_released"]), float(state["energy_crushed"])
        self.cracks = cracks_of(state["cracks"])
        self.counted = crack_counts([])

    def log(self):
        # Rows come often, and a long cut has many cracks.
        modes = [number for number, _ in self.counted.values()]
        new = crack_counts(self.cracks[sum(modes):])
        self.counted = {name: (before + number, unit) for before, (name, (number, unit)) in zip(modes, new.items())}
        return dict(self.counted)


def crack_array(cracks):
    """(cracks, fields of Crack) numbers."""
    return np.array(cracks, float).reshape(-1, len(Crack._fields))


def cracks_of(array):
    """[Crack] of what `crack_array` gave."""
    return [Crack(*row[:7], int(row[7]), row[8], int(row[9]), int(row[10])) for row in array.tolist()]


def crack_counts(cracks):
    """{name: (number, unit)} of cracks by mode."""
    modes = [crack.mode for crack in cracks]
    return {"tensile_cracks": (modes.count(1), "-"), "shear_cracks": (modes.count(2), "-")}

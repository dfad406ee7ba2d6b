"""A rock mass: rock that has no end along the cut, of which a window that moves with the tool is simulated."""
from dataclasses import replace
from functools import cached_property

import numpy as np

from rockwear.kernels import packing
from rockwear.kernels.continued import continued
from rockwear.kernels.elastic_moduli import elastic_moduli
from rockwear.kernels.fragments import pieces
from rockwear.kernels.strip import StraightStrip
from rockwear.kernels.voronoi import periodic_cells
from rockwear.model.rock import RockAssembly, packed_box

SLABS = 16
"""Parts of the window that leave it and enter it as one."""
RIM = 6
"""Largest radii next to bottom and surface that do not count for the moduli."""
MISFIT = 2e-4
"""Parts of the window's height by which the distance of two particles may differ from that in untouched rock to be
bonded. That is some micrometres; a crack of a sandstone has lost its force when it is open by tens."""
FITS = 5e-5
"""Parts of the window's height by which half of the bonds with rock that fits are off: 1 um in 20 mm. Without load, and
when no blow shakes the rock, it is 0.1 to 0.4 um."""
FEW = 0.05
"""Part of those bonds that are left out where rock fits: of loose discs at the surface. A blow leaves out more, down
the whole seam, and the rock would enter cracked."""
WHOLE = 5e-3
"""Parts of the window's height by which uncracked rock at its end may be displaced: under 400 kN/m it is 25 um, 25 mm
away; chips go further."""
MOST_TENSE, MOST_PRESSED = 1e-4, 1e-3
"""Strains by which bonds of rock that enters are pulled and pressed at most; it is to enter unbroken."""
TELLING = 2, 1
"""Slabs at the end of the window that tell how it is displaced, whichever fits better: there may be a crack between
two."""
PARKED = 3.0
"""Particles that are not in the rock yet stand so many heights of the window below it, and their largest diameters
apart."""


class RockMass(RockAssembly):
    """Discs of a packing that repeats itself along a strip with the length of the window, 1 m thick.

    A particle keeps its number and its `positions` in the period of the strip, 0 <= x < width; `laps` (n,) counts how
    many periods further on it stands in the rock, at x + lap width. Along an arc discs are enlarged as the strip is
    stretched there. The window holds each particle once. It moves by
    slabs: the slab that lies furthest behind leaves it, and goes in again ahead as untouched rock, with a lap more.
    `crossing` (m,): periods from the first particle of a bond to the image of the second that it is bonded with; the
    bond is there while their laps differ by that. `absent` (n,) bool: particles that are not there: the groove in which
    the tool begins, what is above the rock's surface, chips in the way.

    width, height: m of the window in the strip; strip: of kernels.strip, straight by default; surface: (x (k,), y (k,))
    m of the strip, the rock's surface, which no centre is above, at y = height by default; extent: (2,) m that pictures
    show, the window by default; others as of a Specimen. Raises ParameterError naming the parameter.
    """

    def __init__(self, *, width, height, radius_min, radius_max, porosity, seed, bonding_gap, grading_factor=1.0,
                 fine_depth=0.035, density, strip=StraightStrip(), surface=None, extent=None):
        stored, pairs = packed_box(
            width=width, height=height, radius_min=radius_min, radius_max=radius_max, porosity=porosity, seed=seed,
            bonding_gap=bonding_gap, grading_factor=grading_factor, fine_depth=fine_depth, along=True)
        self.period = np.array([width, 0.0])
        self.strip, self.surface, self.stretch = strip, surface, strip.stretch(stored["positions"])
        super().__init__(positions=stored["positions"], radii=self.stretch * stored["radii"], width=width,
                         height=height, density=density, pairs=pairs, scale=self.stretch * stored["scale"],
                         porosity=1 - float(np.sum(np.pi * stored["radii"]**2)) / (width * height))
        self.extent = self.extent if extent is None else extent
        i, j = pairs.T
        x = self.positions[:, 0]
        self.crossing = np.rint((x[i] - x[j]) / width).astype(int)
        self.slab = np.minimum((x / self.slab_length).astype(int), SLABS - 1)
        self.laps = np.zeros(self.count, int)
        x, y = self.points.T
        self.absent = y > self.top(x)
        self.passed = 0
        """Slabs that have left the window."""

    def top(self, x):
        """Height (m) of the rock's surface at x (m) of the strip."""
        return self.height if self.surface is None else np.interp(x, *self.surface)

    @property
    def points(self):
        """(n, 2) m of the particles in the strip, in untouched rock."""
        return self.positions + self.laps[:, None] * self.period

    @property
    def bond_lengths(self):
        """(m,) m between the centres of each pair."""
        i, j = self.pairs.T
        return self.strip.lengths(self.positions[i], packing.separation(self.positions, i, j, self.period))

    @property
    def slab_length(self):
        """m of a slab."""
        return self.width / SLABS

    @property
    def begin(self):
        """x (m) of the window's left end in the strip."""
        return self.passed * self.slab_length

    @property
    def end(self):
        """x (m) of the window's right end in the strip."""
        return self.begin + self.width

    @property
    def places(self):
        """(n, 2) m of the particles in untouched rock; absent ones stand aside."""
        places = self.strip.place(self.points)
        aside = np.flatnonzero(self.absent)
        spacing = 2.5 * float(self.radii.max())
        row, column = np.divmod(aside, max(1, int(self.width / spacing)))
        places[aside] = np.column_stack([column * spacing, -PARKED * self.height - row * spacing])
        return places

    @property
    def frame(self):
        """(2,) m, the lower left corner of pictures."""
        return self.strip.frame(self.begin)

    def shown(self, positions):
        """Places (n, 2) m in pictures of particles at `positions` (n, 2) m; nan for those that are not there."""
        return np.where(self.absent[:, None], np.nan, positions - self.frame)

    @property
    def bonded(self):
        """(m,) bool: bonds that the window's rock has while nothing has broken it."""
        i, j = self.pairs.T
        return (self.laps[j] - self.laps[i] == self.crossing) & ~self.absent[self.pairs].any(axis=1)

    @property
    def anchored(self):
        """(n,) bool: particles at the bottom, which hold what is rock and no chip."""
        return self.positions[:, 1] < 1.05 * self._radii

    @property
    def _radii(self):
        """(n,) m in the strip."""
        return self.radii / self.stretch

    def at_ends(self):
        """(numbers of the particles at the left end, those at the right end) of the window now."""
        x = self.positions[:, 0] + self.laps * self.width
        here = ~self.absent
        return (np.flatnonzero(here & (x - self.begin < 1.05 * self._radii)),
                np.flatnonzero(here & (self.end - x < 1.05 * self._radii)))

    def goes_on(self):
        """(n,) bool, particles at the window's bottom and ends now."""
        found = self.anchored.copy()
        found[np.concatenate(self.at_ends())] = True
        return found

    def leave_out(self, gone):
        """Particles (n,) bool that are not there at first."""
        self.absent = np.asarray(gone, bool).copy()

    def advance(self):
        """Move the window by a slab. -> numbers (k,) of the particles that left it behind and enter it ahead."""
        moved = np.flatnonzero(self.slab == self.passed % SLABS)
        self.laps[moved] += 1
        x, y = self.points[moved].T
        self.absent[moved] = y > self.top(x)
        self.passed += 1
        return moved

    def fit(self, moved, positions, intact):
        """Fit the slab that enters to the rock that is there.

        positions: (n, 2) m, where that is now; intact: (m,) bool, bonds up to now.

        Rock at the end of the window is displaced and strained by the cut: the slab enters as its displacement goes on.
        A crack may have reached the end, and chips may lie beyond it. Bonds with the slab that would be longer or
        shorter than in untouched rock by more than MISFIT are left out, and what the slab would overlap by more than
        that is absent from now on.

        -> (k, 2) m of the slab's displacement; bonds (m,) bool that are made; (m,) m by which bonds are longer than
        without force; numbers (l,) of the particles in the way.
        """
        i, j = self.pairs.T
        new = np.isin(np.arange(self.count), moved)
        made = self.bonded & (new[i] | new[j])
        _, displacement, now, longer = self._entering(moved, new, positions, intact)
        made &= (new[i] & new[j]) | (abs(longer) <= MISFIT * self.height)
        longer = np.clip(longer, -MOST_PRESSED * self.bond_lengths, MOST_TENSE * self.bond_lengths)
        overlapping = packing.contacts(now, self.radii, -MISFIT * self.height)
        a, b = overlapping[new[overlapping[:, 0]] ^ new[overlapping[:, 1]]].T
        joined = np.isin(a * self.count + b, self.pairs[made] @ [self.count, 1])
        in_the_way = np.unique(np.where(new[a], b, a)[~joined])
        self.absent[in_the_way] = True
        return displacement, made & ~self.absent[self.pairs].any(axis=1), longer, in_the_way

    def misfit(self, positions, intact):
        """How badly the slab that enters next would fit to the rock that is there, up to 1 well: of their bonds, by how
        much the middle one would be longer or shorter than in untouched rock, over FITS, or the part that would be left
        out, over FEW, whichever is more. positions (n, 2) m, intact (m,): as for `fit`."""
        before, moved = self.state(), self.advance()
        found = self._entering(moved, np.isin(np.arange(self.count), moved), positions, intact)
        self.restore(before)
        return found[0]

    def _entering(self, moved, new, positions, intact):
        """`misfit` of the slab that enters, its displacement (k, 2) m, (n, 2) m of all particles with it, (m,) m by
        which their bonds are longer than in untouched rock.

        Its displacement is that of the rock mass at the end of the window. Where half of that is loose, or displaced by
        more than rock that is whole, there is none.
        """
        (i, j), places, fits, found = self.pairs.T, self.places, [], []
        displaced, there = positions - places, ~new & ~self.absent
        points = (self.points - [self.end - self.slab_length, 0.0]) / self.height
        piece = pieces(self.count, self.pairs, intact & there[self.pairs].all(axis=1))
        for slabs in TELLING:
            near = there & (points[:, 0] > -slabs * self.slab_length / self.height)
            whole = near & np.isin(piece, piece[near & self.anchored])
            whole &= np.linalg.norm(displaced, axis=1) < WHOLE * self.height
            fits.append(continued(points[whole], displaced[whole], points[moved], tolerance=MISFIT * self.height,
                                  least=0.5 * np.count_nonzero(near)))
        seam = self.bonded & (new[i] ^ new[j])
        for displacement in [fit for fit in fits if fit is not None] or [np.zeros((len(moved), 2))]:
            now = positions.copy()
            now[moved] = places[moved] + displacement
            longer = np.linalg.norm(now[i] - now[j], axis=1) - self.bond_lengths
            off = abs(longer[seam]) if seam.any() else np.zeros(1)
            misfit = max(np.median(off) / (FITS * self.height), np.mean(off > MISFIT * self.height) / FEW)
            found.append((float(misfit), displacement, now, longer))
        return min(found, key=lambda one: one[0])

    def moduli(self):
        """kernels.elastic_moduli.Moduli of the bonded packing, the same in the strip and in the plane."""
        rim = RIM * self._radii.max()
        kn, kt = self.stiffness()
        return elastic_moduli(positions=self.positions, radii=self._radii, bonds=self.pairs, kn=kn, kt=kt,
                              box=((0.0, rim), (self.width, self.height - rim)), periodic=(True, False))

    def layouts(self):
        """(positions (n, 2) m, bonds (m,) bool) pairs that show every bond at least once between neighbours as they
        lie."""
        i, j = self.pairs.T
        rolled = self.positions.copy()
        rolled[:, 0] = (rolled[:, 0] + 0.5 * self.width) % self.width
        within_one = abs(rolled[i, 0] - rolled[j, 0]) < 0.5 * self.width
        return [(self.strip.place(self.positions), self.crossing == 0), (self.strip.place(rolled), within_one)]

    @cached_property
    def cells(self):
        """kernels.voronoi.Cells: the part of the period that each particle stands for, with its volume in the plane and
        its faces in the strip, whose conductances are the same."""
        found = periodic_cells(self.positions, period=self.width, height=self.height)
        return replace(found, volumes=self.stretch**2 * found.volumes)

    def state(self):
        """What a restart needs."""
        return {"laps": self.laps.copy(), "absent": self.absent.copy(), "passed": self.passed}

    def restore(self, state):
        """Take back what `state` gave."""
        self.laps, self.absent = state["laps"].astype(int), state["absent"].astype(bool)
        self.passed = int(state["passed"])

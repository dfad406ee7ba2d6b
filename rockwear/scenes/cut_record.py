"""Record of the rock that a moving window has left behind: the groove, and the chips."""
import numpy as np

from rockwear.kernels.fragments import fragments, free_fragments
from rockwear.kernels.groove import groove_profile
from rockwear.model.rock_mass import SLABS

GROOVE = "x height".split()
CHIPS = "distance particles area length thickness y".split()
UNITS = dict(x="m", height="m", distance="m", particles="-", area="m2", length="m", thickness="m", y="m")


class CutRecord:
    """What slabs of a model.rock_mass.RockMass are like when they leave the window.

    Places count from where the tool's tip began: x along the cut, y above its path. A chip is measured whole when the
    first of its particles leaves, with all particles that are still bonded then; what it breaks into later is no chip
    again.

    start: (2,) m.
    """

    def __init__(self, *, rock, start):
        self.rock, self.start = rock, start
        self.groove, self.chips = [], []
        self.noted = np.zeros(rock.count, bool)
        self.bins = max(1, round(rock.slab_length / (2 * float(rock.radii.min()))))

    def note(self, *, positions, intact, distance):
        """The slab behind is about to leave. positions (n, 2) m; intact (m,) bool; distance: m of cut so far."""
        rock = self.rock
        leaving = (rock.slab == rock.passed % SLABS) & ~rock.absent
        groove, chips, members = self._found(positions, intact, distance, rock.begin + rock.slab_length, leaving)
        self.groove += groove
        self.chips += chips
        self.noted |= members
        self.noted[leaving] = False

    def record_free_chips(self, *, positions, intact, distance, pairs, held):
        """Record the chips that nothing touches, which are about to be removed. pairs, held: see kernels.fragments.
        free_fragments. -> their particles (k,)."""
        found = self._fragments(positions, intact)
        gone = free_fragments(found.label, pairs, held)
        self.chips += self._chips(found, np.unique(found.label[gone & ~self.noted]), distance)
        self.noted[gone] = False
        return np.flatnonzero(gone)

    def whole(self, *, positions, intact, distance, behind):
        """(groove, chips) rows: what is noted, and what stands and lies in the window further back than x = `behind`
        (m) now."""
        groove, chips, _ = self._found(positions, intact, distance, behind,
                                       (positions[:, 0] < behind) & ~self.rock.absent)
        return self.groove + groove, self.chips + chips

    def _found(self, positions, intact, distance, end, leaving):
        """Rows of groove and chips up to x = `end`, and which particles (n,) these chips have."""
        rock, found = self.rock, self._fragments(positions, intact)
        step = rock.slab_length / self.bins
        edges = np.arange(rock.begin, end + 0.5 * step, step)
        heights = groove_profile(positions, rock.radii, (found.label < 0) & ~rock.absent, edges) - self.start[1]
        middles = 0.5 * (edges[1:] + edges[:-1]) - self.start[0]
        groove = [row for row in zip(middles.tolist(), heights.tolist()) if row[0] > 0]
        labels = np.unique(found.label[leaving & ~self.noted & (found.label >= 0)])
        return groove, self._chips(found, labels, distance), np.isin(found.label, labels)

    def _fragments(self, positions, intact):
        """The fragments of the window; particles that are not there are none."""
        rock = self.rock
        return fragments(pairs=rock.pairs, intact=intact, positions=positions, areas=np.pi * rock.radii**2,
                         anchored=rock.anchored | rock.absent)

    def _chips(self, found, labels, distance):
        """Rows of these fragments."""
        return [(distance, int(found.particles[k]), *(float(values[k]) for values in (
            found.area, found.length, found.thickness, found.centre[:, 1] - self.start[1]))) for k in labels.tolist()]

    def state(self):
        """What a restart needs."""
        return {"groove": np.array(self.groove, float).reshape(-1, len(GROOVE)),
                "chips": np.array(self.chips, float).reshape(-1, len(CHIPS)), "noted": self.noted.copy()}

    def restore(self, state):
        """Take back what `state` gave."""
        self.groove = [tuple(row) for row in state["groove"].tolist()]
        self.chips = [(row[0], int(row[1]), *row[2:]) for row in state["chips"].tolist()]
        self.noted = state["noted"].astype(bool)


def table(names, rows):
    """(header, rows) of a table of these columns."""
    return [f"{name} [{UNITS[name]}]" for name in names], rows

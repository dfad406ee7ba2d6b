"""How a body made of particles loses them: worn volume per particle, removal, and the volume book (M 6.5, P 4.3)."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from rockwear.kernels.checks import ParameterError, require


def depth_limit(radii, volumes, thickness=1.0):
    """Worn volume at which a particle goes by the sources' rule: depth w = 2 r over the area 2 r b, 4 r^2 b.

    (M 6.5, P 4.3: "accumulated wear exceeds the particle diameter".) radii: (n,) m; thickness b: m. -> (n,) m3.
    """
    return 4 * np.asarray(radii) ** 2 * thickness


def volume_limit(radii, volumes, thickness=1.0):
    """Worn volume at which a particle goes when volume is conserved: the volume that the particle stands for, (n,) m3."""
    return np.asarray(volumes, float)


def no_limit(radii, volumes, thickness=1.0):
    """No particle ever goes: wear is only booked, and the shape stays (M 8.2, 13.3). -> (n,) m3."""
    return np.full(len(volumes), np.inf)


REMOVAL = {"volume": volume_limit, "depth": depth_limit, "none": no_limit}


class Erosion:
    """Worn volume on a particle body, and the removal of its particles.

    radii: (n,) m; volumes: (n,) m3, the part of the body's volume that each particle stands for; pairs: (m, 2)
    particles that cover one another and hold together; surface: indices of particles open to wear at first; fixed:
    indices of those held by the shank; thickness: m, one or (n,), of what a particle stands for across: 1 in the plane,
    2 r for a sphere, whose face is then the square (2 r)^2; rule: "volume" (conserving: the excess over a particle's
    volume passes to what its removal uncovers, so that removed + stored = Archard's volume at every moment), "depth"
    (the sources': no excess is passed on) or "none".
    `worn` is the volume that the wear law took from each particle, `stored` what of it has not led to a removal yet.
    Raises ParameterError for an unknown rule, an index out of range, or volumes that are not positive.
    """

    def __init__(self, *, radii, volumes, pairs, surface, fixed=(), rule="volume", thickness=1.0):
        require(rule in REMOVAL, "removal", rule, f"one of {', '.join(REMOVAL)}")
        self.radii, self.volumes = np.asarray(radii, float), np.asarray(volumes, float)
        require(self.volumes.size > 0 and np.all(self.volumes > 0), "volumes", float(np.min(self.volumes, initial=0)),
                "greater than 0", "m3")
        count = len(self.volumes)
        self.pairs = np.asarray(pairs, int).reshape(-1, 2)
        for name, indices in (("pairs", self.pairs), ("surface", np.asarray(surface)), ("fixed", np.asarray(fixed))):
            if indices.size and not (0 <= indices.min() and indices.max() < count):
                raise ParameterError(name, int(indices.max()), f"an index from 0 to {count - 1}")
        self.rule, self.conserving = rule, rule == "volume"
        self.limit = REMOVAL[rule](self.radii, self.volumes, thickness)
        self.areas = 2 * self.radii * thickness
        self.fixed = np.zeros(count, bool)
        self.fixed[np.asarray(fixed, int)] = True
        self.alive = np.ones(count, bool)
        self.surface = set(int(i) for i in surface)
        self.stored = np.zeros(count)
        self.worn = np.zeros(count)
        self.archard_volume = 0.0
        self.lost_with_pieces = 0.0
        self.beyond = 0.0
        neighbours = [[] for _ in range(count)]
        for i, j in self.pairs.tolist():
            neighbours[i].append(j)
            neighbours[j].append(i)
        self._neighbours = neighbours

    def wear(self, volume):
        """Add worn volume (n,) m3 and remove what is worn away. -> (removed, uncovered) lists of indices, in order.

        All that are worn out go at once, and then those that their excess wears out, so that numbering decides nothing.
        With the conserving rule the excess goes in equal parts to the particles that a removal uncovers, or where it
        uncovers none to the nearest particles that are left: no volume is ever lost.
        """
        self.archard_volume += float(np.sum(volume))
        self.worn += volume
        self.stored += volume
        removed, uncovered = [], []
        while worn_out := sorted(i for i in self.surface if self.stored[i] >= self.limit[i]):
            newly = self._take(worn_out)
            removed += worn_out
            uncovered += newly
            excess = (self.stored - self.volumes)[worn_out]
            self.stored[worn_out] = 0.0
            if self.conserving:
                self._pass_on(worn_out, excess, set(newly))
        return removed, [i for i in uncovered if self.alive[i]]

    def _take(self, worn_out):
        self.alive[worn_out] = False
        self.surface.difference_update(worn_out)
        newly = sorted({j for i in worn_out for j in self._neighbours[i] if self.alive[j]} - self.surface)
        self.surface.update(newly)
        return newly

    def _pass_on(self, worn_out, excess, newly):
        for i, volume in zip(worn_out, excess):
            heirs = [j for j in self._neighbours[i] if j in newly] or self._nearest_alive(i)
            self.stored[heirs] += volume / max(1, len(heirs))
            if not heirs:
                self.beyond += float(volume)

    def _nearest_alive(self, i):
        """Living particles nearest to a removed one along contacts, over others that are gone."""
        seen, shell = {i}, [i]
        while shell:
            shell = sorted({j for k in shell for j in self._neighbours[k]} - seen)
            living = [j for j in shell if self.alive[j]]
            if living:
                return living
            seen.update(shell)
        return []

    def detached(self):
        """Indices of living particles no longer connected with an fixed one (all of them when none is fixed)."""
        alive = self.alive[self.pairs].all(axis=1)
        i, j = self.pairs[alive].T
        graph = coo_matrix((np.ones(len(i)), (i, j)), shape=(len(self.alive),) * 2)
        label = connected_components(graph, directed=False)[1]
        fixed = np.unique(label[self.fixed & self.alive])
        return np.flatnonzero(self.alive & ~np.isin(label, fixed))

    def drop(self, indices):
        """Take loose particles out of the body: they leave with their volume, which was not worn."""
        for i in indices:
            self.alive[i] = False
            self.surface.discard(int(i))
            # What was already worn off a loose particle stays booked as worn.
            self.lost_with_pieces += self.volumes[i] - self.stored[i]
            self.stored[i] = 0.0

    @property
    def gone_volume(self):
        """Volume (m3) of all particles taken out so far, worn away or dropped."""
        return float(np.sum(self.volumes[~self.alive]))

    @property
    def mass_fraction_lost(self):
        """Volume taken out over the initial volume, -."""
        return self.gone_volume / float(np.sum(self.volumes))

    def volume_balance(self):
        """The volume book in m3: what Archard's law wore, where it is, and what the removal rule leaves unexplained.

        unexplained = removed + stored - archard: round-off with the conserving rule; with the depth rule the volume
        by which the sources' criterion deviates from V = k F s / H.
        """
        removed = self.gone_volume - self.lost_with_pieces
        stored = float(np.sum(self.stored))
        return {"archard": self.archard_volume, "removed": removed, "stored": stored,
                "unexplained": removed + stored + self.beyond - self.archard_volume,
                "beyond_the_body": self.beyond, "dropped_pieces": self.lost_with_pieces}

    def state(self):
        """What must survive a restart."""
        return {"alive": self.alive.copy(), "surface": np.array(sorted(self.surface), int), "stored": self.stored.copy(), "worn": self.worn.copy(),
                "archard_volume": self.archard_volume, "lost_with_pieces": self.lost_with_pieces, "beyond": self.beyond}

    def restore(self, state):
        """Take back what `state` gave."""
        self.alive, self.stored, self.worn = (state[name].copy() for name in ("alive", "stored", "worn"))
        self.surface = set(state["surface"].tolist())
        self.archard_volume, self.beyond = float(state["archard_volume"]), float(state["beyond"])
        self.lost_with_pieces = float(state["lost_with_pieces"])

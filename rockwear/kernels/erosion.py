"""Wear of a body of particles: worn volume per particle, removal of particles, and the volume balance.

[Rojek 2003, sec. 6.5; Rojek 2014, sec. 4.3]
"""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from rockwear.kernels.checks import ParameterError, require


def depth_limit(radii, volumes, thickness=1.0):
    """Worn volume (n,) m3 at which a particle is removed by the rule of the sources, 4 r^2 b: the depth 2 r over 2 r b.

    "Accumulated wear exceeds the particle diameter" [Rojek 2003, sec. 6.5; Rojek 2014, sec. 4.3]. radii r: (n,) m;
    thickness b: m, one or (n,); volumes: not used.
    """
    return 4 * np.asarray(radii) ** 2 * thickness


def volume_limit(radii, volumes, thickness=1.0):
    """Worn volume (n,) m3 at which a particle is removed with conserved volume: the volume that it represents."""
    return np.asarray(volumes, float)


def no_limit(radii, volumes, thickness=1.0):
    """Infinite (n,): wear is computed, the shape stays [Rojek 2003, sec. 8.2, 13.3]."""
    return np.full(len(volumes), np.inf)


REMOVAL = {"volume": volume_limit, "depth": depth_limit, "none": no_limit}


class Erosion:
    """Worn volume on a particle body, and the removal of its particles.

    radii: (n,) m; volumes: (n,) m3, the part of the body's volume that each particle represents; pairs: (m, 2)
    neighbours, which are connected and cover one another; surface: indices of the initial surface particles; fixed:
    indices of the particles fixed to the shank; thickness: m, one or (n,): 1 in the plane, 2 r for a sphere, whose face
    is then the square (2 r)^2; rule: "volume" (conserving: the excess over a particle's volume is transferred to the
    particles that its removal uncovers, so that removed + stored = Archard's volume at any time), "depth" (that of the
    sources, without transfer) or "none".

    `alive` (n,) bool; `worn` (n,) m3 by the wear law; `stored` (n,) m3, the part of it that no removal has used yet;
    `archard_volume`, `lost_with_pieces` (detached, not worn), `unassigned` (excess without a particle left): m3.
    Raises ParameterError for an unknown rule, an index out of range, and volumes that are not positive.
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
        self.unassigned = 0.0
        neighbours = [[] for _ in range(count)]
        for i, j in self.pairs.tolist():
            neighbours[i].append(j)
            neighbours[j].append(i)
        self._neighbours = neighbours

    def wear(self, volume):
        """Add worn volume (n,) m3 and remove particles at their limit. -> (removed, uncovered) lists of indices.

        All particles at their limit are removed at once, then those that reach it by the excess: the result does not
        depend on the numbering. With the conserving rule the excess of a removed particle is transferred in equal parts
        to the particles that it uncovers, or if there are none to the nearest particles left.
        """
        self.archard_volume += float(np.sum(volume))
        self.worn += volume
        self.stored += volume
        removed, uncovered = [], []
        while worn_out := sorted(i for i in self.surface if self.stored[i] >= self.limit[i]):
            newly = self._remove(worn_out)
            removed += worn_out
            uncovered += newly
            excess = (self.stored - self.volumes)[worn_out]
            self.stored[worn_out] = 0.0
            if self.conserving:
                self._transfer(worn_out, excess, set(newly))
        return removed, [i for i in uncovered if self.alive[i]]

    def _remove(self, worn_out):
        self.alive[worn_out] = False
        self.surface.difference_update(worn_out)
        newly = sorted({j for i in worn_out for j in self._neighbours[i] if self.alive[j]} - self.surface)
        self.surface.update(newly)
        return newly

    def _transfer(self, worn_out, excess, newly):
        for i, volume in zip(worn_out, excess):
            receivers = [j for j in self._neighbours[i] if j in newly] or self._nearest_alive(i)
            self.stored[receivers] += volume / max(1, len(receivers))
            if not receivers:
                self.unassigned += float(volume)

    def _nearest_alive(self, i):
        """Remaining particles with the fewest pairs between them and a removed one."""
        seen, shell = {i}, [i]
        while shell:
            shell = sorted({j for k in shell for j in self._neighbours[k]} - seen)
            remaining = [j for j in shell if self.alive[j]]
            if remaining:
                return remaining
            seen.update(shell)
        return []

    def detached(self):
        """Indices of remaining particles not connected with a fixed one (all of them when none is fixed)."""
        alive = self.alive[self.pairs].all(axis=1)
        i, j = self.pairs[alive].T
        graph = coo_matrix((np.ones(len(i)), (i, j)), shape=(len(self.alive),) * 2)
        label = connected_components(graph, directed=False)[1]
        fixed = np.unique(label[self.fixed & self.alive])
        return np.flatnonzero(self.alive & ~np.isin(label, fixed))

    def drop(self, indices):
        """Remove detached particles; their volume counts as lost, not as worn."""
        for i in indices:
            self.alive[i] = False
            self.surface.discard(int(i))
            # What was worn off a detached particle before stays worn.
            self.lost_with_pieces += self.volumes[i] - self.stored[i]
            self.stored[i] = 0.0

    @property
    def gone_volume(self):
        """Volume (m3) of all particles removed so far, worn or detached."""
        return float(np.sum(self.volumes[~self.alive]))

    @property
    def mass_fraction_lost(self):
        """Removed over initial volume, -."""
        return self.gone_volume / float(np.sum(self.volumes))

    def volume_balance(self):
        """Volume balance (m3) of Archard's law against removed particles.

        unexplained = removed + stored + unassigned - archard: round-off with the conserving rule; with the depth rule
        the volume by which the criterion of the sources deviates from V = k F s / H.
        """
        removed = self.gone_volume - self.lost_with_pieces
        stored = float(np.sum(self.stored))
        return {"archard": self.archard_volume, "removed": removed, "stored": stored,
                "unexplained": removed + stored + self.unassigned - self.archard_volume,
                "unassigned": self.unassigned, "dropped_pieces": self.lost_with_pieces}

    def state(self):
        """What a checkpoint keeps."""
        return {"alive": self.alive.copy(), "stored": self.stored.copy(), "worn": self.worn.copy(),
                "surface": np.array(sorted(self.surface), int), "unassigned": self.unassigned,
                "archard_volume": self.archard_volume, "lost_with_pieces": self.lost_with_pieces}

    def restore(self, state):
        """Resume from what `state` returned."""
        self.alive, self.stored, self.worn = (state[name].copy() for name in ("alive", "stored", "worn"))
        self.surface = set(state["surface"].tolist())
        self.archard_volume, self.unassigned = float(state["archard_volume"]), float(state["unassigned"])
        self.lost_with_pieces = float(state["lost_with_pieces"])

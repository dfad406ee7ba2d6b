"""Elastic constants of a bonded packing in the plane, from its stiffness matrix."""
import math
from collections import namedtuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from rockwear.kernels.checks import positive, require
from rockwear.kernels.stability import contact_rows

STRAINS = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 0.5], [0.5, 0.0]]])
"""Unit strains: along x, along y, and an engineering shear of 1."""
HOLD = 1e-11
"""Part of the stiffness of each displacement and rotation that is added to it."""


class Moduli(namedtuple("Moduli", "young poisson shear")):
    """Constants of an isotropic medium of two dimensions: E (N/m per metre of thickness, Pa), nu, and G (Pa).

    Under plane stress E and nu are those of the solid; here there is no third direction at all.
    """

    def speeds(self, density):
        """(c_P, c_S), m/s: sqrt(E / (rho (1 - nu^2))) and sqrt(G / rho). density: kg/m3 of the bulk."""
        return (math.sqrt(self.young / (density * (1 - self.poisson**2))), math.sqrt(self.shear / density))


def stiffness_tensor(*, positions, radii, bonds, kn, kt, box, periodic=(False, False)):
    """C (3, 3) Pa of sigma = C epsilon with (xx, yy, xy), the shear strain in engineering measure.

    Every particle moves as a uniform strain would have it, plus a fluctuation (and turns) that leave it in equilibrium.
    Across a direction that is not periodic, particles with centres outside the box have no fluctuation: a rim of three
    or four diameters around the box holds the strain. Stress: sum f l / area over the parts of the bonds that lie in
    the box. A rim makes the rock up to some 2 % too stiff; a periodic packing is exact.

    positions (n, 2) m, radii (n,) m, bonds (m, 2); kn, kt: N/m, one for all or (m,); box: ((x0, y0), (x1, y1)) m, one
    cell where periodic; periodic: for each direction. Raises ParameterError where shapes do not match.
    """
    x, r, pairs = np.asarray(positions, float), np.asarray(radii, float), np.asarray(bonds)
    require(x.ndim == 2 and x.shape[1] == 2, "positions", f"array of shape {x.shape}", "of shape (n, 2)", "m")
    require(pairs.ndim == 2 and pairs.shape[1] == 2 and len(pairs) > 0, "bonds", f"array of shape {pairs.shape}",
            "of shape (m, 2)")
    low, high = np.asarray(box, float)
    side, around = high - low, np.asarray(periodic, bool)
    require((side > 0).all(), "box", box, "of positive sides", "m")
    kn, kt = (np.broadcast_to(np.asarray(k, float), len(pairs)) for k in (kn, kt))
    i, j = pairs.T
    line = x[j] - x[i]
    line = line - np.where(around, side * np.round(line / side), 0.0)
    length = np.linalg.norm(line, axis=1)
    normal, half_overlap = line / length[:, None], 0.5 * (r[i] + r[j] - length)
    rows = contact_rows(len(x), i, j, normal, r[i] - half_overlap, r[j] - half_overlap, kn, kt)

    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    # (m, 2, 3): stretch and shear of each bond by each unit strain, times the roots of kn and kt
    imposed = np.einsum("mad,sde,me->mas", np.stack([normal * np.sqrt(kn)[:, None], tangent * np.sqrt(kt)[:, None]], 1),
                        STRAINS, line)
    free = _free(x, low, high, around, pairs)
    found = rows @ _fluctuation(rows, imposed.reshape(-1, 3), free) + imposed.reshape(-1, 3)
    forces = found.reshape(imposed.shape) * np.sqrt(np.stack([kn, kt], 1))[:, :, None]
    pull = normal[:, :, None] * forces[:, :1] + tangent[:, :, None] * forces[:, 1:]
    inside = _part_inside(x[i], line, low, high, around)
    stress = np.einsum("m,mas,mb->abs", inside, pull, line) / np.prod(side)
    return np.stack([stress[0, 0], stress[1, 1], 0.5 * (stress[0, 1] + stress[1, 0])])


def elastic_moduli(**packing):
    """Moduli of the isotropic medium nearest to `stiffness_tensor`, in the mean over all directions."""
    c = stiffness_tensor(**packing)
    along, across, shear = 0.5 * (c[0, 0] + c[1, 1]), 0.5 * (c[0, 1] + c[1, 0]), c[2, 2]
    mean = 0.25 * (along - across) + 0.5 * shear
    bulk = 0.5 * (along + across)
    return Moduli(young=float(4 * bulk * mean / (bulk + mean)), poisson=float((bulk - mean) / (bulk + mean)),
                  shear=float(positive("kt", mean, "N/m")))


def _free(x, low, high, around, pairs):
    """(3n,) bool: displacements and rotations that are to be found."""
    inside = np.where(around, True, (x > low) & (x < high)).all(axis=1)
    bonded = np.zeros(len(x), bool)
    bonded[pairs] = True
    # Held particles turn as freely as the others.
    free = np.stack([inside, inside, np.ones(len(x), bool)], 1) & bonded[:, None]
    if around.all():
        free[int(np.argmax(bonded)), :2] = False  # against a translation of all
    return free.ravel()


def _fluctuation(rows, imposed, free):
    """(3n, 3): displacements and rotations in equilibrium under each strain."""
    found, part = np.zeros((rows.shape[1], 3)), rows[:, free].tocsc()
    stiffness = part.T @ part
    # A particle that hangs on one bond rolls without force: a trace of stiffness keeps it where it is.
    hold = sparse.diags(HOLD * stiffness.diagonal())
    found[free] = -splu((stiffness + hold).tocsc()).solve(part.T @ imposed)
    return found


def _part_inside(start, line, low, high, around):
    """(m,) part of each segment from start to start + line that lies in the box."""
    enter, leave = np.zeros(len(line)), np.ones(len(line))
    for k in np.flatnonzero(~around):
        run = np.where(line[:, k] == 0, 1e-300, line[:, k])
        ends = np.sort([(low[k] - start[:, k]) / run, (high[k] - start[:, k]) / run], axis=0)
        enter, leave = np.maximum(enter, ends[0]), np.minimum(leave, ends[1])
    return np.clip(leave - enter, 0.0, None)

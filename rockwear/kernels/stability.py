"""Critical time step of the central difference (leapfrog) scheme for a bonded assembly, from its stiffness matrix."""
import math

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh

from rockwear.kernels.checks import ParameterError, not_negative, require

DENSE = 300  # degrees of freedom up to which all eigenvalues are computed
TOLERANCE = 1e-6  # of the largest eigenvalue; the time step is made smaller by as much


def critical_time_step(*, positions, radii, masses, inertias, bonds, kn, kt, fixed=(), damping_ratio=0.0, ground=None,
                       cn=0.0, ct=0.0, ratcheting_free=False):
    """Largest stable time step in s, 2/Ω_max (√(1 + ξ²) − ξ) [Rojek 2003, eq. 3.36-3.37].

    Ω_max² is the largest eigenvalue of M^-½ K M^-½. K = Σ kn n nᵀ + kt t tᵀ, with the rotations: a bond from i to j
    with unit normal n is stretched by n·(u_j − u_i) and sheared in a direction t by

        t·(u_j − u_i) − (n × t)·(a_i φ_i + a_j φ_j),    a = r − ½ (r_i + r_j − |x_j − x_i|)

    with the lever arms a from the centres to the middle of the overlap or gap, as in YADE. Mass is lumped: 3 degrees of
    freedom for a disc, 6 for a sphere.

    positions  (n, 2) or (n, 3) in m        radii    (n,) in m
    masses     (n,) in kg                   inertias (n,) in kg m2
    bonds      (m, 2) indices of particles
    kn, kt     normal and tangential stiffness in N/m, one for all bonds or (m,)
    fixed      indices of particles that do not move
    damping_ratio    ξ, fraction of critical damping at Ω_max, for an assembly with equal damping of all modes
    cn, ct     normal and tangential dashpots of the bonds in N s/m, one for all bonds or (m,); see below
    ratcheting_free    True for YADE's default measure of the shear displacement
               (Ig2_Sphere_Sphere_ScGeom.avoidGranularRatcheting); see below
    ground     (nodes, normals, kn, kt) or (nodes, normals, kn, kt, cn): contacts of particles `nodes` (g,) with a body
               of prescribed motion, such as the tool, in the directions `normals` (g, d) at one radius from the
               centre. If the tool may touch any particle, give all of them at once, for a few directions one after
               the other, and use the least step: for 2,100 discs with kn = 20e9 under a tool of 90e9 N/m that step was
               4 % below that of the worst single contact.

    Dashpots. YADE's laws use the velocity of half a step before, M (v⁺ − v⁻)/Δt = −K x − C v⁻, so that a mode of the
    form (−1)ᵏ grows as soon as

        4 M − Δt² K − 2 Δt C     (C = Σ cn n nᵀ + ct t tᵀ)

    is not positive definite. The returned step is this limit: a dashpot acts like a spring of 2 cn/Δt. For a single
    mode it equals the formula above; for assemblies with and without dashpots it is exact and replaces it.

    Ratcheting. YADE takes the rotations at the full radii and multiplies the translations by
    α = (r_i + r_j)/|x_j − x_i|: the shear increment is α t·(u_j − u_i) − (n × t)·(r_i φ_i + r_j φ_j), while the force
    acts at the lever arms a above. Bonds of overlapping particles are α times as stiff in shear, and K is not symmetric
    where the radii differ. With √(a r/α) as the lever arm of either particle it is, and Ω_max is that of the
    unsymmetric K within 1e-4 (radii 1 to 6 mm, overlaps up to 17 %).

    Returns math.inf if no motion is resisted. The eigenvalue has the relative error TOLERANCE, on the safe side. Raises
    ParameterError (named as the arguments) for shapes that do not match, values that are not finite, masses, inertias
    or radii not positive, negative stiffness, and bonds between coincident or unknown particles.
    """
    x = np.asarray(positions, dtype=float)
    require(x.ndim == 2 and x.shape[1] in (2, 3) and len(x) > 0, "positions", f"array of shape {x.shape}",
            "of shape (n, 2) or (n, 3)", "m")
    require(np.isfinite(x).all(), "positions", "array", "finite", "m")
    n, d = x.shape
    r = _positive_each("radii", radii, n, "m")
    mass, inertia = _positive_each("masses", masses, n, "kg"), _positive_each("inertias", inertias, n, "kg m2")
    i, j = _indices("bonds", bonds, n, 2).T
    kn, kt = _each_bond("kn", kn, len(i)), _each_bond("kt", kt, len(i))
    cn, ct = _each_bond("cn", cn, len(i), "N s/m"), _each_bond("ct", ct, len(i), "N s/m")
    damping_ratio = not_negative("damping_ratio", damping_ratio)
    fixed = _indices("fixed", fixed, n)

    delta = x[j] - x[i]
    distance = np.linalg.norm(delta, axis=1)
    require((distance > 0).all(), "bonds", "array", "between particles at different places")
    normal, half_overlap = delta / distance[:, None], 0.5 * (r[i] + r[j] - distance)
    arms = [r[i] - half_overlap, r[j] - half_overlap]
    if ratcheting_free:
        alpha = (r[i] + r[j]) / distance
        kt = alpha * kt
        arms = [np.sqrt(np.maximum(arm, 0.0) * radius / alpha) for arm, radius in zip(arms, (r[i], r[j]))]
    springs, dashpots = contact_rows(n, i, j, normal, *arms, kn, kt), _dashpot_rows(n, i, j, normal, *arms, cn, ct)
    if ground is not None:
        grounded = _ground_rows(ground, r, d)
        springs, dashpots = sparse.vstack([springs, grounded[0]]), sparse.vstack([dashpots, grounded[1]])

    rotations = springs.shape[1] // n - d
    scale = np.hstack([np.tile(1 / np.sqrt(mass)[:, None], d), np.tile(1 / np.sqrt(inertia)[:, None], rotations)])
    scale[fixed] = 0.0  # an infinite mass
    springs, dashpots = ((rows @ sparse.diags(scale.ravel())).tocsr() for rows in (springs, dashpots))
    step = _undamped_step(springs) if not dashpots.data.any() else _damped_step(springs, dashpots)
    return step * (math.sqrt(1 + damping_ratio**2) - damping_ratio)


def _undamped_step(springs):
    """2/Ω; `springs` are the rows of √K M^-½."""
    omega_squared, _ = _largest_eigenvalue((springs.T @ springs).tocsr())
    return 2 / math.sqrt(omega_squared * (1 + TOLERANCE)) if omega_squared > 0 else math.inf


def _damped_step(springs, dashpots):
    """Least Δt for which Δt² K + 2 Δt C, both scaled by M^-½, has an eigenvalue 4.

    Any vector v gives an upper bound, the root of Δt² vᵀKv + 2 Δt vᵀCv = 4. The eigenvector at one bound gives the
    next: Newton's method, from above.
    """
    stiffness, viscosity = (springs.T @ springs).tocsr(), (dashpots.T @ dashpots).tocsr()
    step, last = min(_undamped_step(springs), 2 / _largest_eigenvalue(viscosity)[0]), math.inf
    while step < (1 - 1e-2 * TOLERANCE) * last:
        last = step
        _, v = _largest_eigenvalue((step * stiffness + 2 * viscosity).tocsr())
        k, c = v @ (stiffness @ v), v @ (viscosity @ v)
        step = 4 / (c + math.sqrt(c * c + 4 * k))
    return step / (1 + TOLERANCE)


def contact_rows(n, i, j, normal, arm_i, arm_j, kn, kt):
    """Sparse matrix that maps (u, φ) of all n particles to stretch times √kn and shear times √kt of each contact."""
    m, d = normal.shape
    if d == 2:
        tangents = [np.column_stack([-normal[:, 1], normal[:, 0]])]
        turns = [np.ones((m, 1))]  # n × t is the unit vector out of the plane
    else:
        # any direction but the normal: the axis with its smallest component
        helper = np.eye(3)[np.abs(normal).argmin(1)]
        first = np.cross(normal, helper)
        first /= np.linalg.norm(first, axis=1)[:, None]
        tangents = [first, np.cross(normal, first)]
        turns = [np.cross(normal, t) for t in tangents]
    rotations = turns[0].shape[1]
    dofs = d + rotations
    directions = [(kn, normal, np.zeros((m, rotations)))] + [(kt, t, turn) for t, turn in zip(tangents, turns)]
    entries = np.stack([np.sqrt(k)[:, None] * np.hstack([-t, -arm_i[:, None] * turn, t, -arm_j[:, None] * turn])
                        for k, t, turn in directions], axis=1)
    columns = np.hstack([i[:, None] * dofs + np.arange(dofs), j[:, None] * dofs + np.arange(dofs)])
    columns = np.broadcast_to(columns[:, None], entries.shape)
    starts = np.arange(0, entries.size + 1, 2 * dofs)
    return sparse.csr_matrix((entries.ravel(), columns.ravel(), starts), shape=(m * len(directions), n * dofs))


def _dashpot_rows(n, i, j, normal, arm_i, arm_j, cn, ct):
    """The same for the relative velocity times √cn and √ct, of the contacts that have a dashpot."""
    damped = np.flatnonzero(cn + ct)
    return contact_rows(n, *(each[damped] for each in (i, j, normal, arm_i, arm_j, cn, ct)))


def _ground_rows(ground, r, d):
    """Rows of springs and of dashpots to a body of prescribed motion: bonds to a particle outside the matrix."""
    nodes, normals, kn, kt, cn = ground if len(ground) == 5 else (*ground, 0.0)
    nodes, n = _indices("ground", nodes, len(r)), len(r)
    normals = np.asarray(normals, dtype=float)
    length = np.linalg.norm(normals, axis=-1) if normals.shape == (len(nodes), d) else np.zeros(1)
    require((length > 0).all(), "ground", f"normals of shape {normals.shape}", f"one vector of {d} components a node")
    kn, kt, cn = (_each_bond("ground", value, len(nodes)) for value in (kn, kt, cn))
    body, normals = np.full(len(nodes), n), normals / length[:, None]
    rows = (contact_rows(n + 1, nodes, body, normals, r[nodes], np.zeros(len(nodes)), kn, kt),
            _dashpot_rows(n + 1, nodes, body, normals, r[nodes], np.zeros(len(nodes)), cn, np.zeros(len(nodes))))
    return [each[:, : each.shape[1] // (n + 1) * n] for each in rows]


def _largest_eigenvalue(matrix):
    """Largest eigenvalue of a symmetric, positive semidefinite sparse matrix, and its unit eigenvector."""
    n = matrix.shape[0]
    if n <= DENSE:
        values, vectors = np.linalg.eigh(matrix.toarray())
        return float(values[-1]), vectors[:, -1]
    # a fixed start makes the result reproducible
    start = np.random.default_rng(0).standard_normal(n)
    if matrix.nnz == 0 or not matrix.data.any():
        return 0.0, start
    values, vectors = eigsh(matrix, k=1, which="LA", tol=TOLERANCE, v0=start)
    return float(values[0]), vectors[:, 0]


def _positive_each(name, values, n, unit):
    array = np.asarray(values, dtype=float)
    require(array.shape == (n,), name, f"array of shape {array.shape}", f"one value for each of {n} particles", unit)
    require((np.isfinite(array) & (array > 0)).all(), name, "array", "finite and greater than 0", unit)
    return array


def _each_bond(name, value, n, unit="N/m"):
    array = np.asarray(value, dtype=float)
    require(array.shape in ((), (n,)), name, f"array of shape {array.shape}", f"a number or {n} of them", unit)
    require((np.isfinite(array) & (array >= 0)).all(), name, array if array.ndim == 0 else "array",
            "finite and at least 0", unit)
    return np.broadcast_to(array, (n,))


def _indices(name, values, n, width=None):
    """`values` as an array of particle indices, (k,) or (k, width)."""
    array = np.asarray(values)
    if array.size == 0:
        array = array.reshape((0,) if width is None else (0, width)).astype(np.intp)
    shape = array.shape[1:] == (() if width is None else (width,)) and array.ndim == (1 if width is None else 2)
    if not (shape and array.dtype.kind in "iu" and (array >= 0).all() and (array < n).all()):
        rule = f"indices below {n}" if width is None else f"pairs of indices below {n}"
        raise ParameterError(name, f"array of shape {array.shape}", rule)
    return array

"""Springs and dashpots that stand for the rock beyond a boundary in the plane."""
from collections import namedtuple

import numpy as np

from rockwear.kernels.checks import positive, require

NORMAL_SPRING, TANGENTIAL_SPRING = 1.6, 0.8
"""alpha_n, alpha_t of K = alpha G/r per area."""
NORMAL_DASHPOT, TANGENTIAL_DASHPOT = 1.05, 0.93
"""a, b of a rho c_P and b rho c_S per area."""

Constants = namedtuple("Constants", "kn kt cn ct")
"""Of each boundary particle: springs (N/m) and dashpots (N s/m) along the normal and across it."""


def viscous_spring(*, moduli, density, areas, distances):
    """Constants of particles that each stand for a part of a plane boundary.

    Dashpots a rho c_P A and b rho c_S A take up plane waves at normal incidence [Lysmer and Kuhlemeyer 1969]; a and b
    near 1 are the optimum over all angles [White, Valliappan and Lee 1977]. Springs alpha G A / r give the static
    stiffness of the rock beyond, for a load at the distance r [Deeks and Randolph 1994; in the plane Liu, Du and Yan
    2006].

    moduli: kernels.elastic_moduli.Moduli; density: kg/m3 of the bulk; areas (k,) m2; distances (k,) m from the load.
    Raises ParameterError for areas or distances that are not positive.
    """
    areas, distances = np.asarray(areas, float), np.asarray(distances, float)
    positive("density", density, "kg/m3")
    for name, values, unit in (("areas", areas, "m2"), ("distances", distances, "m")):
        require((np.isfinite(values) & (values > 0)).all(), name, "array", "greater than 0", unit)
    fast, slow = moduli.speeds(density)
    spring = moduli.shear * areas / distances
    return Constants(NORMAL_SPRING * spring, TANGENTIAL_SPRING * spring,
                     NORMAL_DASHPOT * density * fast * areas, TANGENTIAL_DASHPOT * density * slow * areas)


def stable_masses(*, masses, springs, dashpots, step, critical):
    """(k,) kg, the least masses of particles with these springs and dashpots that leave a leapfrog step stable. (Ours.)

    An assembly is stable where 4 M - dt^2 K - 2 dt C is positive definite (kernels.stability). K of the bonds alone is
    at most 4 M / dt_c^2 with their critical step dt_c, in which particles have their `masses` m; so with a spring k and
    a dashpot c to the ground, m (dt / dt_c)^2 + dt^2 k / 4 + dt c / 2 is enough.

    masses (k,) kg; springs (k,) N/m; dashpots (k,) N s/m; step dt, critical dt_c: s, 0 < dt <= dt_c. Raises
    ParameterError.
    """
    masses, springs, dashpots = (np.asarray(values, float) for values in (masses, springs, dashpots))
    require(0 < step <= critical, "step", step, f"greater than 0 and at most the critical step {critical:.3g}", "s")
    return masses * (step / critical)**2 + 0.25 * step**2 * springs + 0.5 * step * dashpots


def stable_dashpots(*, masses, springs, step, critical):
    """(k,) N s/m, the largest dashpots c for which `stable_masses` are no more than `masses`; the same arguments."""
    masses = np.asarray(masses, float)
    without = stable_masses(masses=masses, springs=springs, dashpots=0.0, step=step, critical=critical)
    return np.maximum(2 * (masses - without) / step, 0.0)


def shares(along, low, high):
    """(k,) m of the boundary from `low` to `high` that each of the places `along` (k,) m is nearest to."""
    along = np.asarray(along, float)
    order = np.argsort(along)
    edges = np.concatenate([[low], 0.5 * (along[order][1:] + along[order][:-1]), [high]])
    found = np.empty(len(along))
    found[order] = np.diff(np.clip(edges, low, high))
    return found

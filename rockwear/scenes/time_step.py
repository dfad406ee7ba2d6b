"""The critical time step of rock under a tool, whichever of its particles the tool presses."""
import math

import numpy as np

from rockwear.engines.bond_dashpots import coefficients
from rockwear.kernels.stability import critical_time_step

CLOSE = 0.05
"""Spheres whose gap is below this part of a radius count as touching."""
TOUCHING = 4
"""Tool particles that are taken to press one sphere at once."""


def plane_steps(rock, contact, bond_damping=0.0):
    """(critical step of the bonded rock, of rock under the tool), s. contact: model.contact.ContactLaw; bond_damping:
    of the critical damping of bonds."""
    return tuple(map(min, zip(*(_plane_steps(rock, contact, bond_damping, *layout) for layout in rock.layouts()))))


def _plane_steps(rock, contact, bond_damping, positions, shown):
    (kn, kt), (cn, ct) = rock.stiffness(), coefficients(rock, bond_damping)
    common = dict(positions=positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                  bonds=rock.pairs[shown], kn=kn[shown], kt=kt[shown], cn=cn[shown], ct=ct[shown],
                  fixed=np.flatnonzero(rock.fixed), ratcheting_free=True)
    bonded = critical_time_step(**common)
    # Any free disc may be the one that the tool presses, from any side, with two of its particles at once.
    free = np.flatnonzero(~rock.fixed)
    dashpots = 4 * contact.damping * np.sqrt(contact.kn * rock.masses[free])
    sides = [np.tile([math.cos(angle), math.sin(angle)], (len(free), 1)) for angle in (0, math.pi / 4, math.pi / 2)]
    exact = min(critical_time_step(**common, ground=(free, side, 2 * contact.kn, 2 * contact.kt, dashpots))
                for side in sides)
    # The estimate of [Rojek 2003, eq. 3.37] for the lightest disc is shorter where contacts are damped, and the energy
    # balance asks for it.
    highest = math.hypot(2 / bonded, math.sqrt(2 * contact.kn / float(rock.masses[free].min())))
    xi = contact.damping
    return bonded, min(exact, 2 / highest * (math.sqrt(1 + xi * xi) - xi))


def space_steps(rock, bond_law, contact):
    """The same for spheres, whose shear follows the points of contact; bond_law: also of contacts that are no bonds."""
    kn, kt = np.max([*zip(*rock.stiffness()), bond_law.stiffest()], axis=0)
    free = np.flatnonzero(~rock.fixed)
    common = dict(positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                  bonds=rock.near(CLOSE * float(rock.radii.max())), kn=kn, kt=kt, fixed=np.flatnonzero(rock.fixed),
                  ratcheting_free=False)
    bonded = critical_time_step(**common)
    dashpots = 2 * TOUCHING * contact.damping * np.sqrt(contact.kn * rock.masses[free])
    return bonded, min(
        critical_time_step(**common, ground=(free, np.tile(side, (len(free), 1)), TOUCHING * contact.kn,
                                             TOUCHING * contact.kt, dashpots)) for side in np.eye(3)[:2])

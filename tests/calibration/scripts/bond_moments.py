"""Moments in bonds on a small specimen; writes {check: number} to the file named last."""
import json
import os
import sys

import numpy as np

from calibration.benchmarks.bond_moments import OURS, made
from rockwear.engines import access, base
from rockwear.kernels.stability import critical_time_step

SMALL = dict(width=0.03, height=0.015)
ELASTIC = 1e-4
"""s before any bond breaks."""


def loaded(name):
    """The test of a case, and its stiffness (Pa) after so long."""
    scene = made(name, "compression", 2, **SMALL)
    base.run(scene.steps_in(ELASTIC))
    columns = scene.recorder.columns()
    return scene, columns["stress"][-1] / columns["axial_strain"][-1]


_, ours = loaded(OURS)
without, plain = loaded("0")
rock, (kn, kt) = without.rock, without.rock.stiffness()
known = critical_time_step(positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                           bonds=rock.pairs, kn=kn, kt=kt)
scene, stiffer = loaded("2")
# The law of a step sees the discs as the step before has left them.
angles = 2 * np.arctan2(*access.rock_states(scene.rock)[:, 11:].T)
base.run(1)
i, j = np.array([(bond.id1, bond.id2) for bond in scene.bonded]).T
moments = np.array([bond.phys.moment_bending[2] for bond in scene.bonded])
kr = 2.0 * 8e9 * scene.rock.radii[i] * scene.rock.radii[j]
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump({"stiffness": plain / ours, "stiffer": stiffer / plain, "step": without.critical_step / known,
               "shorter": scene.critical_step / known, "moment": float(abs(moments).max()),
               "off": float(abs(moments - kr * (angles[i] - angles[j])).max())}, file)
sys.stdout.flush()
os._exit(0)

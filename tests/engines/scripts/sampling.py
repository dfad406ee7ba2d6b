"""In which steps the engine of bonds looks and samples slip; writes {"looks", "samples", "prepared": steps} to FILE.

    yade -n -x sampling.py FILE
"""
import json
import os
import sys
from unittest import mock

import numpy as np
from yade import Ig2_Sphere_Sphere_ScGeom, NewtonIntegrator, O

from rockwear.engines import base, cpm_bonds
from rockwear.kernels.bond_laws import Cohesive
from rockwear.scenes import yade_scene

STEPS = 2000
LAW = Cohesive(kn=2e10, kt=1e10, bond_tension=1e5, bond_cohesion=2e5, bond_fracture_energy=1.0, mu=0.5)

O.engines = [yade_scene.bond_loop([Ig2_Sphere_Sphere_ScGeom()]), NewtonIntegrator()]
bonds = cpm_bonds.CpmBonds(pairs=np.empty((0, 2), int), law=LAW, clock=lambda: O.time)
base.register([bonds])
base.insert([bonds])
bonds.connect()
found = {"looks": [], "samples": [], "prepared": []}
with mock.patch.multiple(bonds, look_at_all=lambda: found["looks"].append(O.iter),
                         _sample=lambda: found["samples"].append(O.iter),
                         _prepare=lambda: found["prepared"].append(O.iter)):
    base.run(STEPS)
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(found, file)
os._exit(0)

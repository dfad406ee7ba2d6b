"""Confined compression in the plane: a square specimen of sandstone, 2100 discs, under a constant pressure on its
sides.

    yade -n -x yade_scripts/triaxial.py [--confinement PA] [--name value ...] [--out DIR] [--resume]

The test ends when the deviatoric stress has fallen to `drop` of its peak, or at strain_max.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("triaxial.py")[0] + "find_rockwear.py")

from calibration.laboratory.triaxial import GROUPS, TriaxialTest
from rockwear.run.main import main

main("triaxial", GROUPS, TriaxialTest)

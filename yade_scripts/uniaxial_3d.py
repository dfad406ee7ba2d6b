"""A block of bonded spheres, 50 x 25 x 25 mm of sandstone, compressed or pulled along its length until it fails.

    yade -n -x yade_scripts/uniaxial_3d.py [--test compression|tension] [--name value ...] [--out DIR] [--resume]

Strengths of the default bonds are per area: they hold for spheres of any radius. Stiffnesses kn and kt grow with it.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("uniaxial_3d.py")[0] + "find_rockwear.py")

from calibration.laboratory.uniaxial import GROUPS_IN_SPACE, UniaxialTest
from rockwear.run.main import main

main("uniaxial_3d", GROUPS_IN_SPACE, UniaxialTest)

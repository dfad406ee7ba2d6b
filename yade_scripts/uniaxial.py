"""A square specimen of sandstone, 2100 discs, compressed or pulled between two platens until it fails [Rojek 2003,
5.1].

    yade -n -x yade_scripts/uniaxial.py [--test compression|tension] [--name value ...] [--out DIR] [--resume]

The source moves the walls at 1 mm/s; the default is the fastest speed at which Young's modulus and strength stay within
2 % of those of slow loading.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("uniaxial.py")[0] + "find_rockwear.py")

from calibration.laboratory.uniaxial import GROUPS, UniaxialTest
from rockwear.run.main import main

main("uniaxial", GROUPS, UniaxialTest)

"""Brazilian test: a disc of sandstone, 50 mm wide, pressed along a diameter until it splits.

    yade -n -x yade_scripts/brazilian.py [--diameter 0.05] [--name value ...] [--out DIR] [--resume]

tensile_strength is 2P/(pi D) at the peak force, as a laboratory reports it.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("brazilian.py")[0] + "find_rockwear.py")

from calibration.laboratory.brazilian import GROUPS, BrazilianTest
from rockwear.run.main import main

main("brazilian", GROUPS, BrazilianTest)

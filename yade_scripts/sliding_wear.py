"""The laboratory wear test: a block of tool steel is pressed on rock and slid; it returns its k [Rojek 2003, 6.6].

    yade -n -x yade_scripts/sliding_wear.py [--name value ...] [--out DIR] [--resume]

The defaults are the source's first test of MET 71. k x 1000 over 100 m / 1000 stands for k over 100 m. Turn your own
laboratory's rows into k with python3 -m calibration.fitting.wear_fit, then look at the test here: --force, --area,
--distance, --temperature, --hardness_table ...
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("sliding_wear.py")[0] + "find_rockwear.py")

from calibration.laboratory.sliding_wear import GROUPS, SlidingWear
from rockwear.run.main import main

main("sliding_wear", GROUPS, SlidingWear)

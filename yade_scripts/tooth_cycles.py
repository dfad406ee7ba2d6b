"""M 9.2, thermo-mechanical: a test tooth cuts bonded sandstone, heats up, wears and changes its shape over many cycles.

    yade -n -x yade_scripts/tooth_cycles.py [--name value ...] [--out DIR] [--resume]

The parameters, their defaults and sources are those of rockwear.scenes.cutting; --help prints them. M shows the tooth in a
figure only and gives no depth of cut, air gap or background damping: these are ours.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("tooth_cycles.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

main("tooth_cycles", cutting.groups(), cutting.make)

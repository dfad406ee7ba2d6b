"""A test tooth cuts bonded sandstone, heats up, wears and changes its shape over many cycles [Rojek 2003, 9.2].

    yade -n -x yade_scripts/tooth_cycles.py [--name value ...] [--out DIR] [--resume]

--help prints all parameters in groups, with their defaults, units and sources. The source shows the tooth in a figure
only and gives no depth of cut, air gap or background damping: these are ours.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("tooth_cycles.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

main("tooth_cycles", cutting.groups(), cutting.make)

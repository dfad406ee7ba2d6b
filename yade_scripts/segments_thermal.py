"""A tool of segments cuts bonded sandstone, heats up, and recedes where it wears; its hardness falls with temperature.

    yade -n -x yade_scripts/segments_thermal.py [--name value ...] [--out DIR] [--resume]

Behind the segments particles of --thermal_radius store and conduct the heat; each segment has the temperature of the
nearest of them, and wears with the hardness there.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("segments_thermal.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

SEGMENTS = cutting.groups(tool="segments", cycles=1, wear_acceleration=70.0)

main("segments_thermal", SEGMENTS, cutting.make)

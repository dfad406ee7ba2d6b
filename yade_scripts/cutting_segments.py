"""M 8.1: a rigid tool of straight segments cuts bonded sandstone; where the rock fails, and where the tool wears.

    yade -n -x yade_scripts/cutting_segments.py [--name value ...] [--out DIR] [--resume]

As in M: kn = kt = 20e9 N/m and mu = 0.839 between tool and rock too, wear constant k / mu = 1 and hardness 1 Pa, so that
the worn volume is no real one (it is the friction work) but shows where wear falls; the shape stays. To move the
vertices: --reshape true --wear_coefficient 0.01128 --hardness 0 --acceleration 70; a warning says when the acceleration
is too high for a tool that recedes. M cuts 40 mm at 0.04 m/s, some 9 million steps; the default goes the same way
fifty times as fast (shorter ones meet a single chip), and --velocity 0.04 --start_up 1 is M's.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_segments.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

SEGMENTS = cutting.groups(
    tool="segments", reshape=False, heat=False, tool_kn=20e9, tool_kt=20e9, tool_mu=0.839, velocity=2.0, start_up=0.02,
    cycles=0, hardness=1.0, wear_coefficient=0.839, wear_acceleration=1.0)

main("cutting_segments", SEGMENTS, cutting.make)

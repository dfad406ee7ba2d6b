"""A rigid tool of straight segments cuts bonded sandstone: where the rock fails, where the tool wears [Rojek 2003,
8.1].

    yade -n -x yade_scripts/cutting_segments.py [--name value ...] [--out DIR] [--resume]

As in the source: kn = kt = 20e9 N/m and mu = 0.839 between tool and rock too, wear constant k / mu = 1 and hardness 1
Pa. The worn volume is then the friction work, which shows where wear falls; the shape stays. To move the vertices:
--reshape true --wear_coefficient 0.01128 --hardness 0 --wear_acceleration 70; a warning says when the wear acceleration
is too high for a tool that recedes. The source cuts 40 mm at 0.04 m/s, some 9 million steps (--velocity 0.04
--start_up 1); the default goes the same way fifty times as fast. Shorter ways meet a single chip.
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

"""One cut with a tool of equal particles: wear summed up on the tool, and its shape changed by it [Rojek 2003, 8.2].

    yade -n -x yade_scripts/cutting_particles.py [--removal none] [--name value ...] [--out DIR] [--resume]

With `--removal none` the shape stays, as in the source's first analysis. The source cuts 40 mm in 1 s at 0.04 m/s, ten
million steps (--velocity 0.04 --start_up 1); the defaults cut as far at 1 m/s, slow against every wave in the rock. The
wear is the source's, k / mu = 5e-9 and H = 1 Pa: a test of the algorithm, no steel.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_particles.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

TOOL = cutting.groups(
    tool_radius_min=0.5e-3, tool_radius_max=0.5e-3, tool_kn=20e9, tool_kt=20e9, tool_mu=0.839, velocity=1.0,
    start_up=0.04, cycles=0, removal="depth", wear_coefficient=0.839 * 5e-9, hardness=1.0, wear_acceleration=1.0,
    heat=False, record_period=1e-4)

main("cutting_particles", TOOL, cutting.make)

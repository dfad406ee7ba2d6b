"""A cut with heat: where friction heats tool and rock, with conduction and without [Rojek 2003, 10.1].

    yade -n -x yade_scripts/cutting_thermal.py [--conduction false] [--name value ...] [--out DIR] [--resume]

With `--conduction false` all heat stays with the particles that it arose at, as in the source's first case. The source
cuts 40 mm in 1 s at 0.04 m/s: nine million steps (--time_scale 1, some four hours). The mechanics here run a hundred
times as fast as the process, at 4 m/s, slow against every wave in the rock; heat has its full second. The wear is the
source's, k / mu = 1e-10 and H = 100 Pa: little, and no steel. The source shares friction heat equally; it gives no
conductance from tool to rock.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_thermal.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

THERMAL = cutting.groups(
    rock_specific_heat=3000.0, rock_conductivity=0.1, tool_radius_min=0.5e-3, tool_radius_max=0.5e-3,
    tool_kn=20e9, tool_kt=20e9, tool_mu=0.839, tooth_height=0.078, tooth_width=0.055, velocity=0.04, time_scale=100.0,
    start_up=1.0, cycles=0, hardness=100.0, wear_coefficient=0.839e-10, wear_acceleration=1.0, heat_sharing="equal",
    heat_period=0.01, surface_period=0.05, record_period=2e-3)

main("cutting_thermal", THERMAL, cutting.make)

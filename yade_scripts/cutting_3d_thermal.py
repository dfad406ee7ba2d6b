"""A tooth of particles cuts bonded spheres in space and heats up; its hardness falls with the temperature.

    yade -n -x yade_scripts/cutting_3d_thermal.py [--full] [--name value ...] [--out DIR] [--resume]

The cut of cutting_3d_wear.py with heat in rock and tool, a tool of MET 91, and bonds fifty times as strong (500 and
5000 N), so that there is friction to heat it. The wear is accelerated a thousand times.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_3d_thermal.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting_3d

THERMAL = cutting_3d.groups(
    heat=True, hardness=0.0, Rn=500.0, Rt=5000.0, velocity=0.4, lowering_velocity=0.4, wear_coefficient=0.01128,
    wear_acceleration=1e3, snapshot_period=0.02, record_period=1e-3)

main("cutting_3d_thermal", THERMAL, cutting_3d.make)

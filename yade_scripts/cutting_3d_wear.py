"""Cutting bonded rock in space, model II: a tooth of particles; where it wears, and how deep [Rojek 2003, 13.3].

    yade -n -x yade_scripts/cutting_3d_wear.py [--full] [--name value ...] [--out DIR] [--resume]

The numbers are the source's: rock as in cutting_3d_triangles.py, tool particles of 1.5 mm, 0.4 m/s over 1 s, wear
constant k / mu = 5e-9 and hardness 1 Pa, none removed. The source's tooth has 28,570 particles where it cuts and
triangles elsewhere; here all of it is of particles (28,576 with --full), since only its surface particles take part
in contact.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_3d_wear.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting_3d

WEAR = cutting_3d.groups(
    velocity=0.4, lowering_velocity=0.4, wear_coefficient=0.1 * 5e-9, snapshot_period=0.02, record_period=1e-3)

main("cutting_3d_wear", WEAR, cutting_3d.make)

"""A tooth cuts rock whose bonds harden and soften by the Padova law [Rojek 2003, 4.2].

    yade -n -x yade_scripts/padova_cut.py [--name value ...] [--out DIR] [--resume]

No law of YADE has the nonlinear elastic domain of these bonds: Python gives the force of each in every step, about 2
us a bond. The specimen is small for that reason.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("padova_cut.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

PADOVA = cutting.groups(
    bond_law="padova", width=0.06, height=0.04, radius_min=1.5e-3, radius_max=2.2e-3, tooth_height=0.03,
    tooth_width=0.02, rake=10.0, clearance=10.0, tip_radius=2e-3, depth_of_cut=0.01, start_up=2e-3, cycles=0)

main("padova_cut", PADOVA, cutting.make)

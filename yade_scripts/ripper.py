"""Wear of a ripper tooth in 20 cycles: where it wears, how its shape changes, how fast its mass goes [Rojek 2003, 9.3].

    yade -n -x yade_scripts/ripper.py [--name value ...] [--out DIR] [--resume]

The numbers are the source's. It shows the tooth in figures only: rake, clearance, size and depth of cut are ours. The
hardness is constant, so nothing is heated here; ripper_temperature.py does that.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("ripper.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting

RIPPER = cutting.groups(
    kn=90e9, kt=90e9, tool_kn=20e9, tool_kt=20e9, tool_radius_max=0.6e-3, hardness_temperature=293.15, heat=False,
    rake=25.0, clearance=12.0, tooth_height=0.085, tooth_width=0.06, tip_radius=5e-3, depth_of_cut=0.015, cycles=20)

main("ripper", RIPPER, cutting.make)

"""P 5 (and M 12): a pick of a dredge cutter head swings and turns, cuts rock and cools in water, three turns.

    yade -n -x yade_scripts/dredge_pick.py [--full] [--name value ...] [--out DIR] [--resume]

The parameters, their defaults and sources are those of rockwear.scenes.dredging; --help prints them. The default has P's pick
and data in rock of discs four times as coarse, in a layer along the path of the pick; --full has P's 92,000 discs.

M 12, in its sandstone (M 5.1), is --kt 20e9 --Rt 1e6 --mu 0.839 --hardness_table MET91 --wear_coefficient 0.01128 and
    model I, an unworn pick:  --acceleration 0
    model I, with wear:       --acceleration 7000 --hardness_temperature 293
    model II:                 --acceleration 7000 --tool_radius_min 0.7e-3 --tool_radius_max 0.7e-3
                              --tooth_height 0.1386 --tooth_width 0.1386
A pick of discs of 0.7 mm has M's 9,400 at this size; the outline itself M has in a figure only. To pack them takes a
minute or two.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("dredge_pick.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import dredging

main("dredge_pick", dredging.groups(full="--full" in sys.argv), dredging.make)

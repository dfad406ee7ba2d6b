"""A pick of a dredge cutter head swings and turns, cuts rock and cools in water, three turns [Rojek 2014, ch. 5].

    yade -n -x yade_scripts/dredge_pick.py [--full] [--name value ...] [--out DIR] [--resume]

The default has the pick and the data of [Rojek 2014] in rock of discs four times as coarse. The rock is there only near
the tip: a window moves along the path, and its ends absorb waves. With
    --window false
all rock along the path is there, in a layer of `backing`, and with --full so are the source's 92,000 discs. With
    --scale_factor 1 --window_behind 0.06 --backing 0.04 --time_step_fraction 0.95 --time_scale 10
three turns in the source's discs take an hour; calibration/results/dredging.md tells what that costs in accuracy.

The dredging of [Rojek 2003, ch. 12], in the sandstone of its 5.1, is
    --kt 20e9 --Rt 1e6 --mu 0.839 --hardness_table MET91 --wear_coefficient 0.01128      and
    model I, an unworn pick:  --wear_acceleration 0
    model I, with wear:       --wear_acceleration 7000 --hardness_temperature 293
    model II:                 --wear_acceleration 7000 --tool_radius_min 0.7e-3 --tool_radius_max 0.7e-3
                              --tooth_height 0.1386 --tooth_width 0.1386
A pick of discs of 0.7 mm has the source's 9,400 at this size; the outline itself is shown in a figure only. To pack
them takes a minute or two.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("dredge_pick.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import dredging

main("dredge_pick", dredging.groups(), dredging.make)

"""P 5 (and M 12): a pick of a dredge cutter head swings and turns, cuts rock and cools in water, three turns.

    yade -n -x yade_scripts/dredge_pick.py [--full] [--name value ...] [--out DIR] [--resume]

The parameters, their defaults and sources are those of rockwear.dredging; --help prints them. The default has P's pick
and data in rock of discs four times as coarse, in a layer along the path of the pick; --full has P's 92,000 discs.
M 12 is --steel MET91 --wear_coefficient 0.01128 --acceleration 7000 (0 for its first analysis), and its second model
--tool_radius_min 0.75e-3 --tool_radius_max 0.75e-3.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from rockwear import run  # noqa: E402
from rockwear.dredging import Dredging, dredging_parameters  # noqa: E402

run.main("dredge_pick", dredging_parameters("--full" in sys.argv), Dredging)

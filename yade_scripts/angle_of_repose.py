"""The angle of repose: grains settle in a box, which is drained beside a plate; a heap stays [Rojek 2003, ch. 14].

    yade -n -x yade_scripts/angle_of_repose.py [--name value ...] [--out DIR] [--resume]

The source's text only says that the repose angle was evaluated, without a number: the test is that of Zhou, Xu, Yu and
Zulli (2002), with whose relation the result is compared. Contacts follow YADE's Hertz-Mindlin law with dashpots and a
limit to the rolling moment. results: angle_of_repose with its standard error over both flanks, strip by strip.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("angle_of_repose.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import heap

main("angle_of_repose", heap.GROUPS, heap.make)

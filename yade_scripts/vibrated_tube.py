"""Sand flows into a horizontal tube while its box vibrates [Rojek 2003, ch. 14].

    yade -n -x yade_scripts/vibrated_tube.py [--name value ...] [--out DIR] [--resume]

The source's text names this test of lost foam casting and gives no number: box, tube, grains, amplitude and frequency
are ours, those of a laboratory flask with grains of 3 to 4 mm. The grains settle, and some run into the tube; then the
box vibrates. history.csv has tube_mass over time; results: inflow_rate, the share of the tube that is filled.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("vibrated_tube.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import tube

main("vibrated_tube", tube.GROUPS, tube.make)

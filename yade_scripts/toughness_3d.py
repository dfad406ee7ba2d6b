"""Fracture toughness and fracture energy in space: a notched compact tension specimen of spheres, 30 x 31 x 10 mm.

    yade -n -x yade_scripts/toughness_3d.py [--size 0.025] [--depth 0.01] [--name value ...] [--out DIR] [--resume]

The opening of the notch is prescribed, and drives a crack steadily through the specimen.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("toughness_3d.py")[0] + "find_rockwear.py")

from calibration.laboratory.toughness import GROUPS_IN_SPACE, ToughnessTest
from rockwear.run.main import main

main("toughness_3d", GROUPS_IN_SPACE, ToughnessTest)

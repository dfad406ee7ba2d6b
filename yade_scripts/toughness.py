"""Fracture toughness and fracture energy: a notched compact tension specimen of sandstone, 96 x 100 mm.

    yade -n -x yade_scripts/toughness.py [--size 0.08] [--name value ...] [--out DIR] [--resume]

The opening of the notch is prescribed, and drives a crack steadily through the specimen.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("toughness.py")[0] + "find_rockwear.py")

from calibration.laboratory.toughness import GROUPS, ToughnessTest
from rockwear.run.main import main

main("toughness", GROUPS, ToughnessTest)

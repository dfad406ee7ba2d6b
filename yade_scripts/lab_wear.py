"""M 6.6, fig. 6.3: the laboratory wear test. A block of tool steel is pressed on rock and slid; it returns its own k.

    yade -n -x yade_scripts/lab_wear.py [--name value ...] [--out DIR] [--resume]

The parameters, their defaults (M's first test of MET 71) and sources are those of calibration.wear_test; --help prints
them. k x 1000 over 100 m / 1000 stands for k over 100 m. Turn your own laboratory's rows into k with
python3 -m calibration.wear_fit, then look at the test here: --force, --area, --distance, --temperature, --steel ...
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from calibration.wear_test import PARAMETERS, WearTest  # noqa: E402
from rockwear import run  # noqa: E402

run.main("lab_wear", PARAMETERS, WearTest)

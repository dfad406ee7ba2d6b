"""M 5.1: a square specimen of sandstone, 2100 discs, compressed (or pulled) between two platens until it fails.

    yade -n -x yade_scripts/uniaxial.py [--test compression|tension] [--name value ...] [--out DIR] [--resume]

The parameters, their defaults and sources are those of calibration.laboratory; --help prints them. M moves the walls at
1 mm/s; the default is the fastest speed at which E and strength stay within 2 % of those of slow loading.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from calibration.laboratory import PARAMETERS, UniaxialTest  # noqa: E402
from rockwear import run  # noqa: E402

run.main("uniaxial", PARAMETERS, UniaxialTest)

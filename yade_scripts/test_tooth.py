"""M 9.2, thermo-mechanical: a test tooth cuts bonded sandstone, heats up, wears and changes its shape over many cycles.

    yade -n -x yade_scripts/test_tooth.py [--name value ...] [--out DIR] [--resume]

The parameters, their defaults and sources are those of rockwear.cutting; --help prints them. M shows the tooth in a
figure only and gives no depth of cut, air gap or background damping: these are ours.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from rockwear import run  # noqa: E402
from rockwear.cutting import PARAMETERS  # noqa: E402
from rockwear.facet_cutting import OF_FACETS, TOOL, cut  # noqa: E402

run.main("test_tooth", [*PARAMETERS, TOOL, *OF_FACETS], cut)

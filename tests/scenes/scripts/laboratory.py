"""The uniaxial test on specimens that have exact answers.

    yade -n -x laboratory.py --specimen lattice|chain [--name value ...]
"""
from exact_specimens import SPECIMEN, ExactSpecimen

from calibration.laboratory.uniaxial import GROUPS, UniaxialTest
from rockwear.run import main as run


class Exact(ExactSpecimen, UniaxialTest):
    """The test of an exact specimen."""


run.main("exact", [*GROUPS, SPECIMEN], Exact)

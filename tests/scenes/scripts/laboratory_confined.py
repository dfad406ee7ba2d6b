"""Confined compression on specimens that have exact answers.

    yade -n -x laboratory_confined.py --specimen lattice|chain [--name value ...]
"""
from exact_specimens import SPECIMEN, ExactSpecimen

from calibration.laboratory.triaxial import GROUPS, TriaxialTest
from rockwear.run import main as run


class Exact(ExactSpecimen, TriaxialTest):
    """The test of an exact specimen."""


run.main("exact", [*GROUPS, SPECIMEN], Exact)

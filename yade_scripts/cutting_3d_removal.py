"""Cutting bonded rock in space, model III: the tooth changes its shape as worn particles go [Rojek 2003, 13.4].

    yade -n -x yade_scripts/cutting_3d_removal.py [--full] [--name value ...] [--out DIR] [--resume]

As model II (cutting_3d_wear.py), with the source's wear constant k / mu = 5e-6, which is to test the algorithm in a
short run and is no steel's, and the source's removal: a particle goes once its worn depth exceeds its diameter. That
rule passes nothing on to what it uncovers; --removal volume does, so that no wear is lost.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_3d_removal.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting_3d

REMOVAL = cutting_3d.groups(
    velocity=0.4, lowering_velocity=0.4, wear_coefficient=0.1 * 5e-6, removal="depth", wear_period=2,
    snapshot_period=0.02, record_period=1e-3)

main("cutting_3d_removal", REMOVAL, cutting_3d.make)

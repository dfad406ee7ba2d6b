"""Two discs and one bond, under tension, compression, shear and both, for every bond law [Rojek 2003, 4.6].

    yade -n -x yade_scripts/two_disc.py [--name value ...] [--out DIR]

The lower disc is fixed, the upper one is moved and rolled. YADE's forces (points) are drawn over those of the law's own
`drive` at the same displacements (line), one figure for each of the source's figures 4.11 to 4.26, and as many for the
brittle and the Padova law. The forces of a step belong to the displacements of the same step: there is no lag. The
source prints k_t = 1e5 N among its constants, which is R_t; k_t is taken as k_n. It has no numbers for the Padova law.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("two_disc.py")[0] + "find_rockwear.py")

from calibration.laboratory.two_disc import main

main()

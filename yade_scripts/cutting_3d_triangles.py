"""Cutting bonded rock in space, model I: a tooth of triangles; where a chip forms [Rojek 2003, 13.2].

    yade -n -x yade_scripts/cutting_3d_triangles.py [--full] [--name value ...] [--out DIR] [--resume]

The numbers are the source's: kn = kt = 1e6 N/m, mu = 0.5, 0.1 against the tooth, 0.04 m/s, no wear. Its strengths,
Rn = 500 N/m and Rt = 5000 N/m, are forces over a length: times the spheres' diameter of 18 mm they are 9 and 90 N. It
shows block, tooth and depth of cut in a figure only, and gives no density and no length: they are ours, 60 mm of cut.
The source's spheres of 9 mm come with --full (11,720 of them, the source has 11,700); by default radii are 1.5 times as
large. Models II and III: cutting_3d_wear.py, cutting_3d_removal.py.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("cutting_3d_triangles.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting_3d

main("cutting_3d_triangles", cutting_3d.groups(tool="triangles", lowering_velocity=0.4, cut_time=1.5), cutting_3d.make)

"""A tooth of triangles goes through loose spheres that have settled under gravity [Rojek 2003, 13.1].

    yade -n -x yade_scripts/granular_3d.py [--full] [--name value ...] [--out DIR] [--resume]

The numbers are the source's: kn = 1e6 N/m, mu = 0.1 between particles and against the tooth, 0.04 m/s, no cohesion, no
wear. It shows box, tooth and depth of cut in a figure only, and gives no density: they are ours. The source's 11,700
spheres of 9 mm come with --full; by default radii are 1.5 times as large. The box's bottom and sides are fixed spheres.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("granular_3d.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import cutting_3d

FILL = cutting_3d.loose_groups(tool="triangles", porosity=0.42, start=0.2, background_damping=5.0)

main("granular_3d", FILL, cutting_3d.make_loose)

"""A steady cut: a tooth through a rock mass without end, of which a window moves along with it.

    yade -n -x yade_scripts/steady_cut.py [--rock NAME] [--depth_of_cut m] [--name value ...] [--out DIR]

By default a sandstone that crushes, with eight discs in the depth of cut, which give the sizes of all else;
--discs_per_depth 0 leaves all sizes to their own parameters, --rock '' the bonds.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("steady_cut.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import steady_cut

TOOL = steady_cut.groups(
    rock="crushing_sandstone", discs_per_depth=8.0, depth_of_cut=5e-3, cut_length=0.12, rake=-5.0, clearance=5.0,
    tip_radius=5e-4, tool_kn=5e9, tool_kt=5e9, contact_damping=0.1, heat=False, wear_acceleration=1.0,
    # Where discs_per_depth does not give them:
    window_behind=0.02, window_ahead=0.044, window_height=0.03, tooth_height=0.02, tooth_width=0.008,
    tool_radius_min=2e-4, tool_radius_max=2.6e-4, radius_min=5e-4, radius_max=7.5e-4)

main("steady_cut", TOOL, steady_cut.make)

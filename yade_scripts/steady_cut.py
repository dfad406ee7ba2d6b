"""A steady cut: a tooth through a rock mass without end, of which a window moves along with it.

    yade -n -x yade_scripts/steady_cut.py --rock NAME [--depth_of_cut m] [--cut_length m] [--name value ...] [--out DIR]
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("steady_cut.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import steady_cut

TOOL = steady_cut.groups(
    window_behind=0.02, window_ahead=0.044, window_height=0.03, depth_of_cut=5e-3, rake=-5.0, clearance=5.0,
    tip_radius=5e-4, tooth_height=0.02, tooth_width=0.008,
    tool_radius_min=2e-4, tool_radius_max=2.6e-4, tool_kn=1e10, tool_kt=1e10, contact_damping=0.2, radius_min=5e-4,
    radius_max=7.5e-4, heat=False, wear_acceleration=1.0)

main("steady_cut", TOOL, steady_cut.make)

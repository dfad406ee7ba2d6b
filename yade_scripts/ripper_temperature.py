"""How hot a ripper's tip gets at 4, 0.4 and 0.04 m/s, where that ends, and what it does to wear [Rojek 2003, ch. 11].

    yade -n -x yade_scripts/ripper_temperature.py [--name value ...] [--out DIR] [--resume]

The start-up brings the tool to the rock. Then a pass at each speed from room temperature, its first 20 mm in the rock:
the transients. The mean load of each pass heats the tool alone: a minute of it, and the quasi-stationary fields with
the shank at 20 deg C and with an insulated shank. From either field at 0.4 m/s a last pass with wear, 7000 times
accelerated.

The mechanics always run at --velocity, 4 m/s, while heat has the time of the process (rockwear/scenes/passes.py);
--velocity 0.4 --start_up 0.001 --cycle_time 0.05 runs them ten times slower and takes ten times as long. The source
shares friction heat equally. It shows the tooth in figures only: its shape and the depth of cut are ours, as in
ripper.py.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("ripper_temperature.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes import passes

RIPPER = passes.groups(
    kn=90e9, kt=90e9, tool_kn=20e9, tool_kt=20e9, tool_radius_max=0.6e-3, heat_sharing="equal",
    rake=25.0, clearance=12.0, tooth_height=0.085, tooth_width=0.06, tip_radius=5e-3, depth_of_cut=0.015,
    start_up=1e-4, cycle_time=0.005)

main("ripper_temperature", RIPPER, passes.make)

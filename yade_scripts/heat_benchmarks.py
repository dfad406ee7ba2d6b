"""M 7.6: three benchmarks of heat conduction on square, triangular and random packings, beside their exact solutions.

    yade -n -x yade_scripts/heat_benchmarks.py [--benchmark slab_source|half_space|jump] [--packing random|square|
    triangular] [--across 80] [--name value ...] [--out DIR] [--resume]

Without words all nine, each at three resolutions: profiles over the exact ones, errors, and the order of convergence.
The parameters, their defaults and sources are those of rockwear.scenes.heat_benchmarks; --help prints them.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("heat_benchmarks.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes.heat_benchmarks import GROUPS, HeatBenchmarks

main("heat_benchmarks", GROUPS, HeatBenchmarks)

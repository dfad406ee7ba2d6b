"""Heat conduction on square, triangular and random packings beside exact solutions [Rojek 2003, 7.6].

    yade -n -x yade_scripts/heat_benchmarks.py [--benchmark slab_source|half_space|jump] [--packing random|square|
    triangular] [--across 80] [--name value ...] [--out DIR] [--resume]

By default all nine cases, each at three resolutions: profiles over the exact ones, errors, and the order of
convergence.
"""
import runpy
import sys

runpy.run_path(sys.argv[0].rpartition("heat_benchmarks.py")[0] + "find_rockwear.py")

from rockwear.run.main import main
from rockwear.scenes.heat_benchmarks import GROUPS, HeatBenchmarks

main("heat_benchmarks", GROUPS, HeatBenchmarks)

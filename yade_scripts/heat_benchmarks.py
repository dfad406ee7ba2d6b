"""M 7.6: three benchmarks of heat conduction on square, triangular and random packings, beside their exact solutions.

    yade -n -x yade_scripts/heat_benchmarks.py [--benchmark slab_source|half_space|jump] [--packing random|square|
    triangular] [--across 80] [--name value ...] [--out DIR] [--resume]

Without words all nine, each at three resolutions: profiles over the exact ones, errors, and the order of convergence.
The parameters, their defaults and sources are those of rockwear.heat_benchmarks; --help prints them.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))

from rockwear import run  # noqa: E402
from rockwear.heat_benchmarks import PARAMETERS, HeatBenchmarks  # noqa: E402

run.main("heat_benchmarks", PARAMETERS, HeatBenchmarks)

"""When the end of a strength test comes; writes {case: (index of the stress, what it says)} to FILE.

    yade -n -x failure.py FILE
"""
import json
import os
import sys

from rockwear.engines.base import RunEnded
from rockwear.engines.failure import Failure

STRESSES = {
    "a fall": ([0.0, 5e6, 4.1e6, 3.9e6], {}),
    "noise of the first loading": ([0.0, 2.03e6, 1.5e6, 0.1e6, 9e6, 8e6, 7.1e6, 6.9e6], {"noise": 2e6, "beside": 1e7}),
    "a part that is no fall": ([9e6, 7.3e6, 7.1e6], {"noise": 1e6}),
    "nothing broken": ([5e6, 1e6], {"broken": lambda: False}),
}


def end(stresses, given):
    left = iter(stresses)
    failure = Failure(**{"stress": lambda: next(left), "broken": lambda: True, "drop": 0.8, **given})
    for index, stress in enumerate(stresses):
        try:
            failure.act()
        except RunEnded as ended:
            return index, str(ended), failure.has_fallen(stress)
    return None


with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump({case: end(*of) for case, of in STRESSES.items()}, file)
os._exit(0)

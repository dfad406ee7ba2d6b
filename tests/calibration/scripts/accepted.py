"""Which parameters scripts refuse, without building their scenes, in one process of YADE.

    yade -n -x accepted.py RUNS.json CHECKS.json

RUNS.json: [[script, {parameter: value}], ...]. Writes the refusals: ["script: message", ...].
"""
import json
import os
import runpy
import sys
from pathlib import Path

from rockwear.kernels.checks import ParameterError
from rockwear.run import main as run
from rockwear.run import parameters


def groups_of(script, found={}):
    """Parameter groups that a script passes to rockwear.run.main."""
    if script not in found:
        sys.argv = [script]
        run.main = lambda name, groups, make_scene: found.update({script: [*groups, run.COMMON]})
        runpy.run_path(script)
    return found[script]


refused = []
runs, checks = sys.argv[-2:]
for script, values in json.loads(Path(runs).read_text(encoding="utf-8")):
    try:
        parameters.read(groups_of(script), [f"--{name}={value}" for name, value in values.items()])
    except ParameterError as error:
        refused.append(f"{script}: {error}")
Path(checks).write_text(json.dumps(refused), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

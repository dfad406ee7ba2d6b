"""What a scene makes and puts into YADE for the physics that it has.

    yade -n -x needed.py CASES.json CHECKS.json

CASES.json: {case: [scene, words of its command line]}. Writes {case: {what: found}}.
"""
import json
import os
import sys
from collections import Counter
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from unittest import mock

from yade import O

from rockwear.engines.base import Engine
from rockwear.kernels.conduction import HeatNetwork
from rockwear.model.thermal_body import ThermalBody
from rockwear.run import parameters
from rockwear.run.main import COMMON


def counted(kind, made):
    """Count in `made` what is made of a class and those derived from it."""
    make = kind.__init__

    def counting(self, *args, **kwargs):
        made[type(self).__name__] += 1
        make(self, *args, **kwargs)
    return mock.patch.object(kind, "__init__", counting)


def found(name, words):
    """What is there once the scene has been built and has run to its first canonical point."""
    module, made = import_module(f"rockwear.scenes.{name}"), Counter()
    with ExitStack() as stack:
        for kind in (Engine, HeatNetwork, ThermalBody):
            stack.enter_context(counted(kind, made))
        scene = module.make(parameters.read([*module.GROUPS, COMMON], words))
        scene.build()
        scene.run_chunk()
    grains = getattr(scene, "grain_damping", None)
    tool, surface = scene.tool, getattr(scene.tool.model, "erosion", None)
    return {"made": dict(made), "engines": [engine.name for engine in scene.engines], "rock": scene.rock.count,
            "pieces": tool.count, "of_tool": len(tool.bodies.body_of), "bodies": sum(1 for _ in O.bodies),
            "surface": len(surface.surface) if surface else tool.count, "balances": list(scene.output.balances()),
            "grain_rate": grains.rate if grains else 0.0, "step": scene.time_step}


cases, checks = sys.argv[-2:]
said = {case: found(*given) for case, given in json.loads(Path(cases).read_text(encoding="utf-8")).items()}
Path(checks).write_text(json.dumps(said), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

"""Scenes whose contacts are laid out in memory anew again and again, against the same that are not.

    yade -n -x laid_out.py CASES.json CHECKS.json

CASES.json: {case: [scene, words of its command line]}. Writes {case: {what: found}}.
"""
import json
import os
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from unittest import mock

import numpy as np
from yade import O

from rockwear.engines.access import states
from rockwear.run import parameters
from rockwear.run.main import COMMON
from rockwear.scenes import scene as scenes

CHUNKS, STEPS, STOPPED = 5, 200, 3
"""Canonical points, steps between them, the one at which a run is stopped and resumed."""


def made(name, words):
    """A scene that has not been built."""
    module = import_module(f"rockwear.scenes.{name}")
    scene = module.make(parameters.read([*module.GROUPS, COMMON], words))
    scene.chunk = STEPS
    return scene


def resumed(scene, given, folder):
    """The scene, saved and taken up by another."""
    state, other = scene.state(), made(*given)
    (folder / "checkpoint").mkdir()
    scene.save(folder / "checkpoint", folder)
    other.restore(state, folder / "checkpoint", folder)
    return other


def run(given, laid_out, stopped=False):
    """({what: numbers} at the end, contacts in the order of their particles or not).

    laid_out: canonical points from one laying out to the next.
    """
    with mock.patch.object(scenes, "LAID_OUT", laid_out), tempfile.TemporaryDirectory() as folder:
        scene = made(*given)
        scene.build()
        for k in range(CHUNKS):
            if stopped and k == STOPPED:
                scene = resumed(scene, given, Path(folder))
            scene.run_chunk()
            if scene.stage_done:
                scene.end_stage(Path(folder))
    contacts = [(i.id1, i.id2) for i in O.interactions]
    energies = {**scene.stored_energy(), **scene.output.energy_balance()}
    del energies["residual"]
    return {"moving": states(range(scene.rock.count)), "bonds": scene.bonds.status, "energies": list(energies.values()),
            "temperature": scene.heat.network.temperature if scene.heat else [],
            "cracks": [len(scene.bonds.cracks)], "friction": [energies["tool_friction"]],
            "iteration": [O.iter, *(engine.last_iteration for engine in scene.engines)]}, contacts == sorted(contacts)


def largest_difference(one, other):
    """Of numbers, over the largest of them."""
    one, other = np.asarray(one, float), np.asarray(other, float)
    return float(np.max(np.abs(one - other), initial=0.0) / max(np.max(np.abs(other), initial=0.0), 1e-300))


def found(given):
    plain, _ = run(given, scenes.NEVER)
    laid, in_order = run(given, 1)
    again, _ = run(given, 1, stopped=True)
    return {"cracks": plain["cracks"][0], "friction": plain["friction"][0], "in_order": in_order,
            "differs": {what: largest_difference(laid[what], plain[what]) for what in plain},
            "resumed differs": {what: largest_difference(again[what], laid[what]) for what in plain}}


cases, checks = sys.argv[-2:]
said = {case: found(given) for case, given in json.loads(Path(cases).read_text(encoding="utf-8")).items()}
Path(checks).write_text(json.dumps(said), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

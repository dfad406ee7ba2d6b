"""Cost of the Python engines in a steady cut, where the tool is in contact all the time, and errors of their samples.

    PYTHONPATH=. yade -n -x -j1 calibration/benchmarks/steady_engines.py --out DIR [--name value ...]

The cut of `make run`, from where its tool has gone BEGIN. Clocks say what YADE and the engines cost over the next TIMED
of way, short turns without the engines how much longer YADE's own step is beside them. Then the same steps follow
twice, with the defaults and with every step sampled: samples do not act back on the motion, so the difference is
theirs. Writes DIR/steady_engines.json. calibration/benchmarks/steady_cost.py runs it.
"""
import json
import os
import sys
import time
from pathlib import Path

import numpy as np
from yade import O, PyRunner, utils

from calibration.benchmarks.make_run import BEGIN, CUT
from rockwear.engines import base
from rockwear.engines.access import rock_positions
from rockwear.engines.bond_log import INTACT
from rockwear.kernels.stability import critical_time_step
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import steady_cut

TIMED = 0.014
"""m."""
TURNS, TURN = 30, 77
"""Turns with the engines and without, and steps of each. Without them for long the rock would fall apart: part of its
bond law is theirs, and in 1500 steps half of its contacts went."""
SAMPLED = 6000
"""Steps of the two runs that are compared."""


def every_step(scene):
    """Sample every step from now on. (Slip of bonds is none: it is taken out of their strains in every step.)"""
    scene.rock_friction.period = scene.tool.contact.sampling_period = 1
    base.register(scene.engines)


def balances(scene):
    """{what: number} of what the engines add up, by now."""
    balance, heat = scene.output.energy_balance(), scene.heat
    heat.act()
    return {**{name: balance[name] for name in ("tool_work", "tool_friction", "rock_friction", "residual")},
            "wear": scene.tool.volume_balance()["archard"],
            "tip temperature": float(heat.tool_temperature().max() - scene.heat_model.tool_temperature),
            "kinetic energy": utils.kineticEnergy()}


def sampled(scene, state, folder, change=lambda scene: None):
    """Run the compared steps from `state`. -> what the balances gain, and the worn depths."""
    scene.restore(state, folder, folder)
    change(scene)
    before = balances(scene)
    base.run(SAMPLED)
    after, depth = balances(scene), scene.output.snapshot()["worn_depth"]
    gained = {name: after[name] - before[name] for name in after if name not in ("tip temperature", "kinetic energy")}
    return {**after, **gained}, np.asarray(depth)


def timed(scene):
    """{what: number} of the cost over TIMED of way. All that is not YADE's own counts as overhead: beside the engines
    that is what their runners cost, canonical points, and the advance of the window."""
    def spent():
        return (time.perf_counter(), base.yade_time, O.iter,
                np.array([engine.wall_time for engine in scene.engines]))

    before = spent()
    while scene.programme.distance < BEGIN + TIMED:
        scene.run_chunk()
    total, yade, steps, engines = (now - then for now, then in zip(spent(), before))
    seconds = {engine.name: float(one) for engine, one in zip(scene.engines, engines)}
    return {"steps": steps, "step": yade / steps, "overhead": (total - yade) / yade,
            "seconds": {**seconds, "runners and canonical points": total - yade - float(engines.sum())}}


def turns(scene):
    """{"alive" and "dead" engines: [s of YADE's own time a step]} in turns, from where the cut is.

    (What the engines take is not: right after a rest they have more to do.)
    """
    found = {"alive": [], "dead": []}
    runners = [engine for engine in O.engines if isinstance(engine, PyRunner)]
    for _ in range(TURNS):
        for engines, seconds in found.items():
            base.register(scene.engines if engines == "alive" else [])
            for runner in runners:
                runner.dead = engines == "dead"
            begin = base.yade_time
            base.run(TURN)
            seconds.append((base.yade_time - begin) / TURN)
    return found


def critical_steps(scene):
    """Critical steps over that of untouched rock: of the bonds that are intact now, and of rock under the tool."""
    rock, intact = scene.rock, scene.bonds.status == INTACT
    kn, kt = rock.stiffness()
    left = critical_time_step(positions=rock_positions(rock), radii=rock.radii, masses=rock.masses,
                              inertias=rock.inertias, bonds=rock.pairs[intact], kn=kn[intact], kt=kt[intact],
                              fixed=np.flatnonzero(rock.fixed), ratcheting_free=True)
    return {"intact": left / scene.bonded_step, "under the tool": scene.contact_step / scene.bonded_step}


def main():
    """Measure and write."""
    servers.close()
    values = parameters.read([*steady_cut.groups(**CUT), COMMON], sys.argv[1:])
    folder = Path(values["out"])
    folder.mkdir(parents=True, exist_ok=True)
    scene = steady_cut.make(values)
    scene.build()
    while scene.programme.distance < BEGIN:
        scene.run_chunk()
    cost, state, steps = timed(scene), scene.state(), critical_steps(scene)
    scene.save(folder, folder)
    cost["turns"] = turns(scene)
    found, depth = sampled(scene, state, folder)
    exact, exact_depth = sampled(scene, state, folder, every_step)
    off = float(np.abs(depth - exact_depth).sum() / exact_depth.sum())
    (folder / "steady_engines.json").write_text(json.dumps({
        **cost, "discs": scene.rock.count, "bonds": len(scene.rock.pairs), "sampled": SAMPLED, "critical_steps": steps,
        "found": found, "exact": exact, "distribution": off}, indent=1), encoding="utf-8")
    os._exit(0)


main()

"""What the Python engines of a scene cost: the same steps with and without them, in turns."""
import time
from statistics import median

from yade import O, PyRunner

TURNS, FIRST = 5, 200
"""Turns; steps that are run before the clock starts."""


def alive_and_dead(scene, folder, steps):
    """{"overhead": (time with - time without) / time without, ...} of so many steps from where the scene is.

    Each turn begins from one saved state ("dead" is YADE's term for an engine that is switched off). Processor time;
    medians over the turns, the overhead that of the ratios.
    """
    state = scene.state()
    scene.save(folder, folder)
    seconds = {"alive": [], "dead": []}
    for _ in range(TURNS):
        for kind in seconds:
            scene.restore(state, folder, folder)
            for engine in O.engines:
                engine.dead = isinstance(engine, PyRunner) and kind == "dead"
            O.run(FIRST, True)
            begin = time.process_time()
            O.run(steps, True)
            seconds[kind].append((time.process_time() - begin) / steps)
    scene.restore(state, folder, folder)
    ratios = [alive / dead for alive, dead in zip(*seconds.values())]
    return {"seconds_a_step": seconds, "median": {kind: median(times) for kind, times in seconds.items()},
            "overhead": median(ratios) - 1}

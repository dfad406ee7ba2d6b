"""Engines in YADE's loop without a scene."""
from yade import O

from rockwear.engines import base


def insert(*engines):
    """Insert these engines, and no others, into YADE's loop; O.dt is set already."""
    base.register(engines)
    base.insert(engines)
    for engine in engines:
        engine.last_iteration = O.iter - 1
        engine.connect()

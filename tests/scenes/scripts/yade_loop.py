"""Engines in YADE's loop without a scene."""
from rockwear.engines import base


def insert(*engines):
    """Insert these engines, and no others, into YADE's loop; O.dt is set already."""
    base.register(engines)
    base.insert(engines)
    for engine in engines:
        engine.start_clock()
        engine.connect()

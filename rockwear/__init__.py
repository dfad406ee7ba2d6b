"""rockwear: how a rock-cutting tool heats up, wears and changes its shape, on the YADE discrete element engine."""
__version__ = "0.1.0"

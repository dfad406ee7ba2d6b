"""Scenes: staged simulations in YADE, put together from parts."""

"""Scenes: what is put into YADE, from parts, and led through its stages."""
